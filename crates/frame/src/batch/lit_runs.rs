//! Runs: neighbouring patches of an object that are drawn alike, and the order in which they are drawn.

use std::ops::Range;

/// Neighbouring patches of an object that are drawn alike.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LitRun {
    /// The number of its state.
    pub(crate) state: u32,
    /// 0, and 1 for the second pass of an object that is drawn in two: its near side.
    pub(crate) pass: u32,
    pub record: u32,
    /// Distance of the object's centre along the view; nearer opaque objects first, farther blended ones first.
    pub(crate) depth: f32,
    pub(crate) instance: u32,
}

/// A run that may go on with the next patch.
pub(super) struct OpenRun {
    pub(super) record: u32,
    pub(super) indices: Range<u32>,
}

/// The most triangles that are drawn without being seen, because they lie between patches of a run: they cost less than
/// another draw. Of a mesh with levels of detail none are: other levels of the same surface lie there.
pub(super) fn most_between(has_levels: bool) -> u32 {
    if has_levels { 0 } else { 128 }
}

impl OpenRun {
    pub(super) fn goes_on_with(&self, next: &Self, most_between: u32) -> bool {
        self.record == next.record && next.indices.start - self.indices.end <= 3 * most_between
    }
}

impl LitRun {
    /// A number that is the larger the farther away it is, as `f32::total_cmp` orders.
    pub(crate) fn nearness(&self) -> u32 {
        let bits = self.depth.to_bits();
        bits ^ if bits >> 31 == 0 { 1 << 31 } else { u32::MAX }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_bridge_small_gaps_but_no_other_levels() {
        let run = |indices: Range<u32>| OpenRun { record: 0, indices };
        for (gap, has_levels, joined) in
            [(0, false, true), (128, false, true), (129, false, false), (0, true, true), (1, true, false)]
        {
            let next = run(30 + 3 * gap..60 + 3 * gap);
            assert_eq!(run(0..30).goes_on_with(&next, most_between(has_levels)), joined, "{gap} {has_levels}");
            let other = OpenRun { record: 1, ..next };
            assert!(!run(0..30).goes_on_with(&other, most_between(has_levels)), "another record");
        }
    }
}
