//! The numbers of corners in their drafts.

use super::assemble::Draft;

/// Numbers the distinct corners of each draft in the order of first occurrence.
///
/// Most positions have one corner that all their faces share. It is kept in a table by position, and only where several
/// corners or drafts take turns at one position are they looked up by hash.
#[derive(Default)]
pub(super) struct CornerNumbers {
    /// The draft and the number of the corner that was last met at each position that is defined so far.
    last: Vec<LastCorner>,
    /// Whether some corner was met before its position was defined.
    has_forward: bool,
}

#[derive(Clone, Copy)]
struct LastCorner {
    draft: u32,
    number: u32,
}

/// No corner was met.
const NONE: LastCorner = LastCorner { draft: u32::MAX, number: u32::MAX };

impl CornerNumbers {
    /// The number of a corner in a draft; there are `positions` so far.
    pub(super) fn number(&mut self, drafts: &mut [Draft], draft: usize, corner: [u32; 3], positions: usize) -> u32 {
        if self.last.len() < positions {
            self.last.resize(positions, NONE);
        }
        let Some(last) = self.last.get_mut(corner[0] as usize - 1) else {
            self.has_forward = true;
            return drafts[draft].corners.number(corner);
        };
        let LastCorner { draft: before, number } = *last;
        if before == draft as u32 && drafts[draft].corners.keys()[number as usize] == corner {
            return number;
        }
        let number = if before == NONE.draft && !self.has_forward {
            drafts[draft].corners.add(corner)
        } else {
            if before != NONE.draft {
                drafts[before as usize].corners.remember(number);
            }
            drafts[draft].corners.number(corner)
        };
        *last = LastCorner { draft: draft as u32, number };
        number
    }
}
