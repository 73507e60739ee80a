//! `halfway-chart`: measures, and writes the report.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use halfway::output::write_text;
use halfway::render::RenderError;
use halfway_chart::measure::{MeasureError, MeasureProgress};
use halfway_chart::{NamedFile, ReportError, ReportPlan, Scaling, measure};
use indicatif::{ProgressBar, ProgressStyle};

/// Measures what flat, Gouraud and Phong shading cost and lose, and writes a page, tables and drawings of it.
///
/// Nothing is written before all is measured, and each file appears only when it is complete.
#[derive(Debug, Parser)]
#[command(name = "halfway-chart", version, max_term_width = 100)]
#[command(
    after_help = "Exit codes: 0 done; 1 it failed; 2 the command line cannot be used; 3 the adapter that is asked for is not there."
)]
struct Arguments {
    /// Fewer tessellations, rounds, frames and pixels
    #[arg(long)]
    quick: bool,
    /// Only how the time of a frame grows with triangles, objects, lights and pixels; the page is scaling.html
    #[arg(long, conflicts_with = "small_chart")]
    scaling: bool,
    /// The folder for the page and what belongs to it
    #[arg(short, long, value_name = "FOLDER", default_value = "out/chart")]
    output: PathBuf,
    /// Also write the main chart in small, an SVG file
    #[arg(long, value_name = "FILE")]
    small_chart: Option<PathBuf>,
}

fn main() -> ExitCode {
    env_logger::Builder::from_env(env_logger::Env::default().default_filter_or("warn,wgpu_hal=off"))
        .format_timestamp(None)
        .init();
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(exit_code(&error))
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), ReportError> {
    let plan = if arguments.quick { ReportPlan::QUICK } else { ReportPlan::FULL };
    let bar = progress_bar(if arguments.scaling { plan.scaling.units() } else { plan.units() });
    let tell = &mut |done, what: &str| {
        bar.set_position(done);
        bar.set_message(what.to_owned());
    };
    if arguments.scaling {
        let scaling = Scaling::measure(plan.scaling, &mut MeasureProgress::new(tell))?;
        bar.finish_and_clear();
        return write_all(arguments, scaling.files()?);
    }
    let report = measure(plan, tell)?;
    bar.finish_and_clear();
    write_all(arguments, report.files()?)?;
    if let Some(file) = &arguments.small_chart {
        write_and_tell(file, &report.small_chart()?)?;
    }
    Ok(())
}

fn write_all(arguments: &Arguments, files: Vec<NamedFile>) -> Result<(), ReportError> {
    files.into_iter().try_for_each(|(name, content)| write_and_tell(&arguments.output.join(name), &content))
}

fn write_and_tell(file: &Path, content: &str) -> Result<(), ReportError> {
    write_text(file, content)?;
    println!("{}", file.display());
    Ok(())
}

/// A bar on standard error, with the time left; hidden where standard error is no terminal.
fn progress_bar(units: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} %, {eta} left: {msg}");
    ProgressBar::new(units).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

fn exit_code(error: &ReportError) -> u8 {
    match error {
        ReportError::Measure(MeasureError::Render(RenderError::NoAdapter | RenderError::NoDevice { .. })) => 3,
        _ => 1,
    }
}
