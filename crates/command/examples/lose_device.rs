//! A teapot in a window. For each line on the standard input its graphics device is destroyed; for `surface` the
//! surface of its window counts as lost, as if the driver had said so, and for `surfaces` so does every one from then
//! on. The tests of the window run it. With `--update-first` the App has drawn a headless picture, on a device of its
//! own, before there is a window.

use std::io::stdin;
use std::sync::Mutex;

use halfway::prelude::*;
use halfway::render::{Gpu, SurfaceLost};

/// Lines that have arrived and are not yet handled.
static LINES: Mutex<Vec<String>> = Mutex::new(Vec::new());

fn main() -> AppExit {
    std::thread::spawn(|| {
        for line in stdin().lines().map_while(Result::ok) {
            LINES.lock().expect("nobody panics with it").push(line);
        }
    });
    let mut app = App::new();
    // Levels of detail would arrive beside the frames, and one scene would have two pictures.
    app.insert_resource(ViewTolerance(Tolerance::EXACT));
    app.add_plugins(HalfwayPlugins).add_systems(Startup, scene).add_systems(Update, lose);
    if std::env::args().any(|argument| argument == "--update-first") {
        app.update();
        app.update();
    }
    app.run()
}

fn scene(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>) {
    commands.spawn((Camera::default(), Transform::from_xyz(0.0, 2.0, 6.0).looking_at(Vec3::ZERO, Vec3::Y)));
    commands.spawn((Mesh3d(meshes.add(Teapot::new(8))), Material::BRASS));
    commands.spawn((PointLight::white(), Transform::from_xyz(2.0, 3.0, 2.0)));
}

fn lose(mut commands: Commands, gpu: Option<Res<Gpu>>, mut always: Local<bool>) {
    let line = LINES.lock().expect("nobody panics with it").pop();
    *always |= line.as_deref() == Some("surfaces");
    if *always || line.as_deref() == Some("surface") {
        commands.insert_resource(SurfaceLost);
    } else if let (Some(_), Some(gpu)) = (line, gpu) {
        gpu.device.destroy();
    }
}
