//! Materials and lights of model files, as components.
//!
//! `halfway_mesh` reads files and `halfway_lighting` has the equations; this module translates between them. It follows
//! the exact statements of a format exactly, decides and documents the questions that the format leaves open, and
//! returns each change as a [`Warning`].
//!
//! ```no_run
//! use halfway_scene::import::ModelMaterial;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let model = halfway_mesh::load("assets/teapot.obj".as_ref())?;
//! for source in &model.materials {
//!     let (material, warnings) = ModelMaterial::from_source(source)?;
//!     println!("{}: {:?} {warnings:?}", source.name(), material.material);
//! }
//! # Ok(())
//! # }
//! ```

mod camera;
mod maps;
mod metallic_roughness;
mod model_material;
mod mtl;
mod punctual;
mod warning;

pub use camera::model_camera;
pub use metallic_roughness::{
    DIELECTRIC_REFLECTANCE, SHININESS_MAX, from_metallic_roughness, shininess_from_roughness,
};
pub use model_material::ModelMaterial;
pub use mtl::from_mtl;
pub use punctual::{RADIANCE_SCALE, from_punctual, model_light};
pub use warning::Warning;

pub(crate) use camera::camera_place;
pub(crate) use maps::{channel, maps, sampling, transform};
