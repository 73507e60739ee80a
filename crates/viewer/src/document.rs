//! The scene that is shown, as a scene file, and its history.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use halfway::mesh::load;
use halfway::scene::options::{scene_of_models, unknown_material};
use halfway::scene::{LoadedModel, MeshEntry, ObjectEntry, SceneFile};

use crate::error::ViewerError;

/// The steps that can be undone.
const STEPS: usize = 100;

/// A scene that can be changed, with its file and its history.
///
/// Whatever the panels change is a value of the [`SceneFile`], and the world follows it: so a saved scene holds all that is
/// seen.
#[derive(Debug)]
pub struct Document {
    /// The scene as it stands, during a drag too.
    pub(crate) scene: SceneFile,
    /// The folder of its relative paths.
    pub(crate) base_dir: PathBuf,
    /// The file that was opened.
    pub(crate) file: PathBuf,
    /// The camera that the command line asks for.
    pub(crate) camera: Option<String>,
    /// The scene after the last finished change.
    settled: SceneFile,
    before: Vec<SceneFile>,
    after: Vec<SceneFile>,
    /// Whether the last finished change is saved.
    saved: bool,
    /// When the file was written, by which a change of it is seen.
    written: Option<SystemTime>,
}

impl Document {
    /// A scene that was read from a file. `base_dir` is the folder of its relative paths.
    pub fn new(scene: SceneFile, base_dir: impl Into<PathBuf>, file: impl Into<PathBuf>) -> Self {
        let (base_dir, file) = (base_dir.into(), file.into());
        let written = time_of(&file);
        let settled = scene.clone();
        let (before, after, saved, camera) = (Vec::new(), Vec::new(), true, None);
        Self { scene, base_dir, file, camera, settled, before, after, saved, written }
    }

    /// The same, seen from the camera of this name or number.
    #[must_use]
    pub fn seen_from(self, camera: Option<String>) -> Self {
        Self { camera, ..self }
    }

    /// Opens a scene file or a model.
    ///
    /// # Errors
    /// [`ViewerError::Scene`] and [`ViewerError::Model`], with the file's name and what is wrong in it.
    pub fn open(file: &Path) -> Result<Self, ViewerError> {
        if is_scene(file) {
            let scene = SceneFile::read(file).map_err(ViewerError::Scene)?;
            return Ok(Self::new(scene, file.parent().unwrap_or(Path::new("")), file));
        }
        let model = Arc::new(load(file).map_err(|error| ViewerError::Model(error.to_string()))?);
        let model = LoadedModel { path: file.to_owned(), model, material: unknown_material() };
        Ok(Self::new(scene_of_models(vec![model]), PathBuf::new(), file))
    }

    /// The file's name without its folder.
    pub fn name(&self) -> String {
        self.file.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Whether there are changes that no file holds.
    pub fn is_changed(&self) -> bool {
        !self.saved
    }

    /// Takes back a change that cannot be shown: the scene is that of the last finished one.
    pub(crate) fn reject(&mut self) {
        self.scene = self.settled.clone();
    }

    /// Ends a change, such as a drag of a slider: it is one step of the history.
    pub(crate) fn settle(&mut self) {
        self.before.push(std::mem::replace(&mut self.settled, self.scene.clone()));
        if self.before.len() > STEPS {
            self.before.remove(0);
        }
        self.after.clear();
        self.saved = false;
    }

    pub(crate) fn can_undo(&self) -> bool {
        !self.before.is_empty()
    }

    pub(crate) fn can_redo(&self) -> bool {
        !self.after.is_empty()
    }

    /// Takes back the last step; `false` where there is none.
    pub(crate) fn undo(&mut self) -> bool {
        let Some(scene) = self.before.pop() else { return false };
        self.after.push(std::mem::replace(&mut self.settled, scene));
        self.show_settled();
        true
    }

    /// Takes the step again that was undone last; `false` where there is none.
    pub(crate) fn redo(&mut self) -> bool {
        let Some(scene) = self.after.pop() else { return false };
        self.before.push(std::mem::replace(&mut self.settled, scene));
        self.show_settled();
        true
    }

    fn show_settled(&mut self) {
        self.scene = self.settled.clone();
        self.saved = false;
    }

    /// The name under which the scene is saved unless the user says otherwise: the scene file itself, or `.json` beside
    /// the model.
    pub(crate) fn file_to_save(&self) -> PathBuf {
        if is_scene(&self.file) { self.file.clone() } else { self.file.with_extension("json") }
    }

    /// Writes the scene, seen as `scene` has it, into a file.
    ///
    /// # Errors
    /// [`ViewerError::OtherFolder`] where relative paths would lead elsewhere, and [`ViewerError::Scene`].
    pub(crate) fn save(&mut self, file: &Path, mut scene: SceneFile) -> Result<(), ViewerError> {
        let folder = |path: &Path| std::path::absolute(path.parent().unwrap_or(Path::new(""))).unwrap_or_default();
        if is_scene(&self.file) {
            if folder(file) != folder(&self.file) {
                return Err(ViewerError::OtherFolder { file: file.to_owned(), expected: folder(&self.file) });
            }
        } else {
            scene.objects.iter_mut().for_each(|object| lead_from(&folder(file), object));
        }
        scene.write(file).map_err(ViewerError::Scene)?;
        if file == self.file_to_save() {
            self.saved = true;
            self.written = time_of(&self.file);
        }
        Ok(())
    }

    /// Whether the file was written since it was opened; asked once, it is answered `true` once.
    pub(crate) fn is_written_anew(&mut self) -> bool {
        let now = time_of(&self.file);
        let is_new = now.is_some() && now != self.written;
        if is_new {
            self.written = now;
        }
        is_new
    }
}

/// Makes the path of a model relative to a folder, where the model lies in it, else absolute.
fn lead_from(folder: &Path, object: &mut ObjectEntry) {
    let (MeshEntry::Model(LoadedModel { path, .. }) | MeshEntry::Path(path)) = &mut object.mesh else { return };
    if let Ok(absolute) = std::path::absolute(&*path) {
        *path = absolute.strip_prefix(folder).map_or(absolute.clone(), Path::to_owned);
    }
}

pub(crate) fn is_scene(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"))
}

fn time_of(file: &Path) -> Option<SystemTime> {
    std::fs::metadata(file).and_then(|data| data.modified()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with_samples(samples: u32) -> SceneFile {
        SceneFile { samples, ..SceneFile::default() }
    }

    #[test]
    fn steps_are_undone_and_taken_again() {
        let mut document = Document::new(with_samples(1), "", "scene.json");
        assert!(!document.undo() && !document.redo() && !document.is_changed());
        for samples in [4, 16] {
            document.scene.samples = samples;
            document.settle();
        }
        assert!(document.is_changed());
        let mut seen = Vec::new();
        while document.undo() {
            seen.push(document.scene.samples);
        }
        while document.redo() {
            seen.push(document.scene.samples);
        }
        assert_eq!(seen, [4, 1, 4, 16]);
        document.undo();
        document.scene.samples = 64;
        document.settle();
        assert!(!document.redo(), "a new step ends what was undone");
    }

    #[test]
    fn a_history_has_an_end() {
        let mut document = Document::new(with_samples(1), "", "scene.json");
        for width in 1..=STEPS as u32 + 10 {
            document.scene.size = [width, 1];
            document.settle();
        }
        let mut undone = 0;
        while document.undo() {
            undone += 1;
        }
        assert_eq!((undone, document.scene.size), (STEPS, [10, 1]));
    }
}
