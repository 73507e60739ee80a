//! Everything that is measured, and the files that tell it.

mod charts;
mod earlier;
mod failing;
mod filters;
mod fronts;
mod highlights;
mod over;
mod pages;
mod plan;
mod scaling;
mod tables;

use halfway::output::OutputError;
use thiserror::Error;

use crate::failures::{self, FailurePage};
use crate::figure::Figure;
use crate::figure::svg::{self, Size, SvgError};
use crate::front::{ChartedAdapter, ChartedScene, KeptResults, MeasuredOver};
use crate::measure::convergence::{self, Convergence};
use crate::measure::highlight::{self, Energies};
use crate::measure::{MeasureError, MeasureProgress};
use crate::page::html;

pub use earlier::EarlierRun;
pub use filters::Filters;
pub use fronts::Fronts;
pub use plan::ReportPlan;
pub use scaling::Scaling;

/// A report that could not be made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReportError {
    /// Something could not be measured.
    #[error(transparent)]
    Measure(#[from] MeasureError),
    /// A chart could not be drawn.
    #[error(transparent)]
    Svg(#[from] SvgError),
    /// A file could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Report {
    /// How much was measured.
    pub plan: ReportPlan,
    /// Error and time.
    pub fronts: Fronts,
    /// Rates of convergence.
    pub convergence: Vec<Convergence>,
    /// The moving highlight.
    pub energies: Energies,
    /// Error and time over shininess, lights and distance.
    pub over: Vec<MeasuredOver>,
    /// Where methods fail.
    pub failures: Vec<FailurePage>,
    /// How the time of a frame grows; also tells what drew.
    pub scaling: Scaling,
}

/// A file's name and what is in it.
pub type NamedFile = (String, String);

/// Measures everything; `tell` hears of [`ReportPlan::units`] done so far, and of what is being done. What `kept` has
/// is not measured again.
///
/// # Errors
/// The first picture that could not be drawn.
pub fn measure(
    plan: &ReportPlan,
    scenes: &[ChartedScene],
    adapters: &[ChartedAdapter],
    kept: &mut KeptResults,
    tell: &mut dyn FnMut(u64, &str),
) -> Result<Report, ReportError> {
    let mut progress = MeasureProgress::new(tell);
    let fronts = Fronts::measure(&plan.fronts, scenes, adapters, kept, &mut progress)?;
    let convergence = convergence::sweep(plan.convergence, &mut progress)?;
    let energies = highlight::sweep(plan.highlight, &mut progress)?;
    let over = MeasuredOver::all(&plan.fronts, adapters, kept, &mut progress)?;
    let failures = failures::all(adapters, |page| progress.advance(1, page.title))?;
    let scaling = Scaling::measure(plan.scaling, &mut progress)?;
    Ok(Report { plan: plan.clone(), fronts, over, convergence, energies, failures, scaling })
}

/// A figure as SVG, named by its identifier.
fn figure_file(figure: &Figure) -> Result<NamedFile, ReportError> {
    let size = if figure.columns > 2 { Size { width: 1240, row: 300 } } else { Size { width: 900, row: 330 } };
    Ok((format!("{}.svg", figure.id), svg::figure(figure, size)?))
}

impl Report {
    /// The page `index.html`, and beside it every table as CSV and every chart as SVG.
    ///
    /// # Errors
    /// What could not be drawn or encoded.
    pub fn files(&self) -> Result<Vec<NamedFile>, ReportError> {
        let page = self.page();
        let mut files = vec![("index.html".to_owned(), html(&page)?)];
        files.extend(self.tables());
        files.push(("over.csv".to_owned(), over::csv(&self.over)));
        for (_, figure) in page.sections.iter().flat_map(|section| &section.figures) {
            files.push(figure_file(figure)?);
        }
        files.extend(failing::files(&self.failures)?);
        Ok(files)
    }
}
