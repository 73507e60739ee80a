//! Wavefront OBJ.

mod assemble;
mod chunk;
mod corners;
mod mtl;

use std::collections::{HashMap, HashSet};
use std::path::Path;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use self::assemble::{Draft, ObjVertices};
use self::chunk::{ObjChunk, RunKind, StatementRun};
use self::corners::CornerNumbers;
use super::source::{ModelFolder, Reader, Source};
use super::srgb::decoded;
use super::text::{Skipped, Statement, Statements, abridged};
use super::{LoadError, polygon};
use crate::{Model, SourceMaterial, origin_of_box};

/// So many bytes are a piece of work for a thread.
const CHUNK: usize = 1 << 20;

/// Reads vertices, polygons, lines, points, groups, smoothing groups and materials; other statements are skipped with a warning. A
/// missing MTL file is a warning, a malformed one an error.
pub(super) fn parse(source: Source) -> Result<Model, LoadError> {
    let Source { path, mut reader, around } = source;
    let mut obj = Obj::default();
    while obj.take_chunks(&mut reader)? {}
    obj.check_forward_references(path)?;
    obj.cut_late_polygons();
    let origin = obj.place_vertices(path)?;
    obj.vertices.decode_colors(&mut obj.skipped);

    let mut warnings = Vec::new();
    let materials = obj.read_libraries(around, &mut warnings)?;
    let named = NamedMaterials::new(&materials);
    obj.warn_of_unknown_materials(&named);
    let Obj { vertices, drafts, smoothing, skipped, .. } = obj;
    warnings.splice(0..0, skipped.warnings(path));
    let material_of = |draft: &Draft| draft.material.as_deref().and_then(|name| named.find(name));
    let with_lines = drafts.iter().filter(|draft| draft.has_lines());
    let lines = with_lines.map(|draft| draft.line_part(path, &vertices, material_of(draft)));
    let lines = lines.collect::<Result<_, _>>()?;
    let drafts: Vec<Draft> = drafts.into_iter().filter(Draft::has_triangles).collect();
    let used: Vec<_> = drafts.iter().map(material_of).collect();
    let mut parts = assemble::parts(drafts, path, &vertices, smoothing.is_some(), &mut warnings)?;
    for (part, material) in parts.iter_mut().zip(used) {
        part.material = material;
    }
    Ok(Model { origin, parts, lines, materials, warnings, ..Model::default() })
}

/// The indices of a face's corner: keyword and meaning.
const REFERRED: [(&str, &str); 3] = [("v", "position"), ("vt", "texture coordinate"), ("vn", "normal")];

const CORNERS: &str = "corners of the form v, v/vt, v//vn or v/vt/vn are";

/// A positive index beyond the vertices defined above its line; the format asks for definition first, but some files
/// do without.
#[derive(Clone, Copy, Debug)]
struct ForwardReference {
    line: usize,
    /// The keyword of its statement.
    keyword: &'static str,
    index: i64,
}

/// A polygon whose vertices are defined later in the file, so that it cannot be cut yet.
struct LatePolygon {
    draft: usize,
    group: u32,
    corners: Vec<[u32; 3]>,
}

/// The statement that refers to something.
#[derive(Clone, Copy, Debug)]
struct Referrer<'a> {
    path: &'a Path,
    line: usize,
    keyword: &'static str,
}

/// The contents read so far.
#[derive(Default)]
struct Obj {
    vertices: ObjVertices,
    /// How many lines.
    lines: usize,
    drafts: Vec<Draft>,
    numbers: CornerNumbers,
    /// The positions that are not finite, and their lines. They are errors only if something uses them.
    not_finite: Vec<(usize, usize)>,
    /// The drafts by their names and materials.
    draft_of: HashMap<(String, Option<String>), usize>,
    /// The draft that faces go to; `None` until the next face after the name or the material has changed.
    current: Option<usize>,
    name: String,
    material: Option<String>,
    /// The smoothing group of the faces to come, 0 for none; `None` if the file has no smoothing groups so far.
    smoothing: Option<u32>,
    forward: [Option<ForwardReference>; 3],
    late: Vec<LatePolygon>,
    libraries: Vec<String>,
    used_materials: Vec<(usize, String)>,
    /// The corners of the face being read, and their positions.
    corners: Vec<[u32; 3]>,
    points: Vec<Vec3>,
    skipped: Skipped,
}

impl Obj {
    /// Reads on; returns whether there was anything.
    fn take_chunks(&mut self, reader: &mut Reader) -> Result<bool, LoadError> {
        let mut chunks: Vec<Vec<u8>> = Vec::new();
        while chunks.len() < rayon::current_num_threads() {
            let mut bytes = Vec::new();
            if !reader.lines(CHUNK, &mut bytes)? {
                break;
            }
            chunks.push(bytes);
        }
        if self.lines == 0 && chunks.first().is_some_and(|first| first.starts_with(b"\xEF\xBB\xBF")) {
            chunks[0].drain(..3);
        }
        let read: Vec<ObjChunk> = match &chunks[..] {
            [one] => vec![ObjChunk::new(one)],
            several => several.par_iter().map(|bytes| ObjChunk::new(bytes)).collect(),
        };
        for (bytes, chunk) in chunks.iter().zip(read) {
            self.take(reader.path(), bytes, chunk)?;
        }
        Ok(!chunks.is_empty())
    }

    /// Adds the statements of a chunk.
    fn take(&mut self, path: &Path, bytes: &[u8], chunk: ObjChunk) -> Result<(), LoadError> {
        let (mut positions, mut uvs) = (&chunk.positions[..], &chunk.uvs[..]);
        let (mut normals, mut corners) = (&chunk.normals[..], &chunk.corners[..]);
        for StatementRun { kind, line, count } in chunk.runs {
            let line = self.lines + line;
            match kind {
                RunKind::Positions => self.vertices.read.extend_from_slice(first(&mut positions, count)),
                RunKind::Uvs => self.vertices.uvs.extend_from_slice(first(&mut uvs, count)),
                RunKind::Normals => self.vertices.normals.extend_from_slice(first(&mut normals, count)),
                RunKind::Faces(each) => {
                    for (face, line) in first(&mut corners, each * count).chunks_exact(each).zip(line + 1..) {
                        self.face_of(Referrer { path, line, keyword: "f" }, face)?;
                    }
                }
                RunKind::Others(range) => {
                    let mut others = Statements::new(Reader::of_chunk(path, &bytes[range]), true).after(line);
                    while let Some(statement) = others.next()? {
                        self.add(&statement)?;
                    }
                    others.warn_of_encoding(&mut self.skipped);
                }
            }
        }
        self.lines += chunk.lines;
        Ok(())
    }

    fn add(&mut self, statement: &Statement) -> Result<(), LoadError> {
        match statement.keyword {
            "v" => self.position(statement)?,
            "vt" => self.texture_coordinate(statement)?,
            "vn" => self.normal(statement)?,
            "f" | "fo" => self.face(statement)?,
            "l" => self.line(statement)?,
            "p" => self.points(statement)?,
            "o" | "g" => {
                statement.rest.clone_into(&mut self.name);
                self.current = None;
            }
            "usemtl" if statement.rest.is_empty() => {
                self.skipped.add(statement.line, "`usemtl` without a name: the faces after it have no material");
                self.material = None;
                self.current = None;
            }
            "usemtl" => {
                self.used_materials.push((statement.line, statement.rest.to_owned()));
                self.material = Some(statement.rest.to_owned());
                self.current = None;
            }
            "mtllib" if statement.rest.is_empty() => {
                return Err(statement.unexpected("`mtllib` and a file name is"));
            }
            "mtllib" => self.libraries.push(statement.rest.to_owned()),
            "s" => self.smoothing_group(statement),
            _ => self.skipped.add_statement(statement),
        }
        Ok(())
    }

    /// `v x y z`, perhaps with a weight, which is for free-form curves, or with a colour.
    fn position(&mut self, statement: &Statement) -> Result<(), LoadError> {
        let (numbers, count) = statement.any_numbers::<7>(&[3, 4, 6, 7], "`v` and three numbers are")?;
        let [x, y, z, r, g, b, _] = numbers;
        let position = DVec3::new(x, y, z);
        if !position.as_vec3().is_finite() {
            self.not_finite.push((self.vertices.read.len(), statement.line));
        }
        if count >= 6 {
            let color = Vec3::new(r as f32, g as f32, b as f32);
            if !color.to_array().map(decoded).iter().all(|x| x.is_finite()) {
                return Err(statement.unexpected("a colour of three numbers from 0 to 1 is"));
            }
            self.vertices.add_color(color, statement.line);
        }
        if count == 7 {
            self.skipped.add(statement.line, "the seventh number of `v` is skipped");
        }
        self.vertices.read.push(position);
        Ok(())
    }

    fn normal(&mut self, statement: &Statement) -> Result<(), LoadError> {
        let ([x, y, z], _) = statement.any_numbers(&[3], "`vn` and three numbers are")?;
        let normal = DVec3::new(x, y, z).as_vec3();
        if !normal.is_finite() {
            self.skipped.add(statement.line, "a normal that is not finite is taken for (0, 0, 0)");
        }
        // One of length 0 is made anew.
        self.vertices.normals.push(if normal.is_finite() { normal } else { Vec3::ZERO });
        Ok(())
    }

    fn texture_coordinate(&mut self, statement: &Statement) -> Result<(), LoadError> {
        const EXPECTED: &str = "`vt` and two numbers are";
        let mut words = statement.words();
        let Some(u) = words.next() else {
            return Err(statement.unexpected(EXPECTED));
        };
        let v = words.next().unwrap_or("0");
        if let Some(w) = words.next() {
            statement.number(w)?;
        }
        if words.next().is_some() {
            return Err(statement.unexpected(EXPECTED));
        }
        self.vertices.uvs.push(statement.uv(u, v)?);
        Ok(())
    }

    /// `s off`, `s 0` or `s n`; some programs write `s on` or `s 1` for smooth surfaces.
    fn smoothing_group(&mut self, statement: &Statement) {
        let word = statement.words().next().unwrap_or_default();
        match (word, word.parse()) {
            ("off" | "none", _) => self.smoothing = Some(0),
            ("on", _) => self.smoothing = Some(1),
            (_, Ok(group)) => self.smoothing = Some(group),
            _ => self.skipped.add(statement.line, "`s` without the number of a group is skipped"),
        }
    }

    fn face(&mut self, statement: &Statement) -> Result<(), LoadError> {
        self.corners.clear();
        let mut words = statement.words();
        let first_three = [words.next(), words.next(), words.next()];
        let [Some(a), Some(b), Some(c)] = first_three else {
            self.skipped.add(statement.line, "a face of fewer than three corners is skipped");
            return Ok(());
        };
        for word in [a, b, c].into_iter().chain(words) {
            let corner = self.corner(statement, word)?;
            self.corners.push(corner);
        }
        self.polygon(statement.line);
        Ok(())
    }

    /// A face whose corners have been read ahead.
    fn face_of(&mut self, referrer: Referrer, corners: &[[i32; 3]]) -> Result<(), LoadError> {
        self.corners.clear();
        let counts = self.vertices.counts();
        for corner in corners {
            let mut found = [0; 3];
            for kind in 0..3 {
                let index = corner[kind];
                found[kind] = match index {
                    0 => 0,
                    1.. if index as usize <= counts[kind] => index as u32,
                    _ => self.absolute(referrer, kind, index.into())?,
                };
            }
            self.corners.push(found);
        }
        self.polygon(referrer.line);
        Ok(())
    }

    /// Adds the face of the corners that have been read.
    fn polygon(&mut self, line: usize) {
        let draft = self.draft();
        let group = self.smoothing.unwrap_or(0);
        if let &[a, b, c] = &self.corners[..] {
            let numbers = [a, b, c].map(|corner| self.number(draft, corner));
            self.drafts[draft].triangle(numbers, group);
        } else if self.corners.iter().all(|[v, ..]| *v as usize <= self.vertices.read.len()) {
            let corners = std::mem::take(&mut self.corners);
            self.cut(draft, group, &corners, line);
            self.corners = corners;
        } else {
            self.late.push(LatePolygon { draft, group, corners: self.corners.clone() });
        }
    }

    /// The number of a corner in a draft.
    fn number(&mut self, draft: usize, corner: [u32; 3]) -> u32 {
        self.numbers.number(&mut self.drafts, draft, corner, self.vertices.read.len())
    }

    /// `l`: a line through all its vertices.
    fn line(&mut self, statement: &Statement) -> Result<(), LoadError> {
        let vertices = self.named_vertices(statement)?;
        if vertices.len() < 2 {
            self.skipped.add(statement.line, "a line of fewer than two vertices is skipped");
            return Ok(());
        }
        let draft = self.draft();
        self.drafts[draft].segments.extend(vertices.array_windows());
        Ok(())
    }

    /// `p`: each of its vertices is a point.
    fn points(&mut self, statement: &Statement) -> Result<(), LoadError> {
        let vertices = self.named_vertices(statement)?;
        if !vertices.is_empty() {
            let draft = self.draft();
            self.drafts[draft].points.extend(vertices);
        }
        Ok(())
    }

    /// The positions, numbered from 1, that a line or points name, as `v` or `v/vt`.
    fn named_vertices(&mut self, statement: &Statement) -> Result<Vec<u32>, LoadError> {
        let mut vertices = Vec::new();
        let mut has_uvs = false;
        for word in statement.words() {
            let (vertex, uv) = word.split_once('/').map_or((word, ""), |(vertex, uv)| (vertex, uv));
            let index =
                vertex.parse().map_err(|_| statement.unexpected_word(word, "vertices of the form v or v/vt are"))?;
            vertices.push(self.absolute(referrer_of(statement), 0, index)?);
            has_uvs |= !uv.is_empty();
        }
        if has_uvs {
            self.skipped.add(statement.line, "texture coordinates of lines are skipped");
        }
        Ok(vertices)
    }

    /// The index of the draft for the current name and material.
    fn draft(&mut self) -> usize {
        if let Some(current) = self.current {
            return current;
        }
        let Self { drafts, draft_of, name, material, .. } = self;
        let place = *draft_of.entry((name.clone(), material.clone())).or_insert_with(|| {
            drafts.push(Draft::new(name.clone(), material.clone()));
            drafts.len() - 1
        });
        self.current = Some(place);
        place
    }

    fn cut(&mut self, draft: usize, group: u32, corners: &[[u32; 3]], line: usize) {
        let numbers: Vec<u32> = corners.iter().map(|corner| self.number(draft, *corner)).collect();
        let positions = &self.vertices.read;
        polygon::near(corners.iter().map(|[v, ..]| positions[*v as usize - 1]), &mut self.points);
        let draft = &mut self.drafts[draft];
        let clean = polygon::cut(&self.points, |triangle| draft.triangle(triangle.map(|i| numbers[i as usize]), group));
        if !clean {
            self.skipped.add(line, "a polygon that crosses itself, or has too many corners, is cut somehow");
        }
    }

    /// Cuts the polygons whose vertices came after them; all indices have been checked.
    fn cut_late_polygons(&mut self) {
        for late in std::mem::take(&mut self.late) {
            // Their lines are not kept.
            self.cut(late.draft, late.group, &late.corners, 0);
        }
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`, also with nothing after a slash, as indices from 1, 0 for none.
    fn corner(&mut self, statement: &Statement, corner: &str) -> Result<[u32; 3], LoadError> {
        let malformed = || statement.unexpected_word(corner, CORNERS);
        let mut found = [0; 3];
        for (kind, word) in corner.split('/').enumerate() {
            let place = found.get_mut(kind).ok_or_else(malformed)?;
            // Some programs write `v//` for a corner with neither.
            if kind > 0 && word.is_empty() {
                continue;
            }
            *place = self.absolute(referrer_of(statement), kind, word.parse().map_err(|_| malformed())?)?;
        }
        Ok(found)
    }

    /// A negative index counts back from the last one defined; 0 is none.
    fn absolute(&mut self, referrer: Referrer, kind: usize, index: i64) -> Result<u32, LoadError> {
        let count = self.vertices.counts()[kind] as i64;
        let Referrer { line, keyword, .. } = referrer;
        let absolute = match index {
            1.. => index,
            _ if index < 0 && index >= -count => count + 1 + index,
            _ if kind == 0 => return Err(out_of_range(referrer, kind, index, count)),
            _ => {
                let name = REFERRED[kind].1;
                self.skipped
                    .add(line, format!("a {name} that there is not, as {index}, in `{keyword}` counts as none"));
                return Ok(0);
            }
        };
        if absolute > count && self.forward[kind].is_none_or(|furthest| absolute > furthest.index) {
            self.forward[kind] = Some(ForwardReference { line, keyword, index });
        }
        // An index beyond 32 bits is beyond every count, which the check of forward references reports.
        Ok(u32::try_from(absolute).unwrap_or(u32::MAX))
    }

    /// Checks the largest reference of each kind, which bounds the others. Texture coordinates and normals that there are
    /// not count as none.
    fn check_forward_references(&mut self, path: &Path) -> Result<(), LoadError> {
        for (kind, count) in self.vertices.counts().into_iter().enumerate() {
            let beyond = self.forward[kind].filter(|found| found.index > count as i64);
            let Some(ForwardReference { line, keyword, index }) = beyond else { continue };
            if kind == 0 {
                return Err(out_of_range(Referrer { path, line, keyword }, kind, index, count as i64));
            }
            let name = REFERRED[kind].1;
            self.skipped.add(
                line,
                format!("the {name} {index} in `{keyword}`, and every other beyond the {count} that there are, counts as none"),
            );
        }
        Ok(())
    }

    /// Places the vertices by their origin, which it returns. A position that is not finite must not be used.
    fn place_vertices(&mut self, path: &Path) -> Result<DVec3, LoadError> {
        let read = &mut self.vertices.read;
        let used = || self.drafts.iter().flat_map(Draft::used_positions).map(|v| v as usize - 1);
        if !self.not_finite.is_empty() {
            let is_finite = |v: usize| read[v].as_vec3().is_finite();
            let used: HashSet<usize> = used().filter(|v| !is_finite(*v)).collect();
            for &(v, line) in &self.not_finite {
                if used.contains(&v) {
                    let wrong = read[v].to_array().into_iter().find(|x| !(*x as f32).is_finite()).unwrap_or_default();
                    return Err(LoadError::Line {
                        path: path.to_owned(),
                        line,
                        found: format!("`{wrong}` in `v`"),
                        expected: "a finite number is".to_owned(),
                    });
                }
                self.skipped.add(line, "a position that is not finite is skipped; nothing uses it");
                read[v] = DVec3::ZERO;
            }
        }
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for v in used() {
            (min, max) = (min.min(read[v]), max.max(read[v]));
        }
        let origin = origin_of_box(min, max);
        self.vertices.positions = read.par_iter().with_min_len(1 << 14).map(|p| (*p - origin).as_vec3()).collect();
        *read = Vec::new();
        Ok(origin)
    }

    /// The materials of all MTL files, each read once. An unreadable file is a warning.
    fn read_libraries(
        &self,
        around: ModelFolder,
        warnings: &mut Vec<String>,
    ) -> Result<Vec<SourceMaterial>, LoadError> {
        let mut materials = Vec::new();
        let mut seen = HashSet::new();
        for rest in &self.libraries {
            // A name may have spaces, and a statement may have several names. Some programs write backslashes.
            let rest = &rest.replace('\\', "/");
            let names: Vec<&str> = match around.find(rest) {
                Some(whole) if whole.exists() => vec![rest],
                _ => rest.split_ascii_whitespace().take_while(|word| !word.starts_with('#')).collect(),
            };
            for name in names {
                if seen.insert(name.to_owned()) {
                    mtl::read_library(name, around, &mut materials, warnings)?;
                }
            }
        }
        Ok(materials)
    }

    fn warn_of_unknown_materials(&mut self, named: &NamedMaterials) {
        for (line, name) in &self.used_materials {
            if named.find(name).is_none() {
                self.skipped.add(*line, format!("the material `{}` is nowhere defined", abridged(name, "")));
            }
        }
    }
}

/// Materials by their names. A name may hold spaces and `#` ("Material #25"), and a comment may follow it: the whole
/// text is looked up first, then the text before ` #`.
struct NamedMaterials<'a>(HashMap<&'a str, usize>);

impl<'a> NamedMaterials<'a> {
    fn new(materials: &'a [SourceMaterial]) -> Self {
        let mut named: HashMap<&str, usize> = HashMap::new();
        let names = || materials.iter().map(SourceMaterial::name).enumerate();
        named.extend(names().map(|(index, name)| (name, index)));
        for (index, name) in names() {
            named.entry(before_comment(name)).or_insert(index);
        }
        Self(named)
    }

    fn find(&self, name: &str) -> Option<usize> {
        self.0.get(name).or_else(|| self.0.get(before_comment(name))).copied()
    }
}

fn before_comment(name: &str) -> &str {
    name.split_once(" #").map_or(name, |(name, _)| name.trim_ascii_end())
}

fn referrer_of<'a>(statement: &Statement<'a>) -> Referrer<'a> {
    let keyword = match statement.keyword {
        "l" => "l",
        "p" => "p",
        _ => "f",
    };
    Referrer { path: statement.path, line: statement.line, keyword }
}

/// Takes the first so many.
fn first<'a, T>(rest: &mut &'a [T], count: usize) -> &'a [T] {
    let (own, others) = rest.split_at(count);
    *rest = others;
    own
}

fn out_of_range(referrer: Referrer, kind: usize, index: i64, count: i64) -> LoadError {
    let Referrer { path, line, keyword: statement } = referrer;
    let (keyword, name) = REFERRED[kind];
    LoadError::Line {
        path: path.to_owned(),
        line,
        found: format!("the {name} {index} in `{statement}`"),
        expected: match count {
            0 => format!("a {name} that a `{keyword}` defines is"),
            _ => format!("a {name} from 1 to {count}, or from -{count} to -1, is"),
        },
    }
}
