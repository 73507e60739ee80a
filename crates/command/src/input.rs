//! The scene of the command line.

use std::cell::Cell;
use std::path::{Path, PathBuf};

use halfway::prelude::*;
use halfway::scene::{SceneError, SceneFile, Spawned, spawn, spawn_seen_from};

use crate::drawing::{DrawingArgs, SizeArgs};
use crate::failure::Failure;

const EXPECTED: &str =
    "neither a scene that is known by a name nor a file that ends in .json, .smf, .obj, .gltf, .glb, .ply or .stl";

/// A scene with the folder of its relative paths.
pub(crate) struct SceneInput {
    pub(crate) scene: SceneFile,
    base_dir: PathBuf,
    /// The file as it was named, and whether it is a scene file.
    file: PathBuf,
    is_scene: bool,
    /// The camera that the command line asks for.
    camera: Option<String>,
    warned: Cell<bool>,
}

impl SceneInput {
    /// Reads the scene file, or wraps the model in one.
    pub(crate) fn open(file: &Path) -> Result<Self, Failure> {
        let is_scene = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
        let scene = if is_scene { SceneFile::read(file)? } else { SceneFile::for_model(file.to_owned()) };
        let folder = file.parent().filter(|_| is_scene).unwrap_or(Path::new(""));
        let warned = Cell::new(false);
        Ok(Self { scene, base_dir: folder.to_owned(), file: file.to_owned(), is_scene, camera: None, warned })
    }

    /// Reads the scene, with the options of the command line.
    pub(crate) fn read(args: &DrawingArgs) -> Result<Self, Failure> {
        let mut input = Self::open(&args.input)?;
        input.camera.clone_from(&args.camera);
        let scene = &mut input.scene;
        if let Some(shading) = args.shading() {
            scene.shading = shading;
            scene.all_cameras_mut().for_each(|camera| camera.shading = None);
            scene.objects.iter_mut().for_each(|object| object.shading = None);
        }
        if let Some(reflectance) = args.reflectance {
            scene.reflectance = reflectance;
            scene.all_cameras_mut().for_each(|camera| camera.reflectance = None);
            scene.objects.iter_mut().for_each(|object| object.reflectance = None);
        }
        if let Some(tolerance) = args.tolerance.given() {
            scene.tolerance = Some(tolerance);
            scene.all_cameras_mut().for_each(|camera| camera.tolerance = None);
            scene.objects.iter_mut().for_each(|object| object.tolerance = None);
        }
        if let Some(edges) = args.edges.given() {
            scene.edges = Some(edges.into());
            scene.objects.iter_mut().for_each(|object| object.edges = None);
        }
        if let Some(samples) = args.samples {
            scene.samples = samples;
            scene.all_cameras_mut().for_each(|camera| camera.samples = None);
        }
        if let Some(intensity) = args.intensity {
            scene.intensity = intensity;
        }
        Ok(input)
    }

    /// The size of the picture in pixels: the command line's, or the scene's. A camera that frames everything needs the
    /// picture's shape, so the scene gets it.
    pub(crate) fn resize(&mut self, args: SizeArgs) -> UVec2 {
        let size = args.size.unwrap_or(UVec2::from_array(self.scene.size));
        self.scene.size = size.to_array();
        size
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

    /// The failure for an error: a model's own error; in a scene file it is one of that file's keys.
    fn failure(&self, error: SceneError) -> Failure {
        match error {
            SceneError::Model { source, .. } if !self.is_scene => source.into(),
            // A model's name makes only this key.
            SceneError::Value { key, .. } if !self.is_scene && key == "objects[0].mesh.path" => {
                format!("{}: {EXPECTED}", self.file.display()).into()
            }
            error @ SceneError::NoCamera { .. } => format!("--camera: {}: {error}", self.file.display()).into(),
            error => {
                let text = error.to_string();
                let text = text.strip_prefix("scene: ").unwrap_or(&text);
                format!("{}: {text}", self.file.display()).into()
            }
        }
    }
}
