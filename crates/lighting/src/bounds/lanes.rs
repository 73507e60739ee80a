//! Angles and vectors on lanes: the text of `angle.rs`, operation by operation.

use super::angle::Angle;
use super::chunk::CHUNK;
use super::receiver::Receiver;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, mask32x8};

pub(super) type F<S> = f32x8<S>;
pub(super) type M<S> = mask32x8<S>;
pub(super) type V3<S> = [F<S>; 3];

/// 32 ε, as in [`slack`](super::angle::slack).
pub(super) const SLACK: f32 = 32.0 * f32::EPSILON;

/// An angle in [0, π] as cosine and sine.
#[derive(Clone, Copy)]
pub(super) struct WideAngle<S: Simd> {
    pub(super) cos: F<S>,
    pub(super) sin: F<S>,
}

#[inline(always)]
pub(super) fn splat<S: Simd>(simd: S, x: f32) -> F<S> {
    F::<S>::splat(simd, x)
}

#[inline(always)]
pub(super) fn splat3<S: Simd>(simd: S, v: [f32; 3]) -> V3<S> {
    [splat(simd, v[0]), splat(simd, v[1]), splat(simd, v[2])]
}

#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, from: &[f32; CHUNK]) -> F<S> {
    F::<S>::from_slice(simd, from)
}

#[inline(always)]
pub(super) fn load3<S: Simd>(simd: S, from: &[[f32; CHUNK]; 3]) -> V3<S> {
    [load(simd, &from[0]), load(simd, &from[1]), load(simd, &from[2])]
}

#[inline(always)]
pub(super) fn stored<S: Simd>(x: F<S>) -> [f32; CHUNK] {
    let mut to = [0.0; CHUNK];
    x.store_slice(&mut to);
    to
}

/// Of numbers, the larger; the sign of a zero does not matter here.
#[inline(always)]
pub(super) fn max<S: Simd>(a: F<S>, b: F<S>) -> F<S> {
    SimdBase::max(a, b)
}

#[inline(always)]
pub(super) fn min<S: Simd>(a: F<S>, b: F<S>) -> F<S> {
    SimdBase::min(a, b)
}

#[inline(always)]
pub(super) fn dot<S: Simd>(a: V3<S>, b: V3<S>) -> F<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(super) fn cross<S: Simd>(a: V3<S>, b: V3<S>) -> V3<S> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
pub(super) fn scale<S: Simd>(a: V3<S>, s: F<S>) -> V3<S> {
    [a[0] * s, a[1] * s, a[2] * s]
}

impl<S: Simd> WideAngle<S> {
    #[inline(always)]
    pub(super) fn splat(simd: S, cos: f32, sin: f32) -> Self {
        Self { cos: splat(simd, cos), sin: splat(simd, sin) }
    }

    #[inline(always)]
    pub(super) fn of(simd: S, angle: Angle<f32>) -> Self {
        Self::splat(simd, angle.cos, angle.sin)
    }

    #[inline(always)]
    pub(super) fn select(mask: M<S>, a: Self, b: Self) -> Self {
        Self { cos: mask.select(a.cos, b.cos), sin: mask.select(a.sin, b.sin) }
    }

    #[inline(always)]
    pub(super) fn subtended(simd: S, opposite: F<S>, hypotenuse: F<S>) -> Self {
        let one = splat(simd, 1.0);
        let widened = opposite * splat(simd, 1.0 + SLACK);
        let sin = widened / hypotenuse;
        let cos = ((one - sin) * (one + sin)).sqrt();
        Self::select(widened.simd_lt(hypotenuse), Self { cos, sin }, Self::splat(simd, -1.0, 0.0))
    }

    #[inline(always)]
    pub(super) fn between(a: V3<S>, b: V3<S>) -> Self {
        let across = cross::<S>(a, b);
        Self { cos: dot::<S>(a, b), sin: dot::<S>(across, across).sqrt() }
    }

    #[inline(always)]
    pub(super) fn plus(self, simd: S, other: Self) -> Self {
        let zero = splat(simd, 0.0);
        let sum = Self {
            cos: self.cos * other.cos - self.sin * other.sin,
            sin: max::<S>(self.sin * other.cos + self.cos * other.sin, zero),
        };
        Self::select((self.cos + other.cos).simd_le(zero), Self::splat(simd, -1.0, 0.0), sum)
    }

    #[inline(always)]
    pub(super) fn cos_within(self, simd: S, other: Self) -> F<S> {
        let difference = self.cos * other.cos + self.sin * other.sin + splat(simd, SLACK);
        self.cos.simd_ge(other.cos).select(splat(simd, 1.0), difference)
    }

    #[inline(always)]
    pub(super) fn chord(self, simd: S) -> F<S> {
        let one = splat(simd, 1.0);
        let small = self.sin / ((one + self.cos) * splat(simd, 0.5)).sqrt();
        let large = ((one - self.cos) * splat(simd, 2.0)).sqrt();
        self.cos.simd_gt(splat(simd, 0.0)).select(small, large)
    }

    /// To the nearer side, where both are seen.
    #[inline(always)]
    pub(super) fn side(self, receiver: &Receiver<f32>) -> Self {
        if receiver.both_sides { Self { cos: self.cos.abs(), ..self } } else { self }
    }
}
