//! Random values over sixteen decades, and transforms of every kind: never NaN, infinite or negative, and as near the
//! exact value as rounding allows.
//!
//! The exact value is enclosed by an evaluation of its own: every cosine is taken a little smaller and a little larger
//! than it is, and every factor of the equation grows with its cosine or falls with it. So the bound holds at any
//! exponent, at the edge of a cone and at the gate n·l > 0, without an exception.

use core::f32::consts::{FRAC_PI_2, PI};

use bevy_color::LinearRgba;
use halfway_lighting::equations::vector::{dot, length, normalize, scale, sub};
use halfway_lighting::equations::{
    ATTENUATION_MAX, COINCIDENT, Coefficients, Eye, GRAZING, HALFWAY_MIN, Light, Real, ShadedPoint, rgb, shade,
};
use halfway_lighting::{
    Attenuation, Cone, DirectionalLight, Material, PointLight, Reflectance, SpotLight, matched_shininess,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::support::{ALL_REFLECTANCES, to_f64};

/// Everything that one evaluation takes, in numbers that f32 and f64 both hold.
#[derive(Clone, Debug)]
struct Case {
    material: Material,
    light: PointLight,
    kind: Kind,
    /// Of a point or a spot light; may be the lit point itself.
    place: [f32; 3],
    /// Of a spot or a directional light.
    direction: [f32; 3],
    position: [f32; 3],
    normal: [f32; 3],
    view: Eye<f32>,
    reflectance: Reflectance,
    ga: [f32; 3],
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Point,
    Spot(Cone),
    Directional,
}

/// 10^x with x uniform in −8 … 8.
fn magnitude() -> impl Strategy<Value = f32> {
    (-8f32..=8.0).prop_map(|x| 10f32.powf(x))
}

/// A magnitude, or 0.
fn number() -> impl Strategy<Value = f32> {
    prop_oneof![1 => Just(0.0), 7 => magnitude()]
}

fn color(channel: impl Strategy<Value = f32>) -> impl Strategy<Value = LinearRgba> {
    prop::array::uniform3(channel).prop_map(|[r, g, b]| LinearRgba::rgb(r, g, b))
}

fn material(channel: fn() -> BoxedStrategy<f32>, shininess: BoxedStrategy<f32>) -> impl Strategy<Value = Material> {
    let colors = (color(channel()), color(channel()), color(channel()), color(channel()));
    (colors, shininess).prop_map(|((ambient, diffuse, specular, emission), shininess)| Material {
        ambient,
        diffuse,
        specular,
        emission,
        shininess,
        ..Material::DEFAULT
    })
}

/// Uniform on the unit sphere, rounded to f32.
fn direction() -> impl Strategy<Value = [f32; 3]> {
    (-1f64..=1.0, 0.0..core::f64::consts::TAU).prop_map(|(z, angle)| {
        let r = (1.0 - z * z).sqrt();
        [r * angle.cos(), r * angle.sin(), z].map(|x| x as f32)
    })
}

fn signed(size: impl Strategy<Value = f32>) -> impl Strategy<Value = f32> {
    (size, any::<bool>()).prop_map(|(size, negative)| if negative { -size } else { size })
}

fn cone(exponent: BoxedStrategy<f32>) -> impl Strategy<Value = Cone> {
    let cutoff = prop_oneof![Just(0.0), Just(PI), Just(FRAC_PI_2), 0f32..FRAC_PI_2];
    let share = prop_oneof![Just(0.0), Just(1.0), 0f32..1.0];
    (cutoff, prop::option::of(share), exponent).prop_map(|(cutoff, share, exponent)| Cone {
        cutoff,
        inner: share.map(|share| cutoff * share),
        exponent,
    })
}

fn kind(exponent: BoxedStrategy<f32>) -> impl Strategy<Value = Kind> {
    prop_oneof![Just(Kind::Point), cone(exponent).prop_map(Kind::Spot), Just(Kind::Directional)]
}

fn reflectance() -> impl Strategy<Value = Reflectance> {
    prop::sample::select(&ALL_REFLECTANCES)
}

/// Colours, constants and places of any magnitude; light and eye may be at the lit point, or exactly above it.
fn wild() -> impl Strategy<Value = Case> {
    let shininess = prop_oneof![Just(0.0), (-8f32..=5.0).prop_map(|x| 10f32.powf(x))].boxed();
    let near = || (prop::array::uniform3(signed(number())), 0..4u8);
    let place = |position: [f32; 3], (other, which): ([f32; 3], u8)| match which {
        0 => position,
        1 => [position[0], position[1], other[2]],
        _ => other,
    };
    let light = (color(number()), color(number()), color(number()))
        .prop_map(|(ambient, diffuse, specular)| PointLight { ambient, diffuse, specular, ..PointLight::white() });
    let falloff = ([number(), number(), number()], prop::option::of(magnitude()), any::<bool>());
    let seen = (prop::array::uniform3(signed(number())), near(), near(), direction(), direction());
    (
        material(|| number().boxed(), shininess),
        (light, falloff),
        kind(number().boxed()),
        seen,
        reflectance(),
        direction(),
    )
        .prop_map(
            move |(material, (light, ([a, b, c], range, attenuate_ambient)), kind, seen, reflectance, aim)| {
                let attenuation = Attenuation::new(a, b, if a + b + c == 0.0 { 1.0 } else { c });
                let (position, light_at, eye_at, normal, v) = seen;
                let view = if eye_at.1 == 3 { Eye::Infinite(v) } else { Eye::Local(place(position, eye_at)) };
                Case {
                    material,
                    light: PointLight { attenuation, range, attenuate_ambient, ..light },
                    kind,
                    place: place(position, light_at),
                    direction: aim,
                    position,
                    normal,
                    view,
                    reflectance,
                    ga: [1.0; 3],
                }
            },
        )
}

/// Colours to 1, lengths of a few units, a light that shines at the lit point.
fn ordinary() -> impl Strategy<Value = Case> {
    let unit = || (0f32..=1.0).boxed();
    let at = || prop::array::uniform3(-3f32..3.0);
    let light = (color(unit()), color(unit()), prop::option::of(4f32..12.0), any::<bool>());
    let cone = kind((0f32..16.0).boxed());
    (material(unit, (0f32..256.0).boxed()), light, cone, (at(), at(), at()), (direction(), direction()), reflectance())
        .prop_map(|(material, light, kind, (position, place, eye), (normal, nudge), reflectance)| {
            let (ambient, diffuse, range, attenuate_ambient) = light;
            Case {
                material,
                light: PointLight { ambient, range, attenuate_ambient, ..PointLight::new(diffuse) },
                kind,
                place,
                direction: core::array::from_fn(|i| position[i] - place[i] + nudge[i]),
                position,
                normal,
                view: Eye::Local(eye),
                reflectance,
                ga: [0.1; 3],
            }
        })
        .prop_filter("a light that shines somewhere", |case| case.direction != [0.0; 3])
}

impl Case {
    /// From the lit point to the light; 0 where the light counts as being there.
    fn to_light(&self) -> [f64; 3] {
        if self.nearness() < 1.0 { [0.0; 3] } else { sub(to_f64(self.place), to_f64(self.position)) }
    }

    /// The distance of the light from the lit point, in units of the distance within which it counts as at the point.
    fn nearness(&self) -> f64 {
        let p = to_f64(self.position);
        length(sub(to_f64(self.place), p)) / (f64::from(COINCIDENT) * length(p)).max(f64::MIN_POSITIVE)
    }

    /// The n·l up to which the light counts as in the plane of the surface.
    fn grazing(&self) -> f64 {
        let share = match self.kind {
            Kind::Directional => 1.0,
            Kind::Point | Kind::Spot(_) => {
                let d = length(self.to_light());
                if d > 0.0 { 1.0 + length(to_f64(self.position)) / d } else { 0.0 }
            }
        };
        share * f64::from(GRAZING)
    }

    fn light<T: Real>(&self) -> Light<T> {
        let [place, direction] = [self.place, self.direction].map(|a| a.map(|x| T::from_f64(x.into())));
        let PointLight { ambient, diffuse, specular, .. } = self.light;
        match self.kind {
            Kind::Point => self.light.at(place),
            Kind::Spot(cone) => SpotLight { light: self.light, cone }.at(place, direction).expect("a direction"),
            Kind::Directional => DirectionalLight { ambient, diffuse, specular }.along(direction).expect("a direction"),
        }
    }

    fn evaluated<T: Real>(&self) -> [f64; 3] {
        let of = |a: [f32; 3]| a.map(|x| T::from_f64(x.into()));
        let unit = |a: [f32; 3]| normalize(of(a)).expect("a direction");
        let surface = ShadedPoint { position: of(self.position), normal: unit(self.normal) };
        let view = match self.view {
            Eye::Local(eye) => Eye::Local(of(eye)),
            Eye::Infinite(v) => Eye::Infinite(unit(v)),
        };
        let coefficients = Coefficients::from(&self.material);
        shade(&surface, &coefficients, &[self.light::<T>()], of(self.ga), &view, self.reflectance)
            .map(|x| x.to_f64().expect("a float"))
    }

    /// Fails unless the evaluation in `T` is a color, and one that `rounding` explains.
    fn check<T: Real>(&self, rounding: Rounding) -> Result<(), TestCaseError> {
        let got = self.evaluated::<T>();
        for (value, exact) in got.into_iter().zip(rounding.intensity(self)) {
            prop_assert!(value.is_finite() && value >= 0.0, "{got:?}");
            prop_assert!((exact.low..=exact.high).contains(&value), "{value:e} is not in {exact:?}");
        }
        Ok(())
    }
}

/// The allowed distance of a computed number from the exact one.
#[derive(Clone, Copy)]
struct Rounding {
    /// A cosine of two vectors, each computed from two points: absolute.
    cosine: f64,
    /// Products, quotients and sums of what is not negative: relative.
    relative: f64,
    /// The loss of a factor by underflow: absolute.
    least: f64,
}

/// A cosine takes two roundings for the difference of two points, four for the length of each, five for the product:
/// eleven of 6·10⁻⁸.
const F32: Rounding = Rounding { cosine: 7e-7, relative: 2e-6, least: f32::MIN_POSITIVE as f64 };
/// The same count of 10⁻¹⁶; the enclosure itself is computed so.
const F64: Rounding = Rounding { cosine: 2e-15, relative: 1e-14, least: f64::MIN_POSITIVE };

/// The interval of an exact number of 0 or more.
#[derive(Clone, Copy, Debug)]
struct Between {
    low: f64,
    high: f64,
}

impl Between {
    const fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    fn times(self, other: Self) -> Self {
        Self::new(self.low * other.low, self.high * other.high)
    }
}

impl Rounding {
    /// I of a case.
    fn intensity(self, case: &Case) -> [Between; 3] {
        let unit = |a: [f32; 3]| normalize(to_f64(a)).expect("a direction");
        let n = unit(case.normal);
        let p = to_f64(case.position);
        let toward = |q: [f32; 3]| normalize(sub(to_f64(q), p)).unwrap_or(n);
        let v = match case.view {
            Eye::Local(eye) => toward(eye),
            Eye::Infinite(v) => unit(v),
        };
        let l = match case.kind {
            Kind::Directional => scale(unit(case.direction), -1.0),
            Kind::Point | Kind::Spot(_) => normalize(case.to_light()).unwrap_or(n),
        };
        let weight = self.weight(case, l);
        let lambert = self.above(case, dot(n, l), self.cosine(dot(n, l), 1.0));
        let gloss = self.gloss(case, n, l, v);
        let Material { ambient, diffuse, specular, emission, .. } = case.material;
        let [ka, kd, ks, ke] = [ambient, diffuse, specular, emission].map(rgb::<f64>);
        let [la, ld, ls] = [case.light.ambient, case.light.diffuse, case.light.specular].map(rgb::<f64>);
        let fades = case.light.attenuate_ambient && !matches!(case.kind, Kind::Directional);
        let ambient = if fades { weight } else { Between::new(1.0, 1.0) };
        core::array::from_fn(|k| {
            let sum = |w: f64, a: f64, d: f64, s: f64| {
                ke[k] + ka[k] * f64::from(case.ga[k]) + ka[k] * la[k] * a + w * (kd[k] * ld[k] * d + ks[k] * ls[k] * s)
            };
            // A factor that underflowed is multiplied by the colors and the largest attenuation after that.
            let lost = self.least * (1.0 + sum(ATTENUATION_MAX.into(), 1.0, 1.0, 1.0));
            let low = sum(weight.low, ambient.low, lambert.low, gloss.low);
            let high = sum(weight.high, ambient.high, lambert.high, gloss.high);
            Between::new(low * (1.0 - self.relative) - lost, high * (1.0 + self.relative) + lost)
        })
    }

    /// max(c, 0) for a cosine of a few times the usual error.
    fn cosine(self, c: f64, times: f64) -> Between {
        let off = self.cosine * times;
        Between::new((c - off).clamp(0.0, 1.0), (c + off).clamp(0.0, 1.0))
    }

    /// c^e with 0⁰ = 1, for a c of at most 1: it falls with e.
    fn power(self, c: Between, e: f64) -> Between {
        let power = |x: f64, e: f64| if e == 0.0 { 1.0 } else { x.powf(e) };
        Between::new(power(c.low, e * (1.0 + self.relative)), power(c.high, e * (1.0 - self.relative)))
    }

    /// S, with its gate.
    fn gloss(self, case: &Case, n: [f64; 3], l: [f64; 3], v: [f64; 3]) -> Between {
        let nl = dot(n, l);
        let alpha = f64::from(case.material.shininess);
        let s = match case.reflectance {
            // 2(n·l)(n·v) − l·v: five cosines.
            Reflectance::Phong => self.power(self.cosine(2.0 * nl * dot(n, v) - dot(l, v), 5.0), alpha),
            Reflectance::BlinnPhong => self.halfway(n, l, v, alpha),
            Reflectance::BlinnPhongMatched => self.halfway(n, l, v, matched_shininess(alpha)),
        };
        self.above(case, nl, s)
    }

    /// A term, with its gate: 0 unless n·l is above what counts as in the plane.
    fn above(self, case: &Case, nl: f64, term: Between) -> Between {
        let grazing = case.grazing();
        let off = self.cosine * (1.0 + grazing);
        Between::new(if nl > grazing + off { term.low } else { 0.0 }, if nl > grazing - off { term.high } else { 0.0 })
    }

    /// (n·h)^β.
    fn halfway(self, n: [f64; 3], l: [f64; 3], v: [f64; 3], beta: f64) -> Between {
        let sum: [f64; 3] = core::array::from_fn(|i| l[i] + v[i]);
        let (width, shortest) = (length(sum), f64::from(HALFWAY_MIN));
        if width <= shortest - self.cosine {
            return Between::new(0.0, 0.0);
        }
        let s = self.power(self.cosine(dot(n, sum) / width, 1.0 + 2.0 / width), beta);
        // Too short a sum for a direction may be taken for none.
        if width > shortest + self.cosine { s } else { Between::new(0.0, s.high) }
    }

    /// att·spot.
    fn weight(self, case: &Case, l: [f64; 3]) -> Between {
        if matches!(case.kind, Kind::Directional) {
            return Between::new(1.0, 1.0);
        }
        let d = length(case.to_light());
        let Attenuation { constant, linear, quadratic } = case.light.attenuation;
        let [a, b, c] = [constant, linear, quadratic].map(f64::from);
        let att = 1.0 / (a + b * d + c * d * d).max(1.0 / f64::from(ATTENUATION_MAX));
        let window = |relative: f64| {
            case.light
                .range
                .map_or(1.0, |range| (1.0 - (d / f64::from(range) * (1.0 + relative)).powi(4)).clamp(0.0, 1.0).powi(2))
        };
        let arriving = Between::new(att * window(self.relative), att * window(-self.relative));
        match case.kind {
            Kind::Spot(cone) if !cone.is_none() => arriving.times(self.cone(case, &cone, l)),
            _ => arriving,
        }
    }

    fn cone(self, case: &Case, cone: &Cone, l: [f64; 3]) -> Between {
        let phi = -dot(l, normalize(to_f64(case.direction)).expect("a direction"));
        let cutoff = f64::from(cone.cutoff).cos();
        if phi + self.cosine < cutoff - self.cosine {
            return Between::new(0.0, 0.0);
        }
        let inside = phi - self.cosine >= cutoff + self.cosine;
        let fade = cone.inner.map_or(Between::new(1.0, 1.0), |inner| {
            let width = f64::from(inner).cos() - cutoff;
            let s = |phi: f64, width: f64| if width <= 0.0 { 1.0 } else { ((phi - cutoff) / width).clamp(0.0, 1.0) };
            let off = 2.0 * self.cosine;
            // The wider the fade and the smaller the cosine, the less is left.
            Between::new(s(phi - off, width + off).powi(2), s(phi + off, width - off).powi(2))
        });
        let factor = self.power(self.cosine(phi, 1.0), cone.exponent.into()).times(fade);
        Between::new(if inside { factor.low } else { 0.0 }, factor.high)
    }
}

/// The same cases in every run.
fn config(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(1975), ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(config(12_000))]

    #[test]
    fn ordinary_values_are_exact_but_for_rounding(case in ordinary()) {
        case.check::<f32>(F32)?;
        case.check::<f64>(F64)?;
    }

    #[test]
    fn sixteen_decades_are_exact_but_for_rounding(case in wild()) {
        // Rounding decides there whether the light counts as being at the point.
        prop_assume!((case.nearness() - 1.0).abs() > 1e-3);
        case.material.validate().expect("a valid material");
        case.light.validate().expect("a valid light");
        case.check::<f32>(F32)?;
        case.check::<f64>(F64)?;
    }
}
