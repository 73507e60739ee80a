//! What a chart says, apart from how it is drawn: [`svg`] draws a [`Figure`] for a file, and its panels for the page.

mod axis;
pub mod svg;

pub(crate) use axis::superscript;
pub use axis::{Axis, AxisScale, Tick};

/// A chart of one or more panels whose axes and series mean the same; horizontal axes may differ ([`Panel::x_label`]).
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Names the SVG file and the chart's place on the page: lower case, no spaces.
    pub id: String,
    /// What is charted, in a line.
    pub title: String,
    /// The horizontal axis of every panel.
    pub x: Axis,
    /// The vertical axis of every panel.
    pub y: Axis,
    /// How many panels stand side by side where there is room for them, 1 or more.
    pub columns: usize,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
}

/// One pair of axes with what is drawn in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// What the panel shows and its neighbours do not.
    pub title: String,
    /// What its horizontal axis shows, where that is not what the figure's does; it has ends of its own then.
    pub x_label: Option<String>,
    /// Lines of text for a corner that the series leave free.
    pub notes: Vec<String>,
    /// What is drawn, the last on top.
    pub series: Vec<Series>,
}

/// Points that belong together, joined by a line in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// What the points have in common. Series of the same name in several panels share one entry of the legend.
    pub name: String,
    /// How they are told from others.
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
    /// What the point is, in a line.
    pub label: String,
    /// From where to where half of the values lie that `x` is the median of, where it is one.
    pub quartiles: Option<(f64, f64)>,
    /// Whether another point is better in everything: it is drawn pale.
    pub faded: bool,
}

impl Point {
    /// A point without quartiles.
    pub fn new(x: f64, y: f64, label: String) -> Self {
        Self { x, y, label, quartiles: None, faded: false }
    }
}

/// How a series looks. Colour, marker and line all differ between series, so that each is told by any of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// sRGB.
    pub color: [u8; 3],
    /// What stands at the points; `None` for a bare line.
    pub marker: Option<Marker>,
    /// Whether markers are filled, or only outlined.
    pub filled: bool,
    /// How the line is drawn.
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

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// Without gaps.
    Solid,
    /// In dashes.
    Dash,
    /// In dots.
    Dot,
    /// Not at all: points alone.
    Nothing,
}

impl Style {
    /// The same in a colour that stands back.
    pub(crate) fn faded(self) -> Self {
        // Three quarters of the way to white.
        Self { color: self.color.map(|channel| 255 - (255 - channel) / 4), ..self }
    }
}

impl Stroke {
    /// The lengths of ink and gap in pixels; `None` without gaps.
    pub(crate) fn pattern(self) -> Option<(u32, u32)> {
        match self {
            Self::Solid | Self::Nothing => None,
            Self::Dash => Some((8, 4)),
            Self::Dot => Some((2, 3)),
        }
    }
}

impl Figure {
    /// The ends of a panel's axes: the least that hold every point of every panel, or, where its horizontal axis is one
    /// of its own, of this one; and a little room. In positions ([`Axis::position`]): x, then y.
    pub fn ranges(&self, panel: &Panel) -> [(f64, f64); 2] {
        let all = || self.shown().map(|(_, point)| point);
        let own = || panel.series.iter().flat_map(|series| self.drawn(series));
        let x = match panel.x_label {
            None => self.x.range(all().flat_map(|point| self.reach(point))),
            Some(_) => self.x.range(own().flat_map(|point| self.reach(point))),
        };
        [x, self.y.range(all().map(|point| point.y))]
    }

    /// Where a point and its quartiles stand along the horizontal axis.
    fn reach(&self, point: &Point) -> impl Iterator<Item = f64> {
        let (low, high) = point.quartiles.unwrap_or((point.x, point.x));
        [low, point.x, high].into_iter().filter(|x| self.x.shows(*x))
    }

    /// Every point that can be drawn, with its series. A logarithmic axis has no place for 0.
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
            x_label: None,
            notes: vec!["slope < 2".to_owned(), "another".to_owned()],
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
        Figure {
            id: "example".to_owned(),
            title: "An <example>".to_owned(),
            x: Axis::new("time", AxisScale::Log),
            y: Axis::new("error", AxisScale::Log),
            columns: 2,
            panels: vec![panel("left", 1.0), panel("right", 2.0)],
        }
    }

    #[test]
    fn ranges_hold_what_is_shown() {
        let mut figure = example();
        let [x, y] = figure.ranges(&figure.panels[0]);
        assert!(x.0 < 0.0 && x.1 > 3f64.log10() && x.1 < 1.0, "{x:?}");
        assert!(y.0 < -2.0 && y.0 > -3.0 && y.1 > 0.0 && y.1 < 1.0, "{y:?}");
        assert_eq!(figure.shown().count(), 8, "the points at 0 have no logarithm");
        figure.panels[0].series.pop();
        figure.panels[0].x_label = Some("another".to_owned());
        let [own, same] = figure.ranges(&figure.panels[0]);
        assert!(own.1 > 1.5f64.log10() && own.1 < 2f64.log10() && same == y, "{own:?}, {same:?}");
        assert_eq!(figure.ranges(&figure.panels[1])[0], x);
    }

    #[test]
    fn the_legend_names_each_series_once() {
        let figure = example();
        let names: Vec<&str> = figure.legend().iter().map(|series| series.name.as_str()).collect();
        assert_eq!(names, ["one & all", "other"]);
    }
}
