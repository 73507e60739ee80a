//! A light moves with its parent. Five teapots show five arrangements:
//!
//! | where | teapot | light |
//! |---|---|---|
//! | front left, amber | drives round | rides on the teapot |
//! | front right, blue and violet | stands | two circle round it |
//! | back left, green | drives round | two street lamps stand |
//! | back right, rose | turns | circles on its own |
//! | middle, white | stands | is fixed to the camera |
//!
//! ```text
//! cargo run --release --example moving_lights
//! cargo run --release --example moving_lights -- --headless moving_lights.png --frames 180
//! ```
//!
//! The teapot is the model file `assets/teapot.obj`; `--model FILE` names another.

use std::error::Error;
use std::f32::consts::{FRAC_PI_2, TAU};
use std::path::Path;

use halfway::mesh::Part;
use halfway::prelude::*;

/// The period of the scene in seconds.
const LOOP: f32 = 6.0;

/// The number of turns about +Y in a period.
#[derive(Component)]
struct Turns(f32);

/// The parts of the model.
#[derive(Resource)]
struct Parts(Vec<(Mesh, Material, Transform)>);

fn main() -> AppExit {
    let parts = match load() {
        Ok(parts) => parts,
        Err(error) => {
            eprintln!("error: {error}");
            return AppExit::from_code(2);
        }
    };
    App::new()
        .add_plugins(HalfwayPlugins::from_args())
        .insert_resource(GlobalAmbient(LinearRgba::rgb(0.01, 0.01, 0.025)))
        .insert_resource(parts)
        .add_systems(Startup, scene)
        .add_systems(Update, (turn, sway))
        .run()
}

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, parts: Res<Parts>) {
    let at = Transform::from_xyz;
    let parts: Vec<_> =
        parts.0.iter().map(|(mesh, own, place)| (Mesh3d(meshes.add(mesh.clone())), *own, *place)).collect();
    let teapot = || SpawnIter(parts.clone().into_iter());
    let [bulb, dot] = [(0.2, 24), (0.05, 8)].map(|(radius, n)| Mesh3d(meshes.add(UvSphere::new(radius, n, n / 2))));
    let bulb = |color| (bulb.clone(), Material::emissive(color));
    let pole = Mesh3d(meshes.add(Cuboid { size: Vec3::new(0.08, 1.9, 0.08) }));
    let pole = |place: Transform| (pole.clone(), Material::emissive(LinearRgba::WHITE * 0.04), place);
    // The path of a light or a teapot.
    let dots = |radius: f32, height: f32, color: LinearRgba| {
        let dot = dot.clone();
        Children::spawn(SpawnIter((0..36).map(move |i| {
            let place = Quat::from_rotation_y(TAU * i as f32 / 36.0) * Vec3::X * radius + Vec3::Y * height;
            (dot.clone(), Material::emissive(color * 0.3), Transform::from_translation(place))
        })))
    };

    // With the object: the teapot drives round, the lamp is its child.
    let (place, amber) = (at(-5.3, 0.0, 3.2), LinearRgba::rgb(1.0, 0.5, 0.1));
    let lamp = (bulb(amber), spot(amber, 25.0), at(-1.75, 3.6, 0.0).looking_at(Vec3::X * 2.0, Vec3::Y));
    let car = (driving(-1.3), Children::spawn((teapot(), Spawn(pole(at(-1.75, 2.65, 0.0))), Spawn(lamp))));
    commands.spawn((place, Turns(1.0), children![car]));
    commands.spawn((place, dots(1.7, 0.0, amber)));

    // ANCHOR: circling_lights
    // Objects fixed, lights moving.
    let place = at(5.3, 0.0, 3.2);
    let [blue, violet] = [LinearRgba::rgb(0.05, 0.35, 1.0), LinearRgba::rgb(0.6, 0.1, 1.0)];
    let lights = [(blue, 2.8), (violet, -2.8)].map(|(color, x)| (bulb(color), point(color), at(x, 2.0, 0.0)));
    commands.spawn((place, Children::spawn(teapot())));
    commands.spawn((place, Turns(-1.0), Children::spawn(SpawnIter(lights.into_iter()))));
    commands.spawn((place, dots(2.8, 2.0, blue)));
    // ANCHOR_END: circling_lights

    // Lights fixed, objects moving.
    let (place, green) = (at(-5.3, 0.0, -4.6), LinearRgba::rgb(0.2, 1.0, 0.35));
    for side in [-1.0, 1.0] {
        let lamp = at(side * 2.5, 3.6, side * -2.6).looking_at(Vec3::new(side * 0.8, 0.0, side * -1.2), Vec3::Y);
        let pole = pole(at(side * 2.5, 1.8, side * -2.6).with_scale(Vec3::new(1.0, 1.9, 1.0)));
        commands.spawn((place, children![(bulb(green), spot(green, 28.0), lamp), pole]));
    }
    commands.spawn((place, Turns(1.0), children![(driving(-2.1), Children::spawn(teapot()))]));
    commands.spawn((place, dots(1.7, 0.0, green)));

    // Both move, independently.
    let (place, rose) = (at(5.3, 0.0, -4.6), LinearRgba::rgb(1.0, 0.08, 0.25));
    commands.spawn((place, Turns(-1.0), Children::spawn(teapot())));
    commands.spawn((place, Turns(2.0), children![(bulb(rose), point(rose), at(2.4, 2.6, 0.0))]));
    commands.spawn((place, dots(2.4, 2.6, rose)));

    // A headlight: the light is the camera's child.
    commands.spawn((at(0.0, 0.0, -0.8), Children::spawn(teapot())));
    let mut headlight = SpotLight::white(0.1);
    headlight.cone.inner = Some(0.0);
    headlight.light = PointLight { attenuation: Attenuation::NONE, ..PointLight::new(LinearRgba::WHITE * 0.7) };
    let camera = Camera { samples: Samples::Four, ..Camera::perspective(0.52) };
    let eye = at(0.0, 14.0, 18.0).looking_at(Vec3::new(0.0, 0.5, -0.6), Vec3::Y);
    commands.spawn((camera, eye, children![headlight]));

    // The ground, and a little moonlight for the dark sides.
    let ground = meshes.add(Plane { size: 120.0, divisions: 1 });
    commands.spawn((Mesh3d(ground), Material::matte(LinearRgba::WHITE * 0.4)));
    let moon = DirectionalLight::new(LinearRgba::rgb(0.05, 0.045, 0.07));
    commands.spawn((moon, at(-3.0, 1.0, 2.0).looking_at(Vec3::ZERO, Vec3::Y)));
}

fn point(color: LinearRgba) -> PointLight {
    PointLight { attenuation: Attenuation::new(0.3, 0.0, 0.13), range: Some(6.0), ..PointLight::new(color) }
}

fn spot(color: LinearRgba, cutoff_degrees: f32) -> SpotLight {
    let light = PointLight { attenuation: Attenuation::new(0.8, 0.0, 0.03), ..PointLight::new(color) };
    let cutoff = cutoff_degrees.to_radians();
    SpotLight { light, cone: Cone { inner: Some(0.7 * cutoff), ..Cone::new(cutoff) } }
}

/// On a circle, at an angle in radians, spout ahead.
fn driving(angle: f32) -> Transform {
    let turned = Quat::from_rotation_y(angle);
    Transform::from_translation(turned * Vec3::X * 1.7).with_rotation(turned * Quat::from_rotation_y(FRAC_PI_2))
}

// ANCHOR: turn
fn turn(time: Res<Time>, mut turning: Query<(&Turns, &mut Transform)>) {
    for (turns, mut transform) in &mut turning {
        transform.rotation = Quat::from_rotation_y(turns.0 * TAU * (time.elapsed_secs() / LOOP).fract());
    }
}
// ANCHOR_END: turn

/// Swings the camera, which shows that its light moves with it. In a window the mouse can still turn it.
fn sway(time: Res<Time>, mut camera: Single<&mut Transform, With<Camera>>) {
    let angle = |seconds: f32| 0.12 * (TAU * seconds / LOOP).sin();
    let (now, step) = (time.elapsed_secs(), time.delta_secs());
    camera.rotate_around(Vec3::ZERO, Quat::from_rotation_y(angle(now) - angle(now - step)));
}

/// Reads the model, scales it to the teapot's length and puts it on the ground.
fn load() -> Result<Parts, Box<dyn Error>> {
    let named = std::env::args_os().skip_while(|argument| argument != "--model").nth(1);
    let file = named.unwrap_or_else(|| concat!(env!("CARGO_MANIFEST_DIR"), "/assets/teapot.obj").into());
    let file = Path::new(&file);
    let model = halfway::mesh::load(file)?;
    for warning in &model.warnings {
        eprintln!("{}: {warning}", file.display());
    }
    let bounds = model.bounds().ok_or("the model has no parts")?;
    let foot = bounds.center().with_y(bounds.min.y);
    let fit = Mat4::from_scale(Vec3::splat(4.8 / bounds.size().max_element())) * Mat4::from_translation(-foot);
    let materials = model.materials.iter().map(ModelMaterial::from_source).collect::<Result<Vec<_>, _>>()?;
    for warning in materials.iter().flat_map(|(_, warnings)| warnings) {
        eprintln!("{}: {warning}", file.display());
    }
    let part = |part: Part| {
        let own = part.material.map_or(Material::BRASS, |index| materials[index].0.material);
        (part.mesh, own, Transform::from_matrix(fit * part.world_from_part))
    };
    Ok(Parts(model.parts.into_iter().map(part).collect()))
}
