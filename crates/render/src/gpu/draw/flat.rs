//! Meshes for flat shading: one vertex of each triangle carries its colour.

use bevy_math::{Vec3, Vec4};
use halfway_mesh::face_normal;

/// A mesh in which each triangle starts with a vertex of its own: that provoking vertex carries the triangle's face
/// normal and centroid. Triangles keep their order and winding; they are rotated, and vertices duplicated, so that each
/// has one.
pub(crate) struct FlatMesh {
    pub(crate) positions: Vec<Vec3>,
    /// Face normal, centroid.
    pub(crate) attributes: Vec<[Vec3; 2]>,
    /// The mean color of its triangle's corners for each provoking vertex, if they have colors.
    pub(crate) colors: Option<Vec<Vec4>>,
    /// The texture coordinates of each vertex, if they have any.
    pub(crate) uvs: Option<Vec<Vec4>>,
    pub(crate) indices: Vec<u32>,
    /// Whether a vertex is already the provoking one of a triangle.
    taken: Vec<bool>,
}

/// After N triangles a vertex has left an adapter's vertex cache, and is shaded again. A vertex that is already a
/// provoking one is then better duplicated: the copy can provoke another triangle, and costs no more.
const VERTEX_MEMORY: usize = 256;

impl FlatMesh {
    pub(crate) fn new(
        (corners, colors, uvs): (&[Vec3], Option<&[Vec4]>, Option<&[Vec4]>),
        triangles: &[[u32; 3]],
    ) -> Self {
        let mut flat = Self {
            positions: corners.to_vec(),
            attributes: vec![[Vec3::ZERO; 2]; corners.len()],
            colors: colors.map(<[Vec4]>::to_vec),
            uvs: uvs.map(<[Vec4]>::to_vec),
            indices: Vec::with_capacity(3 * triangles.len()),
            taken: vec![false; corners.len()],
        };
        // For each vertex of the mesh: the current copy, and the triangle that used it last.
        let mut copies: Vec<(u32, usize)> = (0..corners.len() as u32).map(|vertex| (vertex, 0)).collect();
        for (triangle, &vertices) in triangles.iter().enumerate() {
            let mut used = vertices.map(|vertex| {
                let (copy, last) = &mut copies[vertex as usize];
                if flat.taken[*copy as usize] && triangle - *last > VERTEX_MEMORY {
                    *copy = flat.repeat(*copy);
                }
                *last = triangle;
                *copy
            });
            let free = used.iter().position(|&copy| !flat.taken[copy as usize]).unwrap_or_else(|| {
                let copy = flat.repeat(used[0]);
                copies[vertices[0] as usize].0 = copy;
                used[0] = copy;
                0
            });
            used.rotate_left(free);
            let provoking = used[0] as usize;
            flat.taken[provoking] = true;
            flat.attributes[provoking] = shaded_point(vertices.map(|vertex| corners[vertex as usize]));
            if let (Some(means), Some(colors)) = (&mut flat.colors, colors) {
                let [a, b, c] = vertices.map(|vertex| colors[vertex as usize]);
                means[provoking] = (a + b + c) / 3.0;
            }
            flat.indices.extend(used);
        }
        flat
    }

    fn repeat(&mut self, vertex: u32) -> u32 {
        self.positions.push(self.positions[vertex as usize]);
        self.attributes.push([Vec3::ZERO; 2]);
        if let Some(colors) = &mut self.colors {
            colors.push(Vec4::ONE);
        }
        if let Some(uvs) = &mut self.uvs {
            uvs.push(uvs[vertex as usize]);
        }
        self.taken.push(false);
        self.positions.len() as u32 - 1
    }
}

/// Face normal and centroid. A degenerate triangle covers no pixel; any normal will do.
fn shaded_point([a, b, c]: [Vec3; 3]) -> [Vec3; 2] {
    let normal = face_normal(a, b, c).unwrap_or(Vec3::ZERO);
    let centroid = (a.as_dvec3() + b.as_dvec3() + c.as_dvec3()) / 3.0;
    [normal, centroid.as_vec3()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use halfway_mesh::{Mesh, UvSphere};
    use std::collections::HashSet;

    #[test]
    fn every_flat_triangle_has_its_own_provoking_vertex() {
        let mesh = Mesh::from(UvSphere { radius: 1.0, segments: 16, rings: 8 });
        let flat = FlatMesh::new((mesh.positions(), None, None), mesh.indices().as_chunks().0);
        let mut provoking = HashSet::new();
        for (corners, triangle) in flat.indices.chunks_exact(3).zip(mesh.triangles()) {
            assert!(provoking.insert(corners[0]), "vertex {} provokes two triangles", corners[0]);
            let mut flat_corners: Vec<_> =
                corners.iter().map(|&i| flat.positions[i as usize].to_array().map(f32::to_bits)).collect();
            let mut mesh_corners: Vec<_> =
                triangle.iter().map(|&i| mesh.positions()[i as usize].to_array().map(f32::to_bits)).collect();
            flat_corners.sort_unstable();
            mesh_corners.sort_unstable();
            assert_eq!(flat_corners, mesh_corners);
            let [p0, p1, p2] = [0, 1, 2].map(|i| flat.positions[corners[i] as usize]);
            let [normal, _] = flat.attributes[corners[0] as usize];
            assert!((p1 - p0).cross(p2 - p0).dot(normal) > 0.0, "the winding turned over");
        }
        // Each duplicate replaces a taken vertex, and each triangle takes one.
        assert!(flat.positions.len() <= mesh.triangle_count() + mesh.positions().len());
    }

    #[test]
    fn a_large_grid_needs_one_vertex_a_triangle() {
        // 512 quads a row: the upper row of vertices of each row of quads has been forgotten by then.
        let mesh = Mesh::from(UvSphere { radius: 1.0, segments: 512, rings: 16 });
        let flat = FlatMesh::new((mesh.positions(), None, None), mesh.indices().as_chunks().0);
        assert!(flat.positions.len() <= mesh.triangle_count() + 2 * 513, "{} vertices", flat.positions.len());
    }
}
