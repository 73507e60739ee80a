//! Normals that suit a mesh of which nothing but its triangles is known.

#[cfg(feature = "formats")]
use glam::Mat4;
use glam::Vec3;

#[cfg(feature = "formats")]
use super::creased_normals;
use super::{NormalWeighting, Normals, face_normal, face_normals};
use crate::Mesh;
#[cfg(feature = "formats")]
use crate::Model;
use crate::edges::Edges;
use crate::numbering::Numbering;
use rayon::prelude::*;

/// Degrees of a bin of the histogram of angles between neighbouring triangles.
const BIN: usize = 5;
/// The bins of the valley: three neighbours, the lowest of them from 25° to 55°.
const VALLEY: usize = 3;
const LOWEST: std::ops::RangeInclusive<usize> = 25 / BIN..=55 / BIN;
/// Edges sharper than this are folds of a faulty mesh, in degrees.
const FOLDED: usize = 150;
/// Beyond the valley there are so many times as many edges as in it, at least.
const CONTRAST: usize = 8;
/// Of so many edges one at least is sharp.
const SCARCE: usize = 2000;
/// Of meshes with twice as many triangles as this half of the edges are counted, and so on.
const COUNTED: usize = 1 << 13;
/// Of some of the edges at least so many are sharp, since fewer may be so by chance.
const CHANCE: usize = 24;

impl Mesh {
    /// The normals that suit the shape: [creased](Normals::Creased) for a made part, whose faces meet in sharp edges, and
    /// the [default weighting](NormalWeighting) for a scan or a sculpture, which is smooth all over.
    ///
    /// The histogram of the angles between neighbouring triangles decides, in bins of 5°. In a scan few neighbours
    /// differ much, and the more they differ the fewer they are. In a made part the sharp edges stand apart: between
    /// them and the small steps of its rounded faces is a valley. The valley is sought in three neighbouring bins, 15°
    /// wide, that begin at 25° to 55°. The mesh is a made part if at least one edge in 2000 is beyond the emptiest of
    /// them, and these are at least eight times as many as those in it; it is creased at the middle of the valley.
    /// Edges of more than 150° do not count, since they are folds of faulty scans. Of meshes of more than 16,384 triangles
    /// only the edges at some of the points are counted, 12,000 at least, and 24 of them have to be sharp.
    ///
    /// ```
    /// use halfway_mesh::{Cuboid, Icosphere, Mesh, NormalWeighting, Normals};
    ///
    /// let part = Mesh::from(Cuboid::default()).suited_normals();
    /// assert!(matches!(part, Normals::Creased { .. }));
    /// let ball = Mesh::from(Icosphere { radius: 1.0, divisions: 8 }).suited_normals();
    /// assert_eq!(ball, Normals::Weighted(NormalWeighting::default()));
    /// ```
    pub fn suited_normals(&self) -> Normals {
        let weighting = NormalWeighting::default();
        match self.crease() {
            Some(degrees) => Normals::Creased { angle: degrees.to_radians(), weighting },
            None => Normals::Weighted(weighting),
        }
    }

    /// The angle above which edges are sharp, in degrees; `None` where no edges stand apart.
    fn crease(&self) -> Option<f32> {
        let halvings = self.halvings();
        let (taken, edges) = self.some_edges(&self.points(), halvings);
        // Where most triangles are asked for, and each by several edges.
        let all = if halvings < 2 { face_normals(self.positions(), self.indices()) } else { Vec::new() };
        let normal = |pass: u32| {
            let triangle = taken[pass as usize / 3] as usize;
            let made = || {
                let [a, b, c] = self.indices().as_chunks::<3>().0[triangle].map(|i| self.positions()[i as usize]);
                face_normal(a, b, c)
            };
            all.get(triangle).map_or_else(made, |n| Some(*n).filter(|n| *n != Vec3::ZERO)).map(Vec3::as_dvec3)
        };
        let counted = edges.par_parts().map(|edges_of_part| {
            let mut bins = [0_usize; 180 / BIN + 1];
            for edge in edges_of_part {
                let Some([a, b]) = edges.regular(&edge) else { continue };
                let (Some(a), Some(b)) = (normal(a), normal(b)) else { continue };
                let degrees = a.cross(b).length().atan2(a.dot(b)).to_degrees();
                bins[degrees as usize / BIN] += 1;
            }
            bins
        });
        let none = || [0_usize; 180 / BIN + 1];
        let bins = counted.reduce(none, |a, b| std::array::from_fn(|bin| a[bin] + b[bin]));
        let count: usize = bins.iter().sum();
        let inside = |first: usize| bins[first..first + VALLEY].iter().sum::<usize>();
        let first = LOWEST.min_by_key(|&first| inside(first))?;
        let beyond: usize = bins[first + VALLEY..FOLDED / BIN].iter().sum();
        let least = if halvings == 0 { 1 } else { CHANCE };
        let is_made = beyond >= least && beyond * SCARCE >= count && beyond >= CONTRAST * inside(first);
        is_made.then_some((BIN * first) as f32 + 0.5 * (BIN * VALLEY) as f32)
    }

    /// Whether it has a border: an edge, told apart by the positions of its ends, of one triangle only.
    ///
    /// ```
    /// use halfway_mesh::{Cuboid, Mesh, Plane};
    ///
    /// assert!(Mesh::from(Plane::default()).is_open() && !Mesh::from(Cuboid::default()).is_open());
    /// ```
    pub fn is_open(&self) -> bool {
        let points = self.points();
        // Where every edge has an even number of triangles, the numbers of all ends cancel out; that they do so
        // elsewhere is less likely than a fault of the machine.
        let sum_of = |triangles: &[[u32; 3]]| {
            let sides = triangles.iter().map(|triangle| triangle.map(|vertex| points.numbers[vertex as usize]));
            let sides = sides.flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).filter(|[from, to]| from != to);
            sides.fold(0, |sum, [a, b]| sum ^ scattered(u64::from(a.min(b)) << 32 | u64::from(a.max(b))))
        };
        let triangles = self.indices().as_chunks().0;
        let sum = triangles.par_chunks(1 << 16).map(sum_of).reduce(|| 0, |a, b| a ^ b);
        let has_border = |halvings: u32| {
            let (_, edges) = self.some_edges(&points, halvings);
            edges.iter().any(|edge| edge.passes.len() == 1)
        };
        let halvings = self.halvings();
        // A border is soon found at some of the points; if it is not, all are looked at.
        sum != 0 && ((halvings > 0 && has_border(halvings)) || has_border(0))
    }

    /// How many times the points are halved, at whose share of a power of two edges are looked at.
    fn halvings(&self) -> u32 {
        (self.triangle_count() / COUNTED).checked_ilog2().unwrap_or(0).min(20)
    }

    /// The edges at some of the points, whose passes are of the triangles whose numbers are given.
    fn some_edges(&self, points: &Numbering, halvings: u32) -> (Vec<u32>, Edges) {
        // Neighbours in the numbering are often neighbours in space, so the product scatters them.
        let is_taken = |point: u32| halvings == 0 || point.wrapping_mul(0x9e37_79b1) >> (32 - halvings) == 0;
        let triangles = self.indices().as_chunks::<3>().0;
        if halvings == 0 {
            return ((0..triangles.len() as u32).collect(), Edges::new(points.triangles(self.indices())));
        }
        let around = triangles.par_iter().enumerate().with_min_len(1 << 14).filter_map(|(number, triangle)| {
            let triangle = triangle.map(|vertex| points.numbers[vertex as usize]);
            triangle.into_iter().any(is_taken).then_some((number as u32, triangle))
        });
        let (numbers, triangles): (Vec<_>, Vec<_>) = around.unzip();
        (numbers, Edges::at_points(triangles, is_taken))
    }
}

/// The finalizer of `SplitMix64` (Steele, Lea and Flood 2014), in which every bit depends on all.
fn scattered(key: u64) -> u64 {
    let key = key.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let key = (key ^ key >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let key = (key ^ key >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    key ^ key >> 31
}

#[cfg(feature = "formats")]
impl Model {
    /// Gives the parts that have no normals of the file's own those that [suit](Mesh::suited_normals) all of them
    /// together, so that a border between two materials is no crease. Parts placed by a transform are each by itself.
    pub fn make_auto_normals(&mut self) {
        let lack = |model: &Self, i: usize| !model.parts[i].mesh.has_given_normals();
        let mut joined: Vec<usize> = (0..self.parts.len()).filter(|&i| lack(self, i)).collect();
        let sum = |parts: &[usize], size: fn(&Mesh) -> usize| -> usize {
            parts.iter().map(|&i| size(&self.parts[i].mesh)).sum()
        };
        let are_too_many = u32::try_from(sum(&joined, |mesh| mesh.indices().len())).is_err()
            || u32::try_from(sum(&joined, |mesh| mesh.positions().len())).is_err();
        let are_placed = joined.iter().any(|&i| self.parts[i].world_from_part != Mat4::IDENTITY);
        if joined.len() < 2 || are_placed || are_too_many {
            for i in joined.drain(..) {
                let mesh = &mut self.parts[i].mesh;
                *mesh = mesh.clone().with_normals(Normals::Auto).0;
            }
            return;
        }
        let (mut positions, mut indices) = (Vec::new(), Vec::new());
        for &i in &joined {
            let mesh = &self.parts[i].mesh;
            let first = positions.len() as u32;
            positions.extend_from_slice(mesh.positions());
            indices.extend(mesh.indices().iter().map(|&index| first + index));
        }
        let normals = vec![Vec3::Y; positions.len()];
        let whole = Mesh::checked(positions, normals, None, indices);
        let Normals::Creased { angle, weighting } = whole.suited_normals() else { return };
        let (creased, _) = creased_normals(&whole, angle, weighting);
        let corner_normal = |corner: usize| creased.normals()[creased.indices()[corner] as usize];
        let mut first = 0;
        for &i in &joined {
            let mesh = &self.parts[i].mesh;
            let indices = mesh.indices();
            let vertices = Numbering::new(indices.len(), |corner| {
                let [x, y, z] = corner_normal(first + corner).to_array().map(f32::to_bits);
                [indices[corner], x, y, z]
            });
            let corners = vertices.firsts.iter().map(|&corner| corner as usize);
            let normals = corners.clone().map(|corner| corner_normal(first + corner)).collect();
            let sources: Vec<u32> = corners.map(|corner| indices[corner]).collect();
            let count = indices.len();
            self.parts[i].mesh = mesh.selected(&sources, vertices.numbers).with_given_normals(normals);
            first += count;
        }
    }
}
