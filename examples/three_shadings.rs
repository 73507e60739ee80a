//! One teapot three times: flat shading (once a triangle), Gouraud shading (once a vertex) and Phong shading (once a
//! pixel).
//!
//! ```text
//! cargo run --release --example three_shadings
//! cargo run --release --example three_shadings -- --headless three_shadings.png --size 960x320
//! ```

use halfway::prelude::*;

fn main() -> AppExit {
    App::new().add_plugins(HalfwayPlugins::from_args()).add_systems(Startup, scene).run()
}

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
    let material = Material {
        specular: LinearRgba::WHITE * 0.9,
        shininess: 60.0,
        ..Material::plastic(LinearRgba::rgb(0.28, 0.015, 0.02))
    };
    let teapot = meshes.add(Teapot::new(3));
    for (shading, x) in [(Shading::Flat, -3.9), (Shading::Gouraud, 0.0), (Shading::Phong, 3.9)] {
        let transform =
            Transform::from_xyz(x, 0.15, 0.0).with_rotation(Quat::from_rotation_x(0.3) * Quat::from_rotation_y(0.7));
        commands.spawn((Mesh3d(teapot.clone()), material, shading, transform));
    }
    for (brightness, from) in [(1.0, Vec3::new(-2.0, 1.6, 3.0)), (0.4, Vec3::new(3.0, 2.0, 1.0))] {
        let light = DirectionalLight::new(LinearRgba::WHITE * brightness);
        commands.spawn((light, Transform::from_translation(from).looking_at(Vec3::ZERO, Vec3::Y)));
    }
    commands.spawn((
        Camera { samples: Samples::Four, background: LinearRgba::WHITE * 0.02, ..Camera::perspective(0.115) },
        Transform::from_xyz(0.0, 0.0, 36.0),
    ));
}
