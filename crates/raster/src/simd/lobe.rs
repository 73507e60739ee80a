//! Highlights on vectors of points: round ones with one exponent for all points, or anisotropic ones with two axes at
//! each point. Twins of `halfway_lighting::equations`, with their names.

use crate::simd::lanes::{F, Simd, V3, add, dot, each, fma, max, splat, splat3};
use crate::simd::power::{Exponent, Power};
use fearless_simd::prelude::*;
use halfway_lighting::Reflectance;
use halfway_lighting::equations::HALFWAY_MIN;
use halfway_lighting::record::MaterialRecord;

/// Inputs of the highlights of points from the surface.
pub(crate) trait PointLobe<S: Simd>: Copy {
    /// S, without the gate n·l > 0.
    fn highlight(self, simd: S, n: V3<S>, l: V3<S>, v: V3<S>) -> F<S>;
}

/// Round highlights, the same at all points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gloss {
    pub(crate) reflectance: Reflectance,
    /// The material's exponent, halved for Blinn–Phong.
    pub(crate) exponent: Exponent,
}

impl Gloss {
    /// Those of one side.
    pub(crate) fn new(reflectance: Reflectance, side: &MaterialRecord) -> Self {
        let exponent = match reflectance {
            Reflectance::Phong => Exponent::new(side.shininess),
            Reflectance::BlinnPhong | Reflectance::BlinnPhongMatched => Exponent::new(side.shininess).halved(),
        };
        Self { reflectance, exponent }
    }
}

impl<S: Simd> PointLobe<S> for Gloss {
    #[inline(always)]
    fn highlight(self, simd: S, n: V3<S>, l: V3<S>, v: V3<S>) -> F<S> {
        match self.reflectance {
            Reflectance::Phong => specular_phong(simd, n, l, v, Power::One(self.exponent)),
            Reflectance::BlinnPhong | Reflectance::BlinnPhongMatched => {
                specular_blinn_phong(simd, n, l, v, Power::One(self.exponent))
            }
        }
    }
}

/// Anisotropic highlights, different at each point: see `axial_exponent` in the equations.
#[derive(Clone, Copy)]
pub(crate) struct AxialGloss<S: Simd> {
    /// All else that a side says of its highlights.
    round: Gloss,
    axes: [V3<S>; 2],
    widths: V3<S>,
    /// The exponent if the halfway direction is that of the normal.
    pub(crate) otherwise: F<S>,
}

impl<S: Simd> AxialGloss<S> {
    /// Those of a side, so far round and of exponent 0.
    #[inline(always)]
    pub(crate) fn none(simd: S, round: Gloss) -> Self {
        let zero = splat3(simd, [0.0; 3]);
        Self { round, axes: [zero; 2], widths: zero, otherwise: splat(simd, 0.0) }
    }

    /// Those of one point.
    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, axes: [[f32; 3]; 2], widths: [f32; 3]) {
        for axis in 0..3 {
            self.axes[0][axis][lane] = axes[0][axis];
            self.axes[1][axis][lane] = axes[1][axis];
            self.widths[axis][lane] = widths[axis];
        }
    }
}

impl<S: Simd> PointLobe<S> for AxialGloss<S> {
    #[inline(always)]
    fn highlight(self, simd: S, n: V3<S>, l: V3<S>, v: V3<S>) -> F<S> {
        let exponents = axial_exponent(simd, &self, add::<S>(l, v));
        match self.round.reflectance {
            Reflectance::Phong => specular_phong(simd, n, l, v, Power::Each(exponents)),
            Reflectance::BlinnPhong | Reflectance::BlinnPhongMatched => {
                specular_blinn_phong(simd, n, l, v, Power::Each(exponents * splat(simd, 0.5)))
            }
        }
    }
}

/// The exponents toward the halfway directions h, of any length.
#[inline(always)]
fn axial_exponent<S: Simd>(simd: S, axial: &AxialGloss<S>, h: V3<S>) -> F<S> {
    let [a, b] = each!(k in 2 => dot::<S>(h, axial.axes[k]));
    let least = splat(simd, 1e-30);
    let squared = a * a + b * b;
    let [aa, ab, bb] = axial.widths;
    let along = aa * a * a + (ab + ab) * a * b + bb * b * b;
    let found = max::<S>(along / max::<S>(squared, least), splat(simd, 0.0));
    squared.simd_le(least).select(axial.otherwise, found)
}

/// `max(r·v, 0)^α` with r = 2(n·l)n − l, without the gate n·l > 0.
#[inline(always)]
fn specular_phong<S: Simd>(simd: S, n: V3<S>, l: V3<S>, v: V3<S>, alpha: Power<S>) -> F<S> {
    let twice = dot::<S>(n, l) * splat(simd, 2.0);
    alpha.raise(simd, fma::<S>(twice, dot::<S>(n, v), -dot::<S>(l, v)))
}

/// `max(n·h, 0)^β` with h = (l + v)/‖l + v‖, as ((n·(l + v))²/‖l + v‖²)^(β/2), without the gate n·l > 0; `half_beta` is
/// β/2.
#[inline(always)]
fn specular_blinn_phong<S: Simd>(simd: S, n: V3<S>, l: V3<S>, v: V3<S>, half_beta: Power<S>) -> F<S> {
    const SMALLEST: f32 = HALFWAY_MIN * HALFWAY_MIN;
    let sum = add::<S>(l, v);
    let squared = dot::<S>(sum, sum);
    let along = max::<S>(dot::<S>(n, sum), splat(simd, 0.0));
    let cos_squared = along * along / max::<S>(squared, splat(simd, SMALLEST));
    let s = half_beta.raise(simd, cos_squared);
    squared.simd_gt(splat(simd, SMALLEST)).select(s, splat(simd, 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::width::{VectorWidth, with_vectors};
    use halfway_lighting::equations::{self, vector};

    /// Axes, widths, l, v, and the exponent otherwise; n is z.
    type Case = ([[f32; 3]; 2], [f32; 3], [[f32; 3]; 2], f32);

    fn highlight<S: Simd>(simd: S, reflectance: Reflectance, &(axes, widths, [l, v], otherwise): &Case) -> f32 {
        let round = Gloss::new(reflectance, &MaterialRecord::default());
        let mut axial = AxialGloss { otherwise: splat(simd, otherwise), ..AxialGloss::none(simd, round) };
        (0..crate::simd::lanes::lanes::<S>()).for_each(|lane| axial.set(lane, axes, widths));
        axial.highlight(simd, splat3(simd, [0.0, 0.0, 1.0]), splat3(simd, l), splat3(simd, v))[0]
    }

    fn expected(reflectance: Reflectance, &(axes, widths, [l, v], otherwise): &Case) -> f64 {
        let wide = |of: [f32; 3]| of.map(f64::from);
        let (n, l, v) = ([0.0, 0.0, 1.0], wide(l), wide(v));
        let e = equations::axial_exponent(axes.map(wide), wide(widths), vector::add(l, v), otherwise.into());
        match reflectance {
            Reflectance::Phong => equations::specular_phong(n, l, v, e),
            _ => equations::specular_blinn_phong(n, l, v, e),
        }
    }

    /// Two axes, rotated axes, no axes, widths that would give exponents below 0, and a halfway vector along the normal
    /// itself.
    #[test]
    fn anisotropic_highlights_match_the_equations() {
        let (straight, turned) = ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0.8, 0.6, 0.0], [0.6, -0.8, 0.0]]);
        let unit = |d: [f32; 3]| vector::normalize(d.map(f64::from)).expect("a direction").map(|x| x as f32);
        let v = unit([0.1, -0.2, 1.0]);
        let (beside, mirrored) = (unit([0.3, 0.1, 1.0]), [-v[0], -v[1], v[2]]);
        let cases: [Case; 6] = [
            (straight, [60.0, 0.0, 4.0], [beside, v], 9.0),
            (turned, [60.0, -12.0, 4.0], [beside, v], 9.0),
            (straight, [60.0, 30.0, 40.0], [unit([-0.5, 0.4, 0.9]), v], 9.0),
            ([[0.0; 3]; 2], [60.0, 0.0, 4.0], [beside, v], 9.0),
            (straight, [1.0, -40.0, 1.0], [unit([0.6, 0.7, 0.8]), v], 9.0),
            (straight, [60.0, 0.0, 4.0], [mirrored, v], 0.0),
        ];
        let mut seen = [false; 2];
        for case in &cases {
            for kind in [Reflectance::Phong, Reflectance::BlinnPhong] {
                let expected = expected(kind, case);
                seen[usize::from(expected < 0.9)] = true;
                for width in VectorWidth::available() {
                    let found =
                        with_vectors!(width.level().expect("one of this CPU's"), simd => highlight(simd, kind, case));
                    // Cosines are off by some ULP, times exponents of up to 60.
                    let error = (f64::from(found) - expected).abs();
                    assert!(error < 2e-5, "{kind:?} on {width}: {found} instead of {expected}: {case:?}");
                }
            }
        }
        assert_eq!(seen, [true; 2], "some are bright and some are not");
    }
}
