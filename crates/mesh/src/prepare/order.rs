//! An order of triangles and vertices for the GPU.

use crate::Mesh;

/// How much worse the order may become for the vertex cache so that less is drawn over.
const OVERDRAW_THRESHOLD: f32 = 1.05;

impl Mesh {
    /// The mesh with its triangles in an order that shades few vertices twice and draws little over what is already
    /// there, and its vertices in the order of their use, without those of no triangle. It looks the same.
    ///
    /// By meshoptimizer: vertex cache (a scored greedy order after Forsyth 2006), then overdraw (clusters that face out
    /// first, after Sander et al. 2007).
    #[must_use]
    pub fn optimized(&self) -> Self {
        let mut indices = meshopt::optimize_vertex_cache(self.indices(), self.positions().len());
        meshopt::optimize_overdraw_in_place_decoder(&mut indices, &self.unit_positions().0, OVERDRAW_THRESHOLD);
        self.in_order_of_use(&indices)
    }
}
