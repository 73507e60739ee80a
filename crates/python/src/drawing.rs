//! Scenes that are drawn.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use bevy_app::SubApp;
use bevy_time::TimeUpdateStrategy;
use halfway::lighting::equations::srgb_encoded;
use halfway::lighting::{Choices, Term};
use halfway::output::ContactSheet;
use halfway::prelude::*;
use halfway::reference::marking::Rubric;
use halfway::render::{EmptyReason, why_empty};
use halfway::scene::options::{
    SceneOptions, parse, remove_what_is_laid_over, scene_of_models, unknown_material, views,
};
use halfway::scene::{
    CameraEntry, LightEntry, LoadedModel, MeshEntry, ObjectEntry, PartOfLight, SceneFile, SceneTime, Spawned,
    Turntable, outline, spawn, spawn_seen_from,
};
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyDict};

use crate::mesh::Mesh as PyMesh;
use crate::pictures::{Given, Pixels as PyPixels, floats, to_python};
use crate::reference::{Judged, explained, judge_given, mark_given, reference_picture};
use crate::work::{Failure, detached};

/// A scene with its meshes, spawned into an App that is kept from picture to picture.
#[pyclass(frozen, module = "halfway._halfway")]
pub(crate) struct Drawing(Mutex<Stage>);

/// All that a scene is made of.
#[derive(Clone)]
pub(crate) struct Recipe {
    pub(crate) scene: SceneFile,
    base_dir: PathBuf,
    camera: Option<String>,
    options: SceneOptions,
    renderer: Renderer,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Renderer {
    Cpu,
    Reference,
}

struct Stage {
    recipe: Recipe,
    played: Option<Played>,
    warnings: Vec<String>,
}

/// The App of this process.
struct Played {
    app: SubApp,
    spawned: Spawned,
    process: u32,
}

impl Recipe {
    /// Whether the camera stands where the objects want it.
    fn frames_objects(&self) -> bool {
        let is_framed = |camera: &CameraEntry| camera.view.is_some() || camera.fit.is_some();
        self.scene.all_cameras().any(is_framed) || self.scene.all_cameras().next().is_none()
    }

    /// The scene in an App.
    pub(crate) fn play(&self) -> Result<(App, Spawned), Failure> {
        let mut app = App::new();
        match self.renderer {
            Renderer::Cpu => app.add_plugins(HalfwayPlugins::headless(UVec2::from_array(self.scene.size))),
            Renderer::Reference => app.add_plugins(HalfwayPlugins::reference()),
        };
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
        let world = app.world_mut();
        let spawned = match &self.camera {
            None => spawn(&self.scene, &self.base_dir, world),
            Some(camera) => spawn_seen_from(&self.scene, &self.base_dir, camera, world),
        };
        let spawned = spawned.map_err(Failure::input)?;
        app.finish();
        app.cleanup();
        Ok((app, spawned))
    }
}

impl Stage {
    /// Does something with the App, which is spawned where there is none in this process.
    fn with<T>(&mut self, work: impl FnOnce(&mut App, &Spawned, &Recipe) -> Result<T, Failure>) -> Result<T, Failure> {
        let process = std::process::id();
        if self.played.as_ref().is_some_and(|played| played.process != process) {
            // Its threads are the parent's, and would be waited for.
            std::mem::forget(self.played.take());
        }
        let (mut app, spawned) = if let Some(Played { app: kept, spawned, .. }) = self.played.take() {
            let mut app = App::empty();
            *app.main_mut() = kept;
            (app, spawned)
        } else {
            let (app, spawned) = self.recipe.play()?;
            self.warnings.extend(spawned.warnings.iter().cloned());
            (app, spawned)
        };
        // Where the work panics, the App is not kept.
        let done = work(&mut app, &spawned, &self.recipe);
        let app = std::mem::take(app.main_mut());
        self.played = Some(Played { app, spawned, process });
        done
    }
}

impl Drawing {
    fn stage(&self) -> MutexGuard<'_, Stage> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Works with the App, without the interpreter's lock.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut App, &Spawned, &Recipe) -> Result<T, Failure> + Send,
    ) -> PyResult<T> {
        detached(py, move || self.stage().with(work))
    }
}

#[pymethods]
impl Drawing {
    /// `scene` is the text of a scene file, in which the mesh `{"path": "N.mesh"}` is the N-th of `meshes`. `options` are
    /// names and texts of options. `size` is that of the pictures.
    #[new]
    #[pyo3(signature = (scene, origin, base_dir, meshes, options, size=None, camera=None, reference=false))]
    #[expect(clippy::too_many_arguments, reason = "they have names in Python")]
    fn new(
        py: Python<'_>,
        scene: &str,
        origin: &str,
        base_dir: PathBuf,
        meshes: Vec<PyRef<'_, PyMesh>>,
        options: Vec<(String, String)>,
        size: Option<[u32; 2]>,
        camera: Option<String>,
        reference: bool,
    ) -> PyResult<Self> {
        let models: HashMap<PathBuf, LoadedModel> = meshes
            .iter()
            .enumerate()
            .map(|(number, mesh)| {
                let (path, model) = (mesh.name.clone(), mesh.model.clone());
                (format!("{number}.mesh.obj").into(), LoadedModel { path, model, material: unknown_material() })
            })
            .collect();
        let mut given = SceneOptions::default();
        for (name, text) in &options {
            given.set(name, text).map_err(Failure::Input)?;
        }
        detached(py, move || {
            let mut scene = SceneFile::from_json(scene, origin).map_err(Failure::input)?;
            for object in &mut scene.objects {
                if let MeshEntry::Path(path) = &object.mesh
                    && let Some(model) = models.get(path)
                {
                    object.mesh = MeshEntry::Model(model.clone());
                }
            }
            // In Python the scene says its samples.
            given.samples = given.samples.or(Some(scene.samples));
            if let Some(size) = size {
                scene.size = size;
            }
            given.apply(&mut scene);
            scene.validate().map_err(Failure::input)?;
            let warnings = scene.warnings.clone();
            let renderer = if reference { Renderer::Reference } else { Renderer::Cpu };
            let recipe = Recipe { scene, base_dir, camera, options: given, renderer };
            Ok(Self(Mutex::new(Stage { recipe, played: None, warnings })))
        })
    }

    /// Warnings that were not told yet.
    fn take_warnings(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        detached(py, || Ok(std::mem::take(&mut self.stage().warnings)))
    }

    /// The picture at this time, in seconds; its outputs by their names; and why it shows nothing, where that is asked
    /// for and so.
    #[pyo3(signature = (time, is_float, outputs, ask_why=false))]
    fn draw<'py>(
        &self,
        py: Python<'py>,
        time: f64,
        is_float: bool,
        outputs: Vec<String>,
        ask_why: bool,
    ) -> PyResult<(PyPixels<'py>, Bound<'py, PyDict>, Option<String>)> {
        let kinds = outputs.iter().map(|name| output(name)).collect::<Result<Vec<_>, _>>()?;
        let quantities: Vec<Quantity> = kinds.iter().filter_map(Output::quantity).collect();
        let (picture, images, why) = self.with(py, |app, spawned, recipe| {
            let pixels = if is_float { Pixels::Float } else { Pixels::Byte };
            set_time(app, spawned, time)?;
            let size = UVec2::from_array(recipe.scene.size);
            let (picture, images, why) = if recipe.renderer == Renderer::Reference {
                let (picture, images) = reference_picture(app, size, pixels, &quantities)?;
                (picture, images, None)
            } else {
                app.insert_resource(Headless { size, pixels });
                let picture = render_picture(app).map_err(Failure::work)?;
                let images = if quantities.is_empty() {
                    Vec::new()
                } else {
                    take_quantities(app.world_mut(), &quantities).map_err(Failure::work)?
                };
                let why = if ask_why { nothing_is_seen(app, &picture) } else { None };
                (picture, images, why)
            };
            let mut images = images.into_iter();
            let mut all = Vec::with_capacity(kinds.len());
            for kind in &kinds {
                all.push(match kind {
                    Output::Quantity(quantity) => {
                        let values = images.next().ok_or_else(|| Failure::Work("outputs: one is missing".into()))?;
                        (values.values, quantity.channels().len())
                    }
                    Output::Term(term) => (term_alone(*term, (app, spawned, recipe), size)?, 3),
                });
            }
            Ok((picture, all, why))
        })?;
        let named = PyDict::new(py);
        for (name, (values, channels)) in outputs.iter().zip(&images) {
            named.set_item(name, image_to_python(py, values, *channels))?;
        }
        Ok((to_python(py, &picture), named, why))
    }

    /// A pixel of the picture at this time, explained: as JSON, as text and as LaTeX.
    fn explain(&self, py: Python<'_>, x: u32, y: u32, time: f64) -> PyResult<(String, String, String)> {
        self.with(py, |app, spawned, recipe| {
            set_time(app, spawned, time)?;
            explained(app, UVec2::from_array(recipe.scene.size), [x, y])
        })
    }

    /// A sheet of views, `front,right,iso`, with captions.
    fn sheet<'py>(&self, py: Python<'py>, list: &str) -> PyResult<PyPixels<'py>> {
        let views = views(list).map_err(|error| Failure::Input(format!("views: {error}")))?;
        let sheet = self.with(py, |app, spawned, recipe| {
            let size = UVec2::from_array(recipe.scene.size);
            let points = outline(app.world_mut());
            let base = app.world().get::<Camera>(spawned.camera).copied().unwrap_or_default();
            let mut sheet = ContactSheet::new(views.columns(), size.x, base.encoding);
            for (caption, camera, place) in views.cameras(&recipe.options, base, &points, size) {
                app.world_mut().entity_mut(spawned.camera).insert((camera, place));
                app.insert_resource(Headless { size, pixels: Pixels::Byte });
                let picture = if recipe.renderer == Renderer::Reference {
                    reference_picture(app, size, Pixels::Byte, &[])?.0
                } else {
                    render_picture(app).map_err(Failure::work)?
                };
                sheet.push_with_caption(&picture, &caption);
            }
            Ok(sheet.picture())
        })?;
        Ok(to_python(py, &sheet))
    }

    /// Turns the camera once around the scene in so many pictures, of which each call of `draw` from now on is the next.
    fn turn(&self, py: Python<'_>, frames: u32) -> PyResult<()> {
        self.with(py, |app, spawned, recipe| {
            let up = recipe.options.upright(&recipe.scene);
            Turntable::turn(app, spawned.camera, up, std::f32::consts::TAU / frames.max(1) as f32);
            Ok(())
        })
    }

    /// Moves objects, by their places in the list, to where matrices take them, of 16 numbers each, row by row. Returns
    /// whether all could be moved so; else the scene has to be made again.
    fn place_objects(&self, py: Python<'_>, objects: PyBuffer<u32>, matrices: PyBuffer<f64>) -> PyResult<bool> {
        let (objects, matrices) = (objects.to_vec(py)?, matrices.to_vec(py)?);
        self.with(py, |app, spawned, recipe| {
            if recipe.frames_objects() {
                return Ok(false);
            }
            let world = app.world_mut();
            let mut placed = objects.iter().zip(matrices.as_chunks::<16>().0);
            Ok(placed.all(|(&object, matrix)| {
                spawned.place_object(object as usize, &DMat4::from_cols_array(matrix).transpose(), world)
            }))
        })
    }

    /// Gives a light the values of its entry. Returns whether that could be; else the scene has to be made again.
    fn place_light(&self, py: Python<'_>, light: usize, entry: &str) -> PyResult<bool> {
        let entry = LightEntry::from_json(entry, "light").map_err(Failure::input)?;
        self.with(py, |app, spawned, recipe| {
            Ok(recipe.options.lights.is_none() && spawned.place_light(light, &entry, app.world_mut()))
        })
    }

    /// Gives the camera the values of its entry. Returns whether that could be; else the scene has to be made again.
    fn place_camera(&self, py: Python<'_>, entry: &str) -> PyResult<bool> {
        let entry = CameraEntry::from_json(entry, "camera").map_err(Failure::input)?;
        self.with(py, |app, spawned, recipe| {
            let is_seen = recipe.camera.is_none() && !recipe.options.is_framing();
            Ok(is_seen && spawned.place_camera(&entry, app.world_mut()))
        })
    }

    /// Judges a picture by the reference renderer.
    fn judge<'py>(&self, py: Python<'py>, pixels: Given, size: (u32, u32), most: f64) -> PyResult<Bound<'py, PyDict>> {
        let picture = pixels.picture(py, size)?;
        let judged = detached(py, move || {
            let mut recipe = self.recipe_of_reference(size);
            recipe.scene.samples = 1;
            recipe.scene.all_cameras_mut().for_each(|camera| camera.samples = None);
            judge_given(&recipe, &picture, most)
        })?;
        let Judged { is_within, worst, at, equal, edges, bad, sentence } = judged;
        let figures = PyDict::new(py);
        figures.set_item("within", is_within)?;
        figures.set_item("worst", worst)?;
        figures.set_item("at", at)?;
        figures.set_item("equal", equal)?;
        figures.set_item("edges", edges)?;
        figures.set_item("bad", bad)?;
        figures.set_item("sentence", sentence)?;
        Ok(figures)
    }

    /// Marks a picture by the reference renderer, with points by a rubric in JSON: as JSON, and in sentences.
    fn mark(
        &self,
        py: Python<'_>,
        pixels: Given,
        size: (u32, u32),
        most: f64,
        rubric: &str,
    ) -> PyResult<(String, String)> {
        let rubric = Rubric::from_json(rubric).map_err(|error| Failure::Input(format!("rubric: {error}")))?;
        let picture = pixels.picture(py, size)?;
        detached(py, move || mark_given(&self.recipe_of_reference(size), &picture, most, &rubric))
    }
}

impl Drawing {
    /// The recipe for the reference renderer's picture of this size, without what lies over or behind surfaces.
    fn recipe_of_reference(&self, size: (u32, u32)) -> Recipe {
        let mut recipe = Recipe { renderer: Renderer::Reference, ..self.stage().recipe.clone() };
        remove_what_is_laid_over(&mut recipe.scene);
        recipe.scene.size = [size.0, size.1];
        recipe
    }
}

/// Sets the time of the scene's animation, in seconds.
fn set_time(app: &mut App, spawned: &Spawned, time: f64) -> Result<(), Failure> {
    if time != 0.0 && !spawned.is_animated {
        return Err(Failure::Input(format!("time: {time}; the scene has no animation")));
    }
    app.insert_resource(SceneTime::At(time));
    Ok(())
}

/// The values of a quantity: whether they are floats, how many a pixel has, and the numbers.
type Values<'py> = (bool, usize, Bound<'py, PyByteArray>);

fn image_to_python<'py>(py: Python<'py>, values: &QuantityValues, channels: usize) -> Values<'py> {
    match values {
        QuantityValues::Floats(numbers) => (true, channels, floats(py, numbers)),
        QuantityValues::Numbers(numbers) => {
            let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_ne_bytes()).collect();
            (false, channels, PyByteArray::new(py, &bytes))
        }
    }
}

/// An output of a picture beside its colours.
enum Output {
    Quantity(Quantity),
    /// A term of the light alone.
    Term(Term),
}

impl Output {
    fn quantity(&self) -> Option<Quantity> {
        if let Self::Quantity(quantity) = self { Some(*quantity) } else { None }
    }
}

fn output(name: &str) -> Result<Output, Failure> {
    let key = name.replace('-', "_");
    let found = Quantity::from_key(&key).map(Output::Quantity).or_else(|| Term::from_key(&key).map(Output::Term));
    found.ok_or_else(|| Failure::Input(format!("outputs: {name:?}; expected color, {}", output_names().join(", "))))
}

fn output_names() -> Vec<&'static str> {
    let quantities = Quantity::CHOICES.iter().map(|choice| choice.key);
    quantities.chain(Term::CHOICES.iter().map(|choice| choice.key)).collect()
}

/// The linear colours that a term of the light adds.
fn term_alone(
    term: Term,
    (app, spawned, recipe): (&mut App, &Spawned, &Recipe),
    size: UVec2,
) -> Result<QuantityValues, Failure> {
    if recipe.scene.only.is_some() {
        return Err(Failure::Input("outputs: the picture has one term only; expected no `only`".into()));
    }
    spawned.show_light(PartOfLight { term: Some(term), ..spawned.part }, app.world_mut());
    let drawn = if recipe.renderer == Renderer::Reference {
        reference_picture(app, size, Pixels::Float, &[]).map(|(picture, _)| picture)
    } else {
        app.insert_resource(Headless { size, pixels: Pixels::Float });
        render_picture(app).map_err(Failure::work)
    };
    spawned.show_light(spawned.part, app.world_mut());
    match drawn? {
        Picture::Float(image) => {
            Ok(QuantityValues::Floats(image.pixels().flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()))
        }
        Picture::Byte(_) => Err(Failure::Work("outputs: no colours in floating point".into())),
    }
}

/// Why nothing is seen in the picture, if all its pixels are equal.
fn nothing_is_seen(app: &mut App, picture: &Picture) -> Option<String> {
    fn alike<T: PartialEq>(pixels: &[T]) -> bool {
        let (pixels, _) = pixels.as_chunks::<4>();
        pixels.iter().all(|pixel| *pixel == pixels[0])
    }
    let is_plain = match picture {
        Picture::Byte(image) => alike(image.as_raw()),
        Picture::Float(image) => alike(image.as_raw()),
    };
    let reason = if is_plain { why_empty(app.world_mut()) } else { None };
    reason.filter(|reason| !matches!(reason, EmptyReason::CameraInside { .. })).map(|reason| reason.to_string())
}

/// Checks the text of a scene, of an object, a light or a camera, and returns its warnings.
#[pyfunction]
fn check(kind: &str, text: &str, origin: &str) -> PyResult<Vec<String>> {
    let checked = match kind {
        "object" => ObjectEntry::from_json(text, origin).map(|_| Vec::new()),
        "light" => LightEntry::from_json(text, origin).map(|_| Vec::new()),
        "camera" => CameraEntry::from_json(text, origin).map(|_| Vec::new()),
        _ => SceneFile::from_json(text, origin).map(|scene| scene.warnings),
    };
    Ok(checked.map_err(Failure::input)?)
}

/// Checks options, given by names and texts.
#[pyfunction]
fn check_options(options: Vec<(String, String)>) -> PyResult<()> {
    let mut given = SceneOptions::default();
    for (name, text) in &options {
        given.set(name, text).map_err(Failure::Input)?;
    }
    Ok(())
}

/// A colour as CSS has it: linear red, green and blue, and the opacity.
#[pyfunction]
fn css(text: &str) -> PyResult<[f32; 4]> {
    Ok(parse::css(text).map_err(Failure::Input)?)
}

/// The sRGB curve.
#[pyfunction]
fn srgb(linear: f64) -> f64 {
    srgb_encoded(linear)
}

/// The values of a preset.
#[pyfunction]
fn preset<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyDict>> {
    let known = || Material::PRESETS.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    let missing = || Failure::Input(format!("preset: {name:?}; expected one of {}", known()));
    let Material { ambient, diffuse, specular, emission, shininess, opacity } =
        Material::named(name).ok_or_else(missing)?;
    let values = PyDict::new(py);
    for (key, color) in [("ambient", ambient), ("diffuse", diffuse), ("specular", specular), ("emission", emission)] {
        values.set_item(key, color.to_f32_array_no_alpha())?;
    }
    values.set_item("shininess", shininess)?;
    values.set_item("opacity", opacity)?;
    Ok(values)
}

/// The scene of models that nothing is known of, without a model.
#[pyfunction]
fn default_scene() -> PyResult<String> {
    let scene = SceneFile { samples: 4, ..scene_of_models(Vec::new()) };
    Ok(scene.to_json().map_err(Failure::input)?)
}

pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("OPTIONS", SceneOptions::NAMES.to_vec())?;
    module.add("OUTPUTS", output_names())?;
    let presets: Vec<&str> = Material::PRESETS.iter().map(|(name, _)| *name).collect();
    module.add("PRESETS", presets)?;
    module.add_function(wrap_pyfunction!(check, module)?)?;
    module.add_function(wrap_pyfunction!(css, module)?)?;
    module.add_function(wrap_pyfunction!(srgb, module)?)?;
    module.add_function(wrap_pyfunction!(preset, module)?)?;
    module.add_function(wrap_pyfunction!(default_scene, module)?)?;
    module.add_function(wrap_pyfunction!(check_options, module)?)
}
