//! Figures as SVG, with text as text.

use std::fmt::Write as _;

use super::{Axis, Figure, Panel, Point, Series, Stroke, Style};

/// The size of a figure in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Of the whole figure.
    pub width: u32,
    /// Of one row of panels.
    pub row: u32,
}

/// The height of the title and one line of legend.
const HEAD: u32 = 64;
/// The height of another line of legend.
const LEGEND_LINE: u32 = 20;
/// The length of line that stands for a series in the legend.
const SWATCH: u32 = 36;
/// The space of a panel's title and labels around its plot: left, right, top, bottom.
const MARGINS: [f64; 4] = [64.0, 14.0, 26.0, 48.0];

/// Draws all of a figure: title, legend, and the panels below.
pub fn figure(figure: &Figure, size: Size) -> String {
    let columns = figure.columns();
    let legend = legend_lines(figure, size.width);
    let top = HEAD + LEGEND_LINE * legend.len().saturating_sub(1) as u32;
    let mut body = head(figure, &legend, size.width);
    let panel_size = Size { width: size.width / columns as u32, row: size.row };
    for (i, content) in figure.panels.iter().enumerate() {
        let (column, row) = ((i % columns) as u32, (i / columns) as u32);
        let (x, y) = (column * panel_size.width, top + row * size.row);
        let _ = writeln!(body, "<g transform=\"translate({x} {y})\">\n{}</g>", panel(figure, content, panel_size).0);
    }
    let rows = figure.panels.len().div_ceil(columns).max(1) as u32;
    document((size.width, top + rows * size.row), &body)
}

/// Draws one panel of a figure alone, for an interactive page: each point with a label gets an invisible circle of the
/// class `hit`, with the point's label as `data-label` and its card, if it has one, as `data-card`.
pub fn panel_with_hits(figure: &Figure, content: &Panel, size: Size) -> String {
    let (mut body, points) = panel(figure, content, size);
    for (series, point, (x, y)) in points.into_iter().filter(|(_, point, _)| !point.label.is_empty()) {
        let [series, label] = [&series.name, &point.label].map(|text| escaped(text));
        let card = point.card.map(|card| format!(" data-card=\"{card}\"")).unwrap_or_default();
        let _ = writeln!(
            body,
            "<circle class=\"hit\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"8\" tabindex=\"0\" data-series=\"{series}\" \
             data-label=\"{label}\"{card}/>"
        );
    }
    document((size.width, size.row), &body)
}

/// Draws a sample of a series' line with its marker, as the legend shows it.
pub fn swatch(style: Style) -> String {
    document((SWATCH, 14), &piece((0.0, 7.0), style))
}

/// Text as HTML and SVG, in elements and in quoted attributes.
pub fn escaped(text: &str) -> String {
    let mut escaped = text.replace('&', "&amp;");
    for (character, entity) in [('<', "&lt;"), ('>', "&gt;"), ('"', "&quot;"), ('\'', "&#39;")] {
        escaped = escaped.replace(character, entity);
    }
    escaped
}

fn document((width, height): (u32, u32), body: &str) -> String {
    format!(
        "<svg width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         xmlns=\"http://www.w3.org/2000/svg\" font-family=\"system-ui, sans-serif\" fill=\"#2b2b2b\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{body}</svg>\n"
    )
}

fn piece((x, y): (f64, f64), style: Style) -> String {
    let length = f64::from(SWATCH);
    line(&[(x, y), (x + length, y)], style) + &mark((x + length / 2.0, y), style)
}

/// The width of a series in the legend. An SVG file does not say how wide its letters are; most are narrower than this.
fn advance(series: &Series) -> f64 {
    f64::from(SWATCH) + 8.0 * series.name.chars().count() as f64 + 30.0
}

/// The legend in as many lines as its entries need in this width, at least one entry in each.
fn legend_lines(figure: &Figure, width: u32) -> Vec<Vec<&Series>> {
    let mut lines: Vec<Vec<&Series>> = Vec::new();
    let mut left = 0.0;
    for series in figure.legend() {
        left -= advance(series);
        match lines.last_mut() {
            Some(line) if left >= 0.0 => line.push(series),
            _ => {
                left = f64::from(width) - advance(series);
                lines.push(vec![series]);
            }
        }
    }
    lines
}

fn head(figure: &Figure, legend: &[Vec<&Series>], width: u32) -> String {
    let middle = f64::from(width) / 2.0;
    let mut head = text(&figure.title, (middle, 26.0), (16, "middle"));
    for (line, y) in legend.iter().zip((47..).step_by(LEGEND_LINE as usize)) {
        let y = f64::from(y);
        let mut x = middle - line.iter().map(|series| advance(series)).sum::<f64>() / 2.0 + 11.0;
        for series in line {
            head += &piece((x, y), series.style);
            head += &text(&series.name, (x + f64::from(SWATCH) + 8.0, y + 4.5), (13, "start"));
            x += advance(series);
        }
    }
    head
}

/// An axis between two positions of the picture.
struct Scale<'a> {
    axis: &'a Axis,
    /// Positions ([`Axis::position`]).
    range: (f64, f64),
    /// The pixels that they map to.
    pixels: (f64, f64),
}

impl Scale<'_> {
    fn place(&self, position: f64) -> f64 {
        let ((low, high), (start, end)) = (self.range, self.pixels);
        start + (position - low) / (high - low) * (end - start)
    }

    fn value(&self, value: f64) -> f64 {
        self.place(self.axis.position(value))
    }
}

/// A point of a series, and its position in the drawing.
type Placed<'a> = (&'a Series, &'a Point, (f64, f64));

/// A panel, and the positions of its points.
fn panel<'a>(figure: &'a Figure, panel: &'a Panel, size: Size) -> (String, Vec<Placed<'a>>) {
    let [left, right, top, bottom] = MARGINS;
    let (right, bottom) = (f64::from(size.width) - right, f64::from(size.row) - bottom);
    let [x, y] = figure.ranges();
    let x = Scale { axis: &figure.x, range: x, pixels: (left, right) };
    let y = Scale { axis: &figure.y, range: y, pixels: (bottom, top) };
    let mut body = axes(&x, &y);
    body += &text(&panel.title, (f64::midpoint(left, right), 18.0), (13, "middle"));
    body += &text(&figure.x.label, (f64::midpoint(left, right), bottom + 38.0), (11, "middle"));
    let _ = writeln!(
        body,
        "<text transform=\"translate(14 {:.1}) rotate(-90)\" font-size=\"11\" text-anchor=\"middle\">{}</text>",
        f64::midpoint(top, bottom),
        escaped(&figure.y.label)
    );
    let mut placed = Vec::new();
    for series in &panel.series {
        let points = figure.drawn(series).map(|point| (series, point, (x.value(point.x), y.value(point.y))));
        let points: Vec<Placed<'_>> = points.collect();
        let _ = writeln!(body, "<g data-series=\"{}\">", escaped(&series.name));
        body += &line(&points.iter().map(|(.., at)| *at).collect::<Vec<_>>(), series.style);
        for &(_, point, at) in &points {
            let style = if point.faded { series.style.faded() } else { series.style };
            if let Some((low, high)) = point.quartiles.filter(|(low, _)| figure.x.shows(*low)) {
                body += &segment((x.value(low), at.1), (x.value(high), at.1), &style.css());
            }
            body += &mark(at, style);
        }
        body += "</g>\n";
        placed.extend(points);
    }
    (body, placed)
}

/// Ticks with their labels and the lines of the grid, and the frame's left and lower side.
fn axes(x: &Scale<'_>, y: &Scale<'_>) -> String {
    let ((left, right), (bottom, top)) = (x.pixels, y.pixels);
    let mut body = String::new();
    for tick in x.axis.ticks(x.range) {
        let at = x.place(tick.position);
        body += &segment((at, top), (at, bottom), "#e6e6e6");
        body += &text(&tick.label, (at, bottom + 16.0), (11, "middle"));
    }
    for tick in y.axis.ticks(y.range) {
        let at = y.place(tick.position);
        body += &segment((left, at), (right, at), "#e6e6e6");
        body += &text(&tick.label, (left - 6.0, at + 4.0), (11, "end"));
    }
    body + &segment((left, top), (left, bottom), "#2b2b2b") + &segment((left, bottom), (right, bottom), "#2b2b2b")
}

fn text(content: &str, (x, y): (f64, f64), (size, anchor): (u32, &str)) -> String {
    let content = escaped(content);
    format!("<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" text-anchor=\"{anchor}\">{content}</text>\n")
}

fn segment((x1, y1): (f64, f64), (x2, y2): (f64, f64), color: &str) -> String {
    format!("<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"{color}\"/>\n")
}

fn line(points: &[(f64, f64)], style: Style) -> String {
    let dashes = match style.stroke {
        Stroke::Nothing => return String::new(),
        Stroke::Solid => "",
        Stroke::Dash => " stroke-dasharray=\"8 4\"",
        Stroke::Dot => " stroke-dasharray=\"2 3\"",
    };
    let points: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let color = style.css();
    let points = points.join(" ");
    format!("<polyline points=\"{points}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\"{dashes}/>\n")
}

/// The series' marker, if it has one. An outlined one is white inside, so that no line shows through.
fn mark((x, y): (f64, f64), style: Style) -> String {
    let Some(marker) = style.marker else { return String::new() };
    let color = style.css();
    let fill = if style.filled { &color } else { "#ffffff" };
    let path = marker.path();
    format!(
        "<path class=\"mark\" d=\"{path}\" transform=\"translate({x:.1} {y:.1})\" fill=\"{fill}\" stroke=\"{color}\" \
         stroke-width=\"2\"/>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::tests::example;

    #[test]
    fn text_is_escaped() {
        assert_eq!(escaped("<a href=\"x\">'&'</a>"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;&lt;/a&gt;");
    }

    #[test]
    fn an_svg_file_shows_all_and_keeps_text_as_text() {
        let svg = figure(&example(), Size { width: 800, row: 300 });
        assert!(svg.starts_with("<svg width=\"800\" height=\"364\""), "{}", &svg[..80]);
        for text in ["An &lt;example&gt;", "one &amp; all", "other", "left", "right", "time", "error"] {
            assert!(svg.contains(&format!(">{text}</text>")), "{text}");
        }
        // Four points in each panel, and two series in the legend.
        assert_eq!(svg.matches("class=\"mark\"").count(), 8 + 2);
        // Ticks of both axes.
        for label in [">1</text>", ">0.1</text>"] {
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
        let svg = figure(&example, Size { width: 150, row: 300 });
        assert!(svg.starts_with("<svg width=\"150\" height=\"384\""), "{}", &svg[..80]);
    }

    #[test]
    fn every_point_of_a_panel_can_be_hit() {
        let example = example();
        let svg = panel_with_hits(&example, &example.panels[0], Size { width: 300, row: 280 });
        assert!(svg.starts_with("<svg width=\"300\" height=\"280\"") && svg.ends_with("</svg>\n"), "{svg}");
        assert_eq!(svg.matches("class=\"hit\"").count(), 4);
        assert!(svg.contains("data-label=\"&lt;1&gt; &amp; 0.01\""));
    }

    #[test]
    fn values_lie_where_the_axis_says() {
        let axis = Axis::log("");
        let scale = Scale { axis: &axis, range: (-2.0, 2.0), pixels: (100.0, 500.0) };
        for (value, expected) in [(0.01, 100.0), (1.0, 300.0), (100.0, 500.0)] {
            assert!((scale.value(value) - expected).abs() < 1e-9, "{value}");
        }
    }
}
