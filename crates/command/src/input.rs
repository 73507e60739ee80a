//! The scene or the models of the command line.

use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use halfway::prelude::*;
use halfway::render::DrawsOnce;
use halfway::scene::options::{SceneOptions, scene_of_models, unknown_material};
use halfway::scene::{LoadedModel, SceneError, SceneFile, Spawned, spawn, spawn_seen_from};

use crate::drawing::{DrawingArgs, SizeArgs};
use crate::failure::Failure;
use crate::reading::{InputArgs, ReadingArgs};

/// A scene with the folder of its relative paths.
#[derive(Clone)]
pub(crate) struct SceneInput {
    pub(crate) scene: SceneFile,
    base_dir: PathBuf,
    /// The first file as it was named.
    file: PathBuf,
    /// The camera that the command line asks for.
    camera: Option<String>,
    warned: Cell<bool>,
}

impl SceneInput {
    /// Reads the scene file, or the model.
    pub(crate) fn open(file: &Path) -> Result<Self, Failure> {
        Self::open_all(&InputArgs { inputs: vec![file.to_owned()], reading: ReadingArgs::default() })
    }

    /// Reads a model of at most so many bytes.
    pub(crate) fn open_model(file: &Path, limit: u64) -> Result<Self, Failure> {
        let model = Arc::new(ReadingArgs::within(limit).load(file)?);
        let model = LoadedModel { path: file.to_owned(), model, material: unknown_material() };
        let (base_dir, warned) = (PathBuf::new(), Cell::new(true));
        Ok(Self { scene: scene_of_models(vec![model]), base_dir, file: file.to_owned(), camera: None, warned })
    }

    fn open_all(args: &InputArgs) -> Result<Self, Failure> {
        let is_scene = |file: &PathBuf| file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
        let file = args.inputs.first().cloned().unwrap_or_default();
        let warned = Cell::new(false);
        if args.inputs.len() == 1 && is_scene(&file) {
            let base_dir = file.parent().unwrap_or(Path::new("")).to_owned();
            return Ok(Self { scene: SceneFile::read(&file)?, base_dir, file, camera: None, warned });
        }
        if let Some(scene) = args.inputs.iter().find(|file| is_scene(file)) {
            let file = scene.display();
            return Err(format!("{file}: a scene file is drawn alone; expected models beside each other").into());
        }
        let mut models = Vec::with_capacity(args.inputs.len());
        for file in &args.inputs {
            let model = Arc::new(args.reading.load(file)?);
            models.push(LoadedModel { path: file.clone(), model, material: unknown_material() });
        }
        Ok(Self { scene: scene_of_models(models), base_dir: PathBuf::new(), file, camera: None, warned })
    }

    /// Reads the scene, with the options of the command line.
    pub(crate) fn read(args: &DrawingArgs, options: &SceneOptions) -> Result<Self, Failure> {
        let mut input = Self::open_all(&args.input)?;
        input.camera.clone_from(&args.camera);
        options.apply(&mut input.scene);
        Ok(input)
    }

    /// The same for the viewer, which can change it.
    #[cfg(feature = "window")]
    pub(crate) fn into_document(self) -> halfway_viewer::Document {
        halfway_viewer::Document::new(self.scene, self.base_dir, self.file).seen_from(self.camera)
    }

    /// The size of the picture in pixels: the command line's, or the scene's. A camera that frames everything needs the
    /// picture's shape, so the scene gets it.
    pub(crate) fn resize(&mut self, args: SizeArgs) -> UVec2 {
        let size = args.size.unwrap_or(UVec2::from_array(self.scene.size));
        self.scene.size = size.to_array();
        size
    }

    /// Gives the first camera, or the one that is chosen, the picture for itself.
    pub(crate) fn see_alone(&mut self) {
        self.scene.all_cameras_mut().for_each(|camera| camera.viewport = None);
    }

    /// The cameras that share the picture, by their numbers, with their names; none where one has it for itself.
    pub(crate) fn sharing(&self) -> Vec<(usize, String)> {
        let all = self.scene.all_cameras().enumerate();
        let shared = all.filter(|(_, camera)| self.camera.is_none() && camera.viewport.is_some());
        shared.map(|(number, camera)| (number, camera.name.clone().unwrap_or_else(|| number.to_string()))).collect()
    }

    /// The same, seen from the camera with this number.
    pub(crate) fn seen_from(&self, number: usize) -> Self {
        Self { camera: Some(number.to_string()), ..self.clone() }
    }

    /// The file's name without its folder.
    pub(crate) fn name(&self) -> String {
        self.file.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Spawns the scene into the App's world, and prints its warnings, once, on standard error.
    pub(crate) fn spawn(&self, app: &mut App) -> Result<Spawned, Failure> {
        let world = app.world_mut();
        let spawned = match &self.camera {
            None => spawn(&self.scene, &self.base_dir, world),
            Some(camera) => spawn_seen_from(&self.scene, &self.base_dir, camera, world),
        };
        let spawned = spawned.map_err(|error| self.failure(error))?;
        if !self.warned.replace(true) {
            spawned.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
        }
        Ok(spawned)
    }

    /// The same for an App that draws a single picture. Large meshes are not cut into patches then, unless many lights
    /// would be shaded where they do not reach.
    pub(crate) fn spawn_once(&self, app: &mut App) -> Result<Spawned, Failure> {
        const FEW_LIGHTS: usize = 8;
        let spawned = self.spawn(app)?;
        let is_one_frame = self.scene.samples <= 4;
        app.insert_resource(DrawsOnce(is_one_frame && spawned.lights.len() <= FEW_LIGHTS));
        Ok(spawned)
    }

    /// The failure for an error in one of the scene's keys.
    fn failure(&self, error: SceneError) -> Failure {
        if let SceneError::NoCamera { .. } = error {
            return format!("--camera: {}: {error}", self.file.display()).into();
        }
        if let SceneError::NoLight { .. } = error {
            return format!("--light: {}: {error}", self.file.display()).into();
        }
        let text = error.to_string();
        let text = text.strip_prefix("scene: ").unwrap_or(&text);
        format!("{}: {text}", self.file.display()).into()
    }
}
