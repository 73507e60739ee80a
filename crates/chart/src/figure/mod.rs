//! The data of a chart, independent of its drawing: [`svg`] draws a [`Figure`] for a file, and its panels for the page.

mod axis;
pub mod svg;

pub use axis::{Axis, AxisScale, Tick};

/// A chart of one or more panels with the same axes and series.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The name of the SVG file and of the chart on the page: lower case, no spaces.
    pub id: String,
    /// The label of the button that shows this chart, if a section has several.
    pub name: String,
    /// The subject of the chart, in a line; unique on its page.
    pub title: String,
    /// The horizontal axis of every panel.
    pub x: Axis,
    /// The vertical axis of every panel.
    pub y: Axis,
    /// The panels, row by row ([`Figure::columns`]).
    pub panels: Vec<Panel>,
}

/// One pair of axes with its series.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// The feature that distinguishes the panel from its neighbours.
    pub title: String,
    /// The series, the last on top.
    pub series: Vec<Series>,
}

impl Panel {
    /// A panel.
    pub fn new(title: impl Into<String>, series: Vec<Series>) -> Self {
        Self { title: title.into(), series }
    }
}

/// Points that belong together, joined by a line in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The common feature of the points. Series of the same name in several panels share one entry of the legend.
    pub name: String,
    /// The style that distinguishes it from others.
    pub style: Style,
    /// The points.
    pub points: Vec<Point>,
}

/// One measured point.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// In the unit of the horizontal axis.
    pub x: f64,
    /// In the unit of the vertical axis.
    pub y: f64,
    /// A description in a line; empty for points that were not measured.
    pub label: String,
    /// The quartiles of the values whose median `x` is, if it is one.
    pub quartiles: Option<(f64, f64)>,
    /// Whether another point is both faster and more accurate: it is drawn pale.
    pub faded: bool,
    /// The index of its details in [`Page::cards`](crate::page::Page::cards); without one the page shows the label.
    pub card: Option<usize>,
}

impl Point {
    /// A point without quartiles.
    pub fn new(x: f64, y: f64, label: String) -> Self {
        Self { x, y, label, quartiles: None, faded: false, card: None }
    }
}

/// The style of a series. Colour, marker and line all differ between series, so that any of them is enough to tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// sRGB.
    pub color: [u8; 3],
    /// The marker at the points; `None` for a bare line.
    pub marker: Option<Marker>,
    /// Whether markers are filled, or only outlined.
    pub filled: bool,
    /// The stroke of the line.
    pub stroke: Stroke,
}

/// The shape of a marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// ●
    Circle,
    /// ■
    Square,
    /// ▲
    Triangle,
    /// ◆
    Diamond,
    /// ▼
    Wedge,
    /// ★ of four points.
    Star,
}

/// The stroke of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// Without gaps.
    Solid,
    /// In dashes.
    Dash,
    /// In dots.
    Dot,
    /// No line: points alone.
    Nothing,
}

impl Style {
    /// A bare solid line of this brightness.
    pub const fn gray(level: u8) -> Self {
        Self { color: [level; 3], marker: None, filled: true, stroke: Stroke::Solid }
    }

    /// The colour as CSS writes it.
    pub fn css(self) -> String {
        let [r, g, b] = self.color;
        format!("#{r:02x}{g:02x}{b:02x}")
    }

    /// A pale version of the style.
    fn faded(self) -> Self {
        // Three quarters of the way to white.
        Self { color: self.color.map(|channel| 255 - (255 - channel) / 4), ..self }
    }
}

impl Marker {
    /// The outline around (0, 0), in pixels, as the data of an SVG path.
    pub fn path(self) -> &'static str {
        match self {
            Self::Circle => "M-4.5,0a4.5,4.5 0 1,0 9,0a4.5,4.5 0 1,0 -9,0Z",
            Self::Square => "M-4,-4 4,-4 4,4 -4,4Z",
            Self::Triangle => "M0,-5 5,4 -5,4Z",
            Self::Diamond => "M0,-5 5,0 0,5 -5,0Z",
            Self::Wedge => "M0,5 5,-4 -5,-4Z",
            Self::Star => "M0,-6 2,-2 6,0 2,2 0,6 -2,2 -6,0 -2,-2Z",
        }
    }
}

/// The colours that charts use, which colour-blind readers tell apart (Okabe and Ito, "Color Universal Design", 2008).
pub(crate) mod colors {
    pub(crate) const GRAY: [u8; 3] = [0x8a, 0x8a, 0x8a];
    pub(crate) const INK: [u8; 3] = [0x22, 0x22, 0x22];
    pub(crate) const RED: [u8; 3] = [0xd5, 0x5e, 0x00];
    pub(crate) const BLUE: [u8; 3] = [0x00, 0x72, 0xb2];
    pub(crate) const GREEN: [u8; 3] = [0x00, 0x9e, 0x73];
    pub(crate) const PURPLE: [u8; 3] = [0xcc, 0x79, 0xa7];
    pub(crate) const ORANGE: [u8; 3] = [0xe6, 0x9f, 0x00];
    pub(crate) const SKY: [u8; 3] = [0x56, 0xb4, 0xe9];
}

impl Figure {
    /// A figure of these axes and panels.
    pub fn new(id: impl Into<String>, title: impl Into<String>, [x, y]: [Axis; 2], panels: Vec<Panel>) -> Self {
        Self { id: id.into(), name: String::new(), title: title.into(), x, y, panels }
    }

    /// The number of panels side by side, if the page is wide enough.
    pub fn columns(&self) -> usize {
        match self.panels.len() {
            0 | 1 => 1,
            2 | 4 => 2,
            _ => 3,
        }
    }

    /// With a label for its button.
    #[must_use]
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }

    /// The ends of the axes: the least that contain every point of every panel, and a margin. In positions
    /// ([`Axis::position`]): x, then y.
    pub fn ranges(&self) -> [(f64, f64); 2] {
        let all = || self.shown().map(|(_, point)| point);
        [self.x.range(all().flat_map(|point| self.reach(point))), self.y.range(all().map(|point| point.y))]
    }

    /// The horizontal positions of a point and its quartiles.
    fn reach(&self, point: &Point) -> impl Iterator<Item = f64> {
        let (low, high) = point.quartiles.unwrap_or((point.x, point.x));
        [low, point.x, high].into_iter().filter(|x| self.x.shows(*x))
    }

    /// Every point that can be drawn, with its series. A logarithmic axis cannot show 0.
    pub fn shown(&self) -> impl Iterator<Item = (&Series, &Point)> {
        let series = self.panels.iter().flat_map(|panel| &panel.series);
        series.flat_map(|series| self.drawn(series).map(move |point| (series, point)))
    }

    /// The points of one series that can be drawn.
    pub fn drawn<'a>(&'a self, series: &'a Series) -> impl Iterator<Item = &'a Point> {
        series.points.iter().filter(|point| self.x.shows(point.x) && self.y.shows(point.y))
    }

    /// The entries of the legend: every name once.
    pub fn legend(&self) -> Vec<&Series> {
        let mut entries: Vec<&Series> = Vec::new();
        for series in self.panels.iter().flat_map(|panel| &panel.series) {
            if entries.iter().all(|entry| entry.name != series.name) {
                entries.push(series);
            }
        }
        entries
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Two panels of two series; one point, at 0, has no place on the logarithmic axis.
    pub(crate) fn example() -> Figure {
        let style = |color, marker, stroke| Style { color, marker: Some(marker), filled: true, stroke };
        let point = |x, y| Point { quartiles: Some((0.9 * x, 1.1 * x)), ..Point::new(x, y, format!("<{x}> & {y}")) };
        let panel = |title: &str, factor: f64| Panel {
            title: title.to_owned(),
            series: vec![
                Series {
                    name: "one & all".to_owned(),
                    style: style([0xd5, 0x5e, 0x00], Marker::Square, Stroke::Dot),
                    points: vec![point(1.0, 0.01 * factor), point(1.5, 0.1 * factor), point(2.0, 0.0)],
                },
                Series {
                    name: "other".to_owned(),
                    style: style([0x00, 0x72, 0xb2], Marker::Triangle, Stroke::Dash),
                    points: vec![point(1.2, 0.02 * factor), point(3.0, 0.5 * factor)],
                },
            ],
        };
        let axes = [Axis::log("time"), Axis::log("error")];
        Figure::new("example", "An <example>", axes, vec![panel("left", 1.0), panel("right", 2.0)])
    }

    #[test]
    fn ranges_hold_all_shown_values() {
        let figure = example();
        let [x, y] = figure.ranges();
        assert!(x.0 < 0.0 && x.1 > 3f64.log10() && x.1 < 1.0, "{x:?}");
        assert!(y.0 < -2.0 && y.0 > -3.0 && y.1 > 0.0 && y.1 < 1.0, "{y:?}");
        assert_eq!(figure.shown().count(), 8, "the points at 0 have no logarithm");
    }

    #[test]
    fn the_legend_names_each_series_once() {
        let figure = example();
        let names: Vec<&str> = figure.legend().iter().map(|series| series.name.as_str()).collect();
        assert_eq!(names, ["one & all", "other"]);
    }
}
