//! Primitives: the meshes of glTF.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DMat4, Vec2, Vec3, Vec4};
use gltf::Primitive;
use gltf::accessor::Dimensions;
use gltf::mesh::{Mode, Semantic};

use super::accessor::{self, Accessors, Attribute, Items, Which};
use super::extensions::{self, DRACO};
use super::fault::Fault;
use crate::animation::{Influences, MorphTarget, Moved, Shape};
use crate::numbering::Numbering;
use crate::{Lines, Mesh, MeshError};

/// Bytes of a vertex (position, normal, two uvs, colour, tangent) and of an index in a mesh.
const VERTEX: usize = 72;
const INDEX: usize = 4;
/// Bytes of a vertex that is moved: position, normal and tangent, and the first two also in f64.
const MOVED: usize = 88;

/// The content of a primitive.
#[derive(Clone)]
pub(super) enum PrimitiveShape {
    /// With its vertices and what moves them, where something does.
    Mesh(Mesh, Option<Arc<Shape>>),
    Lines(Lines),
    /// It has no positions.
    Nothing,
}

/// Makes meshes of primitives, each once, however many nodes show it.
pub(super) struct Primitives<'a> {
    pub(super) accessors: Accessors<'a>,
    /// By the numbers of mesh and primitive.
    shapes: HashMap<(usize, usize), PrimitiveShape>,
    warnings: Vec<String>,
    without_normals: usize,
    without_positions: usize,
    without_bounds: usize,
    with_stiff_lines: usize,
    with_more: usize,
    with_bad_tangents: usize,
    with_idle_uvs: usize,
}

impl<'a> Primitives<'a> {
    pub(super) fn new(accessors: Accessors<'a>) -> Self {
        Self {
            accessors,
            shapes: HashMap::new(),
            warnings: Vec::new(),
            without_normals: 0,
            without_positions: 0,
            without_bounds: 0,
            with_stiff_lines: 0,
            with_more: 0,
            with_bad_tangents: 0,
            with_idle_uvs: 0,
        }
    }

    pub(super) fn into_warnings(self) -> Vec<String> {
        let mut warnings = self.warnings;
        for (count, before, after) in [
            (
                self.without_normals,
                "",
                " primitives have no normals; smooth ones are computed, where glTF asks for flat ones",
            ),
            (self.without_positions, "", " primitives have no positions and are skipped"),
            (
                self.without_bounds,
                "the positions of ",
                " primitives have no least and greatest values, which glTF asks for; they are computed",
            ),
            (self.with_stiff_lines, "the morph targets and joints of ", " primitives of lines or points are skipped"),
            (
                self.with_more,
                "of ",
                " primitives only the first two texture coordinates and the first colours are read",
            ),
            (
                self.with_bad_tangents,
                "the tangents of ",
                " primitives are skipped, since not all are of unit length with a sign of 1 or -1",
            ),
            (self.with_idle_uvs, "the texture coordinates of ", " primitives of lines or points are skipped"),
        ] {
            if count > 0 {
                warnings.push(format!("{before}{count}{after}"));
            }
        }
        warnings
    }

    /// The mesh of a primitive, or its lines or points.
    pub(super) fn shape(&mut self, mesh: usize, primitive: &Primitive<'a>) -> Result<PrimitiveShape, Fault> {
        let key = (mesh, primitive.index());
        if let Some(known) = self.shapes.get(&key) {
            return Ok(known.clone());
        }
        let element = format!("meshes[{mesh}].primitives[{}]", primitive.index());
        let Some(positions) = primitive.get(&Semantic::Positions) else {
            self.without_positions += 1;
            self.shapes.insert(key, PrimitiveShape::Nothing);
            return Ok(PrimitiveShape::Nothing);
        };
        let is_packed = primitive.extension_value(DRACO).is_some();
        if is_packed && positions.view().is_none() && positions.sparse().is_none() {
            return Err(extensions::required(DRACO));
        }
        self.without_bounds += usize::from(positions.min().is_none() || positions.max().is_none());
        let made = match primitive.mode() {
            Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan => {
                let (mesh, shape) = self.make(&element, primitive)?;
                PrimitiveShape::Mesh(mesh, shape)
            }
            _ => {
                let is_stiff = primitive.morph_targets().len() > 0 || primitive.get(&Semantic::Joints(0)).is_some();
                self.with_stiff_lines += usize::from(is_stiff);
                PrimitiveShape::Lines(self.make_lines(&element, primitive)?)
            }
        };
        self.shapes.insert(key, made.clone());
        Ok(made)
    }

    /// The attributes of a primitive besides positions, one a vertex; those that are left out are counted.
    fn attributes(
        &mut self,
        element: &str,
        primitive: &Primitive<'a>,
        vertices: usize,
    ) -> Result<Attributes<'a>, Fault> {
        let mut attribute = |semantic: Semantic, kind: &Attribute, what: &'static str| {
            let Some(accessor) = primitive.get(&semantic) else {
                return Ok(None);
            };
            let items = self.accessors.attribute(&accessor, kind)?;
            if items.count == vertices {
                return Ok(Some(items));
            }
            let source = MeshError::CountMismatch { attribute: what, found: items.count, expected: vertices };
            Err(Fault::Mesh { element: element.to_owned(), source })
        };
        let normals = attribute(Semantic::Normals, &accessor::NORMAL, "normal")?;
        let uvs = attribute(Semantic::TexCoords(0), &accessor::TEXCOORD, "uv")?;
        let second_uvs = attribute(Semantic::TexCoords(1), &accessor::TEXCOORD, "uv")?;
        let colors = attribute(Semantic::Colors(0), &accessor::COLOR, "colour")?;
        // Tangents of the file belong to normals of the file.
        let tangents = attribute(Semantic::Tangents, &accessor::TANGENT, "tangent")?.filter(|_| normals.is_some());
        self.without_normals += usize::from(normals.is_none() && !is_lines(primitive.mode()));
        let is_more = |semantic| matches!(semantic, Semantic::TexCoords(2..) | Semantic::Colors(1..));
        self.with_more += usize::from(primitive.attributes().any(|(semantic, _)| is_more(semantic)));
        Ok(Attributes { normals, uvs, second_uvs, colors, tangents })
    }

    /// The positions of a primitive and its corners.
    fn corners(&mut self, element: &str, primitive: &Primitive<'a>) -> Result<(Items<'a>, Vec<u32>), Fault> {
        let Some(positions) = primitive.get(&Semantic::Positions) else {
            return Err(Fault::element(element, "no POSITION", "positions are"));
        };
        let positions = self.accessors.attribute(&positions, &accessor::POSITION)?;
        let corners = match primitive.indices() {
            Some(indices) => self.accessors.indices(&indices)?,
            None => (0..positions.count as u32).collect(),
        };
        Ok((positions, corners))
    }

    fn make_lines(&mut self, element: &str, primitive: &Primitive<'a>) -> Result<Lines, Fault> {
        let invalid = |source: MeshError| Fault::Mesh { element: element.to_owned(), source };
        let (positions, corners) = self.corners(element, primitive)?;
        let vertices = positions.count;
        let is_cloud = primitive.mode() == Mode::Points;
        let (number_of, uses) = if is_cloud { (1, corners) } else { (2, ends(primitive.mode(), &corners)) };
        if let Some(at) = uses.iter().position(|&index| index as usize >= vertices) {
            let element = if is_cloud { "point" } else { "line" };
            return Err(invalid(MeshError::NoSuchVertex {
                element,
                number: at / number_of,
                index: uses[at],
                vertices,
            }));
        }
        let (which, numbers) = used_vertices(uses, vertices).map_err(invalid)?;
        let used = count(&which, vertices);
        self.accessors.spend(&|| element.to_owned(), used * VERTEX + numbers.len() * INDEX)?;
        let Attributes { normals, uvs, colors, .. } = self.attributes(element, primitive, vertices)?;
        self.with_idle_uvs += usize::from(uvs.is_some());
        let positions = positions.floats(&which, Vec3::from_array);
        let lines = if is_cloud {
            Lines::new(positions, Vec::new(), numbers)
        } else {
            Lines::new(positions, numbers.as_chunks().0.to_vec(), Vec::new())
        };
        let mut lines = lines.map_err(invalid)?;
        if let Some(normals) = normals {
            lines = lines.with_normals(normals.floats(&which, Vec3::from_array)).map_err(invalid)?;
        }
        if let Some(colors) = colors {
            lines = lines.with_colors(rgba(&colors, &which)).map_err(invalid)?;
        }
        Ok(lines)
    }

    fn make(&mut self, element: &str, primitive: &Primitive<'a>) -> Result<(Mesh, Option<Arc<Shape>>), Fault> {
        let invalid = |source: MeshError| Fault::Mesh { element: element.to_owned(), source };
        let (positions, corners) = self.corners(element, primitive)?;
        let vertices = positions.count;
        let indices = triangles(primitive.mode(), corners);
        let (which, indices) = used_vertices(indices, vertices).map_err(invalid)?;
        let used = count(&which, vertices);
        self.accessors.spend(&|| element.to_owned(), used * VERTEX + indices.len() * INDEX)?;

        let Attributes { normals, uvs, second_uvs, colors, tangents } =
            self.attributes(element, primitive, vertices)?;
        let has_normals = normals.is_some();
        let (mesh, report) = Mesh::from_parts_reported(
            positions.floats(&which, Vec3::from_array),
            normals.map(|normals| normals.floats(&which, Vec3::from_array)),
            uvs.map(|uvs| uvs.floats(&which, Vec2::from_array)),
            indices,
        )
        .map_err(invalid)?;
        if report.replaced > 0 {
            self.warnings.push(format!("{element}: {} normals of zero length are replaced", report.replaced));
        }
        let mesh = match second_uvs.map(|uvs| uvs.floats(&which, Vec2::from_array)) {
            Some(uvs) => mesh.with_second_uvs(uvs).map_err(invalid)?,
            None => mesh,
        };
        let mesh = match colors.map(|colors| rgba(&colors, &which)) {
            Some(colors) => mesh.with_colors(colors).map_err(invalid)?,
            None => mesh,
        };
        let mesh = match tangents.map(|tangents| tangents.floats(&which, Vec4::from_array)) {
            Some(tangents) if tangents.iter().all(is_tangent) => mesh.with_given_tangents(tangents),
            tangents => {
                self.with_bad_tangents += usize::from(tangents.is_some());
                mesh
            }
        };
        let targets = self.targets(element, primitive, (vertices, &which))?;
        let influences = self.influences(element, primitive, (vertices, &which))?;
        let moves = !targets.is_empty() || influences.is_some();
        let shape = moves.then(|| Arc::new(Shape { mesh: mesh.clone(), has_normals, targets, influences }));
        Ok((mesh, shape))
    }

    /// The morph targets of a primitive.
    fn targets(
        &mut self,
        element: &str,
        primitive: &Primitive<'a>,
        (vertices, which): (usize, &Which),
    ) -> Result<Vec<MorphTarget>, Fault> {
        let used = count(which, vertices);
        let mut targets = Vec::new();
        for (t, target) in primitive.morph_targets().enumerate() {
            let element = || format!("{element}.targets[{t}]");
            self.accessors.spend(&element, size_of::<MorphTarget>())?;
            let mut list = |accessor: Option<gltf::Accessor<'a>>, attribute: &'static str| {
                let Some(accessor) = accessor else { return Ok(Vec::new()) };
                let items = self.accessors.attribute(&accessor, &accessor::DISPLACEMENT)?;
                if items.count != vertices {
                    let source = MeshError::CountMismatch { attribute, found: items.count, expected: vertices };
                    return Err(Fault::Mesh { element: element(), source });
                }
                self.accessors.spend(&element, used * size_of::<Vec3>())?;
                let list = items.floats(which, Vec3::from_array);
                match list.iter().position(|v| !v.is_finite()) {
                    None => Ok(list),
                    Some(vertex) => {
                        let source = MeshError::NotFinite { attribute, vertex, value: list[vertex].to_array() };
                        Err(Fault::Mesh { element: element(), source })
                    }
                }
            };
            let positions = list(target.positions(), "position")?;
            let normals = list(target.normals(), "normal")?;
            let tangents = list(target.tangents(), "tangent")?;
            targets.push(MorphTarget { positions, normals, tangents });
        }
        Ok(targets)
    }

    /// The joints and weights of a primitive, if it has both.
    fn influences(
        &mut self,
        element: &str,
        primitive: &Primitive<'a>,
        (vertices, which): (usize, &Which),
    ) -> Result<Option<Influences>, Fault> {
        let used = count(which, vertices);
        let mut sets = Vec::new();
        for set in 0.. {
            let found = primitive.get(&Semantic::Joints(set)).zip(primitive.get(&Semantic::Weights(set)));
            let Some((joints, weights)) = found else { break };
            let joints = self.accessors.joints(&joints)?;
            let weights = self.accessors.attribute(&weights, &accessor::WEIGHTS)?;
            for (attribute, found) in [("joint", joints.count), ("weight", weights.count)] {
                if found != vertices {
                    let source = MeshError::CountMismatch { attribute, found, expected: vertices };
                    return Err(Fault::Mesh { element: element.to_owned(), source });
                }
            }
            // Once here and once among the influences.
            self.accessors.spend(&|| element.to_owned(), used * 2 * size_of::<([u16; 4], [f32; 4])>())?;
            // Whole numbers of 16 bits are exact in f32.
            let joints = joints.floats(which, |four: [f32; 4]| four.map(|joint| joint as u16));
            sets.push((joints, weights.floats(which, |four: [f32; 4]| four)));
        }
        Ok((!sets.is_empty()).then(|| Influences::new(&sets)))
    }

    /// The mesh of a shape that is moved, and its vertices in f64.
    pub(super) fn moved(
        &mut self,
        element: &str,
        shape: &Shape,
        (weights, joints): (&[f32], Option<&[DMat4]>),
    ) -> Result<Moved, Fault> {
        // A mesh of its own, and the vertices in f64 meanwhile.
        self.accessors.spend(&|| element.to_owned(), shape.mesh.positions().len() * MOVED)?;
        Ok(shape.moved(weights, joints))
    }
}

struct Attributes<'a> {
    normals: Option<Items<'a>>,
    uvs: Option<Items<'a>>,
    second_uvs: Option<Items<'a>>,
    colors: Option<Items<'a>>,
    tangents: Option<Items<'a>>,
}

fn rgba(colors: &Items, which: &Which) -> Vec<Vec4> {
    match colors.shape {
        Dimensions::Vec3 => colors.floats(which, |rgb| Vec3::from_array(rgb).extend(1.0)),
        _ => colors.floats(which, Vec4::from_array),
    }
}

/// Quantised to bytes a unit vector's length is off by up to 1 %.
fn is_tangent(tangent: &Vec4) -> bool {
    (tangent.truncate().length() - 1.0).abs() < 0.02 && (tangent.w.abs() - 1.0).abs() < f32::EPSILON
}

/// How many vertices these are, of so many in all.
fn count(which: &Which, vertices: usize) -> usize {
    match which {
        Which::All => vertices,
        Which::These(these) => these.len(),
    }
}

fn is_lines(mode: Mode) -> bool {
    matches!(mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip)
}

/// The two ends of each line that a primitive's corners make (glTF 2.0 §3.7.2.1). A last corner without another, and
/// the loop of a single corner, make none.
fn ends(mode: Mode, corners: &[u32]) -> Vec<u32> {
    if mode == Mode::Lines {
        return corners.as_chunks::<2>().0.as_flattened().to_vec();
    }
    let mut ends: Vec<u32> = corners.windows(2).flatten().copied().collect();
    if let (Mode::LineLoop, [first, .., last]) = (mode, corners) {
        ends.extend([*last, *first]);
    }
    ends
}

/// The corners of the triangles that a primitive's corners make (glTF 2.0 §3.7.2.1).
fn triangles(mode: Mode, corners: Vec<u32>) -> Vec<u32> {
    match mode {
        Mode::TriangleStrip => corners
            .windows(3)
            .enumerate()
            .flat_map(|(i, three)| match i % 2 {
                0 => [three[0], three[1], three[2]],
                _ => [three[0], three[2], three[1]],
            })
            .collect(),
        Mode::TriangleFan => corners.windows(2).skip(1).flat_map(|two| [two[0], two[1], corners[0]]).collect(),
        _ => corners,
    }
}

/// The vertices that the triangles use, and the indices into those. Files may keep all their vertices in one array, of
/// which a primitive uses a few; then these come in the order of their use.
fn used_vertices(indices: Vec<u32>, vertices: usize) -> Result<(Which, Vec<u32>), MeshError> {
    for (at, &index) in indices.iter().enumerate() {
        if index as usize >= vertices {
            return Err(MeshError::IndexOutOfRange { triangle: at / 3, corner: at % 3, index, vertices });
        }
    }
    // Checked only where there are enough indices, so that primitives that use few vertices pay nothing for the others.
    let uses_all = indices.len() >= vertices && {
        let mut is_used = vec![false; vertices];
        for &index in &indices {
            is_used[index as usize] = true;
        }
        is_used.into_iter().all(|used| used)
    };
    if uses_all {
        return Ok((Which::All, indices));
    }
    let used = Numbering::new(indices.len(), |corner| [indices[corner]]);
    let these = used.firsts.iter().map(|&corner| indices[corner as usize]).collect();
    Ok((Which::These(these), used.numbers))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans() {
        let corners = || vec![4, 5, 6, 7, 8];
        assert_eq!(triangles(Mode::Triangles, corners()), [4, 5, 6, 7, 8]);
        assert_eq!(triangles(Mode::TriangleStrip, corners()), [4, 5, 6, 5, 7, 6, 6, 7, 8]);
        assert_eq!(triangles(Mode::TriangleFan, corners()), [5, 6, 4, 6, 7, 4, 7, 8, 4]);
        for mode in [Mode::TriangleStrip, Mode::TriangleFan] {
            for few in 0..3 {
                assert!(triangles(mode, (0..few).collect()).is_empty());
            }
        }
    }

    #[test]
    fn lines_strips_and_loops() {
        let corners = [4, 5, 6];
        assert_eq!(ends(Mode::Lines, &corners), [4, 5]);
        assert_eq!(ends(Mode::LineStrip, &corners), [4, 5, 5, 6]);
        assert_eq!(ends(Mode::LineLoop, &corners), [4, 5, 5, 6, 6, 4]);
        for mode in [Mode::Lines, Mode::LineStrip, Mode::LineLoop] {
            assert!(ends(mode, &[]).is_empty() && ends(mode, &[4]).is_empty());
        }
    }

    #[test]
    fn only_used_vertices_are_kept() {
        let (which, indices) = used_vertices(vec![7, 2, 4, 4, 2, 9], 10).unwrap();
        assert!(matches!(which, Which::These(these) if these == [7, 2, 4, 9]));
        assert_eq!(indices, [0, 1, 2, 2, 1, 3]);
        let (which, indices) = used_vertices(vec![0, 2, 1], 3).unwrap();
        assert!(matches!(which, Which::All));
        assert_eq!(indices, [0, 2, 1]);
        // As many indices as vertices, but not all are used.
        let (which, _) = used_vertices(vec![0, 2, 2], 3).unwrap();
        assert!(matches!(which, Which::These(these) if these == [0, 2]));
    }
}
