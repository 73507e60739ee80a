//! Primitives: the meshes of glTF.

use std::collections::HashMap;

use gltf::Primitive;
use gltf::mesh::{Mode, Semantic};

use super::Fault;
use super::accessor::Accessors;
use crate::{Mesh, MeshError};

/// Bytes of a vertex (position, normal, uv) and of an index in a mesh.
const VERTEX: usize = 32;
const INDEX: usize = 4;

/// Makes meshes of primitives, each once, however many nodes show it.
pub(super) struct Primitives<'a> {
    accessors: Accessors<'a>,
    /// By the numbers of mesh and primitive; `None` where it has no triangles.
    meshes: HashMap<(usize, usize), Option<Mesh>>,
    warnings: Vec<String>,
    without_normals: usize,
    with_targets: usize,
}

impl<'a> Primitives<'a> {
    pub(super) fn new(accessors: Accessors<'a>) -> Self {
        Self { accessors, meshes: HashMap::new(), warnings: Vec::new(), without_normals: 0, with_targets: 0 }
    }

    pub(super) fn into_warnings(self) -> Vec<String> {
        let mut warnings = self.warnings;
        if self.without_normals > 0 {
            warnings.push(format!(
                "{} primitives have no normals; smooth ones are computed, where glTF asks for flat ones",
                self.without_normals
            ));
        }
        if self.with_targets > 0 {
            warnings.push(format!("the morph targets of {} primitives are skipped", self.with_targets));
        }
        warnings
    }

    /// The mesh of a primitive, `None` where it is made of points or lines.
    pub(super) fn mesh(&mut self, mesh: usize, primitive: &Primitive<'a>) -> Result<Option<Mesh>, Fault> {
        let key = (mesh, primitive.index());
        if let Some(known) = self.meshes.get(&key) {
            return Ok(known.clone());
        }
        let element = format!("meshes[{mesh}].primitives[{}]", primitive.index());
        let made = match primitive.mode() {
            Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan => Some(self.make(&element, primitive)?),
            mode => {
                self.warnings.push(format!("{element}: its mode, {mode:?}, is skipped"));
                None
            }
        };
        self.meshes.insert(key, made.clone());
        Ok(made)
    }

    fn make(&mut self, element: &str, primitive: &Primitive<'a>) -> Result<Mesh, Fault> {
        let invalid = |source: MeshError| Fault::Mesh { element: element.to_owned(), source };
        let Some(positions) = primitive.get(&Semantic::Positions) else {
            return Err(Fault::element(element, "no POSITION", "positions are"));
        };
        let positions = self.accessors.vec3s(&positions)?;
        let corners = match primitive.indices() {
            Some(indices) => self.accessors.indices(&indices)?,
            None => (0..positions.len() as u32).collect(),
        };
        let indices = triangles(primitive.mode(), corners);
        let used = used_vertices(&indices, positions.len()).map_err(invalid)?;
        let bytes = used.len() * VERTEX + indices.len() * INDEX;
        self.accessors.spend(&|| element.to_owned(), bytes)?;

        let normals = match primitive.get(&Semantic::Normals) {
            Some(normals) => Some(self.accessors.vec3s(&normals)?),
            None => None,
        };
        let uvs = match primitive.get(&Semantic::TexCoords(0)) {
            Some(uvs) => Some(self.accessors.vec2s(&uvs)?),
            None => None,
        };
        self.without_normals += usize::from(normals.is_none());
        self.with_targets += usize::from(primitive.morph_targets().len() > 0);
        let same_count = |attribute, found: usize| {
            if found == positions.len() {
                return Ok(());
            }
            Err(invalid(MeshError::CountMismatch { attribute, found, expected: positions.len() }))
        };
        if let Some(normals) = &normals {
            same_count("normal", normals.len())?;
        }
        if let Some(uvs) = &uvs {
            same_count("uv", uvs.len())?;
        }
        let (mesh, report) = Mesh::from_parts_reported(
            pick(&positions, &used),
            normals.map(|normals| pick(&normals, &used)),
            uvs.map(|uvs| pick(&uvs, &used)),
            renumbered(indices, &used),
        )
        .map_err(invalid)?;
        if report.replaced > 0 {
            let count = report.replaced;
            let warning = format!("{element}: {count} normals of zero length are replaced");
            self.warnings.push(warning);
        }
        Ok(mesh)
    }
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

/// The vertices that the triangles use, in order. Files may keep all their vertices in one place, of which a primitive
/// shows a few.
fn used_vertices(indices: &[u32], vertices: usize) -> Result<Vec<u32>, MeshError> {
    for (at, &index) in indices.iter().enumerate() {
        if index as usize >= vertices {
            return Err(MeshError::IndexOutOfRange { triangle: at / 3, corner: at % 3, index, vertices });
        }
    }
    let mut used = indices.to_vec();
    used.sort_unstable();
    used.dedup();
    Ok(used)
}

fn pick<T: Copy>(all: &[T], used: &[u32]) -> Vec<T> {
    used.iter().map(|&vertex| all[vertex as usize]).collect()
}

/// The indices into the used vertices.
fn renumbered(mut indices: Vec<u32>, used: &[u32]) -> Vec<u32> {
    let all_used = used.last().is_some_and(|&last| last as usize + 1 == used.len());
    if !all_used {
        for index in &mut indices {
            // Every index is among the used.
            *index = used.partition_point(|vertex| *vertex < *index) as u32;
        }
    }
    indices
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
    fn only_used_vertices_are_kept() {
        let indices = vec![7, 2, 4, 4, 2, 9];
        let used = used_vertices(&indices, 10).unwrap();
        assert_eq!(used, [2, 4, 7, 9]);
        assert_eq!(renumbered(indices, &used), [2, 0, 1, 1, 0, 3]);
        let all = vec![0, 2, 1];
        assert_eq!(renumbered(all.clone(), &used_vertices(&all, 3).unwrap()), all);
    }
}
