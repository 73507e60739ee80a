//! Numbers on meshes, as colours: the height of a wavy sheet with lines of equal height, lit; and the angle of a ball's
//! faces against the light, one number a face, unlit.
//!
//! ```text
//! cargo run --release --example scalars
//! cargo run --release --example scalars -- --headless scalars.png
//! ```

use halfway::prelude::*;
use halfway::render::Legend;
use halfway::scene::{ColorMap, Scalars};

fn main() -> AppExit {
    App::new().add_plugins(HalfwayPlugins::from_args()).add_systems(Startup, scene).run()
}

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut images: ResMut<Assets<Texture>>) -> Result {
    let flat = Mesh::from(Plane { size: 6.0, divisions: 60 });
    let height = |p: &Vec3| 0.35 * (1.6 * p.x).sin() * (1.3 * p.z).cos();
    let raised = flat.positions().iter().map(|p| p.with_y(height(p))).collect();
    let sheet = Mesh::new(raised, flat.indices().to_vec())?;
    let heights = Scalars::at_vertices(sheet.positions().iter().map(|p| p.y).collect());
    let range = heights.shown_range().unwrap_or_default();
    commands.insert_resource(Legend { title: "height".into(), range, colors: heights.map.colors() });
    let (sheet, colors) = Scalars { isolines: 6, ..heights }.on(&sheet)?;
    commands.spawn((
        Mesh3d(meshes.add(sheet)),
        Material::matte(LinearRgba::WHITE),
        Faces::Both,
        Scalars::maps(MapKind::Color, images.add(colors)),
    ));

    let light = Vec3::new(1.5, 1.5, -0.3).normalize();
    let ball = Mesh::from(UvSphere { radius: 0.8, segments: 24, rings: 12 });
    let cosine = |corners: [u32; 3]| {
        let [a, b, c] = corners.map(|vertex| ball.positions()[vertex as usize]);
        (b - a).cross(c - a).normalize_or_zero().dot(light)
    };
    let cosines = Scalars::on_faces(ball.triangles().map(cosine).collect());
    let (ball, colors) = Scalars { range: Some([-1.0, 1.0]), map: ColorMap::BlueRed, ..cosines }.on(&ball)?;
    commands.spawn((
        Mesh3d(meshes.add(ball)),
        (Material::matte(LinearRgba::WHITE), Shading::Unlit),
        Scalars::maps(MapKind::Color, images.add(colors)),
        Transform::from_xyz(0.0, 1.5, 0.0),
    ));
    commands.spawn((DirectionalLight::white(), Transform::from_translation(light).looking_at(Vec3::ZERO, Vec3::Y)));
    let camera = Camera { samples: Samples::Four, background: LinearRgba::rgb(0.02, 0.02, 0.03), ..Camera::default() };
    commands.spawn(camera.framing((Vec3::new(0.0, 0.4, 0.0), 3.4), Vec3::new(-0.5, -0.7, -1.0)));
    Ok(())
}
