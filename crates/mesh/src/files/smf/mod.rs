//! SMF, the format of Michael Garland's simplification tools (its version 1.2): vertices and triangles in
//! text, with scopes, transforms and attributes.

mod assemble;
mod scope;

use glam::{DVec3, Vec3};

use self::assemble::{Binding, SmfContent};
use self::scope::Scopes;
use super::LoadError;
use super::polygon;
use super::source::{Source, stem};
use super::srgb::decoded;
use super::text::{Skipped, Statement, Statements};
use crate::Model;

const FACE: &str = "`f` and three vertex numbers, counted from 1, are";

/// Reads `v x y z` and `f a b c`, numbers from 1, in any order; `begin` and `end`, the transforms and `set
/// vertex_correction`; `bind` with `n`, `c` and `r`; `g` and `o`, which real files have from OBJ. Other statements are
/// skipped with a warning.
pub(super) fn parse(source: Source) -> Result<Model, LoadError> {
    let path = source.path;
    let mut lines = Statements::new(source.reader, false);
    let mut smf = Smf::new(stem(path));
    while let Some(statement) = lines.next()? {
        smf.add(&statement)?;
    }
    smf.check_furthest(path)?;
    lines.warn_of_encoding(&mut smf.skipped);
    smf.scopes.warn_of_open(lines.line(), &mut smf.skipped);
    let (parts, origin, more) = smf.shape.into_parts(path)?;
    let mut warnings = smf.skipped.warnings(path);
    warnings.extend(more);
    Ok(Model { origin, parts, warnings, ..Model::default() })
}

/// The largest vertex number of all faces, and its line.
#[derive(Clone, Copy)]
struct Furthest {
    /// As an index from 0.
    vertex: u32,
    number: i64,
    line: usize,
}

struct Smf {
    shape: SmfContent,
    scopes: Scopes,
    furthest: Option<Furthest>,
    /// The corners of the face being read, and their positions.
    corners: Vec<u32>,
    points: Vec<Vec3>,
    skipped: Skipped,
}

impl Smf {
    fn new(name: String) -> Self {
        Self {
            shape: SmfContent::new(name),
            scopes: Scopes::new(),
            furthest: None,
            corners: Vec::new(),
            points: Vec::new(),
            skipped: Skipped::default(),
        }
    }

    fn add(&mut self, statement: &Statement) -> Result<(), LoadError> {
        match statement.keyword {
            "v" => self.vertex(statement),
            // `t` is the older word.
            "f" | "t" => self.face(statement),
            "n" => self.normal(statement),
            "c" => self.color(statement),
            "r" => self.texture_coordinate(statement),
            "bind" => self.bind(statement),
            "g" | "o" => {
                self.shape.begin_group(statement.rest);
                Ok(())
            }
            _ => {
                if !self.scopes.add(statement, self.shape.positions.len())? {
                    self.skipped.add_statement(statement);
                }
                Ok(())
            }
        }
    }

    fn vertex(&mut self, statement: &Statement) -> Result<(), LoadError> {
        let (_, count) = statement.numbers::<4>(&[3, 4], "`v` and three numbers are")?;
        let mut numbers = [0.0_f64; 4];
        for (number, word) in numbers.iter_mut().zip(statement.words()) {
            *number = word.parse().map_err(|_| statement.unexpected_word(word, "a finite number is"))?;
        }
        let [x, y, z, w] = numbers;
        let mut p = DVec3::new(x, y, z);
        if count == 4 {
            p /= w;
            if !p.as_vec3().is_finite() {
                return Err(statement.unexpected("a fourth number of `v` by which the others can be divided is"));
            }
        }
        self.shape.positions.push(self.scopes.place(p, statement)?);
        Ok(())
    }

    fn face(&mut self, statement: &Statement) -> Result<(), LoadError> {
        self.corners.clear();
        for word in statement.words() {
            let number: i64 = word.parse().map_err(|_| statement.unexpected(FACE))?;
            let vertex = self.scopes.vertex(number).ok_or_else(|| {
                if number < 0 {
                    statement.unexpected(FACE)
                } else {
                    statement.error(format!("the vertex number {number} in `f`"), "a number from 1 is")
                }
            })?;
            if self.furthest.is_none_or(|furthest| vertex > furthest.vertex) {
                self.furthest = Some(Furthest { vertex, number, line: statement.line });
            }
            self.corners.push(vertex);
        }
        if self.corners.len() < 3 {
            return Err(statement.unexpected(FACE));
        }
        self.shape.faces += 1;
        if let &[a, b, c] = &self.corners[..] {
            self.shape.triangle([a, b, c]);
            return Ok(());
        }
        self.skipped.add(statement.line, "a face of more than three corners, which SMF does not have, is cut");
        self.cut(statement)
    }

    /// Cuts a face of more than three corners, whose vertices must be defined before it.
    fn cut(&mut self, statement: &Statement) -> Result<(), LoadError> {
        let Self { shape, corners, points, skipped, .. } = self;
        points.clear();
        // Counted from the first, so that they keep their shape far from 0.
        let mut first: Option<DVec3> = None;
        for &corner in &*corners {
            let Some(p) = shape.positions.get(corner as usize) else {
                return Err(statement.unexpected("vertices that stand above a face of more than three corners are"));
            };
            points.push((*p - *first.get_or_insert(*p)).as_vec3());
        }
        let clean = polygon::cut(points, |triangle| shape.triangle(triangle.map(|i| corners[i as usize])));
        if !clean {
            skipped.add(statement.line, "a polygon that crosses itself, or has too many corners, is cut somehow");
        }
        Ok(())
    }

    fn normal(&mut self, statement: &Statement) -> Result<(), LoadError> {
        let ([x, y, z], _) = statement.numbers(&[3], "`n` and three numbers are")?;
        match self.shape.normals.binding {
            Binding::None => self.skipped.add(statement.line, "`n` without a `bind` before it is skipped"),
            _ => self.shape.normals.values.push(self.scopes.turn(Vec3::new(x, y, z))),
        }
        Ok(())
    }

    fn color(&mut self, statement: &Statement) -> Result<(), LoadError> {
        let (rgb, _) = statement.numbers::<3>(&[3], "`c` and three numbers are")?;
        let linear = rgb.map(decoded);
        if !linear.iter().all(|x| x.is_finite()) {
            return Err(statement.unexpected("`c` and three numbers from 0 to 1 are"));
        }
        match self.shape.colors.binding {
            Binding::None => self.skipped.add(statement.line, "`c` without a `bind` before it is skipped"),
            _ => self.shape.colors.values.push(Vec3::from_array(linear)),
        }
        Ok(())
    }

    fn texture_coordinate(&mut self, statement: &Statement) -> Result<(), LoadError> {
        let words: [&str; 2] = statement.exactly("`r` and two numbers are")?;
        let uv = statement.uv(words[0], words[1])?;
        match self.shape.uvs.binding {
            Binding::Vertex => self.shape.uvs.values.push(uv),
            Binding::Face => self.skipped.add(statement.line, "`r` bound to faces is skipped"),
            Binding::None => self.skipped.add(statement.line, "`r` without a `bind` before it is skipped"),
        }
        Ok(())
    }

    fn bind(&mut self, statement: &Statement) -> Result<(), LoadError> {
        const EXPECTED: &str = "`bind`, one of c, n and r, and one of vertex and face are";
        let [what, to] = statement.exactly(EXPECTED)?;
        let binding = match to {
            "vertex" => Binding::Vertex,
            "face" => Binding::Face,
            _ => return Err(statement.unexpected(EXPECTED)),
        };
        let shape = &mut self.shape;
        let bound = match what {
            "n" => shape.normals.bind(binding),
            "c" => shape.colors.bind(binding),
            "r" => shape.uvs.bind(binding),
            _ => return Err(statement.unexpected(EXPECTED)),
        };
        if bound {
            return Ok(());
        }
        Err(statement.unexpected("the same binding as above for values of which there are some is"))
    }

    /// Checks the largest number, which bounds the others.
    fn check_furthest(&self, path: &std::path::Path) -> Result<(), LoadError> {
        let vertices = self.shape.positions.len();
        match self.furthest {
            Some(Furthest { vertex, number, line }) if vertex as usize >= vertices => Err(LoadError::Line {
                path: path.to_owned(),
                line,
                found: format!("the vertex number {number} in `f`"),
                expected: match vertices {
                    0 => "a vertex that a `v` defines is".to_owned(),
                    // Scopes may count from elsewhere; the message counts in the file all the same.
                    _ => format!("one of the {vertices} vertices, counted from 1, is"),
                },
            }),
            _ => Ok(()),
        }
    }
}
