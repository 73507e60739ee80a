//! Upload: what a backend has made of the meshes that are drawn.

use crate::batch::batches::Batches;
use crate::error::RenderError;
use crate::geometry::meshes::{Form, Geometries, Geometry};
use crate::geometry::patches::Patches;
use crate::geometry::workshop::is_same;
use crate::report::FrameReport;
use bevy_platform::collections::HashMap;
use halfway_asset::AssetId;
use halfway_mesh::Mesh;
use std::sync::Arc;

/// Something of a backend's for each mesh that has been drawn, until the mesh changes or goes.
pub struct DrawnMeshes<T> {
    meshes: HashMap<(AssetId<Mesh>, Form), DrawnMesh<T>>,
    /// Of the geometries when these were last looked through.
    forgotten: u64,
}

struct DrawnMesh<T> {
    made: T,
    source: Mesh,
    patches: Arc<Patches>,
}

impl<T> Default for DrawnMeshes<T> {
    fn default() -> Self {
        Self { meshes: HashMap::default(), forgotten: 0 }
    }
}

impl<T> DrawnMeshes<T> {
    /// The data of a mesh in a form, where it is ready.
    pub fn get(&self, id: AssetId<Mesh>, form: Form) -> Option<&T> {
        self.meshes.get(&(id, form)).map(|mesh| &mesh.made)
    }

    /// The number of meshes that are ready.
    pub fn len(&self) -> usize {
        self.meshes.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.meshes.is_empty()
    }

    /// Forgets meshes that are gone, and makes what is missing or out of date for those that are drawn: `make` takes
    /// the mesh, its indices, its form, and what was made of the same mesh with other triangles; it says how many bytes
    /// it has made. If it fails, the mesh is not drawn, and every frame reports its error.
    pub fn make_ready(
        &mut self,
        batches: &Batches,
        geometries: &mut Geometries,
        report: &mut FrameReport,
        make: impl Fn(&Geometry, &[u32], Form, Option<&T>) -> Result<(T, u64), RenderError>,
    ) {
        if self.forgotten != geometries.forgotten {
            self.forgotten = geometries.forgotten;
            self.meshes.retain(|&(id, form), _| geometries.get(id, form).is_some());
        }
        let mut last = None;
        for group in batches.draws.groups() {
            let key = (group.state.mesh, group.state.form);
            if last.replace(key) == Some(key) {
                continue;
            }
            let Some(geometry) = geometries.get_mut(key.0, key.1) else { continue };
            let there = self.meshes.get(&key).filter(|there| is_same(&there.source, &geometry.source));
            if there.is_some_and(|there| Arc::ptr_eq(&there.patches, &geometry.patches)) {
                continue;
            }
            let Some(triangles) = &geometry.triangles else { continue };
            match make(geometry, triangles.as_flattened(), key.1, there.map(|there| &there.made)) {
                Ok((made, bytes)) => {
                    report.bytes_uploaded += bytes;
                    geometry.triangles = None;
                    let (source, patches) = (geometry.source.clone(), Arc::clone(&geometry.patches));
                    self.meshes.insert(key, DrawnMesh { made, source, patches });
                }
                Err(error) => {
                    self.meshes.remove(&key);
                    if !report.errors.contains(&error) {
                        report.errors.push(error);
                    }
                }
            }
        }
    }
}
