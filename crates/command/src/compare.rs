//! `halfway compare`.

use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::Args;
use halfway::prelude::*;
use halfway::reference::Image;
use halfway::reference::metrics::{
    Flip, PERCENTILES, PIXELS_PER_DEGREE, PictureRows, Scale, compare, difference, flip,
};
use image::DynamicImage;

use crate::failure::{DIFFERENT, Failure};
use crate::{figures, picture};

#[derive(Args, Debug)]
pub(crate) struct CompareArgs {
    /// The actual picture: a PNG of 8 or 16 bits, or an EXR
    a: PathBuf,
    /// The expected picture
    b: PathBuf,
    /// Draw where they differ, with a legend, into this PNG
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The background's linear intensities: pixels of this colour, compared in 8 bits, are covered by nothing
    /// [default: the colour that the four corners share; where they do not, all pixels count]
    #[arg(long, value_name = "R,G,B", value_parser = parse_background)]
    background: Option<[f64; 3]>,
    /// Exit with code 4 where any pixel, covered or not, differs by more steps of 1/255
    #[arg(long, value_name = "STEPS")]
    max: Option<u8>,
    /// The pictures hold intensities as they are (a scene's "output": "raw"), not the sRGB curve's
    #[arg(long)]
    raw: bool,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &CompareArgs) -> Result<(), Failure> {
    let encoding = if args.raw { Encoding::Raw } else { Encoding::Srgb };
    let mut actual = Decoded::read(&args.a, encoding)?;
    let mut expected = Decoded::read(&args.b, encoding)?;
    find_background(&mut actual, &mut expected, args.background);
    let named = |error| Failure::from(format!("{} and {}: {error}", args.a.display(), args.b.display()));
    let comparison = compare(&actual, &expected, encoding).map_err(named)?;
    let perceived = flip(&actual, &expected, encoding).map_err(named)?;
    if args.json {
        let mut json = figures::comparison(&comparison);
        json["flip"] = flip_json(perceived);
        println!("{json}");
    } else {
        print!("{}", comparison.table());
        print_flip(perceived);
    }
    if let Some(file) = &args.output {
        picture::write(file, difference(&actual, &expected, encoding, Scale::default()).map_err(named)?)?;
    }
    match args.max {
        Some(max) if !comparison.is_within(max) => {
            Err(Failure::new(DIFFERENT, format!("more than --max {max} steps: {comparison}")))
        }
        _ => Ok(()),
    }
}

/// A picture as decoded, of which some rows at a time become intensities: the largest would take 6 GB as those.
struct Decoded {
    picture: DynamicImage,
    encoding: Encoding,
    background: Option<Background>,
}

/// The color of the background.
enum Background {
    /// Exactly these intensities.
    Exactly([f64; 3]),
    /// These bytes, after rounding.
    AsBytes([u8; 3]),
}

impl Decoded {
    fn read(file: &Path, encoding: Encoding) -> Result<Self, Failure> {
        Ok(Self { picture: picture::decoded(file)?, encoding, background: None })
    }

    /// The color that the four corners share.
    #[expect(
        clippy::float_cmp,
        reason = "nothing was computed between the corners: a background is one colour exactly"
    )]
    fn corners(&self) -> Option<[f64; 3]> {
        let (width, height) = self.dimensions();
        let (right, bottom) = (width.checked_sub(1)?, height.checked_sub(1)?);
        let [top, bottom] = [self.rows(0..1), self.rows(bottom..height)];
        let first = top.pixel(0, 0);
        let share = [top.pixel(right, 0), bottom.pixel(0, 0), bottom.pixel(right, 0)].iter().all(|it| *it == first);
        share.then_some(first)
    }
}

impl PictureRows for Decoded {
    fn dimensions(&self) -> (u32, u32) {
        (self.picture.width(), self.picture.height())
    }

    fn rows(&self, rows: Range<u32>) -> Image {
        let cut = self.picture.crop_imm(0, rows.start, self.picture.width(), rows.end - rows.start);
        let image = Image::from_decoded(&cut, self.encoding);
        match self.background {
            None => image,
            Some(Background::Exactly(color)) => image.with_background(color),
            Some(Background::AsBytes(bytes)) => {
                let covered = image.to_bytes(self.encoding).pixels().map(|pixel| pixel.0 != bytes).collect();
                image.with_coverage(covered)
            }
        }
    }
}

/// Finds the background of both pictures, where possible.
fn find_background(a: &mut Decoded, b: &mut Decoded, background: Option<[f64; 3]>) {
    if let Some(background) = background {
        let bytes = bytes_of(background, a.encoding);
        (a.background, b.background) = (Some(Background::AsBytes(bytes)), Some(Background::AsBytes(bytes)));
        return;
    }
    // Pictures that were written with different precision may show the same background a step apart.
    if let [Some(of_a), Some(of_b)] = [a.corners(), b.corners()]
        && is_near(of_a, of_b, a.encoding)
    {
        (a.background, b.background) = (Some(Background::Exactly(of_a)), Some(Background::Exactly(of_b)));
    }
}

fn bytes_of(color: [f64; 3], encoding: Encoding) -> [u8; 3] {
    Image::new(1, 1, vec![color]).to_bytes(encoding).get_pixel(0, 0).0
}

fn is_near(a: [f64; 3], b: [f64; 3], encoding: Encoding) -> bool {
    bytes_of(a, encoding).iter().zip(bytes_of(b, encoding)).all(|(a, b)| a.abs_diff(b) <= 1)
}

fn print_flip(it: Flip) {
    println!("\nꟻLIP            mean {:.4}, max {:.4} at {PIXELS_PER_DEGREE} pixels a degree", it.mean, it.max);
    let percentiles = PERCENTILES.iter().zip(it.percentiles).map(|(share, value)| format!("{share} % ≤ {value:.4}"));
    println!("                {}", percentiles.collect::<Vec<_>>().join(", "));
}

fn flip_json(it: Flip) -> serde_json::Value {
    serde_json::json!({
        "pixels_per_degree": PIXELS_PER_DEGREE,
        "mean": it.mean,
        "max": it.max,
        "percentiles": figures::percentiles(it.percentiles),
    })
}

fn parse_background(text: &str) -> Result<[f64; 3], String> {
    let channels: Option<Vec<f64>> = text.split(',').map(|channel| channel.trim().parse().ok()).collect();
    channels
        .and_then(|channels| <[f64; 3]>::try_from(channels).ok())
        .filter(|channels| channels.iter().all(|channel| channel.is_finite() && *channel >= 0.0))
        .ok_or_else(|| "expected three linear intensities, 0 and up, such as 0,0,0 or 0.01,0.01,0.03".into())
}
