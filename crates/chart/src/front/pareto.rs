//! The front: the points that nothing beats.

use std::collections::HashMap;

use super::FrontPoint;

/// The errors whose least time is told, in steps of 1/255.
pub const ERROR_STEPS: [f64; 5] = [8.0, 4.0, 2.0, 1.0, 0.5];
/// The times whose least error is told, as multiples of the reference frame's.
pub const BOUGHT_RATIOS: [f64; 6] = [1.2, 1.5, 2.0, 3.0, 5.0, 10.0];

/// The points of one scene and adapter that no other point is both faster and nearer to the truth than: the Pareto
/// front.
#[derive(Clone, Debug, PartialEq)]
pub struct Front {
    /// Their places in the list that it was made of, the fastest first.
    pub members: Vec<usize>,
    /// The error of every point of that list.
    errors: Vec<f64>,
}

/// What a table says: the best for a limit, or that there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BestWithin {
    /// The greatest error, or the longest time, that was allowed.
    pub limit: f64,
    /// The place of the best point.
    pub best: Option<usize>,
}

impl Front {
    /// Of these points, by the error that `error` tells and the median of the time. Of equal ones the first stays.
    pub fn of(points: &[&FrontPoint], error: impl Fn(&FrontPoint) -> f64) -> Self {
        let errors: Vec<f64> = points.iter().map(|point| error(point)).collect();
        let mut order: Vec<usize> = (0..points.len()).collect();
        let time = |i: usize| points[i].ratio.median;
        order.sort_by(|&a, &b| time(a).total_cmp(&time(b)).then(errors[a].total_cmp(&errors[b])).then(a.cmp(&b)));
        let mut least = f64::INFINITY;
        let members = order.into_iter().filter(|&i| {
            let nearer = errors[i] < least;
            least = least.min(errors[i]);
            nearer
        });
        Self { members: members.collect(), errors }
    }

    /// Whether the point at this place is on it.
    pub fn has(&self, place: usize) -> bool {
        self.members.contains(&place)
    }

    /// For each of [`ERROR_STEPS`] the fastest point that errs no more.
    pub fn least_times(&self) -> [BestWithin; ERROR_STEPS.len()] {
        ERROR_STEPS.map(|limit| {
            let best = self.members.iter().copied().find(|&i| self.errors[i] <= limit);
            BestWithin { limit, best }
        })
    }

    /// For each of [`BOUGHT_RATIOS`] the point of the least error that takes no longer.
    pub fn least_errors(&self, points: &[&FrontPoint]) -> [BestWithin; BOUGHT_RATIOS.len()] {
        BOUGHT_RATIOS.map(|limit| {
            let best = self.members.iter().copied().rev().find(|&i| points[i].ratio.median <= limit);
            BestWithin { limit, best }
        })
    }

    /// The error of the point at this place.
    pub fn error(&self, place: usize) -> f64 {
        self.errors[place]
    }

    /// Who wins where, in a sentence, coarse errors first: neighbours on the front of one family are told together, and
    /// points that err less than a fifth less than the one before are left out. Empty for no points.
    pub fn sentence(&self, points: &[&FrontPoint]) -> String {
        let mut told: Vec<usize> = Vec::new();
        for &i in &self.members {
            if told.last().is_none_or(|&last| self.errors[i] <= 0.8 * self.errors[last]) {
                told.push(i);
            }
        }
        let runs: Vec<&[usize]> = told.chunk_by(|&a, &b| points[a].family == points[b].family).collect();
        let part = |run: &&[usize]| {
            let (first, last) = (run[0], run[run.len() - 1]);
            let time = |i: usize| format!("{:.2}", points[i].ratio.median);
            let error = |i: usize| format!("{:.2}", self.errors[i]);
            let family = &points[first].family;
            if first == last {
                let FrontPoint { detail_words, .. } = points[first];
                return format!(
                    "{family} ({detail_words}) at {} × the reference frame, {} steps off",
                    time(first),
                    error(first)
                );
            }
            format!("{family} from {} to {} ×, {} to {} steps off", time(first), time(last), error(first), error(last))
        };
        let parts: Vec<String> = runs.iter().map(part).collect();
        match &parts[..] {
            [] => String::new(),
            [only] => format!("Nothing beats {only}."),
            [rest @ .., last] => format!("Nothing beats {}; then {last}.", rest.join("; then ")),
        }
    }

    /// What the fronts of two runs disagree on, over the points that both measured: points that are on the front of one
    /// and clearly beaten in the other. A point is clearly beaten where one that errs no more has its upper quartile of
    /// time below that point's lower quartile; else the two are a tie.
    pub fn disagreement<'a>(
        own: &[&'a FrontPoint],
        other: &[&'a FrontPoint],
        error: impl Fn(&FrontPoint) -> f64 + Copy,
    ) -> Vec<&'a FrontPoint> {
        let names = |point: &FrontPoint| (point.method.clone(), point.detail.clone(), point.backend.clone());
        let by_name: HashMap<_, &FrontPoint> = other.iter().map(|point| (names(point), *point)).collect();
        let both = own.iter().filter_map(|point| Some((*point, *by_name.get(&names(point))?)));
        let (own, other): (Vec<&FrontPoint>, Vec<&FrontPoint>) = both.unzip();
        let [front, theirs] = [&own, &other].map(|points| Self::of(points, error));
        let is_beaten = |place: usize, points: &[&FrontPoint]| {
            let point = points[place];
            points.iter().any(|by| error(by) <= error(point) && by.ratio.upper_quartile < point.ratio.lower_quartile)
        };
        let mut found: Vec<&FrontPoint> = Vec::new();
        found.extend(front.members.iter().filter(|&&place| is_beaten(place, &other)).map(|&place| own[place]));
        found.extend(theirs.members.iter().filter(|&&place| is_beaten(place, &own)).map(|&place| other[place]));
        found
    }
}

#[cfg(test)]
mod tests {
    use super::super::{ErrorFigures, PointErrors};
    use super::*;
    use crate::timing::Spread;

    /// A point of this time, ± a tenth, and error.
    fn point(method: &str, time: f64, error: f64) -> FrontPoint {
        let spread =
            Spread { lower_quartile: time * 0.9, median: time, upper_quartile: time * 1.1, ..Spread::default() };
        let mut errors = PointErrors::default();
        errors.covered.steps = ErrorFigures { rms: error, max: 2.0 * error, p95: error };
        FrontPoint {
            method: method.into(),
            family: method.split('-').next().unwrap_or_default().into(),
            detail_words: "8 cells".into(),
            ratio: spread,
            errors,
            ..FrontPoint::default()
        }
    }

    fn rms(point: &FrontPoint) -> f64 {
        point.errors.covered.steps.rms
    }

    #[test]
    fn the_front_is_what_nothing_beats() {
        let all =
            [point("flat", 1.0, 5.0), point("slow", 2.0, 6.0), point("gouraud", 1.5, 2.0), point("phong", 3.0, 0.4)];
        let all: Vec<&FrontPoint> = all.iter().collect();
        let front = Front::of(&all, rms);
        assert_eq!(front.members, [0, 2, 3]);
        assert!(front.has(2) && !front.has(1));
        assert_eq!(front.least_times().map(|choice| choice.best), [Some(0), Some(2), Some(2), Some(3), Some(3)]);
        let found = front.least_errors(&all).map(|choice| choice.best);
        assert_eq!(found, [Some(0), Some(2), Some(2), Some(3), Some(3), Some(3)]);
        assert_eq!(
            front.sentence(&all),
            "Nothing beats flat (8 cells) at 1.00 × the reference frame, 5.00 steps off; then gouraud (8 cells) at \
             1.50 × the reference frame, 2.00 steps off; then phong (8 cells) at 3.00 × the reference frame, 0.40 steps off."
        );
    }

    #[test]
    fn what_is_hardly_better_is_not_told() {
        let all = [
            point("flat", 1.0, 5.0),
            point("gouraud", 1.5, 4.9),
            point("phong-a", 2.0, 2.0),
            point("phong-b", 3.0, 1.0),
        ];
        let all: Vec<&FrontPoint> = all.iter().collect();
        let front = Front::of(&all, rms);
        assert_eq!(front.members.len(), 4);
        assert_eq!(
            front.sentence(&all),
            "Nothing beats flat (8 cells) at 1.00 × the reference frame, 5.00 steps off; then phong from 2.00 to 3.00 ×, \
             2.00 to 1.00 steps off."
        );
    }

    #[test]
    fn of_equal_points_one_stays() {
        let all = [point("a", 1.0, 1.0), point("b", 1.0, 1.0), point("c", 2.0, 1.0), point("d", 1.0, 2.0)];
        assert_eq!(Front::of(&all.iter().collect::<Vec<_>>(), rms).members, [0]);
        let none = Front::of(&[], rms);
        assert_eq!((none.members.len(), none.sentence(&[])), (0, String::new()));
        assert!(none.least_times().iter().all(|choice| choice.best.is_none()));
    }

    #[test]
    fn runs_agree_but_for_ties() {
        let one = [point("a", 1.0, 5.0), point("b", 1.05, 2.0), point("c", 3.0, 0.5)];
        // b is a bit faster now: a is no longer on the front, but its quartiles reach b's.
        let two = [point("a", 1.0, 5.0), point("b", 0.98, 2.0), point("c", 3.1, 0.5)];
        // c took half as long again, and b took as long as c did.
        let off = [point("a", 1.0, 5.0), point("b", 3.5, 2.0), point("c", 1.5, 0.5)];
        let [one, two, off] = [&one, &two, &off].map(|run| run.iter().collect::<Vec<_>>());
        assert!(Front::disagreement(&one, &two, rms).is_empty());
        let names: Vec<&str> = Front::disagreement(&one, &off, rms).iter().map(|point| point.method.as_str()).collect();
        assert_eq!(names, ["b"]);
        // What beats a point by far in one run alone is no tie, however good it is.
        let ahead = [point("a", 1.0, 5.0), point("b", 1.05, 2.0), point("c", 0.5, 0.5)];
        let names = |own: &[&FrontPoint], other: &[&FrontPoint]| {
            Front::disagreement(own, other, rms).iter().map(|point| point.method.clone()).collect::<Vec<_>>()
        };
        let ahead: Vec<&FrontPoint> = ahead.iter().collect();
        assert_eq!(
            (names(&one, &ahead), names(&ahead, &one)),
            (vec!["a".into(), "b".into()], vec!["a".into(), "b".into()])
        );
        // Of what one run did not measure nothing is said.
        assert!(names(&one, &ahead[..2]).is_empty());
    }
}
