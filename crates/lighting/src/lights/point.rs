//! A light at a point that shines in all directions.

use crate::LinearRgba;

use super::{Light, LightFrame, LightKind, LightNeeds, LightSource, LightView};
use crate::Reflectance;
use crate::bounds::{LitTerms, Receiver, TermBounds};
use crate::equations::vector::{length, toward};
use crate::equations::{Arrival, COINCIDENT, Coefficients, Eye, GRAZING, Incidence, Irradiance, Real, ShadedPoint};
use crate::falloff::{Attenuation, ConeTerms, attenuation, number, range_window};
use crate::field::{self, Described, Field, FieldPlace, rgb};
use crate::invalid::{Fields, InvalidValue};
use crate::light_colors::{Colors, is_bright, meaning};
use crate::range::Range;
use crate::record::{self, LightRecord};

/// A light at a point, shining in all directions.
///
/// The position is the translation of the entity's `GlobalTransform`; rotation and scale do nothing.
///
/// ```
/// use bevy_color::LinearRgba;
/// use halfway_lighting::{Attenuation, PointLight};
///
/// // A candle that no longer counts from four units on.
/// let candle = PointLight::new(LinearRgba::rgb(1.0, 0.7, 0.3)).with_attenuation(Attenuation::INVERSE_SQUARE).with_range(4.0);
/// assert!(candle.validate().is_ok());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component), require(bevy_transform::components::Transform))]
pub struct PointLight {
    #[doc = meaning!(ambient)]
    ///
    /// Each channel 0 to 10¹²; alpha is ignored. Default black.
    pub ambient: LinearRgba,
    #[doc = meaning!(diffuse)]
    ///
    /// Each channel 0 to 10¹²; alpha is ignored. Default white.
    pub diffuse: LinearRgba,
    #[doc = meaning!(specular)]
    ///
    /// Each channel 0 to 10¹²; alpha is ignored. Default white.
    pub specular: LinearRgba,
    #[doc = meaning!(attenuation)]
    ///
    /// Each finite, 0 or more. Default 1, 0.09, 0.032.
    pub attenuation: Attenuation,
    #[doc = meaning!(range)]
    ///
    /// In world units, finite and above 0; the factor is that of `KHR_lights_punctual`. Default `None`, which is `null`
    /// in files.
    pub range: Option<f32>,
    #[doc = meaning!(attenuate_ambient)]
    ///
    /// OpenGL 2.1 §2.14.1; so does `range`. Default `false`.
    pub attenuate_ambient: bool,
}

impl PointLight {
    /// A white light with the default falloff and no ambient colour.
    pub const fn white() -> Self {
        Self {
            ambient: LinearRgba::BLACK,
            diffuse: LinearRgba::WHITE,
            specular: LinearRgba::WHITE,
            attenuation: Attenuation::new(1.0, 0.09, 0.032),
            range: None,
            attenuate_ambient: false,
        }
    }

    /// A light whose diffuse and specular colour are `color`, with the default falloff and no ambient colour.
    pub fn new(color: impl Into<LinearRgba>) -> Self {
        let color = color.into();
        Self { diffuse: color, specular: color, ..Self::white() }
    }

    /// The same with this ambient colour.
    #[must_use]
    pub fn with_ambient(self, color: impl Into<LinearRgba>) -> Self {
        Self { ambient: color.into(), ..self }
    }

    /// The same with this falloff.
    #[must_use]
    pub const fn with_attenuation(self, attenuation: Attenuation) -> Self {
        Self { attenuation, ..self }
    }

    /// The same that ends at this distance, in world units, above 0.
    #[must_use]
    pub const fn with_range(self, range: f32) -> Self {
        Self { range: Some(range), ..self }
    }

    /// This light at a position.
    pub fn at<T: Real>(&self, position: [T; 3]) -> Light<T> {
        Light::Point(self.source(position))
    }

    pub(super) fn source<T: Real>(&self, position: [T; 3]) -> Point<T> {
        let Attenuation { constant, linear, quadratic } = self.attenuation;
        Point {
            position,
            colors: Colors::new(self.ambient, self.diffuse, self.specular),
            attenuation: [constant, linear, quadratic].map(number),
            range: self.range.map(number),
            attenuate_ambient: self.attenuate_ambient,
        }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The first field that is outside the range it documents.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        self.validate_as(Fields::for_owner("PointLight"))
    }

    pub(super) fn validate_as(&self, fields: Fields) -> Result<(), InvalidValue> {
        field::validate(self, fields)?;
        self.attenuation.some_above_zero(fields, "attenuation")
    }
}

/// The fields of a light at a position: of a [`PointLight`] itself, or of the one in another component.
macro_rules! fields_at_a_position {
    ($($inside:ident)?) => {
        &[
            Field::color("ambient", meaning!(ambient), |it| rgb(&mut it$(.$inside)?.ambient)),
            Field::color("diffuse", meaning!(diffuse), |it| rgb(&mut it$(.$inside)?.diffuse)),
            Field::color("specular", meaning!(specular), |it| rgb(&mut it$(.$inside)?.specular)),
            Field::new(
                "attenuation",
                Range::NON_NEGATIVE,
                meaning!(attenuation),
                FieldPlace::Three(
                    |it| {
                        let Attenuation { constant, linear, quadratic } = &mut it$(.$inside)?.attenuation;
                        [constant, linear, quadratic]
                    },
                    ["constant", "linear", "quadratic"],
                ),
            ),
            Field::new("range", Range::POSITIVE, meaning!(range), FieldPlace::Optional(|it| &mut it$(.$inside)?.range)),
            Field::new(
                "attenuate_ambient",
                Range::FINITE,
                meaning!(attenuate_ambient),
                FieldPlace::Flag(|it| &mut it$(.$inside)?.attenuate_ambient),
            ),
        ]
    };
}
pub(super) use fields_at_a_position;

impl Described for PointLight {
    const FIELDS: &'static [Field<Self>] = fields_at_a_position!();
}

impl Default for PointLight {
    fn default() -> Self {
        Self::white()
    }
}

/// A [`PointLight`] in the space of an evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point<T> {
    /// A finite position.
    pub position: [T; 3],
    /// Its colours.
    pub colors: Colors<T>,
    /// `[a, b, c]` of the attenuation: 0 or more, not all 0.
    pub attenuation: [T; 3],
    /// R, above 0, or `None` for no end.
    pub range: Option<T>,
    /// Whether attenuation, range and cone also weaken the ambient term.
    pub attenuate_ambient: bool,
}

impl<T: Real> Point<T> {
    // ANCHOR: arriving_at
    /// Its way to a point. If the light is at the point itself ([`COINCIDENT`]) l is n and the distance 0.
    pub(super) fn arriving_at(&self, surface: &ShadedPoint<T>) -> Arrival<T> {
        let least = T::from_f64(GRAZING.into());
        let from_eye = length(surface.position);
        let (l, d, grazing) = match toward(surface.position, self.position) {
            (Some(l), d) if d > T::from_f64(COINCIDENT.into()) * from_eye => (l, d, least + least * (from_eye / d)),
            _ => (surface.normal, T::zero(), T::zero()),
        };
        let window = self.range.map_or(T::one(), |range| range_window(d, range));
        Arrival {
            l,
            distance: Some(d),
            grazing,
            constants: Some(self.attenuation),
            attenuation: attenuation(self.attenuation, d),
            window,
            cos_phi: None,
            spot: T::one(),
        }
    }
    // ANCHOR_END: arriving_at

    /// The light that arrives with this incidence.
    pub(super) fn arriving(
        &self,
        incident: &Incidence<T>,
        seen: (&ShadedPoint<T>, &Eye<T>),
        reflecting: (Reflectance, &Coefficients<T>),
    ) -> Irradiance<T> {
        let ambient = if self.attenuate_ambient { incident.weight } else { T::one() };
        self.colors.arriving(incident, ambient, seen, reflecting)
    }

    /// The terms that may be above 0 on a patch, with or without a cone.
    pub(super) fn lit_terms_in(&self, cone: Option<&ConeTerms<T>>, receiver: &Receiver<T>) -> LitTerms {
        let colored = || receiver.colored_terms(&self.colors, self.attenuate_ambient);
        // Signs of sums that left the number range say nothing.
        let Some(offset) = receiver.offset_to(self.position) else { return colored() };
        if self.range.is_some_and(|range| receiver.is_beyond(range, &offset)) {
            return LitTerms::default();
        }
        let lit = receiver.facing_terms(&offset, colored());
        if lit == LitTerms::default() || receiver.is_out_of_reach(self.position, self.range, cone) {
            LitTerms::default()
        } else {
            lit
        }
    }

    /// Upper bounds of the terms on a patch, with or without a cone.
    pub(super) fn bounds_in(&self, cone: Option<&ConeTerms<T>>, receiver: &Receiver<T>) -> TermBounds<T> {
        let lit = self.lit_terms_in(cone, receiver);
        receiver.bounds_of(
            lit,
            &self.colors,
            || receiver.arrival(self.position),
            |arrival| {
                let window = self.range.map_or(T::one(), |range| range_window(arrival.nearest, range));
                let spot = cone.map_or(T::one(), |cone| arrival.largest_spot(cone));
                attenuation(self.attenuation, arrival.nearest) * window * spot
            },
        )
    }

    pub(super) fn cast<U: Real>(&self) -> Point<U> {
        Point {
            position: self.position.map(number),
            colors: self.colors.cast(),
            attenuation: self.attenuation.map(number),
            range: self.range.map(number),
            attenuate_ambient: self.attenuate_ambient,
        }
    }
}

impl Point<f64> {
    /// The same in eye space, the lengths measured in the view's unit, or in a longer one where it would be too far away.
    /// The direction is kept, so that near the eye, where what it lights is seen, it lights the same.
    #[expect(clippy::float_cmp, reason = "a unit that nothing was done to is 1 exactly")]
    pub(super) fn seen(&self, view: &LightView) -> Self {
        let LightView { eye_from_world, unit: least, farthest } = *view;
        let position = eye_from_world.transform_point3(self.position.into());
        // True of nearly all points, and takes no division.
        if least == 1.0 && position.length_squared() <= farthest * farthest {
            return Self { position: position.to_array(), ..*self };
        }
        let unit = (position.length() / farthest).max(least);
        let [constant, linear, quadratic] = self.attenuation;
        Self {
            position: (position / unit).to_array(),
            attenuation: [constant, linear * unit, quadratic * unit * unit].map(|value| value.min(f64::from(f32::MAX))),
            range: self.range.map(|range| range / unit),
            ..*self
        }
    }

    pub(super) fn needs(&self) -> LightNeeds {
        LightNeeds {
            highlights: self.colors.has_highlights(),
            own_specular: !self.colors.are_shared(),
            attenuated_ambient: self.attenuate_ambient && is_bright(self.colors.la),
            range: self.range.is_some(),
        }
    }

    pub(super) fn record(&self) -> LightRecord {
        let number = record::number;
        let Colors { la, ld, ls } = self.colors;
        let [constant, linear, quadratic] = self.attenuation.map(number);
        LightRecord {
            position: self.position.map(number),
            inverse_range: self.range.map_or(0.0, |range| number(range.recip())),
            diffuse: ld.map(number),
            constant,
            specular: ls.map(number),
            linear,
            quadratic,
            ambient: if self.attenuate_ambient { la.map(number) } else { [0.0; 3] },
            ..LightRecord::default()
        }
    }
}

impl<T: Real> LightSource<T> for Point<T> {
    fn arrival(&self, surface: &ShadedPoint<T>) -> Option<Arrival<T>> {
        Some(self.arriving_at(surface))
    }

    fn colors(&self) -> Option<Colors<T>> {
        Some(self.colors)
    }

    fn irradiance(
        &self,
        surface: &ShadedPoint<T>,
        view: &Eye<T>,
        reflectance: Reflectance,
        material: &Coefficients<T>,
    ) -> Irradiance<T> {
        self.arriving(&self.arriving_at(surface).incidence(), (surface, view), (reflectance, material))
    }

    fn steady_ambient(&self) -> [T; 3] {
        if self.attenuate_ambient { [T::zero(); 3] } else { self.colors.la }
    }

    fn lit_terms(&self, receiver: &Receiver<T>) -> LitTerms {
        self.lit_terms_in(None, receiver)
    }

    fn bounds(&self, receiver: &Receiver<T>) -> TermBounds<T> {
        self.bounds_in(None, receiver)
    }

    fn reach(&self) -> Option<([T; 3], T)> {
        self.range.map(|range| (self.position, range))
    }
}

impl LightKind for PointLight {
    const NAME: &'static str = "point";
    const FUNCTION: &'static str = "point_light";
    const WGSL: &'static str = "
// From a point, in all directions.
fn point_light(light: Light, p: vec3f, n: vec3f, v: vec3f, material: Material, terms: Terms) -> Irradiance {
    return irradiance(light, incidence(light, false, p, n), n, v, material, terms);
}
";
    type Source<T: Real> = Point<T>;

    fn validate(&self) -> Result<(), InvalidValue> {
        self.validate()
    }

    fn ambient_alone(&self) -> Self {
        Self { diffuse: LinearRgba::BLACK, specular: LinearRgba::BLACK, ..*self }
    }

    fn placed(&self, frame: &impl LightFrame) -> Result<Light<f64>, InvalidValue> {
        Ok(self.at(frame.position()?))
    }

    fn cast<T: Real, U: Real>(source: &Point<T>) -> Point<U> {
        source.cast()
    }

    fn in_eye_space(source: &Point<f64>, view: &LightView) -> Point<f64> {
        source.seen(view)
    }

    fn needs(source: &Point<f64>) -> LightNeeds {
        source.needs()
    }

    fn record(source: &Point<f64>) -> LightRecord {
        source.record()
    }
}
