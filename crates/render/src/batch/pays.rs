//! Whether it pays to place an object's terms light by light, as far as some patches tell.

use crate::batch::choosers::Chooser;
use crate::batch::lit_object::SeenPatch;
use crate::batch::lit_patches::LitPatches;
use crate::lights::places::ShadedAt;
use crate::lights::profit::LOOKED_AT_FIRST;

/// Of objects with fewer patches in sight, others of the frame tell.
const FEW_PATCHES: usize = 64;

impl LitPatches {
    /// Whether it pays to place the terms of an object light by light: by some of its patches where they are many, else
    /// by what was drawn before it. What was moved in the frame before is looked at in any case.
    pub(super) fn pays(&mut self, chooser: &Chooser, seen: &[SeenPatch]) -> bool {
        let object = chooser.object;
        self.profit.is_open = seen.len() < FEW_PATCHES;
        let pays = if self.profit.is_open {
            let memory = &self.lists.memory;
            let mut moved = seen.iter().map(|(patch, _)| memory.before(object.name(patch)).is_moved());
            self.profit.looks_at_next() || (memory.has_moved(object.entity) && moved.any(|moved| moved == Some(true)))
        } else {
            let selector = self.choosers.first();
            let (mut gains, mut may_save) = (0.0, false);
            for looked_at in seen.iter().step_by(LOOKED_AT_FIRST) {
                let place = chooser.place(looked_at.0, &self.lists.memory);
                if place.0 == ShadedAt::Either {
                    may_save = true;
                    chooser.look_around(selector, std::slice::from_ref(looked_at), place.0);
                    gains += chooser.select(selector, (looked_at.0, place), None, &self.lists);
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
