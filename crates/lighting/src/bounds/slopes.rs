//! How steep and how bent the powers of a cosine are.

use super::quick::power_within;
use crate::equations::{Real, power};

/// Bounds of the derivatives of max(cos f, 0)ⁿ by f, over all angles from some f₀ on.
///
/// With c = cos f and s = sin f, the first is −n·cⁿ⁻¹·s, and the second n·(n − 1)·cⁿ⁻²·s² − n·cⁿ. Each product has one
/// peak; before it the bound is the peak's value, behind it the value at f₀.
#[derive(Clone, Copy, Debug)]
pub struct PowerSlopes<T> {
    exponent: T,
    /// The cosines at which n·cⁿ⁻¹·s, n·(n − 1)·cⁿ⁻²·s² and n·cⁿ⁻¹·(1 − c) have their peaks, and these.
    peaks: [[T; 2]; 3],
}

impl<T: Real> PowerSlopes<T> {
    /// Of this exponent, 0 or more.
    pub fn new(exponent: T) -> Self {
        let (n, one, two) = (exponent, T::one(), T::of(2.0));
        let steepest = ((n - one) / n).max(T::zero()).sqrt();
        let bent = ((n - two) / n).max(T::zero()).sqrt();
        let raised = ((n - one) / n).max(T::zero());
        let square_of_sine = |c: T| (one - c) * (one + c);
        let peaks = [
            [steepest, n * power(steepest, n - one) * square_of_sine(steepest).sqrt()],
            [bent, n * (n - one) * power(bent, n - two) * square_of_sine(bent)],
            [raised, n * power(raised, n - one) * (one - raised)],
        ];
        Self { exponent, peaks }
    }

    /// n.
    pub fn exponent(&self) -> T {
        self.exponent
    }

    /// Where its products have their peaks, and these.
    pub(super) fn peaks(&self) -> [[T; 2]; 3] {
        self.peaks
    }

    /// For cosines of at most `c`: the largest size of the first derivative; of −n·cⁿ⁻¹, by which the second one may
    /// fall; the most by which it may rise; and the largest power itself. The second derivative is bounded for n ≥ 2
    /// alone, or where n is 1, and the first for n ≥ 1: elsewhere they are infinite.
    pub(super) fn from(&self, c: T) -> [T; 4] {
        let (n, zero, one) = (self.exponent, T::zero(), T::one());
        if c <= zero && n > zero {
            return [zero; 4];
        }
        let c = c.max(zero).min(one);
        if n < T::of(2.0) {
            let [_, largest] = power_within(c, n);
            let steepest = if n == zero {
                zero
            } else if n < one {
                T::infinity()
            } else {
                n
            };
            let bent = if n == one || n == zero { n } else { T::infinity() };
            return [steepest, bent, bent, largest];
        }
        let [_, lower] = power_within(c, n - T::of(2.0));
        let squared = (one - c) * (one + c);
        let at_c = [n * lower * c * squared.sqrt(), n * (n - one) * lower * squared, n * lower * c * (one - c)];
        let of = |i: usize| if c > self.peaks[i][0] { self.peaks[i][1] } else { at_c[i] };
        [of(0), n * lower * c, of(1) + of(2), lower * c * c]
    }
}
