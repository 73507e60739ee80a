//! One checker on a floor that is tilted away and on a ball, by twelve filters: from left to right nearest, bilinear,
//! B-spline and Catmull–Rom; above without mipmaps, in the middle with them; below by the footprint's shape: ripmap,
//! summed areas, 16 probes and the elliptical mean.
//!
//! ```text
//! cargo run --release --example textures
//! cargo run --release --example textures -- --headless textures.png
//! ```

use halfway::prelude::*;
use halfway::texture::{LevelFilter, TexelFilter, TexelImage, TextureError, UvTransform};

/// The filters of the panels, row by row.
const PANELS: [Sampling; 12] = {
    const fn panel(texels: TexelFilter, levels: LevelFilter) -> Sampling {
        Sampling { wrap: Sampling::NEAREST.wrap, magnify: texels, minify: texels, levels }
    }
    [
        panel(TexelFilter::Nearest, LevelFilter::None),
        panel(TexelFilter::Bilinear, LevelFilter::None),
        panel(TexelFilter::BSpline, LevelFilter::None),
        panel(TexelFilter::CatmullRom, LevelFilter::None),
        panel(TexelFilter::Nearest, LevelFilter::Nearest),
        panel(TexelFilter::Bilinear, LevelFilter::Linear),
        panel(TexelFilter::BSpline, LevelFilter::Linear),
        panel(TexelFilter::CatmullRom, LevelFilter::Linear),
        panel(TexelFilter::Bilinear, LevelFilter::Ripmap),
        panel(TexelFilter::Bilinear, LevelFilter::SummedArea),
        panel(TexelFilter::Bilinear, LevelFilter::Anisotropic16),
        panel(TexelFilter::Bilinear, LevelFilter::Elliptical),
    ]
};

fn main() -> AppExit {
    App::new().add_plugins(HalfwayPlugins::from_args()).add_systems(Startup, scene).run()
}

/// Squares of eight texels, in four colors.
fn checker() -> Result<TexelImage, TextureError> {
    TexelImage::from_fn(32, 32, |x, y| {
        let colors = [[0.9, 0.85, 0.7, 1.0], [0.05, 0.1, 0.3, 1.0], [0.5, 0.05, 0.05, 1.0], [0.9, 0.85, 0.7, 1.0]];
        colors[(x / 8 % 2 + 2 * (y / 8 % 2)) as usize]
    })
}

fn map(texture: &Handle<Texture>, sampling: Sampling, transform: UvTransform) -> Maps {
    Maps::new(MapKind::Color, SurfaceMap { sampling, transform, ..SurfaceMap::from(texture.clone()) })
}

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut textures: ResMut<Assets<Texture>>) -> Result {
    let texture = textures.add(Texture::from(checker()?));
    commands.spawn((
        Camera { background: LinearRgba::rgb(0.02, 0.03, 0.05), ..Camera::perspective(0.6) },
        Transform::from_xyz(0.0, 0.0, 10.0),
    ));
    commands.spawn((DirectionalLight::white(), Transform::from_xyz(0.3, 1.0, 0.6).looking_at(Vec3::ZERO, Vec3::Y)));
    let floor = meshes.add(Plane { size: 2.0, divisions: 1 });
    let ball = meshes.add(UvSphere::new(0.36, 64, 32));
    for (number, sampling) in PANELS.into_iter().enumerate() {
        let (column, row) = ((number % 4) as f32, (number / 4) as f32);
        let x = 2.35 * (column - 1.5);
        let transform = UvTransform { scale: [4.0, 40.0], ..UvTransform::default() };
        // Long, and seen from a few degrees above.
        let floor_at = Vec3::new(x, 3.35 - 3.5 * row, -7.0);
        let tilt = (floor_at.y / 17.0).atan() + 0.085;
        commands.spawn((
            Mesh3d(floor.clone()),
            Material::matte(LinearRgba::WHITE),
            map(&texture, sampling, transform),
            Transform::from_translation(floor_at)
                .with_rotation(Quat::from_rotation_x(tilt))
                .with_scale(Vec3::new(1.05, 1.0, 9.0)),
        ));
        commands.spawn((
            Mesh3d(ball.clone()),
            Material::plastic(LinearRgba::WHITE),
            map(&texture, sampling, UvTransform::default()),
            Transform::from_xyz(x, 2.58 - 2.06 * row, 0.0),
        ));
    }
    Ok(())
}
