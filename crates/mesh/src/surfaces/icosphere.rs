//! The sphere from the icosahedron.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::{Quadric, SurfaceError, SurfaceField};
use crate::Mesh;

/// A sphere about the origin, from an icosahedron whose faces are subdivided into `divisions`² triangles each and
/// projected onto the sphere.
///
/// Its triangles are of nearly equal size and shape, unlike those of a [`UvSphere`](super::UvSphere); it has 20
/// `divisions`² of them and 10 `divisions`² + 2 vertices, all shared. It has no texture coordinates.
///
/// ```
/// use halfway_mesh::{Icosphere, Mesh};
///
/// let sphere = Mesh::from(Icosphere::new(1.0, 4));
/// assert_eq!((sphere.triangle_count(), sphere.positions().len()), (320, 162));
/// assert!(Icosphere::for_chord_error(1.0, 0.001).divisions > 8);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Icosphere {
    /// The radius, 1e-30 … 1e30; 1 by default.
    pub radius: f32,
    /// How many parts an edge of the icosahedron is cut into, 1 … [`Icosphere::MAX_DIVISIONS`]; 8 by default.
    pub divisions: u32,
}

impl Default for Icosphere {
    fn default() -> Self {
        Self { radius: 1.0, divisions: 8 }
    }
}

/// The golden ratio.
const PHI: f64 = 1.618_033_988_749_895;

/// The icosahedron: the corners of three golden rectangles, one in each plane of two axes.
const CORNERS: [[f64; 3]; 12] = [
    [-1.0, PHI, 0.0],
    [1.0, PHI, 0.0],
    [-1.0, -PHI, 0.0],
    [1.0, -PHI, 0.0],
    [0.0, -1.0, PHI],
    [0.0, 1.0, PHI],
    [0.0, -1.0, -PHI],
    [0.0, 1.0, -PHI],
    [PHI, 0.0, -1.0],
    [PHI, 0.0, 1.0],
    [-PHI, 0.0, -1.0],
    [-PHI, 0.0, 1.0],
];

/// Its faces, counter-clockwise from outside.
#[rustfmt::skip]
const FACES: [[usize; 3]; 20] = [
    [0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11],
    [1, 5, 9], [5, 11, 4], [11, 10, 2], [10, 7, 6], [7, 1, 8],
    [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9],
    [4, 9, 5], [2, 4, 11], [6, 2, 10], [8, 6, 7], [9, 8, 1],
];

impl Icosphere {
    /// The most divisions; more would be more than five million triangles.
    pub const MAX_DIVISIONS: u32 = 512;

    /// A sphere of this radius and these divisions.
    pub fn new(radius: f32, divisions: u32) -> Self {
        Self { radius, divisions }
    }

    /// The coarsest sphere of this radius whose facets are nowhere further than `error` from the true one, both in the
    /// same unit; the finest one if none is as accurate.
    pub fn for_chord_error(radius: f32, error: f64) -> Self {
        let allowed = error / f64::from(radius);
        let near = |divisions: u32| chord_error(divisions) <= allowed;
        // The error falls with every division.
        let (mut low, mut high) = (1, Self::MAX_DIVISIONS);
        while low < high {
            let middle = u32::midpoint(low, high);
            if near(middle) { high = middle } else { low = middle + 1 }
        }
        Self { radius, divisions: low }
    }

    /// Checks the ranges of the fields.
    ///
    /// # Errors
    /// Names the first field out of range.
    pub fn validate(&self) -> Result<(), SurfaceError> {
        self.fields().iter().try_for_each(SurfaceField::check)
    }

    fn fields(self) -> [SurfaceField; 2] {
        [
            SurfaceField::length("Icosphere", "radius", self.radius),
            SurfaceField::count("Icosphere", "divisions", self.divisions, 1..=Self::MAX_DIVISIONS),
        ]
    }
}

/// The weights of three corners, whose sum is the number of divisions.
type CornerWeights = [u32; 3];

/// The small triangles of a face, each by the weights of the face's corners at its own.
fn small_triangles(n: u32) -> impl Iterator<Item = [CornerWeights; 3]> {
    let at = move |i: u32, j: u32| [n - i - j, i, j];
    (0..n).flat_map(move |i| (0..n - i).map(move |j| (i, j))).flat_map(move |(i, j)| {
        let upright = [at(i, j), at(i + 1, j), at(i, j + 1)];
        let inverted = (i + j + 2 <= n).then(|| [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        [Some(upright), inverted].into_iter().flatten()
    })
}

/// The point of the unit sphere above the weighted mean of corners. Corners without weight are left out, so that a
/// point on an edge is the same from both faces as long as the others come in one order.
fn on_sphere(corners: [(usize, u32); 3]) -> DVec3 {
    corners
        .iter()
        .map(|&(corner, weight)| f64::from(weight) * DVec3::from_array(CORNERS[corner]))
        .sum::<DVec3>()
        .normalize()
}

fn paired(face: [usize; 3], weights: CornerWeights) -> [(usize, u32); 3] {
    [0, 1, 2].map(|k| (face[k], weights[k]))
}

/// How far the facets of a unit sphere are from it at most: at the foot of the normal through the middle, for each. All
/// faces are alike.
fn chord_error(divisions: u32) -> f64 {
    let height = |triangle: [CornerWeights; 3]| {
        let [a, b, c] = triangle.map(|weights| on_sphere(paired(FACES[0], weights)));
        (b - a).cross(c - a).normalize().dot(a)
    };
    1.0 - small_triangles(divisions).map(height).fold(1.0, f64::min)
}

impl From<Icosphere> for Mesh {
    /// Fields out of range are clamped, with a warning in the log; see [`Icosphere::validate`].
    fn from(sphere: Icosphere) -> Self {
        let [radius, divisions] = sphere.fields().map(|field| field.nearest());
        let n = divisions as u32;
        let count = 10 * (n as usize).pow(2) + 2;
        let mut normals: Vec<DVec3> = Vec::with_capacity(count);
        let mut vertices = HashMap::with_capacity(count);
        let mut indices = Vec::with_capacity(60 * (n as usize).pow(2));
        for face in FACES {
            for triangle in small_triangles(n) {
                indices.extend(triangle.map(|weights| {
                    let mut corners = paired(face, weights);
                    // The order of corners without weight does not matter.
                    corners.sort_unstable_by_key(|&(corner, weight)| if weight == 0 { (1, 0) } else { (0, corner) });
                    let key = corners.map(|(corner, weight)| if weight == 0 { (0, 0) } else { (corner, weight) });
                    *vertices.entry(key).or_insert_with(|| {
                        normals.push(on_sphere(key));
                        normals.len() as u32 - 1
                    })
                }));
            }
        }
        let positions = normals.iter().map(|n| (radius * n).as_vec3()).collect();
        let normals: Vec<Vec3> = normals.iter().map(|n| n.as_vec3()).collect();
        Mesh::checked(positions, normals, None, indices).with_surface(Quadric::sphere(radius).into())
    }
}
