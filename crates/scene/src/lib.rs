#![doc = include_str!("../README.md")]
//!
//! The format is described in `docs/scene-format.md`, and as a JSON schema in `docs/scene.schema.json`
//! ([`json_schema`]). [`SceneFile`] is the file as a value, and [`spawn()`] turns it into entities.

mod animation;
mod check;
mod defaults;
mod described;
mod displacement;
mod edges;
mod entry;
mod environment;
mod error;
mod file;
mod follow;
pub mod import;
mod intensity;
mod json;
mod keys;
mod light;
mod light_place;
mod lights_entry;
mod lines;
mod locate;
mod maps;
mod material;
mod mesh;
mod model_animation;
mod model_root;
mod models;
mod named;
mod object;
pub mod options;
mod part_of_light;
mod placement;
mod retired;
mod scalars;
mod scalars_entry;
mod schema;
mod solid;
mod spawn;
mod surface;
mod track;
mod transform;
mod turntable;
mod view;
mod viewport;

pub use animation::{AnimationPlugin, AnimationSystems, SceneTime};
pub use defaults::{default_lights, framing_camera, rig_lights};
pub use displacement::DisplacementEntry;
pub use edges::EdgesEntry;
pub use environment::EnvironmentEntry;
pub use error::SceneError;
pub use file::SceneFile;
pub use halfway_lighting::LightComponent;
pub use halfway_mesh::ScalarValues;
pub use light::{AttachEntry, ConeEntry, LightEntry, LightKind};
pub use lights_entry::LightsEntry;
pub use lines::LineStyleEntry;
pub use material::MaterialEntry;
pub use mesh::{InlineMesh, LoadedModel, MeshEntry};
pub use model_root::{ModelError, ModelFailed, ModelParts, ModelRoot, spawn_model};
pub use named::NameOrIndex;
pub use object::ObjectEntry;
pub use part_of_light::{LightSource, PartOfLight};
pub use scalars::{ColorMap, Scalars, ScalarsError};
pub use scalars_entry::ScalarsEntry;
pub use schema::json_schema;
pub use solid::SolidEntry;
pub use spawn::{Spawned, outline, spawn, spawn_seen_from};
pub use surface::{
    BezierEntry, CapsuleEntry, ConeMeshEntry, CylinderEntry, DiscEntry, EllipsoidEntry, HeightFieldEntry,
    HyperboloidEntry, HyperboloidSheetEntry, ParaboloidEntry, PolynomialEntry, SurfaceEntry, TorusEntry,
};
pub use track::{AnimatedKey, Interpolation, KeyFrame, TrackEntry};
pub use transform::{TransformEntry, TransformMatrix, TransformParts};
pub use turntable::Turntable;
pub use view::{CameraEntry, IntrinsicsEntry};
pub use viewport::ViewportEntry;
