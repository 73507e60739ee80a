//! Binary STL.

use std::io::Write as _;
use std::path::Path;

use glam::{DVec3, Vec3};

use super::file::{WriteError, replace};
use super::placed::{Placed, lost_in_text};
use crate::{Model, face_normal};

/// Writes the triangles of all parts, with their normals.
pub(super) fn write(path: &Path, model: &Model) -> Result<Vec<String>, WriteError> {
    if model.parts.is_empty() {
        return Err(WriteError::NoParts { path: path.to_owned() });
    }
    let count = model.triangle_count();
    let Ok(count) = u32::try_from(count) else {
        return Err(WriteError::TooLarge { path: path.to_owned(), what: format!("{count} triangles") });
    };
    let placed = model.parts.iter().enumerate().map(|(i, part)| Placed::new(path, i, part));
    let placed: Vec<Placed> = placed.collect::<Result<_, _>>()?;
    let world = |p: Vec3| model.origin + p.as_dvec3();
    let mut off = 0.0_f64;
    for p in placed.iter().flat_map(|placed| &placed.positions) {
        off = off.max((world(*p) - world(*p).as_vec3().as_dvec3()).abs().max_element());
    }
    replace(path, |file| {
        let mut header = [b' '; 80];
        header[..7].copy_from_slice(b"halfway");
        file.write_all(&header)?;
        file.write_all(&count.to_le_bytes())?;
        for (part, placed) in model.parts.iter().zip(&placed) {
            for triangle in part.mesh.triangles() {
                let corners = placed.triangle(triangle).map(|corner| placed.positions[corner as usize]);
                // 0 says that the reader is to find it.
                let n = face_normal(corners[0], corners[1], corners[2]).unwrap_or(Vec3::ZERO);
                let [a, b, c] = corners.map(|p| world(p).as_vec3());
                let numbers = [n, a, b, c].map(|p| p.to_array().map(f32::to_le_bytes));
                file.write_all(numbers.as_flattened().as_flattened())?;
                file.write_all(&[0, 0])?;
            }
        }
        Ok(())
    })?;
    Ok(lost(model, off))
}

/// The losses; positions are rounded by at most `off`.
fn lost(model: &Model, off: f64) -> Vec<String> {
    let mut lost: Vec<_> =
        lost_in_text(model).into_iter().filter(|lost| !lost.ends_with("the opacity of their vertices")).collect();
    let parts = &model.parts;
    for (count, what) in [
        (parts.iter().filter(|part| part.mesh.has_given_normals()).count(), "parts lose their normals"),
        (parts.iter().filter(|part| part.mesh.uvs().is_some()).count(), "parts lose their texture coordinates"),
        (parts.iter().filter(|part| part.mesh.colors().is_some()).count(), "parts lose the colours of their vertices"),
        (model.line_count(), "lines"),
        (model.point_count(), "points"),
        (model.materials.len(), "materials"),
    ] {
        if count > 0 {
            lost.push(format!("{count} {what}"));
        }
    }
    if parts.len() > 1 {
        lost.push(format!("the names and borders of {} parts", parts.len()));
    }
    if model.origin != DVec3::ZERO && off > 0.0 {
        lost.push(format!("positions, which are far from 0, are rounded to single precision, by at most {off:.1e}"));
    }
    lost
}
