//! How far a coarse level is from the finer one before it, at sampled points.

use bevy_math::DVec3;
use rayon::prelude::*;

use super::nearest::Triangles;
use super::stand_ins::StandIns;
use crate::Mesh;

/// What two levels differ by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Deviation {
    /// The greatest distance of a sampled point.
    pub(super) distance: f64,
    /// The greatest angle between normals, in radians.
    pub(super) angle: f64,
}

impl Deviation {
    pub(super) fn max(self, other: Self) -> Self {
        Self { distance: self.distance.max(other.distance), angle: self.angle.max(other.angle) }
    }
}

/// Triangles of a level that are looked at for a point, after which the best so far has to do.
const LOOKED_AT: usize = 256;

/// No triangle of the level touches the place.
const NOWHERE: u32 = u32::MAX;

/// The triangles of a level, found by the places that they touch.
pub(super) struct Sheet<'a> {
    mesh: &'a Mesh,
    stand_ins: &'a StandIns,
    triangles: &'a [[u32; 3]],
    /// Where the triangles about each place begin among `fans`; one more at the end.
    starts: Vec<u32>,
    fans: Vec<u32>,
    /// Whether each vertex is one of the level's.
    used: Vec<bool>,
}

/// A point and its normal.
#[derive(Clone, Copy)]
struct Sample {
    p: DVec3,
    n: DVec3,
    /// A place of the level that is probably near.
    start: u32,
}

impl<'a> Sheet<'a> {
    pub(super) fn new(mesh: &'a Mesh, stand_ins: &'a StandIns, triangles: &'a [[u32; 3]]) -> Self {
        let count = mesh.positions().len();
        let (mut starts, mut used) = (vec![0; count + 1], vec![false; count]);
        for &vertex in triangles.iter().flatten() {
            used[vertex as usize] = true;
            starts[stand_ins.places[vertex as usize] as usize + 1] += 1;
        }
        for place in 0..count {
            starts[place + 1] += starts[place];
        }
        let mut next = starts.clone();
        let mut fans = vec![0; 3 * triangles.len()];
        for (number, triangle) in (0..).zip(triangles) {
            for &vertex in triangle {
                let place = stand_ins.places[vertex as usize] as usize;
                fans[next[place] as usize] = number;
                next[place] += 1;
            }
        }
        Self { mesh, stand_ins, triangles, starts, fans, used }
    }

    fn place(&self, vertex: u32) -> u32 {
        self.stand_ins.places[vertex as usize]
    }

    fn fan(&self, place: u32) -> &[u32] {
        &self.fans[self.starts[place as usize] as usize..self.starts[place as usize + 1] as usize]
    }

    fn position(&self, vertex: u32) -> DVec3 {
        self.mesh.positions()[vertex as usize].as_dvec3()
    }

    fn normal(&self, vertex: u32) -> DVec3 {
        self.mesh.normals()[vertex as usize].as_dvec3()
    }

    /// What this level and a finer one differ by: at the finer one's vertices that this one has not, and at the centroids
    /// and the middles of the edges that the finer one has not.
    pub(super) fn deviation_from(&self, finer: &Self) -> Deviation {
        let starts = self.starts_of(finer);
        let gone = (0..self.used.len() as u32).into_par_iter();
        let gone = gone.filter(|&vertex| finer.used[vertex as usize] && !self.used[vertex as usize]).map(|vertex| {
            let (p, n) = (self.position(vertex), self.normal(vertex));
            let start = starts[self.place(vertex) as usize];
            self.deviation_at(Sample { p, n, start })
        });
        let new = self.triangles.par_iter().flat_map_iter(|triangle| self.new_samples(*triangle, finer));
        let new = new.map(|sample| finer.deviation_at(sample));
        gone.chain(new).reduce(Deviation::default, Deviation::max)
    }

    /// For each place of a finer level a place of this one that is near along edges.
    fn starts_of(&self, finer: &Self) -> Vec<u32> {
        let place_of = |place: u32| if self.fan(place).is_empty() { NOWHERE } else { place };
        let mut starts: Vec<u32> = (0..self.used.len() as u32).map(place_of).collect();
        let places = |triangle: &[u32; 3]| triangle.map(|vertex| self.place(vertex));
        let mut waiting: Vec<[u32; 3]> = finer.triangles.iter().map(places).collect();
        loop {
            waiting.retain(|triangle| triangle.iter().any(|&place| starts[place as usize] == NOWHERE));
            let mut found = Vec::new();
            for triangle in &waiting {
                for &place in triangle.iter().filter(|&&place| starts[place as usize] == NOWHERE) {
                    let near = triangle.map(|other| starts[other as usize]).into_iter().filter(|&s| s != NOWHERE);
                    let distance2 = |&start: &u32| self.position(start).distance_squared(self.position(place));
                    let nearest = near.min_by(|a, b| distance2(a).total_cmp(&distance2(b)));
                    found.extend(nearest.map(|start| (place, start)));
                }
            }
            if found.is_empty() {
                break;
            }
            for (place, start) in found {
                starts[place as usize] = start;
            }
        }
        self.find_lost(finer, &mut starts);
        starts
    }

    /// Starts for pieces that are gone altogether: a corner of the triangle nearest to each of their places.
    fn find_lost(&self, finer: &Self, starts: &mut [u32]) {
        let is_lost = |place: &u32| starts[*place as usize] == NOWHERE && !finer.fan(*place).is_empty();
        let lost: Vec<u32> = (0..starts.len() as u32).filter(is_lost).collect();
        if lost.is_empty() {
            return;
        }
        let corners = |triangle: &[u32; 3]| triangle.map(|vertex| self.position(vertex));
        let tree = Triangles::new(self.triangles.iter().map(corners).collect());
        let nearest = |&place: &u32| {
            let (_, number) = tree.nearest(self.position(place), 0);
            self.place(self.triangles[tree.original(number)][0])
        };
        let found: Vec<u32> = lost.par_iter().map(nearest).collect();
        for (&place, start) in lost.iter().zip(found) {
            starts[place as usize] = start;
        }
    }

    /// The centroid and the middles of the edges of a triangle of this level that `finer` has not; an edge that two
    /// triangles share counts once.
    fn new_samples(&self, triangle: [u32; 3], finer: &Self) -> impl Iterator<Item = Sample> {
        let [a, b, c] = triangle;
        let is_new = !finer.fan(self.place(a)).iter().any(|&i| is_rotation(finer.triangles[i as usize], triangle));
        let sides = [[a, b], [b, c], [c, a]].into_iter().filter(move |_| is_new);
        let sides = sides.filter(|&[a, b]| (a < b || !self.has_edge(b, a)) && !finer.has_edge(a, b));
        let sample = |corners: &[u32]| {
            let count = corners.len() as f64;
            let n: DVec3 = corners.iter().map(|&vertex| self.normal(vertex)).sum();
            let by_fan = |vertex: &&u32| finer.fan(self.place(**vertex)).len();
            Sample {
                p: corners.iter().map(|&vertex| self.position(vertex)).sum::<DVec3>() / count,
                n: n.normalize_or_zero(),
                start: self.place(*corners.iter().min_by_key(by_fan).unwrap_or(&corners[0])),
            }
        };
        let centroid = is_new.then(|| sample(&triangle));
        let middles: Vec<Sample> = sides.map(|side| sample(&side)).collect();
        centroid.into_iter().chain(middles)
    }

    /// Whether a triangle goes from one vertex to the other.
    fn has_edge(&self, from: u32, to: u32) -> bool {
        self.fan(self.place(from)).iter().any(|&number| {
            let [a, b, c] = self.triangles[number as usize];
            [[a, b], [b, c], [c, a]].contains(&[from, to])
        })
    }

    /// The distance of a point from this level, and the angle of its normal to the interpolated one there.
    ///
    /// Looks from the start around the corners of the best triangle so far until none is better. Where a crease or a thin
    /// part has two sides near the point, the one that faces its way is meant: a difference of unit normals counts as
    /// that part of the distance from the start. What it finds bounds the distance from the nearest point from above.
    fn deviation_at(&self, sample: Sample) -> Deviation {
        let scale2 = self.position(sample.start).distance_squared(sample.p);
        let mut best = Match { cost: f64::INFINITY, distance2: f64::INFINITY, n: DVec3::ZERO, triangle: [0; 3] };
        let mut looked_at = 0;
        let mut around: Vec<u32> = Vec::with_capacity(16);
        let mut next = Some(sample.start);
        while let Some(place) = next {
            around.push(place);
            let fan = self.fan(place);
            let fan = &fan[..fan.len().min(LOOKED_AT.saturating_sub(looked_at).max(1))];
            looked_at += fan.len();
            for &number in fan {
                self.improve(&mut best, self.triangles[number as usize], sample, scale2);
            }
            let corners = best.triangle.map(|vertex| self.place(vertex)).into_iter();
            let left = corners.filter(|place| looked_at < LOOKED_AT && !around.contains(place));
            next = left.min_by_key(|&place| self.fan(place).len());
        }
        let angle = if best.n == DVec3::ZERO { std::f64::consts::PI } else { angle(sample.n, best.n) };
        Deviation { distance: best.distance2.sqrt(), angle }
    }

    fn improve(&self, best: &mut Match, triangle: [u32; 3], sample: Sample, scale2: f64) {
        let (distance2, weights) = nearest_on(sample.p, triangle.map(|vertex| self.position(vertex)));
        if distance2 >= best.cost {
            return;
        }
        let weighted = triangle.into_iter().zip(weights).map(|(vertex, weight)| weight * self.normal(vertex));
        let n = weighted.sum::<DVec3>().normalize_or_zero();
        let cost = distance2 + scale2 * n.distance_squared(sample.n);
        if cost < best.cost {
            *best = Match { cost, distance2, n, triangle };
        }
    }
}

/// The triangle that fits a sample best so far.
struct Match {
    cost: f64,
    distance2: f64,
    n: DVec3,
    triangle: [u32; 3],
}

fn is_rotation([a, b, c]: [u32; 3], other: [u32; 3]) -> bool {
    [[a, b, c], [b, c, a], [c, a, b]].contains(&other)
}

/// The angle between two vectors, exact also where it is small.
pub(super) fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

/// The square of the distance of a point from a triangle, which may be degenerate, and the weights of its corners at the
/// nearest point.
pub(super) fn nearest_on(p: DVec3, [a, b, c]: [DVec3; 3]) -> (f64, [f64; 3]) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let n = ab.cross(ac);
    let n2 = n.length_squared();
    if n2 > 0.0 {
        let [v, w] = [ap.cross(ac).dot(n) / n2, ab.cross(ap).dot(n) / n2];
        let weights = [1.0 - v - w, v, w];
        if weights.iter().all(|&weight| weight >= 0.0) {
            return (ap.dot(n).powi(2) / n2, weights);
        }
    }
    let on_side = |from: DVec3, to: DVec3| {
        let side = to - from;
        let length2 = side.length_squared();
        let t = if length2 > 0.0 { ((p - from).dot(side) / length2).clamp(0.0, 1.0) } else { 0.0 };
        (p.distance_squared(from + side * t), t)
    };
    let [(d_ab, t_ab), (d_bc, t_bc), (d_ca, t_ca)] = [on_side(a, b), on_side(b, c), on_side(c, a)];
    if d_ab <= d_bc && d_ab <= d_ca {
        (d_ab, [1.0 - t_ab, t_ab, 0.0])
    } else if d_bc <= d_ca {
        (d_bc, [0.0, 1.0 - t_bc, t_bc])
    } else {
        (d_ca, [t_ca, 0.0, 1.0 - t_ca])
    }
}
