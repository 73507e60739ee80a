//! Wavefront OBJ and MTL.

use std::collections::HashSet;
use std::io::{self, Write};
use std::path::Path;

use glam::{DVec3, Vec3, Vec4};

use super::file::{WriteError, replace};
use super::images::ImageFiles;
use super::placed::{Placed, coordinates, lost_in_text, upward};
use crate::files::srgb::encoded;
use crate::{LinePart, Mesh, Model, MtlMaterial, SourceMaterial};

/// Writes an object for each part and each group of lines, and an MTL file where there are materials.
pub(super) fn write(path: &Path, model: &Model) -> Result<Vec<String>, WriteError> {
    let mut lost = lost_in_text(model);
    let names = unique_names(model);
    let library = path.with_extension("mtl");
    let mut images = ImageFiles::new(path);
    let maps: Vec<Vec<String>> = model.materials.iter().map(|source| images.statements(source)).collect();
    images.write()?;
    if !model.materials.is_empty() {
        replace(&library, |file| {
            let mut materials = model.materials.iter().zip(&names).zip(&maps);
            materials.try_for_each(|((source, name), maps)| {
                write_material(file, name, source)?;
                maps.iter().try_for_each(|map| writeln!(file, "{map}"))
            })
        })?;
    }
    lost.extend(images.into_lost());
    let renamed = model.materials.iter().zip(&names).filter(|(material, name)| material.name() != *name).count();
    let pbr = model.materials.iter().filter(|source| matches!(source, SourceMaterial::MetallicRoughness(_))).count();
    let with_normals = model.lines.iter().filter(|part| part.lines.normals().is_some()).count();
    let distinct: HashSet<_> = model.parts.iter().map(|part| (one_line(&part.name), part.material)).collect();
    for (count, what) in [
        (
            model.parts.len() - distinct.len(),
            "parts have the name and the material of another, and will be read as one with it",
        ),
        (renamed, "materials get another name"),
        (with_normals, "groups of lines lose their normals"),
        (pbr, "materials lose their alpha mode, and which faces they show"),
    ] {
        if count > 0 {
            lost.push(format!("{count} {what}"));
        }
    }
    let placed: Vec<Placed> =
        model.parts.iter().enumerate().map(|(i, part)| Placed::new(path, i, part)).collect::<Result<_, _>>()?;
    let lines = model.lines.iter().enumerate();
    let placed_lines = lines.map(|(i, part)| Placed::line_positions(path, i, part)).collect::<Result<Vec<_>, _>>()?;
    replace(path, |file| {
        if !model.materials.is_empty() {
            writeln!(file, "mtllib {}", library.file_name().unwrap_or_default().to_string_lossy())?;
        }
        let mut first = [1, 1];
        let mut used = None;
        for (part, placed) in model.parts.iter().zip(&placed) {
            writeln!(file, "o {}", one_line(&part.name))?;
            if part.material != used {
                // The format returns to no material only by a name that is defined nowhere.
                let name = part.material.and_then(|material| names.get(material)).map_or("none", String::as_str);
                writeln!(file, "usemtl {name}")?;
                used = part.material;
            }
            write_part(file, &part.mesh, (placed, model.origin), &mut first)?;
        }
        for (part, positions) in model.lines.iter().zip(&placed_lines) {
            writeln!(file, "o {}", one_line(&part.name))?;
            if part.material != used {
                let name = part.material.and_then(|material| names.get(material)).map_or("none", String::as_str);
                writeln!(file, "usemtl {name}")?;
                used = part.material;
            }
            write_lines(file, part, (positions, model.origin), &mut first)?;
        }
        Ok(())
    })?;
    Ok(lost)
}

/// The vertices, lines and points of a group.
fn write_lines(
    file: &mut impl Write,
    part: &LinePart,
    (positions, origin): (&[Vec3], DVec3),
    first: &mut [u64; 2],
) -> io::Result<()> {
    write_positions(file, (positions, origin), part.lines.colors())?;
    let number = |vertex: &u32| first[0] + u64::from(*vertex);
    for [from, to] in part.lines.segments() {
        writeln!(file, "l {} {}", number(from), number(to))?;
    }
    for point in part.lines.points() {
        writeln!(file, "p {}", number(point))?;
    }
    first[0] += positions.len() as u64;
    Ok(())
}

fn write_positions(
    file: &mut impl Write,
    (positions, origin): (&[Vec3], DVec3),
    colors: Option<&[Vec4]>,
) -> io::Result<()> {
    for (i, p) in positions.iter().enumerate() {
        let p = coordinates(origin, *p);
        match colors {
            None => writeln!(file, "v {p}")?,
            Some(colors) => {
                let [r, g, b] = colors[i].truncate().to_array().map(encoded);
                writeln!(file, "v {p} {r} {g} {b}")?;
            }
        }
    }
    Ok(())
}

/// The vertices and faces of a part; `first` are the numbers of its first vertex and texture coordinate.
fn write_part(
    file: &mut impl Write,
    mesh: &Mesh,
    (placed, origin): (&Placed, DVec3),
    first: &mut [u64; 2],
) -> io::Result<()> {
    write_positions(file, (&placed.positions, origin), mesh.colors())?;
    for uv in mesh.uvs().unwrap_or_default() {
        writeln!(file, "vt {} {}", uv.x, upward(uv.y))?;
    }
    for n in &placed.normals {
        writeln!(file, "vn {} {} {}", n.x, n.y, n.z)?;
    }
    for triangle in mesh.triangles() {
        write!(file, "f")?;
        for corner in placed.triangle(triangle) {
            let (v, vt) = (first[0] + u64::from(corner), first[1] + u64::from(corner));
            match mesh.uvs() {
                Some(_) => write!(file, " {v}/{vt}/{v}")?,
                None => write!(file, " {v}//{v}")?,
            }
        }
        writeln!(file)?;
    }
    first[0] += mesh.positions().len() as u64;
    first[1] += mesh.uvs().map_or(0, <[_]>::len) as u64;
    Ok(())
}

fn write_material(file: &mut impl Write, name: &str, source: &SourceMaterial) -> io::Result<()> {
    writeln!(file, "newmtl {name}")?;
    let of_pbr;
    let mtl = match source {
        SourceMaterial::Mtl(mtl) => mtl,
        SourceMaterial::MetallicRoughness(pbr) => {
            let [r, g, b, alpha] = pbr.base_color;
            // `illum 0` is the sum of Kd and Ke, whatever the lights.
            let (ke, illum) = if pbr.unlit { (None, Some(0)) } else { (Some(pbr.emissive), None) };
            let [pr, pm] = [pbr.roughness, pbr.metallic].map(|factor| (!pbr.unlit).then_some(factor));
            of_pbr = MtlMaterial { kd: Some([r, g, b]), ke, d: Some(alpha), illum, pr, pm, ..MtlMaterial::default() };
            &of_pbr
        }
    };
    for (keyword, color) in [("Ka", mtl.ka), ("Kd", mtl.kd), ("Ks", mtl.ks), ("Ke", mtl.ke)] {
        if let Some([r, g, b]) = color {
            writeln!(file, "{keyword} {r} {g} {b}")?;
        }
    }
    for (keyword, number) in [("Ns", mtl.ns), ("d", mtl.d), ("Tr", mtl.tr), ("Pr", mtl.pr), ("Pm", mtl.pm)] {
        if let Some(number) = number {
            writeln!(file, "{keyword} {number}")?;
        }
    }
    mtl.illum.map_or(Ok(()), |illum| writeln!(file, "illum {illum}"))
}

/// Unique names of the materials, each on one line.
fn unique_names(model: &Model) -> Vec<String> {
    let mut seen = HashSet::from(["none".to_owned()]);
    model
        .materials
        .iter()
        .enumerate()
        .map(|(index, material)| {
            let mut name = one_line(material.name());
            if name.is_empty() || seen.contains(&name) {
                name = format!("material_{index}");
            }
            while !seen.insert(name.clone()) {
                name.push('_');
            }
            name
        })
        .collect()
}

/// A name on one line.
fn one_line(name: &str) -> String {
    let flat: String = name.chars().map(|c| if c.is_control() || c == '\\' { ' ' } else { c }).collect();
    flat.trim_ascii().to_owned()
}
