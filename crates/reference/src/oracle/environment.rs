//! The environment of the scene.

use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemState;
use bevy_math::{DMat3, DVec3};
use halfway_asset::Assets;
use halfway_lighting::{Fields, InvalidValue, Shown};
use halfway_texture::environment::{EnvironmentLight, EnvironmentMap};

use super::error::{ALWAYS, OracleError, label};
use super::solid::Color;
use super::view::PictureView;

/// The environment, in eye space.
#[derive(Clone, Debug)]
pub(super) struct OracleEnvironment {
    pub(super) map: EnvironmentMap,
    pub(super) strength: f64,
    environment_from_eye: DMat3,
    /// The level that is drawn as the sky, if the sky is drawn.
    pub(super) sky: Option<f64>,
}

impl OracleEnvironment {
    /// The environment of the first entity that has one.
    pub(super) fn from_world(world: &mut World, view: &PictureView) -> Result<Option<Self>, OracleError> {
        let mut query = world.query::<(Entity, &EnvironmentLight, Option<&Name>)>();
        let mut shown = SystemState::<Shown>::new(world);
        let shown = shown.get(world).expect(ALWAYS);
        let is_shown = shown.by_entity();
        let first = query.iter(world).filter(|(entity, ..)| is_shown(*entity)).min_by_key(|(entity, ..)| *entity);
        let Some((entity, light, name)) = first else { return Ok(None) };
        check(light).map_err(|source| OracleError::Invalid { entity: label(entity, name), source })?;
        let maps = world.get_resource::<Assets<EnvironmentMap>>();
        let map = maps.and_then(|maps| maps.get(&light.map)).cloned().unwrap_or_else(EnvironmentMap::missing);
        let rows = DMat3::from_cols_array_2d(&light.environment_from_world()).transpose();
        let level = map.level_of(view.pixel_angle()).max(0.0);
        Ok(Some(Self {
            strength: light.strength.into(),
            environment_from_eye: rows * view.world_from_eye(),
            sky: light.sky.then_some(level),
            map,
        }))
    }

    /// The light from a direction of eye space.
    pub(super) fn at(&self, direction: DVec3, level: f64) -> Color {
        self.map.at((self.environment_from_eye * direction).to_array(), level)
    }

    /// The mean light E on a surface with a normal of eye space.
    pub(super) fn mean_light(&self, n: Color) -> Color {
        let [r, g, b, _] =
            self.map.harmonics().mean_light((self.environment_from_eye * DVec3::from_array(n)).to_array());
        [r, g, b].map(|channel| channel.max(0.0))
    }
}

fn check(light: &EnvironmentLight) -> Result<(), InvalidValue> {
    light.wrong().map_or(Ok(()), |wrong| {
        Fields::for_owner("EnvironmentLight").number(wrong.field, wrong.value, false, wrong.expected)
    })
}
