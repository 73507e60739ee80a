//! Entities far from the origin of the world.

use bevy_ecs::prelude::*;
use bevy_transform::components::{GlobalTransform, Transform};
use glam::{Affine3A, DAffine3, DQuat, DVec3};

use crate::Cameras;

/// Moves an entity, and all below it, by a vector in f64: above its [`Transform`], in the frame of its parent.
///
/// `f32` has 24 bits: at map coordinates of 5 · 10⁶ it counts in steps of 0.5. Give the camera, and what it sees, the
/// same origin near them, and keep their `Transform`s small. While any entity has an origin other than 0, every
/// [`GlobalTransform`] is composed in f64 from the `Transform`s and origins above it, and counted from the camera's own
/// origin ([`FrameOrigin`]), so that what is near the camera has small numbers. Where several cameras share the picture,
/// from that of the first.
///
/// ```
/// use bevy_app::App;
/// use bevy_transform::components::{GlobalTransform, Transform};
/// use bevy_transform::TransformPlugin;
/// use glam::{DVec3, Vec3};
/// use halfway_lighting::{Camera, Origin};
/// # use bevy_app::PostUpdate;
/// # use bevy_ecs::prelude::*;
/// # use bevy_transform::TransformSystems;
/// # use halfway_lighting::{CameraTurn, FrameOrigin, place_by_origins};
///
/// let mut app = App::new();
/// app.add_plugins(TransformPlugin);
/// # app.init_resource::<FrameOrigin>().init_resource::<CameraTurn>();
/// # app.add_systems(PostUpdate, place_by_origins.after(TransformSystems::Propagate));
/// let town = Origin(DVec3::new(400_000.0, 5_000_000.0, 0.0));
/// app.world_mut().spawn((Camera::default(), town, Transform::from_xyz(0.0, 0.0, 10.0)));
/// let house = app.world_mut().spawn((town, Transform::from_xyz(0.25, 0.0, 0.0))).id();
/// app.update();
/// assert_eq!(app.world().get::<GlobalTransform>(house).unwrap().translation(), Vec3::new(0.25, 0.0, 0.0));
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
#[require(Transform)]
pub struct Origin(pub DVec3);

/// The point of the world from which every [`GlobalTransform`] is counted since [`place_by_origins`] ran last: the origin
/// of the camera and those above it. 0 where nothing has an [`Origin`].
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameOrigin(pub DVec3);

/// The place of an entity in the world: the product of the `Transform`s and [`Origin`]s of the entity and those above it.
/// One without a `Transform` counts as if it were at its parent.
///
/// ```
/// use bevy_ecs::hierarchy::ChildOf;
/// use bevy_ecs::world::World;
/// use bevy_transform::components::Transform;
/// use glam::DVec3;
/// use halfway_lighting::{Origin, world_place};
///
/// let mut world = World::new();
/// let town = world.spawn(Origin(DVec3::new(4e5, 5e6, 0.0))).id();
/// let lamp = world.spawn((Transform::from_xyz(0.125, 0.0, 2.0), ChildOf(town))).id();
/// assert_eq!(world_place(lamp, &world).translation, DVec3::new(400_000.125, 5e6, 2.0));
/// ```
pub fn world_place(entity: Entity, world: &World) -> DAffine3 {
    let mut place = DAffine3::IDENTITY;
    let parent = |entity: &Entity| world.get::<ChildOf>(*entity).map(ChildOf::parent);
    // A hierarchy that runs in a circle comes to an end.
    for entity in core::iter::successors(Some(entity), parent).take(10_000) {
        if let Some(transform) = world.get::<Transform>(entity) {
            place = local(transform, world.get::<Origin>(entity)) * place;
        }
    }
    place
}

/// The place of an entity in the frame of its parent.
fn local(transform: &Transform, origin: Option<&Origin>) -> DAffine3 {
    let Transform { translation, rotation, scale } = *transform;
    let moved = origin.map_or(DVec3::ZERO, |origin| origin.0) + translation.as_dvec3();
    let (x, y, z, w) = rotation.into();
    let rotation = DQuat::from_xyzw(x.into(), y.into(), z.into(), w.into());
    DAffine3::from_scale_rotation_translation(scale.as_dvec3(), rotation.normalize(), moved)
}

type Places<'w, 's> = Query<'w, 's, (&'static Transform, Option<&'static Origin>, &'static mut GlobalTransform)>;

/// Writes every [`GlobalTransform`] anew, in f64 and counted from [`FrameOrigin`], while an entity has an [`Origin`]
/// other than 0. A frame of halfway runs it before it reads the camera, after transforms are propagated.
pub fn place_by_origins(
    origins: Query<&Origin>,
    cameras: Cameras,
    (parents, children): (Query<&ChildOf>, Query<&Children>),
    roots: Query<Entity, (With<Transform>, Without<ChildOf>)>,
    mut places: Places,
    mut frame: ResMut<FrameOrigin>,
    mut was_needed: Local<bool>,
) {
    let is_needed = origins.iter().any(|origin| origin.0 != DVec3::ZERO);
    // Once more after the last one has gone.
    if !std::mem::replace(&mut *was_needed, is_needed) && !is_needed {
        return;
    }
    let camera = cameras.current().ok();
    let origin = camera.map_or(DVec3::ZERO, |camera| origin_above(camera, &parents, &places));
    frame.set_if_neq(FrameOrigin(origin));
    let mut below: Vec<(Entity, DAffine3)> = roots.iter().map(|root| (root, DAffine3::IDENTITY)).collect();
    while let Some((entity, parent)) = below.pop() {
        let Ok((transform, own, mut global)) = places.get_mut(entity) else { continue };
        let place = parent * local(transform, own);
        let translation = (place.translation - origin).as_vec3();
        let counted = Affine3A::from_mat3_translation(place.matrix3.as_mat3(), translation);
        global.set_if_neq(GlobalTransform::from(counted));
        below.extend(children.get(entity).into_iter().flatten().map(|&child| (child, place)));
    }
}

/// The origin of an entity and those above it, each turned and scaled by what is above.
fn origin_above(entity: Entity, parents: &Query<&ChildOf>, places: &Places) -> DVec3 {
    let mut chain: Vec<Entity> = parents.iter_ancestors(entity).take(10_000).collect();
    chain.reverse();
    chain.push(entity);
    let (mut origin, mut place) = (DVec3::ZERO, DAffine3::IDENTITY);
    for (transform, own, _) in chain.into_iter().filter_map(|entity| places.get(entity).ok()) {
        origin += place.transform_vector3(own.map_or(DVec3::ZERO, |own| own.0));
        place *= local(transform, own);
    }
    origin
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, CameraTurn};
    use bevy_app::{App, PostUpdate};
    use bevy_transform::{TransformPlugin, TransformSystems};
    use glam::{Quat, Vec3};
    use std::f32::consts::FRAC_PI_2;

    fn app() -> App {
        let mut app = App::new();
        app.add_plugins(TransformPlugin)
            .init_resource::<FrameOrigin>()
            .init_resource::<CameraTurn>()
            .add_systems(PostUpdate, place_by_origins.after(TransformSystems::Propagate));
        app
    }

    fn seen(app: &App, entity: Entity) -> Vec3 {
        app.world().get::<GlobalTransform>(entity).unwrap().translation()
    }

    const FAR: DVec3 = DVec3::new(400_000.0, 5_000_000.0, 1e9);

    #[test]
    fn a_hierarchy_far_away_is_where_it_would_be_at_the_origin() {
        let turned = Transform::from_rotation(Quat::from_rotation_z(FRAC_PI_2)).with_scale(Vec3::splat(2.0));
        let spawn = |world: &mut World, origin: DVec3| {
            let root = world.spawn((Origin(origin), Transform::from_xyz(0.1, 0.2, 0.3))).id();
            let middle = world.spawn((turned, ChildOf(root))).id();
            world.spawn((Transform::from_xyz(0.7, 0.0, 0.0), ChildOf(middle))).id()
        };
        let mut app = app();
        let camera = app.world_mut().spawn((Camera::default(), Origin(FAR))).id();
        let (far, near) = (spawn(app.world_mut(), FAR), spawn(app.world_mut(), DVec3::ZERO));
        for _ in 0..2 {
            app.update();
            assert!(seen(&app, far).distance(Vec3::new(0.1, 1.6, 0.3)) < 1e-6, "{}", seen(&app, far));
            assert_eq!(seen(&app, near), (DVec3::new(0.1, 1.6, 0.3) - FAR).as_vec3());
            assert_eq!(app.world().resource::<FrameOrigin>().0, FAR);
        }
        // Without origins all is as bevy has it.
        app.world_mut().entity_mut(camera).remove::<Origin>();
        let root = app.world().get::<ChildOf>(app.world().get::<ChildOf>(far).unwrap().parent()).unwrap().parent();
        app.world_mut().entity_mut(root).insert(Origin(DVec3::ZERO));
        app.update();
        assert_eq!(seen(&app, far), seen(&app, near));
        assert_eq!(app.world().resource::<FrameOrigin>().0, DVec3::ZERO);
    }

    #[test]
    fn origins_below_others_are_turned_and_scaled() {
        let mut app = app();
        let turned = Transform::from_rotation(Quat::from_rotation_z(FRAC_PI_2)).with_scale(Vec3::splat(2.0));
        let root = app.world_mut().spawn((turned, Origin(DVec3::Z))).id();
        let child = app.world_mut().spawn((Origin(DVec3::X * 1e6), ChildOf(root))).id();
        let camera = app.world_mut().spawn((Camera::default(), ChildOf(child))).id();
        app.update();
        let origin = app.world().resource::<FrameOrigin>().0;
        assert!(origin.distance(DVec3::new(0.0, 2e6, 1.0)) < 1e-1, "{origin}");
        assert!(seen(&app, camera).length() < 1e-6);
        assert!(world_place(camera, app.world()).translation.distance(origin) < 1e-6);
    }
}
