//! Welding: merges vertices that are equal, or nearly so.

use std::collections::HashMap;

use glam::Vec3;

use crate::numbering::Numbering;
use crate::{Mesh, MeshError};

/// The criterion by which [`Mesh::welded`] merges vertices. By default, all attributes must be equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weld {
    /// The distance up to which positions are merged, in the mesh's units; 0, a negative number and NaN require equal
    /// ones.
    ///
    /// A vertex joins the first one within the distance that has not joined another, so that rows of close vertices do
    /// not run together.
    pub distance: f32,
    /// The step to which normals, texture coordinates, colours and tangents are rounded before they are compared: 0
    /// requires equal ones, `None` ignores them.
    pub attributes: Option<f32>,
}

impl Default for Weld {
    fn default() -> Self {
        Self { distance: 0.0, attributes: Some(0.0) }
    }
}

impl Weld {
    /// Merges vertices up to this distance, whatever their attributes.
    pub fn positions(distance: f32) -> Self {
        Self { distance, attributes: None }
    }
}

/// The changes made by [`Mesh::welded`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WeldReport {
    /// Vertices merged with an earlier one.
    pub merged_vertices: usize,
    /// Triangles dropped because two of their corners became one position.
    pub collapsed_triangles: usize,
}

/// The words of a vertex: its position, then normal, texture coordinates, colour and tangent.
type VertexKey = [u32; 16];

impl Mesh {
    /// The mesh with equal vertices merged by `weld`, and without the triangles that this collapses.
    ///
    /// The first of the merged vertices stays. If attributes are ignored it takes the mean of their normals, unless
    /// that vanishes, and tangents are dropped; its other attributes stay.
    ///
    /// ```
    /// use halfway_mesh::{Cuboid, Mesh, Weld};
    ///
    /// // Three vertices at each corner, one for each side.
    /// let cube = Mesh::from(Cuboid::default());
    /// let (welded, report) = cube.welded(Weld::positions(0.0))?;
    /// assert_eq!((welded.positions().len(), report.merged_vertices), (8, 16));
    /// # Ok::<(), halfway_mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// Every triangle collapses.
    pub fn welded(&self, weld: Weld) -> Result<(Self, WeldReport), MeshError> {
        let places = places(self.positions(), weld.distance);
        let vertices = match weld.attributes {
            None => Numbering::new(places.len(), |vertex| [places[vertex]]),
            Some(step) if step > 0.0 => {
                // Casts saturate.
                let word = |x: f32| ((f64::from(x) / f64::from(step)).round() as i32).cast_unsigned();
                Numbering::new(places.len(), |vertex| self.vertex_key(vertex, &places, word))
            }
            Some(_) => self.identical_vertices(&places),
        };
        let triangles = self.triangles().filter(|triangle| {
            let [a, b, c] = triangle.map(|i| places[i as usize]);
            a != b && b != c && c != a
        });
        let indices: Vec<u32> = triangles.flatten().map(|i| vertices.numbers[i as usize]).collect();
        if indices.is_empty() {
            return Err(MeshError::NoTriangles);
        }
        let report = WeldReport {
            merged_vertices: places.len() - vertices.count(),
            collapsed_triangles: self.triangle_count() - indices.len() / 3,
        };
        let positions = vertices.firsts.iter().map(|&vertex| self.positions()[places[vertex as usize] as usize]);
        let positions = positions.collect();
        let mut mesh = self.selected(&vertices.firsts, indices).with_given_positions(positions);
        if weld.attributes.is_none() {
            mesh = mesh.with_given_normals(self.mean_normals(&vertices));
        }
        Ok((mesh, report))
    }

    /// Numbers the vertices that are equal in all attributes; `places` are those of their positions.
    pub(crate) fn identical_vertices(&self, places: &[u32]) -> Numbering {
        Numbering::new(places.len(), |vertex| self.vertex_key(vertex, places, |x| (x + 0.0).to_bits()))
    }

    fn vertex_key(&self, vertex: usize, places: &[u32], word: impl Fn(f32) -> u32) -> VertexKey {
        let mut key = [0; 16];
        key[0] = places[vertex];
        key[1..4].copy_from_slice(&self.normals()[vertex].to_array().map(&word));
        if let Some(uvs) = self.uvs() {
            key[4..6].copy_from_slice(&uvs[vertex].to_array().map(&word));
        }
        if let Some(colors) = self.colors() {
            key[6..10].copy_from_slice(&colors[vertex].to_array().map(&word));
        }
        if let Some(tangents) = self.tangents() {
            key[10..14].copy_from_slice(&tangents[vertex].to_array().map(&word));
        }
        if let Some(uvs) = self.uv_set(1) {
            key[14..16].copy_from_slice(&uvs[vertex].to_array().map(&word));
        }
        key
    }

    /// The mean normal of the vertices of each number; the first's where it vanishes.
    fn mean_normals(&self, vertices: &Numbering) -> Vec<Vec3> {
        let mut sums = vec![Vec3::ZERO; vertices.count()];
        for (n, &number) in self.normals().iter().zip(&vertices.numbers) {
            sums[number as usize] += n;
        }
        let first = |number: usize| self.normals()[vertices.firsts[number] as usize];
        sums.iter().enumerate().map(|(number, sum)| sum.try_normalize().unwrap_or_else(|| first(number))).collect()
    }
}

/// The vertex that each vertex is merged with: the first within the distance that was not merged itself.
pub(super) fn places(positions: &[Vec3], distance: f32) -> Vec<u32> {
    let exact = Numbering::from_positions(positions);
    let mut owners = exact.firsts.clone();
    if distance > 0.0 {
        let distance = f64::from(distance);
        // Cells four times as wide as the distance, by the bits of their whole numbers, which may be too large for an
        // integer. A cell holds few targets: they lie further apart than a quarter of it.
        let width = 4.0 * distance;
        let mut cells: HashMap<[u64; 3], Vec<u32>> = HashMap::new();
        for owner in &mut owners {
            let p = positions[*owner as usize].as_dvec3();
            let cell = (p / width).floor();
            let [low, high] = [-distance, distance].map(|reach| ((p + reach) / width).floor());
            let near = (0..8).find_map(|i| {
                let is_high = glam::BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0);
                // If both are one cell, it is searched once.
                if (is_high & low.cmpeq(high)).any() {
                    return None;
                }
                let key = glam::DVec3::select(is_high, high, low).to_array().map(|x| (x + 0.0).to_bits());
                let mut owners = cells.get(&key)?.iter();
                owners.find(|&&other| positions[other as usize].as_dvec3().distance(p) <= distance).copied()
            });
            match near {
                Some(other) => *owner = other,
                None => cells.entry(cell.to_array().map(|x| (x + 0.0).to_bits())).or_default().push(*owner),
            }
        }
    }
    exact.numbers.iter().map(|&number| owners[number as usize]).collect()
}
