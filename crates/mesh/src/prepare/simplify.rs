//! A coarser mesh within a bound.

use meshopt::SimplifyOptions;

use crate::Mesh;

/// A coarser mesh in the place of a fine one.
#[derive(Clone, Debug, PartialEq)]
pub struct SimplifiedMesh {
    /// The mesh; its vertices are some of the fine mesh's, with all that they have.
    pub mesh: Mesh,
    /// No point of either mesh is further from the other than this, in their units: the larger of both
    /// [distances](Mesh::distance_to), known to a fifth of what the simplifier takes it for or to a ten-thousandth of
    /// half the longest edge of the box around the mesh.
    pub error: f64,
}

/// How often a mesh that came out too far off is tried again.
const TRIES: u32 = 4;

/// The error is known to this part of what the simplifier takes it for, or to the second part of half the longest edge
/// of the box around the mesh.
const ERROR_TOLERANCE: [f64; 2] = [0.2, 1e-4];

impl Mesh {
    /// The mesh with about as many triangles as asked for, or more, if fewer would be further off than `max_error` (in
    /// its units) or change its topology; by meshoptimizer's edge collapses under quadric errors (Garland and Heckbert
    /// 1997). An error too small to be told from none is allowed. Seams between vertices at one position stay; faceted
    /// meshes, which are all seams, should be [welded](Self::welded) first.
    pub fn simplified(&self, triangles: usize, max_error: f64) -> SimplifiedMesh {
        let (positions, unit) = self.unit_positions();
        // NaN asks for nothing.
        let max_error = max_error.max(0.0);
        let mut limit = max_error;
        for _ in 0..TRIES {
            let (indices, estimate) = self.collapsed(&positions, triangles, (limit / unit) as f32);
            if indices.is_empty() {
                break;
            }
            let mesh = self.in_order_of_use(&meshopt::optimize_vertex_cache(&indices, positions.len()));
            let tolerance = (ERROR_TOLERANCE[0] * estimate).max(ERROR_TOLERANCE[1]) * unit;
            let error = self.distance_to(&mesh, tolerance).most.max(mesh.distance_to(self, tolerance).most);
            if error <= max_error.max(tolerance) {
                return SimplifiedMesh { mesh, error };
            }
            // The simplifier knows a mean of squares only; a little less than what would do.
            limit *= 0.9 * max_error / error;
        }
        SimplifiedMesh { mesh: self.clone(), error: 0.0 }
    }

    /// The indices after collapses up to a limit, both it and the mean error found in units of the positions.
    fn collapsed(&self, positions: &[[f32; 3]], triangles: usize, limit: f32) -> (Vec<u32>, f64) {
        let mut estimate = 0.0;
        let indices = meshopt::simplify_decoder(
            self.indices(),
            positions,
            3 * triangles.min(self.triangle_count()),
            limit,
            SimplifyOptions::ErrorAbsolute,
            Some(&mut estimate),
        );
        (indices, f64::from(estimate))
    }
}
