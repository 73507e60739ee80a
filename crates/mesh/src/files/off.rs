//! OFF, the format of Geomview: vertices and polygons in text.

use std::path::Path;

use glam::{DVec3, DVec4, Mat4, Vec2, Vec3, Vec4};

use super::source::{Source, stem};
use super::srgb::decoded;
use super::text::{Skipped, Statement, Statements, abridged};
use super::{LoadError, polygon};
use crate::numbering::Numbering;
use crate::{LinePart, Lines, Mesh, Model, Part, origin_of_box};

/// Reads `OFF` with the prefixes `ST`, `C`, `N` and `4`: polygons, normals, texture coordinates and colours of vertices,
/// or colours of faces; without faces the vertices are points. The binary variant and those of other dimensions are
/// refused.
pub(super) fn parse(source: Source) -> Result<Model, LoadError> {
    let path = source.path;
    let mut lines = Statements::new(source.reader, false);
    let mut off = Off::default();
    let mut words = off.header(&mut lines)?;
    let counts = numbers_of(&mut words, &mut lines, "the numbers of vertices and faces are")?;
    // A third number, of edges, may be there and says nothing.
    off.vertices(counts[0], &mut lines)?;
    off.faces(counts[1], &mut lines)?;
    if let Some(statement) = lines.next()? {
        off.skipped.add(statement.line, "text after the last face is skipped");
    }
    lines.warn_of_encoding(&mut off.skipped);
    off.into_model(path)
}

/// The contents of the file.
#[derive(Default)]
struct Off {
    has: Variant,
    positions: Vec<DVec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    colors: Vec<[f32; 4]>,
    /// The corners of all polygons, and where each ends.
    corners: Vec<u32>,
    ends: Vec<usize>,
    /// The colours of the polygons; `None` for one without.
    face_colors: Vec<Option<[f32; 4]>>,
    skipped: Skipped,
}

/// The numbers of a vertex beside its position.
#[derive(Clone, Copy, Default)]
#[expect(clippy::struct_excessive_bools, reason = "one for each mark before `OFF`")]
struct Variant {
    uvs: bool,
    colors: bool,
    normals: bool,
    weights: bool,
}

impl Off {
    /// Reads the first word, which some files do without, and returns the words after it on its line.
    fn header(&mut self, lines: &mut Statements) -> Result<Vec<String>, LoadError> {
        let path = lines.path();
        let Some(first) = lines.next()? else {
            return Err(LoadError::Line {
                path: path.to_owned(),
                line: 1,
                found: "no words".to_owned(),
                expected: "`OFF` is".to_owned(),
            });
        };
        let rest: Vec<String> = first.words().map(str::to_owned).collect();
        if first.keyword.parse::<u64>().is_ok() {
            return Ok([vec![first.keyword.to_owned()], rest].concat());
        }
        let Some(mut prefix) = first.keyword.strip_suffix("OFF") else {
            return Err(first.unexpected("`OFF`, perhaps with ST, C, N or 4 before it, is"));
        };
        let mut taken = |mark: &str| {
            let after = prefix.strip_prefix(mark);
            prefix = after.unwrap_or(prefix);
            after.is_some()
        };
        let (uvs, colors, normals, weights) = (taken("ST"), taken("C"), taken("N"), taken("4"));
        self.has = Variant { uvs, colors, normals, weights };
        if prefix == "n" {
            return Err(first.unexpected("vertices of three dimensions, and so `OFF` or `4OFF`, are"));
        }
        if !prefix.is_empty() {
            return Err(first.unexpected("`OFF`, perhaps with ST, C, N or 4 before it, is"));
        }
        if rest.first().is_some_and(|word| word == "BINARY") {
            return Err(first.error("binary OFF", "OFF in text is"));
        }
        Ok(rest)
    }

    fn vertices(&mut self, count: u64, lines: &mut Statements) -> Result<(), LoadError> {
        let Variant { uvs, colors, normals, weights } = self.has;
        let before = if weights { 4 } else { 3 } + if normals { 3 } else { 0 };
        let after = if uvs { 2 } else { 0 };
        for vertex in 0..count {
            let statement = next(lines, || format!("{vertex} of {count} vertices"), "a line for each vertex is")?;
            let values = values(&statement)?;
            let of_color = values.len().wrapping_sub(before + after);
            let fits = if colors { matches!(of_color, 3 | 4) } else { values.len() >= before + after };
            if !fits {
                let colors = if colors { ", and three or four of its colour," } else { "" };
                return Err(statement.unexpected(&format!("{} numbers of a vertex{colors} are", before + after)));
            }
            if !colors && of_color > 0 {
                self.skipped
                    .add(statement.line, format!("numbers after the {} of a vertex are skipped", before + after));
            }
            self.positions.push(position(&values, weights));
            if normals {
                self.normals.push(DVec3::from_slice(&values[before - 3..]).as_vec3());
            }
            if colors {
                let channel =
                    |i: usize| values.get(before + i).filter(|_| i < of_color).map_or(f32::NAN, |x| *x as f32);
                self.colors.push([0, 1, 2, 3].map(channel));
            }
            if uvs {
                let [u, v] = [values[before + of_color], values[before + of_color + 1]];
                // v runs upward in the file.
                self.uvs.push(Vec2::new(u as f32, (1.0 - v) as f32));
            }
        }
        Ok(())
    }

    fn faces(&mut self, count: u64, lines: &mut Statements) -> Result<(), LoadError> {
        const EXPECTED: &str = "a number of corners, and as many vertices, counted from 0, are";
        for face in 0..count {
            let statement = next(lines, || format!("{face} of {count} faces"), "a line for each face is")?;
            let mut words = statement.words();
            let corners: usize = statement.keyword.parse().map_err(|_| statement.unexpected(EXPECTED))?;
            let start = self.corners.len();
            for _ in 0..corners {
                let word = words.next().ok_or_else(|| statement.unexpected(EXPECTED))?;
                let vertex: u64 = word.parse().map_err(|_| statement.unexpected(EXPECTED))?;
                if vertex >= self.positions.len() as u64 {
                    let found = format!("the vertex {vertex} of a face");
                    return Err(statement
                        .error(found, format!("one of the {} vertices, counted from 0, is", self.positions.len())));
                }
                self.corners.push(vertex as u32);
            }
            let color = self.face_color(words, &statement)?;
            if corners < 3 {
                self.corners.truncate(start);
                self.skipped.add(statement.line, "a face of fewer than three corners is skipped");
                continue;
            }
            self.ends.push(self.corners.len());
            self.face_colors.push(color);
        }
        Ok(())
    }

    /// The colour after the corners of a face: three or four numbers; one is a place in a colour map.
    fn face_color<'a>(
        &mut self,
        words: impl Iterator<Item = &'a str>,
        statement: &Statement,
    ) -> Result<Option<[f32; 4]>, LoadError> {
        let mut numbers = [f32::NAN; 4];
        let mut count = 0;
        for word in words {
            let number = statement.number(word)?;
            if let Some(place) = numbers.get_mut(count) {
                *place = number;
            }
            count += 1;
        }
        match count {
            0 => {}
            3 | 4 => return Ok(Some(numbers)),
            1 => self.skipped.add(statement.line, "a colour by its number in a map is skipped"),
            _ => self.skipped.add(statement.line, "numbers after the corners of a face that are no colour are skipped"),
        }
        Ok(None)
    }

    fn into_model(mut self, path: &Path) -> Result<Model, LoadError> {
        let is_cloud = self.ends.is_empty();
        let mut is_used = vec![is_cloud; self.positions.len()];
        for &corner in &self.corners {
            is_used[corner as usize] = true;
        }
        let mut without_place = 0;
        for (vertex, (p, used)) in self.positions.iter_mut().zip(&is_used).enumerate() {
            if !p.as_vec3().is_finite() {
                if *used {
                    return Err(LoadError::Element {
                        path: path.to_owned(),
                        element: format!("vertex {vertex}"),
                        found: format!("{:?}", p.to_array()),
                        expected: "finite numbers are".to_owned(),
                    });
                }
                without_place += 1;
                *p = DVec3::ZERO;
            }
        }
        let used = || self.positions.iter().zip(&is_used).filter(|(_, used)| **used).map(|(p, _)| *p);
        let (min, max) = (used().reduce(DVec3::min), used().reduce(DVec3::max));
        let origin = min.zip(max).map_or(DVec3::ZERO, |(min, max)| origin_of_box(min, max));
        // A vertex that nothing uses may be too far from there.
        let placed = |p: &DVec3| Some((*p - origin).as_vec3()).filter(|p| p.is_finite()).unwrap_or_default();
        let positions: Vec<Vec3> = self.positions.iter().map(placed).collect();
        let mut warnings = std::mem::take(&mut self.skipped).warnings(path);
        if without_place > 0 {
            warnings.push(format!("{without_place} vertices of no face are not finite, and are put at 0"));
        }
        if is_cloud {
            let lines = self.cloud(positions, path, &mut warnings)?;
            return Ok(Model { origin, lines, warnings, ..Model::default() });
        }
        let mesh = self.mesh(positions, path, &mut warnings)?;
        let part = Part { name: stem(path), mesh, material: None, world_from_part: Mat4::IDENTITY };
        Ok(Model { origin, parts: vec![part], warnings, ..Model::default() })
    }

    fn cloud(&self, positions: Vec<Vec3>, path: &Path, warnings: &mut Vec<String>) -> Result<Vec<LinePart>, LoadError> {
        if positions.is_empty() {
            return Ok(Vec::new());
        }
        if self.has.uvs {
            warnings.push("texture coordinates of points are skipped".to_owned());
        }
        let refused = |source| LoadError::Mesh { path: path.to_owned(), element: "vertices".to_owned(), source };
        let mut lines = Lines::cloud(positions).map_err(refused)?;
        if self.has.normals {
            lines = lines.with_normals(self.normals.clone()).map_err(refused)?;
        }
        if self.has.colors {
            lines = lines.with_colors(linear(&self.colors)).map_err(refused)?;
        }
        Ok(vec![LinePart { name: stem(path), lines, material: None, world_from_part: Mat4::IDENTITY }])
    }

    fn mesh(self, positions: Vec<Vec3>, path: &Path, warnings: &mut Vec<String>) -> Result<Mesh, LoadError> {
        // The corners of all triangles, and the polygon of each.
        let (mut indices, mut face_of) = (Vec::new(), Vec::new());
        let (mut points, mut start, mut crossed) = (Vec::new(), 0, 0);
        for (face, &end) in self.ends.iter().enumerate() {
            let corners = &self.corners[start..end];
            start = end;
            points.clear();
            points.extend(corners.iter().map(|&corner| positions[corner as usize]));
            let clean = polygon::cut(&points, |triangle| {
                indices.extend(triangle.map(|corner| corners[corner as usize]));
                face_of.push(face as u32);
            });
            crossed += usize::from(!clean);
        }
        if crossed > 0 {
            warnings
                .push(format!("{crossed} polygons that cross themselves, or have too many corners, are cut somehow"));
        }
        let has_face_colors = self.face_colors.iter().any(Option::is_some);
        let mut colors = self.has.colors.then(|| linear(&self.colors));
        let mut firsts: Option<Vec<u32>> = None;
        if has_face_colors && colors.is_some() {
            warnings.push("the colours of faces are skipped, since vertices have colours, too".to_owned());
        } else if has_face_colors {
            // Vertices are split where faces of several colours meet.
            let of_faces: Vec<_> = self.face_colors.iter().map(|color| color.unwrap_or([f32::NAN; 4])).collect();
            let of_faces = linear(&of_faces);
            let color = |corner: usize| of_faces[face_of[corner / 3] as usize];
            let key = |corner: usize| {
                let [r, g, b, a] = color(corner).to_array().map(f32::to_bits);
                [indices[corner], r, g, b, a]
            };
            let split = Numbering::new(indices.len(), key);
            colors = Some(split.firsts.iter().map(|&first| color(first as usize)).collect());
            firsts = Some(split.firsts.iter().map(|&first| indices[first as usize]).collect());
            indices = split.numbers;
        }
        let refused = |source| LoadError::Mesh { path: path.to_owned(), element: "mesh".to_owned(), source };
        let normals = self.has.normals.then(|| picked(&self.normals, firsts.as_deref()));
        let uvs = self.has.uvs.then(|| picked(&self.uvs, firsts.as_deref()));
        let positions = picked(&positions, firsts.as_deref());
        let (mesh, report) = Mesh::from_parts_reported(positions, normals, uvs, indices).map_err(refused)?;
        if report.replaced > 0 {
            warnings.push(format!("{} normals of zero length are replaced by computed ones", report.replaced));
        }
        match colors {
            Some(colors) => mesh.with_colors(colors).map_err(refused),
            None => Ok(mesh),
        }
    }
}

/// Those of these vertices, or all.
fn picked<T: Copy>(values: &[T], vertices: Option<&[u32]>) -> Vec<T> {
    match vertices {
        Some(vertices) => vertices.iter().map(|&vertex| values[vertex as usize]).collect(),
        None => values.to_vec(),
    }
}

/// Colours from 0 to 1, or to 255 if one of the file's is above 1, as linear ones. NaN for alpha is opaque, and for all
/// channels white.
fn linear(colors: &[[f32; 4]]) -> Vec<Vec4> {
    let most = colors.iter().flatten().copied().fold(0.0, f32::max);
    let scale = if most > 1.0 { 1.0 / 255.0 } else { 1.0 };
    let channel = |x: f32| if x.is_nan() { 1.0 } else { (x * scale).clamp(0.0, 1.0) };
    let color = |color: &[f32; 4]| {
        let [r, g, b, a] = color.map(channel);
        Vec4::new(decoded(r), decoded(g), decoded(b), a)
    };
    colors.iter().map(color).collect()
}

/// A position, perhaps divided by its weight.
fn position(values: &[f64], weights: bool) -> DVec3 {
    if weights {
        let p = DVec4::from_slice(values);
        p.truncate() / p.w
    } else {
        DVec3::from_slice(values)
    }
}

/// The next line, which has to be there.
fn next<'a>(
    lines: &'a mut Statements,
    found: impl FnOnce() -> String,
    expected: &str,
) -> Result<Statement<'a>, LoadError> {
    let (path, line) = (lines.path(), lines.line());
    lines.next()?.ok_or_else(|| LoadError::Line {
        path: path.to_owned(),
        line,
        found: format!("the end of the file after {}", found()),
        expected: expected.to_owned(),
    })
}

/// Two numbers at the beginning of the words, or of the next line if there are none.
fn numbers_of(words: &mut Vec<String>, lines: &mut Statements, expected: &str) -> Result<[u64; 2], LoadError> {
    let (path, mut line) = (lines.path(), lines.line());
    if words.is_empty() {
        let statement = next(lines, || "its first line".to_owned(), expected)?;
        line = statement.line;
        words.push(statement.keyword.to_owned());
        words.extend(statement.words().map(str::to_owned));
    }
    let number = |i: usize| words.get(i)?.parse().ok();
    number(0).zip(number(1)).map(|(vertices, faces)| [vertices, faces]).ok_or_else(|| LoadError::Line {
        path: path.to_owned(),
        line,
        found: format!("`{}`", abridged(&words.join(" "), "")),
        expected: expected.to_owned(),
    })
}

/// The numbers of a vertex; those of a position may be anything but text.
fn values(statement: &Statement) -> Result<Vec<f64>, LoadError> {
    let words = std::iter::once(statement.keyword).chain(statement.words());
    let number = |word: &str| {
        let found = || format!("`{}` of a vertex", abridged(word, ""));
        word.parse().map_err(|_| statement.error(found(), "a number is"))
    };
    // No line of a vertex has more.
    words.take(16).map(number).collect()
}
