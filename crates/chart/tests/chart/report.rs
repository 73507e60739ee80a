//! The smallest report, and its files.

use std::collections::HashMap;
use std::sync::OnceLock;

use halfway::prelude::*;
use halfway::render::AdapterChoice;
use halfway_chart::front::{
    AreaErrors, ChartedAdapter, ChartedScene, FrontFilter, FrontPlan, FrontPoint, Method, Over, scenes,
};
use halfway_chart::{Progress, Report};

/// Two details, one round, very small pictures.
const SMALLEST: FrontPlan = FrontPlan {
    smaller: 12,
    details: 2,
    all_methods: false,
    rounds: 1,
    budget_ms: 1.0,
    samples: 2,
    only: FrontFilter { methods: Vec::new(), detail: None },
};
/// Two details of seven methods, and of eight where Blinn's formula may stand for Phong's.
const POINTS: [(&str, usize); 2] = [("sphere", 14), ("teapot-by-phong", 16)];

fn charted() -> Vec<ChartedScene> {
    vec![scenes::sphere(), scenes::teapot_by_phong()]
}

/// Measured once for all tests.
pub(crate) fn report() -> &'static Report {
    static REPORT: OnceLock<Report> = OnceLock::new();
    REPORT.get_or_init(|| {
        let adapter = AdapterChoice::default().open().expect("an adapter");
        let adapters = [ChartedAdapter { name: "the adapter".to_owned(), adapter }];
        let mut last = 0;
        let tell = &mut |done, _: &str| {
            assert!(done >= last, "progress never goes back");
            last = done;
        };
        let report = Report::measure(&SMALLEST, &charted(), &adapters, &mut Progress::new(tell));
        assert_eq!(last, Report::units(&SMALLEST, &charted(), 1), "all that was announced was done");
        report.expect("everything can be measured")
    })
}

/// Every file of the report by its name, made once for all tests.
fn files() -> &'static HashMap<String, String> {
    static FILES: OnceLock<HashMap<String, String>> = OnceLock::new();
    FILES.get_or_init(|| {
        let pages = report().pages().expect("pages can be made");
        let files: Vec<_> = pages.iter().flat_map(halfway_chart::page::Page::files).collect();
        let count = files.len();
        let files: HashMap<_, _> = files.into_iter().collect();
        assert_eq!(files.len(), count, "no two files have the same name");
        files
    })
}

pub(crate) fn file(name: &str) -> &'static str {
    files().get(name).unwrap_or_else(|| panic!("{name} is not among {:?}", files().keys()))
}

/// The points of a scene of the report.
fn points(scene: &str) -> &'static [FrontPoint] {
    let found = report().fronts.scenes.iter().find(|measured| measured.name == scene);
    &found.expect("the scene was measured").points
}

#[test]
fn every_point_is_measured_and_finite() {
    for (scene, count) in POINTS {
        assert_eq!(points(scene).len(), count);
        for point in points(scene) {
            let name = point.describe();
            assert!(point.ratio.median.is_finite() && point.ratio.min > 0.0 && point.ms.min > 0.0, "{name}");
            assert!(point.ratio.lower_quartile <= point.ratio.median && point.triangles > 0, "{name}");
            for AreaErrors { steps, flip } in [point.errors.covered, point.errors.whole] {
                assert!(steps.rms > 0.0 && steps.rms <= steps.max && steps.p95 <= steps.max, "{name}: {steps:?}");
                assert!((0.0..=1.0).contains(&flip), "{name}");
            }
        }
    }
}

/// Both from the finer of two details: a mesh of 256 meridians.
#[test]
fn errors_are_those_of_the_method() {
    let fine = |method: Method| {
        let found = points("sphere").iter().rfind(|point| point.method == method.id());
        found.expect("the method was measured").errors
    };
    let [flat, gouraud, phong] = [Method::FLAT, Method::GOURAUD, Method::PHONG].map(fine);
    // Phong shading of so fine a mesh keeps to half a step nearly everywhere, flat shading does not.
    assert!(phong.covered.steps.p95 < 1.0 && flat.covered.steps.rms > phong.covered.steps.rms, "{flat:?}, {phong:?}");
    assert!(gouraud.covered.steps.rms <= flat.covered.steps.rms);
    // One sample a pixel is wrong at the silhouette, whatever the shading; four are less so.
    let smooth = fine(Method { samples: Samples::Four, ..Method::PHONG });
    assert!(phong.whole.steps.rms > 2.0 * phong.covered.steps.rms, "{phong:?}");
    assert!(smooth.whole.steps.rms < phong.whole.steps.rms, "{smooth:?}, {phong:?}");
}

#[test]
fn chart_json_has_every_point_by_its_keys() {
    let json: serde_json::Value = serde_json::from_str(file("chart.json")).expect("JSON");
    let points = json["points"].as_array().expect("points");
    assert_eq!(points.len(), 30);
    for point in points {
        for key in ["scene", "method", "words", "family", "detail", "detail_words", "adapter", "command"] {
            assert!(point[key].is_string(), "{key}: {point}");
        }
        for key in [
            "/triangles",
            "/ms/median",
            "/ratio/lower_quartile",
            "/covered/steps/rms",
            "/whole/steps/p95",
            "/whole/flip",
        ] {
            assert!(
                point.pointer(key).is_some_and(|value| value.as_f64().is_some_and(f64::is_finite)),
                "{key}: {point}"
            );
        }
        assert!(point["front"].is_boolean() && point["front_whole"].is_boolean(), "{point}");
    }
    for (scene, _) in POINTS {
        let place = |point: &serde_json::Value| {
            ["/ratio/median", "/covered/steps/rms"].map(|key| {
                point.pointer(key).and_then(serde_json::Value::as_f64).expect("times and errors are numbers")
            })
        };
        let here = || points.iter().filter(|point| point["scene"] == scene);
        let front: Vec<_> = here().filter(|point| point["front"] == true).map(place).collect();
        assert!(!front.is_empty());
        // No point of the scene is both faster and more accurate than one of the front.
        for point in here() {
            let [time, error] = place(point);
            assert!(front.iter().all(|[t, e]| time >= *t || error >= *e), "{point}");
        }
    }
}

/// The farther away a near light is, the less it differs from a far one; from 1000 radii on the difference is
/// invisible.
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
    // Two families of four methods at 4 steps.
    let points: usize = report().over.iter().flat_map(|measured| &measured.steps).map(|(_, points)| points.len()).sum();
    assert_eq!(points, 2 * 4 * 4);
}

#[test]
fn charts_show_every_family() {
    let mut charts =
        ["front-sphere-rms", "front-teapot-by-phong-rms"].map(|id| file(&format!("{id}.svg")).to_owned()).to_vec();
    charts.push(report().fronts.small_chart(&["sphere"]));
    for svg in charts {
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        for series in ["flat", "Gouraud", "Phong", "mixed terms"] {
            assert!(svg.contains(&format!(">{series}</text>")), "{series}");
        }
        assert!(!svg.contains("NaN"));
    }
}

#[test]
fn the_page_holds_all_and_fetches_nothing() {
    let page = file("index.html");
    for (scene, _) in POINTS {
        assert!(page.contains(&format!("id=\"front-{scene}-rms\"")), "{scene}");
        assert!(page.contains(&format!("id=\"front-{scene}-largest\" hidden")), "{scene}");
    }
    assert!(page.contains("chart.json") && page.contains("<h2>Far lights and far viewers</h2>"));
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

#[test]
fn tables_are_written_in_markdown() {
    let pages = report().pages().expect("pages can be made");
    let markdown = pages[0].markdown();
    for text in ["## sphere\n", "What to choose for sphere on the adapter", "| distance of a point light (radii) |"] {
        assert!(markdown.contains(text), "{text} is missing in:\n{markdown}");
    }
}

/// Each page of a failure names an existing test, and shows its pictures and figures.
#[test]
fn every_failure_names_a_test_that_there_is() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/failures");
    let files = std::fs::read_dir(folder).expect("the folder is there");
    let text: String =
        files.map(|file| std::fs::read_to_string(file.expect("an entry").path()).expect("a file")).collect();
    let pages = &report().failures;
    for page in pages {
        let test = format!("    #[test]\n    fn {}() {{", page.test);
        assert!(text.contains(&test), "{}: {}", page.id, page.test);
        assert!(!page.pictures.is_empty() && !page.figures.is_empty(), "{}", page.id);
        for figure in &page.figures {
            assert!(figure.shown().count() > 3, "{}: {}", page.id, figure.title);
            assert!(page.figures.len() == 1 || !figure.name.is_empty(), "{}: a figure has no name", page.id);
        }
    }
    for names in [pages.iter().map(|page| page.id).collect::<Vec<_>>(), pages.iter().map(|page| page.title).collect()] {
        let mut once = names.clone();
        once.sort_unstable();
        once.dedup();
        assert_eq!(once.len(), names.len(), "{names:?}");
    }
}
