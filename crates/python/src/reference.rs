//! The reference renderer, and its judgement of pictures.

use std::ops::ControlFlow;

use halfway::prelude::*;
use halfway::record::{FrameToDraw, ReferenceDrawing};
use halfway::reference::Oracle;
use halfway::reference::marking::{Report, Rubric, examine};
use halfway::reference::metrics::{Bars, judge};

use crate::drawing::Recipe;
use crate::pictures::intensities;
use crate::work::Failure;

/// The picture that the reference renderer draws of an App, and its quantities.
pub(crate) fn reference_picture(
    app: &mut App,
    size: UVec2,
    pixels: Pixels,
    quantities: &[Quantity],
) -> Result<(Picture, Vec<QuantityImage>), Failure> {
    let drawing = ReferenceDrawing::default();
    let frame = FrameToDraw { number: 0, size, pixels };
    let picture = drawing.picture(app, frame, &|_, _| ControlFlow::Continue(())).map_err(Failure::work)?;
    let images = if quantities.is_empty() {
        Vec::new()
    } else {
        drawing.take_quantities(app.world_mut(), size, quantities).map_err(Failure::work)?
    };
    Ok((picture, images))
}

/// A pixel of the picture of an App, explained: as JSON, as text and as LaTeX.
pub(crate) fn explained(app: &mut App, size: UVec2, [x, y]: [u32; 2]) -> Result<(String, String, String), Failure> {
    app.update();
    let oracle = Oracle::new(app.world_mut(), size).map_err(Failure::work)?;
    let oracle = oracle.with_clamping(true).with_samples_of_camera();
    let explained = oracle.explain(x, y).map_err(|error| Failure::Input(format!("at: {error}")))?;
    Ok((explained.to_json().to_string(), explained.to_string(), explained.to_latex()))
}

/// The judgement of a picture.
pub(crate) struct Judged {
    pub(crate) is_within: bool,
    pub(crate) worst: f64,
    pub(crate) at: Option<(u32, u32)>,
    pub(crate) equal: f64,
    pub(crate) edges: f64,
    pub(crate) bad: usize,
    pub(crate) sentence: String,
}

/// The bars for a picture, of which no pixel may differ by more than `most` steps of 1/255 from every colour that it may
/// show.
fn bars(picture: &Picture, most: f64, encoding: Encoding) -> Bars {
    match picture {
        Picture::Byte(_) => Bars { most, worst: most, equal: 0.0, ..Bars::bytes(encoding) },
        Picture::Float(_) => Bars::FLOAT,
    }
}

/// Judges a picture of the scene.
pub(crate) fn judge_given(recipe: &Recipe, picture: &Picture, most: f64) -> Result<Judged, Failure> {
    let (mut app, _) = recipe.play()?;
    app.update();
    let encoding = recipe.scene.output;
    let bars = bars(picture, most, encoding);
    let size = UVec2::from_array(recipe.scene.size);
    let oracle = Oracle::new(app.world_mut(), size).map_err(Failure::work)?.with_clamping(bars.are_clamped());
    let found = judge(&oracle, &oracle.draw(), &intensities(picture, encoding), bars).map_err(Failure::input)?;
    Ok(Judged {
        is_within: found.is_within(),
        worst: found.worst,
        at: found.at.map(|worst| worst.at),
        equal: found.equal,
        edges: found.edges,
        bad: found.bad,
        sentence: found.to_string(),
    })
}

/// Marks a picture of the scene: as JSON, and in sentences.
pub(crate) fn mark_given(
    recipe: &Recipe,
    picture: &Picture,
    most: f64,
    rubric: &Rubric,
) -> Result<(String, String), Failure> {
    let (mut app, _) = recipe.play()?;
    app.update();
    let encoding = recipe.scene.output;
    let (bars, actual) = (bars(picture, most, encoding), intensities(picture, encoding));
    let goes_on = |_, _| ControlFlow::Continue(());
    let examined = examine(app.world_mut(), &actual, encoding, bars, &goes_on).map_err(Failure::input)?;
    let report = Report::new("the picture".into(), recipe.scene.size, examined, rubric);
    Ok((report.to_json().to_string(), report.to_string()))
}
