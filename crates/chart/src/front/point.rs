//! One measured point.

use serde::Serialize;

use super::{AreaErrors, PointErrors};
use crate::timing::Spread;

/// What one method took for one scene at one detail on one adapter, and how far off it was.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FrontPoint {
    /// The scene's name.
    pub scene: String,
    /// The method, as the command line takes it ([`Method::id`](super::Method::id)).
    pub method: String,
    /// The method in words.
    pub words: String,
    /// The name of its [`Family`](super::Family).
    pub family: String,
    /// The scene's detail, as the command line takes it ([`SceneDetail::id`](super::SceneDetail::id)).
    pub detail: String,
    /// The detail in words.
    pub detail_words: String,
    /// The triangles that a frame draws.
    pub triangles: u64,
    /// The adapter, by the name that it was opened by.
    pub adapter: String,
    /// Times of a frame in milliseconds.
    pub ms: Spread,
    /// The same as multiples of the reference frame's in the same round: the scene's coarsest detail, in a constant
    /// colour, on the same adapter.
    pub ratio: Spread,
    /// How far its pictures are from the truth.
    #[serde(flatten)]
    pub errors: PointErrors,
    /// Whether it is on the front of its scene and adapter, by RMS error of covered pixels.
    pub front: bool,
    /// The same by RMS error of the whole picture.
    pub front_whole: bool,
    /// What measures it again.
    pub command: String,
    /// What was drawn, small, as a `data:` address.
    #[serde(skip)]
    pub picture: String,
    /// Where that differs from the truth.
    #[serde(skip)]
    pub difference: String,
    /// Its place among all points of a run.
    #[serde(skip)]
    pub place: usize,
}

impl FrontPoint {
    /// What it is, in a line.
    pub fn describe(&self) -> String {
        format!("{}, {}, {} triangles", self.words, self.detail_words, self.triangles)
    }

    /// Time and error, of which fronts are made: the median of the ratio, and the RMS error in steps of 1/255 of the
    /// picture that is timed.
    pub fn time_and_error(&self, area: fn(&PointErrors) -> &AreaErrors) -> (f64, f64) {
        (self.ratio.median, area(&self.errors).steps.rms)
    }
}
