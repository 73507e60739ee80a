//! Error and time over shininess, lights and distance.

use super::fronts::style;
use super::tables::{files, number};
use crate::figure::{Axis, AxisScale, Figure, Marker, Panel, Point, Series, Stroke, Style};
use crate::front::{Family, FrontPoint, MeasuredOver};
use crate::page::{Section, csv as as_csv};

/// What is charted: the name of its button, the axis, and the value.
type Charted = (&'static str, &'static str, fn(&FrontPoint) -> f64);

const CHARTED: [Charted; 2] = [
    ("error", "RMS error of covered pixels, steps of 1/255", |point| point.errors.covered.steps.rms),
    ("time", "time of a frame (constant colour = 1)", |point| point.ratio.median),
];

/// The chapter.
pub(super) fn section(all: &[MeasuredOver]) -> Section {
    let figures = CHARTED.map(|charted| (charted.0.to_owned(), figure(all, charted)));
    Section {
        title: "Over shininess, lights and distance".to_owned(),
        scene: None,
        text: vec![
            "A sphere of 64 meridians, of which one thing changes. Near lights are point lights, far ones directional: for \
             those the direction toward the light is one for the whole object, as it is toward an infinite viewer. In \
             the last panel a near light is what is true, and “far lights” draws it as if it were infinitely far \
             away. The time is that of a frame over the same sphere in a constant colour."
                .to_owned(),
        ],
        pictures: Vec::new(),
        files: files(&[("error", "over-error"), ("time", "over-time")], &[("errors and times", "over")]),
        figures: figures.into(),
        tables: Vec::new(),
    }
}

fn figure(all: &[MeasuredOver], (name, label, value): Charted) -> Figure {
    let panels = all.iter().map(|measured| {
        let methods = measured.over.methods();
        let series = methods.iter().enumerate().map(|(i, method)| {
            let points = measured.steps.iter().filter_map(|(step, points)| {
                let point = points.get(i)?;
                let y = value(point);
                Some(Point::new(*step, y, format!("{}: {y:.3} at {step}", point.words)))
            });
            let family = style(method.family());
            let far = method.infinite_viewer || method.far_lights;
            let stroke = if far { Stroke::Dash } else { Stroke::Solid };
            let marker = if method.family() == Family::Mixed { Some(Marker::Wedge) } else { family.marker };
            let style = Style { stroke, marker, filled: !far, ..family };
            Series { name: method.words(), style, points: points.collect() }
        });
        Panel {
            title: measured.over.name().to_owned(),
            x_label: Some(measured.over.name().to_owned()),
            notes: Vec::new(),
            series: series.collect(),
        }
    });
    Figure {
        id: format!("over-{name}"),
        title: format!("{} over shininess, lights and distance", if name == "time" { "Time" } else { "Error" }),
        x: Axis::new("", AxisScale::Log),
        y: Axis::new(label, AxisScale::Log),
        columns: 2,
        panels: panels.collect(),
    }
}

/// A row for each step and method.
pub(super) fn csv(all: &[MeasuredOver]) -> String {
    let rows = all.iter().flat_map(|measured| {
        measured.steps.iter().flat_map(|(step, points)| {
            points.iter().map(|point| {
                let name = measured.over.name().to_owned();
                let [ms, ratio, error] = [point.ms.median, point.ratio.median, point.errors.covered.steps.rms];
                [name, number(*step), point.method.clone(), number(ms), number(ratio), number(error)]
            })
        })
    });
    let header = [
        "over",
        "value",
        "method",
        "frame (ms)",
        "frame (constant colour = 1)",
        "RMS of covered pixels (steps of 1/255)",
    ];
    as_csv(header, rows)
}
