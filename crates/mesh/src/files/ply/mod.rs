//! PLY, in ASCII and binary (Turk 1994, "The PLY polygon file format").

mod header;
mod values;

use glam::{Mat4, Vec2, Vec3, Vec4};

use self::header::{Element, Property as PropertyType};
use self::values::{ElementProperty, Values};
use super::source::{Source, stem};
use super::srgb::decoded;
use super::text::abridged;
use super::{LoadError, polygon};
use crate::{LinePart, Lines, Mesh, Model, Part, Property, ScalarValues};

/// Reads `vertex` (positions, normals, colours, texture coordinates), `face`, `tristrips` and `edge`; other numbers of
/// vertices and faces become properties, and all else is skipped with a warning. Where nothing joins the vertices they are
/// points.
pub(super) fn parse(source: Source) -> Result<Model, LoadError> {
    let Source { path, mut reader, .. } = source;
    let header = header::parse(&mut reader)?;
    let mut values = Values::new(reader, &header);
    let mut shape = PlyContent::default();
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => shape.vertices(element, &mut values)?,
            "face" => shape.faces(element, &mut values)?,
            "tristrips" => shape.strips(element, &mut values)?,
            "edge" => shape.edges(element, &mut values)?,
            _ => {
                let name = abridged(&element.name, "");
                shape.warnings.push(format!("the {} elements `{name}` are skipped", element.count));
                skip_all(element, &mut values)?;
            }
        }
    }
    let lines = shape.lines(path)?;
    let PlyContent { positions, normals, uvs, colors, indices, mut warnings, crossed, small, mut properties, .. } =
        shape;
    for (count, what) in [
        (crossed, "polygons that cross themselves, or have too many corners, are cut somehow"),
        (small, "faces of fewer than three corners are skipped"),
    ] {
        if count > 0 {
            warnings.push(format!("{count} {what}"));
        }
    }
    if indices.is_empty() {
        if !properties.is_empty() {
            let names: Vec<_> = properties.iter().map(|property| format!("`{}`", property.name)).collect();
            warnings.push(format!("the properties {} of lines and points are skipped", names.join(", ")));
        }
        return Ok(Model { lines, warnings, ..Model::default() });
    }
    let refused = |source| LoadError::Mesh { path: path.to_owned(), element: "mesh".to_owned(), source };
    let (mut mesh, report) = Mesh::from_parts_reported(positions, normals, uvs, indices).map_err(refused)?;
    if report.replaced > 0 {
        warnings.push(format!("{} normals of zero length are replaced by computed ones", report.replaced));
    }
    if let Some(colors) = colors {
        mesh = mesh.with_colors(colors).map_err(refused)?;
    }
    // Triangles of strips have no numbers.
    let triangles = mesh.triangle_count();
    let is_whole = |values: &ScalarValues| !matches!(values, ScalarValues::Faces(faces) if faces.len() != triangles);
    for property in properties.extract_if(.., |property| !is_whole(&property.values)) {
        warnings.push(format!("of `face` is skipped: {}, which strips have not", abridged(&property.name, "")));
    }
    let properties = properties.into();
    let part = Part { name: stem(path), mesh, material: None, world_from_part: Mat4::IDENTITY };
    Ok(Model { parts: vec![part], lines, warnings, properties, ..Model::default() })
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

/// The names of the face property that lists the corners.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// The edge properties for its two ends.
const ENDS: [&str; 2] = ["vertex1", "vertex2"];

#[derive(Default)]
struct PlyContent {
    positions: Vec<Vec3>,
    normals: Option<Vec<Vec3>>,
    uvs: Option<Vec<Vec2>>,
    colors: Option<Vec<Vec4>>,
    indices: Vec<u32>,
    segments: Vec<[u32; 2]>,
    /// The corners of the face being read, and their positions.
    corners: Vec<u32>,
    points: Vec<Vec3>,
    crossed: usize,
    small: usize,
    properties: Vec<Property>,
    warnings: Vec<String>,
}

/// The numbers of one property of each vertex or triangle; `None` for those that mean something else.
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
        self.warn_of_skipped(element, |i| slots[i].is_some() || numbers[i].is_some());
        if !has(0..3) {
            let place = ElementProperty { element: "vertex", number: 0, property: "x, y and z" };
            return Err(values.error(place, "no such properties", "three numbers are"));
        }
        self.normals = has(3..6).then(Vec::new);
        self.uvs = has(6..8).then(Vec::new);
        self.colors = has(8..11).then(Vec::new);
        for number in 0..element.count {
            let mut vertex = [0.0; 12];
            vertex[11] = 1.0;
            for ((property, slot), numbers) in element.properties.iter().zip(&slots).zip(&mut numbers) {
                let place = ElementProperty { element: &element.name, number, property: &property.name };
                let Some(slot) = *slot else {
                    match numbers {
                        Some(numbers) => numbers.push(values.next(property.scalar, place)? as f32),
                        None => skip(property, place, values)?,
                    }
                    continue;
                };
                let found = values.next(property.scalar, place)?;
                vertex[slot] = if slot < 8 { found } else { found / property.scalar.one() };
                if !(vertex[slot] as f32).is_finite() {
                    return Err(values.error(place, &format!("{found}"), "a finite number is"));
                }
            }
            self.vertex(vertex);
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

    fn vertex(&mut self, slots: [f64; 12]) {
        let [x, y, z, nx, ny, nz, u, v, r, g, b, alpha] = slots;
        let vec3 = |x: f64, y: f64, z: f64| Vec3::new(x as f32, y as f32, z as f32);
        self.positions.push(vec3(x, y, z));
        if let Some(normals) = &mut self.normals {
            normals.push(vec3(nx, ny, nz));
        }
        if let Some(uvs) = &mut self.uvs {
            // Programs write v upward, as in OBJ.
            uvs.push(Vec2::new(u as f32, (1.0 - v) as f32));
        }
        if let Some(colors) = &mut self.colors {
            colors.push(Vec3::from_array([r, g, b].map(|x| decoded(x as f32))).extend(alpha as f32));
        }
    }

    fn faces(&mut self, element: &Element, values: &mut Values) -> Result<(), LoadError> {
        self.lists(element, values, |shape, values, place| {
            if let Some(&corner) = shape.corners.iter().find(|&&corner| corner as usize >= shape.positions.len()) {
                return Err(outside(values, place, corner, shape.positions.len()));
            }
            match &shape.corners[..] {
                &[a, b, c] => shape.indices.extend([a, b, c]),
                [] | [_] | [_, _] => shape.small += 1,
                corners => {
                    shape.points.extend(corners.iter().map(|&corner| shape.positions[corner as usize]));
                    let indices = &mut shape.indices;
                    let clean = polygon::cut(&shape.points, |triangle| {
                        indices.extend(triangle.map(|i| corners[i as usize]));
                    });
                    shape.crossed += usize::from(!clean);
                }
            }
            Ok(())
        })
    }

    /// Strips, each ended by −1.
    fn strips(&mut self, element: &Element, values: &mut Values) -> Result<(), LoadError> {
        self.lists(element, values, |shape, values, place| {
            for strip in shape.corners.split(|&corner| corner == RESTART) {
                if let Some(&corner) = strip.iter().find(|&&corner| corner as usize >= shape.positions.len()) {
                    return Err(outside(values, place, corner, shape.positions.len()));
                }
                for (i, &three) in strip.array_windows::<3>().enumerate() {
                    let [a, b, c] = three;
                    shape.indices.extend(if i % 2 == 0 { [a, b, c] } else { [a, c, b] });
                }
            }
            Ok(())
        })
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
        self.warn_of_skipped(element, |i| ends[i].is_some());
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
                if segment[end] as usize >= self.positions.len() {
                    return Err(outside(values, place, segment[end], self.positions.len()));
                }
            }
            self.segments.push(segment);
        }
        Ok(())
    }

    /// The edges; all vertices as points where there are neither edges nor faces.
    fn lines(&mut self, path: &std::path::Path) -> Result<Vec<LinePart>, LoadError> {
        let is_cloud = self.segments.is_empty() && self.indices.is_empty();
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
        if self.uvs.is_some() && self.indices.is_empty() {
            self.warnings.push("texture coordinates of lines and points are skipped".to_owned());
        }
        Ok(vec![LinePart { name: stem(path), lines, material: None, world_from_part: Mat4::IDENTITY }])
    }

    /// Reads the lists of corners and passes each on in `corners`.
    fn lists(
        &mut self,
        element: &Element,
        values: &mut Values,
        mut take: impl FnMut(&mut Self, &Values, ElementProperty) -> Result<(), LoadError>,
    ) -> Result<(), LoadError> {
        let is_list = |property: &PropertyType| {
            property.list.is_some() && !property.scalar.is_float() && CORNERS.contains(&property.name.as_str())
        };
        let list = element.properties.iter().position(is_list);
        let mut numbers = numbers(element, |_| element.name == "face");
        self.warn_of_skipped(element, |i| Some(i) == list || numbers[i].is_some());
        if element.properties.is_empty() {
            return Ok(());
        }
        for number in 0..element.count {
            self.corners.clear();
            self.points.clear();
            for (i, property) in element.properties.iter().enumerate() {
                let place = ElementProperty { element: &element.name, number, property: &property.name };
                match property.list {
                    Some(length) if Some(i) == list => {
                        for _ in 0..length_of(length, place, values)? {
                            let corner = values.next(property.scalar, place)?;
                            let is_restart = corner as i64 == -1 && element.name == "tristrips";
                            if !(is_restart || (0.0..f64::from(u32::MAX)).contains(&corner)) {
                                return Err(values.error(place, &format!("{corner}"), "a vertex, counted from 0, is"));
                            }
                            self.corners.push(if is_restart { RESTART } else { corner as u32 });
                        }
                    }
                    _ => match &mut numbers[i] {
                        Some(numbers) => numbers.push(values.next(property.scalar, place)? as f32),
                        None => skip(property, place, values)?,
                    },
                }
            }
            let before = self.indices.len() / 3;
            let property = list.map_or("", |list| &element.properties[list].name);
            take(self, values, ElementProperty { element: &element.name, number, property })?;
            // One a triangle.
            let triangles = self.indices.len() / 3 - before;
            for numbers in numbers.iter_mut().flatten() {
                let length = (numbers.len() - 1) + triangles;
                let number = numbers.last().copied().unwrap_or_default();
                numbers.resize(length, number);
            }
        }
        self.keep(element, numbers, ScalarValues::Faces);
        Ok(())
    }

    fn warn_of_skipped(&mut self, element: &Element, is_read: impl Fn(usize) -> bool) {
        const SHOWN: usize = 8;
        let skipped: Vec<&str> =
            (0..element.properties.len()).filter(|i| !is_read(*i)).map(|i| &element.properties[i].name[..]).collect();
        if !skipped.is_empty() {
            let mut names = skipped.iter().take(SHOWN).map(|name| abridged(name, "")).collect::<Vec<_>>().join(", ");
            if skipped.len() > SHOWN {
                names.push_str(" and more");
            }
            self.warnings.push(format!("of `{}` is skipped: {names}", abridged(&element.name, "")));
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
