//! The part of a triangle that lies over another.

use bevy_math::DVec2;

/// A corner of a part: the weights of the coarse triangle's second and third corner there, and of the fine one's.
#[derive(Clone, Copy, Default)]
pub(super) struct PartCorner {
    pub(super) coarse: DVec2,
    pub(super) fine: DVec2,
}

/// What is clipped by a side has half as many corners more at most, also where rounding has made it concave: 3, 4,
/// 6, 9.
const MOST_CORNERS: usize = 9;

/// A part, with its corners before and after it is clipped; here only so that their memory is used again.
#[derive(Default)]
pub(super) struct ClippedPart {
    part: [PartCorner; MOST_CORNERS],
    count: usize,
    whole: [PartCorner; MOST_CORNERS],
}

/// How far inside of the third side of a coarse triangle a point is. Of the others its coordinates say it.
pub(super) fn third(at: DVec2) -> f64 {
    1.0 - at.x - at.y
}

impl ClippedPart {
    /// The part of a fine triangle over a coarse one, from where its corners are over that.
    pub(super) fn clipped(&mut self, at: [DVec2; 3]) -> &[PartCorner] {
        for (place, (coarse, fine)) in at.into_iter().zip([DVec2::ZERO, DVec2::X, DVec2::Y]).enumerate() {
            self.part[place] = PartCorner { coarse, fine };
        }
        self.count = 3;
        self.clip(|at| at.x);
        self.clip(|at| at.y);
        self.clip(third);
        &self.part[..self.count]
    }

    /// Keeps what is inside of one side.
    fn clip(&mut self, side: impl Fn(DVec2) -> f64) {
        let mut depths = [0.0; MOST_CORNERS];
        for (depth, corner) in depths.iter_mut().zip(&self.part[..self.count]) {
            *depth = side(corner.coarse);
        }
        if depths[..self.count].iter().all(|&depth| depth >= 0.0) {
            return;
        }
        let count = std::mem::take(&mut self.count);
        self.whole[..count].copy_from_slice(&self.part[..count]);
        let mut before = count.saturating_sub(1);
        for this in 0..count {
            let [from, to] = [before, this].map(|place| self.whole[place]);
            if (depths[this] < 0.0) != (depths[before] < 0.0) {
                let t = depths[before] / (depths[before] - depths[this]);
                self.push(PartCorner { coarse: from.coarse.lerp(to.coarse, t), fine: from.fine.lerp(to.fine, t) });
            }
            if depths[this] >= 0.0 {
                self.push(to);
            }
            before = this;
        }
    }

    fn push(&mut self, corner: PartCorner) {
        self.part[self.count] = corner;
        self.count += 1;
    }
}
