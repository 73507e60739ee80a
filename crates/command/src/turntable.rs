//! A camera that goes round what it sees.

use halfway::prelude::*;

/// The camera goes round the point on its axis that is nearest to the middle of the objects.
#[derive(Resource)]
pub(crate) struct Turntable {
    camera: Entity,
    start: Transform,
    /// In radians a frame, about the upright axis.
    step: f32,
    frame: u32,
    pivot: Option<Vec3>,
}

impl Turntable {
    /// Turns `camera` by `step` radians a frame from the second frame on.
    pub(crate) fn turn(app: &mut App, camera: Entity, step: f32) {
        let start = app.world().get::<Transform>(camera).copied().unwrap_or_default();
        app.insert_resource(Self { camera, start, step, frame: 0, pivot: None }).add_systems(Update, turn);
    }

    /// As objects stand in a scene file, which lets none of them move.
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
    // Before the first frame objects are not in their places yet.
    if table.frame > 0 {
        let pivot = table.pivot.unwrap_or_else(|| table.pivot(objects, &meshes));
        table.pivot = Some(pivot);
        if let Ok(mut transform) = cameras.get_mut(table.camera) {
            *transform = table.start;
            transform.rotate_around(pivot, Quat::from_rotation_y(table.step * table.frame as f32));
        }
    }
    table.frame += 1;
}
