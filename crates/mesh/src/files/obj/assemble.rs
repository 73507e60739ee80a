//! Turns the statements of a file into parts.

use std::collections::HashMap;
use std::path::Path;

use glam::{DVec3, Mat4, Vec2, Vec3};

use crate::classes::Classes;
use crate::files::LoadError;
use crate::files::srgb::decoded;
use crate::files::text::Skipped;
use crate::normals::{Smoothed, grouped_normals};
use crate::numbering::{DistinctKeys, Numbering, position_key};
use crate::{LinePart, Lines, Mesh, MeshError, NormalWeighting, Part};

/// The vertices that faces refer to.
#[derive(Default)]
pub(super) struct ObjVertices {
    /// The positions as the file says them, until they are placed.
    pub(super) read: Vec<DVec3>,
    /// The positions, counted from the model's origin.
    pub(super) positions: Vec<Vec3>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) normals: Vec<Vec3>,
    /// The colours of the first positions: as in the file, NaN for none, and then linear RGB, white for none. The other
    /// positions are white.
    pub(super) colors: Vec<Vec3>,
    /// The first line with a colour beyond 1.
    bright: Option<usize>,
    /// Whether some colour is no whole number from 0 to 255.
    has_fractions: bool,
}

impl ObjVertices {
    /// How many positions, texture coordinates and normals there are.
    pub(super) fn counts(&self) -> [usize; 3] {
        [self.read.len(), self.uvs.len(), self.normals.len()]
    }

    /// Gives the next position a colour.
    pub(super) fn add_color(&mut self, color: Vec3, line: usize) {
        if color.max_element() > 1.0 {
            self.bright.get_or_insert(line);
        }
        self.has_fractions |= color.fract() != Vec3::ZERO || color.min_element() < 0.0 || color.max_element() > 255.0;
        self.colors.resize(self.read.len(), Vec3::NAN);
        self.colors.push(color);
    }

    /// Decodes the colours. Whole numbers up to 255 mean 255 times less.
    pub(super) fn decode_colors(&mut self, skipped: &mut Skipped) {
        let line = self.bright.filter(|_| !self.has_fractions);
        if let Some(line) = line {
            skipped.add(line, "colours of `v` are whole numbers up to 255, and are divided by it");
        }
        let one = if line.is_some() { 255.0 } else { 1.0 };
        for color in &mut self.colors {
            *color = if color.is_nan() { Vec3::ONE } else { Vec3::from_array((*color / one).to_array().map(decoded)) };
        }
    }
}

/// A part under construction: the faces, lines and points of one name and material.
pub(super) struct Draft {
    name: String,
    pub(super) material: Option<String>,
    /// The distinct corners, as indices from 1 of position, texture coordinate and normal, 0 for none.
    pub(super) corners: DistinctKeys,
    indices: Vec<u32>,
    /// The smoothing group of each triangle; triangles beyond the end have group 0.
    groups: Vec<u32>,
    /// The positions, numbered from 1, of the ends of lines, and of points.
    pub(super) segments: Vec<[u32; 2]>,
    pub(super) points: Vec<u32>,
}

impl Draft {
    pub(super) fn new(name: String, material: Option<String>) -> Self {
        Self {
            name,
            material,
            corners: DistinctKeys::default(),
            indices: Vec::new(),
            groups: Vec::new(),
            segments: Vec::new(),
            points: Vec::new(),
        }
    }

    pub(super) fn has_triangles(&self) -> bool {
        !self.indices.is_empty()
    }

    pub(super) fn has_lines(&self) -> bool {
        !(self.segments.is_empty() && self.points.is_empty())
    }

    /// Its lines and points; all indices have been checked.
    pub(super) fn line_part(
        &self,
        path: &Path,
        vertices: &ObjVertices,
        material: Option<usize>,
    ) -> Result<LinePart, LoadError> {
        let Self { name, segments, points, .. } = self;
        let refused = |source| LoadError::Mesh { path: path.to_owned(), element: format!("`{name}`"), source };
        let uses: Vec<u32> = segments.iter().flatten().chain(points).copied().collect();
        let used = Numbering::new(uses.len(), |i| [uses[i]]);
        let sources: Vec<usize> = used.firsts.iter().map(|&first| uses[first as usize] as usize - 1).collect();
        let (ends, points) = used.numbers.split_at(2 * segments.len());
        let positions = sources.iter().map(|&source| vertices.positions[source]).collect();
        let mut lines = Lines::new(positions, ends.as_chunks().0.to_vec(), points.to_vec()).map_err(refused)?;
        if !vertices.colors.is_empty() {
            let color = |source: &usize| vertices.colors.get(*source).unwrap_or(&Vec3::ONE).extend(1.0);
            lines = lines.with_colors(sources.iter().map(color).collect()).map_err(refused)?;
        }
        Ok(LinePart { name: name.clone(), lines, material, world_from_part: Mat4::IDENTITY })
    }

    /// The positions, numbered from 1, of its faces, lines and points.
    pub(super) fn used_positions(&self) -> impl Iterator<Item = u32> {
        let of_faces = self.corners.keys().iter().map(|key| key[0]);
        of_faces.chain(self.segments.as_flattened().iter().chain(&self.points).copied())
    }

    /// Adds a triangle of numbered corners.
    pub(super) fn triangle(&mut self, corners: [u32; 3], group: u32) {
        if group != 0 {
            self.groups.resize(self.indices.len() / 3, 0);
            self.groups.push(group);
        }
        self.indices.extend(corners);
    }

    /// The part, and, where it has no normals and `normals_later`, the data to compute them; they are +Y until then.
    fn into_part(
        self,
        path: &Path,
        vertices: &ObjVertices,
        normals_later: bool,
        warnings: &mut Vec<String>,
    ) -> Result<(Part, Option<Unsmoothed>), LoadError> {
        let Self { name, corners, indices, groups, .. } = self;
        let mut keys = corners.into_keys();
        // Numbers beyond those that the file defines, of which a warning has told.
        let [_, uvs, normals] = vertices.counts().map(|count| count as u32);
        for [_, uv, normal] in &mut keys {
            *uv = if *uv > uvs { 0 } else { *uv };
            *normal = if *normal > normals { 0 } else { *normal };
        }
        let mut given = |kind: usize, what: &str| {
            let missing = keys.iter().filter(|key| key[kind] == 0).count();
            if missing != 0 && missing != keys.len() {
                warnings.push(format!("`{name}`: {missing} of {} vertices have no {what}", keys.len()));
            }
            missing != keys.len()
        };
        let positions = keys.iter().map(|key| vertices.positions[key[0] as usize - 1]).collect();
        let uvs = given(1, "texture coordinate; they get (0, 0)").then(|| picked(&keys, 1, &vertices.uvs, Vec2::ZERO));
        let has_normals = given(2, "normal; they get a computed one");
        let missing = keys.iter().filter(|key| key[2] == 0).count();
        let normals = match (has_normals, normals_later) {
            // Zero marks a normal to be computed.
            (true, _) => Some(picked(&keys, 2, &vertices.normals, Vec3::ZERO)),
            (false, true) => Some(vec![Vec3::Y; keys.len()]),
            (false, false) => None,
        };
        let colors = (!vertices.colors.is_empty()).then(|| {
            let color = |key: &[u32; 3]| vertices.colors.get(key[0] as usize - 1).unwrap_or(&Vec3::ONE).extend(1.0);
            keys.iter().map(color).collect()
        });
        let unsmoothed = (!has_normals && normals_later).then(|| Unsmoothed {
            part: 0,
            groups,
            sources: keys.iter().map(|key| key[0] - 1).collect(),
        });
        drop(keys);
        let refused = |source| LoadError::Mesh { path: path.to_owned(), element: format!("`{name}`"), source };
        let (mut mesh, report) = Mesh::from_parts_reported(positions, normals, uvs, indices).map_err(refused)?;
        let without_direction = report.replaced - if has_normals { missing } else { 0 };
        if without_direction > 0 {
            warnings
                .push(format!("`{name}`: {without_direction} normals of zero length are replaced by computed ones"));
        }
        if let Some(colors) = colors {
            mesh = mesh.with_colors(colors).map_err(refused)?;
        }
        Ok((Part { name, mesh, material: None, world_from_part: Mat4::IDENTITY }, unsmoothed))
    }
}

/// A part without normals.
struct Unsmoothed {
    /// Its number among the parts.
    part: usize,
    /// The smoothing group of each triangle; triangles beyond the end have group 0.
    groups: Vec<u32>,
    /// The position in the file, counted from 0, of each vertex.
    sources: Vec<u32>,
}

/// The parts of all drafts. Parts without normals are smoothed together, by smoothing groups if the file has any: a
/// border between materials or names is not a crease.
pub(super) fn parts(
    drafts: Vec<Draft>,
    path: &Path,
    vertices: &ObjVertices,
    has_groups: bool,
    warnings: &mut Vec<String>,
) -> Result<Vec<Part>, LoadError> {
    let normals_later = has_groups || drafts.len() > 1;
    let mut parts = Vec::with_capacity(drafts.len());
    let mut unsmoothed = Vec::new();
    for draft in drafts {
        let (part, without) = draft.into_part(path, vertices, normals_later, warnings)?;
        unsmoothed.extend(without.map(|without| Unsmoothed { part: parts.len(), ..without }));
        parts.push(part);
    }
    let count = unsmoothed.iter().map(|without| parts[without.part].mesh.indices().len()).sum();
    if u32::try_from(count).is_err() {
        let source = MeshError::TooMany { elements: "indices", count };
        return Err(LoadError::Mesh { path: path.to_owned(), element: "parts without normals".to_owned(), source });
    }
    if !has_groups {
        for without in &mut unsmoothed {
            without.groups = vec![1; parts[without.part].mesh.triangle_count()];
        }
    }
    smooth(&mut parts, &unsmoothed, &vertices.positions);
    if !has_groups {
        for without in &unsmoothed {
            let mesh = &mut parts[without.part].mesh;
            *mesh = mesh.clone().with_normals_as_default();
        }
    }
    Ok(parts)
}

/// Computes normals. Faces share a point if they use the same `v`, and within one name also if they are at the same
/// position: objects that only touch are separate surfaces.
fn smooth(parts: &mut [Part], unsmoothed: &[Unsmoothed], positions: &[Vec3]) {
    let mut names = HashMap::new();
    let mut used: Vec<(u32, u32)> = Vec::new();
    for without in unsmoothed {
        let next = names.len() as u32;
        let name = *names.entry(&parts[without.part].name[..]).or_insert(next);
        used.extend(without.sources.iter().map(|&source| (name, source)));
    }
    let at_one_position = Numbering::new(used.len(), |i| {
        let (name, source) = used[i];
        let [x, y, z] = position_key(positions[source as usize]);
        [name, x, y, z]
    });
    let mut points = Classes::new(positions.len());
    for (&(_, source), &number) in used.iter().zip(&at_one_position.numbers) {
        let (_, first) = used[at_one_position.firsts[number as usize] as usize];
        points.join(source, first);
    }
    drop((names, used, at_one_position));
    let (points, _) = points.numbers();
    let points_of = |without: &Unsmoothed| without.sources.iter().map(|&source| points[source as usize]).collect();
    let points: Vec<Vec<u32>> = unsmoothed.iter().map(points_of).collect();
    let with_points = unsmoothed.iter().zip(&points);
    let meshes: Vec<Smoothed> = with_points
        .map(|(without, points)| Smoothed { mesh: &parts[without.part].mesh, points, groups: &without.groups })
        .collect();
    let made = grouped_normals(&meshes, NormalWeighting::default());
    for (without, mesh) in unsmoothed.iter().zip(made) {
        parts[without.part].mesh = mesh;
    }
}

fn picked<T: Copy>(keys: &[[u32; 3]], kind: usize, all: &[T], missing: T) -> Vec<T> {
    keys.iter()
        .map(|key| match key[kind] {
            0 => missing,
            index => all[index as usize - 1],
        })
        .collect()
}
