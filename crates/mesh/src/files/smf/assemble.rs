//! Turns the statements of a file into meshes.

use std::path::Path;

use glam::{DVec3, Mat4, Vec2, Vec3};

use crate::files::LoadError;
use crate::numbering::Numbering;
use crate::{Mesh, Part, origin_of_box};

/// The elements that an attribute's values belong to, in order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Binding {
    #[default]
    None,
    Vertex,
    Face,
}

/// The values of an attribute.
#[derive(Default)]
pub(super) struct BoundValues<T> {
    pub(super) binding: Binding,
    pub(super) values: Vec<T>,
}

impl<T> BoundValues<T> {
    /// Binds the values to come. Existing values keep their binding, so it must be the same; returns whether it is.
    pub(super) fn bind(&mut self, binding: Binding) -> bool {
        let fits = self.values.is_empty() || self.binding == binding;
        self.binding = if fits { binding } else { self.binding };
        fits
    }
}

/// A group's name, and the triangle that it begins with.
struct Group {
    name: String,
    triangle: usize,
}

/// The contents of the file.
#[derive(Default)]
pub(super) struct SmfContent {
    pub(super) positions: Vec<DVec3>,
    /// The point that the positions of meshes are counted from.
    origin: DVec3,
    pub(super) normals: BoundValues<Vec3>,
    pub(super) colors: BoundValues<Vec3>,
    pub(super) uvs: BoundValues<Vec2>,
    pub(super) faces: usize,
    indices: Vec<u32>,
    /// The face of every triangle, where a face was cut into several.
    face_of: Vec<u32>,
    groups: Vec<Group>,
}

impl SmfContent {
    pub(super) fn new(name: String) -> Self {
        Self { groups: vec![Group { name, triangle: 0 }], ..Self::default() }
    }

    /// The triangles to come belong to this group.
    pub(super) fn begin_group(&mut self, name: &str) {
        let triangle = self.indices.len() / 3;
        match self.groups.last_mut() {
            Some(last) if last.triangle == triangle => name.clone_into(&mut last.name),
            _ => self.groups.push(Group { name: name.to_owned(), triangle }),
        }
    }

    /// Adds a triangle of the face that was counted last.
    pub(super) fn triangle(&mut self, corners: [u32; 3]) {
        let triangle = self.indices.len() / 3;
        let face = self.faces - 1;
        if face != triangle || !self.face_of.is_empty() {
            // Until now every face was one triangle.
            self.face_of.extend(self.face_of.len() as u32..triangle as u32);
            self.face_of.push(face as u32);
        }
        self.indices.extend(corners);
    }

    /// A part for each group that has triangles, and warnings of missing attributes that were filled in.
    pub(super) fn into_parts(mut self, path: &Path) -> Result<(Vec<Part>, DVec3, Vec<String>), LoadError> {
        let mut warnings = Vec::new();
        self.warn_of_counts(path, &mut warnings);
        let used = || self.indices.iter().map(|&corner| self.positions[corner as usize]);
        let extent = used().reduce(DVec3::min).zip(used().reduce(DVec3::max));
        let origin = extent.map_or(DVec3::ZERO, |(min, max)| origin_of_box(min, max));
        self.origin = origin;
        let groups = std::mem::take(&mut self.groups);
        let ends: Vec<usize> =
            groups.iter().skip(1).map(|group| group.triangle).chain([self.indices.len() / 3]).collect();
        let filled: Vec<(Group, usize)> =
            groups.into_iter().zip(ends).filter(|(group, end)| *end > group.triangle).collect();
        let alone = filled.len() == 1;
        let mut parts = Vec::with_capacity(filled.len());
        for (group, end) in filled {
            let mesh = if alone && !self.is_split() {
                std::mem::take(&mut self).into_mesh()
            } else {
                self.selected(3 * group.triangle..3 * end).into_mesh()
            };
            let (mesh, replaced) = mesh.map_err(|source| {
                let element = if alone { "mesh".to_owned() } else { format!("`{}`", group.name) };
                LoadError::Mesh { path: path.to_owned(), element, source }
            })?;
            if replaced > 0 {
                warnings.push(format!("{replaced} vertices without a normal get a computed one"));
            }
            parts.push(Part { name: group.name, mesh, material: None, world_from_part: Mat4::IDENTITY });
        }
        Ok((parts, origin, warnings))
    }

    /// Whether faces have values of their own, so that they share no vertices.
    fn is_split(&self) -> bool {
        let of_faces = |binding: Binding, count: usize| binding == Binding::Face && count > 0;
        of_faces(self.normals.binding, self.normals.values.len())
            || of_faces(self.colors.binding, self.colors.values.len())
    }

    fn warn_of_counts(&self, path: &Path, warnings: &mut Vec<String>) {
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        let rows = [
            ("n", self.normals.binding, self.normals.values.len(), "a computed normal"),
            ("c", self.colors.binding, self.colors.values.len(), "white"),
            ("r", self.uvs.binding, self.uvs.values.len(), "(0, 0)"),
        ];
        for (keyword, binding, found, instead) in rows {
            let (expected, what) = match binding {
                Binding::Face => (self.faces, "faces"),
                _ => (self.positions.len(), "vertices"),
            };
            if found > 0 && found != expected {
                warnings.push(format!(
                    "{file}: {found} `{keyword}` for {expected} {what}; what is missing is {instead}, what is left over is \
                     skipped"
                ));
            }
        }
    }

    /// The shape of some corners alone, with the vertices that they use; three vertices a triangle where faces have
    /// values of their own.
    fn selected(&self, corners: std::ops::Range<usize>) -> Self {
        let indices = &self.indices[corners.clone()];
        let (sources, firsts, indices) = if self.is_split() {
            (indices.to_vec(), corners.collect(), (0..indices.len() as u32).collect())
        } else {
            let used = Numbering::new(indices.len(), |corner| [indices[corner]]);
            let sources: Vec<u32> = used.firsts.iter().map(|&corner| indices[corner as usize]).collect();
            (sources, Vec::new(), used.numbers)
        };
        let face_of = |corner: usize| match self.face_of.get(corner / 3) {
            Some(&face) => face as usize,
            None => corner / 3,
        };
        Self {
            positions: sources.iter().map(|&vertex| self.positions[vertex as usize]).collect(),
            normals: self.normals.picked(&sources, &firsts, face_of, Vec3::ZERO),
            colors: self.colors.picked(&sources, &firsts, face_of, Vec3::ONE),
            uvs: self.uvs.picked(&sources, &firsts, face_of, Vec2::ZERO),
            indices,
            origin: self.origin,
            ..Self::default()
        }
    }

    /// The mesh, and how many normals were filled in.
    fn into_mesh(mut self) -> Result<(Mesh, usize), crate::MeshError> {
        let vertices = self.positions.len();
        // A vertex that nothing uses may be too far from the others.
        let placed = |p: &DVec3| Some((*p - self.origin).as_vec3()).filter(|p| p.is_finite()).unwrap_or_default();
        let (mesh, report) = Mesh::from_parts_reported(
            self.positions.iter().map(placed).collect(),
            self.normals.filled(vertices, Vec3::ZERO),
            self.uvs.filled(vertices, Vec2::ZERO),
            self.indices,
        )?;
        match self.colors.filled(vertices, Vec3::ONE) {
            None => Ok((mesh, report.replaced)),
            Some(colors) => {
                let mesh = mesh.with_colors(colors.into_iter().map(|rgb| rgb.extend(1.0)).collect())?;
                Ok((mesh, report.replaced))
            }
        }
    }
}

impl<T: Copy> BoundValues<T> {
    /// One value a vertex, `None` where there are none.
    fn filled(&mut self, vertices: usize, missing: T) -> Option<Vec<T>> {
        let mut values = std::mem::take(&mut self.values);
        if values.is_empty() {
            return None;
        }
        values.resize(vertices, missing);
        Some(values)
    }

    /// The values of vertices: of each vertex's source, or of the face of each vertex's corner.
    fn picked(&self, sources: &[u32], corners: &[usize], face_of: impl Fn(usize) -> usize, missing: T) -> Self {
        let value = |i: usize| self.values.get(i).copied().unwrap_or(missing);
        let values = match self.binding {
            _ if self.values.is_empty() => Vec::new(),
            Binding::Face => corners.iter().map(|&corner| value(face_of(corner))).collect(),
            _ => sources.iter().map(|&vertex| value(vertex as usize)).collect(),
        };
        Self { binding: Binding::Vertex, values }
    }
}
