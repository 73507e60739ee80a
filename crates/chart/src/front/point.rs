//! One measured point.

use serde::Serialize;

use super::{AreaErrors, PointErrors};
use crate::timing::Spread;

/// The time and the error of one method for one scene at one detail on one adapter.
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
    /// The ratio to the reference frame of the same round: the scene's coarsest detail, in a constant colour, on the
    /// same adapter.
    pub ratio: Spread,
    /// The errors of its pictures.
    #[serde(flatten)]
    pub errors: PointErrors,
    /// Whether it is on the front of its scene and adapter, by RMS error of covered pixels.
    pub front: bool,
    /// Whether it is on the front by RMS error of the whole picture.
    pub front_whole: bool,
    /// The command that measures it again.
    pub command: String,
    /// The picture, small, as a `data:` address.
    #[serde(skip)]
    pub picture: String,
    /// Its difference from the truth.
    #[serde(skip)]
    pub difference: String,
    /// Its index among all points of a run.
    #[serde(skip)]
    pub place: usize,
}

impl FrontPoint {
    /// A description in a line.
    pub fn describe(&self) -> String {
        format!("{}, {}, {} triangles", self.words, self.detail_words, self.triangles)
    }

    /// Time and error, the axes of fronts: the median of the ratio, and the RMS error in steps of 1/255 of the picture
    /// that is timed.
    pub fn time_and_error(&self, area: fn(&PointErrors) -> &AreaErrors) -> (f64, f64) {
        (self.ratio.median, area(&self.errors).steps.rms)
    }
}
