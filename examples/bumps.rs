//! One height image on four columns: ignored, as a bump map, as the normal map made of it, and as displacement of a
//! fine mesh. Prints the error of the first three relative to the last, by the oracle.
//!
//! ```text
//! cargo run --release --example bumps
//! cargo run --release --example bumps -- --headless bumps.png
//! ```

use std::f32::consts::TAU;

use halfway::mesh::{Cylinder, ParametricSurface, Tessellation};
use halfway::prelude::*;
use halfway::reference::metrics::compare;
use halfway::reference::{Image, Oracle};
use halfway::texture::{LevelFilter, Pyramid, TexelFilter, TexelImage, TextureError, Wrap, lookup, normals};

/// Columns and rows of the image.
const SIZE: [u32; 2] = [512, 224];
/// The size of a texel on a column, in both directions.
const TEXEL: f32 = TAU * RADIUS / SIZE[0] as f32;
const RADIUS: f32 = 0.8;
/// The height of a value of 1.
const HEIGHT: f32 = 0.07;
const NAMES: [&str; 4] = ["no image", "bump map", "normal map", "displaced"];

/// The image repeats horizontally and is clamped vertically.
const SAMPLING: Sampling = Sampling {
    wrap: [Wrap::Repeat, Wrap::Clamp],
    magnify: TexelFilter::Bilinear,
    minify: TexelFilter::Bilinear,
    levels: LevelFilter::Linear,
};

fn main() -> AppExit {
    App::new().add_plugins(HalfwayPlugins::from_args()).add_systems(Startup, scene).run()
}

/// Studs in rows, every second of them moved by half a distance, between a ring below and one above.
fn heights() -> Result<TexelImage, TextureError> {
    const ROWS: f32 = 5.0;
    const AROUND: f32 = 14.0;
    TexelImage::from_fn(SIZE[0], SIZE[1], |x, y| {
        let [u, v] = [(x as f32 + 0.5) / SIZE[0] as f32, (y as f32 + 0.5) / SIZE[1] as f32];
        let row = (v * 7.0 - 1.0).floor();
        let across = v * 7.0 - 1.0 - row - 0.5;
        let along = (u * AROUND + 0.5 * row.rem_euclid(2.0)).fract() - 0.5;
        // In shares of a stud's radius; cells are a little wider than high.
        let [a, b] = [along * TAU * RADIUS / AROUND, across * SIZE[1] as f32 * TEXEL / 7.0];
        let outside = ((a * a + b * b) / (0.14 * 0.14)).min(1.0);
        let stud = (1.0 - outside) * (1.0 - outside);
        let ring = 1.0 - (2.0 * across).powi(2);
        let height = if (0.0..ROWS).contains(&row) { stud } else { ring * ring };
        [height, height, height, 1.0]
    })
}

/// A column: a mesh and its image.
struct Column {
    mesh: Mesh,
    map: Option<(MapKind, Texture, f32)>,
}

fn columns() -> Result<[Column; 4]> {
    let heights = heights()?;
    let cylinder = Cylinder { radius: RADIUS, height: TEXEL * SIZE[1] as f32, capped: false };
    let mesh = |rows, columns| cylinder.mesh(Tessellation::Count { rows, columns });
    let normals = normals::from_heights(&heights, SAMPLING.wrap, HEIGHT / TEXEL)?;
    let fine = mesh(SIZE[1], SIZE[0])?;
    let image = Pyramid::new(heights);
    let uvs = fine.uvs().unwrap_or_default();
    let height = |vertex: usize| HEIGHT * lookup::at_level(&image, &SAMPLING, uvs[vertex].to_array(), 0.0)[0];
    let (displaced, _) = fine.displaced(height)?;
    Ok([
        Column { mesh: mesh(1, 128)?, map: None },
        Column { mesh: mesh(1, 128)?, map: Some((MapKind::Height, Texture(image), HEIGHT)) },
        Column { mesh: mesh(1, 128)?, map: Some((MapKind::Normal, Texture::from(normals), 1.0)) },
        Column { mesh: displaced, map: None },
    ])
}

fn spawn(column: &Column, at: f32, world: &mut World) {
    let mesh = world.resource_mut::<Assets<Mesh>>().add(column.mesh.clone());
    let material = Material { shininess: 40.0, ..Material::plastic(LinearRgba::rgb(0.55, 0.16, 0.1)) };
    let place = Transform::from_xyz(at, 0.0, 0.0);
    let entity = world.spawn((Mesh3d(mesh), material, Shading::Phong, place)).id();
    if let Some((kind, texture, amount)) = &column.map {
        let texture = world.resource_mut::<Assets<Texture>>().add(texture.clone());
        let map = SurfaceMap { sampling: SAMPLING, amount: *amount, ..SurfaceMap::from(texture) };
        world.entity_mut(entity).insert(Maps::new(*kind, map));
    }
}

/// A light from the upper left, and a camera with this field of view.
fn look(world: &mut World, fov_y: f32) {
    let sun = DirectionalLight::white();
    world.spawn((sun, Transform::from_xyz(-1.0, 0.9, 0.8).looking_at(Vec3::ZERO, Vec3::Y)));
    world.spawn((
        Camera { background: LinearRgba::rgb(0.02, 0.03, 0.04), ..Camera::perspective(fov_y) },
        Transform::from_xyz(0.0, 0.0, 12.0),
    ));
}

/// A column in f64.
fn true_picture(column: &Column) -> Result<Image> {
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::reference());
    look(app.world_mut(), 0.215);
    spawn(column, 0.0, app.world_mut());
    app.update();
    Ok(Oracle::new(app.world_mut(), UVec2::new(180, 240))?.draw())
}

fn scene(world: &mut World) -> Result {
    let columns = columns()?;
    let pictures = columns.iter().map(true_picture).collect::<Result<Vec<_>>>()?;
    println!("from the displaced mesh, in steps of 1/255 where both are seen:");
    for (name, picture) in NAMES.iter().zip(&pictures).take(3) {
        let off = compare(picture, &pictures[3], Encoding::Srgb)?.steps.all;
        println!("{name:10}  RMSE {:5.2}", off.rmse);
    }
    look(world, 0.275);
    for (number, column) in columns.iter().enumerate() {
        spawn(column, 2.1 * (number as f32 - 1.5), world);
    }
    Ok(())
}
