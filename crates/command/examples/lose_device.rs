//! A teapot in a window, whose graphics device is destroyed for each line on the standard input. The tests of the window
//! run it. With `--update-first` the App has drawn a headless picture, on a device of its own, before there is a window.

use std::io::stdin;
use std::sync::atomic::{AtomicUsize, Ordering};

use halfway::prelude::*;
use halfway::render::Gpu;

/// Lines that have come, less those whose device is destroyed.
static LINES: AtomicUsize = AtomicUsize::new(0);

fn main() -> AppExit {
    std::thread::spawn(|| {
        for _ in stdin().lines() {
            LINES.fetch_add(1, Ordering::Relaxed);
        }
    });
    let mut app = App::new();
    // Levels of detail would come in beside the frames, and one scene would have two pictures.
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

fn lose(gpu: Option<Res<Gpu>>) {
    let taken = LINES.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |lines| lines.checked_sub(1));
    if let (Ok(_), Some(gpu)) = (taken, gpu) {
        gpu.device.destroy();
    }
}
