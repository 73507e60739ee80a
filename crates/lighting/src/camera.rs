//! The camera: what a view looks through and how its picture is written.

use std::f32::consts::{FRAC_PI_4, PI};
use std::ops::Bound::Excluded;

use bevy_color::LinearRgba;
use bevy_ecs::component::Component;
use bevy_transform::components::Transform;

use crate::equations::{Transcendental, srgb_encoded};
use crate::invalid::{Fields, InvalidValue};
use crate::range::Range;
use crate::{Intensity, Viewer};

/// A perspective camera at its entity's transform, looking along its local −Z with +Y up.
///
/// Only the transform's translation and rotation count: eye space has world units whatever the
/// camera is attached to. A [`Shading`](crate::Shading) or [`Reflectance`](crate::Reflectance) component on the camera
/// is the view's default; an object's own wins for that object.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
#[require(Transform)]
pub struct Camera {
    /// Vertical field of view in radians, in (0, π). Default 45°.
    pub fov_y: f32,
    /// Distance of the near plane in world units, above 0. Default 0.1. There is no far plane.
    pub near: f32,
    /// Colour where nothing is drawn, linear RGB, 0 to 10¹²; alpha is ignored, the picture is opaque. Default black.
    pub background: LinearRgba,
    /// Whether `v` points toward the eye or is constant. Default [`Viewer::Local`].
    pub viewer: Viewer,
    /// Coverage samples a pixel. Default one.
    pub samples: Samples,
    /// The encoding of an 8-bit picture. Default [`Encoding::Srgb`].
    pub encoding: Encoding,
    /// The policy for intensities above 1. Default [`Intensity::Clamp`].
    pub intensity: Intensity,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            fov_y: FRAC_PI_4,
            near: 0.1,
            background: LinearRgba::BLACK,
            viewer: Viewer::default(),
            samples: Samples::default(),
            encoding: Encoding::default(),
            intensity: Intensity::default(),
        }
    }
}

/// Coverage samples a pixel. Shading is still evaluated once a pixel and triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Samples {
    /// The pixel's centre decides.
    #[default]
    One,
    /// Four samples, averaged (multisample anti-aliasing).
    Four,
}

impl Samples {
    /// 1 or 4.
    pub fn count(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Four => 4,
        }
    }
}

/// The encoding of the channels of an 8-bit picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Encoding {
    /// I encoded with the sRGB curve (IEC 61966-2-1), as displays expect.
    #[default]
    Srgb,
    /// I as it is, the textbook's way: 0.5 is written as 128.
    Raw,
}

impl Encoding {
    /// The code of the linear intensity I in [0, 1], itself in [0, 1].
    ///
    /// The sRGB curve is 12.92·I up to 0.0031308, then 1.055·I^(1/2.4) − 0.055; 1 is reached exactly.
    pub fn encode(self, linear: f64) -> f64 {
        match self {
            Self::Raw => linear,
            Self::Srgb => srgb_encoded(linear),
        }
    }

    /// The inverse of [`Encoding::encode`].
    pub fn decode(self, encoded: f64) -> f64 {
        match self {
            Self::Raw => encoded,
            Self::Srgb if encoded <= 0.040_45 => encoded / 12.92,
            Self::Srgb => ((encoded + 0.055) / 1.055).pow(2.4),
        }
    }
}

impl Camera {
    /// Checks every field against its range.
    ///
    /// # Errors
    /// An [`InvalidValue`] that names the field.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let fields = Fields::for_owner("Camera");
        fields.within("fov_y", self.fov_y, Self::FIELD_OF_VIEW)?;
        fields.positive("near", self.near)?;
        fields.color("background", self.background)?;
        self.intensity.validate()
    }

    const FIELD_OF_VIEW: Range = Range::new(Excluded(0.0), Excluded(PI), "an angle above 0 and below π radians");
}
