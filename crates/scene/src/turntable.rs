//! A camera that orbits the scene.

use bevy_app::{App, Update};
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::components::{GlobalTransform, Transform};
use halfway_asset::Assets;
use halfway_lighting::Camera;
use halfway_mesh::{Mesh, Mesh3d};

use crate::animation::AnimationSystems;

/// A camera that orbits the point on its axis that is nearest to the middle of the objects.
///
/// ```
/// use bevy_app::App;
/// use bevy_math::Vec3;
/// use bevy_transform::components::Transform;
/// use halfway_lighting::Camera;
/// use halfway_scene::Turntable;
///
/// let mut app = App::new();
/// app.add_plugins(halfway_mesh::MeshPlugin);
/// let camera = app.world_mut().spawn((Camera::default(), Transform::from_xyz(0.0, 0.0, 4.0))).id();
/// // Once around in 36 frames.
/// Turntable::turn(&mut app, camera, Vec3::Y, std::f32::consts::TAU / 36.0);
/// ```
#[derive(Resource, Debug)]
pub struct Turntable {
    camera: Entity,
    start: Transform,
    /// In radians a frame, about `up`.
    step: f32,
    up: Vec3,
    frame: u32,
    pivot: Option<Vec3>,
}

impl Turntable {
    /// Turns `camera` about `up`, of unit length, by `step` radians a frame from the second frame on.
    pub fn turn(app: &mut App, camera: Entity, up: Vec3, step: f32) {
        let start = app.world().get::<Transform>(camera).copied().unwrap_or_default();
        app.insert_resource(Self { camera, start, step, up, frame: 0, pivot: None })
            .add_systems(Update, turn.after(AnimationSystems));
    }

    /// The pivot. Objects of scene files do not move.
    fn pivot(&self, objects: Query<(&Mesh3d, &GlobalTransform)>, meshes: &Assets<Mesh>) -> Vec3 {
        let centers: Vec<Vec3> = objects
            .iter()
            .filter_map(|(mesh, transform)| Some(transform.transform_point(meshes.get(&mesh.0)?.bounds().center())))
            .collect();
        let middle = centers.iter().sum::<Vec3>() / centers.len().max(1) as f32;
        let along = (middle - self.start.translation).dot(*self.start.forward()).max(0.0);
        self.start.translation + self.start.forward() * along
    }
}

fn turn(
    mut table: ResMut<Turntable>,
    mut cameras: Query<&mut Transform, With<Camera>>,
    objects: Query<(&Mesh3d, &GlobalTransform)>,
    meshes: Res<Assets<Mesh>>,
) {
    // Before the first frame transforms are not propagated yet.
    if table.frame > 0 {
        let pivot = table.pivot.unwrap_or_else(|| table.pivot(objects, &meshes));
        table.pivot = Some(pivot);
        if let Ok(mut transform) = cameras.get_mut(table.camera) {
            *transform = table.start;
            transform.rotate_around(pivot, Quat::from_axis_angle(table.up, table.step * table.frame as f32));
        }
    }
    table.frame += 1;
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_transform::TransformPlugin;
    use halfway_mesh::{Cuboid, MeshPlugin};

    #[test]
    fn the_camera_goes_round_the_middle_by_its_step_a_frame() {
        let mut app = App::new();
        app.add_plugins((MeshPlugin, TransformPlugin));
        let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(Cuboid::default());
        // Their middle is 4 before the camera and 1 beside its axis.
        for at in [Vec3::new(-1.0, 2.0, -3.0), Vec3::new(3.0, 2.0, 1.0)] {
            app.world_mut().spawn((Mesh3d(mesh.clone()), Transform::from_translation(at)));
        }
        let camera = app.world_mut().spawn((Camera::default(), Transform::from_xyz(0.0, 2.0, 3.0))).id();
        Turntable::turn(&mut app, camera, Vec3::Y, 1.0_f32.to_radians());
        app.finish();
        app.cleanup();
        for frame in 0..=90_u16 {
            app.update();
            let (sin, cos) = f32::from(frame).to_radians().sin_cos();
            let at = app.world().get::<Transform>(camera).expect("the camera stays");
            let expected = Vec3::new(4.0 * sin, 2.0, 4.0 * cos - 1.0);
            assert!((at.translation - expected).length() < 1e-4, "frame {frame}: {at:?}");
            assert!((*at.forward() - Vec3::new(-sin, 0.0, -cos)).length() < 1e-4, "frame {frame}: {at:?}");
        }
    }
}
