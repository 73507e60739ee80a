//! Preparation of a mesh before it is drawn: welding, repair, a report, the distance from another mesh, simplification
//! and levels of detail.

mod components;
mod distance;
mod lod;
mod patches;
mod repair;
mod report;
mod simplify;
mod weld;

pub use distance::DistanceBounds;
pub use lod::{LodCluster, LodGroup, LodHierarchy};
pub use repair::RepairReport;
pub use report::MeshReport;
pub use simplify::SimplifiedMesh;
pub use weld::{Weld, WeldReport};

use glam::Vec3;

use crate::Mesh;
use crate::numbering::Numbering;

impl Mesh {
    /// The corners of a triangle by its number.
    fn corners_of(&self, triangle: u32) -> [Vec3; 3] {
        self.indices().as_chunks::<3>().0[triangle as usize].map(|vertex| self.positions()[vertex as usize])
    }

    /// The corners of all triangles.
    pub(crate) fn triangle_corners(&self) -> impl Iterator<Item = [Vec3; 3]> {
        self.triangles().map(|triangle| triangle.map(|vertex| self.positions()[vertex as usize]))
    }

    /// The mesh with these triangles, its vertices in the order of first use and the unused ones dropped: the GPU then
    /// fetches them nearly in sequence.
    pub(crate) fn in_order_of_use(&self, indices: &[u32]) -> Self {
        let used = Numbering::new(indices.len(), |corner| [indices[corner]]);
        let vertices: Vec<u32> = used.firsts.iter().map(|&corner| indices[corner as usize]).collect();
        self.selected(&vertices, used.numbers)
    }
}
