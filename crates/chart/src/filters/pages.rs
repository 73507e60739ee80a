//! The page of the filters of images.

use super::{FILTERS, FilterFigures, FilterPlan, FilterView, MeasuredFilters, sweep};
use crate::error::ChartError;
use crate::figure::{Axis, Figure, Marker, Panel, Point, Series, Stroke, Style, colors};
use crate::page::{Page, PageTable, Section, capital};
use crate::pareto::front_panel;
use crate::progress::Progress;
use crate::timing::{Machine, Spread};

/// The cost and the error of texture filters.
#[derive(Clone, Debug)]
pub struct Filters {
    /// The extent of the measurements.
    pub plan: FilterPlan,
    /// The figures of each image.
    pub images: Vec<MeasuredFilters>,
    facts: Vec<(String, String)>,
}

/// A quantity that is charted against time: the end of the figure's name, the axis, and the value.
type Quantity = (&'static str, &'static str, fn(&FilterFigures) -> f64);

const QUANTITIES: [Quantity; 3] = [
    ("rms", "RMS error, steps of 1/255", |figures| figures.rms),
    ("shimmer", "shimmer, steps of 1/255", |figures| figures.shimmer),
    ("flip", "mean ꟻLIP", |figures| figures.flip),
];

const LEAD: &str = "A pixel covers more than one texel where an image is minified, and should show the mean of all of \
                    them. Filters approximate it by a few lookups, with more or less error and flicker under a moving \
                    camera. Down is nearer to the truth, left is faster.";

impl Filters {
    /// Measures; `progress` counts [`FilterPlan::units`].
    ///
    /// # Errors
    /// A picture that cannot be put on the page.
    pub fn measure(plan: FilterPlan, progress: &mut Progress<'_>) -> Result<Self, ChartError> {
        Ok(Self { plan, images: sweep(&plan, progress)?, facts: Machine::processor() })
    }

    /// The page `filters.html`.
    pub fn page(&self) -> Page {
        let FilterPlan { size: [width, height], frames, rounds, tolerance } = self.plan;
        let plan = [
            ("pictures", format!("{width} × {height} pixels")),
            ("frames of the moving camera", frames.to_string()),
            ("rounds", rounds.to_string()),
            ("tolerance of the truth", tolerance.to_string()),
        ];
        let plan = plan.map(|(name, value)| (name.to_owned(), value));
        Page {
            file: "filters.html".to_owned(),
            title: "Texture filters".to_owned(),
            lead: LEAD.to_owned(),
            facts: self.facts.iter().cloned().chain(plan).collect(),
            sections: std::iter::once(self.charts()).chain(self.images.iter().map(section)).collect(),
            ..Page::default()
        }
    }

    fn charts(&self) -> Section {
        Section {
            title: "Error against time".to_owned(),
            text: vec![
                "Truth is the mean of the image’s texels over what a pixel covers, integrated. Errors are in steps of 1/255 of \
                 the sRGB curve, not rounded, over eight views of a plane: from above, at 45°, 70° and 85° from its normal, \
                 each upright and turned by 30°. Shimmer is the RMS of what changes from frame to frame of a moving camera, \
                 less what changes in the truth."
                    .to_owned(),
                "Time is that of a lookup in f32 on the CPU, over the bilinear filter’s in the same round: medians of rounds \
                 in which the filters take turns, with bars from quartile to quartile. The line is the Pareto front; pale \
                 points are dominated."
                    .to_owned(),
            ],
            figures: QUANTITIES.map(|quantity| self.figure(quantity)).into(),
            ..Section::default()
        }
    }

    fn figure(&self, (id, label, error): Quantity) -> Figure {
        let axes = [Axis::log("time of a lookup (bilinear = 1)"), Axis::log(label)];
        let panels = self.images.iter().map(|image| panel(image, error));
        let title = format!("{} against time", capital(label));
        Figure::new(format!("filters-{id}"), title, axes, panels.collect()).named(label)
    }
}

fn section(image: &MeasuredFilters) -> Section {
    let filters = FILTERS.iter().zip(&image.figures);
    let pictures = filters.map(|(method, found)| (method.name.to_owned(), found.picture.clone()));
    Section {
        title: capital(image.image.name()),
        pictures: std::iter::once(("truth".to_owned(), image.truth.clone())).chain(pictures).collect(),
        tables: vec![figures_table(image), views_table(image)],
        ..Section::default()
    }
}

fn figures_table(image: &MeasuredFilters) -> PageTable {
    let header =
        ["filter", "RMS", "mean ꟻLIP", "shimmer", "time, bilinear = 1", "quartiles", "least, ns", "memory, image = 1"];
    let rows = FILTERS.iter().zip(&image.figures).map(|(method, found)| {
        vec![
            method.name.to_owned(),
            format!("{:.2}", found.rms),
            format!("{:.4}", found.flip),
            format!("{:.2}", found.shimmer),
            format!("{:.2}", found.ratio.median),
            format!("{:.2}–{:.2}", found.ratio.lower_quartile, found.ratio.upper_quartile),
            format!("{:.0}", found.ns.min),
            format!("{:.2}", method.memory),
        ]
    });
    PageTable {
        caption: "Error and shimmer in steps of 1/255, time, and the memory that is read".to_owned(),
        names: 1,
        header: header.map(str::to_owned).into(),
        rows: rows.collect(),
    }
}

fn views_table(image: &MeasuredFilters) -> PageTable {
    let header = std::iter::once("filter".to_owned()).chain(FilterView::ALL.map(FilterView::name));
    let rows = FILTERS.iter().zip(&image.figures).map(|(method, found)| {
        let errors = found.rms_by_view.iter().map(|rms| format!("{rms:.2}"));
        std::iter::once(method.name.to_owned()).chain(errors).collect()
    });
    PageTable {
        caption: "RMS error by the angle between view and normal, in steps of 1/255".to_owned(),
        names: 1,
        header: header.collect(),
        rows: rows.collect(),
    }
}

fn panel(image: &MeasuredFilters, error: fn(&FilterFigures) -> f64) -> Panel {
    let series = FILTERS.iter().zip(&image.figures).enumerate().map(|(i, (method, found))| {
        let Spread { median, lower_quartile, upper_quartile, .. } = found.ratio;
        let label = format!("{}: {median:.2} ×, {:.3}", method.name, error(found));
        let quartiles = Some((lower_quartile, upper_quartile));
        let point = Point { quartiles, ..Point::new(median, error(found), label) };
        Series { name: method.name.to_owned(), style: style(i), points: vec![point] }
    });
    front_panel(image.image.name(), series.collect())
}

/// Filled markers for the first seven filters and outlined ones for the others; no two have both colour and marker in
/// common.
fn style(filter: usize) -> Style {
    use colors::{BLUE, GRAY, GREEN, ORANGE, PURPLE, RED, SKY};
    const COLORS: [[u8; 3]; 7] = [GRAY, RED, BLUE, GREEN, PURPLE, ORANGE, SKY];
    const MARKERS: [Marker; 6] =
        [Marker::Diamond, Marker::Square, Marker::Triangle, Marker::Circle, Marker::Wedge, Marker::Star];
    Style {
        color: COLORS[filter % COLORS.len()],
        marker: Some(MARKERS[filter % MARKERS.len()]),
        filled: filter < COLORS.len(),
        stroke: Stroke::Nothing,
    }
}
