//! Ten balls lit by a sky alone: highlights get sharper from left to right; the upper balls are metal, the lower ones a
//! matt color under a polish.
//!
//! ```text
//! cargo run --release --example environment
//! cargo run --release --example environment -- --headless environment.png
//! ```

use halfway::prelude::*;
use halfway::texture::environment::{Environment, EnvironmentLight, EnvironmentMap, EnvironmentShape};
use halfway::texture::noise::{checker, fractal};

/// The exponents of the columns, from left to right.
const EXPONENTS: [f32; 5] = [1.0, 12.0, 80.0, 800.0, 1e5];

fn main() -> AppExit {
    App::new().add_plugins(HalfwayPlugins::from_args()).add_systems(Startup, scene).run()
}

fn mix(a: [f64; 3], b: [f64; 3], share: f64) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + share.clamp(0.0, 1.0) * (b[k] - a[k]))
}

/// A sky with clouds and a sun over a floor of tiles that reaches to the horizon.
fn sky([x, y, z]: [f64; 3]) -> [f32; 4] {
    const SUN: [f64; 3] = [0.06, 0.292, -0.954];
    const HAZE: [f64; 3] = [0.62, 0.68, 0.74];
    let color = if y > 0.0 {
        let blue = mix(HAZE, [0.06, 0.16, 0.42], (3.0 * y).sqrt().min(1.0));
        // Clouds on a plane above, which fade into haze toward the horizon.
        let height = y + 0.08;
        let clouds = fractal([1.7 * x / height, 3.0, 1.7 * z / height], 6, 0.02 / height);
        let clouded = mix(blue, [0.85, 0.84, 0.82], (1.5 * clouds).clamp(0.0, 0.9) * (6.0 * y).min(1.0));
        let toward_sun = (x * SUN[0] + y * SUN[1] + z * SUN[2]).min(1.0);
        let away = toward_sun.acos();
        let glow = 0.7 * (-away / 0.12).exp() + if away < 0.03 { 60.0 } else { 0.0 };
        std::array::from_fn(|k| clouded[k] + glow * [1.0, 0.85, 0.6][k])
    } else {
        let down = (-y).max(1e-4);
        let at = [2.0 * x / down, 0.5, 2.0 * z / down];
        let width = 0.004 / (down * down);
        let tile = mix([0.32, 0.13, 0.06], [0.5, 0.42, 0.3], checker(at, [width, 1.0, width]));
        mix(tile, HAZE, (-9.0 * down).exp())
    };
    let [r, g, b] = color.map(|number| number as f32);
    [r, g, b, 1.0]
}

fn scene(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut environments: ResMut<Assets<EnvironmentMap>>,
    mut ambient: ResMut<GlobalAmbient>,
) -> Result {
    *ambient = GlobalAmbient(LinearRgba::BLACK);
    let cube = Environment::from_fn(EnvironmentShape::Cube, 768, sky)?;
    commands.spawn(EnvironmentLight::from(environments.add(EnvironmentMap::new(&cube)?)));
    commands.spawn((
        Camera { samples: Samples::Four, ..Camera::perspective(0.6) },
        Transform::from_xyz(0.0, 0.0, 10.0).looking_at(Vec3::new(0.0, 0.35, 0.0), Vec3::Y),
    ));
    let ball = meshes.add(UvSphere::new(0.95, 96, 48));
    for (number, exponent) in EXPONENTS.into_iter().enumerate() {
        let x = 2.1 * (number as f32 - 2.0);
        let metal = Material {
            diffuse: LinearRgba::BLACK,
            specular: LinearRgba::rgb(1.0, 0.78, 0.45),
            shininess: exponent,
            ..Material::DEFAULT
        };
        let polished = Material {
            diffuse: LinearRgba::rgb(0.05, 0.3, 0.33),
            specular: LinearRgba::rgb(0.25, 0.25, 0.25),
            shininess: exponent,
            ..Material::DEFAULT
        };
        for (y, material) in [(1.05, metal), (-1.05, polished)] {
            commands.spawn((
                Mesh3d(ball.clone()),
                material,
                Reflectance::Phong,
                Shading::Phong,
                Transform::from_xyz(x, y, 0.0),
            ));
        }
    }
    Ok(())
}
