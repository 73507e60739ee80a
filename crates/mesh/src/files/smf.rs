//! SMF, the format of Michael Garland's simplification tools: vertices and triangles in text.

use std::path::Path;

use bevy_math::{Mat4, Vec3};

use super::LoadError;
use super::text::{Skipped, Statement, statements};
use crate::{Mesh, Model, Part};

/// Reads `v x y z` and `f a b c`, indices from 1, in any order; other statements are skipped with a warning.
pub(super) fn parse(path: &Path, text: &[u8]) -> Result<Model, LoadError> {
    let mut positions = Vec::new();
    let mut indices = Vec::new();
    let mut lines = Vec::new();
    let mut skipped = Skipped::default();
    for statement in statements(path, text) {
        let statement = statement?;
        match statement.keyword {
            "v" => positions.push(Vec3::from_array(vertex(&statement)?)),
            "f" => {
                indices.extend(face(&statement)?);
                lines.push(statement.line);
            }
            _ => skipped.add_statement(&statement),
        }
    }

    for (at, index) in indices.iter_mut().enumerate() {
        if *index == 0 || *index as usize > positions.len() {
            return Err(LoadError::Line {
                path: path.to_owned(),
                line: lines[at / 3],
                found: format!("the vertex number {index} in `f`"),
                expected: format!("a number from 1 to {} is", positions.len()),
            });
        }
        *index -= 1;
    }
    if indices.is_empty() {
        return Err(LoadError::NoTriangles { path: path.to_owned() });
    }
    let mesh = Mesh::new(positions, indices).map_err(|source| LoadError::Mesh {
        path: path.to_owned(),
        element: "mesh".to_owned(),
        source,
    })?;
    Ok(Model {
        parts: vec![Part {
            name: path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default(),
            mesh,
            material: None,
            world_from_part: Mat4::IDENTITY,
        }],
        warnings: skipped.warnings(path),
        ..Model::default()
    })
}

/// The words of a statement, of which there must be three.
fn three<'a>(statement: &Statement<'a>, expected: &str) -> Result<[&'a str; 3], LoadError> {
    let mut words = statement.words();
    match [words.next(), words.next(), words.next(), words.next()] {
        [Some(a), Some(b), Some(c), None] => Ok([a, b, c]),
        _ => Err(statement.unexpected(expected)),
    }
}

fn vertex(statement: &Statement) -> Result<[f32; 3], LoadError> {
    let words = three(statement, "`v` and three numbers are")?;
    Ok([statement.number(words[0])?, statement.number(words[1])?, statement.number(words[2])?])
}

/// The numbers of a face's vertices, from 1.
fn face(statement: &Statement) -> Result<[u32; 3], LoadError> {
    const EXPECTED: &str = "`f` and three vertex numbers, counted from 1, are";
    let words = three(statement, EXPECTED)?;
    let number = |word: &str| word.parse().map_err(|_| statement.unexpected(EXPECTED));
    Ok([number(words[0])?, number(words[1])?, number(words[2])?])
}
