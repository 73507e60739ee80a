//! How rough a surface is: what its normals differ by from those beside them.

use bevy_math::Vec3;

/// Rougher by this much, a group of fewer triangles is hardly allowed by its normals at any tolerance, in radians.
const SMOOTH: f32 = 0.01;

/// How many times that what is above it counts as the spread of a triangle's normals.
const WEIGHT: f32 = 40.0;

/// A quarter of the vertices differ from the mean of their neighbours' normals by no more than this, as unit vectors:
/// hardly by anything on what is smooth, or has sharp edges only here and there.
pub(super) fn roughness(triangles: &[[u32; 3]], normals: &[Vec3]) -> f32 {
    let mut around = vec![Vec3::ZERO; normals.len()];
    for &[a, b, c] in triangles {
        let [of_a, of_b, of_c] = [a, b, c].map(|vertex| normals[vertex as usize]);
        around[a as usize] += of_b + of_c;
        around[b as usize] += of_c + of_a;
        around[c as usize] += of_a + of_b;
    }
    let with_mean = around.iter().zip(normals).filter_map(|(sum, normal)| Some((sum.try_normalize()?, normal)));
    let mut differences: Vec<f32> = with_mean.map(|(mean, normal)| mean.distance(*normal)).collect();
    if differences.is_empty() {
        return 0.0;
    }
    let quarter = differences.len() / 4;
    *differences.select_nth_unstable_by(quarter, f32::total_cmp).1
}

/// The spread of normals that each triangle of a surface as rough as this counts with at least, 0 of what is smooth.
///
/// Normals of a rough surface are lost with the first vertices that go, and then nothing but the length of edges tells
/// whether a group will do. With this all triangles lose alike by their edges, and none becomes much longer than others
/// because its normals happen to agree.
pub(super) fn least_spread(roughness: f32) -> f32 {
    WEIGHT * (roughness - SMOOTH).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of squares in two triangles each, with normals of these slopes.
    fn spread(slope: impl Fn(u32, u32) -> f32) -> f32 {
        const SIDE: u32 = 12;
        let corner = |x: u32, y: u32| y * SIDE + x;
        let squares = (0..SIDE - 1).flat_map(|y| (0..SIDE - 1).map(move |x| (x, y)));
        let triangles: Vec<_> = squares
            .flat_map(|(x, y)| {
                let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect();
        let normals: Vec<_> =
            (0..SIDE * SIDE).map(|i| Vec3::new(slope(i % SIDE, i / SIDE), 0.0, 1.0).normalize()).collect();
        least_spread(roughness(&triangles, &normals))
    }

    #[test]
    fn what_is_smooth_or_creased_is_not_rough_and_noise_is() {
        let is_close = |a: f32, b: f32| (a - b).abs() < 1e-3;
        assert!(is_close(spread(|_, _| 0.3), 0.0), "flat");
        assert!(is_close(spread(|x, _| 0.05 * x as f32), 0.0), "round");
        assert!(is_close(spread(|x, _| if x < 6 { -0.5 } else { 0.5 }), 0.0), "creased");
        let noise = |x: u32, y: u32| if (x * 7 + y * 5).is_multiple_of(3) { 0.2 } else { -0.1 };
        assert!(spread(noise) > 1.0, "{}", spread(noise));
        assert!(is_close(roughness(&[], &[]), 0.0));
    }
}
