//! A straight line on the picture: which pixels it covers, and by how much.

use bevy_math::{DVec2, Vec2Swizzles as _};
use std::ops::Range;

/// A line from one point of the picture to another, in pixels from the top left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Segment {
    pub(super) from: DVec2,
    pub(super) to: DVec2,
    /// At both ends, in pixels; in between it changes evenly.
    pub(super) widths: [f64; 2],
}

/// A pixel that a line reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reached {
    pub(super) x: u32,
    pub(super) y: u32,
    /// The share of the pixel that the line covers: exactly, for a line along an axis that does not end in the pixel;
    /// else that of a line along an axis at the same distance.
    pub(super) coverage: f64,
    /// The nearest point of the line, from 0 at its start to 1 at its end.
    pub(super) along: f64,
}

impl Segment {
    /// The rows of a picture of this height that it may reach.
    pub(super) fn rows(&self, height: u32) -> Range<u32> {
        let margin = 0.5 * self.widths[0].max(self.widths[1]) + 2.0;
        pixels(self.from.y.min(self.to.y) - margin, self.from.y.max(self.to.y) + margin, &(0..height))
    }

    /// Calls with each pixel that the line reaches in these rows of the picture. Its ends are round.
    pub(super) fn each(&self, width: u32, rows: &Range<u32>, mut reach: impl FnMut(Reached)) {
        let [first, last] = self.widths;
        // Beside the line by half its width and half a pixel there is nothing.
        let margin = 0.5 * first.max(last) + 1.0;
        let way = self.to - self.from;
        let steep = way.y.abs() > way.x.abs();
        // Along the axis in which the line is longer: in each column of pixels, or row, it takes a short piece.
        let turned = |p: DVec2| if steep { p.yx() } else { p };
        let [a, b] = [turned(self.from), turned(self.to)];
        let [a, b] = if a.x <= b.x { [a, b] } else { [b, a] };
        let slope = if b.x > a.x { (b.y - a.y) / (b.x - a.x) } else { 0.0 };
        let all = 0..width;
        let [in_columns, in_rows] = if steep { [rows, &all] } else { [&all, rows] };
        let across = margin * slope.hypot(1.0) + 1.0;
        let length2 = way.length_squared();
        let per_length2 = if length2 > 0.0 { 1.0 / length2 } else { 0.0 };
        // Farther away than this from the middle of a pixel, nothing of it is covered.
        let reach2 = (0.5 * first.max(last) + 0.5).powi(2);
        for column in pixels(a.x - margin, b.x + margin, in_columns) {
            let x = (f64::from(column) + 0.5).clamp(a.x, b.x);
            let y = a.y + slope * (x - a.x);
            for row in pixels(y - across, y + across, in_rows) {
                let [x, y] = if steep { [row, column] } else { [column, row] };
                let from_start = DVec2::new(f64::from(x), f64::from(y)) + 0.5 - self.from;
                let along = (from_start.dot(way) * per_length2).clamp(0.0, 1.0);
                let distance2 = (along * way - from_start).length_squared();
                if distance2 >= reach2 {
                    continue;
                }
                let distance = distance2.sqrt();
                let half = 0.5 * (first + along * (last - first));
                let coverage = (distance + 0.5).min(half) - (distance - 0.5).max(-half);
                if coverage > 0.0 {
                    reach(Reached { x, y, coverage: coverage.min(1.0), along });
                }
            }
        }
    }
}

/// Those of some pixels in a row that an interval meets.
pub(super) fn pixels(from: f64, to: f64, of: &Range<u32>) -> Range<u32> {
    let [from, to] = [from.floor(), to.ceil()].map(|end| end.clamp(of.start.into(), of.end.into()) as u32);
    from..to.max(from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_math::UVec2;
    use std::collections::HashMap;

    const SIZE: UVec2 = UVec2::new(40, 30);

    fn covered(from: [f64; 2], to: [f64; 2], width: f64) -> HashMap<[u32; 2], f64> {
        let mut found = HashMap::new();
        let line = Segment { from: from.into(), to: to.into(), widths: [width; 2] };
        line.each(SIZE.x, &(0..SIZE.y), |Reached { x, y, coverage, .. }| {
            assert!(found.insert([x, y], coverage).is_none(), "({x}, {y}) twice");
        });
        found
    }

    #[test]
    fn along_an_axis_it_covers_exactly_its_width() {
        for width in [0.25, 1.0, 1.5, 4.0] {
            for middle in [10.0, 10.25, 10.5, 10.9] {
                let across = |at: [u32; 2], found: &HashMap<_, f64>| found.get(&at).copied().unwrap_or(0.0);
                let level = covered([5.0, middle], [35.0, middle], width);
                let upright = covered([middle, 5.0], [middle, 25.0], width);
                for pixel in 0..30 {
                    let edges = [f64::from(pixel), f64::from(pixel) + 1.0];
                    let expected = (edges[1].min(middle + 0.5 * width) - edges[0].max(middle - 0.5 * width)).max(0.0);
                    assert!((across([20, pixel], &level) - expected).abs() < 1e-12, "{width} {middle} {pixel}");
                    assert!((across([pixel, 20], &upright) - expected).abs() < 1e-12, "{width} {middle} {pixel}");
                }
            }
        }
    }

    #[test]
    fn in_any_direction_it_covers_its_area() {
        for degrees in (0..360).step_by(7) {
            let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
            let end = [20.0 + 12.0 * cos, 15.0 + 12.0 * sin];
            let sum: f64 = covered([20.0, 15.0], end, 2.0).values().sum();
            // With two half discs at its ends. Pixels are counted by their distance alone.
            let area = 2.0 * 12.0 + std::f64::consts::PI;
            assert!((sum / area - 1.0).abs() < 0.03, "{degrees}°: {sum} instead of {area}");
        }
    }

    #[test]
    fn outside_of_the_picture_there_is_nothing() {
        assert!(covered([-50.0, -3.0], [90.0, -3.0], 2.0).is_empty());
        assert!(covered([1e9, 1e9], [2e9, 3e9], 2.0).is_empty());
        let through = covered([-1e6, 15.0], [1e6, 15.0], 1.0);
        assert_eq!(through.len(), 2 * 40);
        let point = covered([20.5, 15.5], [20.5, 15.5], 1.0);
        assert!((point[&[20, 15]] - 1.0).abs() < 1e-12);
    }
}
