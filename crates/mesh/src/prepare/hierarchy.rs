//! A hierarchy of patches: neighbouring ones joined with fewer triangles, those joined again, and so on.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use bevy_math::DVec3;

use super::box_grid::not_less;
use super::collapse::{Collapse, LocalMesh};
use super::fine_surface::Surfaces;
use super::frame::longest_edge;
use super::neighbours;
use super::open_border::open_border;
use super::overlay::Deviation;
use super::pieces::rooms;
use super::stand_ins::StandIns;
use super::widest_angle::WidestAngle;
use crate::Mesh;

/// Patches of a mesh, finer and coarser ones, of which some make up the mesh once, each part as fine as it has to be.
///
/// Groups of neighbouring patches are joined to fewer triangles, which are cut into patches again: the *parts* of a
/// group are coarser patches that cover what the patches that it *joins* cover. Their common border stays as it is, so
/// parts fit whatever stands beside them. A patch is part of one group, or finest, and each is joined by one. Where for
/// each group it is decided whether it *will do*, and all groups will do of whose parts it joins any, then those
/// patches cover the mesh once that are finest or parts of a group that will do, and that are joined by a group that
/// will not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatchHierarchy {
    /// The triangles of all patches, as numbers of the mesh's vertices.
    pub triangles: Vec<[u32; 3]>,
    /// The patches, those that one group joins together.
    pub patches: Vec<HierarchyPatch>,
    /// The groups, the finer first: the parts that a group joins are those of earlier ones. The last joins what nothing
    /// coarser stands for, and has no parts.
    pub groups: Vec<PatchGroup>,
}

/// A patch of a [`PatchHierarchy`].
#[derive(Clone, Debug, PartialEq)]
pub struct HierarchyPatch {
    /// Its triangles, of those of the hierarchy.
    pub triangles: Range<u32>,
    /// The group that it is a part of; `None` for the mesh's own triangles.
    pub part_of: Option<u32>,
}

/// Patches that are joined to coarser ones, and how far off those are. None of these numbers is smaller than that of a
/// group whose parts this one joins.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchGroup {
    /// The patches that it joins.
    pub joins: Range<u32>,
    /// No point of its parts is further from the mesh than this, and no point of the mesh's triangles for which they
    /// stand is further from its parts, in the mesh's units. Infinite for the last group.
    pub error: f32,
    /// For each point of its parts the mesh has a point within `error` of it whose interpolated normal, made unit
    /// again, is turned by no more than this, in radians; π where nothing is known.
    pub normal_error: f32,
    /// The largest angle between a vertex normal of a triangle and the mean of all three, in radians: what shading at
    /// the vertices loses between them grows with its square.
    pub normal_spread: f32,
    /// The length of the longest edge of its parts, in the mesh's units; at most `f32::MAX`.
    pub longest_edge: f32,
}

/// A mesh of up to this many triangles is one patch: cutting it would cost more draws than it saves.
const WHOLE: usize = 4096;

/// How many triangles a patch of a larger mesh has at most.
const PATCH: usize = 64;

/// Fewer triangles than this are not joined.
const FEWEST: usize = 32;

/// Groups further off than this part of the radius of the box around the mesh are not made.
const FARTHEST: f64 = 0.1;

/// Where other pieces of the mesh are closer than this number of times the error, no group is made: so neither of two
/// that move by their errors comes to lie before the other.
const ROOM: f64 = 2.0;

/// A group that keeps more than this part of its triangles is not worth its memory.
const WORTHWHILE: f64 = 0.93;

/// Which part of its triangles a group is to keep.
const KEPT: f64 = 0.5;

/// Of a mesh of one patch, fewer at a time: errors of small meshes rise in jumps, as one vertex after the other goes.
const KEPT_OF_WHOLE: f64 = 0.8;

/// After this number of joins, errors are measured against the patches then, and added to theirs: what they add is
/// small, as errors double with each join, and measuring against the mesh itself would take as long each time.
const REBASED: u32 = 3;

impl Mesh {
    /// How many triangles a patch of the mesh has at most: all, up to 4096, and else 64.
    pub fn triangles_of_a_patch(&self) -> usize {
        if self.triangle_count() <= WHOLE { WHOLE } else { PATCH }
    }

    /// The hierarchy of the mesh's patches, or `None` where `stop` has become true.
    ///
    /// A mesh of up to 4096 triangles is one patch, and is joined to ever fewer triangles as a whole. Patches of others
    /// have up to 64 triangles, and about eight are joined to half as many triangles.
    ///
    /// Vertices go one by one, the least loss first, each onto a neighbour: a loss of shape or of shading (see
    /// [`PatchGroup::normal_spread`]), so that triangles stay where the surface or its normals bend. Those at one place
    /// with the same attributes (to 10⁻⁴) become one; the others make a seam or a crease, which stays closed and goes
    /// only along itself. What is on an open border stays, for other meshes may share it. A faceted mesh is all
    /// creases:
    /// [weld](Self::welded) it first.
    ///
    /// Triangles that have corners in common, and those that have some in common with these, and so on, are one piece.
    /// Where another piece is closer than twice the [error](PatchGroup::error) of a group, that is not made: so neither
    /// comes to lie before the other.
    pub fn patch_hierarchy(&self, stop: &AtomicBool) -> Option<PatchHierarchy> {
        let mut maker = Maker::new(self);
        let mut pool = maker.finest(stop);
        while !pool.is_empty() {
            let before = pool.len();
            let (next, joined) = maker.join(pool, stop)?;
            pool = next;
            if !joined || (before == 1 && pool.is_empty()) {
                break;
            }
        }
        Some(maker.finish(pool))
    }
}

/// A patch that has not been joined yet.
struct Loose {
    /// Its number among all patches.
    number: u32,
    /// Between stand-ins, each with three places.
    triangles: Vec<[u32; 3]>,
    part_of: Option<u32>,
    /// The triangles that it is measured against, of the maker's.
    under: Vec<u32>,
    /// Those of their vertices that it stands for.
    covers: Vec<u32>,
    /// Of those triangles from the mesh.
    base: Deviation,
    /// The number of joins since.
    age: u32,
    /// How far it is at least from what is not connected with it.
    room: f64,
    /// Whether a group that was to join it would have been too far off for that. It is joined no more.
    is_stuck: bool,
}

struct Maker<'a> {
    mesh: &'a Mesh,
    stand_ins: StandIns,
    /// Of each place, whether it must stay in any case.
    stays: Vec<bool>,
    /// A length that is 1 where positions are in a cube from −1 to 1, and the middle of that.
    unit: f64,
    center: DVec3,
    /// What patches are measured against.
    references: Vec<[u32; 3]>,
    /// The triangles of each patch, and the group that it is a part of.
    patches: Vec<(Vec<[u32; 3]>, Option<u32>)>,
    /// Their `joins` are still empty.
    groups: Vec<PatchGroup>,
    /// The patches that each group joins.
    joined: Vec<Vec<u32>>,
    /// Of each vertex `u32::MAX`; for what needs a number of each.
    slots: Vec<u32>,
    is_whole: bool,
}

impl<'a> Maker<'a> {
    fn new(mesh: &'a Mesh) -> Self {
        let stand_ins = StandIns::new(mesh);
        let stays = open_border(mesh, &stand_ins);
        let (min, max) = (mesh.bounds().min.as_dvec3(), mesh.bounds().max.as_dvec3());
        let unit = (0.5 * (max - min)).max_element();
        Self {
            mesh,
            stays,
            stand_ins,
            unit: if unit > 0.0 { unit } else { 1.0 },
            center: 0.5 * (min + max),
            references: mesh.triangles().collect(),
            patches: Vec::new(),
            groups: Vec::new(),
            joined: Vec::new(),
            slots: vec![u32::MAX; mesh.positions().len()],
            is_whole: mesh.triangle_count() <= WHOLE,
        }
    }

    fn finest(&mut self, stop: &AtomicBool) -> Vec<Loose> {
        let rooms = rooms(self.mesh, &self.stand_ins.places, stop);
        let mut triangles: Vec<[u32; 3]> = self.mesh.triangles().collect();
        let runs = self.mesh.cut_into_patches(&mut triangles, self.mesh.triangles_of_a_patch());
        self.references = triangles;
        let loose = runs.into_iter().map(|run| {
            let number = self.patches.len() as u32;
            let drawn = self.references[run.clone()].to_vec();
            let triangles = self.stand_ins.triangles(&drawn).collect();
            let room = rooms.as_ref().map_or(f64::INFINITY, |rooms| self.room(&drawn, rooms));
            let loose = Loose {
                number,
                triangles,
                part_of: None,
                under: (run.start as u32..run.end as u32).collect(),
                covers: vertices(&drawn),
                base: Deviation::default(),
                age: 0,
                room,
                is_stuck: false,
            };
            self.patches.push((drawn, None));
            loose
        });
        loose.collect()
    }

    /// How far triangles are from what is not connected with them, by how far their vertices are: no point of a
    /// triangle is further from one of them than the longest edge over √3 (Jung 1901).
    fn room(&self, triangles: &[[u32; 3]], rooms: &[f64]) -> f64 {
        let of = |triangle: &[u32; 3]| {
            let corners = triangle.map(|vertex| self.mesh.positions()[vertex as usize].as_dvec3());
            let rooms = triangle.map(|vertex| rooms[self.stand_ins.places[vertex as usize] as usize]);
            rooms.into_iter().fold(f64::INFINITY, f64::min) - longest_edge(corners) / 3f64.sqrt()
        };
        triangles.iter().map(of).fold(f64::INFINITY, f64::min).max(0.0)
    }

    /// Joins what can be joined; `None` where it is to stop. Returns what is loose then, and whether anything was
    /// joined.
    fn join(&mut self, pool: Vec<Loose>, stop: &AtomicBool) -> Option<(Vec<Loose>, bool)> {
        let places: Vec<Vec<u32>> = pool.iter().map(|loose| self.places(loose)).collect();
        let (stuck, free): (Vec<_>, Vec<_>) = (0..).zip(&places).partition(|(at, _)| pool[*at as usize].is_stuck);
        let touched = free.into_iter().flat_map(|(at, places)| places.iter().map(move |&place| (place, at)));
        let groups = neighbours::group(touched.collect(), pool.len());
        // Of each place the only group that has it.
        let mut owners = vec![NOBODY; self.stand_ins.places.len()];
        for (group, members) in (0..).zip(&groups) {
            for &place in members.iter().flat_map(|&at| &places[at as usize]) {
                let owner = &mut owners[place as usize];
                *owner = if *owner == NOBODY || *owner == group { group } else { SEVERAL };
            }
        }
        for &place in stuck.into_iter().flat_map(|(_, places)| places) {
            owners[place as usize] = SEVERAL;
        }
        let mut pool: Vec<Option<Loose>> = pool.into_iter().map(Some).collect();
        let (mut next, mut joined) = (Vec::new(), false);
        for members in &groups {
            if stop.load(Ordering::Relaxed) {
                return None;
            }
            let (stuck, mut members): (Vec<Loose>, Vec<Loose>) =
                members.iter().filter_map(|&at| pool[at as usize].take()).partition(|loose| loose.is_stuck);
            next.extend(stuck);
            match self.parts(&mut members, &owners) {
                Some(parts) => {
                    joined = true;
                    next.extend(parts);
                }
                None => next.extend(members),
            }
        }
        Some((next, joined))
    }

    /// The places of a patch, each once.
    fn places(&mut self, loose: &Loose) -> Vec<u32> {
        let mut places = Vec::with_capacity(loose.triangles.len());
        for &vertex in loose.triangles.as_flattened() {
            let place = self.stand_ins.places[vertex as usize];
            if std::mem::replace(&mut self.slots[place as usize], 0) == u32::MAX {
                places.push(place);
            }
        }
        for &place in &places {
            self.slots[place as usize] = u32::MAX;
        }
        places
    }

    /// Fewer triangles in the place of some patches, cut into patches.
    fn parts(&mut self, members: &mut [Loose], owners: &[u32]) -> Option<Vec<Loose>> {
        let finer = members.iter().filter_map(|loose| loose.part_of).map(|group| &self.groups[group as usize]);
        let known = finer.map(|group| f64::from(group.error)).fold(0.0, f64::max);
        if !has_room(members, known) {
            return None;
        }
        let before: usize = members.iter().map(|loose| loose.triangles.len()).sum();
        let kept = if self.is_whole { KEPT_OF_WHOLE } else { KEPT };
        let wanted = (kept * before as f64) as usize;
        if wanted < FEWEST {
            return None;
        }
        let mut coarse = self.reduced(members, owners, wanted);
        if coarse.is_empty() || coarse.len() as f64 > WORTHWHILE * before as f64 {
            return None;
        }
        let runs = self.mesh.cut_into_patches(&mut coarse, self.mesh.triangles_of_a_patch());
        let gather = |of: fn(&Loose) -> &Vec<u32>| {
            let mut all: Vec<u32> = members.iter().flat_map(of).copied().collect();
            #[expect(clippy::stable_sort_primitive, reason = "it merges runs; those of each member are in order")]
            all.sort();
            all.dedup();
            all
        };
        let (under, covers) = (gather(|loose| &loose.under), gather(|loose| &loose.covers));
        let fine: Vec<[u32; 3]> = under.iter().map(|&number| self.references[number as usize]).collect();
        let places = &self.stand_ins.places;
        let surfaces =
            Surfaces { mesh: self.mesh, places, coarse: &coarse, runs: &runs, fine: &fine, covered: &covers };
        let base = members.iter().map(|loose| loose.base).fold(Deviation::default(), Deviation::max);
        let overlay = surfaces.overlay(self.least(members, base), &mut self.slots);
        let deviation = overlay.deviation.and(base);
        if deviation.distance > FARTHEST * f64::from(self.mesh.bounds().radius())
            || !has_room(members, deviation.distance.max(known))
        {
            return None;
        }
        let group = self.groups.len() as u32;
        self.add_group(members, &coarse, deviation);
        let room = members.iter().map(|loose| loose.room).fold(f64::INFINITY, f64::min);
        let age = 1 + members.iter().map(|loose| loose.age).max().unwrap_or(0);
        let parts = runs.iter().map(|run| {
            let number = self.patches.len() as u32;
            let triangles = coarse[run.clone()].to_vec();
            self.patches.push((triangles.clone(), Some(group)));
            let (under, covers, is_stuck) = (Vec::new(), Vec::new(), false);
            Loose { number, triangles, part_of: Some(group), under, covers, base, age, room, is_stuck }
        });
        let mut parts: Vec<Loose> = parts.collect();
        if age == REBASED && !self.is_whole {
            for part in &mut parts {
                let first = self.references.len() as u32;
                self.references.extend(&part.triangles);
                part.under = (first..self.references.len() as u32).collect();
                part.covers = vertices(&part.triangles);
                (part.base, part.age) = (deviation, 0);
            }
        } else {
            for (part, near) in parts.iter_mut().zip(overlay.near) {
                part.under.extend(near.into_iter().map(|at| under[at as usize]));
            }
            for (&vertex, home) in covers.iter().zip(overlay.homes) {
                let part = runs.partition_point(|run| run.end <= home as usize);
                parts[part].covers.push(vertex);
            }
        }
        Some(parts)
    }

    /// What the errors of a group that joins these patches are in any case, besides the base: what they are for finer
    /// ones.
    fn least(&self, members: &[Loose], base: Deviation) -> Deviation {
        let finer = members.iter().filter_map(|loose| loose.part_of).map(|group| &self.groups[group as usize]);
        let of_group = |group: &PatchGroup| Deviation {
            distance: f64::from(group.error) - base.distance,
            angle: f64::from(group.normal_error) - base.angle,
        };
        finer.map(of_group).fold(Deviation::default(), Deviation::max)
    }

    /// The patches' triangles, without vertices that cost little.
    fn reduced(&mut self, members: &[Loose], owners: &[u32], wanted: usize) -> Vec<[u32; 3]> {
        let triangles: Vec<[u32; 3]> = members.iter().flat_map(|loose| loose.triangles.iter().copied()).collect();
        let Self { mesh, stand_ins: StandIns { places, .. }, stays, slots, .. } = self;
        let place = |vertex: u32| places[vertex as usize];
        let mut vertices = Vec::with_capacity(triangles.len());
        for vertex in triangles.as_flattened().iter().flat_map(|&vertex| [vertex, place(vertex)]) {
            let slot = &mut slots[vertex as usize];
            if *slot == u32::MAX {
                *slot = vertices.len() as u32;
                vertices.push(vertex);
            }
        }
        let position = |&vertex: &u32| (mesh.positions()[vertex as usize].as_dvec3() - self.center) / self.unit;
        let is_kept = |&vertex: &u32| {
            let place = place(vertex) as usize;
            stays[place] || owners[place] == SEVERAL
        };
        let local = LocalMesh {
            positions: vertices.iter().map(position).collect(),
            normals: vertices.iter().map(|&vertex| mesh.normals()[vertex as usize]).collect(),
            places: vertices.iter().map(|&vertex| slots[place(vertex) as usize]).collect(),
            stays: vertices.iter().map(is_kept).collect(),
            triangles: triangles.iter().map(|triangle| triangle.map(|vertex| slots[vertex as usize])).collect(),
        };
        for &vertex in &vertices {
            slots[vertex as usize] = u32::MAX;
        }
        let mut collapse = Collapse::new(local);
        collapse.reduce_to(wanted);
        collapse.triangles().map(|triangle| triangle.map(|local| vertices[local as usize])).collect()
    }

    fn add_group(&mut self, members: &[Loose], coarse: &[[u32; 3]], deviation: Deviation) {
        let normals = self.mesh.normals();
        let mut spread = WidestAngle::default();
        for triangle in coarse {
            let normals = triangle.map(|i| normals[i as usize].as_dvec3());
            let mean = normals.iter().sum::<DVec3>();
            for n in normals {
                spread.add(n, mean);
            }
        }
        let longest2 = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|i| self.mesh.positions()[i as usize].as_dvec3());
            a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a))
        };
        let longest_edge = coarse.iter().map(longest2).fold(0.0, f64::max).sqrt();
        let [normal_spread, longest_edge] = [spread.angle, longest_edge].map(not_less);
        let mut group = PatchGroup {
            joins: 0..0,
            error: not_less(deviation.distance),
            normal_error: not_less(deviation.angle),
            normal_spread,
            longest_edge: longest_edge.min(f32::MAX),
        };
        for finer in members.iter().filter_map(|loose| loose.part_of) {
            let finer = &self.groups[finer as usize];
            group.error = group.error.max(finer.error);
            group.normal_error = group.normal_error.max(finer.normal_error);
            group.normal_spread = group.normal_spread.max(finer.normal_spread);
            group.longest_edge = group.longest_edge.max(finer.longest_edge);
        }
        self.groups.push(group);
        self.joined.push(members.iter().map(|loose| loose.number).collect());
    }

    /// Puts all in order.
    fn finish(mut self, pool: Vec<Loose>) -> PatchHierarchy {
        self.groups.push(PatchGroup {
            joins: 0..0,
            error: f32::INFINITY,
            normal_error: std::f32::consts::PI,
            normal_spread: std::f32::consts::PI,
            longest_edge: f32::MAX,
        });
        self.joined.push(pool.iter().map(|loose| loose.number).collect());
        let mut hierarchy = PatchHierarchy { groups: self.groups, ..PatchHierarchy::default() };
        for (group, joined) in hierarchy.groups.iter_mut().zip(self.joined) {
            let first = hierarchy.patches.len() as u32;
            for number in joined {
                let (triangles, part_of) = std::mem::take(&mut self.patches[number as usize]);
                let start = hierarchy.triangles.len() as u32;
                hierarchy.triangles.extend(triangles);
                let triangles = start..hierarchy.triangles.len() as u32;
                hierarchy.patches.push(HierarchyPatch { triangles, part_of });
            }
            group.joins = first..hierarchy.patches.len() as u32;
        }
        hierarchy
    }
}

/// Whether patches may be this far off; those are stuck that may not.
fn has_room(members: &mut [Loose], distance: f64) -> bool {
    let mut has_room = true;
    for loose in members {
        loose.is_stuck = ROOM * f64::from(not_less(distance)) > loose.room;
        has_room &= !loose.is_stuck;
    }
    has_room
}

/// Of no group, and of more than one.
const NOBODY: u32 = u32::MAX;
const SEVERAL: u32 = u32::MAX - 1;

/// The vertices of triangles, in ascending order.
fn vertices(triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut vertices = triangles.as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

impl PatchHierarchy {
    /// The number of triangles of the finest patches: those of the mesh.
    pub fn finest_count(&self) -> usize {
        let finest = self.patches.iter().filter(|patch| patch.part_of.is_none());
        finest.map(|patch| patch.triangles.len()).sum()
    }

    /// How many triangles there are where each group will do that is no further off than `error`, in the mesh's units.
    pub fn triangles_within(&self, error: f32) -> usize {
        let will_do = |group: u32| self.groups[group as usize].error <= error;
        let left = (0..).zip(&self.groups).filter(|(number, _)| !will_do(*number)).map(|(_, group)| group);
        let patches = left.flat_map(|group| &self.patches[group.joins.start as usize..group.joins.end as usize]);
        patches.filter(|patch| patch.part_of.is_none_or(will_do)).map(|patch| patch.triangles.len()).sum()
    }
}
