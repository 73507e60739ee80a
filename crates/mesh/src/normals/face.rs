//! The normal of one triangle, and its weights.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::NormalWeighting;

/// A triangle is degenerate if its height above its longest edge is at most this fraction of that edge. It is one
/// rounding step of `f32`: below it the direction of the normal depends on the rounding of the corners alone.
const DEGENERATE_HEIGHT: f64 = f32::EPSILON as f64;

/// The unit normal of the triangle, toward the side from which its corners wind counter-clockwise:
/// (p₁ − p₀) × (p₂ − p₀), normalised.
///
/// `None` for degenerate triangles: two corners coincide, all lie on a line, or the height above the longest edge is at
/// most 2⁻²³ of that edge; and where a coordinate is not finite. Safe at any scale of `f32`.
///
/// ```
/// use glam::Vec3;
/// use halfway_mesh::face_normal;
///
/// assert_eq!(face_normal(Vec3::ZERO, Vec3::X, Vec3::Y), Some(Vec3::Z));
/// assert_eq!(face_normal(Vec3::ZERO, Vec3::X, 2.0 * Vec3::X), None);
/// ```
pub fn face_normal(p0: Vec3, p1: Vec3, p2: Vec3) -> Option<Vec3> {
    Face::new([p0, p1, p2]).map(|face| face.n.as_vec3())
}

/// A triangle that has a normal.
pub(super) struct Face {
    /// Unit normal.
    pub(super) n: DVec3,
    /// Twice the area.
    pub(super) area2: f64,
    /// The edge that leaves each corner.
    edges: [DVec3; 3],
}

impl Face {
    // ANCHOR: face
    pub(super) fn new(corners: [Vec3; 3]) -> Option<Self> {
        let [p0, p1, p2] = corners.map(Vec3::as_dvec3);
        let edges = [p1 - p0, p2 - p1, p0 - p2];
        let longest2 = edges.iter().fold(0.0_f64, |most, e| most.max(e.length_squared()));
        let cross = edges[0].cross(-edges[2]);
        let area2 = cross.length();
        // Not `area2 <= …`: NaN must be refused too.
        (area2 > DEGENERATE_HEIGHT * longest2 && area2.is_finite()).then(|| Self {
            n: cross * area2.recip(),
            area2,
            edges,
        })
    }
    // ANCHOR_END: face

    // ANCHOR: weights
    /// The weights at its corners, all positive.
    pub(super) fn weights(&self, weighting: NormalWeighting) -> [f64; 3] {
        match weighting {
            NormalWeighting::Uniform => [1.0; 3],
            NormalWeighting::Area => [0.5 * self.area2; 3],
            NormalWeighting::Angle => [0, 1, 2].map(|corner| {
                let (e1, e2) = self.sides(corner);
                self.area2.atan2(e1.dot(e2))
            }),
            NormalWeighting::Max => [0, 1, 2].map(|corner| {
                let (e1, e2) = self.sides(corner);
                self.area2 / (e1.length_squared() * e2.length_squared())
            }),
        }
    }
    // ANCHOR_END: weights

    /// The two edges that leave a corner.
    fn sides(&self, corner: usize) -> (DVec3, DVec3) {
        (self.edges[corner], -self.edges[(corner + 2) % 3])
    }
}

/// The normal of every triangle, zero for the degenerate ones.
pub(crate) fn face_normals(positions: &[Vec3], indices: &[u32]) -> Vec<Vec3> {
    let triangles = indices.as_chunks::<3>().0;
    let normal = |triangle: &[u32; 3]| {
        let [p0, p1, p2] = triangle.map(|i| positions[i as usize]);
        face_normal(p0, p1, p2).unwrap_or(Vec3::ZERO)
    };
    triangles.par_iter().with_min_len(PARALLEL_MIN).map(normal).collect()
}

/// Fewer triangles than this do not pay for another thread.
pub(super) const PARALLEL_MIN: usize = 1 << 12;
