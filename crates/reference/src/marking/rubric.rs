//! Points for a picture.

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
    /// No listed mistake has this name.
    #[error("mistakes: {name:?} is not the name of a mistake; expected one of {}", names())]
    Unknown {
        /// The name.
        name: String,
    },
}

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
