//! Scene files: cameras, lights, materials and meshes as JSON, read, checked, written and put into a world.
//!
//! [`SceneFile`] is the file as a value: [`SceneFile::read`] reads one and says exactly what is wrong with it,
//! [`SceneFile::write`] writes one. [`spawn()`] turns it into entities. The format is described in
//! `docs/scene-format.md`, and as a JSON schema in `docs/scene.schema.json` ([`json_schema`]).
//!
//! ```
//! use halfway_scene::SceneFile;
//!
//! let scene = SceneFile::from_json(r#"{"objects": [{"mesh": {"teapot": {}}}]}"#, "example").unwrap();
//! assert_eq!(scene.size, [1280, 720]);
//!
//! let error = SceneFile::from_json(r#"{"objects": [{"mesh": {"teapot": {"divisons": 4}}}]}"#, "example").unwrap_err();
//! assert_eq!(error.key(), Some("objects[0].mesh.teapot.divisons"));
//! ```

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
mod light_component;
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

pub use defaults::{default_lights, framing_camera};
pub use environment::EnvironmentEntry;
pub use error::SceneError;
pub use file::SceneFile;
pub use light::{AttachEntry, ConeEntry, LightEntry, LightKind};
pub use light_component::LightComponent;
pub use material::MaterialEntry;
pub use mesh::{InlineMesh, MeshEntry};
pub use model_root::{ModelError, ModelFailed, ModelParts, ModelRoot, spawn_model};
pub use object::ObjectEntry;
pub use schema::json_schema;
pub use solid::SolidEntry;
pub use spawn::{Spawned, spawn};
pub use transform::{TransformEntry, TransformMatrix, TransformParts};
pub use view::CameraEntry;
