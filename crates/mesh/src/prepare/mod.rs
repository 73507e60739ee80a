//! What is done to a mesh before it is drawn: welding, repair, a look over it, its distance from another, and levels of
//! detail.
//!
//! With the feature `prepare`, which takes a C++ compiler, also an order for the GPU's caches, meshlets and simplified
//! meshes by meshoptimizer.

mod components;
mod distance;
#[cfg(feature = "prepare")]
mod enclose;
mod hierarchy;
#[cfg(feature = "prepare")]
mod meshlets;
mod nearest;
#[cfg(feature = "prepare")]
mod order;
mod patches;
mod repair;
mod report;
#[cfg(feature = "prepare")]
mod simplify;
mod weld;

pub use distance::DistanceBounds;
#[cfg(feature = "prepare")]
pub use enclose::{BoundingSphere, DirectionCone};
pub use hierarchy::{HierarchyPatch, PatchGroup, PatchHierarchy};
#[cfg(feature = "prepare")]
pub use meshlets::{Meshlet, Meshlets};
pub use repair::RepairReport;
pub use report::MeshReport;
#[cfg(feature = "prepare")]
pub use simplify::SimplifiedMesh;
pub use weld::{Weld, WeldReport};

use bevy_math::{DVec3, Vec3};

use crate::Mesh;
use crate::numbering::Numbering;

impl Mesh {
    /// The corners of a triangle by its number.
    fn corners_of(&self, triangle: u32) -> [Vec3; 3] {
        self.indices().as_chunks::<3>().0[triangle as usize].map(|vertex| self.positions()[vertex as usize])
    }

    /// The mesh with these triangles, its vertices in the order in which they are used first and the unused ones left
    /// out: the GPU then fetches them nearly in a row.
    pub(crate) fn in_order_of_use(&self, indices: &[u32]) -> Self {
        let used = Numbering::new(indices.len(), |corner| [indices[corner]]);
        let vertices: Vec<u32> = used.firsts.iter().map(|&corner| indices[corner as usize]).collect();
        self.selected(&vertices, used.numbers)
    }

    /// The positions moved and scaled into the cube from −1 to 1, where single precision neither under- nor overflows,
    /// and the length that is 1 there.
    pub(crate) fn unit_positions(&self) -> (Vec<[f32; 3]>, f64) {
        let (min, max) = (self.bounds().min.as_dvec3(), self.bounds().max.as_dvec3());
        let center = 0.5 * (min + max);
        let unit = (0.5 * (max - min)).max_element();
        let unit = if unit > 0.0 { unit } else { 1.0 };
        let place = |p: &Vec3| ((p.as_dvec3() - center) / unit).clamp(DVec3::NEG_ONE, DVec3::ONE).as_vec3().to_array();
        (self.positions().iter().map(place).collect(), unit)
    }
}
