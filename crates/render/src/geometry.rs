//! Meshes on the GPU: shared vertices for smooth shading, one vertex a triangle for flat.

use crate::error::RenderError;
use crate::gpu::Gpu;
use crate::matrices::Visible;
use crate::report::FrameReport;
use crate::terms::Chosen;
use bevy_asset::{AssetEvent, AssetId, Assets};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use halfway_mesh::{Mesh, Mesh3d, face_normal};
use std::collections::HashMap;
use wgpu::util::DeviceExt;

/// The buffers of one mesh for one way of shading.
pub(crate) struct Geometry {
    pub(crate) positions: wgpu::Buffer,
    /// Smooth: normals. Flat: face normal and centroid of the triangle whose provoking vertex this is.
    pub(crate) attributes: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    pub(crate) index_format: wgpu::IndexFormat,
    pub(crate) index_count: u32,
    /// What it was made of; a mesh is immutable and shares its data, so the same data is the same mesh.
    source: Mesh,
    /// Some interpolated normal may vanish, so that Phong shading needs the geometric one at hand.
    pub(crate) opposite_normals: bool,
}

/// All meshes that have been drawn, until their assets change or go.
#[derive(Resource, Default)]
pub(crate) struct Geometries {
    meshes: HashMap<(AssetId<Mesh>, bool), Geometry>,
}

impl Geometries {
    pub(crate) fn get(&self, id: AssetId<Mesh>, flat: bool) -> Option<&Geometry> {
        self.meshes.get(&(id, flat))
    }

    /// Uploads the mesh unless it is there. Returns the bytes sent.
    pub(crate) fn ensure(&mut self, gpu: &Gpu, id: AssetId<Mesh>, mesh: &Mesh, flat: bool) -> Result<u64, RenderError> {
        if self.meshes.get(&(id, flat)).is_some_and(|geometry| is_same(&geometry.source, mesh)) {
            return Ok(0);
        }
        let geometry = if flat { upload_flat(gpu, mesh)? } else { upload_smooth(gpu, mesh)? };
        let bytes = geometry.positions.size() + geometry.attributes.size() + geometry.indices.size();
        self.meshes.insert((id, flat), geometry);
        Ok(bytes)
    }
}

/// Uploads the meshes of visible objects that are not there yet, for the way they are shaded.
pub(crate) fn upload_visible(
    gpu: Res<Gpu>,
    meshes: Res<Assets<Mesh>>,
    objects: Query<(&Mesh3d, &Chosen)>,
    visible: Res<Visible>,
    mut geometries: ResMut<Geometries>,
    mut report: ResMut<FrameReport>,
) {
    for (Mesh3d(handle), chosen) in objects.iter_many(&visible.0).flatten() {
        let Some(mesh) = meshes.get(handle) else { continue };
        match geometries.ensure(&gpu, handle.id(), mesh, chosen.flat) {
            Ok(bytes) => report.bytes_uploaded += bytes,
            Err(error) => report.errors.push(error),
        }
    }
}

/// Whether two meshes are clones of each other.
fn is_same(a: &Mesh, b: &Mesh) -> bool {
    a.positions().as_ptr() == b.positions().as_ptr()
        && a.normals().as_ptr() == b.normals().as_ptr()
        && a.indices().as_ptr() == b.indices().as_ptr()
}

/// Forgets meshes that are gone. Those that changed are found when they are drawn, which needs no event.
pub(crate) fn forget_removed(mut events: MessageReader<AssetEvent<Mesh>>, mut geometries: ResMut<Geometries>) {
    for event in events.read() {
        if let AssetEvent::Removed { id } | AssetEvent::Unused { id } = event {
            geometries.meshes.remove(&(*id, true));
            geometries.meshes.remove(&(*id, false));
        }
    }
}

fn upload_smooth(gpu: &Gpu, mesh: &Mesh) -> Result<Geometry, RenderError> {
    let positions: Vec<[f32; 3]> = mesh.positions().iter().map(Vec3::to_array).collect();
    let normals: Vec<[f32; 3]> = mesh.normals().iter().map(Vec3::to_array).collect();
    let opposite_normals = has_opposite_normals(mesh);
    upload(gpu, mesh, &positions, bytemuck::cast_slice(&normals), mesh.indices(), opposite_normals)
}

fn upload_flat(gpu: &Gpu, mesh: &Mesh) -> Result<Geometry, RenderError> {
    let flat = FlatMesh::new(mesh);
    upload(gpu, mesh, &flat.positions, bytemuck::cast_slice(&flat.attributes), &flat.indices, false)
}

fn upload(
    gpu: &Gpu,
    source: &Mesh,
    positions: &[[f32; 3]],
    attributes: &[u8],
    indices: &[u32],
    opposite_normals: bool,
) -> Result<Geometry, RenderError> {
    let buffer = |label, contents: &[u8], usage| {
        let (needed, limit) = (contents.len() as u64, gpu.device.limits().max_buffer_size);
        if needed > limit {
            return Err(RenderError::TooLarge { what: format!("the mesh's {label}, in bytes,"), needed, limit });
        }
        Ok(gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage }))
    };
    let short = positions.len() < usize::from(u16::MAX);
    let (index_bytes, index_format) = if short {
        let short: Vec<u16> = indices.iter().map(|&index| index as u16).collect();
        (bytemuck::pod_collect_to_vec::<u16, u8>(&short), wgpu::IndexFormat::Uint16)
    } else {
        (bytemuck::pod_collect_to_vec::<u32, u8>(indices), wgpu::IndexFormat::Uint32)
    };
    // A buffer's size is a multiple of 4; an odd count of u16 is padded.
    let mut index_bytes = index_bytes;
    index_bytes.resize(index_bytes.len().next_multiple_of(4), 0);
    Ok(Geometry {
        positions: buffer("positions", bytemuck::cast_slice(positions), wgpu::BufferUsages::VERTEX)?,
        attributes: buffer("attributes", attributes, wgpu::BufferUsages::VERTEX)?,
        indices: buffer("indices", &index_bytes, wgpu::BufferUsages::INDEX)?,
        index_format,
        index_count: indices.len() as u32,
        source: source.clone(),
        opposite_normals,
    })
}

/// Whether any triangle's normals can cancel under interpolation. While all pairs of the three have
/// `n_i·n_j ≥ −0.49`, `|Σ b_i n_i|² ≥ Σ b_i² − 0.98 Σ b_i b_j ≥ 0.0066` everywhere on the triangle.
fn has_opposite_normals(mesh: &Mesh) -> bool {
    let normals = mesh.normals();
    mesh.triangles().any(|triangle| {
        let [a, b, c] = triangle.map(|index| normals[index as usize]);
        a.dot(b).min(b.dot(c)).min(c.dot(a)) < -0.49
    })
}

/// A mesh whose every triangle has a vertex of its own in first place: that provoking vertex carries
/// the triangle's face normal and centroid, and so its one shade. Triangles keep their order and
/// winding; they are rotated, and vertices repeated, so that each has one.
struct FlatMesh {
    positions: Vec<[f32; 3]>,
    /// Face normal, centroid.
    attributes: Vec<[[f32; 3]; 2]>,
    indices: Vec<u32>,
    /// Whether a vertex provokes a triangle already.
    taken: Vec<bool>,
}

/// After so many triangles an adapter has forgotten a vertex and shades it anew. One that is taken is
/// then better repeated: the new one can provoke another triangle, and costs no more than the old.
const VERTEX_MEMORY: usize = 256;

impl FlatMesh {
    fn new(mesh: &Mesh) -> Self {
        let corners = mesh.positions();
        let mut flat = Self {
            positions: corners.iter().map(Vec3::to_array).collect(),
            attributes: vec![[[0.0; 3]; 2]; corners.len()],
            indices: Vec::with_capacity(mesh.indices().len()),
            taken: vec![false; corners.len()],
        };
        // Of each vertex of the mesh: the copy in use, and the triangle that used it last.
        let mut copies: Vec<(u32, usize)> = (0..corners.len() as u32).map(|vertex| (vertex, 0)).collect();
        for (triangle, vertices) in mesh.triangles().enumerate() {
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
            flat.indices.extend(used);
        }
        flat
    }

    fn repeat(&mut self, vertex: u32) -> u32 {
        self.positions.push(self.positions[vertex as usize]);
        self.attributes.push([[0.0; 3]; 2]);
        self.taken.push(false);
        self.positions.len() as u32 - 1
    }
}

/// Face normal and centroid. A degenerate triangle covers no pixel; any normal will do.
fn shaded_point([a, b, c]: [Vec3; 3]) -> [[f32; 3]; 2] {
    let normal = face_normal(a, b, c).unwrap_or(Vec3::ZERO);
    let centroid = (a.as_dvec3() + b.as_dvec3() + c.as_dvec3()) / 3.0;
    [normal.to_array(), centroid.as_vec3().to_array()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use halfway_mesh::UvSphere;
    use std::collections::HashSet;

    #[test]
    fn every_flat_triangle_has_its_own_provoking_vertex_and_keeps_its_corners() {
        let mesh = Mesh::from(UvSphere { radius: 1.0, segments: 16, rings: 8 });
        let flat = FlatMesh::new(&mesh);
        let mut provoking = HashSet::new();
        for (corners, triangle) in flat.indices.chunks_exact(3).zip(mesh.triangles()) {
            assert!(provoking.insert(corners[0]), "vertex {} provokes two triangles", corners[0]);
            let mut flat_corners: Vec<_> =
                corners.iter().map(|&i| flat.positions[i as usize].map(f32::to_bits)).collect();
            let mut mesh_corners: Vec<_> =
                triangle.iter().map(|&i| mesh.positions()[i as usize].to_array().map(f32::to_bits)).collect();
            flat_corners.sort_unstable();
            mesh_corners.sort_unstable();
            assert_eq!(flat_corners, mesh_corners);
            let [p0, p1, p2] = [0, 1, 2].map(|i| Vec3::from_array(flat.positions[corners[i] as usize]));
            let [normal, _] = flat.attributes[corners[0] as usize].map(Vec3::from_array);
            assert!((p1 - p0).cross(p2 - p0).dot(normal) > 0.0, "the winding turned over");
        }
        // Each repeated vertex stands for a taken one, and each triangle takes one.
        assert!(flat.positions.len() <= mesh.triangle_count() + mesh.positions().len());
    }

    #[test]
    fn a_grid_larger_than_the_vertex_memory_needs_one_vertex_a_triangle() {
        // 512 quads a row: the upper row of vertices of each row of quads has been forgotten by then.
        let mesh = Mesh::from(UvSphere { radius: 1.0, segments: 512, rings: 16 });
        let flat = FlatMesh::new(&mesh);
        assert!(flat.positions.len() <= mesh.triangle_count() + 2 * 513, "{} vertices", flat.positions.len());
    }
}
