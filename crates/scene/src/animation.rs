//! Animations of scene files and of their models, played: [`AnimationPlugin`] gives the entities of a scene that was
//! [spawned](fn@crate::spawn) the values of their keys at the [`SceneTime`] of each frame, and the parts of models (glTF)
//! their places and vertices.

use std::sync::Arc;

use bevy_app::{App, Plugin, Update};
use bevy_ecs::prelude::*;
use bevy_math::DVec3;
use bevy_time::Time;
use bevy_transform::components::Transform;
use halfway_lighting::{Camera, Origin};

use crate::light::LightEntry;
use crate::light_place::place;
use crate::model_animation::play_models;
use crate::part_of_light::insert_light;
use crate::track::{Animate, TrackEntry};
use crate::transform::TransformEntry;
use crate::view::CameraEntry;

/// The time of the animations of scenes and models.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub enum SceneTime {
    /// The time since the App's start, by bevy's `Time`.
    #[default]
    Clock,
    /// This many seconds.
    At(f64),
}

/// The set in `Update` in which animated entities are given their values.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub struct AnimationSystems;

/// Plays the animations of spawned scenes and models at the App's [`SceneTime`]. Part of `HalfwayPlugins`.
#[derive(Clone, Copy, Debug, Default)]
pub struct AnimationPlugin;

impl Plugin for AnimationPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<SceneTime>().add_systems(Update, play.in_set(AnimationSystems));
    }
}

/// The animated keys of an entity, with those of its entry that stay.
#[derive(Component, Clone, Debug, PartialEq)]
pub(crate) enum Animated {
    Object(Arc<(TransformEntry, Vec<TrackEntry>)>),
    Light(Arc<(LightEntry, Vec<TrackEntry>)>),
    Camera(Arc<(CameraEntry, Vec<TrackEntry>)>),
}

impl Animated {
    /// `None` where nothing changes.
    pub(crate) fn object(transform: &TransformEntry, tracks: &[TrackEntry]) -> Option<Self> {
        (!tracks.is_empty()).then(|| Self::Object(Arc::new((*transform, tracks.to_vec()))))
    }

    /// `None` where nothing changes.
    pub(crate) fn light(light: &LightEntry) -> Option<Self> {
        let still = LightEntry { animation: Vec::new(), ..light.clone() };
        (!light.animation.is_empty()).then(|| Self::Light(Arc::new((still, light.animation.clone()))))
    }

    /// `None` where nothing changes.
    pub(crate) fn camera(camera: &CameraEntry) -> Option<Self> {
        let still = CameraEntry { animation: Vec::new(), ..camera.clone() };
        (!camera.animation.is_empty()).then(|| Self::Camera(Arc::new((still, camera.animation.clone()))))
    }
}

/// Gives every animated entity its values at the scene's time.
fn play(world: &mut World) {
    let mut query = world.query::<(Entity, &Animated)>();
    let animated: Vec<(Entity, Animated)> = query.iter(world).map(|(entity, it)| (entity, it.clone())).collect();
    let time = match world.get_resource::<SceneTime>() {
        Some(SceneTime::At(time)) => *time,
        Some(SceneTime::Clock) | None => world.get_resource::<Time>().map_or(0.0, Time::elapsed_secs_f64),
    };
    for (entity, animated) in animated {
        pose(&mut world.entity_mut(entity), &animated, time);
    }
    play_models(world, time);
}

fn pose(entity: &mut EntityWorldMut, animated: &Animated, time: f64) {
    let origin = entity.get::<Origin>().map_or(DVec3::ZERO, |origin| origin.0);
    let transform = match animated {
        Animated::Object(object) => object.0.at(&object.1, time).parts(origin),
        Animated::Light(light) => {
            let (component, transform) = place(&light.0.at(&light.1, time), origin);
            insert_light(component, entity);
            Some(transform)
        }
        Animated::Camera(camera) => {
            let camera = camera.0.at(&camera.1, time);
            if let Some(mut there) = entity.get_mut::<Camera>() {
                let projection = camera.projection();
                if there.projection != projection {
                    there.projection = projection;
                }
            }
            // At a moment without a direction it stays as it was.
            camera.axes().map(|_| camera.transform(origin))
        }
    };
    // Transforms that stay are not touched, so that nothing after them has to be done again.
    if let (Some(transform), Some(mut there)) = (transform, entity.get_mut::<Transform>())
        && *there != transform
    {
        *there = transform;
    }
}
