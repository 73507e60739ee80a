//! Polygons cut into triangles.

use glam::{DVec2, DVec3, Vec3};

use crate::origin_of_box;

/// How many corners are tested for each corner of a polygon before the rest is cut without tests. Only polygons of ten
/// thousand corners and more, or malicious ones, come near.
const PATIENCE: usize = 1 << 14;

/// Cuts a polygon of at least three corners into triangles, two fewer than it has corners, each as three numbers of
/// corners in the polygon's own winding. Returns whether the triangles do not overlap, which holds for every polygon
/// that is simple when seen along its normal; self-intersecting ones are cut all the same.
///
/// Triangles and convex polygons are cut as a fan from the first corner, others by ears (Meisters 1975, "Polygons have
/// ears"). No corner is dropped, not even where three lie in a line: neighbours may use it.
pub(super) fn cut(points: &[Vec3], mut triangle: impl FnMut([u32; 3])) -> bool {
    let count = points.len() as u32;
    let flat = match count {
        3 => {
            triangle([0, 1, 2]);
            return true;
        }
        _ => flattened(points),
    };
    let corner = |i: u32| flat[(i % count) as usize];
    let is_reflex = |i: u32| turn(corner(i + count - 1), corner(i), corner(i + 1)) < 0.0;
    if !(0..count).any(is_reflex) {
        (1..count - 1).for_each(|i| triangle([0, i, i + 1]));
        return true;
    }
    Ears::new(&flat).cut(triangle)
}

/// The corners of a polygon as [`cut`] takes them: from an origin of their own, where they are far away.
pub(super) fn near(corners: impl Iterator<Item = DVec3> + Clone, near: &mut Vec<Vec3>) {
    let min = corners.clone().fold(DVec3::INFINITY, DVec3::min);
    let max = corners.clone().fold(DVec3::NEG_INFINITY, DVec3::max);
    let origin = origin_of_box(min, max);
    near.clear();
    near.extend(corners.map(|p| (p - origin).as_vec3()));
}

/// The polygon projected along its normal (Newell's, Sutherland et al. 1974), so that it winds counter-clockwise.
/// Moved and scaled, so that no size over- or underflows.
fn flattened(points: &[Vec3]) -> Vec<DVec2> {
    let origin = points[0].as_dvec3();
    let size = points.iter().map(|p| (p.as_dvec3() - origin).abs().max_element()).fold(0.0, f64::max);
    let scale = if size > 0.0 { 1.0 / size } else { 1.0 };
    let place = |p: &Vec3| (p.as_dvec3() - origin) * scale;
    let next = points.iter().skip(1).chain(&points[..1]);
    let normal: DVec3 = points.iter().zip(next).map(|(a, b)| place(a).cross(place(b))).sum();
    let [x, y, z] = normal.abs().to_array();
    let seen = |p: DVec3| {
        if z >= x && z >= y {
            DVec2::new(p.x, p.y * normal.z.signum())
        } else if y >= x {
            DVec2::new(p.z, p.x * normal.y.signum())
        } else {
            DVec2::new(p.y, p.z * normal.x.signum())
        }
    };
    points.iter().map(|p| seen(place(p))).collect()
}

/// Twice the area of a triangle: positive where it turns left at b.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - b)
}

/// The remaining polygon, as a ring of corners.
struct Ears<'a> {
    points: &'a [DVec2],
    next: Vec<u32>,
    previous: Vec<u32>,
    /// The corners that did not turn left when they were last counted, and how many corners there were then; no other
    /// corner lies in an ear.
    reflex: Vec<u32>,
    counted: usize,
    left: usize,
    patience: usize,
}

impl<'a> Ears<'a> {
    fn new(points: &'a [DVec2]) -> Self {
        let count = points.len() as u32;
        Self {
            points,
            next: (0..count).map(|i| (i + 1) % count).collect(),
            previous: (0..count).map(|i| (i + count - 1) % count).collect(),
            reflex: (0..count).collect(),
            counted: usize::MAX,
            left: points.len(),
            patience: PATIENCE.saturating_mul(points.len()),
        }
    }

    fn cut(mut self, mut triangle: impl FnMut([u32; 3])) -> bool {
        let mut clean = true;
        let mut at = 0;
        let mut since_ear = 0;
        while self.left > 3 {
            if self.left <= self.counted / 2 {
                self.count_reflex();
            }
            let (before, after) = (self.previous[at as usize], self.next[at as usize]);
            let stuck = since_ear >= self.left;
            if stuck || self.is_ear(before, at, after) {
                clean &= !stuck;
                triangle([before, at, after]);
                self.next[before as usize] = after;
                self.previous[after as usize] = before;
                // A removed corner points at itself.
                self.next[at as usize] = at;
                self.left -= 1;
                since_ear = 0;
                // Not the neighbouring corner, which would make slivers around one corner.
                at = self.next[after as usize];
            } else {
                since_ear += 1;
                at = after;
            }
        }
        let last = [self.previous[at as usize], at, self.next[at as usize]];
        triangle(last);
        let [a, b, c] = last.map(|i| self.points[i as usize]);
        // All other triangles wind as the polygon; the surplus of a self-intersecting polygon is left for the last. The
        // coordinates are of size 1.
        clean && self.patience > 0 && turn(a, b, c) > -1e-12
    }

    /// Counts the reflex corners. In a simple polygon, convex corners stay convex while ears are cut.
    fn count_reflex(&mut self) {
        let Self { points, next, previous, reflex, .. } = self;
        reflex.retain(|&i| {
            let (before, after) = (previous[i as usize], next[i as usize]);
            let [a, b, c] = [before, i, after].map(|i| points[i as usize]);
            after != i && turn(a, b, c) <= 0.0
        });
        self.counted = self.left;
    }

    /// Whether the corner turns left, and no other lies in its triangle.
    fn is_ear(&mut self, before: u32, at: u32, after: u32) -> bool {
        let [a, b, c] = [before, at, after].map(|i| self.points[i as usize]);
        if turn(a, b, c) <= 0.0 {
            return false;
        }
        for &other in &self.reflex {
            if self.patience == 0 {
                return true;
            }
            self.patience -= 1;
            let is_left = self.next[other as usize] != other;
            let p = self.points[other as usize];
            // Where a polygon touches itself, as a bridge to a hole does, equal points do not block each other.
            let is_apart = p != a && p != b && p != c;
            if is_left && is_apart && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0 {
                return false;
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cuts a polygon and checks that the triangles have its winding and its area; returns them.
    fn check(name: &str, points: &[Vec3]) -> Vec<[u32; 3]> {
        let mut triangles = Vec::new();
        assert!(cut(points, |triangle| triangles.push(triangle)), "{name}");
        assert_eq!(triangles.len(), points.len() - 2, "{name}");
        let flat = flattened(points);
        let at = |i: u32| flat[i as usize];
        let areas: Vec<f64> = triangles.iter().map(|&[a, b, c]| turn(at(a), at(b), at(c))).collect();
        let count = points.len();
        let whole: f64 = (0..count).map(|i| flat[i].perp_dot(flat[(i + 1) % count])).sum();
        assert!(areas.iter().all(|area| *area >= 0.0), "{name}: {areas:?}");
        // Sums of f64 of size 1.
        assert!((areas.iter().sum::<f64>() - whole).abs() < 1e-9 * count as f64, "{name}");
        triangles
    }

    fn polygon(points: &[[f32; 2]]) -> Vec<Vec3> {
        points.iter().map(|&[x, y]| Vec3::new(x, y, 0.0)).collect()
    }

    #[test]
    fn polygons_are_covered_once() {
        let comb: Vec<[f32; 2]> = (0..40)
            .flat_map(|i| [[i as f32, 1.0], [i as f32 + 0.5, 0.1]])
            .chain([[40.0, 0.0], [0.0, 0.0]])
            .rev()
            .collect();
        let star: Vec<[f32; 2]> = (0..50)
            .map(|i| {
                let (angle, r) = (i as f32 * std::f32::consts::TAU / 50.0, if i % 2 == 0 { 1.0 } else { 0.3 });
                [r * angle.cos(), r * angle.sin()]
            })
            .collect();
        let rows: [(&str, &[[f32; 2]]); 8] = [
            ("square", &[[0., 0.], [1., 0.], [1., 1.], [0., 1.]]),
            ("dart", &[[0., 0.], [2., -1.], [0., 3.], [-2., -1.]]),
            ("dart from a wing", &[[2., -1.], [0., 3.], [-2., -1.], [0., 0.]]),
            ("L", &[[0., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.]]),
            ("corner in a line", &[[0., 0.], [1., 0.], [2., 0.], [1., 0.5], [1., 2.], [0., 2.]]),
            (
                "bridge to a hole",
                &[[0., 0.], [4., 0.], [4., 4.], [0., 4.], [0., 0.], [1., 1.], [1., 3.], [3., 3.], [3., 1.], [1., 1.]],
            ),
            ("comb", &comb),
            ("star", &star),
        ];
        for (name, points) in rows {
            let flat = polygon(points);
            check(name, &flat);
            let reversed: Vec<Vec3> = flat.iter().rev().copied().collect();
            check(&format!("{name}, reversed"), &reversed);
            // In other planes, far off and at other sizes.
            for (size, shift) in [(1e-15, 0.0), (1e15, 0.0), (1.0, 100.0)] {
                let tilted: Vec<Vec3> =
                    flat.iter().map(|p| Vec3::new(p.y, p.x + 2.0 * p.y, p.x) * size + Vec3::splat(shift)).collect();
                check(&format!("{name}, {size}, {shift}"), &tilted);
            }
        }
        assert_eq!(check("square", &polygon(rows[0].1)), [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn polygons_of_thousands_of_corners_are_covered_once() {
        let spiral = |i: i32| {
            let (angle, r) = (i.abs() as f32 * 0.05, i.abs() as f32 * 0.01 + if i < 0 { 0.5 } else { 1.0 });
            [r * angle.cos(), r * angle.sin()]
        };
        let corners: Vec<[f32; 2]> = (0..1500).map(spiral).chain((1..1500).rev().map(|i| spiral(-i))).collect();
        check("spiral", &polygon(&corners));
    }

    #[test]
    fn invalid_polygons_give_as_many_triangles() {
        let bow = polygon(&[[0., 0.], [1., 1.], [1., 0.], [0., 1.], [0.5, 3.0]]);
        let zigzag: Vec<Vec3> = (0..500).map(|i| Vec3::new((i * 37 % 101) as f32, (i * 53 % 89) as f32, 0.0)).collect();
        for points in [vec![Vec3::ZERO; 5], vec![Vec3::X, Vec3::Y, Vec3::X, Vec3::Y], bow, zigzag] {
            let mut count = 0;
            cut(&points, |triangle| {
                count += 1;
                assert!(triangle.iter().all(|&i| (i as usize) < points.len()));
            });
            assert_eq!(count, points.len() - 2);
        }
    }
}
