//! Vertices that levels of detail take for one.

use crate::Mesh;
use crate::prepare::weld::places;

/// Numbers of normals, texture coordinates, colours and tangents no further apart than this are equal.
const EQUAL: f32 = 1e-4;

/// A vertex is compared with this number of others of its place; the pole of a sphere has hundreds.
const COMPARED: usize = 64;

/// Which vertex each vertex is taken for, by number.
pub(super) struct StandIns {
    /// The first vertex with its position, to the bit but for the sign of 0.
    pub(super) places: Vec<u32>,
    /// The vertex that is used in its stead: one of the same place with the same attributes.
    pub(super) vertices: Vec<u32>,
}

impl StandIns {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let places = places(mesh.positions(), 0.0);
        // The vertices of each place that are no stand-ins of others: the first, and what follows each.
        let mut following = vec![u32::MAX; places.len()];
        let vertices = (0..).zip(&places).map(|(vertex, &place)| {
            if vertex == place {
                return vertex;
            }
            let mut other = place;
            for _ in 0..COMPARED {
                if mesh.attributes_agree(vertex, other) {
                    return other;
                }
                let next = following[other as usize];
                if next == u32::MAX {
                    following[other as usize] = vertex;
                    return vertex;
                }
                other = next;
            }
            vertex
        });
        let vertices = vertices.collect();
        Self { places, vertices }
    }

    /// Those of some triangles that have three places, between stand-ins.
    pub(super) fn triangles<'a>(&'a self, triangles: &'a [[u32; 3]]) -> impl Iterator<Item = [u32; 3]> + 'a {
        let has_three_places = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|vertex| self.places[vertex as usize]);
            a != b && b != c && c != a
        };
        let stand_ins = triangles.iter().map(|triangle| triangle.map(|vertex| self.vertices[vertex as usize]));
        stand_ins.filter(has_three_places)
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
            && self.uv_set(1).is_none_or(|all| near(all[a].to_array(), all[b].to_array()))
            && self.colors().is_none_or(|all| near(all[a].to_array(), all[b].to_array()))
            && self.tangents().is_none_or(|all| near(all[a].to_array(), all[b].to_array()))
    }
}
