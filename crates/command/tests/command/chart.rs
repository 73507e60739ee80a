//! The measurements and the files of `chart`.

use std::fs;
use std::path::Path;

use crate::command::{asset, folder, halfway, succeeds};

fn json(file: &Path) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(file).expect("the file was written")).expect("JSON")
}

#[test]
fn a_model_is_charted_with_a_recommendation() {
    let folder = folder("chart_model");
    let model = asset("assets/teapot.obj");
    let said = succeeds(&folder, &["chart", &model, "--quick", "--adapter", "cpu", "-o", "charted"]);
    assert!(said.contains("charted/index.html") && said.contains("What to choose for "), "{said}");
    let chart = json(&folder.join("charted/chart.json"));
    let points = chart["points"].as_array().expect("points");
    // Three details of seven methods.
    assert_eq!(points.len(), 21);
    assert!(points.iter().all(|point| point["adapter"] == "cpu" && point["scene"] == model.as_str()));
    assert!(points.iter().any(|point| point["front"] == true));
    // The errors are relative to the model itself under Phong shading.
    let exact = points.iter().find(|point| point["method"] == "phong" && point["detail"] == "full");
    let exact = exact.expect("the model as it is");
    assert!(exact["covered"]["steps"]["p95"].as_f64().is_some_and(|steps| steps <= 1.0), "{exact}");
    let page = fs::read_to_string(folder.join("charted/index.html")).expect("the page was written");
    assert!(page.contains("What to choose for ") && page.contains("<figure id=\"front-"));
}

#[test]
fn one_point_is_measured_again_by_its_command() {
    let folder = folder("chart_point");
    let line = "chart sphere --detail 16 --method gouraud --method flat --adapter cpu --quick -o point --tables t.md";
    succeeds(&folder, &line.split(' ').collect::<Vec<_>>());
    let chart = json(&folder.join("point/chart.json"));
    let names: Vec<_> = chart["points"].as_array().expect("points").iter().map(|point| &point["method"]).collect();
    assert_eq!(names, ["gouraud", "flat"]);
    let command = chart["points"][0]["command"].as_str().expect("a command");
    assert_eq!(command, "halfway chart sphere --detail 16 --method gouraud --adapter cpu --quick");
    let tables = fs::read_to_string(folder.join("t.md")).expect("the tables were written");
    assert!(tables.contains("## sphere") && tables.contains("| Gouraud | 16 cells |"), "{tables}");
    // Times differ from run to run, errors do not.
    let again = format!("{command} -o again");
    succeeds(&folder, &again.split(' ').skip(1).collect::<Vec<_>>());
    let again = json(&folder.join("again/chart.json"));
    for area in ["covered", "whole"] {
        assert_eq!(again["points"][0][area], chart["points"][0][area], "{area}");
    }
}

#[test]
fn failure_modes_are_drawn_alone() {
    let folder = folder("chart_failures");
    succeeds(&folder, &["chart", "--failures", "--adapter", "cpu", "-o", "failures"]);
    let index = fs::read_to_string(folder.join("failures/index.html")).expect("the index was written");
    let linked: Vec<_> = index.split("href=\"failure-").skip(1).filter_map(|rest| rest.split_once(".html\"")).collect();
    assert_eq!(linked.len(), 18);
    for (id, _) in linked {
        assert!(folder.join(format!("failures/failure-{id}.html")).is_file(), "{id}");
    }
    let said = succeeds(&folder, &["chart", "--failures=chapters", "--adapter", "cpu", "-o", "chapters"]);
    let chapters: Vec<_> = said.lines().filter_map(|line| line.strip_suffix(".md")).collect();
    assert_eq!(chapters.len(), 18);
    for chapter in chapters {
        let text = fs::read_to_string(folder.join(format!("{chapter}.md"))).expect("the chapter was written");
        assert!(
            text.starts_with("# ") && text.contains("\n**Remedy.** ") && text.contains("\n<figure><img "),
            "{text}"
        );
        let chart = text.split_once("\n![").and_then(|(_, rest)| rest.split_once("](")?.1.split_once(')'));
        assert!(folder.join("chapters").join(chart.expect("a chart").0).is_file(), "{text}");
    }
}

#[test]
fn invalid_subjects_are_refused_before_measuring() {
    let folder = folder("chart_refused");
    let rows = [
        (&["chart", "no_such_scene"][..], "no_such_scene"),
        (&["chart", "sphere", "--method", "cel"], "gouraud"),
        (&["chart", "sphere", "--detail", "17"], "8, 16, 32"),
        (&["chart", "--filters", "sphere"], "--filters"),
        (&["chart", "--failures", "sphere"], "--failures"),
        (&["chart", "--failures=book"], "[possible values: pages, chapters]"),
    ];
    for (arguments, told) in rows {
        let output = halfway(&folder, arguments);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && error.contains(told), "{arguments:?}: {:?}: {error}", output.status);
    }
    let output = halfway(&folder, &["chart", "sphere", "--adapter", "no such adapter"]);
    assert_eq!(output.status.code(), Some(3));
    assert!(fs::read_dir(&folder).expect("the folder").next().is_none(), "nothing was written");
}
