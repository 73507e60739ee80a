//! Inputs of the equations: the values of the components, in the number type and the space of the evaluation.

use crate::LinearRgba;

use super::Real;
use super::vector::{mul, normalize};
use crate::invalid::{Fields, InvalidValue, Problem};
use crate::{Material, Viewer};

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadedPoint<T> {
    /// p, finite.
    pub position: [T; 3],
    /// n, unit length, on the side that is seen.
    pub normal: [T; 3],
}

/// The numbers of a [`Material`] as the equations take them; see there for their meaning and ranges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients<T> {
    /// Ambient.
    pub ka: [T; 3],
    /// Diffuse.
    pub kd: [T; 3],
    /// Specular.
    pub ks: [T; 3],
    /// Emission.
    pub ke: [T; 3],
    /// α or β.
    pub shininess: T,
    /// Opacity.
    pub opacity: T,
}

impl<T: Real> From<&Material> for Coefficients<T> {
    fn from(material: &Material) -> Self {
        Self {
            ka: rgb(material.ambient),
            kd: rgb(material.diffuse),
            ks: rgb(material.specular),
            ke: rgb(material.emission),
            shininess: real(material.shininess),
            opacity: real(material.opacity),
        }
    }
}

impl<T: Real> Coefficients<T> {
    /// Those of an opaque surface that gives back no light, with a highlight as wide as the lit side.
    pub fn black() -> Self {
        let black = [T::zero(); 3];
        Self { ka: black, kd: black, ks: black, ke: black, shininess: T::zero(), opacity: T::one() }
    }

    /// Coefficients under which no light adds less than under either of two, so that bounds hold for both. Emission
    /// and opacity, in which lights have no part, are those of `self`.
    #[must_use]
    pub fn brightest(&self, other: &Self) -> Self {
        let larger = |a: [T; 3], b: [T; 3]| [0, 1, 2].map(|channel| a[channel].max(b[channel]));
        Self {
            ka: larger(self.ka, other.ka),
            kd: larger(self.kd, other.kd),
            ks: larger(self.ks, other.ks),
            // The smaller exponent is the wider highlight.
            shininess: self.shininess.min(other.shininess),
            ..*self
        }
    }

    /// Those of the same surface under [`Shading::Unlit`](crate::Shading::Unlit): under an ambient light of 1 its color is
    /// kd, whatever else shines.
    #[must_use]
    pub fn unlit(self) -> Self {
        Self { ka: self.kd, opacity: self.opacity, ..Self::black() }
    }

    /// The same where the surface has this color: ka and kd times it, each channel by itself.
    #[must_use]
    pub fn tinted(self, color: [T; 3]) -> Self {
        Self { ka: mul(self.ka, color), kd: mul(self.kd, color), ..self }
    }
}

/// The position of the viewer, in the space of the evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Eye<T> {
    /// The eye is at this point; v points from the surface to it.
    Local([T; 3]),
    /// v is this unit vector everywhere.
    Infinite([T; 3]),
}

impl<T: Real> Eye<T> {
    /// Whether v differs from point to point.
    pub fn is_local(&self) -> bool {
        matches!(self, Self::Local(_))
    }

    /// The viewer in eye space: the eye at the origin, or v = (0, 0, 1).
    pub fn in_eye_space(viewer: Viewer) -> Self {
        let (zero, one) = (T::zero(), T::one());
        match viewer {
            Viewer::Local => Self::Local([zero; 3]),
            Viewer::Infinite => Self::Infinite([zero, zero, one]),
        }
    }
}

/// A colour without its alpha.
pub fn rgb<T: Real>(color: LinearRgba) -> [T; 3] {
    [color.red, color.green, color.blue].map(real)
}

fn real<T: Real>(value: f32) -> T {
    T::from_f64(f64::from(value))
}

/// The unit vector along the direction of a light.
pub(crate) fn unit<T: Real>(owner: &'static str, direction: [T; 3]) -> Result<[T; 3], InvalidValue> {
    normalize(direction).ok_or_else(|| {
        let value = direction.map(|x| x.to_f32().unwrap_or(f32::NAN));
        Fields::for_owner(owner).error("direction", Problem::NoDirection { value })
    })
}
