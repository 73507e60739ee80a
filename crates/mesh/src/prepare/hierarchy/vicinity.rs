//! What is around a vertex, and what is lost where it moves onto a neighbour.

use bevy_math::{DVec3, Vec3, Vec4};

use super::four_vectors::FourVectors;
use crate::prepare::nearest::nearest_on;

/// Places with more triangles stay: they are looked at with each of their neighbours.
pub(super) const MOST_AROUND: usize = 64;

/// A triangle may turn by so much at once, as a cosine.
const TURN: f32 = 0.3;

/// The cosine between a triangle and the mean of those around its vertex, which none falls below if it was above. Else
/// three vertices of a row, moved by noise, make a triangle that stands upright: no surface lies over it, so that how
/// far off it is is hardly known.
const FACING: f32 = 0.6;

/// How much of a loss the distance of the vertex that goes from the triangles that stay is.
const GAP_WEIGHT: f32 = 2.0;

/// How much of a loss the edge is by which a vertex moves, so that triangles stay round where all is flat. A sphere of
/// radius 1 is off by a sixth of the edge's square.
const EDGE_WEIGHT: f64 = 1e-3;

/// A normal that changes by so much, as a difference of unit vectors, counts twice, and more than that the cube of it:
/// else a few small parts, cheap by their size, would lose their shading at once.
const SHARP_TURN: f32 = 0.25;

/// A triangle around a place.
#[derive(Clone, Copy)]
struct FanCorner {
    /// The triangle's vertex at the fan's place, and the two after it.
    vertices: [u32; 3],
    /// The neighbours that those two are.
    ends: [u8; 2],
}

/// A place that shares edges with the fan's place.
#[derive(Clone, Copy)]
pub(super) struct Neighbour {
    pub(super) place: u32,
    /// The vertex that the fan's triangles have there; `SEVERAL` if it is not the same one for all.
    vertex: u32,
    /// How many of the fan's triangles have it.
    pub(super) triangles: u32,
    /// Where it is from the fan's place.
    offset: Vec3,
    /// What is lost at least by collapsing onto it.
    pub(super) base: f64,
}

const SEVERAL: u32 = u32::MAX;

/// The sides of four of a fan's triangles across from the fan's place; the last of a fan may be one side more than
/// once.
struct FourSides {
    /// Of the fan.
    corners: [u8; 4],
    /// The numbers of the neighbours at their ends.
    ends: [Vec4; 2],
    from: FourVectors,
    to: FourVectors,
    side: FourVectors,
    /// The squares of their lengths.
    length2: Vec4,
    /// Across the triangles, as long as twice their areas, and what the square of that counts for a turn.
    across: FourVectors,
    turn2: Vec4,
    /// The least square, with its sign, of the cosine between the fan's normal and each triangle that takes one's
    /// place.
    facing2: Vec4,
    normals: [FourVectors; 2],
}

/// What is around a place. Lengths are parts of that of the longest edge there, so that no squares of areas under- or
/// overflow.
#[derive(Default)]
pub(super) struct Vicinity {
    fan: Vec<FanCorner>,
    pub(super) around: Vec<Neighbour>,
    sides: Vec<FourSides>,
    /// That longest edge.
    unit: f64,
    /// The square of the spread of normals that each triangle counts with at least: see
    /// [`least_spread`](super::roughness::least_spread).
    least_spread2: f32,
    /// Whether all of the fan's triangles have one vertex at the fan's place.
    has_one_vertex: bool,
    /// Of each place the number of the neighbour that it is, from 1; 0 if it is none.
    numbers: Vec<u8>,
    /// The mean of its triangles' normals by their areas, of unit length; zero where it has none.
    normal: Vec3,
    /// The neighbours by what collapsing onto them loses, more or less: its bits, and the neighbour's number.
    pub(super) targets: Vec<(u32, u8)>,
}

/// Vertices of the place that moves, and those that take their triangles. Most places have one vertex.
#[derive(Default)]
pub(super) struct Moves {
    first: Option<(u32, u32)>,
    others: Vec<(u32, u32)>,
}

impl Moves {
    fn push(&mut self, from: u32, to: u32) {
        match self.first {
            None => self.first = Some((from, to)),
            Some(_) => self.others.push((from, to)),
        }
    }

    /// The vertex that takes the triangles of this one, if there is one.
    pub(super) fn target(&self, vertex: u32) -> Option<u32> {
        let (from, to) = self.first?;
        let other = || self.others.iter().find(|(from, _)| *from == vertex).map(|&(_, to)| to);
        if from == vertex { Some(to) } else { other() }
    }
}

/// The squares of the greatest differences between one of three normals and their mean.
fn spread2(a: FourVectors, b: FourVectors, c: FourVectors) -> Vec4 {
    let mean = (a + b + c) * (1.0 / 3.0);
    let [a, b, c] = [a, b, c].map(|n| (n - mean).length_squared());
    a.max(b).max(c)
}

fn signed_square(x: Vec4) -> Vec4 {
    x * x.abs()
}

impl Vicinity {
    /// Of one of N places.
    pub(super) fn new(places: usize, least_spread: f32) -> Self {
        Self { numbers: vec![0; places], least_spread2: least_spread * least_spread, ..Self::default() }
    }

    pub(super) fn clear(&mut self) {
        for neighbour in &self.around {
            self.numbers[neighbour.place as usize] = 0;
        }
        self.fan.clear();
        self.around.clear();
        self.has_one_vertex = true;
    }

    /// Adds one of up to [`MOST_AROUND`] triangles of the fan by its corners, from that at the fan's place on: their
    /// vertices, and the places of the second and the third.
    pub(super) fn add(&mut self, vertices: [u32; 3], places: [u32; 2]) {
        let ends = [self.end(places[0], vertices[1]), self.end(places[1], vertices[2])];
        self.has_one_vertex &= self.fan.first().is_none_or(|first| first.vertices[0] == vertices[0]);
        self.fan.push(FanCorner { vertices, ends });
    }

    /// The number of a neighbour that one more triangle has.
    fn end(&mut self, place: u32, vertex: u32) -> u8 {
        let number = &mut self.numbers[place as usize];
        if *number == 0 {
            self.around.push(Neighbour { place, vertex, triangles: 1, offset: Vec3::ZERO, base: 0.0 });
            *number = self.around.len() as u8;
        } else {
            let neighbour = &mut self.around[usize::from(*number - 1)];
            neighbour.triangles += 1;
            if neighbour.vertex != vertex {
                neighbour.vertex = SEVERAL;
            }
        }
        *number - 1
    }

    /// The number of the neighbour that a place is.
    pub(super) fn number(&self, place: u32) -> Option<usize> {
        self.numbers[place as usize].checked_sub(1).map(usize::from)
    }

    pub(super) fn triangles(&self) -> usize {
        self.fan.len()
    }

    /// Which vertex of a neighbour each vertex of the fan's place becomes: the one that it shares an edge with. None if
    /// a vertex has none there, or two.
    pub(super) fn moves(&self, target: usize) -> Option<Moves> {
        let mut moves = Moves::default();
        let first = self.fan.first()?.vertices[0];
        if self.has_one_vertex {
            let to = self.around[target].vertex;
            moves.push(first, to);
            return (to != SEVERAL).then_some(moves);
        }
        for FanCorner { vertices: [a, b, c], ends } in &self.fan {
            let to = match ends.map(|end| usize::from(end) == target) {
                [true, _] => *b,
                [_, true] => *c,
                _ => continue,
            };
            match moves.target(*a) {
                None => moves.push(*a, to),
                Some(other) if other != to => return None,
                Some(_) => {}
            }
        }
        self.fan.iter().all(|corner| moves.target(corner.vertices[0]).is_some()).then_some(moves)
    }

    /// Measures what is around a place at `p`.
    pub(super) fn measure(&mut self, p: DVec3, positions: &[DVec3], normals: &[Vec3]) {
        let Self { fan, around, sides, unit, normal, .. } = self;
        let mut longest2 = 0.0_f64;
        for neighbour in &mut *around {
            let offset = positions[neighbour.place as usize] - p;
            longest2 = longest2.max(offset.length_squared());
            neighbour.offset = offset.as_vec3();
        }
        *unit = longest2.sqrt();
        let per_unit = (1.0 / *unit) as f32;
        for neighbour in &mut *around {
            neighbour.offset *= per_unit;
        }
        sides.clear();
        let mut areas = Vec3::ZERO;
        for start in (0..fan.len()).step_by(4) {
            let mut corners = [start as u8; 4];
            let (mut numbers, mut offsets) = ([[0.0; 4]; 2], [[Vec3::ZERO; 4]; 2]);
            let mut side_normals = [[Vec3::ZERO; 4]; 2];
            for lane in 0..4 {
                let is_one_more = start + lane < fan.len();
                let number = if is_one_more { start + lane } else { start };
                corners[lane] = number as u8;
                let corner = &fan[number];
                for end in 0..2 {
                    numbers[end][lane] = f32::from(corner.ends[end]);
                    offsets[end][lane] = around[usize::from(corner.ends[end])].offset;
                    side_normals[end][lane] = normals[corner.vertices[1 + end] as usize];
                }
                if is_one_more {
                    areas += offsets[0][lane].cross(offsets[1][lane]);
                }
            }
            let (from, to) = (FourVectors::new(offsets[0]), FourVectors::new(offsets[1]));
            let (side, across) = (to - from, from.cross(to));
            sides.push(FourSides {
                corners,
                ends: [Vec4::from_array(numbers[0]), Vec4::from_array(numbers[1])],
                from,
                to,
                side,
                length2: side.length_squared(),
                across,
                turn2: TURN * TURN * across.length_squared(),
                facing2: Vec4::ZERO,
                normals: [FourVectors::new(side_normals[0]), FourVectors::new(side_normals[1])],
            });
        }
        *normal = areas.normalize_or_zero();
        for four in sides {
            let along = four.across.dot(FourVectors::splat(*normal));
            let least = Vec4::splat(FACING * FACING);
            let faces = signed_square(along).cmpge(least * four.across.length_squared());
            four.facing2 = Vec4::select(faces, least, Vec4::NEG_INFINITY);
        }
    }

    /// Puts the neighbours in the order in which they are looked at, those first that promise to lose least: then
    /// others can be left sooner. `distance` is how far a place is from the planes of the original triangles, in the
    /// mean.
    pub(super) fn order_targets(&mut self, normals: &[Vec3], distance: impl Fn(u32) -> f64) {
        let Self { fan, around, targets, unit, .. } = self;
        let Some(n) = fan.first().map(|corner| normals[corner.vertices[0] as usize]) else { return };
        targets.clear();
        for (number, neighbour) in (0..).zip(around) {
            let length = neighbour.offset.length();
            neighbour.base = distance(neighbour.place) + EDGE_WEIGHT * (*unit * f64::from(length)).powi(2);
            let turn = normals.get(neighbour.vertex as usize).map_or(0.0, |other| n.distance(*other));
            targets.push((((neighbour.base / *unit) as f32 + turn * length).to_bits(), number));
        }
        targets.sort_unstable();
    }

    /// What collapsing the measured place onto a neighbour loses, unless it is no less than `most`, it turns a triangle
    /// over or a seam would tear.
    ///
    /// A length, the sum of: how far the new position is from the planes of the original triangles, in the mean; how
    /// far the old position is from the new triangles, which the mean may hide; the spread of the new triangles'
    /// normals, of rough surfaces a large one for all, and the change of the normal at the old position (see
    /// [`SHARP_TURN`]), both times the longest edge. So what is small may be cut coarsely, and on a sphere, or where
    /// all is rough, all triangles become alike.
    pub(super) fn loss(&self, target: usize, most: f64, normals: &[Vec3]) -> Option<f64> {
        let base = self.around[target].base;
        if base >= most {
            return None;
        }
        let moves = self.moves(target)?;
        let q = FourVectors::splat(self.around[target].offset);
        let number = Vec4::splat(target as f32);
        let normal = |vertex: u32| normals[vertex as usize];
        let moved = |corner: u8| {
            let vertex = self.fan[usize::from(corner)].vertices[0];
            normal(moves.target(vertex).unwrap_or(vertex))
        };
        let one = if moves.others.is_empty() { Some(FourVectors::splat(moved(0))) } else { None };
        let most_bulge = ((most - base) / self.unit) as f32;
        let mut bulge2 = 0.0_f32;
        for four in &self.sides {
            let goes = four.ends[0].cmpeq(number) | four.ends[1].cmpeq(number);
            let from = q - four.from;
            let after = four.side.cross(from);
            let dot = four.across.dot(after);
            let turns = dot.cmple(Vec4::ZERO) | (dot * dot).cmple(four.turn2 * after.length_squared());
            let along = after.dot(FourVectors::splat(self.normal));
            let turns = turns | signed_square(along).cmplt(four.facing2 * after.length_squared());
            if (turns & !goes).any() {
                return None;
            }
            let longest2 = four.length2.max(from.length_squared()).max((q - four.to).length_squared());
            let moved = one.unwrap_or_else(|| FourVectors::new(four.corners.map(moved)));
            let spread2 = spread2(moved, four.normals[0], four.normals[1]).max(Vec4::splat(self.least_spread2));
            let bulges2 = spread2 * longest2;
            bulge2 = bulge2.max(Vec4::select(goes, Vec4::ZERO, bulges2).max_element());
            if bulge2 >= most_bulge * most_bulge {
                return None;
            }
        }
        // An ear, or a piece of one triangle, would be gone.
        let (gap2, corner, weights) = self.nearest(target)?;
        let FanCorner { vertices: [a, b, c], ends } = self.fan[usize::from(corner)];
        let [from, to] = ends.map(|end| self.around[usize::from(end)].offset);
        let q = self.around[target].offset;
        let longest2 = from.distance_squared(to).max(q.distance_squared(from)).max(q.distance_squared(to));
        let n = weights[0] * moved(corner) + weights[1] * normal(b) + weights[2] * normal(c);
        let by = n.distance(normal(a));
        let turn = by * (1.0 + (by / SHARP_TURN).powi(2)) * longest2.sqrt();
        let loss = base + self.unit * f64::from(bulge2.sqrt() + GAP_WEIGHT * gap2.sqrt() + turn);
        (loss < most).then_some(loss)
    }

    /// Of the triangles that stay where the place is collapsed onto a neighbour the one that is nearest to it: the
    /// square of its distance, its corner in the fan, and the weights of its corners at the nearest point.
    fn nearest(&self, target: usize) -> Option<(f32, u8, [f32; 3])> {
        let q = FourVectors::splat(self.around[target].offset);
        let number = Vec4::splat(target as f32);
        let mut nearest: Option<(f32, u8, [f32; 3])> = None;
        for four in &self.sides {
            let after = four.side.cross(q - four.from);
            let weights = [after.dot(four.across), after.dot(four.to.cross(q)), after.dot(q.cross(four.from))];
            let is_over = weights[1].cmpge(Vec4::ZERO) & weights[2].cmpge(Vec4::ZERO);
            let goes = four.ends[0].cmpeq(number) | four.ends[1].cmpeq(number);
            if !(is_over & !goes).any() {
                continue;
            }
            let area2 = after.length_squared();
            let height = after.dot(four.from);
            let gaps2 = Vec4::select(is_over & !goes, height * height / area2, Vec4::INFINITY);
            let lane = gaps2.min_position();
            if gaps2[lane] < nearest.map_or(f32::INFINITY, |(gap2, ..)| gap2) {
                nearest = Some((gaps2[lane], four.corners[lane], weights.map(|weight| weight[lane] / area2[lane])));
            }
        }
        nearest.or_else(|| self.nearest_beside(target))
    }

    /// The same where the place is over none of them.
    fn nearest_beside(&self, target: usize) -> Option<(f32, u8, [f32; 3])> {
        let stays = |corner: &FanCorner| corner.ends.iter().all(|&end| usize::from(end) != target);
        let offset = |number: usize| self.around[number].offset.as_dvec3();
        let each = (0..).zip(&self.fan).filter(|(_, corner)| stays(corner)).map(|(number, corner)| {
            let [from, to] = corner.ends.map(|end| offset(usize::from(end)));
            let (gap2, weights) = nearest_on(DVec3::ZERO, [offset(target), from, to]);
            (gap2 as f32, number, weights.map(|weight| weight as f32))
        });
        each.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}
