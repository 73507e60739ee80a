//! Writers of model files.

mod glb;
mod obj;
mod quantise;
mod smf;

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use bevy_math::{DMat3, Mat4, Vec3};
use thiserror::Error;

use super::Format;
use crate::{Model, Part};

/// Why a model was not written. Nothing is left behind, and a file that was there before stays as it was.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The extension names no format that is written.
    #[error("{}: the extension {extension:?} names no format that is written; smf, obj or glb is expected", path.display())]
    UnknownExtension {
        /// The file.
        path: PathBuf,
        /// What follows the last dot of its name, in lower case; empty where there is none.
        extension: String,
    },
    /// Only GLB holds quantised meshes.
    #[error("{}: only .glb holds integers of 16 bits", path.display())]
    NotQuantised {
        /// The file.
        path: PathBuf,
    },
    /// The model has no parts, and no format can say so.
    #[error("{}: the model has no parts; at least one is expected", path.display())]
    NoParts {
        /// The file.
        path: PathBuf,
    },
    /// More than the format can count.
    #[error("{}: {what}; at most {} are expected", path.display(), u32::MAX)]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// What there is too much of, and how much.
        what: String,
    },
    /// A part stands where its vertices leave the range of single precision.
    #[error("{}: the vertices of part {part}, where they stand in the world, are not finite", path.display())]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// The part, from 0.
        part: usize,
    },
    /// The system refuses.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}

/// Writes a model into an SMF, OBJ or GLB file, told by the extension in either case. OBJ brings an MTL file of the same
/// name where the model has materials. Files are written beside their place and renamed, so that half a file is never
/// there.
///
/// Returns what the format cannot hold, one sentence each. Numbers are written so that they are read as the same `f32`;
/// of positions and normals that holds for parts that stand at the origin, since SMF and OBJ have no places: they get the
/// vertices where they stand in the world. Texture coordinates of SMF and OBJ run upward, which costs those below 1e-9
/// their last bits. Vertex colours are written as sRGB in both.
///
/// # Errors
/// Another extension, a model without parts, more than the format can count, or the system refuses.
pub fn write(path: &Path, model: &Model) -> Result<Vec<String>, WriteError> {
    if model.parts.is_empty() {
        return Err(WriteError::NoParts { path: path.to_owned() });
    }
    match Format::of(path) {
        Some(Format::Smf) => smf::write(path, model),
        Some(Format::Obj) => obj::write(path, model),
        Some(Format::Glb) => glb::write(path, model, false),
        _ => {
            let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
            Err(WriteError::UnknownExtension { path: path.to_owned(), extension })
        }
    }
}

/// Writes a model into a GLB file with integers of 16 bits (`KHR_mesh_quantization`), which takes about half the room.
///
/// Positions are rounded to 65,536 steps along the longest edge of each mesh's box, normals, tangents and colours to
/// 32,768 or more, texture coordinates to 65,536 where all of a mesh lie from 0 to 1. Returns how far positions moved at
/// most, in model space, and what the format cannot hold, one sentence each.
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
    Ok((moved, glb::write(path, model, true)?))
}

/// Writes a file beside its place and renames it.
fn replace(path: &Path, content: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> Result<(), WriteError> {
    let failed = |source| WriteError::Write { path: path.to_owned(), source };
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.partial", std::process::id()));
    let beside = path.with_file_name(name);
    let written = File::create(&beside).and_then(|file| {
        let mut file = BufWriter::with_capacity(1 << 16, file);
        content(&mut file)?;
        file.flush()
    });
    written.and_then(|()| fs::rename(&beside, path)).map_err(|source| {
        let _ = fs::remove_file(&beside);
        failed(source)
    })
}

/// The vertices of a part where they stand in the world.
struct Placed {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    /// Whether triangles wind the other way round because the part is mirrored.
    mirrored: bool,
}

impl Placed {
    fn new(path: &Path, index: usize, part: &Part) -> Result<Self, WriteError> {
        let (positions, normals) = (part.mesh.positions(), part.mesh.normals());
        if part.world_from_part == Mat4::IDENTITY {
            return Ok(Self { positions: positions.to_vec(), normals: normals.to_vec(), mirrored: false });
        }
        let world_from_part = part.world_from_part.as_dmat4();
        let positions: Vec<Vec3> =
            positions.iter().map(|p| world_from_part.transform_point3(p.as_dvec3()).as_vec3()).collect();
        if !positions.iter().all(|p| p.is_finite()) {
            return Err(WriteError::NotFinite { path: path.to_owned(), part: index });
        }
        let m = DMat3::from_mat4(world_from_part);
        let mirrored = m.determinant() < 0.0;
        // The inverse transpose but for a factor, whose sign is set right.
        let cofactors = DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
        let sign = if mirrored { -1.0 } else { 1.0 };
        let turn = |n: &Vec3| (sign * (cofactors * n.as_dvec3())).try_normalize().unwrap_or(n.as_dvec3()).as_vec3();
        Ok(Self { normals: normals.iter().map(turn).collect(), positions, mirrored })
    }

    /// The corners of a triangle, so that its front stays in front.
    fn triangle(&self, [a, b, c]: [u32; 3]) -> [u32; 3] {
        if self.mirrored { [a, c, b] } else { [a, b, c] }
    }
}

/// v upward, with all the digits that it takes to be turned again without loss.
fn upward(v: f32) -> f64 {
    1.0 - f64::from(v)
}

/// What SMF and OBJ cannot hold.
fn lost_in_text(model: &Model) -> Vec<String> {
    let mut lost = Vec::new();
    let mut add = |count: usize, what: &str| {
        if count > 0 {
            lost.push(format!("{count} {what}"));
        }
    };
    let parts = &model.parts;
    add(
        parts.iter().filter(|part| part.world_from_part != Mat4::IDENTITY).count(),
        "places of parts; their vertices are moved instead",
    );
    add(parts.iter().filter(|part| part.mesh.tangents().is_some()).count(), "parts lose their tangents");
    let is_clear =
        |part: &&Part| part.mesh.colors().is_some_and(|colors| colors.iter().any(|c| (c.w - 1.0).abs() > 0.0));
    add(parts.iter().filter(is_clear).count(), "parts lose the opacity of their vertices");
    add(model.lights.len(), "lights");
    add(model.cameras.len(), "cameras");
    lost
}
