//! The points of a mesh at the centres of an image's texels.

use glam::{DVec2, Vec2};

use crate::Mesh;

/// A point of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct UvPlace {
    pub(super) triangle: u32,
    pub(super) weights: [f64; 3],
}

/// The triangle that contains each texel's centre, row by row.
pub(super) struct TexelPlaces {
    width: u32,
    size: DVec2,
    triangles: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl TexelPlaces {
    pub(super) fn new(mesh: &Mesh, uvs: &[Vec2], [width, height]: [u32; 2]) -> Self {
        let size = DVec2::new(f64::from(width), f64::from(height));
        let mut triangles = vec![NONE; width as usize * height as usize];
        for (number, corners) in mesh.triangles().enumerate() {
            let at = corners.map(|vertex| uvs[vertex as usize].as_dvec2() * size);
            let least = at[0].min(at[1]).min(at[2]);
            let most = at[0].max(at[1]).max(at[2]);
            // Texels whose centre may lie within; casts clamp negative numbers to 0.
            let along = |least: f64, most: f64, side: u32| {
                (least - 0.5).ceil() as u32..((most - 0.5).floor() + 1.0).min(f64::from(side)) as u32
            };
            for y in along(least.y, most.y, height) {
                for x in along(least.x, most.x, width) {
                    let texel = &mut triangles[(y * width + x) as usize];
                    if *texel == NONE && weights(at, center([x, y])).is_some() {
                        *texel = number as u32;
                    }
                }
            }
        }
        Self { width, size, triangles }
    }

    /// The point of the mesh at a texel's centre.
    pub(super) fn at(&self, mesh: &Mesh, uvs: &[Vec2], [x, y]: [u32; 2]) -> Option<UvPlace> {
        let triangle = self.triangles[(y * self.width + x) as usize];
        if triangle == NONE {
            return None;
        }
        let first = 3 * triangle as usize;
        let corner = |corner: usize| uvs[mesh.indices()[first + corner] as usize].as_dvec2() * self.size;
        let weights = weights([corner(0), corner(1), corner(2)], center([x, y]))?;
        Some(UvPlace { triangle, weights })
    }
}

fn center(texel: [u32; 2]) -> DVec2 {
    DVec2::from(texel.map(|at| f64::from(at) + 0.5))
}

/// The barycentric weights of a point, if it lies in the triangle or on its border.
fn weights([a, b, c]: [DVec2; 3], p: DVec2) -> Option<[f64; 3]> {
    let area = (b - a).perp_dot(c - a);
    if area == 0.0 {
        return None;
    }
    let of = |from: DVec2, to: DVec2| (to - from).perp_dot(p - from) / area;
    let weights = [of(b, c), of(c, a), of(a, b)];
    // Of two triangles that share an edge, at least one must contain its points, whatever the rounding.
    weights.iter().all(|weight| *weight >= -1e-12).then_some(weights)
}
