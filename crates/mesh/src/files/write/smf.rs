//! SMF.

use std::io::Write as _;
use std::path::Path;

use super::file::{WriteError, replace};
use super::placed::{Placed, coordinates, lost_in_text, upward};
use crate::Model;
use crate::files::srgb::encoded;

/// Writes all parts as one object: vertices and triangles, then the normals, and the colours and texture coordinates
/// that any part has.
pub(super) fn write(path: &Path, model: &Model) -> Result<Vec<String>, WriteError> {
    let parts = &model.parts;
    let (vertices, triangles) =
        (parts.iter().map(|part| part.mesh.positions().len()).sum::<usize>(), model.triangle_count());
    let placed: Vec<Placed> =
        parts.iter().enumerate().map(|(i, part)| Placed::new(path, i, part)).collect::<Result<_, _>>()?;
    replace(path, |file| {
        writeln!(file, "#$SMF 1.0\n#$vertices {vertices}\n#$faces {triangles}")?;
        for p in placed.iter().flat_map(|placed| &placed.positions) {
            writeln!(file, "v {}", coordinates(model.origin, *p))?;
        }
        let mut first = 1;
        for (part, placed) in parts.iter().zip(&placed) {
            for triangle in part.mesh.triangles() {
                let [a, b, c] = placed.triangle(triangle).map(|i| first + u64::from(i));
                writeln!(file, "f {a} {b} {c}")?;
            }
            first += part.mesh.positions().len() as u64;
        }
        writeln!(file, "bind n vertex")?;
        for n in placed.iter().flat_map(|placed| &placed.normals) {
            writeln!(file, "n {} {} {}", n.x, n.y, n.z)?;
        }
        if parts.iter().any(|part| part.mesh.uvs().is_some()) {
            writeln!(file, "bind r vertex")?;
            for part in parts {
                for i in 0..part.mesh.positions().len() {
                    let (u, v) = part.mesh.uvs().map_or((0.0, 1.0), |uvs| (uvs[i].x, upward(uvs[i].y)));
                    writeln!(file, "r {u} {v}")?;
                }
            }
        }
        if parts.iter().any(|part| part.mesh.colors().is_some()) {
            writeln!(file, "bind c vertex")?;
            for part in parts {
                for i in 0..part.mesh.positions().len() {
                    let [r, g, b] = part.mesh.colors().map_or([1.0; 3], |c| c[i].truncate().to_array().map(encoded));
                    writeln!(file, "c {r} {g} {b}")?;
                }
            }
        }
        Ok(())
    })?;
    let mut lost = lost_in_text(model);
    for (count, what) in [(model.line_count(), "lines"), (model.point_count(), "points")] {
        if count > 0 {
            lost.push(format!("{count} {what}"));
        }
    }
    if !model.materials.is_empty() {
        lost.push(format!("{} materials", model.materials.len()));
    }
    if parts.len() > 1 {
        lost.push(format!("the names and borders of {} parts", parts.len()));
    }
    Ok(lost)
}
