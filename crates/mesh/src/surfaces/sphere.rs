//! The sphere by longitude and latitude.

use std::f64::consts::PI;

use bevy_math::{DVec3, Vec2};

use super::{Field, SurfaceError};
use crate::Mesh;

/// A sphere about the origin, cut along meridians and parallels; its poles lie on the Y axis.
///
/// Parallel j of `rings` has the polar angle θ = πj / `rings` from +Y, meridian i of `segments` the longitude
/// φ = 2πi / `segments` from +X toward +Z; the normal is n = (sin θ cos φ, cos θ, sin θ sin φ), the position
/// `radius`·n. That makes (`segments` + 1)·(`rings` + 1) vertices, parallel by parallel: the poles and the first
/// meridian are repeated, at bit-equal positions, for the sake of the texture coordinates. With a and b = a + 1 on one
/// parallel and c, d under them on the next, a cell has the triangles (a, b, d), but not at the north pole, and
/// (a, d, c), but not at the south pole: 2·`segments`·(`rings` − 1) in all, none of them degenerate.
///
/// A texture is wrapped around once, with its top at +Y and upright as seen from outside: its coordinates are
/// (1 − i / `segments`, j / `rings`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvSphere {
    /// The radius, 1e-30 … 1e30; 1 by default.
    pub radius: f32,
    /// How many meridians, 3 … [`UvSphere::MAX_SEGMENTS`]; 32 by default.
    pub segments: u32,
    /// How many bands between parallels, 2 … [`UvSphere::MAX_RINGS`]; 16 by default.
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

    /// A sphere of this radius, meridians and bands.
    pub fn new(radius: f32, segments: u32, rings: u32) -> Self {
        Self { radius, segments, rings }
    }

    /// Whether the fields are in their ranges.
    ///
    /// # Errors
    /// The first field that is not.
    pub fn validate(&self) -> Result<(), SurfaceError> {
        self.radius_field().check()?;
        self.segments_field().check(3..=Self::MAX_SEGMENTS)?;
        self.rings_field().check(2..=Self::MAX_RINGS)
    }

    fn radius_field(self) -> Field<f32> {
        Field { surface: "UvSphere", name: "radius", value: self.radius }
    }

    fn segments_field(self) -> Field<u32> {
        Field { surface: "UvSphere", name: "segments", value: self.segments }
    }

    fn rings_field(self) -> Field<u32> {
        Field { surface: "UvSphere", name: "rings", value: self.rings }
    }
}

/// Sine and cosine of i/n of a turn. Exact at the quarters, and the last is the first to the bit: sin π is not 0 in
/// floating point, and poles and seams must close.
fn turn(i: u32, n: u32) -> (f64, f64) {
    let i = i % n;
    match (4 * i) / n {
        quarter if (4 * i).is_multiple_of(n) => [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][quarter as usize],
        _ => (2.0 * PI * f64::from(i) / f64::from(n)).sin_cos(),
    }
}

impl From<UvSphere> for Mesh {
    /// Fields out of range are taken at their nearest value in range, with a warning in the log; see
    /// [`UvSphere::validate`].
    fn from(sphere: UvSphere) -> Self {
        let radius = f64::from(sphere.radius_field().nearest());
        let segments = sphere.segments_field().nearest(3..=UvSphere::MAX_SEGMENTS);
        let rings = sphere.rings_field().nearest(2..=UvSphere::MAX_RINGS);

        let meridians: Vec<(f64, f64)> = (0..=segments).map(|i| turn(i, segments)).collect();
        let count = meridians.len() * (rings as usize + 1);
        let mut positions = Vec::with_capacity(count);
        let mut normals = Vec::with_capacity(count);
        let mut uvs = Vec::with_capacity(count);
        for j in 0..=rings {
            let (sin_theta, cos_theta) = turn(j, 2 * rings);
            for (i, (sin_phi, cos_phi)) in meridians.iter().enumerate() {
                let n = DVec3::new(sin_theta * cos_phi, cos_theta, sin_theta * sin_phi);
                positions.push((n * radius).as_vec3());
                normals.push(n.as_vec3());
                uvs.push(Vec2::new(1.0 - i as f32 / segments as f32, j as f32 / rings as f32));
            }
        }
        Mesh::checked(positions, normals, Some(uvs), indices(segments, rings))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarters_of_a_turn_are_exact() {
        for n in [3, 4, 8, 12, 512] {
            assert_eq!(turn(0, n), (0.0, 1.0));
            assert_eq!(turn(n, n), turn(0, n));
            for i in 0..n {
                let (sin, cos) = turn(i, n);
                let angle = 2.0 * PI * f64::from(i) / f64::from(n);
                // sin and cos of the rounded angle are off by at most half a rounding step of the angle (< 2π).
                assert!((sin - angle.sin()).abs() < 1e-15 && (cos - angle.cos()).abs() < 1e-15);
            }
        }
    }
}
