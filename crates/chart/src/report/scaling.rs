//! How the time of a frame grows, as a chapter of the report and as a page of its own.

use super::charts::{gray, order, style};
use super::tables::{files, number};
use super::{NamedFile, ReportError, figure_file};
use crate::figure::{Axis, AxisScale, Figure, Marker, Panel, Point, Series, Stroke, Style, superscript};
use crate::measure::scaling::{self, Curve, Decade, Growth, LOOKS, Law, ScalingPlan, TimedSample};
use crate::measure::{MeasureError, MeasureProgress, shading_name};
use crate::page::{Page, PageTable, Section, csv, html};
use crate::timing::{FRAME_TIME, Machine, Spread, TimedLook};

/// How the time of a frame grows with what is in it.
#[derive(Clone, Debug)]
pub struct Scaling {
    /// How much was measured.
    pub plan: ScalingPlan,
    /// What it was measured on.
    pub machine: Machine,
    /// A curve for each of [`Growth::ALL`] and each of [`LOOKS`], the last the quickest to change.
    pub curves: Vec<Curve>,
}

impl Scaling {
    /// Measures; `progress` hears of [`ScalingPlan::units`].
    ///
    /// # Errors
    /// The first frame that could not be drawn.
    pub fn measure(plan: ScalingPlan, progress: &mut MeasureProgress<'_>) -> Result<Self, MeasureError> {
        let (curves, machine) = scaling::sweep(plan, progress)?;
        Ok(Self { plan, machine, curves })
    }

    /// The page `scaling.html`, the chart and the tables.
    ///
    /// # Errors
    /// What could not be drawn.
    pub fn files(&self) -> Result<Vec<NamedFile>, ReportError> {
        let page = Page {
            title: "How the time of a frame grows".to_owned(),
            lead: "Flat shading evaluates the lighting once a triangle, Gouraud shading once a vertex, Phong shading \
                   once a pixel; a constant colour leaves it out. What does each cost in large scenes and in small ones?"
                .to_owned(),
            facts: self.machine.facts(),
            sections: vec![self.section()],
            points: None,
        };
        let mut files = vec![("scaling.html".to_owned(), html(&page)?), figure_file(&self.figure())?];
        files.extend(self.tables());
        Ok(files)
    }

    /// The chart's figures, and their slopes.
    pub(super) fn tables(&self) -> [NamedFile; 2] {
        [("scaling.csv".to_owned(), self.samples_csv()), ("scaling-slopes.csv".to_owned(), self.slopes_csv())]
    }

    pub(super) fn section(&self) -> Section {
        let figure = self.figure();
        Section {
            title: "Scaling".to_owned(),
            scene: None,
            pictures: Vec::new(),
            text: vec![
                format!(
                    "One thing at a time grows by powers of ten, and the time of a frame with it. {FRAME_TIME} Points are \
                     medians of up to {} rounds in which constant, flat, Gouraud and Phong take turns. Where it is not \
                     pixels that grow, there are {1} × {1} of them.",
                    self.plan.rounds, self.plan.size
                ),
                format!(
                    "Levels of detail are off while {} grow, so that all of them are there to draw; elsewhere they are as \
                     by default, and made before anything is timed. Patches that turn away or lie outside are left out \
                     everywhere.",
                    Growth::Triangles.counted()
                ),
                "Both axes are logarithmic: a slope of 1, as of the grey line, is in proportion, and one of 0 does not \
                 depend on the count. The law of a curve is the slope of its last decade; it breaks where an earlier \
                 decade’s is off by more than 0.25. A decade counts as far as it was measured."
                    .to_owned(),
            ],
            files: files(&[("chart", &figure.id)], &[("times", "scaling"), ("slopes", "scaling-slopes")]),
            figures: vec![(String::new(), figure)],
            tables: vec![self.slope_table(), self.law_table()],
        }
    }

    /// A panel for each growth.
    fn figure(&self) -> Figure {
        Figure {
            id: "scaling".to_owned(),
            title: "Time of a frame against what is in it".to_owned(),
            x: Axis::new("count", AxisScale::Log),
            y: Axis::new("frame, ms", AxisScale::Log),
            columns: 3,
            panels: Growth::ALL.map(|growth| self.panel(growth)).into(),
        }
    }

    fn panel(&self, growth: Growth) -> Panel {
        let curves: Vec<&Curve> = self.curves.iter().filter(|curve| curve.growth == growth).collect();
        let mut series: Vec<Series> = proportion(&curves).into_iter().collect();
        series.extend(curves.iter().map(|curve| self::series(curve)));
        Panel { title: growth.name().to_owned(), x_label: Some(growth.counted().to_owned()), notes: Vec::new(), series }
    }

    /// A row for each curve, a column for each decade of any.
    fn slope_table(&self) -> PageTable {
        let decades = || self.curves.iter().flat_map(Curve::decades).map(|decade| decade.exponent);
        let (first, last) = (decades().min().unwrap_or(0), decades().max().unwrap_or(-1));
        let mut header = names();
        header.extend((first..=last).map(|exponent| format!("{}–{}", power(exponent), power(exponent + 1))));
        let rows = self.curves.iter().map(|curve| {
            let found = curve.decades();
            let slope = |exponent| found.iter().find(|decade| decade.exponent == exponent).map(|decade| decade.slope);
            let mut row = row_names(curve);
            row.extend((first..=last).map(|exponent| order(slope(exponent))));
            row
        });
        PageTable {
            caption: "Slopes of log time against log count, decade by decade".to_owned(),
            names: 2,
            header,
            rows: rows.collect(),
        }
    }

    fn law_table(&self) -> PageTable {
        let mut header = names();
        header.push("time of a frame with n of them".to_owned());
        let rows = self.curves.iter().map(|curve| {
            let mut row = row_names(curve);
            row.push(self.sentence(curve));
            row
        });
        PageTable { caption: "The laws, and where they break".to_owned(), names: 3, header, rows: rows.collect() }
    }

    /// How a curve grows, where it grows otherwise, and why it ends.
    fn sentence(&self, curve: &Curve) -> String {
        let power_law = |slope: f64| format!("as n^{}", order(Some(slope)));
        let law = match curve.law() {
            None => "measured at too few n for a slope".to_owned(),
            Some(Law { slope, breaks: None, .. }) => format!("{} throughout", power_law(slope)),
            Some(Law { slope, holds_from, breaks: Some(Decade { exponent, slope: there }) }) => {
                let [from, to, holds_from] = [exponent, exponent + 1, holds_from].map(power);
                let only = if there < slope { "only " } else { "" };
                format!("{} from {holds_from} on; {only}{} from {from} to {to}", power_law(slope), power_law(there))
            }
        };
        let end = |last: &TimedSample| {
            format!("; ends at {:.0}, for the next may take more than {:.0} ms", last.count, self.plan.limit_ms)
        };
        law + &curve.samples.last().filter(|_| curve.is_cut).map(end).unwrap_or_default()
    }

    fn samples_csv(&self) -> String {
        let header = [
            "what grows",
            "counted",
            "shading",
            "count",
            "frame (ms)",
            "least (ms)",
            "lower quartile (ms)",
            "upper quartile (ms)",
            "largest (ms)",
            "frames timed",
        ];
        let rows = self.curves.iter().flat_map(|curve| {
            curve.samples.iter().map(|sample| {
                let Spread { min, lower_quartile, median, upper_quartile, max, count } = sample.frame_ms;
                let [name, shading] = [curve.growth.name(), look_name(curve.look)].map(str::to_owned);
                let [median, min, lower, upper, max] = [median, min, lower_quartile, upper_quartile, max].map(number);
                let counted = curve.growth.counted().to_owned();
                let [many, frames] = [format!("{:.0}", sample.count), count.to_string()];
                [name, counted, shading, many, median, min, lower, upper, max, frames]
            })
        });
        csv(header, rows)
    }

    fn slopes_csv(&self) -> String {
        let rows = self.curves.iter().flat_map(|curve| {
            curve.decades().into_iter().map(|Decade { exponent, slope }| {
                let [name, shading] = [curve.growth.name(), look_name(curve.look)].map(str::to_owned);
                let [from, to] = [exponent, exponent + 1].map(|exponent| format!("1e{exponent}"));
                [name, shading, from, to, number(slope)]
            })
        });
        csv(["what grows", "shading", "from", "to", "slope"], rows)
    }
}

fn look_name(look: TimedLook) -> &'static str {
    match look {
        TimedLook::Constant => "constant",
        TimedLook::Shaded(shading) => shading_name(shading),
    }
}

fn names() -> Vec<String> {
    ["what grows", "shading"].map(str::to_owned).into()
}

/// What grows stands in the first of its rows only.
fn row_names(curve: &Curve) -> Vec<String> {
    let growth = if curve.look == LOOKS[0] { curve.growth.name() } else { "" };
    vec![growth.to_owned(), look_name(curve.look).to_owned()]
}

/// 10 to the power, short ones in full.
fn power(exponent: i32) -> String {
    match exponent {
        0..=3 => 10u32.pow(exponent.unsigned_abs()).to_string(),
        _ => format!("10{}", superscript(exponent)),
    }
}

fn series(curve: &Curve) -> Series {
    let name = look_name(curve.look);
    let style = match curve.look {
        TimedLook::Constant => Style { marker: Some(Marker::Circle), filled: false, ..gray(0x55) },
        TimedLook::Shaded(shading) => style(shading),
    };
    let points = curve.samples.iter().map(|sample| {
        let Spread { median, lower_quartile, upper_quartile, .. } = sample.frame_ms;
        let label = format!(
            "{name}, {:.0} {}: {median:.2} ms (half of the frames {lower_quartile:.2} to {upper_quartile:.2})",
            sample.count,
            curve.growth.counted()
        );
        Point::new(sample.count, median, label)
    });
    Series { name: name.to_owned(), style, points: points.collect() }
}

/// A line of slope 1 through the last point of the highest curve, as far down as anything was measured.
fn proportion(curves: &[&Curve]) -> Option<Series> {
    let samples = || curves.iter().flat_map(|curve| &curve.samples);
    let last = curves.iter().filter_map(|curve| curve.samples.last());
    let top = last.max_by(|a, b| (a.frame_ms.median / a.count).total_cmp(&(b.frame_ms.median / b.count)))?;
    let least = samples().map(|sample| sample.frame_ms.median).fold(f64::INFINITY, f64::min);
    let start = samples().map(|sample| sample.count).fold(f64::INFINITY, f64::min);
    let each = top.frame_ms.median / top.count;
    let end = samples().map(|sample| sample.count).fold(0.0, f64::max).min(top.count);
    let points = [start.max(least / each), end].map(|x| Point::new(x, each * x, "in proportion".to_owned()));
    let style = Style { stroke: Stroke::Solid, ..gray(0xb8) };
    Some(Series { name: "in proportion".to_owned(), style, points: points.into() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scaling(is_cut: bool, times: &[(f64, f64)]) -> Scaling {
        let samples = times.iter().map(|&(count, ms)| TimedSample { count, frame_ms: Spread::of(&[ms]) }).collect();
        let curve = Curve { growth: Growth::Lights, look: LOOKS[3], samples, is_cut };
        let machine = Machine {
            adapter: "one".to_owned(),
            backend: "vulkan".to_owned(),
            software: true,
            driver: "driver".to_owned(),
            driver_version: "1".to_owned(),
            halfway: "0",
            cpu: "fast".to_owned(),
            cores: 2,
        };
        Scaling { plan: crate::ReportPlan::QUICK.scaling, machine, curves: vec![curve] }
    }

    #[test]
    fn sentences_tell_where_a_law_breaks() {
        let sentence = |is_cut, times: &[(f64, f64)]| {
            let scaling = scaling(is_cut, times);
            scaling.sentence(&scaling.curves[0])
        };
        let proportional = sentence(false, &[(1.0, 1.0), (10.0, 10.0), (100.0, 100.0)]);
        assert_eq!(proportional, "as n^1.00 throughout");
        let flat_first = sentence(true, &[(1.0, 2.0), (10.0, 2.0), (100.0, 20.0)]);
        let expected = "as n^1.00 from 10 on; only as n^0.00 from 1 to 10; ends at 100, for the next";
        assert!(flat_first.starts_with(expected), "{flat_first}");
        assert_eq!(sentence(false, &[(1.0, 2.0)]), "measured at too few n for a slope");
    }

    #[test]
    fn the_line_of_proportion_ends_at_the_highest_curve() {
        let scaling = scaling(false, &[(1.0, 2.0), (10.0, 3.0), (100.0, 10.0)]);
        let line = proportion(&[&scaling.curves[0]]).unwrap();
        let ends: Vec<_> = line.points.iter().map(|point| (point.x, point.y)).collect();
        // 0.1 ms each; 2 ms, the least that was measured, are reached at 20.
        assert!((ends[0].0 - 20.0).abs() < 1e-9 && (ends[0].1 - 2.0).abs() < 1e-9, "{ends:?}");
        assert!((ends[1].0 - 100.0).abs() < 1e-9 && (ends[1].1 - 10.0).abs() < 1e-9, "{ends:?}");
        assert_eq!(proportion(&[]), None);
    }
}
