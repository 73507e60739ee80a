//! One measured point.

use serde::{Deserialize, Serialize};

use super::PointErrors;
use crate::timing::Spread;

/// What one method took for one scene at one detail on one adapter, and how far off it was.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrontPoint {
    /// The scene's name.
    pub scene: String,
    /// The method, as the command line takes it ([`Method::id`](super::Method::id)).
    pub method: String,
    /// The method in words.
    pub words: String,
    /// The name of its [`Family`](super::Family).
    pub family: String,
    /// The error that it was told to keep to, in steps of 255.
    pub tolerance: Option<f64>,
    /// The scene's detail, as the command line takes it ([`SceneDetail::id`](super::SceneDetail::id)).
    pub detail: String,
    /// The detail in words.
    pub detail_words: String,
    /// The triangles that a frame draws.
    pub triangles: u64,
    /// The adapter, by the name that it was opened by.
    pub backend: String,
    /// Times of a frame in milliseconds.
    pub ms: Spread,
    /// The same as multiples of the reference frame's in the same round: the scene's coarsest detail, in a constant
    /// colour, on the same adapter.
    pub ratio: Spread,
    /// How far its pictures are from the truth.
    pub errors: PointErrors,
    /// What was drawn, small, as a `data:` address.
    pub picture: String,
    /// Where that differs from the truth.
    pub difference: String,
    /// What measures it again.
    pub command: String,
}

impl FrontPoint {
    /// What it is, in a line.
    pub fn describe(&self) -> String {
        format!("{}, {}, {} triangles", self.words, self.detail_words, self.triangles)
    }
}
