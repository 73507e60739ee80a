//! STL, in ASCII and binary (Burns 1993, "Automated Fabrication", §6.5): triangles that share no vertices.

use glam::{Mat4, Vec3};

use super::LoadError;
use super::source::{Reader, Source, stem};
use super::text::{Skipped, Statement, Statements};
use crate::numbering::DistinctKeys;
use crate::{Mesh, Model, Part, face_normal};

/// The bytes before the triangles of a binary file, of which the last four count them, and those of a triangle.
const HEADER: usize = 84;
const FACET: usize = 50;

/// Reads the triangles. Vertices at equal positions are merged, and normals are computed, since those of the file only
/// repeat the winding. ASCII files have a part for each `solid`.
///
/// A file is binary if its length fits its count of triangles, even if it begins with `solid` as some binary files do,
/// and also if it does not begin with `solid`.
pub(super) fn parse(source: Source) -> Result<Model, LoadError> {
    let Source { path, mut reader, .. } = source;
    let mut header = [0; HEADER];
    let found = reader.peek(&mut header)?;
    let count = u32::from_le_bytes([header[80], header[81], header[82], header[83]]);
    let length = HEADER as u64 + FACET as u64 * u64::from(count);
    let is_text = header[..found].trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let mut skipped = Skipped::default();
    let mut warnings = Vec::new();
    let mut solids = if found == HEADER && length == reader.length() || !is_text {
        if found < HEADER || length > reader.length() {
            return Err(LoadError::Element {
                path: path.to_owned(),
                element: "STL".to_owned(),
                found: format!("{} bytes", reader.length()),
                expected: match found {
                    HEADER => format!("`solid`, or the {length} bytes that {count} triangles take, are"),
                    _ => format!("`solid`, or at least {HEADER} bytes, are"),
                },
            });
        }
        vec![binary(reader, count, &mut warnings, stem(path))?]
    } else {
        text(reader, &mut skipped, &stem(path))?
    };
    solids.retain(|solid| !solid.indices.is_empty());
    let mut against = 0;
    let mut parts = Vec::with_capacity(solids.len());
    for solid in solids {
        against += solid.against;
        parts.push(solid.into_part(path)?);
    }
    warnings.extend(skipped.warnings(path));
    if against > 0 {
        warnings
            .push(format!("{against} triangles have a normal that points against their winding; the winding counts"));
    }
    Ok(Model { parts, warnings, ..Model::default() })
}

/// The triangles of one `solid`.
struct StlSolid {
    name: String,
    /// The bits of the distinct positions.
    positions: DistinctKeys,
    indices: Vec<u32>,
    /// How many normals point against the winding.
    against: usize,
}

impl StlSolid {
    fn new(name: String) -> Self {
        Self { name, positions: DistinctKeys::default(), indices: Vec::new(), against: 0 }
    }

    fn triangle(&mut self, normal: Vec3, corners: [Vec3; 3]) {
        // −0 and 0 are the same position.
        self.indices.extend(corners.map(|p| self.positions.number((p + Vec3::ZERO).to_array().map(f32::to_bits))));
        let is_against = |n: Vec3| n.as_dvec3().dot(normal.as_dvec3()) < 0.0;
        self.against += usize::from(face_normal(corners[0], corners[1], corners[2]).is_some_and(is_against));
    }

    fn into_part(self, path: &std::path::Path) -> Result<Part, LoadError> {
        let Self { name, positions, indices, .. } = self;
        let keys = positions.into_keys();
        let positions = keys.into_iter().map(|bits| Vec3::from_array(bits.map(f32::from_bits))).collect();
        match Mesh::new(positions, indices) {
            Ok(mesh) => Ok(Part { name, mesh, material: None, world_from_part: Mat4::IDENTITY }),
            Err(source) => Err(LoadError::Mesh { path: path.to_owned(), element: format!("`{name}`"), source }),
        }
    }
}

fn binary(mut reader: Reader, count: u32, warnings: &mut Vec<String>, name: String) -> Result<StlSolid, LoadError> {
    let mut header = [0; HEADER];
    reader.fill(&mut header)?;
    let mut solid = StlSolid::new(name);
    let path = reader.path();
    let mut facet = [0; FACET];
    let mut with_attribute = 0_usize;
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
        let corners = [at(3), at(6), at(9)];
        if let Some(p) = corners.into_iter().find(|p| !p.is_finite()) {
            return Err(error(format!("the corner {:?}", p.to_array()), "finite numbers are"));
        }
        with_attribute += usize::from(facet[48..] != [0, 0]);
        solid.triangle(at(0), corners);
    }
    if with_attribute > 0 {
        warnings.push(format!("the attributes (colours, by some programs) of {with_attribute} triangles are skipped"));
    }
    Ok(solid)
}

/// Reads `solid`, facets and `endsolid`, perhaps several times.
fn text(reader: Reader, skipped: &mut Skipped, name: &str) -> Result<Vec<StlSolid>, LoadError> {
    let mut lines = Statements::new(reader, false);
    let mut solids: Vec<StlSolid> = Vec::new();
    let mut normal = Vec3::ZERO;
    let mut corners = Vec::new();
    let mut inside = false;
    while let Some(statement) = lines.next()? {
        match statement.keyword.to_ascii_lowercase().as_str() {
            "solid" => {
                let own = if statement.rest.is_empty() { name } else { statement.rest };
                solids.push(StlSolid::new(own.to_owned()));
            }
            "facet" => {
                normal = facet_normal(&statement)?;
                corners.clear();
                inside = true;
            }
            "vertex" if inside && corners.len() < 3 => {
                let ([x, y, z], _) = statement.numbers(&[3], "`vertex` and three numbers are")?;
                corners.push(Vec3::new(x, y, z));
            }
            "vertex" => return Err(statement.unexpected("three vertices in a facet are")),
            "endfacet" => {
                inside = false;
                let (&[a, b, c], Some(solid)) = (&corners[..], solids.last_mut()) else {
                    return Err(statement.unexpected("three vertices before it are"));
                };
                solid.triangle(normal, [a, b, c]);
                corners.clear();
            }
            "outer" | "endloop" | "endsolid" => {}
            _ => skipped.add_statement(&statement),
        }
    }
    lines.warn_of_encoding(skipped);
    if inside {
        return Err(LoadError::Line {
            path: lines.path().to_owned(),
            line: lines.line(),
            found: "the end of the file inside a facet".to_owned(),
            expected: "`endfacet` is".to_owned(),
        });
    }
    Ok(solids)
}

/// Reads `facet normal x y z`. Programs write arbitrary normals for degenerate triangles.
fn facet_normal(statement: &Statement) -> Result<Vec3, LoadError> {
    const EXPECTED: &str = "`facet normal` and three numbers are";
    let [word, numbers @ ..]: [&str; 4] = statement.exactly(EXPECTED)?;
    if !word.eq_ignore_ascii_case("normal") {
        return Err(statement.unexpected(EXPECTED));
    }
    let mut n = [0.0_f32; 3];
    for (x, word) in n.iter_mut().zip(numbers) {
        *x = word.parse().map_err(|_| statement.unexpected_word(word, "a number is"))?;
    }
    let n = Vec3::from_array(n);
    Ok(if n.is_finite() { n } else { Vec3::ZERO })
}
