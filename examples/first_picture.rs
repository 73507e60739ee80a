//! The README's first program: a brass teapot under one light.
//!
//! ```text
//! cargo run --release --example first_picture
//! cargo run --release --example first_picture -- --headless teapot.png --size 640x480
//! ```

use halfway::prelude::*;

fn main() -> AppExit {
    App::new().add_plugins(HalfwayPlugins::from_args()).add_systems(Startup, scene).run()
}

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
    commands.spawn((Camera::default(), Transform::from_xyz(0.0, 2.0, 6.0).looking_at(Vec3::ZERO, Vec3::Y)));
    commands.spawn((Mesh3d(meshes.add(Teapot::new(8))), Material::BRASS, Shading::Phong));
    commands.spawn((PointLight::white(), Transform::from_xyz(2.0, 3.0, 2.0)));
}
