//! Percentiles.

/// The percentages of [`Statistics::percentiles`](super::Statistics::percentiles).
pub const PERCENTILES: [f64; 4] = [50.0, 95.0, 99.0, 99.9];

/// The rank, from 0, of the least of N sorted values that `share` per cent of them do not exceed.
pub(super) fn nearest_rank(values: u64, share: f64) -> u64 {
    // Rounding may leave the product a little above a whole number.
    (values as f64 * share / 100.0 - 1e-6).ceil().max(1.0) as u64 - 1
}

/// The least of the sorted values that `share` per cent of them do not exceed; 0 where there are none.
pub(super) fn percentile(sorted: &[f64], share: f64) -> f64 {
    sorted.get(nearest_rank(sorted.len() as u64, share) as usize).copied().unwrap_or(0.0)
}

/// The [`percentile`] of the values, 0 and above, of several sorted lists together.
pub(super) fn percentile_of_all(sorted: &[Vec<f64>], share: f64) -> f64 {
    let values: usize = sorted.iter().map(Vec::len).sum();
    let rank = nearest_rank(values as u64, share) as usize;
    let not_above = |value: f64| sorted.iter().map(|list| list.partition_point(|other| *other <= value)).sum::<usize>();
    // The bits of such numbers are in their order.
    let (mut low, mut high) = (0, f64::INFINITY.to_bits());
    while values > 0 && low < high {
        let middle = low + (high - low) / 2;
        if not_above(f64::from_bits(middle)) > rank { high = middle } else { low = middle + 1 }
    }
    f64::from_bits(low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn those_of_several_lists_are_those_of_one(
            values in prop::collection::vec(
                prop_oneof![0.0..1.0_f64, Just(0.0), Just(0.25), 0.25..0.25 + 1e-14, 0.0..f64::MIN_POSITIVE, 0.0..f64::MAX],
                0..300,
            ),
        ) {
            let mut one = values.clone();
            one.sort_by(f64::total_cmp);
            let mut lists: Vec<Vec<f64>> = values.chunks(values.len() / 3 + 1).map(<[f64]>::to_vec).collect();
            for list in &mut lists {
                list.sort_by(f64::total_cmp);
            }
            let expected = PERCENTILES.map(|share| percentile(&one, share));
            let found = PERCENTILES.map(|share| percentile_of_all(&lists, share));
            prop_assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits));
        }
    }
}
