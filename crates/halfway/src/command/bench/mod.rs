//! `halfway bench`: the benchmark scenes, each shading beside a constant colour in the same run; and what features cost.

mod cpu;
mod features;
mod own_process;
mod scenes;

use clap::{Args, ValueEnum};
use halfway::benchmark::{BenchmarkScene, Look, Machine, Spread};
use halfway::prelude::*;
use halfway::record::parse_size;
use serde_json::{Map, Value, json};

use super::Failure;
use super::levels::LevelsArgs;

#[derive(Args, Debug)]
pub(super) struct BenchArgs {
    /// What is timed
    #[arg(value_enum)]
    subject: Subject,
    /// Width and height in pixels [default: the scene's]; 16x16 leaves hardly more than the work before the pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<UVec2>,
    /// Draw the spheres of S2 as octahedra: 10,000 moving entities and few triangles
    #[arg(long)]
    octahedra: bool,
    #[command(flatten)]
    levels: LevelsArgs,
    /// Rounds; each times two frames of everything that is compared, in turn
    #[arg(long, default_value_t = 25, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    rounds: u32,
    /// Also time the first frame without the shaders that the driver keeps on disk (Mesa's do)
    #[arg(long)]
    cold: bool,
    /// Print JSON instead of a table: all figures
    #[arg(long)]
    json: bool,
    /// Draw one frame of one shading and print when it was finished and the peak memory: what the table's last
    /// columns run in a process of their own
    #[arg(long, value_enum, hide = true)]
    once: Option<Mode>,
}

/// What is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Subject {
    /// One sphere of 261,120 triangles, 4 lights, 1280 × 720
    S1,
    /// 10,000 turning spheres of 224 triangles each, 1 light, 1280 × 720
    S2,
    /// 400 spheres on a plane, 256 moving lights of range 12, 1280 × 720
    S3,
    /// One sphere of 3,968 triangles, 1 light, 256 × 256
    S4,
    /// What each feature of lighting costs once a vertex and once a pixel, beside one directional light
    Features,
}

/// How a scene is shaded.
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

pub(super) fn run(args: &BenchArgs) -> Result<(), Failure> {
    let scene = match args.subject {
        Subject::S1 => BenchmarkScene::S1,
        Subject::S2 => BenchmarkScene::S2,
        Subject::S3 => BenchmarkScene::S3,
        Subject::S4 => BenchmarkScene::S4,
        Subject::Features => return features::run(args),
    };
    match args.once {
        Some(mode) => own_process::once(args, scene, mode),
        None => scenes::run(args, scene),
    }
}

/// Runs what the plugins left to the end of their building.
fn finish(app: &mut App) {
    app.finish();
    app.cleanup();
}

fn spread(it: &Spread) -> Value {
    let Spread { min, lower_quartile, median, upper_quartile, max, count } = it;
    json!({
        "min": min,
        "lower_quartile": lower_quartile,
        "median": median,
        "upper_quartile": upper_quartile,
        "max": max,
        "frames": count,
    })
}

fn counters(report: &FrameReport) -> Value {
    let counters = halfway::benchmark::counters(report).into_iter().map(|(name, count)| (name, json!(count)));
    let all = counters.chain([("left_out", json!(report.left_out))]);
    all.map(|(name, value)| (name.to_owned(), value)).collect::<Map<_, _>>().into()
}

fn machine(it: &Machine) -> Value {
    json!({
        "adapter": it.adapter,
        "backend": it.backend,
        "software": it.software,
        "driver": it.driver,
        "driver_version": it.driver_version,
        "halfway": it.halfway,
        "cpu": it.cpu,
        "cores": it.cores,
    })
}

fn print_facts(machine: &Machine) {
    for (name, value) in machine.facts() {
        println!("{name}: {value}");
    }
}
