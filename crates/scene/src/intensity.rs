//! The key of a scene file that says what becomes of intensities above 1.

use halfway_lighting::Intensity;
use schemars::JsonSchema;
use serde::de::MapAccess;
use serde::{Deserialize, Serialize};

use crate::check::{Check, Within, in_range};
use crate::read::{Given, JsonObject, Word};

/// `intensity`: what becomes of intensities above 1. `clamp` acts on each surface, the others on the finished picture.
#[derive(Serialize, JsonSchema, Clone, Copy, Debug, Default, PartialEq)]
#[serde(rename_all = "snake_case")]
pub enum IntensityEntry {
    /// min(I, 1) for every channel.
    #[default]
    Clamp,
    /// Where any channel exceeds 1, all of the picture are divided by the largest.
    Renormalise,
    /// The same with a divisor that follows from frame to frame.
    #[serde(rename = "renormalise")]
    RenormaliseSlowly(RenormaliseEntry),
    /// I·(1 + I/w²)/(1 + I) for every channel, with a white point w of 4.
    Reinhard,
    /// The same with a white point of its own.
    #[serde(rename = "reinhard")]
    ReinhardTo(ReinhardEntry),
    /// I·(2.51·I + 0.03)/(I·(2.43·I + 0.59) + 0.14), at most 1, for every channel.
    Aces,
}

/// The value of `{"renormalise": …}`.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Copy, Debug, Default, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct RenormaliseEntry {
    /// The share of the last frame's divisor that stays, from 0 to below 1.
    #[schemars(range(min = 0), extend("exclusiveMaximum" = 1))]
    pub smoothing: f32,
}

/// The value of `{"reinhard": …}`.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Copy, Debug, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct ReinhardEntry {
    /// The intensity that becomes 1, itself 1 or more.
    #[schemars(range(min = 1))]
    pub white: f32,
}

impl Default for ReinhardEntry {
    fn default() -> Self {
        Self { white: Intensity::WHITE }
    }
}

impl JsonObject for RenormaliseEntry {
    const EXPECTED: &'static str = "an object such as {\"smoothing\": 0.9}";
}

impl JsonObject for ReinhardEntry {
    const EXPECTED: &'static str = "an object such as {\"white\": 4}";
}

/// The key of the object that each of two policies may be.
const RENORMALISE: &str = "renormalise";
const REINHARD: &str = "reinhard";

impl Word for IntensityEntry {
    const WORDS: &'static [(&'static str, Self)] =
        &[("clamp", Self::Clamp), (RENORMALISE, Self::Renormalise), (REINHARD, Self::Reinhard), ("aces", Self::Aces)];
    const OBJECTS: &'static [(&'static str, &'static str)] =
        &[(RENORMALISE, "{\"renormalise\": {\"smoothing\": 0.9}}"), (REINHARD, "{\"reinhard\": {\"white\": 4}}")];

    fn from_member<'de, A: MapAccess<'de>>(key: &str, map: &mut A) -> Result<Self, A::Error> {
        if key == RENORMALISE {
            map.next_value().map(|Given(entry)| Self::RenormaliseSlowly(entry))
        } else {
            map.next_value().map(|Given(entry)| Self::ReinhardTo(entry))
        }
    }
}

impl From<IntensityEntry> for Intensity {
    fn from(entry: IntensityEntry) -> Self {
        match entry {
            IntensityEntry::Clamp => Self::Clamp,
            IntensityEntry::Renormalise => Self::Renormalize { smoothing: 0.0 },
            IntensityEntry::RenormaliseSlowly(RenormaliseEntry { smoothing }) => Self::Renormalize { smoothing },
            IntensityEntry::Reinhard => Self::Reinhard { white: Self::WHITE },
            IntensityEntry::ReinhardTo(ReinhardEntry { white }) => Self::Reinhard { white },
            IntensityEntry::Aces => Self::Aces,
        }
    }
}

impl IntensityEntry {
    pub(crate) fn check(self) -> Check {
        match self {
            Self::Clamp | Self::Renormalise | Self::Reinhard | Self::Aces => Ok(()),
            Self::RenormaliseSlowly(RenormaliseEntry { smoothing }) => {
                in_range("smoothing", smoothing, Intensity::SMOOTHING_RANGE).within(RENORMALISE)
            }
            Self::ReinhardTo(ReinhardEntry { white }) => {
                in_range("white", white, Intensity::WHITE_RANGE).within(REINHARD)
            }
        }
    }
}
