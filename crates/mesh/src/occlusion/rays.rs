//! Whether a ray meets a triangle.

use bevy_math::DVec3;

use crate::Mesh;

/// How many triangles have one sphere around them.
const RUN: usize = 16;
/// How many have a larger one.
const LONG_RUN: usize = 16 * RUN;

/// The triangles that rays may meet, in an order in which neighbours are near each other in space, in runs.
pub(super) struct Occluders {
    triangles: Vec<OccludingTriangle>,
    runs: Vec<TriangleRun>,
    long_runs: Vec<TriangleRun>,
    clearance: f64,
}

/// A corner, and the edges from it.
struct OccludingTriangle {
    corner: DVec3,
    edges: [DVec3; 2],
}

/// The sphere around [`RUN`] triangles, [`LONG_RUN`], or fewer at the end.
struct TriangleRun {
    center: DVec3,
    radius: f64,
}

/// How far rays start above a triangle, in shares of the largest coordinate: some roundings of `f32` positions.
const CLEARANCE: f64 = 1.0 / (1 << 20) as f64;

impl Occluders {
    pub(super) fn new<'a>(meshes: impl Iterator<Item = &'a Mesh>) -> Self {
        let (mut triangles, mut largest) = (Vec::new(), 0.0_f64);
        for mesh in meshes {
            let positions = mesh.positions();
            largest = positions.iter().fold(largest, |most, p| most.max(p.abs().max_element().into()));
            for corners in mesh.triangles() {
                let [a, b, c] = corners.map(|vertex| positions[vertex as usize].as_dvec3());
                triangles.push(OccludingTriangle { corner: a, edges: [b - a, c - a] });
            }
        }
        triangles.sort_by_cached_key(|triangle| triangle.place(largest));
        let runs = triangles.chunks(RUN).map(TriangleRun::around).collect();
        let long_runs = triangles.chunks(LONG_RUN).map(TriangleRun::around).collect();
        Self { triangles, runs, long_runs, clearance: CLEARANCE * largest }
    }

    /// How far above a triangle a ray has to start, so that no rounding lets it meet that one.
    pub(super) fn clearance(&self) -> f64 {
        self.clearance
    }

    /// Whether a triangle, of either side, is met no farther than `reach` along a unit direction.
    pub(super) fn meet(&self, origin: DVec3, direction: DVec3, reach: f64) -> bool {
        let reaches = |run: &TriangleRun| run.reaches(origin, direction, reach);
        let of_long = self.runs.chunks(LONG_RUN / RUN).zip(self.triangles.chunks(LONG_RUN));
        self.long_runs.iter().zip(of_long).filter(|(long, _)| reaches(long)).any(|(_, (runs, triangles))| {
            let of_run = runs.iter().zip(triangles.chunks(RUN)).filter(|(run, _)| reaches(run));
            of_run.flat_map(|(_, triangles)| triangles).any(|triangle| triangle.meets(origin, direction, reach))
        })
    }
}

impl TriangleRun {
    fn around(triangles: &[OccludingTriangle]) -> Self {
        let corners = || {
            triangles.iter().flat_map(|OccludingTriangle { corner, edges: [b, c] }| [*corner, corner + b, corner + c])
        };
        let least = corners().fold(DVec3::INFINITY, DVec3::min);
        let most = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        let center = 0.5 * (least + most);
        let radius = corners().map(|p| p.distance_squared(center)).fold(0.0, f64::max).sqrt();
        // Above what rounding may take away.
        Self { center, radius: radius * (1.0 + 1e-12) }
    }

    fn reaches(&self, origin: DVec3, direction: DVec3, reach: f64) -> bool {
        let toward = self.center - origin;
        let along = toward.dot(direction);
        let aside = toward.length_squared() - along * along;
        // Rounding of the difference of squares is below 1e-15 of them.
        let is_near = aside <= self.radius * self.radius + 1e-12 * toward.length_squared();
        is_near && along >= -self.radius && along <= reach + self.radius
    }
}

impl OccludingTriangle {
    /// The place of the middle along a curve through all of space as far as `largest` along each axis (Morton 1966),
    /// cut into 1024 parts along each.
    fn place(&self, largest: f64) -> u32 {
        let [b, c] = self.edges;
        let middle = self.corner + (b + c) / 3.0;
        // Casts take what is no number to 0.
        let parts = (middle / largest * 0.5 + 0.5).to_array().map(|share| (share * 1024.0) as u32);
        (0..10).fold(0, |place, bit| {
            parts
                .iter()
                .enumerate()
                .fold(place, |place, (axis, part)| place | (part >> bit & 1) << (3 * bit + axis as u32))
        })
    }

    /// Möller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection".
    fn meets(&self, origin: DVec3, direction: DVec3, reach: f64) -> bool {
        let [b, c] = self.edges;
        let normal = direction.cross(c);
        let determinant = b.dot(normal);
        if determinant == 0.0 {
            return false;
        }
        let from = origin - self.corner;
        let u = from.dot(normal) / determinant;
        let across = from.cross(b);
        let v = direction.dot(across) / determinant;
        let t = c.dot(across) / determinant;
        u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t <= reach
    }
}
