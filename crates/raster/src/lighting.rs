//! The lighting text on vectors, one point a lane: a third twin of `halfway_lighting::equations` and `lighting.wgsl`, with
//! their names. Eye space, linear RGB. The test beside it holds it to the equations in f64.

use crate::lanes::{
    F, SMALLEST_SQUARE, Simd, V3, add, add_scaled, dot, fma, max, min, neg, saturate, scale, select3, splat, splat3,
    sub,
};
use crate::pass::{Highlight, LightData, LightRange, ShadedTerms, SideData};
use crate::power::{Exponent, power};
use fearless_simd::prelude::*;
use halfway_lighting::equations::{ATTENUATION_MAX, HALFWAY_MIN};

/// Points of a surface, on the side that is seen.
#[derive(Clone, Copy)]
pub(crate) struct Points<S: Simd> {
    pub(crate) p: V3<S>,
    /// Unit length.
    pub(crate) n: V3<S>,
    /// Toward the viewer, unit length.
    pub(crate) v: V3<S>,
}

/// What reaches points, before the material: sums over lights of color·att·spot·factor.
#[derive(Clone, Copy)]
pub(crate) struct Irradiance<S: Simd> {
    pub(crate) ambient: V3<S>,
    pub(crate) diffuse: V3<S>,
    pub(crate) specular: V3<S>,
}

/// What the terms of one side's lights take from the surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gloss {
    pub(crate) highlight: Highlight,
    /// Of the material; Blinn–Phong takes it halved.
    pub(crate) exponent: Exponent,
}

impl<S: Simd> Irradiance<S> {
    #[inline(always)]
    pub(crate) fn none(simd: S) -> Self {
        let zero = [splat(simd, 0.0); 3];
        Self { ambient: zero, diffuse: zero, specular: zero }
    }
}

/// `1 / max(a + b·d + c·d², 10⁻⁶)`.
#[inline(always)]
pub(crate) fn attenuation<S: Simd>(simd: S, [a, b, c]: [f32; 3], d: F<S>) -> F<S> {
    let divisor = fma::<S>(fma::<S>(splat(simd, c), d, splat(simd, b)), d, splat(simd, a));
    splat(simd, 1.0) / max::<S>(divisor, splat(simd, 1.0 / ATTENUATION_MAX))
}

/// `clamp(1 − (d/R)⁴, 0, 1)²`.
#[inline(always)]
pub(crate) fn range_window<S: Simd>(simd: S, d: F<S>, inverse_range: f32) -> F<S> {
    let ratio = d * splat(simd, inverse_range);
    let square = ratio * ratio;
    let window = saturate(simd, splat(simd, 1.0) - square * square);
    window * window
}

/// `max(cos φ, 0)^e` inside the cone, with the inner cone's fade, and 0 outside.
#[inline(always)]
pub(crate) fn spot_factor<S: Simd>(simd: S, l: V3<S>, light: &LightData) -> F<S> {
    let cos_phi = min::<S>(-dot::<S>(l, splat3(simd, light.direction)), splat(simd, 1.0));
    let factor = power(simd, cos_phi, Exponent::new(light.exponent));
    let [fade, offset] = light.inner_fade;
    let inner = saturate(simd, fma::<S>(cos_phi, splat(simd, fade), splat(simd, offset)));
    cos_phi.simd_ge(splat(simd, light.cos_cutoff)).select(factor * inner * inner, splat(simd, 0.0))
}

/// `max(r·v, 0)^α` with r = 2(n·l)n − l, without the gate n·l > 0.
#[inline(always)]
pub(crate) fn specular_phong<S: Simd>(simd: S, n: V3<S>, l: V3<S>, v: V3<S>, alpha: Exponent) -> F<S> {
    let twice = dot::<S>(n, l) * splat(simd, 2.0);
    power(simd, fma::<S>(twice, dot::<S>(n, v), -dot::<S>(l, v)), alpha)
}

/// `max(n·h, 0)^β` with h = (l + v)/‖l + v‖, as ((n·(l + v))²/‖l + v‖²)^(β/2), without the gate n·l > 0.
#[inline(always)]
pub(crate) fn specular_blinn_phong<S: Simd>(simd: S, n: V3<S>, l: V3<S>, v: V3<S>, half_beta: Exponent) -> F<S> {
    const SMALLEST: f32 = HALFWAY_MIN * HALFWAY_MIN;
    let sum = add::<S>(l, v);
    let squared = dot::<S>(sum, sum);
    let along = max::<S>(dot::<S>(n, sum), splat(simd, 0.0));
    let cos_squared = along * along / max::<S>(squared, splat(simd, SMALLEST));
    let s = power(simd, cos_squared, half_beta);
    squared.simd_gt(splat(simd, SMALLEST)).select(s, splat(simd, 0.0))
}

/// Adds one light that arrives from l with the strength `arriving`, att·spot.
#[inline(always)]
pub(crate) fn add_light<S: Simd>(
    simd: S,
    sum: &mut Irradiance<S>,
    light: &LightData,
    l: V3<S>,
    arriving: F<S>,
    points: &Points<S>,
    gloss: Gloss,
    terms: ShadedTerms,
) {
    let Points { n, v, .. } = *points;
    let zero = splat(simd, 0.0);
    let n_dot_l = dot::<S>(n, l);
    if terms.diffuse {
        let factor = arriving * max::<S>(n_dot_l, zero);
        sum.diffuse = add_scaled::<S>(sum.diffuse, splat3(simd, light.diffuse), factor);
        if light.ambient.iter().any(|&la| la > 0.0) {
            sum.ambient = add_scaled::<S>(sum.ambient, splat3(simd, light.ambient), arriving);
        }
    }
    if terms.specular {
        let s = match gloss.highlight {
            Highlight::Phong => specular_phong(simd, n, l, v, gloss.exponent),
            Highlight::BlinnPhong => specular_blinn_phong(simd, n, l, v, gloss.exponent),
        };
        let factor = n_dot_l.simd_gt(zero).select(arriving * s, zero);
        sum.specular = add_scaled::<S>(sum.specular, splat3(simd, light.specular), factor);
    }
}

/// l and att·spot of a point light, or of a spot where `cone` is set.
#[inline(always)]
pub(crate) fn finite_light<S: Simd>(simd: S, light: &LightData, cone: bool, points: &Points<S>) -> (V3<S>, F<S>) {
    let to_light = sub::<S>(splat3(simd, light.position), points.p);
    let squared = dot::<S>(to_light, to_light);
    let at_surface = squared.simd_lt(splat(simd, SMALLEST_SQUARE));
    let d = max::<S>(squared, splat(simd, SMALLEST_SQUARE)).sqrt();
    let inverse = splat(simd, 1.0) / d;
    // A light on the surface has no direction: l falls back to n.
    let l = select3::<S>(at_surface, points.n, scale::<S>(to_light, inverse));
    let mut arriving = attenuation(simd, light.attenuation, d);
    if light.inverse_range > 0.0 {
        arriving *= range_window(simd, d, light.inverse_range);
    }
    if cone {
        arriving *= spot_factor(simd, l, light);
    }
    (l, arriving)
}

/// v: toward the eye, or (0, 0, 1) for an infinite viewer. An eye on the surface looks along n.
#[inline(always)]
pub(crate) fn to_viewer<S: Simd>(simd: S, p: V3<S>, n: V3<S>, local_viewer: bool) -> V3<S> {
    if !local_viewer {
        return splat3(simd, [0.0, 0.0, 1.0]);
    }
    let squared = dot::<S>(p, p);
    let inverse = splat(simd, 1.0) / max::<S>(squared, splat(simd, SMALLEST_SQUARE)).sqrt();
    select3::<S>(squared.simd_lt(splat(simd, SMALLEST_SQUARE)), n, neg::<S>(scale::<S>(p, inverse)))
}

/// What two ranges of lights bring to points, the second without highlights. A function of its own in each width: it is
/// most of the code.
pub(crate) fn gathered<S: Simd>(
    simd: S,
    lights: (&[LightData], &[u32]),
    ranges: [LightRange; 2],
    points: &Points<S>,
    gloss: Gloss,
    terms: ShadedTerms,
) -> Irradiance<S> {
    simd.vectorize(
        #[inline(always)]
        || {
            let mut sum = Irradiance::none(simd);
            let mut terms = terms;
            for range in ranges {
                add_listed(simd, &mut sum, lights, range, points, gloss, terms);
                terms.specular = false;
            }
            sum
        },
    )
}

/// Adds the lights of a range.
#[inline(always)]
fn add_listed<S: Simd>(
    simd: S,
    sum: &mut Irradiance<S>,
    (lights, lists): (&[LightData], &[u32]),
    range: LightRange,
    points: &Points<S>,
    gloss: Gloss,
    terms: ShadedTerms,
) {
    if range.is_empty() || terms.is_empty() {
        return;
    }
    let [directional, finite, spots] = range.counts.map(|count| count as usize);
    let numbers = &lists[range.start as usize..][..directional + finite + spots];
    for (place, &number) in numbers.iter().enumerate() {
        let light = &lights[number as usize];
        let (l, arriving) = if place < directional {
            (splat3(simd, light.position), splat(simd, 1.0))
        } else {
            finite_light(simd, light, place >= directional + finite, points)
        };
        add_light(simd, sum, light, l, arriving, points, gloss, terms);
    }
}

/// I = ke + ka·(Ga + Σ La) + Σ …, from what arrives.
#[inline(always)]
pub(crate) fn reflected<S: Simd>(simd: S, arriving: &Irradiance<S>, side: &SideData) -> V3<S> {
    add::<S>(splat3(simd, side.base), added(simd, arriving, side))
}

/// The part of I that the lights of one list add.
#[inline(always)]
pub(crate) fn added<S: Simd>(simd: S, arriving: &Irradiance<S>, side: &SideData) -> V3<S> {
    let mut sum = [splat(simd, 0.0); 3];
    for c in 0..3 {
        let ambient = arriving.ambient[c] * splat(simd, side.ambient[c]);
        let diffuse = fma::<S>(arriving.diffuse[c], splat(simd, side.diffuse[c]), ambient);
        sum[c] = fma::<S>(arriving.specular[c], splat(simd, side.specular[c]), diffuse);
    }
    sum
}

#[cfg(test)]
mod tests;
