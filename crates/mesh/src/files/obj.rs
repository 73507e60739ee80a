//! Wavefront OBJ.
//!
//! `tobj` puts the polygons together, but it cannot say the line of an error, takes polylines for polygons, and reads
//! past numbers that are out of range. So each statement is checked here first and handed on in a plainer form: one
//! statement a line, vertices before faces, absolute indices.

use std::collections::{BTreeSet, HashSet};
use std::fmt::Write as _;
use std::path::Path;

use bevy_math::{Mat4, Vec2, Vec3};

use super::text::{Skipped, Statement, abridged, statements};
use super::{LoadError, folder_of, mtl, read, stays_inside};
use crate::{Mesh, Model, Part, SourceMaterial};

/// Reads vertices, polygons, groups and materials; other statements are skipped with a warning. A missing MTL file is
/// a warning, a malformed one an error.
pub(super) fn parse(path: &Path, text: &[u8]) -> Result<Model, LoadError> {
    let joined = join_continued_lines(text);
    let mut plain = Plain::default();
    for statement in statements(path, &joined) {
        plain.add(&statement?)?;
    }
    plain.check_forward_references()?;
    plain.warn_of_smoothing_groups();

    let mut warnings = Vec::new();
    let mtl = plain.read_libraries(path, &mut warnings)?;
    let (models, materials) = assemble(path, &plain.text(), &mtl)?;
    plain.warn_of_unknown_materials(&materials);
    warnings.splice(0..0, std::mem::take(&mut plain.skipped).warnings(path));
    let mut parts = Vec::with_capacity(models.len());
    for model in models {
        if !model.mesh.indices.is_empty() {
            parts.push(part(path, model, &mut warnings)?);
        }
    }
    Ok(Model { parts, materials, lights: Vec::new(), warnings })
}

/// A backslash at the end of a line joins the next one to it. The lines keep their numbers: what was joined is
/// followed by empty lines.
fn join_continued_lines(text: &[u8]) -> Vec<u8> {
    let mut joined = Vec::with_capacity(text.len() + 1);
    let mut owed = 0;
    for line in text.split(|&byte| byte == b'\n') {
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        let is_comment = owed == 0 && line.trim_ascii_start().starts_with(b"#");
        if let Some(begun) = line.strip_suffix(b"\\").filter(|_| !is_comment) {
            joined.extend_from_slice(begun);
            joined.push(b' ');
            owed += 1;
        } else {
            joined.extend_from_slice(line);
            joined.resize(joined.len() + owed + 1, b'\n');
            owed = 0;
        }
    }
    joined
}

/// How many there are of the three things that a face refers to.
#[derive(Clone, Copy, Debug, Default)]
struct Counts([usize; 3]);

const REFERRED: [(&str, &str); 3] = [("v", "position"), ("vt", "texture coordinate"), ("vn", "normal")];

/// A positive index beyond what was defined above its line; the format asks for definition first, but files are about
/// that do without.
#[derive(Debug)]
struct ForwardReference<'a> {
    statement: Statement<'a>,
    kind: usize,
    index: i64,
}

/// The checked text.
#[derive(Debug, Default)]
struct Plain<'a> {
    vertices: String,
    faces: String,
    counts: Counts,
    forward: [Option<ForwardReference<'a>>; 3],
    libraries: Vec<Statement<'a>>,
    used_materials: Vec<(usize, &'a str)>,
    /// The line of the first smoothing group.
    smoothing: Option<usize>,
    skipped: Skipped,
}

impl<'a> Plain<'a> {
    fn add(&mut self, statement: &Statement<'a>) -> Result<(), LoadError> {
        match statement.keyword {
            "v" => self.position(statement)?,
            "vt" => self.texture_coordinate(statement)?,
            "vn" => self.normal(statement)?,
            "f" | "fo" => self.face(statement)?,
            "o" | "g" => writeln_to(&mut self.faces, "o", statement.rest),
            "usemtl" if statement.rest.is_empty() => {
                return Err(statement.unexpected("`usemtl` and a name is"));
            }
            "usemtl" => {
                self.used_materials.push((statement.line, statement.rest));
                writeln_to(&mut self.faces, "usemtl", statement.rest);
            }
            "mtllib" if statement.rest.is_empty() => {
                return Err(statement.unexpected("`mtllib` and a file name is"));
            }
            "mtllib" => self.libraries.push(*statement),
            "s" if matches!(statement.rest, "off" | "0") => {}
            "s" => self.smoothing = self.smoothing.or(Some(statement.line)),
            _ => self.skipped.add_statement(statement),
        }
        Ok(())
    }

    fn position(&mut self, statement: &Statement) -> Result<(), LoadError> {
        let words = numbers(statement, &[3, 4, 6, 7], "`v` and three numbers are")?;
        if words.len() >= 6 {
            self.skipped.add(statement.line, "vertex colours are skipped");
        }
        writeln_to(&mut self.vertices, "v", &words[..3].join(" "));
        self.counts.0[0] += 1;
        Ok(())
    }

    fn texture_coordinate(&mut self, statement: &Statement) -> Result<(), LoadError> {
        let words = numbers(statement, &[1, 2, 3], "`vt` and two numbers are")?;
        let v = words.get(1).unwrap_or(&"0");
        writeln_to(&mut self.vertices, "vt", &format!("{} {v}", words[0]));
        self.counts.0[1] += 1;
        Ok(())
    }

    fn normal(&mut self, statement: &Statement) -> Result<(), LoadError> {
        let words = numbers(statement, &[3], "`vn` and three numbers are")?;
        writeln_to(&mut self.vertices, "vn", &words.join(" "));
        self.counts.0[2] += 1;
        Ok(())
    }

    fn face(&mut self, statement: &Statement<'a>) -> Result<(), LoadError> {
        let corners = statement.words().count();
        if corners < 3 {
            let kind = "a face of fewer than three corners is skipped";
            self.skipped.add(statement.line, kind);
            return Ok(());
        }
        self.faces.push('f');
        for corner in statement.words() {
            self.corner(statement, corner)?;
        }
        self.faces.push('\n');
        Ok(())
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`, written with absolute indices.
    fn corner(&mut self, statement: &Statement<'a>, corner: &str) -> Result<(), LoadError> {
        const EXPECTED: &str = "corners of the form v, v/vt, v//vn or v/vt/vn are";
        let malformed = || statement.unexpected_word(corner, EXPECTED);
        for (kind, word) in corner.split('/').enumerate() {
            self.faces.push_str(if kind == 0 { " " } else { "/" });
            if kind == 1 && word.is_empty() {
                continue;
            }
            if kind > 2 {
                return Err(malformed());
            }
            let index: i64 = word.parse().map_err(|_| malformed())?;
            let absolute = self.absolute(statement, kind, index)?;
            let _ = write!(self.faces, "{absolute}");
        }
        Ok(())
    }

    /// A negative index counts back from the last one defined; 0 is none.
    fn absolute(&mut self, statement: &Statement<'a>, kind: usize, index: i64) -> Result<i64, LoadError> {
        let count = self.counts.0[kind] as i64;
        match index {
            1.. if index > count => {
                let furthest = self.forward[kind].as_ref().map_or(0, |found| found.index);
                if index > furthest {
                    self.forward[kind] = Some(ForwardReference { statement: *statement, kind, index });
                }
                Ok(index)
            }
            1.. => Ok(index),
            _ if index < 0 && index >= -count => Ok(count + 1 + index),
            _ => Err(out_of_range(statement, kind, index, count)),
        }
    }

    /// Only the furthest of each kind has to be looked at.
    fn check_forward_references(&self) -> Result<(), LoadError> {
        for found in self.forward.iter().flatten() {
            let count = self.counts.0[found.kind] as i64;
            if found.index > count {
                return Err(out_of_range(&found.statement, found.kind, found.index, count));
            }
        }
        Ok(())
    }

    /// The text for `tobj`; the name of the library is of no account, there is one only.
    fn text(&self) -> String {
        let Self { vertices, faces, .. } = self;
        format!("mtllib all\n{vertices}{faces}")
    }

    /// The checked text of all MTL files, each read once. What cannot be read is a warning.
    fn read_libraries(&self, path: &Path, warnings: &mut Vec<String>) -> Result<String, LoadError> {
        let mut plain = String::new();
        let mut seen = HashSet::new();
        for statement in &self.libraries {
            // A name may have spaces, and a statement may have several names.
            let whole = folder_of(path).join(statement.rest);
            let names: Vec<&str> = if stays_inside(Path::new(statement.rest)) && whole.exists() {
                vec![statement.rest]
            } else {
                statement.rest.split_whitespace().collect()
            };
            for name in names {
                if !seen.insert(name) {
                    continue;
                }
                if !stays_inside(Path::new(name)) {
                    warnings.push(format!("{name}: outside the folder of the model, not read"));
                    continue;
                }
                match read(&folder_of(path).join(name)) {
                    Ok(text) => {
                        let library = folder_of(path).join(name);
                        warnings.extend(mtl::check(&library, &text, &mut plain)?);
                    }
                    Err(error) => warnings.push(error.to_string()),
                }
            }
        }
        Ok(plain)
    }

    /// Smoothing groups say nothing more where there are normals.
    fn warn_of_smoothing_groups(&mut self) {
        if let (Some(line), 0) = (self.smoothing, self.counts.0[2]) {
            let kind = "smoothing groups are skipped; all normals are computed alike";
            self.skipped.add(line, kind);
        }
    }

    fn warn_of_unknown_materials(&mut self, materials: &[SourceMaterial]) {
        let known: BTreeSet<&str> = materials.iter().map(SourceMaterial::name).collect();
        for &(line, name) in &self.used_materials {
            if !known.contains(name) {
                self.skipped.add(line, format!("the material `{}` is nowhere defined", abridged(name, "")));
            }
        }
    }
}

fn out_of_range(statement: &Statement, kind: usize, index: i64, count: i64) -> LoadError {
    let (keyword, name) = REFERRED[kind];
    statement.error(
        format!("the {name} {index} in `f`"),
        match count {
            0 => format!("a {name} that a `{keyword}` defines is"),
            _ => format!("a {name} from 1 to {count}, or from -{count} to -1, is"),
        },
    )
}

fn writeln_to(text: &mut String, keyword: &str, rest: &str) {
    // Writing to a string does not fail.
    let _ = writeln!(text, "{keyword} {rest}");
}

/// The words of a statement: finite numbers, and as many of them as is allowed.
fn numbers<'a>(statement: &Statement<'a>, counts: &[usize], expected: &str) -> Result<Vec<&'a str>, LoadError> {
    let words: Vec<&str> = statement.words().take(8).collect();
    if !counts.contains(&words.len()) {
        return Err(statement.unexpected(expected));
    }
    for word in &words {
        statement.number(word)?;
    }
    Ok(words)
}

/// Hands the checked text to `tobj`.
fn assemble(path: &Path, obj: &str, mtl: &str) -> Result<(Vec<tobj::Model>, Vec<SourceMaterial>), LoadError> {
    let failed = |error: tobj::LoadError| LoadError::Element {
        path: path.to_owned(),
        element: "OBJ".to_owned(),
        found: error.to_string(),
        expected: "a well-formed file is".to_owned(),
    };
    let (models, materials) =
        tobj::load_obj_buf(&mut obj.as_bytes(), &tobj::GPU_LOAD_OPTIONS, |_| tobj::load_mtl_buf(&mut mtl.as_bytes()))
            .map_err(failed)?;
    let materials = materials.map_err(failed)?;
    Ok((models, materials.into_iter().map(mtl::material).collect()))
}

fn part(path: &Path, model: tobj::Model, warnings: &mut Vec<String>) -> Result<Part, LoadError> {
    // The name that `tobj` gives to what has none.
    let name = if model.name == "unnamed_object" { String::new() } else { model.name };
    let tobj::Mesh { positions, normals, texcoords, indices, material_id, .. } = model.mesh;
    let vec3s = |numbers: &[f32]| -> Vec<Vec3> {
        let (triples, _) = numbers.as_chunks::<3>();
        triples.iter().copied().map(Vec3::from_array).collect()
    };
    let positions = vec3s(&positions);
    let vertices = positions.len();
    // Each vertex brought at most one of either; where some brought none the rest have lost their places.
    let mut whole = |found: usize, what: &str, instead: &str| {
        if found != 0 && found != vertices {
            warnings.push(format!("`{name}`: {found} of {vertices} vertices have a {what}; {instead}"));
        }
        found == vertices
    };
    let has_normals = whole(normals.len() / 3, "normal", "all normals are computed");
    let has_uvs = whole(texcoords.len() / 2, "texture coordinate", "none is used");
    let normals = has_normals.then(|| vec3s(&normals));
    let uvs = has_uvs.then(|| {
        let (pairs, _) = texcoords.as_chunks::<2>();
        // From v upward to v downward.
        pairs.iter().map(|&[u, v]| Vec2::new(u, 1.0 - v)).collect()
    });
    let (mesh, report) = Mesh::from_parts_reported(positions, normals, uvs, indices)
        .map_err(|source| LoadError::Mesh { path: path.to_owned(), element: format!("`{name}`"), source })?;
    if report.replaced > 0 {
        warnings.push(format!("`{name}`: {} normals of zero length are replaced by computed ones", report.replaced));
    }
    Ok(Part { name, mesh, material: material_id, world_from_part: Mat4::IDENTITY })
}
