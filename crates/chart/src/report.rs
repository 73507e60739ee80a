//! All measurements that `halfway chart` makes of the project's own scenes.

use crate::error::ChartError;
use crate::failures::{self, FailurePage};
use crate::front::{ChartedAdapter, ChartedScene, FrontPlan, Fronts, MeasuredOver};
use crate::page::Page;
use crate::progress::Progress;

/// The results.
#[derive(Clone, Debug)]
pub struct Report {
    /// Error and time.
    pub fronts: Fronts,
    /// Error and time of distant lights and viewers.
    pub over: Vec<MeasuredOver>,
    /// The known failure modes.
    pub failures: Vec<FailurePage>,
}

impl Report {
    /// The units of [`Progress`] that [`measure`](Self::measure) reports.
    pub fn units(plan: &FrontPlan, scenes: &[ChartedScene], adapters: usize) -> u64 {
        plan.units(scenes, adapters) + MeasuredOver::units(plan, adapters) + failures::PAGES
    }

    /// Measures everything.
    ///
    /// # Errors
    /// The first picture that could not be drawn.
    pub fn measure(
        plan: &FrontPlan,
        scenes: &[ChartedScene],
        adapters: &[ChartedAdapter],
        progress: &mut Progress<'_>,
    ) -> Result<Self, ChartError> {
        let fronts = Fronts::measure(plan, scenes, adapters, progress)?;
        let over = MeasuredOver::all(plan, adapters, progress)?;
        let failures = failures::all(adapters, |page| progress.advance(1, page.title))?;
        Ok(Self { fronts, over, failures })
    }

    /// The page `index.html`, and a page for each failure.
    ///
    /// # Errors
    /// A picture that could not be put on a page.
    pub fn pages(&self) -> Result<Vec<Page>, ChartError> {
        let mut index = self.fronts.page();
        index.sections.push(MeasuredOver::section(&self.over));
        let failures = self.failures.iter().map(FailurePage::page).collect::<Result<Vec<_>, _>>()?;
        index.sections.push(failures::section(&failures));
        Ok(std::iter::once(index).chain(failures).collect())
    }
}
