//! `halfway chart`.

use std::path::{Path, PathBuf};

use clap::builder::NonEmptyStringValueParser;
use clap::{Args, ValueEnum};
use halfway::output::write_text;
use halfway::prelude::*;
use halfway::render::AdapterChoice;
use halfway_chart::failures;
use halfway_chart::filters::{FilterPlan, Filters};
use halfway_chart::front::{ChartedAdapter, ChartedScene, FrontFilter, FrontPlan, Fronts, Method, scenes};
use halfway_chart::page::{NamedFile, Page};
use halfway_chart::timing::{Machine, TimedShading};
use halfway_chart::{ChartError, Progress, Report};

use crate::failure::Failure;
use crate::input::SceneInput;
use crate::progress::Bar;
use crate::scenery::{Benchmark, BenchmarkScene};

#[derive(Args, Debug)]
pub(crate) struct ChartArgs {
    /// The subject: a scene file, a model, or a scene of the project's by its name (sphere, teapot,
    /// teapot-by-phong, scan, s3) [default: all of the project's, and with them distant lights and viewers, and known
    /// failure modes]
    #[arg(value_name = "SCENE|MODEL")]
    inputs: Vec<PathBuf>,
    /// The folder for the page and its files
    #[arg(short, long, value_name = "FOLDER", default_value = "out/chart")]
    output: PathBuf,
    /// Fewer methods, details, rounds and pixels
    #[arg(long)]
    quick: bool,
    /// Only the cost and the error of texture filters; the page is filters.html
    #[arg(long, conflicts_with_all = ["inputs", "small_chart", "method", "detail", "adapter"])]
    filters: bool,
    /// Only the pages of known failure modes, with an index.html that links them; or as chapters of a book, in Markdown
    #[arg(long, value_enum, value_name = "FORM", num_args = 0..=1, require_equals = true, default_missing_value = "pages")]
    #[arg(conflicts_with_all = ["inputs", "quick", "filters", "small_chart", "tables", "method", "detail"])]
    failures: Option<FailureForm>,
    /// Only this method, by the name that the page gives it, such as gouraud or phong-infinite-viewer; several times
    /// for several
    #[arg(id = "method", long = "method", value_name = "NAME")]
    methods: Vec<String>,
    /// Only this detail, by the name that the page gives it: a number of cells, 1-of-16 or full, say
    #[arg(long, value_name = "NAME")]
    detail: Option<String>,
    /// The renderer, as `halfway adapters` lists them; several times for several [default: that of the other commands]
    #[arg(long = "adapter", value_name = "NAME", value_parser = NonEmptyStringValueParser::new())]
    adapters: Vec<String>,
    /// Also write the fronts of sphere, teapot and scan in small, an SVG file
    #[arg(long, value_name = "FILE")]
    small_chart: Option<PathBuf>,
    /// Also write the tables of the page, a Markdown file
    #[arg(long, value_name = "FILE")]
    tables: Option<PathBuf>,
}

/// How the known failure modes are written.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum FailureForm {
    Pages,
    Chapters,
}

pub(crate) fn run(args: &ChartArgs) -> Result<(), Failure> {
    if args.filters {
        let plan = if args.quick { FilterPlan::QUICK } else { FilterPlan::FULL };
        let found = with_progress(plan.units(), |progress| Filters::measure(plan, progress))?;
        return write(args, &[found.page()]);
    }
    if let Some(form) = args.failures {
        let adapters = adapters(&args.adapters)?;
        let found = with_progress(failures::PAGES, |progress| {
            failures::all(&adapters, |page| progress.advance(1, page.title))
        })?;
        return match form {
            FailureForm::Pages => write(args, &failures::pages(&found)?),
            FailureForm::Chapters => found.iter().try_for_each(|page| write_all(&args.output, page.chapter()?)),
        };
    }
    let only = FrontFilter { methods: args.methods.clone(), detail: args.detail.clone() };
    let plan = FrontPlan { only, ..if args.quick { FrontPlan::QUICK } else { FrontPlan::FULL } };
    let scenes = charted(&args.inputs)?;
    check_filter(&plan, &scenes)?;
    let adapters = adapters(&args.adapters)?;
    let (pages, fronts) = if args.inputs.is_empty() && plan.only == FrontFilter::default() {
        let units = Report::units(&plan, &scenes, adapters.len());
        let report = with_progress(units, |progress| Report::measure(&plan, &scenes, &adapters, progress))?;
        (report.pages()?, report.fronts)
    } else {
        let units = plan.units(&scenes, adapters.len());
        let fronts = with_progress(units, |progress| Fronts::measure(&plan, &scenes, &adapters, progress))?;
        fronts.scenes.iter().flat_map(|scene| fronts.advice(scene)).for_each(|advice| println!("{advice}"));
        (vec![fronts.page()], fronts)
    };
    if let Some(file) = &args.small_chart {
        write_and_report(file, &fronts.small_chart(&["sphere", "teapot", "scan"]))?;
    }
    write(args, &pages)
}

/// Writes the pages with their files, and the tables of the first.
fn write(args: &ChartArgs, pages: &[Page]) -> Result<(), Failure> {
    write_all(&args.output, pages.iter().flat_map(Page::files))?;
    match (&args.tables, pages) {
        (Some(file), [first, ..]) => write_and_report(file, &first.markdown()),
        _ => Ok(()),
    }
}

/// The scenes of the command line.
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
            None => all.push(from_file(input)?),
        }
    }
    Ok(all)
}

/// A scene file or a model.
fn from_file(file: &Path) -> Result<ChartedScene, Failure> {
    let mut input = SceneInput::open(file)?;
    halfway::scene::options::remove_what_is_laid_over(&mut input.scene);
    let size = UVec2::from_array(input.scene.size);
    // Errors are reported now, before measuring begins.
    input.spawn(App::new().add_plugins(HalfwayPlugins::reference()))?;
    let about = format!("the scene of {}, at its first moment", input.name());
    let scene = ChartedScene::from_meshes(
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
    let look = TimedShading::Shaded(Shading::Phong);
    let build = Box::new(move |app: &mut App, _| {
        app.add_plugins(Benchmark { scene, look, octahedra: false });
        Ok(())
    });
    ChartedScene { size: UVec2::new(640, 360), ..ChartedScene::from_meshes("s3", about, build) }
}

/// Checks that every name of the command line is one of something that can be measured.
fn check_filter(plan: &FrontPlan, scenes: &[ChartedScene]) -> Result<(), Failure> {
    for scene in scenes {
        let known = plan.methods_of(scene).len();
        if known < plan.only.methods.len().max(1) {
            let names: Vec<String> = Method::all(scene.reflectance).into_iter().map(Method::id).collect();
            return Err(format!("--method: {} is drawn with {}", scene.name, names.join(", ")).into());
        }
        if plan.details_of(scene).is_empty() {
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

fn write_all(folder: &Path, files: impl IntoIterator<Item = NamedFile>) -> Result<(), Failure> {
    files.into_iter().try_for_each(|(name, content)| write_and_report(&folder.join(name), &content))
}

fn write_and_report(file: &Path, content: &str) -> Result<(), Failure> {
    write_text(file, content)?;
    println!("{}", file.display());
    Ok(())
}

/// Measures with a progress bar on standard error.
fn with_progress<T>(
    units: u64,
    measure: impl FnOnce(&mut Progress<'_>) -> Result<T, ChartError>,
) -> Result<T, Failure> {
    let bar = Bar::new();
    Ok(measure(&mut Progress::new(&mut |done, what: &str| bar.show(done, units, what)))?)
}

impl From<ChartError> for Failure {
    fn from(error: ChartError) -> Self {
        match error {
            ChartError::Render(error) => error.into(),
            other => Self::new(1, other),
        }
    }
}
