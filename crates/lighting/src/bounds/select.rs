//! Which lights a patch needs.

use super::{Receiver, TermBounds};
use crate::equations::vector::add;
use crate::equations::{Light, Real};
use core::cmp::Ordering;

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
    /// The largest channel of its bound, as a share of the tolerance; not known until it is needed.
    share: f64,
    light: u32,
    term: Term,
    bound: [T; 3],
    /// By how much `bound` may exceed the bound itself, relative to it; 0 of most.
    blur: f64,
}

impl<T> WeakTerm<T> {
    /// The weakest first.
    fn order(a: &Self, b: &Self) -> Ordering {
        a.share.total_cmp(&b.share).then(a.light.cmp(&b.light)).then(a.term.cmp(&b.term))
    }

    /// What its share is at least.
    fn least_share(&self) -> f64 {
        self.share * (1.0 - self.blur)
    }
}

impl<T: Real> WeakTerm<T> {
    /// What it adds at least, had it all that its bound says.
    fn least(&self) -> [f64; 3] {
        to_f64(self.bound).map(|channel| channel * (1.0 - self.blur))
    }
}

/// What a sum in f64 is lowered by, more than its rounding: sums of the same terms run in different orders.
const ROUNDING: f64 = 1.0 - 1e-9;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Term {
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
        for (number, light) in lights {
            if let Some(bounds) = self.reached(light) {
                selected.offer_bounds(number, &bounds, tolerance);
            }
        }
        selected.keep_strongest(tolerance, 0.0, |_| [T::nan(); 3]);
    }
}

impl<T: Real> Selected<T> {
    pub(super) fn clear(&mut self) {
        self.diffuse.clear();
        self.specular.clear();
        self.weak.clear();
        self.left_out = [0.0; 3];
    }

    /// Both terms of a light.
    pub(super) fn offer_bounds(&mut self, light: u32, bounds: &TermBounds<T>, tolerance: [f64; 3]) {
        self.offer(light, Term::Diffuse, add(bounds.ambient, bounds.diffuse), tolerance);
        self.offer(light, Term::Specular, bounds.specular, tolerance);
    }

    /// Keeps a term that exceeds the tolerance by itself, forgets one that is 0, and puts the others aside.
    fn offer(&mut self, light: u32, term: Term, bound: [T; 3], tolerance: [f64; 3]) {
        if bound.iter().all(|&x| x == T::zero()) {
            return;
        }
        if within(to_f64(bound), tolerance) {
            self.put_aside(light, term, bound, 0.0);
        } else {
            self.keep(light, term);
        }
    }

    /// A term that exceeds the tolerance by itself.
    pub(super) fn keep(&mut self, light: u32, term: Term) {
        self.list(term).push(light);
    }

    /// A term that does not, and is not 0. `bound` may exceed its bound by the share `blur`.
    pub(super) fn put_aside(&mut self, light: u32, term: Term, bound: [T; 3], blur: f64) {
        self.weak.push(WeakTerm { share: f64::NAN, light, term, bound, blur });
    }

    /// Leaves out as many of the weak terms as fit into the tolerance, the weakest first, and keeps the rest; of those
    /// that are blurred `exact` gives the bound where it matters. `spent` is what terms add at most that nobody has
    /// looked at and that are left out with them; false where it is not certain that these are the weakest, or that no
    /// other would be left out if they added less.
    pub(super) fn keep_strongest(&mut self, tolerance: [f64; 3], spent: f64, exact: impl Fn(u32) -> [T; 3]) -> bool {
        let mut weak = core::mem::take(&mut self.weak);
        let is_certain = loop {
            self.left_out = weak.iter().fold([spent; 3], |sum, item| add(sum, to_f64(item.bound)));
            if within(self.left_out, tolerance) {
                break true;
            }
            // Once a patch instead of three divisions a term.
            let inverse = tolerance.map(f64::recip);
            for item in &mut weak {
                let wide = to_f64(item.bound);
                // 0·∞ is not a number, and so no maximum: a channel without light needs no tolerance.
                item.share = (wide[0] * inverse[0]).max(wide[1] * inverse[1]).max(wide[2] * inverse[2]).max(0.0);
            }
            self.left_out = [spent; 3];
            let fitting = self.leave_out_weakest(&mut weak, tolerance);
            let (left_out, kept) = weak.split_at(fitting);
            let is_blurred = weak.iter().any(|item| item.blur > 0.0);
            let largest_unseen = inverse.into_iter().fold(0.0, f64::max) * spent;
            if (is_blurred || spent > 0.0) && !is_certain(left_out, kept, tolerance, largest_unseen) {
                if !is_blurred {
                    break false;
                }
                for item in weak.iter_mut().filter(|item| item.blur > 0.0) {
                    (item.bound, item.blur) = (exact(item.light), 0.0);
                }
                continue;
            }
            let strong = [self.diffuse.len(), self.specular.len()];
            for item in kept {
                self.list(item.term).push(item.light);
            }
            for (list, strong) in [(&mut self.diffuse, strong[0]), (&mut self.specular, strong[1])] {
                if list.len() > strong {
                    list.sort_unstable();
                }
            }
            break true;
        };
        self.weak = weak;
        is_certain
    }

    /// Moves the longest run of weakest terms that fits to the front, and gives its length: a bisection in which each
    /// step partitions half as many terms as the one before.
    fn leave_out_weakest(&mut self, weak: &mut [WeakTerm<T>], tolerance: [f64; 3]) -> usize {
        // The first `fitting` terms are the weakest and fit; those from `kept` on are the strongest, too much together.
        let (mut fitting, mut kept) = (0, weak.len());
        while fitting < kept {
            let open = &mut weak[fitting..kept];
            let half = open.len().div_ceil(2);
            open.select_nth_unstable_by(half - 1, WeakTerm::order);
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

/// Whether the same terms are left out whatever the bounds are, as far as they are known: those kept are all stronger
/// than those left out and than `largest_unseen`, and none would fit beside those left out.
fn is_certain<T: Real>(
    left_out: &[WeakTerm<T>],
    kept: &[WeakTerm<T>],
    tolerance: [f64; 3],
    largest_unseen: f64,
) -> bool {
    let largest = |blurred: bool| {
        left_out.iter().filter(|item| !blurred || item.blur > 0.0).map(|item| item.share).fold(0.0, f64::max)
    };
    // Two that are exact are in order already.
    let (largest, largest_blurred) = (largest(false).max(largest_unseen), largest(true).max(largest_unseen));
    let next = kept.iter().map(|item| item.share).fold(f64::INFINITY, f64::min);
    let sum = left_out.iter().fold([0.0; 3], |sum, item| add(sum, item.least())).map(|sum| sum * ROUNDING);
    kept.iter().all(|item| {
        let is_stronger = item.least_share() > if item.blur > 0.0 { largest } else { largest_blurred };
        let may_be_next = item.least_share() <= next;
        is_stronger && !(may_be_next && within(add(sum, item.least()), tolerance))
    })
}

/// Whether no channel exceeds its tolerance; false where one is not a number.
fn within(bound: [f64; 3], tolerance: [f64; 3]) -> bool {
    (0..3).all(|c| bound[c] <= tolerance[c])
}

fn to_f64<T: Real>(a: [T; 3]) -> [f64; 3] {
    // Both number types convert.
    a.map(|x| x.to_f64().unwrap_or(f64::NAN))
}
