//! Animations of model files (glTF), played on the entities of their parts.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::{DMat4, Mat4};
use bevy_transform::components::Transform;
use halfway_asset::Assets;
use halfway_lighting::rotation_along;
use halfway_mesh::{Animations, Mesh, Mesh3d, Normals};

use crate::error::SceneError;
use crate::import::camera_place;
use crate::named::NameOrIndex;
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

/// The animations of the models of a scene that are played: of each model the one that is wanted, else its first.
#[derive(Default)]
pub(crate) struct Chosen<'a> {
    wanted: Option<&'a NameOrIndex>,
    is_found: bool,
    /// The animations of each file, as a clause.
    known: Vec<String>,
}

impl<'a> Chosen<'a> {
    pub(crate) fn new(wanted: Option<&'a NameOrIndex>) -> Self {
        Self { wanted, ..Self::default() }
    }

    /// The number of the animation of a model that is played, and a sentence where that has to be said.
    pub(crate) fn clip(&mut self, animations: &Animations, file: &str) -> (usize, Option<String>) {
        let names: Vec<&str> = animations.clips().iter().map(|clip| clip.name.as_str()).collect();
        let name =
            |number: usize| if names[number].is_empty() { number.to_string() } else { format!("{:?}", names[number]) };
        let Some(wanted) = self.wanted else {
            let others: Vec<String> = (1..names.len()).map(name).collect();
            let said = format!("{file}: the animation {} is played, and not {}", name(0), others.join(", "));
            return (0, (!others.is_empty()).then_some(said));
        };
        let found = wanted.find_by_text(names.iter().map(|name| Some(*name)));
        self.is_found |= found.is_some();
        self.known.push(format!("{file} has {}", listed(&names)));
        let said = format!("{file}: has no animation {wanted}; {} is played", name(0));
        (found.unwrap_or(0), found.is_none().then_some(said))
    }

    /// # Errors
    /// The wanted animation is one of no model.
    pub(crate) fn check(&self) -> Result<(), SceneError> {
        let Some(wanted) = self.wanted.filter(|_| !self.is_found) else { return Ok(()) };
        let known = if self.known.is_empty() { "the models have none".to_owned() } else { self.known.join("; ") };
        Err(SceneError::Value { key: "animation".to_owned(), message: format!("is {wanted}; {known}") })
    }
}

/// Names with their numbers.
fn listed(names: &[&str]) -> String {
    let each = names.iter().enumerate();
    let each = each.map(|(i, name)| if name.is_empty() { i.to_string() } else { format!("{i} {name:?}") });
    each.collect::<Vec<_>>().join(", ")
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
