//! Selects the lights of a patch: the one place where a tolerance is spent.

use crate::bounds::{LitTerms, Receiver, TermBounds};
use crate::equations::Real;
use crate::equations::vector::add;
use crate::lights::{Light, LightSource};

/// The lights that a patch needs, term by term, and a bound of what the others would have added.
///
/// Make it once and fill it again and again, by [`Receiver::select`] or
/// [`LightTree::select`](super::LightTree::select): it keeps its memory.
#[derive(Clone, Debug, Default)]
pub struct Selected {
    /// The lights whose diffuse term is needed, and with it the ambient term of a light that attenuates it. Ascending.
    pub diffuse: Vec<u32>,
    /// The lights whose specular term is needed. Ascending.
    pub specular: Vec<u32>,
    /// The sum of the bounds of all terms left out, per channel; at most the tolerance.
    pub left_out: [f64; 3],
    /// The number of lights that have been evaluated for it.
    pub evaluated: usize,
    /// The terms that have a bound, by light.
    terms: Vec<Term>,
    /// The ranks of those that are weak.
    ranks: Vec<u64>,
    /// The lights that may reach a patch.
    pub(super) near: Vec<u32>,
}

/// A term of a light.
#[derive(Clone, Copy, Debug)]
struct Term {
    bound: [f64; 3],
    light: u32,
    is_specular: bool,
    /// The place among the weak terms, the weakest first; [`STRONG`] if it exceeds the tolerance by itself.
    rank: u64,
}

const STRONG: u64 = u64::MAX;

impl<T: Real> Receiver<T> {
    /// Bounds what `light` adds to any point of the patch.
    ///
    /// The table at [`bounds`](crate::bounds) gives the formulas and why they hold. A bound is usually above the
    /// largest term, because the sphere has places without surface, the factors are bounded one by one, and a patch
    /// seen from both sides takes the better side for each factor.
    pub fn bounds(&self, light: &Light<T>) -> TermBounds<T> {
        light.bounds(self)
    }

    /// Fills `selected` with the `lights` that the patch needs, each given with its number, in ascending order. The
    /// terms of the others are left out, the weakest first, as long as the sum of their bounds stays within
    /// `tolerance`, a linear intensity per channel (see [`linear_tolerance`](crate::bounds::linear_tolerance)).
    ///
    /// The tolerance covers both terms together: no channel of any point changes by more. A term is as weak as its
    /// largest channel in shares of the tolerance, compared in `f32`; of equal ones the smaller number goes first, and
    /// diffuse before specular. With a tolerance of 0, only terms that are 0 all over the patch are left out.
    pub fn select<'a>(
        &self,
        lights: impl IntoIterator<Item = (u32, &'a Light<T>)>,
        tolerance: [f64; 3],
        selected: &mut Selected,
    ) {
        selected.clear();
        let is_exact = tolerance.iter().all(|&channel| channel <= 0.0);
        let shares = tolerance.map(f64::recip);
        for (number, light) in lights {
            selected.evaluated += 1;
            if is_exact {
                selected.keep_lit(number, light.lit_terms(self));
            } else {
                let bounds = light.bounds(self);
                selected.offer(number, false, add(bounds.ambient, bounds.diffuse), tolerance, shares);
                selected.offer(number, true, bounds.specular, tolerance, shares);
            }
        }
        selected.leave_out_weakest(tolerance);
    }
}

impl Selected {
    fn clear(&mut self) {
        self.diffuse.clear();
        self.specular.clear();
        self.terms.clear();
        self.ranks.clear();
        self.left_out = [0.0; 3];
        self.evaluated = 0;
    }

    fn keep_lit(&mut self, light: u32, lit: LitTerms) {
        if lit.ambient || lit.diffuse {
            self.diffuse.push(light);
        }
        if lit.specular {
            self.specular.push(light);
        }
    }

    /// Takes note of a term that is not 0; `shares` are the shares of the tolerance that an intensity of 1 takes.
    fn offer<T: Real>(&mut self, light: u32, is_specular: bool, bound: [T; 3], tolerance: [f64; 3], shares: [f64; 3]) {
        if bound == [T::zero(); 3] {
            return;
        }
        // Both number types convert.
        let bound = bound.map(|channel| channel.to_f64().unwrap_or(f64::NAN));
        let mut rank = STRONG;
        if is_within(bound, tolerance) {
            // 0·∞ is not a number, and so no maximum: a channel without light needs no tolerance.
            let share = (0..3).map(|c| bound[c] * shares[c]).fold(0.0, f64::max) as f32;
            // Numbers of 0 or more are ordered as their bits are.
            rank = u64::from(share.to_bits()) << 32 | self.terms.len() as u64;
            self.ranks.push(rank);
        }
        self.terms.push(Term { bound, light, is_specular, rank });
    }

    /// Leaves out as many of the weak terms as fit into the tolerance, the weakest first, and keeps the rest.
    fn leave_out_weakest(&mut self, tolerance: [f64; 3]) {
        let Self { diffuse, specular, left_out, terms, ranks, .. } = self;
        let weak = terms.iter().filter(|term| term.rank != STRONG);
        let all = weak.fold([0.0; 3], |sum, term| add(sum, term.bound));
        // The first rank that is kept.
        let mut kept = STRONG;
        if is_within(all, tolerance) {
            *left_out = all;
        } else {
            ranks.sort_unstable();
            for &rank in &*ranks {
                let sum = add(*left_out, terms[rank as u32 as usize].bound);
                if !is_within(sum, tolerance) {
                    kept = rank;
                    break;
                }
                *left_out = sum;
            }
        }
        for term in terms.iter().filter(|term| term.rank >= kept) {
            let list = if term.is_specular { &mut *specular } else { &mut *diffuse };
            list.push(term.light);
        }
    }
}

/// Whether no channel exceeds its tolerance; false where one is not a number.
fn is_within(bound: [f64; 3], tolerance: [f64; 3]) -> bool {
    (0..3).all(|c| bound[c] <= tolerance[c])
}
