//! STL, in ASCII and binary (Burns 1993, "Automated Fabrication", §6.5): triangles that share no vertices.

use std::path::Path;

use glam::{DVec3, Mat4, Vec3};

use super::LoadError;
use super::source::{Reader, Source, stem};
use super::srgb::decoded;
use super::text::{Skipped, Statement, Statements, abridged};
use crate::numbering::Numbering;
use crate::{Mesh, Model, Part, origin_of_box};

/// The bytes before the triangles of a binary file, of which the last four count them, and those of a triangle.
const HEADER: usize = 84;
const FACET: usize = 50;

/// Reads the triangles. Vertices at equal positions are merged, and normals are computed, since those of the file only
/// repeat the winding. ASCII files have a part for each `solid`; binary ones may have a colour for each triangle.
///
/// A file is binary if it has the bytes that its count of triangles asks for, even if it begins with `solid` as some
/// binary files do, and also if it does not begin with `solid`. The bytes of a text, taken for a count, ask for 7 GB and
/// more.
pub(super) fn parse(source: Source) -> Result<Model, LoadError> {
    let Source { path, mut reader, .. } = source;
    let mut header = [0; HEADER];
    let found = reader.peek(&mut header)?;
    let count = u32::from_le_bytes([header[80], header[81], header[82], header[83]]);
    let length = HEADER as u64 + FACET as u64 * u64::from(count);
    let (is_text, is_whole) = (is_text(&header[..found]), found == HEADER && length <= reader.length());
    let mut skipped = Skipped::default();
    let mut warnings = Vec::new();
    let counts_like_text = header[80..].iter().all(|&byte| is_of_text(byte));
    let solids = if is_text && (!is_whole || counts_like_text) {
        text(reader, &mut skipped, &stem(path))?
    } else if is_whole {
        vec![binary(reader, count, &mut warnings, stem(path))?]
    } else {
        return Err(LoadError::Element {
            path: path.to_owned(),
            element: "STL".to_owned(),
            found: format!("{} bytes", reader.length()),
            expected: match found {
                HEADER => format!("`solid`, or the {length} bytes that {count} triangles take, are"),
                _ => format!("`solid`, or at least {HEADER} bytes, are"),
            },
        });
    };
    warnings.extend(skipped.warnings(path));
    let against: usize = solids.iter().map(|solid| solid.against).sum();
    if against > 0 {
        warnings
            .push(format!("{against} triangles have a normal that points against their winding; the winding counts"));
    }
    let solids: Vec<_> = solids.into_iter().filter(|solid| solid.corners.count() > 0).collect();
    let boxes = solids.iter().map(|solid| solid.corners.extent());
    let all = boxes.reduce(|[min, max], [other_min, other_max]| [min.min(other_min), max.max(other_max)]);
    let origin = all.map_or(DVec3::ZERO, |[min, max]| origin_of_box(min, max));
    let parts = solids.into_iter().map(|solid| solid.into_part(origin, path)).collect::<Result<_, _>>()?;
    Ok(Model { origin, parts, warnings, ..Model::default() })
}

/// Whether a file that begins so may be a text: with `solid`, perhaps after white space and a byte order mark, and
/// without zeros.
fn is_text(begin: &[u8]) -> bool {
    let begin = begin.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(begin);
    let word = begin.trim_ascii_start().get(..5);
    word.is_some_and(|word| word.eq_ignore_ascii_case(b"solid")) && !begin.contains(&0)
}

fn is_of_text(byte: u8) -> bool {
    byte.is_ascii_graphic() || byte.is_ascii_whitespace()
}

/// The triangles of one `solid`.
struct StlSolid {
    name: String,
    corners: Corners,
    /// The colour of each triangle, linear; empty where the file has none.
    colors: Vec<[f32; 3]>,
    /// How many normals point against the winding.
    against: usize,
}

/// Three positions a triangle, as precise as their file has them.
enum Corners {
    Single(Vec<Vec3>),
    Double(Vec<DVec3>),
}

impl Corners {
    fn count(&self) -> usize {
        match self {
            Self::Single(corners) => corners.len(),
            Self::Double(corners) => corners.len(),
        }
    }

    fn get(&self, corner: usize) -> DVec3 {
        match self {
            Self::Single(corners) => corners[corner].as_dvec3(),
            Self::Double(corners) => corners[corner],
        }
    }

    /// The box around them.
    fn extent(&self) -> [DVec3; 2] {
        let all = (0..self.count()).map(|corner| self.get(corner));
        all.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[min, max], p| [min.min(p), max.max(p)])
    }
}

impl StlSolid {
    fn into_part(self, origin: DVec3, path: &Path) -> Result<Part, LoadError> {
        let Self { name, corners, colors, .. } = self;
        // −0 and 0 are the same position.
        let position = |corner: usize| (corners.get(corner) - origin).as_vec3() + Vec3::ZERO;
        let color = |corner: usize| colors.get(corner / 3).copied().unwrap_or_default();
        let key = |corner: usize| {
            let ([x, y, z], [r, g, b]) = (position(corner).to_array(), color(corner));
            [x, y, z, r, g, b].map(f32::to_bits)
        };
        let Numbering { numbers, firsts } = Numbering::new(corners.count(), key);
        let positions = firsts.iter().map(|&first| position(first as usize)).collect();
        let mesh = Mesh::new(positions, numbers).and_then(|mesh| {
            if colors.is_empty() {
                return Ok(mesh);
            }
            mesh.with_colors(firsts.iter().map(|&first| Vec3::from(color(first as usize)).extend(1.0)).collect())
        });
        match mesh {
            Ok(mesh) => Ok(Part { name, mesh, material: None, world_from_part: Mat4::IDENTITY }),
            Err(source) => Err(LoadError::Mesh { path: path.to_owned(), element: format!("`{name}`"), source }),
        }
    }
}

/// Whether a normal points against the winding. One without a direction, as programs write for degenerate triangles,
/// does not.
fn is_against(normal: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    (b - a).cross(c - a).dot(normal) < 0.0
}

/// The colours of a binary file: five bits a channel in the attributes of its triangles.
struct Attributes {
    /// The colour of the whole object, if the header has one (Magics): then bit 15 of an attribute asks for it, and red
    /// has the lowest bits. Else bit 15 says that there is a colour, and blue has the lowest bits (`VisCAM`).
    object: Option<[f32; 3]>,
    with_color: usize,
    /// Those of another meaning.
    others: usize,
}

impl Attributes {
    fn new(header: &[u8; HEADER]) -> Self {
        const MARK: &[u8] = b"COLOR=";
        let at = header[..80].windows(MARK.len() + 4).position(|bytes| bytes.starts_with(MARK));
        let object = at.map(|at| {
            let start = at + MARK.len();
            [0, 1, 2].map(|channel| decoded(f32::from(header[start + channel]) / 255.0))
        });
        Self { object, with_color: 0, others: 0 }
    }

    /// The colour of a triangle with this attribute; white for one without.
    fn color(&mut self, attribute: u16) -> [f32; 3] {
        let channels = [0, 5, 10].map(|shift| decoded(f32::from(attribute >> shift & 31) / 31.0));
        let [low, middle, high] = channels;
        match (self.object, attribute & 0x8000 != 0) {
            (Some(object), true) => object,
            (Some(_), false) => {
                self.with_color += 1;
                channels
            }
            (None, true) => {
                self.with_color += 1;
                [high, middle, low]
            }
            (None, false) => {
                self.others += usize::from(attribute != 0);
                [1.0; 3]
            }
        }
    }

    fn has_colors(&self) -> bool {
        self.object.is_some() || self.with_color > 0
    }
}

fn binary(mut reader: Reader, count: u32, warnings: &mut Vec<String>, name: String) -> Result<StlSolid, LoadError> {
    let mut header = [0; HEADER];
    reader.fill(&mut header)?;
    let mut attributes = Attributes::new(&header);
    let (mut corners, mut colors, mut against) = (Vec::new(), Vec::new(), 0);
    let path = reader.path();
    let mut facet = [0; FACET];
    for triangle in 0..count {
        let error = |found: String, expected: &str| LoadError::Element {
            path: path.to_owned(),
            element: format!("triangle {triangle}"),
            found,
            expected: expected.to_owned(),
        };
        if reader.fill(&mut facet)? < FACET {
            return Err(error("the end of the file".to_owned(), "50 bytes are"));
        }
        let (words, _) = facet.as_chunks::<4>();
        let at = |i: usize| {
            let number = |i: usize| f32::from_le_bytes(words[i]);
            Vec3::new(number(i), number(i + 1), number(i + 2))
        };
        let three = [at(3), at(6), at(9)];
        if let Some(p) = three.into_iter().find(|p| !p.is_finite()) {
            return Err(error(format!("the corner {:?}", p.to_array()), "finite numbers are"));
        }
        let color = attributes.color(u16::from_le_bytes([facet[48], facet[49]]));
        if attributes.has_colors() {
            // The triangles before the first with a colour are white.
            colors.resize(triangle as usize, [1.0; 3]);
            colors.push(color);
        }
        against += usize::from(is_against(at(0).as_dvec3(), three.map(Vec3::as_dvec3)));
        corners.extend(three);
    }
    if attributes.others > 0 {
        warnings.push(format!("the attributes of {} triangles, which are no colours, are skipped", attributes.others));
    }
    if header.windows(9).any(|bytes| bytes == b"MATERIAL=") {
        warnings.push("the material in the header is skipped".to_owned());
    }
    Ok(StlSolid { name, corners: Corners::Single(corners), colors, against })
}

/// Reads `solid`, facets and `endsolid`, perhaps several times, with white space anywhere between words.
fn text(reader: Reader, skipped: &mut Skipped, name: &str) -> Result<Vec<StlSolid>, LoadError> {
    let mut lines = Statements::new(reader, false);
    let mut text = StlText { solids: Vec::new(), facet: None, numbers: None };
    while let Some(statement) = lines.next()? {
        text.add(&statement, name, skipped)?;
    }
    lines.warn_of_encoding(skipped);
    if text.facet.is_some() {
        return Err(LoadError::Line {
            path: lines.path().to_owned(),
            line: lines.line(),
            found: "the end of the file inside a facet".to_owned(),
            expected: "`endfacet` is".to_owned(),
        });
    }
    Ok(text.solids)
}

/// The text that was read so far.
struct StlText {
    solids: Vec<StlSolid>,
    /// The facet being read.
    facet: Option<Facet>,
    /// The three numbers being read, and the word before them.
    numbers: Option<(Before, Vec<f64>)>,
}

#[derive(Default)]
struct Facet {
    normal: DVec3,
    corners: Vec<DVec3>,
}

#[derive(Clone, Copy)]
enum Before {
    Normal,
    Vertex,
}

impl StlText {
    /// Takes the words of a line.
    fn add(&mut self, statement: &Statement, name: &str, skipped: &mut Skipped) -> Result<(), LoadError> {
        let all = std::iter::once(statement.keyword).chain(statement.words());
        let mut words = all.peekable();
        while let Some(word) = words.next() {
            if self.numbers.is_some() {
                self.number(word, statement)?;
                continue;
            }
            let unexpected = |expected: &str| statement.error(format!("`{word}`"), expected);
            match word.to_ascii_lowercase().as_str() {
                "solid" => {
                    let mut own = Vec::new();
                    while let Some(word) = words.next_if(|word| !is_one_of(word, &["facet", "endsolid"])) {
                        own.push(word);
                    }
                    let own = if own.is_empty() { name.to_owned() } else { own.join(" ") };
                    let corners = Corners::Double(Vec::new());
                    self.solids.push(StlSolid { name: own, corners, colors: Vec::new(), against: 0 });
                }
                "facet" if self.facet.is_some() => return Err(unexpected("`endfacet` before it is")),
                "facet" => self.facet = Some(Facet::default()),
                "normal" if self.facet.is_some() => self.numbers = Some((Before::Normal, Vec::new())),
                "vertex" => match &self.facet {
                    Some(facet) if facet.corners.len() < 3 => self.numbers = Some((Before::Vertex, Vec::new())),
                    _ => return Err(unexpected("three vertices in a facet are")),
                },
                "endfacet" => {
                    let (Some(facet), Some(solid)) = (self.facet.take(), self.solids.last_mut()) else {
                        return Err(unexpected("`facet` before it is"));
                    };
                    let &[a, b, c] = &facet.corners[..] else {
                        return Err(unexpected("three vertices before it are"));
                    };
                    solid.against += usize::from(is_against(facet.normal, [a, b, c]));
                    if let Corners::Double(corners) = &mut solid.corners {
                        corners.extend([a, b, c]);
                    }
                }
                "outer" | "loop" | "endloop" => {}
                // Its name follows.
                "endsolid" => while words.next_if(|word| !is_one_of(word, &["solid"])).is_some() {},
                _ => {
                    skipped.add(statement.line, format!("`{}` is skipped", abridged(word, "")));
                    words.by_ref().for_each(drop);
                }
            }
        }
        Ok(())
    }

    /// Takes one of three numbers.
    fn number(&mut self, word: &str, statement: &Statement) -> Result<(), LoadError> {
        let Some((before, numbers)) = &mut self.numbers else { return Ok(()) };
        let number: Option<f64> = word.parse().ok();
        let (keyword, number) = match before {
            Before::Normal => ("normal", number),
            // Beyond f32 it cannot be drawn.
            Before::Vertex => ("vertex", number.filter(|x| (*x as f32).is_finite())),
        };
        let Some(number) = number else {
            let expected = if keyword == "normal" { "three numbers are" } else { "three finite numbers are" };
            return Err(statement.error(format!("`{}` after `{keyword}`", abridged(word, "")), expected));
        };
        numbers.push(number);
        if let (&[x, y, z], Some(facet)) = (&numbers[..], &mut self.facet) {
            let p = DVec3::new(x, y, z);
            match before {
                Before::Normal => facet.normal = if p.is_finite() { p } else { DVec3::ZERO },
                Before::Vertex => facet.corners.push(p),
            }
            self.numbers = None;
        }
        Ok(())
    }
}

fn is_one_of(word: &str, keywords: &[&str]) -> bool {
    keywords.iter().any(|keyword| word.eq_ignore_ascii_case(keyword))
}
