//! What the page says.

use super::charts::{self, order};
use super::tables::files;
use super::{Report, ReportError};
use crate::measure::accuracy::{Measured, describe};
use crate::measure::convergence::{FITTED, QUANTITIES};
use crate::measure::highlight::Unsteadiness;
use crate::measure::{SHADINGS, shading_name};
use crate::page::{Card, Page, PageTable, Section, data_uri};

impl Report {
    /// The page.
    ///
    /// # Errors
    /// A picture that could not be encoded.
    pub(super) fn page(&self) -> Result<Page, ReportError> {
        Ok(Page {
            title: "What shading costs, and what it loses".to_owned(),
            lead: "Flat shading evaluates the lighting once a triangle, Gouraud shading once a vertex, Phong shading once \
                   a pixel. Each chart compares the three with the true surface: the sphere, and the teapot’s Bézier \
                   patches, with their exact normal at every pixel. Down is more accurate; in the first chart, left is \
                   faster. Point at a point to see its picture and its figures, click to keep them."
                .to_owned(),
            facts: self.facts(),
            sections: vec![
                self.main_section(),
                self.convergence_section(),
                self.highlight_section(),
                self.scaling.section(),
            ],
            cards: self.accuracy.iter().map(card).collect::<Result<_, _>>()?,
        })
    }

    fn facts(&self) -> Vec<(String, String)> {
        let plan = self.plan;
        let fact = |name: &str, value: String| (name.to_owned(), value);
        let mut facts = self.scaling.machine.facts();
        facts.extend([
            fact("timed pictures", format!("{0} × {0} pixels", plan.accuracy.size)),
            fact("rounds", plan.accuracy.rounds.to_string()),
            fact("convergence", format!("{0} × {0} pixels", plan.convergence.size)),
            fact("highlight", format!("{} frames of {1} × {1} pixels", plan.highlight.frames, plan.highlight.size)),
        ]);
        facts
    }

    fn main_section(&self) -> Section {
        let figures = charts::QUANTITIES.map(|quantity| (quantity.name.to_owned(), self.main_figure(quantity)));
        Section {
            title: "Error against time".to_owned(),
            text: vec![
                "Each line joins the tessellations of one shading, from coarse to fine. The error is that of the \
                 adapter’s picture against the true surface’s, on the pixels that both cover; pixels at the outline that \
                 only one of them covers are counted apart, and are in the point’s figures. The time is that of a \
                 frame, as a multiple of a frame of the same mesh in one constant colour, measured in turns with it; the \
                 median of all rounds. Such ratios carry over to other machines far better than milliseconds, which the figures of each \
                 point and the CSV file also give."
                    .to_owned(),
            ],
            files: files(&figures.iter().map(|(name, figure)| (name.as_str(), figure.id)).collect::<Vec<_>>(), &[(
                "all figures",
                "error",
            )]),
            figures: figures.into(),
            tables: Vec::new(),
        }
    }

    fn convergence_section(&self) -> Section {
        let figure = self.convergence_figure();
        Section {
            title: "Rates of convergence".to_owned(),
            text: vec![
                "Both pictures are the reference renderer’s, in double precision, so that what is seen is what the method \
                 loses and not how it was implemented."
                    .to_owned(),
                format!(
                    "A slope of p means that the error goes with the p-th power of the edge length: with slope 1 it \
                     halves when edges are halved, with slope 2 it falls to a quarter. Slopes are least-squares fits to \
                     the {FITTED} finest meshes. Over most of a surface flat shading is of the first order, Gouraud and \
                     Phong of the second. The largest error is another matter: it sits at outlines. There the true \
                     surface turns away from the viewer within a few pixels, and a mesh does so a little earlier; and \
                     where one part of the teapot hides another, there are always pixels that show the one in one picture \
                     and the other in the other, however fine the mesh."
                ),
            ],
            files: files(&[("chart", figure.id)], &[("errors", "convergence"), ("slopes", "slopes")]),
            figures: vec![(String::new(), figure)],
            tables: vec![self.slopes()],
        }
    }

    /// A row for each object, material and quantity, a column for each shading.
    fn slopes(&self) -> PageTable {
        let mut header = vec!["object, material".to_owned(), "slope of the".to_owned()];
        header.extend(SHADINGS.map(|shading| shading_name(shading).to_owned()));
        // The sweep's innermost loop is over the shadings.
        let rows = self.convergence.chunks(SHADINGS.len()).flat_map(|found| {
            QUANTITIES.into_iter().map(|(name, error)| {
                let mut row = vec![format!("{}, {}", found[0].object.name(), found[0].surface.name()), name.to_owned()];
                row.extend(found.iter().map(|found| order(found.order(error))));
                row
            })
        });
        PageTable {
            caption: "Slopes of log error against log edge length".to_owned(),
            names: 2,
            header,
            rows: rows.collect(),
        }
    }

    fn highlight_section(&self) -> Section {
        let figure = self.highlight_figure();
        let rows = SHADINGS.into_iter().zip(self.unsteadiness()).filter_map(|(shading, found)| {
            let Unsteadiness { rms, worst, worst_frame } = found?;
            let percent = |share: f64| format!("{:.3} %", share * 100.0);
            Some(vec![shading_name(shading).to_owned(), percent(rms), percent(worst), worst_frame.to_string()])
        });
        Section {
            title: "A moving highlight".to_owned(),
            text: vec![format!(
                "A light moves slowly across a {}, which shows its highlight only (no ambient, no diffuse; shininess \
                 32). On the true surface the sum of all the light in a frame, its energy, hardly changes from one frame \
                 to the next. A highlight that lives on the vertices swells when it meets one and fades between them: it \
                 flickers.",
                self.coarse_sphere()
            )],
            files: files(&[("chart", figure.id)], &[("energies", "highlight"), ("numbers", "unsteadiness")]),
            figures: vec![(String::new(), figure)],
            tables: vec![PageTable {
                caption:
                    "Change of energy from frame to frame less the true surface’s, relative to the mean true energy"
                        .to_owned(),
                names: 1,
                header: ["shading", "RMS", "worst", "in frame"].map(str::to_owned).into(),
                rows: rows.collect(),
            }],
        }
    }
}

fn card(measured: &Measured) -> Result<Card, ReportError> {
    let comparison = &measured.comparison;
    let coverage = comparison.coverage.unwrap_or_default();
    let row = |name: &str, value: String| (name.to_owned(), value);
    Ok(Card {
        title: describe(measured),
        rows: vec![
            row("time", format!("{:.2} × constant", measured.ratio)),
            row("frame", format!("{:.2} ms", measured.frame_ms)),
            row("RMS error", format!("{:.2e}", comparison.linear.all.rmse)),
            row("in 8-bit steps", format!("{:.2}", comparison.steps.all.rmse)),
            row("largest error", format!("{:.2e}", comparison.linear.all.max())),
            row("in 8-bit steps", format!("{:.0}", comparison.steps.all.max())),
            row("mean ꟻLIP", format!("{:.4}", measured.flip)),
            row("outline differs", format!("{} of {} pixels", coverage.different(), comparison.counted)),
        ],
        pictures: vec![
            ("as drawn".to_owned(), data_uri(&measured.picture)?),
            ("difference from the true surface".to_owned(), data_uri(&measured.difference)?),
        ],
    })
}
