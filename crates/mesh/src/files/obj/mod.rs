//! Wavefront OBJ.

mod assemble;
mod mtl;

use std::collections::{HashMap, HashSet};
use std::path::Path;

use glam::Vec3;

use self::assemble::{Draft, ObjVertices};
use super::source::{ModelFolder, Source};
use super::srgb::decoded;
use super::text::{Skipped, Statement, Statements, abridged};
use super::{LoadError, polygon};
use crate::{Model, SourceMaterial};

/// Reads vertices, polygons, lines, points, groups, smoothing groups and materials; other statements are skipped with a warning. A
/// missing MTL file is a warning, a malformed one an error.
pub(super) fn parse(source: Source) -> Result<Model, LoadError> {
    let path = source.path;
    let mut lines = Statements::new(source.reader, true);
    let mut obj = Obj::default();
    while let Some(statement) = lines.next()? {
        obj.add(&statement)?;
    }
    obj.check_forward_references(path)?;
    obj.cut_late_polygons();

    lines.warn_of_encoding(&mut obj.skipped);
    let mut warnings = Vec::new();
    let materials = obj.read_libraries(source.around, &mut warnings)?;
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
    Ok(Model { parts, lines, materials, warnings, ..Model::default() })
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

/// The contents read so far.
#[derive(Default)]
struct Obj {
    vertices: ObjVertices,
    drafts: Vec<Draft>,
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
    fn add(&mut self, statement: &Statement) -> Result<(), LoadError> {
        match statement.keyword {
            "v" => self.position(statement)?,
            "vt" => self.texture_coordinate(statement)?,
            "vn" => {
                let ([x, y, z], _) = statement.numbers(&[3], "`vn` and three numbers are")?;
                self.vertices.normals.push(Vec3::new(x, y, z));
            }
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
        let (numbers, count) = statement.numbers::<7>(&[3, 4, 6, 7], "`v` and three numbers are")?;
        let [x, y, z, r, g, b, _] = numbers;
        if count >= 6 {
            let linear = Vec3::new(r, g, b).to_array().map(decoded);
            if !linear.iter().all(|x| x.is_finite()) {
                return Err(statement.unexpected("a colour of three numbers from 0 to 1 is"));
            }
            self.vertices.colors.resize(self.vertices.positions.len(), Vec3::ONE);
            self.vertices.colors.push(Vec3::from_array(linear));
        }
        if count == 7 {
            self.skipped.add(statement.line, "the seventh number of `v` is skipped");
        }
        self.vertices.positions.push(Vec3::new(x, y, z));
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
        let draft = self.draft();
        let group = self.smoothing.unwrap_or(0);
        if let &[a, b, c] = &self.corners[..] {
            self.drafts[draft].triangle([a, b, c], group);
        } else if self.corners.iter().all(|[v, ..]| *v as usize <= self.vertices.positions.len()) {
            let corners = std::mem::take(&mut self.corners);
            self.cut(draft, group, &corners, statement.line);
            self.corners = corners;
        } else {
            self.late.push(LatePolygon { draft, group, corners: self.corners.clone() });
        }
        Ok(())
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
            vertices.push(self.absolute(statement, 0, index)?);
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
        self.points.clear();
        self.points.extend(corners.iter().map(|[v, ..]| self.vertices.positions[*v as usize - 1]));
        let draft = &mut self.drafts[draft];
        let clean = polygon::cut(&self.points, |triangle| draft.triangle(triangle.map(|i| corners[i as usize]), group));
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
            *place = self.absolute(statement, kind, word.parse().map_err(|_| malformed())?)?;
        }
        Ok(found)
    }

    /// A negative index counts back from the last one defined; 0 is none.
    fn absolute(&mut self, statement: &Statement, kind: usize, index: i64) -> Result<u32, LoadError> {
        let count = self.vertices.counts()[kind] as i64;
        let keyword = match statement.keyword {
            "l" => "l",
            "p" => "p",
            _ => "f",
        };
        let absolute = match index {
            1.. => index,
            _ if index < 0 && index >= -count => count + 1 + index,
            _ => return Err(out_of_range(statement.path, (statement.line, keyword), kind, index, count)),
        };
        if absolute > count && self.forward[kind].is_none_or(|furthest| absolute > furthest.index) {
            self.forward[kind] = Some(ForwardReference { line: statement.line, keyword, index });
        }
        // An index beyond 32 bits is beyond every count, which the check of forward references reports.
        Ok(u32::try_from(absolute).unwrap_or(u32::MAX))
    }

    /// Checks the largest reference of each kind, which bounds the others.
    fn check_forward_references(&self, path: &Path) -> Result<(), LoadError> {
        for (kind, count) in self.vertices.counts().into_iter().enumerate() {
            if let Some(ForwardReference { line, keyword, index }) =
                self.forward[kind].filter(|found| found.index > count as i64)
            {
                return Err(out_of_range(path, (line, keyword), kind, index, count as i64));
            }
        }
        Ok(())
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

fn out_of_range(path: &Path, (line, statement): (usize, &str), kind: usize, index: i64, count: i64) -> LoadError {
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
