//! The values at some ranks among many, found without keeping the values.

/// The shares of [`Statistics::percentiles`](super::Statistics::percentiles), in per cent.
pub const PERCENTILES: [f64; 4] = [50.0, 95.0, 99.0, 99.9];

/// Bits that a pass tells of the values at the ranks.
const DIGIT: u32 = 13;
/// Passes over all values: 13 bits each of 64, the last one fewer.
pub(super) const PASSES: u32 = u64::BITS.div_ceil(DIGIT);

/// The nearest ranks of [`PERCENTILES`] among values of 0 and above, in [`PASSES`] passes over them, the same values in
/// each.
///
/// The bits of such numbers are in their order. A pass counts by the next digit those values that share all digits
/// before it with the value that is looked for.
pub(super) struct Ranks {
    pass: u32,
    values: u64,
    /// By percentile what is known of its value, and its rank among the values that begin so, from 0.
    found: [(u64, u64); 4],
    /// By percentile and digit how many values continue with it. Of equal beginnings only the first counts.
    counts: Vec<u64>,
}

impl Ranks {
    pub(super) fn new() -> Self {
        Self { pass: 0, values: 0, found: [(0, 0); 4], counts: vec![0; PERCENTILES.len() << DIGIT] }
    }

    /// How far the digits of this pass stand from the last bit.
    fn shift(&self) -> u32 {
        (u64::BITS - DIGIT).saturating_sub(DIGIT * self.pass)
    }

    /// Takes a value of this pass.
    pub(super) fn push(&mut self, value: f64) {
        // −0 is 0.
        let bits = if value == 0.0 { 0 } else { value.to_bits() };
        let shift = self.shift();
        let digit = (bits >> shift) as usize & ((1 << DIGIT) - 1);
        if self.pass == 0 {
            self.values += 1;
            self.counts[digit] += 1;
            return;
        }
        let unknown = u64::BITS - DIGIT * self.pass;
        if let Some(first) = self.found.iter().position(|(found, _)| found >> unknown == bits >> unknown) {
            self.counts[(first << DIGIT) + digit] += 1;
        }
    }

    /// Ends a pass.
    pub(super) fn next_pass(&mut self) {
        if self.pass == 0 {
            for ((_, rank), share) in self.found.iter_mut().zip(PERCENTILES) {
                *rank = nearest_rank(self.values, share);
            }
        }
        let (shift, before) = (self.shift(), self.found);
        for (found, rank) in &mut self.found {
            let first = before.iter().position(|(other, _)| other == found).unwrap_or_default();
            let counts = &self.counts[first << DIGIT..][..1 << DIGIT];
            for (digit, &count) in counts.iter().enumerate() {
                if *rank < count {
                    *found |= (digit as u64) << shift;
                    break;
                }
                *rank -= count;
            }
        }
        self.counts.fill(0);
        self.pass += 1;
    }

    /// The values, after [`PASSES`] passes; 0 where there were none.
    pub(super) fn percentiles(&self) -> [f64; 4] {
        self.found.map(|(bits, _)| f64::from_bits(bits))
    }
}

/// The rank, from 0, of the least of N sorted values that `share` per cent of them do not exceed.
pub(super) fn nearest_rank(values: u64, share: f64) -> u64 {
    // The product may end a little above a whole number that it stands for.
    (values as f64 * share / 100.0 - 1e-6).ceil().max(1.0) as u64 - 1
}

/// The least of the sorted values that `share` per cent of them do not exceed; 0 where there are none.
pub(super) fn percentile(sorted: &[f64], share: f64) -> f64 {
    sorted.get(nearest_rank(sorted.len() as u64, share) as usize).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn found(values: &[f64]) -> [f64; 4] {
        let mut ranks = Ranks::new();
        for _ in 0..PASSES {
            for value in values {
                ranks.push(*value);
            }
            ranks.next_pass();
        }
        ranks.percentiles()
    }

    proptest! {
        #[test]
        fn they_are_those_of_the_sorted_values(
            mut values in prop::collection::vec(
                prop_oneof![0.0..1.0_f64, Just(0.0), Just(0.25), 0.25..0.25 + 1e-14, 0.0..f64::MIN_POSITIVE, 0.0..f64::MAX],
                0..3000,
            ),
        ) {
            let found = found(&values);
            values.sort_by(f64::total_cmp);
            let expected = PERCENTILES.map(|share| percentile(&values, share));
            prop_assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits));
        }
    }

    #[test]
    fn none_are_0_and_both_zeros_are_one() {
        assert_eq!(found(&[]).map(f64::to_bits), [0; 4]);
        assert_eq!(found(&[0.0, -0.0, -0.0, 1.0]).map(f64::to_bits), [0, 1, 1, 1].map(|x| f64::from(x).to_bits()));
    }
}
