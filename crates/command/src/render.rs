//! `halfway render`.

use std::ops::Range;
use std::path::PathBuf;

use clap::Args;
use halfway::lighting::{Choices, Term};
use halfway::output::ContactSheet;
use halfway::prelude::*;
use halfway::record::{FrameToDraw, RecordError, Recording, ReferenceDrawing, record_with};
use halfway::reference::Mode;
use halfway::render::Adapter;
use halfway::scene::options::{SceneOptions, Views, views};
use halfway::scene::{PartOfLight, SceneTime, Turntable, outline};

use crate::drawing::{DrawingArgs, SizeArgs};
use crate::empty::warn_if_empty;
use crate::failure::Failure;
use crate::input::SceneInput;
use crate::progress::Progress;

#[derive(Args, Debug)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    drawing: DrawingArgs,
    /// The picture: .png, .jpg, .webp or .exr; of several frames an animated PNG, or one file a frame if the name has a
    /// {}; - writes to standard output, a PNG unless --format says otherwise
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    size: SizeArgs,
    /// Frames A to B − 1 of the scene's animation, frame f at f/--fps seconds; with --turntable, of the turn
    #[arg(long, value_name = "A..B", value_parser = parse_frames)]
    frames: Option<Range<u32>>,
    /// Turn the camera once around the upright axis of the scene, or --up, in N frames
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_FRAMES)))]
    turntable: Option<u32>,
    /// Frames a second [default: 30]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    fps: Option<u16>,
    /// Draw the scene's animation at T seconds
    #[arg(long, value_name = "T", value_parser = parse_time, conflicts_with_all = ["frames", "turntable"])]
    time: Option<f64>,
    /// Several views on one sheet with captions, each of --size, such as front,right,top,iso; with --ortho at one scale
    #[arg(long, value_name = "LIST", value_parser = views, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["view", "frames", "turntable", "time", "also", "contact_sheet"])]
    views: Option<Views>,
    /// Bits a channel: 8 or 16 in a PNG, 32 in an EXR [default: 8; 32]
    #[arg(long)]
    bits: Option<u32>,
    /// Also write a contact sheet of up to 16 of the frames, a PNG
    #[arg(long, value_name = "FILE")]
    contact_sheet: Option<PathBuf>,
    /// Also write what the picture shows beside colour, each quantity to a .exr or .png; in one .exr they are layers; or
    /// a term of the light alone, such as diffuse=d.exr
    #[arg(long, value_name = "QUANTITY=FILE,…", value_delimiter = ',', value_parser = parse_also)]
    also: Vec<(Also, PathBuf)>,
    /// Draw with the reference renderer: every pixel in 64-bit arithmetic on the CPU, without a graphics adapter
    #[arg(long, conflicts_with = "adapter")]
    reference: bool,
    /// Draw spheres, teapots and other surfaces that are known by formula exactly, in place of their triangles
    #[arg(long, requires = "reference")]
    surface: bool,
    /// N × N samples a pixel, 1 to 16 [default: as many as the scene has]
    #[arg(long, value_name = "N", requires = "reference", value_parser = clap::value_parser!(u32).range(1..=16))]
    supersample: Option<u32>,
}

/// A picture beside that of the colours.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Also {
    Quantity(Quantity),
    Term(Term),
}

impl RenderArgs {
    fn quantities(&self) -> Vec<(Quantity, PathBuf)> {
        let quantity = |(also, file): &(Also, PathBuf)| match also {
            Also::Quantity(quantity) => Some((*quantity, file.clone())),
            Also::Term(_) => None,
        };
        self.also.iter().filter_map(quantity).collect()
    }

    /// The terms that are drawn alone, with their files.
    fn terms(&self) -> Result<Vec<(Term, &PathBuf)>, Failure> {
        let mut terms = Vec::new();
        for (number, (also, file)) in self.also.iter().enumerate() {
            let Also::Term(term) = also else { continue };
            if self.frames.is_some() || self.turntable.is_some() {
                let name = term.choice().map_or("", |choice| choice.key);
                return Err(format!("--also {name}: a term is drawn of one picture; expected --only {name}").into());
            }
            let is_shared = self.also.iter().enumerate().any(|(other, (_, taken))| other != number && taken == file);
            if is_shared || *file == self.output {
                return Err(format!("--also: {}: a term has a file of its own", file.display()).into());
            }
            terms.push((*term, file));
        }
        Ok(terms)
    }
}

/// The renderer of the frames.
enum Drawer {
    Adapter(Adapter),
    Reference(ReferenceDrawing),
}

impl Drawer {
    /// The adapter, unless the command line wants the reference renderer.
    fn choose(args: &RenderArgs) -> Result<Self, Failure> {
        let mode = if args.surface { Mode::Surface } else { Mode::Mesh };
        let reference = ReferenceDrawing { mode, supersampling: args.supersample };
        if args.reference {
            return Ok(Self::Reference(reference));
        }
        Ok(Self::Adapter(args.drawing.adapter.choice().open()?))
    }

    fn app(&self, size: UVec2) -> App {
        let mut app = App::new();
        match self {
            Self::Adapter(adapter) => {
                app.add_plugins(HalfwayPlugins::headless(size));
                adapter.clone().insert_into(app.world_mut());
            }
            Self::Reference(_) => {
                app.add_plugins(HalfwayPlugins::reference());
            }
        }
        app
    }

    /// Records the frames; the first one of all shows the scene at `time`, in seconds.
    fn record(&self, app: &mut App, recording: &Recording, time: f64) -> Result<(), Failure> {
        let frames = recording.frames.len() as u32;
        let set_time = |app: &mut App, frame: FrameToDraw| {
            app.insert_resource(SceneTime::At(time + f64::from(frame.number) / f64::from(recording.rate)));
        };
        let progress = match self {
            Self::Adapter(_) => Progress::for_frames(frames),
            Self::Reference(_) => Progress::for_tiles(frames),
        };
        let mut is_first = true;
        let draw = |app: &mut App, frame: FrameToDraw| {
            set_time(app, frame);
            let picture = self.picture(app, frame, frame.number.saturating_sub(recording.frames.start), &progress)?;
            if std::mem::take(&mut is_first) {
                warn_if_empty(app, &picture);
            }
            Ok(picture)
        };
        record_with(app, recording, draw, |done, _| match self {
            Self::Adapter(_) => progress.frame(done),
            Self::Reference(_) => progress.going_on(),
        })?;
        Ok(())
    }

    /// One picture, the `index`th that progress is reported of.
    fn picture(
        &self,
        app: &mut App,
        frame: FrameToDraw,
        index: u32,
        progress: &Progress,
    ) -> Result<Picture, RecordError> {
        match self {
            Self::Adapter(_) => Ok(render_picture(app)?),
            Self::Reference(drawing) => drawing.picture(app, frame, &|done, of| progress.tile(index, done, of)),
        }
    }
}

pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let options = args.drawing.options();
    let terms = args.terms()?;
    let mut input = SceneInput::read(&args.drawing, &options)?;
    if !terms.is_empty() && input.scene.only.is_some() {
        return Err("--also: the picture has one term only; expected none of --only and the scene's `only`"
            .to_owned()
            .into());
    }
    let size = input.resize(args.size);
    if args.views.is_some() || args.turntable.is_some() {
        input.see_alone();
    }
    let turn = args.turntable.map(|frames| 0..frames);
    let frames = args.frames.clone().or(turn);
    if args.fps.is_some() && frames.is_none() {
        return Err("--fps: expected --frames or --turntable beside it".to_owned().into());
    }
    let recording = Recording {
        frames: frames.unwrap_or(0..1),
        rate: args.fps.unwrap_or(30),
        size,
        bits: args.bits,
        format: args.drawing.input.picture_format().map(str::to_owned),
        contact_sheet: args.contact_sheet.clone(),
        also: args.quantities(),
        ..Recording::new(args.output.clone())
    };
    let drawer = Drawer::choose(args)?;
    let mut app = drawer.app(size);
    let is_one = recording.frames.len() == 1 && args.views.is_none() && args.also.is_empty();
    let spawned = if is_one { input.spawn_once(&mut app)? } else { input.spawn(&mut app)? };
    if let Some(views) = &args.views {
        return draw_sheet(&options, views, &recording, &drawer, (&mut app, spawned.camera));
    }
    if let Some(frames) = args.turntable {
        let up = options.upright(&input.scene);
        Turntable::turn(&mut app, spawned.camera, up, std::f32::consts::TAU / frames as f32);
    } else if !spawned.is_animated {
        let still = |option: &str| format!("{option}: {} has no animation", input.name());
        if args.frames.is_some() {
            return Err(format!("{}; --turntable N turns the camera around it", still("--frames")).into());
        }
        if args.time.is_some() {
            return Err(still("--time").into());
        }
    }
    let time = args.time.unwrap_or(0.0);
    drawer.record(&mut app, &recording, time)?;
    for (term, file) in terms {
        spawned.show_light(PartOfLight { term: Some(term), ..spawned.part }, app.world_mut());
        let alone = Recording { path: file.clone(), also: Vec::new(), contact_sheet: None, ..recording.clone() };
        drawer.record(&mut app, &alone, time)?;
    }
    Ok(())
}

/// The most frames.
const MOST_FRAMES: u32 = 100_000;

/// Draws several views on one sheet.
fn draw_sheet(
    options: &SceneOptions,
    views: &Views,
    recording: &Recording,
    drawer: &Drawer,
    (app, camera): (&mut App, Entity),
) -> Result<(), Failure> {
    let (size, pixels) = (recording.size, Pixels::Byte);
    if recording.format_of(0)?.pixels() != pixels {
        let file = recording.path.display();
        return Err(format!("{file}: a sheet of views has 8 bits a channel; expected a PNG of 8 bits, say").into());
    }
    app.insert_resource(bevy_time::TimeUpdateStrategy::ManualDuration(std::time::Duration::ZERO));
    app.insert_resource(Headless { size, pixels });
    app.finish();
    app.cleanup();
    let points = outline(app.world_mut());
    let base = app.world().get::<Camera>(camera).copied().unwrap_or_default();
    let progress = Progress::for_tiles(1);
    let mut sheet = ContactSheet::new(views.columns(), size.x, base.encoding);
    for (number, (caption, seen, place)) in (0..).zip(views.cameras(options, base, &points, size)) {
        app.world_mut().entity_mut(camera).insert((seen, place));
        let picture = drawer.picture(app, FrameToDraw { number, size, pixels }, 0, &progress)?;
        warn_if_empty(app, &picture);
        sheet.push_with_caption(&picture, &caption);
    }
    drop(progress);
    Ok(recording.write(0, &sheet.picture(), base.encoding)?)
}

fn parse_frames(text: &str) -> Result<Range<u32>, String> {
    text.split_once("..")
        .and_then(|(start, end)| Some(start.trim().parse().ok()?..end.trim().parse().ok()?))
        .filter(|frames: &Range<u32>| !frames.is_empty() && frames.end <= MOST_FRAMES)
        .ok_or_else(|| format!("expected A..B with A below B and B at most {MOST_FRAMES}, such as 0..120"))
}

pub(crate) fn parse_time(text: &str) -> Result<f64, String> {
    let time = text.trim().parse().ok().filter(|time: &f64| time.is_finite() && *time >= 0.0);
    time.ok_or_else(|| "expected seconds, 0 or more, such as 1.5".to_owned())
}

fn parse_also(text: &str) -> Result<(Also, PathBuf), String> {
    let expected = || {
        let quantities = Quantity::CHOICES.iter().map(|choice| choice.key.replace('_', "-"));
        let terms = Term::CHOICES.iter().map(|choice| choice.key.to_owned());
        let all = quantities.chain(terms).collect::<Vec<_>>().join(", ");
        format!("expected QUANTITY=FILE, such as depth=depth.exr, of the quantities {all}")
    };
    let (key, file) = text.split_once('=').filter(|(_, file)| !file.is_empty()).ok_or_else(expected)?;
    let key = key.replace('-', "_");
    let also = Quantity::from_key(&key).map(Also::Quantity).or_else(|| Term::from_key(&key).map(Also::Term));
    Ok((also.ok_or_else(expected)?, file.into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_with_their_files() {
        assert_eq!(parse_also("depth=out/d.exr"), Ok((Also::Quantity(Quantity::Depth), "out/d.exr".into())));
        assert_eq!(parse_also("eye-normal=n.png"), Ok((Also::Quantity(Quantity::EyeNormal), "n.png".into())));
        assert_eq!(parse_also("diffuse=d.png"), Ok((Also::Term(Term::Diffuse), "d.png".into())));
        for bad in ["", "depth", "depth=", "Depth=d.exr", "=d.exr", "colour=c.exr"] {
            assert!(parse_also(bad).is_err_and(|error| error.contains("depth, distance")), "{bad}");
        }
    }

    #[test]
    fn times() {
        assert_eq!(parse_time("1.5"), Ok(1.5));
        for bad in ["", "-1", "inf", "nan", "1s"] {
            assert!(parse_time(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn frame_ranges() {
        assert_eq!(parse_frames("0..120"), Ok(0..120));
        for bad in ["", "5", "5..5", "6..5", "0..4000000000", "-1..4", "a..b"] {
            assert!(parse_frames(bad).is_err(), "{bad}");
        }
    }
}
