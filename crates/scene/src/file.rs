//! The scene file as a whole.

use std::collections::HashSet;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use bevy_color::ColorToComponents;
use halfway_lighting::{Camera, Encoding, GlobalAmbient, Reflectance, Tolerance, Viewer};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::check::{Check, KeyProblem, Within, color, count};
use crate::environment::EnvironmentEntry;
use crate::error::SceneError;
use crate::fields::{self, Keys, keys_or_null, write_keys_or_null};
use crate::intensity::IntensityEntry;
use crate::json;
use crate::light::{AttachEntry, LightEntry};
use crate::locate::{line_and_column, place_of};
use crate::mesh::MeshEntry;
use crate::object::ObjectEntry;
use crate::read::{Given, JsonObject, Spoken, object_or_null, objects, objects_or_null, word, write_word};
use crate::view::{CameraEntry, ShadingEntry};

/// A scene as it stands in a scene file. Every key may be left out; the defaults are [`SceneFile::default`].
///
/// A scene from [`SceneFile::read`] or [`SceneFile::from_json`] holds only values that make sense
/// ([`SceneFile::validate`]). One that was put together in code, or deserialised by other means, is validated before it
/// is written or spawned.
#[derive(Serialize, Deserialize, JsonSchema, Clone, Debug, PartialEq)]
#[serde(default, deny_unknown_fields)]
#[schemars(
    title = "halfway scene",
    description = "A scene: a camera, lights and objects. Right-handed, Y up; colours are linear RGB; lengths are world \
                   units; paths are relative to the scene file."
)]
pub struct SceneFile {
    /// The version of the format: 1.
    #[schemars(extend("const" = 1))]
    pub schema_version: u32,
    /// Width and height of the picture in pixels, each 1 to 16384.
    #[schemars(inner(range(min = 1, max = SceneFile::MAX_SIDE)))]
    pub size: [u32; 2],
    /// The colour where nothing is drawn, linear RGB. 0 to 1e12.
    #[schemars(inner(range(min = 0, max = halfway_lighting::CHANNEL_MAX)))]
    pub background: [f32; 3],
    /// What the channels of a PNG picture hold.
    #[serde(deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<Encoding>")]
    pub output: Encoding,
    /// What becomes of intensities above 1.
    #[serde(deserialize_with = "word")]
    pub intensity: IntensityEntry,
    /// Coverage samples a pixel: 1, or 4 for smooth edges.
    #[schemars(extend("enum" = [1, 4]))]
    pub samples: u32,
    /// Ga, the global ambient light, linear RGB. 0 to 1e12.
    #[schemars(inner(range(min = 0, max = halfway_lighting::CHANNEL_MAX)))]
    pub ambient: [f32; 3],
    /// Where the viewer is for the highlights.
    #[serde(deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<Viewer>")]
    pub viewer: Viewer,
    /// The shading of objects that name none.
    #[serde(deserialize_with = "word")]
    pub shading: ShadingEntry,
    /// The tolerance of objects that name none; null: one step and half a pixel.
    #[serde(deserialize_with = "keys_or_null", serialize_with = "write_keys_or_null")]
    #[schemars(with = "Option<Keys<Tolerance>>")]
    pub tolerance: Option<Tolerance>,
    /// The reflectance of objects that name none.
    #[serde(deserialize_with = "word", serialize_with = "write_word")]
    #[schemars(with = "Spoken<Reflectance>")]
    pub reflectance: Reflectance,
    /// Light from all directions; null or left out: none.
    #[serde(deserialize_with = "object_or_null")]
    pub environment: Option<EnvironmentEntry>,
    /// The camera; null or left out: one that frames everything.
    #[serde(deserialize_with = "keys_or_null", serialize_with = "write_keys_or_null")]
    #[schemars(with = "Option<Keys<CameraEntry>>")]
    pub camera: Option<CameraEntry>,
    /// The lights; null or left out: those of the models, or a key light, a fill light and a headlight where the models
    /// have none. An empty list: no lights.
    #[serde(deserialize_with = "objects_or_null")]
    pub lights: Option<Vec<LightEntry>>,
    /// What is seen.
    #[serde(deserialize_with = "objects")]
    pub objects: Vec<ObjectEntry>,
}

impl Default for SceneFile {
    fn default() -> Self {
        Self {
            schema_version: Self::VERSION,
            size: [1280, 720],
            background: Camera::default().background.to_f32_array_no_alpha(),
            output: Encoding::default(),
            intensity: IntensityEntry::default(),
            samples: 1,
            ambient: GlobalAmbient::default().0.to_f32_array_no_alpha(),
            viewer: Viewer::default(),
            shading: ShadingEntry::default(),
            tolerance: None,
            reflectance: Reflectance::default(),
            environment: None,
            camera: None,
            lights: None,
            objects: Vec::new(),
        }
    }
}

impl JsonObject for SceneFile {
    const EXPECTED: &'static str = "an object with the keys of a scene";
}

impl SceneFile {
    /// The version of the format that is read and written.
    pub const VERSION: u32 = 1;
    /// The largest width and height, in pixels.
    pub const MAX_SIDE: u32 = 16384;
    /// The largest scene file, in bytes (256 MiB); larger meshes belong in model files.
    pub const MAX_BYTES: u64 = 256 << 20;

    /// Reads a scene file.
    ///
    /// Paths in it stay as they are written: relative to the folder of the file, which [`spawn()`](fn@crate::spawn) is
    /// told.
    ///
    /// # Errors
    /// [`SceneError::Read`], [`SceneError::NotAFile`], [`SceneError::TooLarge`] and [`SceneError::NotUtf8`] for a file
    /// that is no text, and as [`from_json`](Self::from_json).
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let mut bytes = Vec::new();
        // Asked before it is opened: opening a pipe waits for its other end.
        if std::fs::metadata(path).is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir()) {
            return Err(SceneError::NotAFile { file: path.to_owned() });
        }
        File::open(path)
            .and_then(|file| file.take(Self::MAX_BYTES + 1).read_to_end(&mut bytes))
            .map_err(|source| SceneError::read(path, source))?;
        if bytes.len() as u64 > Self::MAX_BYTES {
            return Err(SceneError::TooLarge { file: path.to_owned(), most: Self::MAX_BYTES });
        }
        let text = String::from_utf8(bytes)
            .map_err(|error| SceneError::NotUtf8 { file: path.to_owned(), byte: error.utf8_error().valid_up_to() })?;
        Self::from_json(&text, &path.display().to_string())
    }

    /// Reads a scene from the text of a scene file. `origin` is the name that errors give it, such as the file's.
    ///
    /// A byte order mark at the start is skipped.
    ///
    /// # Errors
    /// [`SceneError::Text`], with line, column and key, for text that is not JSON, for keys that the format does not
    /// have, for values of the wrong type and for those that [`validate`](Self::validate) refuses.
    pub fn from_json(text: &str, origin: &str) -> Result<Self, SceneError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let Given(scene): Given<Self> =
            serde_json::from_str(text).map_err(|error| json::located(&error, text, origin))?;
        scene.check().map_err(|KeyProblem { key, message }| {
            let (line, column) = line_and_column(text, place_of(text, &key).value);
            SceneError::Text { origin: origin.to_owned(), line, column, key, message }
        })?;
        Ok(scene)
    }

    /// The scene as the text of a scene file, with every key. Reading it again gives an equal scene.
    ///
    /// # Errors
    /// [`SceneError::Value`] as [`validate`](Self::validate), and for a path that is not UTF-8.
    pub fn to_json(&self) -> Result<String, SceneError> {
        self.validate()?;
        json::pretty(self).map_err(|error| SceneError::Value { key: String::new(), message: error.to_string() })
    }

    /// Writes the scene to a file, as [`to_json`](Self::to_json) has it. An existing file is replaced.
    ///
    /// # Errors
    /// As [`to_json`](Self::to_json), and [`SceneError::Write`].
    pub fn write(&self, path: &Path) -> Result<(), SceneError> {
        let text = self.to_json()?;
        std::fs::write(path, text).map_err(|source| SceneError::Write { file: path.to_owned(), source })
    }

    /// A scene of one model file, framed by the camera and lit by its own lights or by the default ones.
    ///
    /// `path` is taken as it is; it is relative to the folder that [`spawn()`](fn@crate::spawn) is told.
    pub fn for_model(path: impl Into<PathBuf>) -> Self {
        let model = ObjectEntry::new(MeshEntry::Path(path.into()));
        Self { objects: vec![model], ..Self::default() }
    }

    /// Whether every value is one that the format allows and this version can draw. Model files are not looked at.
    ///
    /// # Errors
    /// [`SceneError::Value`] for the first that is not, with its path.
    pub fn validate(&self) -> Result<(), SceneError> {
        self.check().map_err(|KeyProblem { key, message }| SceneError::Value { key, message })
    }

    fn check(&self) -> Check {
        if self.schema_version != Self::VERSION {
            let message = format!("is {}; this version reads {} only", self.schema_version, Self::VERSION);
            return Err(KeyProblem::new("schema_version", message));
        }
        for (i, &side) in self.size.iter().enumerate() {
            count("", side, 1..=Self::MAX_SIDE).within_item("size", i)?;
        }
        color("background", &self.background)?;
        if !matches!(self.samples, 1 | 4) {
            return Err(KeyProblem::new("samples", format!("is {}; expected 1 or 4", self.samples)));
        }
        color("ambient", &self.ambient)?;
        self.intensity.check().within("intensity")?;
        self.shading.check().within("shading")?;
        self.tolerance.as_ref().map_or(Ok(()), fields::check).within("tolerance")?;
        self.environment.as_ref().map_or(Ok(()), EnvironmentEntry::check).within("environment")?;
        self.camera.as_ref().map_or(Ok(()), CameraEntry::check).within("camera")?;
        for (i, object) in self.objects.iter().enumerate() {
            object.check().within_item("objects", i)?;
        }
        let names = self.names()?;
        for (i, light) in self.lights.iter().flatten().enumerate() {
            light.check().within_item("lights", i)?;
            check_attach(&light.attach, &names).within_item("lights", i)?;
        }
        Ok(())
    }

    /// The names of the objects, all different.
    fn names(&self) -> Result<HashSet<&str>, KeyProblem> {
        let mut names = HashSet::new();
        for (i, object) in self.objects.iter().enumerate() {
            let Some(name) = object.name.as_deref() else { continue };
            if !names.insert(name) {
                let message = format!("is {name:?}, as of an object before; expected a name of its own");
                return Err(KeyProblem::new("name", message)).within_item("objects", i);
            }
        }
        Ok(names)
    }
}

fn check_attach(attach: &AttachEntry, names: &HashSet<&str>) -> Check {
    match attach {
        AttachEntry::Object(name) if !names.contains(name.as_str()) => {
            Err(KeyProblem::new("attach.object", format!("is {name:?}; no object of the scene has that name")))
        }
        _ => Ok(()),
    }
}
