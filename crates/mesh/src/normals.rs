//! Face normals and vertex normals.
//!
//! Everything is computed in `f64` from the `f32` positions: differences of `f32` are exact there or nearly so, and
//! the products of the smallest and of the largest models (1e-18 … 1e18 units) neither underflow nor overflow.

use std::collections::HashMap;

use bevy_math::{DVec3, Vec3};

/// How a mesh gets its normals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Normals {
    /// As they are: the file's or the surface's own.
    #[default]
    Keep,
    /// The normal of the triangle at each of its corners. Vertices are no longer shared: three for every triangle.
    Face,
    /// The normalised weighted mean of the normals of the triangles around each vertex.
    Weighted(NormalWeighting),
}

/// The weight of a triangle's unit normal in the mean at one of its vertices.
///
/// Vertices at equal positions share their mean, so that a seam in the texture coordinates is not a seam in the shading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NormalWeighting {
    /// 1: the plain mean of the face normals (Gouraud 1971). Depends on how faces are cut into triangles.
    Uniform,
    /// The area of the triangle: large faces win.
    Area,
    /// The angle of the triangle at the vertex (Thürmer and Wüthrich 1998, "Computing vertex normals from polygonal
    /// facets"): independent of how flat faces are cut into triangles. The default.
    #[default]
    Angle,
    /// sin α / (|e₁| |e₂|), α the angle between the edges e₁ and e₂ at the vertex (Max 1999, "Weights for computing
    /// vertex normals from facet normals"): exact where the vertex and its neighbours lie on a sphere.
    Max,
}

/// What had to be left out or made up while normals were computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NormalReport {
    /// Triangles without a normal (see [`face_normal`]); they added nothing.
    pub degenerate_triangles: usize,
    /// Vertices whose mean vanished, as on a sheet folded onto itself; they took the normal of the largest triangle
    /// around them, the first in order among equals.
    pub cancelled: usize,
    /// Vertices of no triangle, or of degenerate triangles alone; they took +Y.
    pub without_face: usize,
    /// Given normals of zero length that the default weighting's normal replaced.
    pub replaced: usize,
}

impl NormalReport {
    /// Whether nothing had to be left out or made up.
    pub fn is_clean(&self) -> bool {
        *self == Self::default()
    }
}

/// A triangle is degenerate where its height above its longest edge is at most this fraction of that edge. It is one
/// rounding step of `f32`: below it the direction of the normal says how the corners were rounded and nothing else.
const DEGENERATE_HEIGHT: f64 = f32::EPSILON as f64;

/// A mean is taken to have vanished where its length is at most this fraction of the sum of the weights; a few
/// rounding steps of the `f32` positions.
const CANCELLED: f64 = 1e-6;

/// The unit normal of the triangle, toward the side from which its corners wind counter-clockwise:
/// (p₁ − p₀) × (p₂ − p₀), normalised.
///
/// `None` where the triangle is degenerate: two corners coincide, all lie on a line, or the height above the longest
/// edge is at most 2⁻²³ of that edge; and where a coordinate is not finite. Safe at any scale of `f32`.
pub fn face_normal(p0: Vec3, p1: Vec3, p2: Vec3) -> Option<Vec3> {
    Face::new([p0, p1, p2]).map(|face| face.n.as_vec3())
}

/// A triangle that has a normal.
struct Face {
    /// Unit normal.
    n: DVec3,
    /// Twice the area.
    area2: f64,
    /// The edge that leaves each corner.
    edges: [DVec3; 3],
}

impl Face {
    fn new(corners: [Vec3; 3]) -> Option<Self> {
        let [p0, p1, p2] = corners.map(Vec3::as_dvec3);
        let edges = [p1 - p0, p2 - p1, p0 - p2];
        let longest2 = edges.iter().fold(0.0_f64, |most, e| most.max(e.length_squared()));
        let cross = edges[0].cross(-edges[2]);
        let area2 = cross.length();
        // Not `area2 <= …`: NaN must end here too.
        (area2 > DEGENERATE_HEIGHT * longest2 && area2.is_finite()).then(|| Self { n: cross / area2, area2, edges })
    }

    fn weight(&self, corner: usize, weighting: NormalWeighting) -> f64 {
        let (e1, e2) = (self.edges[corner], -self.edges[(corner + 2) % 3]);
        match weighting {
            NormalWeighting::Uniform => 1.0,
            NormalWeighting::Area => 0.5 * self.area2,
            NormalWeighting::Angle => self.area2.atan2(e1.dot(e2)),
            NormalWeighting::Max => self.area2 / (e1.length_squared() * e2.length_squared()),
        }
    }
}

/// The sum at one position.
#[derive(Clone, Copy, Default)]
struct Mean {
    sum: DVec3,
    weights: f64,
    largest: DVec3,
    largest_area2: f64,
}

impl Mean {
    fn add(&mut self, face: &Face, weight: f64) {
        self.sum += face.n * weight;
        self.weights += weight;
        if face.area2 > self.largest_area2 {
            self.largest = face.n;
            self.largest_area2 = face.area2;
        }
    }

    fn normal(&self, report: &mut NormalReport) -> Vec3 {
        let length = self.sum.length();
        if self.largest_area2 == 0.0 {
            report.without_face += 1;
            Vec3::Y
        } else if length > CANCELLED * self.weights {
            (self.sum / length).as_vec3()
        } else {
            report.cancelled += 1;
            self.largest.as_vec3()
        }
    }
}

/// One number for every position: the vertices at equal positions have the same. Also says how many there are.
pub(crate) fn position_groups(positions: &[Vec3]) -> (Vec<u32>, usize) {
    let mut seen = HashMap::with_capacity(positions.len());
    let groups = positions
        .iter()
        .map(|p| {
            // Adding 0 makes −0 and 0 one.
            let key = (*p + Vec3::ZERO).to_array().map(f32::to_bits);
            let next = seen.len() as u32;
            *seen.entry(key).or_insert(next)
        })
        .collect();
    (groups, seen.len())
}

/// The normals of all vertices. `indices` has three a triangle, all in range.
pub(crate) fn vertex_normals(
    positions: &[Vec3],
    indices: &[u32],
    weighting: NormalWeighting,
) -> (Vec<Vec3>, NormalReport) {
    let mut report = NormalReport::default();
    let (groups, count) = position_groups(positions);
    let mut means = vec![Mean::default(); count];
    for triangle in indices.as_chunks::<3>().0 {
        let Some(face) = Face::new(triangle.map(|i| positions[i as usize])) else {
            report.degenerate_triangles += 1;
            continue;
        };
        for (corner, &vertex) in triangle.iter().enumerate() {
            let weight = face.weight(corner, weighting);
            means[groups[vertex as usize] as usize].add(&face, weight);
        }
    }
    let normals = groups.iter().map(|&group| means[group as usize].normal(&mut report)).collect();
    (normals, report)
}

/// The normal of every triangle, +Y for the degenerate ones, and what was made up.
pub(crate) fn face_normals(positions: &[Vec3], indices: &[u32]) -> (Vec<Vec3>, NormalReport) {
    let mut report = NormalReport::default();
    let normals = indices
        .as_chunks::<3>()
        .0
        .iter()
        .map(|triangle| {
            let [p0, p1, p2] = triangle.map(|i| positions[i as usize]);
            face_normal(p0, p1, p2).unwrap_or_else(|| {
                report.degenerate_triangles += 1;
                Vec3::Y
            })
        })
        .collect();
    (normals, report)
}
