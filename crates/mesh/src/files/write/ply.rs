//! PLY.

use std::io::{self, Write};
use std::path::Path;

use glam::{DVec3, Vec2, Vec3, Vec4};

use super::file::{WriteError, replace};
use super::placed::{Placed, coordinates, lost_in_text, upward};
use crate::Model;
use crate::files::srgb::encoded;

/// Writes all parts as one mesh, and lines as edges, or points if there is nothing else. Positions are `double` where
/// they are counted from an origin.
pub(super) fn write(path: &Path, model: &Model, in_ascii: bool) -> Result<Vec<String>, WriteError> {
    let is_cloud = model.parts.is_empty() && model.line_count() == 0;
    let placed = model.parts.iter().enumerate().map(|(i, part)| Placed::new(path, i, part));
    let placed: Vec<Placed> = placed.collect::<Result<_, _>>()?;
    let lines = model.lines.iter().filter(|part| is_cloud || !part.lines.segments().is_empty());
    let lines: Vec<_> = lines.collect();
    let of_lines = lines.iter().enumerate().map(|(i, part)| Placed::line_positions(path, i, part));
    let of_lines = of_lines.collect::<Result<Vec<_>, _>>()?;
    let has_uvs = model.parts.iter().any(|part| part.mesh.uvs().is_some());
    let colors_of_lines = lines.iter().map(|part| part.lines.colors());
    let has_colors =
        model.parts.iter().map(|part| part.mesh.colors()).chain(colors_of_lines).any(|colors| colors.is_some());
    let has_normals = !model.parts.is_empty() || lines.iter().all(|part| part.lines.normals().is_some());
    let columns =
        Columns { normals: has_normals, uvs: has_uvs, colors: has_colors, double: model.origin != DVec3::ZERO };
    let count = placed.iter().map(|placed| placed.positions.len()).chain(of_lines.iter().map(Vec::len)).sum::<usize>();
    if u32::try_from(count).is_err() {
        return Err(WriteError::TooLarge { path: path.to_owned(), what: format!("{count} vertices") });
    }
    replace(path, |file| {
        let mut out = Out { file, in_ascii, origin: model.origin };
        out.header(count, &columns, model)?;
        for (part, placed) in model.parts.iter().zip(&placed) {
            let mesh = &part.mesh;
            for (i, p) in placed.positions.iter().enumerate() {
                let uv = mesh.uvs().map_or(Vec2::Y, |uvs| uvs[i]);
                let color = mesh.colors().map_or(Vec4::ONE, |colors| colors[i]);
                out.vertex(&columns, *p, placed.normals[i], uv, color)?;
            }
        }
        for (part, positions) in lines.iter().zip(&of_lines) {
            for (i, p) in positions.iter().enumerate() {
                let n = part.lines.normals().map_or(Vec3::ZERO, |normals| normals[i]);
                let color = part.lines.colors().map_or(Vec4::ONE, |colors| colors[i]);
                out.vertex(&columns, *p, n, Vec2::Y, color)?;
            }
        }
        let mut first = 0;
        for (part, placed) in model.parts.iter().zip(&placed) {
            for triangle in part.mesh.triangles() {
                out.corners(&placed.triangle(triangle).map(|corner| first + corner), true)?;
            }
            first += placed.positions.len() as u32;
        }
        for (part, positions) in lines.iter().zip(&of_lines) {
            for segment in part.lines.segments() {
                out.corners(&segment.map(|end| first + end), false)?;
            }
            first += positions.len() as u32;
        }
        Ok(())
    })?;
    Ok(lost(model, is_cloud, has_colors))
}

fn lost(model: &Model, is_cloud: bool, has_colors: bool) -> Vec<String> {
    let mut lost: Vec<_> =
        lost_in_text(model).into_iter().filter(|lost| !lost.ends_with("the opacity of their vertices")).collect();
    if has_colors {
        lost.push("colours are rounded to 8 bits".to_owned());
    }
    let second = model.parts.iter().filter(|part| part.mesh.uv_set(1).is_some()).count();
    let points = if is_cloud { 0 } else { model.point_count() };
    for (count, what) in [
        (points, "points"),
        (second, "parts lose their second texture coordinates"),
        (model.materials.len(), "materials"),
    ] {
        if count > 0 {
            lost.push(format!("{count} {what}"));
        }
    }
    if model.parts.len() + model.lines.len() > 1 {
        lost.push(format!("the names and borders of {} parts", model.parts.len() + model.lines.len()));
    }
    lost
}

/// The columns of a vertex beside its position.
#[expect(clippy::struct_excessive_bools, reason = "one for each group of columns")]
struct Columns {
    normals: bool,
    uvs: bool,
    colors: bool,
    /// Whether positions are `double`.
    double: bool,
}

struct Out<'a, W> {
    file: &'a mut W,
    in_ascii: bool,
    origin: DVec3,
}

impl<W: Write> Out<'_, W> {
    fn header(&mut self, count: usize, columns: &Columns, model: &Model) -> io::Result<()> {
        let format = if self.in_ascii { "ascii" } else { "binary_little_endian" };
        writeln!(self.file, "ply\nformat {format} 1.0\ncomment halfway\nelement vertex {count}")?;
        let float = if columns.double { "double" } else { "float" };
        let mut properties = vec![(float, "x"), (float, "y"), (float, "z")];
        if columns.normals {
            properties.extend(["nx", "ny", "nz"].map(|name| ("float", name)));
        }
        if columns.uvs {
            properties.extend(["s", "t"].map(|name| ("float", name)));
        }
        if columns.colors {
            properties.extend(["red", "green", "blue", "alpha"].map(|name| ("uchar", name)));
        }
        for (kind, name) in properties {
            writeln!(self.file, "property {kind} {name}")?;
        }
        if model.triangle_count() > 0 {
            let faces = model.triangle_count();
            writeln!(self.file, "element face {faces}\nproperty list uchar uint vertex_indices")?;
        }
        if model.line_count() > 0 {
            let edges = model.line_count();
            writeln!(self.file, "element edge {edges}\nproperty uint vertex1\nproperty uint vertex2")?;
        }
        writeln!(self.file, "end_header")
    }

    fn vertex(&mut self, columns: &Columns, p: Vec3, n: Vec3, uv: Vec2, color: Vec4) -> io::Result<()> {
        let t = upward(uv.y) as f32;
        let [r, g, b] = color.truncate().to_array().map(encoded);
        let color = [r, g, b, color.w].map(|x| (x.clamp(0.0, 1.0) * 255.0).round() as u8);
        if self.in_ascii {
            write!(self.file, "{}", coordinates(self.origin, p))?;
            if columns.normals {
                write!(self.file, " {} {} {}", n.x, n.y, n.z)?;
            }
            if columns.uvs {
                write!(self.file, " {} {t}", uv.x)?;
            }
            if columns.colors {
                write!(self.file, " {} {} {} {}", color[0], color[1], color[2], color[3])?;
            }
            return writeln!(self.file);
        }
        if columns.double {
            let world = self.origin + p.as_dvec3();
            self.file.write_all(world.to_array().map(f64::to_le_bytes).as_flattened())?;
        } else {
            self.file.write_all(p.to_array().map(f32::to_le_bytes).as_flattened())?;
        }
        if columns.normals {
            self.file.write_all(n.to_array().map(f32::to_le_bytes).as_flattened())?;
        }
        if columns.uvs {
            self.file.write_all([uv.x, t].map(f32::to_le_bytes).as_flattened())?;
        }
        if columns.colors {
            self.file.write_all(&color)?;
        }
        Ok(())
    }

    /// A list of corners, with their number before it where that is `counted`.
    fn corners(&mut self, corners: &[u32], counted: bool) -> io::Result<()> {
        if self.in_ascii {
            let words: Vec<String> = corners.iter().map(u32::to_string).collect();
            let count = if counted { format!("{} ", corners.len()) } else { String::new() };
            return writeln!(self.file, "{count}{}", words.join(" "));
        }
        if counted {
            self.file.write_all(&[corners.len() as u8])?;
        }
        corners.iter().try_for_each(|corner| self.file.write_all(&corner.to_le_bytes()))
    }
}
