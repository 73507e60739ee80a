//! PLY, in ASCII and binary (Turk 1994, "The PLY polygon file format").

mod faces;
mod header;
mod values;

use std::path::Path;

use glam::{DVec3, Mat4, Vec2, Vec3, Vec4};
use rayon::prelude::*;

use self::faces::{Faces, Split, SplitVertices};
use self::header::{Element, Property as PropertyType};
use self::values::{ElementProperty, Values};
use super::LoadError;
use super::source::{Source, stem};
use super::srgb::decoded;
use super::text::abridged;
use crate::{LinePart, Lines, Mesh, Model, Part, Property, ScalarValues, origin_of_box};

/// Reads `vertex` (positions, normals, colours, texture coordinates), `face`, `tristrips` and `edge`, in any order; other
/// numbers of vertices and faces become properties, and all else is skipped with a warning. Where nothing joins the
/// vertices they are points.
pub(super) fn parse(source: Source) -> Result<Model, LoadError> {
    let Source { path, mut reader, .. } = source;
    let header = header::parse(&mut reader)?;
    let mut values = Values::new(reader, &header);
    let mut shape = PlyContent::default();
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => shape.vertices(element, &mut values)?,
            "face" => {
                let vertices = shape.known_vertices();
                shape.faces.read(element, &mut values, vertices, &mut shape.warnings)?;
            }
            "tristrips" => shape.strips(element, &mut values)?,
            "edge" => shape.edges(element, &mut values)?,
            _ => {
                let name = abridged(&element.name, "");
                shape.warnings.push(format!("the {} elements `{name}` are skipped", element.count));
                skip_all(element, &mut values)?;
            }
        }
    }
    shape.check_corners(&values)?;
    shape.check_numbers(&mut values)?;
    let origin = shape.place_vertices();
    let lines = shape.lines(path)?;
    Ok(Model { origin, lines, ..shape.into_model(path)? })
}

/// The vertex properties that are read, in the order of a vertex's slots.
const SLOTS: [&[&str]; 12] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["s", "u", "texture_u", "texture_s"],
    &["t", "v", "texture_v", "texture_t"],
    &["red", "r", "diffuse_red"],
    &["green", "g", "diffuse_green"],
    &["blue", "b", "diffuse_blue"],
    &["alpha", "a", "diffuse_alpha"],
];

/// The slots of normals.
const NORMAL: std::ops::Range<usize> = 3..6;

/// The names of the face property that lists the corners.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// The edge properties for its two ends.
const ENDS: [&str; 2] = ["vertex1", "vertex2"];

#[derive(Default)]
struct PlyContent {
    /// The positions as the file says them, until they are placed.
    read: Vec<DVec3>,
    has_vertices: bool,
    /// The positions, counted from the model's origin.
    positions: Vec<Vec3>,
    normals: Option<Vec<Vec3>>,
    uvs: Option<Vec<Vec2>>,
    colors: Option<Vec<Vec4>>,
    not_finite: Vec<NotFinite>,
    faces: Faces,
    /// The triangles of strips.
    strips: Vec<u32>,
    segments: Vec<[u32; 2]>,
    properties: Vec<Property>,
    warnings: Vec<String>,
}

/// A number that is an error if its vertex is used.
struct NotFinite {
    vertex: u32,
    /// In [`SLOTS`].
    slot: usize,
    found: f64,
    line: usize,
}

/// The numbers of one property of each vertex or face; `None` for those that mean something else.
type Numbers = Vec<Option<Vec<f32>>>;

impl PlyContent {
    fn vertices(&mut self, element: &Element, values: &mut Values) -> Result<(), LoadError> {
        let slot_of = |property: &PropertyType| {
            let named = |names: &&[&str]| names.contains(&property.name.as_str());
            SLOTS.iter().position(named).filter(|_| property.list.is_none())
        };
        let slots: Vec<Option<usize>> = element.properties.iter().map(slot_of).collect();
        let has = |wanted: std::ops::Range<usize>| wanted.into_iter().all(|slot| slots.contains(&Some(slot)));
        let mut numbers = numbers(element, |i| slots[i].is_none());
        warn_of_skipped(element, |i| slots[i].is_some() || numbers[i].is_some(), &mut self.warnings);
        if !has(0..3) {
            let place = ElementProperty { element: "vertex", number: 0, property: "x, y and z" };
            return Err(values.error(place, "no such properties", "three numbers are"));
        }
        self.has_vertices = true;
        self.normals = has(3..6).then(Vec::new);
        self.uvs = has(6..8).then(Vec::new);
        self.colors = has(8..11).then(Vec::new);
        let normals = self.not_finite.len();
        let mut row = vec![0.0; element.properties.len()];
        let record = Record::new(element);
        let mut number = 0;
        while number < element.count {
            // All that is there at once, where all records have one size.
            if let Some(record) = &record {
                let is_big = values.is_big_endian();
                let ahead = values.ahead(record.size)?;
                let count = ((ahead.len() / record.size) as u64).min(element.count - number);
                for bytes in ahead.chunks_exact(record.size).take(count as usize) {
                    record.decode(bytes, is_big, &mut row);
                    self.vertex(element, &slots, &row, &mut numbers, 0);
                }
                values.consume(count as usize * record.size);
                number += count;
                if number == element.count {
                    break;
                }
            }
            for (property, found) in element.properties.iter().zip(&mut row) {
                let place = ElementProperty { element: &element.name, number, property: &property.name };
                match property.list {
                    None => *found = values.next(property.scalar, place)?,
                    Some(_) => skip(property, place, values)?,
                }
            }
            self.vertex(element, &slots, &row, &mut numbers, values.line());
            number += 1;
        }
        let made_anew = self.not_finite.len() - normals;
        self.not_finite.retain(|found| !NORMAL.contains(&found.slot));
        let made_anew = made_anew - (self.not_finite.len() - normals);
        if made_anew > 0 {
            self.warnings.push(format!("{made_anew} numbers of normals are not finite; the normals are made anew"));
        }
        self.keep(element, numbers, ScalarValues::Vertices);
        Ok(())
    }

    fn keep(&mut self, element: &Element, numbers: Numbers, values: fn(Vec<f32>) -> ScalarValues) {
        for (property, numbers) in element.properties.iter().zip(numbers) {
            let property = |numbers| Property { name: property.name.clone(), part: 0, values: values(numbers) };
            self.properties.extend(numbers.map(property));
        }
    }

    /// Adds a vertex of the numbers of its properties.
    fn vertex(&mut self, element: &Element, slots: &[Option<usize>], row: &[f64], numbers: &mut Numbers, line: usize) {
        let mut vertex = [0.0; 12];
        vertex[11] = 1.0;
        for (i, &found) in row.iter().enumerate() {
            match (slots[i], &mut numbers[i]) {
                (Some(slot), _) => {
                    vertex[slot] = if slot < 8 { found } else { found / element.properties[i].scalar.one() };
                    if !(vertex[slot] as f32).is_finite() {
                        self.not_finite.push(NotFinite { vertex: self.read.len() as u32, slot, found, line });
                        vertex[slot] = if NORMAL.contains(&slot) { f64::NAN } else { 0.0 };
                    }
                }
                (None, Some(numbers)) => numbers.push(found as f32),
                (None, None) => {}
            }
        }
        let [x, y, z, nx, ny, nz, u, v, r, g, b, alpha] = vertex;
        self.read.push(DVec3::new(x, y, z));
        if let Some(normals) = &mut self.normals {
            let normal = DVec3::new(nx, ny, nz).as_vec3();
            // One of length 0 is made anew.
            normals.push(if normal.is_finite() { normal } else { Vec3::ZERO });
        }
        if let Some(uvs) = &mut self.uvs {
            // Programs write v upward, as in OBJ.
            uvs.push(Vec2::new(u as f32, (1.0 - v) as f32));
        }
        if let Some(colors) = &mut self.colors {
            colors.push(Vec3::from_array([r, g, b].map(|x| decoded(x as f32))).extend(alpha as f32));
        }
    }

    /// How many vertices there are, if they have been read.
    fn known_vertices(&self) -> Option<usize> {
        self.has_vertices.then_some(self.read.len())
    }

    /// Strips, each ended by −1.
    fn strips(&mut self, element: &Element, values: &mut Values) -> Result<(), LoadError> {
        let mut lists = Faces::default();
        lists.read(element, values, self.known_vertices(), &mut self.warnings)?;
        let mut rest = &lists.corners[..];
        for size in lists.sizes {
            let (list, others) = rest.split_at(size as usize);
            rest = others;
            for strip in list.split(|&corner| corner == RESTART) {
                for (i, &three) in strip.array_windows::<3>().enumerate() {
                    let [a, b, c] = three;
                    self.strips.extend(if i % 2 == 0 { [a, b, c] } else { [a, c, b] });
                }
            }
        }
        Ok(())
    }

    /// Checks the corners that were read before the vertices.
    fn check_corners(&self, values: &Values) -> Result<(), LoadError> {
        let count = self.read.len();
        if let Some((face, corner)) = self.faces.outside(count) {
            let place = ElementProperty { element: "face", number: face, property: CORNERS[0] };
            return Err(outside(values, place, corner, count));
        }
        let ends = self.segments.as_flattened();
        for (element, corners) in [("tristrips", &self.strips[..]), ("edge", ends)] {
            if let Some(&corner) = corners.iter().find(|corner| **corner as usize >= count) {
                let place = ElementProperty { element, number: 0, property: "vertices" };
                return Err(outside(values, place, corner, count));
            }
        }
        Ok(())
    }

    fn used_vertices(&self) -> impl Iterator<Item = u32> {
        self.faces.corners.iter().chain(&self.strips).chain(self.segments.as_flattened()).copied()
    }

    fn is_cloud(&self) -> bool {
        self.segments.is_empty() && self.faces.corners.is_empty() && self.strips.is_empty()
    }

    /// Vertices with numbers that are not finite must not be used. Of a cloud they are left out.
    fn check_numbers(&mut self, values: &mut Values) -> Result<(), LoadError> {
        let Some(first) = self.not_finite.first() else { return Ok(()) };
        let slot = SLOTS[first.slot][0];
        let mut is_wrong = vec![false; self.read.len()];
        self.not_finite.iter().for_each(|found| is_wrong[found.vertex as usize] = true);
        let count = is_wrong.iter().filter(|is_wrong| **is_wrong).count();
        if self.is_cloud() {
            let mut keeps = is_wrong.iter().map(|is_wrong| !is_wrong).cycle();
            let mut keep = || keeps.next().unwrap_or(true);
            self.read.retain(|_| keep());
            self.normals.iter_mut().for_each(|list| list.retain(|_| keep()));
            self.uvs.iter_mut().for_each(|list| list.retain(|_| keep()));
            self.colors.iter_mut().for_each(|list| list.retain(|_| keep()));
            self.warnings.push(format!("{count} points have numbers that are not finite, and are left out"));
            return Ok(());
        }
        let mut used = vec![false; self.read.len()];
        self.used_vertices().for_each(|vertex| used[vertex as usize] = true);
        if let Some(wrong) = self.not_finite.iter().find(|wrong| used[wrong.vertex as usize]) {
            let property = SLOTS[wrong.slot][0];
            let place = ElementProperty { element: "vertex", number: wrong.vertex.into(), property };
            values.at_line(wrong.line);
            return Err(values.error(place, &format!("{}", wrong.found), "a finite number is"));
        }
        self.warnings.push(format!(
            "{count} vertices have numbers that are not finite, as `{slot}` of vertex {}; nothing uses them",
            first.vertex
        ));
        Ok(())
    }

    /// Places the vertices by their origin, which it returns.
    fn place_vertices(&mut self) -> DVec3 {
        let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let around = |(min, max): (DVec3, DVec3), p: DVec3| (min.min(p), max.max(p));
        let (min, max) = if self.is_cloud() {
            self.read.iter().copied().fold(nothing, around)
        } else {
            self.used_vertices().map(|vertex| self.read[vertex as usize]).fold(nothing, around)
        };
        let origin = origin_of_box(min, max);
        let place = |p: &DVec3| {
            let placed = (*p - origin).as_vec3();
            // Only one that nothing uses may be so far away.
            if placed.is_finite() { placed } else { Vec3::ZERO }
        };
        self.positions = self.read.par_iter().with_min_len(1 << 14).map(place).collect();
        self.read = Vec::new();
        origin
    }

    fn into_model(self, path: &Path) -> Result<Model, LoadError> {
        let Self {
            mut positions, mut normals, mut uvs, mut colors, faces, strips, mut properties, mut warnings, ..
        } = self;
        let faces_alone = strips.is_empty();
        let Split { mut indices, corner_uvs, corner_colors, mut numbers } =
            faces.into_triangles(&positions, strips, &mut warnings);
        if indices.is_empty() {
            properties.append(&mut numbers);
            if !properties.is_empty() {
                let names: Vec<_> = properties.iter().map(|property| format!("`{}`", property.name)).collect();
                warnings.push(format!("the properties {} of lines and points are skipped", names.join(", ")));
            }
            return Ok(Model { warnings, ..Model::default() });
        }
        // Triangles of strips have no numbers.
        if faces_alone {
            properties.append(&mut numbers);
        }
        for property in numbers {
            let name = abridged(&property.name, "");
            warnings.push(format!("of `face` is skipped: {name}, which strips have not"));
        }
        let corner_colors = corner_colors.filter(|_| {
            if colors.is_some() {
                warnings.push("the colours of faces are skipped, since vertices have their own".to_owned());
            }
            colors.is_none()
        });
        if corner_uvs.is_some() || corner_colors.is_some() {
            let SplitVertices { corners, sources } =
                faces::split(&mut indices, corner_uvs.as_deref(), corner_colors.as_deref());
            positions = picked(&positions, &sources);
            normals = normals.map(|list| picked(&list, &sources));
            uvs = match corner_uvs {
                Some(list) => Some(picked(&list, &corners)),
                None => uvs.map(|list| picked(&list, &sources)),
            };
            colors = match corner_colors {
                Some(list) => Some(corners.iter().map(|corner| list[*corner as usize / 3]).collect()),
                None => colors.map(|list| picked(&list, &sources)),
            };
            for property in &mut properties {
                if let ScalarValues::Vertices(list) = &mut property.values {
                    *list = picked(list, &sources);
                }
            }
        }
        let refused = |source| LoadError::Mesh { path: path.to_owned(), element: "mesh".to_owned(), source };
        let (mut mesh, report) = Mesh::from_parts_reported(positions, normals, uvs, indices).map_err(refused)?;
        if report.replaced > 0 {
            warnings.push(format!("{} normals of zero length are replaced by computed ones", report.replaced));
        }
        if let Some(colors) = colors {
            mesh = mesh.with_colors(colors).map_err(refused)?;
        }
        let part = Part { name: stem(path), mesh, material: None, world_from_part: Mat4::IDENTITY };
        Ok(Model { parts: vec![part], warnings, properties: properties.into(), ..Model::default() })
    }

    fn edges(&mut self, element: &Element, values: &mut Values) -> Result<(), LoadError> {
        let end_of = |property: &PropertyType| {
            ENDS.iter()
                .position(|name| property.name == *name && property.list.is_none() && !property.scalar.is_float())
        };
        let ends: Vec<Option<usize>> = element.properties.iter().map(end_of).collect();
        if ![0, 1].iter().all(|end| ends.contains(&Some(*end))) {
            self.warnings.push(format!("the {} elements `edge` are skipped", element.count));
            return skip_all(element, values);
        }
        warn_of_skipped(element, |i| ends[i].is_some(), &mut self.warnings);
        for number in 0..element.count {
            let mut segment = [0; 2];
            for (property, end) in element.properties.iter().zip(&ends) {
                let place = ElementProperty { element: &element.name, number, property: &property.name };
                let Some(end) = *end else {
                    skip(property, place, values)?;
                    continue;
                };
                let vertex = values.next(property.scalar, place)?;
                if !(0.0..f64::from(u32::MAX)).contains(&vertex) {
                    return Err(values.error(place, &format!("{vertex}"), "a vertex, counted from 0, is"));
                }
                segment[end] = vertex as u32;
                if let Some(vertices) = self.known_vertices().filter(|count| segment[end] as usize >= *count) {
                    return Err(outside(values, place, segment[end], vertices));
                }
            }
            self.segments.push(segment);
        }
        Ok(())
    }

    /// The edges; all vertices as points where there are neither edges nor faces.
    fn lines(&mut self, path: &Path) -> Result<Vec<LinePart>, LoadError> {
        let is_cloud = self.is_cloud();
        if self.segments.is_empty() && !is_cloud || self.positions.is_empty() {
            return Ok(Vec::new());
        }
        let refused = |source| LoadError::Mesh { path: path.to_owned(), element: "vertices".to_owned(), source };
        let made = if is_cloud {
            Lines::cloud(self.positions.clone())
        } else {
            Lines::new(self.positions.clone(), std::mem::take(&mut self.segments), Vec::new())
        };
        let mut lines = made.map_err(refused)?;
        if let Some(normals) = self.normals.clone() {
            lines = lines.with_normals(normals).map_err(refused)?;
        }
        if let Some(colors) = self.colors.clone() {
            lines = lines.with_colors(colors).map_err(refused)?;
        }
        if self.uvs.is_some() && self.faces.corners.is_empty() && self.strips.is_empty() {
            self.warnings.push("texture coordinates of lines and points are skipped".to_owned());
        }
        Ok(vec![LinePart { name: stem(path), lines, material: None, world_from_part: Mat4::IDENTITY }])
    }
}

fn picked<T: Copy>(list: &[T], numbers: &[u32]) -> Vec<T> {
    numbers.iter().map(|number| list[*number as usize]).collect()
}

/// Warns of the properties of an element that are not read.
fn warn_of_skipped(element: &Element, is_read: impl Fn(usize) -> bool, warnings: &mut Vec<String>) {
    const SHOWN: usize = 8;
    let skipped: Vec<&str> =
        (0..element.properties.len()).filter(|i| !is_read(*i)).map(|i| &element.properties[i].name[..]).collect();
    if !skipped.is_empty() {
        let mut names = skipped.iter().take(SHOWN).map(|name| abridged(name, "")).collect::<Vec<_>>().join(", ");
        if skipped.len() > SHOWN {
            names.push_str(" and more");
        }
        warnings.push(format!("of `{}` is skipped: {names}", abridged(&element.name, "")));
    }
}

/// How an element of single numbers lies in a binary body.
struct Record {
    /// Each number's type and its place.
    numbers: Vec<(header::Scalar, usize)>,
    size: usize,
}

impl Record {
    /// `None` where there are lists, or nothing, or more than a buffer holds.
    fn new(element: &Element) -> Option<Self> {
        let mut size = 0;
        let mut numbers = Vec::with_capacity(element.properties.len());
        for property in &element.properties {
            if property.list.is_some() {
                return None;
            }
            numbers.push((property.scalar, size));
            size += property.scalar.size();
        }
        (1..1 << 16).contains(&size).then_some(Self { numbers, size })
    }

    fn decode(&self, bytes: &[u8], is_big: bool, row: &mut [f64]) {
        for ((scalar, at), number) in self.numbers.iter().zip(row) {
            *number = scalar.decode(&bytes[*at..], is_big);
        }
    }
}

/// Room for the numbers of the properties that are single numbers, and are not used otherwise.
fn numbers(element: &Element, is_free: impl Fn(usize) -> bool) -> Numbers {
    let is_kept = |(i, property): (usize, &PropertyType)| property.list.is_none() && is_free(i);
    element.properties.iter().enumerate().map(|property| is_kept(property).then(Vec::new)).collect()
}

/// Marks the −1 between strips.
const RESTART: u32 = u32::MAX;

fn outside(values: &Values, place: ElementProperty, corner: u32, vertices: usize) -> LoadError {
    values.error(
        place,
        &format!("vertex {corner}"),
        &format!("one of {vertices} vertices that stand before it, from 0, is"),
    )
}

#[inline]
fn length_of(length: header::Scalar, place: ElementProperty, values: &mut Values) -> Result<u64, LoadError> {
    let found = values.next(length, place)?;
    if found < 0.0 {
        return Err(values.error(place, &format!("a list of {found}"), "a length from 0 is"));
    }
    Ok(found as u64)
}

fn skip_all(element: &Element, values: &mut Values) -> Result<(), LoadError> {
    // Elements without properties take no bytes, so their count proves nothing.
    if element.properties.is_empty() {
        return Ok(());
    }
    for number in 0..element.count {
        for property in &element.properties {
            skip(property, ElementProperty { element: &element.name, number, property: &property.name }, values)?;
        }
    }
    Ok(())
}

fn skip(property: &PropertyType, place: ElementProperty, values: &mut Values) -> Result<(), LoadError> {
    let count = match property.list {
        Some(length) => length_of(length, place, values)?,
        None => 1,
    };
    for _ in 0..count {
        values.next(property.scalar, place)?;
    }
    Ok(())
}
