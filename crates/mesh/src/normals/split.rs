//! Normals with more than one at a vertex: vertices are split between classes of corners.

use glam::Vec3;

use super::means::Means;
use super::{NormalReport, NormalWeighting};
use crate::Mesh;
use crate::numbering::Numbering;

/// A mesh whose normals are computed together with those of others.
#[cfg(feature = "formats")]
pub(crate) struct Smoothed<'a> {
    pub(crate) mesh: &'a Mesh,
    /// The point of each vertex: vertices of one point, in whichever mesh, share a normal.
    pub(crate) points: &'a [u32],
    /// The smoothing group of each triangle; triangles beyond the end have group 0.
    pub(crate) groups: &'a [u32],
}

/// The meshes with the normals by the smoothing groups of Wavefront OBJ.
///
/// The triangles of one group share the mean of their normals at each point, across all the meshes; those of group 0
/// are faceted. Vertices are split where groups meet, and the vertices of no triangle are left out. All meshes together
/// have at most 2³² − 1 corners.
#[cfg(feature = "formats")]
pub(crate) fn grouped_normals(meshes: &[Smoothed], weighting: NormalWeighting) -> Vec<Mesh> {
    let (mut positions, mut points, mut indices, mut groups) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for smoothed in meshes {
        let first = positions.len() as u32;
        positions.extend_from_slice(smoothed.mesh.positions());
        points.extend_from_slice(smoothed.points);
        indices.extend(smoothed.mesh.indices().iter().map(|&i| first + i));
        groups.extend_from_slice(smoothed.groups);
        groups.resize(indices.len() / 3, 0);
    }
    let classes = Numbering::new(indices.len(), |corner| match groups[corner / 3] {
        0 => [corner as u32 / 3, 0],
        group => [points[indices[corner] as usize], group],
    });
    let class = |corner: usize| classes.numbers[corner];
    let means = Means::new(&positions, &indices, classes.count(), weighting, class);
    let mut rest = &classes.numbers[..];
    let mut made = Vec::with_capacity(meshes.len());
    for smoothed in meshes {
        let (own, others) = rest.split_at(smoothed.mesh.indices().len());
        made.push(split(smoothed.mesh, own, &means).0);
        rest = others;
    }
    made
}

/// The mesh with the mean normals of classes of corners, numbered below `count`; vertices are split between classes,
/// and those of no triangle are left out.
pub(super) fn split_normals(
    mesh: &Mesh,
    classes: &[u32],
    count: usize,
    weighting: NormalWeighting,
) -> (Mesh, NormalReport) {
    split(mesh, classes, &Means::new(mesh.positions(), mesh.indices(), count, weighting, |corner| classes[corner]))
}

/// The mesh with these means as the normals of its corners' classes.
fn split(mesh: &Mesh, classes: &[u32], means: &Means) -> (Mesh, NormalReport) {
    let indices = mesh.indices();
    let vertices = Numbering::new(indices.len(), |corner| [indices[corner], classes[corner]]);
    let mut report = means.report;
    let corners = vertices.firsts.iter().map(|&corner| corner as usize);
    let normals: Vec<Vec3> = corners.clone().map(|corner| means.normal(classes[corner], &mut report)).collect();
    let sources: Vec<u32> = corners.map(|corner| indices[corner]).collect();
    (mesh.selected(&sources, vertices.numbers).with_given_normals(normals), report)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cuboid, Weld, face_normal};

    /// The normals of one mesh whose points are its positions.
    fn grouped(mesh: &Mesh, groups: &[u32]) -> Mesh {
        let points = Numbering::from_positions(mesh.positions()).numbers;
        grouped_normals(&[Smoothed { mesh, points: &points, groups }], NormalWeighting::Angle).remove(0)
    }

    fn normals_at(mesh: &Mesh, triangle: usize) -> [Vec3; 3] {
        [0, 1, 2].map(|corner| mesh.normals()[mesh.indices()[3 * triangle + corner] as usize])
    }

    fn face(mesh: &Mesh, triangle: usize) -> Vec3 {
        let [a, b, c] = [0, 1, 2].map(|corner| mesh.positions()[mesh.indices()[3 * triangle + corner] as usize]);
        face_normal(a, b, c).unwrap()
    }

    /// A cube of eight vertices, two triangles a side.
    fn cube() -> Mesh {
        Mesh::from(Cuboid::default()).welded(Weld::positions(0.0)).unwrap().0
    }

    #[test]
    fn group_zero_is_faceted() {
        for groups in [&[0; 12][..], &[]] {
            let mesh = grouped(&cube(), groups);
            assert_eq!(mesh.positions().len(), 36);
            (0..12).for_each(|triangle| assert_eq!(normals_at(&mesh, triangle), [face(&mesh, triangle); 3]));
        }
    }

    #[test]
    fn one_group_is_smooth() {
        let mesh = grouped(&cube(), &[7; 12]);
        assert_eq!(mesh.positions().len(), 8);
        for (n, p) in mesh.normals().iter().zip(mesh.positions()) {
            // Rounded to f32 in each coordinate.
            assert!(n.distance(p.normalize()) < 3e-7);
        }
    }

    #[test]
    fn smoothing_groups_crease_and_cross_seams() {
        // Each side of the cube a group of its own, then pairs of sides; the cuboid itself has split vertices.
        for mesh in [cube(), Mesh::from(Cuboid::default())] {
            let sides: Vec<u32> = (0..12).map(|triangle| 1 + triangle / 2).collect();
            let split = grouped(&mesh, &sides);
            assert_eq!(split.positions().len(), 24);
            for triangle in 0..12 {
                let expected = face(&split, triangle);
                assert!(normals_at(&split, triangle).iter().all(|n| n.distance(expected) < 1e-6));
            }
            let pairs: Vec<u32> = (0..12).map(|triangle| 1 + triangle / 4).collect();
            let split = grouped(&mesh, &pairs);
            // Opposite sides make a pair: the groups share no position, and everything stays as it was.
            for triangle in 0..12 {
                let expected = face(&split, triangle);
                assert!(normals_at(&split, triangle).iter().all(|n| n.distance(expected) < 1e-6));
            }
        }
    }
}
