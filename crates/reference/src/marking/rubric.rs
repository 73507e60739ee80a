//! Points for a picture.

use serde_json::{Map, Value};
use thiserror::Error;

use super::diagnosis::Diagnosis;
use crate::mistakes::Mistake;

/// How many points a picture gets.
///
/// A picture that passes gets all of them. Where mistakes explain the difference, each of them takes its points away;
/// where several mistakes would draw the same picture, the cheapest counts. A picture that no mistake explains gets a part
/// of [`unexplained`](Self::unexplained): the share of its pixels that are right. No picture gets less than 0.
///
/// ```
/// use halfway_reference::marking::Rubric;
/// use halfway_reference::mistakes::Mistake;
///
/// let rubric = Rubric::default().with_mistake("gamma-missing", 5.0)?;
/// assert_eq!((rubric.lost(Mistake::GammaMissing), rubric.lost(Mistake::Mirrored)), (5.0, 20.0));
/// # Ok::<(), halfway_reference::marking::RubricError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Rubric {
    points: f64,
    mistake: f64,
    unexplained: f64,
    own: Vec<(Mistake, f64)>,
}

/// An entry of a rubric that cannot be used.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RubricError {
    /// A number of points is negative or not finite.
    #[error("{field}: {found}; expected a finite number of points, 0 or more")]
    NotPoints {
        /// The field.
        field: String,
        /// Its value.
        found: f64,
    },
    /// JSON that is no rubric: where, and what was expected.
    #[error("{0}")]
    Json(String),
    /// No listed mistake has this name.
    #[error("mistakes: {name:?} is not the name of a mistake; expected one of {}", names())]
    Unknown {
        /// The name.
        name: String,
    },
}

/// The keys of a rubric in JSON.
const KEYS: [&str; 4] = ["points", "mistake", "unexplained", "mistakes"];

fn names() -> String {
    Mistake::ALL.iter().map(|mistake| mistake.name()).collect::<Vec<_>>().join(", ")
}

impl Rubric {
    /// Points for a picture that passes, points lost by a mistake without an entry of its own, and the most points for a
    /// picture that none explains.
    ///
    /// # Errors
    /// A number is negative or not finite.
    pub fn new(points: f64, mistake: f64, unexplained: f64) -> Result<Self, RubricError> {
        for (field, found) in [("points", points), ("mistake", mistake), ("unexplained", unexplained)] {
            is_points(field, found)?;
        }
        Ok(Self { points, mistake, unexplained, own: Vec::new() })
    }

    /// Reads an object of JSON: `{"points": 10, "mistake": 2, "unexplained": 5, "mistakes": {"gamma-missing": 1}}`. Keys
    /// that are left out have the values of the default.
    ///
    /// # Errors
    /// It is no such object, or [`new`](Self::new) and [`with_mistake`](Self::with_mistake) refuse it.
    pub fn from_json(text: &str) -> Result<Self, RubricError> {
        let json: Value = serde_json::from_str(text)
            .map_err(|error| RubricError::Json(format!("{error}; expected a rubric in JSON")))?;
        let Value::Object(entries) = &json else {
            return Err(RubricError::Json(format!("{json}; expected an object of JSON")));
        };
        if let Some(unknown) = entries.keys().find(|key| !KEYS.contains(&key.as_str())) {
            return Err(RubricError::Json(format!("unknown key {unknown:?}; expected {}", KEYS.join(", "))));
        }
        let points = |key: &str, value: &Value| {
            value.as_f64().ok_or_else(|| RubricError::Json(format!("{key}: {value}; expected a number of points")))
        };
        let number = |key: &str, otherwise: f64| entries.get(key).map_or(Ok(otherwise), |value| points(key, value));
        let default = Self::default();
        let rubric = Self::new(
            number("points", default.points)?,
            number("mistake", default.mistake)?,
            number("unexplained", default.unexplained)?,
        )?;
        let own = match entries.get("mistakes") {
            None => &Map::new(),
            Some(Value::Object(own)) => own,
            Some(other) => {
                let message = format!("mistakes: {other}; expected an object of names and points");
                return Err(RubricError::Json(message));
            }
        };
        own.iter().try_fold(rubric, |rubric, (name, lost)| {
            rubric.with_mistake(name, points(&format!("mistakes.{name}"), lost)?)
        })
    }

    /// The same where the mistake of this name takes `lost` points away.
    ///
    /// # Errors
    /// There is no such mistake, or the number is negative or not finite.
    pub fn with_mistake(mut self, name: &str, lost: f64) -> Result<Self, RubricError> {
        let mistake = Mistake::from_name(name).ok_or_else(|| RubricError::Unknown { name: name.into() })?;
        is_points(name, lost)?;
        self.own.retain(|(known, _)| *known != mistake);
        self.own.push((mistake, lost));
        Ok(self)
    }

    /// The points of a picture that passes.
    pub fn points(&self) -> f64 {
        self.points
    }

    /// The points that a mistake without an entry of its own takes away.
    pub fn mistake(&self) -> f64 {
        self.mistake
    }

    /// The most points of a picture that no mistake explains.
    pub fn unexplained(&self) -> f64 {
        self.unexplained
    }

    /// The points that a mistake takes away.
    pub fn lost(&self, mistake: Mistake) -> f64 {
        self.own.iter().find(|(known, _)| *known == mistake).map_or(self.mistake, |(_, lost)| *lost)
    }

    /// The points of a picture that does not pass.
    pub fn mark(&self, diagnosis: &Diagnosis) -> f64 {
        let mark = match diagnosis.explanations.first() {
            Some(explanation) => {
                let cheapest = |all: &[Mistake]| all.iter().map(|it| self.lost(*it)).fold(f64::INFINITY, f64::min);
                self.points - explanation.causes.iter().map(|cause| cheapest(&cause.alternatives)).sum::<f64>()
            }
            None => self.unexplained.min(self.points) * diagnosis.right,
        };
        mark.max(0.0)
    }
}

impl Default for Rubric {
    /// 100 points, 20 lost by each mistake, at most 50 without an explanation.
    fn default() -> Self {
        Self { points: 100.0, mistake: 20.0, unexplained: 50.0, own: Vec::new() }
    }
}

fn is_points(field: &str, found: f64) -> Result<(), RubricError> {
    if found.is_finite() && found >= 0.0 { Ok(()) } else { Err(RubricError::NotPoints { field: field.into(), found }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_is_as_by_default() {
        assert_eq!(Rubric::from_json("{}").expect("an empty rubric"), Rubric::default());
        let rubric =
            Rubric::from_json(r#"{"points": 10, "mistake": 2.5, "mistakes": {"mirrored": 0, "gamma-twice": 1}}"#);
        let rubric = rubric.expect("a rubric");
        let lost = [Mistake::Mirrored, Mistake::GammaTwice, Mistake::GammaMissing].map(|it| rubric.lost(it));
        assert_eq!((rubric.points(), rubric.unexplained(), lost), (10.0, 50.0, [0.0, 1.0, 2.5]));
    }

    #[test]
    fn errors_name_the_key_and_what_is_expected() {
        for (text, expected) in [
            ("{", "expected a rubric in JSON"),
            ("[]", "[]; expected an object of JSON"),
            (r#"{"point": 1}"#, "unknown key \"point\"; expected points, mistake, unexplained, mistakes"),
            (r#"{"points": "many"}"#, "points: \"many\"; expected a number of points"),
            (r#"{"points": -1}"#, "points: -1; expected a finite number of points, 0 or more"),
            (r#"{"mistakes": 3}"#, "mistakes: 3; expected an object of names and points"),
            (r#"{"mistakes": {"mirrored": null}}"#, "mistakes.mirrored: null; expected a number of points"),
            (r#"{"mistakes": {"mirrored": -2}}"#, "mirrored: -2; expected a finite number of points, 0 or more"),
            (r#"{"mistakes": {"typo": 1}}"#, "\"typo\" is not the name of a mistake; expected one of normals-not-"),
        ] {
            let error = Rubric::from_json(text).expect_err(text).to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
