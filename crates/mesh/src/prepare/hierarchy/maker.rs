//! What is known while a hierarchy of patches is made.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use bevy_math::{DVec3, Vec3};

use super::box_grid::not_less;
use super::corner_reach::corner_reach;
use super::deviation::Deviation;
use super::open_border::open_border;
use super::stand_ins::StandIns;
use super::{PatchGroup, WHOLE};
use crate::Mesh;

/// Groups further off than this part of the radius of the box around the mesh are not made.
pub(super) const FARTHEST: f64 = 0.1;

/// Where other pieces of the mesh are closer than this number of times the error, no group is made: so neither of two
/// that move by their errors comes to lie before the other.
const ROOM: f64 = 2.0;

/// Of no group, and of more than one.
pub(super) const NOBODY: u32 = u32::MAX;
pub(super) const SEVERAL: u32 = u32::MAX - 1;

/// A patch that has not been joined yet.
pub(super) struct Loose {
    /// Its number among all patches.
    pub(super) number: u32,
    pub(super) part_of: Option<u32>,
    /// The triangles that it is measured against, of those of all patches.
    pub(super) under: Vec<u32>,
    /// Those of their vertices that it stands for.
    pub(super) covers: Vec<u32>,
    /// Of those triangles from the mesh.
    pub(super) base: Deviation,
    /// The number of joins since.
    pub(super) age: u32,
    /// How far it is from other pieces, and from other layers of its own.
    pub(super) room: f64,
    /// Whether a group that was to join it would have been too far off for that. It is joined no more.
    pub(super) is_stuck: bool,
}

/// A mesh's patches and groups, as far as they are made.
pub(super) struct Maker<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) stand_ins: StandIns,
    /// Of each place, whether it must stay in any case.
    pub(super) stays: Vec<bool>,
    /// A length that is 1 where positions are in a cube from −1 to 1, and the middle of that.
    pub(super) unit: f64,
    pub(super) center: DVec3,
    /// The triangles of all patches, one after the other.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Which of them each patch has, and the group that it is a part of.
    pub(super) patches: Vec<(Range<usize>, Option<u32>)>,
    /// Their `joins` are still empty.
    pub(super) groups: Vec<PatchGroup>,
    /// The patches that each group joins.
    pub(super) joined: Vec<Vec<u32>>,
    /// For what needs a number of each vertex: lists of `u32::MAX`, one for each thread that has needed one.
    slots: Mutex<Vec<Vec<u32>>>,
    pub(super) is_whole: bool,
}

impl<'a> Maker<'a> {
    pub(super) fn new(mesh: &'a Mesh) -> Self {
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
            triangles: Vec::new(),
            patches: Vec::new(),
            groups: Vec::new(),
            joined: Vec::new(),
            slots: Mutex::default(),
            is_whole: mesh.triangle_count() <= WHOLE,
        }
    }

    /// The triangles of a patch between stand-ins, those that have three places.
    pub(super) fn triangles_of(&self, loose: &Loose) -> impl Iterator<Item = [u32; 3]> {
        let (triangles, _) = &self.patches[loose.number as usize];
        self.stand_ins.triangles(&self.triangles[triangles.clone()])
    }

    /// The places of a patch, each once.
    pub(super) fn places(&self, loose: &Loose) -> Vec<u32> {
        self.with_slots(|slots| {
            let mut places = Vec::new();
            for vertex in self.triangles_of(loose).flatten() {
                let place = self.stand_ins.places[vertex as usize];
                if std::mem::replace(&mut slots[place as usize], 0) == u32::MAX {
                    places.push(place);
                }
            }
            for &place in &places {
                slots[place as usize] = u32::MAX;
            }
            places
        })
    }

    /// Does what needs a number of each vertex, with a list of `u32::MAX` that it leaves as it was.
    pub(super) fn with_slots<T>(&self, work: impl FnOnce(&mut [u32]) -> T) -> T {
        let lists = || self.slots.lock().unwrap_or_else(PoisonError::into_inner);
        let kept = lists().pop();
        let mut slots = kept.unwrap_or_else(|| vec![u32::MAX; self.mesh.positions().len()]);
        let made = work(&mut slots);
        lists().push(slots);
        made
    }

    /// Vertices that are as far as this from other pieces and layers have room for any group.
    pub(super) fn most_room(&self) -> f64 {
        let reach = |number| corner_reach(self.mesh.corners_of(number).map(Vec3::as_dvec3));
        let farthest = (0..self.mesh.triangle_count() as u32).map(reach).fold(0.0, f64::max);
        // A little more, as errors are rounded up.
        1.001 * ROOM * FARTHEST * f64::from(self.mesh.bounds().radius()) + farthest
    }

    /// How far triangles are from other pieces and layers, by how far their vertices are.
    pub(super) fn room(&self, triangles: &[[u32; 3]], rooms: &[f32]) -> f64 {
        let of = |triangle: &[u32; 3]| {
            let corners = triangle.map(|vertex| self.mesh.positions()[vertex as usize].as_dvec3());
            let rooms = triangle.map(|vertex| rooms[self.stand_ins.places[vertex as usize] as usize]);
            f64::from(rooms.into_iter().fold(f32::INFINITY, f32::min)) - corner_reach(corners)
        };
        triangles.iter().map(of).fold(f64::INFINITY, f64::min).max(0.0)
    }
}

/// Whether patches may be this far off; those are stuck that may not.
pub(super) fn has_room(members: &mut [Loose], distance: f64) -> bool {
    let mut has_room = true;
    for loose in members {
        loose.is_stuck = ROOM * f64::from(not_less(distance)) > loose.room;
        has_room &= !loose.is_stuck;
    }
    has_room
}
