//! Numbers in time, by key frames (glTF 2.0, appendix C).

use glam::{DQuat, DVec4};

/// Key frames: times in seconds that grow, and as many numbers at each.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Curve {
    times: Vec<f32>,
    /// Of a cubic spline the tangent before, the value and the tangent after of each key frame.
    values: Vec<f32>,
    /// The numbers of a value.
    width: usize,
    interpolation: Interpolation,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Interpolation {
    Step,
    Linear,
    CubicSpline,
}

impl Interpolation {
    /// How many values there are at each key frame.
    pub(crate) fn values(self) -> usize {
        if self == Self::CubicSpline { 3 } else { 1 }
    }
}

impl Curve {
    /// A curve of at least one key frame, with values for each.
    pub(crate) fn new(times: Vec<f32>, values: Vec<f32>, interpolation: Interpolation) -> Self {
        let width = values.len() / (times.len() * interpolation.values());
        debug_assert_eq!(values.len(), width * times.len() * interpolation.values());
        Self { times, values, width, interpolation }
    }

    /// The times of the key frames.
    pub(crate) fn times(&self) -> &[f32] {
        &self.times
    }

    /// The numbers of all key frames.
    pub(crate) fn values(&self) -> &[f32] {
        &self.values
    }

    pub(crate) fn interpolation(&self) -> Interpolation {
        self.interpolation
    }

    /// The time of the last key frame.
    pub(crate) fn end(&self) -> f64 {
        self.times.last().copied().map_or(0.0, f64::from)
    }

    /// The value at a time: before the first key frame that of the first, after the last one that of the last. Rotations
    /// turn by the shorter way at an even speed.
    pub(crate) fn at(&self, time: f64, is_rotation: bool) -> Vec<f64> {
        let next = self.times.partition_point(|key| f64::from(*key) <= time);
        let before = next.saturating_sub(1);
        let after = next.min(self.times.len() - 1);
        let [start, end] = [before, after].map(|key| f64::from(self.times[key]));
        let (span, t) = (end - start, if end > start { ((time - start) / (end - start)).clamp(0.0, 1.0) } else { 0.0 });
        let mix = |f: &dyn Fn(f64, f64, usize) -> f64| -> Vec<f64> {
            let [a, b] = [before, after].map(|key| self.numbers(key, self.middle()));
            a.iter().zip(b).enumerate().map(|(i, (&a, &b))| f(a.into(), b.into(), i)).collect()
        };
        match self.interpolation {
            Interpolation::Step => mix(&|a, _, _| a),
            Interpolation::Linear if is_rotation && self.width == 4 => {
                let [a, b] = [before, after].map(|key| {
                    let mut four = [0.0; 4];
                    four.iter_mut().zip(self.numbers(key, 0)).for_each(|(to, from)| *to = f64::from(*from));
                    unit(DQuat::from_array(four))
                });
                DVec4::from(a.slerp(b, t)).to_array().to_vec()
            }
            Interpolation::Linear => mix(&|a, b, _| a + (b - a) * t),
            Interpolation::CubicSpline => {
                let (leaving, entering) = (self.numbers(before, 2), self.numbers(after, 0));
                let (t2, t3) = (t * t, t * t * t);
                mix(&|a, b, i| {
                    (2.0 * t3 - 3.0 * t2 + 1.0) * a
                        + span * (t3 - 2.0 * t2 + t) * f64::from(leaving[i])
                        + (3.0 * t2 - 2.0 * t3) * b
                        + span * (t3 - t2) * f64::from(entering[i])
                })
            }
        }
    }

    /// Which of a key frame's values is the value itself.
    fn middle(&self) -> usize {
        self.interpolation.values() / 2
    }

    fn numbers(&self, key: usize, value: usize) -> &[f32] {
        &self.values[(key * self.interpolation.values() + value) * self.width..][..self.width]
    }
}

/// The quaternion at unit length; none at all turns nothing.
pub(super) fn unit(q: DQuat) -> DQuat {
    DQuat::from_vec4(DVec4::from(q).normalize_or(DVec4::W))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(interpolation: Interpolation, values: &[f32]) -> Curve {
        Curve::new(vec![1.0, 3.0], values.to_vec(), interpolation)
    }

    #[test]
    fn curves_meet_their_formulas() {
        let step = curve(Interpolation::Step, &[2.0, 6.0]);
        let linear = curve(Interpolation::Linear, &[2.0, 6.0]);
        // Tangents of 0: the smooth step 3t² − 2t³. A tangent of 1 at the start adds span·(t³ − 2t² + t).
        let smooth = curve(Interpolation::CubicSpline, &[9.0, 2.0, 0.0, 0.0, 6.0, 9.0]);
        let leaving = curve(Interpolation::CubicSpline, &[9.0, 2.0, 1.0, 0.0, 6.0, 9.0]);
        for (time, stepped, mixed) in
            [(0.0, 2.0, 2.0), (1.0, 2.0, 2.0), (1.5, 2.0, 3.0), (3.0, 6.0, 6.0), (9.0, 6.0, 6.0)]
        {
            assert_eq!(step.at(time, false), [stepped], "{time}");
            assert_eq!(linear.at(time, false), [mixed], "{time}");
            let t: f64 = ((time - 1.0) / 2.0).clamp(0.0, 1.0);
            let expected = 2.0 + 4.0 * (3.0 * t * t - 2.0 * t * t * t);
            assert!((smooth.at(time, false)[0] - expected).abs() < 1e-12, "{time}");
            let bent = expected + 2.0 * (t * t * t - 2.0 * t * t + t);
            assert!((leaving.at(time, false)[0] - bent).abs() < 1e-12, "{time}");
        }
        assert_eq!(step.end().to_bits(), 3_f64.to_bits());
    }

    #[test]
    fn rotations_turn_evenly_by_the_shorter_way() {
        let quarter = DQuat::from_rotation_z(1.5);
        let [x, y, z, w] = quarter.to_array().map(|number| number as f32);
        for sign in [1.0, -1.0] {
            let turn = curve(Interpolation::Linear, &[0.0, 0.0, 0.0, 1.0, sign * x, sign * y, sign * z, sign * w]);
            let found = turn.at(2.0, true);
            let found = DQuat::from_xyzw(found[0], found[1], found[2], found[3]);
            assert!(found.dot(DQuat::from_rotation_z(0.75)).abs() > 1.0 - 1e-7, "{found}");
        }
        assert_eq!(curve(Interpolation::Linear, &[0.0; 8]).at(2.0, true), [0.0, 0.0, 0.0, 1.0]);
    }
}
