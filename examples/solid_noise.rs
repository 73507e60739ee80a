//! Solid textures on cut objects: a block of wood without a corner, a ball of marble without an eighth, a ball of
//! noise; on a checkered floor to the horizon, where detail finer than a pixel fades to its mean.
//!
//! ```text
//! cargo run --release --example solid_noise
//! cargo run --release --example solid_noise -- --headless solid_noise.png
//! ```

use halfway::mesh::MeshError;
use halfway::prelude::*;

fn main() -> AppExit {
    App::new().add_plugins(HalfwayPlugins::from_args()).add_systems(Startup, scene).run()
}

/// Triangles in the making, with a normal a vertex.
#[derive(Default)]
struct Carving {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    indices: Vec<u32>,
}

impl Carving {
    /// A flat fan around its first point.
    fn fan(&mut self, points: &[Vec3], normal: Vec3) {
        let first = self.positions.len() as u32;
        self.positions.extend(points);
        self.normals.extend(points.iter().map(|_| normal));
        for k in 2..points.len() as u32 {
            let [a, b] = [points[1], points[2]].map(|point| point - points[0]);
            let turned = if a.cross(b).dot(normal) > 0.0 { [k - 1, k] } else { [k, k - 1] };
            self.indices.extend([first, first + turned[0], first + turned[1]]);
        }
    }

    fn mesh(self) -> Result<Mesh, MeshError> {
        Mesh::from_parts(self.positions, Some(self.normals), None, self.indices)
    }
}

const AXES: [Vec3; 3] = [Vec3::X, Vec3::Y, Vec3::Z];

/// A cube of edge 2 without the corner toward (1, 1, 1).
fn block() -> Result<Mesh, MeshError> {
    let mut carving = Carving::default();
    for axis in 0..3 {
        let [n, u, v] = [AXES[axis], AXES[(axis + 1) % 3], AXES[(axis + 2) % 3]];
        let mut quarter = |depth: f32, [s, t]: [f32; 2], normal: Vec3| {
            let at = |s: f32, t: f32| n * depth + u * s + v * t;
            carving.fan(&[at(s, t), at(s + 1.0, t), at(s + 1.0, t + 1.0), at(s, t + 1.0)], normal);
        };
        for corner in [[-1.0, -1.0], [0.0, -1.0], [-1.0, 0.0]] {
            quarter(1.0, corner, n);
            quarter(-1.0, corner, -n);
        }
        quarter(-1.0, [0.0; 2], -n);
        // Where the corner was.
        quarter(0.0, [0.0; 2], n);
    }
    carving.mesh()
}

/// A ball of radius 1 without the eighth toward (1, 1, 1).
fn ball() -> Result<Mesh, MeshError> {
    const STEPS: u32 = 128;
    let whole = Mesh::from(UvSphere::new(1.0, STEPS, STEPS / 2));
    let mut carving = Carving::default();
    carving.positions.extend(whole.positions());
    carving.normals.extend(whole.normals());
    for corners in whole.triangles() {
        let middle: Vec3 = corners.iter().map(|&corner| whole.positions()[corner as usize]).sum();
        if middle.min_element() < 0.0 {
            carving.indices.extend(corners);
        }
    }
    for axis in 0..3 {
        let [u, v] = [AXES[(axis + 1) % 3], AXES[(axis + 2) % 3]];
        let rim = (0..=STEPS / 4).map(|k| {
            let angle = std::f32::consts::TAU * k as f32 / STEPS as f32;
            u * angle.cos() + v * angle.sin()
        });
        carving.fan(&std::iter::once(Vec3::ZERO).chain(rim).collect::<Vec<_>>(), AXES[axis]);
    }
    carving.mesh()
}

/// A solid texture; `place` maps the object into it.
fn solid(kind: SolidKind, colors: [[f32; 3]; 2], place: Mat4) -> SolidTexture {
    SolidTexture::new(kind, colors).placed(place.to_cols_array_2d())
}

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut ambient: ResMut<GlobalAmbient>) -> Result {
    *ambient = GlobalAmbient(LinearRgba::rgb(0.2, 0.23, 0.28));
    commands.spawn((
        Camera { samples: Samples::Four, background: LinearRgba::rgb(0.36, 0.45, 0.58), ..Camera::perspective(0.6) },
        Transform::from_xyz(0.6, 3.1, 8.8).looking_at(Vec3::new(0.1, 1.05, 0.0), Vec3::Y),
    ));
    commands.spawn((
        DirectionalLight { diffuse: LinearRgba::rgb(0.85, 0.8, 0.72), ..DirectionalLight::white() },
        Transform::from_xyz(0.75, 0.65, 0.5).looking_at(Vec3::ZERO, Vec3::Y),
    ));

    let wood = solid(
        SolidKind::Wood,
        [[0.62, 0.38, 0.17], [0.3, 0.13, 0.045]],
        // The axis of the tree lies low and behind, along the block.
        Mat4::from_scale(Vec3::splat(5.0))
            * Mat4::from_rotation_z(1.35)
            * Mat4::from_translation(Vec3::new(0.0, 0.65, 0.55)),
    );
    let turn = Quat::from_rotation_y(-0.45);
    commands.spawn((
        Mesh3d(meshes.add(block()?)),
        Material { specular: LinearRgba::rgb(0.1, 0.1, 0.1), shininess: 30.0, ..white() },
        wood,
        Transform::from_xyz(-2.2, 1.0, 0.0).with_rotation(turn),
    ));

    let marble = solid(
        SolidKind::Marble,
        [[0.93, 0.9, 0.85], [0.16, 0.2, 0.22]],
        Mat4::from_scale(Vec3::splat(1.4)) * Mat4::from_rotation_z(0.6),
    );
    commands.spawn((
        Mesh3d(meshes.add(ball()?)),
        Material { specular: LinearRgba::rgb(0.45, 0.45, 0.45), shininess: 90.0, ..white() },
        marble.with_octaves(7),
        Transform::from_xyz(1.1, 1.25, 0.0).with_scale(Vec3::splat(1.25)).with_rotation(turn),
    ));

    let noise = solid(
        SolidKind::Noise,
        [[0.02, 0.12, 0.42], [0.75, 0.95, 0.55]],
        Mat4::from_scale_rotation_translation(Vec3::splat(3.0), Quat::IDENTITY, Vec3::new(0.3, 2.4, 1.7)),
    );
    commands.spawn((
        Mesh3d(meshes.add(UvSphere::new(0.6, 96, 48))),
        Material { specular: LinearRgba::rgb(0.3, 0.3, 0.3), shininess: 40.0, ..white() },
        noise.with_octaves(8),
        Transform::from_xyz(2.9, 0.6, 1.0),
    ));

    let tiles = solid(
        SolidKind::Checker,
        [[0.55, 0.52, 0.47], [0.07, 0.09, 0.13]],
        Mat4::from_scale(Vec3::new(1.2, 1.0, 1.2)) * Mat4::from_rotation_y(0.35),
    );
    commands.spawn((Mesh3d(meshes.add(Plane { size: 1200.0, divisions: 1 })), white(), tiles, Transform::default()));
    Ok(())
}

/// A white material, so that the solid decides the color.
fn white() -> Material {
    Material::matte(LinearRgba::WHITE)
}
