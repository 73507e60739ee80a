//! Numbers that are linear over the picture, such as 1/w and a color over w, from their values at three corners.

use crate::lanes::{Simd, each, f32x4, max_one, min_one};
use fearless_simd::prelude::*;

/// Four numbers as functions of the tile's pixels (i, j): `base + dx·i + dy·j`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Slopes {
    pub(crate) base: [f32; 4],
    pub(crate) dx: [f32; 4],
    pub(crate) dy: [f32; 4],
}

/// What is interpolated over a triangle.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Planes {
    /// 1/w, and three numbers over w.
    pub(crate) lead: Slopes,
    /// Nothing, and three numbers over w.
    pub(crate) second: Slopes,
    /// The triangle's own normal.
    pub(crate) face: [f32; 3],
    /// The least and greatest 1/w of its corners.
    pub(crate) range: [f32; 2],
}

/// The corners' places in a form that makes slopes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gradient<T> {
    x: [T; 3],
    y: [T; 3],
    /// 1 over twice the area.
    inverse: T,
}

/// A triangle flatter than this, in pixels, takes its slopes from the corners on the grid, so that it covers no pixel that
/// lies far outside of what slopes were made from.
const FLATTEST: f32 = 1.0 / 32.0;

impl Gradient<f32> {
    /// From the corners in pixels from the tile's first.
    #[inline(always)]
    pub(crate) fn new(x: [f32; 3], y: [f32; 3]) -> Self {
        let area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
        Self { x, y, inverse: 1.0 / area }
    }

    /// Whether the triangle is neither flat nor turned over by the rounding to the grid, where its area's sign is given.
    /// If it is, slopes are made from the corners on the grid.
    #[inline(always)]
    pub(crate) fn is_sound(&self, positive: bool) -> bool {
        let longest = max_one(extent(self.x), extent(self.y));
        let inverse = if positive { self.inverse } else { -self.inverse };
        inverse > 0.0 && inverse * (longest * FLATTEST) <= 1.0
    }

    /// The slopes of four numbers.
    #[inline(always)]
    pub(crate) fn slopes<S: Simd>(&self, simd: S, values: [&[f32; 4]; 3]) -> Slopes {
        let v = each!(k in 3 => f32x4::from_slice(simd, values[k]));
        let (d1, d2) = (v[1] - v[0], v[2] - v[0]);
        let [x0, x1, x2] = self.x;
        let [y0, y1, y2] = self.y;
        let dx = (d1 * (y2 - y0) - d2 * (y1 - y0)) * self.inverse;
        let dy = (d2 * (x1 - x0) - d1 * (x2 - x0)) * self.inverse;
        let base = v[0] - dx * x0 - dy * y0;
        Slopes { base: array(base), dx: array(dx), dy: array(dy) }
    }
}

#[inline(always)]
fn extent(v: [f32; 3]) -> f32 {
    max_one(max_one(v[0], v[1]), v[2]) - min_one(min_one(v[0], v[1]), v[2])
}

#[inline(always)]
fn array<S: Simd>(v: f32x4<S>) -> [f32; 4] {
    let mut out = [0.0; 4];
    v.store_slice(&mut out);
    out
}

impl Gradient<f64> {
    /// The same in f64, for triangles that reach far beyond the tile.
    pub(crate) fn new(x: [f64; 3], y: [f64; 3], on_grid: ([f64; 3], [f64; 3]), positive: bool) -> Self {
        let area = |x: [f64; 3], y: [f64; 3]| (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
        let extent =
            |v: [f64; 3]| v.iter().copied().fold(f64::MIN, f64::max) - v.iter().copied().fold(f64::MAX, f64::min);
        let exact = area(x, y);
        let signed = if positive { exact } else { -exact };
        if signed >= extent(x).max(extent(y)) * f64::from(FLATTEST) {
            Self { x, y, inverse: 1.0 / exact }
        } else {
            let (x, y) = on_grid;
            Self { x, y, inverse: 1.0 / area(x, y) }
        }
    }

    /// The slopes of four numbers.
    pub(crate) fn slopes(&self, values: [&[f32; 4]; 3]) -> Slopes {
        let [x0, x1, x2] = self.x;
        let [y0, y1, y2] = self.y;
        let mut slopes = Slopes::default();
        for k in 0..4 {
            let [v0, v1, v2] = values.map(|v| f64::from(v[k]));
            let dx = ((v1 - v0) * (y2 - y0) - (v2 - v0) * (y1 - y0)) * self.inverse;
            let dy = ((v2 - v0) * (x1 - x0) - (v1 - v0) * (x2 - x0)) * self.inverse;
            slopes.base[k] = (v0 - dx * x0 - dy * y0) as f32;
            (slopes.dx[k], slopes.dy[k]) = (dx as f32, dy as f32);
        }
        slopes
    }
}

impl Slopes {
    /// The same everywhere.
    pub(crate) fn constant(value: [f32; 3]) -> Self {
        Self { base: [0.0, value[0], value[1], value[2]], ..Self::default() }
    }
}
