//! The lights near a region, side by side, for the patches that lie in it.

#[expect(clippy::inline_always, reason = "what is not inlined is not compiled for the CPU's vectors")]
mod wide;

use super::chunk::{CHUNK, Chunk};
use super::select::{Selected, Term};
use super::{LightTree, Receiver, Region};
use crate::equations::vector::{length, sub};
use crate::equations::{Light, Place};
use core::cmp::Ordering;
use fearless_simd::Level;
use wide::{BLUR, Found};

/// Those of the lights of a [`LightTree`] that a region may need, made ready for its patches.
///
/// Made once and filled again and again; its memory is kept.
#[derive(Clone, Debug)]
pub struct NearLights {
    level: Level,
    region: Region,
    /// Those to look at first, and more of them for patches whose lists depend on what is farther away.
    packs: [Pack; UNSEEN.len()],
    /// How many of them are those of the region.
    filled: usize,
    found: Vec<Found>,
    /// How many pairs of a patch and a light have been looked at.
    pairs: u64,
}

/// The parts of the tolerance that may be spent on lights without looking at them. With more of it fewer are looked at,
/// and more often it depends on the others which of these are left out.
const UNSEEN: [f64; 3] = [1.0 / 64.0, 1.0 / 4096.0, 0.0];

/// Lights side by side, in ascending order.
#[derive(Clone, Debug, Default)]
struct Pack {
    numbers: Vec<u32>,
    chunks: Vec<Chunk>,
    /// What all others add to any point of the region at most, together.
    spent: f64,
}

impl Default for NearLights {
    fn default() -> Self {
        Self {
            level: Level::new(),
            region: Region::EMPTY,
            packs: [const { Pack { numbers: Vec::new(), chunks: Vec::new(), spent: 0.0 } }; UNSEEN.len()],
            filled: 0,
            found: Vec::new(),
            pairs: 0,
        }
    }
}

impl Pack {
    fn fill(&mut self, tree: &LightTree, lights: &[Light<f32>], region: &Region, unseen: f64) {
        self.numbers.clear();
        self.spent = tree.find(region, unseen, &mut self.numbers);
        self.numbers.sort_unstable();
        self.chunks.clear();
        for numbers in self.numbers.chunks(CHUNK) {
            let mut chunk = Chunk::EMPTY;
            for (lane, &number) in numbers.iter().enumerate() {
                chunk.put(lane, &lights[number as usize]);
            }
            self.chunks.push(chunk);
        }
    }
}

impl NearLights {
    /// How many pairs of a patch and a light have been looked at since this was last asked.
    pub fn take_pairs(&mut self) -> u64 {
        core::mem::take(&mut self.pairs)
    }

    /// Starts over with the patches of another region, or with other lights.
    pub fn begin(&mut self, region: Region) {
        self.region = region;
        self.filled = 0;
    }

    /// Whether any of the lights that the region may need is nearer to `center` than that, or no number. Directional
    /// lights are not.
    pub fn any_within(&mut self, tree: &LightTree, lights: &[Light<f32>], center: [f32; 3], distance: f32) -> bool {
        self.fill(0, tree, lights);
        self.packs[0].numbers.iter().any(|&number| match lights[number as usize].place {
            Place::Point(position) => length(sub(position, center)).partial_cmp(&distance) != Some(Ordering::Greater),
            Place::Directional(_) => false,
        })
    }

    /// Makes those ready that are looked at in this place.
    fn fill(&mut self, place: usize, tree: &LightTree, lights: &[Light<f32>]) {
        if self.filled == place {
            self.packs[place].fill(tree, lights, &self.region, UNSEEN[place]);
            self.filled += 1;
        }
    }

    /// Fills `selected` as [`Receiver::select`] does with all of `lights`, of which `tree` is made, for a patch in the
    /// region: with the same lists. What is said to be left out may be more, and is within the tolerance.
    ///
    /// `tolerance` is in no channel below the region's.
    pub fn select(
        &mut self,
        tree: &LightTree,
        lights: &[Light<f32>],
        receiver: &Receiver<f32>,
        tolerance: [f64; 3],
        selected: &mut Selected<f32>,
    ) {
        for place in 0..UNSEEN.len() {
            self.fill(place, tree, lights);
            let pack = &self.packs[place];
            self.pairs += pack.numbers.len() as u64;
            offer(self.level, pack, lights, receiver, tolerance, &mut self.found, selected);
            let exact = |number: u32| receiver.bounds(&lights[number as usize]).specular;
            if selected.keep_strongest(tolerance, pack.spent, exact) {
                return;
            }
        }
    }
}

/// Offers the terms of a pack's lights.
fn offer(
    level: Level,
    pack: &Pack,
    lights: &[Light<f32>],
    receiver: &Receiver<f32>,
    tolerance: [f64; 3],
    found: &mut Vec<Found>,
    selected: &mut Selected<f32>,
) {
    selected.clear();
    if !receiver.is_moderate() {
        for &number in &pack.numbers {
            selected.offer_bounds(number, &receiver.bounds(&lights[number as usize]), tolerance);
        }
        return;
    }
    wide::find(level, receiver, &pack.chunks, tolerance.map(at_most), found);
    for (found, numbers) in found.iter().zip(pack.numbers.chunks(CHUNK)) {
        // A lane without a light has a black one, which adds nothing but where a coefficient is no number.
        let mut lanes = found.lanes() & ((1 << numbers.len()) - 1);
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize;
            lanes &= lanes - 1;
            let number = numbers[lane];
            if found.odd >> lane & 1 == 1 {
                selected.offer_bounds(number, &receiver.bounds(&lights[number as usize]), tolerance);
                continue;
            }
            for (term, of, blur) in [(Term::Diffuse, &found.diffuse, 0.0), (Term::Specular, &found.specular, BLUR)] {
                if of.strong >> lane & 1 == 1 {
                    selected.keep(number, term);
                } else if of.weak >> lane & 1 == 1 {
                    selected.put_aside(number, term, of.bound.map(|channel| channel[lane]), blur);
                }
            }
        }
    }
}

/// The largest f32 that is no larger: what is at most the one is at most the other.
fn at_most(tolerance: f64) -> f32 {
    let near = tolerance as f32;
    if f64::from(near) > tolerance { near.next_down() } else { near }
}
