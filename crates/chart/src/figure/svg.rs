//! Figures as SVG, with text as text.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::element::{DashedPathElement, PathElement, Polygon, Text};
use plotters::prelude::{
    ChartBuilder, Circle, DrawingArea, DrawingAreaErrorKind, IntoDrawingArea, RGBColor, SVGBackend, TRANSPARENT, WHITE,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, IntoFont, TextStyle};
use thiserror::Error;

use super::{Axis, Figure, Marker, Panel, Point, Series, Stroke, Style, Tick};

/// How large a figure is drawn, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Of the whole figure.
    pub width: u32,
    /// Of one row of panels.
    pub row: u32,
}

/// The drawing library refused.
#[derive(Debug, Error)]
#[error("the chart cannot be drawn as SVG: {0}")]
pub struct SvgError(String);

impl<E: std::error::Error + Send + Sync> From<DrawingAreaErrorKind<E>> for SvgError {
    fn from(error: DrawingAreaErrorKind<E>) -> Self {
        Self(error.to_string())
    }
}

type Result<T = ()> = std::result::Result<T, SvgError>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// Pixels from the upper left corner of the figure.
type Pixel = (i32, i32);

const INK: RGBColor = RGBColor(0x2b, 0x2b, 0x2b);
const GRID: RGBColor = RGBColor(0xe6, 0xe6, 0xe6);
const FONT: &str = "system-ui, sans-serif";
/// What the title and one line of legend take at the top.
const HEAD: u32 = 64;
/// What another line of legend takes.
const LEGEND_LINE: u32 = 20;
/// Half the width of a marker.
const MARKER: i32 = 4;
/// The length of line that stands for a series in the legend.
const SWATCH: i32 = 36;

/// Draws all of a figure: title, legend, and the panels below.
///
/// # Errors
/// What the drawing library has to say; it has no reason to fail on text in memory.
pub fn figure(figure: &Figure, size: Size) -> Result<String> {
    let rows = figure.panels.len().div_ceil(figure.columns).max(1);
    let legend = legend_lines(figure, size.width);
    let top = HEAD + LEGEND_LINE * legend.len().saturating_sub(1) as u32;
    on_canvas((size.width, top + rows as u32 * size.row), |root| {
        head(figure, &legend, root)?;
        let body = root.split_vertically(top).1.split_evenly((rows, figure.columns));
        figure.panels.iter().zip(body).try_for_each(|(content, area)| panel(figure, content, root, &area).map(drop))
    })
    .map(|(svg, ())| svg)
}

/// Draws one panel of a figure alone, for a page that can be pointed at: over each point lies an invisible circle of
/// the class `hit`, with the point's label as `data-label`.
///
/// # Errors
/// What the drawing library has to say; it has no reason to fail on text in memory.
pub fn panel_with_hits(figure: &Figure, content: &Panel, size: Size) -> Result<String> {
    let (mut svg, points) = on_canvas((size.width, size.row), |root| panel(figure, content, root, root))?;
    let end = svg.rfind("</svg>").unwrap_or(svg.len());
    let hits: String = points.into_iter().map(hit).collect();
    svg.insert_str(end, &hits);
    Ok(svg)
}

/// Draws a piece of a series' line with its marker, as the legend shows it.
///
/// # Errors
/// What the drawing library has to say; it has no reason to fail on text in memory.
pub fn swatch(style: Style) -> Result<String> {
    let drawn = on_canvas((SWATCH as u32, 14), |root| piece(root, (0, 7), style));
    drawn.map(|(svg, ())| svg)
}

fn piece(root: &Area<'_>, (x, y): Pixel, style: Style) -> Result {
    line(root, vec![(x, y), (x + SWATCH, y)], style)?;
    mark(root, (x + SWATCH / 2, y), style)
}

fn on_canvas<T>((width, height): (u32, u32), draw: impl FnOnce(&Area<'_>) -> Result<T>) -> Result<(String, T)> {
    let mut svg = String::new();
    let drawn = {
        let root = SVGBackend::with_string(&mut svg, (width, height)).into_drawing_area();
        root.fill(&WHITE)?;
        let drawn = draw(&root)?;
        root.present()?;
        drawn
    };
    Ok((svg, drawn))
}

fn hit((point, (x, y)): (&Point, Pixel)) -> String {
    let label = escaped(&point.label);
    format!("<circle class=\"hit\" cx=\"{x}\" cy=\"{y}\" r=\"8\" data-label=\"{label}\"/>\n")
}

/// Text as HTML and SVG, in elements and in quoted attributes.
pub fn escaped(text: &str) -> String {
    let mut escaped = text.replace('&', "&amp;");
    for (character, entity) in [('<', "&lt;"), ('>', "&gt;"), ('"', "&quot;"), ('\'', "&#39;")] {
        escaped = escaped.replace(character, entity);
    }
    escaped
}

/// What a series takes in the legend. An SVG file does not say how wide its letters are; most are narrower than this.
fn advance(series: &Series) -> i32 {
    SWATCH + 8 + 8 * series.name.chars().count() as i32 + 22
}

/// The legend in as many lines as its entries need in this width, at least one entry in each.
fn legend_lines(figure: &Figure, width: u32) -> Vec<Vec<&Series>> {
    let mut lines: Vec<Vec<&Series>> = Vec::new();
    let mut room = 0;
    for series in figure.legend() {
        room -= advance(series);
        match lines.last_mut() {
            Some(line) if room >= 0 => line.push(series),
            _ => {
                room = width as i32 - advance(series);
                lines.push(vec![series]);
            }
        }
    }
    lines
}

fn head(figure: &Figure, legend: &[Vec<&Series>], root: &Area<'_>) -> Result {
    let middle = root.dim_in_pixel().0 as i32 / 2;
    write(root, &figure.title, (middle, 20), 16, (HPos::Center, VPos::Center))?;
    for (line, y) in legend.iter().zip((47..).step_by(LEGEND_LINE as usize)) {
        let mut x = middle - line.iter().map(|series| advance(series)).sum::<i32>() / 2 + 11;
        for series in line {
            piece(root, (x, y), series.style)?;
            write(root, &series.name, (x + SWATCH + 8, y), 13, (HPos::Left, VPos::Center))?;
            x += advance(series);
        }
    }
    Ok(())
}

/// An axis as the drawing library takes it, in positions ([`Axis::position`]).
struct Positions {
    range: (f64, f64),
    ticks: Vec<Tick>,
}

impl Positions {
    fn of(axis: &Axis, range: (f64, f64)) -> Self {
        Self { range, ticks: axis.ticks(range) }
    }
}

impl Ranged for Positions {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, position: &f64, (start, end): (i32, i32)) -> i32 {
        let (low, high) = self.range;
        start + ((position - low) / (high - low) * f64::from(end - start)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        // There are no light grid lines between the ticks.
        let ticks = if hint.weight().allow_light_points() { &[] } else { self.ticks.as_slice() };
        ticks.iter().map(|tick| tick.position).collect()
    }

    fn range(&self) -> Range<f64> {
        self.range.0..self.range.1
    }
}

impl ValueFormatter<f64> for Positions {
    fn format_ext(&self, position: &f64) -> String {
        let off = |tick: &Tick| (tick.position - position).abs();
        let nearest = self.ticks.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        nearest.map(|tick| tick.label.clone()).unwrap_or_default()
    }
}

/// Draws a panel into `area` and tells where its points are on `root`.
fn panel<'a>(
    figure: &'a Figure,
    panel: &'a Panel,
    root: &Area<'_>,
    area: &Area<'_>,
) -> Result<Vec<(&'a Point, Pixel)>> {
    let [x, y] = figure.ranges(panel);
    let mut chart = ChartBuilder::on(area)
        .margin(6)
        .margin_right(14)
        .caption(&panel.title, style(13))
        .x_label_area_size(42)
        .y_label_area_size(58)
        .build_cartesian_2d(Positions::of(&figure.x, x), Positions::of(&figure.y, y))?;
    chart
        .configure_mesh()
        .x_desc(panel.x_label.as_ref().unwrap_or(&figure.x.label).as_str())
        .y_desc(figure.y.label.as_str())
        .label_style(style(11))
        .axis_desc_style(style(11))
        .axis_style(INK)
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .draw()?;
    let at = |point: &Point| chart.backend_coord(&(figure.x.position(point.x), figure.y.position(point.y)));
    let mut placed = Vec::new();
    for series in &panel.series {
        let points: Vec<_> = figure.drawn(series).map(|point| (point, at(point))).collect();
        line(root, points.iter().map(|(_, at)| *at).collect(), series.style)?;
        for (point, at) in &points {
            let style = if point.faded { series.style.faded() } else { series.style };
            if let Some((low, high)) = point.quartiles.filter(|(low, _)| figure.x.shows(*low)) {
                let [low, high] = [low, high].map(|x| (chart.backend_coord(&(figure.x.position(x), y.0)).0, at.1));
                root.draw(&PathElement::new(vec![low, high], color(style).stroke_width(1)))?;
            }
            mark(root, *at, style)?;
        }
        placed.extend(points);
    }
    // Lines of 15 pixels, the last at the bottom of the plot's right edge.
    let (right, bottom) = chart.backend_coord(&(x.1, y.0));
    for (above, note) in panel.notes.iter().rev().enumerate() {
        let at = (right - 8, bottom - 8 - 15 * above as i32);
        write(root, note, at, 11, (HPos::Right, VPos::Bottom))?;
    }
    Ok(placed)
}

/// `size` is the font's in pixels, as CSS has it; the drawing library means the height of a line, and divides by 1.24.
fn style(size: u32) -> TextStyle<'static> {
    TextStyle::from((FONT, f64::from(size) * 1.24).into_font()).color(&INK)
}

fn write(root: &Area<'_>, text: &str, at: Pixel, size: u32, (h, v): (HPos, VPos)) -> Result {
    Ok(root.draw(&Text::new(text.to_owned(), at, style(size).pos(Pos::new(h, v))))?)
}

fn line(root: &Area<'_>, points: Vec<Pixel>, style: Style) -> Result {
    let ink = color(style).stroke_width(2);
    match style.stroke.pattern() {
        _ if style.stroke == Stroke::Nothing => {}
        None => root.draw(&PathElement::new(points, ink))?,
        Some((dash, gap)) => root.draw(&DashedPathElement::new(points, dash, gap, ink))?,
    }
    Ok(())
}

/// The series' marker, if it has one. One that is not filled is white inside, so that no line shows through.
fn mark(root: &Area<'_>, (x, y): Pixel, style: Style) -> Result {
    let Some(marker) = style.marker else { return Ok(()) };
    let fill = if style.filled { color(style).filled() } else { WHITE.filled() };
    let corners: &[Pixel] = match marker {
        Marker::Circle => {
            root.draw(&Circle::new((x, y), MARKER, fill))?;
            return Ok(root.draw(&Circle::new((x, y), MARKER, color(style).stroke_width(2)))?);
        }
        Marker::Square => &[(-4, -4), (4, -4), (4, 4), (-4, 4)],
        Marker::Triangle => &[(0, -5), (5, 4), (-5, 4)],
        Marker::Diamond => &[(0, -5), (5, 0), (0, 5), (-5, 0)],
        Marker::Wedge => &[(0, 5), (5, -4), (-5, -4)],
        Marker::Star => &[(0, -6), (2, -2), (6, 0), (2, 2), (0, 6), (-2, 2), (-6, 0), (-2, -2)],
    };
    let mut outline: Vec<Pixel> = corners.iter().map(|(dx, dy)| (x + dx, y + dy)).collect();
    root.draw(&Polygon::new(outline.clone(), fill))?;
    // Closed, and a bit beyond, for the last corner to be as sharp as the others.
    outline.extend_from_within(..2);
    Ok(root.draw(&PathElement::new(outline, color(style).stroke_width(2)))?)
}

fn color(style: Style) -> RGBColor {
    let [r, g, b] = style.color;
    RGBColor(r, g, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::AxisScale;
    use crate::figure::tests::example;

    #[test]
    fn text_is_escaped() {
        assert_eq!(escaped("<a href=\"x\">'&'</a>"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;&lt;/a&gt;");
    }

    #[test]
    fn an_svg_file_shows_all_and_keeps_text_as_text() {
        let svg = figure(&example(), Size { width: 800, row: 300 }).unwrap();
        assert!(svg.starts_with("<svg width=\"800\" height=\"364\""), "{}", &svg[..80]);
        for text in ["An &lt;example&gt;", "one &amp; all", "other", "left", "right", "slope &lt; 2", "time", "error"] {
            assert!(svg.contains(text), "{text}");
        }
        // Four points of triangles in each panel and one in the legend, each filled and outlined.
        assert_eq!(svg.matches("<polygon").count(), 8 + 2);
        // Ticks of both axes.
        for label in ["\n1\n", "\n0.1\n"] {
            assert!(svg.contains(label), "{label:?}");
        }
        assert!(!svg.contains("NaN"));
    }

    #[test]
    fn legends_take_the_lines_that_they_need() {
        let example = example();
        let names = |width| -> Vec<Vec<String>> {
            let lines = legend_lines(&example, width);
            lines.iter().map(|line| line.iter().map(|series| series.name.clone()).collect()).collect()
        };
        assert_eq!(names(800), [["one & all", "other"]]);
        assert_eq!(names(150), [["one & all"], ["other"]]);
        let svg = figure(&example, Size { width: 150, row: 300 }).unwrap();
        assert!(svg.starts_with("<svg width=\"150\" height=\"384\""), "{}", &svg[..80]);
    }

    #[test]
    fn every_point_of_a_panel_can_be_hit() {
        let example = example();
        let svg = panel_with_hits(&example, &example.panels[0], Size { width: 300, row: 280 }).unwrap();
        assert!(svg.starts_with("<svg width=\"300\" height=\"280\"") && svg.ends_with("</svg>\n"), "{svg}");
        assert_eq!(svg.matches("class=\"hit\"").count(), 4);
        assert!(svg.contains("data-label=\"&lt;1&gt; &amp; 0.01\""));
    }

    #[test]
    fn positions_are_linear_and_named() {
        let axis = Positions::of(&Axis::new("", AxisScale::Log), (-2.0, 2.0));
        assert_eq!([-2.0, 0.0, 2.0].map(|position| axis.map(&position, (100, 500))), [100, 300, 500]);
        assert_eq!(axis.format_ext(&-1.0), "0.1");
    }
}
