//! Parallel rays: a light at an infinite distance.

use crate::LinearRgba;

use super::{Light, LightFrame, LightKind, LightNeeds, LightSource, LightView};
use crate::Reflectance;
use crate::bounds::{LitTerms, Receiver, TermBounds};
use crate::equations::{Arrival, Coefficients, Eye, GRAZING, Irradiance, Real, ShadedPoint, unit};
use crate::field::{self, Described, Field, rgb};
use crate::invalid::{Fields, InvalidValue};
use crate::light_colors::{Colors, meaning};
use crate::record::{LightRecord, number};

/// A light so far away that its rays are parallel (w = 0) and do not weaken.
///
/// The rays travel along the local −Z axis of the entity's `GlobalTransform`; its translation does nothing.
///
/// ```
/// use bevy_color::LinearRgba;
/// use glam::Vec3;
/// use bevy_transform::components::Transform;
/// use halfway_lighting::DirectionalLight;
///
/// // A warm sun that shines down and to the right: spawn both as one entity.
/// let sun = DirectionalLight::new(LinearRgba::rgb(1.0, 0.9, 0.7));
/// let place = Transform::default().looking_to(Vec3::new(1.0, -2.0, 0.0), Vec3::Y);
/// assert_eq!(sun.specular, sun.diffuse);
/// # sun.validate().expect("a valid light");
/// # assert!(place.rotation.is_finite());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component), require(bevy_transform::components::Transform))]
pub struct DirectionalLight {
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
}

impl DirectionalLight {
    /// A white light without an ambient colour.
    pub const fn white() -> Self {
        Self { ambient: LinearRgba::BLACK, diffuse: LinearRgba::WHITE, specular: LinearRgba::WHITE }
    }

    /// A light whose diffuse and specular colour are `color`, without an ambient colour.
    pub fn new(color: impl Into<LinearRgba>) -> Self {
        let color = color.into();
        Self { diffuse: color, specular: color, ..Self::white() }
    }

    /// The same with this ambient colour.
    #[must_use]
    pub fn with_ambient(self, color: impl Into<LinearRgba>) -> Self {
        Self { ambient: color.into(), ..self }
    }

    /// This light with its rays travelling along `direction`, which needs no unit length.
    ///
    /// # Errors
    /// The direction is 0 or not finite.
    pub fn along<T: Real>(&self, direction: [T; 3]) -> Result<Light<T>, InvalidValue> {
        let direction = unit("DirectionalLight", direction)?;
        let colors = Colors::new(self.ambient, self.diffuse, self.specular);
        Ok(Light::Directional(Directional { toward: direction.map(|x| -x), colors }))
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The first colour channel that is negative, above 10¹² or not a number.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        field::validate(self, Fields::for_owner("DirectionalLight"))
    }
}

impl Default for DirectionalLight {
    fn default() -> Self {
        Self::white()
    }
}

impl Described for DirectionalLight {
    const FIELDS: &'static [Field<Self>] = &[
        Field::color("ambient", meaning!(ambient), |it| rgb(&mut it.ambient)),
        Field::color("diffuse", meaning!(diffuse), |it| rgb(&mut it.diffuse)),
        Field::color("specular", meaning!(specular), |it| rgb(&mut it.specular)),
    ];
}

/// A [`DirectionalLight`] in the space of an evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Directional<T> {
    /// l: the unit vector *toward* the light.
    pub toward: [T; 3],
    /// Its colours.
    pub colors: Colors<T>,
}

impl<T: Real> Directional<T> {
    /// The same at every point.
    fn arriving(&self) -> Arrival<T> {
        Arrival {
            l: self.toward,
            distance: None,
            constants: None,
            grazing: T::from_f64(GRAZING.into()),
            attenuation: T::one(),
            window: T::one(),
            cos_phi: None,
            spot: T::one(),
        }
    }
}

impl<T: Real> LightSource<T> for Directional<T> {
    fn arrival(&self, _: &ShadedPoint<T>) -> Option<Arrival<T>> {
        Some(self.arriving())
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
        self.colors.arriving(&self.arriving().incidence(), T::one(), (surface, view), (reflectance, material))
    }

    fn steady_ambient(&self) -> [T; 3] {
        self.colors.la
    }

    fn lit_terms(&self, receiver: &Receiver<T>) -> LitTerms {
        receiver.facing_terms(&Receiver::offset_along(self.toward), receiver.colored_terms(&self.colors, false))
    }

    fn bounds(&self, receiver: &Receiver<T>) -> TermBounds<T> {
        receiver.bounds_of(
            self.lit_terms(receiver),
            &self.colors,
            || Receiver::arrival_along(self.toward),
            |_| T::one(),
        )
    }

    fn reach(&self) -> Option<([T; 3], T)> {
        None
    }
}

impl LightKind for DirectionalLight {
    const NAME: &'static str = "directional";
    const FUNCTION: &'static str = "directional_light";
    const WGSL: &'static str = "
// Parallel rays.
fn directional_light(light: Light, p: vec3f, n: vec3f, v: vec3f, material: Material, terms: Terms) -> Irradiance {
    return irradiance(light, Incidence(light.position, GRAZING, 1.0), n, v, material, terms);
}
";
    type Source<T: Real> = Directional<T>;

    fn validate(&self) -> Result<(), InvalidValue> {
        self.validate()
    }

    fn ambient_alone(&self) -> Self {
        Self { diffuse: LinearRgba::BLACK, specular: LinearRgba::BLACK, ..*self }
    }

    fn placed(&self, frame: &impl LightFrame) -> Result<Light<f64>, InvalidValue> {
        self.along(frame.forward()?)
    }

    fn cast<T: Real, U: Real>(source: &Directional<T>) -> Directional<U> {
        Directional { toward: source.toward.map(crate::falloff::number), colors: source.colors.cast() }
    }

    fn in_eye_space(source: &Directional<f64>, view: &LightView) -> Directional<f64> {
        Directional { toward: view.direction(source.toward), ..*source }
    }

    fn needs(source: &Directional<f64>) -> LightNeeds {
        LightNeeds {
            highlights: source.colors.has_highlights(),
            own_specular: !source.colors.are_shared(),
            ..LightNeeds::default()
        }
    }

    fn record(source: &Directional<f64>) -> LightRecord {
        let Colors { ld, ls, .. } = source.colors;
        LightRecord {
            position: source.toward.map(number),
            diffuse: ld.map(number),
            specular: ls.map(number),
            ..LightRecord::default()
        }
    }
}
