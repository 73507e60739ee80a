//! How far apart surfaces are where they cannot be compared point for point: at coarse triangles that the fine ones do
//! not cover once, as noise, folds and slivers make them.

use bevy_math::DVec3;

use super::corner_reach::corner_reach;
use super::deviation::{Deviation, angle};
use super::fine_surface::Surfaces;
use crate::prepare::nearest::{TriangleCorners, nearest_on};

/// A triangle is cut in four so often at most. A fifth time saves less than 0.1 % of them.
const CUTS: u32 = 4;

/// What is this small, in parts of its distance, is cut no more.
const SMALL: f64 = 0.1;

/// A coarse triangle that the fine ones do not cover once.
pub(super) struct Uncovered {
    /// Its number.
    pub(super) coarse: u32,
    /// The numbers of the fine ones that lie over or near it.
    pub(super) near: Vec<u32>,
}

/// The fine triangles, and which coarse ones their vertices are nearest to.
pub(super) struct FineHomes<'a> {
    /// As numbers of vertices.
    pub(super) triangles: &'a [[u32; 3]],
    /// For each of the first vertices; the others are on both surfaces.
    pub(super) homes: &'a [u32],
    /// None is further off.
    pub(super) farthest: f64,
}

impl Surfaces<'_> {
    /// What is known of the surfaces by now, and of these triangles both ways.
    pub(super) fn with_uncovered(&self, known: Deviation, uncovered: &[Uncovered], fine: &FineHomes) -> Deviation {
        let mut search = Search { most: known };
        let mut both = Vec::new();
        for Uncovered { coarse, near } in uncovered {
            let triangle = self.shaded(self.coarse[*coarse as usize]);
            let others: Vec<ShadedTriangle> = near.iter().map(|&at| self.shaded(self.fine[at as usize])).collect();
            search.look(&triangle, &others, triangle.by_corners());
            both.extend(near.iter().map(|&at| (at, *coarse)));
        }
        // The other way round normals do not count: each point of the coarse surface has its fine one.
        both.sort_unstable();
        for pairs in both.chunk_by(|a, b| a.0 == b.0) {
            let at = pairs[0].0 as usize;
            let of_vertices = fine.triangles[at].iter().filter_map(|&vertex| fine.homes.get(vertex as usize));
            let mut near: Vec<u32> = pairs.iter().map(|(_, coarse)| coarse).chain(of_vertices).copied().collect();
            near.sort_unstable();
            near.dedup();
            let others: Vec<ShadedTriangle> =
                near.iter().map(|&coarse| self.shaded(self.coarse[coarse as usize]).unshaded()).collect();
            let triangle = self.shaded(self.fine[at]).unshaded();
            let by_corners = Deviation { distance: fine.farthest + triangle.by_corners().distance, angle: 0.0 };
            search.look(&triangle, &others, by_corners);
        }
        search.most
    }

    fn shaded(&self, triangle: [u32; 3]) -> ShadedTriangle {
        ShadedTriangle { corners: self.mesh.corners(triangle), normals: self.mesh.corner_normals(triangle) }
    }
}

/// A triangle with the normals at its corners, which are interpolated.
#[derive(Clone, Copy)]
struct ShadedTriangle {
    corners: TriangleCorners,
    normals: [DVec3; 3],
}

impl ShadedTriangle {
    /// The same with normals that do not differ from others.
    fn unshaded(self) -> Self {
        Self { normals: [DVec3::Z; 3], ..self }
    }

    /// How far its points are from its corners.
    fn by_corners(&self) -> Deviation {
        let [a, b, c] = self.normals;
        let angle = angle(a, b).max(angle(b, c)).max(angle(c, a));
        Deviation { distance: corner_reach(self.corners), angle }
    }

    /// How far its points are from points of another one, all of which are no further from that than `within`: a
    /// distance from a triangle is convex, and so is largest at a corner.
    fn apart_from(&self, other: &Self, within: f64) -> Deviation {
        let by_corners = self.corners.map(|p| nearest_on(p, other.corners).0.sqrt()).into_iter().fold(0.0, f64::max);
        // What is interpolated lies in the cones of the normals, and the angle is largest between edges of them as long
        // as it is less than a right one.
        let widest = self.normals.into_iter().flat_map(|n| other.normals.map(|m| angle(n, m))).fold(0.0, f64::max);
        let angle = if widest < std::f64::consts::FRAC_PI_2 { widest } else { std::f64::consts::PI };
        Deviation { distance: by_corners.min(within), angle }
    }

    /// Its four quarters.
    fn quarters(&self) -> [Self; 4] {
        let cut = |[a, b, c]: [DVec3; 3]| {
            let [ab, bc, ca] = [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        let (corners, normals) = (cut(self.corners), cut(self.normals));
        std::array::from_fn(|k| Self { corners: corners[k], normals: normals[k] })
    }
}

/// What is known by now, which is not looked for any more.
struct Search {
    most: Deviation,
}

impl Search {
    /// Looks how far a triangle is from others; what is said `otherwise` holds as well.
    fn look(&mut self, triangle: &ShadedTriangle, others: &[ShadedTriangle], otherwise: Deviation) {
        let known = self.most;
        let otherwise = known.max(otherwise);
        if otherwise == known {
            return;
        }
        let candidates: Vec<u32> = (0..others.len() as u32).collect();
        self.look_at(triangle, others, &candidates, CUTS);
        if (otherwise.distance, otherwise.angle) < (self.most.distance, self.most.angle) {
            self.most = otherwise;
        }
    }

    /// Looks at a part of a triangle, of which no point is nearer to any other than to one of the candidates.
    fn look_at(&mut self, part: &ShadedTriangle, others: &[ShadedTriangle], candidates: &[u32], cuts: u32) {
        let center = part.corners.into_iter().sum::<DVec3>() / 3.0;
        let radius = part.corners.map(|p| p.distance(center)).into_iter().fold(0.0, f64::max);
        let distance = |&at: &u32| nearest_on(center, others[at as usize].corners).0.sqrt();
        let distances: Vec<f64> = candidates.iter().map(distance).collect();
        let nearest = distances.iter().zip(candidates).min_by(|a, b| a.0.total_cmp(b.0));
        let Some((&least, &nearest)) = nearest else {
            self.most = Deviation { distance: f64::INFINITY, angle: std::f64::consts::PI };
            return;
        };
        let found = self.most.max(part.apart_from(&others[nearest as usize], least + radius));
        if found == self.most || cuts == 0 || radius <= SMALL * least {
            self.most = found;
            return;
        }
        let near = distances.iter().zip(candidates).filter(|(distance, _)| **distance <= least + 2.0 * radius);
        let candidates: Vec<u32> = near.map(|(_, &at)| at).collect();
        for quarter in part.quarters() {
            self.look_at(&quarter, others, &candidates, cuts - 1);
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy_math::Vec3;

    use super::*;
    use crate::Mesh;

    /// Numbers from −1 to 1 that follow from no other.
    struct Hashed(u64);

    impl Hashed {
        fn next(&mut self) -> f32 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 40) as f32 / (1 << 23) as f32 - 1.0
        }

        fn point(&mut self) -> Vec3 {
            Vec3::new(self.next(), self.next(), self.next())
        }

        /// Triangles anyhow between these vertices.
        fn triangles(&mut self, count: usize, vertices: &[u32]) -> Vec<[u32; 3]> {
            let mut vertex = |_| vertices[((0.5 + 0.499 * self.next()) * vertices.len() as f32) as usize];
            (0..count).map(|_| [0; 3].map(&mut vertex)).collect()
        }
    }

    const VERTICES: u32 = 14;

    fn at([a, b, c]: [DVec3; 3], [u, v, w]: [f64; 3]) -> DVec3 {
        u * a + v * b + w * c
    }

    /// Weights of corners, in steps.
    fn steps(count: u32) -> impl Iterator<Item = [f64; 3]> {
        let weights = move |i, j| [i, j, count - i - j].map(|weight| f64::from(weight) / f64::from(count));
        (0..=count).flat_map(move |i| (0..=count - i).map(move |j| weights(i, j)))
    }

    /// Triangles anyhow, coarse ones between the corners of fine ones that do not cover them: what is said, and in the
    /// first two how far apart a point of a coarse and of a fine one are that were looked at, in the third how far the
    /// nearest normal within what is said is turned.
    fn said_and_found(seed: u64) -> (Deviation, [f64; 3]) {
        let mut hashed = Hashed(seed);
        let positions: Vec<Vec3> = (0..VERTICES).map(|_| hashed.point() * Vec3::new(1.0, 1.0, 0.2)).collect();
        let normals = (0..VERTICES).map(|_| (Vec3::Z + 0.3 * hashed.point()).normalize()).collect();
        let numbers: Vec<u32> = (0..VERTICES).collect();
        let fine = hashed.triangles(12, &numbers);
        let coarse = hashed.triangles(12, fine.as_flattened());
        let mesh = Mesh::from_parts(positions, Some(normals), None, fine.as_flattened().to_vec()).expect("a mesh");
        let surfaces =
            Surfaces { mesh: &mesh, places: &numbers, coarse: &coarse, runs: &[], fine: &fine, covered: &numbers };
        let from = |p: DVec3, others: &[[u32; 3]]| {
            let distances = others.iter().map(|&other| nearest_on(p, mesh.corners(other)).0.sqrt());
            (0..).zip(distances).min_by(|a: &(u32, f64), b| a.1.total_cmp(&b.1)).expect("triangles")
        };
        let nearest: Vec<(u32, f64)> = mesh.positions().iter().map(|p| from(p.as_dvec3(), &coarse)).collect();
        let homes: Vec<u32> = nearest.iter().map(|nearest| nearest.0).collect();
        let farthest = nearest.iter().map(|nearest| nearest.1).fold(0.0, f64::max);
        let all = |coarse| Uncovered { coarse, near: (0..fine.len() as u32).collect() };
        let uncovered: Vec<Uncovered> = (0..coarse.len() as u32).map(all).collect();
        let fine_homes = FineHomes { triangles: &fine, homes: &homes, farthest };
        let said = surfaces.with_uncovered(Deviation::default(), &uncovered, &fine_homes);

        let mut found = [0.0_f64; 3];
        for (way, of, others) in [(0, &coarse, &fine), (1, &fine, &coarse)] {
            for (&triangle, weights) in of.iter().flat_map(|of| steps(12).map(move |weights| (of, weights))) {
                let p = at(mesh.corners(triangle), weights);
                found[way] = found[way].max(from(p, others).1);
                if way == 0 {
                    let n = at(mesh.corner_normals(triangle), weights);
                    let turned = fine.iter().filter_map(|&other| {
                        let (distance2, weights) = nearest_on(p, mesh.corners(other));
                        let is_near = distance2.sqrt() <= said.distance;
                        is_near.then(|| angle(n, at(mesh.corner_normals(other), weights)))
                    });
                    found[2] = found[2].max(turned.fold(f64::INFINITY, f64::min));
                }
            }
        }
        (said, found)
    }

    #[test]
    fn every_point_has_another_within_what_is_said() {
        let (mut larger, mut of_found) = ([0; 3], 0.0);
        for seed in 0..300 {
            let (said, found) = said_and_found(seed);
            let limits = [said.distance, said.distance, said.angle];
            for way in 0..3 {
                // Rounded numbers of 64 bits.
                assert!(found[way] <= limits[way] + 1e-12, "{seed}: {found:?} where {said:?} is said");
                larger[way] += u32::from(found[way] > 0.6 * limits[way]);
            }
            of_found += said.distance / found[0].max(found[1]) / 300.0;
        }
        // Planted faults, a bound too small by two fifths, would be found by as many.
        assert!(larger[0] > 30 && larger[1] > 100 && larger[2] > 10, "{larger:?} of 300");
        assert!(of_found < 1.2, "{of_found} times what was found");
    }

    #[test]
    fn corners_bound_what_is_nowhere_near() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let triangle = ShadedTriangle { corners, normals: [DVec3::Z, DVec3::Z, DVec3::new(0.6, 0.0, 0.8)] };
        let far = ShadedTriangle { corners: corners.map(|p| p + 9.0 * DVec3::Z), ..triangle };
        let by_corners = triangle.by_corners();
        assert!((by_corners.distance - 0.5_f64.sqrt()).abs() < 1e-15, "{by_corners:?}");
        for others in [vec![], vec![far]] {
            let mut search = Search { most: Deviation::default() };
            search.look(&triangle, &others, by_corners);
            assert_eq!(search.most, by_corners);
        }
    }

    #[test]
    fn normals_beyond_a_right_angle_say_nothing() {
        let flat = |normal| ShadedTriangle { corners: [DVec3::ZERO, DVec3::X, DVec3::Y], normals: [normal; 3] };
        let found = flat(DVec3::Z).apart_from(&flat(DVec3::NEG_Z), f64::INFINITY);
        assert_eq!(found, Deviation { distance: 0.0, angle: std::f64::consts::PI });
        let found = flat(DVec3::Z).apart_from(&flat(DVec3::new(0.6, 0.0, 0.8)), f64::INFINITY);
        assert!(found.distance == 0.0 && (found.angle - 0.6_f64.asin()).abs() < 1e-15, "{found:?}");
    }
}
