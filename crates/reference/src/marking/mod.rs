//! Marks pictures that others have drawn of a scene, and finds the mistake that explains the difference.
//!
//! [`examine`] judges a picture, and diagnoses one that does not pass. A [`Marker`] has the oracle draw the scene with
//! each mistake of a [list](crate::mistakes::Mistake), and with pairs where no single one will do, and ranks them by how
//! much of the difference they explain. A [`Rubric`] turns that into points, and a [`Report`] says it.

mod diagnosis;
mod examined;
mod mistaken;
mod pictures;
mod report;
mod rubric;
mod score;
mod steps;

pub use diagnosis::{Area, Cause, Diagnosis, Finding, Marker};
pub use examined::{ExamineError, Examined, examine};
pub use mistaken::mistaken_picture;
pub use report::Report;
pub use rubric::{Rubric, RubricError};
