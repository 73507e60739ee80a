//! The page of the filters of images.

use super::charts::gray;
use super::tables::{capital, number};
use super::{NamedFile, ReportError, figure_file, highlights};
use crate::figure::{Axis, AxisScale, Figure, Marker, Panel, Point, Series, Stroke, Style};
use crate::filters::{
    FILTERS, FilterFigures, FilterPlan, FilterView, MeasuredFilters, MeasuredHighlights, highlights as measured, sweep,
};
use crate::measure::{MeasureError, MeasureProgress};
use crate::page::{Page, PageTable, Section, csv, html};
use crate::timing::{Machine, Spread};

/// What filters of images cost and lose.
#[derive(Clone, Debug)]
pub struct Filters {
    /// How much was measured.
    pub plan: FilterPlan,
    /// What was found of each image.
    pub images: Vec<MeasuredFilters>,
    /// What was found of highlights of each rough surface.
    pub highlights: Vec<MeasuredHighlights>,
    facts: Vec<(String, String)>,
}

/// A quantity that is charted against time.
type Quantity = (&'static str, &'static str, fn(&FilterFigures) -> f64);

const QUANTITIES: [Quantity; 3] = [
    ("rms", "RMS error, steps of 1/255", |figures| figures.rms),
    ("shimmer", "shimmer, steps of 1/255", |figures| figures.shimmer),
    ("flip", "mean ꟻLIP", |figures| figures.flip),
];

const LEAD: &str = "A pixel sees more than one texel where an image is reduced. What it should show is the mean of all that it \
                    sees; what a filter makes of a few lookups is more or less near to that, and flickers more or less while \
                    the camera moves. Down is nearer to the truth, left is faster.";

impl Filters {
    /// Measures; `progress` hears of [`FilterPlan::units`].
    ///
    /// # Errors
    /// What cannot be drawn, or a picture that cannot be put on the page.
    pub fn measure(plan: FilterPlan, progress: &mut MeasureProgress<'_>) -> Result<Self, MeasureError> {
        let (images, highlights) = (sweep(&plan, progress)?, measured(&plan, progress)?);
        Ok(Self { plan, images, highlights, facts: Machine::processor() })
    }

    /// The page `filters.html`, the charts and the tables.
    ///
    /// # Errors
    /// What could not be drawn.
    pub fn files(&self) -> Result<Vec<NamedFile>, ReportError> {
        let figures: Vec<Figure> = QUANTITIES.into_iter().map(|quantity| self.figure(quantity)).collect();
        let of_highlights = highlights::figures(&self.highlights);
        let page = Page {
            title: "Texture filters".to_owned(),
            lead: LEAD.to_owned(),
            facts: self.facts(),
            sections: self
                .sections(&figures)
                .into_iter()
                .chain([highlights::section(&self.highlights, &of_highlights)])
                .collect(),
            points: None,
        };
        let mut files = vec![
            ("filters.html".to_owned(), html(&page)?),
            ("filters.csv".to_owned(), self.csv()),
            ("highlights.csv".to_owned(), highlights::file(&self.highlights)),
        ];
        for figure in figures.iter().chain(&of_highlights) {
            files.push(figure_file(figure)?);
        }
        Ok(files)
    }

    /// The findings and tables in Markdown.
    pub fn markdown(&self) -> String {
        let facts: Vec<String> = self.facts().iter().map(|(name, value)| format!("{name}: {value}")).collect();
        let head = "# Texture filters\n\nMade by `cargo xtask chart --filters`; [charts.md](charts.md#texture-filters) says \
                    what is measured.";
        let mut blocks = vec![head.to_owned(), facts.join("; ") + "."];
        for image in &self.images {
            blocks.push(format!("## {}", capital(image.image.name())));
            blocks.extend(findings(image));
            blocks.extend([figures_table(image), views_table(image)].iter().flat_map(in_markdown));
        }
        blocks.push(format!("## {}", highlights::TITLE));
        blocks.extend(highlights::text());
        blocks.extend(highlights::tables(&self.highlights).iter().flat_map(in_markdown));
        blocks.join("\n\n") + "\n"
    }

    fn facts(&self) -> Vec<(String, String)> {
        let FilterPlan { size: [width, height], frames, rounds, tolerance } = self.plan;
        let mut facts = self.facts.clone();
        facts.extend([
            ("pictures".to_owned(), format!("{width} × {height} pixels")),
            ("frames of the moving camera".to_owned(), frames.to_string()),
            ("rounds".to_owned(), rounds.to_string()),
            ("tolerance of the truth".to_owned(), tolerance.to_string()),
        ]);
        facts
    }

    fn sections(&self, figures: &[Figure]) -> Vec<Section> {
        let charts = Section {
            title: "Error against time".to_owned(),
            scene: None,
            text: vec![
                "Truth is the mean of the image’s texels over what a pixel covers, integrated. Errors are in steps of 1/255 of \
                 the sRGB curve, not rounded, over eight views of a plane: from above, at 45°, 70° and 85° from its normal, \
                 each upright and turned by 30°. Shimmer is the RMS of what changes from frame to frame of a moving camera, \
                 less what changes in the truth."
                    .to_owned(),
                "Time is that of a lookup in f32 on the CPU, over the bilinear filter’s in the same round: medians of rounds \
                 in which the filters take turns, with bars from quartile to quartile. The line joins what nothing beats; what is \
                 pale is beaten."
                    .to_owned(),
            ],
            pictures: Vec::new(),
            figures: QUANTITIES.iter().zip(figures).map(|((_, name, _), figure)| ((*name).to_owned(), figure.clone())).collect(),
            tables: Vec::new(),
            files: figures
                .iter()
                .map(|figure| (format!("{} (SVG)", figure.title), format!("{}.svg", figure.id)))
                .chain([("every figure (CSV)".to_owned(), "filters.csv".to_owned())])
                .collect(),
        };
        let of_image = |image: &MeasuredFilters| Section {
            title: capital(image.image.name()),
            scene: None,
            text: findings(image),
            pictures: std::iter::once(("truth".to_owned(), image.truth.clone()))
                .chain(
                    FILTERS
                        .iter()
                        .zip(&image.figures)
                        .map(|(of, figures)| (of.name.to_owned(), figures.picture.clone())),
                )
                .collect(),
            figures: Vec::new(),
            tables: vec![figures_table(image), views_table(image)],
            files: Vec::new(),
        };
        std::iter::once(charts).chain(self.images.iter().map(of_image)).collect()
    }

    fn figure(&self, (id, label, error): Quantity) -> Figure {
        Figure {
            id: format!("filters-{id}"),
            title: format!("{} against time", capital(label)),
            x: Axis::new("time of a lookup (bilinear = 1)", AxisScale::Log),
            y: Axis::new(label, AxisScale::Log),
            columns: 3,
            panels: self.images.iter().map(|image| panel(image, error)).collect(),
        }
    }

    fn csv(&self) -> String {
        let header = [
            "image",
            "filter",
            "RMS (steps)",
            "mean ꟻLIP",
            "shimmer (steps)",
            "time (bilinear = 1)",
            "lower quartile",
            "upper quartile",
            "lookup, median (ns)",
            "lookup, least (ns)",
            "memory (image = 1)",
        ];
        let rows = self.images.iter().flat_map(|image| {
            FILTERS.iter().zip(&image.figures).map(|(of, found)| {
                let Spread { median, lower_quartile, upper_quartile, .. } = found.ratio;
                let numbers = [
                    found.rms,
                    found.flip,
                    found.shimmer,
                    median,
                    lower_quartile,
                    upper_quartile,
                    found.ns.median,
                    found.ns.min,
                    of.memory,
                ]
                .map(number);
                let [a, b, c, d, e, f, g, h, i] = numbers;
                [image.image.name().to_owned(), of.name.to_owned(), a, b, c, d, e, f, g, h, i]
            })
        });
        csv(header, rows)
    }
}

/// Its caption and its lines.
fn in_markdown(table: &PageTable) -> [String; 2] {
    let line = |cells: &Vec<String>| format!("| {} |", cells.join(" | "));
    let rule = format!("|{}", "---|".repeat(table.header.len()));
    let lines = [line(&table.header), rule].into_iter().chain(table.rows.iter().map(line));
    [format!("{}:", table.caption), lines.collect::<Vec<_>>().join("\n")]
}

/// What wins where, in sentences.
fn findings(image: &MeasuredFilters) -> Vec<String> {
    let told = |what: &str, error: fn(&FilterFigures) -> f64| {
        let part = |&i: &usize| {
            format!("{} at {:.2} × ({:.2})", FILTERS[i].name, image.figures[i].ratio.median, error(&image.figures[i]))
        };
        let parts: Vec<String> = image.front(error).iter().map(part).collect();
        format!("{what}, nothing beats {}.", parts.join("; then "))
    };
    vec![
        told("By RMS error, in steps of 1/255", |figures| figures.rms),
        told("By shimmer, in such steps", |figures| figures.shimmer),
    ]
}

fn figures_table(image: &MeasuredFilters) -> PageTable {
    let header =
        ["filter", "RMS", "mean ꟻLIP", "shimmer", "time, bilinear = 1", "quartiles", "least, ns", "memory, image = 1"];
    let rows = FILTERS.iter().zip(&image.figures).map(|(of, found)| {
        vec![
            of.name.to_owned(),
            format!("{:.2}", found.rms),
            format!("{:.4}", found.flip),
            format!("{:.2}", found.shimmer),
            format!("{:.2}", found.ratio.median),
            format!("{:.2}–{:.2}", found.ratio.lower_quartile, found.ratio.upper_quartile),
            format!("{:.0}", found.ns.min),
            format!("{:.2}", of.memory),
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
    let rows = FILTERS.iter().zip(&image.figures).map(|(of, found)| {
        std::iter::once(of.name.to_owned()).chain(found.rms_by_view.iter().map(|rms| format!("{rms:.2}"))).collect()
    });
    PageTable {
        caption: "RMS error by the angle between view and normal, in steps of 1/255".to_owned(),
        names: 1,
        header: header.collect(),
        rows: rows.collect(),
    }
}

fn panel(image: &MeasuredFilters, error: fn(&FilterFigures) -> f64) -> Panel {
    let front = image.front(error);
    let point = |i: usize| {
        let found = &image.figures[i];
        let Spread { median, lower_quartile, upper_quartile, .. } = found.ratio;
        let label = format!("{}: {median:.2} ×, {:.3}", FILTERS[i].name, error(found));
        let quartiles = Some((lower_quartile, upper_quartile));
        Point { quartiles, faded: !front.contains(&i), ..Point::new(median, error(found), label) }
    };
    // In steps: a time buys the least error of what takes no longer.
    let mut line: Vec<Point> = Vec::new();
    for &i in &front {
        let point = Point { quartiles: None, ..point(i) };
        let corner = line.last().map(|last| Point { x: point.x, ..last.clone() });
        line.extend(corner.into_iter().chain([point]));
    }
    let line = Series { name: "front".to_owned(), style: gray(0x55), points: line };
    let filters = FILTERS.iter().enumerate().map(|(i, of)| Series {
        name: of.name.to_owned(),
        style: style(i),
        points: vec![point(i)],
    });
    Panel {
        title: image.image.name().to_owned(),
        x_label: None,
        notes: Vec::new(),
        series: std::iter::once(line).chain(filters).collect(),
    }
}

/// Colours that colour-blind readers tell apart (Okabe and Ito, "Color Universal Design", 2008), filled for the first
/// of them and outlined for the second; no two filters have both colour and marker in common.
fn style(filter: usize) -> Style {
    const COLORS: [[u8; 3]; 7] = [
        [0x8a, 0x8a, 0x8a],
        [0xd5, 0x5e, 0x00],
        [0x00, 0x72, 0xb2],
        [0x00, 0x9e, 0x73],
        [0xcc, 0x79, 0xa7],
        [0xe6, 0x9f, 0x00],
        [0x56, 0xb4, 0xe9],
    ];
    const MARKERS: [Marker; 6] =
        [Marker::Diamond, Marker::Square, Marker::Triangle, Marker::Circle, Marker::Wedge, Marker::Star];
    Style {
        color: COLORS[filter % COLORS.len()],
        marker: Some(MARKERS[filter % MARKERS.len()]),
        filled: filter < COLORS.len(),
        stroke: Stroke::Nothing,
    }
}
