//! Light from all directions in a scene file.

use std::path::{Path, PathBuf};

use bevy_asset::{Assets, Handle};
use bevy_ecs::world::World;
use halfway_texture::environment::{Environment, EnvironmentLight, EnvironmentMap, EnvironmentShape};
use halfway_texture::{TexelMeaning, TextureError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::check::{Check, KeyProblem};
use crate::read::{ComponentWord, JsonObject, Spoken, Word, word, write_word};

/// `environment`: light from all directions, in images.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Debug, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct EnvironmentEntry {
    /// HDR, EXR, PNG or JPEG files, relative to the scene file: one, or of a cube six, of +X, −X, +Y, −Y, +Z and −Z.
    /// Required.
    pub paths: Vec<PathBuf>,
    /// How the images hold all directions.
    #[serde(default, deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<EnvironmentShape>")]
    pub shape: EnvironmentShape,
    /// Multiplies the light.
    #[serde(default = "one")]
    #[schemars(range(min = 0, max = 1_000_000))]
    pub strength: f32,
    /// It is turned by this angle in degrees around +Y, counter-clockwise as seen from above.
    #[serde(default)]
    pub rotation_deg: f32,
    /// Whether it is seen where nothing is drawn, in place of `background`.
    #[serde(default = "yes")]
    pub sky: bool,
}

fn one() -> f32 {
    1.0
}

fn yes() -> bool {
    true
}

impl JsonObject for EnvironmentEntry {
    const EXPECTED: &'static str = "an object such as {\"paths\": [\"sky.hdr\"]}";
}

impl EnvironmentEntry {
    pub(crate) fn check(&self) -> Check {
        let (found, expected) = (self.paths.len(), if self.shape == EnvironmentShape::Cube { 6 } else { 1 });
        if found != expected {
            return Err(KeyProblem::new("paths", format!("has {found} files; expected {expected} for this shape")));
        }
        if self.paths.iter().any(|path| path.as_os_str().is_empty()) {
            return Err(KeyProblem::new("paths", "has an empty one; expected paths of HDR, EXR, PNG or JPEG files"));
        }
        if !self.rotation_deg.is_finite() {
            return Err(KeyProblem::new("rotation_deg", "is no finite number"));
        }
        let Some(wrong) = self.light(Handle::default()).wrong() else { return Ok(()) };
        let problem = format!("is {}; expected a number from {}", wrong.value, wrong.expected);
        Err(KeyProblem::new(wrong.field, problem))
    }

    fn light(&self, map: Handle<EnvironmentMap>) -> EnvironmentLight {
        let rotation = self.rotation_deg.to_radians();
        EnvironmentLight { map, strength: self.strength, rotation, sky: self.sky }
    }

    /// Puts it into the world. What cannot be read is told, and shown.
    pub(crate) fn spawn(&self, base_dir: &Path, warnings: &mut Vec<String>, world: &mut World) {
        let map = self.load(base_dir).unwrap_or_else(|error| {
            warnings.push(format!("environment: {error}; squares of magenta and black are shown"));
            EnvironmentMap::missing()
        });
        let map = world.resource_mut::<Assets<EnvironmentMap>>().add(map);
        world.spawn(self.light(map));
    }

    fn load(&self, base_dir: &Path) -> Result<EnvironmentMap, TextureError> {
        let images = self.paths.iter().map(|path| halfway_texture::load(&base_dir.join(path), TexelMeaning::Color));
        EnvironmentMap::new(&Environment::new(self.shape, images.collect::<Result<_, _>>()?)?)
    }
}

impl Word for EnvironmentShape {
    const WORDS: &'static [(&'static str, Self)] =
        &[("equirectangular", Self::Equirectangular), ("ball", Self::MirrorBall), ("cube", Self::Cube)];
}

impl ComponentWord for EnvironmentShape {
    const NAME: &'static str = "EnvironmentShapeEntry";
    const MEANING: &'static str = "How images hold all directions.";
    const MEANINGS: &'static [&'static str] = &[
        "Longitude along the width, latitude along the height; −Z is in the middle.",
        "A square photograph of a mirroring ball, looked at along −Z.",
        "Six squares.",
    ];
}
