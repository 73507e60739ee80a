//! The solids that objects of a scene file are cut from.

use bevy_math::Mat4;
use halfway_texture::noise::MOST_OCTAVES;
use halfway_texture::{SolidKind, SolidTexture};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::check::{Check, Within, count, test};
use crate::read::{ComponentWord, JsonObject, Spoken, Word, object, word, write_word};
use crate::transform::TransformEntry;

/// `solid`: a pattern that fills space, of which the object's surface shows what it cuts out.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Copy, Debug, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct SolidEntry {
    /// What fills space.
    #[serde(deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<SolidKind>")]
    pub kind: SolidKind,
    /// How many octaves of noise marble and noise have: 1 to 16.
    #[schemars(range(min = 1, max = MOST_OCTAVES))]
    pub octaves: u32,
    /// From the object's space to the solid's, in cells: a scale of 4 puts four to a length of 1.
    #[serde(deserialize_with = "object")]
    pub transform: TransformEntry,
    /// The two colors of the solid, linear RGB. 0 to 1.
    #[schemars(inner(inner(range(min = 0, max = 1))))]
    pub colors: [[f32; 3]; 2],
}

impl Default for SolidEntry {
    fn default() -> Self {
        let SolidTexture { kind, octaves, colors, .. } = SolidTexture::default();
        Self { kind, octaves, transform: TransformEntry::default(), colors }
    }
}

impl JsonObject for SolidEntry {
    const EXPECTED: &'static str = "an object such as {\"kind\": \"marble\"}";
}

impl SolidEntry {
    pub(crate) fn check(&self) -> Check {
        count("octaves", self.octaves, 1..=MOST_OCTAVES)?;
        self.transform.check().within("transform")?;
        for (number, color) in self.colors.iter().enumerate() {
            for (channel, &value) in color.iter().enumerate() {
                let found = test("", value, (0.0..=1.0).contains(&value), "0 to 1");
                found.within_item("", channel).within_item("colors", number)?;
            }
        }
        Ok(())
    }

    /// What a part of the object is cut from, that lies in it so.
    pub(crate) fn of_part(&self, object_from_part: &Mat4) -> SolidTexture {
        let solid_from_part = self.transform.matrix().as_dmat4() * object_from_part.as_dmat4();
        let columns = solid_from_part.to_cols_array_2d().map(|column| column.map(|number| number as f32));
        let Self { kind, octaves, colors, .. } = *self;
        SolidTexture { octaves, ..SolidTexture::new(kind, colors) }.placed(columns)
    }
}

impl Word for SolidKind {
    const WORDS: &'static [(&'static str, Self)] =
        &[("checker", Self::Checker), ("marble", Self::Marble), ("wood", Self::Wood), ("noise", Self::Noise)];
}

impl ComponentWord for SolidKind {
    const NAME: &'static str = "SolidKindEntry";
    const MEANING: &'static str = "What fills the space of a solid.";
    const MEANINGS: &'static [&'static str] = &[
        "Cubes of side 1 around whole numbers, in turns of the two colors.",
        "Veins across x, one a unit, bent by noise.",
        "Rings around the y axis, one a unit, made uneven by noise.",
        "A sum of octaves of noise.",
    ];
}
