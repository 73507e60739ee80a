//! What is saved where terms move to the vertices.

use crate::device::costs::VertexPrices;
use crate::lights::memory::{Before, CLEARLY};

/// How much of a patch there is to shade.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Extent {
    /// About how many pixels it covers, where nothing hides them.
    pub(crate) pixels: f32,
    pub(crate) vertices: f32,
}

impl Extent {
    /// That of both.
    #[must_use]
    pub(crate) fn and(self, other: Self) -> Self {
        Self { pixels: self.pixels + other.pixels, vertices: self.vertices + other.vertices }
    }
}

/// Terms of a light that may be shaded at the vertices: one of them, or both together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Movable {
    pub(super) light: u32,
    /// Diffuse and specular.
    pub(super) terms: [bool; 2],
    pub(super) brighter: [f64; 3],
    pub(super) darker: [f64; 3],
    /// The largest part of what is allowed that it takes; found later.
    pub(super) share: f64,
    /// Whether all of it was at the vertices in the frame before; `None` where that does not count.
    pub(super) stays: Option<bool>,
    /// What is saved at the pixels, less what it costs at the vertices, in lights at a pixel.
    pub(super) gain: f32,
}

/// What a light costs that is compiled in and does not show: it is found to be behind.
const UNSEEN_LIGHT: f32 = 0.5;

impl VertexPrices {
    /// Whether a patch may save anything, and enough to go on with what was chosen before; `compiled_in` lights are
    /// looked at where there are no lists. Of lists one light tells: where all its pixels do not pay for a look at it,
    /// those of more lights do not either.
    pub(crate) fn may_save(&self, extent: Extent, before: Before, compiled_in: Option<usize>) -> bool {
        let Extent { pixels, vertices } = extent;
        let (lights, least_cost) = match compiled_in {
            Some(lights) => (lights as f32, self.draw),
            None => (1.0, vertices * self.light),
        };
        let most = pixels * (lights + self.pixel);
        *self != Self::NEVER && most - least_cost - lights * self.look >= before.least_gain(most).min(0.0)
    }

    /// The terms of a light, of those that a patch `has`, that may move by these changes to their own gain: each by
    /// itself where that saves anything, else both together. What was at the vertices before, where that counts, stays
    /// unless it costs clearly more than it saves, and what was not comes if it saves clearly more.
    pub(super) fn movable(
        &self,
        light: u32,
        has: [bool; 2],
        changes: [Option<[[f64; 3]; 2]>; 2],
        Extent { pixels, vertices }: Extent,
        was: Option<[bool; 2]>,
    ) -> [Option<Movable>; 2] {
        let one_term = [self.diffuse_alone, self.specular_alone];
        let item = |terms: [bool; 2], [brighter, darker]: [[f64; 3]; 2], saved: f32, cost: f32| {
            let gain = saved * pixels - cost * self.light * vertices;
            let stays = was.map(|was| (0..2).all(|term| was[term] || !terms[term]));
            let least = stays.map_or(0.0, |stays| if stays { -CLEARLY } else { CLEARLY }) * saved * pixels;
            (gain >= least).then_some(Movable { light, terms, brighter, darker, share: 0.0, stays, gain })
        };
        let one = |term: usize, saved: f32| {
            let terms = [term == 0, term == 1];
            changes[term].and_then(|change| item(terms, change, saved, one_term[term]))
        };
        if has != [true; 2] {
            return [one(0, one_term[0]), one(1, one_term[1])];
        }
        let apart = [one(0, 1.0 - one_term[1]), one(1, 1.0 - one_term[0])];
        match changes {
            [Some(diffuse), Some(specular)] if apart.iter().any(Option::is_none) => {
                let sum = [0, 1].map(|side| [0, 1, 2].map(|c| diffuse[side][c] + specular[side][c]));
                [item([true; 2], sum, 1.0, 1.0), None]
            }
            _ => apart,
        }
    }

    /// How much more than it costs moving terms has to save of a patch on which so much could be saved: a tenth of it,
    /// or what a draw costs. What is shaded in two places is drawn in a way of its own, and on an adapter each way is a
    /// pipeline to build and to change to.
    pub(super) fn least_gain(&self, of: f32) -> f32 {
        (CLEARLY * of).min(self.draw)
    }

    /// What is saved of a patch beside what each moved term saves, less what it took to find that: of `looked_at`
    /// lights, with nothing left at the fragments or something.
    pub(super) fn of_all(&self, extent: Extent, looked_at: usize, is_emptied: bool, compiled_in: Option<usize>) -> f32 {
        let emptied = if is_emptied { self.pixel } else { 0.0 };
        match compiled_in {
            Some(lights) => {
                let unseen = lights.saturating_sub(looked_at) as f32;
                extent.pixels * (emptied + UNSEEN_LIGHT * unseen) - lights as f32 * self.look - self.draw
            }
            None => extent.pixels * emptied - looked_at as f32 * self.look,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::costs::Costs;

    #[test]
    fn what_cannot_pay_is_not_looked_at() {
        let prices = Costs::SOFTWARE.vertices;
        let may_save = |prices: VertexPrices, pixels: f32, compiled_in: Option<usize>| {
            prices.may_save(Extent { pixels, vertices: 10.0 }, Before::default(), compiled_in)
        };
        // Four lights and what any light costs at a pixel, for four looks and a draw: 932 / 4.5.
        assert_eq!([207.0, 208.0].map(|pixels| may_save(prices, pixels, Some(4))), [false, true]);
        // One light of a list, for a look and ten vertices: 38 / 1.5.
        assert_eq!([25.0, 26.0].map(|pixels| may_save(prices, pixels, None)), [false, true]);
        assert!([None, Some(4)].iter().all(|&lights| may_save(VertexPrices::FREE, 0.0, lights)));
        assert!([None, Some(4)].iter().all(|&lights| !may_save(VertexPrices::NEVER, 1e9, lights)));
    }

    #[test]
    fn what_moves_saves_a_tenth_or_a_draw() {
        let prices = Costs::SOFTWARE.vertices;
        let close = |a: f32, b: f32| assert!((a - b).abs() < 1e-3, "{a} {b}");
        close(prices.least_gain(1000.0), 100.0);
        close(prices.least_gain(1e6), prices.draw);
        close(VertexPrices::FREE.least_gain(1e6), 0.0);
    }
}
