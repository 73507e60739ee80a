//! Faces: their corners, and the colours and texture coordinates that they have of their own.

use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::header::{Element, Property as PropertyType, Scalar};
use super::values::{ElementProperty, Values};
use super::{CORNERS, RESTART, SLOTS, length_of, numbers, outside, skip, warn_of_skipped};
use crate::files::srgb::decoded;
use crate::files::{LoadError, polygon};
use crate::numbering::Numbering;
use crate::{Property, ScalarValues};

/// The names of the property that lists the texture coordinates of a face's corners.
const CORNER_UVS: [&str; 2] = ["texcoord", "texcoords"];

/// Polygons as they are read: they may stand before the vertices.
#[derive(Default)]
pub(super) struct Faces {
    pub(super) corners: Vec<u32>,
    /// How many corners each has.
    pub(super) sizes: Vec<u32>,
    /// A pair a corner.
    uvs: Option<Vec<Vec2>>,
    /// Faces whose list has not a pair a corner.
    without_uvs: usize,
    /// One a face.
    colors: Option<Vec<Vec4>>,
    /// The numbers of other properties, one a face.
    numbers: Vec<Property>,
}

/// Triangles, with what their corners have of their own.
pub(super) struct Split {
    pub(super) indices: Vec<u32>,
    /// One a corner.
    pub(super) corner_uvs: Option<Vec<Vec2>>,
    /// One a triangle.
    pub(super) corner_colors: Option<Vec<Vec4>>,
    /// One a triangle.
    pub(super) numbers: Vec<Property>,
}

/// The meaning of a face's property.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Meaning {
    Corners,
    Uvs,
    /// Red, green, blue or opacity.
    Color(usize),
    Other,
}

impl Faces {
    /// Reads the faces, or the lists of strips. `vertices` is their count, where they have been read.
    pub(super) fn read(
        &mut self,
        element: &Element,
        values: &mut Values,
        vertices: Option<usize>,
        warnings: &mut Vec<String>,
    ) -> Result<(), LoadError> {
        let is_face = element.name == "face";
        let mut meanings: Vec<Meaning> = element.properties.iter().map(|property| meaning(property, is_face)).collect();
        let has_colors = (0..3).all(|channel| meanings.contains(&Meaning::Color(channel)));
        if !has_colors {
            meanings.iter_mut().filter(|it| matches!(it, Meaning::Color(_))).for_each(|it| *it = Meaning::Other);
        }
        let mut numbers = numbers(element, |i| is_face && meanings[i] == Meaning::Other);
        warn_of_skipped(element, |i| meanings[i] != Meaning::Other || numbers[i].is_some(), warnings);
        if element.properties.is_empty() {
            return Ok(());
        }
        self.colors = has_colors.then(Vec::new);
        self.uvs = meanings.contains(&Meaning::Uvs).then(Vec::new);
        let list = meanings.iter().position(|meaning| *meaning == Meaning::Corners);
        let is_plain = match &element.properties[..] {
            [PropertyType { list: Some(Scalar::U8), scalar: Scalar::I32 | Scalar::U32, .. }] => list.is_some(),
            _ => false,
        };
        let mut pairs = Vec::new();
        let mut number = 0;
        while number < element.count {
            if is_plain {
                number += self.read_plain(element.count - number, vertices, values)?;
                if number == element.count {
                    break;
                }
            }
            let before = self.corners.len();
            let mut color = [0.0, 0.0, 0.0, 1.0];
            pairs.clear();
            for (i, property) in element.properties.iter().enumerate() {
                let place = ElementProperty { element: &element.name, number, property: &property.name };
                match (meanings[i], &mut numbers[i]) {
                    (Meaning::Corners, _) => self.read_corners(property, place, vertices, values)?,
                    (Meaning::Uvs, _) => {
                        let length = property.list.map_or(Ok(0), |length| length_of(length, place, values))?;
                        for _ in 0..length {
                            pairs.push(values.next(property.scalar, place)?);
                        }
                    }
                    (Meaning::Color(channel), _) => {
                        let found = values.next(property.scalar, place)?;
                        color[channel] = found / property.scalar.one();
                        if !(color[channel] as f32).is_finite() {
                            return Err(values.error(place, &format!("{found}"), "a finite number is"));
                        }
                    }
                    (Meaning::Other, Some(numbers)) => numbers.push(values.next(property.scalar, place)? as f32),
                    (Meaning::Other, None) => skip(property, place, values)?,
                }
            }
            let size = self.corners.len() - before;
            self.sizes.push(size as u32);
            self.add_uvs(&pairs, size);
            if let Some(colors) = &mut self.colors {
                let [r, g, b, alpha] = color.map(|x| x as f32);
                colors.push(Vec3::from_array([r, g, b].map(decoded)).extend(alpha));
            }
            number += 1;
        }
        for (property, numbers) in element.properties.iter().zip(numbers) {
            let property =
                |numbers| Property { name: property.name.clone(), part: 0, values: ScalarValues::Faces(numbers) };
            self.numbers.extend(numbers.map(property));
        }
        Ok(())
    }

    /// Reads faces of nothing but a list, with a length of one byte and corners of four, as far as they are in the buffer
    /// and sound; returns how many.
    fn read_plain(&mut self, most: u64, vertices: Option<usize>, values: &mut Values) -> Result<u64, LoadError> {
        let is_big = values.is_big_endian();
        let limit = vertices.map_or(i32::MAX as u32, |count| u32::try_from(count).unwrap_or(u32::MAX));
        let ahead = values.ahead(1 + 4 * usize::from(u8::MAX))?;
        let mut at = 0;
        let mut count = 0;
        while count < most {
            let Some((&size, rest)) = ahead[at..].split_first() else { break };
            let Some(list) = rest.get(..4 * usize::from(size)) else { break };
            let before = self.corners.len();
            let corners = list.as_chunks::<4>().0.iter();
            self.corners
                .extend(corners.map(|four| if is_big { u32::from_be_bytes(*four) } else { u32::from_le_bytes(*four) }));
            if self.corners[before..].iter().any(|corner| *corner >= limit) {
                self.corners.truncate(before);
                break;
            }
            self.sizes.push(size.into());
            at += 1 + list.len();
            count += 1;
        }
        values.consume(at);
        Ok(count)
    }

    fn read_corners(
        &mut self,
        property: &PropertyType,
        place: ElementProperty,
        vertices: Option<usize>,
        values: &mut Values,
    ) -> Result<(), LoadError> {
        let length = property.list.map_or(Ok(0), |length| length_of(length, place, values))?;
        for _ in 0..length {
            let corner = values.next(property.scalar, place)?;
            let is_restart = corner.total_cmp(&-1.0).is_eq() && place.element == "tristrips";
            if !(is_restart || (0.0..f64::from(u32::MAX)).contains(&corner) && corner.fract() == 0.0) {
                return Err(values.error(place, &format!("{corner}"), "a vertex, counted from 0, is"));
            }
            if let Some(count) = vertices.filter(|count| !is_restart && corner >= *count as f64) {
                return Err(outside(values, place, corner as u32, count));
            }
            self.corners.push(if is_restart { RESTART } else { corner as u32 });
        }
        Ok(())
    }

    fn add_uvs(&mut self, pairs: &[f64], corners: usize) {
        let Some(uvs) = &mut self.uvs else { return };
        if pairs.len() == 2 * corners && pairs.iter().all(|x| (*x as f32).is_finite()) {
            // v runs upward in the file.
            uvs.extend(pairs.as_chunks::<2>().0.iter().map(|[u, v]| Vec2::new(*u as f32, (1.0 - v) as f32)));
        } else {
            self.without_uvs += 1;
            uvs.resize(uvs.len() + corners, Vec2::ZERO);
        }
    }

    /// The first face with a corner beyond so many vertices, and that corner.
    pub(super) fn outside(&self, vertices: usize) -> Option<(u64, u32)> {
        let at = self.corners.par_iter().with_min_len(1 << 16).position_first(|corner| *corner as usize >= vertices)?;
        let mut end = 0;
        let face = self.sizes.iter().position(|size| {
            end += *size as usize;
            at < end
        });
        Some((face.unwrap_or_default() as u64, self.corners[at]))
    }

    /// The triangles, and those of strips after them. All corners have been checked.
    pub(super) fn into_triangles(self, positions: &[Vec3], strips: Vec<u32>, warnings: &mut Vec<String>) -> Split {
        let Self { corners, sizes, uvs, without_uvs, colors, numbers } = self;
        if without_uvs > 0 {
            warnings.push(format!(
                "{without_uvs} faces have no finite pair of texture coordinates a corner; they get (0, 0)"
            ));
        }
        if !strips.is_empty() && (uvs.is_some() || colors.is_some()) {
            warnings.push("colours and texture coordinates of faces are skipped, since strips have none".to_owned());
        }
        let [has_uvs, has_colors] = [uvs.is_some(), colors.is_some()].map(|has| has && strips.is_empty());
        if sizes.iter().all(|size| *size == 3) {
            let mut indices = corners;
            indices.extend(strips);
            let [corner_uvs, corner_colors] = [has_uvs, has_colors];
            return Split {
                indices,
                corner_uvs: uvs.filter(|_| corner_uvs),
                corner_colors: colors.filter(|_| corner_colors),
                numbers,
            };
        }
        // The corners of the triangles as numbers in the list, and the face of each triangle.
        let mut picked: Vec<u32> = Vec::with_capacity(corners.len());
        let mut faces: Vec<u32> = Vec::with_capacity(sizes.len());
        let (mut first, mut small, mut crossed) = (0, 0, 0_usize);
        let mut points = Vec::new();
        for (face, size) in (0..).zip(sizes) {
            let own = first..first + size;
            first += size;
            match size {
                0..3 => small += 1,
                3 => picked.extend(own),
                _ => {
                    points.clear();
                    points.extend(corners[own.start as usize..own.end as usize].iter().map(|v| positions[*v as usize]));
                    let is_clean = polygon::cut(&points, |triangle| picked.extend(triangle.map(|i| own.start + i)));
                    crossed += usize::from(!is_clean);
                }
            }
            faces.resize(picked.len() / 3, face);
        }
        for (count, what) in [
            (crossed, "polygons that cross themselves, or have too many corners, are cut somehow"),
            (small, "faces of fewer than three corners are skipped"),
        ] {
            if count > 0 {
                warnings.push(format!("{count} {what}"));
            }
        }
        let mut indices: Vec<u32> = picked.iter().map(|corner| corners[*corner as usize]).collect();
        indices.extend(strips);
        let of_triangles = |property: Property| match property.values {
            ScalarValues::Faces(of) => {
                let values = ScalarValues::Faces(faces.iter().map(|face| of[*face as usize]).collect());
                Property { values, ..property }
            }
            ScalarValues::Vertices(_) => property,
        };
        Split {
            indices,
            corner_uvs: uvs.filter(|_| has_uvs).map(|of| picked.iter().map(|corner| of[*corner as usize]).collect()),
            corner_colors: colors
                .filter(|_| has_colors)
                .map(|of| faces.iter().map(|face| of[*face as usize]).collect()),
            numbers: numbers.into_iter().map(of_triangles).collect(),
        }
    }
}

fn meaning(property: &PropertyType, is_face: bool) -> Meaning {
    let name = property.name.as_str();
    let channel = SLOTS[8..].iter().position(|names| names.contains(&name));
    match property.list {
        Some(_) if CORNERS.contains(&name) => Meaning::Corners,
        Some(_) if is_face && CORNER_UVS.contains(&name) && property.scalar.is_float() => Meaning::Uvs,
        None if is_face => channel.map_or(Meaning::Other, Meaning::Color),
        _ => Meaning::Other,
    }
}

/// Vertices that were split where the triangles around them differ.
pub(super) struct SplitVertices {
    /// A corner of each.
    pub(super) corners: Vec<u32>,
    /// The vertex that each comes from.
    pub(super) sources: Vec<u32>,
}

/// Splits vertices between corners with different texture coordinates or colours, one a corner and one a triangle.
pub(super) fn split(indices: &mut Vec<u32>, uvs: Option<&[Vec2]>, colors: Option<&[Vec4]>) -> SplitVertices {
    let color_class =
        colors.map(|colors| Numbering::new(colors.len(), |face| colors[face].to_array().map(f32::to_bits)));
    let vertices = Numbering::new(indices.len(), |corner| {
        let [u, v] = uvs.map_or([0; 2], |uvs| uvs[corner].to_array().map(f32::to_bits));
        [indices[corner], u, v, color_class.as_ref().map_or(0, |class| class.numbers[corner / 3])]
    });
    let sources = vertices.firsts.iter().map(|corner| indices[*corner as usize]).collect();
    *indices = vertices.numbers;
    SplitVertices { corners: vertices.firsts, sources }
}
