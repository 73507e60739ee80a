//! The smallest sweep, and the files that tell it.

mod browser;

use std::sync::OnceLock;

use halfway::prelude::*;
use halfway::render::AdapterChoice;
use halfway_chart::front::{
    ChartedAdapter, ChartedScene, FrontFilter, FrontPlan, FrontPoint, KeptResults, Method, Over, scenes,
};
use halfway_chart::measure::highlight::{self, unsteadiness};
use halfway_chart::measure::scaling::{self, Growth, LOOKS};
use halfway_chart::measure::{MeasureProgress, SHADINGS, convergence};
use halfway_chart::{Fronts, Report, ReportPlan, measure};

/// Two levels, two rounds, two frames of very small pictures.
const SMALLEST: ReportPlan = ReportPlan {
    fronts: FrontPlan {
        smaller: 12,
        details: 2,
        all_methods: false,
        rounds: 1,
        budget_ms: 1.0,
        samples: 2,
        only: FrontFilter { methods: Vec::new(), detail: None },
    },
    convergence: convergence::ConvergencePlan { size: 48, levels: 2 },
    highlight: highlight::HighlightPlan { size: 32, level: 8, frames: 2 },
    // No curve is cut, so that the number of points does not depend on the machine.
    scaling: scaling::ScalingPlan {
        size: 16,
        per_decade: 1,
        rounds: 2,
        budget_ms: 1.0,
        limit_ms: f64::INFINITY,
        decades_less: 2,
    },
};
/// The steps that it takes, in the order of [`Growth::ALL`].
const STEPS: [&[f64]; Growth::ALL.len()] =
    [&[1e3, 1e4], &[1e1, 1e2, 1e3], &[1e1, 1e2, 1e3], &[1.0, 1e1, 1e2], &[1.0, 3.0], &[4096.0, 1e4, 82944.0]];

fn charted() -> Vec<ChartedScene> {
    vec![scenes::sphere(), scenes::teapot_by_phong()]
}

fn adapters() -> Vec<ChartedAdapter> {
    let adapter = AdapterChoice::default().open().expect("an adapter");
    vec![ChartedAdapter { name: "the adapter".to_owned(), adapter }]
}

/// Measured once for all tests.
fn report() -> &'static Report {
    static REPORT: OnceLock<Report> = OnceLock::new();
    REPORT.get_or_init(|| {
        let mut last = 0;
        let tell = &mut |done, _: &str| {
            assert!(done >= last, "progress never goes back");
            last = done;
        };
        let report = measure(&SMALLEST, &charted(), &adapters(), &mut KeptResults::default(), tell);
        assert_eq!(last, SMALLEST.units(&charted(), 1), "all that was announced was done");
        report.expect("everything can be measured")
    })
}

/// The points of a scene of the report.
fn points(scene: &str) -> &'static [FrontPoint] {
    let found = report().fronts.scenes.iter().find(|measured| measured.name == scene);
    &found.expect("the scene was measured").points
}

fn file(name: &str) -> String {
    let files = report().files().expect("files can be made");
    let names: Vec<_> = files.iter().map(|(name, _)| name.clone()).collect();
    let found = files.into_iter().find(|(other, _)| other == name);
    found.unwrap_or_else(|| panic!("{name} is not among {names:?}")).1
}

/// The rows of a CSV file whose fields hold no commas, without the header.
fn rows(name: &str) -> Vec<Vec<String>> {
    let text = file(name);
    let mut lines = text.split_terminator("\r\n").map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let header = lines.next().expect("a header");
    let rows: Vec<_> = lines.collect();
    assert!(rows.iter().all(|row| row.len() == header.len()), "{name}: {header:?}");
    rows
}

#[test]
fn every_point_is_measured_and_finite() {
    // Two details of seven methods, and of eight where Blinn's formula may stand for Phong's.
    assert_eq!((points("sphere").len(), points("teapot-by-phong").len()), (14, 16));
    for point in points("sphere").iter().chain(points("teapot-by-phong")) {
        let name = point.describe();
        assert!(point.ratio.median.is_finite() && point.ratio.min > 0.0 && point.ms.min > 0.0, "{name}");
        assert!(point.ratio.lower_quartile <= point.ratio.median && point.triangles > 0, "{name}");
        for area in [&point.errors.covered, &point.errors.whole] {
            for errors in [area.steps, area.linear] {
                assert!(errors.rms > 0.0 && errors.rms <= errors.max && errors.p95 <= errors.max, "{name}: {errors:?}");
            }
            assert!((0.0..=1.0).contains(&area.flip), "{name}");
        }
    }
}

/// Both from the finer of two details: a mesh of 256 meridians.
#[test]
fn errors_are_of_the_method_and_not_of_the_truth() {
    let fine = |method: Method| {
        let found = points("sphere").iter().rfind(|point| point.method == method.id());
        found.expect("the method was measured").errors
    };
    let [flat, gouraud, phong, ..] = [Shading::Flat, Shading::Gouraud, Shading::Phong].map(|shading| {
        fine(
            Method::few(None)
                .into_iter()
                .find(|m| m.id() == Method::new(halfway_chart::front::Shade::At(shading)).id())
                .unwrap(),
        )
    });
    // Phong shading of so fine a mesh keeps to half a step nearly everywhere, flat shading does not.
    assert!(phong.covered.steps.p95 < 1.0 && flat.covered.steps.rms > phong.covered.steps.rms, "{flat:?}, {phong:?}");
    assert!(gouraud.covered.steps.rms <= flat.covered.steps.rms);
    // One sample a pixel is wrong at the silhouette, whatever the shading; four are less so.
    let smooth =
        fine(Method { samples: Samples::Four, ..Method::new(halfway_chart::front::Shade::At(Shading::Phong)) });
    assert!(phong.whole.steps.rms > 2.0 * phong.covered.steps.rms, "{phong:?}");
    assert!(smooth.whole.steps.rms < phong.whole.steps.rms, "{smooth:?}, {phong:?}");
}

#[test]
fn what_is_kept_is_not_measured_again() {
    let (scenes, adapters) = ([scenes::sphere()], adapters());
    let only = FrontFilter { methods: vec!["gouraud".to_owned()], detail: None };
    let plan = FrontPlan { only, ..SMALLEST.fronts };
    let mut kept = KeptResults::default();
    let run = |scenes: &[ChartedScene], kept: &mut KeptResults| {
        let mut done = 0;
        let fronts =
            Fronts::measure(&plan, scenes, &adapters, kept, &mut MeasureProgress::new(&mut |now, _| done = now));
        assert_eq!(done, plan.units(scenes, 1));
        fronts
    };
    let first = run(&scenes, &mut kept).expect("the sphere can be measured");
    assert_eq!(first.scenes[0].points.len(), 2);
    // What is known stands where it belongs among what is not.
    let all = FrontPlan { only: FrontFilter::default(), ..plan.clone() };
    let again = Fronts::measure(&all, &scenes, &adapters, &mut kept, &mut MeasureProgress::new(&mut |_, _| ()));
    let again = again.expect("the sphere can be measured").scenes.remove(0).points;
    let names: Vec<String> = Method::few(None).into_iter().map(Method::id).collect();
    assert!(again.chunks(names.len()).all(|points| points.iter().map(|point| &point.method).eq(&names)));
    assert!(first.scenes[0].points.iter().all(|point| again.contains(point)));
    // A scene that can no longer be set up is known all the same.
    let broken = ChartedScene { build: Box::new(|_, _| Err("gone".to_owned())), ..scenes::sphere() };
    let again = run(&[broken], &mut kept).expect("nothing is drawn");
    assert_eq!(again.scenes[0].points, first.scenes[0].points);
    let broken = ChartedScene { build: Box::new(|_, _| Err("gone".to_owned())), ..scenes::sphere() };
    assert!(
        Fronts::measure(
            &plan,
            &[broken],
            &adapters,
            &mut KeptResults::default(),
            &mut MeasureProgress::new(&mut |_, _| ())
        )
        .is_err()
    );
}

#[test]
fn chart_json_has_every_point_by_its_keys() {
    let json: serde_json::Value = serde_json::from_str(&file("chart.json")).expect("JSON");
    let points = json["points"].as_array().expect("points");
    assert_eq!(points.len(), 30);
    for point in points {
        for key in ["scene", "method", "tessellation", "backend"] {
            assert!(point[key].is_string(), "{key}: {point}");
        }
        for key in ["ms", "rms", "max", "flip", "p95", "ratio"] {
            assert!(point[key].as_f64().is_some_and(f64::is_finite), "{key}: {point}");
        }
        let is_automatic = point["family"] == "automatic";
        assert!(point["tolerance"].is_number() == is_automatic && point["front"].is_boolean(), "{point}");
        assert!(point["whole"]["rms"].is_number() && point["float"]["rms"].is_number());
    }
    for scene in ["sphere", "teapot-by-phong"] {
        let mut front: Vec<[f64; 2]> = Vec::new();
        for point in points.iter().filter(|point| point["scene"] == scene) {
            let here = ["ratio", "rms"].map(|key| point[key].as_f64().unwrap());
            if point["front"] == true {
                front.push(here);
            }
        }
        assert!(!front.is_empty());
        // Nothing of the scene is faster than one of the front and errs less.
        for point in points.iter().filter(|point| point["scene"] == scene) {
            let [time, error] = ["ratio", "rms"].map(|key| point[key].as_f64().unwrap());
            assert!(front.iter().all(|[t, e]| time >= *t || error >= *e), "{point}");
        }
    }
}

#[test]
fn finer_meshes_err_less() {
    for found in &report().convergence {
        let [coarse, fine] = &found.levels[..] else { panic!("two levels") };
        assert!(fine.edge < coarse.edge && fine.rms() < coarse.rms(), "{found:?}");
    }
}

#[test]
fn everything_grows_in_its_steps() {
    let curves = &report().scaling.curves;
    assert_eq!(curves.len(), STEPS.len() * LOOKS.len());
    for (curves, (growth, steps)) in curves.chunks(LOOKS.len()).zip(Growth::ALL.into_iter().zip(STEPS)) {
        for (curve, look) in curves.iter().zip(LOOKS) {
            assert_eq!((curve.growth, curve.look, curve.samples.len()), (growth, look, steps.len()));
            for (sample, step) in curve.samples.iter().zip(steps) {
                // Meshes and pictures have whole rows and columns: 960 of 1000 triangles are the least like.
                assert!((sample.count / step - 1.0).abs() < 0.05, "{growth:?}: {} for {step}", sample.count);
                // Two rounds of two frames.
                assert!(sample.frame_ms.min > 0.0 && sample.frame_ms.count == 4, "{growth:?}: {sample:?}");
            }
        }
    }
}

#[test]
fn scaling_has_a_page_of_its_own() {
    let files = report().scaling.files().expect("files can be made");
    let names: Vec<_> = files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["scaling.html", "scaling.svg", "scaling.csv", "scaling-slopes.csv"]);
    for growth in Growth::ALL {
        assert!(files[0].1.contains(growth.name()) && files[1].1.contains(growth.name()), "{growth:?}");
    }
}

#[test]
fn tables_have_every_row() {
    assert_eq!(file("points.csv").lines().count(), 1 + 30);
    // 2 objects, 2 materials, 3 shadings; 2 levels, or 3 quantities.
    assert_eq!((rows("convergence.csv").len(), rows("slopes.csv").len()), (24, 36));
    assert_eq!((rows("highlight.csv").len(), rows("unsteadiness.csv").len()), (2, 3));
    let steps: usize = STEPS.iter().map(|steps| steps.len()).sum();
    // One growth has a comma in its name.
    assert_eq!(file("scaling.csv").lines().count(), 1 + steps * LOOKS.len());
}

/// Near and far lights differ by less the farther away the near one is; from 1000 radii on by nothing that is seen.
#[test]
fn a_far_light_may_stand_for_one_that_is_far_enough() {
    let over = report().over.iter().find(|measured| measured.over == Over::Distance).expect("the distance was changed");
    let error = |step: usize, method: &str| {
        let (_, points) = &over.steps[step];
        let point = points.iter().find(|point| point.method == method).expect("the method was measured");
        point.errors.covered.steps.rms
    };
    let last = over.steps.len() - 1;
    assert!(over.steps[last].0 >= 1000.0);
    assert!(error(0, "phong-far-lights") > 10.0 * error(0, "phong"), "1.5 radii: {}", error(0, "phong-far-lights"));
    let [near, far] = ["phong", "phong-far-lights"].map(|method| error(last, method));
    assert!((near - far).abs() < 0.1, "{near}, {far}");
    // No figure is left out, and the CSV has a row for each.
    let points: usize = report().over.iter().flat_map(|measured| &measured.steps).map(|(_, points)| points.len()).sum();
    assert_eq!(rows("over.csv").len(), points);
    // Four families of four methods at 4 + 4 + 4 + 4 steps.
    assert_eq!(points, 4 * 16);
}

#[test]
fn charts_show_every_series() {
    let mut charts = ["front-sphere", "front-teapot-by-phong", "convergence", "highlight", "scaling"]
        .map(|id| file(&format!("{id}.svg")))
        .to_vec();
    charts.push(report().fronts.small_chart(&["sphere"]).expect("the small chart can be drawn"));
    for svg in charts {
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        for series in ["flat", "Gouraud", "Phong"] {
            assert!(svg.contains(&format!("\n{series}")), "{series}");
        }
        assert!(!svg.contains("NaN"));
    }
}

#[test]
fn the_page_holds_all_and_fetches_nothing() {
    let page = file("index.html");
    for part in [
        "data-scene=\"sphere\"",
        "data-scene=\"teapot-by-phong\"",
        "id=\"front-sphere\"",
        "id=\"convergence\"",
        "id=\"highlight\"",
        "id=\"scaling\"",
        "points.csv",
        "chart.json",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(page.contains("id=\"over-error\"") && page.contains("id=\"over-time\" hidden"));
    for failure in &report().failures {
        assert!(page.contains(&format!("href=\"failure-{}.html\"", failure.id)), "{}", failure.id);
        let own = file(&format!("failure-{}.html", failure.id));
        assert!(own.contains(failure.test) && own.contains("data:image/png") && own.contains("<svg"), "{}", failure.id);
    }
    // Two pictures for each of the 30 points, and one of the truth for each scene.
    assert_eq!(page.matches("data:image/jpeg;base64,").count(), 62);
    let page = page.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    assert!(!page.contains("http:") && !page.contains("https:") && !page.contains("src=\"//"));
}

/// Gouraud shading makes highlights flicker, Phong shading hardly does: the bar is three times, where several times are
/// measured at the sizes of the report.
#[test]
fn highlights_flicker_under_gouraud() {
    let plan = highlight::HighlightPlan { size: 96, level: 8, frames: 24 };
    let energies = highlight::sweep(plan, &mut MeasureProgress::new(&mut |_, _| ())).expect("frames can be drawn");
    let [flat, gouraud, phong] =
        energies.shaded.each_ref().map(|shaded| unsteadiness(shaded, &energies.truth).expect("a number").rms);
    assert!(gouraud > 3.0 * phong, "{SHADINGS:?}: {flat}, {gouraud}, {phong}");
    assert!(flat > 3.0 * phong, "{SHADINGS:?}: {flat}, {gouraud}, {phong}");
}
