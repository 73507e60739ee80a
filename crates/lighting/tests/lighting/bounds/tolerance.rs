//! A change of a linear intensity within the tolerance is one within the tolerance in the picture.

use halfway_lighting::Encoding;
use halfway_lighting::bounds::{STEP, linear_tolerance};
use proptest::prelude::*;

use super::support::cases;

/// The value of a channel of an 8-bit picture before rounding.
fn written(encoding: Encoding, linear: f64) -> f64 {
    encoding.encode(linear.min(1.0))
}

proptest! {
    #![proptest_config(cases(1000))]

    #[test]
    fn no_change_within_the_tolerance_is_visible(
        known in 0f64..1.2,
        more in 0f64..1.0,
        share in 0f64..=1.0,
        tolerance in 1e-4..0.5f64,
    ) {
        for encoding in [Encoding::Srgb, Encoding::Raw] {
            let allowed = linear_tolerance(encoding, tolerance, known);
            let change = if allowed.is_finite() { allowed * share } else { share * 1e3 };
            let without = known + more;
            let seen = written(encoding, without + change) - written(encoding, without);
            // The two pieces of the sRGB curve meet up to 3·10⁻⁸.
            prop_assert!(seen <= tolerance + 1e-7, "{encoding:?}: {seen}");
        }
    }
}

/// The closed forms, and that more is allowed where more is known.
#[test]
fn the_worst_place_is_black() {
    const HALF_A_STEP: f64 = 0.5 * STEP;
    assert_eq!(linear_tolerance(Encoding::Raw, HALF_A_STEP, 0.0), 1.0 / 510.0);
    let black = linear_tolerance(Encoding::Srgb, HALF_A_STEP, 0.0);
    assert!((black / (1.0 / 510.0 / 12.92) - 1.0).abs() < 1e-12, "{black}");
    let mut last = black;
    for step in 1..100 {
        let allowed = linear_tolerance(Encoding::Srgb, HALF_A_STEP, f64::from(step) * 0.01);
        assert!(allowed > last, "{allowed} after {last} at {step} %");
        last = allowed;
    }
    assert_eq!(linear_tolerance(Encoding::Srgb, HALF_A_STEP, 1.0), f64::INFINITY);
    assert_eq!(linear_tolerance(Encoding::Srgb, 0.0, 0.5), 0.0);
    assert_eq!(linear_tolerance(Encoding::Srgb, f64::NAN, 0.5), 0.0);
}
