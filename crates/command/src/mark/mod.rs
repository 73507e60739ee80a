//! `halfway mark`.

mod reports;
mod rubric;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use halfway::prelude::*;
use halfway::reference::marking::{Diagnosis, Marker, Rubric};
use halfway::reference::metrics::{Bars, Verdict, judge};
use halfway::reference::{Image, Oracle};
use halfway::scene::options::remove_what_is_laid_over;

use crate::drawing::{DrawingArgs, SizeArgs};
use crate::failure::{DIFFERENT, Failure, STOPPED};
use crate::input::SceneInput;
use crate::picture;
use crate::progress::Progress;
use crate::verify::{picture_size, set_up, text};

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

/// All that is said of a picture.
struct Report {
    picture: String,
    size: UVec2,
    verdict: Verdict,
    /// `None` for a picture that passes.
    diagnosis: Option<Diagnosis>,
    mark: f64,
    points: f64,
    /// The names of the objects that explanations are about.
    names: Vec<(Entity, String)>,
}

pub(crate) fn run(args: &MarkArgs) -> Result<(), Failure> {
    args.drawing.input.without_picture()?;
    let rubric = args.rubric.as_deref().map_or_else(|| Ok(Rubric::default()), rubric::read)?;
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
        None => print!("{}", reports::lines(&report)),
        Some(ReportFormat::Halfway) => println!("{}", reports::json(&report)),
        Some(ReportFormat::Gradescope) => println!("{}", reports::gradescope(&report)),
        Some(ReportFormat::Submitty) => println!("{}", reports::submitty(&report)),
    }
    if report.passes() {
        Ok(())
    } else {
        let (file, mark, points) = (&report.picture, reports::points(report.mark), reports::points(report.points));
        Err(Failure::new(DIFFERENT, format!("{file}: differs from the scene; {mark} of {points} points")))
    }
}

fn report(args: &MarkArgs, mut input: SceneInput, file: &Path, rubric: &Rubric) -> Result<Report, Failure> {
    let encoding = input.scene.output;
    let picture = picture::decoded(file)?;
    let size = picture_size(file, &picture, args.size)?;
    input.scene.size = size.to_array();
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::reference());
    set_up(&mut app, &input)?;
    app.update();

    let bars = match Bars::for_decoded(&picture, encoding) {
        bars if bars.are_clamped() => Bars { most: args.max.into(), worst: args.max.into(), ..bars },
        bars => bars,
    };
    let actual = Image::from_decoded(&picture, encoding);
    let oracle = Oracle::new(app.world_mut(), size)?.with_clamping(bars.are_clamped());
    let progress = Progress::for_tiles(1);
    let expected = oracle.draw_with(&|done, of| progress.tile(0, done, of));
    let expected = expected.map_err(|stopped| Failure::new(STOPPED, stopped))?;
    // Whether it passes is enough: the share of right pixels comes from the diagnosis.
    let verdict = judge(&oracle, &expected, &actual, bars.until_wrong()).map_err(text)?;
    drop(progress);
    let diagnosis =
        if verdict.is_within() { None } else { Some(Marker::new(&oracle, encoding).diagnose(&actual).map_err(text)?) };
    let mark = diagnosis.as_ref().map_or(rubric.points(), |diagnosis| rubric.mark(diagnosis));
    let explanations = diagnosis.iter().flat_map(|it| it.explanations.iter().chain(&it.nearest));
    let objects = explanations.filter_map(|it| it.object);
    let names = objects.filter_map(|object| {
        let name = app.world().get::<bevy_ecs::name::Name>(object)?;
        Some((object, name.to_string()))
    });
    let names = names.collect();
    Ok(Report { picture: file.display().to_string(), size, verdict, diagnosis, mark, points: rubric.points(), names })
}

impl Report {
    fn passes(&self) -> bool {
        self.diagnosis.is_none()
    }

    fn name(&self, object: Option<Entity>) -> Option<&str> {
        let object = object?;
        self.names.iter().find(|(entity, _)| *entity == object).map(|(_, name)| name.as_str())
    }
}
