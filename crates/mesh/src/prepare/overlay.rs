//! How far coarse triangles are from the fine ones that they stand for: the largest differences, and not samples of them.

use bevy_math::{DVec2, DVec3, Vec3A};

use super::box_grid::BoxGrid;
use super::nearest::{TriangleCorners, nearest_on};
use crate::Mesh;

impl Mesh {
    fn corners(&self, triangle: [u32; 3]) -> TriangleCorners {
        triangle.map(|vertex| self.positions()[vertex as usize].as_dvec3())
    }

    fn corner_normals(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        triangle.map(|vertex| self.normals()[vertex as usize].as_dvec3())
    }
}

/// A bound of how far apart two surfaces are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Deviation {
    /// No point of either is further from the other than this.
    pub(super) distance: f64,
    /// Every point of the coarse one has a point of the fine one within the distance whose normal is turned by no more
    /// than this, in radians.
    pub(super) angle: f64,
}

impl Deviation {
    pub(super) fn max(self, other: Self) -> Self {
        Self { distance: self.distance.max(other.distance), angle: self.angle.max(other.angle) }
    }

    /// Of a surface from a third one, where this is that of the first from the second, and `other` of the second from
    /// the third.
    pub(super) fn and(self, other: Self) -> Self {
        let angle = (self.angle + other.angle).min(std::f64::consts::PI);
        Self { distance: self.distance + other.distance, angle }
    }
}

/// Two surfaces between a mesh's vertices.
pub(super) struct Surfaces<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) coarse: &'a [[u32; 3]],
    pub(super) fine: &'a [[u32; 3]],
    /// The vertices of the fine one for which the coarse one stands; it may have others at its border.
    pub(super) covered: &'a [u32],
}

/// What is known of where the fine surface is.
pub(super) struct Overlay {
    pub(super) deviation: Deviation,
    /// Each coarse triangle and a fine one that lies over or near it, in the order of the coarse ones.
    pub(super) pairs: Vec<(u32, u32)>,
    /// For each covered vertex, a coarse triangle that lies nearest to it, or nearly.
    pub(super) homes: Vec<u32>,
}

/// Further off than this part of a triangle's longest edge nothing is looked for over it.
const REACH: f64 = 0.25;

/// What lies beside a triangle by this part of its height lies near it, and over others in its place that face a little
/// otherwise.
const NEAR: f64 = 0.2;

/// The parts of the fine triangles over a coarse one are to cover it to this part of its area.
const COVERED: f64 = 1e-7;

impl Surfaces<'_> {
    /// Bounds the distance of the surfaces.
    ///
    /// Each coarse triangle is compared with the fine ones that lie over it along its normal: they are clipped by its
    /// sides, and over each part both surfaces are linear, so that the distance along the normal and the difference of
    /// the interpolated normals are largest at corners of the parts (as in Bajaj and Schikore 1996, "Error-bounded
    /// reduction of triangle meshes with multivariate data"). The parts have to fill the triangle once. Where they do
    /// not, its own corners, which are vertices of the fine surface, bound it: none of its points is further from one of
    /// them than the longest edge over √3 (Jung 1901).
    ///
    /// The other way round, what lies over no coarse triangle lies in a wedge at an edge. The distance from the edge is
    /// convex, so over a part of a fine triangle it is largest at a corner: at a side of a coarse triangle, which has
    /// been looked at, or at a vertex of the fine surface, whose distance is found by itself.
    ///
    /// `slots` has `u32::MAX` for every vertex of the mesh, before and after.
    pub(super) fn overlay(&self, slots: &mut [u32]) -> Overlay {
        let mut homes = Homes::new(self, slots);
        let fine: Vec<FineTriangle> =
            self.fine.iter().map(|&triangle| homes.fine_triangle(self.mesh, triangle)).collect();
        let boxes: Vec<(Vec3A, Vec3A)> = self.fine.iter().map(|&triangle| box_around(self.mesh, triangle)).collect();
        let grid = BoxGrid::new(&boxes);
        let mut pairs = Vec::with_capacity(6 * self.fine.len());
        let (mut look, mut unseen) = (Look::default(), Deviation::default());
        let mut longest_unseen = 0.0_f64;
        for (number, &triangle) in (0..).zip(self.coarse) {
            let before = pairs.len();
            let frame = Frame::new(self.mesh, triangle);
            let [low, high] = reached(self.mesh.corners(triangle), frame.as_ref());
            let own = first_least(triangle);
            let mut is_same = false;
            look.begin();
            grid.meeting(low, high, |at| {
                let other = &fine[at as usize];
                is_same |= other.first_least == own;
                let Some(frame) = &frame else { return };
                let normals = || self.mesh.corner_normals(self.fine[at as usize]);
                if frame
                    .look((at, other), normals, &mut look, |slot, distance| homes.see(slot, [1 + at, number], distance))
                {
                    pairs.push((number, at));
                }
            });
            if is_same || look.counts() {
                continue;
            }
            unseen = unseen.max(self.by_corners(triangle));
            let over = pairs[before..].iter().map(|&(_, at)| longest_edge(fine[at as usize].corners));
            longest_unseen = over.fold(longest_unseen, f64::max);
        }
        let mut deviation = look.deviation().max(unseen);
        let (farthest, homes) = homes.farthest(self);
        // What lies over a triangle that is not covered is no further from a vertex than its longest edge over √3.
        deviation.distance = deviation.distance.max(farthest + longest_unseen / 3f64.sqrt());
        Overlay { deviation, pairs, homes }
    }

    /// What the corners of a coarse triangle say of it.
    fn by_corners(&self, triangle: [u32; 3]) -> Deviation {
        let [a, b, c] = self.mesh.corner_normals(triangle);
        let angle = angle(a, b).max(angle(b, c)).max(angle(c, a));
        let angle = if angle < std::f64::consts::FRAC_PI_2 { angle } else { std::f64::consts::PI };
        Deviation { distance: longest_edge(self.mesh.corners(triangle)) / 3f64.sqrt(), angle }
    }
}

/// The same triangle, its least corner first.
fn first_least([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a <= b && a <= c {
        [a, b, c]
    } else if b <= c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

fn longest_edge([a, b, c]: TriangleCorners) -> f64 {
    a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a)).sqrt()
}

/// The angle between two vectors, exact also where it is small.
pub(super) fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

/// A coarse triangle, and where points are over it.
struct Frame {
    origin: DVec3,
    /// What the weights of its second and third corner grow by, and of unit length, its normal.
    axes: [DVec3; 3],
    normals: [DVec3; 3],
    /// Of unit length.
    mean_normal: DVec3,
    reach: f64,
}

/// A triangle of the fine surface.
struct FineTriangle {
    corners: TriangleCorners,
    /// The places of its corners in the list of covered vertices.
    slots: [u32; 3],
    first_least: [u32; 3],
}

/// What has been seen of the fine surface over coarse triangles.
#[derive(Default)]
struct Look {
    /// Of the parts over this triangle the number of the fine triangle, and the area as a part of the coarse one's.
    areas: Vec<(u32, f64)>,
    over_this: Differences,
    /// Over the triangles before that count.
    most: Differences,
    /// Corners of a part, before and after it is clipped.
    parts: [Vec<PartCorner>; 2],
}

/// How far surfaces are apart at most.
#[derive(Clone, Copy, Default)]
struct Differences {
    distance: f64,
    /// The square of the sine of an angle that no normal is turned by more than, if less than 1.
    sine2: f64,
}

impl Look {
    /// Begins with a coarse triangle.
    fn begin(&mut self) {
        self.areas.clear();
        self.over_this = self.most;
    }

    /// Whether the parts fill the triangle once, so that what was seen over it counts.
    fn counts(&mut self) -> bool {
        // In one order, so that sums are equal to the bit.
        self.areas.sort_unstable_by_key(|&(fine, _)| fine);
        let area: f64 = self.areas.iter().map(|(_, area)| area).sum();
        let fills = (area - 1.0).abs() <= COVERED;
        if fills {
            self.most = self.over_this;
        }
        fills
    }

    fn deviation(&self) -> Deviation {
        let Differences { distance, sine2 } = self.most;
        let angle = if sine2 < 1.0 { sine2.sqrt().asin() } else { std::f64::consts::PI };
        Deviation { distance, angle }
    }
}

/// A corner of a part: the weights of the coarse triangle's second and third corner there, and of the fine one's.
#[derive(Clone, Copy, Default)]
struct PartCorner {
    coarse: DVec2,
    fine: DVec2,
    /// The number of the fine triangle's corner that it is; 3 if none.
    number: usize,
}

impl Frame {
    /// `None` where the triangle has no area to speak of.
    fn new(mesh: &Mesh, triangle: [u32; 3]) -> Option<Self> {
        let [a, b, c] = mesh.corners(triangle);
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        let longest = longest_edge([a, b, c]);
        if normal.length() <= 1e-9 * longest * longest {
            return None;
        }
        let square = normal.length_squared();
        let axes = [ac.cross(normal) / square, normal.cross(ab) / square, normal.normalize()];
        let normals = mesh.corner_normals(triangle);
        let mean_normal = (normals[0] + normals[1] + normals[2]).normalize_or_zero();
        Some(Self { origin: a, axes, normals, mean_normal, reach: REACH * longest })
    }

    /// Looks at a fine triangle, and returns whether it lies near this one. `see` gets the slot of each of its corners
    /// that do, and how far off they are.
    fn look(
        &self,
        (number, fine): (u32, &FineTriangle),
        normals: impl Fn() -> [DVec3; 3],
        look: &mut Look,
        mut see: impl FnMut(u32, f64),
    ) -> bool {
        let [x, y, z] = self.axes;
        let [a, b, c] = fine.corners;
        let offsets = [a - self.origin, b - self.origin, c - self.origin];
        let along = |axis: DVec3| [offsets[0].dot(axis), offsets[1].dot(axis), offsets[2].dot(axis)];
        let greatest = |[a, b, c]: [f64; 3]| a.max(b).max(c);
        let xs = along(x);
        if greatest(xs) <= -NEAR {
            return false;
        }
        let ys = along(y);
        let at = [DVec2::new(xs[0], ys[0]), DVec2::new(xs[1], ys[1]), DVec2::new(xs[2], ys[2])];
        let inside = greatest(xs).min(greatest(ys)).min(greatest([third(at[0]), third(at[1]), third(at[2])]));
        if inside <= -NEAR {
            return false;
        }
        let heights = along(z);
        if heights.iter().all(|&h| h > self.reach) || heights.iter().all(|&h| h < -self.reach) {
            return false;
        }
        // The last: facing the other way, or edge on.
        if inside <= 0.0 || (at[1] - at[0]).perp_dot(at[2] - at[0]) <= 0.0 {
            return true;
        }
        let Look { areas, over_this, parts, .. } = look;
        let part = clipped(at, parts);
        if part.len() < 3 {
            return true;
        }
        let mut area = 0.0;
        let mut before = part[part.len() - 1].coarse;
        let [h, to_h1, to_h2] = [heights[0], heights[1] - heights[0], heights[2] - heights[0]];
        for &PartCorner { coarse, fine: at, number } in part {
            area += before.perp_dot(coarse);
            before = coarse;
            let height = (h + at.x * to_h1 + at.y * to_h2).abs();
            over_this.distance = over_this.distance.max(height);
            if let Some(&slot) = fine.slots.get(number) {
                see(slot, height);
            }
        }
        areas.push((number, area));
        over_this.sine2 = over_this.sine2.max(self.sine2(normals(), part));
        true
    }

    /// The square of the sine of an angle that no normal is turned by more than over a part.
    fn sine2(&self, [n0, n1, n2]: [DVec3; 3], part: &[PartCorner]) -> f64 {
        let (mut most, mut least) = (0.0_f64, f64::INFINITY);
        let [a, b, c] = self.normals;
        let (to_n1, to_n2, to_b, to_c) = (n1 - n0, n2 - n0, b - a, c - a);
        for &PartCorner { coarse, fine, .. } in part {
            let n = n0 + fine.x * to_n1 + fine.y * to_n2;
            let m = a + coarse.x * to_b + coarse.y * to_c;
            most = most.max(n.distance_squared(m));
            least = least.min(n.dot(self.mean_normal));
        }
        // |n| sin ∠(n, m) ≤ |n − m|, and both n − m and n are linear over the part.
        if least > 0.0 { most / (least * least) } else { f64::INFINITY }
    }
}

/// How far inside of the third side of a coarse triangle a point is. Of the others its coordinates say it.
fn third(at: DVec2) -> f64 {
    1.0 - at.x - at.y
}

/// The part of a fine triangle over a coarse one, from where its corners are over that.
fn clipped(at: [DVec2; 3], parts: &mut [Vec<PartCorner>; 2]) -> &[PartCorner] {
    parts[0].clear();
    parts[0].extend([
        PartCorner { coarse: at[0], fine: DVec2::ZERO, number: 0 },
        PartCorner { coarse: at[1], fine: DVec2::X, number: 1 },
        PartCorner { coarse: at[2], fine: DVec2::Y, number: 2 },
    ]);
    clip(parts, |at| at.x);
    clip(parts, |at| at.y);
    clip(parts, third);
    &parts[0]
}

/// Keeps what is inside of one side of the first part; the second is for what was there before.
fn clip([part, whole]: &mut [Vec<PartCorner>; 2], side: impl Fn(DVec2) -> f64) {
    if part.iter().all(|corner| side(corner.coarse) >= 0.0) {
        return;
    }
    std::mem::swap(part, whole);
    part.clear();
    let Some(&(mut before)) = whole.last() else { return };
    let mut depth_before = side(before.coarse);
    for &corner in &*whole {
        let depth = side(corner.coarse);
        if (depth < 0.0) != (depth_before < 0.0) {
            let t = depth_before / (depth_before - depth);
            let [coarse, fine] = [before.coarse.lerp(corner.coarse, t), before.fine.lerp(corner.fine, t)];
            part.push(PartCorner { coarse, fine, number: 3 });
        }
        if depth >= 0.0 {
            part.push(corner);
        }
        (before, depth_before) = (corner, depth);
    }
}

/// Which coarse triangle each covered vertex is nearest to, by its place in the list of covered vertices.
struct Homes<'a> {
    /// Of every vertex of the mesh that place; `u32::MAX` if it has none.
    slots: &'a mut [u32],
    nearest: Vec<Nearest>,
}

/// The least distance of a vertex that has been seen.
#[derive(Clone, Copy)]
struct Nearest {
    distance: f64,
    /// The first fine triangle that has it, from 1 (0 where no fine one was asked), and the first coarse one.
    seen: [u32; 2],
}

impl<'a> Homes<'a> {
    fn new(surfaces: &Surfaces, slots: &'a mut [u32]) -> Self {
        for (slot, &vertex) in (0..).zip(surfaces.covered) {
            slots[vertex as usize] = slot;
        }
        let unseen = Nearest { distance: f64::INFINITY, seen: [0, u32::MAX] };
        let mut homes = Self { nearest: vec![unseen; surfaces.covered.len()], slots };
        for (number, triangle) in (0..).zip(surfaces.coarse) {
            for &vertex in triangle {
                homes.see(homes.slots[vertex as usize], [0, number], 0.0);
            }
        }
        homes
    }

    fn fine_triangle(&self, mesh: &Mesh, triangle: [u32; 3]) -> FineTriangle {
        FineTriangle {
            corners: mesh.corners(triangle),
            slots: triangle.map(|vertex| self.slots[vertex as usize]),
            first_least: first_least(triangle),
        }
    }

    /// Takes note of a distance between a vertex and a fine and a coarse triangle.
    fn see(&mut self, slot: u32, seen: [u32; 2], distance: f64) {
        if let Some(nearest) = self.nearest.get_mut(slot as usize)
            && (distance, seen) < (nearest.distance, nearest.seen)
        {
            *nearest = Nearest { distance, seen };
        }
    }

    /// Compares the vertices that lie over no triangle with all, and returns how far the farthest of all is, and the
    /// coarse triangles.
    fn farthest(mut self, surfaces: &Surfaces) -> (f64, Vec<u32>) {
        // Made when the first is asked for: most surfaces have few such vertices, or none.
        let mut spheres: Vec<(DVec3, f64)> = Vec::new();
        for (&vertex, nearest) in surfaces.covered.iter().zip(&mut self.nearest) {
            self.slots[vertex as usize] = u32::MAX;
            if nearest.seen[1] != u32::MAX {
                continue;
            }
            if spheres.is_empty() {
                let corners = surfaces.coarse.iter().map(|&triangle| surfaces.mesh.corners(triangle));
                spheres = corners.map(sphere_around).collect();
            }
            let p = surfaces.mesh.positions()[vertex as usize].as_dvec3();
            let (mut least2, mut least) = (f64::INFINITY, f64::INFINITY);
            for (number, &(center, radius)) in (0..).zip(&spheres) {
                // Further off than the nearest, by more than rounding could change.
                if p.distance_squared(center) > 1.001 * (radius + least).powi(2) {
                    continue;
                }
                let (distance2, _) = nearest_on(p, surfaces.mesh.corners(surfaces.coarse[number as usize]));
                if distance2 < least2 {
                    (least2, least) = (distance2, distance2.sqrt());
                    *nearest = Nearest { distance: least, seen: [0, number] };
                }
            }
        }
        let farthest = self.nearest.iter().map(|nearest| nearest.distance).fold(0.0, f64::max);
        (farthest, self.nearest.iter().map(|nearest| nearest.seen[1]).collect())
    }
}

/// The centre of a triangle, and how far it reaches from there; infinitely far where rounding may take points on it for
/// anywhere in its plane: with height h over a sliver whose area is a part r of its edge's square, by about 1e-16 h/r².
fn sphere_around([a, b, c]: TriangleCorners) -> (DVec3, f64) {
    let center = (a + b + c) / 3.0;
    let radius2 = a.distance_squared(center).max(b.distance_squared(center)).max(c.distance_squared(center));
    let is_sliver = (b - a).cross(c - a).length() <= 1e-4 * longest_edge([a, b, c]).powi(2);
    (center, if is_sliver { f64::INFINITY } else { radius2.sqrt() })
}

/// The box around a triangle.
fn box_around(mesh: &Mesh, triangle: [u32; 3]) -> (Vec3A, Vec3A) {
    let [a, b, c] = triangle.map(|vertex| Vec3A::from(mesh.positions()[vertex as usize]));
    (a.min(b).min(c), a.max(b).max(c))
}

/// The box around a coarse triangle and what lies within its reach, along its normal only.
fn reached([a, b, c]: TriangleCorners, frame: Option<&Frame>) -> [DVec3; 2] {
    let reach = frame.map_or(DVec3::ZERO, |frame| frame.reach * frame.axes[2].abs());
    [a.min(b).min(c) - reach, a.max(b).max(c) + reach]
}
