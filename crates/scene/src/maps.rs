//! The images on objects of a scene file.

use std::path::PathBuf;

use halfway_texture::{LevelFilter, Sampling, TexelFilter, UvTransform, Wrap};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::check::{Check, KeyProblem, finite};
use crate::read::{ComponentWord, JsonObject, Spoken, Word, word, write_word};

/// `color_map`: an image whose color multiplies ambient and diffuse light.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Debug, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct ColorMapEntry {
    /// A PNG or JPEG file, relative to the scene file. Required.
    pub path: PathBuf,
    /// What is beyond the image along u.
    #[serde(default, deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<Wrap>")]
    pub wrap_u: Wrap,
    /// What is beyond the image along v.
    #[serde(default, deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<Wrap>")]
    pub wrap_v: Wrap,
    /// The filter where a texel is larger than a pixel.
    #[serde(default, deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<TexelFilter>")]
    pub magnify: TexelFilter,
    /// The filter within each level where a texel is smaller than a pixel.
    #[serde(default, deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<TexelFilter>")]
    pub minify: TexelFilter,
    /// Which levels count where a texel is smaller than a pixel.
    #[serde(default, deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<LevelFilter>")]
    pub levels: LevelFilter,
    /// The mesh's coordinates are moved by this, in widths and heights of the image.
    #[serde(default)]
    pub offset: [f32; 2],
    /// Before that they are turned by so many degrees, counter-clockwise as the image is seen.
    #[serde(default)]
    pub rotation_deg: f32,
    /// And first they are stretched by this.
    #[serde(default = "one")]
    pub scale: [f32; 2],
}

fn one() -> [f32; 2] {
    [1.0; 2]
}

impl JsonObject for ColorMapEntry {
    const EXPECTED: &'static str = "an object such as {\"path\": \"image.png\"}";
}

impl ColorMapEntry {
    pub(crate) fn check(&self) -> Check {
        if self.path.as_os_str().is_empty() {
            return Err(KeyProblem::new("path", "is empty; expected the path of a PNG or JPEG file"));
        }
        finite("offset", &self.offset)?;
        finite("scale", &self.scale)?;
        if self.rotation_deg.is_finite() { Ok(()) } else { Err(KeyProblem::new("rotation_deg", "is no finite number")) }
    }

    pub(crate) fn sampling(&self) -> Sampling {
        let Self { wrap_u, wrap_v, magnify, minify, levels, .. } = *self;
        Sampling { wrap: [wrap_u, wrap_v], magnify, minify, levels }
    }

    pub(crate) fn transform(&self) -> UvTransform {
        UvTransform { offset: self.offset, rotation: self.rotation_deg.to_radians(), scale: self.scale }
    }
}

impl Word for Wrap {
    const WORDS: &'static [(&'static str, Self)] =
        &[("repeat", Self::Repeat), ("mirror", Self::Mirror), ("clamp", Self::Clamp)];
}

impl ComponentWord for Wrap {
    const NAME: &'static str = "WrapEntry";
    const MEANING: &'static str = "What is beyond an image.";
    const MEANINGS: &'static [&'static str] =
        &["The image again.", "The image mirrored, and then again.", "Its outermost texels."];
}

impl Word for TexelFilter {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("nearest", Self::Nearest),
        ("bilinear", Self::Bilinear),
        ("b_spline", Self::BSpline),
        ("catmull_rom", Self::CatmullRom),
    ];
}

impl ComponentWord for TexelFilter {
    const NAME: &'static str = "TexelFilterEntry";
    const MEANING: &'static str = "How texels become a value between them.";
    const MEANINGS: &'static [&'static str] = &[
        "The texel that the point lies in.",
        "The mean of four, weighted by nearness along each axis.",
        "The cubic B-spline over sixteen: smooth, and softer than the texels.",
        "The cubic of Catmull and Rom through the texels, over sixteen: sharper; it overshoots.",
    ];
}

impl Word for LevelFilter {
    const WORDS: &'static [(&'static str, Self)] =
        &[("none", Self::None), ("nearest", Self::Nearest), ("linear", Self::Linear)];
}

impl ComponentWord for LevelFilter {
    const NAME: &'static str = "LevelFilterEntry";
    const MEANING: &'static str = "Which of ever smaller images count, by how large a pixel is on the image.";
    const MEANINGS: &'static [&'static str] = &[
        "The image itself, whose texels are then skipped.",
        "The nearest in size.",
        "The two nearest in size, weighted by nearness.",
    ];
}
