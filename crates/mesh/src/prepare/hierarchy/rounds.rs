//! Makes a hierarchy of patches, round by round.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::deviation::Deviation;
use super::joined::{Joined, JoinedPart};
use super::maker::{Loose, Maker, NOBODY, SEVERAL};
use super::neighbours;
use super::rooms::rooms;
use super::{HierarchyPatch, PatchGroup, PatchHierarchy};

/// After this number of joins, errors are measured against the patches then, and added to theirs: what they add is
/// small, as errors double with each join, and measuring against the mesh itself would take as long each time.
const REBASED: u32 = 3;

/// More threads than this are not kept busy: each has a list as long as the mesh's vertices.
const MOST_THREADS: usize = 16;

impl Maker<'_> {
    /// The patches of the mesh itself.
    pub(super) fn finest(&mut self, stop: &AtomicBool) -> Vec<Loose> {
        let rooms = rooms(self.mesh, &self.stand_ins.places, (self.unit, self.most_room()), stop);
        self.triangles = self.mesh.triangles().collect();
        let runs = self.mesh.cut_into_patches(&mut self.triangles, self.mesh.triangles_of_a_patch());
        // There are seldom more in the end.
        self.triangles.reserve_exact(self.triangles.len() * 5 / 4);
        let loose = (0..).zip(&runs).map(|(number, run)| {
            let triangles = &self.triangles[run.clone()];
            Loose {
                number,
                part_of: None,
                under: (run.start as u32..run.end as u32).collect(),
                covers: vertices(triangles),
                base: Deviation::default(),
                age: 0,
                room: self.room(triangles, &rooms),
                is_stuck: false,
            }
        });
        let loose = loose.collect();
        self.patches = runs.into_iter().map(|run| (run, None)).collect();
        loose
    }

    /// Joins what can be joined; `None` where it is to stop. Returns what is loose then, and whether anything was
    /// joined.
    ///
    /// The groups of a round have nothing to do with one another: they are joined on all threads, and numbered in their
    /// order.
    pub(super) fn join(&mut self, pool: Vec<Loose>, stop: &AtomicBool) -> Option<(Vec<Loose>, bool)> {
        let few = pool.len().div_ceil(MOST_THREADS);
        let places: Vec<Vec<u32>> = pool.par_iter().with_min_len(few).map(|loose| self.places(loose)).collect();
        let (stuck, free): (Vec<_>, Vec<_>) = (0..).zip(&places).partition(|(at, _)| pool[*at as usize].is_stuck);
        let mut touched = Vec::with_capacity(free.iter().map(|(_, places)| places.len()).sum());
        for (at, places) in free {
            touched.extend(places.iter().map(|&place| (place, at)));
        }
        let groups = neighbours::group(touched, pool.len());
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
        drop(places);
        let mut pool: Vec<Option<Loose>> = pool.into_iter().map(Some).collect();
        let mut members_of = |group: &Vec<u32>| -> (Vec<Loose>, Vec<Loose>) {
            group.iter().filter_map(|&at| pool[at as usize].take()).partition(|loose| loose.is_stuck)
        };
        let groups: Vec<_> = groups.iter().map(&mut members_of).collect();
        let few = groups.len().div_ceil(MOST_THREADS);
        let joined = groups.into_par_iter().with_min_len(few).map(|(stuck, members)| {
            let is_stopped = stop.load(Ordering::Relaxed);
            let joined = if is_stopped { Err(members) } else { self.joined(members, &owners) };
            (stuck, joined)
        });
        let joined: Vec<_> = joined.collect();
        if stop.load(Ordering::Relaxed) {
            return None;
        }
        let (mut next, mut any) = (Vec::new(), false);
        for (stuck, joined) in joined {
            next.extend(stuck);
            match joined {
                Ok(joined) => {
                    any = true;
                    self.add(joined, &mut next);
                }
                Err(members) => next.extend(members),
            }
        }
        Some((next, any))
    }

    /// Adds a group that has been joined; its parts are loose.
    fn add(&mut self, Joined { group, joins, parts, deviation, base, age, room }: Joined, loose: &mut Vec<Loose>) {
        let part_of = Some(self.groups.len() as u32);
        self.groups.push(group);
        self.joined.push(joins);
        for JoinedPart { triangles, under, covers } in parts {
            let number = self.patches.len() as u32;
            let run = self.triangles.len()..self.triangles.len() + triangles.len();
            let part = if age == REBASED && !self.is_whole {
                let (under, covers) = ((run.start as u32..run.end as u32).collect(), vertices(&triangles));
                Loose { number, part_of, under, covers, base: deviation, age: 0, room, is_stuck: false }
            } else {
                Loose { number, part_of, under, covers, base, age, room, is_stuck: false }
            };
            self.triangles.extend(triangles);
            self.patches.push((run, part_of));
            loose.push(part);
        }
    }

    /// Puts all in order.
    pub(super) fn finish(mut self, pool: Vec<Loose>) -> PatchHierarchy {
        self.groups.push(PatchGroup {
            joins: 0..0,
            error: f32::INFINITY,
            normal_error: std::f32::consts::PI,
            normal_spread: std::f32::consts::PI,
            longest_edge: f32::MAX,
            corner_reach: f32::MAX,
            roughness: 0.0,
        });
        self.joined.push(pool.into_iter().map(|loose| loose.number).collect());
        let mut hierarchy = PatchHierarchy {
            triangles: Vec::with_capacity(self.triangles.len()),
            patches: Vec::with_capacity(self.patches.len()),
            groups: self.groups,
        };
        for (group, joined) in hierarchy.groups.iter_mut().zip(self.joined) {
            let first = hierarchy.patches.len() as u32;
            for number in joined {
                let (run, part_of) = self.patches[number as usize].clone();
                let start = hierarchy.triangles.len() as u32;
                hierarchy.triangles.extend_from_slice(&self.triangles[run]);
                let triangles = start..hierarchy.triangles.len() as u32;
                hierarchy.patches.push(HierarchyPatch { triangles, part_of });
            }
            group.joins = first..hierarchy.patches.len() as u32;
        }
        hierarchy
    }
}

/// The vertices of triangles, in ascending order.
fn vertices(triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut vertices = triangles.as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    // Of four corners about three were another's too.
    vertices.shrink_to_fit();
    vertices
}
