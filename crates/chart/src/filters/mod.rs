//! Filters of images against the integrated footprint: error, shimmer, time and memory.

mod pages;
mod scenery;
mod sweep;

use halfway::texture::{LevelFilter, Sampling, TexelFilter};

use crate::timing::Spread;

pub use pages::Filters;
pub use scenery::{ChartedImage, FilterView};
pub use sweep::sweep;

/// The extent of the filter measurements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterPlan {
    /// Columns and rows of the pictures.
    pub size: [u32; 2],
    /// Frames of the moving camera, 2 or more.
    pub frames: u32,
    /// Rounds in which the filters take turns while they are timed.
    pub rounds: u32,
    /// The difference between the mean over a part of a footprint and that of its halves above which these are halved.
    pub tolerance: f64,
}

impl FilterPlan {
    /// Many minutes on two cores, most of them for the truth near the horizon.
    pub const FULL: Self = Self { size: [160, 120], frames: 6, rounds: 25, tolerance: 1e-4 };
    /// Fewer pixels, frames and rounds: for a first impression.
    pub const QUICK: Self = Self { size: [96, 72], frames: 4, rounds: 7, tolerance: 1e-4 };

    /// The units that [`sweep`] reports: a truth each, and one for each timing.
    pub fn units(&self) -> u64 {
        let views = FilterView::ALL.len() + FilterView::MOVING.len() * self.frames as usize;
        (ChartedImage::ALL.len() * (views + 1)) as u64
    }
}

/// A texture filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterMethod {
    /// Its name.
    pub name: &'static str,
    /// Its settings.
    pub sampling: Sampling,
    /// The memory that it reads, in multiples of the image's.
    pub memory: f64,
}

const fn method(name: &'static str, texels: TexelFilter, levels: LevelFilter, memory: f64) -> FilterMethod {
    let sampling = Sampling { wrap: Sampling::NEAREST.wrap, magnify: texels, minify: texels, levels };
    FilterMethod { name, sampling, memory }
}

const PYRAMID: f64 = 4.0 / 3.0;

/// The charted filters. The second is the one whose time is 1.
pub const FILTERS: [FilterMethod; 13] = {
    use LevelFilter as L;
    use TexelFilter as T;
    [
        method("nearest", T::Nearest, L::None, 1.0),
        method("bilinear", T::Bilinear, L::None, 1.0),
        method("bilinear, nearest level", T::Bilinear, L::Nearest, PYRAMID),
        method("trilinear", T::Bilinear, L::Linear, PYRAMID),
        method("B-spline, two levels", T::BSpline, L::Linear, PYRAMID),
        method("Catmull–Rom, two levels", T::CatmullRom, L::Linear, PYRAMID),
        method("ripmap", T::Bilinear, L::Ripmap, 4.0),
        method("summed areas", T::Bilinear, L::SummedArea, 3.0),
        method("2 probes", T::Bilinear, L::Anisotropic2, PYRAMID),
        method("4 probes", T::Bilinear, L::Anisotropic4, PYRAMID),
        method("8 probes", T::Bilinear, L::Anisotropic8, PYRAMID),
        method("16 probes", T::Bilinear, L::Anisotropic16, PYRAMID),
        method("elliptical mean", T::Bilinear, L::Elliptical, PYRAMID),
    ]
};

/// The index in [`FILTERS`] of the one whose time is 1.
pub const BILINEAR: usize = 1;

/// The figures of one filter on one image.
#[derive(Clone, Debug, Default)]
pub struct FilterFigures {
    /// The RMS error of each of [`FilterView::ALL`], in steps of 1/255 of the sRGB curve, not rounded.
    pub rms_by_view: Vec<f64>,
    /// The same over all of them.
    pub rms: f64,
    /// The mean of ꟻLIP over all of them.
    pub flip: f64,
    /// The RMS of the change from a frame of the moving camera to the next, minus the change of the truth, in such
    /// steps.
    pub shimmer: f64,
    /// A lookup's time, in nanoseconds.
    pub ns: Spread,
    /// Its ratio to the bilinear filter's time of the same round.
    pub ratio: Spread,
    /// The picture of the steepest rotated view, as a `data:` address.
    pub picture: String,
}

/// The figures of one image.
#[derive(Clone, Debug)]
pub struct MeasuredFilters {
    /// The image.
    pub image: ChartedImage,
    /// The true picture of the steepest rotated view, as a `data:` address.
    pub truth: String,
    /// For each of [`FILTERS`].
    pub figures: Vec<FilterFigures>,
}
