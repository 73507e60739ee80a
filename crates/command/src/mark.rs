//! `halfway mark`.

use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use halfway::prelude::*;
use halfway::reference::marking::{ExamineError, Report, Rubric, examine};
use halfway::scene::options::remove_what_is_laid_over;

use crate::drawing::{DrawingArgs, SizeArgs};
use crate::failure::{DIFFERENT, Failure, STOPPED};
use crate::figures;
use crate::input::SceneInput;
use crate::progress::Progress;
use crate::verify::{Given, text};

#[derive(Args, Debug)]
pub(crate) struct MarkArgs {
    #[command(flatten)]
    drawing: DrawingArgs,
    #[command(flatten)]
    size: SizeArgs,
    /// The picture that is marked, a PNG or EXR of the scene's first moment; its size is used
    #[arg(long, value_name = "FILE")]
    picture: PathBuf,
    /// The points for right pictures and those that mistakes take away, a JSON file [default: 100 points, 20 lost by each
    /// mistake, at most 50 without an explanation]
    #[arg(long, value_name = "FILE")]
    rubric: Option<PathBuf>,
    /// The most steps of 1/255 by which a pixel of a picture of bytes may differ from every colour that it may show
    #[arg(long, value_name = "STEPS", default_value_t = 1)]
    max: u8,
    /// Print JSON instead of lines: halfway's own, or as Gradescope and Submitty read it
    #[arg(long, value_name = "FORMAT", num_args = 0..=1, require_equals = true, default_missing_value = "halfway")]
    json: Option<ReportFormat>,
}

/// The keys of the JSON.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum ReportFormat {
    /// All that is known
    Halfway,
    /// results.json of a Gradescope autograder
    Gradescope,
    /// The output of a custom validator of Submitty
    Submitty,
}

pub(crate) fn run(args: &MarkArgs) -> Result<(), Failure> {
    args.drawing.input.without_picture()?;
    let rubric = args.rubric.as_deref().map_or_else(|| Ok(Rubric::default()), read_rubric)?;
    let mut input = SceneInput::read(&args.drawing, &args.drawing.options())?;
    if remove_what_is_laid_over(&mut input.scene) {
        eprintln!("note: marked without lines along edges and before an opaque background of one colour");
    }
    if !input.sharing().is_empty() {
        let file = input.name();
        return Err(format!("{file}: several cameras share the picture; expected --camera with the one to mark").into());
    }
    let report = report(args, input, &args.picture, &rubric)?;
    match args.json {
        None => print!("{report}"),
        Some(ReportFormat::Halfway) => {
            let mut json = report.to_json();
            json["verdict"] = figures::verdict(&report.examined.verdict);
            println!("{json}");
        }
        Some(ReportFormat::Gradescope) => println!("{}", report.to_gradescope()),
        Some(ReportFormat::Submitty) => println!("{}", report.to_submitty()),
    }
    if report.examined.passes() {
        Ok(())
    } else {
        let (file, marked) = (&report.picture, report.marked());
        Err(Failure::new(DIFFERENT, format!("{file}: differs from the scene; {marked}")))
    }
}

fn report(args: &MarkArgs, input: SceneInput, file: &Path, rubric: &Rubric) -> Result<Report, Failure> {
    let encoding = input.scene.output;
    let Given { mut app, actual, size, bars } = Given::new(input, file, args.size, args.max)?;
    let progress = Progress::for_tiles(1);
    let told = |done: u32, of: u32| progress.tile(0, done, of);
    let examined = examine(app.world_mut(), &actual, encoding, bars, &told).map_err(|error| match error {
        ExamineError::Stopped(stopped) => Failure::new(STOPPED, stopped),
        other => text(other),
    })?;
    drop(progress);
    Ok(Report::new(file.display().to_string(), size.to_array(), examined, rubric))
}

fn read_rubric(file: &Path) -> Result<Rubric, Failure> {
    let name = file.display();
    let text = fs::read_to_string(file).map_err(|error| format!("{name}: cannot be read: {error}"))?;
    Rubric::from_json(&text).map_err(|error| format!("{name}: {error}").into())
}
