//! Straight lines through points.

/// y = `intercept` + `slope`·x, by least squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// dy/dx.
    pub slope: f64,
    /// y at x = 0.
    pub intercept: f64,
}

impl Line {
    /// The line with the least sum of squared vertical distances to the points; `None` for fewer than two different x,
    /// and where a coordinate is not finite.
    pub fn through(points: &[(f64, f64)]) -> Option<Self> {
        let count = points.len() as f64;
        let mean_x = points.iter().map(|(x, _)| x).sum::<f64>() / count;
        let mean_y = points.iter().map(|(_, y)| y).sum::<f64>() / count;
        let xx: f64 = points.iter().map(|(x, _)| (x - mean_x).powi(2)).sum();
        let xy: f64 = points.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
        let slope = xy / xx;
        let line = Self { slope, intercept: mean_y - slope * mean_x };
        (xx > 0.0 && line.slope.is_finite() && line.intercept.is_finite()).then_some(line)
    }

    /// The order of convergence p of error ∝ hᵖ: the slope of log error against log h over the finest `count` points.
    /// `None` where fewer than two of them are positive.
    pub fn order(points: &[(f64, f64)], count: usize) -> Option<f64> {
        let mut finest: Vec<_> = points.to_vec();
        finest.sort_by(|a, b| a.0.total_cmp(&b.0));
        let logarithms: Vec<_> = finest
            .into_iter()
            .take(count)
            .filter(|(h, error)| *h > 0.0 && *error > 0.0)
            .map(|(h, error)| (h.ln(), error.ln()))
            .collect();
        Self::through(&logarithms).map(|line| line.slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_on_a_line_give_the_line() {
        let line = Line::through(&[(0.0, 1.0), (1.0, 3.0), (4.0, 9.0)]).unwrap();
        // A handful of roundings of numbers up to 9.
        assert!((line.slope - 2.0).abs() < 1e-14 && (line.intercept - 1.0).abs() < 1e-14);
    }

    #[test]
    fn points_off_the_line_are_balanced() {
        // By hand: means (1, 2/3); Σ(x − x̄)² = 2, Σ(x − x̄)(y − ȳ) = 1.
        let line = Line::through(&[(0.0, 0.0), (1.0, 1.0), (2.0, 1.0)]).unwrap();
        assert!((line.slope - 0.5).abs() < 1e-15 && (line.intercept - 1.0 / 6.0).abs() < 1e-15);
    }

    #[test]
    fn no_line_through_what_is_not_two_points() {
        for points in [&[][..], &[(1.0, 1.0)], &[(1.0, 1.0), (1.0, 2.0)], &[(0.0, f64::NAN), (1.0, 1.0)]] {
            assert_eq!(Line::through(points), None, "{points:?}");
        }
    }

    #[test]
    fn the_order_is_that_of_the_finest_points() {
        // Second order, but for the coarsest two, in any sequence.
        let points = [(1.0, 5.0), (0.25, 0.0625), (0.5, 7.0), (0.125, 0.015_625), (0.0625, 0.003_906_25)];
        let order = Line::order(&points, 3).unwrap();
        assert!((order - 2.0).abs() < 1e-12, "{order}");
        assert_eq!(Line::order(&[(1.0, 0.0), (2.0, 1.0)], 2), None);
    }
}
