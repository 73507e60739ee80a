//! Faults of a scene file, told so that the line can be found and mended.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// A scene that cannot be read, is invalid, or cannot be put into a world.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The file could not be opened or read.
    #[error("{}: cannot be read: {source}", file.display())]
    Read {
        /// The scene file.
        file: PathBuf,
        /// The system's message.
        source: io::Error,
    },
    /// The path leads to a folder, a pipe or a device.
    #[error("{}: is not a regular file; expected one, since a pipe may never end", file.display())]
    NotAFile {
        /// The path.
        file: PathBuf,
    },
    /// The file could not be written.
    #[error("{}: cannot be written: {source}", file.display())]
    Write {
        /// The scene file.
        file: PathBuf,
        /// The system's message.
        source: io::Error,
    },
    /// The file is larger than [`SceneFile::MAX_BYTES`](super::SceneFile::MAX_BYTES).
    #[error(
        "{}: is larger than {most} bytes; put large meshes into model files and name them by `path`",
        file.display()
    )]
    TooLarge {
        /// The scene file.
        file: PathBuf,
        /// The limit, in bytes.
        most: u64,
    },
    /// The file is not UTF-8.
    #[error("{}: is not UTF-8 text (byte {byte}); a scene file is JSON in UTF-8", file.display())]
    NotUtf8 {
        /// The scene file.
        file: PathBuf,
        /// The offset of the first byte that does not belong, counted from 0.
        byte: usize,
    },
    /// A place in the text is not JSON, not a key of the format, or not a value that the key takes.
    #[error("{origin}:{line}:{column}: {}{message}", named(key))]
    Text {
        /// The origin of the text: a file's name, as it was given.
        origin: String,
        /// The line, counted from 1.
        line: usize,
        /// The column in characters, counted from 1.
        column: usize,
        /// The path of the key, such as `lights[2].attenuation`; empty for the scene as a whole.
        key: String,
        /// The fault, and what was expected.
        message: String,
    },
    /// A value of a scene is invalid, and there is no text to point into.
    #[error("scene: {}{message}", named(key))]
    Value {
        /// The path of the key, such as `lights[2].attenuation`; empty for the scene as a whole.
        key: String,
        /// The fault, and what was expected.
        message: String,
    },
    /// A model that the scene names cannot be loaded. The source names the file and the place in it.
    #[error("scene: `{key}`: {source}")]
    Model {
        /// The path of the key, such as `objects[0].mesh.path`.
        key: String,
        /// The loader's message.
        source: halfway_mesh::LoadError,
    },
    /// A material or a light that came with a model holds a value that cannot be used.
    #[error("scene: `{key}`: {at}: {source}")]
    ModelValue {
        /// The path of the key, such as `objects[0].mesh.path`.
        key: String,
        /// The model's file, and the name of the material or light in it.
        at: String,
        /// Which value, and what was expected.
        source: halfway_lighting::InvalidValue,
    },
    /// No camera of the scene or its models has the name or the number that was asked for.
    #[error("no camera is called {wanted:?}; {known}")]
    NoCamera {
        /// The name or the number.
        wanted: String,
        /// The cameras that there are, as a clause.
        known: String,
    },
    /// No light of the scene has the name or the number that was asked for.
    #[error("no light is called {wanted:?}; {known}")]
    NoLight {
        /// The name or the number.
        wanted: String,
        /// The lights that there are, as a clause.
        known: String,
    },
    /// The world has no `Assets<Mesh>` to put meshes into.
    #[error("the world has no `Assets<Mesh>`; add `MeshPlugin` before a scene is spawned")]
    NoMeshAssets,
    /// Some object has an image, and the world has no `Assets<Texture>` to keep it in.
    #[error("the world has no Assets<Texture>, which the images of objects need; add TexturePlugin")]
    NoTextureAssets,
}

impl SceneError {
    /// The path of the key that is wrong, such as `lights[2].attenuation`, where there is one.
    pub fn key(&self) -> Option<&str> {
        match self {
            Self::Text { key, .. }
            | Self::Value { key, .. }
            | Self::Model { key, .. }
            | Self::ModelValue { key, .. } => Some(key),
            _ => None,
        }
    }
}

fn named(key: &str) -> String {
    if key.is_empty() { String::new() } else { format!("`{key}`: ") }
}
