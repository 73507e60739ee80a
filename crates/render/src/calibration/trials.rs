//! Which prices draw faster, by frames that took turns.

/// How long frames took by several prices, in any unit.
#[derive(Clone, Debug, Default)]
pub(super) struct Trials {
    /// Scene by scene, round by round, price by price.
    pub(super) scenes: Vec<Vec<Vec<f64>>>,
}

/// How long frames took by some prices, as a multiple of those by the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Trial {
    /// The geometric mean over the scenes, of each the median of its rounds.
    pub(super) ratio: f64,
    /// By what factor that may be off: twice the standard error of its logarithm.
    pub(super) uncertainty: f64,
}

impl Trial {
    /// Whether frames are surely shorter.
    pub(super) fn is_faster(self) -> bool {
        self.ratio * self.uncertainty < 1.0
    }
}

impl Trials {
    /// Of the prices with this number.
    pub(super) fn of(&self, number: usize) -> Trial {
        let (mut sum, mut apart) = (0.0, Vec::new());
        for rounds in &self.scenes {
            let logs = || rounds.iter().map(|times| (times[number] / times[0]).ln());
            let middle = median(logs());
            sum += middle;
            apart.extend(logs().map(|log| (log - middle).abs()));
        }
        // The standard deviation of what is spread normally is 1.48 times the median of what is apart from the middle,
        // and the standard error of a median √(π/2) of a mean's.
        let error = 1.2533 * 1.4826 * median(apart.iter().copied()) / (apart.len() as f64).sqrt();
        Trial { ratio: (sum / self.scenes.len() as f64).exp(), uncertainty: (2.0 * error).exp() }
    }
}

/// The middle value; the upper of two, NaN of none.
fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of prices by which each frame takes so many times as long, of two scenes with five rounds each, in all of which
    /// the machine is as slow as it likes, and in one of which something else runs beside them.
    fn of(ratios: [[f64; 5]; 2]) -> Trial {
        let slow = [1.0, 7.0, 2.0, 1.5, 3.0];
        let rounds = |of: [f64; 5]| (0..5).map(|i| vec![slow[i], slow[i] * of[i]]).collect();
        Trials { scenes: ratios.map(rounds).into() }.of(1)
    }

    #[test]
    fn the_middle_of_each_scene_counts() {
        let even = of([[0.5; 5], [0.98; 5]]);
        assert!((even.ratio - 0.7).abs() < 1e-12 && (even.uncertainty - 1.0).abs() < 1e-12, "{even:?}");
        let disturbed = of([[0.5, 0.5, 9.0, 0.5, 0.5], [0.98, 0.1, 0.98, 0.98, 0.98]]);
        assert_eq!(disturbed, even);
    }

    #[test]
    fn what_differs_from_round_to_round_says_little() {
        assert!(of([[0.99; 5], [0.98; 5]]).is_faster());
        assert!(!of([[1.0; 5], [1.0; 5]]).is_faster());
        let noisy = of([[0.97, 1.3, 0.8, 0.97, 1.2], [0.6, 0.97, 1.4, 0.97, 1.1]]);
        assert!(noisy.ratio < 0.98 && !noisy.is_faster(), "{noisy:?}");
        assert!(of([[0.6, 0.7, 0.5, 0.65, 0.6], [0.8, 0.6, 0.7, 0.6, 0.75]]).is_faster());
        assert!(!of([[f64::NAN; 5], [0.5; 5]]).is_faster());
        assert!(!Trials::default().of(0).is_faster());
    }
}
