//! The lens on vectors of pixels: [`Lens`]'s functions of the same names, for all lanes at once.

use crate::input::pass::Pass;
use crate::simd::lanes::{F, Simd, each, fma, splat};
use crate::vertices::placed::TILE;
use halfway_lighting::Lens;

/// How eye space falls onto the picture and its tiles.
///
/// Depths are compared by the [nearness](Lens::nearness), and what is interpolated is divided by w of clip space: it is
/// linear over the picture then. In a perspective the nearness is 1/w.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Screen {
    pub(crate) lens: Lens,
    /// 1 over the depth from the near plane to the far one.
    inverse_span: f32,
    /// Pixels = x/w·scale + center; y counts downward.
    pub(crate) scale: [f32; 2],
    pub(crate) center: [f32; 2],
    /// x and y at w = 1 in the first pixel, and their steps from a pixel to the next.
    pub(crate) way_step: [f32; 2],
    pub(crate) way_start: [f32; 2],
}

impl Screen {
    pub(crate) fn new(pass: &Pass) -> Self {
        let [width, height] = pass.size.map(f64::from);
        let [x, y] = pass.lens.scale.map(f64::from);
        let [right, up] = pass.lens.center.map(f64::from);
        Self {
            lens: pass.lens,
            inverse_span: (1.0 / (f64::from(pass.lens.far) - f64::from(pass.lens.near))) as f32,
            scale: [(0.5 * width * x) as f32, (-0.5 * height * y) as f32],
            center: [(0.5 * width * (1.0 + right)) as f32, (0.5 * height * (1.0 - up)) as f32],
            way_step: [(2.0 / (width * x)) as f32, (-2.0 / (height * y)) as f32],
            way_start: [((1.0 / width - 1.0 - right) / x) as f32, ((1.0 - 1.0 / height - up) / y) as f32],
        }
    }

    /// 1/w at a depth.
    #[inline(always)]
    pub(crate) fn inverse_w<S: Simd>(&self, simd: S, depth: F<S>) -> F<S> {
        let one = splat(simd, 1.0);
        if self.lens.is_parallel { one } else { one / depth }
    }

    /// The nearness of a depth at which 1/w is known.
    #[inline(always)]
    pub(crate) fn nearness<S: Simd>(&self, simd: S, depth: F<S>, inverse_w: F<S>) -> F<S> {
        if self.lens.is_parallel {
            (splat(simd, self.lens.far) - depth) * splat(simd, self.inverse_span)
        } else {
            inverse_w
        }
    }

    /// 1/w at a nearness.
    #[inline(always)]
    pub(crate) fn inverse_w_at<S: Simd>(&self, simd: S, nearness: F<S>) -> F<S> {
        if self.lens.is_parallel { splat(simd, 1.0) } else { nearness }
    }

    /// w at a nearness.
    #[inline(always)]
    pub(crate) fn w_at<S: Simd>(&self, simd: S, nearness: F<S>) -> F<S> {
        let one = splat(simd, 1.0);
        if self.lens.is_parallel { one } else { one / nearness }
    }

    /// The depth at a nearness at which w is known.
    #[inline(always)]
    pub(crate) fn depth_at<S: Simd>(&self, simd: S, nearness: F<S>, w: F<S>) -> F<S> {
        if self.lens.is_parallel {
            let Lens { near, far, .. } = self.lens;
            fma::<S>(nearness, splat(simd, near - far), splat(simd, far))
        } else {
            w
        }
    }

    /// Through a pixel of a tile: x and y where w is 1.
    #[inline(always)]
    pub(crate) fn way<S: Simd>(&self, simd: S, tile: [u32; 2], place: [F<S>; 2]) -> [F<S>; 2] {
        each!(axis in 2 => {
            let pixel = place[axis] + splat(simd, tile[axis] as f32 * TILE as f32);
            fma::<S>(pixel, splat(simd, self.way_step[axis]), splat(simd, self.way_start[axis]))
        })
    }
}
