//! Writers of model files.

mod file;
mod glb;
mod obj;
mod placed;
mod quantise;
mod smf;

use std::path::Path;

pub use file::WriteError;

use super::Format;
use crate::Model;

/// Writes a model into an SMF, OBJ or GLB file, told by the extension in either case. OBJ brings an MTL file of the
/// same name where the model has materials. Files are written beside their place and renamed, so that half a file is
/// never there.
///
/// Returns what the format cannot hold, one sentence each. Numbers are written so that they are read as the same `f32`;
/// of positions and normals that holds for parts that stand at the origin, since SMF and OBJ have no places: they get
/// the vertices where they stand in the world. Texture coordinates of SMF and OBJ run upward, which costs those below
/// 1e-9 their last bits. Vertex colours are written as sRGB in both.
///
/// # Errors
/// Another extension, a model without parts, more than the format can count, or the system refuses.
pub fn write(path: &Path, model: &Model) -> Result<Vec<String>, WriteError> {
    if model.parts.is_empty() {
        return Err(WriteError::NoParts { path: path.to_owned() });
    }
    let mut lost = match Format::of(path) {
        Some(Format::Smf) => smf::write(path, model),
        Some(Format::Obj) => obj::write(path, model),
        Some(Format::Glb) => glb::write(path, model, false),
        _ => {
            let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
            Err(WriteError::UnknownExtension { path: path.to_owned(), extension })
        }
    }?;
    lost.extend(lost_images(model));
    Ok(lost)
}

/// Writes a model into a GLB file with integers of 16 bits (`KHR_mesh_quantization`), which takes about 60 % of
/// the room for large meshes.
///
/// Positions are rounded to 65,536 steps along the longest edge of each mesh's box, normals, tangents and colours to
/// 32,768 or more, texture coordinates to 65,536 where all of a mesh lie from 0 to 1. Returns how far positions moved
/// at most, in model space, and what the format cannot hold, one sentence each.
///
/// # Errors
/// As [`write()`], and another extension than `glb`.
pub fn write_quantised(path: &Path, model: &Model) -> Result<(f64, Vec<String>), WriteError> {
    if model.parts.is_empty() {
        return Err(WriteError::NoParts { path: path.to_owned() });
    }
    if Format::of(path) != Some(Format::Glb) {
        return Err(WriteError::NotQuantised { path: path.to_owned() });
    }
    let moved = model.parts.iter().map(|part| quantise::Grid::of(&part.mesh).largest_error()).fold(0.0, f64::max);
    let mut lost = glb::write(path, model, true)?;
    lost.extend(lost_images(model));
    Ok((moved, lost))
}

/// What is said of images that materials refer to.
fn lost_images(model: &Model) -> Option<String> {
    let count = model.materials.iter().filter(|material| material.has_maps()).count();
    (count > 0).then(|| format!("{count} materials lose their images"))
}
