//! Fills the empty texels of an image from their neighbours.

/// The numbers with the missing ones filled in: each is the mean of its neighbours, corners included, that are already
/// known. Texels next to known ones come first, then the ring around those. At least one number must be known.
pub(super) fn dilated(mut numbers: Vec<Option<f32>>, width: usize) -> Vec<f32> {
    let mut ring: Vec<usize> = (0..numbers.len()).filter(|at| numbers[*at].is_none()).collect();
    ring.retain(|at| around(*at, width, numbers.len()).any(|beside| numbers[beside].is_some()));
    while !ring.is_empty() {
        let mean = |at: &usize| {
            let (mut sum, mut count) = (0.0, 0);
            for number in around(*at, width, numbers.len()).filter_map(|beside| numbers[beside]) {
                (sum, count) = (sum + number, count + 1);
            }
            sum / f32::from(count.max(1_u8))
        };
        let means: Vec<f32> = ring.iter().map(mean).collect();
        for (at, mean) in ring.iter().zip(means) {
            numbers[*at] = Some(mean);
        }
        let mut next: Vec<usize> = ring
            .iter()
            .flat_map(|at| around(*at, width, numbers.len()))
            .filter(|beside| numbers[*beside].is_none())
            .collect();
        next.sort_unstable();
        next.dedup();
        ring = next;
    }
    numbers.into_iter().map(Option::unwrap_or_default).collect()
}

/// The up to eight neighbours of a texel.
fn around(at: usize, width: usize, count: usize) -> impl Iterator<Item = usize> {
    let (x, y, height) = (at % width, at / width, count / width);
    let beside = |at: usize, side: usize| at.saturating_sub(1)..(at + 2).min(side);
    beside(y, height).flat_map(move |y| beside(x, width).map(move |x| y * width + x)).filter(move |other| *other != at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_are_means_of_what_is_before_them() {
        let (n, one, three) = (None, Some(1.0), Some(3.0));
        assert_eq!(dilated(vec![one, n, n, n, three], 5), [1.0, 1.0, 2.0, 3.0, 3.0]);
        assert_eq!(dilated(vec![n, one, n, n, n, n, n, n, n], 3), [1.0; 9]);
        // Two beside it and one at a corner.
        assert_eq!(dilated(vec![one, three, three, n], 2), [1.0, 3.0, 3.0, 7.0 / 3.0]);
        assert_eq!(dilated(vec![one, three], 1), [1.0, 3.0]);
    }
}
