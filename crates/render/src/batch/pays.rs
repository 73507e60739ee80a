//! Whether it pays to place an object's terms light by light, as far as some patches tell.

use crate::batch::choosers::Chooser;
use crate::batch::clusters::Cluster;
use crate::batch::lit_patches::LitPatches;
use crate::geometry::seen::SeenPatch;
use crate::lights::places::ShadedAt;
use crate::lights::profit::LOOKED_AT_FIRST;

/// Of objects with fewer patches in sight, others of the frame tell.
const FEW_PATCHES: usize = 64;

/// Of those with more, so many neighbours are looked at in one place.
const NEIGHBORS: usize = 8;

/// At most in so many places: more tell little more, and of a mesh of a million triangles would be a part of the frame.
const PLACES: usize = 16;

impl LitPatches {
    /// Whether it pays to place the terms of an object light by light: by some of its patches where they are many, else
    /// by what was drawn before it. What was moved in the frame before is looked at in any case.
    pub(super) fn pays(&mut self, chooser: &Chooser, (seen, clusters): (&[SeenPatch], &mut Vec<Cluster>)) -> bool {
        let object = chooser.object;
        self.profit.is_open = seen.len() < FEW_PATCHES;
        let pays = if self.profit.is_open {
            self.profit.looks_at_next() || self.lists.memory.keeps_moved(object.entity)
        } else {
            let selector = self.choosers.first();
            let (mut gains, mut may_save) = (0.0, false);
            let apart = (LOOKED_AT_FIRST * NEIGHBORS).max(seen.len().div_ceil(PLACES));
            for start in (0..seen.len()).step_by(apart) {
                let members = start..seen.len().min(start + NEIGHBORS);
                chooser.cluster(selector, seen, members, &self.lists, clusters);
                for looked_at in &*clusters {
                    let place = chooser.place(looked_at, &self.lists.memory);
                    if place == ShadedAt::Either {
                        may_save = true;
                        gains += chooser.select(selector, (looked_at, place), None, &self.lists);
                    }
                }
            }
            may_save && gains >= 0.0
        };
        if !pays {
            self.lists.memory.note_object(object.entity);
        }
        pays
    }
}
