//! The images on objects of a scene file.

use std::path::PathBuf;

use bevy_asset::Handle;
use halfway_texture::{
    Channel, FarNormals, LevelFilter, MapKind, Sampling, SurfaceMap, TexelFilter, Texture, UvSet, UvTransform, Wrap,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::check::{Check, KeyProblem, Within, finite};
use crate::read::{ComponentWord, JsonObject, Spoken, Word, object_or_null, word, write_word};

/// `maps`: the images on an object, one of each kind. null: none of that kind.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Debug, Default, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct MapsEntry {
    /// Its color multiplies ambient and diffuse light, and its alpha the opacity, unless there is an `opacity`.
    #[serde(deserialize_with = "object_or_null")]
    pub color: Option<MapEntry>,
    /// Its color multiplies highlights.
    #[serde(deserialize_with = "object_or_null")]
    pub specular: Option<MapEntry>,
    /// Its color multiplies the emission.
    #[serde(deserialize_with = "object_or_null")]
    pub emission: Option<MapEntry>,
    /// Its number multiplies the opacity.
    #[serde(deserialize_with = "object_or_null")]
    pub opacity: Option<MapEntry>,
    /// Its number multiplies the shininess, where highlights are shaded at the pixels.
    #[serde(deserialize_with = "object_or_null")]
    pub shininess: Option<MapEntry>,
    /// Its number multiplies ambient light.
    #[serde(deserialize_with = "object_or_null")]
    pub occlusion: Option<MapEntry>,
    /// Its colors are normals in the space of the mesh's tangents, where light is shaded at the pixels.
    #[serde(deserialize_with = "object_or_null")]
    pub normal: Option<MapEntry>,
    /// Its numbers are heights that turn the normals, where light is shaded at the pixels. Not beside a `normal`.
    #[serde(deserialize_with = "object_or_null")]
    pub height: Option<MapEntry>,
}

impl MapsEntry {
    /// All kinds, each with its image.
    pub fn each(&self) -> [(MapKind, Option<&MapEntry>); MapKind::COUNT] {
        let Self { color, specular, emission, opacity, shininess, occlusion, normal, height } = self;
        let entries = [color, specular, emission, opacity, shininess, occlusion, normal, height];
        std::array::from_fn(|slot| (MapKind::ALL[slot], entries[slot].as_ref()))
    }

    /// Those that are there.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (MapKind, &MapEntry)> {
        self.each().into_iter().filter_map(|(kind, entry)| Some((kind, entry?)))
    }

    pub(crate) fn check(&self) -> Check {
        if self.normal.is_some() && self.height.is_some() {
            return Err(KeyProblem::new("height", "stands beside `normal`; expected one of them"));
        }
        self.iter().try_for_each(|(kind, entry)| entry.check(kind).within(kind.name()))
    }
}

impl JsonObject for MapsEntry {
    const EXPECTED: &'static str = "an object such as {\"color\": {\"path\": \"image.png\"}}";
}

/// An image on an object.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Debug, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct MapEntry {
    /// A PNG, JPEG, HDR or EXR file, relative to the scene file. Required.
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
    /// What is taken of the image where a texel is smaller than a pixel. Slopes of a `height` take levels alone.
    #[serde(default, deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<LevelFilter>")]
    pub levels: LevelFilter,
    /// The mesh's coordinates are moved by this, in widths and heights of the image.
    #[serde(default)]
    pub offset: [f32; 2],
    /// Before that they are turned by this angle in degrees, counter-clockwise as the image is seen.
    #[serde(default)]
    pub rotation_deg: f32,
    /// And first they are stretched by this.
    #[serde(default = "ones")]
    pub scale: [f32; 2],
    /// Which of the mesh's coordinates are taken.
    #[serde(default, deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<UvSet>")]
    pub uv_set: UvSet,
    /// Which number of the image is taken where one is.
    #[serde(default, deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<Channel>")]
    pub channel: Channel,
    /// How much the image counts: 0 not at all, 1 in full; of normals what their slopes are multiplied by; of heights
    /// how high a 1 is, in lengths of the mesh.
    #[serde(default = "one")]
    pub amount: f32,
    /// What highlights take of a `normal` that is smaller than a pixel, beside where it points.
    #[serde(default, deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<FarNormals>")]
    pub far_normals: FarNormals,
}

fn one() -> f32 {
    1.0
}

fn ones() -> [f32; 2] {
    [1.0; 2]
}

impl JsonObject for MapEntry {
    const EXPECTED: &'static str = "an object such as {\"path\": \"image.png\"}";
}

impl MapEntry {
    fn check(&self, kind: MapKind) -> Check {
        if self.path.as_os_str().is_empty() {
            return Err(KeyProblem::new("path", "is empty; expected the path of a PNG or JPEG file"));
        }
        finite("offset", &self.offset)?;
        finite("scale", &self.scale)?;
        if !self.rotation_deg.is_finite() {
            return Err(KeyProblem::new("rotation_deg", "is no finite number"));
        }
        let amount = self.amount;
        match kind.is_relief() {
            true if !amount.is_finite() => Err(KeyProblem::new("amount", "is no finite number")),
            false if !(0.0..=1.0).contains(&amount) => {
                Err(KeyProblem::new("amount", format!("is {amount:?}; expected a number from 0 to 1")))
            }
            _ => Ok(()),
        }
    }

    /// The map with this image.
    pub(crate) fn on(&self, texture: Handle<Texture>) -> SurfaceMap {
        let Self {
            wrap_u, wrap_v, magnify, minify, levels, offset, scale, uv_set, channel, amount, far_normals, ..
        } = *self;
        SurfaceMap {
            texture,
            sampling: Sampling { wrap: [wrap_u, wrap_v], magnify, minify, levels },
            uv_set,
            transform: UvTransform { offset, rotation: self.rotation_deg.to_radians(), scale },
            channel,
            amount,
            far_normals,
        }
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
    const WORDS: &'static [(&'static str, Self)] = &[
        ("none", Self::None),
        ("nearest", Self::Nearest),
        ("linear", Self::Linear),
        ("ripmap", Self::Ripmap),
        ("summed_areas", Self::SummedArea),
        ("anisotropic_2", Self::Anisotropic2),
        ("anisotropic_4", Self::Anisotropic4),
        ("anisotropic_8", Self::Anisotropic8),
        ("anisotropic_16", Self::Anisotropic16),
        ("elliptical", Self::Elliptical),
    ];
}

impl ComponentWord for LevelFilter {
    const NAME: &'static str = "LevelFilterEntry";
    const MEANING: &'static str = "What is taken of an image by how large a pixel is on it, and of what shape.";
    const MEANINGS: &'static [&'static str] = &[
        "The image itself, whose texels are then skipped.",
        "The nearest in size.",
        "The two nearest in size, weighted by nearness.",
        "Images halved along each axis apart: the four nearest to the pixel's width and height on the image.",
        "The mean of a rectangle as wide and as high as the pixel.",
        "Up to 2 lookups along the pixel's longer axis, of levels by its shorter one.",
        "Up to 4 lookups.",
        "Up to 8 lookups.",
        "Up to 16 lookups.",
        "All texels in the ellipse that a round pixel covers, weighted by a Gaussian.",
    ];
}

impl Word for FarNormals {
    const WORDS: &'static [(&'static str, Self)] =
        &[("mean", Self::Mean), ("toksvig", Self::Toksvig), ("lean", Self::Lean)];
}

impl ComponentWord for FarNormals {
    const NAME: &'static str = "FarNormalsEntry";
    const MEANING: &'static str = "What highlights take of normals that are smaller than a pixel.";
    const MEANINGS: &'static [&'static str] = &[
        "Where their mean points.",
        "And how long it is: rough surfaces have wider and fainter highlights from afar.",
        "How far their slopes lie apart along each axis, by two more images: highlights need not be round.",
    ];
}

impl Word for UvSet {
    const WORDS: &'static [(&'static str, Self)] = &[("first", Self::First), ("second", Self::Second)];
}

impl ComponentWord for UvSet {
    const NAME: &'static str = "UvSetEntry";
    const MEANING: &'static str = "Which of a mesh's coordinates on images.";
    const MEANINGS: &'static [&'static str] = &["The first.", "The second, which glTF calls TEXCOORD_1."];
}

impl Word for Channel {
    const WORDS: &'static [(&'static str, Self)] =
        &[("red", Self::Red), ("green", Self::Green), ("blue", Self::Blue), ("alpha", Self::Alpha)];
}

impl ComponentWord for Channel {
    const NAME: &'static str = "ChannelEntry";
    const MEANING: &'static str = "One of the four numbers of a texel.";
    const MEANINGS: &'static [&'static str] =
        &["The first; of a grey image any of three.", "The second.", "The third.", "The fourth."];
}
