//! Surfaces that lie close over one another, also where they are connected somewhere.

use bevy_math::{DVec3, Vec3};

use crate::Mesh;
use crate::prepare::nearest::TriangleTree;

/// What is turned by more than 45° from the surface at a place does not lie over it, but beside.
const LEAST_COSINE: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Normals are means over triangles, and then over neighbours as often as this: along those of a rough surface's own
/// triangles, parts of the same surface would lie over one another.
const MEANS: usize = 2;

/// Finds the layers of a mesh.
pub(super) struct LayerSearch<'a, C> {
    mesh: &'a Mesh,
    places: &'a [u32],
    tree: &'a TriangleTree<C>,
    /// Of each place, of any length.
    normals: Vec<Vec3>,
}

/// A triangle that lies over a place, by its own places, and how far away.
pub(super) struct Layer {
    pub(super) places: [u32; 3],
    pub(super) distance: f64,
}

impl<'a, C: Fn(u32) -> [Vec3; 3]> LayerSearch<'a, C> {
    /// The tree has the triangles of the mesh, by their numbers; `unit` is a length of the mesh's size.
    pub(super) fn new(mesh: &'a Mesh, places: &'a [u32], tree: &'a TriangleTree<C>, unit: f64) -> Self {
        let triangles = || mesh.triangles().map(|triangle| triangle.map(|vertex| places[vertex as usize] as usize));
        let mut normals = vec![Vec3::ZERO; places.len()];
        for (number, triangle) in (0..).zip(triangles()) {
            let normal = (normal(mesh.corners_of(number)) / (unit * unit)).as_vec3();
            for place in triangle {
                normals[place] += normal;
            }
        }
        for _ in 0..MEANS {
            let mut sums = vec![Vec3::ZERO; places.len()];
            for triangle in triangles() {
                let sum: Vec3 = triangle.iter().map(|&place| normals[place]).sum();
                for place in triangle {
                    sums[place] += sum;
                }
            }
            normals = sums;
        }
        Self { mesh, places, tree, normals }
    }

    /// The nearest layer over a place, on either side: what a line along its normal meets, no further off than
    /// `within`. Triangles that have a place in common with one that has this place are no layer.
    pub(super) fn next_to(&self, place: u32, within: f64) -> Option<Layer> {
        let p = self.mesh.positions()[place as usize];
        let direction = self.normals[place as usize].as_dvec3().try_normalize()?;
        let (mut layer, mut within, mut around) = (None, within, Vec::new());
        self.tree.search_line(p, direction.as_vec3(), within, |number| {
            let places = self.places_of(number);
            if !places.contains(&place)
                && let Some(distance) = self.distance_over(p.as_dvec3(), direction, number)
                && distance < within
            {
                if around.is_empty() {
                    self.tree.search_around(p, |number| {
                        let places = self.places_of(number);
                        around.extend(places.into_iter().filter(|_| places.contains(&place)));
                    });
                }
                if !places.iter().any(|place| around.contains(place)) {
                    within = distance;
                    layer = Some(Layer { places, distance });
                }
            }
            within
        });
        layer
    }

    fn places_of(&self, number: u32) -> [u32; 3] {
        let first = 3 * number as usize;
        [0, 1, 2].map(|corner| self.places[self.mesh.indices()[first + corner] as usize])
    }

    /// How far off a triangle is where a line along a direction of length 1 meets it, across the surface there; `None`
    /// where it does not, or where that surface is no layer.
    fn distance_over(&self, p: DVec3, direction: DVec3, number: u32) -> Option<f64> {
        let corners = self.mesh.corners_of(number);
        let [a, b, c] = corners.map(|corner| corner.as_dvec3() - p);
        // On which side of each edge the line passes.
        let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| from.cross(to).dot(direction));
        let least = sides[0].min(sides[1]).min(sides[2]);
        let most = sides[0].max(sides[1]).max(sides[2]);
        let rounding = 1e-9 * most.max(-least);
        if least < -rounding && most > rounding {
            return None;
        }
        let normals = self.places_of(number).map(|place| self.normals[place as usize].as_dvec3().normalize_or_zero());
        let cosine = (normals[0] + normals[1] + normals[2]).normalize_or_zero().dot(direction).abs();
        let normal = normal(corners);
        let along = (a.dot(normal) / direction.dot(normal)).abs();
        (cosine >= LEAST_COSINE && along.is_finite()).then_some(along * cosine)
    }
}

/// As long as the triangle's area, twice.
fn normal(corners: [Vec3; 3]) -> DVec3 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    (b - a).cross(c - a)
}
