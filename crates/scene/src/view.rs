//! The keys of a scene file that say how its picture is seen and written.

use std::ops::Bound::Excluded;

use bevy_math::{DVec3, Vec3};
use halfway_lighting::{
    Camera, Described, Encoding, Faces, Field, FieldPlace, Range, Reflectance, Shading, Tolerance, VertexColors, Viewer,
};
use schemars::JsonSchema;
use serde::de::MapAccess;
use serde::{Deserialize, Serialize};

use crate::check::{Check, KeyProblem, direction, in_range};
use crate::fields::{self, ComponentObject, XYZ};
use crate::read::{ComponentWord, Given, JsonObject, Word};

impl Word for Encoding {
    const WORDS: &'static [(&'static str, Self)] = &[("srgb", Self::Srgb), ("raw", Self::Raw)];
}

impl ComponentWord for Encoding {
    const NAME: &'static str = "OutputEntry";
    const MEANING: &'static str = "`output`: what the channels of an 8- or 16-bit picture hold.";
    const MEANINGS: &'static [&'static str] = &[
        "Intensities encoded with the sRGB curve, as displays expect.",
        "Intensities as they are, the textbook's way.",
    ];
}

impl Word for Viewer {
    const WORDS: &'static [(&'static str, Self)] = &[("local", Self::Local), ("infinite", Self::Infinite)];
}

impl ComponentWord for Viewer {
    const NAME: &'static str = "ViewerEntry";
    const MEANING: &'static str = "`viewer`: where the viewer is for the highlights.";
    const MEANINGS: &'static [&'static str] = &[
        "The direction to the viewer is taken at every point.",
        "The direction to the viewer is the camera's axis everywhere: cheaper, right only from afar.",
    ];
}

impl Word for Reflectance {
    const WORDS: &'static [(&'static str, Self)] =
        &[("phong", Self::Phong), ("blinn_phong", Self::BlinnPhong), ("blinn_phong_matched", Self::BlinnPhongMatched)];
}

impl ComponentWord for Reflectance {
    const NAME: &'static str = "ReflectanceEntry";
    const MEANING: &'static str = "`reflectance`: the specular term.";
    const MEANINGS: &'static [&'static str] = &[
        "(r·v)^shininess, r the reflected light direction.",
        "(n·h)^shininess, h the halfway vector.",
        "(n·h)^β with β matched, so that highlights are about as large as under `phong`.",
    ];
}

impl Word for Faces {
    const WORDS: &'static [(&'static str, Self)] =
        &[("front", Self::Front), ("back", Self::Back), ("both", Self::Both)];
}

impl ComponentWord for Faces {
    const NAME: &'static str = "FacesEntry";
    const MEANING: &'static str = "`faces`: which sides of a surface are shown. Front faces wind counter-clockwise, also \
                                   under a mirroring transform.";
    const MEANINGS: &'static [&'static str] =
        &["The front.", "The back, lit with the flipped normal and the back material, if any.", "Both."];
}

impl Word for VertexColors {
    const WORDS: &'static [(&'static str, Self)] = &[("multiply", Self::Multiply), ("ignore", Self::Ignore)];
}

impl ComponentWord for VertexColors {
    const NAME: &'static str = "VertexColorsEntry";
    const MEANING: &'static str = "`vertex_colors`: what becomes of the colors at a mesh's vertices.";
    const MEANINGS: &'static [&'static str] = &[
        "They multiply the ambient and diffuse reflectance, and the opacity where the object is blended, on both sides.",
        "Nothing.",
    ];
}

/// `shading`: how often a surface is shaded.
#[derive(Serialize, JsonSchema, Clone, Copy, Debug, Default, PartialEq)]
#[serde(rename_all = "snake_case")]
pub enum ShadingEntry {
    /// One shade per triangle, at its centroid.
    Flat,
    /// At every vertex; colours are interpolated.
    Gouraud,
    /// At every fragment; normals are interpolated.
    #[default]
    Phong,
    /// As `phong`, within the tolerance, wherever that is cheapest.
    Auto,
    /// The same with a tolerance of its own.
    #[serde(rename = "auto")]
    AutoWithin(AutoShading),
}

/// The value of `{"auto": …}`.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Copy, Debug, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct AutoShading {
    /// The `steps` of a tolerance, 0 or more.
    #[schemars(range(min = 0))]
    pub tolerance: f32,
}

impl Default for AutoShading {
    fn default() -> Self {
        Self { tolerance: 1.0 }
    }
}

impl JsonObject for AutoShading {
    const EXPECTED: &'static str = "an object such as {\"tolerance\": 1.0}";
}

impl Word for ShadingEntry {
    const WORDS: &'static [(&'static str, Self)] =
        &[("flat", Self::Flat), ("gouraud", Self::Gouraud), ("phong", Self::Phong), ("auto", Self::Auto)];
    const OBJECTS: &'static [(&'static str, &'static str)] = &[("auto", "{\"auto\": {\"tolerance\": 1.0}}")];

    fn from_member<'de, A: MapAccess<'de>>(_key: &str, map: &mut A) -> Result<Self, A::Error> {
        map.next_value().map(|Given(auto)| Self::AutoWithin(auto))
    }
}

impl ShadingEntry {
    /// The component.
    pub(crate) fn shading(self) -> Shading {
        match self {
            Self::Flat => Shading::Flat,
            Self::Gouraud => Shading::Gouraud,
            Self::Phong => Shading::Phong,
            Self::Auto | Self::AutoWithin(_) => Shading::Phong,
        }
    }

    /// The tolerance that it brings along, beside one that is given.
    pub(crate) fn tolerance(self, given: Option<Tolerance>) -> Option<Tolerance> {
        match self {
            Self::AutoWithin(AutoShading { tolerance: steps }) => {
                Some(Tolerance { steps, ..given.unwrap_or_default() })
            }
            _ => given,
        }
    }

    pub(crate) fn check(self) -> Check {
        match self {
            Self::Flat | Self::Gouraud | Self::Phong | Self::Auto => Ok(()),
            Self::AutoWithin(AutoShading { tolerance }) => in_range("auto.tolerance", tolerance, Range::NON_NEGATIVE),
        }
    }
}

impl JsonObject for Tolerance {
    const EXPECTED: &'static str = "an object such as {\"steps\": 1.0, \"pixels\": 0.5}";
}

impl ComponentObject for Tolerance {
    const NAME: &'static str = "ToleranceEntry";
    const MEANING: &'static str = "`tolerance`: how far a picture may be from everything at full detail with all \
                                   lights, and under `auto` from Phong shading.";
}

/// What each number of [`CameraEntry`] means, for its documentation and for the schema.
macro_rules! meaning {
    (position) => {
        "Where the camera stands."
    };
    (target) => {
        "The point in the middle of the picture; not `position`."
    };
    (up) => {
        "What is up in the picture; not along the line of sight. Any length above 0."
    };
    (fov_y_deg) => {
        "Vertical field of view."
    };
    (near) => {
        "Distance of the near plane. There is no far plane."
    };
}

/// `camera`: where the scene is seen from. Right-handed, Y up; the camera looks from `position` to `target`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraEntry {
    #[doc = meaning!(position)]
    pub position: [f32; 3],
    #[doc = meaning!(target)]
    pub target: [f32; 3],
    #[doc = meaning!(up)]
    pub up: [f32; 3],
    #[doc = meaning!(fov_y_deg)]
    /// In degrees, above 0 and below 180.
    pub fov_y_deg: f32,
    #[doc = meaning!(near)]
    /// Above 0.
    pub near: f32,
}

impl Default for CameraEntry {
    fn default() -> Self {
        Self {
            position: [0.0, 0.0, 3.0],
            target: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            fov_y_deg: 45.0,
            near: Camera::default().near,
        }
    }
}

impl Described for CameraEntry {
    const FIELDS: &'static [Field<Self>] = &[
        Field::new("position", Range::FINITE, meaning!(position), FieldPlace::Three(|it| it.position.each_mut(), XYZ)),
        Field::new("target", Range::FINITE, meaning!(target), FieldPlace::Three(|it| it.target.each_mut(), XYZ)),
        Field::new("up", Range::FINITE, meaning!(up), FieldPlace::Three(|it| it.up.each_mut(), XYZ)),
        Field::number(
            "fov_y_deg",
            Range::new(Excluded(0.0), Excluded(180.0), "degrees above 0 and below 180"),
            meaning!(fov_y_deg),
            |it| &mut it.fov_y_deg,
        ),
        Field::number("near", Range::POSITIVE, meaning!(near), |it| &mut it.near),
    ];
}

impl JsonObject for CameraEntry {
    const EXPECTED: &'static str = "an object with the keys of a camera";
}

impl ComponentObject for CameraEntry {
    const NAME: &'static str = "CameraEntry";
    const MEANING: &'static str = "`camera`: where the scene is seen from. Right-handed, Y up; the camera looks from \
                                   `position` to `target`.";
}

impl CameraEntry {
    pub(crate) fn check(&self) -> Check {
        fields::check(self)?;
        direction("up", &self.up)?;
        if Vec3::from(self.position) == Vec3::from(self.target) {
            return Err(KeyProblem::new("target", "is where the camera stands; expected another point"));
        }
        if self.axes().is_none() {
            return Err(KeyProblem::new("up", "is along the line of sight; expected another direction"));
        }
        Ok(())
    }
}

impl CameraEntry {
    /// The camera's right, up and back in world space, of unit length and perpendicular; `None` where `position` and
    /// `target` or `up` do not say which they are.
    pub(crate) fn axes(&self) -> Option<[DVec3; 3]> {
        let [position, target, up] = [self.position, self.target, self.up].map(|v| Vec3::from(v).as_dvec3());
        let back = (position - target).try_normalize()?;
        let right = up.try_normalize()?.cross(back);
        // The sine of the angle between `up` and the line of sight; below this, rounding alone picks the roll.
        if right.length() < 1e-6 {
            return None;
        }
        let right = right.normalize();
        Some([right, back.cross(right), back])
    }
}
