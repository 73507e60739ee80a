//! Some patches of a group joined: fewer triangles in their place, and how far off those are.

use bevy_math::DVec3;

use super::PatchGroup;
use super::box_grid::not_less;
use super::collapse::{Collapse, LocalMesh};
use super::corner_reach::corner_reach;
use super::deviation::Deviation;
use super::fine_surface::Surfaces;
use super::frame::longest_edge;
use super::maker::{FARTHEST, Loose, Maker, SEVERAL, has_room};
use super::stand_ins::StandIns;
use super::widest_angle::WidestAngle;
use crate::prepare::nearest::TriangleCorners;

/// Fewer triangles than this are not joined.
const FEWEST: usize = 32;

/// A group that keeps more than this part of its triangles is not worth its memory.
const WORTHWHILE: f64 = 0.93;

/// Which part of its triangles a group is to keep.
const KEPT: f64 = 0.5;

/// Of a mesh of one patch, fewer at a time: errors of small meshes rise in jumps, as one vertex after the other goes.
const KEPT_OF_WHOLE: f64 = 0.8;

/// A group of patches that has been joined.
pub(super) struct Joined {
    /// Without what it joins.
    pub(super) group: PatchGroup,
    /// The numbers of the patches that it joins.
    pub(super) joins: Vec<u32>,
    pub(super) parts: Vec<JoinedPart>,
    /// Of its parts from the mesh.
    pub(super) deviation: Deviation,
    /// What its parts have, as far as they have it together; of [`Loose`] patches.
    pub(super) base: Deviation,
    pub(super) age: u32,
    pub(super) room: f64,
}

/// A coarser patch; see [`Loose`].
pub(super) struct JoinedPart {
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) under: Vec<u32>,
    pub(super) covers: Vec<u32>,
}

impl Maker<'_> {
    /// Fewer triangles in the place of some patches, cut into patches; else the patches as they are.
    pub(super) fn joined(&self, mut members: Vec<Loose>, owners: &[u32]) -> Result<Joined, Vec<Loose>> {
        match self.coarser(&mut members, owners) {
            Some(joined) => Ok(joined),
            None => Err(members),
        }
    }

    fn coarser(&self, members: &mut [Loose], owners: &[u32]) -> Option<Joined> {
        let finer = members.iter().filter_map(|loose| loose.part_of).map(|group| &self.groups[group as usize]);
        let known = finer.map(|group| f64::from(group.error)).fold(0.0, f64::max);
        if !has_room(members, known) {
            return None;
        }
        let triangles: Vec<[u32; 3]> = members.iter().flat_map(|loose| self.triangles_of(loose)).collect();
        let before = triangles.len();
        let kept = if self.is_whole { KEPT_OF_WHOLE } else { KEPT };
        let wanted = (kept * before as f64) as usize;
        if wanted < FEWEST {
            return None;
        }
        let (mut coarse, roughness) = self.reduced(&triangles, owners, wanted);
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
        let fine: Vec<[u32; 3]> = under.iter().map(|&number| self.triangles[number as usize]).collect();
        let places = &self.stand_ins.places;
        let surfaces =
            Surfaces { mesh: self.mesh, places, coarse: &coarse, runs: &runs, fine: &fine, covered: &covers };
        let base = members.iter().map(|loose| loose.base).fold(Deviation::default(), Deviation::max);
        let least = self.least(members, base);
        let overlay = self.with_slots(|slots| surfaces.overlay(least, slots));
        let deviation = overlay.deviation.and(base);
        if deviation.distance > FARTHEST * f64::from(self.mesh.bounds().radius())
            || !has_room(members, deviation.distance.max(known))
        {
            return None;
        }
        let parts = runs.iter().zip(overlay.near).map(|(run, near)| JoinedPart {
            triangles: coarse[run.clone()].to_vec(),
            under: near.iter().map(|&at| under[at as usize]).collect(),
            covers: Vec::new(),
        });
        let mut parts: Vec<JoinedPart> = parts.collect();
        for (&vertex, home) in covers.iter().zip(overlay.homes) {
            let part = runs.partition_point(|run| run.end <= home as usize);
            parts[part].covers.push(vertex);
        }
        Some(Joined {
            group: self.group(members, (&coarse, roughness), deviation),
            joins: members.iter().map(|loose| loose.number).collect(),
            parts,
            deviation,
            base,
            age: 1 + members.iter().map(|loose| loose.age).max().unwrap_or(0),
            room: members.iter().map(|loose| loose.room).fold(f64::INFINITY, f64::min),
        })
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

    /// Triangles of patches without vertices that cost little, and how rough those triangles were.
    fn reduced(&self, triangles: &[[u32; 3]], owners: &[u32], wanted: usize) -> (Vec<[u32; 3]>, f32) {
        let (vertices, local) = self.with_slots(|slots| self.local(triangles, owners, slots));
        let mut collapse = Collapse::new(local);
        collapse.reduce_to(wanted);
        let left = collapse.triangles().map(|triangle| triangle.map(|local| vertices[local as usize])).collect();
        (left, collapse.roughness)
    }

    /// Triangles by themselves, and the vertices that theirs are.
    fn local(&self, triangles: &[[u32; 3]], owners: &[u32], slots: &mut [u32]) -> (Vec<u32>, LocalMesh) {
        let Self { mesh, stand_ins: StandIns { places, .. }, stays, .. } = self;
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
        (vertices, local)
    }

    /// What is known of the group of coarse triangles that stand for some patches.
    fn group(&self, members: &[Loose], (coarse, roughness): (&[[u32; 3]], f32), deviation: Deviation) -> PatchGroup {
        let normals = self.mesh.normals();
        let mut spread = WidestAngle::default();
        for triangle in coarse {
            let normals = triangle.map(|i| normals[i as usize].as_dvec3());
            let mean = normals.iter().sum::<DVec3>();
            for n in normals {
                spread.add(n, mean);
            }
        }
        let corners = |triangle: &[u32; 3]| triangle.map(|i| self.mesh.positions()[i as usize].as_dvec3());
        let largest = |of: fn(TriangleCorners) -> f64| coarse.iter().map(|it| of(corners(it))).fold(0.0, f64::max);
        let mut group = PatchGroup {
            joins: 0..0,
            error: not_less(deviation.distance),
            normal_error: not_less(deviation.angle),
            normal_spread: not_less(spread.angle),
            longest_edge: not_less(largest(longest_edge)).min(f32::MAX),
            corner_reach: not_less(largest(corner_reach)).min(f32::MAX),
            roughness,
        };
        for finer in members.iter().filter_map(|loose| loose.part_of) {
            let finer = &self.groups[finer as usize];
            group.error = group.error.max(finer.error);
            group.normal_error = group.normal_error.max(finer.normal_error);
            group.normal_spread = group.normal_spread.max(finer.normal_spread);
            group.longest_edge = group.longest_edge.max(finer.longest_edge);
            group.corner_reach = group.corner_reach.max(finer.corner_reach);
            group.roughness = group.roughness.min(finer.roughness);
        }
        group
    }
}
