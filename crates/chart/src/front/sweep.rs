//! Measures the points.

use halfway::prelude::*;
use halfway::reference::Image;
use halfway::reference::metrics::{self, Scale};
use halfway::render::Adapter;
use rayon::prelude::*;

use super::errors::{AreaErrors, PointErrors, Truth};
use super::stage::{SceneStage, SimplifiedMeshes};
use super::{ChartedScene, FrontPoint, Method, SceneDetail};
use crate::error::ChartError;
use crate::page::data_uri;
use crate::pareto;
use crate::progress::Progress;
use crate::timing::{Spread, in_turns, ratios};

/// The extent of the measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontPlan {
    /// The divisor of the sides of pictures.
    pub smaller: u32,
    /// The most details of a scene, the coarsest and the finest among them.
    pub details: usize,
    /// Whether to measure every method, or the most informative few.
    pub all_methods: bool,
    /// The most rounds in which every method is timed in turn.
    pub rounds: u32,
    /// The time in milliseconds that the timed frames of one method may take at one detail; 3 rounds are made at least.
    pub budget_ms: f64,
    /// Samples along each side of a pixel, for the truth about its average.
    pub samples: u32,
    /// A filter for the measurements.
    pub only: FrontFilter,
}

/// A filter for the measurements; empty by default, which measures all.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrontFilter {
    /// The methods of these names ([`Method::id`]); all for none.
    pub methods: Vec<String>,
    /// The detail of this name ([`SceneDetail::id`]).
    pub detail: Option<String>,
}

/// An adapter with its name.
#[derive(Clone)]
pub struct ChartedAdapter {
    /// The name that it was opened by.
    pub name: String,
    /// Itself.
    pub adapter: Adapter,
}

/// One scene, its truth, and its measurements.
#[derive(Clone, Debug, Default)]
pub struct MeasuredScene {
    /// Its name.
    pub name: String,
    /// Its subject.
    pub about: String,
    /// The reference of the errors.
    pub truth: String,
    /// The oracle's picture, small, as a `data:` address.
    pub picture: String,
    /// The points of every adapter, detail and method; in this order, the last varying fastest.
    pub points: Vec<FrontPoint>,
}

/// The number of Apps that take turns: enough that the reference frame costs little, few enough for the memory of a
/// small machine.
const TOGETHER: usize = 8;
/// The fewest rounds of a median, however long a frame takes, so that a single disturbance does not change it.
const LEAST: u32 = 3;
/// The longer side that small pictures have at most, in pixels.
const SMALL: u32 = 240;

impl FrontPlan {
    /// The plan of the project's own figures: half an hour on two cores without a GPU.
    pub const FULL: Self = Self {
        smaller: 1,
        details: 5,
        all_methods: true,
        rounds: 25,
        budget_ms: 2000.0,
        samples: 4,
        only: FrontFilter { methods: Vec::new(), detail: None },
    };
    /// Fewer methods, details, rounds and pixels: for a first impression, and for CI.
    pub const QUICK: Self = Self {
        smaller: 2,
        details: 3,
        all_methods: false,
        rounds: 7,
        budget_ms: 100.0,
        samples: 2,
        only: FrontFilter { methods: Vec::new(), detail: None },
    };

    /// The details of a scene that are measured.
    pub fn details_of(&self, scene: &ChartedScene) -> Vec<SceneDetail> {
        let all = &scene.details;
        if let Some(only) = &self.only.detail {
            return all.iter().copied().filter(|detail| detail.id() == *only).collect();
        }
        let count = self.details.clamp(1, all.len().max(1));
        let place = |i: usize| i * (all.len().saturating_sub(1)) / (count - 1).max(1);
        (0..count).filter_map(|i| all.get(place(i)).copied()).collect()
    }

    /// The methods for a scene.
    pub fn methods_of(&self, scene: &ChartedScene) -> Vec<Method> {
        let every = Method::all(scene.reflectance);
        if self.only.methods.is_empty() {
            return if self.all_methods { every } else { Method::few(scene.reflectance) };
        }
        let far = every.iter().map(|method| Method { far_lights: true, ..*method });
        let all: Vec<Method> = every.iter().copied().chain(far).collect();
        // In the order of the filter.
        self.only.methods.iter().filter_map(|only| all.iter().find(|method| method.id() == *only)).copied().collect()
    }

    /// The units of [`Progress`] that [`sweep`] reports.
    pub fn units(&self, scenes: &[ChartedScene], adapters: usize) -> u64 {
        let of = |scene| 1 + adapters * self.details_of(scene).len() * self.methods_of(scene).len();
        scenes.iter().map(|scene| of(scene) as u64).sum()
    }
}

/// Measures every scene.
///
/// # Errors
/// The first picture that could not be drawn.
pub fn sweep(
    plan: &FrontPlan,
    scenes: &[ChartedScene],
    adapters: &[ChartedAdapter],
    progress: &mut Progress<'_>,
) -> Result<Vec<MeasuredScene>, ChartError> {
    let measured = scenes.iter().map(|scene| measure_scene(plan, scene, adapters, progress));
    let mut measured = measured.collect::<Result<Vec<_>, _>>()?;
    let points = measured.iter_mut().flat_map(|scene| &mut scene.points);
    points.enumerate().for_each(|(place, point)| point.place = place);
    Ok(measured)
}

fn measure_scene(
    plan: &FrontPlan,
    scene: &ChartedScene,
    adapters: &[ChartedAdapter],
    progress: &mut Progress<'_>,
) -> Result<MeasuredScene, ChartError> {
    progress.begin(&format!("{}, the truth", scene.name));
    let mut judge = Judge::new(plan, scene)?;
    let picture = data_uri(&reduced(&judge.truth.average).to_bytes(judge.encoding))?;
    progress.advance(1, &scene.name);
    let coarsest = scene.details.first().ok_or_else(|| ChartError::Scene(format!("{}: no details", scene.name)))?;
    let mut points = Vec::new();
    for adapter in adapters {
        let mut reference = judge.stage(*coarsest, Method::CONSTANT, adapter)?;
        reference.move_on()?;
        let first = points.len();
        for detail in plan.details_of(scene) {
            let covered = judge.stage(detail, Method::CONSTANT, adapter)?.coverage()?;
            for methods in plan.methods_of(scene).chunks(TOGETHER) {
                progress.begin(&format!("{}, {} on {}", scene.name, detail.words(), adapter.name));
                points.extend(judge.measure((adapter, detail), methods, &covered, &mut reference)?);
                progress.advance(methods.len() as u64, &scene.name);
            }
        }
        mark_fronts(&mut points[first..]);
    }
    let ChartedScene { name, about, truth, .. } = scene;
    Ok(MeasuredScene { name: name.clone(), about: about.clone(), truth: truth.clone(), picture, points })
}

/// Marks the points of one scene and adapter that are on its fronts.
fn mark_fronts(points: &mut [FrontPoint]) {
    let front = |area: fn(&PointErrors) -> &AreaErrors| {
        pareto::front(&points.iter().map(|point| point.time_and_error(area)).collect::<Vec<_>>())
    };
    let (covered, whole) = (front(|errors| &errors.covered), front(|errors| &errors.whole));
    for (i, point) in points.iter_mut().enumerate() {
        (point.front, point.front_whole) = (covered.contains(&i), whole.contains(&i));
    }
}

/// A scene with its truth.
struct Judge<'a> {
    plan: &'a FrontPlan,
    scene: &'a ChartedScene,
    size: UVec2,
    truth: Truth,
    encoding: Encoding,
    meshes: SimplifiedMeshes,
}

impl<'a> Judge<'a> {
    fn new(plan: &'a FrontPlan, scene: &'a ChartedScene) -> Result<Self, ChartError> {
        let size = (scene.size / plan.smaller).max(UVec2::ONE);
        let (truth, encoding) = SceneStage::truth(scene, size, plan.samples)?;
        Ok(Self { plan, scene, size, truth, encoding, meshes: SimplifiedMeshes::default() })
    }

    fn stage(
        &mut self,
        detail: SceneDetail,
        method: Method,
        adapter: &ChartedAdapter,
    ) -> Result<SceneStage, ChartError> {
        SceneStage::drawn(self.scene, detail, method, self.size, &adapter.adapter, &mut self.meshes)
    }

    /// A point for each of the methods. `covered` is the coverage with one sample at this detail.
    fn measure(
        &mut self,
        (adapter, detail): (&ChartedAdapter, SceneDetail),
        methods: &[Method],
        covered: &[bool],
        reference: &mut SceneStage,
    ) -> Result<Vec<FrontPoint>, ChartError> {
        let mut stages = Vec::new();
        let mut drawn = Vec::new();
        for &method in methods {
            let mut stage = self.stage(detail, method, adapter)?;
            drawn.push((method, stage.picture(self.encoding)?.with_coverage(covered.to_vec())));
            stage.move_on()?;
            stages.push(stage);
        }
        let mut apps = vec![reference.app()];
        apps.extend(stages.iter_mut().map(SceneStage::app));
        let times = in_time(&mut apps, self.plan)?;
        let (truth, encoding) = (&self.truth, self.encoding);
        let judged = drawn.par_iter().map(|drawn| judge(drawn, truth, encoding)).collect::<Result<Vec<_>, _>>()?;
        let found = methods.iter().zip(&stages).zip(&times[1..]).zip(judged);
        let points = found.map(|(((method, stage), own), (errors, [picture, difference]))| FrontPoint {
            triangles: stage.triangles(),
            ms: Spread::from_values(own),
            ratio: ratios(own, &times[0]),
            errors,
            picture,
            difference,
            ..self.unmeasured(detail, *method, adapter)
        });
        Ok(points.collect())
    }

    /// The known data of a point before it is measured.
    fn unmeasured(&self, detail: SceneDetail, method: Method, adapter: &ChartedAdapter) -> FrontPoint {
        let (scene, adapter) = (self.scene.name.clone(), adapter.name.clone());
        let (id, method_id) = (detail.id(), method.id());
        let quick = if self.plan.smaller > 1 { " --quick" } else { "" };
        FrontPoint {
            command: format!("halfway chart {scene} --detail {id} --method {method_id} --adapter {adapter}{quick}"),
            scene,
            method: method_id,
            words: method.words(),
            family: method.family().name().to_owned(),
            detail: id,
            detail_words: detail.words(),
            adapter,
            ..FrontPoint::default()
        }
    }
}

/// Errors, and the small pictures: as drawn, and the difference.
fn judge(
    (method, picture): &(Method, Image),
    truth: &Truth,
    encoding: Encoding,
) -> Result<(PointErrors, [String; 2]), ChartError> {
    let errors = PointErrors::new(picture, method.samples, truth, encoding)?;
    let [small, truth] = [picture, &truth.average].map(reduced);
    // The scale fits the largest error of the small picture, so that all of it is visible.
    let difference = metrics::difference(&small, &truth, encoding, Scale::default())?;
    Ok((errors, [data_uri(&small.to_bytes(encoding))?, data_uri(&difference)?]))
}

/// The times of as many rounds as the plan allows.
fn in_time(apps: &mut [&mut App], plan: &FrontPlan) -> Result<Vec<Vec<f64>>, ChartError> {
    let first = plan.rounds.min(LEAST);
    let mut times = in_turns(apps, first)?;
    let round =
        times.iter().map(|own| own.iter().sum::<f64>() / f64::from(first.max(1))).fold(f64::MIN_POSITIVE, f64::max);
    let more = (plan.budget_ms / round) as u32;
    let more = in_turns(apps, more.min(plan.rounds).saturating_sub(first))?;
    for (own, more) in times.iter_mut().zip(more) {
        own.extend(more);
    }
    Ok(times)
}

/// The picture with squares of pixels averaged, so that no side is longer than [`SMALL`]. The remainder at the right
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_pictures_are_averages() {
        let pixels = (0..481 * 2).map(|i| [f64::from(i % 481), 1.0, 0.0]).collect();
        let small = reduced(&Image::new(481, 3, [pixels, vec![[9.0; 3]; 481]].concat()));
        // 481 needs squares of 3 × 3.
        assert_eq!(small.dimensions(), (160, 1));
        let [r, g, b] = small.pixel(1, 0);
        // Columns 3, 4, 5 in two rows, and three pixels of 9.
        assert!((r - (2.0 * 12.0 + 27.0) / 9.0).abs() < 1e-12);
        assert!((g - 33.0 / 9.0).abs() < 1e-12 && (b - 3.0).abs() < 1e-12);
        let tiny = Image::new(1, 1, vec![[0.25; 3]]);
        assert_eq!(reduced(&tiny), tiny);
    }
}
