#![doc = include_str!("../README.md")]
//!
//! The format is described in `docs/scene-format.md`, and as a JSON schema in `docs/scene.schema.json`
//! ([`json_schema`]). [`SceneFile`] is the file as a value, and [`spawn()`] turns it into entities.

mod check;
mod defaults;
mod described;
mod entry;
mod environment;
mod error;
mod file;
pub mod import;
mod intensity;
mod json;
mod keys;
mod light;
mod light_place;
mod locate;
mod maps;
mod material;
mod mesh;
mod model_root;
mod models;
mod object;
mod placement;
mod retired;
mod schema;
mod solid;
mod spawn;
mod transform;
mod view;

pub use defaults::{default_lights, framing_camera, rig_lights};
pub use environment::EnvironmentEntry;
pub use error::SceneError;
pub use file::SceneFile;
pub use halfway_lighting::LightComponent;
pub use light::{AttachEntry, ConeEntry, LightEntry, LightKind};
pub use material::MaterialEntry;
pub use mesh::{InlineMesh, LoadedModel, MeshEntry};
pub use model_root::{ModelError, ModelFailed, ModelParts, ModelRoot, spawn_model};
pub use object::ObjectEntry;
pub use schema::json_schema;
pub use solid::SolidEntry;
pub use spawn::{Spawned, outline, spawn};
pub use transform::{TransformEntry, TransformMatrix, TransformParts};
pub use view::CameraEntry;
