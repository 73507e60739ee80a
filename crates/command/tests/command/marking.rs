//! `halfway mark`.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::command::{asset, folder, halfway, succeeds};

/// Draws a scene with options that change it, as a student might.
fn draw(folder: &Path, scene: &str, name: &str, options: &[&str]) {
    let common = ["render", scene, "--size", "96x72", "--samples", "1", "--adapter", "cpu", "-o", name];
    succeeds(folder, &[&common[..], options].concat());
}

/// The report of a picture as JSON, and the exit code.
fn marked(folder: &Path, arguments: &[&str]) -> (Value, Option<i32>) {
    let output = halfway(folder, &[&["mark"], arguments].concat());
    let error = String::from_utf8_lossy(&output.stderr);
    let json = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{arguments:?}: {error}"));
    (json, output.status.code())
}

/// The names of the first explanation, a list a cause.
fn first(report: &Value) -> Vec<Vec<&str>> {
    let causes = report["explanations"][0]["causes"].as_array().map_or(&[][..], Vec::as_slice);
    causes
        .iter()
        .map(|cause| cause.as_array().into_iter().flatten().filter_map(|it| it["name"].as_str()).collect())
        .collect()
}

#[test]
fn right_pictures_of_the_cpu_pass_and_are_not_accused() {
    let folder = folder("mark_right");
    for scene in fs::read_dir(asset("examples/scenes")).expect("the example scenes are there") {
        let path = scene.expect("the folder can be read").path();
        // Lines are drawn over pictures, and are no part of what is marked.
        if ["drawing.json", "lines_and_points.json"].iter().any(|name| path.ends_with(name)) {
            continue;
        }
        let text = fs::read_to_string(&path).expect("the scene can be read");
        let path = path.to_string_lossy();
        let camera = if text.contains("viewport") { &["--camera", "0"][..] } else { &[] };
        // One sample, and what the scene asks for.
        for samples in [&["--samples", "1"][..], &[]] {
            let common = ["render", &path, "--size", "96x54", "--adapter", "cpu", "-o", "right.png"];
            succeeds(&folder, &[&common[..], camera, samples].concat());
            let (report, code) = marked(&folder, &[&[&*path, "--picture", "right.png", "--json"][..], camera].concat());
            assert_eq!((&report["passes"], code), (&json!(true), Some(0)), "{path}: {report}");
            assert_eq!((&report["mark"], &report["explanations"]), (&json!(100.0), &json!([])), "{path}: {report}");
        }
    }
}

#[test]
fn a_mistake_is_named_with_its_share_and_place() {
    let folder = folder("mark_mistake");
    let scene = asset("examples/scenes/brass_teapot.json");
    draw(&folder, &scene, "gouraud.png", &["--shading", "gouraud"]);
    let (report, code) = marked(&folder, &[&scene, "--picture", "gouraud.png", "--json"]);
    assert_eq!(code, Some(4), "{report}");
    assert_eq!(first(&report), [["gouraud-for-phong"]]);
    assert_eq!((&report["mark"], &report["points"]), (&json!(80.0), &json!(100.0)));
    let explanation = &report["explanations"][0];
    assert!(explanation["share"].as_f64().is_some_and(|share| share > 0.99), "{report}");
    assert_eq!(explanation["object"], "teapot");
    let column = |end: &str| explanation["area"][end][0].as_u64().expect("a column");
    assert!(5 < column("from") && column("from") < column("to") && column("to") < 90, "{report}");

    let output = halfway(&folder, &["mark", &scene, "--picture", "gouraud.png"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    for said in [
        "gouraud.png, 96 × 72 pixels: differs, 80 of 100 points",
        "gouraud-for-phong: Lighting is evaluated at the vertices",
        "most of it on teapot",
    ] {
        assert!(text.contains(said), "{said}: {text}");
    }

    draw(&folder, &scene, "both.png", &["--shading", "flat", "--reflectance", "phong"]);
    let (report, _) = marked(&folder, &[&scene, "--picture", "both.png", "--json"]);
    let mut named = first(&report);
    named.sort();
    assert_eq!(named, [["flat-for-smooth"], ["phong-for-blinn"]], "{report}");
    assert_eq!(report["mark"], 60.0);

    draw(&folder, &scene, "elsewhere.png", &["--view", "left"]);
    let (report, code) = marked(&folder, &[&scene, "--picture", "elsewhere.png", "--json"]);
    assert_eq!((&report["explanations"], code), (&json!([]), Some(4)), "{report}");
    assert!(report["mark"].as_f64().is_some_and(|mark| mark < 50.0), "{report}");
    let output = halfway(&folder, &["mark", &scene, "--picture", "elsewhere.png"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.contains("none of the known mistakes explains the difference"), "{text}");
}

#[test]
fn a_rubric_gives_the_points() {
    let folder = folder("mark_rubric");
    let scene = asset("examples/scenes/brass_teapot.json");
    draw(&folder, &scene, "flat.png", &["--shading", "flat"]);
    let arguments = [scene.as_str(), "--picture", "flat.png", "--rubric", "rubric.json", "--json"];
    for (rubric, mark, points) in [
        (r#"{"points": 10, "mistake": 3}"#, 7.0, 10.0),
        (r#"{"points": 10, "mistake": 3, "mistakes": {"flat-for-smooth": 4.5}}"#, 5.5, 10.0),
        (r#"{"points": 10, "mistakes": {"flat-for-smooth": 40}}"#, 0.0, 10.0),
    ] {
        fs::write(folder.join("rubric.json"), rubric).expect("the folder can be written");
        let (report, code) = marked(&folder, &arguments);
        assert_eq!((&report["mark"], &report["points"], code), (&json!(mark), &json!(points), Some(4)), "{rubric}");
    }
    fs::write(folder.join("rubric.json"), r#"{"mistakes": {"flat": 1}}"#).expect("the folder can be written");
    let output = halfway(&folder, &[&["mark"], &arguments[..]].concat());
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains("rubric.json: mistakes: \"flat\" is not the name of a mistake; expected one of"), "{error}");
}

#[test]
fn reports_are_written_for_gradescope_and_submitty() {
    let folder = folder("mark_reports");
    let scene = asset("examples/scenes/brass_teapot.json");
    draw(&folder, &scene, "right.png", &[]);
    draw(&folder, &scene, "flat.png", &["--shading", "flat"]);
    for (picture, mark, passed, success) in
        [("right.png", 100.0, "passed", "success"), ("flat.png", 80.0, "failed", "failure")]
    {
        let (report, _) = marked(&folder, &[&scene, "--picture", picture, "--json=gradescope"]);
        let test = &report["tests"][0];
        assert_eq!(
            (&test["score"], &test["max_score"], &test["status"]),
            (&json!(mark), &json!(100.0), &json!(passed))
        );
        assert_eq!(test["name"], picture);
        let (report, _) = marked(&folder, &[&scene, "--picture", picture, "--json=submitty"]);
        assert_eq!((&report["score"], &report["status"]), (&json!(mark / 100.0), &json!(success)));
        for output in [&test["output"], &report["message"]] {
            let names = output.as_str().is_some_and(|text| text.contains("flat-for-smooth"));
            assert_eq!(names, picture == "flat.png", "{output}");
        }
    }
}

#[test]
fn the_page_lists_every_mistake() {
    use halfway::reference::mistakes::Mistake;
    let page = fs::read_to_string(asset("docs/marking.md")).expect("the page can be read");
    for mistake in Mistake::ALL {
        let row = format!("| `{mistake}` | {} | {} |", mistake.explanation(), mistake.remedy());
        assert!(page.contains(&row), "docs/marking.md: expected the row\n{row}");
    }
    let rows = page.lines().filter(|line| line.starts_with("| `")).count();
    assert_eq!(rows, Mistake::ALL.len(), "rows of mistakes that are not there");
}

/// Gradescope's entry of the recipes, which needs no more than a shell; `.ci/run` tries the others with their own tools.
#[cfg(target_os = "linux")]
#[test]
fn gradescopes_entry_writes_results() {
    use std::os::unix::fs::PermissionsExt;

    let results = |test: &str, options: &str| {
        let home = folder(test);
        let write = |file: &str, text: &str| fs::write(home.join(file), text).expect("the folder can be written");
        for part in ["source", "submission"] {
            fs::create_dir(home.join(part)).expect("the folder can be written");
        }
        write(
            "source/scene.json",
            r#"{"size": [96, 72], "camera": {"position": [1, 2, 6], "target": [0, 1, 0]},
                "lights": [{"kind": "point", "position": [2, 3, 4]}],
                "objects": [{"mesh": {"teapot": {"divisions": 4}}, "material": "brass"}]}"#,
        );
        fs::copy(asset("examples/ci/homework/rubric.json"), home.join("source/rubric.json")).expect("it can be copied");
        let program = env!("CARGO_BIN_EXE_halfway");
        write(
            "submission/student",
            &format!("#!/bin/sh\nexec {program} render \"$1\" --adapter cpu {options} -o \"$2\"\n"),
        );
        let executable = fs::Permissions::from_mode(0o755);
        fs::set_permissions(home.join("submission/student"), executable).expect("permissions can be set");
        let output = std::process::Command::new(asset("examples/ci/homework/run_autograder"))
            .env("AUTOGRADER", &home)
            .env("HALFWAY", program)
            .output()
            .expect("the recipe can be run");
        assert!(output.status.success(), "{test}: {}", String::from_utf8_lossy(&output.stderr));
        let json = fs::read_to_string(home.join("results/results.json")).expect("it was written");
        serde_json::from_str::<Value>(&json).expect("JSON")
    };
    assert_eq!(results("mark_gradescope_right", "")["tests"][0]["score"], 10.0);
    let wrong = results("mark_gradescope_wrong", "--shading flat");
    assert_eq!(wrong["tests"][0]["score"], 7.0);
    assert!(wrong["tests"][0]["output"].as_str().is_some_and(|said| said.contains("flat-for-smooth")), "{wrong}");
    assert_eq!(results("mark_gradescope_none", "--no-such-option")["score"], 0);
}
