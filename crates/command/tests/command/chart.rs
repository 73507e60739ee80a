//! What `chart` measures and writes.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::command::{asset, folder, halfway, succeeds};

fn json(file: &Path) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(file).expect("the file was written")).expect("JSON")
}

#[test]
fn a_model_is_charted_and_what_to_choose_is_said() {
    let folder = folder("chart_model");
    let model = asset("assets/teapot.obj");
    let said = succeeds(&folder, &["chart", &model, "--quick", "--adapter", "cpu", "-o", "charted"]);
    assert!(said.contains("charted/index.html") && said.contains("What to choose for "), "{said}");
    let chart = json(&folder.join("charted/chart.json"));
    let points = chart["points"].as_array().expect("points");
    // Three details of seven methods.
    assert_eq!(points.len(), 21);
    assert!(points.iter().all(|point| point["backend"] == "cpu" && point["scene"] == model.as_str()));
    assert!(points.iter().any(|point| point["front"] == true));
    // The model itself, under Phong shading, is what errors are errors from.
    let exact = points.iter().find(|point| point["method"] == "phong" && point["tessellation"] == "full");
    let exact = exact.expect("the model as it is");
    assert!(exact["p95"].as_f64().is_some_and(|steps| steps <= 1.0), "{exact}");
    let page = fs::read_to_string(folder.join("charted/index.html")).expect("the page was written");
    assert!(page.contains("What to choose for ") && page.contains("<figure id=\"front-"));
    assert!(!folder.join("charted/unfinished.jsonl").exists(), "all of it is on the page");
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
    assert!(tables.contains("## sphere") && tables.contains("| 0.5 steps |"), "{tables}");
    // An earlier run is compared; this one's file is where that one's was.
    let again = format!("{line} --against point/chart.json");
    let of_earlier = |with: &dyn Fn(&mut serde_json::Value)| {
        let mut earlier = chart.clone();
        with(&mut earlier);
        fs::write(folder.join("point/chart.json"), earlier.to_string()).expect("it is written");
        halfway(&folder, &again.split(' ').collect::<Vec<_>>())
    };
    // A run in which any time is a tie.
    let output = of_earlier(&|earlier| {
        for point in earlier["points"].as_array_mut().expect("points") {
            point["ratio_quartiles"] = serde_json::json!([1e-3, 1e3]);
        }
    });
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("agree but for ties"), "{said}");
    // One in which what errs least now was beaten in everything.
    let output = of_earlier(&|earlier| {
        for (place, time) in [(0, 1e3), (1, 1e-3)] {
            let point = &mut earlier["points"][place];
            point["ratio"] = time.into();
            point["ratio_quartiles"] = serde_json::json!([time, time]);
        }
        for area in ["/rms", "/whole/rms"] {
            *earlier["points"][1].pointer_mut(area).expect("an error") = 0.0.into();
        }
    });
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.code() == Some(4) && said.contains("sphere on cpu, covered pixels: Gouraud, "), "{said}");
}

#[test]
fn what_cannot_be_charted_is_refused_before_anything_is_measured() {
    let folder = folder("chart_refused");
    let rows = [
        (&["chart", "no_such_scene"][..], "no_such_scene"),
        (&["chart", "sphere", "--method", "cel"], "gouraud"),
        (&["chart", "sphere", "--detail", "17"], "8, 16, 32"),
        (&["chart", "sphere", "--against", "no_such.json"], "no_such.json"),
        (&["chart", "--scaling", "sphere"], "--scaling"),
        (&["chart", "--filters", "sphere"], "--filters"),
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

#[test]
fn an_interrupted_run_goes_on_where_it_stopped() {
    let folder = folder("chart_interrupted");
    let arguments = ["chart", "sphere", "teapot", "--quick", "--adapter", "cpu", "-o", "chart"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_halfway"));
    let command = command.args(arguments).current_dir(&folder).stdout(Stdio::null()).stderr(Stdio::null());
    let mut run = command.spawn().expect("the command was built with this test");
    let unfinished = folder.join("chart/unfinished.jsonl");
    let lines = || fs::read_to_string(&unfinished).unwrap_or_default().lines().map(str::to_owned).collect::<Vec<_>>();
    let start = Instant::now();
    // The run itself, the first scene's truth, six points, and one that may be cut off in the middle.
    while lines().len() < 9 {
        assert!(start.elapsed() < Duration::from_mins(5) && run.try_wait().expect("a process").is_none());
        std::thread::sleep(Duration::from_millis(5));
    }
    run.kill().expect("it still runs");
    run.wait().expect("it has ended");
    assert!(!folder.join("chart/index.html").exists(), "nothing is written before all is measured");
    let kept: Vec<serde_json::Value> = lines().iter().filter_map(|line| serde_json::from_str(line).ok()).collect();
    let known: Vec<_> = kept.iter().filter(|line| line[1]["ms"].is_object()).collect();
    assert!(known.len() >= 6, "{}", kept.len());
    succeeds(&folder, &arguments);
    let chart = json(&folder.join("chart/chart.json"));
    let points = chart["points"].as_array().expect("points");
    assert_eq!(points.len(), 2 * 3 * 7);
    for line in known {
        // To the last digit: a frame does not take the same time twice.
        assert!(
            points.iter().any(|point| point["ms"] == line[1]["ms"]["median"] && point["method"] == line[1]["method"])
        );
    }
}
