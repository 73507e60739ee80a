//! The lights of a scene.
//!
//! A light is a component beside a [`Transform`]: it stands at the translation of its entity's `GlobalTransform` and
//! shines along the local −Z axis, so it moves with whatever it is attached to. [`crate::light_position`] and
//! [`crate::light_direction`] read both.

use core::f32::consts::{FRAC_PI_2, FRAC_PI_6, PI};

use bevy_color::LinearRgba;
use bevy_ecs::component::Component;
use bevy_ecs::resource::Resource;
use bevy_transform::components::Transform;

use crate::field::{self, Described, Field, FieldPlace, rgb};
use crate::invalid::{Fields, InvalidValue, Problem};
use crate::range::Range;

/// How far an angle in radians may lie from π/2 or π and still be taken as it, because degrees were converted in `f32`.
const ANGLE_SLACK: f32 = 1e-6;

/// How a light weakens with the distance d: `1 / (constant + linear·d + quadratic·d²)`, d in world units.
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
        let fields = Fields::of("Attenuation");
        for (name, value) in [("constant", self.constant), ("linear", self.linear), ("quadratic", self.quadratic)] {
            fields.non_negative(name, value)?;
        }
        self.some_above_zero(fields, "constant")
    }

    fn some_above_zero(&self, fields: Fields, field: &str) -> Result<(), InvalidValue> {
        if *self == Self::new(0.0, 0.0, 0.0) { Err(fields.error(field, Problem::NoAttenuation)) } else { Ok(()) }
    }
}

impl Default for Attenuation {
    fn default() -> Self {
        Self::new(1.0, 0.09, 0.032)
    }
}

/// What each field of a light means, for its documentation and for the schema of scene files.
macro_rules! meaning {
    (ambient) => {
        "La, linear RGB: added wherever the surface faces."
    };
    (diffuse) => {
        "Ld, linear RGB: received by the diffuse term."
    };
    (specular) => {
        "Ls, linear RGB: received by the specular term."
    };
    (attenuation) => {
        "[a, b, c] of 1/(a + b·d + c·d²), d the distance. One of them above 0."
    };
    (range) => {
        "Where the light ends: multiplies by clamp(1 − (d/range)⁴, 0, 1)². null: it does not end."
    };
    (attenuate_ambient) => {
        "Whether distance and cone weaken the ambient color too, as in OpenGL."
    };
}

/// A light at a point, shining in all directions.
///
/// The position is the translation of the entity's `GlobalTransform`; rotation and scale do nothing.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[require(Transform)]
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
        Self::from_color(LinearRgba::WHITE)
    }

    /// A light whose diffuse and specular colour are `color`, with the default falloff and no ambient colour.
    pub const fn from_color(color: LinearRgba) -> Self {
        Self {
            ambient: LinearRgba::BLACK,
            diffuse: color,
            specular: color,
            attenuation: Attenuation::new(1.0, 0.09, 0.032),
            range: None,
            attenuate_ambient: false,
        }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The first field that is outside the range it documents.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        self.validate_as(Fields::of("PointLight"))
    }

    fn validate_as(&self, fields: Fields) -> Result<(), InvalidValue> {
        field::validate(self, fields)?;
        self.attenuation.some_above_zero(fields, "attenuation")
    }
}

impl Described for PointLight {
    const FIELDS: &'static [Field<Self>] = &[
        Field::color("ambient", meaning!(ambient), |it| rgb(&mut it.ambient)),
        Field::color("diffuse", meaning!(diffuse), |it| rgb(&mut it.diffuse)),
        Field::color("specular", meaning!(specular), |it| rgb(&mut it.specular)),
        Field::new(
            "attenuation",
            Range::NON_NEGATIVE,
            meaning!(attenuation),
            FieldPlace::Three(
                |PointLight { attenuation: Attenuation { constant, linear, quadratic }, .. }| {
                    [constant, linear, quadratic]
                },
                ["constant", "linear", "quadratic"],
            ),
        ),
        Field::new("range", Range::POSITIVE, meaning!(range), FieldPlace::Optional(|it| &mut it.range)),
        Field::new(
            "attenuate_ambient",
            Range::FINITE,
            meaning!(attenuate_ambient),
            FieldPlace::Flag(|it| &mut it.attenuate_ambient),
        ),
    ];
}

impl Default for PointLight {
    fn default() -> Self {
        Self::white()
    }
}

/// The cone of a [`SpotLight`]. φ is the angle between the light's direction and the ray to the lit point.
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
        self.validate_as(Fields::of("Cone"))
    }

    fn validate_as(&self, fields: Fields) -> Result<(), InvalidValue> {
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

/// A point light that shines only into a cone around the entity's local −Z axis.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
#[require(Transform)]
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

    /// Checks every field.
    ///
    /// # Errors
    /// The first field that is outside the range it documents.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let fields = Fields::of("SpotLight");
        self.light.validate_as(fields.inside("light."))?;
        self.cone.validate_as(fields.inside("cone."))
    }
}

/// A light so far away that its rays are parallel (w = 0) and do not weaken.
///
/// The rays travel along the local −Z axis of the entity's `GlobalTransform`; its translation does nothing.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[require(Transform)]
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
        Self::from_color(LinearRgba::WHITE)
    }

    /// A light whose diffuse and specular colour are `color`, without an ambient colour.
    pub const fn from_color(color: LinearRgba) -> Self {
        Self { ambient: LinearRgba::BLACK, diffuse: color, specular: color }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The first colour channel that is negative, above 10¹² or not a number.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let fields = Fields::of("DirectionalLight");
        fields.color("ambient", self.ambient)?;
        fields.color("diffuse", self.diffuse)?;
        fields.color("specular", self.specular)
    }
}

impl Default for DirectionalLight {
    fn default() -> Self {
        Self::white()
    }
}

/// Ga: ambient light that no light source brings. Every material reflects it by its ambient colour.
///
/// Linear RGB, 0 to 10¹²; alpha is ignored. Default 0.1 grey.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct GlobalAmbient(pub LinearRgba);

impl GlobalAmbient {
    /// Checks the colour.
    ///
    /// # Errors
    /// The first channel that is negative, above 10¹² or not a number.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        Fields::of("GlobalAmbient").color("0", self.0)
    }
}

impl Default for GlobalAmbient {
    fn default() -> Self {
        Self(LinearRgba::rgb(0.1, 0.1, 0.1))
    }
}
