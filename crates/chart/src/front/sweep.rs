//! Measures points.

use std::collections::HashMap;

use halfway::prelude::*;
use halfway::reference::Image;
use halfway::reference::metrics::{self, Scale};
use halfway::render::Adapter;
use image::RgbImage;
use rayon::prelude::*;

use super::errors::{Drawn, PointErrors, Truth};
use super::stage::{SceneStage, SimplifiedMeshes};
use super::{ChartedScene, FrontPoint, KeptResults, Method, SceneDetail};
use crate::measure::{MeasureError, MeasureProgress};
use crate::page::data_uri;
use crate::timing::{Spread, in_turns, ratios};

/// How much is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontPlan {
    /// By what the sides of pictures are divided.
    pub smaller: u32,
    /// The most details of a scene, the coarsest and the finest among them.
    pub details: usize,
    /// Every method, or the few that tell most.
    pub all_methods: bool,
    /// How often every method is timed in turn, at most.
    pub rounds: u32,
    /// The time in milliseconds that the timed frames of one method may take at one detail; 3 rounds are made at least.
    pub budget_ms: f64,
    /// Samples along each side of a pixel, for the truth about its average.
    pub samples: u32,
    /// What is left out.
    pub only: FrontFilter,
}

/// What is measured of all that there is; all of it by default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrontFilter {
    /// The methods of these names ([`Method::id`]); all for none.
    pub methods: Vec<String>,
    /// The detail of this name ([`SceneDetail::id`]).
    pub detail: Option<String>,
}

/// Something that draws.
#[derive(Clone)]
pub struct ChartedAdapter {
    /// The name that it was opened by.
    pub name: String,
    /// Itself.
    pub adapter: Adapter,
}

/// One scene, what it should look like, and everything that was measured of it.
#[derive(Clone, Debug, Default)]
pub struct MeasuredScene {
    /// Its name.
    pub name: String,
    /// What there is to see.
    pub about: String,
    /// What errors are errors from.
    pub truth: String,
    /// The oracle's picture, small, as a `data:` address.
    pub picture: String,
    /// The size of the pictures that were measured, in pixels.
    pub size: UVec2,
    /// Every adapter, detail and method; in this order, the last the quickest to change.
    pub points: Vec<FrontPoint>,
}

/// How many Apps take turns: enough that the reference frame costs little, few enough for the memory of a small
/// machine.
const TOGETHER: usize = 8;
/// The fewest rounds that a median is taken of, however long a frame takes: one that is disturbed then leaves it alone.
const LEAST: u32 = 3;
/// The longer side that small pictures have at most, in pixels.
const SMALL: u32 = 240;

/// One App's worth of work.
#[derive(Clone, Copy)]
struct Task<'a> {
    scene: &'a ChartedScene,
    detail: SceneDetail,
    method: Method,
}

impl Task<'_> {
    /// What is known of its point before it is measured.
    fn point(self, plan: &FrontPlan, adapter: &ChartedAdapter) -> FrontPoint {
        let Self { scene, detail, method } = self;
        let command = ["halfway chart", &scene.name, "--detail", &detail.id(), "--method", &method.id()].join(" ");
        FrontPoint {
            scene: scene.name.clone(),
            method: method.id(),
            words: method.words(),
            family: method.family().name().to_owned(),
            tolerance: method.tolerance(),
            detail: detail.id(),
            detail_words: detail.words(),
            backend: adapter.name.clone(),
            command: format!("{command} --adapter {}{}", adapter.name, if plan.smaller > 1 { " --quick" } else { "" }),
            ..FrontPoint::default()
        }
    }
}

impl FrontPlan {
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

    /// The methods that a scene is drawn with.
    pub fn methods_of(&self, scene: &ChartedScene) -> Vec<Method> {
        let every = Method::all(scene.reflectance);
        if self.only.methods.is_empty() {
            return if self.all_methods { every } else { Method::few(scene.reflectance) };
        }
        let far = every.iter().map(|method| Method { far_lights: true, ..*method });
        let all: Vec<Method> = every.iter().copied().chain(far).collect();
        // In the order in which they are asked for.
        self.only.methods.iter().filter_map(|only| all.iter().find(|method| method.id() == *only)).copied().collect()
    }

    /// The units of [`MeasureProgress`] that [`sweep`] will report.
    pub fn units(&self, scenes: &[ChartedScene], adapters: usize) -> u64 {
        let of = |scene| 1 + adapters * self.details_of(scene).len() * self.methods_of(scene).len();
        scenes.iter().map(|scene| of(scene) as u64).sum()
    }

    fn size_of(&self, scene: &ChartedScene) -> UVec2 {
        (scene.size / self.smaller).max(UVec2::ONE)
    }

    fn key(&self, task: Task<'_>, adapter: &ChartedAdapter) -> String {
        let Task { scene, detail, method } = task;
        let size = self.size_of(scene);
        let (rounds, samples) = (self.rounds, self.samples);
        let parts = [&scene.name, &detail.id(), &method.id(), &adapter.name].map(String::as_str).join(" ");
        format!("{parts} {size} {rounds} {samples}")
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
    kept: &mut KeptResults,
    progress: &mut MeasureProgress<'_>,
) -> Result<Vec<MeasuredScene>, MeasureError> {
    scenes.iter().map(|scene| of_scene(plan, scene, adapters, kept, progress)).collect()
}

fn of_scene(
    plan: &FrontPlan,
    scene: &ChartedScene,
    adapters: &[ChartedAdapter],
    kept: &mut KeptResults,
    progress: &mut MeasureProgress<'_>,
) -> Result<MeasuredScene, MeasureError> {
    progress.begin(&format!("{}, the truth", scene.name));
    let size = plan.size_of(scene);
    let mut judged = None;
    let key = format!("truth {} {size} {}", scene.name, plan.samples);
    let picture = if let Some(picture) = kept.find(&key) {
        picture
    } else {
        let picture = needed(&mut judged, plan, scene)?.picture()?;
        kept.keep(&key, &picture).map_err(MeasureError::Keep)?;
        picture
    };
    progress.advance(1, &scene.name);
    let mut points = Vec::new();
    for adapter in adapters {
        let mut reference = None;
        for detail in plan.details_of(scene) {
            let tasks = plan.methods_of(scene).into_iter().map(|method| Task { scene, detail, method });
            let (old, new): (Vec<_>, Vec<_>) = tasks
                .map(|task| (task, kept.find::<FrontPoint>(&plan.key(task, adapter))))
                .partition(|(_, known)| known.is_some());
            progress.advance(old.len() as u64, &scene.name);
            points.extend(old.into_iter().filter_map(|(_, point)| point));
            let new: Vec<Task<'_>> = new.into_iter().map(|(task, _)| task).collect();
            for tasks in new.chunks(TOGETHER) {
                progress.begin(&format!("{}, {} on {}", scene.name, detail.words(), adapter.name));
                let judged = needed(&mut judged, plan, scene)?;
                let reference = match &mut reference {
                    Some(reference) => reference,
                    none => none.insert(judged.reference(scene, adapter)?),
                };
                for (task, point) in tasks.iter().zip(judged.measure(plan, tasks, adapter, reference)?) {
                    kept.keep(&plan.key(*task, adapter), &point).map_err(MeasureError::Keep)?;
                    points.push(point);
                }
                progress.advance(tasks.len() as u64, &scene.name);
            }
        }
    }
    // What was known already came first.
    let methods: Vec<String> = plan.methods_of(scene).into_iter().map(Method::id).collect();
    let details: Vec<String> = plan.details_of(scene).into_iter().map(SceneDetail::id).collect();
    let place = |list: &[String], name: &String| list.iter().position(|other| other == name);
    points.sort_by_key(|point: &FrontPoint| {
        let adapter = adapters.iter().position(|adapter| adapter.name == point.backend);
        (adapter, place(&details, &point.detail), place(&methods, &point.method))
    });
    let ChartedScene { name, about, truth, .. } = scene;
    Ok(MeasuredScene { name: name.clone(), about: about.clone(), truth: truth.clone(), picture, size, points })
}

/// The truth about a scene, found out when it is first needed: not where everything is known already.
fn needed<'a>(
    judged: &'a mut Option<Judged>,
    plan: &FrontPlan,
    scene: &ChartedScene,
) -> Result<&'a mut Judged, MeasureError> {
    Ok(match judged {
        Some(judged) => judged,
        none => none.insert(Judged::new(plan, scene)?),
    })
}

/// A scene with what it should look like.
struct Judged {
    truth: Truth,
    encoding: Encoding,
    size: UVec2,
    /// What one sample covers, by adapter and detail.
    covered: HashMap<(String, String), Vec<bool>>,
    meshes: SimplifiedMeshes,
}

impl Judged {
    fn new(plan: &FrontPlan, scene: &ChartedScene) -> Result<Self, MeasureError> {
        let size = plan.size_of(scene);
        let (truth, encoding) = SceneStage::truth(scene, size, plan.samples)?;
        Ok(Self { truth, encoding, size, covered: HashMap::new(), meshes: SimplifiedMeshes::default() })
    }

    /// What it should look like, small.
    fn picture(&self) -> Result<String, MeasureError> {
        data_uri(&reduced(&self.truth.average).to_bytes(self.encoding)).map_err(MeasureError::Picture)
    }

    /// The coarsest detail in a constant colour.
    fn reference(&mut self, scene: &ChartedScene, adapter: &ChartedAdapter) -> Result<SceneStage, MeasureError> {
        let coarsest =
            *scene.details.first().ok_or_else(|| MeasureError::Scene(format!("{}: no details", scene.name)))?;
        let mut stage =
            SceneStage::drawn(scene, coarsest, Method::CONSTANT, self.size, &adapter.adapter, &mut self.meshes)?;
        stage.move_on()?;
        Ok(stage)
    }

    fn covered(&mut self, task: Task<'_>, adapter: &ChartedAdapter) -> Result<Vec<bool>, MeasureError> {
        let key = (adapter.name.clone(), task.detail.id());
        if let Some(covered) = self.covered.get(&key) {
            return Ok(covered.clone());
        }
        let stage = SceneStage::drawn(
            task.scene,
            task.detail,
            Method::CONSTANT,
            self.size,
            &adapter.adapter,
            &mut self.meshes,
        )?;
        Ok(self.covered.entry(key).or_insert(stage.coverage()?).clone())
    }

    /// A point for each of the tasks, which are all of one detail.
    fn measure(
        &mut self,
        plan: &FrontPlan,
        tasks: &[Task<'_>],
        adapter: &ChartedAdapter,
        reference: &mut SceneStage,
    ) -> Result<Vec<FrontPoint>, MeasureError> {
        let Some(first) = tasks.first() else { return Ok(Vec::new()) };
        let covered = self.covered(*first, adapter)?;
        let mut stages = Vec::new();
        let mut drawn = Vec::new();
        for &Task { scene, detail, method } in tasks {
            let mut stage = SceneStage::drawn(scene, detail, method, self.size, &adapter.adapter, &mut self.meshes)?;
            drawn.push(stage.pictures(method, &covered, self.encoding)?);
            stage.move_on()?;
            stages.push(stage);
        }
        let mut apps = vec![reference.app()];
        apps.extend(stages.iter_mut().map(SceneStage::app));
        let times = in_time(&mut apps, plan)?;
        let judged = drawn.par_iter().map(|drawn| self.judge(drawn)).collect::<Result<Vec<_>, _>>()?;
        let timed = times[1..].iter().map(|own| (Spread::of(own), ratios(own, &times[0])));
        let found = tasks.iter().zip(&stages).zip(timed).zip(judged);
        let points = found.map(|(((task, stage), (ms, ratio)), (errors, pictures))| {
            let [picture, difference] = pictures;
            let triangles = stage.triangles();
            FrontPoint { triangles, ms, ratio, errors, picture, difference, ..task.point(plan, adapter) }
        });
        Ok(points.collect())
    }

    /// Errors, and the small pictures.
    fn judge(&self, drawn: &Drawn) -> Result<(PointErrors, [String; 2]), MeasureError> {
        let truth = &self.truth.average;
        let errors = PointErrors::of(drawn, &self.truth, self.encoding)?;
        let [small, small_truth] = [&drawn.bytes, truth].map(reduced);
        // Steps of the largest error of the small picture, so that all of it is seen.
        let difference = metrics::difference(&small, &small_truth, self.encoding, Scale::default())?;
        let pictures: [RgbImage; 2] = [small.to_bytes(self.encoding), difference];
        let [picture, difference] = pictures.map(|picture| data_uri(&picture));
        Ok((errors, [picture.map_err(MeasureError::Picture)?, difference.map_err(MeasureError::Picture)?]))
    }
}

/// The times of as many rounds as the plan has time for.
fn in_time(apps: &mut [&mut App], plan: &FrontPlan) -> Result<Vec<Vec<f64>>, MeasureError> {
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

/// The picture with squares of pixels averaged, so that no side is longer than [`SMALL`]. What is left over at the
/// right and the bottom is dropped.
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
