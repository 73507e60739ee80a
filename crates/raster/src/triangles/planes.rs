//! Numbers that are linear over the picture, such as the nearness and a color over w, from their values at three corners.

use crate::lighting::state::{Stage, State};
use crate::simd::lanes::{Simd, f32x4};
use fearless_simd::prelude::*;
use halfway_lighting::Lens;

/// Four numbers as functions of the tile's pixels (i, j): `base + dx·i + dy·j`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Slopes {
    pub(crate) base: [f32; 4],
    pub(crate) dx: [f32; 4],
    pub(crate) dy: [f32; 4],
}

/// Four numbers over a triangle: `base` at the tile's first pixel, or of tiny ones at the first that may be covered,
/// growing by `dx` and `dy` from pixel to pixel.
#[derive(Clone, Copy)]
pub(crate) struct LaneSlopes<S: Simd> {
    pub(crate) base: f32x4<S>,
    pub(crate) dx: f32x4<S>,
    pub(crate) dy: f32x4<S>,
}

/// Planes of the values interpolated over a triangle.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Planes {
    /// The nearness, and three numbers over w.
    pub(crate) lead: Slopes,
    /// Nothing, and three numbers over w.
    pub(crate) second: Slopes,
    /// The opacity and the color over w, in colored draws.
    pub(crate) paint: Slopes,
    /// The triangle's own normal.
    pub(crate) face: [f32; 3],
    /// The least and greatest nearness of its corners.
    pub(crate) range: [f32; 2],
    /// The depth, which decides what is nearest.
    pub(crate) depth: DepthPlane,
}

/// The nearness as `base + dx·(i − first) + dy·(j − first)` of the tile's pixels (i, j). Every triangle of few pixels
/// starts at the first pixel that may be covered, in all draws, so that coincident surfaces have equal depths, to the
/// bit.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct DepthPlane {
    pub(crate) base: f32,
    pub(crate) dx: f32,
    pub(crate) dy: f32,
    pub(crate) first: [i32; 2],
}

impl DepthPlane {
    /// From the first of four numbers.
    pub(crate) fn new(lead: &Slopes, first: [i32; 2]) -> Self {
        Self { base: lead.base[0], dx: lead.dx[0], dy: lead.dy[0], first }
    }
}

/// A corner of a clipped triangle: 1/w, and its weights in the triangle's corners.
pub(crate) type CutCorner = (f32, [f64; 3]);

/// The corners' positions in a form that gives slopes, in f64: for triangles that reach far beyond the tile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gradient {
    x: [f64; 3],
    y: [f64; 3],
    /// 1 over twice the area.
    inverse: f64,
}

/// A triangle flatter than this, in pixels, takes its slopes from the corners on the grid, and so does one that the
/// rounding to the grid has flipped. A covered pixel lies at most one step of the grid outside of the exact triangle,
/// so interpolated values leave the range of the corners by at most half of it.
pub(crate) const FLATTEST: f32 = 1.0 / 128.0;

impl Gradient {
    /// From the corners in pixels from the tile's first, exactly and on the grid, and the sign of the area on the
    /// picture.
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

    /// The same, with this pixel of the tile as the base.
    pub(crate) fn beginning_at(self, pixel: [i32; 2]) -> Self {
        let [i, j] = pixel.map(f64::from);
        Self { x: self.x.map(|x| x - i), y: self.y.map(|y| y - j), ..self }
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
    pub(crate) fn of_lane<S: Simd>(slopes: &LaneSlopes<S>) -> Self {
        Self { base: slopes.base.to_array(), dx: slopes.dx.to_array(), dy: slopes.dy.to_array() }
    }
}

impl Planes {
    /// Sets the triangle's own values: its opacity and color if the draw is flat, else its normal if that may be
    /// needed.
    #[inline(always)]
    pub(crate) fn set_face(&mut self, [first, x, y, z]: &[f32; 4], state: &State, lens: &Lens) {
        if state.stage == Stage::Flat {
            if state.paints() {
                // One opacity over w everywhere.
                let Slopes { base, dx, dy } = self.lead;
                let opacity = |number: f32| [first * number, 0.0, 0.0, 0.0];
                let step = |nearness: f32| opacity(lens.inverse_w_step(nearness));
                self.paint = Slopes { base: opacity(lens.inverse_w(base[0])), dx: step(dx[0]), dy: step(dy[0]) };
            }
            self.lead.base[1..].copy_from_slice(&[*x, *y, *z]);
            // Clipped corners hold a normal, which flat shading does not fill.
            self.lead.dx[1..].fill(0.0);
            self.lead.dy[1..].fill(0.0);
        } else if state.opposite_normals {
            self.face = [*x, *y, *z];
        }
    }
}
