//! The measurements.

use std::hint::black_box;
use std::time::Instant;

use halfway::prelude::Encoding;
use halfway::reference::Image;
use halfway::reference::metrics;
use halfway::texture::{FootprintTruth, PictureMap, Pyramid, Wrap, lookup};
use rayon::prelude::*;

use super::{BILINEAR, ChartedImage, FILTERS, FilterFigures, FilterMethod, FilterPlan, FilterView, MeasuredFilters};
use crate::error::ChartError;
use crate::page::data_uri;
use crate::progress::Progress;
use crate::timing::{Spread, ratios};

/// A lookup: the point, and the derivatives of (u, v) along x and y.
type Lookup<T> = ([T; 2], [[T; 2]; 2]);

/// One picture of the plane: the lookup of each pixel, and the true value. Pixels that are not wholly on the plane have
/// neither.
struct PlanePicture {
    lookups: Vec<Option<Lookup<f64>>>,
    truth: Vec<Option<[f64; 3]>>,
}

/// Measures every filter on every image; `progress` counts [`FilterPlan::units`].
///
/// # Errors
/// A picture that cannot be put on the page.
pub fn sweep(plan: &FilterPlan, progress: &mut Progress<'_>) -> Result<Vec<MeasuredFilters>, ChartError> {
    ChartedImage::ALL.into_iter().map(|image| measure_image(plan, image, progress)).collect()
}

fn measure_image(
    plan: &FilterPlan,
    image: ChartedImage,
    progress: &mut Progress<'_>,
) -> Result<MeasuredFilters, ChartError> {
    let pyramid = image.pyramid();
    let truth = FootprintTruth::new(&pyramid);
    let mut see = |view: FilterView, frame: u32| {
        let seen = PlanePicture::new(plan, &truth, &view.map(plan.size, frame));
        progress.advance(1, &format!("truth of the {}, {}", image.name(), view.name()));
        seen
    };
    let still: Vec<PlanePicture> = FilterView::ALL.into_iter().map(|view| see(view, 0)).collect();
    let moving: Vec<Vec<PlanePicture>> =
        FilterView::MOVING.into_iter().map(|view| (0..plan.frames).map(|frame| see(view, frame)).collect()).collect();
    let mut figures = Vec::with_capacity(FILTERS.len());
    for method in FILTERS {
        figures.push(errors(plan, &pyramid, method, &still, &moving)?);
    }
    timed(plan, &pyramid, &still, &mut figures);
    progress.advance(1, &format!("times on the {}", image.name()));
    let steepest = &still[still.len() - 1];
    Ok(MeasuredFilters { image, truth: uri(plan, &steepest.truth)?, figures })
}

impl PlanePicture {
    fn new(plan: &FilterPlan, truth: &FootprintTruth, map: &PictureMap) -> Self {
        let [width, height] = plan.size;
        let places = (0..width * height).into_par_iter().map(|pixel| {
            let place = [f64::from(pixel % width) + 0.5, f64::from(pixel / width) + 0.5];
            let [r, g, b, _] = truth.mean([Wrap::Repeat; 2], map, place, plan.tolerance)?;
            Some(((map.at(place)?, map.footprint(place)), [r, g, b]))
        });
        let (lookups, truth) = places.map(Option::unzip).unzip();
        Self { lookups, truth }
    }

    fn drawn(&self, pyramid: &Pyramid, method: FilterMethod) -> Vec<Option<[f64; 3]>> {
        let texel = |&(uv, footprint): &Lookup<f64>| {
            let [r, g, b, _] = lookup::filtered(pyramid, &method.sampling, uv, footprint);
            [r, g, b]
        };
        self.lookups.par_iter().map(|lookup| lookup.as_ref().map(texel)).collect()
    }
}

fn errors(
    plan: &FilterPlan,
    pyramid: &Pyramid,
    method: FilterMethod,
    still: &[PlanePicture],
    moving: &[Vec<PlanePicture>],
) -> Result<FilterFigures, ChartError> {
    let mut found = FilterFigures::default();
    let mut all = Mean::default();
    for seen in still {
        let drawn = seen.drawn(pyramid, method);
        let mut own = Mean::default();
        for (drawn, truth) in drawn.iter().flatten().zip(seen.truth.iter().flatten()) {
            let [drawn, truth] = [drawn, truth].map(steps);
            own.add(std::array::from_fn(|k| drawn[k] - truth[k]));
        }
        found.rms_by_view.push(own.root());
        all.join(&own);
        let flip = metrics::flip(&image(plan, &drawn), &image(plan, &seen.truth), Encoding::Srgb)?;
        found.flip += flip.mean / still.len() as f64;
        found.picture = uri(plan, &drawn)?;
    }
    found.rms = all.root();
    let mut shimmer = Mean::default();
    for frames in moving {
        let drawn: Vec<_> = frames.iter().map(|seen| seen.drawn(pyramid, method)).collect();
        for frame in 1..frames.len() {
            let of = |pictures: [&Vec<Option<[f64; 3]>>; 2], pixel: usize| {
                let [a, b] = pictures.map(|picture| picture[pixel].as_ref().map(steps));
                a.zip(b).map(|(a, b)| -> [f64; 3] { std::array::from_fn(|k| b[k] - a[k]) })
            };
            for pixel in 0..drawn[frame].len() {
                let own = of([&drawn[frame - 1], &drawn[frame]], pixel);
                let right = of([&frames[frame - 1].truth, &frames[frame].truth], pixel);
                if let Some((own, right)) = own.zip(right) {
                    shimmer.add(std::array::from_fn(|k| own[k] - right[k]));
                }
            }
        }
    }
    found.shimmer = shimmer.root();
    Ok(found)
}

/// Times of lookups in f32, as in the CPU's rasterizer, over all pixels of all views. The filters take turns; each
/// round begins with another filter, after an untimed lookup.
fn timed(plan: &FilterPlan, pyramid: &Pyramid, still: &[PlanePicture], figures: &mut [FilterFigures]) {
    let single = |&([u, v], [x, y]): &Lookup<f64>| -> Lookup<f32> {
        ([u as f32, v as f32], [[x[0] as f32, x[1] as f32], [y[0] as f32, y[1] as f32]])
    };
    let lookups: Vec<Lookup<f32>> = still.iter().flat_map(|seen| seen.lookups.iter().flatten().map(single)).collect();
    let run = |method: &FilterMethod| {
        let start = Instant::now();
        let mut sum = [0.0_f32; 4];
        for (uv, footprint) in &lookups {
            let texel = lookup::filtered(pyramid, &method.sampling, *uv, *footprint);
            (0..4).for_each(|k| sum[k] += texel[k]);
        }
        black_box(sum);
        start.elapsed().as_secs_f64() * 1e9 / lookups.len().max(1) as f64
    };
    for method in &FILTERS {
        run(method);
    }
    let mut times = vec![Vec::new(); FILTERS.len()];
    for round in 0..plan.rounds as usize {
        for k in 0..FILTERS.len() {
            let place = (k + round) % FILTERS.len();
            times[place].push(run(&FILTERS[place]));
        }
    }
    for (figures, own) in figures.iter_mut().zip(&times) {
        figures.ns = Spread::from_values(own);
        figures.ratio = ratios(own, &times[BILINEAR]);
    }
}

/// Steps of 1/255 of the sRGB curve, not rounded.
fn steps(color: &[f64; 3]) -> [f64; 3] {
    color.map(|linear| 255.0 * Encoding::Srgb.encode(linear.clamp(0.0, 1.0)))
}

/// A picture; pixels beside the plane are gray in all of them.
fn image(plan: &FilterPlan, pixels: &[Option<[f64; 3]>]) -> Image {
    Image::new(plan.size[0], plan.size[1], pixels.iter().map(|pixel| pixel.unwrap_or([0.3; 3])).collect())
}

fn uri(plan: &FilterPlan, pixels: &[Option<[f64; 3]>]) -> Result<String, ChartError> {
    Ok(data_uri(&image(plan, pixels).to_bytes(Encoding::Srgb))?)
}

/// A root mean square.
#[derive(Default)]
struct Mean {
    squares: f64,
    count: usize,
}

impl Mean {
    fn add(&mut self, differences: [f64; 3]) {
        self.squares += differences.iter().map(|difference| difference * difference).sum::<f64>();
        self.count += 3;
    }

    fn join(&mut self, other: &Self) {
        self.squares += other.squares;
        self.count += other.count;
    }

    fn root(&self) -> f64 {
        (self.squares / self.count.max(1) as f64).sqrt()
    }
}
