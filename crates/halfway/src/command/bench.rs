//! `halfway bench`: the benchmark scenes, each shading beside a constant colour in the same run.

use std::process::Command;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use clap::{Args, ValueEnum};
use halfway::prelude::*;
use halfway::render::{Gpu, wgpu};

use super::Failure;

#[derive(Args, Debug)]
pub(super) struct BenchArgs {
    /// The scene
    #[arg(value_enum)]
    scene: Scene,
    /// Rounds; each times every shading in turn
    #[arg(long, default_value_t = 25, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    rounds: u32,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
    /// Draw one frame of one shading and print when it was finished and the peak memory: what the table's last
    /// columns run in a process of their own
    #[arg(long, value_enum, hide = true)]
    once: Option<Mode>,
}

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Scene {
    /// One sphere of 261,120 triangles, 4 lights, 1280 × 720
    S1,
    /// One sphere of 3,968 triangles, 1 light, 256 × 256
    S4,
}

/// How it is shaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Mode {
    Constant,
    Flat,
    Gouraud,
    Phong,
}

impl Mode {
    const ALL: [Self; 4] = [Self::Constant, Self::Flat, Self::Gouraud, Self::Phong];

    fn name(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Flat => "flat",
            Self::Gouraud => "gouraud",
            Self::Phong => "phong",
        }
    }
}

/// What was measured of one shading.
struct Row {
    mode: Mode,
    frame_ms: f64,
    first_frame_ms: f64,
    peak_mb: f64,
}

pub(super) fn run(args: &BenchArgs) -> Result<(), Failure> {
    if let Some(mode) = args.once {
        return once(args.scene, mode);
    }
    let mut apps = Mode::ALL.map(|mode| app(args.scene, mode));
    // The first frames build pipelines and upload meshes.
    for app in &mut apps {
        for _ in 0..3 {
            frame(app)?;
        }
    }
    let device = apps[0].world().resource::<Gpu>().describe();
    let mut times = Mode::ALL.map(|_| Vec::new());
    for _ in 0..args.rounds {
        for (app, times) in apps.iter_mut().zip(&mut times) {
            // The first of each turn warms the caches that the other shadings have cooled.
            frame(app)?;
            for _ in 0..2 {
                let start = Instant::now();
                frame(app)?;
                times.push(start.elapsed().as_secs_f64() * 1e3);
            }
        }
    }
    drop(apps);
    let rows = Mode::ALL
        .into_iter()
        .zip(times)
        .map(|(mode, times)| {
            let (first_frame_ms, peak_mb) = in_own_process(args.scene, mode)?;
            Ok(Row { mode, frame_ms: median(times), first_frame_ms, peak_mb })
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    if args.json {
        print_json(args.scene, &device, &rows);
    } else {
        print_table(args.scene, &device, &rows);
    }
    Ok(())
}

fn print_table(scene: Scene, device: &str, rows: &[Row]) {
    println!("{scene:?} on {device}; medians\n");
    println!("| shading | frame, ms | × constant | first frame, ms | peak memory, MB |");
    println!("|---|---|---|---|---|");
    for row in rows {
        let ratio = row.frame_ms / rows[0].frame_ms;
        let Row { mode, frame_ms, first_frame_ms, peak_mb } = row;
        println!("| {} | {frame_ms:.2} | {ratio:.2} | {first_frame_ms:.0} | {peak_mb:.0} |", mode.name());
    }
}

fn print_json(scene: Scene, device: &str, rows: &[Row]) {
    let rows: Vec<_> = rows
        .iter()
        .map(|row| {
            serde_json::json!({
                "shading": row.mode.name(),
                "frame_ms": row.frame_ms,
                "ratio_to_constant": row.frame_ms / rows[0].frame_ms,
                "first_frame_ms": row.first_frame_ms,
                "peak_mb": row.peak_mb,
            })
        })
        .collect();
    println!("{}", serde_json::json!({ "scene": format!("{scene:?}"), "device": device, "rows": rows }));
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// One frame, until the device has finished it.
fn frame(app: &mut App) -> Result<(), Failure> {
    app.update();
    let world = app.world();
    if let Some(error) = world.resource::<FrameReport>().errors.first() {
        return Err(error.clone().into());
    }
    let device = &world.resource::<Gpu>().device;
    device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| Failure::new(1, error))?;
    Ok(())
}

fn once(scene: Scene, mode: Mode) -> Result<(), Failure> {
    frame(&mut app(scene, mode))?;
    println!("{} {}", now_ms(), peak_kb());
    Ok(())
}

/// Median time to the first finished frame and peak memory in MB of three processes.
fn in_own_process(scene: Scene, mode: Mode) -> Result<(f64, f64), Failure> {
    let program = std::env::current_exe().map_err(|error| Failure::new(1, error))?;
    let mut measured = Vec::new();
    for _ in 0..3 {
        let start = now_ms();
        let output = Command::new(&program)
            .args(["bench", &format!("{scene:?}").to_lowercase(), "--once", mode.name()])
            .output()
            .map_err(|error| Failure::new(1, error))?;
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let mut numbers = text.split_whitespace().map(str::parse::<f64>);
        let (Some(Ok(finished)), Some(Ok(kb))) = (numbers.next(), numbers.next()) else {
            return Err(Failure::new(1, String::from_utf8_lossy(&output.stderr).into_owned()));
        };
        measured.push((finished - start, kb / 1024.0));
    }
    measured.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(measured[1])
}

/// Milliseconds of the wall clock, which two processes share.
fn now_ms() -> f64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64() * 1e3)
}

/// The largest resident set so far in KiB; 0 where the system does not tell.
fn peak_kb() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|value| value.split_whitespace().next()?.parse().ok()).unwrap_or(0)
}

fn app(scene: Scene, mode: Mode) -> App {
    let size = match scene {
        Scene::S1 => UVec2::new(1280, 720),
        Scene::S4 => UVec2::splat(256),
    };
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::headless(size));
    app.insert_resource(GlobalAmbient(LinearRgba::rgb(0.1, 0.1, 0.1)));
    app.add_systems(Startup, move |mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>| {
        let camera = Camera { background: LinearRgba::rgb(0.01, 0.012, 0.02), ..Camera::default() };
        commands.spawn((camera, Transform::from_xyz(0.0, 0.0, 3.0)));
        let (segments, rings) = if scene == Scene::S1 { (512, 256) } else { (64, 32) };
        let sphere = meshes.add(UvSphere { radius: 1.0, segments, rings });
        commands.spawn((Mesh3d(sphere), material(mode), shading(mode)));
        lights(&mut commands, scene);
    });
    app.finish();
    app.cleanup();
    app
}

fn material(mode: Mode) -> Material {
    let red = LinearRgba::rgb(0.8, 0.3, 0.2);
    if mode == Mode::Constant {
        return Material {
            diffuse: LinearRgba::BLACK,
            specular: LinearRgba::BLACK,
            ambient: red,
            ..Material::default()
        };
    }
    Material { ambient: red, diffuse: red, specular: LinearRgba::WHITE, shininess: 32.0, ..Material::default() }
}

fn shading(mode: Mode) -> Shading {
    match mode {
        Mode::Flat => Shading::Flat,
        Mode::Gouraud => Shading::Gouraud,
        Mode::Constant | Mode::Phong => Shading::Phong,
    }
}

fn lights(commands: &mut Commands, scene: Scene) {
    let grey = |i| LinearRgba::rgb(i, i, i);
    let sun = Transform::from_xyz(1.0, 1.0, 1.0).looking_at(Vec3::ZERO, Vec3::Y);
    if scene == Scene::S4 {
        commands.spawn((DirectionalLight::from_color(grey(0.9)), sun));
        return;
    }
    commands.spawn((DirectionalLight::from_color(grey(0.6)), sun));
    for (position, [r, g, b]) in
        [([2.0, 0.0, 2.0], [1.0, 0.9, 0.8]), ([-2.0, 1.0, 1.5], [0.8, 0.9, 1.0]), ([0.0, -2.0, 2.0], [0.9, 1.0, 0.9])]
    {
        let light = PointLight::from_color(LinearRgba::rgb(r * 0.5, g * 0.5, b * 0.5));
        commands.spawn((light, Transform::from_translation(Vec3::from_array(position))));
    }
}
