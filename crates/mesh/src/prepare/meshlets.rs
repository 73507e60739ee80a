//! Meshlets: patches of neighbouring triangles.

use std::ops::Range;

use bevy_math::Vec3;
use meshopt::VertexDataAdapter;

use super::enclose::{BoundingSphere, DirectionCone};
use crate::{Mesh, face_normal};

/// A mesh cut into patches of neighbouring triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Meshlets {
    /// The mesh with the triangles of each meshlet in a row and its vertices in the order of their use; those of no
    /// triangle are left out.
    pub mesh: Mesh,
    /// The meshlets, which hold every triangle once, in the order of the triangles.
    pub meshlets: Vec<Meshlet>,
}

/// A patch of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Meshlet {
    /// Its triangles; its indices are three times as many, from three times the start.
    pub triangles: Range<u32>,
    /// Holds the positions of its vertices, and so its triangles.
    pub sphere: BoundingSphere,
    /// Holds the normals of its vertices, and, if narrower than a half-space, the interpolated ones between them.
    pub normals: DirectionCone,
    /// Holds the normals of its triangles that have one.
    pub faces: DirectionCone,
}

impl Meshlets {
    /// The most triangles of a meshlet, unless asked otherwise.
    pub const DEFAULT_TRIANGLES: u32 = 128;

    /// The most vertices of a meshlet.
    const VERTICES: usize = 256;
    /// How much facing alike counts against being round, from 0 to 1.
    const CONE_WEIGHT: f32 = 0.5;
}

impl Mesh {
    /// The mesh in meshlets of at most `triangles` triangles (taken into 4 … 512 and down to a multiple of 4) and 256
    /// vertices, round and facing alike as far as may be; by meshoptimizer. [`Meshlets::DEFAULT_TRIANGLES`] is a good
    /// number.
    pub fn meshlets(&self, triangles: u32) -> Meshlets {
        let built = self.cut(triangles.clamp(4, 512) as usize & !3);
        let mut indices = Vec::with_capacity(self.indices().len());
        let mut ranges = Vec::with_capacity(built.len());
        for meshlet in built.iter() {
            let start = indices.len() as u32 / 3;
            indices.extend(meshlet.triangles.iter().map(|&local| meshlet.vertices[local as usize]));
            ranges.push(start..indices.len() as u32 / 3);
        }
        let mesh = self.in_order_of_use(&indices);
        let meshlets = ranges.into_iter().map(|range| mesh.meshlet(range)).collect();
        Meshlets { mesh, meshlets }
    }

    /// Meshlets of at most N triangles, a number that meshoptimizer allows.
    fn cut(&self, triangles: usize) -> meshopt::Meshlets {
        let indices = meshopt::optimize_vertex_cache(self.indices(), self.positions().len());
        let positions = self.unit_positions().0;
        let vertices = VertexDataAdapter::new(meshopt::typed_to_bytes(&positions), size_of::<[f32; 3]>(), 0)
            .expect("positions are whole and begin with their first byte");
        meshopt::build_meshlets(&indices, &vertices, Meshlets::VERTICES, triangles, Meshlets::CONE_WEIGHT)
    }

    fn meshlet(&self, triangles: Range<u32>) -> Meshlet {
        let corners = &self.indices()[3 * triangles.start as usize..3 * triangles.end as usize];
        let mut vertices = corners.to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        let of = |all: &[Vec3]| -> Vec<Vec3> { vertices.iter().map(|&vertex| all[vertex as usize]).collect() };
        let face = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|i| self.positions()[i as usize]);
            face_normal(a, b, c)
        };
        let faces: Vec<Vec3> = corners.as_chunks::<3>().0.iter().filter_map(face).collect();
        Meshlet {
            triangles,
            sphere: BoundingSphere::around(&of(self.positions())),
            normals: DirectionCone::around(&of(self.normals())),
            faces: DirectionCone::around(&faces),
        }
    }
}
