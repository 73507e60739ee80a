//! Reading a light: every key that some light has, and then those that this kind of light has.
//!
//! `serde`'s tagged enums take a value into a buffer until they know its tag, and errors inside it then come without a
//! line. Here all keys are read where they stand, and a key that the kind does not have is refused by its name.

use std::fmt;

use serde::Deserialize;
use serde::de::Error;

use crate::light::{AttachEntry, ConeEntry, FalloffEntry, LightEntry, LightSource};
use crate::read::{Word, given, word};

/// The keys of all kinds of light together.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(clippy::option_option, reason = "the outer one is whether the key is there, the inner one its null")]
pub(crate) struct LightKeys {
    #[serde(deserialize_with = "word")]
    kind: Kind,
    #[serde(default, deserialize_with = "given")]
    position: Option<Position>,
    #[serde(default, deserialize_with = "given")]
    direction: Option<[f32; 3]>,
    #[serde(default)]
    ambient: [f32; 3],
    #[serde(default = "white")]
    diffuse: [f32; 3],
    #[serde(default = "white")]
    specular: [f32; 3],
    #[serde(default, deserialize_with = "given")]
    attenuation: Option<[f32; 3]>,
    #[serde(default, deserialize_with = "given")]
    range: Option<Option<f32>>,
    #[serde(default, deserialize_with = "given")]
    attenuate_ambient: Option<bool>,
    #[serde(default, deserialize_with = "given")]
    cutoff_deg: Option<f32>,
    #[serde(default, deserialize_with = "given")]
    inner_deg: Option<Option<f32>>,
    #[serde(default, deserialize_with = "given")]
    exponent: Option<f32>,
    #[serde(default, deserialize_with = "word")]
    attach: AttachEntry,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "snake_case")]
enum Kind {
    Point,
    Spot,
    Directional,
    Homogeneous,
}

/// Three numbers, or four in a homogeneous position.
struct Position(Vec<f32>);

/// A key that does not fit the kind of the light. It begins with the key in backticks, by which its line is found.
#[derive(Debug)]
pub(crate) struct Misfit {
    key: &'static str,
    message: String,
}

impl fmt::Display for Misfit {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "`{}` {}", self.key, self.message)
    }
}

impl Word for Kind {
    const EXPECTED: &'static str = "\"point\", \"spot\", \"directional\" or \"homogeneous\"";
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Spot => "spot",
            Self::Directional => "directional",
            Self::Homogeneous => "homogeneous",
        }
    }

    /// The keys of this kind beside those of every light.
    fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Point => &["position", "attenuation", "range", "attenuate_ambient"],
            Self::Directional => &["direction"],
            Self::Spot | Self::Homogeneous => &[
                "position",
                "attenuation",
                "range",
                "attenuate_ambient",
                "direction",
                "cutoff_deg",
                "inner_deg",
                "exponent",
            ],
        }
    }
}

impl LightKeys {
    pub(crate) fn light(self) -> Result<LightEntry, Misfit> {
        self.only_keys_of_its_kind()?;
        let source = match self.kind {
            Kind::Point => LightSource::Point { position: self.point()?, falloff: self.falloff() },
            Kind::Spot => LightSource::Spot {
                position: self.point()?,
                falloff: self.falloff(),
                cone: self.cone(ConeEntry::default()),
            },
            Kind::Directional => {
                LightSource::Directional { direction: self.direction.unwrap_or(LightSource::DIRECTION) }
            }
            Kind::Homogeneous => LightSource::Homogeneous {
                position: self.coordinates(LightSource::HOMOGENEOUS)?,
                falloff: self.falloff(),
                cone: self.cone(ConeEntry::NONE),
            },
        };
        let Self { ambient, diffuse, specular, attach, .. } = self;
        Ok(LightEntry { source, ambient, diffuse, specular, attach })
    }

    fn only_keys_of_its_kind(&self) -> Result<(), Misfit> {
        let present = [
            ("position", self.position.is_some()),
            ("direction", self.direction.is_some()),
            ("attenuation", self.attenuation.is_some()),
            ("range", self.range.is_some()),
            ("attenuate_ambient", self.attenuate_ambient.is_some()),
            ("cutoff_deg", self.cutoff_deg.is_some()),
            ("inner_deg", self.inner_deg.is_some()),
            ("exponent", self.exponent.is_some()),
        ];
        let keys = self.kind.keys();
        match present.into_iter().find(|(key, present)| *present && !keys.contains(key)) {
            None => Ok(()),
            Some((key, _)) => Err(Misfit {
                key,
                message: format!(
                    "does not belong to a {} light, whose keys are {}, ambient, diffuse, specular and attach",
                    self.kind.name(),
                    keys.join(", "),
                ),
            }),
        }
    }

    fn point(&self) -> Result<[f32; 3], Misfit> {
        self.coordinates(LightSource::POSITION)
    }

    fn coordinates<const N: usize>(&self, default: [f32; N]) -> Result<[f32; N], Misfit> {
        let Some(Position(numbers)) = &self.position else { return Ok(default) };
        numbers.as_slice().try_into().map_err(|_| Misfit {
            key: "position",
            message: format!("has {} numbers; a {} light has {N}", numbers.len(), self.kind.name()),
        })
    }

    fn falloff(&self) -> FalloffEntry {
        let default = FalloffEntry::default();
        FalloffEntry {
            attenuation: self.attenuation.unwrap_or(default.attenuation),
            range: self.range.unwrap_or(default.range),
            attenuate_ambient: self.attenuate_ambient.unwrap_or(default.attenuate_ambient),
        }
    }

    fn cone(&self, default: ConeEntry) -> ConeEntry {
        ConeEntry {
            direction: self.direction.unwrap_or(default.direction),
            cutoff_deg: self.cutoff_deg.unwrap_or(default.cutoff_deg),
            inner_deg: self.inner_deg.unwrap_or(default.inner_deg),
            exponent: self.exponent.unwrap_or(default.exponent),
        }
    }
}

fn white() -> [f32; 3] {
    [1.0; 3]
}

impl<'de> Deserialize<'de> for Position {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::deserialize(deserializer).map(Self)
    }
}

impl<'de> Deserialize<'de> for LightEntry {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        LightKeys::deserialize(deserializer)?.light().map_err(D::Error::custom)
    }
}
