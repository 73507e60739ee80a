//! Random numbers that are the same on every machine: whole numbers, sums, products and roots only.

/// `splitmix64`, Steele, Lea and Flood 2014.
#[derive(Debug)]
pub(crate) struct Random(u64);

impl Random {
    /// The numbers of one scene of a seed.
    pub(crate) fn new(seed: u64, scene: u64) -> Self {
        // The second word starts where the first one has led to, so that no scene repeats numbers of its neighbours.
        let start = Self(seed).bits();
        Self(Self(start ^ scene).bits())
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In [low, high).
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// From `low` to `high`, both included.
    pub(crate) fn whole(&mut self, low: u64, high: u64) -> u64 {
        low + self.bits() % (high - low + 1)
    }

    /// True in `percent` of a hundred cases.
    pub(crate) fn percent(&mut self, percent: u64) -> bool {
        self.bits() % 100 < percent
    }

    /// One of these.
    pub(crate) fn of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[(self.bits() % choices.len() as u64) as usize]
    }

    /// From 2^`low` to 2^(`high` + 1), each power about as often as the next.
    pub(crate) fn magnitude(&mut self, low: i32, high: i32) -> f64 {
        let power = low + (self.bits() % (high - low + 1) as u64) as i32;
        let whole = (0..power.unsigned_abs()).fold(1.0, |product, _| product * 2.0);
        let power = if power < 0 { 1.0 / whole } else { whole };
        power * (1.0 + self.unit())
    }

    /// A direction of length 1, none preferred.
    pub(crate) fn direction(&mut self) -> [f64; 3] {
        loop {
            let v: [f64; 3] = std::array::from_fn(|_| self.between(-1.0, 1.0));
            let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
            if (0.1..=1.0).contains(&length) {
                return v.map(|c| c / length);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_to_their_ranges() {
        let mut random = Random::new(1, 2);
        let mut whole = [0; 4];
        for _ in 0..1000 {
            assert!((0.0..1.0).contains(&random.unit()));
            assert!((-2.0..3.0).contains(&random.between(-2.0, 3.0)));
            assert!((0.25..16.0).contains(&random.magnitude(-2, 3)));
            whole[random.whole(2, 5) as usize - 2] += 1;
            let length: f64 = random.direction().iter().map(|c| c * c).sum();
            assert!((length - 1.0).abs() < 1e-12);
        }
        assert!(whole.iter().all(|&times| times > 150), "{whole:?}");
    }
}
