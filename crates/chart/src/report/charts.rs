//! What is charted of the report.

use halfway::prelude::Shading;

use super::Report;
use crate::figure::{Axis, AxisScale, Figure, Marker, Panel, Point, Series, Stroke, Style};
use crate::measure::convergence::{Convergence, ConvergenceSurface, Refinement};
use crate::measure::{ChartObject, SHADINGS, shading_name};

/// Colours that colour-blind readers tell apart (Okabe and Ito, "Color Universal Design", 2008), with markers and
/// strokes of their own.
pub(super) fn style(shading: Shading) -> Style {
    let (color, marker, stroke) = match shading {
        Shading::Flat => ([0xd5, 0x5e, 0x00], Marker::Square, Stroke::Dot),
        Shading::Gouraud => ([0x00, 0x72, 0xb2], Marker::Triangle, Stroke::Dash),
        _ => ([0x00, 0x9e, 0x73], Marker::Circle, Stroke::Solid),
    };
    Style { color, marker: Some(marker), filled: true, stroke }
}

/// A bare line of this brightness.
pub(super) fn gray(level: u8) -> Style {
    Style { color: [level; 3], marker: None, filled: true, stroke: Stroke::Solid }
}

impl Report {
    /// Error against edge length: a row of panels an object, a column a material.
    pub(super) fn convergence_figure(&self) -> Figure {
        let panels = ChartObject::ALL.into_iter().flat_map(|object| {
            ConvergenceSurface::ALL.into_iter().map(move |surface| {
                let here = |found: &&Convergence| found.object == object && found.surface == surface;
                let found: Vec<&Convergence> = self.convergence.iter().filter(here).collect();
                let mut notes = vec!["slope of max, of RMS".to_owned()];
                notes.extend(found.iter().map(|found| {
                    let [max, rms] = [Refinement::max, Refinement::rms].map(|error| order(found.order(error)));
                    format!("{}: {max}, {rms}", shading_name(found.shading))
                }));
                let title = format!("{}, {}", object.name(), surface.name());
                Panel {
                    title,
                    x_label: None,
                    notes,
                    series: found.iter().flat_map(|found| convergence_series(found)).collect(),
                }
            })
        });
        Figure {
            id: "convergence".to_owned(),
            title: "Error of the shading method as the mesh is refined".to_owned(),
            x: Axis::new("longest edge (the sphere's radius is 1)", AxisScale::Log),
            y: Axis::new("error (linear, white = 1)", AxisScale::Log),
            columns: 2,
            panels: panels.collect(),
        }
    }

    /// Energy over frames.
    pub(super) fn highlight_figure(&self) -> Figure {
        let truth = &self.energies.truth;
        let mean = truth.iter().sum::<f64>() / truth.len() as f64;
        let series = |name: &str, style: Style, energies: &[f64]| {
            let points = energies.iter().enumerate().map(|(frame, energy)| {
                let y = energy / mean;
                Point::new(frame as f64, y, format!("{name}, frame {frame}: {y:.3}"))
            });
            Series { name: name.to_owned(), style: Style { marker: None, ..style }, points: points.collect() }
        };
        let shaded = SHADINGS.iter().zip(&self.energies.shaded);
        let mut all: Vec<Series> =
            shaded.map(|(shading, energies)| series(shading_name(*shading), style(*shading), energies)).collect();
        all.push(series("true surface", gray(0x22), truth));
        Figure {
            id: "highlight".to_owned(),
            title: "Energy of a highlight while its light moves".to_owned(),
            x: Axis::new("frame", AxisScale::Linear),
            y: Axis::new("energy (mean of the true surface = 1)", AxisScale::Linear),
            columns: 1,
            panels: vec![Panel { title: self.coarse_sphere(), x_label: None, notes: Vec::new(), series: all }],
        }
    }

    /// The sphere that the highlight moves over, in words.
    pub(super) fn coarse_sphere(&self) -> String {
        let rings = self.plan.highlight.level;
        format!("sphere of {} meridians and {rings} bands", 2 * rings)
    }
}

/// The largest and the RMS error of one shading.
fn convergence_series(found: &Convergence) -> [Series; 2] {
    let name = shading_name(found.shading);
    let series = |what: &str, style: Style, error: fn(&Refinement) -> f64| {
        let points = found.levels.iter().map(|level| {
            let y = error(level);
            let label = format!("{name}, {what}: {y:.3e} with {} triangles", level.triangles);
            Point::new(level.edge, y, label)
        });
        Series { name: format!("{name}, {what}"), style, points: points.collect() }
    };
    let full = style(found.shading);
    [
        series("max", Style { filled: false, stroke: Stroke::Dash, ..full }, Refinement::max),
        series("RMS", Style { stroke: Stroke::Solid, ..full }, Refinement::rms),
    ]
}

/// An order of convergence with two decimals; a dash where there is none.
pub(super) fn order(order: Option<f64>) -> String {
    // What rounds to 0 has no sign.
    order.map_or_else(|| "–".to_owned(), |order| format!("{:.2}", if order.abs() < 0.005 { 0.0 } else { order }))
}
