//! The parts that lights at a position share: attenuation with the distance, range, and cone, as components and as maths.

use core::f32::consts::{FRAC_PI_2, FRAC_PI_6, PI};

use crate::equations::{Real, power};
use crate::invalid::{Fields, InvalidValue, Problem};

/// An angle in radians within this distance of π/2 or π counts as that angle, because degrees were converted in `f32`.
const ANGLE_SLACK: f32 = 1e-6;

/// The attenuation of a light with the distance d: `1 / (constant + linear·d + quadratic·d²)`, d in world units.
///
/// Each constant is finite and 0 or more, and at least one is positive. The quotient is at most 10⁶
/// ([`ATTENUATION_MAX`](crate::equations::ATTENUATION_MAX)), so that a light without a constant term stays finite at d
/// = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attenuation {
    /// a, without a unit. Default 1.
    pub constant: f32,
    /// b, per world unit. Default 0.09.
    pub linear: f32,
    /// c, per square world unit. Default 0.032.
    pub quadratic: f32,
}

impl Attenuation {
    /// No falloff: the light is equally strong at any distance.
    pub const NONE: Self = Self::new(1.0, 0.0, 0.0);
    /// The inverse-square law of a physical point light.
    pub const INVERSE_SQUARE: Self = Self::new(0.0, 0.0, 1.0);

    /// `1 / (constant + linear·d + quadratic·d²)`.
    pub const fn new(constant: f32, linear: f32, quadratic: f32) -> Self {
        Self { constant, linear, quadratic }
    }

    /// Checks the three constants.
    ///
    /// # Errors
    /// A constant is negative or not finite, or all three are 0.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let fields = Fields::for_owner("Attenuation");
        for (name, value) in [("constant", self.constant), ("linear", self.linear), ("quadratic", self.quadratic)] {
            fields.non_negative(name, value)?;
        }
        self.some_above_zero(fields, "constant")
    }

    pub(super) fn some_above_zero(&self, fields: Fields, field: &str) -> Result<(), InvalidValue> {
        if *self == Self::new(0.0, 0.0, 0.0) { Err(fields.error(field, Problem::NoAttenuation)) } else { Ok(()) }
    }
}

impl Default for Attenuation {
    fn default() -> Self {
        Self::new(1.0, 0.09, 0.032)
    }
}

/// The cone of a [`SpotLight`](crate::SpotLight). φ is the angle between the light's direction and the ray to the lit point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// The half angle in radians beyond which nothing is lit: 0 to π/2, or π for no cone at all, in which case `inner`
    /// and `exponent` are ignored. A cutoff of 0 lights only the axis. Default π/6 (30°).
    pub cutoff: f32,
    /// The half angle in radians inside which the light is at its full strength, 0 to `cutoff`; from there it fades
    /// smoothly to the cutoff as in `KHR_lights_punctual`. Default `None`: a hard edge.
    pub inner: Option<f32>,
    /// e of `max(cos φ, 0)^e`: finite, 0 or more. Default 0: equally strong over the whole cone.
    pub exponent: f32,
}

impl Cone {
    /// No cone: the light shines in all directions.
    pub const NONE: Self = Self::new(PI);

    /// A hard-edged cone of the half angle `cutoff` in radians, equally strong everywhere inside.
    pub const fn new(cutoff: f32) -> Self {
        Self { cutoff, inner: None, exponent: 0.0 }
    }

    /// This cone around a unit direction, in which the light travels; `None` if the cutoff is π.
    pub fn along<T: Real>(&self, direction: [T; 3]) -> Option<ConeTerms<T>> {
        let real = |value: f32| T::from_f64(value.into());
        (!self.is_none()).then(|| ConeTerms {
            direction,
            cos_cutoff: real(self.cutoff).cosine(),
            cos_inner: self.inner.map(|inner| real(inner).cosine()),
            exponent: real(self.exponent),
        })
    }

    /// Whether the cutoff is π, which stands for no cone.
    pub fn is_none(&self) -> bool {
        (self.cutoff - PI).abs() <= ANGLE_SLACK
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The cutoff is neither in [0, π/2] nor π; the inner angle is not in [0, cutoff]; the exponent is negative or not
    /// finite.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        self.validate_as(Fields::for_owner("Cone"))
    }

    pub(super) fn validate_as(&self, fields: Fields) -> Result<(), InvalidValue> {
        let cone = (0.0..=FRAC_PI_2 + ANGLE_SLACK).contains(&self.cutoff);
        fields.number(
            "cutoff",
            self.cutoff,
            cone || self.is_none(),
            "radians from 0 to π/2 (90°), or π (180°) for no cone",
        )?;
        if let Some(inner) = self.inner {
            fields.non_negative("inner", inner)?;
            if inner > self.cutoff {
                return Err(fields.error("inner", Problem::InnerOutsideCutoff { inner, cutoff: self.cutoff }));
            }
        }
        fields.non_negative("exponent", self.exponent)
    }
}

impl Default for Cone {
    fn default() -> Self {
        Self::new(FRAC_PI_6)
    }
}

/// The largest attenuation: `1 / (a + b·d + c·d²)` is capped here, so that a light without a constant term stays finite
/// at d = 0. It matters only within the distance at which the divisor falls below 10⁻⁶: a thousandth of a world unit
/// for an inverse-square light.
pub const ATTENUATION_MAX: f32 = 1e6;

/// A cone, ready for evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConeTerms<T> {
    /// The direction of the light's travel along the axis, unit length, in the space of the evaluation.
    pub direction: [T; 3],
    /// cos(cutoff). Differences below the resolution of `T` near 1 are lost: in `f32` a cutoff under 2.4e-4 rad is 0.
    pub cos_cutoff: T,
    /// cos(inner), where an inner cone is given.
    pub cos_inner: Option<T>,
    /// e, 0 or more.
    pub exponent: T,
}

impl<T: Real> ConeTerms<T> {
    /// The same in another number type.
    pub(crate) fn cast<U: Real>(&self) -> ConeTerms<U> {
        ConeTerms {
            direction: self.direction.map(number),
            cos_cutoff: number(self.cos_cutoff),
            cos_inner: self.cos_inner.map(number),
            exponent: number(self.exponent),
        }
    }
}

/// A number in another number type, rounded once.
pub(crate) fn number<T: Real, U: Real>(value: T) -> U {
    U::from_f64(value.to_f64().unwrap_or(f64::NAN))
}

// ANCHOR: attenuation
/// `1 / max(a + b·d + c·d², 10⁻⁶)` for the constants `[a, b, c]` and the distance d, all 0 or more.
///
/// With a = 0 and d = 0 it is [`ATTENUATION_MAX`]. If the divisor overflows it is 0.
pub fn attenuation<T: Real>([a, b, c]: [T; 3], d: T) -> T {
    // Horner's form, and a finite d, keep 0·∞ out: with c = 0 and a huge d, c·d² would be NaN.
    let d = d.min(T::max_value());
    (a + d * (b + c * d)).max(T::from_f64(f64::from(ATTENUATION_MAX)).recip()).recip()
}
// ANCHOR_END: attenuation

// ANCHOR: range_window
/// `clamp(1 − (d/R)⁴, 0, 1)²` for a distance d and a range R > 0 (`KHR_lights_punctual`).
pub fn range_window<T: Real>(d: T, range: T) -> T {
    let ratio = d / range;
    let square = ratio * ratio;
    let window = (T::one() - square * square).max(T::zero()).min(T::one());
    window * window
}
// ANCHOR_END: range_window

// ANCHOR: spot_factor
/// `max(cos φ, 0)^e` inside the cone and 0 outside, where `cos_phi` is the cosine of the angle between the axis and the
/// ray to the lit point; OpenGL 2.1 §2.14.1.
///
/// Where an inner cone is given the factor is also multiplied by s² (`KHR_lights_punctual`): s is 1 inside the inner
/// cone and (cos φ − cos cutoff) / (cos inner − cos cutoff) between the two. There cos φ lies below cos inner, so the
/// divisor is above 0, and an inner cone equal to the cutoff is a hard edge. (The extension's sample code bounds the
/// divisor by 10⁻³ instead, which would dim a cone narrower than 2.5° even on its axis.)
pub fn spot_factor<T: Real>(cos_phi: T, cone: &ConeTerms<T>) -> T {
    if cos_phi < cone.cos_cutoff {
        return T::zero();
    }
    let factor = power(cos_phi, cone.exponent);
    match cone.cos_inner {
        Some(cos_inner) if cos_phi < cos_inner => {
            let s = (cos_phi - cone.cos_cutoff) / (cos_inner - cone.cos_cutoff);
            factor * s * s
        }
        _ => factor,
    }
}
// ANCHOR_END: spot_factor
