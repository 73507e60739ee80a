//! The colour scale of difference pictures.

use colorous::MAGMA;
use image::Rgb;

/// The unit of a difference picture, and the upper end of its colours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scale {
    /// The unit of the errors. Default [`Unit::Steps`].
    pub unit: Unit,
    /// The error of the brightest colour, in the unit; larger errors have the same colour. `None`, the default, takes
    /// the first of 1, 2, 5, 10, 20 … (in linear intensity also 0.5, 0.2 …) that 99.9 % of the pixels do not exceed.
    pub upper: Option<f64>,
}

/// The unit of a pixel's error, which is the largest of its three channels' errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Unit {
    /// In steps of 1/255, after both pictures are clamped, encoded and rounded to bytes.
    #[default]
    Steps,
    /// In linear intensity.
    Linear,
}

/// Pixels that exactly one of the pictures covers. Neither this colour nor the next is near one of the scale's.
pub(super) const COVERAGE: Rgb<u8> = Rgb([0, 220, 90]);
/// Pixels that are not finite.
pub(super) const NOT_FINITE: Rgb<u8> = Rgb([0, 200, 255]);

/// The contents of the legend.
#[derive(Clone, Copy, Debug)]
pub(super) struct LegendContent {
    pub(super) unit: Unit,
    pub(super) upper: f64,
    /// Whether an error is larger than the scale.
    pub(super) beyond: bool,
    pub(super) coverage: bool,
    pub(super) not_finite: bool,
}

/// The colour of a fraction of the scale; clamped beyond its end.
pub(super) fn color(share: f64) -> Rgb<u8> {
    let colorous::Color { r, g, b } = MAGMA.eval_continuous(share);
    Rgb([r, g, b])
}

/// The first of 1, 2 and 5 times a power of ten that is not below a number above 0.
pub(super) fn round_up(number: f64) -> f64 {
    // Rounding may leave a product a hair below the number.
    let reaches = |candidate: &f64| *candidate >= number * (1.0 - 1e-12);
    let power = power_of_ten(number);
    [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power).into_iter().find(reaches).unwrap_or(number)
}

/// The largest power of ten that is not above a number above 0, by its decimal digits.
pub(super) fn power_of_ten(number: f64) -> f64 {
    let text = format!("{number:e}");
    text.split_once('e').and_then(|(_, exponent)| format!("1e{exponent}").parse().ok()).unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::round_up;

    #[test]
    fn scales_end_at_round_numbers() {
        for (number, expected) in
            [(1.0, 1.0), (1.5, 2.0), (2.0, 2.0), (2.1, 5.0), (7.0, 10.0), (255.0, 500.0), (0.003, 0.005), (1e-9, 1e-9)]
        {
            assert!((round_up(number) / expected - 1.0).abs() < 1e-9, "{number}: {}", round_up(number));
        }
    }
}
