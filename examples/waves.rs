//! A sheet of 100 × 100 vertices in the wind: new positions and normals each frame.
//!
//! ```text
//! cargo run --release --example waves
//! cargo run --release --example waves -- --headless waves.png
//! ```

use std::f32::consts::TAU;

use halfway::prelude::*;

/// Vertices a side.
const SIDE: u16 = 100;

fn main() -> AppExit {
    App::new().add_plugins(HalfwayPlugins::from_args()).add_systems(Startup, scene).add_systems(Update, wave).run()
}

/// The sheet's asset.
#[derive(Resource)]
struct Sheet(Handle<Mesh>);

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
    commands.spawn((
        Camera::perspective(0.6),
        Transform::from_xyz(4.5, 4.0, 6.5).looking_at(Vec3::new(0.0, -0.3, 0.0), Vec3::Y),
    ));
    commands.spawn((PointLight::white(), Transform::from_xyz(-2.0, 4.0, -1.0)));
    commands.spawn((
        DirectionalLight::new(LinearRgba::rgb(0.3, 0.35, 0.5)),
        Transform::from_xyz(3.0, 2.0, 4.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    let sheet = meshes.add(Plane { size: 5.0, divisions: u32::from(SIDE) - 1 });
    commands.spawn((Mesh3d(sheet.clone()), Material::plastic(LinearRgba::rgb(0.6, 0.1, 0.08)), Shading::Phong));
    commands.insert_resource(Sheet(sheet));
}

/// Two waves cross the sheet; their slopes give the normals.
fn wave(sheet: Res<Sheet>, time: Res<Time>, mut meshes: ResMut<Assets<Mesh>>) -> Result {
    let waves = [(0.25, Vec2::new(2.2, 0.9), 0.4), (0.08, Vec2::new(-1.3, 4.1), 0.9)];
    let Some(mesh) = meshes.get_mut(&sheet.0) else { return Ok(()) };
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    for &Vec3 { x, z, .. } in mesh.positions() {
        let (mut height, mut slope) = (0.0, Vec2::ZERO);
        for (amplitude, along, frequency) in waves {
            let phase = along.dot(Vec2::new(x, z)) - TAU * frequency * time.elapsed_secs();
            height += amplitude * phase.sin();
            slope += amplitude * phase.cos() * along;
        }
        positions.push(Vec3::new(x, height, z));
        normals.push(Vec3::new(-slope.x, 1.0, -slope.y));
    }
    mesh.set_positions(positions)?;
    mesh.set_normals(normals)?;
    Ok(())
}
