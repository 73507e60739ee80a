//! Materials: how a surface reflects light.

use crate::LinearRgba;
use bytemuck::NoUninit;

use crate::field::{self, Described, Field, rgb};
use crate::invalid::{Fields, InvalidValue};
use crate::range::Range;

/// The meaning of each field of [`Material`], for its documentation and for the schema of scene files.
macro_rules! meaning {
    (ambient) => {
        "ka, linear RGB: reflects ambient light. Normally at most 1."
    };
    (diffuse) => {
        "kd, linear RGB: reflects light evenly to all sides. Normally at most 1."
    };
    (specular) => {
        "ks, linear RGB: reflects light into the highlight. Normally at most 1."
    };
    (emission) => {
        "ke, linear RGB: shines by itself, unaffected by lights."
    };
    (shininess) => {
        "The exponent of the highlight."
    };
    (opacity) => {
        "0 is clear, 1 opaque; seen only where the object is blended."
    };
}

/// The classic material: how much of each kind of light a surface gives back.
///
/// A plain value without padding (its bytes can be hashed); equal materials may share one record on the GPU. Named
/// materials are in [`Material::PRESETS`].
#[derive(Clone, Copy, Debug, PartialEq, NoUninit)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component))]
#[repr(C)]
pub struct Material {
    #[doc = meaning!(ambient)]
    ///
    /// Each channel 0 to 10¹²; alpha is ignored. Default 0.2 grey.
    pub ambient: LinearRgba,
    #[doc = meaning!(diffuse)]
    ///
    /// Each channel 0 to 10¹²; alpha is ignored. Default 0.8 grey.
    pub diffuse: LinearRgba,
    #[doc = meaning!(specular)]
    ///
    /// Each channel 0 to 10¹²; alpha is ignored. Default black: no highlight.
    pub specular: LinearRgba,
    #[doc = meaning!(emission)]
    ///
    /// Each channel 0 to 10¹²; alpha is ignored. Default black.
    pub emission: LinearRgba,
    #[doc = meaning!(shininess)]
    ///
    /// Finite, 0 or more. α under Phong reflectance, where 5–10 looks like plastic and 100–200 like metal; β under
    /// Blinn–Phong, where about four times as much gives a highlight of the same size ([`crate::matched_shininess`]). 0
    /// gives a highlight as wide as the lit side. Default 32.
    pub shininess: f32,
    #[doc = meaning!(opacity)]
    ///
    /// 0 to 1; [`AlphaMode`](crate::AlphaMode) says what one below 1 does. Default 1.
    pub opacity: f32,
}

impl Material {
    /// The value of [`Material::default`], for constants.
    pub const DEFAULT: Self = Self {
        ambient: LinearRgba::rgb(0.2, 0.2, 0.2),
        diffuse: LinearRgba::rgb(0.8, 0.8, 0.8),
        specular: LinearRgba::BLACK,
        emission: LinearRgba::BLACK,
        shininess: 32.0,
        opacity: 1.0,
    };

    /// A surface without a highlight: ambient and diffuse are `color`.
    ///
    /// Every constructor takes any colour of `bevy_color` and converts it to linear RGB:
    ///
    /// ```
    /// use bevy_color::{Color, LinearRgba, Srgba};
    /// use halfway_lighting::Material;
    ///
    /// let orange = Material::matte(Srgba::rgb_u8(255, 128, 0));
    /// assert_eq!(orange, Material::matte(Color::srgb_u8(255, 128, 0)));
    /// // sRGB 128 of 255 is 0.216 of linear light.
    /// assert!((orange.diffuse.green - 0.216).abs() < 1e-3);
    /// assert_eq!(Material::matte(LinearRgba::RED).diffuse, LinearRgba::RED);
    /// ```
    pub fn matte(color: impl Into<LinearRgba>) -> Self {
        let color = color.into();
        Self { ambient: color, diffuse: color, ..Self::DEFAULT }
    }

    /// A coloured surface with a half-bright white highlight of shininess 32: ambient and diffuse are `color`, specular
    /// is 0.5 grey, since plastic reflects at its surface without colouring the light.
    ///
    /// ```
    /// use bevy_color::{Color, LinearRgba};
    /// use halfway_lighting::Material;
    ///
    /// let ball = Material::plastic(Color::linear_rgb(0.8, 0.1, 0.1));
    /// assert_eq!(ball.specular, LinearRgba::rgb(0.5, 0.5, 0.5));
    /// ```
    pub fn plastic(color: impl Into<LinearRgba>) -> Self {
        Self { specular: LinearRgba::rgb(0.5, 0.5, 0.5), ..Self::matte(color) }
    }

    /// A surface that shines by itself and takes no light: emission is `color`, all else black.
    ///
    /// ```
    /// use bevy_color::{Color, LinearRgba};
    /// use halfway_lighting::Material;
    ///
    /// let bulb = Material::emissive(Color::WHITE);
    /// assert_eq!((bulb.emission, bulb.diffuse), (LinearRgba::WHITE, LinearRgba::BLACK));
    /// ```
    pub fn emissive(color: impl Into<LinearRgba>) -> Self {
        Self { emission: color.into(), ..Self::matte(LinearRgba::BLACK) }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The first field that is outside the range it documents.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        field::validate(self, Fields::for_owner("Material"))
    }
}

impl Described for Material {
    const FIELDS: &'static [Field<Self>] = &[
        Field::color("ambient", meaning!(ambient), |it| rgb(&mut it.ambient)),
        Field::color("diffuse", meaning!(diffuse), |it| rgb(&mut it.diffuse)),
        Field::color("specular", meaning!(specular), |it| rgb(&mut it.specular)),
        Field::color("emission", meaning!(emission), |it| rgb(&mut it.emission)),
        Field::number("shininess", Range::NON_NEGATIVE, meaning!(shininess), |it| &mut it.shininess),
        Field::number("opacity", Range::UNIT, meaning!(opacity), |it| &mut it.opacity),
    ];
}

impl Default for Material {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// The material of back faces, where they are drawn ([`crate::Faces`]) and differ from the front.
///
/// Without it back faces take the entity's [`Material`]. It is a component of its own, since few objects have one.
///
/// ```
/// use bevy_ecs::world::World;
/// use halfway_lighting::{BackMaterial, Faces, Material};
///
/// let mut world = World::new();
/// world.spawn((Material::BRASS, BackMaterial(Material::COPPER), Faces::Both));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "ecs", derive(bevy_ecs::component::Component))]
pub struct BackMaterial(pub Material);

impl BackMaterial {
    /// Checks every field of the material.
    ///
    /// # Errors
    /// The first field that is outside the range it documents.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        field::validate(&self.0, Fields::for_owner("BackMaterial"))
    }
}
