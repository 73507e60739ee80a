//! Upload: what a backend has made of the meshes that are drawn.

use crate::batch::batches::Batches;
use crate::error::RenderError;
use crate::geometry::meshes::{Form, Geometries, Geometry};
use crate::geometry::patches::Patches;
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
    /// Where the mesh moves: the triangles in the order in which they are drawn.
    triangles: Option<Arc<Vec<[u32; 3]>>>,
}

/// The data made of a mesh before it changed.
pub enum Before<T> {
    /// Nothing, or nothing that is of use.
    Nothing,
    /// The same vertices, with other triangles.
    SameVertices(T),
    /// The same triangles in the same order, with other vertices.
    SameTriangles(T),
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
    /// the mesh, its indices, its form, and what was made of it before; it says how many bytes
    /// it has made. If it fails, the mesh is not drawn, and every frame reports its error.
    pub fn make_ready(
        &mut self,
        batches: &Batches,
        geometries: &mut Geometries,
        report: &mut FrameReport,
        make: impl Fn(&Geometry, &[u32], Form, Before<T>) -> Result<(T, u64), RenderError>,
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
            let Some(triangles) = geometry.triangles.clone() else { continue };
            let there = self.meshes.get(&key);
            let is_ready = there.is_some_and(|there| {
                there.source.is_clone_of(&geometry.source) && Arc::ptr_eq(&there.patches, &geometry.patches)
            });
            if is_ready {
                continue;
            }
            let before = match self.meshes.remove(&key) {
                Some(there) if there.source.is_clone_of(&geometry.source) => Before::SameVertices(there.made),
                Some(there) if there.triangles.as_ref().is_some_and(|kept| Arc::ptr_eq(kept, &triangles)) => {
                    Before::SameTriangles(there.made)
                }
                _ => Before::Nothing,
            };
            let is_unsorted = geometry.patches.are_unsorted();
            let indices = if is_unsorted { geometry.drawn.indices() } else { triangles.as_flattened() };
            match make(geometry, indices, key.1, before) {
                Ok((made, bytes)) => {
                    report.bytes_uploaded += bytes;
                    geometry.triangles.take_if(|_| !geometry.moves);
                    let (source, patches) = (geometry.source.clone(), Arc::clone(&geometry.patches));
                    let triangles = geometry.triangles.clone();
                    self.meshes.insert(key, DrawnMesh { made, source, patches, triangles });
                }
                Err(error) => {
                    if !report.errors.contains(&error) {
                        report.errors.push(error);
                    }
                }
            }
        }
    }
}
