//! Random numbers that are the same on every machine: whole numbers, sums, products and roots only.

use fastrand::Rng;

/// The numbers of one scene of a seed.
pub(crate) fn for_scene(seed: u64, scene: u64) -> Rng {
    // The scene's number changes the seeded state, so that no scene repeats numbers of its neighbours.
    Rng::with_seed(Rng::with_seed(seed).u64(..) ^ scene)
}

/// The random values of scenes.
pub(crate) trait RngExt {
    /// In [low, high).
    fn between(&mut self, low: f64, high: f64) -> f64;
    /// True in `percent` of a hundred cases.
    fn percent(&mut self, percent: u64) -> bool;
    /// One of these.
    fn choose<T: Copy>(&mut self, choices: &[T]) -> T;
    /// From 2^`low` to 2^(`high` + 1), each power about as often as the next.
    fn magnitude(&mut self, low: i32, high: i32) -> f64;
    /// A direction of length 1, uniformly distributed.
    fn direction(&mut self) -> [f64; 3];
}

impl RngExt for Rng {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.f64()
    }

    fn percent(&mut self, percent: u64) -> bool {
        self.u64(..100) < percent
    }

    fn choose<T: Copy>(&mut self, choices: &[T]) -> T {
        // Not by `choice`, which draws a `usize`: that differs on machines of 32 bits.
        choices[self.u64(..choices.len() as u64) as usize]
    }

    fn magnitude(&mut self, low: i32, high: i32) -> f64 {
        let power = self.i32(low..=high);
        let whole = (0..power.unsigned_abs()).fold(1.0, |product, _| product * 2.0);
        let power = if power < 0 { 1.0 / whole } else { whole };
        power * (1.0 + self.f64())
    }

    fn direction(&mut self) -> [f64; 3] {
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
        let mut random = for_scene(1, 2);
        for _ in 0..1000 {
            assert!((-2.0..3.0).contains(&random.between(-2.0, 3.0)));
            assert!((0.25..16.0).contains(&random.magnitude(-2, 3)));
            let length: f64 = random.direction().iter().map(|c| c * c).sum();
            assert!((length - 1.0).abs() < 1e-12);
        }
    }
}
