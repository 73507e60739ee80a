//! The smallest sweep, and the files that tell it.

mod browser;

use std::sync::OnceLock;

use halfway_chart::measure::highlight::{self, unsteadiness};
use halfway_chart::measure::scaling::{self, Growth, LOOKS};
use halfway_chart::measure::{MeasureProgress, SHADINGS, accuracy, convergence};
use halfway_chart::{Report, ReportPlan, measure};

/// Two levels, two rounds, two frames of very small pictures.
const SMALLEST: ReportPlan = ReportPlan {
    accuracy: accuracy::AccuracyPlan { size: 48, levels: 2, rounds: 1 },
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

/// Measured once for all tests.
fn report() -> &'static Report {
    static REPORT: OnceLock<Report> = OnceLock::new();
    REPORT.get_or_init(|| {
        let mut last = 0;
        let report = measure(SMALLEST, &mut |done, _| {
            assert!(done >= last, "progress never goes back");
            last = done;
        });
        assert_eq!(last, SMALLEST.units(), "all that was announced was done");
        report.expect("everything can be measured")
    })
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
    let accuracy = &report().accuracy;
    // 2 objects, 2 levels, 3 shadings, 2 reflectances with 2 viewers each.
    assert_eq!(accuracy.len(), 2 * 2 * 3 * 4);
    for measured in accuracy {
        let name = accuracy::describe(measured);
        let errors = &measured.comparison.linear.all;
        assert!(measured.ratio.is_finite() && measured.ratio > 0.0, "{name}");
        assert!(errors.rmse.is_finite() && errors.rmse > 0.0 && errors.rmse <= errors.max(), "{name}");
        assert!(measured.flip.is_finite() && measured.flip >= 0.0, "{name}");
        assert_eq!(measured.comparison.not_finite, None, "{name}");
        let coverage = measured.comparison.coverage.expect("both pictures know what they cover");
        // A mesh of chords lies inside a sphere, and near a teapot.
        assert!(coverage.both > 10 * coverage.only_actual, "{name}: {coverage:?}");
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
    assert_eq!(rows("error.csv").len(), 48);
    // 2 objects, 2 materials, 3 shadings; 2 levels, or 3 quantities.
    assert_eq!((rows("convergence.csv").len(), rows("slopes.csv").len()), (24, 36));
    assert_eq!((rows("highlight.csv").len(), rows("unsteadiness.csv").len()), (2, 3));
    let steps: usize = STEPS.iter().map(|steps| steps.len()).sum();
    // One growth has a comma in its name.
    assert_eq!(file("scaling.csv").lines().count(), 1 + steps * LOOKS.len());
    for row in rows("error.csv") {
        for number in &row[6..] {
            assert!(number.parse::<f64>().is_ok_and(f64::is_finite), "{row:?}");
        }
    }
}

#[test]
fn charts_show_every_series() {
    let mut charts = ["error-rms", "error-max", "error-flip", "convergence", "highlight", "scaling"]
        .map(|id| file(&format!("{id}.svg")))
        .to_vec();
    charts.push(report().small_chart().expect("the small chart can be drawn"));
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
        "id=\"error-rms\"",
        "id=\"error-flip\" hidden",
        "id=\"convergence\"",
        "id=\"highlight\"",
        "id=\"scaling\"",
        "error.csv",
    ] {
        assert!(page.contains(part), "{part}");
    }
    // Two pictures for each of the 48 points.
    assert_eq!(page.matches("data:image/png;base64,").count(), 96);
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
