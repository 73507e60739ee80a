//! Levels of detail: fewer and fewer triangles between the vertices of one mesh.

use std::ops::Range;

use bevy_math::DVec3;
use rayon::prelude::*;

use super::collapse::Collapse;
use super::deviation::{Deviation, Gone, Sheet, angle};
use super::stand_ins::StandIns;
use crate::Mesh;

/// A coarser version of a mesh: fewer triangles between some of its vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Its triangles, three corners each, as numbers of the mesh's vertices: all levels share the mesh's vertices.
    pub indices: Vec<u32>,
    /// How far the level is from the mesh, in its units, at the points that [`Mesh::levels`] samples.
    pub error: f32,
    /// How far the level's interpolated normals, made unit again, are from the mesh's at the same points, in radians.
    pub normal_error: f32,
    /// The largest angle between a vertex normal of a triangle and the mean of all three, in radians: what shading at
    /// the vertices loses between them grows with its square.
    pub normal_spread: f32,
    /// The length of the longest edge, in the mesh's units; at most `f32::MAX`.
    pub longest_edge: f32,
}

/// The triangles of a level.
struct Step {
    triangles: Vec<[u32; 3]>,
    /// Which vertices went since the level before, as numbers in the order in which vertices go.
    gone: Range<usize>,
}

/// Levels with fewer triangles than this are not made.
const FEWEST: usize = 32;

/// Levels further off than this part of the radius of the box around the mesh are not made.
const FARTHEST: f64 = 0.1;

/// A level that keeps more than this part of the triangles of the one before is not worth its memory.
const WORTHWHILE: f64 = 0.93;

/// Which part of so many triangles the next candidate for a level keeps. The errors of small meshes rise in jumps, as
/// one vertex after the other goes, and candidates cost little to measure and to keep.
fn kept_part(triangles: usize) -> f64 {
    match triangles {
        0..=512 => 0.97,
        513..=4096 => 0.85,
        4097..=32_768 => 0.7,
        _ => 0.5,
    }
}

impl Level {
    /// How many triangles there are.
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }
}

impl Mesh {
    /// The mesh itself as a level, its errors 0, for its spread and its longest edge.
    pub fn finest_level(&self) -> Level {
        self.level(self.indices().to_vec(), Deviation::default())
    }

    /// Coarser versions of the mesh, the finest first and without the mesh itself; none if it cannot be made coarser. A
    /// large mesh has levels of about half the triangles of the one before; from 32,768 triangles down they become
    /// closer. What is hardly nearer to the mesh than something coarser is left out where no more than half of the
    /// triangles go at once.
    ///
    /// Vertices go one by one, the least loss first, each onto a neighbour: a loss of shape or of shading (see
    /// [`Level::normal_spread`]), so that triangles stay where the surface or its normals bend. Vertices within 10⁻⁶ of
    /// the longest edge of the box are one place. Those of one place with the same attributes (to 10⁻⁴) become one; the
    /// others make a seam or a crease, which stays closed and goes only along itself. Borders keep their line as well,
    /// within the error. A faceted mesh is all creases: [weld](Self::welded) it first. There is no level of fewer than
    /// 32 triangles, of more than 93 % of those before, or with an error of more than a tenth of the radius of the box.
    ///
    /// Each level is measured against the mesh itself, at sampled points: at up to 8192 of the vertices that went last,
    /// at up to 8192 of those that went before them, and at up to 16384 centroids and middles of edges of the level's
    /// triangles, each sort taken evenly over its order in the mesh or the level. A vertex is compared with the level,
    /// the others with the mesh, at the nearest point that faces alike: the one with the least d² + s² |n − m|², where
    /// d is the distance, n and m are the unit interpolated normals, and s is the distance of the sample from the
    /// vertex onto which it went, of a centroid or a middle from its nearest corner. The largest d is the error and the
    /// largest angle between n and m the normal's, or that of the level before if it is larger, so that neither falls.
    /// Points between the samples may be further off. Texture coordinates, colours and tangents are not measured.
    pub fn levels(&self) -> Vec<Level> {
        let stand_ins = StandIns::new(self);
        let (steps, gone) = self.steps(&stand_ins);
        if steps.is_empty() {
            return Vec::new();
        }
        let finest = Sheet::new(self, self.indices().as_chunks().0);
        let deviation =
            |step: &Step| Sheet::new(self, &step.triangles).deviation_from(&finest, &gone, step.gone.clone());
        let deviations: Vec<Deviation> = steps.par_iter().map(deviation).collect();
        let mut worst = self.deviation_of(&stand_ins);
        let counts: Vec<usize> = steps.iter().map(|step| step.triangles.len()).collect();
        let (mut steps, mut levels) = (steps.into_iter().enumerate(), Vec::new());
        let mut before = self.triangle_count();
        while let Some(chosen) = best_within_half(&counts, &deviations, (before, worst)) {
            let Some((number, step)) = steps.find(|(number, _)| *number == chosen) else { break };
            worst = worst.max(deviations[number]);
            if worst.distance > FARTHEST * f64::from(self.bounds().radius()) {
                break;
            }
            before = step.triangles.len();
            levels.push(self.level(step.triangles.into_flattened(), worst));
        }
        levels
    }

    /// What stand-ins differ by from the vertices that they stand for.
    fn deviation_of(&self, stand_ins: &StandIns) -> Deviation {
        let deviation = |(vertex, &stand_in): (usize, &u32)| {
            if vertex == stand_in as usize {
                return Deviation::default();
            }
            let [p, q] = [vertex, stand_in as usize].map(|i| self.positions()[i].as_dvec3());
            let [n, m] = [vertex, stand_in as usize].map(|i| self.normals()[i].as_dvec3());
            Deviation { distance: p.distance(q), angle: angle(n, m) }
        };
        stand_ins.vertices.iter().enumerate().map(deviation).fold(Deviation::default(), Deviation::max)
    }

    /// Fewer triangles between stand-ins, fewer than those, and so on, and the vertices that go on the way.
    fn steps(&self, stand_ins: &StandIns) -> (Vec<Step>, Gone) {
        let mut collapse = Collapse::new(self, stand_ins);
        let mut used = self.used(&collapse.triangles());
        let (mut steps, mut order) = (Vec::new(), Vec::new());
        loop {
            let before = collapse.triangle_count();
            let wanted = (kept_part(before) * before as f64) as usize;
            if wanted < FEWEST {
                break;
            }
            collapse.reduce_to(wanted);
            let left = collapse.triangle_count();
            if left < FEWEST || left == before {
                break;
            }
            let triangles = collapse.triangles();
            let still_used = self.used(&triangles);
            let first = order.len();
            let is_gone = |vertex: &u32| used[*vertex as usize] && !still_used[*vertex as usize];
            order.extend((0..used.len() as u32).filter(is_gone));
            used = still_used;
            steps.push(Step { triangles, gone: first..order.len() });
        }
        (steps, Gone::new(order, collapse.into_targets()))
    }

    /// Whether each vertex is a corner.
    fn used(&self, triangles: &[[u32; 3]]) -> Vec<bool> {
        let mut used = vec![false; self.positions().len()];
        for &vertex in triangles.as_flattened() {
            used[vertex as usize] = true;
        }
        used
    }

    fn level(&self, indices: Vec<u32>, deviation: Deviation) -> Level {
        let spread = |triangle: &[u32; 3]| {
            let normals = triangle.map(|i| self.normals()[i as usize].as_dvec3());
            let mean = normals.iter().sum::<DVec3>();
            let angles = normals.map(|n| if mean == DVec3::ZERO { std::f64::consts::PI } else { angle(n, mean) });
            angles.into_iter().fold(0.0, f64::max)
        };
        let longest2 = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|i| self.positions()[i as usize].as_dvec3());
            a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a))
        };
        let triangles = indices.as_chunks::<3>().0;
        let most = |of: &(dyn Fn(&[u32; 3]) -> f64 + Sync)| triangles.par_iter().map(of).reduce(|| 0.0, f64::max);
        let [normal_spread, longest_edge] = [most(&spread), most(&longest2).sqrt().min(f64::from(f32::MAX))];
        Level {
            error: rounded_up(deviation.distance),
            normal_error: rounded_up(deviation.angle),
            normal_spread: rounded_up(normal_spread),
            longest_edge: longest_edge as f32,
            indices,
        }
    }
}

/// After a level of so many triangles that is so far off: of the candidates that keep at least half of them, the
/// coarsest that is hardly further off than the first one that is worth its memory, or that one, also where it keeps
/// less: an odd number has no half. Longer edges may matter even where all is flat, so no more than half of the
/// triangles go at once if that can be.
fn best_within_half(counts: &[usize], deviations: &[Deviation], (before, worst): (usize, Deviation)) -> Option<usize> {
    let first = counts.iter().position(|&count| count as f64 <= WORTHWHILE * before as f64)?;
    let Deviation { distance, angle } = worst.max(deviations[first]);
    let hardly_further = Deviation { distance: 1.05 * distance, angle: 1.05 * angle };
    let half = counts.iter().rposition(|&count| 2 * count >= before).unwrap_or(first);
    (first..=half).rev().find(|&number| deviations[number].is_within(&hardly_further)).or(Some(first))
}

/// The least `f32` that is not less.
fn rounded_up(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) < x { near.next_up() } else { near }
}
