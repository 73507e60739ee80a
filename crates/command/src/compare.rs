//! `halfway compare`.

use std::path::PathBuf;

use clap::Args;
use halfway::prelude::*;
use halfway::reference::Image;
use halfway::reference::metrics::{Flip, PERCENTILES, PIXELS_PER_DEGREE, Scale, compare, difference, flip};

use crate::failure::{DIFFERENT, Failure};
use crate::{figures, picture};

#[derive(Args, Debug)]
pub(crate) struct CompareArgs {
    /// The picture that is measured: a PNG of 8 or 16 bits, or an EXR
    a: PathBuf,
    /// The picture that is expected
    b: PathBuf,
    /// Draw where they differ, with a legend, into this PNG
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The background's linear intensities: what has this colour, as 8 bits tell colours apart, is covered by nothing
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
    let (actual, expected) = (picture::read(&args.a, encoding)?, picture::read(&args.b, encoding)?);
    let (actual, expected) = told_apart(actual, expected, args.background, encoding);
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

/// Both pictures with what they cover, where that can be told.
fn told_apart(a: Image, b: Image, background: Option<[f64; 3]>, encoding: Encoding) -> (Image, Image) {
    if let Some(background) = background {
        let bytes = bytes_of(background, encoding);
        return (without(a, bytes, encoding), without(b, bytes, encoding));
    }
    match [corners(&a), corners(&b)] {
        // Pictures that were written with different precision may show the same background a step apart.
        [Some(of_a), Some(of_b)] if is_near(of_a, of_b, encoding) => (a.with_background(of_a), b.with_background(of_b)),
        _ => (a, b),
    }
}

fn bytes_of(colour: [f64; 3], encoding: Encoding) -> [u8; 3] {
    Image::new(1, 1, vec![colour]).to_bytes(encoding).get_pixel(0, 0).0
}

fn is_near(a: [f64; 3], b: [f64; 3], encoding: Encoding) -> bool {
    bytes_of(a, encoding).iter().zip(bytes_of(b, encoding)).all(|(a, b)| a.abs_diff(b) <= 1)
}

/// The picture with all pixels of a colour as background.
fn without(image: Image, background: [u8; 3], encoding: Encoding) -> Image {
    let covered = image.to_bytes(encoding).pixels().map(|pixel| pixel.0 != background).collect();
    image.with_coverage(covered)
}

/// The colour that the four corners share.
#[expect(clippy::float_cmp, reason = "nothing was computed between the corners: a background is one colour exactly")]
fn corners(image: &Image) -> Option<[f64; 3]> {
    let (right, bottom) = (image.dimensions().0.checked_sub(1)?, image.dimensions().1.checked_sub(1)?);
    let first = image.pixel(0, 0);
    let share = [(right, 0), (0, bottom), (right, bottom)].iter().all(|&(x, y)| image.pixel(x, y) == first);
    share.then_some(first)
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
