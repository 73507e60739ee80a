//! What the page says.

use super::Report;
use super::charts::order;
use super::failing;
use super::fronts::LEAD;
use super::over;
use super::tables::files;
use crate::measure::convergence::{FITTED, QUANTITIES};
use crate::measure::highlight::Unsteadiness;
use crate::measure::{SHADINGS, shading_name};
use crate::page::{Page, PageTable, Section};

impl Report {
    /// The page.
    pub(super) fn page(&self) -> Page {
        let mut sections = self.fronts.sections();
        sections.extend([
            over::section(&self.over),
            failing::section(&self.failures),
            self.convergence_section(),
            self.highlight_section(),
            self.scaling.section(),
        ]);
        Page {
            title: "Error against time".to_owned(),
            lead: LEAD.to_owned(),
            facts: self.facts(),
            sections,
            points: Some(self.fronts.on_page()),
        }
    }

    fn facts(&self) -> Vec<(String, String)> {
        let plan = &self.plan;
        let fact = |name: &str, value: String| (name.to_owned(), value);
        let mut facts = self.fronts.facts();
        facts.extend([
            fact("convergence", format!("{0} × {0} pixels", plan.convergence.size)),
            fact("highlight", format!("{} frames of {1} × {1} pixels", plan.highlight.frames, plan.highlight.size)),
        ]);
        facts
    }

    fn convergence_section(&self) -> Section {
        let figure = self.convergence_figure();
        Section {
            title: "Rates of convergence".to_owned(),
            scene: None,
            pictures: Vec::new(),
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
            files: files(&[("chart", &figure.id)], &[("errors", "convergence"), ("slopes", "slopes")]),
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
            scene: None,
            pictures: Vec::new(),
            text: vec![format!(
                "A light moves slowly across a {}, which shows its highlight only (no ambient, no diffuse; shininess \
                 32). On the true surface the sum of all the light in a frame, its energy, hardly changes from one frame \
                 to the next. A highlight that lives on the vertices swells when it meets one and fades between them: it \
                 flickers.",
                self.coarse_sphere()
            )],
            files: files(&[("chart", &figure.id)], &[("energies", "highlight"), ("numbers", "unsteadiness")]),
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
