//! Whether it pays to place an object's terms light by light, as far as some patches tell.

use crate::batch::lit_object::LitObject;
use crate::batch::lit_patches::{LitPatches, SeenPatch};
use crate::batch::object::Shared;
use crate::geometry::patches::Sight;
use crate::lights::lists::Listing;
use crate::lights::places::ShadedAt;
use crate::lights::profit::LOOKED_AT_FIRST;

/// Of objects with fewer patches in sight, others of the frame tell.
const FEW_PATCHES: usize = 64;

impl LitPatches {
    /// Whether it pays to place the terms of an object light by light: by some of its patches where they are many, else
    /// by what was drawn before it. What was moved in the frame before is looked at in any case.
    pub(super) fn pays(
        &mut self,
        object: &LitObject,
        seen: &[SeenPatch],
        listing: &Listing,
        sight: &Sight,
        (shared, compiled_in): (Shared, Option<usize>),
    ) -> bool {
        self.profit.is_open = seen.len() < FEW_PATCHES;
        let pays = if self.profit.is_open {
            let mut moved = seen.iter().map(|(patch, _)| self.lists.memory.before(object.name(patch)).is_moved());
            self.profit.looks_at_next() || moved.any(|moved| moved == Some(true))
        } else {
            let prices = (&shared.prices, compiled_in);
            let mut gains = 0.0;
            for (patch, _) in seen.iter().step_by(LOOKED_AT_FIRST) {
                let place = object.place(patch, sight, prices, &self.lists.memory);
                if place.0 == ShadedAt::Either {
                    self.lists.look_around(listing, std::iter::once(patch.sphere(object.model_view)));
                    gains += object.placed(patch, place, None, |placed| {
                        self.lists.select(shared.lights, placed, listing, object.key.terms)
                    });
                }
            }
            gains >= 0.0
        };
        if !pays {
            self.lists.memory.note_object(object.entity);
        }
        pays
    }
}
