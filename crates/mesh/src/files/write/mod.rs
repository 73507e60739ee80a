//! Writers of model files.

mod file;
mod glb;
mod images;
mod obj;
mod placed;
mod ply;
mod quantise;
mod smf;
mod stl;

use std::path::Path;

pub use file::WriteError;

use super::Format;
use crate::{Model, SourceMaterial};

/// Writes a model into an SMF, OBJ, GLB, glTF, PLY (binary) or STL (binary) file, told by the extension in upper or lower
/// case. OBJ adds an MTL file of the same name if the model has materials, glTF its buffer, and both the images of the
/// materials, under the model's name with a number. Each file is written under a temporary name and renamed, so that a
/// partial file is never seen.
///
/// Returns a sentence for each thing that the format cannot hold. Numbers are written so that they are read back as
/// the same `f32`; of positions and normals that holds for parts at the origin: SMF and OBJ have no transforms and get
/// vertices in world space, as do PLY and STL. Positions that are counted from [`Model::origin`] are written with the
/// digits of the world, in PLY as `double`; STL rounds them. Texture coordinates of SMF and OBJ run upward, which costs those below 1e-9 their last
/// bits. Both get vertex colours as sRGB. See [`load`](crate::load) for an example.
///
/// glTF keeps [`Model::animations`], as long as parts, lines, lights and cameras stand as they were read, and meshes that
/// skins or morph targets move are those that were read; other meshes and all materials may have changed.
///
/// # Errors
/// An unknown extension, a model without parts, more than the format can count, or an error of the system.
pub fn write(path: &Path, model: &Model) -> Result<Vec<String>, WriteError> {
    if model.is_empty() {
        return Err(WriteError::NoParts { path: path.to_owned() });
    }
    let mut lost = match Format::from_path(path) {
        Some(Format::Smf) => smf::write(path, model),
        Some(Format::Obj) => obj::write(path, model),
        Some(Format::Gltf | Format::Glb) => glb::write(path, model, false).map(|(_, lost)| lost),
        Some(Format::Ply) => ply::write(path, model, false),
        Some(Format::Stl) => stl::write(path, model),
        Some(Format::Off | Format::ThreeMf) | None => {
            let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
            Err(WriteError::UnknownExtension { path: path.to_owned(), extension })
        }
    }?;
    let is_gltf = matches!(Format::from_path(path), Some(Format::Gltf | Format::Glb));
    let has_images = is_gltf || Format::from_path(path) == Some(Format::Obj);
    lost.extend(lost_images(model).filter(|_| !has_images));
    lost.extend(lost_animations(model).filter(|_| !is_gltf));
    lost.extend(lost_in_all(model));
    Ok(lost)
}

/// Writes a model into a PLY file in ASCII, where [`write()`] writes a binary one.
///
/// ```
/// use glam::Mat4;
/// use halfway_mesh::{Cuboid, Mesh, Model, Part, write_ascii};
///
/// let path = std::env::temp_dir().join(format!("ascii_{}.ply", std::process::id()));
/// let part = Part { name: String::new(), mesh: Mesh::from(Cuboid::default()), material: None, world_from_part: Mat4::IDENTITY };
/// let lost = write_ascii(&path, &Model { parts: vec![part], ..Model::default() })?;
/// assert!(lost.is_empty() && std::fs::read_to_string(&path)?.starts_with("ply\nformat ascii"));
/// # std::fs::remove_file(path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`write()`], and another extension than `ply`.
pub fn write_ascii(path: &Path, model: &Model) -> Result<Vec<String>, WriteError> {
    if model.is_empty() {
        return Err(WriteError::NoParts { path: path.to_owned() });
    }
    if Format::from_path(path) != Some(Format::Ply) {
        return Err(WriteError::NotAscii { path: path.to_owned() });
    }
    let mut lost = ply::write(path, model, true)?;
    lost.extend(lost_images(model).into_iter().chain(lost_animations(model)).chain(lost_in_all(model)));
    Ok(lost)
}

/// Writes a model into a GLB file with integers of 16 bits (`KHR_mesh_quantization`), which makes large meshes about
/// 40 % smaller.
///
/// Positions are rounded to 65,536 steps along the longest edge of each mesh's box, normals, tangents and colours to
/// 32,768 or more, texture coordinates to 65,536 where all of a mesh lie from 0 to 1. Lines and points stay as they are,
/// and so do meshes that skins or morph targets move. Returns the largest distance that
/// a position moved, in model space, and a sentence for each thing that the format cannot hold.
///
/// ```
/// use glam::Mat4;
/// use halfway_mesh::{Mesh, Model, Part, Teapot, write_quantised};
///
/// let path = std::env::temp_dir().join(format!("quantised_{}.glb", std::process::id()));
/// let mesh = Mesh::from(Teapot::new(4));
/// let part = Part { name: String::new(), mesh, material: None, world_from_part: Mat4::IDENTITY };
/// let (moved, lost) = write_quantised(&path, &Model { parts: vec![part], ..Model::default() })?;
/// assert!(moved < 1e-4 && lost.is_empty());
/// # std::fs::remove_file(path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`write()`], and another extension than `glb`.
pub fn write_quantised(path: &Path, model: &Model) -> Result<(f64, Vec<String>), WriteError> {
    if model.is_empty() {
        return Err(WriteError::NoParts { path: path.to_owned() });
    }
    if Format::from_path(path) != Some(Format::Glb) {
        return Err(WriteError::NotQuantised { path: path.to_owned() });
    }
    let (moved, mut lost) = glb::write(path, model, true)?;
    lost.extend(lost_in_all(model));
    Ok((moved, lost))
}

/// Warnings about what no format is written with: numbers beside the meshes, highlights of specular-glossiness materials.
fn lost_in_all(model: &Model) -> impl Iterator<Item = String> + use<> {
    let names: Vec<&str> = model.properties.iter().map(|property| property.name.as_str()).collect();
    let properties = (!names.is_empty()).then(|| format!("properties: {}", names.join(", ")));
    let is_pbr = |source: &&SourceMaterial| matches!(source, SourceMaterial::MetallicRoughness(pbr) if pbr.specular_glossiness.is_some());
    let glossy = model.materials.iter().filter(is_pbr).count();
    let glossy = (glossy > 0).then(|| format!("{glossy} materials lose their specular color and glossiness"));
    properties.into_iter().chain(glossy)
}

/// The warning about animations, which glTF alone has.
fn lost_animations(model: &Model) -> Option<String> {
    let count = model.animations.as_ref()?.clips().len();
    Some(format!("{count} animations; the model is written in the pose of the file"))
}

/// The warning about images that materials refer to.
fn lost_images(model: &Model) -> Option<String> {
    let count = model.materials.iter().filter(|material| material.has_maps()).count();
    (count > 0).then(|| format!("{count} materials lose their images"))
}
