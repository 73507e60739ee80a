//! `halfway terms`.

use std::path::PathBuf;

use clap::Args;
use halfway::lighting::Term;
use halfway::output::{ContactSheet, PictureFormat, write_picture};
use halfway::prelude::*;
use halfway::record::Continue;
use halfway::scene::{LightSource, PartOfLight, SceneTime, Spawned};
use image::Rgba32FImage;

use crate::drawing::{DrawingArgs, SizeArgs};
use crate::empty::warn_if_empty;
use crate::failure::{Failure, STOPPED};
use crate::input::SceneInput;
use crate::progress::Progress;
use crate::render::parse_time;

#[derive(Args, Debug)]
pub(crate) struct TermsArgs {
    #[command(flatten)]
    drawing: DrawingArgs,
    /// The sheet: .png, .jpg or .webp
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Width and height of each picture in pixels [default: 320 wide, of the shape of the scene's picture]
    #[command(flatten)]
    size: SizeArgs,
    /// Draw the scene's animation at T seconds
    #[arg(long, value_name = "T", value_parser = parse_time)]
    time: Option<f64>,
}

/// The most lights of a sheet.
const MOST_LIGHTS: usize = 32;
/// The width of a picture.
const WIDTH: u32 = 320;
/// The pictures of a row: three terms and their sum.
const COLUMNS: u32 = 4;

pub(crate) fn run(args: &TermsArgs) -> Result<(), Failure> {
    let options = args.drawing.options();
    if options.only.is_some() || options.light.is_some() {
        return Err("--only, --light: the sheet shows every term and every light".to_owned().into());
    }
    let format = PictureFormat::from_path(&args.output, Some(8))?;
    let mut input = SceneInput::read(&args.drawing, &options)?;
    (input.scene.only, input.scene.light) = (None, None);
    if input.scene.intensity.acts_on_pictures() {
        eprintln!("note: intensities above 1 are clamped in the sheet, in place of the scene's policy");
        input.scene.intensity = Intensity::Clamp;
    }
    input.see_alone();
    let [width, height] = input.scene.size;
    let of_shape = UVec2::new(WIDTH, (WIDTH * height).div_ceil(width).max(1));
    let size = input.resize(SizeArgs { size: Some(args.size.size.unwrap_or(of_shape)) });
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::headless(size));
    args.drawing.adapter.choice().open()?.insert_into(app.world_mut());
    let spawned = input.spawn(&mut app)?;
    if args.time.is_some() && !spawned.is_animated {
        return Err(format!("--time: {} has no animation", input.name()).into());
    }
    let lights = spawned.lights.len();
    if lights > MOST_LIGHTS {
        return Err(format!("{}: {lights} lights; a sheet shows at most {MOST_LIGHTS}", input.name()).into());
    }
    app.insert_resource(SceneTime::At(args.time.unwrap_or(0.0)))
        .insert_resource(bevy_time::TimeUpdateStrategy::ManualDuration(std::time::Duration::ZERO))
        .insert_resource(Headless { size, pixels: Pixels::Float });
    app.finish();
    app.cleanup();
    let sheet = Terms { app, spawned, size, drawn: 0, progress: Progress::for_frames(3 * (lights as u32 + 1)) }
        .sheet(input.scene.output)?;
    Ok(write_picture(&sheet, &args.output, format, input.scene.output)?)
}

/// The terms of a scene that is being drawn.
struct Terms {
    app: App,
    spawned: Spawned,
    size: UVec2,
    drawn: u32,
    progress: Progress,
}

impl Terms {
    /// A row for each light, one without lights, and their sums.
    fn sheet(&mut self, encoding: Encoding) -> Result<Picture, Failure> {
        const OF_LIGHT: [(Term, &str); 3] =
            [(Term::Ambient, "ambient"), (Term::Diffuse, "diffuse"), (Term::Specular, "specular")];
        const WITHOUT: [(Term, &str); 3] = [
            (Term::Ambient, "global ambient"),
            (Term::Emission, "emission, background"),
            (Term::Specular, "mirrored environment"),
        ];
        let mut sheet = ContactSheet::new(COLUMNS, self.size.x, encoding);
        let black = || Rgba32FImage::new(self.size.x, self.size.y);
        let mut sums = [black(), black(), black(), black()];
        let sources: Vec<LightSource> = (0..self.spawned.lights.len()).map(LightSource::Light).collect();
        for source in sources.into_iter().chain([LightSource::NoLight]) {
            let (name, terms) = match source {
                LightSource::Light(place) => (Some(self.name(place)), OF_LIGHT),
                _ => (None, WITHOUT),
            };
            let mut row = Rgba32FImage::new(self.size.x, self.size.y);
            for (column, (term, caption)) in terms.into_iter().enumerate() {
                let part = self.part(PartOfLight { term: Some(term), source })?;
                add(&mut row, &part);
                let caption = name.as_ref().map_or(caption.to_owned(), |name| format!("{name}: {caption}"));
                if term != Term::Emission {
                    add(&mut sums[column], &part);
                }
                sheet.push_with_caption(&Picture::Float(part), &caption);
            }
            add(&mut sums[3], &row);
            let caption = name.map_or("without lights".to_owned(), |name| format!("{name}: sum"));
            sheet.push_with_caption(&Picture::Float(row), &caption);
        }
        let whole = Picture::Float(sums[3].clone());
        warn_if_empty(&mut self.app, &whole);
        for (sum, caption) in sums.into_iter().zip(["all ambient", "all diffuse", "all specular", "sum of all"]) {
            sheet.push_with_caption(&Picture::Float(sum), caption);
        }
        Ok(sheet.picture())
    }

    /// The name of a light.
    fn name(&self, place: usize) -> String {
        let name = self.spawned.lights.get(place).and_then(|light| self.app.world().get::<Name>(*light));
        name.map_or_else(|| format!("lights[{place}]"), |name| name.as_str().to_owned())
    }

    fn part(&mut self, part: PartOfLight) -> Result<Rgba32FImage, Failure> {
        self.spawned.show_light(part, self.app.world_mut());
        let picture = render_picture(&mut self.app)?;
        self.drawn += 1;
        if self.progress.frame(self.drawn) == Continue::No {
            return Err(Failure::new(STOPPED, "stopped"));
        }
        match picture {
            Picture::Float(image) => Ok(image),
            Picture::Byte(_) => Err("a picture of bytes in place of one of floats".to_owned().into()),
        }
    }
}

/// Adds the intensities of a part. The opacity is the largest one.
fn add(sum: &mut Rgba32FImage, part: &Rgba32FImage) {
    for (sum, part) in sum.pixels_mut().zip(part.pixels()) {
        let [r, g, b, a] = part.0;
        sum.0 = [sum.0[0] + r, sum.0[1] + g, sum.0[2] + b, sum.0[3].max(a)];
    }
}
