//! A box.

use glam::{Vec2, Vec3};

use super::{SurfaceError, SurfaceField, grid_indices};
use crate::Mesh;

/// A box with edges along the axes, centred on the origin.
///
/// Each of its six faces has four vertices of its own, two triangles, and the whole texture, upright on the sides.
///
/// ```
/// use halfway_mesh::{Cuboid, Mesh};
///
/// let brick = Mesh::from(Cuboid::new(2.0, 0.5, 1.0));
/// assert_eq!((brick.positions().len(), brick.triangle_count()), (24, 12));
/// assert!((brick.report().volume - 1.0).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// The lengths of the edges along x, y and z, each 1e-30 … 1e30; 1 by default.
    pub size: Vec3,
}

impl Default for Cuboid {
    fn default() -> Self {
        Self { size: Vec3::ONE }
    }
}

impl Cuboid {
    /// A box with edges of these lengths.
    pub fn new(x: f32, y: f32, z: f32) -> Self {
        Self { size: Vec3::new(x, y, z) }
    }

    /// Checks the ranges of the lengths.
    ///
    /// # Errors
    /// Names the first length out of range.
    pub fn validate(&self) -> Result<(), SurfaceError> {
        self.fields().iter().try_for_each(SurfaceField::check)
    }

    fn fields(self) -> [SurfaceField; 3] {
        let field = |name, value| SurfaceField::length("Cuboid", name, value);
        [field("size.x", self.size.x), field("size.y", self.size.y), field("size.z", self.size.z)]
    }
}

/// Each face by its normal and the direction of the texture's u; its v runs along u × n, which is down on the sides.
const FACES: [(Vec3, Vec3); 6] = [
    (Vec3::X, Vec3::NEG_Z),
    (Vec3::NEG_X, Vec3::Z),
    (Vec3::Y, Vec3::X),
    (Vec3::NEG_Y, Vec3::X),
    (Vec3::Z, Vec3::X),
    (Vec3::NEG_Z, Vec3::NEG_X),
];

impl From<Cuboid> for Mesh {
    /// Lengths out of range are clamped, with a warning in the log; see [`Cuboid::validate`].
    fn from(cuboid: Cuboid) -> Self {
        let half = Vec3::from_array(cuboid.fields().map(|field| field.nearest() as f32)) * 0.5;
        let corners = [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE];
        let mut positions = Vec::with_capacity(24);
        let mut normals = Vec::with_capacity(24);
        let mut uvs = Vec::with_capacity(24);
        let mut indices = Vec::with_capacity(36);
        for (n, along_u) in FACES {
            let along_v = along_u.cross(n);
            let first = positions.len() as u32;
            for uv in corners {
                let unit = n + along_u * (2.0 * uv.x - 1.0) + along_v * (2.0 * uv.y - 1.0);
                positions.push(unit * half);
                normals.push(n);
                uvs.push(uv);
            }
            indices.extend(grid_indices(1, 1).iter().map(|i| first + i));
        }
        Mesh::checked(positions, normals, Some(uvs), indices)
    }
}
