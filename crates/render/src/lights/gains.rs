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
    /// What is saved at the pixels, less what it costs at the vertices, in lights at a pixel: where the light's other
    /// term is at the fragments, and where that is at the vertices, too. `None` where it does not pay.
    pub(super) gains: [Option<f32>; 2],
    pub(super) is_moved: bool,
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

    /// The terms of a light, of those that a patch `has`, that may move by these changes: term by term where one of
    /// them pays by itself, else both together. What was at the vertices before, where that counts, pays unless it
    /// costs clearly more than it saves; what was not pays if it saves clearly more.
    pub(super) fn movable(
        &self,
        light: u32,
        has: [bool; 2],
        changes: [Option<[[f64; 3]; 2]>; 2],
        Extent { pixels, vertices }: Extent,
        before: Before,
    ) -> [Option<Movable>; 2] {
        let one_term = [self.diffuse_alone, self.specular_alone];
        // What is saved of a light at a pixel, and what it costs of one at a vertex, by itself and beside the other.
        let item = |terms: [bool; 2], [brighter, darker]: [[f64; 3]; 2], parts: [Option<[f32; 2]>; 2]| {
            let stays = before.stays(light, terms);
            let clearly = stays.map_or(0.0, |stays| if stays { -CLEARLY } else { CLEARLY });
            let gains = parts.map(|part| {
                let [saved, cost] = part?;
                let gain = saved * pixels - cost * self.light * vertices;
                (gain >= clearly * saved * pixels).then_some(gain)
            });
            let movable = Movable { light, terms, brighter, darker, share: 0.0, stays, gains, is_moved: false };
            gains.iter().any(Option::is_some).then_some(movable)
        };
        let one = |term: usize| {
            let (own, other) = (one_term[term], one_term[1 - term]);
            let by_itself = if has[1 - term] { [1.0 - other, own] } else { [own; 2] };
            let beside = changes[1 - term].map(|_| [own, 1.0 - other]);
            changes[term].and_then(|change| item([term == 0, term == 1], change, [Some(by_itself), beside]))
        };
        let apart = [one(0), one(1)];
        match changes {
            [Some(diffuse), Some(specular)] if !apart.iter().flatten().any(|item| item.gains[0].is_some()) => {
                let sum = [0, 1].map(|side| [0, 1, 2].map(|c| diffuse[side][c] + specular[side][c]));
                [item([true; 2], sum, [Some([1.0; 2]), None]), None]
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

    /// Prices that leave 0.2 of a light at a pixel to save by its diffuse term, and 0.4 by its specular one.
    const TERMS: VertexPrices =
        VertexPrices { light: 1.0, diffuse_alone: 0.6, specular_alone: 0.8, ..VertexPrices::FREE };

    /// Terms that may move, what they change, brighter and darker, and their gains.
    type Found = ([bool; 2], [f64; 2], [Option<f32>; 2]);

    /// Of a light with both terms, and of a patch of 100 pixels.
    fn movable(vertices: f32, changes: [Option<f64>; 2]) -> Vec<Found> {
        let changes = changes.map(|change| change.map(|change| [[change; 3], [0.0; 3]]));
        let extent = Extent { pixels: 100.0, vertices };
        let found = TERMS.movable(7, [true; 2], changes, extent, Before::default());
        let told = |item: Movable| {
            (item.terms, [item.brighter[0], item.darker[0]], item.gains.map(|gain| gain.map(f32::round)))
        };
        found.into_iter().flatten().map(told).collect()
    }

    #[test]
    fn both_terms_save_what_a_light_takes() {
        let (diffuse, specular) = ([true, false], [false, true]);
        let changes = [Some(1.0), Some(2.0)];
        // Each by itself saves 20 and 40 for 0.6 and 0.8 of the vertices, and beside the other what is left of 100.
        let free = [(diffuse, [1.0, 0.0], [Some(20.0), Some(60.0)]), (specular, [2.0, 0.0], [Some(40.0), Some(80.0)])];
        assert_eq!(movable(0.0, changes), free);
        for [one, other] in [[0, 1], [1, 0]] {
            let sum = free[one].2[0].unwrap_or_default() + free[other].2[1].unwrap_or_default();
            assert!((sum - 100.0).abs() < 1e-3, "{sum}");
        }
        // One pays by itself, the other beside it alone.
        let one = [(diffuse, [1.0, 0.0], [None, Some(52.0)]), (specular, [2.0, 0.0], [Some(8.0), Some(64.0)])];
        assert_eq!(movable(40.0, changes), one);
        assert_eq!(movable(40.0, [None, Some(2.0)]), [(specular, [2.0, 0.0], [Some(8.0), None])]);
        assert_eq!(movable(40.0, [Some(1.0), None]), []);
        // Neither pays but with the other.
        assert_eq!(movable(60.0, changes), [([true; 2], [3.0, 0.0], [Some(40.0), None])]);
        assert_eq!(movable(110.0, changes), []);
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
