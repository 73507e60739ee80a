//! Which lights a patch needs.

use super::Receiver;
use crate::equations::vector::add;
use crate::equations::{Light, Real};

/// The lights that a patch needs, term by term, and what those left out would have added at most.
///
/// Made once and filled by [`Receiver::select`] again and again; its memory is kept.
#[derive(Clone, Debug)]
pub struct Selected<T> {
    /// The lights whose diffuse term is needed, and with it the ambient one of a light that attenuates it. Ascending.
    pub diffuse: Vec<u32>,
    /// The lights whose specular term is needed. Ascending.
    pub specular: Vec<u32>,
    /// The sum of the bounds of all terms left out, a channel each; at most the tolerance.
    pub left_out: [f64; 3],
    /// The terms that could be left out one by one.
    weak: Vec<WeakTerm<T>>,
}

impl<T> Default for Selected<T> {
    fn default() -> Self {
        Self { diffuse: Vec::new(), specular: Vec::new(), left_out: [0.0; 3], weak: Vec::new() }
    }
}

/// A term of a light that stays within the tolerance by itself.
#[derive(Clone, Copy, Debug)]
struct WeakTerm<T> {
    /// The largest channel of its bound, as a share of the tolerance.
    share: f64,
    light: u32,
    term: Term,
    bound: [T; 3],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Term {
    /// With the attenuated ambient.
    Diffuse,
    Specular,
}

impl<T: Real> Receiver<T> {
    /// Fills `selected` with those of `lights`, each with the number it goes by, that the patch needs: the others'
    /// terms are left out, the weakest first, as long as the sum of their bounds stays within `tolerance`, a linear
    /// intensity a channel (see [`linear_tolerance`](super::linear_tolerance)).
    ///
    /// The tolerance is one for both terms together: no channel of any point changes by more. A term is as weak as its
    /// largest channel in shares of the tolerance; of equal ones the smaller number goes first, and diffuse before
    /// specular. A term that adds nothing is left out for nothing. Time is linear in the lights: those out of range
    /// cost a distance, and the weakest are found by partitions instead of a sort.
    pub fn select<'a>(
        &self,
        lights: impl IntoIterator<Item = (u32, &'a Light<T>)>,
        tolerance: [f64; 3],
        selected: &mut Selected<T>,
    ) {
        selected.clear();
        // Once a patch instead of three divisions a term.
        let inverse = tolerance.map(f64::recip);
        for (number, light) in lights {
            if let Some(bounds) = self.reached(light) {
                selected.offer(number, Term::Diffuse, add(bounds.ambient, bounds.diffuse), tolerance, inverse);
                selected.offer(number, Term::Specular, bounds.specular, tolerance, inverse);
            }
        }
        selected.keep_strongest(tolerance);
    }
}

impl<T: Real> Selected<T> {
    fn clear(&mut self) {
        self.diffuse.clear();
        self.specular.clear();
        self.weak.clear();
        self.left_out = [0.0; 3];
    }

    /// Keeps a term that exceeds the tolerance by itself, forgets one that is 0, and puts the others aside.
    fn offer(&mut self, light: u32, term: Term, bound: [T; 3], tolerance: [f64; 3], inverse: [f64; 3]) {
        if bound.iter().all(|&x| x == T::zero()) {
            return;
        }
        let wide = to_f64(bound);
        if within(wide, tolerance) {
            // 0·∞ is not a number, and so no maximum: a channel without light needs no tolerance.
            let share = (wide[0] * inverse[0]).max(wide[1] * inverse[1]).max(wide[2] * inverse[2]).max(0.0);
            self.weak.push(WeakTerm { share, light, term, bound });
        } else {
            self.list(term).push(light);
        }
    }

    /// Leaves out as many of the weak terms as fit into the tolerance, the weakest first, and keeps the rest.
    fn keep_strongest(&mut self, tolerance: [f64; 3]) {
        let mut weak = core::mem::take(&mut self.weak);
        let all = weak.iter().fold([0.0; 3], |sum, item| add(sum, to_f64(item.bound)));
        if within(all, tolerance) {
            self.left_out = all;
        } else {
            let fitting = self.leave_out_weakest(&mut weak, tolerance);
            for item in &weak[fitting..] {
                self.list(item.term).push(item.light);
            }
            self.diffuse.sort_unstable();
            self.specular.sort_unstable();
        }
        self.weak = weak;
    }

    /// Moves the longest run of weakest terms that fits to the front, and gives its length: a bisection in which each
    /// step partitions half as many terms as the one before.
    fn leave_out_weakest(&mut self, weak: &mut [WeakTerm<T>], tolerance: [f64; 3]) -> usize {
        // The first `fitting` terms are the weakest and fit; those from `kept` on are the strongest, too much together.
        let (mut fitting, mut kept) = (0, weak.len());
        while fitting < kept {
            let open = &mut weak[fitting..kept];
            let half = open.len().div_ceil(2);
            open.select_nth_unstable_by(half - 1, |a, b| {
                a.share.total_cmp(&b.share).then(a.light.cmp(&b.light)).then(a.term.cmp(&b.term))
            });
            let sum = open[..half].iter().fold(self.left_out, |sum, item| add(sum, to_f64(item.bound)));
            if within(sum, tolerance) {
                self.left_out = sum;
                fitting += half;
            } else {
                kept = fitting + half - 1;
            }
        }
        fitting
    }

    fn list(&mut self, term: Term) -> &mut Vec<u32> {
        match term {
            Term::Diffuse => &mut self.diffuse,
            Term::Specular => &mut self.specular,
        }
    }
}

/// Whether no channel exceeds its tolerance; false where one is not a number.
fn within(bound: [f64; 3], tolerance: [f64; 3]) -> bool {
    (0..3).all(|c| bound[c] <= tolerance[c])
}

fn to_f64<T: Real>(a: [T; 3]) -> [f64; 3] {
    // Both number types convert.
    a.map(|x| x.to_f64().unwrap_or(f64::NAN))
}
