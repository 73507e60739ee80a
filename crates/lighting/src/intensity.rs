//! Intensity policies: what becomes of intensities above 1.

use std::ops::Bound::{Excluded, Included, Unbounded};

use crate::choices::{Choice, Choices};
use crate::equations::{aces, reinhard};
use crate::invalid::{Fields, InvalidValue};
use crate::range::Range;

/// The policy for intensities above 1.
///
/// [`Clamp`](Self::Clamp) acts on each surface, and costs nothing. The others act on the finished picture: on
/// intensities that have been blended, and averaged where a pixel has several samples. It is drawn in floating point
/// for that, and what is above 1 after the policy is clamped as bytes are written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Intensity {
    /// min(I, 1) a channel, as each surface is written and before it is blended. Floating-point
    /// pictures are not clamped.
    #[default]
    Clamp,
    /// Where any channel of the picture exceeds 1, all are divided by the largest
    /// ([`equations::divisor`](crate::equations::divisor)).
    Renormalize {
        /// The share of the last frame's divisor that stays, 0 to below 1; 0 for each frame by itself. A change has
        /// come to 1/e of what is left after −1/ln(smoothing) frames. While the divisor follows a picture that grows
        /// brighter, channels exceed 1.
        smoothing: f32,
    },
    /// The extended curve of Reinhard and others, a channel by itself
    /// ([`equations::reinhard`](crate::equations::reinhard)).
    Reinhard {
        /// The intensity that becomes 1, itself 1 or more. Default [`Intensity::WHITE`].
        white: f32,
    },
    /// Narkowicz's fit to the curve of ACES, a channel by itself ([`equations::aces`](crate::equations::aces)).
    Aces,
}

impl Intensity {
    /// The default of [`Reinhard::white`](Self::Reinhard).
    pub const WHITE: f32 = 4.0;
    /// The values of [`Renormalize::smoothing`](Self::Renormalize).
    pub const SMOOTHING_RANGE: Range = Range::new(Included(0.0), Excluded(1.0), "a number from 0 to below 1");
    /// The values of [`Reinhard::white`](Self::Reinhard).
    pub const WHITE_RANGE: Range = Range::new(Included(1.0), Unbounded, "a finite number, 1 or more");

    /// Its name for readers, such as "Reinhard", whatever its number.
    pub fn name(self) -> &'static str {
        let kind = std::mem::discriminant(&self);
        let choice = Self::CHOICES.iter().find(|choice| std::mem::discriminant(&choice.value) == kind);
        choice.map_or("", |choice| choice.name)
    }

    /// Whether it acts on the finished picture, and not on each surface.
    pub fn acts_on_pictures(self) -> bool {
        self != Self::Clamp
    }

    /// One channel of the finished picture, but for a divisor. Grows with the intensity.
    pub fn toned(self, intensity: f64) -> f64 {
        match self {
            Self::Clamp | Self::Renormalize { .. } => intensity,
            Self::Reinhard { white } => reinhard(intensity, (f64::from(white) * f64::from(white)).recip()),
            Self::Aces => aces(intensity),
        }
    }

    /// By how much more than an intensity what becomes of it changes, at most.
    ///
    /// Reinhard's curve is steepest at 0, with 1. That of ACES has a slope of 1.801 near 0.12. Under a divisor m of 1
    /// or more both the channel and m may be off, each by so much as m: twice.
    pub fn steepest(self) -> f64 {
        match self {
            Self::Clamp | Self::Reinhard { .. } => 1.0,
            Self::Renormalize { .. } => 2.0,
            Self::Aces => 1.802,
        }
    }

    /// Checks its number.
    ///
    /// # Errors
    /// The number is out of its range.
    pub fn validate(self) -> Result<(), InvalidValue> {
        let fields = Fields::for_owner("Intensity");
        match self {
            Self::Clamp | Self::Aces => Ok(()),
            Self::Renormalize { smoothing } => fields.within("Renormalize.smoothing", smoothing, Self::SMOOTHING_RANGE),
            Self::Reinhard { white } => fields.within("Reinhard.white", white, Self::WHITE_RANGE),
        }
    }
}

/// Each with the default of its number.
impl Choices for Intensity {
    const CHOICES: &'static [Choice<Self>] = &[
        Choice { value: Self::Clamp, key: "clamp", name: "clamped", meaning: "min(I, 1) for every channel." },
        Choice {
            value: Self::Renormalize { smoothing: 0.0 },
            key: "renormalise",
            name: "renormalised",
            meaning: "Where any channel exceeds 1, all of the picture are divided by the largest.",
        },
        Choice {
            value: Self::Reinhard { white: Self::WHITE },
            key: "reinhard",
            name: "Reinhard",
            meaning: "I·(1 + I/w²)/(1 + I) for every channel, with a white point w of 4.",
        },
        Choice {
            value: Self::Aces,
            key: "aces",
            name: "ACES",
            meaning: "I·(2.51·I + 0.03)/(I·(2.43·I + 0.59) + 0.14), at most 1, for every channel.",
        },
    ];
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equations::divisor;

    #[test]
    fn curves_grow_from_0_and_reach_1_where_they_say() {
        for white in [1.0, 1.5, 4.0, 1e4, f32::MAX] {
            let policy = Intensity::Reinhard { white };
            assert_eq!(policy.validate(), Ok(()));
            assert!((policy.toned(white.into()) - 1.0).abs() < 1e-12, "white {white}");
        }
        // By hand: 2·(1 + 2/16)/3, and 1·2.54/(2.43 + 0.59 + 0.14).
        assert!((Intensity::Reinhard { white: 4.0 }.toned(2.0) - 0.75).abs() < 1e-15);
        assert!((Intensity::Aces.toned(1.0) - 2.54 / 3.16).abs() < 1e-15);
        assert!(Intensity::Aces.toned(7.2) < 1.0);
        for high in [7.25, 8.0, 1e300] {
            assert!((Intensity::Aces.toned(high) - 1.0).abs() < 1e-15);
        }
        for policy in [Intensity::Reinhard { white: 4.0 }, Intensity::Reinhard { white: 1.0 }, Intensity::Aces] {
            let at = |k: i32| policy.toned(1e-4 * f64::from(k));
            assert!(at(0).abs() < 1e-15);
            let slopes = (0..100_000).map(|k| (at(k + 1) - at(k)) / 1e-4);
            let (least, most) = slopes.fold((f64::MAX, 0.0), |(a, b): (f64, f64), s| (a.min(s), b.max(s)));
            assert!(least >= 0.0 && most <= policy.steepest() + 1e-9, "{policy:?}: {least} to {most}");
            // And it is not far above.
            assert!(most > policy.steepest() - 0.01, "{policy:?}: {most}");
        }
    }

    #[test]
    fn nothing_overflows_in_f32() {
        for i in [0.0, 1e-38, 1.0, 1e19, 1e30, f32::MAX] {
            assert!(aces(i) <= 1.0 && reinhard(i, 0.0) <= 1.0, "{i}");
            assert!(reinhard(i, 1.0).is_finite(), "{i}: a white point of 1 changes nothing");
        }
    }

    #[test]
    fn divisors_are_the_largest_channel_from_1_and_follow_it() {
        for (largest, before, smoothing, expected) in [
            (0.5, 9.0, 0.0, 1.0),
            (1.0, 9.0, 0.0, 1.0),
            (4.0, 9.0, 0.0, 4.0),
            (4.0, 2.0, 0.5, 3.0),
            (0.5, 2.0, 0.75, 1.75),
            (4.0, 4.0, 0.9, 4.0),
        ] {
            let found: f64 = divisor(largest, before, smoothing);
            assert!((found - expected).abs() < 1e-15, "{largest} {before} {smoothing}: {found}");
        }
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        for (policy, message) in [
            (
                Intensity::Renormalize { smoothing: 1.0 },
                "Intensity.Renormalize.smoothing: the value is 1.0; expected a number from 0 to below 1",
            ),
            (
                Intensity::Renormalize { smoothing: f32::NAN },
                "Intensity.Renormalize.smoothing: the value is NaN; expected a number from 0 to below 1",
            ),
            (
                Intensity::Reinhard { white: 0.99 },
                "Intensity.Reinhard.white: the value is 0.99; expected a finite number, 1 or more",
            ),
        ] {
            assert_eq!(policy.validate().map_err(|error| error.to_string()), Err(message.to_owned()));
        }
    }
}
