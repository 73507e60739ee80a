//! `halfway bench`: the benchmark scenes, each shading beside a constant colour in the same run.

use std::process::Command;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use clap::{Args, ValueEnum};
use halfway::benchmark::{Benchmark, BenchmarkScene, Look};
use halfway::prelude::*;
use halfway::record::parse_size;
use halfway::render::{Gpu, wgpu};

use super::Failure;

#[derive(Args, Debug)]
pub(super) struct BenchArgs {
    /// The scene
    #[arg(value_enum)]
    scene: Scene,
    /// Width and height in pixels [default: the scene's]; 16x16 leaves hardly more than the work before the pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<UVec2>,
    /// Draw the spheres of S2 as octahedra: 10,000 moving entities and few triangles
    #[arg(long)]
    octahedra: bool,
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
    /// 10,000 turning spheres of 224 triangles each, 1 light, 1280 × 720
    S2,
    /// 400 spheres on a plane, 256 moving lights of range 12, 1280 × 720
    S3,
    /// One sphere of 3,968 triangles, 1 light, 256 × 256
    S4,
}

impl From<Scene> for BenchmarkScene {
    fn from(scene: Scene) -> Self {
        match scene {
            Scene::S1 => Self::S1,
            Scene::S2 => Self::S2,
            Scene::S3 => Self::S3,
            Scene::S4 => Self::S4,
        }
    }
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

    fn look(self) -> Look {
        match self {
            Self::Constant => Look::Constant,
            Self::Flat => Look::Shaded(Shading::Flat),
            Self::Gouraud => Look::Shaded(Shading::Gouraud),
            Self::Phong => Look::Shaded(Shading::Phong),
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
        return once(args, mode);
    }
    let mut apps = Mode::ALL.map(|mode| app(args, mode));
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
            let (first_frame_ms, peak_mb) = in_own_process(args, mode)?;
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

fn once(args: &BenchArgs, mode: Mode) -> Result<(), Failure> {
    frame(&mut app(args, mode))?;
    println!("{} {}", now_ms(), peak_kb());
    Ok(())
}

/// Median time to the first finished frame and peak memory in MB of three processes.
fn in_own_process(args: &BenchArgs, mode: Mode) -> Result<(f64, f64), Failure> {
    let program = std::env::current_exe().map_err(|error| Failure::new(1, error))?;
    let mut measured = Vec::new();
    for _ in 0..3 {
        let start = now_ms();
        let mut command = Command::new(&program);
        command.args(["bench", &format!("{:?}", args.scene).to_lowercase(), "--once", mode.name()]);
        if let Some(size) = args.size {
            command.args(["--size", &format!("{}x{}", size.x, size.y)]);
        }
        if args.octahedra {
            command.arg("--octahedra");
        }
        let output = command.output().map_err(|error| Failure::new(1, error))?;
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

fn app(args: &BenchArgs, mode: Mode) -> App {
    let scene = BenchmarkScene::from(args.scene);
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::headless(args.size.unwrap_or(scene.size())));
    app.add_plugins(Benchmark { scene, look: mode.look(), octahedra: args.octahedra });
    app.finish();
    app.cleanup();
    app
}
