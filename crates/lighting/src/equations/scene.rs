//! What the equations take: the values of the components, in the number type and the space of the evaluation.

use bevy_color::LinearRgba;

use super::Real;
use super::falloff::ConeTerms;
use super::vector::{mul, normalize};
use crate::invalid::{Fields, InvalidValue, Problem};
use crate::{Cone, DirectionalLight, GlobalAmbient, Material, PointLight, SpotLight, Viewer};

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadedPoint<T> {
    /// p, finite.
    pub position: [T; 3],
    /// n, unit length, on the side that is seen.
    pub normal: [T; 3],
}

/// The reflectances of a [`Material`]; see there for their meaning and ranges.
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
}

impl<T: Real> From<&Material> for Coefficients<T> {
    fn from(material: &Material) -> Self {
        Self {
            ka: rgb(material.ambient),
            kd: rgb(material.diffuse),
            ks: rgb(material.specular),
            ke: rgb(material.emission),
            shininess: real(material.shininess),
        }
    }
}

impl<T: Real> Coefficients<T> {
    /// The same where the surface has this color: ka and kd times it, each channel by itself.
    #[must_use]
    pub fn tinted(self, color: [T; 3]) -> Self {
        Self { ka: mul(self.ka, color), kd: mul(self.kd, color), ..self }
    }
}

/// Where a light is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place<T> {
    /// At a finite position (w = 1): it has a distance, and so attenuation and range.
    Point([T; 3]),
    /// In this direction (w = 0), unit length and *toward* the light: attenuation and range do nothing.
    Directional([T; 3]),
}

/// A light of any kind, in the space of the evaluation: eye or world, as long as positions, normals and the viewer are
/// in the same one and lengths in it are world units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light<T> {
    /// Position or direction.
    pub place: Place<T>,
    /// La, ambient colour.
    pub la: [T; 3],
    /// Ld, diffuse colour.
    pub ld: [T; 3],
    /// Ls, specular colour.
    pub ls: [T; 3],
    /// `[a, b, c]` of the attenuation: 0 or more, not all 0.
    pub attenuation: [T; 3],
    /// R, above 0, or `None` for no end.
    pub range: Option<T>,
    /// The cone, or `None` for a light that shines in all directions.
    pub cone: Option<ConeTerms<T>>,
    /// Whether attenuation and cone also weaken the ambient term.
    pub attenuate_ambient: bool,
}

impl<T: Real> Light<T> {
    /// The same light in another number type, each number rounded once. Whoever narrows sees to it that lengths fit.
    pub fn cast<U: Real>(&self) -> Light<U> {
        let number = |x: T| U::of(x.to_f64().unwrap_or(f64::NAN));
        let vector = |v: [T; 3]| v.map(number);
        Light {
            place: match self.place {
                Place::Point(position) => Place::Point(vector(position)),
                Place::Directional(toward) => Place::Directional(vector(toward)),
            },
            la: vector(self.la),
            ld: vector(self.ld),
            ls: vector(self.ls),
            attenuation: vector(self.attenuation),
            range: self.range.map(number),
            cone: self.cone.map(|cone| ConeTerms {
                direction: vector(cone.direction),
                cos_cutoff: number(cone.cos_cutoff),
                cos_inner: cone.cos_inner.map(number),
                exponent: number(cone.exponent),
            }),
            attenuate_ambient: self.attenuate_ambient,
        }
    }
}

impl PointLight {
    /// This light at a position.
    pub fn at<T: Real>(&self, position: [T; 3]) -> Light<T> {
        Light {
            place: Place::Point(position),
            la: rgb(self.ambient),
            ld: rgb(self.diffuse),
            ls: rgb(self.specular),
            attenuation: [self.attenuation.constant, self.attenuation.linear, self.attenuation.quadratic].map(real),
            range: self.range.map(real),
            cone: None,
            attenuate_ambient: self.attenuate_ambient,
        }
    }
}

impl SpotLight {
    /// This light at a position, shining along `direction`, which needs no unit length.
    ///
    /// # Errors
    /// The direction is 0 or not finite.
    pub fn at<T: Real>(&self, position: [T; 3], direction: [T; 3]) -> Result<Light<T>, InvalidValue> {
        let direction = unit("SpotLight", direction)?;
        Ok(Light { cone: self.cone.along(direction), ..self.light.at(position) })
    }
}

impl DirectionalLight {
    /// This light with its rays travelling along `direction`, which needs no unit length.
    ///
    /// # Errors
    /// The direction is 0 or not finite.
    pub fn along<T: Real>(&self, direction: [T; 3]) -> Result<Light<T>, InvalidValue> {
        let direction = unit("DirectionalLight", direction)?;
        Ok(Light {
            place: Place::Directional(direction.map(|x| -x)),
            la: rgb(self.ambient),
            ld: rgb(self.diffuse),
            ls: rgb(self.specular),
            attenuation: [T::one(), T::zero(), T::zero()],
            range: None,
            cone: None,
            attenuate_ambient: false,
        })
    }
}

impl Cone {
    /// This cone around a unit direction, the way the light travels; `None` where the cutoff is π.
    pub fn along<T: Real>(&self, direction: [T; 3]) -> Option<ConeTerms<T>> {
        (!self.is_none()).then(|| ConeTerms {
            direction,
            cos_cutoff: real::<T>(self.cutoff).cosine(),
            cos_inner: self.inner.map(|inner| real::<T>(inner).cosine()),
            exponent: real(self.exponent),
        })
    }
}

impl GlobalAmbient {
    /// Ga.
    pub fn ga<T: Real>(&self) -> [T; 3] {
        rgb(self.0)
    }
}

/// Where the viewer is, in the space of the evaluation.
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
    T::of(f64::from(value))
}

fn unit<T: Real>(owner: &'static str, direction: [T; 3]) -> Result<[T; 3], InvalidValue> {
    normalize(direction).ok_or_else(|| {
        let value = direction.map(|x| x.to_f32().unwrap_or(f32::NAN));
        Fields::of(owner).error("direction", Problem::NoDirection { value })
    })
}
