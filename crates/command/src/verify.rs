//! `halfway verify`.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use clap::Args;
use halfway::prelude::*;
use halfway::reference::metrics::{Bars, Scale, Verdict, difference, judge, judge_on_grid};
use halfway::reference::{Image, Oracle};
use halfway::render::RenderError;
use halfway::scene::options::remove_what_is_laid_over;
use image::DynamicImage;

use crate::drawing::{DrawingArgs, SizeArgs};
use crate::failure::{DIFFERENT, Failure, STOPPED};
use crate::input::SceneInput;
use crate::progress::Progress;
use crate::{figures, picture};

#[derive(Args, Debug)]
pub(crate) struct VerifyArgs {
    #[command(flatten)]
    drawing: DrawingArgs,
    #[command(flatten)]
    size: SizeArgs,
    /// Draw where the 8-bit pictures differ, with a legend, into this PNG
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Judge this picture, a PNG or EXR of the scene's first moment, instead of the adapter's; its size is used
    #[arg(long, value_name = "FILE", conflicts_with_all = ["adapter", "tolerance"])]
    picture: Option<PathBuf>,
    /// Exit with code 4 if a pixel of a picture of bytes differs by more steps of 1/255 from every colour it may show
    #[arg(long, value_name = "STEPS", default_value_t = 1)]
    max: u8,
    /// Print JSON instead of lines
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &VerifyArgs) -> Result<(), Failure> {
    args.drawing.input.without_picture()?;
    let mut input = SceneInput::read(&args.drawing, &args.drawing.options())?;
    if remove_what_is_laid_over(&mut input.scene) {
        eprintln!("note: judged without lines along edges and before an opaque background of one colour");
    }
    let sharing = input.sharing();
    if !sharing.is_empty() && (args.picture.is_some() || args.output.is_some()) {
        let file = input.name();
        return Err(
            format!("{file}: several cameras share the picture; expected --camera with the one to judge").into()
        );
    }
    if let Some(file) = &args.picture {
        return judge_picture(args, input, file);
    }
    if sharing.is_empty() {
        return judge_adapter(args, input);
    }
    let mut judged = Ok(());
    for (number, name) in sharing {
        if !args.json {
            println!("camera {name}, with the picture for itself:");
        }
        judged = judged.and(judge_adapter(args, input.seen_from(number)));
    }
    judged
}

/// Judges the picture that the adapter draws.
fn judge_adapter(args: &VerifyArgs, mut input: SceneInput) -> Result<(), Failure> {
    let tolerance = args.drawing.tolerance.or(Tolerance::EXACT);
    if tolerance.pixels > 0.0 {
        let pixels = tolerance.pixels;
        let advice =
            "coarser triangles are an estimate, which cannot be judged; `halfway compare` says how far they are off";
        return Err(format!("--tolerance: {pixels} pixels; expected 0: {advice}").into());
    }
    input.scene.tolerance = Some(tolerance);
    input.scene.objects.iter_mut().for_each(|object| object.tolerance = None);
    input.scene.all_cameras_mut().for_each(|camera| camera.tolerance = None);
    let size = input.resize(args.size);
    if input.scene.samples != 1 || input.scene.all_cameras().any(|camera| camera.samples.is_some_and(|it| it != 1)) {
        eprintln!("note: judged with one sample a pixel, since adapters differ in where they take four");
    }
    input.scene.samples = 1;
    input.scene.all_cameras_mut().for_each(|camera| camera.samples = None);
    let adapter = args.drawing.adapter.choice().open()?;
    let device = adapter.describe();
    let bits = adapter.sub_pixel_bits()?;
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::headless(size));
    adapter.insert_into(app.world_mut());
    set_up(&mut app, &input)?;
    let encoding = input.scene.output;

    let progress = Progress::for_tiles(2);
    let beside_oracle = |app: &mut App, picture: &Picture, index: u32| {
        let (actual, is_clamped) = match picture {
            Picture::Byte(image) => (Image::from_bytes(image, encoding), true),
            Picture::Float(image) => (Image::from_float(image), false),
        };
        Drawn::new(app, actual, Some(bits), is_clamped, &|done, of| progress.tile(index, done, of))
    };
    let max = f64::from(args.max);
    let steps = f64::from(tolerance.steps);
    let bars = Bars { most: max, worst: max, equal: 0.0, ..Bars::bytes(encoding) }.within(steps);
    let picture = draw(&mut app, size, Pixels::Byte)?;
    let bytes = beside_oracle(&mut app, &picture, 0)?;
    let of_bytes = bytes.judged(bars)?;
    let float = match draw(&mut app, size, Pixels::Float) {
        // The bytes are judged all the same.
        Err(RenderError::FloatTarget { cannot }) => Err(cannot),
        drawn => {
            let bars = Bars::FLOAT.within(steps);
            Ok(beside_oracle(&mut app, &drawn?, 1)?.judged(bars)?)
        }
    };
    drop(progress);
    if let Err(cannot) = &float {
        eprintln!("note: not judged in floating point: of 32-bit floats the adapter cannot {cannot}");
    }
    let float = float.ok();
    bytes.write_difference(args, encoding)?;
    if args.json {
        let json = serde_json::json!({
            "device": device,
            "size": size.to_array(),
            "bytes": figures::verdict(&of_bytes),
            "float": float.as_ref().map(figures::verdict),
            "subPixelBits": bits,
        });
        println!("{json}");
    } else {
        println!("{device}, {} × {} pixels", size.x, size.y);
        println!("8 bits  {of_bytes}");
        if let Some(float) = &float {
            println!("float   {float}");
        }
    }
    verdict(args.max, &of_bytes, float.as_ref())
}

/// A picture that somebody has drawn of a scene's first moment.
pub(crate) struct Given {
    /// The App in which the oracle finds the scene.
    pub(crate) app: App,
    pub(crate) actual: Image,
    pub(crate) size: UVec2,
    /// The bars of its pixels, with `max` steps for bytes.
    pub(crate) bars: Bars,
}

impl Given {
    pub(crate) fn new(mut input: SceneInput, file: &Path, size: SizeArgs, max: u8) -> Result<Self, Failure> {
        let encoding = input.scene.output;
        let picture = picture::decoded(file)?;
        let size = picture_size(file, &picture, size)?;
        input.scene.size = size.to_array();
        let mut app = App::new();
        app.add_plugins(HalfwayPlugins::reference());
        set_up(&mut app, &input)?;
        app.update();
        let bars = match Bars::for_decoded(&picture, encoding) {
            bars if bars.are_clamped() => Bars { most: max.into(), worst: max.into(), ..bars },
            bars => bars,
        };
        Ok(Self { app, actual: Image::from_decoded(&picture, encoding), size, bars })
    }
}

/// Judges a given picture by the oracle, without an adapter.
fn judge_picture(args: &VerifyArgs, input: SceneInput, file: &Path) -> Result<(), Failure> {
    let encoding = input.scene.output;
    let Given { mut app, actual, size, bars } = Given::new(input, file, args.size, args.max)?;
    let progress = Progress::for_tiles(1);
    let told = |done: u32, of: u32| progress.tile(0, done, of);
    let drawn = Drawn::new(&mut app, actual, None, bars.are_clamped(), &told)?;
    let found = drawn.judged(bars)?;
    drop(progress);
    drawn.write_difference(args, encoding)?;
    if args.json {
        let picture = file.display().to_string();
        println!(
            "{}",
            serde_json::json!({ "picture": picture, "size": size.to_array(), "verdict": figures::verdict(&found) })
        );
    } else {
        println!("{}, {} × {} pixels", file.display(), size.x, size.y);
        println!("{found}");
    }
    if found.is_within() { Ok(()) } else { Err(Failure::new(DIFFERENT, format!("{}: {found}", file.display()))) }
}

/// The size of a given picture, which has to be the one that is asked for, if one is.
pub(crate) fn picture_size(file: &Path, picture: &DynamicImage, asked: SizeArgs) -> Result<UVec2, Failure> {
    let size = UVec2::new(picture.width(), picture.height());
    if let Some(wanted) = asked.size.filter(|wanted| *wanted != size) {
        let [found, wanted] = [size, wanted].map(|size| format!("{} × {}", size.x, size.y));
        return Err(format!("{}: the picture has {found} pixels; expected {wanted}", file.display()).into());
    }
    Ok(size)
}

/// Checks that either picture is within its bar for the worst pixel.
fn verdict(max: u8, bytes: &Verdict, float: Option<&Verdict>) -> Result<(), Failure> {
    let different = |what: String| Err(Failure::new(DIFFERENT, what));
    if bytes.bad + float.map_or(0, |float| float.bad) > 0 {
        return different("the picture holds values that are not finite or negative".into());
    }
    if !bytes.is_within() {
        return different(format!("a pixel differs by {} of 255 steps, more than --max {max}", bytes.worst));
    }
    match float {
        Some(&Verdict { worst, bars, allowed, .. }) if worst > bars.worst + allowed => different(format!(
            "in floating point a pixel differs by {worst:.1e} of the range, more than {:.1e}",
            bars.worst + allowed
        )),
        _ => Ok(()),
    }
}

/// Spawns the scene into the App and finishes its plugins. All frames show one moment.
pub(crate) fn set_up(app: &mut App, input: &SceneInput) -> Result<(), Failure> {
    input.spawn(app)?;
    let world = app.world_mut();
    let lines: Vec<Entity> = world.query_filtered::<Entity, With<Lines3d>>().iter(world).collect();
    if !lines.is_empty() {
        eprintln!("note: the lines and points of models are drawn by the same code for all renderers, and not judged");
    }
    for entity in lines {
        world.entity_mut(entity).remove::<Lines3d>();
    }
    app.insert_resource(bevy_time::TimeUpdateStrategy::ManualDuration(std::time::Duration::ZERO));
    app.finish();
    app.cleanup();
    Ok(())
}

fn draw(app: &mut App, size: UVec2, pixels: Pixels) -> Result<Picture, RenderError> {
    app.insert_resource(Headless { size, pixels });
    render_picture(app)
}

/// One picture of a scene, and the oracle's.
struct Drawn {
    oracle: Oracle,
    /// The bits of the adapter's grid within a pixel, if it is an adapter's picture.
    bits: Option<u32>,
    actual: Image,
    expected: Image,
}

impl Drawn {
    /// Draws the App by the oracle, too. `progress` is called for its tiles.
    fn new(
        app: &mut App,
        actual: Image,
        bits: Option<u32>,
        is_clamped: bool,
        progress: &(dyn Fn(u32, u32) -> ControlFlow<()> + Sync),
    ) -> Result<Self, Failure> {
        let size = UVec2::from(actual.dimensions());
        let oracle = Oracle::new(app.world_mut(), size)?.with_clamping(is_clamped);
        let expected = oracle.draw_with(progress).map_err(|stopped| Failure::new(STOPPED, stopped))?;
        Ok(Self { oracle, bits, actual, expected })
    }

    /// Draws the differences, if that is asked for.
    fn write_difference(&self, args: &VerifyArgs, encoding: Encoding) -> Result<(), Failure> {
        let Some(file) = &args.output else { return Ok(()) };
        picture::write(file, difference(&self.actual, &self.expected, encoding, Scale::default()).map_err(text)?)
    }

    /// Judges the picture by these bars.
    fn judged(&self, bars: Bars) -> Result<Verdict, Failure> {
        let Self { oracle, bits, actual, expected } = self;
        match bits {
            Some(bits) => judge_on_grid(oracle, expected, *bits, actual, bars),
            None => judge(oracle, expected, actual, bars),
        }
        .map_err(text)
    }
}

pub(crate) fn text(error: impl std::fmt::Display) -> Failure {
    error.to_string().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A verdict of a picture with this worst error.
    fn off(bars: Bars, worst: f64) -> Verdict {
        let (most, at) = (0.0, None);
        Verdict {
            bars,
            allowed: 0.0,
            most,
            worst,
            at,
            equal: 1.0,
            edges: 0.0,
            layered: 0.0,
            counted: 1.0,
            bad: 0,
            first_bad: None,
        }
    }

    #[test]
    fn a_wrong_pixel_of_either_picture_is_an_error() {
        let bytes = Bars { most: 1.0, worst: 1.0, equal: 0.0, ..Bars::bytes(halfway::lighting::Encoding::Srgb) };
        let [right, wrong] = [1.0, 2.0].map(|worst| off(bytes, worst));
        let [right_float, wrong_float] = [0.9, 1.1].map(|share| off(Bars::FLOAT, share * Bars::FLOAT.worst));
        let said = |bytes: &Verdict, float: Option<&Verdict>| {
            let told = |failure: Failure| failure.error.map_or(String::new(), |error| error.to_string());
            verdict(1, bytes, float).map_err(told)
        };
        assert_eq!(said(&right, None), Ok(()));
        assert_eq!(said(&right, Some(&right_float)), Ok(()));
        assert_eq!(
            said(&wrong, Some(&right_float)),
            Err("a pixel differs by 2 of 255 steps, more than --max 1".into())
        );
        let expected = "in floating point a pixel differs by 2.2e-3 of the range, more than 2.0e-3";
        assert_eq!(said(&right, Some(&wrong_float)), Err(expected.into()));
        let negative = Verdict { bad: 1, ..right_float };
        let expected = "the picture holds values that are not finite or negative";
        assert_eq!(said(&right, Some(&negative)), Err(expected.into()));
    }
}
