//! The lighting text on vectors, one point a lane: a third twin of `halfway_lighting::equations` and `lighting.wgsl`,
//! with their names. Eye space, linear RGB. The test beside it holds it to the equations in f64.

pub(crate) mod state;

use crate::simd::lanes::{
    F, I, M, Simd, V3, add, add_scaled, dot, each, fma, max, min, neg, saturate, scale, select3, splat, splat_i,
    splat3, sub,
};
use crate::simd::lobe::PointLobe;
use crate::simd::power::{Exponent, power};
use fearless_simd::prelude::*;
use halfway_lighting::equations::{ATTENUATION_MAX, COINCIDENT, GRAZING};
use halfway_lighting::lights::Kind;
use halfway_lighting::record::{LightRange, LightRecord, MaterialRecord, SurfaceLights};

/// The shaded terms; attenuated ambient light belongs to the diffuse term.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ShadedTerms {
    /// ka·La where it is attenuated, and kd·Ld.
    pub(crate) diffuse: bool,
    /// ks·Ls.
    pub(crate) specular: bool,
}

impl ShadedTerms {
    pub(crate) fn is_empty(self) -> bool {
        self == Self::default()
    }
}

/// Points of a surface, on the visible side.
#[derive(Clone, Copy)]
pub(crate) struct Points<S: Simd> {
    pub(crate) p: V3<S>,
    /// Unit length.
    pub(crate) n: V3<S>,
    /// Toward the viewer, unit length.
    pub(crate) v: V3<S>,
    /// The squared distance below which a light may coincide with the point.
    coincident: F<S>,
    /// ‖p‖, if its square is finite.
    distance: F<S>,
}

impl<S: Simd> Points<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, p: V3<S>, n: V3<S>, v: V3<S>) -> Self {
        // A little more than the distance of coincidence.
        let share = splat(simd, 1.01 * COINCIDENT * COINCIDENT);
        let squared = dot::<S>(p, p);
        Self { p, n, v, coincident: max::<S>(squared * share, splat(simd, LEAST_SQUARE)), distance: squared.sqrt() }
    }
}

/// Light at points, before the material: sums over lights of color·att·spot·factor.
#[derive(Clone, Copy)]
pub(crate) struct Irradiance<S: Simd> {
    pub(crate) ambient: V3<S>,
    pub(crate) diffuse: V3<S>,
    pub(crate) specular: V3<S>,
}

impl<S: Simd> Irradiance<S> {
    /// `self` in the lanes of `mask`, else `other`.
    #[inline(always)]
    pub(crate) fn or(self, mask: M<S>, other: &Self) -> Self {
        Self {
            ambient: select3::<S>(mask, other.ambient, self.ambient),
            diffuse: select3::<S>(mask, other.diffuse, self.diffuse),
            specular: select3::<S>(mask, other.specular, self.specular),
        }
    }

    #[inline(always)]
    pub(crate) fn none(simd: S) -> Self {
        let zero = [splat(simd, 0.0); 3];
        Self { ambient: zero, diffuse: zero, specular: zero }
    }
}

/// `max(a + b·d + c·d², 10⁻⁶)`, the divisor of attenuation; at most 10³⁰, so that products stay finite.
#[inline(always)]
pub(crate) fn attenuation_divisor<S: Simd>(simd: S, light: &LightRecord, d: F<S>) -> F<S> {
    let [a, b, c] = [light.constant, light.linear, light.quadratic].map(|coefficient| splat(simd, coefficient));
    let divisor = fma::<S>(fma::<S>(c, d, b), d, a);
    min::<S>(max::<S>(divisor, splat(simd, 1.0 / ATTENUATION_MAX)), splat(simd, 1e30))
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
pub(crate) fn spot_factor<S: Simd>(simd: S, l: V3<S>, light: &LightRecord) -> F<S> {
    let cos_phi = min::<S>(-dot::<S>(l, splat3(simd, light.direction)), splat(simd, 1.0));
    let factor = power(simd, cos_phi, Exponent::new(light.exponent));
    let (scale, offset) = (splat(simd, light.inner_scale), splat(simd, light.inner_offset));
    let inner = saturate(simd, fma::<S>(cos_phi, scale, offset));
    cos_phi.simd_ge(splat(simd, light.cos_cutoff)).select(factor * inner * inner, splat(simd, 0.0))
}

/// The light of one source at points.
#[derive(Clone, Copy)]
struct Incidence<S: Simd> {
    l: V3<S>,
    /// 0 if the light counts as behind.
    n_dot_l: F<S>,
    /// att·spot.
    weight: F<S>,
}

/// Adds the light of one source.
#[inline(always)]
fn add_light<S: Simd>(
    simd: S,
    sum: &mut Irradiance<S>,
    light: &LightRecord,
    incident: &Incidence<S>,
    points: &Points<S>,
    lobe: impl PointLobe<S>,
    terms: ShadedTerms,
) {
    let Points { n, v, .. } = *points;
    let Incidence { l, n_dot_l, weight } = *incident;
    let zero = splat(simd, 0.0);
    if terms.diffuse {
        let factor = weight * n_dot_l;
        sum.diffuse = add_scaled::<S>(sum.diffuse, splat3(simd, light.diffuse), factor);
        if has_ambient(light) {
            sum.ambient = add_scaled::<S>(sum.ambient, splat3(simd, light.ambient), weight);
        }
    }
    if terms.specular {
        let s = lobe.highlight(simd, n, l, v);
        let factor = n_dot_l.simd_gt(zero).select(weight * s, zero);
        sum.specular = add_scaled::<S>(sum.specular, splat3(simd, light.specular), factor);
    }
}

#[inline(always)]
fn has_ambient(light: &LightRecord) -> bool {
    light.ambient[0] + light.ambient[1] + light.ambient[2] > 0.0
}

/// Whether a light with these n·l adds nothing to any of the points.
#[inline(always)]
fn is_behind_all<S: Simd>(simd: S, n_dot_l: F<S>, light: &LightRecord, terms: ShadedTerms) -> bool {
    !(terms.diffuse && has_ambient(light)) && n_dot_l.simd_gt(splat(simd, 0.0)).all_false()
}

/// Whether the window of a range is 0 for all points, by the squares of their distances; roundings are far below a
/// millionth.
#[inline(always)]
fn is_beyond_all<S: Simd>(simd: S, squared: F<S>, inverse_range: f32) -> bool {
    let square_over_range = squared * splat(simd, inverse_range * inverse_range);
    square_over_range.simd_lt(splat(simd, 1.0 + 1e-5)).all_false()
}

/// Adds parallel rays.
#[inline(always)]
fn directional_light<S: Simd>(
    simd: S,
    sum: &mut Irradiance<S>,
    light: &LightRecord,
    points: &Points<S>,
    lobe: impl PointLobe<S>,
    terms: ShadedTerms,
) {
    let l = splat3(simd, light.position);
    let n_dot_l = dot::<S>(points.n, l);
    if !is_behind_all(simd, n_dot_l, light, terms) {
        let is_above = n_dot_l.simd_gt(splat(simd, GRAZING));
        let n_dot_l = is_above.select(n_dot_l, splat(simd, 0.0));
        let incident = Incidence { l, n_dot_l, weight: splat(simd, 1.0) };
        add_light(simd, sum, light, &incident, points, lobe, terms);
    }
}

/// Adds light from all around: the sky is its diffuse color, the ground its specular one.
#[inline(always)]
fn hemisphere_light<S: Simd>(
    simd: S,
    sum: &mut Irradiance<S>,
    light: &LightRecord,
    points: &Points<S>,
    terms: ShadedTerms,
) {
    if terms.diffuse {
        let half = splat(simd, 0.5);
        let up = saturate(simd, fma::<S>(dot::<S>(points.n, splat3(simd, light.position)), half, half));
        sum.diffuse = add_scaled::<S>(sum.diffuse, splat3(simd, light.diffuse), up);
        sum.diffuse = add_scaled::<S>(sum.diffuse, splat3(simd, light.specular), splat(simd, 1.0) - up);
    }
}

/// Adds a point light, or a spot where `cone` is set.
#[inline(always)]
fn finite_light<S: Simd>(
    simd: S,
    sum: &mut Irradiance<S>,
    light: &LightRecord,
    cone: bool,
    points: &Points<S>,
    lobe: impl PointLobe<S>,
    terms: ShadedTerms,
) {
    if let Some(incident) = finite_incidence(simd, light, cone, points, terms) {
        add_light(simd, sum, light, &incident, points, lobe, terms);
    }
}

/// The light of a source at a position, with its cone if `cone` is set; `None` if it is behind all points, or reaches
/// none.
#[inline(always)]
fn finite_incidence<S: Simd>(
    simd: S,
    light: &LightRecord,
    cone: bool,
    points: &Points<S>,
    terms: ShadedTerms,
) -> Option<Incidence<S>> {
    let mut to_light = sub::<S>(splat3(simd, light.position), points.p);
    let mut squared = dot::<S>(to_light, to_light);
    let ordinary = squared.simd_gt(points.coincident) & squared.simd_lt(splat(simd, LARGEST_SQUARE));
    let (mut stretch, mut distance) = (None, points.distance);
    if ordinary.any_false() {
        let (away, unit, from_eye) = extraordinary(simd, light.position, points);
        (to_light, squared, stretch, distance) = (away, dot::<S>(away, away), Some(unit), from_eye);
    } else if is_beyond_all(simd, squared, light.inverse_range) {
        return None;
    }
    let n_dot_to_light = dot::<S>(points.n, to_light);
    if is_behind_all(simd, n_dot_to_light, light, terms) {
        return None;
    }
    let length = squared.sqrt();
    let d = stretch.map_or(length, |unit| min::<S>(length * unit, splat(simd, f32::MAX)));
    let divisor = attenuation_divisor(simd, light, d);
    // One division for both; an infinite product means no light.
    let both = splat(simd, 1.0) / (length * divisor);
    let inverse = divisor * both;
    let l = scale::<S>(to_light, inverse);
    let mut weight = length * both;
    if light.inverse_range > 0.0 {
        weight *= range_window(simd, d, light.inverse_range);
    }
    if cone {
        weight *= spot_factor(simd, l, light);
    }
    let is_above = n_dot_to_light.simd_gt((length + distance) * splat(simd, GRAZING));
    Some(Incidence { l, n_dot_l: is_above.select(n_dot_to_light * inverse, splat(simd, 0.0)), weight })
}

/// Larger squares of distances are computed with scaling, as are those below the least.
const LARGEST_SQUARE: f32 = (1_u128 << 120) as f32;
const LEAST_SQUARE: f32 = 1.0 / (1_u64 << 60) as f32;

/// Lights whose squared distance overflows or underflows: the vector to a light that is very far, very near, or at the
/// point itself, where it is n; the factor of its length; and ‖p‖ over that factor, or 0 at the point. Ordinary
/// distances give the same result as elsewhere, since scaling by powers of two is exact.
#[cold]
fn extraordinary<S: Simd>(simd: S, position: [f32; 3], points: &Points<S>) -> (V3<S>, F<S>, F<S>) {
    simd.vectorize(
        #[inline(always)]
        || {
            let half = splat(simd, 0.5);
            // Half of it, since the whole may be infinite.
            let (to_light, unit) =
                brought_near(simd, sub::<S>(scale::<S>(splat3(simd, position), half), scale::<S>(points.p, half)));
            let (p, unit_of_p) = brought_near(simd, points.p);
            let d = dot::<S>(to_light, to_light).sqrt() * unit;
            let from_eye = dot::<S>(p, p).sqrt();
            let at_point = d.simd_le(from_eye * splat(simd, 0.5 * COINCIDENT) * unit_of_p);
            let stretch = at_point.select(splat(simd, 0.0), min::<S>(unit * splat(simd, 2.0), splat(simd, f32::MAX)));
            let from_eye = at_point.select(splat(simd, 0.0), from_eye * splat(simd, 0.5) * (unit_of_p / unit));
            (select3::<S>(at_point, points.n, to_light), stretch, from_eye)
        },
    )
}

/// A vector divided by a power of two, so that its largest coordinate is from 1 to 4 (or less, for the smallest); and
/// that power.
#[inline(always)]
fn brought_near<S: Simd>(simd: S, a: V3<S>) -> (V3<S>, F<S>) {
    let largest = max::<S>(max::<S>(a[0].abs(), a[1].abs()), a[2].abs());
    let bits: I<S> = largest.bitcast();
    let exponent = SimdBase::min(SimdBase::max(bits >> 23, splat_i(simd, 1)), splat_i(simd, 253));
    let over: F<S> = ((splat_i(simd, 254) - exponent) << 23).bitcast();
    (scale::<S>(a, over), (exponent << 23).bitcast())
}

/// v: toward the eye, or (0, 0, 1) for an infinite viewer. An eye on the surface looks along n.
#[inline(always)]
pub(crate) fn to_viewer<S: Simd>(simd: S, p: V3<S>, n: V3<S>, local_viewer: bool) -> V3<S> {
    if !local_viewer {
        return splat3(simd, [0.0, 0.0, 1.0]);
    }
    let (mut p, mut squared) = (p, dot::<S>(p, p));
    let ordinary = squared.simd_gt(splat(simd, LEAST_SQUARE)) & squared.simd_lt(splat(simd, LARGEST_SQUARE));
    if ordinary.any_false() {
        (p, _) = brought_near(simd, p);
        let at_eye = dot::<S>(p, p).simd_eq(splat(simd, 0.0));
        p = select3::<S>(at_eye, neg::<S>(n), p);
        squared = dot::<S>(p, p);
    }
    scale::<S>(p, splat(simd, -1.0) / squared.sqrt())
}

/// The sum of a surface's lights at points. It is most of the code; see [`gathered`].
#[inline(always)]
pub(crate) fn gathered_here<S: Simd>(
    simd: S,
    lights: (&[LightRecord], &[u32]),
    of: &SurfaceLights,
    points: &Points<S>,
    lobe: impl PointLobe<S>,
    terms: ShadedTerms,
) -> Irradiance<S> {
    let mut sum = Irradiance::none(simd);
    let [diffuse, specular] = [ShadedTerms { specular: false, ..terms }, ShadedTerms { diffuse: false, ..terms }];
    for (range, terms) in [(of.both, terms), (of.diffuse, diffuse), (of.specular, specular)] {
        add_listed(simd, &mut sum, lights, range, points, lobe, terms);
    }
    sum
}

/// The same, as a function of its own in each width.
pub(crate) fn gathered<S: Simd>(
    simd: S,
    lights: (&[LightRecord], &[u32]),
    of: &SurfaceLights,
    points: &Points<S>,
    lobe: impl PointLobe<S>,
    terms: ShadedTerms,
) -> Irradiance<S> {
    simd.vectorize(
        #[inline(always)]
        || gathered_here(simd, lights, of, points, lobe, terms),
    )
}

/// Adds the lights of a range.
#[inline(always)]
fn add_listed<S: Simd>(
    simd: S,
    sum: &mut Irradiance<S>,
    (lights, lists): (&[LightRecord], &[u32]),
    range: LightRange,
    points: &Points<S>,
    lobe: impl PointLobe<S>,
    terms: ShadedTerms,
) {
    if range.is_empty() || terms.is_empty() {
        return;
    }
    for &number in &lists[range.start as usize..][..range.count as usize] {
        let light = &lights[number as usize];
        match Kind::from_number(light.kind) {
            Some(Kind::Directional) => directional_light(simd, sum, light, points, lobe, terms),
            Some(kind @ (Kind::Point | Kind::Spot)) => {
                finite_light(simd, sum, light, kind == Kind::Spot, points, lobe, terms);
            }
            Some(Kind::Hemisphere) => hemisphere_light(simd, sum, light, points, terms),
            // The check of the pass refuses this.
            None => {}
        }
    }
}

/// I = ke + ka·(Ga + Σ La) + Σ …, from the irradiance.
#[inline(always)]
pub(crate) fn reflected<S: Simd>(simd: S, arriving: &Irradiance<S>, side: &MaterialRecord) -> V3<S> {
    add::<S>(splat3(simd, side.base), added(simd, arriving, side))
}

/// The part of I that the lights of one list add.
#[inline(always)]
pub(crate) fn added<S: Simd>(simd: S, arriving: &Irradiance<S>, side: &MaterialRecord) -> V3<S> {
    let mut sum = [splat(simd, 0.0); 3];
    for c in 0..3 {
        let ambient = arriving.ambient[c] * splat(simd, side.ambient[c]);
        let diffuse = fma::<S>(arriving.diffuse[c], splat(simd, side.diffuse[c]), ambient);
        sum[c] = fma::<S>(arriving.specular[c], splat(simd, side.specular[c]), diffuse);
    }
    sum
}

/// I of surfaces with a color: ke + color·(ambient and diffuse terms) + the specular ones.
#[inline(always)]
pub(crate) fn tinted<S: Simd>(simd: S, arriving: &Irradiance<S>, side: &MaterialRecord, color: V3<S>) -> V3<S> {
    let terms = tinted_terms(simd, arriving, side, color);
    each!(c in 3 => fma::<S>(color[c], splat(simd, side.base[c]), terms[c] + splat(simd, side.emission[c])))
}

/// The part of it that the lights of one list add.
#[inline(always)]
pub(crate) fn tinted_terms<S: Simd>(simd: S, arriving: &Irradiance<S>, side: &MaterialRecord, color: V3<S>) -> V3<S> {
    each!(c in 3 => {
        let ambient = arriving.ambient[c] * splat(simd, side.ambient[c]);
        let diffuse = fma::<S>(arriving.diffuse[c], splat(simd, side.diffuse[c]), ambient);
        fma::<S>(color[c], diffuse, arriving.specular[c] * splat(simd, side.specular[c]))
    })
}

/// The ambient part of a surface with a color, with the base if `base` is set.
#[inline(always)]
pub(crate) fn ambient_part<S: Simd>(
    simd: S,
    arriving: &Irradiance<S>,
    side: &MaterialRecord,
    color: V3<S>,
    base: bool,
) -> V3<S> {
    each!(c in 3 => {
        let ambient = arriving.ambient[c] * splat(simd, side.ambient[c]);
        color[c] * if base { ambient + splat(simd, side.base[c]) } else { ambient }
    })
}

/// Its diffuse part.
#[inline(always)]
pub(crate) fn diffuse_part<S: Simd>(simd: S, arriving: &Irradiance<S>, side: &MaterialRecord, color: V3<S>) -> V3<S> {
    each!(c in 3 => color[c] * (arriving.diffuse[c] * splat(simd, side.diffuse[c])))
}

/// Its specular part.
#[inline(always)]
pub(crate) fn specular_part<S: Simd>(simd: S, arriving: &Irradiance<S>, side: &MaterialRecord) -> V3<S> {
    each!(c in 3 => arriving.specular[c] * splat(simd, side.specular[c]))
}

#[cfg(test)]
mod tests;
