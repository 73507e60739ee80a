//! The scene that the command line means.

use std::path::{Path, PathBuf};

use halfway::prelude::*;
use halfway::scene::{SceneError, SceneFile, ShadingEntry, Spawned, spawn};

use crate::failure::Failure;
use crate::look::{LookArgs, ReflectanceArg, ShadingArg};

/// A scene with the folder that its paths start from.
pub(crate) struct SceneInput {
    pub(crate) scene: SceneFile,
    base_dir: PathBuf,
    /// The file as it was named, and whether it is a scene file.
    file: PathBuf,
    is_scene: bool,
}

impl SceneInput {
    /// Reads the scene file, or wraps the model in one, and applies what the command line says.
    pub(crate) fn read(args: &LookArgs) -> Result<Self, Failure> {
        let is_scene = args.input.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
        let mut scene = if is_scene { SceneFile::read(&args.input)? } else { SceneFile::for_model(args.input.clone()) };
        let folder = args.input.parent().filter(|_| is_scene).unwrap_or(Path::new(""));
        if let Some(shading) = args.shading {
            let shading = match shading {
                ShadingArg::Flat => ShadingEntry::Flat,
                ShadingArg::Gouraud => ShadingEntry::Gouraud,
                ShadingArg::Phong => ShadingEntry::Phong,
            };
            scene.shading = shading;
            scene.objects.iter_mut().for_each(|object| object.shading = None);
        }
        if let Some(reflectance) = args.reflectance {
            let reflectance = match reflectance {
                ReflectanceArg::Phong => Reflectance::Phong,
                ReflectanceArg::BlinnPhong => Reflectance::BlinnPhong,
                ReflectanceArg::BlinnPhongMatched => Reflectance::BlinnPhongMatched,
            };
            scene.reflectance = reflectance;
            scene.objects.iter_mut().for_each(|object| object.reflectance = None);
        }
        if let Some(samples) = &args.samples {
            scene.samples = if samples == "4" { 4 } else { 1 };
        }
        Ok(Self { scene, base_dir: folder.to_owned(), file: args.input.clone(), is_scene })
    }

    /// The file's name without its folder.
    pub(crate) fn name(&self) -> String {
        self.file.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Puts the scene into the App's world, and its warnings on standard error.
    pub(crate) fn spawn(&self, app: &mut App) -> Result<Spawned, Failure> {
        let spawned = spawn(&self.scene, &self.base_dir, app.world_mut()).map_err(|error| self.failure(error))?;
        for warning in &spawned.warnings {
            eprintln!("warning: {warning}");
        }
        Ok(spawned)
    }

    /// What keeps a model from being shown is the model's own error; in a scene file it is one of that file's keys.
    fn failure(&self, error: SceneError) -> Failure {
        match error {
            SceneError::Model { source, .. } if !self.is_scene => source.into(),
            error => {
                let text = error.to_string();
                let text = text.strip_prefix("scene: ").unwrap_or(&text);
                format!("{}: {text}", self.file.display()).into()
            }
        }
    }
}
