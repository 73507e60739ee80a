//! A scene drawn by an adapter and judged by the oracle.

use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::time::Duration;

use bevy_ecs::system::SystemState;
use halfway::lighting::{CameraTurn, SharedPart, SharingCameras};
use halfway::prelude::*;
use halfway::reference::metrics::{Bars, Verdict, judge_on_grid};
use halfway::reference::{Image, Oracle};
use halfway::render::{Adapter, PendingPicture, RenderError, Surfaces, draw_lines, has_lines};
use halfway::scene::{MeshEntry, SceneFile, spawn};
use image::{Rgba, Rgba32FImage};
use serde_json::Value;

use crate::shrink::shrink;

/// Draws scenes with one adapter and judges the pictures by the oracle, as `halfway verify` does.
///
/// Of cameras that share a picture each part is judged, unless another one covers it. Lines and points are no part of the
/// pictures that are judged: they are drawn by one code for all renderers, over the surfaces that each has found. It draws
/// them on grey over those of the adapter and over those of the oracle, and what is far from where these differ must be
/// equal.
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
    /// Lines or points differ far from all surfaces that do.
    Lines(String),
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
            Self::Lines(reason) => write!(f, "lines: {reason}"),
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
            scene.all_cameras_mut().for_each(|camera| camera.samples = None);
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
            self.judge_lines()?;
            Ok(Figures { float, bytes, left_out: self.renderer.world().resource::<FrameReport>().left_out })
        }
    }

    /// The verdict of the picture, or of the worst of its parts.
    fn judged(&mut self, pixels: Pixels, bars: Bars, grid: u32) -> Result<Verdict, Finding> {
        self.renderer.insert_resource(Headless { size: self.size, pixels });
        self.renderer.update();
        let world = self.renderer.world_mut();
        if let Some(error) = world.resource::<FrameReport>().errors.first() {
            return Err(refused(error));
        }
        // Without lines, which are drawn over it.
        let picture = PendingPicture::request(world).and_then(PendingPicture::wait).map_err(refused)?;
        let parts = sharing(self.oracle.world_mut(), self.size);
        if parts.is_empty() {
            return self.judged_part(&picture, self.size, bars, grid);
        }
        let mut worst = None;
        for (number, part) in parts.iter().enumerate() {
            if parts[number + 1..].iter().any(|later| overlap(part, later)) {
                continue;
            }
            let &SharedPart { camera, corner, size, .. } = part;
            let (corner, size) = (UVec2::from(corner), UVec2::from(size));
            self.oracle.insert_resource(CameraTurn(Some(camera)));
            let verdict = self.judged_part(&picture.part(corner, size), size, bars, grid);
            self.oracle.insert_resource(CameraTurn(None));
            let verdict = verdict?;
            if !verdict.is_within() {
                return Ok(verdict);
            }
            worst = worst.filter(|worst: &Verdict| worst.worst >= verdict.worst).or(Some(verdict));
        }
        worst.ok_or_else(|| refused("cameras cover each other"))
    }

    fn judged_part(&mut self, picture: &Picture, size: UVec2, bars: Bars, grid: u32) -> Result<Verdict, Finding> {
        let actual = match picture {
            Picture::Byte(image) => Image::from_bytes(image, self.encoding),
            Picture::Float(image) => Image::from_float(image),
        };
        let oracle = Oracle::new(self.oracle.world_mut(), size).map_err(refused)?;
        let oracle = oracle.with_clamping(bars.are_clamped());
        judge_on_grid(&oracle, &oracle.draw(), grid, &actual, bars).map_err(refused)
    }

    /// Compares the lines and points of a scene of one camera.
    fn judge_lines(&mut self) -> Result<(), Finding> {
        let size = self.size;
        if !has_lines(self.renderer.world()) || !sharing(self.oracle.world_mut(), size).is_empty() {
            return Ok(());
        }
        let of_renderer = Surfaces::take(self.renderer.world_mut()).map_err(refused)?;
        let world = self.oracle.world_mut();
        let oracle = Oracle::new(world, size).map_err(refused)?;
        let of_oracle = Surfaces::found_by(world, size, |x, y| {
            let nearest = oracle.probe(f64::from(x) + 0.5, f64::from(y) + 0.5).nearest?;
            Some((nearest.object, nearest.triangle?))
        });
        let of_oracle = of_oracle.map_err(refused)?;
        let drawn = |world: &mut World, surfaces: &Surfaces| {
            let mut picture = Picture::Float(Rgba32FImage::from_pixel(size.x, size.y, Rgba([GREY, GREY, GREY, 1.0])));
            draw_lines(world, &mut picture, surfaces).map_err(refused)?;
            let Picture::Float(picture) = picture else { return Err(refused("a picture of bytes")) };
            Ok(picture)
        };
        let actual = drawn(self.renderer.world_mut(), &of_renderer)?;
        let expected = drawn(self.oracle.world_mut(), &of_oracle)?;
        // Entities are others in the other world.
        let place = |surfaces: &Surfaces, x, y| surfaces.at(x, y).map(|it| (it.object, it.part, it.triangle));
        let pixels = || (0..size.y).flat_map(|y| (0..size.x).map(move |x| UVec2::new(x, y)));
        let differing = pixels().filter(|at| place(&of_renderer, at.x, at.y) != place(&of_oracle, at.x, at.y));
        let differing: Vec<UVec2> = differing.collect();
        let wrong = pixels().find(|at| {
            let [a, b] = [&actual, &expected].map(|picture| picture.get_pixel(at.x, at.y).0);
            let is_equal = a.iter().zip(b).all(|(a, b)| (a - b).abs() <= LINE_ROUNDING * (1.0 + b.abs()));
            !is_equal && differing.iter().all(|other| other.as_ivec2().distance_squared(at.as_ivec2()) > FAR * FAR)
        });
        match wrong {
            Some(UVec2 { x, y }) => {
                let [a, b] = [actual, expected].map(|picture| picture.get_pixel(x, y).0);
                Err(Finding::Lines(format!("({x}, {y}) is {a:?} instead of {b:?}")))
            }
            None => Ok(()),
        }
    }
}

/// The picture that lines are drawn on.
const GREY: f32 = 0.5;
/// Rounding of the same computation on the same numbers.
const LINE_ROUNDING: f32 = 1e-5;
/// As far from a surface, in pixels, what it hides may reach: half of the widest line and its neighbours.
const FAR: i32 = 24;

fn sharing(world: &mut World, size: UVec2) -> Vec<SharedPart> {
    let mut cameras = SystemState::<SharingCameras>::new(world);
    cameras.get(world).map(|cameras| cameras.parts(size.to_array())).unwrap_or_default()
}

/// Whether two parts of a picture have a pixel in common.
fn overlap(a: &SharedPart, b: &SharedPart) -> bool {
    (0..2).all(|axis| a.corner[axis] < b.corner[axis] + b.size[axis] && b.corner[axis] < a.corner[axis] + a.size[axis])
}

fn refused<E: fmt::Display>(error: E) -> Finding {
    Finding::Refused(error.to_string())
}
