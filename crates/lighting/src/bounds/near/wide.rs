//! Bounds of eight lights at once: the text of `receiver.rs` on vectors, operation by operation, so that each lane has
//! the bits that [`Receiver::bounds`] gives for its light. What the plain text decides by a branch is a selection here.
//!
//! Lanes whose squares leave the range of numbers are told apart, and are for the plain text.

use crate::bounds::chunk::{CHUNK, Chunk};
use crate::bounds::lanes::{
    F, M, SLACK, V3, WideAngle, cross, dot, load, load3, max, min, scale, splat, splat3, stored,
};
use crate::bounds::power::{self, POWER_ERROR};
use crate::bounds::receiver::{Lobe, MARGIN, Receiver};
use crate::equations::{ATTENUATION_MAX, power};
use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd};

/// What the lights of a chunk add to a patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// The lanes that are for the plain text, a bit each.
    pub(super) odd: u32,
    /// With the ambient term.
    pub(super) diffuse: FoundTerm,
    pub(super) specular: FoundTerm,
}

/// A term of each light.
#[derive(Clone, Copy, Debug)]
pub(super) struct FoundTerm {
    /// The lanes whose bound exceeds the tolerance, a bit each.
    pub(super) strong: u32,
    /// Those whose bound does not, and is not 0.
    pub(super) weak: u32,
    /// A channel each; of highlights no less than the bound and no more than a [`BLUR`] above it. Not there where no
    /// lane is weak.
    pub(super) bound: [[f32; CHUNK]; 3],
}

/// By how much what stands for the bound of a highlight may exceed it, relative to itself: twice the error of the
/// power, on either side.
pub(super) const BLUR: f64 = 4.0 * POWER_ERROR as f64;

impl Found {
    /// The lanes with anything to look at.
    pub(super) fn lanes(&self) -> u32 {
        let Self { odd, diffuse, specular } = self;
        odd | diffuse.strong | diffuse.weak | specular.strong | specular.weak
    }
}

impl FoundTerm {
    const NONE: Self = Self { strong: 0, weak: 0, bound: [[0.0; CHUNK]; 3] };

    /// Also gives the lanes of which it is not certain whether they are strong: their bounds lie between `low` and
    /// `high`.
    #[inline(always)]
    fn new<S: Simd>(simd: S, low: V3<S>, high: V3<S>, tolerance: [f32; 3]) -> (Self, u32) {
        let zero = splat(simd, 0.0);
        let tolerance = splat3(simd, tolerance);
        let within = |bound: V3<S>| {
            bound[0].simd_le(tolerance[0]) & bound[1].simd_le(tolerance[1]) & bound[2].simd_le(tolerance[2])
        };
        let black = high[0].simd_eq(zero) & high[1].simd_eq(zero) & high[2].simd_eq(zero);
        let low_within = within(low).to_bitmask() as u32;
        let within = within(high).to_bitmask() as u32;
        let black = black.to_bitmask() as u32;
        let weak = within & !black;
        let bound = if weak == 0 { Self::NONE.bound } else { [stored(high[0]), stored(high[1]), stored(high[2])] };
        (Self { strong: !low_within & 0xff, weak, bound }, low_within & !within)
    }
}

/// What the lights of each chunk add to a patch whose bounds are [moderate](Receiver::is_moderate).
pub(super) fn find(
    level: Level,
    receiver: &Receiver<f32>,
    chunks: &[Chunk],
    tolerance: [f32; 3],
    found: &mut Vec<Found>,
) {
    found.clear();
    match level {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx512(simd) => find_with(simd, receiver, chunks, tolerance, found),
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx2(simd) => find_with(simd, receiver, chunks, tolerance, found),
        level => fearless_simd::dispatch!(level, simd => find_with(simd, receiver, chunks, tolerance, found)),
    }
}

#[inline(always)]
fn find_with<S: Simd>(
    simd: S,
    receiver: &Receiver<f32>,
    chunks: &[Chunk],
    tolerance: [f32; 3],
    found: &mut Vec<Found>,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            for chunk in chunks {
                found.push(bounds(simd, receiver, chunk, tolerance));
            }
        },
    );
}

/// The lights as they arrive at the points of the patch.
struct WideArrival<S: Simd> {
    axis: V3<S>,
    spread: WideAngle<S>,
    rise: WideAngle<S>,
    /// Of those from which nothing arrives 0.
    weight: F<S>,
    odd: M<S>,
}

#[inline(always)]
fn bounds<S: Simd>(simd: S, receiver: &Receiver<f32>, lights: &Chunk, tolerance: [f32; 3]) -> Found {
    let zero = splat(simd, 0.0);
    let WideArrival { axis, spread, rise, weight, odd } = arrival(simd, receiver, lights);
    let odd = odd.to_bitmask() as u32;
    let arrives = weight.simd_gt(zero);
    if !arrives.any_true() {
        return Found { odd, diffuse: FoundTerm::NONE, specular: FoundTerm::NONE };
    }
    let weight = weight * splat(simd, 1.0 + MARGIN as f32);
    let facing = facing(simd, receiver, axis, spread, rise);
    let faces = facing.simd_gt(zero) & arrives;
    let lit = faces.select(weight * facing, zero);
    let diffuse = |k: usize| {
        let ambient = splat(simd, receiver.ka[k]) * load(simd, &lights.la[k]) * weight;
        ambient + splat(simd, receiver.kd[k]) * load(simd, &lights.ld[k]) * lit
    };
    let diffuse = [diffuse(0), diffuse(1), diffuse(2)];
    let (diffuse, _) = FoundTerm::new(simd, diffuse, diffuse, tolerance);
    let color = |k: usize| splat(simd, receiver.ks[k]) * load(simd, &lights.ls[k]);
    let color = [color(0), color(1), color(2)];
    let shines = (color[0].simd_gt(zero) | color[1].simd_gt(zero) | color[2].simd_gt(zero)) & faces;
    if !shines.any_true() {
        return Found { odd, diffuse, specular: FoundTerm::NONE };
    }
    let [low, high] = peaks(simd, highlight(simd, receiver, axis, spread), receiver.exponent);
    let [low, high] = [weight * low, weight * high];
    let bound = |k: usize, peak: F<S>| shines.select(color[k] * peak, zero);
    let [low, high] = [[bound(0, low), bound(1, low), bound(2, low)], [bound(0, high), bound(1, high), bound(2, high)]];
    let (specular, unsure) = FoundTerm::new(simd, low, high, tolerance);
    Found { odd: odd | unsure, diffuse, specular }
}

#[inline(always)]
fn arrival<S: Simd>(simd: S, receiver: &Receiver<f32>, lights: &Chunk) -> WideArrival<S> {
    let (zero, one) = (splat(simd, 0.0), splat(simd, 1.0));
    let (radius, coincident) = (splat(simd, receiver.radius), splat(simd, receiver.coincident));
    let place = load3(simd, &lights.place);
    let center = splat3(simd, receiver.center);
    let offset = [place[0] - center[0], place[1] - center[1], place[2] - center[2]];
    let square = dot::<S>(offset, offset);
    let is_point = load(simd, &lights.is_point).simd_gt(zero);
    let safe =
        square.simd_gt(splat(simd, f32::MIN_POSITIVE / f32::EPSILON)) & square.simd_lt(splat(simd, f32::MAX * 0.25));
    let range = load(simd, &lights.range);
    let end = max::<S>(range, coincident) + radius;
    let in_range = (square * splat(simd, 1.0 - SLACK * 4.0)).simd_le(end * end);
    let distance = square.sqrt();
    let axis = scale::<S>(offset, one / distance);
    let spread = WideAngle::subtended(simd, radius, distance);
    let beyond_sphere = distance * splat(simd, 1.0 - SLACK) - splat(simd, receiver.radius * (1.0 + SLACK));
    let (beyond_slab, rise) = slab(simd, receiver, offset, distance);
    let nearest = max::<S>(max::<S>(beyond_sphere, beyond_slab), zero);
    let is_there = nearest.simd_le(coincident);
    let nearest = is_there.select(zero, nearest);
    let ratio = nearest / range;
    let ratio = ratio * ratio;
    let window = min::<S>(max::<S>(one - ratio * ratio, zero), one);
    let window = is_there.select(one, window * window);
    let [a, b, c] = load3(simd, &lights.attenuation);
    let divisor = max::<S>(a + nearest * (b + c * nearest), splat(simd, ATTENUATION_MAX.recip()));
    let weight = one / divisor;
    let weight = is_there.select(weight, max::<S>(weight * window, splat(simd, f32::MIN_POSITIVE)));
    let weight = (window.simd_gt(zero) & in_range).select(weight, zero);
    // A directional light arrives as it is.
    let everywhere = is_there & is_point;
    let axis = [
        everywhere.select(zero, is_point.select(axis[0], place[0])),
        everywhere.select(zero, is_point.select(axis[1], place[1])),
        everywhere.select(zero, is_point.select(axis[2], place[2])),
    ];
    let spread = WideAngle::select(is_point, spread, WideAngle::splat(simd, 1.0, 0.0));
    let spread = WideAngle::select(everywhere, WideAngle::splat(simd, -1.0, 0.0), spread);
    let rise = WideAngle::select(is_point, rise, WideAngle::splat(simd, 1.0, 0.0));
    let rise = WideAngle::select(everywhere, WideAngle::splat(simd, 1.0, 0.0), rise);
    let weight = is_point.select(weight, one);
    let weight = if lights.has_cones { through_cones(simd, lights, axis, spread, weight) } else { weight };
    WideArrival { axis, spread, rise, weight, odd: is_point & !safe }
}

/// The weights of lights, in their cones.
#[inline(always)]
fn through_cones<S: Simd>(simd: S, lights: &Chunk, axis: V3<S>, spread: WideAngle<S>, weight: F<S>) -> F<S> {
    let zero = splat(simd, 0.0);
    let from = [-axis[0], -axis[1], -axis[2]];
    let cos = WideAngle::between(from, load3(simd, &lights.direction)).cos_within(simd, spread);
    let (cutoff, inner) = (load(simd, &lights.cos_cutoff), load(simd, &lights.cos_inner));
    let inside = cos.simd_ge(cutoff) & weight.simd_gt(zero);
    let factor = if lights.has_exponents {
        let mut factors = stored::<S>(cos);
        let inside = inside.to_bitmask() as u32;
        for (lane, factor) in factors.iter_mut().enumerate() {
            *factor = if inside >> lane & 1 == 1 { power(*factor, lights.exponent[lane]) } else { 0.0 };
        }
        load(simd, &factors)
    } else {
        splat(simd, 1.0)
    };
    let s = (cos - cutoff) / (inner - cutoff);
    let factor = cos.simd_lt(inner).select(factor * s * s, factor);
    let is_lit = inside & factor.simd_gt(zero);
    let weakened = max::<S>(weight * factor, splat(simd, f32::MIN_POSITIVE));
    let has_cone = load(simd, &lights.has_cone).simd_gt(zero);
    has_cone.select(is_lit.select(weakened, zero), weight)
}

#[inline(always)]
fn slab<S: Simd>(simd: S, receiver: &Receiver<f32>, offset: V3<S>, distance: F<S>) -> (F<S>, WideAngle<S>) {
    let (zero, one) = (splat(simd, 0.0), splat(simd, 1.0));
    let level = WideAngle::splat(simd, 1.0, 0.0);
    if !receiver.is_flat() {
        return (zero, level);
    }
    let (k, radius) = (splat3(simd, receiver.normals.axis), splat(simd, receiver.radius));
    let half_thickness = splat(simd, receiver.half_thickness);
    let height = dot::<S>(offset, k);
    let height = if receiver.both_sides { height.abs() } else { height };
    let across = cross::<S>(offset, k);
    let blur = splat(simd, SLACK) * (distance + radius);
    let over = max::<S>(height.abs() - half_thickness - blur, zero);
    let aside = max::<S>(dot::<S>(across, across).sqrt() - radius - blur, zero);
    let nearest = (over * over + aside * aside).sqrt() * splat(simd, 1.0 - SLACK);
    let top = height + half_thickness + blur;
    let cos = top / top.simd_lt(zero).select(distance + radius + blur, nearest);
    let sin = max::<S>((one - cos) * (one + cos), zero).sqrt();
    (nearest, WideAngle::select(cos.simd_lt(one), WideAngle { cos, sin }, level))
}

#[inline(always)]
fn facing<S: Simd>(simd: S, receiver: &Receiver<f32>, axis: V3<S>, spread: WideAngle<S>, rise: WideAngle<S>) -> F<S> {
    let normals = WideAngle::of(simd, receiver.normals.spread);
    let angle = WideAngle::between(splat3(simd, receiver.normals.axis), axis).side(receiver);
    let by_sphere = angle.cos_within(simd, normals.plus(simd, spread));
    min::<S>(min::<S>(by_sphere, rise.cos_within(simd, normals)), splat(simd, 1.0))
}

/// The cosines that the highlights are powers of.
#[inline(always)]
fn highlight<S: Simd>(simd: S, receiver: &Receiver<f32>, axis: V3<S>, l_spread: WideAngle<S>) -> F<S> {
    let k = splat3(simd, receiver.normals.axis);
    let view = splat3(simd, receiver.view.axis);
    match receiver.lobe {
        Lobe::Halfway { view_chord } => {
            let sum = [axis[0] + view[0], axis[1] + view[1], axis[2] + view[2]];
            let length = dot::<S>(sum, sum).sqrt();
            let moved = l_spread.chord(simd) + splat(simd, view_chord) + splat(simd, SLACK);
            let spread = WideAngle::subtended(simd, moved, length);
            let h = scale::<S>(sum, splat(simd, 1.0) / max::<S>(length, splat(simd, SLACK)));
            let angle = WideAngle::between(k, h).side(receiver);
            angle.cos_within(simd, WideAngle::of(simd, receiver.normals.spread).plus(simd, spread))
        }
        Lobe::Mirror { spread } => {
            let nl = dot::<S>(k, axis);
            let twice = nl + nl;
            let r = [k[0] * twice - axis[0], k[1] * twice - axis[1], k[2] * twice - axis[2]];
            WideAngle::between(r, view).cos_within(simd, WideAngle::of(simd, spread).plus(simd, l_spread))
        }
    }
}

/// What the powers of those cosines are at least and at most.
#[inline(always)]
fn peaks<S: Simd>(simd: S, cos: F<S>, exponent: f32) -> [F<S>; 2] {
    let (zero, one) = (splat(simd, 0.0), splat(simd, 1.0));
    // 0 to the power of 0 is 1.
    if exponent == 0.0 {
        return [one; 2];
    }
    let smallest = splat(simd, f32::MIN_POSITIVE);
    let peak = power::power(simd, min::<S>(max::<S>(cos, smallest), one), exponent);
    // 1 is exact, and what is below the normal numbers counts as the least of them.
    let low = max::<S>(peak * splat(simd, 1.0 - POWER_ERROR), smallest);
    let high = min::<S>(max::<S>(peak * splat(simd, 1.0 + POWER_ERROR), smallest), one);
    let (is_one, is_seen) = (cos.simd_ge(one), cos.simd_gt(zero));
    [is_one.select(one, is_seen.select(low, zero)), is_one.select(one, is_seen.select(high, zero))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::angle::slack;

    #[test]
    fn the_slack_is_that_of_the_plain_text() {
        assert_eq!(slack::<f32>().to_bits(), SLACK.to_bits());
    }
}
