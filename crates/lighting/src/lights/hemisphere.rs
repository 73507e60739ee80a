//! Light from all around: one colour from the sky, another from the ground.

use crate::LinearRgba;

use super::{Light, LightFrame, LightKind, LightNeeds, LightSource, LightView};
use crate::Reflectance;
use crate::bounds::{LitTerms, Receiver, TermBounds};
use crate::equations::vector::{add, dot, scale};
use crate::equations::{self, Arrival, Coefficients, Eye, Irradiance, Real, ShadedPoint, unit};
use crate::falloff::number;
use crate::field::{self, Described, Field, rgb};
use crate::invalid::{Fields, InvalidValue};
use crate::light_colors::Colors;
use crate::record::{self, LightRecord};

macro_rules! meaning {
    (sky) => {
        "The color from the sky, linear RGB: received by the diffuse term of what faces it."
    };
    (ground) => {
        "The color from the ground, linear RGB: received by the diffuse term of what faces away from the sky."
    };
}

/// Light from all around: the sky above, the ground below, and a mixture from the side.
///
/// With d the direction toward the sky, it adds kd·lerp(ground, sky, (1 + n·d)/2) to the diffuse term. There is no
/// highlight, no falloff and no cone, and no side is black: a back face is lit with −n.
/// An occlusion image does not dim it, as it does an environment.
///
/// The sky is along the local +Y axis of the entity's `GlobalTransform`; its translation does nothing.
///
/// ```
/// use bevy_color::LinearRgba;
/// use halfway_lighting::HemisphereLight;
///
/// // A blue sky over brown earth, for an entity whose transform is not turned.
/// let outside = HemisphereLight::new(LinearRgba::rgb(0.3, 0.4, 0.6), LinearRgba::rgb(0.15, 0.1, 0.05));
/// assert!(outside.validate().is_ok());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component), require(bevy_transform::components::Transform))]
pub struct HemisphereLight {
    #[doc = meaning!(sky)]
    ///
    /// Each channel 0 to 10¹²; alpha is ignored. Default white.
    pub sky: LinearRgba,
    #[doc = meaning!(ground)]
    ///
    /// Each channel 0 to 10¹²; alpha is ignored. Default black.
    pub ground: LinearRgba,
}

impl HemisphereLight {
    /// A white sky over black ground.
    pub const fn white() -> Self {
        Self { sky: LinearRgba::WHITE, ground: LinearRgba::BLACK }
    }

    /// A light of these two colours.
    pub fn new(sky: impl Into<LinearRgba>, ground: impl Into<LinearRgba>) -> Self {
        Self { sky: sky.into(), ground: ground.into() }
    }

    /// This light with the sky in the direction `up`, which needs no unit length.
    ///
    /// # Errors
    /// The direction is 0 or not finite.
    pub fn toward<T: Real>(&self, up: [T; 3]) -> Result<Light<T>, InvalidValue> {
        let up = unit("HemisphereLight", up)?;
        Ok(Light::Hemisphere(Hemisphere { up, sky: equations::rgb(self.sky), ground: equations::rgb(self.ground) }))
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The first colour channel that is negative, above 10¹² or not a number.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        field::validate(self, Fields::for_owner("HemisphereLight"))
    }
}

impl Default for HemisphereLight {
    fn default() -> Self {
        Self::white()
    }
}

impl Described for HemisphereLight {
    const FIELDS: &'static [Field<Self>] = &[
        Field::color("sky", meaning!(sky), |it| rgb(&mut it.sky)),
        Field::color("ground", meaning!(ground), |it| rgb(&mut it.ground)),
    ];
}

/// A [`HemisphereLight`] in the space of an evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hemisphere<T> {
    /// d: the unit vector toward the sky.
    pub up: [T; 3],
    /// The colour from the sky.
    pub sky: [T; 3],
    /// The colour from the ground.
    pub ground: [T; 3],
}

impl<T: Real> Hemisphere<T> {
    /// lerp(ground, sky, (1 + n·d)/2); rounding of the cosine leaves the mixture between the two.
    fn mixture(&self, n_dot_d: T) -> [T; 3] {
        let one = T::one();
        let share = ((one + n_dot_d) * T::from_f64(0.5)).max(T::zero()).min(one);
        add(scale(self.ground, one - share), scale(self.sky, share))
    }
}

impl<T: Real> LightSource<T> for Hemisphere<T> {
    fn arrival(&self, _: &ShadedPoint<T>) -> Option<Arrival<T>> {
        None
    }

    fn colors(&self) -> Option<Colors<T>> {
        None
    }

    fn irradiance(&self, surface: &ShadedPoint<T>, _: &Eye<T>, _: Reflectance, _: &Coefficients<T>) -> Irradiance<T> {
        let black = [T::zero(); 3];
        let diffuse = self.mixture(dot(surface.normal, self.up));
        Irradiance { ambient: black, diffuse, specular: black }
    }

    fn steady_ambient(&self) -> [T; 3] {
        [T::zero(); 3]
    }

    fn lit_terms(&self, receiver: &Receiver<T>) -> LitTerms {
        let diffuse = receiver.reflects_diffuse(self.sky) || receiver.reflects_diffuse(self.ground);
        LitTerms { diffuse, ..LitTerms::default() }
    }

    fn bounds(&self, receiver: &Receiver<T>) -> TermBounds<T> {
        // The mixture is linear in the cosine, so each channel is largest at an end.
        let [least, most] = receiver.cosines_with(self.up).map(|cosine| self.mixture(cosine));
        receiver.diffuse_bounds([0, 1, 2].map(|c| least[c].max(most[c])))
    }

    fn reach(&self) -> Option<([T; 3], T)> {
        None
    }
}

impl LightKind for HemisphereLight {
    const NAME: &'static str = "hemisphere";
    const FUNCTION: &'static str = "hemisphere_light";
    const WGSL: &'static str = "
// From all around: the record has d as the position, the sky as the diffuse and the ground as the specular color.
fn hemisphere_light(light: Light, p: vec3f, n: vec3f, v: vec3f, material: Material, terms: Terms) -> Irradiance {
    var result = Irradiance();
    if terms.diffuse {
        let share = clamp(0.5 + 0.5 * dot(n, light.position), 0.0, 1.0);
        result.diffuse = light.specular * (1.0 - share) + light.diffuse * share;
    }
    return result;
}
";
    type Source<T: Real> = Hemisphere<T>;

    fn validate(&self) -> Result<(), InvalidValue> {
        self.validate()
    }

    fn ambient_alone(&self) -> Self {
        Self { sky: LinearRgba::BLACK, ground: LinearRgba::BLACK }
    }

    fn placed(&self, frame: &impl LightFrame) -> Result<Light<f64>, InvalidValue> {
        self.toward(frame.up()?)
    }

    fn cast<T: Real, U: Real>(source: &Hemisphere<T>) -> Hemisphere<U> {
        Hemisphere { up: source.up.map(number), sky: source.sky.map(number), ground: source.ground.map(number) }
    }

    fn in_eye_space(source: &Hemisphere<f64>, view: &LightView) -> Hemisphere<f64> {
        Hemisphere { up: view.direction(source.up), ..*source }
    }

    fn needs(_: &Hemisphere<f64>) -> LightNeeds {
        LightNeeds::default()
    }

    fn record(source: &Hemisphere<f64>) -> LightRecord {
        LightRecord {
            position: source.up.map(record::number),
            diffuse: source.sky.map(record::number),
            specular: source.ground.map(record::number),
            ..LightRecord::default()
        }
    }
}
