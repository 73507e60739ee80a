//! The scene file as a whole.

use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use bevy_color::ColorToComponents;
use halfway_lighting::{
    Camera, Encoding, GlobalAmbient, Intensity, Range, Reflectance, Shading, Show, Term, Tolerance, Viewer,
};

use crate::check::{Check, KeyProblem, Limits, Within};
use crate::edges::EdgesEntry;
use crate::entry::{Entry, Written};
use crate::environment::EnvironmentEntry;
use crate::error::SceneError;
use crate::json;
use crate::keys::{Object, keys};
use crate::light::{AttachEntry, LightEntry};
use crate::lights_entry::LightsEntry;
use crate::lines::LineStyleEntry;
use crate::mesh::MeshEntry;
use crate::named::{NameOrIndex, check_names};
use crate::object::ObjectEntry;
use crate::retired;
use crate::view::CameraEntry;

keys! {
    /// A scene: a camera, lights and objects. Right-handed, Y up; colours are linear RGB; lengths are world units; paths
    /// are relative to the scene file. Every key may be left out.
    #[derive(Clone, Debug, PartialEq)]
    pub struct SceneFile {
        [optional]
        /// The version of the format: 1.
        schema_version: u32 = SceneFile::VERSION => Limits::OneOf(&[SceneFile::VERSION], "this version reads 1 only"),
        /// Width and height of the picture in pixels, each 1 to 16384.
        size: [u32; 2] = [1280, 720] => Limits::Counts(1, SceneFile::MAX_SIDE),
        /// The colour where nothing is drawn, linear RGB. 0 to 1e12.
        background: [f32; 3] = Camera::default().background.to_f32_array_no_alpha() => Limits::Numbers(Range::CHANNEL),
        /// The colour of the background at the lower edge of the picture, where it is another than at the upper edge;
        /// null: the same.
        background_below: Option<[f32; 3]> = None => Limits::Numbers(Range::CHANNEL),
        /// The opacity of the background, 0 to 1; 0 makes it transparent.
        background_opacity: f32 = 1.0 => Limits::Numbers(Range::UNIT),
        /// The encoding of the channels of a PNG picture.
        output: Encoding = Encoding::default(),
        /// The policy for intensities above 1.
        intensity: Intensity = Intensity::default(),
        /// Samples a pixel: 1; 4 for smooth edges; 16 or 64, of which each is shaded.
        samples: u32 = 1 => Limits::OneOf(&[1, 4, 16, 64], "expected 1, 4, 16 or 64"),
        /// Ga, the global ambient light, linear RGB. 0 to 1e12.
        ambient: [f32; 3] = GlobalAmbient::default().0.to_f32_array_no_alpha() => Limits::Numbers(Range::CHANNEL),
        /// Where the viewer is for the highlights.
        viewer: Viewer = Viewer::default(),
        /// The shading of objects that name none.
        shading: Shading = Shading::default(),
        /// The tolerance of objects that name none; null: exact.
        tolerance: Option<Tolerance> = None,
        /// The reflectance of objects that name none.
        reflectance: Reflectance = Reflectance::default(),
        /// Lines along the edges of objects that name none; null: no lines.
        edges: Option<EdgesEntry> = None,
        /// The looks of the lines and points of objects that name none; null: the default ones.
        line_style: Option<LineStyleEntry> = None,
        /// Lines that explain the scene, by their names: axes, normals, `face_normals`, lights, grid. Lengths follow the
        /// scene; the ground is below it, as the camera's `up` has it.
        show: Show = Show::default(),
        /// Light from all directions; null or left out: none.
        environment: Option<EnvironmentEntry> = None,
        /// The camera; null or left out: one that frames everything.
        camera: Option<CameraEntry> = None,
        /// Further cameras, of which one is drawn where it is asked for, by its name or its number. `camera` is number 0
        /// where there is one, and these follow.
        cameras: Vec<CameraEntry> = Vec::new(),
        /// The lights: a list, or a rig that follows the camera. null or left out: those of the models, or a key light, a
        /// fill light and a headlight where the models have none. An empty list: no lights.
        lights: Option<LightsEntry> = None,
        /// The only term that is drawn: ambient, diffuse, specular or emission, with which the background goes; null: all.
        only: Option<Term> = None,
        /// The only light that is drawn, by its name or its number: without the global ambient light, an environment,
        /// emission, unlit objects and the background. null: all of them.
        light: Option<NameOrIndex> = None,
        /// The animation of the models (glTF) that is played, by its name or its number; models without it play their
        /// first. null: the first of each.
        animation: Option<NameOrIndex> = None,
        /// The objects.
        objects: Vec<ObjectEntry> = Vec::new(),
        [not in the file]
        /// Warnings about values of older files, one sentence each, with the file's name. They are not written.
        warnings: Vec<String>,
    }
}

impl Object for SceneFile {
    const EXPECTED: &'static str = "an object with the keys of a scene";

    fn check_whole(&self) -> Check {
        let item = |list: &'static str| move |i: usize| format!("{list}[{i}]");
        let cameras = (0..).map(item("cameras")).zip(self.cameras.iter().map(|camera| camera.name.as_deref()));
        let lights = (0..).map(item("lights")).zip(self.light_list().iter().map(|light| light.name.as_deref()));
        let objects = (0..).map(item("objects")).zip(self.objects.iter().map(|object| object.name.as_deref()));
        let camera = self.camera.iter().map(|camera| ("camera".to_owned(), camera.name.as_deref()));
        check_names(camera.chain(cameras).chain(lights).chain(objects))?;
        if let (Some(Term::Emission), Some(_)) = (self.only, &self.light) {
            let message =
                "is emission, which belongs to no light; expected ambient, diffuse or specular beside `light`";
            return Err(KeyProblem::new("only", message));
        }
        for (i, light) in self.light_list().iter().enumerate() {
            self.check_attach(&light.attach).within_item(i).within("lights")?;
        }
        Ok(())
    }
}

impl SceneFile {
    /// The lights that are listed.
    fn light_list(&self) -> &[LightEntry] {
        if let Some(LightsEntry::List(list)) = &self.lights { list } else { &[] }
    }

    /// The version of the format that is read and written.
    pub const VERSION: u32 = 1;
    /// The largest width and height, in pixels.
    pub const MAX_SIDE: u32 = 16384;
    /// The largest scene file, in bytes (256 MiB); larger meshes belong in model files.
    pub const MAX_BYTES: u64 = 256 << 20;

    /// Reads a scene file.
    ///
    /// Paths in it stay as they are written: relative to the folder of the file, which is an argument of
    /// [`spawn()`](fn@crate::spawn).
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
            .map_err(|source| SceneError::Read { file: path.to_owned(), source })?;
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
        let mut scene: Self = json::read(text, origin)?;
        let warning = scene.check(&Limits::Any).and_then(|()| retired::warning(text, origin));
        scene.warnings.extend(warning.map_err(|problem| json::error_at(text, origin, problem))?);
        Ok(scene)
    }

    /// The scene as the text of a scene file, with every key. Reading it again gives an equal scene.
    ///
    /// # Errors
    /// [`SceneError::Value`] as [`validate`](Self::validate), and for a path that is not UTF-8.
    pub fn to_json(&self) -> Result<String, SceneError> {
        self.validate()?;
        json::pretty(&Written(self))
            .map_err(|error| SceneError::Value { key: String::new(), message: error.to_string() })
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
    /// `path` is taken as it is; it is relative to the folder that [`spawn()`](fn@crate::spawn) gets.
    pub fn for_model(path: impl Into<PathBuf>) -> Self {
        let model = ObjectEntry::new(MeshEntry::Path(path.into()));
        Self { objects: vec![model], ..Self::default() }
    }

    /// Whether every value is one that the format allows and this version can draw. Model files are not looked at.
    ///
    /// # Errors
    /// [`SceneError::Value`] for the first that is not, with its path.
    pub fn validate(&self) -> Result<(), SceneError> {
        self.check(&Limits::Any).map_err(|KeyProblem { key, message }| SceneError::Value { key, message })
    }

    /// All its cameras, [`camera`](Self::camera) first.
    pub fn all_cameras(&self) -> impl Iterator<Item = &CameraEntry> {
        self.camera.iter().chain(&self.cameras)
    }

    /// All its cameras, [`camera`](Self::camera) first.
    pub fn all_cameras_mut(&mut self) -> impl Iterator<Item = &mut CameraEntry> {
        self.camera.iter_mut().chain(&mut self.cameras)
    }

    /// The place of an object in the list, by its name or that place.
    pub(crate) fn object_index(&self, object: &NameOrIndex) -> Option<usize> {
        object.find(self.objects.iter().map(|object| object.name.as_deref()))
    }

    fn check_attach(&self, attach: &AttachEntry) -> Check {
        let AttachEntry::Object(object) = attach else { return Ok(()) };
        if self.object_index(object).is_some() {
            return Ok(());
        }
        let message = match object {
            NameOrIndex::Name(name) => format!("is {name:?}; no object of the scene has that name"),
            NameOrIndex::Index(index) => format!("is {index}; the scene has {} objects", self.objects.len()),
        };
        Err(KeyProblem::new("attach.object", message))
    }
}
