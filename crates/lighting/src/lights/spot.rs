//! A light at a point that shines into a cone.

use crate::LinearRgba;

use super::point::{Point, fields_at_a_position};
use super::{Light, LightFrame, LightKind, LightNeeds, LightSource, LightView, PointLight};
use crate::Reflectance;
use crate::bounds::{LitTerms, Receiver, TermBounds};
use crate::equations::vector::{dot, neg};
use crate::equations::{Arrival, Coefficients, Eye, Irradiance, Real, ShadedPoint, unit};
use crate::falloff::{Attenuation, Cone, ConeTerms, spot_factor};
use crate::field::{Described, Field, FieldPlace, rgb};
use crate::invalid::{Fields, InvalidValue};
use crate::light_colors::{Colors, meaning};
use crate::range::Range;
use crate::record::{LightRecord, number};

/// A point light that shines only into a cone around the entity's local −Z axis.
///
/// ```
/// use bevy_color::LinearRgba;
/// use halfway_lighting::SpotLight;
///
/// let torch = SpotLight::new(LinearRgba::WHITE).with_cutoff_degrees(25.0).with_inner_degrees(20.0).with_range(10.0);
/// assert!(torch.validate().is_ok());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component), require(bevy_transform::components::Transform))]
pub struct SpotLight {
    /// Colours, falloff and range. The cone weakens the ambient term only where `light.attenuate_ambient` is set.
    pub light: PointLight,
    /// The cone.
    pub cone: Cone,
}

impl SpotLight {
    /// A white light with the default falloff and a hard-edged cone of the half angle `cutoff` in radians.
    pub const fn white(cutoff: f32) -> Self {
        Self { light: PointLight::white(), cone: Cone::new(cutoff) }
    }

    /// A light whose diffuse and specular colour are `color`, with the default falloff and a hard-edged cone of 30°.
    pub fn new(color: impl Into<LinearRgba>) -> Self {
        Self { light: PointLight::new(color), ..Self::default() }
    }

    /// The same with this ambient colour.
    #[must_use]
    pub fn with_ambient(self, color: impl Into<LinearRgba>) -> Self {
        Self { light: self.light.with_ambient(color), ..self }
    }

    /// The same with this falloff.
    #[must_use]
    pub const fn with_attenuation(self, attenuation: Attenuation) -> Self {
        Self { light: self.light.with_attenuation(attenuation), ..self }
    }

    /// The same that ends at this distance, in world units, above 0.
    #[must_use]
    pub const fn with_range(self, range: f32) -> Self {
        Self { light: self.light.with_range(range), ..self }
    }

    /// The same with a cone of this half angle in radians: 0 to π/2, or π for no cone.
    #[must_use]
    pub const fn with_cutoff(self, cutoff: f32) -> Self {
        Self { cone: Cone { cutoff, ..self.cone }, ..self }
    }

    /// The same with a cone of this half angle in degrees: 0 to 90, or 180 for no cone.
    #[must_use]
    pub const fn with_cutoff_degrees(self, cutoff: f32) -> Self {
        self.with_cutoff(cutoff.to_radians())
    }

    /// The same that fades from this half angle on, in degrees, from 0 to the cutoff.
    #[must_use]
    pub const fn with_inner_degrees(self, inner: f32) -> Self {
        Self { cone: Cone { inner: Some(inner.to_radians()), ..self.cone }, ..self }
    }

    /// The same that weakens beside its axis by this power of the cosine, 0 or more.
    #[must_use]
    pub const fn with_exponent(self, exponent: f32) -> Self {
        Self { cone: Cone { exponent, ..self.cone }, ..self }
    }

    /// This light at a position, shining along `direction`, which needs no unit length. Without a cone it is a point
    /// light.
    ///
    /// # Errors
    /// The direction is 0 or not finite.
    pub fn at<T: Real>(&self, position: [T; 3], direction: [T; 3]) -> Result<Light<T>, InvalidValue> {
        let direction = unit("SpotLight", direction)?;
        let point = self.light.source(position);
        Ok(self.cone.along(direction).map_or(Light::Point(point), |cone| Light::Spot(Spot { point, cone })))
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The first field that is outside the range it documents.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let fields = Fields::for_owner("SpotLight");
        self.light.validate_as(fields.inside("light."))?;
        self.cone.validate_as(fields.inside("cone."))
    }
}

impl Described for SpotLight {
    const FIELDS: &'static [Field<Self>] = fields_at_a_position!(light);
}

/// A [`SpotLight`] in the space of an evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot<T> {
    /// The light that the cone cuts.
    pub point: Point<T>,
    /// The cone.
    pub cone: ConeTerms<T>,
}

impl<T: Real> Spot<T> {
    /// Its way to a point.
    fn arriving_at(&self, surface: &ShadedPoint<T>) -> Arrival<T> {
        let arrival = self.point.arriving_at(surface);
        let cos_phi = dot(neg(arrival.l), self.cone.direction);
        Arrival { cos_phi: Some(cos_phi), spot: spot_factor(cos_phi, &self.cone), ..arrival }
    }
}

impl<T: Real> LightSource<T> for Spot<T> {
    fn arrival(&self, surface: &ShadedPoint<T>) -> Option<Arrival<T>> {
        Some(self.arriving_at(surface))
    }

    fn colors(&self) -> Option<Colors<T>> {
        self.point.colors()
    }

    fn irradiance(
        &self,
        surface: &ShadedPoint<T>,
        view: &Eye<T>,
        reflectance: Reflectance,
        material: &Coefficients<T>,
    ) -> Irradiance<T> {
        self.point.arriving(&self.arriving_at(surface).incidence(), (surface, view), (reflectance, material))
    }

    fn steady_ambient(&self) -> [T; 3] {
        self.point.steady_ambient()
    }

    fn lit_terms(&self, receiver: &Receiver<T>) -> LitTerms {
        self.point.lit_terms_in(Some(&self.cone), receiver)
    }

    fn bounds(&self, receiver: &Receiver<T>) -> TermBounds<T> {
        self.point.bounds_in(Some(&self.cone), receiver)
    }

    fn reach(&self) -> Option<([T; 3], T)> {
        self.point.reach()
    }
}

impl LightKind for SpotLight {
    const NAME: &'static str = "spot";
    const FUNCTION: &'static str = "spot_light";
    const WGSL: &'static str = "
// From a point, into a cone.
fn spot_light(light: Light, p: vec3f, n: vec3f, v: vec3f, material: Material, terms: Terms) -> Irradiance {
    return irradiance(light, incidence(light, true, p, n), n, v, material, terms);
}
";
    type Source<T: Real> = Spot<T>;

    fn validate(&self) -> Result<(), InvalidValue> {
        self.validate()
    }

    fn ambient_alone(&self) -> Self {
        Self { light: self.light.ambient_alone(), ..*self }
    }

    fn placed(&self, frame: &impl LightFrame) -> Result<Light<f64>, InvalidValue> {
        let position = frame.position()?;
        if self.cone.is_none() { Ok(self.light.at(position)) } else { self.at(position, frame.forward()?) }
    }

    fn cast<T: Real, U: Real>(source: &Spot<T>) -> Spot<U> {
        Spot { point: source.point.cast(), cone: source.cone.cast() }
    }

    fn in_eye_space(source: &Spot<f64>, view: &LightView) -> Spot<f64> {
        let direction = view.direction(source.cone.direction);
        Spot { point: source.point.seen(view), cone: ConeTerms { direction, ..source.cone } }
    }

    fn needs(source: &Spot<f64>) -> LightNeeds {
        source.point.needs()
    }

    fn record(source: &Spot<f64>) -> LightRecord {
        let cone = &source.cone;
        let [inner_scale, inner_offset] = inner_fade(cone).map(number);
        LightRecord {
            direction: cone.direction.map(number),
            cos_cutoff: number(cone.cos_cutoff),
            exponent: number(cone.exponent),
            inner_scale,
            inner_offset,
            ..source.point.record()
        }
    }
}

/// The inner cone's fade of `KHR_lights_punctual`, s = clamp((cos φ − cos cutoff)/(cos inner − cos cutoff), 0, 1), as
/// scale and offset of cos φ; 0 and 1, which is s = 1, where there is no inner cone or it is as wide as the cutoff.
fn inner_fade(cone: &ConeTerms<f64>) -> [f64; 2] {
    let width = cone.cos_inner.map_or(0.0, |cos_inner| cos_inner - cone.cos_cutoff);
    if width > 0.0 { [1.0 / width, -cone.cos_cutoff / width] } else { [0.0, 1.0] }
}
