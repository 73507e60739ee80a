//! The page of error against time, and `chart.json`.

use serde_json::json;

use super::{
    AreaErrors, ChartedAdapter, ChartedScene, ErrorFigures, Family, FrontPlan, FrontPoint, MeasuredScene, PointErrors,
    sweep,
};
use crate::error::ChartError;
use crate::figure::svg::{self, Size};
use crate::figure::{Axis, Figure, Marker, Panel, Point, Series, Stroke, Style, colors};
use crate::page::{Card, NamedFile, Page, PageTable, Section, capital};
use crate::pareto::front_panel;
use crate::progress::Progress;
use crate::timing::{FRAME_TIME, Machine, Spread};

/// The points of every scene, and the machines.
#[derive(Clone, Debug)]
pub struct Fronts {
    /// The extent of the measurements.
    pub plan: FrontPlan,
    /// Each adapter by the name that it was opened by, with the machine.
    pub machines: Vec<(String, Machine)>,
    /// Every scene.
    pub scenes: Vec<MeasuredScene>,
}

const LEAD: &str = "Flat shading evaluates the lighting once a triangle, Gouraud shading once a vertex, Phong shading once \
                    a pixel, and mixtures each term at a place of its own. Each is drawn at several details, timed, and \
                    compared with the truth. Down is more accurate, left is faster. Point at a point to see its picture, the \
                    truth’s, the difference and every figure, click to keep them; click an entry of the legend to hide it.";
/// The errors for which the fastest method is listed, in steps of 1/255.
const ERROR_STEPS: [f64; 5] = [8.0, 4.0, 2.0, 1.0, 0.5];

/// The pixels that count: the name of the area, and its errors.
type Area = (&'static str, fn(&PointErrors) -> &AreaErrors);

const COVERED: Area = ("covered pixels", |errors| &errors.covered);
const WHOLE: Area = ("whole picture", |errors| &errors.whole);

/// An error that is charted: the end of the figure's name, the name of its button, the axis, and the value.
type Measure = (&'static str, &'static str, &'static str, fn(&AreaErrors) -> f64);

const RMS: Measure = ("rms", "RMS", "RMS error, steps of 1/255", |errors| errors.steps.rms);
const MEASURES: [Measure; 4] = [
    RMS,
    ("p95", "95 %", "what 95 % keep to, steps of 1/255", |errors| errors.steps.p95),
    ("largest", "largest", "largest error, steps of 1/255", |errors| errors.steps.max),
    ("flip", "ꟻLIP", "mean ꟻLIP", |errors| errors.flip),
];

impl Fronts {
    /// Measures; `progress` counts [`FrontPlan::units`].
    ///
    /// # Errors
    /// The first picture that could not be drawn.
    pub fn measure(
        plan: &FrontPlan,
        scenes: &[ChartedScene],
        adapters: &[ChartedAdapter],
        progress: &mut Progress<'_>,
    ) -> Result<Self, ChartError> {
        let scenes = sweep(plan, scenes, adapters, progress)?;
        let machine = |adapter: &ChartedAdapter| (adapter.name.clone(), Machine::new(&adapter.adapter));
        Ok(Self { plan: plan.clone(), machines: adapters.iter().map(machine).collect(), scenes })
    }

    /// The page `index.html` with a section for each scene, and `chart.json` beside it.
    pub fn page(&self) -> Page {
        let names: Vec<&str> = self.scenes.iter().map(|scene| scene.name.as_str()).collect();
        Page {
            file: "index.html".to_owned(),
            title: format!("Error against time: {}", names.join(", ")),
            lead: match &self.scenes[..] {
                [one] => self.advice(one).join(" "),
                _ => LEAD.to_owned(),
            },
            facts: self.facts(),
            sections: self.scenes.iter().map(|scene| self.section(scene)).chain([self.reading()]).collect(),
            cards: self.points().map(|point| self.card(point)).collect(),
            images: self.images(),
            beside: vec![self.chart_json()],
        }
    }

    /// The recommendation for a scene, in words: a sentence for each adapter.
    pub fn advice(&self, scene: &MeasuredScene) -> Vec<String> {
        let told = self.machines.iter().map(|(adapter, _)| {
            let choices = choices(&points_on(scene, adapter));
            let choices = if choices.is_empty() { "no method reaches 8 steps of 255".to_owned() } else { choices };
            format!("What to choose for {} on {adapter}, by RMS error of covered pixels: {choices}.", scene.name)
        });
        told.collect()
    }

    /// The fronts of some scenes on the first adapter, for a narrow page, as SVG 900 pixels wide.
    pub fn small_chart(&self, names: &[&str]) -> String {
        let Some((adapter, machine)) = self.machines.first() else { return String::new() };
        let scenes = self.scenes.iter().filter(|scene| names.contains(&scene.name.as_str()));
        let panels = scenes.map(|scene| panel(scene.name.clone(), &points_on(scene, adapter), COVERED, RMS));
        let title = format!("RMS error against the time of a frame, {}", machine.adapter);
        let axes = [Axis::log("frame (reference frame = 1)"), Axis::log("RMS error, steps of 1/255")];
        svg::figure(&Figure::new("chart", title, axes, panels.collect()), Size { width: 900, row: 330 })
    }

    /// The machine and the extent of the measurements.
    fn facts(&self) -> Vec<(String, String)> {
        let mut facts: Vec<(String, String)> = Vec::new();
        for (name, machine) in &self.machines {
            for (what, value) in machine.facts() {
                let of_adapter = self.machines.len() > 1 && (what == "adapter" || what == "driver");
                let what = if of_adapter { format!("{what} {name}") } else { what };
                if !facts.iter().any(|(other, _)| *other == what) {
                    facts.push((what, value));
                }
            }
        }
        facts.push(("rounds".to_owned(), self.plan.rounds.to_string()));
        facts
    }

    /// How to read the charts.
    fn reading(&self) -> Section {
        Section {
            title: "How error and time are measured".to_owned(),
            text: vec![
                format!(
                    "Errors are those of the 8-bit picture that is timed, in steps of 1/255, against the reference \
                     renderer’s in double precision: over the pixels that both cover, or over the whole picture, \
                     silhouettes included and nothing made equal first, where the truth about a pixel is the mean of \
                     {0} × {0} samples. Pictures with one sample a pixel are compared at pixel centres inside \
                     surfaces.",
                    self.plan.samples
                ),
                format!(
                    "Times are medians over up to {} rounds of two frames each, in which the methods take turns and \
                     each round begins with another one; bars reach from quartile to quartile. 1 is the reference frame: \
                     the scene’s coarsest detail in a constant colour, on the same adapter, in the same turns; \
                     milliseconds in the tables are multiples of its median. {FRAME_TIME}",
                    self.plan.rounds
                ),
                "The line is the Pareto front; pale points are dominated: another point is faster and more accurate. \
                 Points whose bars overlap are ties: another run may choose the other one."
                    .to_owned(),
            ],
            links: vec![("all figures, as JSON".to_owned(), "chart.json".to_owned())],
            ..Section::default()
        }
    }

    fn section(&self, scene: &MeasuredScene) -> Section {
        let mut text = vec![format!("{}. Errors are errors from {}.", capital(&scene.about), scene.truth)];
        text.extend(self.advice(scene));
        let tables = self.machines.iter().flat_map(|(adapter, _)| {
            let points = points_on(scene, adapter);
            [COVERED, WHOLE].map(|area| table(adapter, &points, area))
        });
        Section {
            title: scene.name.clone(),
            text,
            figures: MEASURES.map(|measure| self.figure(scene, measure)).into(),
            tables: tables.collect(),
            ..Section::default()
        }
    }

    fn figure(&self, scene: &MeasuredScene, measure: Measure) -> Figure {
        let panels = self.machines.iter().flat_map(|(adapter, _)| {
            let points = points_on(scene, adapter);
            [COVERED, WHOLE].map(|area| panel(format!("{}, {adapter}", area.0), &points, area, measure))
        });
        let (end, name, label, _) = measure;
        let axes = [Axis::log("time of a frame (reference frame = 1)"), Axis::log(label)];
        let id = format!("front-{}-{end}", self.file_stem(scene));
        Figure::new(id, format!("{}: {label} against time", scene.name), axes, panels.collect()).named(name)
    }

    /// A scene's name as a part of a file name, without the folder if that is unambiguous; characters that may trouble
    /// a file system become hyphens.
    fn file_stem(&self, scene: &MeasuredScene) -> String {
        let last = |name: &str| name.rsplit(['/', '\\']).next().unwrap_or(name).to_owned();
        let alike = self.scenes.iter().filter(|other| last(&other.name) == last(&scene.name)).count();
        let name = if alike > 1 { scene.name.clone() } else { last(&scene.name) };
        name.chars().map(|c| if c.is_alphanumeric() { c.to_ascii_lowercase() } else { '-' }).collect()
    }

    fn points(&self) -> impl Iterator<Item = &FrontPoint> {
        self.scenes.iter().flat_map(|scene| &scene.points)
    }

    fn chart_json(&self) -> NamedFile {
        let machines = self.machines.iter().map(|(name, machine)| {
            let facts: std::collections::BTreeMap<_, _> = machine.facts().into_iter().collect();
            json!({ "adapter": name, "facts": facts })
        });
        let json = json!({
            "halfway": env!("CARGO_PKG_VERSION"),
            "machines": machines.collect::<Vec<_>>(),
            "points": self.points().collect::<Vec<_>>(),
        });
        ("chart.json".to_owned(), format!("{json:#}\n"))
    }

    /// Two pictures for each point, then the truth of each scene.
    fn images(&self) -> Vec<String> {
        let own = self.points().flat_map(|point| [&point.picture, &point.difference]);
        own.chain(self.scenes.iter().map(|scene| &scene.picture)).cloned().collect()
    }

    fn card(&self, point: &FrontPoint) -> Card {
        let place = point.place;
        let scene = self.scenes.iter().position(|scene| scene.name == point.scene).unwrap_or_default();
        let pictures = [("as drawn", 2 * place), ("the truth", 2 * self.points().count() + scene)];
        let pictures = pictures.into_iter().chain([("difference", 2 * place + 1)]);
        let spread = |spread: &Spread, unit: &str| {
            let Spread { median, lower_quartile, upper_quartile, .. } = spread;
            format!("{median:.2} {unit} ({lower_quartile:.2} … {upper_quartile:.2})")
        };
        let errors = [("covered", &point.errors.covered), ("whole picture", &point.errors.whole)];
        let errors = errors.map(|(area, AreaErrors { steps, flip })| {
            let ErrorFigures { rms, max, p95 } = steps;
            let steps = format!("RMS {rms:.3}, 95 % {p95:.3}, max {max:.3} steps; ꟻLIP {flip:.4}");
            (area.to_owned(), steps)
        });
        let times = [("frame", spread(&point.ms, "ms")), ("of the reference", spread(&point.ratio, "×"))];
        Card {
            title: point.describe(),
            pictures: pictures.map(|(caption, image)| (caption.to_owned(), image)).collect(),
            rows: times.into_iter().map(|(name, value)| (name.to_owned(), value)).chain(errors).collect(),
            command: point.command.clone(),
        }
    }
}

fn points_on<'a>(scene: &'a MeasuredScene, adapter: &str) -> Vec<&'a FrontPoint> {
    scene.points.iter().filter(|point| point.adapter == adapter).collect()
}

/// The milliseconds of the reference frame, the median over the points' turns. Points are measured one after the other,
/// while a machine may become faster or slower: only multiples of one time can be compared.
fn reference_ms(points: &[&FrontPoint]) -> f64 {
    let references: Vec<f64> = points.iter().map(|point| point.ms.median / point.ratio.median).collect();
    Spread::from_values(&references).median
}

/// The points of the front, the fastest first.
fn front<'a>(points: &[&'a FrontPoint], (_, area): Area) -> Vec<&'a FrontPoint> {
    let places: Vec<_> = points.iter().map(|point| point.time_and_error(area)).collect();
    crate::pareto::front(&places).into_iter().map(|place| points[place]).collect()
}

/// The fastest point for each of [`ERROR_STEPS`]; a point that serves for several errors is listed once, with the least
/// of them.
fn choices(points: &[&FrontPoint]) -> String {
    let front = front(points, COVERED);
    let reference_ms = reference_ms(points);
    let best = |limit: f64| front.iter().position(|point| point.errors.covered.steps.rms <= limit);
    let choices: Vec<(f64, usize)> = ERROR_STEPS.iter().filter_map(|&limit| Some((limit, best(limit)?))).collect();
    let told = choices.chunk_by(|a, b| a.1 == b.1).filter_map(|run| {
        let &(limit, best) = run.last()?;
        let FrontPoint { words, detail_words, ratio, .. } = front[best];
        Some(format!("at most {limit} of 255 steps: {words}, {detail_words}, {:.2} ms", ratio.median * reference_ms))
    });
    told.collect::<Vec<_>>().join("; ")
}

/// The front: the least error for each time, and the least time for each error.
fn table(adapter: &str, points: &[&FrontPoint], area: Area) -> PageTable {
    let reference_ms = reference_ms(points);
    let rows = front(points, area).into_iter().map(|point| {
        let (ratio, error) = point.time_and_error(area.1);
        let [method, detail] = [&point.words, &point.detail_words].map(String::clone);
        vec![method, detail, format!("{ratio:.2}"), format!("{:.2}", ratio * reference_ms), format!("{error:.2}")]
    });
    PageTable {
        caption: format!("The front of the {} ({adapter})", area.0),
        names: 2,
        header: ["method", "detail", "time (reference = 1)", "ms", "RMS error, steps"].map(str::to_owned).into(),
        rows: rows.collect(),
    }
}

/// The points by family.
fn panel(title: String, points: &[&FrontPoint], (_, area): Area, (.., error): Measure) -> Panel {
    let families = Family::ALL.map(|family| {
        let here = points.iter().filter(|point| point.family == family.name()).map(|point| {
            let quartiles = Some((point.ratio.lower_quartile, point.ratio.upper_quartile));
            let card = Some(point.place);
            Point { quartiles, card, ..Point::new(point.ratio.median, error(area(&point.errors)), point.describe()) }
        });
        Series { name: family.name().to_owned(), style: style(family), points: here.collect() }
    });
    front_panel(title, families.into())
}

/// Colours and markers of the families.
fn style(family: Family) -> Style {
    let (color, marker) = match family {
        Family::Constant => (colors::GRAY, Marker::Diamond),
        Family::Flat => (colors::RED, Marker::Square),
        Family::Gouraud => (colors::BLUE, Marker::Triangle),
        Family::Phong => (colors::GREEN, Marker::Circle),
        Family::Mixed => (colors::PURPLE, Marker::Wedge),
    };
    Style { color, marker: Some(marker), filled: true, stroke: Stroke::Nothing }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(method: &str, time: f64, error: f64, ms: f64) -> FrontPoint {
        let spread = |median: f64| Spread { median, ..Spread::default() };
        let errors =
            AreaErrors { steps: ErrorFigures { rms: error, ..ErrorFigures::default() }, ..AreaErrors::default() };
        FrontPoint {
            adapter: "cpu".to_owned(),
            words: method.to_owned(),
            detail_words: "8 cells".to_owned(),
            ratio: spread(time),
            ms: spread(ms),
            errors: PointErrors { covered: errors, whole: AreaErrors::default() },
            ..FrontPoint::default()
        }
    }

    #[test]
    fn advice_names_the_fastest_for_each_error_in_one_unit_of_time() {
        // The machine was half as fast while the first was measured.
        let points = vec![point("flat", 1.0, 5.0, 20.0), point("slow", 3.0, 5.0, 30.0), point("Phong", 2.0, 0.5, 20.0)];
        let scene = MeasuredScene { name: "sphere".to_owned(), points, ..MeasuredScene::default() };
        let machines = vec![("cpu".to_owned(), Machine::default())];
        let fronts = Fronts { plan: FrontPlan::QUICK, machines, scenes: vec![scene] };
        let expected = "What to choose for sphere on cpu, by RMS error of covered pixels: at most 8 of 255 steps: flat, \
                        8 cells, 10.00 ms; at most 0.5 of 255 steps: Phong, 8 cells, 20.00 ms.";
        assert_eq!(fronts.advice(&fronts.scenes[0]), [expected]);
        let rows = table("cpu", &points_on(&fronts.scenes[0], "cpu"), COVERED).rows;
        assert_eq!(rows, [["flat", "8 cells", "1.00", "10.00", "5.00"], ["Phong", "8 cells", "2.00", "20.00", "0.50"]]);
    }

    #[test]
    fn files_of_scenes_have_names_of_their_own() {
        let scenes = ["sphere", "a/Pot.obj", "b/Pot.obj", "a/cup.obj"];
        let scenes = scenes.map(|name| MeasuredScene { name: name.to_owned(), ..MeasuredScene::default() });
        let fronts = Fronts { plan: FrontPlan::QUICK, machines: Vec::new(), scenes: scenes.into() };
        let names: Vec<String> = fronts.scenes.iter().map(|scene| fronts.file_stem(scene)).collect();
        assert_eq!(names, ["sphere", "a-pot-obj", "b-pot-obj", "cup-obj"]);
    }
}
