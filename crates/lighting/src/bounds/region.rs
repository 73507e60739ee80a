//! Where patches lie that look for their lights together.

/// A box that holds patches, and what they do with light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// The least coordinates of the spheres around the patches, in the space of the evaluation.
    pub low: [f32; 3],
    /// The largest.
    pub high: [f32; 3],
    /// The largest coefficient of any patch in it: ambient, diffuse or specular, of any channel.
    pub brightest: f32,
    /// The least tolerance of any patch in it, in any channel.
    pub tolerance: f64,
}

impl Region {
    /// Nowhere: to be widened by [`Region::with`].
    pub const EMPTY: Self =
        Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3], brightest: 0.0, tolerance: f64::INFINITY };

    /// The region, with a sphere; everywhere, if that is infinite or no number.
    #[must_use]
    pub fn with(self, center: [f32; 3], radius: f32) -> Self {
        if !(radius.is_finite() && center.iter().all(|x| x.is_finite())) {
            return Self { low: [f32::NEG_INFINITY; 3], high: [f32::INFINITY; 3], ..self };
        }
        Self {
            low: [0, 1, 2].map(|k| self.low[k].min(center[k] - radius)),
            high: [0, 1, 2].map(|k| self.high[k].max(center[k] + radius)),
            ..self
        }
    }

    /// The distance from the origin beyond which there is nothing of it.
    pub(super) fn farthest(&self) -> f32 {
        (0..3).map(|k| self.low[k].abs().max(self.high[k].abs())).sum()
    }
}
