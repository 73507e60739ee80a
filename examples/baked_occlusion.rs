//! Two stones on two floors in even light from all sides; on the right both have ambient occlusion that rays have
//! baked.
//!
//! ```text
//! cargo run --release --example baked_occlusion
//! cargo run --release --example baked_occlusion -- --headless baked_occlusion.png
//! ```

use std::ops::ControlFlow;

use halfway::mesh::{OcclusionBake, OcclusionImage};
use halfway::prelude::*;
use halfway::texture::noise::gradient_noise;
use halfway::texture::{TexelImage, TextureError, Wrap};

fn main() -> AppExit {
    App::new().add_plugins(HalfwayPlugins::from_args()).add_systems(Startup, scene).run()
}

/// A ball with creases, of the height 2 or so, that stands on y = 0.
fn stone() -> Result<Mesh> {
    let ball = Mesh::from(UvSphere::new(1.0, 144, 72));
    let height = |vertex: usize| {
        let at = |scale: f64| gradient_noise(ball.positions()[vertex].to_array().map(|x| scale * f64::from(x) + 0.37));
        let creases = at(1.6).abs().sqrt() + 0.4 * at(4.1).abs().sqrt();
        (0.34 * creases - 0.25) as f32
    };
    let (stone, _) = ball.displaced(height)?;
    let lowest = stone.bounds().min.y;
    let positions = stone.positions().iter().map(|p| *p - lowest * Vec3::Y).collect();
    let (normals, uvs) = (stone.normals().to_vec(), stone.uvs().map(<[Vec2]>::to_vec));
    Ok(Mesh::from_parts(positions, Some(normals), uvs, stone.indices().to_vec())?)
}

/// Bakes, with a bar on standard error.
fn baked(what: &str, mesh: &Mesh, by: &Mesh, bake: OcclusionBake) -> Result<Texture> {
    let bar = |done: u32, of: u32| {
        let (share, before) = (20 * done / of, 20 * (done - 1) / of);
        if share > before {
            eprint!("\r{what}  [{:<20}]", "#".repeat(share as usize));
        }
        ControlFlow::Continue(())
    };
    let image = mesh.baked_occlusion(&[by], &bake, &bar)?;
    eprintln!();
    let [width, height] = image.size();
    let open = image.shares().iter().sum::<f32>() / image.shares().len() as f32;
    let least = image.shares().iter().copied().fold(1.0, f32::min);
    println!(
        "{what}: {width} × {height} texels of {} rays, open by {open:.3} in the mean and {least:.3} at least",
        bake.rays
    );
    Ok(Texture::from(texels(&image)?))
}

fn texels(image: &OcclusionImage) -> Result<TexelImage, TextureError> {
    let [width, height] = image.size();
    TexelImage::new(width, height, image.shares().iter().map(|share| [*share, *share, *share, 1.0]).collect())
}

fn scene(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut textures: ResMut<Assets<Texture>>,
    mut ambient: ResMut<GlobalAmbient>,
) -> Result {
    let (stone, floor) = (stone()?, Mesh::from(Plane { size: 3.2, divisions: 1 }));
    let of_stone = OcclusionBake { size: [256, 128], rays: 128, ..OcclusionBake::default() };
    let of_floor = OcclusionBake { size: [96, 96], rays: 128, ..OcclusionBake::default() };
    let images = [baked("stone", &stone, &floor, of_stone)?, baked("floor", &floor, &stone, of_floor)?];
    // The stone's image repeats around it; the floor's does not.
    let wraps = [[Wrap::Repeat, Wrap::Clamp], [Wrap::Clamp; 2]];

    *ambient = GlobalAmbient(LinearRgba::rgb(0.85, 0.9, 1.0));
    commands.spawn((
        Camera { samples: Samples::Four, background: LinearRgba::rgb(0.4, 0.45, 0.5), ..Camera::perspective(0.5) },
        Transform::from_xyz(0.0, 3.6, 7.4).looking_at(Vec3::new(0.0, 0.75, 0.0), Vec3::Y),
    ));
    let sun = DirectionalLight { diffuse: LinearRgba::rgb(0.25, 0.22, 0.18), ..DirectionalLight::white() };
    commands.spawn((sun, Transform::from_xyz(-0.7, 1.0, 0.5).looking_at(Vec3::ZERO, Vec3::Y)));
    let colors = [LinearRgba::rgb(0.62, 0.5, 0.38), LinearRgba::rgb(0.5, 0.52, 0.55)];
    let handles = [stone, floor].map(|mesh| meshes.add(mesh));
    let images = images.map(|image| textures.add(image));
    for (column, has_images) in [(-1.0, false), (1.0, true)] {
        for (number, (mesh, color)) in handles.iter().zip(colors).enumerate() {
            let material = Material { ambient: color, ..Material::matte(color) };
            let mut entity = commands.spawn((
                Mesh3d(mesh.clone()),
                material,
                Shading::Phong,
                Transform::from_xyz(1.72 * column, 0.0, 0.0),
            ));
            if has_images {
                let sampling = Sampling { wrap: wraps[number], ..Sampling::default() };
                let map = SurfaceMap { sampling, ..SurfaceMap::from(images[number].clone()) };
                entity.insert(Maps::new(MapKind::Occlusion, map));
            }
        }
    }
    Ok(())
}
