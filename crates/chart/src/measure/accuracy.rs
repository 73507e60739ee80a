//! Error against time: what the adapter draws, beside the true surface and beside a constant colour.

use halfway::prelude::*;
use halfway::reference::metrics::{self, Comparison, Scale};
use halfway::reference::{Image, Mode};
use image::RgbImage;

use super::{ChartObject, ChartScene, MeasureError, MeasureProgress, SHADINGS, SceneApp, shading_name};
use crate::timing::{in_turns, median, median_ratio, settle};

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AccuracyPlan {
    /// Width and height of the pictures in pixels.
    pub size: u32,
    /// How many levels of tessellation ([`ChartObject::level`]).
    pub levels: u32,
    /// How often every shading is timed in turn.
    pub rounds: u32,
}

/// How a highlight is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AccuracyVariant {
    /// Phong or Blinn–Phong.
    pub reflectance: Reflectance,
    /// Local or infinite.
    pub viewer: Viewer,
}

impl AccuracyVariant {
    /// Every reflectance with every viewer.
    pub const ALL: [Self; 4] = [
        Self { reflectance: Reflectance::BlinnPhong, viewer: Viewer::Local },
        Self { reflectance: Reflectance::BlinnPhong, viewer: Viewer::Infinite },
        Self { reflectance: Reflectance::Phong, viewer: Viewer::Local },
        Self { reflectance: Reflectance::Phong, viewer: Viewer::Infinite },
    ];

    /// Both in words: the reflectance, then the viewer.
    pub fn names(self) -> [&'static str; 2] {
        let reflectance = match self.reflectance {
            Reflectance::Phong => "Phong reflectance",
            Reflectance::BlinnPhong => "Blinn–Phong",
            Reflectance::BlinnPhongMatched => "Blinn–Phong, matched",
        };
        let viewer = match self.viewer {
            Viewer::Local => "local viewer",
            Viewer::Infinite => "infinite viewer",
        };
        [reflectance, viewer]
    }
}

/// One object at one level under one shading, reflectance and viewer.
#[derive(Clone, Debug)]
pub struct Measured {
    /// What was drawn.
    pub object: ChartObject,
    /// How finely ([`ChartObject::level`]).
    pub level: u32,
    /// How many triangles that is.
    pub triangles: usize,
    /// How often it was shaded.
    pub shading: Shading,
    /// How its highlight was made.
    pub variant: AccuracyVariant,
    /// Median time of a frame in milliseconds.
    pub frame_ms: f64,
    /// The same of the mesh in a constant colour.
    pub constant_ms: f64,
    /// Median over the rounds of the time of a frame, as a multiple of the constant colour's in the same round: what slows
    /// the machine down for a while slows both.
    pub ratio: f64,
    /// How far the picture is from the true surface, on pixels that both cover.
    pub comparison: Comparison,
    /// ꟻLIP's mean over the whole picture, after pixels that only one of the two covers were made equal.
    pub flip: f64,
    /// What the adapter drew, small.
    pub picture: RgbImage,
    /// Where it differs from the true surface, small, with a legend.
    pub difference: RgbImage,
}

/// The longer side that small pictures have at most, in pixels.
const SMALL: u32 = 320;

impl AccuracyPlan {
    /// The units of [`MeasureProgress`] that [`sweep`] will report.
    pub fn units(self) -> u64 {
        (ChartObject::ALL.len() * AccuracyVariant::ALL.len()) as u64 * u64::from(self.levels)
    }
}

/// Measures every object, level, shading and variant; in this order, the last the quickest to change.
///
/// # Errors
/// The first picture that could not be drawn.
pub fn sweep(plan: AccuracyPlan, progress: &mut MeasureProgress<'_>) -> Result<Vec<Measured>, MeasureError> {
    let size = UVec2::splat(plan.size);
    let mut stages = Stages::new(size);
    let mut oracle = SceneApp::without_adapter(size);
    let mut measured = Vec::new();
    for object in ChartObject::ALL {
        let mut truths = Vec::new();
        for variant in AccuracyVariant::ALL {
            progress.begin(&format!("{}, true surface", object.name()));
            oracle.show(&scene(object, object.level(plan.levels - 1), variant));
            truths.push(oracle.oracle(Mode::Surface)?);
        }
        for level in (0..plan.levels).map(|i| object.level(i)) {
            for (variant, truth) in AccuracyVariant::ALL.into_iter().zip(&truths) {
                let scene = scene(object, level, variant);
                measured.extend(stages.measure(&scene, variant, truth, plan.rounds)?);
                progress.advance(1, &format!("{}, level {level}", object.name()));
            }
        }
    }
    Ok(measured)
}

fn scene(object: ChartObject, level: u32, variant: AccuracyVariant) -> ChartScene {
    ChartScene { reflectance: variant.reflectance, viewer: variant.viewer, ..ChartScene::new(object, level) }
}

/// An App for each shading and one for the constant colour, so that a turn changes nothing in any of them.
struct Stages {
    constant: SceneApp,
    shaded: [SceneApp; SHADINGS.len()],
}

impl Stages {
    fn new(size: UVec2) -> Self {
        Self { constant: SceneApp::with_adapter(size), shaded: SHADINGS.map(|_| SceneApp::with_adapter(size)) }
    }

    fn measure(
        &mut self,
        scene: &ChartScene,
        variant: AccuracyVariant,
        truth: &Image,
        rounds: u32,
    ) -> Result<Vec<Measured>, MeasureError> {
        self.constant.show(&ChartScene { shading: None, ..*scene });
        for (stage, shading) in self.shaded.iter_mut().zip(SHADINGS) {
            stage.show(&ChartScene { shading: Some(shading), ..*scene });
        }
        let pictures = self.shaded.each_mut().map(SceneApp::draw);
        let mut times = self.time(rounds)?;
        let constant = times.remove(0);
        let triangles = scene.object.mesh(scene.level).triangle_count();
        SHADINGS
            .into_iter()
            .zip(pictures)
            .zip(times)
            .map(|((shading, picture), times)| {
                let picture = picture?;
                let alike = covered_alike(&picture, truth);
                let [small, small_alike, small_truth] = [&picture, &alike, truth].map(reduced);
                Ok(Measured {
                    object: scene.object,
                    level: scene.level,
                    triangles,
                    shading,
                    variant,
                    ratio: median_ratio(&times, &constant),
                    frame_ms: median(&times),
                    constant_ms: median(&constant),
                    comparison: metrics::compare(&picture, truth, Encoding::Srgb)?,
                    flip: metrics::flip(&alike, truth, Encoding::Srgb)?.mean,
                    picture: small.to_bytes(Encoding::Srgb),
                    difference: metrics::difference(&small_alike, &small_truth, Encoding::Srgb, Scale::default())?,
                })
            })
            .collect()
    }

    /// The times of frames in milliseconds, the constant colour's first ([`in_turns`]).
    fn time(&mut self, rounds: u32) -> Result<Vec<Vec<f64>>, MeasureError> {
        let [flat, gouraud, phong] = &mut self.shaded;
        let mut apps = [&mut self.constant, flat, gouraud, phong].map(SceneApp::app);
        for app in &mut apps {
            settle(app)?;
        }
        Ok(in_turns(&mut apps, rounds)?)
    }
}

/// The picture, with the true surface's colour at pixels that only one of them covers.
fn covered_alike(picture: &Image, truth: &Image) -> Image {
    let (width, height) = picture.dimensions();
    let Some((a, b)) = picture.covered().zip(truth.covered()) else { return picture.clone() };
    let alike = a.iter().zip(b).zip(picture.pixels().iter().zip(truth.pixels()));
    Image::new(width, height, alike.map(|((a, b), (own, other))| if a == b { *own } else { *other }).collect())
}

/// The picture with squares of pixels averaged, so that no side is longer than [`SMALL`]. What is left over at the right
/// and the bottom is dropped.
fn reduced(image: &Image) -> Image {
    let (width, height) = image.dimensions();
    let factor = width.max(height).div_ceil(SMALL).max(1);
    let (width, height) = (width / factor, height / factor);
    let average = |x: u32, y: u32| {
        let square = (0..factor).flat_map(|dy| (0..factor).map(move |dx| (x * factor + dx, y * factor + dy)));
        let mut sum = [0.0; 3];
        for (x, y) in square {
            let pixel = image.pixel(x, y);
            sum = std::array::from_fn(|channel| sum[channel] + pixel[channel]);
        }
        sum.map(|channel| channel / f64::from(factor * factor))
    };
    Image::new(width, height, (0..height).flat_map(|y| (0..width).map(move |x| average(x, y))).collect())
}

/// What was measured, in a line.
pub fn describe(measured: &Measured) -> String {
    let Measured { object, level, triangles, shading, variant, .. } = measured;
    let [reflectance, viewer] = variant.names();
    let tessellation = match object {
        ChartObject::Sphere => format!("{} × {level}", 2 * level),
        ChartObject::Teapot => format!("{level} × {level} a patch"),
    };
    format!(
        "{} ({tessellation}, {triangles} triangles), {} shading, {reflectance}, {viewer}",
        object.name(),
        shading_name(*shading)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_pictures_are_averages() {
        let pixels = (0..641 * 2).map(|i| [f64::from(i % 641), 1.0, 0.0]).collect();
        let small = reduced(&Image::new(641, 3, [pixels, vec![[9.0; 3]; 641]].concat()));
        // 641 needs squares of 3 × 3.
        assert_eq!(small.dimensions(), (213, 1));
        let [r, g, b] = small.pixel(1, 0);
        // Columns 3, 4, 5 in two rows, and three pixels of 9.
        assert!((r - (2.0 * 12.0 + 27.0) / 9.0).abs() < 1e-12);
        assert!((g - 33.0 / 9.0).abs() < 1e-12 && (b - 3.0).abs() < 1e-12);
        let tiny = Image::new(1, 1, vec![[0.25; 3]]);
        assert_eq!(reduced(&tiny), tiny);
    }

    #[test]
    fn only_what_both_cover_may_differ() {
        let picture = Image::new(4, 1, vec![[0.1; 3], [0.2; 3], [0.0; 3], [0.0; 3]]);
        let truth = Image::new(4, 1, vec![[0.5; 3], [0.0; 3], [0.7; 3], [0.0; 3]]);
        let [picture, truth] = [picture, truth].map(|image| image.with_background([0.0; 3]));
        assert_eq!(covered_alike(&picture, &truth).pixels(), [[0.1; 3], [0.0; 3], [0.7; 3], [0.0; 3]]);
    }
}
