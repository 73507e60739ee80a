//! `halfway chart`.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::NonEmptyStringValueParser;
use halfway::output::write_text;
use halfway::prelude::*;
use halfway::render::AdapterChoice;
use halfway_chart::filters::FilterPlan;
use halfway_chart::front::{ChartedAdapter, ChartedScene, FrontFilter, KeptResults, Method, scenes};
use halfway_chart::measure::{MeasureError, MeasureProgress};
use halfway_chart::timing::{Machine, TimedLook};
use halfway_chart::{EarlierRun, Filters, Fronts, NamedFile, ReportError, ReportPlan, Scaling, measure};
use indicatif::{ProgressBar, ProgressStyle};

use crate::failure::{DIFFERENT, Failure};
use crate::input::SceneInput;
use crate::scenery::{Benchmark, BenchmarkScene};

#[derive(Args, Debug)]
pub(crate) struct ChartArgs {
    /// What is charted: a scene file, a model, or a scene of the project's by its name (sphere, sphere-by-phong,
    /// teapot, teapot-by-phong, machine-part, terrain, scan, moving-lights, s3) [default: all of the project's, and
    /// with them rates of convergence, a moving highlight, and how the time of a frame grows]
    #[arg(value_name = "SCENE|MODEL")]
    inputs: Vec<PathBuf>,
    /// The folder for the page and what belongs to it
    #[arg(short, long, value_name = "FOLDER", default_value = "out/chart")]
    output: PathBuf,
    /// Fewer methods, details, rounds and pixels
    #[arg(long)]
    quick: bool,
    /// Only how the time of a frame grows with triangles, objects, lights and pixels; the page is scaling.html
    #[arg(long, conflicts_with_all = ["inputs", "small_chart", "tables", "method", "detail"])]
    scaling: bool,
    /// Only what filters of images cost and lose; the page is filters.html
    #[arg(long, conflicts_with_all = ["inputs", "small_chart", "scaling", "method", "detail", "adapter"])]
    filters: bool,
    /// Only this method, by the name that the page gives it, such as gouraud or phong-infinite-viewer; several times
    /// for several
    #[arg(id = "method", long = "method", value_name = "NAME")]
    methods: Vec<String>,
    /// Only this detail, by the name that the page gives it: a number of cells, 1-of-16, levels or full, say
    #[arg(long, value_name = "NAME")]
    detail: Option<String>,
    /// What draws, as `halfway adapters` lists them; several times for several [default: what the other commands draw
    /// with]
    #[arg(long = "adapter", value_name = "NAME", value_parser = NonEmptyStringValueParser::new())]
    adapters: Vec<String>,
    /// Also write the fronts of sphere, teapot and scan in small, an SVG file
    #[arg(long, value_name = "FILE")]
    small_chart: Option<PathBuf>,
    /// Also write what wins where, and what each error costs, for every scene (with --filters, for every image), a
    /// Markdown file
    #[arg(long, value_name = "FILE")]
    tables: Option<PathBuf>,
    /// Also compare the fronts with those of an earlier run, its chart.json: exit code 4 where a point is on the front
    /// of one and clearly beaten in the other
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scaling", "filters"])]
    against: Option<PathBuf>,
}

/// What is measured while a run goes on, so that an interrupted one resumes; gone at its end.
const UNFINISHED: &str = "unfinished.jsonl";

pub(crate) fn run(args: &ChartArgs) -> Result<(), Failure> {
    let mut plan = if args.quick { ReportPlan::QUICK } else { ReportPlan::FULL };
    plan.fronts.only = FrontFilter { methods: args.methods.clone(), detail: args.detail.clone() };
    if args.filters {
        return filters(args);
    }
    if args.scaling {
        let bar = progress_bar(plan.scaling.units());
        let found = Scaling::measure(plan.scaling, &mut MeasureProgress::new(&mut tell(&bar)));
        bar.finish_and_clear();
        return write_all(&args.output, found.map_err(ReportError::from)?.files()?);
    }
    // It may lie where this run writes.
    let earlier = args.against.as_deref().map(earlier).transpose()?;
    let scenes = charted(&args.inputs)?;
    check_filter(&plan, &scenes)?;
    let adapters = adapters(&args.adapters)?;
    let unfinished = args.output.join(UNFINISHED);
    let machines: Vec<String> = adapters.iter().map(|one| format!("{:?}", Machine::new(&one.adapter))).collect();
    let mut kept = KeptResults::open(&unfinished, &machines.join(", "))?;
    let everything = args.inputs.is_empty() && args.methods.is_empty() && args.detail.is_none();
    let units =
        if everything { plan.units(&scenes, adapters.len()) } else { plan.fronts.units(&scenes, adapters.len()) };
    let bar = progress_bar(units);
    let tell = &mut tell(&bar);
    let (files, fronts) = if everything {
        let report = measure(&plan, &scenes, &adapters, &mut kept, tell)?;
        (report.files()?, report.fronts)
    } else {
        let progress = &mut MeasureProgress::new(tell);
        let fronts =
            Fronts::measure(&plan.fronts, &scenes, &adapters, &mut kept, progress).map_err(ReportError::from)?;
        (fronts.files()?, fronts)
    };
    bar.finish_and_clear();
    write_all(&args.output, files)?;
    if let Some(file) = &args.small_chart {
        write_and_tell(file, &fronts.small_chart(&["sphere", "teapot", "scan"])?)?;
    }
    if let Some(file) = &args.tables {
        write_and_tell(file, &fronts.markdown())?;
    }
    // All of it is on the page now.
    let _ = fs::remove_file(unfinished);
    if !everything {
        fronts.scenes.iter().flat_map(|scene| fronts.advice(scene)).for_each(|advice| println!("{advice}"));
    }
    earlier.map_or(Ok(()), |earlier| agree(&fronts, &earlier))
}

/// The run that `--against` names.
fn earlier(file: &Path) -> Result<EarlierRun, Failure> {
    let told = |error: String| Failure::from(format!("{}: {error}", file.display()));
    let text = fs::read_to_string(file).map_err(|error| told(error.to_string()))?;
    EarlierRun::read(&text).map_err(told)
}

/// Says where the fronts of two runs differ by more than ties.
fn agree(fronts: &Fronts, earlier: &EarlierRun) -> Result<(), Failure> {
    let told = fronts.disagreements(earlier);
    for line in &told {
        println!("{line}");
    }
    if told.is_empty() {
        println!("the fronts of both runs agree but for ties");
        return Ok(());
    }
    let lines = format!("{} points are on the front of one run and clearly beaten in the other", told.len());
    Err(Failure::new(DIFFERENT, lines))
}

/// Measures filters of images alone.
fn filters(args: &ChartArgs) -> Result<(), Failure> {
    let plan = if args.quick { FilterPlan::QUICK } else { FilterPlan::FULL };
    let bar = progress_bar(plan.units());
    let found = Filters::measure(plan, &mut MeasureProgress::new(&mut tell(&bar)));
    bar.finish_and_clear();
    let found = found.map_err(ReportError::from)?;
    write_all(&args.output, found.files()?)?;
    args.tables.as_ref().map_or(Ok(()), |file| write_and_tell(file, &found.markdown()))
}

/// The scenes that the command line means.
fn charted(inputs: &[PathBuf]) -> Result<Vec<ChartedScene>, Failure> {
    let mut ours = scenes::all();
    ours.push(s3());
    if inputs.is_empty() {
        return Ok(ours);
    }
    let mut all = Vec::new();
    for input in inputs {
        match ours.iter().position(|scene| Path::new(&scene.name) == input) {
            Some(place) => all.push(ours.remove(place)),
            None => all.push(of_file(input)?),
        }
    }
    Ok(all)
}

/// A scene file or a model.
fn of_file(file: &Path) -> Result<ChartedScene, Failure> {
    let input = SceneInput::open(file)?;
    let size = UVec2::from_array(input.scene.size);
    // What is wrong with it is said now, and not once measuring has begun.
    input.spawn(App::new().add_plugins(HalfwayPlugins::reference()))?;
    let about = format!("the scene of {}, at its first moment", input.name());
    let scene = ChartedScene::of_meshes(
        &file.to_string_lossy(),
        &about,
        Box::new(move |app, _| {
            input
                .spawn(app)
                .map(drop)
                .map_err(|failure| failure.error.map_or_else(String::new, |error| error.to_string()))
        }),
    );
    Ok(ChartedScene { size, ..scene })
}

/// The third benchmark scene, whose lights move.
fn s3() -> ChartedScene {
    let about = "400 spheres on a plane among 256 lights that move with every frame: the benchmark scene S3";
    let scene = BenchmarkScene::S3;
    let look = TimedLook::Shaded(Shading::Phong);
    let build = Box::new(move |app: &mut App, _| {
        app.add_plugins(Benchmark { scene, look, octahedra: false });
        Ok(())
    });
    ChartedScene { size: UVec2::new(640, 360), ..ChartedScene::of_meshes("s3", about, build) }
}

/// Whether every name of the command line is one of something that can be measured.
fn check_filter(plan: &ReportPlan, scenes: &[ChartedScene]) -> Result<(), Failure> {
    for scene in scenes {
        let known = plan.fronts.methods_of(scene).len();
        if known < plan.fronts.only.methods.len().max(1) {
            let names: Vec<String> = Method::all(scene.reflectance).into_iter().map(Method::id).collect();
            return Err(format!("--method: {} is drawn with {}", scene.name, names.join(", ")).into());
        }
        if plan.fronts.details_of(scene).is_empty() {
            let names: Vec<String> = scene.details.iter().map(|detail| detail.id()).collect();
            return Err(format!("--detail: {} is drawn with {}", scene.name, names.join(", ")).into());
        }
    }
    Ok(())
}

fn adapters(names: &[String]) -> Result<Vec<ChartedAdapter>, Failure> {
    let open = |name: &String| {
        let adapter = AdapterChoice::named(name).open()?;
        Ok(ChartedAdapter { name: name.clone(), adapter })
    };
    if names.is_empty() {
        let adapter = AdapterChoice::default().open()?;
        let name = Machine::new(&adapter).backend;
        return Ok(vec![ChartedAdapter { name, adapter }]);
    }
    names.iter().map(open).collect()
}

fn write_all(folder: &Path, files: Vec<NamedFile>) -> Result<(), Failure> {
    files.into_iter().try_for_each(|(name, content)| write_and_tell(&folder.join(name), &content))
}

fn write_and_tell(file: &Path, content: &str) -> Result<(), Failure> {
    write_text(file, content)?;
    println!("{}", file.display());
    Ok(())
}

fn tell(bar: &ProgressBar) -> impl FnMut(u64, &str) {
    |done, what: &str| {
        bar.set_position(done);
        bar.set_message(what.to_owned());
    }
}

/// A bar on standard error, with the time left; hidden where standard error is no terminal.
fn progress_bar(units: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} %, {eta} left: {msg}");
    ProgressBar::new(units).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

impl From<ReportError> for Failure {
    fn from(error: ReportError) -> Self {
        match error {
            ReportError::Measure(MeasureError::Render(error)) => error.into(),
            ReportError::Output(error) => error.into(),
            other => Self::new(1, other),
        }
    }
}
