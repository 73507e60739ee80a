//! The surface that a mesh stands for.

use std::sync::Arc;

use glam::{DMat4, DVec3, DVec4};

use super::{BezierPatch, Disc, SurfaceError};

/// The smooth surface that a mesh stands for, known by formula, in the mesh's own space: a list of pieces. Each piece
/// has an outward side, on which the mesh's normals are.
///
/// Clones share the pieces.
///
/// ```
/// use halfway_mesh::{Mesh, SurfacePiece, UvSphere};
///
/// // However coarse the mesh, it knows that it is a sphere.
/// let mesh = Mesh::from(UvSphere::new(1.0, 8, 4));
/// let surface = mesh.surface().expect("spheres are quadrics");
/// assert!(matches!(surface.pieces(), [SurfacePiece::Quadric(_)]));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    pieces: Arc<[SurfacePiece]>,
}

/// A piece of a [`Surface`].
#[derive(Clone, Debug, PartialEq)]
pub enum SurfacePiece {
    /// A part of a sphere, a cylinder, a paraboloid …
    Quadric(Quadric),
    /// A flat disc, as at the ends of a cylinder.
    Disc(Disc),
    /// A polynomial patch.
    Patch(BezierPatch),
}

impl Surface {
    /// The surface of these pieces.
    pub fn new(pieces: impl IntoIterator<Item = SurfacePiece>) -> Self {
        Self { pieces: pieces.into_iter().collect() }
    }

    /// Its pieces.
    pub fn pieces(&self) -> &[SurfacePiece] {
        &self.pieces
    }
}

impl From<Quadric> for Surface {
    fn from(quadric: Quadric) -> Self {
        Self::new([SurfacePiece::Quadric(quadric)])
    }
}

/// The part of a quadric inside a box whose edges lie along the axes.
///
/// With p = (x, y, z, 1) the quadric is where f = pᵀ Q p = 0. f is negative inside, and its gradient points outward.
///
/// ```
/// use glam::{DMat4, DVec3, DVec4};
/// use halfway_mesh::Quadric;
///
/// // x² + y² + z² − 1, the unit sphere; its upper half.
/// let matrix = DMat4::from_diagonal(DVec4::new(1.0, 1.0, 1.0, -1.0));
/// let half = Quadric::new(matrix, DVec3::new(-1.0, 0.0, -1.0), DVec3::ONE)?;
/// assert_eq!(half.value(DVec3::ZERO), -1.0);
/// assert_eq!(half.gradient(DVec3::Y), DVec3::new(0.0, 2.0, 0.0));
/// # Ok::<(), halfway_mesh::SurfaceError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadric {
    matrix: DMat4,
    min: DVec3,
    max: DVec3,
}

impl Quadric {
    /// The part of the quadric of matrix Q from `min` to `max`, both included.
    ///
    /// # Errors
    /// A number that is not finite, or a `min` above the `max`.
    pub fn new(matrix: DMat4, min: DVec3, max: DVec3) -> Result<Self, SurfaceError> {
        let error = |field, value, expected: &str| {
            Err(SurfaceError { surface: "Quadric", field, value, expected: expected.to_owned() })
        };
        let numbers = [("min", &min.to_array()[..]), ("max", &max.to_array()), ("matrix", &matrix.to_cols_array())];
        for (field, values) in numbers {
            if let Some(&bad) = values.iter().find(|x| !x.is_finite()) {
                return error(field, bad, "finite numbers are expected");
            }
        }
        if let Some(i) = (0..3).find(|&i| min[i] > max[i]) {
            return error("min", min[i], "at most the max is expected");
        }
        Ok(Self::within(matrix, min, max))
    }

    /// From values that are known to be valid.
    pub(super) fn within(matrix: DMat4, min: DVec3, max: DVec3) -> Self {
        // The skew part of a matrix adds nothing to pᵀ Q p, and would spoil the gradient.
        Self { matrix: (matrix + matrix.transpose()) * 0.5, min, max }
    }

    /// The sphere about the origin; the radius is positive.
    pub(super) fn sphere(radius: f64) -> Self {
        let matrix = DMat4::from_diagonal(DVec3::ONE.extend(-radius * radius));
        Self::within(matrix, DVec3::splat(-radius), DVec3::splat(radius))
    }

    /// Q, symmetric.
    pub fn matrix(&self) -> DMat4 {
        self.matrix
    }

    /// The corner of the box with the least coordinates.
    pub fn min(&self) -> DVec3 {
        self.min
    }

    /// The corner of the box with the greatest coordinates.
    pub fn max(&self) -> DVec3 {
        self.max
    }

    /// f(p): negative inside, 0 on the surface.
    pub fn value(&self, p: DVec3) -> f64 {
        let p: DVec4 = p.extend(1.0);
        p.dot(self.matrix * p)
    }

    /// ∇f(p), outward where p is on the surface.
    pub fn gradient(&self, p: DVec3) -> DVec3 {
        2.0 * (self.matrix * p.extend(1.0)).truncate()
    }
}
