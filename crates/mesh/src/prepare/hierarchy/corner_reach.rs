//! How far the points of a triangle are from its corners.

use crate::prepare::nearest::TriangleCorners;

/// The farthest that a point of a triangle is from the nearest of its corners.
///
/// Nothing is farther from all corners than where the regions that each is nearest to meet, or meet a side: of an acute
/// triangle that is the middle of the circle through its corners; of another the longest side, where the bisector of
/// the second longest crosses it. It is no more than the longest side over √3 (Jung 1901).
pub(super) fn corner_reach([a, b, c]: TriangleCorners) -> f64 {
    let mut sides2 = [a.distance_squared(b), b.distance_squared(c), c.distance_squared(a)];
    sides2.sort_unstable_by(f64::total_cmp);
    let [p, q, r] = sides2;
    if r <= 0.0 {
        0.0
    } else if r >= p + q {
        q * r.sqrt() / (q + r - p)
    } else {
        let jung = (r / 3.0).sqrt();
        // Twice the area. What rounding leaves of a small one makes no circle larger than it can be.
        let across = (b - a).cross(c - a).length();
        (p.sqrt() * q.sqrt() * r.sqrt() / (2.0 * across)).min(jung)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_math::DVec3;

    /// Into so many parts sides are cut.
    const STEPS: u32 = 60;

    /// By many points of many triangles, acute and obtuse, thin and of no area.
    #[test]
    fn no_point_is_farther_from_all_corners_and_one_is_as_far() {
        let mut state = 7_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as f64 / f64::from(1 << 24) - 0.5
        };
        let (mut obtuse, mut acute) = (0, 0);
        for number in 0..400 {
            let mut corner = || DVec3::new(random(), random(), random());
            let [a, b, mut c] = [corner(), corner(), corner()];
            if number % 4 == 0 {
                c = a.lerp(b, 0.1 * f64::from(number % 11)) + 1e-3 * f64::from(number % 3) * (c - a);
            }
            let corners = [a, b, c];
            let said = corner_reach(corners);
            let mut found = 0.0_f64;
            for i in 0..=STEPS {
                for j in 0..=STEPS - i {
                    let [u, v] = [i, j].map(|step| f64::from(step) / f64::from(STEPS));
                    let p = a + u * (b - a) + v * (c - a);
                    found = found.max(corners.map(|corner| p.distance(corner)).into_iter().fold(f64::MAX, f64::min));
                }
            }
            let mut sides = [a.distance(b), b.distance(c), c.distance(a)];
            sides.sort_unstable_by(f64::total_cmp);
            assert!(found <= said * (1.0 + 1e-9), "{corners:?}: {found} where {said} is said");
            // Points are a part of a side apart.
            assert!(found >= said - sides[2] / f64::from(STEPS), "{corners:?}: {found} where {said} is said");
            assert!(said <= 1.000_001 * sides[2] / 3f64.sqrt() && said >= 0.499_999 * sides[1]);
            let is_obtuse = sides[2].powi(2) > sides[0].powi(2) + sides[1].powi(2);
            (obtuse, acute) = (obtuse + u32::from(is_obtuse), acute + u32::from(!is_obtuse));
        }
        assert!(obtuse > 50 && acute > 50, "{obtuse} and {acute}");
        let [a, b] = [DVec3::ZERO, DVec3::X];
        for (corners, reach) in
            [([a; 3], 0.0), ([a, a, b], 0.5), ([a, b, 0.5 * b], 0.25), ([a, b, DVec3::Y], 0.5f64.sqrt())]
        {
            assert!((corner_reach(corners) - reach).abs() < 1e-12, "{corners:?}: {}", corner_reach(corners));
        }
    }
}
