//! Twenty-four teapots that differ only in their material: one row each of gems, metals, plastics and rubbers. They
//! share one mesh, which is uploaded once.
//!
//! ```text
//! cargo run --release --example teapots
//! cargo run --release --example teapots -- --headless teapots.png
//! ```

use std::f32::consts::PI;

use halfway::prelude::*;

const COLUMNS: usize = 6;
const SPACING: Vec2 = Vec2::new(4.0, 3.35);

fn main() -> AppExit {
    App::new()
        .add_plugins(HalfwayPlugins::from_args())
        .insert_resource(GlobalAmbient(LinearRgba::WHITE * 0.6))
        .add_systems(Startup, scene)
        .add_systems(Last, count)
        .run()
}

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
    let teapot = meshes.add(Teapot::new(12));
    let rows = Material::PRESETS.len().div_ceil(COLUMNS);
    let last = Vec2::new(COLUMNS as f32 - 1.0, rows as f32 - 1.0);
    for (i, &(name, material)) in Material::PRESETS.iter().enumerate() {
        let cell = Vec2::new((i % COLUMNS) as f32, (i / COLUMNS) as f32) - last / 2.0;
        commands.spawn((
            Name::new(name),
            Mesh3d(teapot.clone()),
            material,
            Transform::from_xyz(cell.x * SPACING.x, -cell.y * SPACING.y, 0.0)
                .with_rotation(Quat::from_rotation_x(0.35) * Quat::from_rotation_y(PI / 4.5)),
        ));
    }
    for (brightness, from) in [(1.0, Vec3::new(-2.0, 1.5, 3.0)), (0.3, Vec3::new(3.0, 1.0, 0.5))] {
        let light = DirectionalLight::new(LinearRgba::WHITE * brightness);
        commands.spawn((light, Transform::from_translation(from).looking_at(Vec3::ZERO, Vec3::Y)));
    }
    commands.spawn((
        Camera {
            // From far away, so that every teapot shows the same side.
            background: LinearRgba::rgb(0.28, 0.3, 0.34),
            samples: Samples::Four,
            // The figures were chosen for screens that show intensities as they are.
            encoding: Encoding::Raw,
            ..Camera::perspective(0.185)
        },
        Transform::from_xyz(0.0, 0.0, 75.0),
    ));
}

/// Prints the counters of the first frame: as many draws as materials, but one uploaded mesh.
fn count(report: Res<FrameReport>, mut said: Local<bool>) {
    if !*said {
        let FrameReport { objects, materials, draws, triangles, bytes_uploaded, .. } = *report;
        println!("{objects} teapots of {materials} materials: {triangles} triangles, {draws} draws");
        println!("{bytes_uploaded} bytes sent to the GPU");
        *said = true;
    }
}
