//! How far coarse triangles are from the fine ones that they stand for: the largest differences, and not samples of them.

use bevy_math::{DVec2, DVec3, UVec3};

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
    /// Each coarse triangle and a fine one that lies over or near it.
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
        let frames: Vec<Option<Frame>> = self.coarse.iter().map(|&triangle| Frame::new(self.mesh, triangle)).collect();
        let mut looks = vec![Look::default(); self.coarse.len()];
        let mut homes = Homes::new(self, slots);
        let mut pairs = Vec::new();
        let grid = Grid::new(&frames, self.mesh, self.coarse);
        let mut near = Vec::new();
        for (fine, &triangle) in (0..).zip(self.fine) {
            let corners = self.mesh.corners(triangle);
            let normals = self.mesh.corner_normals(triangle);
            grid.near(&corners, &mut near);
            for &coarse in &near {
                let look = &mut looks[coarse as usize];
                let Some(frame) = &frames[coarse as usize] else { continue };
                if frame.look(&corners, &normals, look, |corner, distance| {
                    homes.see(triangle[corner], coarse, distance);
                }) {
                    pairs.push((coarse, fine));
                }
            }
        }
        let mut deviation = Deviation::default();
        let mut is_unseen = vec![false; self.coarse.len()];
        let mut same = self.fine.iter().map(|&triangle| first_least(triangle)).collect::<Vec<_>>();
        same.sort_unstable();
        for (number, look) in looks.iter().enumerate() {
            let triangle = self.coarse[number];
            if same.binary_search(&first_least(triangle)).is_ok() {
                continue;
            }
            deviation = deviation.max(look.deviation().unwrap_or_else(|| {
                is_unseen[number] = true;
                self.by_corners(triangle)
            }));
        }
        // What lies over a triangle that is not covered is no further from a vertex than this.
        let over = pairs.iter().filter(|(coarse, _)| is_unseen[*coarse as usize]);
        let edges = over.map(|&(_, fine)| longest_edge(self.mesh.corners(self.fine[fine as usize])));
        let from_vertex = edges.fold(0.0, f64::max) / 3f64.sqrt();
        let (farthest, homes) = homes.farthest(self);
        deviation.distance = deviation.distance.max(farthest + from_vertex);
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

/// What has been seen of the fine surface over a coarse triangle.
#[derive(Clone, Copy, Default)]
struct Look {
    /// The area of the parts, as a part of the triangle's.
    area: f64,
    distance: f64,
    /// The square of the sine of an angle that no normal is turned by more than, if less than 1.
    sine2: f64,
}

impl Look {
    /// `None` where the parts do not fill the triangle once.
    fn deviation(&self) -> Option<Deviation> {
        let angle = if self.sine2 < 1.0 { self.sine2.sqrt().asin() } else { std::f64::consts::PI };
        let fills = (self.area - 1.0).abs() <= COVERED;
        fills.then_some(Deviation { distance: self.distance, angle })
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

/// A triangle clipped by three lines has no more corners, and one more on the way.
const MOST_CORNERS: usize = 7;

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

    /// Looks at a fine triangle, and returns whether it lies near this one. `see` gets each of its corners that
    /// do, and how far off they are.
    fn look(
        &self,
        fine: &TriangleCorners,
        normals: &[DVec3; 3],
        look: &mut Look,
        mut see: impl FnMut(usize, f64),
    ) -> bool {
        let [x, y, z] = self.axes;
        let offsets = fine.map(|p| p - self.origin);
        let at = offsets.map(|offset| DVec2::new(offset.dot(x), offset.dot(y)));
        let is_beside = |by: f64| SIDES.into_iter().any(|of| at.iter().all(|&at| of(at) <= -by));
        if is_beside(NEAR) {
            return false;
        }
        let heights = offsets.map(|offset| offset.dot(z));
        if heights.iter().all(|&h| h > self.reach) || heights.iter().all(|&h| h < -self.reach) {
            return false;
        }
        // The last: facing the other way, or edge on.
        if is_beside(0.0) || (at[1] - at[0]).perp_dot(at[2] - at[0]) <= 0.0 {
            return true;
        }
        let mut part = [PartCorner::default(); MOST_CORNERS];
        for (number, weights) in [DVec2::ZERO, DVec2::X, DVec2::Y].into_iter().enumerate() {
            part[number] = PartCorner { coarse: at[number], fine: weights, number };
        }
        let mut count = 3;
        for side in SIDES {
            if part[..count].iter().any(|corner| side(corner.coarse) < 0.0) {
                count = clip(&mut part, count, side);
            }
        }
        if count < 3 {
            return true;
        }
        let part = &part[..count];
        let mut area = 0.0;
        let (mut most, mut least) = (0.0_f64, f64::INFINITY);
        let mut before = part[count - 1].coarse;
        for &PartCorner { coarse, fine, number } in part {
            area += before.perp_dot(coarse);
            before = coarse;
            let height = heights[0] + fine.x * (heights[1] - heights[0]) + fine.y * (heights[2] - heights[0]);
            look.distance = look.distance.max(height.abs());
            let n = normals[0] + fine.x * (normals[1] - normals[0]) + fine.y * (normals[2] - normals[0]);
            let [a, b, c] = self.normals;
            let m = a + coarse.x * (b - a) + coarse.y * (c - a);
            most = most.max(n.distance_squared(m));
            least = least.min(n.dot(self.mean_normal));
            if number < 3 {
                see(number, height.abs());
            }
        }
        look.area += area;
        // |n| sin ∠(n, m) ≤ |n − m|, and both n − m and n are linear over the part.
        look.sine2 = look.sine2.max(if least > 0.0 { most / (least * least) } else { f64::INFINITY });
        true
    }
}

/// How far inside of each side of a coarse triangle a point is.
const SIDES: [fn(DVec2) -> f64; 3] = [|at| at.x, |at| at.y, |at| 1.0 - at.x - at.y];

/// Keeps what is inside of one side, and returns how many corners that has.
fn clip(part: &mut [PartCorner; MOST_CORNERS], count: usize, side: fn(DVec2) -> f64) -> usize {
    let whole = *part;
    let mut kept = 0;
    let mut before = whole[count - 1];
    for &corner in &whole[..count] {
        let [depth_before, depth] = [before, corner].map(|corner| side(corner.coarse));
        if (depth < 0.0) != (depth_before < 0.0) {
            let t = depth_before / (depth_before - depth);
            let [coarse, fine] = [before.coarse.lerp(corner.coarse, t), before.fine.lerp(corner.fine, t)];
            part[kept] = PartCorner { coarse, fine, number: 3 };
            kept += 1;
        }
        if depth >= 0.0 {
            part[kept] = corner;
            kept += 1;
        }
        before = corner;
    }
    kept
}

/// Which coarse triangle each covered vertex is nearest to, by its place in the list of covered vertices.
struct Homes<'a> {
    /// Of every vertex of the mesh that place; `u32::MAX` if it has none.
    slots: &'a mut [u32],
    nearest: Vec<(f64, u32)>,
}

impl<'a> Homes<'a> {
    fn new(surfaces: &Surfaces, slots: &'a mut [u32]) -> Self {
        for (slot, &vertex) in (0..).zip(surfaces.covered) {
            slots[vertex as usize] = slot;
        }
        let mut homes = Self { nearest: vec![(f64::INFINITY, u32::MAX); surfaces.covered.len()], slots };
        for (number, triangle) in (0..).zip(surfaces.coarse) {
            for &vertex in triangle {
                homes.see(vertex, number, 0.0);
            }
        }
        homes
    }

    fn see(&mut self, vertex: u32, triangle: u32, distance: f64) {
        if let Some(nearest) = self.nearest.get_mut(self.slots[vertex as usize] as usize)
            && distance < nearest.0
        {
            *nearest = (distance, triangle);
        }
    }

    /// Compares the vertices that lie over no triangle with all, and returns how far the farthest of all is, and the
    /// triangles.
    fn farthest(mut self, surfaces: &Surfaces) -> (f64, Vec<u32>) {
        for (&vertex, nearest) in surfaces.covered.iter().zip(&mut self.nearest) {
            self.slots[vertex as usize] = u32::MAX;
            if nearest.1 != u32::MAX {
                continue;
            }
            let p = surfaces.mesh.positions()[vertex as usize].as_dvec3();
            let mut least2 = f64::INFINITY;
            for (number, &triangle) in (0..).zip(surfaces.coarse) {
                let (distance2, _) = nearest_on(p, surfaces.mesh.corners(triangle));
                if distance2 < least2 {
                    least2 = distance2;
                    *nearest = (distance2.sqrt(), number);
                }
            }
        }
        let farthest = self.nearest.iter().map(|(distance, _)| *distance).fold(0.0, f64::max);
        (farthest, self.nearest.iter().map(|(_, triangle)| *triangle).collect())
    }
}

/// Coarse triangles by place.
struct Grid {
    low: DVec3,
    per_unit: DVec3,
    cells: UVec3,
    starts: Vec<u32>,
    triangles: Vec<u32>,
    /// The boxes around the triangles and what lies within reach of them.
    boxes: Vec<(DVec3, DVec3)>,
}

/// Cells along an edge of the grid at most.
const MOST_CELLS: u32 = 16;

impl Grid {
    fn new(frames: &[Option<Frame>], mesh: &Mesh, coarse: &[[u32; 3]]) -> Self {
        let around = |(frame, &triangle): (&Option<Frame>, &[u32; 3])| {
            let [a, b, c] = mesh.corners(triangle);
            // Along its normal only.
            let reach = frame.as_ref().map_or(DVec3::ZERO, |frame| frame.reach * frame.axes[2].abs());
            (a.min(b).min(c) - reach, a.max(b).max(c) + reach)
        };
        let boxes: Vec<(DVec3, DVec3)> = frames.iter().zip(coarse).map(around).collect();
        let join = |(low, high): (DVec3, DVec3), of: &(DVec3, DVec3)| (low.min(of.0), high.max(of.1));
        let (low, high) = boxes.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), join);
        let mean = boxes.iter().map(|(low, high)| (high - low).max_element()).sum::<f64>() / boxes.len().max(1) as f64;
        let size = high - low;
        let cells = if mean > 0.0 { (size / mean).ceil() } else { DVec3::ONE };
        let cells = cells.clamp(DVec3::ONE, DVec3::splat(f64::from(MOST_CELLS))).as_uvec3();
        let per_unit = DVec3::select(size.cmpgt(DVec3::ZERO), cells.as_dvec3() / size, DVec3::ZERO);
        let mut grid = Self { low, per_unit, cells, starts: Vec::new(), triangles: Vec::new(), boxes };
        let mut counts = vec![0; (cells.x * cells.y * cells.z) as usize + 1];
        for &(low, high) in &grid.boxes {
            grid.each_cell(low, high, |cell| counts[cell + 1] += 1);
        }
        for cell in 1..counts.len() {
            counts[cell] += counts[cell - 1];
        }
        grid.triangles = vec![0; counts.last().map_or(0, |&count| count as usize)];
        let mut next = counts.clone();
        for (number, &(low, high)) in (0..).zip(&grid.boxes) {
            let (next, triangles) = (&mut next, &mut grid.triangles);
            each_cell(&(grid.low, grid.per_unit, grid.cells), low, high, |cell| {
                triangles[next[cell] as usize] = number;
                next[cell] += 1;
            });
        }
        grid.starts = counts;
        grid
    }

    fn each_cell(&self, low: DVec3, high: DVec3, each: impl FnMut(usize)) {
        each_cell(&(self.low, self.per_unit, self.cells), low, high, each);
    }

    /// The coarse triangles whose boxes meet that of a fine one, each once.
    fn near(&self, corners: &TriangleCorners, near: &mut Vec<u32>) {
        let [a, b, c] = *corners;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        near.clear();
        let mut cells = 0;
        self.each_cell(low, high, |cell| {
            cells += 1;
            let all = &self.triangles[self.starts[cell] as usize..self.starts[cell + 1] as usize];
            near.extend(all.iter().copied().filter(|&triangle| {
                let (least, most) = &self.boxes[triangle as usize];
                least.cmple(high).all() && most.cmpge(low).all()
            }));
        });
        if cells > 1 {
            near.sort_unstable();
            near.dedup();
        }
    }
}

fn each_cell((start, per_unit, cells): &(DVec3, DVec3, UVec3), low: DVec3, high: DVec3, mut each: impl FnMut(usize)) {
    // Casts take what lies beside the grid into it.
    let [from, to] = [low, high].map(|p| ((p - start) * per_unit).as_uvec3().min(cells - UVec3::ONE));
    for z in from.z..=to.z {
        for y in from.y..=to.y {
            for x in from.x..=to.x {
                each(((z * cells.y + y) * cells.x + x) as usize);
            }
        }
    }
}
