//! A disc on the picture: which pixels it covers, and by how much.

use crate::lines::segment::pixels;
use bevy_math::DVec2;
use halfway_lighting::equations::Transcendental as _;
use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

/// Above this radius the rim is as good as straight in a pixel.
const LARGE: f64 = 1e4;

/// A disc, in pixels from the top left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Disc {
    pub(super) middle: DVec2,
    pub(super) radius: f64,
}

impl Disc {
    /// Calls with each pixel that the disc reaches in these rows of the picture, and the share of the pixel that it covers,
    /// exactly.
    pub(super) fn each(&self, width: u32, rows: &Range<u32>, mut reach: impl FnMut(u32, u32, f64)) {
        let Self { middle, radius } = *self;
        let columns = pixels(middle.x - radius, middle.x + radius, &(0..width));
        for y in pixels(middle.y - radius, middle.y + radius, rows) {
            let [above, below] = [0.0, 1.0].map(|edge| f64::from(y) + edge - middle.y);
            // Of the pixels on the left: the areas in and above their row.
            let mut before = None;
            for x in columns.clone() {
                let left = f64::from(x) - middle.x;
                let nearest = DVec2::new(left.max(-left - 1.0).max(0.0), above.max(-below).max(0.0));
                let farthest = DVec2::new((left + 0.5).abs() + 0.5, (above + 0.5).abs() + 0.5);
                let share = if nearest.length_squared() >= radius * radius {
                    0.0
                } else if farthest.length_squared() <= radius * radius {
                    1.0
                } else if radius > LARGE {
                    (radius + 0.5 - DVec2::new(left + 0.5, above + 0.5).length()).clamp(0.0, 1.0)
                } else {
                    let row = |x: f64| self.area(x, below) - self.area(x, above);
                    let [start, end] = [before.unwrap_or_else(|| row(left)), row(left + 1.0)];
                    before = Some(end);
                    (end - start).clamp(0.0, 1.0)
                };
                if share > 0.0 {
                    reach(x, y, share);
                }
                // Nothing was integrated.
                if share <= 0.0 || share >= 1.0 {
                    before = None;
                }
            }
        }
    }

    /// The area of the part of the disc to the left of x and above y, both from its middle.
    fn area(&self, x: f64, y: f64) -> f64 {
        let radius = self.radius;
        let (x, y) = (x.clamp(-radius, radius), y.clamp(-radius, radius));
        // The chord at y reaches from −c to c.
        let c = (radius * radius - y * y).max(0.0).sqrt();
        let within = x.clamp(-c, c);
        let cap = self.below_rim(within) - self.below_rim(-c) - y.abs() * (within + c);
        if y < 0.0 { cap } else { 2.0 * (self.below_rim(x) + self.below_rim(radius)) - cap }
    }

    /// The integral of √(r² − t²) over t from 0 to x.
    fn below_rim(&self, x: f64) -> f64 {
        let height = (self.radius * self.radius - x * x).max(0.0).sqrt();
        let angle = if height > 0.0 { (x / height).arc_tangent() } else { FRAC_PI_2.copysign(x) };
        0.5 * (x * height + self.radius * self.radius * angle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_math::UVec2;
    use std::f64::consts::PI;

    fn covered(middle: [f64; 2], radius: f64) -> Vec<([u32; 2], f64)> {
        let mut found = Vec::new();
        Disc { middle: middle.into(), radius }.each(40, &(0..30), |x, y, share| found.push(([x, y], share)));
        found
    }

    #[test]
    fn it_covers_its_area() {
        for radius in [0.1, 0.5, 0.7, 1.0, 2.0, 3.3, 10.0] {
            for middle in [[20.0, 15.0], [20.5, 15.5], [20.25, 15.7], [19.99, 14.01]] {
                let sum: f64 = covered(middle, radius).iter().map(|(_, share)| share).sum();
                assert!((sum - PI * radius * radius).abs() < 1e-9, "{radius} at {middle:?}: {sum}");
            }
        }
    }

    #[test]
    fn each_pixel_has_its_share() {
        // Half of a pixel's width: the disc in it.
        let in_one = covered([20.5, 15.5], 0.5);
        assert!(in_one.len() == 1 && in_one[0].0 == [20, 15] && (in_one[0].1 - PI / 4.0).abs() < 1e-12);
        // A quarter of it in each.
        let in_four = covered([20.0, 15.0], 0.5);
        assert_eq!(in_four.len(), 4);
        assert!(in_four.iter().all(|(_, share)| (share - PI / 16.0).abs() < 1e-12));
        // Sampled finely, in all pixels.
        let (middle, radius) = (DVec2::new(20.3, 14.6), 2.4);
        for ([x, y], share) in covered(middle.to_array(), radius) {
            const STEPS: u32 = 200;
            let inside = (0..STEPS * STEPS).filter(|i| {
                let place = DVec2::new(f64::from(i % STEPS) + 0.5, f64::from(i / STEPS) + 0.5) / f64::from(STEPS);
                (UVec2::new(x, y).as_dvec2() + place - middle).length() < radius
            });
            let sampled = inside.count() as f64 / f64::from(STEPS * STEPS);
            assert!((share - sampled).abs() < 2e-3, "({x}, {y}): {share} instead of {sampled}");
        }
    }

    #[test]
    fn large_ones_and_those_outside() {
        assert!(covered([-50.0, 15.0], 40.0).is_empty());
        assert!(covered([20.0, 15.0], 1e9).iter().all(|(_, share)| *share >= 1.0));
        assert_eq!(covered([20.0, 15.0], 1e9).len(), 40 * 30);
        // The rim of a large one, by its distance.
        let rim = covered([20.0 - 2e4, 15.0], 2e4);
        let share = rim.iter().find(|(at, _)| *at == [19, 15]).map(|(_, share)| *share);
        assert!(share.is_some_and(|share| (share - 1.0).abs() < 1e-3), "{share:?}");
    }
}
