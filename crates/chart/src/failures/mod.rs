//! Where methods fail: a page for each way, with pictures, a plot, the cause, the remedy, and the test that keeps it.
//!
//! What methods lose is drawn by the oracle, and not by what implements them. What rounding loses is drawn by the
//! adapters that are charted and by the CPU without a driver, and compared with the oracle; what policies of intensity
//! cost is timed.

pub mod blend_order;
mod creases;
pub mod depth;
mod diagonals;
pub mod distances;
pub mod edge_on;
pub mod exponents;
mod highlight;
mod interpolation;
pub mod layers;
mod mach;
pub mod near_light;
pub mod noise;
pub mod outlines;
mod plots;
pub mod provoking;
pub mod rims;
mod saturation;
pub mod slivers;
mod stage;
mod terminator;
pub mod transforms;

use image::RgbImage;

use crate::figure::Figure;
use crate::front::ChartedAdapter;
use crate::measure::MeasureError;

pub use stage::drawers;

/// One way in which a method fails.
#[derive(Clone, Debug)]
pub struct FailurePage {
    /// Names its file: lower case, no spaces.
    pub id: &'static str,
    /// What is seen.
    pub title: &'static str,
    /// Why, in a line.
    pub cause: &'static str,
    /// What helps, in a line.
    pub remedy: &'static str,
    /// The test that keeps what the page says.
    pub test: &'static str,
    /// How much, over what it depends on; of several one is shown at a time, by the name before it.
    pub figures: Vec<(&'static str, Figure)>,
    /// Captions and pictures.
    pub pictures: Vec<(&'static str, RgbImage)>,
}

type DrawnPage = fn() -> Result<FailurePage, MeasureError>;
type JudgedPage = fn(&[ChartedAdapter]) -> Result<FailurePage, MeasureError>;

/// Those that the oracle draws.
const DRAWN: [DrawnPage; 15] = [
    highlight::page,
    mach::page,
    terminator::page,
    outlines::page,
    provoking::page,
    diagonals::page,
    slivers::page,
    creases::page,
    noise::page,
    transforms::page,
    near_light::page,
    rims::page,
    interpolation::page,
    blend_order::page,
    saturation::page,
];
/// Those that adapters draw.
const JUDGED: [JudgedPage; 5] = [exponents::page, distances::page, edge_on::page, depth::page, layers::page];

/// How many pages there are, for whoever is told of progress.
pub const PAGES: u64 = (DRAWN.len() + JUDGED.len()) as u64;

/// Every page, with what these adapters and the CPU without a driver lose; `done` is told after each.
///
/// # Errors
/// The first picture that could not be drawn.
pub fn all(charted: &[ChartedAdapter], done: impl FnMut(&FailurePage)) -> Result<Vec<FailurePage>, MeasureError> {
    let drawers = drawers(charted)?;
    let mut done = done;
    let drawn = DRAWN.into_iter().map(|page| page());
    let judged = JUDGED.into_iter().map(|page| page(&drawers));
    drawn.chain(judged).map(|page| page.inspect(&mut done)).collect()
}

/// The one figure of a page, which needs no name.
fn only(figure: Figure) -> Vec<(&'static str, Figure)> {
    vec![("", figure)]
}
