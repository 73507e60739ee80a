//! Vectors of numbers, one a lane, in operations that give the same bits in every width.
//!
//! Allowed are +, −, ×, ÷, √ and the fused multiply-add, which is emulated exactly on CPUs without it. Not allowed are
//! estimates of reciprocals and roots, and operations that CPUs define differently (minimum and maximum of NaN, casts
//! out of range).

use fearless_simd::prelude::*;
pub(crate) use fearless_simd::{Simd, f32x4};

/// An array of the same expression for 0, 1, 2 … A closure would be a function of its own, which is not compiled for
/// the CPU's vectors.
macro_rules! each {
    ($k:ident in 2 => $e:expr) => {
        [{ let $k = 0_usize; $e }, { let $k = 1_usize; $e }]
    };
    ($k:ident in 3 => $e:expr) => {
        [{ let $k = 0_usize; $e }, { let $k = 1_usize; $e }, { let $k = 2_usize; $e }]
    };
    ($k:ident in 4 => $e:expr) => {
        [{ let $k = 0_usize; $e }, { let $k = 1_usize; $e }, { let $k = 2_usize; $e }, { let $k = 3_usize; $e }]
    };
    ($k:ident in 6 => $e:expr) => {{
        let [a, b, c] = each!($k in 3 => $e);
        [a, b, c, { let $k = 3_usize; $e }, { let $k = 4_usize; $e }, { let $k = 5_usize; $e }]
    }};
}
pub(crate) use each;

/// A lane's number in each.
pub(crate) type F<S> = <S as Simd>::f32s;
/// A lane's integer in each.
pub(crate) type I<S> = <S as Simd>::i32s;
/// A lane's truth in each.
pub(crate) type M<S> = <S as Simd>::mask32s;
/// A lane's vector in each.
pub(crate) type V3<S> = [F<S>; 3];

/// The narrowest there is.
pub(crate) const LEAST_LANES: usize = 4;
/// The widest there is.
pub(crate) const MOST_LANES: usize = 16;

/// How many lanes.
#[inline(always)]
pub(crate) const fn lanes<S: Simd>() -> usize {
    <F<S> as SimdBase<S>>::LEN
}

#[inline(always)]
pub(crate) fn splat<S: Simd>(simd: S, x: f32) -> F<S> {
    F::<S>::simd_from(simd, x)
}

#[inline(always)]
pub(crate) fn splat_i<S: Simd>(simd: S, x: i32) -> I<S> {
    I::<S>::simd_from(simd, x)
}

#[inline(always)]
pub(crate) fn splat3<S: Simd>(simd: S, v: [f32; 3]) -> V3<S> {
    [splat(simd, v[0]), splat(simd, v[1]), splat(simd, v[2])]
}

/// The numbers from `at` on.
#[inline(always)]
pub(crate) fn load<S: Simd>(simd: S, from: &[f32], at: usize) -> F<S> {
    F::<S>::from_slice(simd, &from[at..at + lanes::<S>()])
}

#[inline(always)]
pub(crate) fn load_i<S: Simd>(simd: S, from: &[i32], at: usize) -> I<S> {
    I::<S>::from_slice(simd, &from[at..at + lanes::<S>()])
}

#[inline(always)]
pub(crate) fn store<S: Simd>(x: F<S>, to: &mut [f32], at: usize) {
    x.store_slice(&mut to[at..at + lanes::<S>()]);
}

#[inline(always)]
pub(crate) fn store_i<S: Simd>(x: I<S>, to: &mut [i32], at: usize) {
    x.store_slice(&mut to[at..at + lanes::<S>()]);
}

/// Replaces the lanes of a mask. As integers: for floats LLVM emits a masked store, which is slow on many CPUs (more
/// than ten micro-operations on AMD's) and delays the next load from there.
#[inline(always)]
pub(crate) fn replace<S: Simd>(simd: S, mask: M<S>, x: F<S>, to: &mut [f32], at: usize) {
    let before: I<S> = load(simd, to, at).bitcast();
    store::<S>(mask.select(x.bitcast::<I<S>>(), before).bitcast(), to, at);
}

/// Four numbers a lane, side by side, from `at` on.
#[inline(always)]
pub(crate) fn store_fours<S: Simd>([a, b, c, d]: [F<S>; 4], to: &mut [[f32; 4]], at: usize) {
    let to = &mut to.as_flattened_mut()[4 * at..4 * (at + lanes::<S>())];
    let ((ac, more_ac), (bd, more_bd)) = (a.interleave(c), b.interleave(d));
    for (k, (ac, bd)) in [(ac, bd), (more_ac, more_bd)].into_iter().enumerate() {
        let (low, high) = ac.interleave(bd);
        store::<S>(low, to, 2 * k * lanes::<S>());
        store::<S>(high, to, (2 * k + 1) * lanes::<S>());
    }
}

#[inline(always)]
pub(crate) fn store_fours_i<S: Simd>([a, b, c, d]: [I<S>; 4], to: &mut [[i32; 4]], at: usize) {
    let to = &mut to.as_flattened_mut()[4 * at..4 * (at + lanes::<S>())];
    let ((ac, more_ac), (bd, more_bd)) = (a.interleave(c), b.interleave(d));
    for (k, (ac, bd)) in [(ac, bd), (more_ac, more_bd)].into_iter().enumerate() {
        let (low, high) = ac.interleave(bd);
        store_i::<S>(low, to, 2 * k * lanes::<S>());
        store_i::<S>(high, to, (2 * k + 1) * lanes::<S>());
    }
}

/// The vectors from `at` on, of one list a coordinate.
#[inline(always)]
pub(crate) fn load3<S: Simd>(simd: S, from: &[impl AsRef<[f32]>; 3], at: usize) -> V3<S> {
    each!(axis in 3 => load(simd, from[axis].as_ref(), at))
}

/// 0, 1, 2 …
#[inline(always)]
pub(crate) fn counting<S: Simd>(simd: S) -> F<S> {
    const COUNT: [f32; MOST_LANES] = [0., 1., 2., 3., 4., 5., 6., 7., 8., 9., 10., 11., 12., 13., 14., 15.];
    load(simd, &COUNT, 0)
}

#[inline(always)]
pub(crate) fn counting_i<S: Simd>(simd: S) -> I<S> {
    const COUNT: [i32; MOST_LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
    load_i(simd, &COUNT, 0)
}

/// `a·b + c`, rounded once.
#[inline(always)]
pub(crate) fn fma<S: Simd>(a: F<S>, b: F<S>, c: F<S>) -> F<S> {
    a.mul_add_precise(b, c)
}

/// `a` if it is greater, else `b`, also if either is NaN or both are zeros.
#[inline(always)]
pub(crate) fn max<S: Simd>(a: F<S>, b: F<S>) -> F<S> {
    // x86's instruction is defined so.
    if cfg!(any(target_arch = "x86", target_arch = "x86_64")) { SimdBase::max(a, b) } else { a.simd_gt(b).select(a, b) }
}

/// `a` if it is less, else `b`, also if either is NaN or both are zeros.
#[inline(always)]
pub(crate) fn min<S: Simd>(a: F<S>, b: F<S>) -> F<S> {
    if cfg!(any(target_arch = "x86", target_arch = "x86_64")) { SimdBase::min(a, b) } else { a.simd_lt(b).select(a, b) }
}

/// The same for one number.
#[inline(always)]
pub(crate) fn max_one(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The same for one number.
#[inline(always)]
pub(crate) fn min_one(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// Clamps to 0 to 1; NaN becomes 0.
#[inline(always)]
pub(crate) fn saturate<S: Simd>(simd: S, x: F<S>) -> F<S> {
    min::<S>(max::<S>(x, splat(simd, 0.0)), splat(simd, 1.0))
}

#[inline(always)]
pub(crate) fn select3<S: Simd>(mask: M<S>, a: V3<S>, b: V3<S>) -> V3<S> {
    [mask.select(a[0], b[0]), mask.select(a[1], b[1]), mask.select(a[2], b[2])]
}

#[inline(always)]
pub(crate) fn dot<S: Simd>(a: V3<S>, b: V3<S>) -> F<S> {
    fma::<S>(a[2], b[2], fma::<S>(a[1], b[1], a[0] * b[0]))
}

#[inline(always)]
pub(crate) fn add<S: Simd>(a: V3<S>, b: V3<S>) -> V3<S> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(crate) fn sub<S: Simd>(a: V3<S>, b: V3<S>) -> V3<S> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(crate) fn scale<S: Simd>(a: V3<S>, s: F<S>) -> V3<S> {
    [a[0] * s, a[1] * s, a[2] * s]
}

#[inline(always)]
pub(crate) fn neg<S: Simd>(a: V3<S>) -> V3<S> {
    [-a[0], -a[1], -a[2]]
}

#[inline(always)]
pub(crate) fn cross<S: Simd>(a: V3<S>, b: V3<S>) -> V3<S> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `sum + a·s`.
#[inline(always)]
pub(crate) fn add_scaled<S: Simd>(sum: V3<S>, a: V3<S>, s: F<S>) -> V3<S> {
    [fma::<S>(a[0], s, sum[0]), fma::<S>(a[1], s, sum[1]), fma::<S>(a[2], s, sum[2])]
}

/// Squares of lengths below this count as 0.
pub(crate) const SMALLEST_SQUARE: f32 = f32::MIN_POSITIVE;

/// The unit vector; vectors shorter than 10⁻¹⁹ stay short.
#[inline(always)]
pub(crate) fn safe_normalize<S: Simd>(simd: S, a: V3<S>) -> V3<S> {
    let square = max::<S>(dot::<S>(a, a), splat(simd, SMALLEST_SQUARE));
    scale::<S>(a, splat(simd, 1.0) / square.sqrt())
}
