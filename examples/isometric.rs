//! An isometric view of a town of equal blocks around a teapot: an orthographic camera shows all of them equally large,
//! near and far, and parallel edges stay parallel.
//!
//! ```text
//! cargo run --release --example isometric
//! cargo run --release --example isometric -- --headless isometric.png
//! ```

use halfway::prelude::*;

fn main() -> AppExit {
    App::new().add_plugins(HalfwayPlugins::from_args()).add_systems(Startup, scene).run()
}

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
    let block = meshes.add(Cuboid { size: Vec3::new(1.0, 1.6, 1.0) });
    for x in -2_i8..=2 {
        for z in -2_i8..=2 {
            if x.abs() < 2 && z.abs() < 2 {
                continue;
            }
            let at = Vec3::new(2.0 * f32::from(x), 0.8, 2.0 * f32::from(z));
            let color =
                if (x + z) % 2 == 0 { LinearRgba::rgb(0.5, 0.35, 0.2) } else { LinearRgba::rgb(0.25, 0.35, 0.5) };
            commands.spawn((Mesh3d(block.clone()), Material::matte(color), Transform::from_translation(at)));
        }
    }
    let teapot = meshes.add(Teapot::new(10));
    commands.spawn((Mesh3d(teapot), Material::BRASS, Transform::from_scale(Vec3::splat(1.2))));
    let ground = meshes.add(Plane { size: 11.0, divisions: 1 });
    commands.spawn((Mesh3d(ground), Material::matte(LinearRgba::rgb(0.3, 0.4, 0.25))));
    commands.spawn((DirectionalLight::white(), Transform::from_xyz(1.0, 3.0, 2.0).looking_at(Vec3::ZERO, Vec3::Y)));
    let camera = Camera { samples: Samples::Four, background: LinearRgba::WHITE * 0.02, ..Camera::orthographic(1.0) };
    // Along the diagonal of a cube: the three axes are equally long on the picture.
    commands.spawn(camera.framing((Vec3::ZERO, 5.2), Vec3::new(-1.0, -1.0, -1.0)));
}
