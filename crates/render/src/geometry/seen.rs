//! What is seen of an object: which of its patches, finer and coarser ones, a frame draws.

use crate::frame::helpers::Helpers;
use crate::geometry::allowed::Allowed;
use crate::geometry::corners::{CountedCorners, ShadedCorners};
use crate::geometry::detail::Detail;
use crate::geometry::outlines::{Outline, Sight};
use std::ops::Range;

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

/// Room for what is found out of one object after the other.
#[derive(Debug)]
pub(crate) struct SeenRoom {
    /// Which groups will do.
    will_do: Vec<bool>,
    parts: Vec<SeenPart>,
    /// So many groups are one part, which one thread looks at.
    together: usize,
}

/// What is seen of some groups that follow each other.
#[derive(Debug, Default)]
struct SeenPart {
    /// Their stretches are counted from 0.
    patches: Vec<SeenPatch>,
    /// From the first patch that is drawn, whether it shows or not, to the last; empty where none is.
    drawn: Range<u32>,
    /// The last one's.
    stretch: u32,
    looked_at: u32,
}

impl Default for SeenRoom {
    fn default() -> Self {
        // Some two thousand patches of a mesh without coarser ones: 50 µs.
        Self { will_do: Vec::new(), parts: Vec::new(), together: 256 }
    }
}

impl SeenRoom {
    /// For parts of so many groups.
    #[cfg(test)]
    pub(crate) fn for_parts_of(together: usize) -> Self {
        Self { together, ..Self::default() }
    }
}

impl Detail {
    /// Fills `seen` with the patches that are drawn of an object and may show, in the order of their triangles.
    /// `is_near` tells whether another object is too near to a patch whose points move by a length of the mesh's units.
    /// Returns how many patches were looked at or left out with others.
    pub(crate) fn see(
        &self,
        look: ObjectLook,
        room: &mut SeenRoom,
        helpers: &mut Helpers,
        is_near: impl FnMut(&Outline, f32) -> bool,
        seen: &mut Vec<SeenPatch>,
    ) -> u32 {
        let &mut SeenRoom { ref mut will_do, ref mut parts, together } = room;
        self.choose(look, will_do, is_near);
        let count = self.groups.len().div_ceil(together);
        if parts.len() < count {
            parts.resize_with(count, SeenPart::default);
        }
        let parts = &mut parts[..count];
        let (threads, most) = helpers.for_parts(count);
        let each = parts.iter_mut().enumerate();
        threads.share(0..most, each, |_, (number, part)| {
            let groups = number * together..self.groups.len().min((number + 1) * together);
            // Not in place: threads that write beside each other wait for each other.
            *part = std::mem::take(part).see(self, groups, look, will_do);
        });
        seen.clear();
        let (mut looked_at, mut stretch, mut end) = (0, 0, 0);
        for part in parts.iter().filter(|part| !part.drawn.is_empty()) {
            let before = stretch + u32::from(part.drawn.start != end);
            let moved = |patch: &SeenPatch| SeenPatch { stretch: before + patch.stretch, ..*patch };
            seen.extend(part.patches.iter().map(moved));
            (stretch, end) = (before + part.stretch, part.drawn.end);
            looked_at += part.looked_at;
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

impl SeenPart {
    /// What is seen of some groups, where these will do.
    fn see(mut self, detail: &Detail, groups: Range<usize>, look: ObjectLook, will_do: &[bool]) -> Self {
        self.patches.clear();
        (self.drawn, self.stretch, self.looked_at) = (0..0, 0, 0);
        let ObjectLook { sight, corners, .. } = look;
        // Patches lie one behind the other; what lies between are triangles for which others stand.
        let drawn = |at: &u32| will_do.get(detail.part_of[*at as usize] as usize).is_none_or(|will_do| *will_do);
        for number in groups.filter(|number| !will_do[*number]) {
            let group = &detail.groups[number];
            // The object as a whole has been found to be seen.
            let is_seen = detail.is_whole || group.joined.is_seen(sight);
            for number in group.joins.clone().filter(drawn) {
                if self.drawn.is_empty() {
                    self.drawn.start = number;
                } else {
                    self.stretch += u32::from(number != self.drawn.end);
                }
                self.drawn.end = number + 1;
                self.looked_at += u32::from(!detail.is_whole);
                if detail.is_whole || is_seen && detail.outlines[number as usize].is_seen(sight) {
                    let corners = corners.and_then(|corners| detail.counted(number, corners, sight));
                    self.patches.push(SeenPatch { number, stretch: self.stretch, corners });
                }
            }
        }
        self
    }
}
