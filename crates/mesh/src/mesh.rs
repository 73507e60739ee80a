//! The triangle mesh.

use std::sync::Arc;

use bevy_asset::Asset;
use bevy_math::{Vec2, Vec3};
use bevy_reflect::TypePath;
use thiserror::Error;

use crate::normals::{face_normals, vertex_normals};
use crate::{Bounds, NormalReport, NormalWeighting, Normals};

/// A triangle mesh: vertices with a position, a unit normal and perhaps texture coordinates, and triangles that index
/// them.
///
/// What holds for every mesh: at least one triangle; every index in range; every number finite; every normal of unit
/// length. At most 2³² − 1 vertices and as many indices, since a draw call counts them in 32 bits. Front faces wind
/// counter-clockwise. Degenerate triangles may be among the others.
///
/// A mesh does not change once it is made, and its clones share its data.
#[derive(Asset, TypePath, Clone, Debug, PartialEq)]
pub struct Mesh {
    data: Arc<Data>,
}

#[derive(Clone, Debug, PartialEq)]
struct Data {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Option<Vec<Vec2>>,
    indices: Vec<u32>,
    bounds: Bounds,
}

/// Why a mesh was refused. Vertices and triangles are numbered from 0.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// There is nothing to show.
    #[error("the mesh has no triangles; at least one is expected")]
    NoTriangles,
    /// More vertices or indices than a draw call can count.
    #[error("{count} {elements}; at most {} are expected", u32::MAX)]
    TooMany {
        /// `"vertices"` or `"indices"`.
        elements: &'static str,
        /// How many there are.
        count: usize,
    },
    /// Not as many normals or texture coordinates as positions.
    #[error("{found} {attribute}s for {expected} positions; one a vertex is expected")]
    CountMismatch {
        /// `"normal"` or `"uv"`.
        attribute: &'static str,
        /// How many there are.
        found: usize,
        /// How many vertices there are.
        expected: usize,
    },
    /// The index list ends inside a triangle.
    #[error("{count} indices; three a triangle are expected")]
    PartialTriangle {
        /// How many there are.
        count: usize,
    },
    /// A triangle asks for a vertex that is not there.
    #[error("triangle {triangle}: index {index} at corner {corner}; the mesh has {vertices} vertices, numbered from 0")]
    IndexOutOfRange {
        /// The triangle.
        triangle: usize,
        /// Its corner, 0, 1 or 2.
        corner: usize,
        /// The index found there.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A number is NaN or infinite.
    #[error("vertex {vertex}: {attribute} {value:?}; finite numbers are expected")]
    NotFinite {
        /// `"position"`, `"normal"` or `"uv"`.
        attribute: &'static str,
        /// The vertex.
        vertex: usize,
        /// What was found there; the third number of a uv is 0.
        value: [f32; 3],
    },
}

impl Mesh {
    /// A mesh with normals of the default weighting ([`NormalWeighting::Angle`]).
    ///
    /// # Errors
    /// As [`from_parts`](Self::from_parts).
    pub fn new(positions: Vec<Vec3>, indices: Vec<u32>) -> Result<Self, MeshError> {
        Self::from_parts(positions, None, None, indices)
    }

    /// A mesh of the given vertices and triangles (three indices each).
    ///
    /// Normals that are given are scaled to unit length, those of zero length replaced by the default weighting's;
    /// where none are given, all are the default weighting's.
    ///
    /// # Errors
    /// No triangles, a number of indices that is not a multiple of three, an index out of range, a position, normal or
    /// uv that is not finite, not one normal or uv a vertex, or more of them than 32 bits count; the error names the
    /// first such element.
    pub fn from_parts(
        positions: Vec<Vec3>,
        normals: Option<Vec<Vec3>>,
        uvs: Option<Vec<Vec2>>,
        indices: Vec<u32>,
    ) -> Result<Self, MeshError> {
        Self::from_parts_reported(positions, normals, uvs, indices).map(|(mesh, _)| mesh)
    }

    /// [`from_parts`](Self::from_parts), and what had to be made up about the normals.
    ///
    /// # Errors
    /// As [`from_parts`](Self::from_parts).
    pub fn from_parts_reported(
        positions: Vec<Vec3>,
        normals: Option<Vec<Vec3>>,
        uvs: Option<Vec<Vec2>>,
        indices: Vec<u32>,
    ) -> Result<(Self, NormalReport), MeshError> {
        check_count("vertices", positions.len())?;
        check_count("indices", indices.len())?;
        check_positions(&positions)?;
        if let Some(normals) = &normals {
            check_attribute("normal", positions.len(), normals.iter().map(Vec3::to_array))?;
        }
        if let Some(uvs) = &uvs {
            check_attribute("uv", positions.len(), uvs.iter().map(|uv| [uv.x, uv.y, 0.0]))?;
        }
        check_indices(&indices, positions.len())?;

        let (normals, report) = match normals {
            Some(given) => kept_normals(given, &positions, &indices),
            None => vertex_normals(&positions, &indices, NormalWeighting::default()),
        };
        Ok((Self::checked(positions, normals, uvs, indices), report))
    }

    /// Takes what is known to keep the promises of a mesh.
    pub(crate) fn checked(positions: Vec<Vec3>, normals: Vec<Vec3>, uvs: Option<Vec<Vec2>>, indices: Vec<u32>) -> Self {
        let bounds =
            Bounds::from_points(positions.iter().copied()).unwrap_or(Bounds { min: Vec3::ZERO, max: Vec3::ZERO });
        Self { data: Arc::new(Data { positions, normals, uvs, indices, bounds }) }
    }

    /// The positions of the vertices.
    pub fn positions(&self) -> &[Vec3] {
        &self.data.positions
    }

    /// The normals of the vertices: one a vertex, of unit length.
    pub fn normals(&self) -> &[Vec3] {
        &self.data.normals
    }

    /// The texture coordinates of the vertices, one pair a vertex: (0, 0) is the top left of the image, (1, 1) the
    /// bottom right, as in glTF.
    pub fn uvs(&self) -> Option<&[Vec2]> {
        self.data.uvs.as_deref()
    }

    /// The indices of the triangles' corners: three a triangle, all in range.
    pub fn indices(&self) -> &[u32] {
        &self.data.indices
    }

    /// The triangles, each as the indices of its three corners.
    pub fn triangles(&self) -> impl ExactSizeIterator<Item = [u32; 3]> + '_ {
        self.data.indices.as_chunks::<3>().0.iter().copied()
    }

    /// How many triangles there are, at least one.
    pub fn triangle_count(&self) -> usize {
        self.data.indices.len() / 3
    }

    /// The box around all vertices.
    pub fn bounds(&self) -> Bounds {
        self.data.bounds
    }

    /// The mesh with its normals by the policy, and what had to be left out or made up.
    ///
    /// [`Normals::Keep`] changes nothing. [`Normals::Face`] gives every triangle three vertices of its own, and +Y to
    /// degenerate ones, which show nothing. [`Normals::Weighted`] keeps vertices and triangles.
    #[must_use]
    pub fn with_normals(self, policy: Normals) -> (Self, NormalReport) {
        match policy {
            Normals::Keep => (self, NormalReport::default()),
            Normals::Face => self.with_face_normals(),
            Normals::Weighted(weighting) => {
                let (normals, report) = vertex_normals(self.positions(), self.indices(), weighting);
                let mut data = Arc::unwrap_or_clone(self.data);
                data.normals = normals;
                let data = Arc::new(data);
                (Self { data }, report)
            }
        }
    }

    fn with_face_normals(self) -> (Self, NormalReport) {
        let (face, report) = face_normals(self.positions(), self.indices());
        let normals = face.into_iter().flat_map(|n| [n; 3]).collect();
        let corners = || self.indices().iter().map(|&i| i as usize);
        let positions = corners().map(|i| self.positions()[i]).collect();
        let uvs = self.uvs().map(|uvs| corners().map(|i| uvs[i]).collect());
        let indices = (0..self.indices().len() as u32).collect();
        (Self::checked(positions, normals, uvs, indices), report)
    }
}

fn check_count(elements: &'static str, count: usize) -> Result<(), MeshError> {
    match u32::try_from(count) {
        Ok(_) => Ok(()),
        Err(_) => Err(MeshError::TooMany { elements, count }),
    }
}

fn check_positions(positions: &[Vec3]) -> Result<(), MeshError> {
    check_attribute("position", positions.len(), positions.iter().map(Vec3::to_array))
}

fn check_attribute(
    attribute: &'static str,
    expected: usize,
    values: impl ExactSizeIterator<Item = [f32; 3]>,
) -> Result<(), MeshError> {
    let found = values.len();
    if found != expected {
        return Err(MeshError::CountMismatch { attribute, found, expected });
    }
    for (vertex, value) in values.enumerate() {
        if !value.iter().all(|x| x.is_finite()) {
            return Err(MeshError::NotFinite { attribute, vertex, value });
        }
    }
    Ok(())
}

fn check_indices(indices: &[u32], vertices: usize) -> Result<(), MeshError> {
    let (triangles, rest) = indices.as_chunks::<3>();
    if !rest.is_empty() {
        return Err(MeshError::PartialTriangle { count: indices.len() });
    }
    if triangles.is_empty() {
        return Err(MeshError::NoTriangles);
    }
    for (at, &index) in indices.iter().enumerate() {
        if index as usize >= vertices {
            return Err(MeshError::IndexOutOfRange { triangle: at / 3, corner: at % 3, index, vertices });
        }
    }
    Ok(())
}

/// Given normals scaled to unit length; the default weighting's in the place of those that have no direction.
fn kept_normals(mut given: Vec<Vec3>, positions: &[Vec3], indices: &[u32]) -> (Vec<Vec3>, NormalReport) {
    let mut without = Vec::new();
    for (vertex, n) in given.iter_mut().enumerate() {
        // In f64, where no finite f32 vector under- or overflows.
        match n.as_dvec3().try_normalize() {
            Some(unit) => *n = unit.as_vec3(),
            None => without.push(vertex),
        }
    }
    if without.is_empty() {
        return (given, NormalReport::default());
    }
    let (computed, _) = vertex_normals(positions, indices, NormalWeighting::default());
    for &vertex in &without {
        given[vertex] = computed[vertex];
    }
    let report = NormalReport { replaced: without.len(), ..NormalReport::default() };
    (given, report)
}
