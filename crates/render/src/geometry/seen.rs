//! What is seen of an object: which of its patches, finer and coarser ones, a frame draws.

use crate::geometry::allowed::Allowed;
use crate::geometry::corners::{CountedCorners, ShadedCorners};
use crate::geometry::detail::Detail;
use crate::geometry::outlines::{Outline, Sight};

/// A patch that is drawn and may show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SeenPatch {
    /// Its number among all patches of its mesh.
    pub(crate) number: u32,
    /// Between two patches of one there are only triangles that do not show.
    pub(crate) stretch: u32,
    /// Which corners it is shaded at, where it is so coarse or far away and that was asked.
    pub(crate) corners: Option<CountedCorners>,
}

/// How an object is looked at.
#[derive(Clone, Copy)]
pub(crate) struct ObjectLook<'a> {
    pub(crate) sight: &'a Sight<'a>,
    /// How coarse patches may be.
    pub(crate) allowed: &'a Allowed,
    /// Where corners count; `None` where nobody asks.
    pub(crate) corners: Option<ShadedCorners>,
}

/// Which groups will do, for one object after the other.
#[derive(Debug, Default)]
pub(crate) struct Choice {
    will_do: Vec<bool>,
}

impl Detail {
    /// Fills `seen` with the patches that are drawn of an object and may show, in the order of their triangles.
    /// `is_near` tells whether another object is too near to a patch whose points move by a length of the mesh's units.
    /// Returns how many patches were looked at or left out with others.
    pub(crate) fn see(
        &self,
        look: ObjectLook,
        Choice { will_do }: &mut Choice,
        is_near: impl FnMut(&Outline, f32) -> bool,
        seen: &mut Vec<SeenPatch>,
    ) -> u32 {
        self.choose(look, will_do, is_near);
        seen.clear();
        let ObjectLook { sight, corners, .. } = look;
        // Patches lie one behind the other; what lies between are triangles for which others stand.
        let (mut stretch, mut end, mut looked_at) = (0, 0, 0);
        let drawn = |at: &u32| will_do.get(self.part_of[*at as usize] as usize).is_none_or(|will_do| *will_do);
        for (group, _) in self.groups.iter().zip(&*will_do).filter(|(_, will_do)| !**will_do) {
            // The object as a whole has been found to be seen.
            let is_seen = self.is_whole || group.joined.is_seen(sight);
            for number in group.joins.clone().filter(drawn) {
                stretch += u32::from(number != end);
                end = number + 1;
                looked_at += u32::from(!self.is_whole);
                if self.is_whole || is_seen && self.outlines[number as usize].is_seen(sight) {
                    let corners = corners.and_then(|corners| self.counted(number, corners, sight));
                    seen.push(SeenPatch { number, stretch, corners });
                }
            }
        }
        looked_at
    }

    /// Finds the groups that will do: a group's parts are drawn where it does, and all finer ones then do as well.
    fn choose(
        &self,
        ObjectLook { sight, allowed, .. }: ObjectLook,
        will_do: &mut Vec<bool>,
        mut is_near: impl FnMut(&Outline, f32) -> bool,
    ) {
        will_do.clear();
        will_do.resize(self.groups.len(), false);
        if allowed.is_nothing() {
            return;
        }
        let of_whole = self.pixels_per_unit(sight).unwrap_or(0.0);
        for (number, group) in self.groups.iter().enumerate().rev() {
            if !will_do[number] {
                let pixels =
                    if self.is_whole { of_whole } else { sight.pixels_per_unit(group.joined.sphere(sight.model_view)) };
                let around = if self.is_whole { &self.whole } else { &group.joined };
                will_do[number] =
                    pixels <= allowed.pixels_per_unit(&group.errors) && !is_near(around, group.errors.error);
            }
            if will_do[number] {
                for &finer in &self.finer[group.finer.start as usize..group.finer.end as usize] {
                    will_do[finer as usize] = true;
                }
            }
        }
    }
}
