//! Interpolation in space, on the picture, and along scan lines.

use halfway::reference::{Interpolation, PolygonCorner};
use std::f64::consts::{FRAC_PI_2, PI};

use super::prelude::*;

/// A strip from left to right whose right end is `ratio` times as far away; u goes from 0 to 1 along it, v across.
fn receding(ratio: f64) -> [PolygonCorner<2>; 4] {
    [(-0.9, -0.9, 1.0), (0.9, -0.9, ratio), (0.9, 0.9, ratio), (-0.9, 0.9, 1.0)].map(|(x, y, w)| {
        let of_side = |side: f64| if side > 0.0 { 1.0 } else { 0.0 };
        // Farther points are projected smaller.
        PolygonCorner { at: [x, y / w], w, value: [of_side(x), of_side(y)] }
    })
}

/// The largest error along the middle of the strip.
fn error(how: Interpolation, ratio: f64) -> f64 {
    let strip = receding(ratio);
    let off = |i: i32| {
        let point = [f64::from(i) / 500.0 * 0.9, 0.0];
        let [own, right] = [how, Interpolation::Perspective].map(|how| how.at(&strip, point));
        own.zip(right).map_or(0.0, |([own, _], [right, _])| (own - right).abs())
    };
    (-499..500).map(off).fold(0.0, f64::max)
}

/// The value at the middle of a square with corners of 1, 0, 1 and 0, turned by an angle.
fn middle(how: Interpolation, angle: f64) -> f64 {
    let square: [PolygonCorner<1>; 4] = std::array::from_fn(|i| {
        let (y, x) = (angle + i as f64 * FRAC_PI_2).sin_cos();
        PolygonCorner { at: [x, y], w: 1.0, value: [((i + 1) % 2) as f64] }
    });
    how.at(&square, [0.0, 0.0]).map_or(0.0, |[value]| value)
}

/// The strip with a checkerboard of 16 × 6 fields that are equally large in space.
fn checkerboard(how: Interpolation) -> Image {
    let strip = receding(6.0);
    let at = |i: u32, size: u32| (f64::from(i) + 0.5) / f64::from(size) * 2.0 - 1.0;
    let pixel = |i: u32| {
        let point = [at(i % SIZE.x, SIZE.x), at(i / SIZE.x, SIZE.y)];
        let is_bright = |[u, v]: [f64; 2]| (16.0 * PI * u).sin() * (6.0 * PI * v).sin() > 0.0;
        [how.at(&strip, point).map_or(0.0, |uv| if is_bright(uv) { 0.85 } else { 0.15 }); 3]
    };
    Image::new(SIZE.x, SIZE.y, (0..SIZE.x * SIZE.y).map(pixel).collect())
}

#[expect(clippy::unnecessary_wraps, reason = "as every page")]
pub(super) fn page() -> Result<FailurePage, ChartError> {
    let ratios: Vec<f64> = (0..=24).map(|i| 10f64.powf(f64::from(i) / 12.0)).collect();
    let errors = [Interpolation::Screen, Interpolation::ScanLine].map(|how| {
        let points: Vec<_> = ratios.iter().map(|&ratio| (ratio, error(how, ratio))).collect();
        series(how.name(), usize::from(how == Interpolation::ScanLine), &points, false)
    });
    let turned = [Interpolation::Screen, Interpolation::ScanLine, Interpolation::Perspective].into_iter().enumerate();
    let turned = turned.map(|(kind, how)| {
        let value = |degrees: i32| (f64::from(degrees), middle(how, f64::from(degrees).to_radians()));
        series(how.name(), kind, &(1..90).map(value).collect::<Vec<_>>(), false)
    });
    let [right, screen, scan] = &Interpolation::ALL.map(checkerboard);
    Ok(FailurePage {
        id: "interpolation",
        title: "Interpolation on the picture is not interpolation in space",
        cause: "Halfway on the picture is not halfway on a surface that recedes: texture coordinates that are linear on the \
                picture bend along the diagonal of the two triangles. The published scan-line form is \
                linear on the picture as well, and of polygons with more than three corners it depends on how they are turned.",
        remedy: "Interpolate value/w and 1/w, as this project does; split polygons into triangles.",
        test: "interpolation_on_the_picture_is_off_by_depth_and_rotation",
        figures: vec![
            figure(
                "interpolation-depth",
                "Error of interpolation along a strip that recedes",
                [Axis::linear("depth of the far end (near end = 1)"), Axis::linear("largest error")],
                Panel::new("values from 0 to 1", errors.into()),
            )
            .named("depth"),
            figure(
                "interpolation-rotation",
                "The middle of a square with corners 1, 0, 1, 0 while it turns",
                [Axis::linear("angle (degrees)"), Axis::linear("value")],
                Panel::new("seen from the front", turned.collect()),
            )
            .named("rotation"),
        ],
        pictures: shown([
            ("perspective-correct, 6 : 1 in depth", right),
            ("linear on the picture", screen),
            ("along edges, then along the line", scan),
        ]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_on_the_picture_is_off_by_depth_and_rotation() {
        for how in [Interpolation::Screen, Interpolation::ScanLine] {
            assert!(error(how, 1.0) < 1e-12, "{how:?}");
            // t − (t/r)/(1 − t + t/r) is largest at t = √r/(1 + √r), where it is (√r − 1)/(√r + 1).
            for ratio in [2.0f64, 6.0, 100.0] {
                let root = ratio.sqrt();
                let expected = (root - 1.0) / (root + 1.0);
                assert!((error(how, ratio) - expected).abs() < 1e-3, "{how:?}, {ratio}: {}", error(how, ratio));
            }
        }
        let spread = |how| {
            let values: Vec<f64> = (1..90).map(|degrees| middle(how, f64::from(degrees).to_radians())).collect();
            values.iter().copied().fold(0.0, f64::max) - values.iter().copied().fold(1.0, f64::min)
        };
        assert!(spread(Interpolation::ScanLine) > 0.9 && spread(Interpolation::Perspective) < 1e-9);
    }
}
