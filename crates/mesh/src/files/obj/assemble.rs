//! Parts of what was read.

use std::path::Path;

use bevy_math::{Mat4, Vec2, Vec3};

use crate::files::LoadError;
use crate::files::distinct::Distinct;
use crate::normals::grouped_normals;
use crate::{Mesh, NormalWeighting, Part};

/// All that faces refer to.
#[derive(Default)]
pub(super) struct Vertices {
    pub(super) positions: Vec<Vec3>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) normals: Vec<Vec3>,
    /// Linear, of the first positions; the rest are white.
    pub(super) colors: Vec<Vec3>,
}

impl Vertices {
    /// How many positions, texture coordinates and normals there are.
    pub(super) fn counts(&self) -> [usize; 3] {
        [self.positions.len(), self.uvs.len(), self.normals.len()]
    }
}

/// A part that is growing: the faces of one name and material.
pub(super) struct Draft {
    name: String,
    pub(super) material: Option<String>,
    /// The distinct corners, as indices from 1 of position, texture coordinate and normal, 0 for none.
    corners: Distinct,
    indices: Vec<u32>,
    /// The smoothing group of each triangle; what is missing at the end is 0.
    groups: Vec<u32>,
}

impl Draft {
    pub(super) fn new(name: String, material: Option<String>) -> Self {
        Self { name, material, corners: Distinct::new(), indices: Vec::new(), groups: Vec::new() }
    }

    pub(super) fn triangle(&mut self, corners: [[u32; 3]; 3], group: u32) {
        if group != 0 {
            self.groups.resize(self.indices.len() / 3, 0);
            self.groups.push(group);
        }
        self.indices.extend(corners.map(|corner| self.corners.number(corner)));
    }

    /// The part. Smoothing groups count where the file speaks of them and gives no normals.
    pub(super) fn into_part(
        self,
        path: &Path,
        vertices: &Vertices,
        material: Option<usize>,
        has_groups: bool,
        warnings: &mut Vec<String>,
    ) -> Result<Part, LoadError> {
        let Self { name, corners, indices, groups, .. } = self;
        let keys = corners.into_keys();
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
        // Where there is none, zero stands for one that is to be computed.
        let normals = has_normals.then(|| picked(&keys, 2, &vertices.normals, Vec3::ZERO));
        let colors = (!vertices.colors.is_empty()).then(|| {
            let color = |key: &[u32; 3]| vertices.colors.get(key[0] as usize - 1).unwrap_or(&Vec3::ONE).extend(1.0);
            keys.iter().map(color).collect()
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
        if has_groups && !has_normals {
            (mesh, _) = grouped_normals(&mesh, &groups, NormalWeighting::default());
        }
        Ok(Part { name, mesh, material, world_from_part: Mat4::IDENTITY })
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
