//! Meshes on the GPU: shared vertices for smooth shading, one vertex a triangle for flat.

use crate::batch::terms::Chosen;
use crate::device::gpu::Gpu;
use crate::error::RenderError;
use crate::frame::report::FrameReport;
use crate::geometry::detail::{Detail, LevelsOfDetail, Triangles};
use crate::geometry::flat::FlatMesh;
use crate::geometry::workshop::Workshop;
use crate::view::matrices::Visible;
use bevy_asset::{AssetEvent, AssetId, Assets};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use halfway_lighting::Blend;
use halfway_mesh::{Mesh, Mesh3d};
use std::collections::HashMap;
use std::sync::Arc;
use wgpu::util::DeviceExt;

/// The buffers of one mesh for one way of shading.
pub(crate) struct Geometry {
    pub(crate) positions: wgpu::Buffer,
    /// Smooth: normals. Flat: face normal and centroid of the triangle whose provoking vertex this is.
    pub(crate) attributes: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    pub(crate) index_format: wgpu::IndexFormat,
    /// The runs of its triangles.
    pub(crate) detail: Arc<Detail>,
    /// What it was made of; a mesh is immutable and shares its data, so the same data is the same mesh.
    pub(crate) source: Mesh,
    /// Some interpolated normal may vanish, so that Phong shading needs the geometric one at hand.
    pub(crate) opposite_normals: bool,
}

/// How a mesh is laid out for drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Form {
    /// For flat shading.
    pub(crate) flat: bool,
    /// In one piece, with the triangles in the order of the mesh. Else in patches, in the patches' order.
    pub(crate) ordered: bool,
}

impl Form {
    pub(crate) const ALL: [Self; 4] = [
        Self { flat: false, ordered: false },
        Self { flat: false, ordered: true },
        Self { flat: true, ordered: false },
        Self { flat: true, ordered: true },
    ];

    /// Blended triangles are drawn in the order of the mesh.
    pub(crate) fn new(chosen: Chosen, blend: bool) -> Self {
        Self { flat: chosen.flat, ordered: blend }
    }
}

/// All meshes that have been drawn, until their assets change or go.
#[derive(Resource, Default)]
pub(crate) struct Geometries {
    meshes: HashMap<(AssetId<Mesh>, Form), Geometry>,
}

impl Geometries {
    pub(crate) fn get(&self, id: AssetId<Mesh>, form: Form) -> Option<&Geometry> {
        self.meshes.get(&(id, form))
    }

    /// Uploads the mesh unless it is there, and its levels of detail once they are. Returns the bytes sent.
    fn ensure(
        &mut self,
        gpu: &Gpu,
        (id, form): (AssetId<Mesh>, Form),
        mesh: &Mesh,
        levels: Option<&Triangles>,
    ) -> Result<u64, RenderError> {
        let there = self.meshes.get(&(id, form)).filter(|geometry| is_same(&geometry.source, mesh));
        if there.is_some_and(|there| levels.is_none_or(|levels| Arc::ptr_eq(&levels.detail, &there.detail))) {
            return Ok(0);
        }
        let finest;
        let triangles = if let Some(levels) = levels {
            levels
        } else {
            finest = if form.ordered { Triangles::in_order(mesh) } else { Triangles::in_patches(mesh) };
            &finest
        };
        let (geometry, bytes) = match there {
            // The vertices of levels are those of the mesh.
            Some(there) if !form.flat => Geometry::with_vertices_of(there, gpu, triangles)?,
            _ if form.flat => Geometry::flat(gpu, mesh, triangles)?,
            _ => Geometry::smooth(gpu, mesh, triangles)?,
        };
        self.meshes.insert((id, form), geometry);
        Ok(bytes)
    }
}

/// Uploads the meshes of visible objects that are not there yet, for the way they are shaded.
#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn upload_visible(
    gpu: Res<Gpu>,
    meshes: Res<Assets<Mesh>>,
    objects: Query<(&Mesh3d, &Chosen, Has<Blend>)>,
    visible: Res<Visible>,
    allowed: Res<LevelsOfDetail>,
    mut workshop: ResMut<Workshop>,
    mut geometries: ResMut<Geometries>,
    mut report: ResMut<FrameReport>,
) {
    workshop.collect();
    let mut last = None;
    for (Mesh3d(handle), chosen, blend) in objects.iter_many(&visible.0).flatten() {
        let wanted = (handle.id(), Form::new(*chosen, blend));
        if last.replace(wanted) == Some(wanted) {
            continue;
        }
        let Some(mesh) = meshes.get(handle) else { continue };
        let levels =
            if wanted.1.ordered || *allowed == LevelsOfDetail::OFF { None } else { workshop.levels(wanted.0, mesh) };
        match geometries.ensure(&gpu, wanted, mesh, levels) {
            Ok(bytes) => report.bytes_uploaded += bytes,
            Err(error) => report.errors.push(error),
        }
    }
    report.levels_pending = workshop.pending();
}

/// Whether two meshes are clones of each other.
pub(crate) fn is_same(a: &Mesh, b: &Mesh) -> bool {
    a.positions().as_ptr() == b.positions().as_ptr()
        && a.normals().as_ptr() == b.normals().as_ptr()
        && a.indices().as_ptr() == b.indices().as_ptr()
}

/// Forgets meshes that are gone. Those that changed are found when they are drawn, which needs no event.
pub(crate) fn forget_removed(
    mut events: MessageReader<AssetEvent<Mesh>>,
    mut geometries: ResMut<Geometries>,
    mut workshop: ResMut<Workshop>,
) {
    for event in events.read() {
        if let AssetEvent::Removed { id } | AssetEvent::Unused { id } = event {
            workshop.forget(*id);
            for form in Form::ALL {
                geometries.meshes.remove(&(*id, form));
            }
        }
    }
}

impl Geometry {
    fn smooth(gpu: &Gpu, mesh: &Mesh, triangles: &Triangles) -> Result<(Self, u64), RenderError> {
        let vertices = Vertices { positions: mesh.positions(), attributes: bytemuck::cast_slice(mesh.normals()) };
        let opposite_normals = has_opposite_normals(mesh);
        vertices.upload(gpu, mesh, (triangles.corners.as_flattened(), &triangles.detail), opposite_normals)
    }

    fn flat(gpu: &Gpu, mesh: &Mesh, triangles: &Triangles) -> Result<(Self, u64), RenderError> {
        let flat = FlatMesh::new(mesh.positions(), &triangles.corners);
        let vertices = Vertices { positions: &flat.positions, attributes: bytemuck::cast_slice(&flat.attributes) };
        vertices.upload(gpu, mesh, (&flat.indices, &triangles.detail), false)
    }

    fn with_vertices_of(there: &Self, gpu: &Gpu, triangles: &Triangles) -> Result<(Self, u64), RenderError> {
        let indices = index_buffer(gpu, triangles.corners.as_flattened(), there.index_format)?;
        let bytes = indices.size();
        let geometry = Self {
            positions: there.positions.clone(),
            attributes: there.attributes.clone(),
            indices,
            index_format: there.index_format,
            opposite_normals: there.opposite_normals,
            source: there.source.clone(),
            detail: Arc::clone(&triangles.detail),
        };
        Ok((geometry, bytes))
    }
}

/// What is stored for each vertex.
struct Vertices<'a> {
    positions: &'a [Vec3],
    attributes: &'a [u8],
}

impl Vertices<'_> {
    fn upload(
        &self,
        gpu: &Gpu,
        source: &Mesh,
        (indices, detail): (&[u32], &Arc<Detail>),
        opposite_normals: bool,
    ) -> Result<(Geometry, u64), RenderError> {
        let short = self.positions.len() < usize::from(u16::MAX);
        let index_format = if short { wgpu::IndexFormat::Uint16 } else { wgpu::IndexFormat::Uint32 };
        let geometry = Geometry {
            positions: buffer(gpu, "positions", bytemuck::cast_slice(self.positions), wgpu::BufferUsages::VERTEX)?,
            attributes: buffer(gpu, "attributes", self.attributes, wgpu::BufferUsages::VERTEX)?,
            indices: index_buffer(gpu, indices, index_format)?,
            index_format,
            detail: Arc::clone(detail),
            source: source.clone(),
            opposite_normals,
        };
        let bytes = geometry.positions.size() + geometry.attributes.size() + geometry.indices.size();
        Ok((geometry, bytes))
    }
}

fn index_buffer(gpu: &Gpu, indices: &[u32], format: wgpu::IndexFormat) -> Result<wgpu::Buffer, RenderError> {
    if format == wgpu::IndexFormat::Uint32 {
        return buffer(gpu, "indices", bytemuck::cast_slice(indices), wgpu::BufferUsages::INDEX);
    }
    let mut short: Vec<u16> = indices.iter().map(|&index| index as u16).collect();
    // A buffer's size is a multiple of 4; an odd count is padded.
    short.resize(short.len().next_multiple_of(2), 0);
    buffer(gpu, "indices", bytemuck::cast_slice(&short), wgpu::BufferUsages::INDEX)
}

fn buffer(gpu: &Gpu, label: &str, contents: &[u8], usage: wgpu::BufferUsages) -> Result<wgpu::Buffer, RenderError> {
    let (needed, limit) = (contents.len() as u64, gpu.device.limits().max_buffer_size);
    if needed > limit {
        return Err(RenderError::TooLarge { what: format!("the mesh's {label}, in bytes,"), needed, limit });
    }
    // What cannot be mapped is written to a second buffer of its size, which is kept until the frame is done.
    let usage = if gpu.shares_memory() { usage | wgpu::BufferUsages::MAP_WRITE } else { usage };
    Ok(gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage }))
}

/// Whether any triangle's normals can cancel under interpolation; those of coarser levels, which do so only where a
/// triangle is smaller than a pixel, are not looked at. While all pairs of the three have
/// `n_i·n_j ≥ −0.49`, `|Σ b_i n_i|² ≥ Σ b_i² − 0.98 Σ b_i b_j ≥ 0.0066` everywhere on the triangle.
fn has_opposite_normals(mesh: &Mesh) -> bool {
    let normals = mesh.normals();
    mesh.triangles().any(|triangle| {
        let [a, b, c] = triangle.map(|index| normals[index as usize]);
        a.dot(b).min(b.dot(c)).min(c.dot(a)) < -0.49
    })
}
