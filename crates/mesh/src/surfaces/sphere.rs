//! The sphere by longitude and latitude.

use glam::{DVec3, Vec2};

use super::parameter::{half_turn, turn};
use super::{Parameter, Quadric, SurfaceError, SurfaceField};
use crate::Mesh;

/// A sphere about the origin, cut along meridians and parallels; its poles lie on the Y axis.
///
/// Parallel j of `rings` has the polar angle θ = πj / `rings` from +Y, meridian i of `segments` the longitude
/// φ = 2πi / `segments` from +X toward +Z; the normal is n = (sin θ cos φ, cos θ, sin θ sin φ), the position
/// `radius`·n. That makes (`segments` + 1)·(`rings` + 1) vertices, parallel by parallel: the poles and the first
/// meridian are repeated, at bit-equal positions, because they have several texture coordinates. With a and b = a + 1
/// on one parallel and c, d under them on the next, a cell has the triangles (a, b, d), but not at the north pole, and
/// (a, d, c), but not at the south pole: 2·`segments`·(`rings` − 1) in all, none of them degenerate.
///
/// A texture is wrapped around once, with its top at +Y and upright as seen from outside: its coordinates are
/// (1 − i / `segments`, j / `rings`).
///
/// ```
/// use halfway_mesh::{Mesh, UvSphere};
///
/// let ball = Mesh::from(UvSphere::new(0.5, 32, 16));
/// assert_eq!(ball.triangle_count(), 2 * 32 * 15);
/// assert!(ball.uvs().is_some() && ball.surface().is_some());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvSphere {
    /// The radius, 1e-30 … 1e30; 1 by default.
    pub radius: f32,
    /// The number of meridians, 3 … [`UvSphere::MAX_SEGMENTS`]; 32 by default.
    pub segments: u32,
    /// The number of bands between parallels, 2 … [`UvSphere::MAX_RINGS`]; 16 by default.
    pub rings: u32,
}

impl Default for UvSphere {
    fn default() -> Self {
        Self { radius: 1.0, segments: 32, rings: 16 }
    }
}

impl UvSphere {
    /// The most meridians; more would be more than eight million vertices.
    pub const MAX_SEGMENTS: u32 = 4096;
    /// The most bands.
    pub const MAX_RINGS: u32 = 2048;

    /// A sphere of this radius with so many meridians and bands.
    pub fn new(radius: f32, segments: u32, rings: u32) -> Self {
        Self { radius, segments, rings }
    }

    /// Checks the ranges of the fields.
    ///
    /// # Errors
    /// Names the first field out of range.
    pub fn validate(&self) -> Result<(), SurfaceError> {
        self.fields().iter().try_for_each(SurfaceField::check)
    }

    fn fields(self) -> [SurfaceField; 3] {
        [
            SurfaceField::length("UvSphere", "radius", self.radius),
            SurfaceField::count("UvSphere", "segments", self.segments, 3..=Self::MAX_SEGMENTS),
            SurfaceField::count("UvSphere", "rings", self.rings, 2..=Self::MAX_RINGS),
        ]
    }
}

impl From<UvSphere> for Mesh {
    /// Fields out of range are clamped, with a warning in the log; see [`UvSphere::validate`].
    fn from(sphere: UvSphere) -> Self {
        let [radius, segments, rings] = sphere.fields().map(|field| field.nearest());
        let (segments, rings) = (segments as u32, rings as u32);
        let meridians: Vec<(f64, f64)> = (0..=segments).map(|i| turn(Parameter::fraction(i, segments))).collect();
        let count = meridians.len() * (rings as usize + 1);
        let mut positions = Vec::with_capacity(count);
        let mut normals = Vec::with_capacity(count);
        let mut uvs = Vec::with_capacity(count);
        for j in 0..=rings {
            let (sin_theta, cos_theta) = half_turn(Parameter::fraction(j, rings));
            for (i, (sin_phi, cos_phi)) in meridians.iter().enumerate() {
                let n = DVec3::new(sin_theta * cos_phi, cos_theta, sin_theta * sin_phi);
                positions.push((n * radius).as_vec3());
                normals.push(n.as_vec3());
                uvs.push(Vec2::new(1.0 - i as f32 / segments as f32, j as f32 / rings as f32));
            }
        }
        Mesh::checked(positions, normals, Some(uvs), indices(segments, rings))
            .with_surface(Quadric::sphere(radius).into())
    }
}

fn indices(segments: u32, rings: u32) -> Vec<u32> {
    let mut indices = Vec::with_capacity(6 * segments as usize * (rings as usize - 1));
    for j in 0..rings {
        for i in 0..segments {
            let a = j * (segments + 1) + i;
            let (b, c, d) = (a + 1, a + segments + 1, a + segments + 2);
            if j > 0 {
                indices.extend([a, b, d]);
            }
            if j < rings - 1 {
                indices.extend([a, d, c]);
            }
        }
    }
    indices
}
