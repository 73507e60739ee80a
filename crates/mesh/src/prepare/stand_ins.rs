//! Vertices that levels of detail take for one.

use super::weld::places;
use crate::Mesh;

/// Positions no further apart than this part of the longest edge of the box are one place: some bits of an `f32`, by
/// which exporters and seams of revolution miss each other.
const SNAP: f64 = 1e-6;

/// Numbers of normals, texture coordinates, colours and tangents no further apart than this are equal.
const EQUAL: f32 = 1e-4;

/// A vertex is compared with so many others of its place; the pole of a sphere has hundreds.
const COMPARED: usize = 64;

/// Which vertex each vertex is taken for, by number.
pub(super) struct StandIns {
    /// The vertex whose position it has.
    pub(super) places: Vec<u32>,
    /// The vertex that is used in its stead: one of the same place with the same attributes.
    pub(super) vertices: Vec<u32>,
}

impl StandIns {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let size = mesh.bounds().max.as_dvec3() - mesh.bounds().min.as_dvec3();
        let places = places(mesh.positions(), (SNAP * size.max_element()) as f32);
        let mut at_place: Vec<Vec<u32>> = vec![Vec::new(); places.len()];
        let vertices = (0..).zip(&places).map(|(vertex, &place)| {
            let others = &mut at_place[place as usize];
            let equal = others.iter().take(COMPARED).find(|&&other| mesh.attributes_agree(vertex, other));
            equal.copied().unwrap_or_else(|| {
                others.push(vertex);
                vertex
            })
        });
        let vertices = vertices.collect();
        Self { places, vertices }
    }

    /// The triangles between stand-ins that have three places.
    pub(super) fn triangles(&self, mesh: &Mesh) -> Vec<[u32; 3]> {
        let has_three_places = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|vertex| self.places[vertex as usize]);
            a != b && b != c && c != a
        };
        let stand_ins = mesh.triangles().map(|triangle| triangle.map(|vertex| self.vertices[vertex as usize]));
        stand_ins.filter(has_three_places).collect()
    }
}

impl Mesh {
    /// Whether two vertices are alike in all but their positions.
    fn attributes_agree(&self, a: u32, b: u32) -> bool {
        fn near<const N: usize>(a: [f32; N], b: [f32; N]) -> bool {
            a.iter().zip(b).all(|(a, b)| (a - b).abs() <= EQUAL)
        }
        let [a, b] = [a, b].map(|vertex| vertex as usize);
        near(self.normals()[a].to_array(), self.normals()[b].to_array())
            && self.uvs().is_none_or(|all| near(all[a].to_array(), all[b].to_array()))
            && self.colors().is_none_or(|all| near(all[a].to_array(), all[b].to_array()))
            && self.tangents().is_none_or(|all| near(all[a].to_array(), all[b].to_array()))
    }
}
