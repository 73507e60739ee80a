//! What it has saved in a frame to place terms light by light.

/// Of objects with few patches, one in so many is looked at where it has not paid so far; and one in so many patches
/// first, of objects with more.
pub(crate) const LOOKED_AT_FIRST: usize = 16;

/// What the objects of few patches have saved in this frame, in lights at a pixel, less what it took to look at them.
#[derive(Debug, Default)]
pub(crate) struct Profit {
    saved: f32,
    objects: usize,
    /// Whether the object at hand has few patches, so that it counts.
    pub(crate) is_open: bool,
}

impl Profit {
    /// What is saved of a patch.
    pub(crate) fn add(&mut self, gain: f32) {
        if self.is_open {
            self.saved += gain;
        }
    }

    /// Whether the next object of few patches is looked at: the first ones, and the others if those have paid, else one
    /// in [`LOOKED_AT_FIRST`].
    pub(crate) fn looks_at_next(&mut self) -> bool {
        self.objects += 1;
        self.objects <= LOOKED_AT_FIRST || self.saved >= 0.0 || self.objects.is_multiple_of(LOOKED_AT_FIRST)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_pay_is_looked_at_once_in_a_while() {
        let looked_at = |gain: f32, is_open: bool| {
            let mut profit = Profit { is_open, ..Profit::default() };
            let mut looked_at = Vec::new();
            for object in 1..=64 {
                if profit.looks_at_next() {
                    looked_at.push(object);
                    profit.add(gain);
                }
            }
            looked_at
        };
        let all: Vec<usize> = (1..=64).collect();
        assert_eq!(looked_at(1.0, true), all);
        assert_eq!(looked_at(0.0, true), all);
        assert_eq!(looked_at(-1.0, false), all, "many patches tell for themselves");
        let mut few: Vec<usize> = (1..=16).collect();
        few.extend([32, 48, 64]);
        assert_eq!(looked_at(-1.0, true), few);
    }
}
