//! Animations of model files (glTF), played on the entities of their parts.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::{DMat4, Mat4};
use bevy_transform::components::Transform;
use halfway_asset::Assets;
use halfway_lighting::rotation_along;
use halfway_mesh::{Animations, Mesh, Mesh3d, Normals};

use crate::import::camera_place;
use crate::placement::Placement;

/// The animation of a model, on the entity of its object.
#[derive(Component, Clone, Debug)]
pub(crate) struct ModelAnimation {
    pub(crate) animations: Arc<Animations>,
    /// The animation that is played.
    pub(crate) clip: usize,
    /// The entity of each part, inside another one, as those of parts that shear.
    pub(crate) parts: Vec<Entity>,
    pub(crate) lines: Vec<Entity>,
    /// The lights, where they are spawned.
    pub(crate) lights: Vec<Entity>,
    /// A camera of the model that is seen from: its entity, its index, and from the model into the world, counted from the
    /// camera's origin.
    pub(crate) camera: Option<(Entity, usize, DMat4)>,
    /// How meshes that move get their normals.
    pub(crate) normals: Normals,
    /// Whether moved vertices are shown; they are not where something else was made of the mesh.
    pub(crate) moves_vertices: bool,
    /// The time that the entities show.
    pub(crate) shown: Option<f64>,
}

/// A sentence on which of several animations is played.
pub(crate) fn which_is_played(animations: &Animations) -> Option<String> {
    let name = |number: usize| match animations.clips()[number].name.as_str() {
        "" => number.to_string(),
        name => format!("{name:?}"),
    };
    let others: Vec<String> = (1..animations.clips().len()).map(name).collect();
    (!others.is_empty()).then(|| format!("the animation {} is played, and not {}", name(0), others.join(", ")))
}

/// Gives the entities of every animated model their places and vertices at a time in seconds.
pub(crate) fn play_models(world: &mut World, time: f64) {
    let mut query = world.query::<(Entity, &mut ModelAnimation)>();
    let mut played = Vec::new();
    for (entity, mut animation) in query.iter_mut(world) {
        if animation.shown != Some(time) {
            animation.shown = Some(time);
            played.push(entity);
        }
    }
    for entity in played {
        let Some(animation) = world.get::<ModelAnimation>(entity).cloned() else { continue };
        show(&animation, time, world);
    }
}

fn show(animation: &ModelAnimation, time: f64, world: &mut World) {
    let pose = animation.animations.pose(animation.clip, time);
    for part in pose.parts {
        let Some(&entity) = animation.parts.get(part.part) else { continue };
        place(entity, &part.world_from_part, world);
        let Some(mesh) = part.mesh.filter(|_| animation.moves_vertices) else { continue };
        let (mesh, _) = mesh.with_normals(animation.normals);
        let Some(handle) = world.get::<Mesh3d>(entity).map(|shown| shown.0.clone()) else { continue };
        if let Some(shown) = world.resource_mut::<Assets<Mesh>>().get_mut(&handle) {
            *shown = mesh;
        }
    }
    for (index, matrix) in pose.lines {
        if let Some(&entity) = animation.lines.get(index) {
            place(entity, &matrix, world);
        }
    }
    for (index, matrix) in pose.lights {
        let Some(&entity) = animation.lights.get(index) else { continue };
        let Some(mut transform) = world.get_mut::<Transform>(entity) else { continue };
        transform.translation = matrix.w_axis.truncate();
        // A light without a direction stays as it was.
        if let Ok(rotation) = rotation_along(matrix.transform_vector3(bevy_math::Vec3::NEG_Z)) {
            transform.rotation = rotation;
        }
    }
    let seen = animation.camera.and_then(|(camera, index, world_from_model)| {
        let (_, matrix) = pose.cameras.iter().find(|(number, _)| *number == index)?;
        Some((camera, camera_place(&(world_from_model * matrix.as_dmat4()).as_mat4())))
    });
    if let Some((camera, transform)) = seen {
        world.entity_mut(camera).insert(transform);
    }
}

/// Places the entity of a part, and the one that it is inside of.
fn place(entity: Entity, matrix: &Mat4, world: &mut World) {
    let Placement { outer, inner } = Placement::from_matrix(&matrix.as_dmat4());
    let around = world.get::<ChildOf>(entity).map(ChildOf::parent);
    let both = [(Some(entity), inner.unwrap_or_default()), (around, outer)];
    for (entity, transform) in both {
        if let Some(mut there) = entity.and_then(|entity| world.get_mut::<Transform>(entity))
            && *there != transform
        {
            *there = transform;
        }
    }
}
