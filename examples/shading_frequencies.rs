//! The frequency of the lighting equation: a coarse teapot above, a fine one below; from left to right flat (once a
//! triangle), Gouraud (once a vertex) and Phong shading (once a fragment). The keys 1, 2 and 3 give all teapots the
//! same shading.
//!
//! ```text
//! cargo run --release --example shading_frequencies
//! cargo run --release --example shading_frequencies -- --headless shading_frequencies.png
//! ```

use halfway::prelude::*;

fn main() -> AppExit {
    App::new().add_plugins(HalfwayPlugins::from_args()).add_systems(Startup, scene).run()
}

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
    let material = Material {
        specular: LinearRgba::WHITE * 0.9,
        shininess: 90.0,
        ..Material::plastic(LinearRgba::rgb(0.28, 0.015, 0.02))
    };
    for (divisions, y) in [(2, 1.6), (16, -1.55)] {
        let teapot = meshes.add(Teapot::new(divisions));
        for (shading, x) in [(Shading::Flat, -3.85), (Shading::Gouraud, 0.1), (Shading::Phong, 4.05)] {
            commands.spawn((
                Mesh3d(teapot.clone()),
                material,
                shading,
                Transform::from_xyz(x, y, 0.0).with_rotation(Quat::from_rotation_x(0.3) * Quat::from_rotation_y(0.7)),
            ));
        }
    }
    for (brightness, from) in [(0.9, Vec3::new(-2.0, 1.2, 3.0)), (0.5, Vec3::new(3.0, 2.0, 1.0))] {
        let light = DirectionalLight::new(LinearRgba::WHITE * brightness);
        commands.spawn((light, Transform::from_translation(from).looking_at(Vec3::ZERO, Vec3::Y)));
    }
    commands.spawn((
        Camera { samples: Samples::Four, background: LinearRgba::WHITE * 0.02, ..Camera::perspective(0.195) },
        Transform::from_xyz(0.0, 0.0, 36.0),
    ));
}
