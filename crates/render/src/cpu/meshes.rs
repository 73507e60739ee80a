//! Upload: meshes as the rasterizer takes them.

use crate::batch::batches::Batches;
use crate::error::RenderError;
use crate::frame::report::FrameReport;
use crate::geometry::detail::Detail;
use crate::geometry::meshes::{Form, Geometries, Geometry};
use crate::geometry::workshop::is_same;
use bevy_asset::AssetId;
use bevy_ecs::prelude::*;
use bevy_platform::collections::HashMap;
use halfway_mesh::Mesh;
use halfway_raster::{Pieces, RasterError, TriangleOrder};
use std::sync::Arc;

/// The meshes that have been drawn, in pieces, until they change or go.
#[derive(Resource, Default)]
pub(crate) struct MeshPieces {
    meshes: HashMap<(AssetId<Mesh>, Form), MadeReady>,
    /// Of the geometries when these were last looked through.
    forgotten: u64,
}

struct MadeReady {
    pieces: Pieces,
    source: Mesh,
    detail: Arc<Detail>,
}

/// Cuts the meshes that are drawn and not there yet. What the memory is refused for is not drawn, and its error is in the
/// report, every frame anew.
pub(crate) fn make_ready(
    batches: Res<Batches>,
    mut geometries: ResMut<Geometries>,
    mut meshes: ResMut<MeshPieces>,
    mut report: ResMut<FrameReport>,
) {
    if meshes.forgotten != geometries.forgotten {
        meshes.forgotten = geometries.forgotten;
        meshes.meshes.retain(|&(id, form), _| geometries.get(id, form).is_some());
    }
    let mut last = None;
    for group in batches.draws.groups() {
        let key = (group.state.mesh, group.state.form);
        if last.replace(key) == Some(key) {
            continue;
        }
        let Some(geometry) = geometries.get_mut(key.0, key.1) else { continue };
        match meshes.ensure(key, geometry) {
            Ok(bytes) => report.bytes_uploaded += bytes,
            Err(error) => {
                meshes.meshes.remove(&key);
                if !report.errors.contains(&error) {
                    report.errors.push(error);
                }
            }
        }
    }
}

impl MeshPieces {
    pub(crate) fn get(&self, id: AssetId<Mesh>, form: Form) -> Option<&Pieces> {
        self.meshes.get(&(id, form)).map(|mesh| &mesh.pieces)
    }

    /// Cuts the mesh unless it is there. Returns the bytes made.
    fn ensure(&mut self, key: (AssetId<Mesh>, Form), geometry: &mut Geometry) -> Result<u64, RenderError> {
        let there = self.meshes.get(&key).filter(|there| is_same(&there.source, &geometry.source));
        if there.is_some_and(|there| Arc::ptr_eq(&there.detail, &geometry.detail)) {
            return Ok(0);
        }
        let Some(indices) = &geometry.indices else { return Ok(0) };
        let pieces = pieces(geometry, indices, key.1).map_err(RenderError::from)?;
        geometry.indices = None;
        let bytes = pieces.bytes();
        let (source, detail) = (geometry.source.clone(), Arc::clone(&geometry.detail));
        self.meshes.insert(key, MadeReady { pieces, source, detail });
        Ok(bytes)
    }
}

/// Draws begin and end where patches do.
fn pieces(geometry: &Geometry, indices: &[u32], form: Form) -> Result<Pieces, RasterError> {
    let Geometry { source, detail, .. } = geometry;
    let cuts: Vec<_> = detail.patches.iter().map(|patch| patch.indices.clone()).collect();
    let order = if form.ordered { TriangleOrder::Kept } else { TriangleOrder::Clustered };
    let [positions, normals] = [source.positions(), source.normals()].map(bytemuck::cast_slice);
    Pieces::new(positions, normals, indices, &cuts, order)
}
