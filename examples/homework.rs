//! A homework exercise: a red surface is lit along a line from vertex V1 to vertex V2. Which colours have ten points on
//! the line by Gouraud's method (interpolate the colours) and by Phong's (interpolate the normals)?
//!
//! ```text
//! cargo run --example homework
//! cargo run --example homework -- --headless homework.png
//! ```
//!
//! With `--headless` the colours are drawn too: Gouraud above, Phong below, and under them by how much Phong's are
//! brighter, forty times.

use halfway::lighting::equations::vector::normalize;
use halfway::lighting::equations::{Coefficients, Eye, ShadedPoint, interpolated_normal, shade};
use halfway::prelude::*;

const V1: [f64; 3] = [-80.0, 0.0, 58.0];
const V2: [f64; 3] = [-65.0, -47.0, 58.0];
const N1: [f64; 3] = [-0.80, -0.04, 0.60];
const N2: [f64; 3] = [-0.65, -0.50, 0.60];
/// Toward the light.
const L: [f64; 3] = [-0.30, -2.20, 2.80];

/// The ten pairs of colours: Gouraud's, Phong's.
type Colors = [[[f64; 3]; 2]; 10];

fn colors() -> Option<Colors> {
    let light = DirectionalLight::new(LinearRgba::rgb(1.0, 0.5, 0.5)).along(L.map(|x| -x)).ok()?;
    let red = Coefficients::from(&Material::matte(LinearRgba::RED));
    // Without highlights the position of the viewer makes no difference.
    let view = Eye::Infinite([0.0, 0.0, 1.0]);
    let color = |position, normal| {
        shade(&ShadedPoint { position, normal }, &red, &[light], [0.0; 3], &view, Reflectance::Phong)
    };
    let (n1, n2) = (normalize(N1)?, normalize(N2)?);
    let (c1, c2) = (color(V1, n1), color(V2, n2));
    Some(std::array::from_fn(|i| {
        let t = i as f64 / 9.0;
        [mix(c1, c2, t), color(mix(V1, V2, t), interpolated_normal(mix(n1, n2, t), n1))]
    }))
}

fn mix(a: [f64; 3], b: [f64; 3], t: f64) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + t * (b[i] - a[i]))
}

fn main() -> AppExit {
    let Some(colors) = colors() else { return AppExit::error() };
    println!("point           Gouraud                Phong");
    for (i, [[gr, gg, gb], [pr, pg, pb]]) in colors.iter().enumerate() {
        println!("{:5}  {gr:.4} {gg:.4} {gb:.4}  {pr:.4} {pg:.4} {pb:.4}", i + 1);
    }
    if std::env::args().len() == 1 {
        return AppExit::Success;
    }
    App::new()
        .add_plugins(HalfwayPlugins::from_args())
        .add_systems(Startup, move |commands: Commands, meshes: ResMut<Assets<Mesh>>| draw(&colors, commands, meshes))
        .run()
}

/// Emissive squares in the computed colours.
fn draw(colors: &Colors, mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
    let square = meshes.add(Plane { size: 0.98, divisions: 1 });
    for (i, [gouraud, phong]) in colors.iter().enumerate() {
        let brighter = std::array::from_fn(|channel| 40.0 * (phong[channel] - gouraud[channel]));
        for (row, [r, g, b]) in [*gouraud, *phong, brighter].into_iter().enumerate() {
            commands.spawn((
                Mesh3d(square.clone()),
                Material::emissive(LinearRgba::rgb(r as f32, g as f32, b as f32)),
                Transform::from_xyz(i as f32 - 4.5, 1.8 * (1.0 - row as f32), 0.0)
                    .with_rotation(Quat::from_rotation_x(std::f32::consts::FRAC_PI_2))
                    .with_scale(Vec3::new(1.0, 1.0, 1.8)),
            ));
        }
    }
    let camera = Camera { encoding: Encoding::Raw, background: LinearRgba::WHITE * 0.1, ..Camera::default() };
    commands.spawn((camera, Transform::from_xyz(0.0, 0.0, 7.0)));
}
