//! How steep a curve is where, on logarithmic axes: a slope of 1 is in proportion, one of 0 does not depend on the
//! count.

use crate::measure::Line;

/// How far a count may lie outside a decade and still be taken as its end: a mesh has not exactly 10ᵏ triangles.
const SLACK: f64 = 1.05;
/// How far apart the ends of a decade's points must lie for a slope: by this factor.
const LEAST: f64 = 2.0;
/// How far the slope of a decade may be from the last one's until the law is said to break.
pub(super) const DEPARTURE: f64 = 0.25;

/// The slope in a decade.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decade {
    /// It goes from 10^`exponent` to 10^(`exponent` + 1).
    pub exponent: i32,
    /// d log y / d log x by least squares.
    pub slope: f64,
}

/// How a curve grows in the end: as x to the power of `slope`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// The slope of the last decade.
    pub slope: f64,
    /// The first decade that it holds for; all later ones follow it too.
    pub holds_from: i32,
    /// The decade before, whose slope is farther from it than 0.25.
    pub breaks: Option<Decade>,
}

/// The slope in each decade in which there are points enough, the decades in order. Points have positive coordinates.
pub(super) fn decades(points: &[(f64, f64)]) -> Vec<Decade> {
    let positive = |(x, y): &(f64, f64)| *x > 0.0 && *y > 0.0;
    let points: Vec<_> = points.iter().copied().filter(positive).collect();
    let exponents = points.iter().map(|(x, _)| x.log10().floor() as i32);
    let (Some(first), Some(last)) = (exponents.clone().min(), exponents.max()) else { return Vec::new() };
    // A little less than 10ᵏ counts as 10ᵏ; the decade before then ends there.
    (first..=last + 1).filter_map(|exponent| decade(&points, exponent)).collect()
}

fn decade(points: &[(f64, f64)], exponent: i32) -> Option<Decade> {
    let (from, to) = (10f64.powi(exponent) / SLACK, 10f64.powi(exponent + 1) * SLACK);
    let inside: Vec<_> =
        points.iter().filter(|(x, _)| (from..=to).contains(x)).map(|(x, y)| (x.log10(), y.log10())).collect();
    let (low, high) =
        inside.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (x, _)| (low.min(*x), high.max(*x)));
    let slope = Line::through(&inside).filter(|_| high - low >= LEAST.log10())?.slope;
    Some(Decade { exponent, slope })
}

/// What the decades, in order, have in common with the last of them. `None` for none.
pub(super) fn law(decades: &[Decade]) -> Option<Law> {
    let (last, earlier) = decades.split_last()?;
    let breaks = earlier.iter().rev().find(|decade| (decade.slope - last.slope).abs() > DEPARTURE).copied();
    let after = |decade: &&Decade| breaks.is_none_or(|breaks| decade.exponent > breaks.exponent);
    let holds_from = decades.iter().find(after).unwrap_or(last).exponent;
    Some(Law { slope: last.slope, holds_from, breaks })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y = 1 + x/1000 at half decades: constant below 10³, in proportion above.
    fn overhead() -> Vec<(f64, f64)> {
        (0..=12).map(|half| 10f64.powf(f64::from(half) / 2.0)).map(|x| (x, 1.0 + x / 1000.0)).collect()
    }

    #[test]
    fn slopes_of_a_fixed_cost_and_a_proportional_one() {
        let decades = decades(&overhead());
        let exponents: Vec<_> = decades.iter().map(|decade| decade.exponent).collect();
        assert_eq!(exponents, [0, 1, 2, 3, 4, 5]);
        // x·y'/y = x/(1000 + x) is 0.5 at 10³; it lies within 0.01 of 0 and 1 from 10 times 10 away.
        assert!(decades[0].slope.abs() < 0.01 && (decades[5].slope - 1.0).abs() < 0.01, "{decades:?}");
        let law = law(&decades).unwrap();
        assert!((law.slope - 1.0).abs() < 0.01);
        // From 10³ to 10⁴ the time grows from 2 to 11: log 5.5 = 0.74, and the fit in between a little less.
        assert_eq!((law.holds_from, law.breaks.unwrap().exponent), (4, 3));
    }

    #[test]
    fn a_law_may_hold_throughout_or_not_be_known() {
        let square: Vec<_> = [960.0, 9_800.0, 100_488.0].map(|x: f64| (x, x * x)).into();
        let decades = decades(&square);
        assert_eq!(decades.iter().map(|decade| decade.exponent).collect::<Vec<_>>(), [3, 4]);
        let found = law(&decades).unwrap();
        assert!((found.slope - 2.0).abs() < 1e-9 && found.breaks.is_none() && found.holds_from == 3);
        for points in [&[][..], &[(10.0, 1.0)], &[(10.0, 1.0), (15.0, 2.0)], &[(0.0, 1.0), (100.0, 0.0)]] {
            assert_eq!(law(&super::decades(points)), None, "{points:?}");
        }
    }
}
