//! Neighbouring patches that have one list of lights together, where each by itself covers too little of the picture to
//! be worth one.

use crate::geometry::corners::CountedCorners;
use crate::geometry::detail::Detail;
use crate::geometry::families::{FamilyPart, MOST};
use crate::geometry::outlines::Sight;
use crate::geometry::seen::SeenPatch;
use crate::geometry::shape::PatchShape;
use crate::lights::gains::Extent;
use crate::lights::memory::{CLEARLY, ChoiceMemory};
use bevy_ecs::prelude::Entity;
use std::ops::Range;

/// Patches that lie together and are chosen for together, or one.
#[derive(Clone, Debug)]
pub(crate) struct Cluster {
    /// What it goes by: the number of one of its patches.
    pub(crate) name: u32,
    /// How many patches it has, and which of what is seen they are.
    pub(crate) count: u32,
    pub(crate) members: Range<usize>,
    pub(crate) shape: PatchShape,
    /// Of all that are seen; where it is asked for.
    pub(crate) extent: Extent,
    /// Which corners the terms of each are shaded at, where they are so coarse or far away.
    pub(crate) corners: Option<CountedCorners>,
}

/// Patches that cover fewer pixels than this together are chosen for together, where they lie together. Where choices
/// are kept, what was joined in the frame before stays so unless there are clearly more pixels, and what was not unless
/// there are clearly fewer.
///
/// What it takes to choose the lights of a patch and to draw with them does not depend on how much of it there is to
/// shade; but the larger it is, the more lights and terms it needs.
const WORTH_A_LIST: f32 = 1024.0;

/// How an object's patches are joined to clusters.
pub(crate) struct Clustering<'s, 'a> {
    pub(crate) object: Entity,
    pub(crate) detail: &'a Detail,
    pub(crate) sight: &'s Sight<'s>,
    /// Whether what is known of one of its patches is known of all.
    pub(crate) may_join: bool,
    /// Whether the extent of a patch by itself is asked for.
    pub(crate) asks_of_one: bool,
}

impl Clustering<'_, '_> {
    /// Cuts what is seen into parts of so many patches or a few less, none within a family.
    pub(crate) fn cut(&self, seen: &[SeenPatch], most: usize, parts: &mut Vec<Range<usize>>) {
        parts.clear();
        let mut part = 0..0;
        while let Some(first) = seen.get(part.end) {
            let family = self.detail.families.of(first.number);
            let count = seen[part.end..].iter().take_while(|seen| seen.number < family.patches.end).count();
            if part.len() + count > most && !part.is_empty() {
                parts.push(part.clone());
                part.start = part.end;
            }
            part.end += count;
        }
        if !part.is_empty() {
            parts.push(part);
        }
    }

    /// Fills `clusters` with some of what is seen, in its order: joined, but where that `is_among` lights.
    pub(crate) fn fill(
        &self,
        (seen, members): (&[SeenPatch], Range<usize>),
        is_among: &mut impl FnMut(&PatchShape) -> bool,
        memory: &ChoiceMemory,
        clusters: &mut Vec<Cluster>,
    ) {
        clusters.clear();
        let mut start = members.start;
        while start < members.end {
            let first = &seen[start];
            let family = self.detail.families.of(first.number);
            let is_alike = |other: &&SeenPatch| {
                self.may_join
                    && other.number < family.patches.end
                    && self.detail.is_coarser(other.number) == self.detail.is_coarser(first.number)
                    && other.corners == first.corners
            };
            let end = start + 1 + seen[start + 1..members.end].iter().take_while(is_alike).count();
            let is_of_family = |other: &SeenPatch| family.patches.contains(&other.number);
            let names = Names {
                has_others: seen[members.start..start].last().is_some_and(is_of_family)
                    || seen[end..members.end].first().is_some_and(is_of_family),
            };
            let mut extents = [Extent::default(); MOST];
            if end > start + 1 || self.asks_of_one {
                for (extent, seen) in extents.iter_mut().zip(&seen[start..end]) {
                    *extent = self.detail.patch(seen.number).extent(self.sight);
                }
            }
            let is_parted = &mut |part: &FamilyPart, of: &[SeenPatch], pixels: f32| {
                let before = || memory.joined_before((self.object, names.of(part, of)));
                is_worth_a_list(part, pixels, before) || self.detail.families.shape(part).is_some_and(&mut *is_among)
            };
            let add = &mut |part: &FamilyPart, at: Range<usize>, extent: Extent| {
                let members = start + at.start..start + at.end;
                clusters.push(Cluster {
                    members,
                    extent,
                    corners: first.corners,
                    ..self.joined(part, &seen[start..][at], names)
                });
            };
            split(&family, (&seen[start..end], 0), &extents, is_parted, add);
            start = end;
        }
    }

    /// What these patches of a part of a family are together, so far as it does not depend on where they are seen.
    fn joined(&self, part: &FamilyPart, patches: &[SeenPatch], names: Names) -> Cluster {
        let joined = self.detail.families.shape(part).filter(|_| patches.len() > 1);
        Cluster {
            name: names.of(part, patches),
            count: joined.map_or(1, |_| part.patches.len() as u32),
            members: 0..0,
            shape: *joined.unwrap_or(&self.detail.patch(patches[0].number).shape),
            extent: Extent::default(),
            corners: None,
        }
    }
}

/// What clusters of a family go by, no two of a frame by the same.
#[derive(Clone, Copy)]
struct Names {
    /// Others of the family are seen that are no part of these clusters: they are coarser, or finer.
    has_others: bool,
}

impl Names {
    /// The first patch of a part of the family, of which these are seen: the same whichever they are, unless it is one,
    /// or another cluster may be of the same part.
    fn of(self, part: &FamilyPart, seen: &[SeenPatch]) -> u32 {
        let is_alone = seen.len() == 1 || self.has_others;
        if is_alone { seen[0].number } else { part.patches.start }
    }
}

/// Whether each half of a part of which so many pixels are seen is to have a list of its own; of `before` it is asked
/// how many patches were chosen for together with the first of it.
fn is_worth_a_list(part: &FamilyPart, pixels: f32, before: impl Fn() -> Option<u32>) -> bool {
    let is_clear = (pixels - WORTH_A_LIST).abs() > CLEARLY * WORTH_A_LIST;
    let before = if is_clear { None } else { before() };
    before.map_or(pixels >= WORTH_A_LIST, |joined| joined < part.patches.len() as u32)
}

/// Adds patches of a part of a family as one, or each half by itself where that `is_parted`. They begin at a place of
/// which their extents tell.
fn split(
    part: &FamilyPart,
    (seen, from): (&[SeenPatch], usize),
    extents: &[Extent],
    is_parted: &mut impl FnMut(&FamilyPart, &[SeenPatch], f32) -> bool,
    add: &mut impl FnMut(&FamilyPart, Range<usize>, Extent),
) {
    let to = from + seen.len();
    if seen.is_empty() {
        return;
    }
    let extent = extents[from..to].iter().copied().fold(Extent::default(), Extent::and);
    if seen.len() == 1 || !is_parted(part, seen, extent.pixels) {
        add(part, from..to, extent);
        return;
    }
    let [one, other] = part.halves();
    let (before, after) = seen.split_at(seen.partition_point(|seen| seen.number < other.patches.start));
    split(&one, (before, from), extents, is_parted, add);
    split(&other, (after, from + before.len()), extents, is_parted, add);
}
