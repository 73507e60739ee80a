//! A scene drawn by an adapter and judged by the oracle.

use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::time::Duration;

use halfway::prelude::*;
use halfway::reference::metrics::{Bars, Verdict, judge_on_grid};
use halfway::reference::{Image, Oracle};
use halfway::render::{Adapter, RenderError};
use halfway::scene::{MeshEntry, SceneFile, spawn};
use serde_json::Value;

use crate::shrink::shrink;

/// Draws scenes with one adapter and judges the pictures by the oracle, as `halfway verify` does.
///
/// Everywhere, in floating point, a value may be off by 2 · 10⁻³ of the range, as by [`Bars::FLOAT`]. Its bar for 99.9
/// % of the values does not hold for all scenes: the judge takes a slope of more than 4 % of the range within 1/16 of a
/// pixel for an edge; on a gentler one half a unit of a grid of 1/256 of a pixel causes errors of up to 1.3 · 10⁻³, and
/// a small object may show hardly anything but slopes. A byte may be off by one step, and by one more for each blended
/// object, since each layer is rounded to bytes. Scenes with four samples a pixel are drawn and judged with one by
/// default.
pub struct Judge {
    adapter: Adapter,
    base_dir: PathBuf,
    grid: u32,
    four: bool,
    steps: Option<f32>,
    fault: Option<Fault>,
    /// Whether to stop at the first wrong pixel, without the figures.
    until_wrong: bool,
}

/// A change of the scene that only the renderer gets, to check that it is found.
pub type Fault = fn(&mut SceneFile);

/// The fault of a scene.
#[derive(Clone, Debug)]
pub enum Finding {
    /// The picture in floating point differs from the oracle's.
    Float(Box<Verdict>),
    /// The picture of bytes differs from the oracle's.
    Bytes(Box<Verdict>),
    /// The scene was read, and then not drawn.
    Refused(String),
    /// The format does not allow the scene.
    NoScene(String),
    /// The renderer or the oracle panicked.
    Panicked(String),
}

/// The figures of a right scene's pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// In floating point.
    pub float: Verdict,
    /// In bytes.
    pub bytes: Verdict,
    /// The largest error allowed by tolerances in the picture of bytes, in linear intensity.
    pub left_out: f64,
}

impl Finding {
    /// Whether two scenes fail in the same way, so that the smaller one may stand for the larger one.
    pub fn is_like(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Float(verdict) => write!(f, "float: {verdict}"),
            Self::Bytes(verdict) => write!(f, "8 bits: {verdict}"),
            Self::Refused(reason) => write!(f, "not drawn: {reason}"),
            Self::NoScene(reason) => write!(f, "no scene: {reason}"),
            Self::Panicked(reason) => write!(f, "panicked: {reason}"),
        }
    }
}

impl Judge {
    /// Judges the pictures of `adapter`. Paths of scenes are relative to `base_dir`.
    ///
    /// # Errors
    /// The adapter cannot draw the picture that measures its grid.
    pub fn new(adapter: Adapter, base_dir: impl Into<PathBuf>) -> Result<Self, RenderError> {
        let grid = adapter.sub_pixel_bits()?;
        Ok(Self { adapter, base_dir: base_dir.into(), grid, four: false, steps: None, fault: None, until_wrong: false })
    }

    /// Draws and judges scenes with four samples a pixel as they are. Adapters differ in where they shade a pixel that
    /// is covered in part, so that some pictures fail on adapters that are right.
    #[must_use]
    pub fn with_four_samples(self, four: bool) -> Self {
        Self { four, ..self }
    }

    /// Draws everything with this tolerance in steps, and judges it accordingly. Spheres, planes and teapots are
    /// refined, so that they have patches.
    #[must_use]
    pub fn within(self, steps: f32) -> Self {
        Self { steps: Some(steps), ..self }
    }

    /// Gives the renderer another scene than the oracle.
    #[must_use]
    pub fn with_fault(self, fault: Fault) -> Self {
        Self { fault: Some(fault), ..self }
    }

    /// Finds only whether a scene is wrong, much sooner if it is; the figures then cover only some pixels.
    #[must_use]
    pub fn until_wrong(self) -> Self {
        Self { until_wrong: true, ..self }
    }

    /// Reads the scene, draws it and judges its pictures.
    ///
    /// # Errors
    /// The fault, of the picture in floating point first.
    pub fn judge(&self, scene: &Value) -> Result<Figures, Finding> {
        let scene = SceneFile::from_json(&scene.to_string(), "scene");
        let mut scene = scene.map_err(|error| Finding::NoScene(error.to_string()))?;
        if !self.four {
            scene.samples = 1;
        }
        catch_unwind(AssertUnwindSafe(|| self.judge_unguarded(&scene))).unwrap_or_else(|panic| {
            let text = panic.downcast_ref::<String>().map(String::as_str);
            let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
            Err(Finding::Panicked(text.unwrap_or("without a message").into()))
        })
    }

    /// A smaller scene that fails in the same way, found with at most `trials` pictures.
    pub fn shrunk(&self, scene: &Value, finding: &Finding, trials: usize) -> Value {
        let hasty = Self { until_wrong: true, adapter: self.adapter.clone(), base_dir: self.base_dir.clone(), ..*self };
        shrink(scene, trials, |smaller| hasty.judge(smaller).is_err_and(|other| other.is_like(finding)))
    }

    fn judge_unguarded(&self, scene: &SceneFile) -> Result<Figures, Finding> {
        let size = UVec2::from_array(scene.size);
        let encoding = scene.output;
        let blended = scene.objects.iter().filter(|object| object.blend == Some(true)).count() as f64;
        let (mut drawn, mut judged) = (scene.clone(), scene.clone());
        if self.steps.is_some() {
            [&mut drawn, &mut judged].into_iter().for_each(refine);
        }
        let steps = self.steps.unwrap_or(0.0);
        if let Some(fault) = self.fault {
            fault(&mut drawn);
        }
        let mut renderer = App::new();
        renderer.add_plugins(HalfwayPlugins::headless(size));
        self.adapter.clone().insert_into(renderer.world_mut());
        self.set_up(&mut renderer, &drawn)?;
        renderer.insert_resource(ViewTolerance(Tolerance::steps(steps)));
        let mut pictures = Pictures { renderer, oracle: App::new(), size, encoding };
        pictures.oracle.add_plugins(HalfwayPlugins::reference());
        self.set_up(&mut pictures.oracle, &judged)?;
        pictures.oracle.update();

        pictures.figures(Limits { grid: self.grid, blended, steps: steps.into(), until_wrong: self.until_wrong })
    }

    fn set_up(&self, app: &mut App, scene: &SceneFile) -> Result<(), Finding> {
        spawn(scene, &self.base_dir, app.world_mut()).map_err(refused)?;
        app.insert_resource(bevy_time::TimeUpdateStrategy::ManualDuration(Duration::ZERO));
        app.finish();
        app.cleanup();
        Ok(())
    }
}

/// Refines meshes so that they have several patches.
fn refine(scene: &mut SceneFile) {
    for object in &mut scene.objects {
        match &mut object.mesh {
            MeshEntry::UvSphere(UvSphere { segments, rings, .. }) => {
                (*segments, *rings) = ((*segments).max(128), (*rings).max(64));
            }
            MeshEntry::Plane(Plane { divisions, .. }) => *divisions = (*divisions).max(64),
            MeshEntry::Teapot(Teapot { divisions }) => *divisions = (*divisions).max(14),
            _ => {}
        }
    }
}

/// One scene in two worlds.
struct Pictures {
    renderer: App,
    oracle: App,
    size: UVec2,
    encoding: Encoding,
}

/// The tolerances of the pictures.
#[derive(Clone, Copy)]
struct Limits {
    /// The bits of the adapter's grid within a pixel.
    grid: u32,
    /// The number of blended objects.
    blended: f64,
    /// The further error that is allowed, in steps.
    steps: f64,
    /// Whether only wrong or right is asked.
    until_wrong: bool,
}

impl Pictures {
    fn figures(&mut self, limits: Limits) -> Result<Figures, Finding> {
        let Limits { grid, blended, steps, until_wrong } = limits;
        let float = Bars { most: Bars::FLOAT.worst, until_wrong, ..Bars::FLOAT };
        let most = 1.0 + blended;
        let bytes = Bars { most, worst: most, equal: 0.0, until_wrong, ..Bars::bytes(self.encoding) };
        let float = self.judged(Pixels::Float, float.within(steps), grid)?;
        let bytes = self.judged(Pixels::Byte, bytes.within(steps), grid)?;
        if !float.is_within() {
            Err(Finding::Float(Box::new(float)))
        } else if !bytes.is_within() {
            Err(Finding::Bytes(Box::new(bytes)))
        } else {
            Ok(Figures { float, bytes, left_out: self.renderer.world().resource::<FrameReport>().left_out })
        }
    }

    fn judged(&mut self, pixels: Pixels, bars: Bars, grid: u32) -> Result<Verdict, Finding> {
        self.renderer.insert_resource(Headless { size: self.size, pixels });
        let actual = match render_picture(&mut self.renderer).map_err(refused::<RenderError>)? {
            Picture::Byte(image) => Image::from_bytes(&image, self.encoding),
            Picture::Float(image) => Image::from_float(&image),
        };
        let oracle = Oracle::new(self.oracle.world_mut(), self.size).map_err(refused)?;
        let oracle = oracle.with_clamping(bars.are_clamped());
        judge_on_grid(&oracle, &oracle.draw(), grid, &actual, bars).map_err(refused)
    }
}

fn refused<E: fmt::Display>(error: E) -> Finding {
    Finding::Refused(error.to_string())
}
