//! Normals that are not one a vertex: vertices are split between classes of corners.

use bevy_math::Vec3;

use super::means::Means;
use super::{NormalReport, NormalWeighting};
use crate::Mesh;
use crate::numbering::{Numbering, position_key};

/// The mesh with the normals that the smoothing groups of Wavefront OBJ ask for.
///
/// `groups` has one number a triangle; what is missing at its end counts as 0. The triangles of one group share the
/// mean of their normals at each position; those of group 0 are faceted. Vertices are split where groups meet, and the
/// vertices of no triangle are left out.
pub(crate) fn grouped_normals(mesh: &Mesh, groups: &[u32], weighting: NormalWeighting) -> (Mesh, NormalReport) {
    let (positions, indices) = (mesh.positions(), mesh.indices());
    let classes = Numbering::new(indices.len(), |corner| {
        let triangle = corner / 3;
        match groups.get(triangle).copied().unwrap_or(0) {
            0 => [triangle as u32, 0, 0, 0],
            group => {
                let [x, y, z] = position_key(positions[indices[corner] as usize]);
                [x, y, z, group]
            }
        }
    });
    split_normals(mesh, &classes.numbers, classes.count(), weighting)
}

/// The mesh with the mean normals of classes of corners, numbered below `count`; vertices are split between classes,
/// and those of no triangle are left out.
pub(crate) fn split_normals(
    mesh: &Mesh,
    classes: &[u32],
    count: usize,
    weighting: NormalWeighting,
) -> (Mesh, NormalReport) {
    let indices = mesh.indices();
    let means = Means::new(mesh.positions(), indices, count, weighting, |corner| classes[corner]);
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
            let (mesh, report) = grouped_normals(&cube(), groups, NormalWeighting::Angle);
            assert!(report.is_clean());
            assert_eq!(mesh.positions().len(), 36);
            (0..12).for_each(|triangle| assert_eq!(normals_at(&mesh, triangle), [face(&mesh, triangle); 3]));
        }
    }

    #[test]
    fn one_group_is_smooth() {
        let (mesh, report) = grouped_normals(&cube(), &[7; 12], NormalWeighting::Angle);
        assert!(report.is_clean());
        assert_eq!(mesh.positions().len(), 8);
        for (n, p) in mesh.normals().iter().zip(mesh.positions()) {
            // Rounded to f32 in each coordinate.
            assert!(n.distance(p.normalize()) < 3e-7);
        }
    }

    #[test]
    fn groups_meet_in_a_crease_and_cross_seams() {
        // Each side of the cube a group of its own, then pairs of sides; the cuboid itself has split vertices.
        for mesh in [cube(), Mesh::from(Cuboid::default())] {
            let sides: Vec<u32> = (0..12).map(|triangle| 1 + triangle / 2).collect();
            let (split, _) = grouped_normals(&mesh, &sides, NormalWeighting::Angle);
            assert_eq!(split.positions().len(), 24);
            for triangle in 0..12 {
                let expected = face(&split, triangle);
                assert!(normals_at(&split, triangle).iter().all(|n| n.distance(expected) < 1e-6));
            }
            let pairs: Vec<u32> = (0..12).map(|triangle| 1 + triangle / 4).collect();
            let (split, _) = grouped_normals(&mesh, &pairs, NormalWeighting::Angle);
            // Opposite sides make a pair: the groups share no position, and everything stays as it was.
            for triangle in 0..12 {
                let expected = face(&split, triangle);
                assert!(normals_at(&split, triangle).iter().all(|n| n.distance(expected) < 1e-6));
            }
        }
    }
}
