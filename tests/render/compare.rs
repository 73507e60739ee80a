//! How far a picture is from what it should be.

use crate::render::oracle::{Colour, Hit, Oracle};
use crate::render::scene::Scene;
use halfway::prelude::*;
use image::{Rgba32FImage, RgbaImage};
use std::fmt;

/// The largest error allowed, in shares of the frame's range.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bars {
    /// Of 99.9 % of the values.
    pub(crate) most: f64,
    /// Of all of them.
    pub(crate) worst: f64,
}

/// Single-precision arithmetic over a few hundred operations, and vertices that a rasteriser may snap to 1/256 pixel.
pub(crate) const FLOAT: Bars = Bars { most: 2e-4, worst: 2e-3 };

/// Bars and measurements are shares of the brightest less the darkest expected value.
#[derive(Clone, Copy, Default)]
pub(crate) struct Measured {
    pub(crate) most: f64,
    pub(crate) worst: f64,
    /// Pixels on an edge, of the object or of its light, where the picture may go either way.
    pub(crate) edges: f64,
    /// Pixels that are not background.
    pub(crate) covered: f64,
    /// Where the worst value is, and what it is and should be: for messages.
    pub(crate) at: (u32, u32),
    pub(crate) found: [f32; 3],
    pub(crate) expected: Colour,
}

/// Within this many pixels of an edge a pixel may belong to either side: eight times the 1/256 pixel to which Vulkan
/// lets vertices be snapped, since a snapped vertex also tilts long edges.
const EDGE: f64 = 1.0 / 32.0;
/// A step of this share of the range inside the edge's width is an edge (of a spot's cone, of a face) and not a slope.
const STEP: f64 = 0.02;
/// The share of pixels that may lie on edges; more means that the scene tests nothing.
const MOST_EDGES: f64 = 0.06;

/// A scene's geometry, traced once for all that is compared on it.
pub(crate) struct Traced {
    hits: Vec<Option<Hit>>,
    width: u32,
    height: u32,
}

impl Traced {
    pub(crate) fn new(scene: &Scene, width: u32, height: u32) -> Self {
        Self { hits: Oracle::new(scene, width, height).trace(), width, height }
    }

    /// Measures a floating-point picture of `scene`, which has the geometry that was traced.
    pub(crate) fn measure(&self, scene: &Scene, picture: &Rgba32FImage, bars: Bars) -> Result<Measured, String> {
        let oracle = Oracle::new(scene, self.width, self.height);
        let seen = |hit: &Option<Hit>| hit.as_ref().map_or(oracle.background(), |hit| oracle.value(hit));
        let expected: Vec<Colour> = self.hits.iter().map(seen).collect();
        let mut measured = measure(&oracle, &expected, picture, bars)?;
        measured.covered = self.hits.iter().flatten().count() as f64 / self.hits.len() as f64;
        Ok(measured)
    }
}

/// Measures a floating-point picture of a scene, blended things included.
pub(crate) fn against_oracle(scene: &Scene, picture: &Rgba32FImage, bars: Bars) -> Result<Measured, String> {
    let (width, height) = picture.dimensions();
    let oracle = Oracle::new(scene, width, height);
    if !scene.things.iter().any(|thing| thing.blend) {
        return Traced::new(scene, width, height).measure(scene, picture, bars);
    }
    let centres = (0..height).flat_map(|y| (0..width).map(move |x| (f64::from(x) + 0.5, f64::from(y) + 0.5)));
    let expected: Vec<Colour> = centres.map(|(x, y)| oracle.seen(x, y)).collect();
    let mut measured = measure(&oracle, &expected, picture, bars)?;
    measured.covered = 1.0;
    Ok(measured)
}

/// Fails unless the picture of `scene` is what the oracle says, within [`FLOAT`].
pub(crate) fn assert_as_expected(row: &str, scene: &Scene, picture: &Rgba32FImage) -> Measured {
    let measured = against_oracle(scene, picture, FLOAT).unwrap_or_else(|what| panic!("{row}: {what}"));
    measured.assert_within(row, FLOAT);
    measured
}

/// The rows of a table that failed, so that one does not hide the others.
#[derive(Default)]
pub(crate) struct Failures(Vec<String>);

impl Failures {
    pub(crate) fn unless(&mut self, holds: bool, what: impl FnOnce() -> String) {
        if !holds {
            self.0.push(what());
        }
    }

    /// Adds the row unless the picture of `scene` shows something, and is what the oracle says within `bars`.
    pub(crate) fn compare(&mut self, row: &str, scene: &Scene, picture: &Rgba32FImage, bars: Bars) {
        if let Some(measured) = self.compare_any(row, scene, picture, bars) {
            self.unless(measured.covered > 0.0, || format!("{row} shows nothing"));
        }
    }

    /// Adds the row unless the picture of `scene`, which may be empty, is what the oracle says within `bars`.
    pub(crate) fn compare_any(
        &mut self,
        row: &str,
        scene: &Scene,
        picture: &Rgba32FImage,
        bars: Bars,
    ) -> Option<Measured> {
        match against_oracle(scene, picture, bars) {
            Ok(measured) => {
                let within = measured.most <= bars.most && measured.worst <= bars.worst;
                self.unless(within, || format!("{row}: {measured} is over {bars:?}"));
                Some(measured)
            }
            Err(what) => {
                self.0.push(format!("{row}: {what}"));
                None
            }
        }
    }

    /// Panics with every row that failed.
    pub(crate) fn finish(self) {
        assert!(self.0.is_empty(), "{} rows failed:\n{}", self.0.len(), self.0.join("\n"));
    }
}

impl fmt::Display for Measured {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { most, worst, edges, covered, at, found, expected } = self;
        write!(f, "99.9 % within {most:.1e}, all within {worst:.1e}, {:.1} % on edges, ", edges * 100.0)?;
        write!(f, "{:.0} % covered; the worst at {at:?} is {found:?} instead of {expected:.4?}", covered * 100.0)
    }
}

impl Measured {
    pub(crate) fn assert_within(&self, row: &str, bars: Bars) {
        assert!(self.most <= bars.most && self.worst <= bars.worst, "{row}: {self} is over {bars:?}");
    }

    /// The worse of both, figure by figure.
    pub(crate) fn or(self, other: Self) -> Self {
        Self {
            most: self.most.max(other.most),
            edges: self.edges.max(other.edges),
            covered: self.covered.min(other.covered),
            ..if self.worst < other.worst { other } else { self }
        }
    }
}

fn measure(oracle: &Oracle, expected: &[Colour], picture: &Rgba32FImage, bars: Bars) -> Result<Measured, String> {
    let (width, height) = oracle.size();
    assert_eq!(picture.dimensions(), (width, height));
    let values = || expected.iter().flatten().copied();
    let (low, high) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    // A picture of one colour has no range of its own: its brightness, or 1 where it is black.
    let range = [high - low, high, 1.0].into_iter().find(|range| *range > 1e-12).unwrap_or(1.0);
    let mut errors = Vec::with_capacity(expected.len() * 3);
    let mut measured = Measured::default();
    let mut edges = 0;
    for ((x, y, pixel), expected) in picture.enumerate_pixels().zip(expected) {
        let [red, green, blue, alpha] = pixel.0;
        let found = [red, green, blue];
        if let Some(bad) = found.into_iter().find(|v| !(v.is_finite() && *v >= 0.0)) {
            return Err(format!("pixel ({x}, {y}) holds {bad}"));
        }
        if alpha != 1.0 {
            return Err(format!("pixel ({x}, {y}) has the alpha {alpha}, and a picture is opaque"));
        }
        let of_pixel = [0, 1, 2].map(|k| (f64::from(found[k]) - expected[k]).abs() / range);
        let largest = of_pixel.into_iter().fold(0.0, f64::max);
        let sides = if largest > bars.most { edge(oracle, x, y, STEP * range) } else { None };
        if let Some([low, high]) = sides {
            edges += 1;
            let outside = |k: usize| (low[k] - f64::from(found[k])).max(f64::from(found[k]) - high[k]) / range;
            if (0..3).any(|k| outside(k) > bars.worst) {
                return Err(format!("pixel ({x}, {y}) is {found:?}, and its edge has sides from {low:?} to {high:?}"));
            }
            continue;
        }
        if largest > measured.worst {
            measured = Measured { worst: largest, at: (x, y), found, expected: *expected, ..measured };
        }
        errors.extend(of_pixel);
    }
    errors.sort_by(f64::total_cmp);
    measured.most = errors.get((errors.len() as f64 * 0.999) as usize).copied().unwrap_or(measured.worst);
    measured.edges = f64::from(edges) / expected.len() as f64;
    if measured.edges > MOST_EDGES {
        return Err(format!("{:.1} % of the pixels lie on edges", measured.edges * 100.0));
    }
    Ok(measured)
}

/// The least and the largest value around a pixel's centre, if it lies on an edge. Layers behind the nearest count too:
/// on a silhouette snapped vertices may open a gap between two faces.
fn edge(oracle: &Oracle, x: u32, y: u32, step: f64) -> Option<[Colour; 2]> {
    let centre = (f64::from(x) + 0.5, f64::from(y) + 0.5);
    let around = [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)];
    let at = around.map(|(dx, dy)| (centre.0 + EDGE * f64::from(dx), centre.1 + EDGE * f64::from(dy)));
    let bounds = |of: &[Colour]| {
        let bound = |pick: fn(f64, f64) -> f64| [0, 1, 2].map(|k| of.iter().map(|c| c[k]).reduce(pick).unwrap_or(0.0));
        [bound(f64::min), bound(f64::max)]
    };
    let mut values: Vec<Colour> = at.iter().map(|&(x, y)| oracle.seen(x, y)).collect();
    let hits = at.map(|(x, y)| oracle.hits(x, y));
    let faces = hits.each_ref().map(|hits| hits.first().map(|hit| (hit.thing, hit.triangle)));
    if faces.iter().any(|face| *face != faces[0]) {
        values.extend(hits.iter().flatten().map(|hit| oracle.value(hit)));
        return Some(bounds(&values));
    }
    let [low, high] = bounds(&values);
    (0..3).any(|k| high[k] - low[k] > step).then_some([low, high])
}

/// The 8-bit value of an intensity, before it is rounded to a whole step.
pub(crate) fn encoded(intensity: f64, encoding: Encoding) -> f64 {
    let clamped = intensity.clamp(0.0, 1.0);
    let curve = match encoding {
        Encoding::Raw => clamped,
        // IEC 61966-2-1.
        Encoding::Srgb if clamped <= 0.003_130_8 => 12.92 * clamped,
        Encoding::Srgb => 1.055 * clamped.powf(1.0 / 2.4) - 0.055,
    };
    255.0 * curve
}

/// Fails unless every pixel of an 8-bit picture is at most one step from the floating-point picture of the same scene,
/// which has been compared with the oracle.
pub(crate) fn assert_same_in_bytes(row: &str, float: &Rgba32FImage, bytes: &RgbaImage, encoding: Encoding) {
    assert_eq!(float.dimensions(), bytes.dimensions(), "{row}");
    for ((x, y, float), (_, _, byte)) in float.enumerate_pixels().zip(bytes.enumerate_pixels()) {
        for k in 0..3 {
            let expected = encoded(f64::from(float.0[k]), encoding);
            // The nearest step is within a half; an encoding table may be off by another half.
            assert!(
                (f64::from(byte.0[k]) - expected).abs() <= 1.0,
                "{row}: pixel ({x}, {y}) is {:?}; expected {expected:.2} in channel {k}",
                byte.0
            );
        }
        assert_eq!(byte.0[3], 255, "{row}: pixel ({x}, {y}) is not opaque");
    }
}

/// The largest difference of two pictures, channel by channel.
pub(crate) fn difference(a: &Rgba32FImage, b: &Rgba32FImage) -> f32 {
    assert_eq!(a.dimensions(), b.dimensions());
    a.iter().zip(b.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// The brightest channel of a picture.
pub(crate) fn brightest(picture: &Rgba32FImage) -> f32 {
    picture.pixels().flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2]]).fold(0.0, f32::max)
}

/// Fails unless two pictures are the same to the bit.
pub(crate) fn assert_identical(row: &str, a: &Rgba32FImage, b: &Rgba32FImage) {
    assert_eq!(a.dimensions(), b.dimensions(), "{row}");
    let bits = |image: &Rgba32FImage| image.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert!(bits(a) == bits(b), "{row}: the pictures differ by up to {}", difference(a, b));
}

/// Fails unless every channel of a picture is finite and 0 or more.
pub(crate) fn assert_finite(row: &str, picture: &Rgba32FImage) {
    for (x, y, pixel) in picture.enumerate_pixels() {
        assert!(pixel.0.iter().all(|v| v.is_finite() && *v >= 0.0), "{row}: pixel ({x}, {y}) is {:?}", pixel.0);
    }
}
