//! Displacement: vertices moved along their normals.

use glam::{DVec3, Vec3};

use crate::{Mesh, MeshError, NormalReport, NormalWeighting, Normals};

impl Mesh {
    /// The mesh with each vertex moved along its normal by `height` of its number, and normals of the default
    /// weighting.
    ///
    /// Vertices at equal positions stay together, so that seams and creases do not tear open: they move by the mean of
    /// their heights along the mean of their normals, and not at all where that mean vanishes. A mesh shows no more
    /// detail than it has vertices; [`subdivided`](Self::subdivided) adds some. Tangents are dropped.
    ///
    /// ```
    /// use halfway_mesh::{Mesh, Plane};
    ///
    /// let plane = Mesh::from(Plane { size: 1.0, divisions: 16 });
    /// let waves = |vertex: usize| 0.1 * (8.0 * plane.positions()[vertex].x).sin();
    /// let (water, report) = plane.displaced(waves)?;
    /// assert!(report.is_clean() && water.bounds().size().y > 0.15);
    /// # Ok::<(), halfway_mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// A height that is not finite, or a position moved beyond the range of `f32`; the error names the first.
    pub fn displaced(&self, height: impl Fn(usize) -> f32) -> Result<(Self, NormalReport), MeshError> {
        let groups = self.points();
        let mut sums = vec![(DVec3::ZERO, 0.0, 0.0); groups.count()];
        for (vertex, &group) in groups.numbers.iter().enumerate() {
            let height = height(vertex);
            if !height.is_finite() {
                return Err(MeshError::NotFinite { attribute: "height", vertex, value: [height, 0.0, 0.0] });
            }
            let (n, heights, count) = &mut sums[group as usize];
            *n += self.normals()[vertex].as_dvec3();
            *heights += f64::from(height);
            *count += 1.0;
        }
        // ANCHOR: place
        let place = |(vertex, &group): (usize, &u32)| {
            let (n, heights, count) = sums[group as usize];
            // The sum of opposite unit normals is 0 but for rounding.
            let n = if n.length() > 1e-6 * count { n.normalize() } else { DVec3::ZERO };
            (self.positions()[vertex].as_dvec3() + n * (heights / count)).as_vec3()
        };
        // ANCHOR_END: place
        let positions: Vec<Vec3> = groups.numbers.iter().enumerate().map(place).collect();
        if let Some(vertex) = positions.iter().position(|p| !p.is_finite()) {
            let value = positions[vertex].to_array();
            return Err(MeshError::NotFinite { attribute: "position", vertex, value });
        }
        let moved = self.clone().with_given_positions(positions);
        Ok(moved.with_normals(Normals::Weighted(NormalWeighting::default())))
    }
}
