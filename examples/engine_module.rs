//! Lighting and rendering as modules of an engine: single plugins instead of the group, drawing in a schedule of the
//! engine's own, and a runner of its own that needs no window.
//!
//! ```text
//! cargo run --release --example engine_module
//! cargo run --release --example engine_module -- --headless engine_module.png --frames 4 --size 960x540
//! ```

use std::error::Error;
use std::f32::consts::TAU;
use std::path::PathBuf;

use bevy_ecs::schedule::ScheduleLabel;
use bevy_transform::TransformSystems;
use bevy_transform::systems::{
    StaticTransformOptimizations, mark_dirty_trees, propagate_parent_transforms, sync_simple_transforms,
};
use halfway::output::{PictureFormat, write_picture};
use halfway::prelude::*;
use halfway::record::parse_size;
use halfway::render::PendingPicture;

/// The schedule that the engine runs when it wants a picture.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
struct MyFrame;

fn main() -> AppExit {
    App::new()
        .add_plugins((TaskPoolPlugin::default(), MeshPlugin, LightingPlugin))
        .add_plugins(RenderPlugin { schedule: MyFrame.intern() })
        // Levels of detail would be built between frames, and be counted in their bytes.
        .insert_resource(ViewTolerance(Tolerance::EXACT))
        .init_resource::<StaticTransformOptimizations>()
        .add_systems(
            MyFrame,
            (mark_dirty_trees, propagate_parent_transforms, sync_simple_transforms)
                .chain()
                .in_set(TransformSystems::Propagate),
        )
        .add_systems(Startup, scene)
        .add_systems(Update, turn)
        .set_runner(|app| match run(app) {
            Ok(()) => AppExit::Success,
            Err(error) => {
                eprintln!("error: {error}");
                AppExit::from_code(2)
            }
        })
        .run()
}

/// The engine's loop: its own work, then a frame.
fn run(mut app: App) -> Result<(), Box<dyn Error>> {
    let argument = |name: &str| std::env::args().skip_while(|argument| argument != name).nth(1);
    let frames = argument("--frames").unwrap_or("4".into());
    let frames: u32 = frames.parse().map_err(|_| format!("--frames {frames}: expected a number"))?;
    if let Some(size) = argument("--size") {
        app.insert_resource(Headless { size: parse_size(&size)?, ..Headless::default() });
    }
    app.finish();
    app.cleanup();
    println!("frame  objects  draws  triangles  matrices  bytes uploaded  pipelines");
    for frame in 1..=frames {
        app.update();
        app.world_mut().run_schedule(MyFrame);
        let report = app.world().resource::<FrameReport>();
        if let Some(error) = report.errors.first() {
            return Err(error.clone().into());
        }
        println!(
            "{frame:5}{:9}{:7}{:11}{:10}{:16}{:11}",
            report.objects, report.draws, report.triangles, report.matrices, report.bytes_uploaded, report.pipelines
        );
    }
    if let Some(file) = argument("--headless").map(PathBuf::from) {
        let picture = PendingPicture::request(app.world())?.wait()?;
        write_picture(&picture, &file, PictureFormat::from_path(&file, Some(8))?, Encoding::Srgb)?;
        println!("{}", file.display());
    }
    Ok(())
}

#[derive(Component)]
struct Turning;

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
    let sphere = Mesh3d(meshes.add(UvSphere::new(0.55, 48, 24)));
    let planets = (0..9).map(move |i| {
        let place = Quat::from_rotation_y(TAU * i as f32 / 9.0) * Vec3::X * 3.6;
        let material = [Material::RUBY, Material::SILVER, Material::TURQUOISE][i % 3];
        (sphere.clone(), material, Transform::from_translation(place))
    });
    commands.spawn((Turning, Transform::IDENTITY, Children::spawn(SpawnIter(planets))));
    commands.spawn((Mesh3d(meshes.add(Teapot::new(12))), Material::BRASS));
    let sun = DirectionalLight::new(LinearRgba::WHITE * 0.8);
    let sky = DirectionalLight::new(LinearRgba::rgb(0.15, 0.25, 0.6));
    for (light, from) in [(sun, Vec3::new(-2.0, 2.0, 3.0)), (sky, Vec3::new(3.0, 1.0, 0.5))] {
        commands.spawn((light, Transform::from_translation(from).looking_at(Vec3::ZERO, Vec3::Y)));
    }
    commands.spawn((
        Camera { samples: Samples::Four, background: LinearRgba::rgb(0.01, 0.015, 0.03), ..Camera::default() },
        Transform::from_xyz(0.0, 3.7, 7.0).looking_at(Vec3::new(0.0, -0.65, 0.0), Vec3::Y),
    ));
}

/// Turns for two frames, then stands still: unchanged matrices are neither computed nor uploaded again.
fn turn(mut turning: Single<&mut Transform, With<Turning>>, mut frame: Local<u32>) {
    *frame += 1;
    if *frame <= 2 {
        turning.rotate_y(0.1);
    }
}
