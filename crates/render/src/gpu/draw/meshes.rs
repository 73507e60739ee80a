//! The set Upload: uploads meshes.

use crate::gpu::device::Gpu;
use crate::gpu::draw::flat::FlatMesh;
use bevy_ecs::prelude::*;
use bevy_math::{Vec3, Vec4};
use halfway_asset::AssetId;
use halfway_frame::batch::batches::Batches;
use halfway_frame::batch::drawn_meshes::{Before, DrawnMeshes};
use halfway_frame::error::RenderError;
use halfway_frame::geometry::meshes::{Form, Geometries, both_uvs};
use halfway_frame::report::FrameReport;
use halfway_mesh::Mesh;

/// The buffers of the drawn meshes, until they change or are removed.
#[derive(Resource, Default)]
pub(crate) struct MeshBuffers(DrawnMeshes<MeshBuffer>);

/// The buffers of one mesh for one way of shading.
pub(crate) struct MeshBuffer {
    pub(crate) positions: wgpu::Buffer,
    /// Smooth: normals. Flat: face normal and centroid of the triangle whose provoking vertex this is.
    pub(crate) attributes: wgpu::Buffer,
    /// The colors, if they are drawn; flat: that of the centroid, as above.
    pub(crate) colors: Option<wgpu::Buffer>,
    /// Texture coordinates of both sets, if images are drawn.
    pub(crate) uvs: Option<wgpu::Buffer>,
    /// The tangents, if there is a normal map.
    pub(crate) tangents: Option<wgpu::Buffer>,
    pub(crate) indices: wgpu::Buffer,
    pub(crate) index_format: wgpu::IndexFormat,
}

/// Uploads the parts of drawn meshes that are missing on the GPU. A mesh that is too large is not drawn, and its error
/// is in the report of every frame.
pub(crate) fn upload(
    gpu: Res<Gpu>,
    batches: Res<Batches>,
    mut geometries: ResMut<Geometries>,
    mut buffers: ResMut<MeshBuffers>,
    mut report: ResMut<FrameReport>,
) {
    buffers.0.make_ready(&batches, &mut geometries, &mut report, |geometry, indices, form, before| {
        let source = &geometry.drawn;
        // Draws with images have colors, white if the mesh has none.
        let white = || vec![Vec4::ONE; source.positions().len()];
        let colors = source.drawn_colors().filter(|_| form.colored).or_else(|| form.mapped.then(white));
        let uvs = form.mapped.then(|| both_uvs(source));
        let tangents = source.tangents().filter(|_| form.tangents.is_some());
        match before {
            _ if form.flat => {
                let vertices = (source.positions(), colors.as_deref(), uvs.as_deref());
                let mut flat = FlatMesh::new(vertices, indices.as_chunks().0);
                gpu.provoking_vertex().place(&mut flat.indices);
                let attributes = bytemuck::cast_slice(&flat.attributes);
                let vertices = (&flat.positions[..], attributes, flat.colors.as_deref(), flat.uvs.as_deref(), None);
                MeshBuffer::new(&gpu, vertices, Indices::New(&flat.indices))
            }
            // The vertices of levels are those of the mesh.
            Before::SameVertices(before) => before.with_indices(&gpu, indices),
            before => {
                let attributes = bytemuck::cast_slice(source.normals());
                let vertices = (source.positions(), attributes, colors.as_deref(), uvs.as_deref(), tangents);
                let indices = match before {
                    Before::SameTriangles(before) => Indices::Kept(before.indices),
                    _ => Indices::New(indices),
                };
                MeshBuffer::new(&gpu, vertices, indices)
            }
        }
    });
}

/// Positions, attributes, colors, texture coordinates and tangents.
type VertexSlices<'a> = (&'a [Vec3], &'a [u8], Option<&'a [Vec4]>, Option<&'a [Vec4]>, Option<&'a [Vec4]>);

/// The triangles of a mesh.
enum Indices<'a> {
    New(&'a [u32]),
    /// Those of the same mesh before its vertices moved.
    Kept(wgpu::Buffer),
}

impl MeshBuffers {
    pub(crate) fn get(&self, id: AssetId<Mesh>, form: Form) -> Option<&MeshBuffer> {
        self.0.get(id, form)
    }

    #[cfg(test)]
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }
}

impl MeshBuffer {
    fn new(
        gpu: &Gpu,
        (positions, attributes, colors, uvs, tangents): VertexSlices,
        indices: Indices,
    ) -> Result<(Self, u64), RenderError> {
        let list = |label, bytes: &[u8]| buffer(gpu, label, bytes, wgpu::BufferUsages::VERTEX);
        let colors = colors.map(|colors| list("colors", bytemuck::cast_slice(colors)));
        let uvs = uvs.map(|uvs| list("texture coordinates", bytemuck::cast_slice(uvs)));
        let tangents = tangents.map(|tangents| list("tangents", bytemuck::cast_slice(tangents)));
        let short = positions.len() < usize::from(u16::MAX);
        let index_format = if short { wgpu::IndexFormat::Uint16 } else { wgpu::IndexFormat::Uint32 };
        let (indices, sent) = match indices {
            Indices::New(indices) => {
                let indices = index_buffer(gpu, indices, index_format)?;
                let sent = indices.size();
                (indices, sent)
            }
            Indices::Kept(indices) => (indices, 0),
        };
        let buffers = Self {
            positions: buffer(gpu, "positions", bytemuck::cast_slice(positions), wgpu::BufferUsages::VERTEX)?,
            attributes: buffer(gpu, "attributes", attributes, wgpu::BufferUsages::VERTEX)?,
            colors: colors.transpose()?,
            uvs: uvs.transpose()?,
            tangents: tangents.transpose()?,
            indices,
            index_format,
        };
        let more =
            buffers.colors.iter().chain(&buffers.uvs).chain(&buffers.tangents).map(wgpu::Buffer::size).sum::<u64>();
        let bytes = buffers.positions.size() + buffers.attributes.size() + more + sent;
        Ok((buffers, bytes))
    }

    /// The same vertices, and other triangles.
    fn with_indices(&self, gpu: &Gpu, indices: &[u32]) -> Result<(Self, u64), RenderError> {
        let indices = index_buffer(gpu, indices, self.index_format)?;
        let bytes = indices.size();
        let buffers = Self {
            positions: self.positions.clone(),
            attributes: self.attributes.clone(),
            colors: self.colors.clone(),
            uvs: self.uvs.clone(),
            tangents: self.tangents.clone(),
            indices,
            index_format: self.index_format,
        };
        Ok((buffers, bytes))
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
    let size = needed.max(1).next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT);
    let descriptor = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: true };
    let buffer = gpu.device.create_buffer(&descriptor);
    // A lost device maps no memory.
    let mut mapped = buffer
        .get_mapped_range_mut(..)
        .map_err(|error| RenderError::Device(format!("the mesh's {label} could not be sent ({error})")))?;
    mapped.slice(..contents.len()).copy_from_slice(contents);
    drop(mapped);
    buffer.unmap();
    Ok(buffer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::headless::Headless;
    use crate::plugin::RenderPlugin;
    use bevy_app::App;
    use bevy_ecs::schedule::ScheduleLabel;
    use bevy_math::UVec2;
    use bevy_transform::TransformPlugin;
    use bevy_transform::components::Transform;
    use halfway_asset::Assets;
    use halfway_frame::geometry::workshop::Workshop;
    use halfway_lighting::{Camera, Material, Shading, Tolerance, ViewTolerance};
    use halfway_mesh::{Mesh3d, UvSphere};

    #[derive(ScheduleLabel, Clone, Copy, Debug, PartialEq, Eq, Hash)]
    struct Seldom;

    /// The numbers of meshes that the renderer keeps laid out, in buffers, and with levels of detail.
    fn kept(app: &App) -> [usize; 3] {
        let world = app.world();
        let levels = world.resource::<Workshop>().len();
        [world.resource::<Geometries>().len(), world.resource::<MeshBuffers>().len(), levels]
    }

    /// Draws ten meshes after each other, `updates` of the App between, each of which stays for one frame or more.
    fn most_kept(updates: usize, frames: usize) -> [usize; 3] {
        let mut app = App::new();
        app.add_plugins((TransformPlugin, RenderPlugin { schedule: Seldom.intern() }));
        app.init_schedule(Seldom).insert_resource(Headless { size: UVec2::splat(4), ..Headless::default() });
        app.insert_resource(ViewTolerance(Tolerance { steps: 0.0, pixels: 1.0 }));
        app.world_mut().spawn((Camera::default(), Transform::from_xyz(0.0, 0.0, 3.0)));
        let mut most = [0; 3];
        for number in 0..10 {
            let mesh = Mesh::from(UvSphere::new(1.0, 12 + number, 6));
            let handle = app.world_mut().resource_mut::<Assets<Mesh>>().add(mesh);
            let objects = [Shading::Flat, Shading::Phong].map(|shading| {
                app.world_mut().spawn((Mesh3d(handle.clone()), Material::DEFAULT, shading, Transform::default())).id()
            });
            drop(handle);
            app.update();
            for _ in 0..frames {
                app.world_mut().run_schedule(Seldom);
            }
            assert_eq!(app.world().resource::<FrameReport>().errors, []);
            assert!(kept(&app)[0] >= 2, "both ways of shading are laid out");
            most = std::array::from_fn(|i| most[i].max(kept(&app)[i]));
            for object in objects {
                app.world_mut().despawn(object);
            }
            for _ in 0..updates {
                app.update();
            }
        }
        app.world_mut().run_schedule(Seldom);
        let [meshes, _, levels] = kept(&app);
        assert_eq!([meshes, levels], [0, 0], "nothing is there, and something is kept");
        most
    }

    #[test]
    fn meshes_that_are_gone_are_forgotten_however_seldom_frames_are() {
        for updates in [1, 2, 3, 10] {
            // Those of the frame in two shadings, and those of the previous frame, which are dropped later.
            let most = most_kept(updates, 2);
            assert!(most[0] <= 4 && most[1] <= 4 && (1..=2).contains(&most[2]), "{updates} updates: {most:?}");
        }
    }
}
