//! Light from all directions in a scene file.

use std::ops::Bound::Included;
use std::path::{Path, PathBuf};

use bevy_ecs::entity::Entity;
use bevy_ecs::world::World;
use halfway_asset::Assets;
use halfway_lighting::Range;
use halfway_texture::environment::{Environment, EnvironmentLight, EnvironmentMap, EnvironmentShape};
use halfway_texture::{TexelMeaning, TextureError};

use crate::check::{Check, KeyProblem, Limits};
use crate::keys::{Object, keys, words};

keys! {
    /// `environment`: light from all directions, in images.
    #[derive(Clone, Debug, PartialEq)]
    pub struct EnvironmentEntry {
        [required]
        /// HDR, EXR, PNG or JPEG files, relative to the scene file: one, or of a cube six, of +X, −X, +Y, −Y, +Z and
        /// −Z. Required.
        paths: Vec<PathBuf>,
        [optional]
        /// How the images hold all directions.
        shape: EnvironmentShape = EnvironmentShape::default(),
        /// Multiplies the light.
        strength: f32 = 1.0
            => Limits::Numbers(Range::new(Included(0.0), Included(1e6), "a number from 0 to 1000000")),
        /// It is turned by this angle in degrees around +Y, counter-clockwise as seen from above.
        rotation_deg: f32 = 0.0,
        /// Whether it is seen where nothing is drawn, in place of `background`.
        sky: bool = true,
    }
}

impl Object for EnvironmentEntry {
    const EXPECTED: &'static str = "an object such as {\"paths\": [\"sky.hdr\"]}";

    fn check_whole(&self) -> Check {
        let (found, expected) = (self.paths.len(), if self.shape == EnvironmentShape::Cube { 6 } else { 1 });
        if found != expected {
            return Err(KeyProblem::new("paths", format!("has {found} files; expected {expected} for this shape")));
        }
        if self.paths.iter().any(|path| path.as_os_str().is_empty()) {
            return Err(KeyProblem::new("paths", "has an empty one; expected paths of HDR, EXR, PNG or JPEG files"));
        }
        Ok(())
    }
}

impl EnvironmentEntry {
    /// Puts it into the world. Images that cannot be read are a warning, and squares are shown.
    pub(crate) fn spawn(&self, base_dir: &Path, warnings: &mut Vec<String>, world: &mut World) -> Entity {
        let map = self.load(base_dir).unwrap_or_else(|error| {
            warnings.push(format!("environment: {error}; squares of magenta and black are shown"));
            EnvironmentMap::missing()
        });
        let map = world.resource_mut::<Assets<EnvironmentMap>>().add(map);
        let rotation = self.rotation_deg.to_radians();
        world.spawn(EnvironmentLight { map, strength: self.strength, rotation, sky: self.sky }).id()
    }

    fn load(&self, base_dir: &Path) -> Result<EnvironmentMap, TextureError> {
        let images = self.paths.iter().map(|path| halfway_texture::load(&base_dir.join(path), TexelMeaning::Color));
        EnvironmentMap::new(&Environment::new(self.shape, images.collect::<Result<_, _>>()?)?)
    }
}

words! {
    /// How images hold all directions.
    EnvironmentShape {
        /// Longitude along the width, latitude along the height; −Z is in the middle.
        equirectangular = Self::Equirectangular,
        /// A square photograph of a mirroring ball, looked at along −Z.
        ball = Self::MirrorBall,
        /// Six squares.
        cube = Self::Cube,
    }
}
