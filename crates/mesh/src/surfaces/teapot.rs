//! The Utah teapot.

use glam::{DVec3, Vec2};

use super::newell::PATCHES;
use super::tessellate::{Grids, Vertex, counts_for};
use super::{BezierPatch, Surface, SurfaceError, SurfaceField, SurfacePiece};
use crate::Mesh;

/// The Utah teapot, from Martin Newell's 32 bicubic Bézier patches (see the module `newell` for the source): rim, body,
/// handle, spout, lid with its knob, and bottom, with the normals of the patches.
///
/// It is rotated from Newell's Z up to Y up and scaled by three quarters: the spout points along +X, the handle along
/// −X; the axis of the body is the Y axis, the middle of the height lies on y = 0. It is 2.3625 high (y = ±1.18125),
/// its body 3 across, from the handle to the tip of the spout it reaches from x = −2.25 to x ≈ 2.57.
///
/// Each patch is a grid of `divisions` × `divisions` cells of two triangles; where a patch ends in a point, at the top
/// of the knob and in the middle of the bottom, the cells there have one. That makes 64 `divisions`² − 8 `divisions`
/// triangles, none of them degenerate; 52 for one division, where four would be. Vertices are not shared between
/// patches, since each patch has the whole texture; along an edge that two patches share they are bit-equal, so that
/// there are no cracks. As in Newell's model, the lid is not joined to the rim, and handle and spout end inside the
/// body.
///
/// ```
/// use halfway_mesh::{Mesh, Teapot};
///
/// let teapot = Mesh::from(Teapot::new(8));
/// assert_eq!(teapot.triangle_count(), 4032);
/// assert!(Teapot::for_chord_error(0.001).divisions > 8);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Teapot {
    /// How many cells an edge of a patch is cut into, 1 … [`Teapot::MAX_DIVISIONS`]; 8 by default.
    pub divisions: u32,
}

impl Default for Teapot {
    fn default() -> Self {
        Self::new(8)
    }
}

/// Newell's units to the mesh's.
const SCALE: f64 = 0.75;
/// Half of Newell's height.
const MIDDLE: f64 = 3.15 / 2.0;

impl Teapot {
    /// The most cells along an edge of a patch; more would be more than two million vertices.
    pub const MAX_DIVISIONS: u32 = 256;

    /// A teapot with this many cells along each edge of its patches.
    pub fn new(divisions: u32) -> Self {
        Self { divisions }
    }

    /// The coarsest teapot, approximately, whose triangles are nowhere further than `error` from its surface, as
    /// [`Tessellation::ChordError`](crate::Tessellation::ChordError) measures it; the finest one if none is as
    /// accurate.
    pub fn for_chord_error(error: f64) -> Self {
        let most = [Self::MAX_DIVISIONS; 2];
        let counts = patches().flat_map(|patch| counts_for(&patch.mapped(mesh_from_newell), error, most));
        Self { divisions: counts.max().unwrap_or(1) }
    }

    /// Checks the range of the divisions.
    ///
    /// # Errors
    /// The divisions are out of range.
    pub fn validate(&self) -> Result<(), SurfaceError> {
        self.divisions_field().check()
    }

    fn divisions_field(self) -> SurfaceField {
        SurfaceField::count("Teapot", "divisions", self.divisions, 1..=Self::MAX_DIVISIONS)
    }
}

/// From Newell's frame, Z up, to the mesh's, Y up.
fn mesh_from_newell(p: DVec3) -> DVec3 {
    DVec3::new(p.x, p.z - MIDDLE, -p.y) * SCALE
}

/// The patches in Newell's frame.
fn patches() -> impl Iterator<Item = BezierPatch> {
    PATCHES.iter().flat_map(|&(symmetry, points)| {
        let first = points.map(DVec3::from_array);
        std::iter::successors(Some(first), move |patch| Some(symmetry.next(patch)))
            .take(symmetry.count())
            .map(|points| BezierPatch::new(4, points.to_vec()).expect("four rows of four points in range"))
    })
}

impl From<Teapot> for Mesh {
    /// Divisions out of range are clamped, with a warning in the log; see [`Teapot::validate`].
    fn from(teapot: Teapot) -> Self {
        let n = teapot.divisions_field().nearest() as u32;
        let mut grids = Grids::default();
        for patch in patches() {
            grids.add(n, n, |u, v| {
                // All of Newell's patches wind so that ∂p/∂v × ∂p/∂u points outward, and none of his normals vanishes;
                // up is an arbitrary fallback.
                let normal = patch.normal(u, v).unwrap_or(DVec3::Z);
                Vertex {
                    position: mesh_from_newell(patch.position(u, v)).as_vec3(),
                    normal: DVec3::new(normal.x, normal.z, -normal.y).as_vec3(),
                    uv: Vec2::new(1.0 - v.value() as f32, u.value() as f32),
                }
            });
        }
        let surface = Surface::new(patches().map(|patch| SurfacePiece::Patch(patch.mapped(mesh_from_newell))));
        grids.mesh().expect("a patch has an area").with_surface(surface)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameter;

    const N: u32 = 10;

    fn grid() -> impl Iterator<Item = (u32, u32)> {
        (0..=N).flat_map(|i| (0..=N).map(move |j| (i, j)))
    }

    #[test]
    fn the_figures_are_whole() {
        let all: Vec<BezierPatch> = patches().collect();
        let row = |patch: usize, row: usize| all[patch].points()[4 * row..4 * row + 4].to_vec();
        let column = |patch: usize, column: usize| -> Vec<DVec3> {
            all[patch].points().iter().skip(column).step_by(4).copied().collect()
        };
        let mut first = 0;
        for (symmetry, _) in PATCHES {
            // The patches of a part go around: each ends where the next begins, and the last where the first does.
            let count = symmetry.count();
            for i in 0..count {
                assert_eq!(column(first + i, 3), column(first + (i + 1) % count, 0), "patch {}", first + i);
            }
            first += count;
        }
        assert_eq!(first, 32);
        // Rim to body, its upper half to its lower; both of the handle, of the spout, and the knob to the lid. The
        // bottom goes around the other way.
        for (upper, lower) in [(0, 4), (4, 8), (12, 14), (16, 18), (20, 24)] {
            assert_eq!(row(upper, 3), row(lower, 0), "patches {upper} and {lower}");
        }
        let rim = row(8, 3).into_iter().map(|p| p * DVec3::new(1.0, -1.0, 1.0)).collect::<Vec<_>>();
        assert_eq!(row(28, 3), rim);
    }

    #[test]
    fn normals_are_perpendicular_to_the_surface() {
        // Central differences of the surface itself: their error is of second order in the step, times the curvature
        // of Newell's tightest bends.
        let steps = 1_000_000;
        for (number, patch) in patches().enumerate() {
            for (i, j) in grid().filter(|(i, j)| (1..N).contains(i) && (1..N).contains(j)) {
                let at = |du: i32, dv: i32| {
                    let shifted =
                        |i: u32, d: i32| Parameter::fraction((i * (steps / N)).saturating_add_signed(d), steps);
                    patch.position(shifted(i, du), shifted(j, dv))
                };
                let difference = (at(0, 1) - at(0, -1)).cross(at(1, 0) - at(-1, 0)).normalize();
                let n = patch.normal(Parameter::fraction(i, N), Parameter::fraction(j, N)).unwrap();
                assert!(n.distance(difference) < 1e-8, "patch {number} at {i}, {j}: {n} {difference}");
            }
        }
    }

    #[test]
    fn normals_at_degenerate_ends_are_limits() {
        let (start, middle) = (Parameter::fraction(0, N), Parameter::fraction(1, 2));
        let pointed: Vec<BezierPatch> =
            patches().filter(|patch| patch.position(start, start) == patch.position(start, middle)).collect();
        for patch in &pointed {
            for j in 0..=N {
                let v = Parameter::fraction(j, N);
                let limit = patch.normal(start, v).unwrap();
                let near = patch.normal(Parameter::fraction(1, 1_000_000), v).unwrap();
                // One millionth of the way along, where the surface has turned by about as much.
                assert!(limit.distance(near) < 1e-5, "{limit} {near}");
                // Along the axis of the body, but for the rounding of tangents to 2⁻⁵³.
                assert!(limit.truncate().length() < 1e-14, "{limit}");
            }
        }
        // Four patches of the knob and four of the bottom.
        assert_eq!(pointed.len(), 8);
    }

    #[test]
    fn edges_run_alike_in_both_directions() {
        for n in [3, 7, 10, 100] {
            for i in 0..=n {
                let (there, back) = (Parameter::fraction(i, n), Parameter::fraction(n - i, n));
                for patch in patches() {
                    let rows = patch.points().chunks(4).flat_map(|row| row.iter().rev().copied());
                    let reversed = BezierPatch::new(4, rows.collect()).unwrap();
                    let u = Parameter::fraction(1, 3);
                    assert_eq!(patch.position(u, there), reversed.position(u, back));
                }
            }
        }
    }
}
