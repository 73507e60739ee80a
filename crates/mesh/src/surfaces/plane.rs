//! A flat square.

use glam::{DVec3, Vec2, Vec3};

use super::parameter::uv_at;
use super::{Parameter, ParametricSurface, SurfaceError, SurfaceField, SurfacePiece, SurfacePoint, grid_indices};
use crate::Mesh;

/// A flat square in the plane y = 0, centred on the origin, that faces +Y.
///
/// Vertices lie row by row from −z to +z, in a row from −x to +x; texture coordinates run from (0, 0) at (−x, −z) to
/// (1, 1) at (+x, +z). A cell with the vertices a b in one row and c d in the next has the triangles (a, c, b) and
/// (b, c, d).
///
/// ```
/// use halfway_mesh::{Mesh, Plane};
///
/// let floor = Mesh::from(Plane { size: 20.0, divisions: 4 });
/// assert_eq!((floor.triangle_count(), floor.bounds().max.x), (32, 10.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// The length of an edge, 1e-30 … 1e30; 1 by default.
    pub size: f32,
    /// How many cells an edge is cut into, 1 … [`Plane::MAX_DIVISIONS`]; 1 by default.
    pub divisions: u32,
}

impl Default for Plane {
    fn default() -> Self {
        Self { size: 1.0, divisions: 1 }
    }
}

impl Plane {
    /// The most cells along an edge; more would be more than four million vertices.
    pub const MAX_DIVISIONS: u32 = 2048;

    /// Checks the ranges of the fields.
    ///
    /// # Errors
    /// Names the first field out of range.
    pub fn validate(&self) -> Result<(), SurfaceError> {
        self.fields().iter().try_for_each(SurfaceField::check)
    }

    fn fields(self) -> [SurfaceField; 2] {
        [
            SurfaceField::length("Plane", "size", self.size),
            SurfaceField::count("Plane", "divisions", self.divisions, 1..=Self::MAX_DIVISIONS),
        ]
    }
}

impl From<Plane> for Mesh {
    /// Fields out of range are clamped, with a warning in the log; see [`Plane::validate`].
    fn from(plane: Plane) -> Self {
        let [size, divisions] = plane.fields().map(|field| field.nearest());
        let n = divisions as u32;
        let along = |i: u32| f64::from(i) / f64::from(n);
        let at = |i: u32| (size * (along(i) - 0.5)) as f32;
        let grid = || (0..=n).flat_map(move |j| (0..=n).map(move |i| (i, j)));
        let positions: Vec<Vec3> = grid().map(|(i, j)| Vec3::new(at(i), 0.0, at(j))).collect();
        let uvs = grid().map(|(i, j)| Vec2::new(along(i) as f32, along(j) as f32)).collect();
        let normals = vec![Vec3::Y; positions.len()];
        Mesh::checked(positions, normals, Some(uvs), grid_indices(n, n))
    }
}

/// u runs from −z to +z, v from +x to −x. The divisions are used by `Mesh::from` only.
impl ParametricSurface for Plane {
    fn at(&self, u: Parameter, v: Parameter) -> SurfacePoint {
        let size = f64::from(self.size);
        SurfacePoint {
            position: size * DVec3::new(v.before_middle(), 0.0, -u.before_middle()),
            du: size * DVec3::Z,
            dv: size * DVec3::NEG_X,
            normal: DVec3::Y,
            uv: uv_at(u, v),
        }
    }

    fn validate(&self) -> Result<(), SurfaceError> {
        Self::validate(self)
    }

    /// None: its mesh is exact.
    fn pieces(&self) -> Option<Vec<SurfacePiece>> {
        None
    }
}
