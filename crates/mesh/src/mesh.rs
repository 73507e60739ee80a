//! The triangle mesh.

use std::sync::Arc;

use glam::{Vec2, Vec3, Vec4};
use thiserror::Error;

use crate::edges::Edges;
use crate::normals::vertex_normals;
use crate::numbering::Numbering;
use crate::{Bounds, NormalReport, NormalWeighting, Surface};

/// A triangle mesh: vertices with a position, a unit normal and perhaps texture coordinates, a colour and a tangent,
/// and triangles that index them.
///
/// Every mesh has at least one triangle, all indices in range, all numbers finite and all normals of unit length. At
/// most 2³² − 1 vertices and as many indices, since a draw call counts them in 32 bits. Front faces wind counter-
/// clockwise. Degenerate triangles may be among the others.
///
/// Clones share their data until one of them changes ([`set_positions`](Self::set_positions)).
///
/// ```
/// use glam::{Vec2, Vec3};
/// use halfway_mesh::Mesh;
///
/// // A square of two triangles, with computed normals and the whole texture.
/// let corners = vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
/// let uvs = vec![Vec2::Y, Vec2::ONE, Vec2::X, Vec2::ZERO];
/// let square = Mesh::from_parts(corners, None, Some(uvs), vec![0, 1, 2, 0, 2, 3])?;
/// assert_eq!(square.normals(), [Vec3::Z; 4]);
/// assert_eq!((square.triangle_count(), square.bounds().max), (2, Vec3::new(1.0, 1.0, 0.0)));
/// # Ok::<(), halfway_mesh::MeshError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    data: Arc<MeshData>,
}

/// The lists of a mesh. Clones share each list separately, so that a mesh that moves shares its triangles with the one
/// before.
#[derive(Clone, Debug, PartialEq)]
struct MeshData {
    positions: Arc<Vec<Vec3>>,
    normals: Arc<Vec<Vec3>>,
    uvs: Option<Arc<Vec<Vec2>>>,
    second_uvs: Option<Arc<Vec<Vec2>>>,
    colors: Option<Arc<Vec<Vec4>>>,
    tangents: Option<Arc<Vec<Vec4>>>,
    indices: Arc<Vec<u32>>,
    bounds: Bounds,
    surface: Option<Surface>,
    notes: Notes,
}

/// Knowledge of a mesh in which equal ones may differ.
#[derive(Clone, Copy, Debug)]
struct Notes {
    normals: NormalOrigin,
    /// Whether no two vertices are known to share a position, so that they need no numbering.
    are_apart: bool,
    /// Whether every vertex is a corner of some triangle.
    are_used: bool,
}

/// Who made the normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NormalOrigin {
    /// A file, a formula or a policy.
    Given,
    /// Nobody gave any, and the default weighting made them, before positions or triangles changed.
    Default,
    /// The default weighting, for these positions and triangles, with this report.
    DefaultOfThese(NormalReport),
}

impl NormalOrigin {
    /// The origin after positions or triangles have changed.
    fn of_others(self) -> Self {
        if self == Self::Given { Self::Given } else { Self::Default }
    }
}

impl PartialEq for Notes {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Why a mesh was refused. Vertices and triangles are numbered from 0.
///
/// ```
/// use glam::Vec3;
/// use halfway_mesh::{Mesh, MeshError};
///
/// let error = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![0, 1, 3]).unwrap_err();
/// assert!(matches!(error, MeshError::IndexOutOfRange { triangle: 0, corner: 2, index: 3, .. }));
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// There is nothing to show.
    #[error("the mesh has no triangles; at least one is expected")]
    NoTriangles,
    /// There is nothing to show among [`Lines`](crate::Lines).
    #[error("there are neither lines nor points; at least one is expected")]
    NoLines,
    /// A line or a point refers to a vertex that does not exist.
    #[error("{element} {number}: vertex {index}; there are {vertices} vertices, numbered from 0")]
    NoSuchVertex {
        /// `"line"` or `"point"`.
        element: &'static str,
        /// Its number.
        number: usize,
        /// The vertex that it names.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// More vertices or indices than a draw call can count.
    #[error("{count} {elements}; at most {} are expected", u32::MAX)]
    TooMany {
        /// `"vertices"`, `"indices"`, `"lines"` or `"points"`.
        elements: &'static str,
        /// How many there are.
        count: usize,
    },
    /// An attribute has more or fewer values than there are vertices.
    #[error("{found} {attribute}s for {expected} vertices; one a vertex is expected")]
    CountMismatch {
        /// `"position"`, `"normal"`, `"uv"` or `"colour"`.
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
    /// A triangle refers to a vertex that does not exist.
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
        /// `"position"`, `"normal"`, `"uv"`, `"colour"`, `"opacity"` or `"height"`.
        attribute: &'static str,
        /// The vertex.
        vertex: usize,
        /// The value found; numbers that the attribute does not have are 0.
        value: [f32; 3],
    },
    /// Tangents take texture coordinates.
    #[error("the mesh has no uvs; a tangent takes one a vertex")]
    NoUvs,
    /// Subdivision would make too many triangles.
    #[error("{count} triangles after {times} subdivisions; at most {most} are expected")]
    TooFine {
        /// How many there would be; `u64::MAX` if more than that.
        count: u64,
        /// How many subdivisions were asked for.
        times: u32,
        /// How many there may be.
        most: u64,
    },
}

impl MeshData {
    /// Replaces the positions by valid ones, as many as before.
    fn place(&mut self, positions: Vec<Vec3>) {
        self.bounds = bounds_of_used(&positions, &self.indices, self.notes.are_used);
        self.positions = Arc::new(positions);
        self.notes = Notes { normals: self.notes.normals.of_others(), are_apart: false, ..self.notes };
        self.surface = None;
    }
}

impl Mesh {
    /// A mesh with normals of the default weighting ([`NormalWeighting::Max`]).
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

    /// [`from_parts`](Self::from_parts), with a report of the normals that had to be filled in.
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
        check_attribute("position", positions.len(), positions.iter().map(Vec3::to_array))?;
        if let Some(normals) = &normals {
            check_attribute("normal", positions.len(), normals.iter().map(Vec3::to_array))?;
        }
        if let Some(uvs) = &uvs {
            check_attribute("uv", positions.len(), uvs.iter().map(|uv| [uv.x, uv.y, 0.0]))?;
        }
        check_indices(&indices, positions.len())?;

        if let Some(given) = normals {
            let (normals, report) = kept_normals(given, &positions, &indices);
            return Ok((Self::checked(positions, normals, uvs, indices), report));
        }
        let points = Numbering::from_positions(&positions);
        let (normals, report) = vertex_normals(&positions, &points, &indices, NormalWeighting::default());
        let mesh = Self::checked(positions, normals, uvs, indices).changed(|data| {
            data.notes.normals = NormalOrigin::DefaultOfThese(report);
            data.notes.are_apart = points.are_distinct();
        });
        Ok((mesh, report))
    }

    /// A mesh from data that is known to be valid.
    pub(crate) fn checked(positions: Vec<Vec3>, normals: Vec<Vec3>, uvs: Option<Vec<Vec2>>, indices: Vec<u32>) -> Self {
        let mut is_used = vec![false; positions.len()];
        for index in &indices {
            is_used[*index as usize] = true;
        }
        let are_used = !is_used.contains(&false);
        let bounds = bounds_of_used(&positions, &indices, are_used);
        let data = MeshData {
            positions: Arc::new(positions),
            normals: Arc::new(normals),
            uvs: uvs.map(Arc::new),
            second_uvs: None,
            colors: None,
            tangents: None,
            indices: Arc::new(indices),
            bounds,
            surface: None,
            notes: Notes { normals: NormalOrigin::Given, are_apart: false, are_used },
        };
        Self { data: Arc::new(data) }
    }

    /// Moves the vertices; triangles, texture coordinates and colours stay, and so do the normals and tangents until
    /// [`set_normals`](Self::set_normals).
    ///
    /// This is the cheap way to change a mesh each frame: change the asset itself, by `Assets::get_mut`. Only
    /// the bounds are computed again. The renderer recognises the triangles and keeps their layout: from the second
    /// change on it measures the moved vertices and sorts nothing. A mesh that is created anew each frame, by
    /// [`from_parts`](Self::from_parts), is laid out anew each time. The example `waves` moves a sheet of 100 × 100
    /// vertices.
    ///
    /// A formula gives the normals at less cost than [`with_normals`](Self::with_normals), which sums them over the
    /// triangles.
    ///
    /// ```
    /// use glam::{Vec2, Vec3};
    /// use halfway_mesh::{Mesh, MeshError, Plane};
    ///
    /// // A wave along x: height a·sin(x), normal (−a·cos(x), 1, 0), scaled to unit length.
    /// fn wave(mesh: &mut Mesh, a: f32) -> Result<(), MeshError> {
    ///     let moved: Vec<Vec3> = mesh.positions().iter().map(|p| Vec3::new(p.x, a * p.x.sin(), p.z)).collect();
    ///     mesh.set_normals(moved.iter().map(|p| Vec3::new(-a * p.x.cos(), 1.0, 0.0)).collect())?;
    ///     mesh.set_positions(moved)
    /// }
    ///
    /// let mut mesh = Mesh::from(Plane { size: 4.0, divisions: 9 });
    /// wave(&mut mesh, 0.5).unwrap();
    /// assert!(mesh.bounds().max.y > 0.4);
    /// assert!(mesh.set_positions(vec![Vec3::ZERO]).is_err());
    /// ```
    ///
    /// A mesh that stood for a [surface](Self::surface) does so no longer.
    ///
    /// # Errors
    /// Not one position a vertex, or one that is not finite. The mesh then is as it was.
    pub fn set_positions(&mut self, positions: Vec<Vec3>) -> Result<(), MeshError> {
        let vertices = self.positions().len();
        check_attribute("position", vertices, positions.iter().map(Vec3::to_array))?;
        Arc::make_mut(&mut self.data).place(positions);
        Ok(())
    }

    /// Gives the vertices other normals, scaled to unit length; those of zero length are replaced by the default
    /// weighting's of the positions that there are. Tangents, which belong to the old normals, are dropped.
    ///
    /// # Errors
    /// Not one normal a vertex, or one that is not finite. The mesh then is as it was.
    pub fn set_normals(&mut self, normals: Vec<Vec3>) -> Result<(), MeshError> {
        let vertices = self.positions().len();
        check_attribute("normal", vertices, normals.iter().map(Vec3::to_array))?;
        let (normals, _) = kept_normals(normals, self.positions(), self.indices());
        let data = Arc::make_mut(&mut self.data);
        data.normals = Arc::new(normals);
        data.tangents = None;
        data.notes.normals = NormalOrigin::Given;
        Ok(())
    }

    /// The mesh with a colour a vertex: linear RGB and opacity.
    ///
    /// # Errors
    /// Not one colour a vertex, or one that is not finite.
    pub fn with_colors(self, colors: Vec<Vec4>) -> Result<Self, MeshError> {
        let vertices = self.positions().len();
        check_attribute("colour", vertices, colors.iter().map(|c| c.truncate().to_array()))?;
        check_attribute("opacity", vertices, colors.iter().map(|c| [c.w, 0.0, 0.0]))?;
        Ok(self.changed(|data| data.colors = Some(Arc::new(colors))))
    }

    /// The mesh without colours at its vertices.
    #[must_use]
    pub fn without_colors(self) -> Self {
        self.changed(|data| data.colors = None)
    }

    /// The mesh with a pair of texture coordinates a vertex, in place of those that it has. Tangents, which belong to the
    /// old ones, are dropped.
    ///
    /// # Errors
    /// Not one pair a vertex, or one that is not finite.
    pub fn with_uvs(self, uvs: Vec<Vec2>) -> Result<Self, MeshError> {
        check_attribute("uv", self.positions().len(), uvs.iter().map(|uv| [uv.x, uv.y, 0.0]))?;
        Ok(self.changed(|data| {
            data.uvs = Some(Arc::new(uvs));
            data.tangents = None;
        }))
    }

    /// The mesh with vertices that no two triangles share: three for each, in their order.
    #[must_use]
    pub fn unshared(&self) -> Self {
        self.selected(self.indices(), (0..self.indices().len() as u32).collect())
    }

    /// The mesh with a second pair of texture coordinates a vertex, beside the first.
    ///
    /// # Errors
    /// Not one pair a vertex, or one that is not finite.
    pub fn with_second_uvs(self, uvs: Vec<Vec2>) -> Result<Self, MeshError> {
        check_attribute("uv", self.positions().len(), uvs.iter().map(|uv| [uv.x, uv.y, 0.0]))?;
        Ok(self.changed(|data| data.second_uvs = Some(Arc::new(uvs))))
    }

    /// The mesh with more vertices, each in the middle of two old ones in every attribute, and these triangles.
    /// Tangents are dropped.
    pub(crate) fn extended(&self, pairs: impl Iterator<Item = [u32; 2]> + Clone, indices: Vec<u32>) -> Self {
        fn extend<T: Copy>(all: &[T], pairs: impl Iterator<Item = [u32; 2]>, middle: impl Fn(T, T) -> T) -> Vec<T> {
            let middles = pairs.map(|pair| pair.map(|vertex| all[vertex as usize])).map(|[a, b]| middle(a, b));
            all.iter().copied().chain(middles).collect()
        }
        // In f64, where no sum of two f32 overflows or loses its last bit.
        let position = |a: Vec3, b: Vec3| (0.5 * (a.as_dvec3() + b.as_dvec3())).as_vec3();
        let positions = extend(self.positions(), pairs.clone(), position);
        let normals = extend(self.normals(), pairs.clone(), |a, b| (a + b).try_normalize().unwrap_or(a));
        let uvs = self.uvs().map(|all| extend(all, pairs.clone(), Vec2::midpoint));
        let mesh = Self::checked(positions, normals, uvs, indices);
        mesh.changed(|data| {
            data.second_uvs = self.uv_set(1).map(|all| Arc::new(extend(all, pairs.clone(), Vec2::midpoint)));
            data.colors = self.colors().map(|all| Arc::new(extend(all, pairs, Vec4::midpoint)));
            data.notes.normals = self.data.notes.normals.of_others();
        })
    }

    /// Replaces the normals by valid ones. Tangents, which belong to the old normals, are dropped.
    pub(crate) fn with_given_normals(self, normals: Vec<Vec3>) -> Self {
        self.changed(|data| {
            data.normals = Arc::new(normals);
            data.tangents = None;
            data.notes.normals = NormalOrigin::Given;
        })
    }

    /// The mesh with the normals that it has as given ones, and without tangents.
    pub(crate) fn with_normals_as_given(self) -> Self {
        self.changed(|data| {
            data.tangents = None;
            data.notes.normals = NormalOrigin::Given;
        })
    }

    /// The mesh with its normals marked as those of the default weighting, which nobody gave.
    #[cfg(feature = "formats")]
    pub(crate) fn with_normals_as_default(self) -> Self {
        self.changed(|data| data.notes.normals = NormalOrigin::Default)
    }

    /// Whether its normals were given, by a file, a formula or a policy; else the default weighting made them for want
    /// of others, and [`Normals::Auto`](crate::Normals::Auto) replaces them.
    pub fn has_given_normals(&self) -> bool {
        self.data.notes.normals == NormalOrigin::Given
    }

    /// The report of the default weighting, if its normals are known to be those of its positions and triangles.
    pub(crate) fn report_of_default_normals(&self) -> Option<NormalReport> {
        match self.data.notes.normals {
            NormalOrigin::DefaultOfThese(report) => Some(report),
            NormalOrigin::Given | NormalOrigin::Default => None,
        }
    }

    /// Replaces the positions by valid ones, as many as before.
    pub(crate) fn with_given_positions(self, positions: Vec<Vec3>) -> Self {
        self.changed(|data| data.place(positions))
    }

    /// Replaces the tangents by valid ones.
    pub(crate) fn with_given_tangents(self, tangents: Vec<Vec4>) -> Self {
        self.changed(|data| data.tangents = Some(Arc::new(tangents)))
    }

    /// The mesh as one that stands for `surface`: the caller's promise that it approximates it, in the same space and
    /// with the same outward side.
    #[must_use]
    pub fn with_surface(self, surface: Surface) -> Self {
        self.changed(|data| data.surface = Some(surface))
    }

    fn changed(self, change: impl FnOnce(&mut MeshData)) -> Self {
        let mut data = Arc::unwrap_or_clone(self.data);
        change(&mut data);
        Self { data: Arc::new(data) }
    }

    /// The mesh whose vertices are those of the given numbers, all in range, in that order, with all their attributes,
    /// and whose triangles are the given ones.
    pub(crate) fn selected(&self, vertices: &[u32], indices: Vec<u32>) -> Self {
        fn pick<T: Copy>(all: &[T], vertices: &[u32]) -> Vec<T> {
            vertices.iter().map(|&vertex| all[vertex as usize]).collect()
        }
        let uvs = self.uvs().map(|all| pick(all, vertices));
        let mesh = Self::checked(pick(self.positions(), vertices), pick(self.normals(), vertices), uvs, indices);
        mesh.changed(|data| {
            data.second_uvs = self.uv_set(1).map(|all| Arc::new(pick(all, vertices)));
            data.colors = self.colors().map(|all| Arc::new(pick(all, vertices)));
            data.tangents = self.tangents().map(|all| Arc::new(pick(all, vertices)));
            data.surface = self.surface().cloned();
            data.notes.normals = self.data.notes.normals.of_others();
        })
    }

    /// The numbers of the positions.
    pub(crate) fn points(&self) -> Numbering {
        if self.data.notes.are_apart {
            Numbering::of_distinct(self.positions().len())
        } else {
            Numbering::from_positions(self.positions())
        }
    }

    /// The numbers of the positions, and the edges between them.
    pub(crate) fn position_edges(&self) -> (Numbering, Edges) {
        let groups = self.points();
        let edges = Edges::new(groups.triangles(self.indices()));
        (groups, edges)
    }

    /// Whether both are clones of one mesh, of which neither has changed since.
    pub fn is_clone_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.data, &other.data)
    }

    /// Whether both have the same list of triangles: they are clones of one mesh whose vertices, if anything, have
    /// changed since.
    pub fn shares_triangles(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.data.indices, &other.data.indices)
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
        self.data.uvs.as_ref().map(|list| &list[..])
    }

    /// One of the sets of texture coordinates: number 0 is [`uvs`](Self::uvs), number 1 the second; there are no
    /// others.
    pub fn uv_set(&self, number: usize) -> Option<&[Vec2]> {
        match number {
            0 => self.uvs(),
            1 => self.data.second_uvs.as_ref().map(|list| &list[..]),
            _ => None,
        }
    }

    /// The colours of the vertices, one a vertex: linear RGB and opacity, finite but not limited to 0 … 1.
    pub fn colors(&self) -> Option<&[Vec4]> {
        self.data.colors.as_ref().map(|list| &list[..])
    }

    /// The colours as they are drawn: each number clamped to 0 … 1, as glTF 2.0 §3.7.2.1 requires for `COLOR_0`.
    pub fn drawn_colors(&self) -> Option<Vec<Vec4>> {
        self.colors().map(|colors| colors.iter().map(|color| color.clamp(Vec4::ZERO, Vec4::ONE)).collect())
    }

    /// The tangents of the vertices, one a vertex; see [`with_tangents`](Self::with_tangents).
    pub fn tangents(&self) -> Option<&[Vec4]> {
        self.data.tangents.as_ref().map(|list| &list[..])
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

    /// The smooth surface that the mesh stands for, if it is known by formula; `None` if nothing but the triangles is
    /// known. Other normals keep it, moved vertices do not.
    pub fn surface(&self) -> Option<&Surface> {
        self.data.surface.as_ref()
    }

    /// The box around all vertices that are corners of triangles.
    pub fn bounds(&self) -> Bounds {
        self.data.bounds
    }
}

/// The box around the vertices that triangles use; all of them, where that is known.
fn bounds_of_used(positions: &[Vec3], indices: &[u32], are_used: bool) -> Bounds {
    let bounds = if are_used {
        Bounds::from_points(positions.iter().copied())
    } else {
        Bounds::from_points(indices.iter().map(|index| positions[*index as usize]))
    };
    bounds.unwrap_or(Bounds { min: Vec3::ZERO, max: Vec3::ZERO })
}

pub(crate) fn check_count(elements: &'static str, count: usize) -> Result<(), MeshError> {
    match u32::try_from(count) {
        Ok(_) => Ok(()),
        Err(_) => Err(MeshError::TooMany { elements, count }),
    }
}

pub(crate) fn check_attribute(
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

/// Given normals scaled to unit length; those without a direction are replaced by the default weighting's.
fn kept_normals(mut given: Vec<Vec3>, positions: &[Vec3], indices: &[u32]) -> (Vec<Vec3>, NormalReport) {
    let mut without = Vec::new();
    for (vertex, n) in given.iter_mut().enumerate() {
        // In f64, where no finite f32 vector under- or overflows. A unit vector that was rounded to f32 is off by less
        // than 1e-7; it stays as it is, so that writing and reading gives the same bits.
        match n.as_dvec3().try_normalize() {
            Some(_) if (n.as_dvec3().length() - 1.0).abs() < 1e-7 => {}
            Some(unit) => *n = unit.as_vec3(),
            None => without.push(vertex),
        }
    }
    if without.is_empty() {
        return (given, NormalReport::default());
    }
    let points = Numbering::from_positions(positions);
    let (computed, _) = vertex_normals(positions, &points, indices, NormalWeighting::default());
    for &vertex in &without {
        given[vertex] = computed[vertex];
    }
    let report = NormalReport { replaced: without.len(), ..NormalReport::default() };
    (given, report)
}
