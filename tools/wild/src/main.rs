//! `halfway-wild`: random scenes, drawn, judged and, where they fail, reduced.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use clap::builder::NonEmptyStringValueParser;
use halfway::lighting::Tolerance;
use halfway::output::write_text;
use halfway::render::AdapterChoice;
use halfway_wild::{IMAGES, Judge, MODELS, scene, written};
use serde_json::Value;

/// Draws random scenes with the adapter and judges each by the oracle; reduces failures and prints them.
///
/// The same seed means the same scenes on every machine. A failure is written as a scene file, which `halfway verify`
/// takes.
#[derive(Debug, Parser)]
#[command(name = "halfway-wild", version, max_term_width = 100)]
#[command(after_help = "Exit codes: 0 done; 1 a file could not be written; 2 the command line cannot be used; 3 the \
    adapter that is asked for is not there; 4 a scene failed.")]
struct Arguments {
    /// The seed of the scenes
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// The number of scenes
    #[arg(long, value_name = "N", default_value_t = 100)]
    scenes: u64,
    /// The number of the first one
    #[arg(long, value_name = "N", default_value_t = 0)]
    first: u64,
    /// The renderer: cpu, or a graphics adapter by a part of its name or its backend's, as `halfway adapters` lists
    /// them, or both, such as gl:llvmpipe
    #[arg(long, value_name = "NAME", value_parser = NonEmptyStringValueParser::new())]
    adapter: Option<String>,
    /// Draw scenes with four samples a pixel as they are, not with one
    #[arg(long)]
    four: bool,
    /// Draw everything within so many steps of 255, and judge it by that
    #[arg(long, value_name = "STEPS", value_parser = steps)]
    steps: Option<f32>,
    /// The most pictures to judge while reducing a failure
    #[arg(long, value_name = "N", default_value_t = 500)]
    trials: usize,
    /// The folder for the scenes that failed
    #[arg(short, long, value_name = "FOLDER", default_value = "out/wild")]
    output: PathBuf,
}

fn steps(text: &str) -> Result<f32, String> {
    let steps = text.parse().ok().filter(|&steps| Tolerance::steps(steps).validate().is_ok());
    steps.ok_or_else(|| "expected a number, 0 or more, such as 0.5".into())
}

fn main() -> ExitCode {
    env_logger::Builder::from_env(env_logger::Env::default().default_filter_or("warn,wgpu_hal=off"))
        .format_timestamp(None)
        .init();
    match run(&Arguments::parse()) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::from(4),
        Err((code, error)) => {
            eprintln!("error: {error}");
            ExitCode::from(code)
        }
    }
}

/// How many scenes failed.
fn run(arguments: &Arguments) -> Result<u64, (u8, String)> {
    let choice = AdapterChoice { name: arguments.adapter.clone() };
    let adapter = choice.open().map_err(|error| (3, error.to_string()))?;
    println!("{}, seed {}", adapter.describe(), arguments.seed);
    write_files(&arguments.output).map_err(|error| (1, error))?;
    let judge = Judge::new(adapter, &arguments.output).map_err(|error| (3, error.to_string()))?;
    let mut judge = judge.with_four_samples(arguments.four);
    if let Some(steps) = arguments.steps {
        judge = judge.within(steps);
    }
    let start = Instant::now();
    // Of the scenes that were right, in shares of the range and in steps.
    let mut worst = [0.0_f64; 2];
    let mut failed = 0;
    for number in arguments.first..arguments.first.saturating_add(arguments.scenes) {
        let drawn = scene(arguments.seed, number);
        match judge.judge(&drawn) {
            Ok(figures) => {
                worst = [worst[0].max(figures.float.worst), worst[1].max(figures.bytes.worst)];
            }
            Err(finding) => {
                failed += 1;
                println!("\nscene {number} fails: {finding}");
                let small = judge.shrunk(&drawn, &finding, arguments.trials);
                report_failure(arguments, number, &judge, &small)?;
            }
        }
    }
    println!(
        "\n{} scenes in {:.0} s: {failed} failed; the others are within {:.1e} of the range and {} of 255 steps",
        arguments.scenes,
        start.elapsed().as_secs_f64(),
        worst[0],
        worst[1]
    );
    Ok(failed)
}

/// Writes the images and models that scenes name beside them.
fn write_files(folder: &Path) -> Result<(), String> {
    for (path, bytes) in IMAGES.into_iter().chain(MODELS) {
        let path = folder.join(path);
        let write = || {
            std::fs::create_dir_all(path.parent().unwrap_or(folder))?;
            std::fs::write(&path, bytes)
        };
        write().map_err(|error: std::io::Error| format!("{}: {error}", path.display()))?;
    }
    Ok(())
}

/// Prints a reduced scene and writes it.
fn report_failure(arguments: &Arguments, number: u64, judge: &Judge, small: &Value) -> Result<(), (u8, String)> {
    let text = written(small);
    let file = file(&arguments.output, arguments.seed, number);
    if let Err(finding) = judge.judge(small) {
        println!("{}: {finding}", file.display());
    }
    print!("{text}");
    write_text(&file, &text).map_err(|error| (1, error.to_string()))
}

fn file(folder: &Path, seed: u64, number: u64) -> PathBuf {
    folder.join(format!("seed_{seed}_scene_{number}.json"))
}
