//! The set Upload: cuts meshes into pieces for the rasterizer.

use crate::cpu::error::raster_error;
use bevy_ecs::prelude::*;
use halfway_asset::AssetId;
use halfway_frame::batch::batches::Batches;
use halfway_frame::batch::drawn_meshes::{Before, DrawnMeshes};
use halfway_frame::geometry::meshes::{Form, Geometries, both_uvs};
use halfway_frame::geometry::patches::{MeshTriangles, Patches, Prepared};
use halfway_frame::report::FrameReport;
use halfway_mesh::Mesh;
use halfway_raster::{Pieces, RasterError, TriangleOrder, VertexLists};
use std::sync::Arc;

/// The drawn meshes in pieces, until they change or are removed.
#[derive(Resource, Default)]
pub(crate) struct MeshPieces(DrawnMeshes<Arc<Pieces>>);

/// Cuts the drawn meshes that are not cut yet, unless that was done with their levels of detail. A mesh whose memory is
/// refused is not drawn, and its error is in the report of every frame.
pub(crate) fn make_ready(
    batches: Res<Batches>,
    mut geometries: ResMut<Geometries>,
    mut meshes: ResMut<MeshPieces>,
    mut report: ResMut<FrameReport>,
) {
    meshes.0.make_ready(&batches, &mut geometries, &mut report, |geometry, indices, form, before| {
        let prepared = geometry.pieces.clone().filter(|_| form == Form::default());
        let kept = prepared.and_then(|prepared| prepared.downcast().ok());
        let kept = kept.or_else(|| moved(before, &geometry.drawn, indices, form));
        let pieces = match kept {
            Some(pieces) => pieces,
            None => Arc::new(pieces(&geometry.drawn, &geometry.patches, indices, form).map_err(raster_error)?),
        };
        let bytes = pieces.bytes();
        Ok((pieces, bytes))
    });
}

impl MeshPieces {
    pub(crate) fn get(&self, id: AssetId<Mesh>, form: Form) -> Option<&Pieces> {
        self.0.get(id, form).map(Arc::as_ref)
    }
}

/// The pieces of a mesh with levels of detail, for draws without colors and images; `None` if they cannot be made,
/// which is reported once they are drawn.
pub(crate) fn of_levels(mesh: &Mesh, MeshTriangles { corners, patches, .. }: &MeshTriangles) -> Option<Prepared> {
    let pieces = pieces(mesh, patches, corners.as_flattened(), Form::default()).ok()?;
    Some(Arc::new(pieces))
}

/// Draws begin and end where patches do.
fn pieces(source: &Mesh, patches: &Patches, indices: &[u32], form: Form) -> Result<Pieces, RasterError> {
    let cuts: Vec<_> = (0..patches.len() as u32).map(|patch| patches.indices(patch)).collect();
    let order = if form.ordered || patches.are_unsorted() { TriangleOrder::Kept } else { TriangleOrder::Clustered };
    with_vertices(source, form, |positions, lists| Pieces::new(positions, lists, indices, &cuts, order))
}

/// The pieces of the same triangles, with their vertices moved to those of a mesh; `None` where that cannot be done.
fn moved(before: Before<Arc<Pieces>>, source: &Mesh, indices: &[u32], form: Form) -> Option<Arc<Pieces>> {
    let Before::SameTriangles(mut pieces) = before else { return None };
    let own = Arc::get_mut(&mut pieces)?;
    with_vertices(source, form, |positions, lists| own.move_to(positions, lists, indices)).then_some(pieces)
}

/// Calls `then` with the vertices of a mesh, as they are drawn in a form.
fn with_vertices<T>(source: &Mesh, form: Form, then: impl FnOnce(&[[f32; 3]], VertexLists) -> T) -> T {
    let [positions, normals] = [source.positions(), source.normals()].map(bytemuck::cast_slice);
    let colors = source.drawn_colors().filter(|_| form.colored).unwrap_or_default();
    let uvs = if form.mapped { both_uvs(source) } else { Vec::new() };
    let lists = VertexLists {
        normals,
        colors: bytemuck::cast_slice(&colors),
        uvs: bytemuck::cast_slice(&uvs),
        tangents: source.tangents().filter(|_| form.tangents.is_some()).map_or(&[], bytemuck::cast_slice),
    };
    then(positions, lists)
}
