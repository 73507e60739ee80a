//! Scopes: the numbering and the transform of vertices between `begin` and `end`.

use glam::{DMat3, DMat4, DVec3, DVec4, Vec3};

use crate::files::LoadError;
use crate::files::text::{Skipped, Statement};

/// The open scopes, innermost last.
pub(super) struct Scopes {
    outer: Vec<Scope>,
    inner: Scope,
}

#[derive(Clone, Copy)]
struct Scope {
    /// The number of vertices at its beginning: its own are counted from there.
    first_vertex: i64,
    /// `set vertex_correction`: added to every vertex number.
    correction: i64,
    /// The transform of its vertices; `None` for the identity.
    transform: Option<Transform>,
}

#[derive(Clone, Copy)]
struct Transform {
    world_from_scope: DMat4,
    /// The inverse transpose of its linear part, up to a positive factor.
    world_normal_from_scope: DMat3,
}

impl Scopes {
    pub(super) fn new() -> Self {
        Self { outer: Vec::new(), inner: Scope { first_vertex: 0, correction: 0, transform: None } }
    }

    /// Takes a statement of scopes; returns whether it is one.
    pub(super) fn add(&mut self, statement: &Statement, vertices: usize) -> Result<bool, LoadError> {
        match statement.keyword {
            "begin" => {
                self.outer.push(self.inner);
                self.inner.first_vertex = vertices as i64;
            }
            "end" => {
                self.inner = self.outer.pop().ok_or_else(|| statement.unexpected("a `begin` before it is"))?;
            }
            "set" => return self.set(statement),
            "trans" => self.multiply(DMat4::from_translation(three(statement)?), statement)?,
            "scale" => self.multiply(DMat4::from_scale(three(statement)?), statement)?,
            "rot" => self.multiply(rotation(statement)?, statement)?,
            "mmult" => self.multiply(matrix(statement)?, statement)?,
            "mload" => self.load(matrix(statement)?, statement)?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// `set vertex_correction n`; other settings are not read.
    fn set(&mut self, statement: &Statement) -> Result<bool, LoadError> {
        const EXPECTED: &str = "`set vertex_correction` and a whole number is";
        if statement.words().next() != Some("vertex_correction") {
            return Ok(false);
        }
        let [_, number] = statement.exactly(EXPECTED)?;
        // No file has vertices beyond 32 bits.
        self.inner.correction = number.parse::<i32>().map_err(|_| statement.unexpected(EXPECTED))?.into();
        Ok(true)
    }

    /// The later transform is applied to vertices first, as in OpenGL.
    fn multiply(&mut self, m: DMat4, statement: &Statement) -> Result<(), LoadError> {
        let before = self.inner.transform.map_or(DMat4::IDENTITY, |transform| transform.world_from_scope);
        self.load(before * m, statement)
    }

    fn load(&mut self, world_from_scope: DMat4, statement: &Statement) -> Result<(), LoadError> {
        if !world_from_scope.is_finite() {
            return Err(statement.unexpected("a transform that stays in the range of f64 is"));
        }
        // Cofactors, which exist for matrices without an inverse too.
        let m = DMat3::from_mat4(world_from_scope);
        let cofactors = DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
        let world_normal_from_scope = if m.determinant() < 0.0 { -cofactors } else { cofactors };
        self.inner.transform =
            (world_from_scope != DMat4::IDENTITY).then_some(Transform { world_from_scope, world_normal_from_scope });
        Ok(())
    }

    /// The index from 0 of a vertex number; `None` if it is out of range.
    pub(super) fn vertex(&self, number: i64) -> Option<u32> {
        if number < 0 {
            return None;
        }
        let vertex = number.checked_add(self.inner.correction)?.checked_add(self.inner.first_vertex)?.checked_sub(1)?;
        if vertex < self.inner.first_vertex && self.inner.correction == 0 {
            return None;
        }
        // A number beyond 32 bits is beyond all vertices.
        (vertex >= 0).then(|| u32::try_from(vertex).unwrap_or(u32::MAX))
    }

    /// A vertex in world space.
    pub(super) fn place(&self, p: DVec3, statement: &Statement) -> Result<DVec3, LoadError> {
        let Some(transform) = &self.inner.transform else {
            return Ok(p);
        };
        let placed: DVec4 = transform.world_from_scope * p.extend(1.0);
        let placed = placed.truncate() / placed.w;
        if placed.as_vec3().is_finite() {
            return Ok(placed);
        }
        Err(statement.unexpected("a vertex that its transform leaves in the range of f32 is"))
    }

    /// A normal in world space; zero where the transform leaves it no direction.
    pub(super) fn turn(&self, n: Vec3) -> Vec3 {
        match &self.inner.transform {
            None => n,
            Some(transform) => {
                (transform.world_normal_from_scope * n.as_dvec3()).try_normalize().unwrap_or_default().as_vec3()
            }
        }
    }

    pub(super) fn warn_of_open(&self, line: usize, skipped: &mut Skipped) {
        if !self.outer.is_empty() {
            skipped.add(line, format!("{} `begin` without an `end`", self.outer.len()));
        }
    }
}

fn three(statement: &Statement) -> Result<DVec3, LoadError> {
    let ([x, y, z], _) = statement.numbers(&[3], "three numbers are")?;
    Ok(Vec3::new(x, y, z).as_dvec3())
}

/// About an axis by N degrees, counter-clockwise as seen against it.
fn rotation(statement: &Statement) -> Result<DMat4, LoadError> {
    const EXPECTED: &str = "`rot`, one of x, y and z, and an angle in degrees are";
    let [axis, angle] = statement.exactly(EXPECTED)?;
    let angle = f64::from(statement.number(angle)?).to_radians();
    match axis {
        "x" => Ok(DMat4::from_rotation_x(angle)),
        "y" => Ok(DMat4::from_rotation_y(angle)),
        "z" => Ok(DMat4::from_rotation_z(angle)),
        _ => Err(statement.unexpected(EXPECTED)),
    }
}

/// Row by row; vectors are columns.
fn matrix(statement: &Statement) -> Result<DMat4, LoadError> {
    let (rows, _) = statement.numbers::<16>(&[16], "sixteen numbers are")?;
    Ok(DMat4::from_cols_array(&rows.map(f64::from)).transpose())
}
