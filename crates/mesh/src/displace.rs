//! Displacement: vertices moved along their normals.

use bevy_math::{DVec3, Vec2, Vec3};
use thiserror::Error;

use crate::numbering::Numbering;
use crate::{Mesh, MeshError, NormalReport, NormalWeighting, Normals};

/// A picture of heights.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightImage {
    width: u32,
    height: u32,
    heights: Vec<f32>,
    /// Whether the picture goes on beyond its sides, and beyond its top and bottom, by beginning again; otherwise its
    /// outermost texels do. Neither, unless set.
    pub repeat: [bool; 2],
}

/// Heights that are no picture.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum HeightImageError {
    /// Not as many heights as texels.
    #[error("{found} heights for {width} × {height} texels; one a texel, and at least one, is expected")]
    Count {
        /// How many heights there are.
        found: usize,
        /// Texels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// A height is NaN or infinite.
    #[error("the height {value} in column {column} of row {row}; a finite number is expected")]
    NotFinite {
        /// The column, from 0.
        column: u32,
        /// The row, from 0 at the top.
        row: u32,
        /// What was found there.
        value: f32,
    },
}

impl HeightImage {
    /// A picture of `width` × `height` heights, row by row from the top.
    ///
    /// # Errors
    /// No heights, not as many as texels, or one that is not finite.
    pub fn new(width: u32, height: u32, heights: Vec<f32>) -> Result<Self, HeightImageError> {
        let found = heights.len();
        if found == 0 || found as u64 != u64::from(width) * u64::from(height) {
            return Err(HeightImageError::Count { found, width, height });
        }
        if let Some(at) = heights.iter().position(|h| !h.is_finite()) {
            let (column, row) = ((at % width as usize) as u32, (at / width as usize) as u32);
            return Err(HeightImageError::NotFinite { column, row, value: heights[at] });
        }
        Ok(Self { width, height, heights, repeat: [false; 2] })
    }

    /// The height at texture coordinates, bilinear between the four nearest centres of texels; texel (i, j) has its
    /// centre at ((i + ½) / width, (j + ½) / height).
    pub fn at(&self, uv: Vec2) -> f32 {
        let (left, right, x) = neighbours(uv.x, self.width, self.repeat[0]);
        let (above, below, y) = neighbours(uv.y, self.height, self.repeat[1]);
        let texel = |column: usize, row: usize| f64::from(self.heights[row * self.width as usize + column]);
        let mix = |a: f64, b: f64, t: f64| a * (1.0 - t) + b * t;
        let upper = mix(texel(left, above), texel(right, above), x);
        let lower = mix(texel(left, below), texel(right, below), x);
        mix(upper, lower, y) as f32
    }
}

/// The two texels around a coordinate, and how far it lies from the first to the second.
fn neighbours(coordinate: f32, texels: u32, repeat: bool) -> (usize, usize, f64) {
    let x = f64::from(coordinate) * f64::from(texels) - 0.5;
    let first = x.floor();
    let place = |texel: f64| {
        let texels = f64::from(texels);
        let texel = if repeat { texel.rem_euclid(texels) } else { texel };
        texel.clamp(0.0, texels - 1.0) as usize
    };
    (place(first), place(first + 1.0), x - first)
}

impl Mesh {
    /// The mesh with each vertex moved along its normal by `height` of its number, and normals of the default
    /// weighting.
    ///
    /// Vertices at equal positions stay together, so that nothing tears open at a seam or a crease: they move by the
    /// mean of their heights along the mean of their normals, and not at all where that vanishes. A mesh shows no more
    /// detail than it has vertices; [`subdivided`](Self::subdivided) gives it some. Tangents are dropped.
    ///
    /// # Errors
    /// A height that is not finite, or a position moved beyond the range of `f32`; the error names the first.
    pub fn displaced(&self, height: impl Fn(usize) -> f32) -> Result<(Self, NormalReport), MeshError> {
        let groups = Numbering::of_positions(self.positions());
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
        let place = |(vertex, &group): (usize, &u32)| {
            let (n, heights, count) = sums[group as usize];
            // The sum of opposite unit normals is 0 but for rounding.
            let n = if n.length() > 1e-6 * count { n.normalize() } else { DVec3::ZERO };
            (self.positions()[vertex].as_dvec3() + n * (heights / count)).as_vec3()
        };
        let positions: Vec<Vec3> = groups.numbers.iter().enumerate().map(place).collect();
        if let Some(vertex) = positions.iter().position(|p| !p.is_finite()) {
            let value = positions[vertex].to_array();
            return Err(MeshError::NotFinite { attribute: "position", vertex, value });
        }
        let moved = self.clone().with_given_positions(positions);
        Ok(moved.with_normals(Normals::Weighted(NormalWeighting::default())))
    }

    /// The mesh [`displaced`](Self::displaced) by `scale` times the heights of an image at its texture coordinates.
    ///
    /// # Errors
    /// The mesh has no texture coordinates, or as [`displaced`](Self::displaced).
    pub fn displaced_by_image(&self, image: &HeightImage, scale: f32) -> Result<(Self, NormalReport), MeshError> {
        let uvs = self.uvs().ok_or(MeshError::NoUvs { what: "displacement by an image" })?;
        self.displaced(|vertex| image.at(uvs[vertex]) * scale)
    }
}
