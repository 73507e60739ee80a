//! Weightings of the face normals around a vertex. From left to right uniform, by area, by the angle at the vertex, and
//! by Max's weights; from top to bottom a sphere of uneven triangles, a coarse teapot, and a box with narrow bevels.
//! See docs/normals.md.
//!
//! ```text
//! cargo run --release --example normal_weightings
//! cargo run --release --example normal_weightings -- --headless normal_weightings.png --size 960x640
//! ```

use halfway::mesh::{Icosphere, NormalWeighting, Normals};
use halfway::prelude::*;

const WEIGHTINGS: [NormalWeighting; 4] =
    [NormalWeighting::Uniform, NormalWeighting::Area, NormalWeighting::Angle, NormalWeighting::Max];

fn main() -> AppExit {
    App::new().add_plugins(HalfwayPlugins::from_args()).add_systems(Startup, scene).run()
}

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
    let material = Material {
        specular: LinearRgba::WHITE * 0.8,
        shininess: 60.0,
        ..Material::plastic(LinearRgba::rgb(0.03, 0.12, 0.3))
    };
    let turned = Quat::from_rotation_x(0.5) * Quat::from_rotation_y(0.6);
    let rows = [(uneven_sphere(), 2.4, 1.05), (Teapot::new(2).into(), 0.05, 0.62), (beveled_box(), -2.4, 0.8)];
    for (mesh, y, scale) in rows {
        for (weighting, x) in WEIGHTINGS.into_iter().zip([-4.2, -1.4, 1.4, 4.2]) {
            let (mesh, _) = mesh.clone().with_normals(Normals::Weighted(weighting));
            let place = Transform::from_xyz(x, y, 0.0).with_rotation(turned).with_scale(Vec3::splat(scale));
            commands.spawn((Mesh3d(meshes.add(mesh)), material, place));
        }
    }
    for (brightness, from) in [(0.9, Vec3::new(-2.0, 2.2, 3.0)), (0.5, Vec3::new(3.0, 1.0, 2.0))] {
        let light = DirectionalLight::new(LinearRgba::WHITE * brightness);
        commands.spawn((light, Transform::from_translation(from).looking_at(Vec3::ZERO, Vec3::Y)));
    }
    commands.spawn((
        Camera { samples: Samples::Four, background: LinearRgba::WHITE * 0.02, ..Camera::perspective(0.19) },
        Transform::from_xyz(0.0, 0.0, 40.0),
    ));
}

/// A sphere whose vertices are displaced along its surface.
fn uneven_sphere() -> Mesh {
    let sphere = Mesh::from(Icosphere::new(1.0, 4));
    // Smooth in the position, so that no triangle turns over and vertices at one position stay together.
    let push = |p: Vec3| Vec3::new((7.0 * p.y + 1.0).sin(), (8.0 * p.z + 2.0).sin(), (9.0 * p.x).sin());
    let positions = sphere.positions().iter().map(|&p| (p + 0.16 * push(p)).normalize()).collect();
    Mesh::new(positions, sphere.indices().to_vec()).expect("as many vertices as before, and finite")
}

/// A cube of side 2 with its edges and corners cut off.
fn beveled_box() -> Mesh {
    const BEVEL: f32 = 0.12;
    const AROUND: [[f32; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    // The vertex of this face, 0 … 2, nearest to the corner in this direction.
    let vertex = |corner: Vec3, face: usize| {
        let mut p = (1.0 - BEVEL) * corner;
        p[face] = corner[face];
        p
    };
    let mut positions = Vec::new();
    for axis in 0..3 {
        let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
        let corner = |along: f32, [a, b]: [f32; 2]| {
            let mut corner = Vec3::ZERO;
            (corner[axis], corner[second], corner[third]) = (along, a, b);
            corner
        };
        for along in [-1.0, 1.0] {
            add_polygon(&mut positions, &AROUND.map(|across| vertex(corner(along, across), axis)));
        }
        for across in AROUND {
            let ends = [(-1.0, second), (-1.0, third), (1.0, third), (1.0, second)];
            add_polygon(&mut positions, &ends.map(|(along, face)| vertex(corner(along, across), face)));
        }
    }
    for z in [-1.0, 1.0] {
        for [x, y] in AROUND {
            add_polygon(&mut positions, &[0, 1, 2].map(|face| vertex(Vec3::new(x, y, z), face)));
        }
    }
    // Each triangle has vertices of its own: those at one position share their normal all the same.
    let indices = (0..positions.len() as u32).collect();
    Mesh::new(positions, indices).expect("three finite corners a triangle")
}

/// Adds the triangles of a convex polygon, which are to face away from the origin.
fn add_polygon(positions: &mut Vec<Vec3>, polygon: &[Vec3]) {
    for pair in polygon[1..].windows(2) {
        let (a, b, c) = (polygon[0], pair[0], pair[1]);
        let outward = (b - a).cross(c - a).dot(a + b + c) > 0.0;
        positions.extend(if outward { [a, b, c] } else { [a, c, b] });
    }
}
