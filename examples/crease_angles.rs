//! Crease angles: from left to right normals are split at edges where faces differ by more than 10, 40 and 180 degrees;
//! above a lathed object of twenty sides, below a coarse teapot. See docs/normals.md.
//!
//! ```text
//! cargo run --release --example crease_angles
//! cargo run --release --example crease_angles -- --headless crease_angles.png --size 960x540
//! ```

use std::f32::consts::TAU;

use halfway::mesh::{NormalWeighting, Normals};
use halfway::prelude::*;

fn main() -> AppExit {
    App::new().add_plugins(HalfwayPlugins::from_args()).add_systems(Startup, scene).run()
}

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
    let material = Material {
        specular: LinearRgba::WHITE * 0.7,
        shininess: 50.0,
        ..Material::plastic(LinearRgba::rgb(0.25, 0.13, 0.03))
    };
    let turned = Quat::from_rotation_x(0.5) * Quat::from_rotation_y(0.6);
    for (mesh, y, scale) in [(turned_piece(), 1.5, 1.0), (Teapot::new(3).into(), -1.6, 0.95)] {
        for (degrees, x) in [(10.0_f32, -3.85), (40.0, 0.0), (180.0, 3.85)] {
            let creased = Normals::Creased { angle: degrees.to_radians(), weighting: NormalWeighting::default() };
            let (mesh, _) = mesh.clone().with_normals(creased);
            let place = Transform::from_xyz(x, y, 0.0).with_rotation(turned).with_scale(Vec3::splat(scale));
            commands.spawn((Mesh3d(meshes.add(mesh)), material, place));
        }
    }
    for (brightness, from) in [(0.9, Vec3::new(-2.0, 2.2, 3.0)), (0.5, Vec3::new(3.0, 1.0, 2.0))] {
        let light = DirectionalLight::new(LinearRgba::WHITE * brightness);
        commands.spawn((light, Transform::from_translation(from).looking_at(Vec3::ZERO, Vec3::Y)));
    }
    commands.spawn((
        Camera { samples: Samples::Four, background: LinearRgba::WHITE * 0.02, ..Camera::perspective(0.165) },
        Transform::from_xyz(0.0, 0.0, 40.0),
    ));
}

/// A step and a cone, turned about the vertical axis.
fn turned_piece() -> Mesh {
    const SIDES: usize = 20;
    // Radius and height, from below.
    const PROFILE: [[f32; 2]; 7] =
        [[0.0, -1.0], [1.4, -1.0], [1.4, -0.45], [0.95, -0.45], [0.95, 0.35], [0.45, 0.9], [0.0, 0.9]];
    let point = |i: usize, side: usize| {
        let [radius, height] = PROFILE[i];
        let (sin, cos) = (TAU * (side % SIDES) as f32 / SIDES as f32).sin_cos();
        Vec3::new(radius * cos, height, -radius * sin)
    };
    let mut positions = Vec::new();
    for side in 0..SIDES {
        for i in 1..PROFILE.len() {
            let [a, b, c, d] = [point(i - 1, side), point(i - 1, side + 1), point(i, side + 1), point(i, side)];
            // On the axis one side of the quadrilateral is a point.
            positions
                .extend([[a, b, c], [a, c, d]].into_iter().filter(|[a, b, c]| a != b && b != c && c != a).flatten());
        }
    }
    let indices = (0..positions.len() as u32).collect();
    Mesh::new(positions, indices).expect("three finite corners a triangle")
}
