//! Error against time: the points, their fronts, and what to choose.

use halfway::reference::metrics::PERCENTILES;
use serde_json::{Value, json};

use super::tables::{capital, files, number};
use super::{NamedFile, ReportError, figure_file};
use crate::figure::svg::{self, Size};
use crate::figure::{Axis, AxisScale, Figure, Marker, Panel, Point, Series, Stroke, Style};
use crate::front::{
    Area, AreaErrors, BestWithin, ChartedAdapter, ChartedScene, Family, Front, FrontPlan, FrontPoint, KeptResults,
    MeasuredScene, sweep,
};
use crate::measure::{MeasureError, MeasureProgress};
use crate::page::{Page, PageTable, Section, csv, html};
use crate::timing::{FRAME_TIME, Machine, Spread};

/// The points of every scene, and what drew them.
#[derive(Clone, Debug)]
pub struct Fronts {
    /// How much was measured.
    pub plan: FrontPlan,
    /// Each adapter by the name that it was opened by, with the machine.
    pub machines: Vec<(String, Machine)>,
    /// Every scene.
    pub scenes: Vec<MeasuredScene>,
}

/// What the page is about.
pub(super) const LEAD: &str = "Flat shading evaluates the lighting once a triangle, Gouraud shading once a vertex, Phong \
                               shading once a pixel, and mixtures each term at a place of its own. Each is drawn at \
                               several details, timed, and compared with the truth. Down is more accurate, left is faster. \
                               Point at a point to see its picture, the truth’s, the difference and every figure; click to \
                               keep them.";

/// The points of one scene on one adapter.
struct Panels<'a> {
    points: Vec<&'a FrontPoint>,
    /// The median of the reference frame's times in milliseconds, of which each point's turns had one.
    reference_ms: f64,
    covered: Front,
    whole: Front,
}

/// The error that fronts are of unless something else is said: RMS, in steps of 1/255, of the picture that is timed.
fn error(area: Area) -> impl Fn(&FrontPoint) -> f64 + Copy {
    move |point| point.errors.over(area).steps.rms
}

impl Fronts {
    /// Measures; `progress` hears of [`FrontPlan::units`].
    ///
    /// # Errors
    /// The first picture that could not be drawn.
    pub fn measure(
        plan: &FrontPlan,
        scenes: &[ChartedScene],
        adapters: &[ChartedAdapter],
        kept: &mut KeptResults,
        progress: &mut MeasureProgress<'_>,
    ) -> Result<Self, MeasureError> {
        let scenes = sweep(plan, scenes, adapters, kept, progress)?;
        let machine = |adapter: &ChartedAdapter| (adapter.name.clone(), Machine::new(&adapter.adapter));
        Ok(Self { plan: plan.clone(), machines: adapters.iter().map(machine).collect(), scenes })
    }

    /// The page `index.html`, and beside it `chart.json`, the points and the tables as CSV, and the charts as SVG.
    ///
    /// # Errors
    /// What could not be drawn.
    pub fn files(&self) -> Result<Vec<NamedFile>, ReportError> {
        let names: Vec<&str> = self.scenes.iter().map(|scene| scene.name.as_str()).collect();
        let page = Page {
            title: format!("Error against time: {}", names.join(", ")),
            lead: match &self.scenes[..] {
                [one] => self.advice(one).join(" "),
                _ => LEAD.to_owned(),
            },
            facts: self.facts(),
            sections: self.sections(),
            points: Some(self.on_page()),
        };
        let mut files = vec![("index.html".to_owned(), html(&page)?)];
        files.extend(self.tables());
        for (_, figure) in page.sections.iter().flat_map(|section| &section.figures) {
            files.push(figure_file(figure)?);
        }
        Ok(files)
    }

    /// What to choose for a scene, in words: a sentence for each adapter.
    pub fn advice(&self, scene: &MeasuredScene) -> Vec<String> {
        let told = self.machines.iter().map(|(backend, _)| {
            let choices = Panels::of(scene, backend).choices();
            let none = || "nothing errs by 8 steps of 255 or less".to_owned();
            let choices = if choices.is_empty() { none() } else { choices.join("; ") };
            format!("What to choose for {} on {backend}, by RMS error of covered pixels: {choices}.", scene.name)
        });
        told.collect()
    }

    /// What was measured on what.
    pub fn facts(&self) -> Vec<(String, String)> {
        let mut facts: Vec<(String, String)> = Vec::new();
        for (name, machine) in &self.machines {
            for (what, value) in machine.facts() {
                let what = if self.machines.len() > 1 && (what == "adapter" || what == "driver") {
                    format!("{what} {name}")
                } else {
                    what
                };
                if !facts.iter().any(|(other, _)| *other == what) {
                    facts.push((what, value));
                }
            }
        }
        facts.push(("rounds".to_owned(), self.plan.rounds.to_string()));
        facts
    }

    /// A section for each scene.
    pub(super) fn sections(&self) -> Vec<Section> {
        self.scenes.iter().map(|scene| self.section(scene)).chain([self.reading()]).collect()
    }

    /// How to read the charts.
    fn reading(&self) -> Section {
        Section {
            title: "How error and time are measured".to_owned(),
            scene: None,
            pictures: Vec::new(),
            text: vec![
                format!(
                    "Errors are those of the 8-bit picture that is timed, in steps of 1/255, against the reference \
                     renderer’s in double precision: over the pixels that both cover, or over the whole picture, \
                     silhouettes included and nothing made equal first, where the truth about a pixel is the mean of \
                     {0} × {0} samples. What is drawn with one sample a pixel is judged by its middle inside of \
                     surfaces. Errors of a picture in floating point stand beside.",
                    self.plan.samples
                ),
                format!(
                    "Times are medians over up to {} rounds, of two frames each, in which the methods take turns, \
                     each round begun by another one; bars reach from quartile to quartile. 1 is the reference frame: \
                     the scene’s coarsest detail in a constant colour, on the same adapter, in the same turns; milliseconds in the tables are multiples of its median. {FRAME_TIME}",
                    self.plan.rounds
                ),
                "The line joins what nothing beats: no other point is as fast and errs as little. What is pale is \
                 beaten by a point of the line. Points whose bars overlap are ties: another run may choose the other one."
                    .to_owned(),
            ],
            figures: Vec::new(),
            tables: Vec::new(),
            files: Vec::new(),
        }
    }

    fn section(&self, scene: &MeasuredScene) -> Section {
        let figure = self.figure(scene);
        let panels = self.machines.iter().map(|(backend, _)| (backend, Panels::of(scene, backend)));
        let (mut text, mut tables) = (Vec::new(), Vec::new());
        text.push(format!("{}. Errors are errors from {}.", capital(&scene.about), scene.truth));
        for (backend, panels) in panels {
            let sentence = panels.covered.sentence(&panels.points);
            text.push(if self.machines.len() > 1 { format!("On {backend}: {sentence}") } else { sentence });
            tables.extend(panels.tables(backend));
        }
        text.extend(self.advice(scene));
        Section {
            title: scene.name.clone(),
            scene: Some(scene.name.clone()),
            pictures: Vec::new(),
            text,
            files: files(&[("chart", &format!("front-{}", stem(&scene.name)))], &[("every point", "points")])
                .into_iter()
                .chain([("every point (JSON)".to_owned(), "chart.json".to_owned())])
                .collect(),
            figures: vec![(String::new(), figure)],
            tables,
        }
    }

    fn figure(&self, scene: &MeasuredScene) -> Figure {
        let panels = self.machines.iter().flat_map(|(backend, _)| {
            [(Area::Covered, "covered pixels"), (Area::Whole, "whole picture")].map(|(area, what)| {
                let panels = Panels::of(scene, backend);
                panel(&panels, area, format!("{what}, {backend}"))
            })
        });
        Figure {
            id: format!("front-{}", stem(&scene.name)),
            title: format!("{}: error against time", scene.name),
            x: Axis::new("time of a frame (reference frame = 1)", AxisScale::Log),
            y: Axis::new("RMS error, steps of 1/255", AxisScale::Log),
            columns: 2,
            panels: panels.collect(),
        }
    }

    /// The fronts of up to three scenes on the first adapter, for a narrow page, as SVG 900 pixels wide.
    ///
    /// # Errors
    /// What the drawing library has to say.
    pub fn small_chart(&self, names: &[&str]) -> Result<String, ReportError> {
        let Some((backend, machine)) = self.machines.first() else { return Ok(String::new()) };
        let scenes = self.scenes.iter().filter(|scene| names.contains(&scene.name.as_str()));
        let panels = scenes.map(|scene| panel(&Panels::of(scene, backend), Area::Covered, scene.name.clone()));
        let figure = Figure {
            id: "chart".to_owned(),
            title: format!("RMS error against the time of a frame, {}", machine.adapter),
            x: Axis::new("frame (reference frame = 1)", AxisScale::Log),
            y: Axis::new("RMS error, steps of 1/255", AxisScale::Log),
            columns: names.len().max(1),
            panels: panels.collect(),
        };
        Ok(svg::figure(&figure, Size { width: 900, row: 330 })?)
    }

    /// Who wins where, and both tables, for every scene, in Markdown.
    pub fn markdown(&self) -> String {
        let facts: Vec<String> = self.facts().iter().map(|(name, value)| format!("{name}: {value}")).collect();
        let head = "# Fronts\n\nMade by `cargo xtask chart`; [charts.md](charts.md) says what is measured. Sentences leave \
                    out what errs less than a fifth less than the point before; tables do not.";
        let mut blocks = vec![head.to_owned(), facts.join("; ") + "."];
        for scene in &self.scenes {
            let section = self.section(scene);
            blocks.push(format!("## {}", scene.name));
            blocks.extend(section.text);
            for PageTable { caption, header, rows, .. } in &section.tables {
                let line = |cells: &Vec<String>| format!("| {} |", cells.join(" | "));
                let rule = format!("|{}", "---|".repeat(header.len()));
                let lines = [line(header), rule].into_iter().chain(rows.iter().map(line));
                blocks.extend([format!("{caption}:"), lines.collect::<Vec<_>>().join("\n")]);
            }
        }
        blocks.join("\n\n") + "\n"
    }

    /// `chart.json`, and the points as CSV.
    pub(super) fn tables(&self) -> Vec<NamedFile> {
        let json = json!({
            "halfway": env!("CARGO_PKG_VERSION"),
            "machines": self.machines.iter().map(|(name, machine)| {
                json!({ "backend": name, "facts": machine.facts().into_iter().collect::<std::collections::BTreeMap<_, _>>() })
            }).collect::<Vec<_>>(),
            "points": self.points(),
        });
        vec![("chart.json".to_owned(), format!("{json:#}\n")), ("points.csv".to_owned(), self.csv())]
    }

    /// Every point with whether it is on the front of its scene and adapter.
    fn points(&self) -> Vec<Value> {
        let mut all = Vec::new();
        for scene in &self.scenes {
            for (backend, _) in &self.machines {
                let panels = Panels::of(scene, backend);
                all.extend(
                    panels
                        .points
                        .iter()
                        .enumerate()
                        .map(|(place, point)| json(point, panels.covered.has(place), panels.whole.has(place))),
                );
            }
        }
        all
    }

    /// What the page's script draws: the points, their pictures in the same order, and the scenes.
    pub(super) fn on_page(&self) -> Value {
        let of_adapters = |scene: &'_ MeasuredScene| -> Vec<[String; 2]> {
            let here = |backend: &String| Panels::of(scene, backend).points;
            let points =
                self.machines.iter().flat_map(|(backend, _)| here(backend).into_iter().cloned().collect::<Vec<_>>());
            points.map(|point| [point.picture, point.difference]).collect()
        };
        json!({
            "points": self.points(),
            "pictures": self.scenes.iter().flat_map(of_adapters).collect::<Vec<_>>(),
            "scenes": self.scenes.iter().map(|scene| {
                json!({ "name": scene.name, "about": scene.about, "picture": scene.picture })
            }).collect::<Vec<_>>(),
        })
    }

    fn csv(&self) -> String {
        let header = [
            "scene",
            "method",
            "detail",
            "triangles",
            "adapter",
            "frame (ms)",
            "lower quartile (ms)",
            "upper quartile (ms)",
            "frame (reference = 1)",
            "lower quartile (reference = 1)",
            "upper quartile (reference = 1)",
            "RMS (steps, covered)",
            "95 % (steps, covered)",
            "max (steps, covered)",
            "mean ꟻLIP (covered)",
            "RMS (steps, whole)",
            "95 % (steps, whole)",
            "max (steps, whole)",
            "mean ꟻLIP (whole)",
            "RMS (linear, covered)",
            "RMS (linear, whole)",
        ];
        csv(header, self.scenes.iter().flat_map(|scene| &scene.points).map(row))
    }
}

fn row(point: &FrontPoint) -> [String; 21] {
    let FrontPoint { ms, ratio, errors: e, .. } = point;
    [
        point.scene.clone(),
        point.method.clone(),
        point.detail.clone(),
        point.triangles.to_string(),
        point.backend.clone(),
        number(ms.median),
        number(ms.lower_quartile),
        number(ms.upper_quartile),
        number(ratio.median),
        number(ratio.lower_quartile),
        number(ratio.upper_quartile),
        number(e.covered.steps.rms),
        number(e.covered.steps.p95),
        number(e.covered.steps.max),
        number(e.covered.flip),
        number(e.whole.steps.rms),
        number(e.whole.steps.p95),
        number(e.whole.steps.max),
        number(e.whole.flip),
        number(e.covered.linear.rms),
        number(e.whole.linear.rms),
    ]
}

fn json(point: &FrontPoint, front: bool, front_whole: bool) -> Value {
    const { assert!(PERCENTILES[1] == 95.0, "p95 is what it says") };
    let area = |errors: &AreaErrors| {
        let AreaErrors { steps, linear, flip } = errors;
        json!({
            "rms": steps.rms, "max": steps.max, "p95": steps.p95, "flip": flip,
            "float": { "rms": linear.rms, "max": linear.max, "p95": linear.p95 },
        })
    };
    let mut json = area(&point.errors.covered);
    json["whole"] = area(&point.errors.whole);
    let rest = json!({
        "scene": point.scene, "method": point.method, "words": point.words, "family": point.family,
        "tolerance": point.tolerance, "tessellation": point.detail, "detail": point.detail_words,
        "triangles": point.triangles, "backend": point.backend,
        "ms": point.ms.median, "ms_quartiles": [point.ms.lower_quartile, point.ms.upper_quartile],
        "ratio": point.ratio.median, "ratio_quartiles": [point.ratio.lower_quartile, point.ratio.upper_quartile],
        "front": front, "front_whole": front_whole, "command": point.command,
    });
    if let (Some(json), Value::Object(rest)) = (json.as_object_mut(), rest) {
        json.extend(rest);
    }
    json
}

impl<'a> Panels<'a> {
    fn of(scene: &'a MeasuredScene, backend: &str) -> Self {
        let points: Vec<&FrontPoint> = scene.points.iter().filter(|point| point.backend == backend).collect();
        let [covered, whole] = [Area::Covered, Area::Whole].map(|area| Front::of(&points, error(area)));
        let references: Vec<f64> = points.iter().map(|point| point.ms.median / point.ratio.median).collect();
        Self { reference_ms: Spread::of(&references).median, points, covered, whole }
    }

    fn front(&self, area: Area) -> &Front {
        match area {
            Area::Covered => &self.covered,
            Area::Whole => &self.whole,
        }
    }

    /// The milliseconds of what takes so much of the reference frame. Points are measured one after the other, while a
    /// machine may become faster or slower: only times in one unit compare.
    fn ms(&self, point: &FrontPoint) -> f64 {
        point.ratio.median * self.reference_ms
    }

    /// The fastest point for each error, those that serve for several errors told once, by the least of them.
    fn choices(&self) -> Vec<String> {
        let choices = self.covered.least_times();
        let runs = choices.chunk_by(|a, b| a.best == b.best);
        let told = runs.filter_map(|run| {
            let BestWithin { limit, best } = *run.last()?;
            let point = self.points[best?];
            let FrontPoint { words, detail_words, .. } = point;
            Some(format!("at most {limit} of 255 steps: {words}, {detail_words}, {:.2} ms", self.ms(point)))
        });
        told.collect()
    }

    /// What an error costs, and what a time buys.
    fn tables(&self, backend: &str) -> [PageTable; 2] {
        let header = |limit: &str, bought: &str| {
            let each = ["covered pixels", "whole picture"].map(|area| format!("{bought}, {area}"));
            [limit.to_owned()].into_iter().chain(each).collect::<Vec<_>>()
        };
        let fronts = [&self.covered, &self.whole];
        let nothing = || "–".to_owned();
        let time = |best: Option<usize>| {
            best.map_or_else(nothing, |i| {
                let point = self.points[i];
                format!(
                    "{:.2} × ({:.2} ms): {}, {}",
                    point.ratio.median,
                    self.ms(point),
                    point.words,
                    point.detail_words
                )
            })
        };
        let error = |front: &Front, best: Option<usize>| {
            best.map_or_else(nothing, |i| {
                let point = self.points[i];
                format!("{:.2} steps: {}, {}", front.error(i), point.words, point.detail_words)
            })
        };
        let least = fronts.map(Front::least_times);
        let bought = fronts.map(|front| front.least_errors(&self.points));
        let rows = (0..least[0].len()).map(|i| {
            let [a, b] = least.map(|choices| time(choices[i].best));
            let limit = least[0][i].limit.to_string();
            vec![format!("{limit} {}", if limit == "1" { "step" } else { "steps" }), a, b]
        });
        let costs = PageTable {
            caption: format!("For this RMS error at most, the least time ({backend})"),
            names: 3,
            header: header("error", "least time"),
            rows: rows.collect(),
        };
        let rows = (0..bought[0].len()).map(|i| {
            let [a, b] = [0, 1].map(|k| error(fronts[k], bought[k][i].best));
            vec![format!("{} ×", bought[0][i].limit), a, b]
        });
        let buys = PageTable {
            caption: format!("For this time at most, the least RMS error ({backend}; the reference frame is 1)"),
            names: 3,
            header: header("time", "least error"),
            rows: rows.collect(),
        };
        [costs, buys]
    }
}

/// The points by family, those that are beaten pale, and the front as a line.
fn panel(panels: &Panels<'_>, area: Area, title: String) -> Panel {
    let front = panels.front(area);
    let at = |i: usize, faded: bool| {
        let point = panels.points[i];
        let label = format!("{}: {:.2} ×, {:.2} steps", point.describe(), point.ratio.median, front.error(i));
        let quartiles = Some((point.ratio.lower_quartile, point.ratio.upper_quartile));
        Point { quartiles, faded, ..Point::new(point.ratio.median, front.error(i), label) }
    };
    // In steps: a time buys the least error of what takes no longer.
    let mut line: Vec<Point> = Vec::new();
    for &i in &front.members {
        let point = Point { quartiles: None, ..at(i, false) };
        let corner = line.last().map(|last| Point { x: point.x, ..last.clone() });
        line.extend(corner.into_iter().chain([point]));
    }
    let line = Series { name: "front".to_owned(), style: super::charts::gray(0x55), points: line };
    let families = Family::ALL.into_iter().map(|family| {
        let here = (0..panels.points.len()).filter(|&i| panels.points[i].family == family.name());
        let mut points: Vec<Point> = here.map(|i| at(i, !front.has(i))).collect();
        points.sort_by_key(|point| !point.faded);
        Series { name: family.name().to_owned(), style: style(family), points }
    });
    let series = std::iter::once(line).chain(families.filter(|series| !series.points.is_empty()));
    Panel { title, x_label: None, notes: Vec::new(), series: series.collect() }
}

/// Colours that colour-blind readers tell apart (Okabe and Ito, "Color Universal Design", 2008), with markers of their
/// own.
pub(super) fn style(family: Family) -> Style {
    let (color, marker) = match family {
        Family::Constant => ([0x8a, 0x8a, 0x8a], Marker::Diamond),
        Family::Flat => ([0xd5, 0x5e, 0x00], Marker::Square),
        Family::Gouraud => ([0x00, 0x72, 0xb2], Marker::Triangle),
        Family::Phong => ([0x00, 0x9e, 0x73], Marker::Circle),
        Family::Mixed => ([0xcc, 0x79, 0xa7], Marker::Wedge),
        Family::Auto => ([0xe6, 0x9f, 0x00], Marker::Star),
    };
    Style { color, marker: Some(marker), filled: true, stroke: Stroke::Nothing }
}

/// A scene's name as a part of a file's: what may trouble a file system is a hyphen.
fn stem(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() { c.to_ascii_lowercase() } else { '-' }).collect()
}
