//! The environment that lights the frame, in eye space.

use crate::error::{RenderError, label};
use crate::report::FrameReport;
use crate::view::camera::View;
use bevy_ecs::prelude::*;
use bevy_math::DMat3;
use halfway_asset::Assets;
use halfway_lighting::{Fields, Load, Shown};
use halfway_texture::environment::SurroundingsData;
use halfway_texture::environment::{EnvironmentLight, EnvironmentMap};

/// The environment of the frame. Holds from [`RenderSet::Select`](crate::sets::RenderSet::Select) on.
#[derive(Resource, Debug, Default)]
pub struct Surroundings(pub Option<SurroundingsData>);

impl Surroundings {
    pub(crate) fn are_there(&self) -> bool {
        self.0.is_some()
    }
}

/// Takes the environment of the first entity; more are told.
pub(crate) fn gather(
    environments: Query<(Entity, &EnvironmentLight, Option<&Name>)>,
    shown: Shown,
    maps: Option<Res<Assets<EnvironmentMap>>>,
    view: Res<View>,
    mut surroundings: ResMut<Surroundings>,
    mut report: ResMut<FrameReport>,
) {
    surroundings.0 = None;
    if environments.is_empty() || view.camera.is_none() {
        return;
    }
    let is_shown = shown.by_entity();
    let all: Vec<_> = environments.iter().filter(|(entity, ..)| is_shown(*entity)).collect();
    if all.len() > 1 {
        report.errors.push(RenderError::ManyEnvironments(all.len()));
    }
    let Some((entity, light, name)) = all.into_iter().min_by_key(|(entity, ..)| *entity) else { return };
    if let Some(wrong) = light.wrong() {
        let fields = Fields::for_owner("EnvironmentLight");
        if let Err(source) = fields.number(wrong.field, wrong.value, false, wrong.expected) {
            report.errors.push(RenderError::Invalid { entity: label(entity, name), source });
        }
        return;
    }
    let map = maps.as_ref().and_then(|maps| maps.get(&light.map)).cloned().unwrap_or_else(missing);
    surroundings.0 = Some(placed(light, map, &view));
}

/// One for all that are missing.
fn missing() -> EnvironmentMap {
    static MISSING: std::sync::OnceLock<EnvironmentMap> = std::sync::OnceLock::new();
    MISSING.get_or_init(EnvironmentMap::missing).clone()
}

/// An environment as it lies around the eye.
fn placed(light: &EnvironmentLight, map: EnvironmentMap, view: &View) -> SurroundingsData {
    let environment_from_world = DMat3::from_cols_array_2d(&light.environment_from_world()).transpose();
    let columns = environment_from_world * view.eye_from_world.matrix3.transpose();
    let rows = columns.transpose().to_cols_array_2d().map(|row| row.map(|number| number as f32));
    let mean = map.harmonics().polynomial().map(|color| color.map(|channel| channel as f32));
    let pixel = f64::from(view.pixel_angle);
    let sky = (light.sky && view.load == Load::Clear).then(|| map.level_of(pixel).max(0.0) as f32);
    SurroundingsData { strength: light.strength, rows, mean, sky, map }
}
