//! How far coarse triangles are from the fine ones that they stand for: the largest differences, and not samples of
//! them.

use bevy_math::{DVec3, Vec3A};

use super::box_grid::BoxGrid;
use super::clip::{ClippedPart, PartCorner};
use super::deviation::Deviation;
use super::fine_surface::{FineSurface, Surfaces};
use super::frame::Frame;
use super::homes::Homes;
use super::uncovered::{FineHomes, Uncovered};
use crate::Mesh;
use crate::prepare::nearest::TriangleCorners;

impl Mesh {
    pub(super) fn corners(&self, triangle: [u32; 3]) -> TriangleCorners {
        triangle.map(|vertex| self.positions()[vertex as usize].as_dvec3())
    }

    pub(super) fn corner_normals(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        triangle.map(|vertex| self.normals()[vertex as usize].as_dvec3())
    }
}

/// What is known of where the fine surface is.
pub(super) struct Overlay {
    pub(super) deviation: Deviation,
    /// Of each run of coarse triangles the fine ones that lie over or near it, in ascending order.
    pub(super) near: Vec<Vec<u32>>,
    /// For each covered vertex, a coarse triangle that lies nearest to it, or nearly.
    pub(super) homes: Vec<u32>,
}

impl Surfaces<'_> {
    /// Bounds the distance of the surfaces.
    ///
    /// Each coarse triangle is compared with the fine ones that lie over it along the mean normal of the surface there
    /// ([`Frame`]): clipped by its sides, they have parts over which both surfaces are linear, so that the distance
    /// along that normal and the difference of the interpolated normals are largest at corners of the parts (as in
    /// Bajaj and Schikore 1996, "Error-bounded reduction of triangle meshes with multivariate data"). A fine triangle
    /// is not clipped where they are no larger at its own corners than what was found before. The parts have to fill
    /// the triangle once ([how that is seen](FineSurface::covers_once)); they are found from its corners on, over
    /// edges, and if these do not fill it, among all by place. Where none do, the distance from the nearest ones bounds
    /// it ([`Uncovered`]), both ways.
    ///
    /// The other way round, what lies over no coarse triangle lies in a wedge at an edge. The distance from the edge is
    /// convex, so over a part of a fine triangle it is largest at a corner: at a side of a coarse triangle, which has
    /// been looked at, or at a vertex of the fine surface, whose distance is found by itself.
    ///
    /// What is less than `known` is not looked for, and the bounds are no less. `slots` has `u32::MAX` for every vertex
    /// of the mesh, before and after.
    pub(super) fn overlay(&self, known: Deviation, slots: &mut [u32]) -> Overlay {
        let (mut fine, coarse) = FineSurface::new(self, slots);
        let mut homes = Homes::new(self.covered.len());
        for (number, corners) in (0..).zip(&coarse) {
            for &vertex in corners {
                homes.see(vertex, [0, number], 0.0);
            }
        }
        let corners: Vec<TriangleCorners> = self.coarse.iter().map(|&triangle| self.mesh.corners(triangle)).collect();
        let mut grid: Option<BoxGrid> = None;
        // Of each fine triangle the run that it lay near last.
        let mut near_run = vec![u32::MAX; fine.triangles.len()];
        let mut near = vec![Vec::new(); self.runs.len()];
        let mut near_this = Vec::new();
        let mut run = 0;
        let known = Differences { distance: known.distance, sine2: sine2_of(known.angle) };
        let mut look = Look { most: known, part: ClippedPart::default() };
        let mut uncovered = Vec::new();
        for ((number, &triangle), (own, &corners)) in (0..).zip(self.coarse).zip(coarse.iter().zip(&corners)) {
            if self.runs.get(run).is_some_and(|run| run.end <= number as usize) {
                run += 1;
            }
            near_this.clear();
            let frame = Frame::new(corners, self.mesh.corner_normals(triangle), fine.outward(*own));
            let is_same = fine.begin(*own, number);
            let is_known = if is_same {
                near_this.extend_from_slice(fine.waiting());
                true
            } else if let Some(frame) = &frame {
                fine.spread(frame, number, &mut near_this);
                look.over(frame, number, &mut fine, &mut homes) || {
                    // Once more with all that lies near, also where no edge leads.
                    let grid = grid.get_or_insert_with(|| self.grid());
                    near_this.clear();
                    fine.look_at_all(grid, corners, frame, number, &mut near_this);
                    look.over(frame, number, &mut fine, &mut homes)
                }
            } else {
                false
            };
            for &at in &near_this {
                if std::mem::replace(&mut near_run[at as usize], run as u32) != run as u32 {
                    near[run].push(at);
                }
            }
            if !is_known {
                uncovered.push(Uncovered { coarse: number, near: near_this.clone() });
            }
        }
        let (farthest, homes) = homes.farthest(&fine.positions, &corners);
        let deviation = look.most.deviation().max(Deviation { distance: farthest, angle: 0.0 });
        // Last, so that least of it is looked for.
        let fine = FineHomes { triangles: &fine.triangles, homes: &homes, farthest };
        let deviation = self.with_uncovered(deviation, &uncovered, &fine);
        for of_run in &mut near {
            of_run.sort_unstable();
        }
        Overlay { deviation, near, homes }
    }

    /// The fine triangles, found by place.
    fn grid(&self) -> BoxGrid {
        BoxGrid::new(&self.fine.iter().map(|&triangle| box_around(self.mesh, triangle)).collect::<Vec<_>>())
    }
}

/// The square of the sine of an angle; infinite from a right angle on.
fn sine2_of(angle: f64) -> f64 {
    if angle < std::f64::consts::FRAC_PI_2 { angle.sin().powi(2) } else { f64::INFINITY }
}

/// How far surfaces are apart at most.
#[derive(Clone, Copy, Default)]
struct Differences {
    distance: f64,
    /// The square of the sine of an angle that no normal is turned by more than, if less than 1.
    sine2: f64,
}

impl Differences {
    fn max(self, other: Self) -> Self {
        Self { distance: self.distance.max(other.distance), sine2: self.sine2.max(other.sine2) }
    }

    fn deviation(self) -> Deviation {
        let angle = if self.sine2 < 1.0 { self.sine2.sqrt().asin() } else { std::f64::consts::PI };
        Deviation { distance: self.distance, angle }
    }

    /// Over a part of a fine triangle with these heights and normals.
    fn of_part(frame: &Frame, part: &[PartCorner], [h0, h1, h2]: [f64; 3], [n0, n1, n2]: [DVec3; 3]) -> Self {
        let (to_h1, to_h2, to_n1, to_n2) = (h1 - h0, h2 - h0, n1 - n0, n2 - n0);
        let (mut distance, mut most, mut least) = (0.0_f64, 0.0_f64, f64::INFINITY);
        for &PartCorner { coarse, fine } in part {
            distance = distance.max((h0 + fine.x * to_h1 + fine.y * to_h2).abs());
            let n = n0 + fine.x * to_n1 + fine.y * to_n2;
            most = most.max(n.distance_squared(frame.normal(coarse)));
            least = least.min(n.dot(frame.mean_normal));
        }
        Self { distance, sine2: sine2(most, least) }
    }
}

/// The square of the sine of an angle that no normal n is turned by more than from m, by the most of |n − m|² and the
/// least of n along a unit vector: |n| sin ∠(n, m) ≤ |n − m|, and both n − m and n are linear over a part.
fn sine2(most: f64, least: f64) -> f64 {
    if least > 0.0 { most / (least * least) } else { f64::INFINITY }
}

/// What has been seen of the fine surface over coarse triangles.
struct Look {
    most: Differences,
    part: ClippedPart,
}

impl Look {
    /// Looks at all that lies over a coarse triangle. Returns whether it fills that once, so that it counts.
    fn over(&mut self, frame: &Frame, from: u32, fine: &mut FineSurface, homes: &mut Homes) -> bool {
        let covers_once = fine.covers_once(from);
        for place in 0..fine.over_this.len() {
            let number = fine.over_this[place];
            let vertices = fine.triangles[number as usize];
            for vertex in vertices {
                if let Some(height) = fine.told_first(vertex) {
                    homes.see(vertex, [1 + number, from], height.abs());
                }
            }
            if covers_once && self.may_differ_more(frame, number, fine) {
                let corners = fine.corners(number);
                let part = self.part.clipped([corners[0].at, corners[1].at, corners[2].at]);
                let heights = [corners[0].height, corners[1].height, corners[2].height];
                let normals = vertices.map(|vertex| fine.normals[vertex as usize]);
                self.most = self.most.max(Differences::of_part(frame, part, heights, normals));
            }
        }
        covers_once
    }

    /// Whether a fine triangle differs by more than any before, also where it is beside the coarse one: so a part of it
    /// may.
    fn may_differ_more(&self, frame: &Frame, number: u32, fine: &mut FineSurface) -> bool {
        let most = self.most.distance;
        if fine.corners(number).iter().any(|corner| corner.height.abs() > most) {
            return true;
        }
        if self.most.sine2 == f64::INFINITY {
            return false;
        }
        fine.turn(frame, number);
        let [a, b, c] = fine.corners(number).map(|corner| corner.turn);
        let least = a[1].min(b[1]).min(c[1]);
        least <= 0.0 || a[0].max(b[0]).max(c[0]) > self.most.sine2 * least * least
    }
}

/// The box around a triangle.
fn box_around(mesh: &Mesh, triangle: [u32; 3]) -> (Vec3A, Vec3A) {
    let [a, b, c] = triangle.map(|vertex| Vec3A::from(mesh.positions()[vertex as usize]));
    (a.min(b).min(c), a.max(b).max(c))
}
