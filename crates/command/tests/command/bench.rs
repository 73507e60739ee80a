//! The measurements and the output of `bench`.

use crate::command::{asset, folder, halfway, succeeds};
use std::fs;
use std::path::Path;

/// The JSON that `halfway` prints.
fn json_of(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    let value: serde_json::Value = serde_json::from_str(&succeeds(folder, arguments)).expect("JSON");
    for name in ["adapter", "backend", "driver", "driver_version", "halfway", "cpu"] {
        assert!(value["machine"][name].as_str().is_some_and(|text| !text.is_empty()), "{name} in {value}");
    }
    value
}

/// The figures are positive, and the times lie in order.
fn is_timed(row: &serde_json::Value) {
    let spread = &row["frame_ms_spread"];
    let times: Vec<_> = ["min", "lower_quartile", "median", "upper_quartile", "max"]
        .into_iter()
        .map(|name| spread[name].as_f64().unwrap_or(f64::NAN))
        .collect();
    assert!(times[0] > 0.0 && times.is_sorted(), "{row}");
    assert_eq!(row["frame_ms"], spread["median"]);
    // Two frames a round.
    assert_eq!(spread["frames"], 2);
}

#[test]
fn a_benchmark_prints_a_row_for_each_shading() {
    let folder = folder("bench");
    let value = json_of(&folder, &["bench", "s4", "--adapter", "gpu", "--rounds", "1", "--cold", "--json"]);
    assert_eq!(value["size"], serde_json::json!([256, 256]));
    let rows = value["rows"].as_array().expect("rows");
    let shadings: Vec<_> = rows.iter().map(|row| row["shading"].as_str().unwrap_or("")).collect();
    assert_eq!(shadings, ["constant", "flat", "gouraud", "phong", "exact-phong"]);
    for row in rows {
        is_timed(row);
        for figure in ["ratio_to_constant", "ratio_to_exact_phong", "first_frame_ms", "first_frame_cold_ms"] {
            assert!(row[figure].as_f64().is_some_and(|value| value > 0.0), "{figure} in {row}");
        }
        // One sphere of 64 × 32 cells, and nothing moves.
        let counts = [("triangles_in", 3968), ("bytes_uploaded", 0), ("pipelines", 1)];
        for (count, expected) in counts {
            assert_eq!(row["report"][count], expected, "{count} in {row}");
        }
        // One light is compiled in: nothing has lists.
        let lists = (&row["report"]["lights_assigned"], &row["report"]["left_out"]);
        assert_eq!(lists, (&0.into(), &0.0.into()), "{row}");
        let sets = row["cpu_ms"].as_object().expect("the time of each set");
        // The eight sets of a frame, and their total.
        assert!(sets.len() == 9 && sets.values().all(|ms| ms.as_f64().is_some_and(|ms| ms >= 0.0)), "{row}");
        assert!(row["cpu_ms"]["total"].as_f64() <= row["frame_ms_spread"]["max"].as_f64(), "{row}");
    }
    let table = succeeds(&folder, &["bench", "s4", "--rounds", "1"]);
    for text in [
        "256 × 256 pixels",
        "tolerance: exact",
        "driver: ",
        "App::update",
        "own CPU, ms",
        "| phong | ",
        "| exact-phong | ",
    ] {
        assert!(table.contains(text), "{text} is missing in:\n{table}");
    }
}

#[test]
fn any_scene_or_model_is_timed() {
    let folder = folder("bench_files");
    for (file, objects) in [("examples/scenes/brass_teapot.json", 1), ("assets/cube.smf", 1)] {
        let file = asset(file);
        let bench = ["bench", &file, "--adapter", "gpu", "--size", "48x32", "--rounds", "1", "--json"];
        let value = json_of(&folder, &bench);
        assert!(value["scene"].as_str().is_some_and(|name| file.ends_with(name)), "{value}");
        assert_eq!(value["size"], serde_json::json!([48, 32]));
        let rows = value["rows"].as_array().expect("rows");
        assert_eq!(rows.len(), 5);
        for row in rows {
            is_timed(row);
            let counts = ["objects_drawn", "draws"].map(|count| row["report"][count].as_u64());
            assert!(counts.iter().flatten().all(|count| *count >= objects), "{row}");
            // The camera turns.
            assert!(row["report"]["bytes_uploaded"].as_u64().is_some_and(|bytes| bytes > 0), "{row}");
            assert!(row["first_frame_ms"].as_f64().is_some_and(|ms| ms > 0.0), "{row}");
        }
    }
    // The scene's own size.
    let table = succeeds(&folder, &["bench", &asset("examples/scenes/brass_teapot.json"), "--rounds", "1"]);
    assert!(table.contains("scene: brass_teapot.json, ") && table.contains("| constant | "), "{table}");
}

#[test]
fn a_point_of_growth_is_measured_in_a_process_of_its_own() {
    let folder = folder("bench_growth");
    for (point, own_is_little) in
        [("objects-standing:1024", true), ("objects-turning:1024", false), ("lights:64", false)]
    {
        let values = succeeds(&folder, &["bench", "growth", "--adapter", "cpu", "--rounds", "2", "--point", point]);
        let values: Vec<f64> = values.split_whitespace().map(|word| word.parse().expect("a number")).collect();
        let [own, draw, peak] = values[..] else { panic!("{point}: {values:?}") };
        assert!(own > 0.0 && draw > 0.0 && peak > 1.0, "{point}: {values:?}");
        // Nothing is put together anew.
        assert!(!own_is_little || own < draw, "{point}: {values:?}");
    }
    let output = halfway(&folder, &["bench", "s4", "-o", "growth.svg"]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && error.contains("--output"), "{error}");
}

/// A count of each row of a scene file or model whose frames are timed, so many rounds of them.
#[track_caller]
fn counts(folder: &Path, file: &str, rounds: &str, count: &str) -> Vec<u64> {
    let bench = ["bench", file, "--adapter", "cpu", "--size", "16x16", "--rounds", rounds];
    let value = json_of(folder, &[&bench[..], &["--tolerance", "exact", "--json"]].concat());
    let rows = value["rows"].as_array().expect("rows");
    rows.iter().map(|row| row["report"][count].as_u64().expect("a count")).collect()
}

#[test]
fn the_camera_turns_by_one_degree_a_frame() {
    let folder = folder("bench_turn");
    // The second box is seen from around 90° only.
    let scene = r#"{"camera": {"position": [0, 0, 5], "target": [0, 0, 0], "fov_y_deg": 30}, "objects": [
        {"mesh": {"box": {}}}, {"mesh": {"box": {}}, "transform": {"translation": [-10, 0, 0]}}]}"#;
    fs::write(folder.join("turn.json"), scene).expect("the folder can be written");
    // A round draws three frames, one of them not timed, and 3 to 20 go before the first.
    for (rounds, visible) in [("1", 1), ("29", 2), ("59", 1), ("149", 2)] {
        assert_eq!(counts(&folder, "turn.json", rounds, "visible"), [visible; 5], "{rounds} rounds");
    }
}

#[test]
fn a_model_is_timed_under_the_lights_that_it_is_drawn_under() {
    let folder = folder("bench_model_lights");
    let cube = asset("assets/cube.smf");
    let dark = serde_json::json!({ "lights": [], "objects": [{ "mesh": { "path": cube } }] });
    fs::write(folder.join("dark.json"), dark.to_string()).expect("the folder can be written");
    // The studio's four; a candle of its own; and none, since the file says so.
    for (file, lights) in [(cube.as_str(), 4), (&asset("assets/lantern.glb"), 1), ("dark.json", 0)] {
        assert_eq!(counts(&folder, file, "1", "lights"), [lights; 5], "{file}");
    }
}

#[test]
fn a_tolerance_applies_only_on_request() {
    let folder = folder("tolerance");
    let bench = |tolerance: &[&str]| {
        json_of(&folder, &[&["bench", "s4", "--size", "16x16", "--rounds", "1", "--json"], tolerance].concat())
    };
    let drawn = |value: &serde_json::Value| -> Vec<u64> {
        let rows = value["rows"].as_array().expect("rows");
        rows.iter().map(|row| row["report"]["triangles"].as_u64().expect("a count")).collect()
    };
    let [off, default, coarse] = [&["--tolerance", "exact"][..], &[], &["--tolerance", "1,4"]].map(bench);
    assert_eq!((&off["tolerance"]["pixels"], &coarse["tolerance"]["pixels"]), (&0.0.into(), &4.0.into()));
    let [off, default, coarse] = [off, default, coarse].map(|value| drawn(&value));
    assert_eq!(off, default, "exact by default");
    // Flat and Gouraud shading draw all triangles, and the last row is exact under any tolerance.
    let fewer: Vec<bool> = coarse.iter().zip(&off).map(|(coarse, off)| *coarse < off / 2).collect();
    assert_eq!(fewer, [true, false, false, true, false], "{off:?}, {coarse:?}");

    let render = ["render", &asset("assets/teapot.obj"), "--size", "32x32", "-o", "turn.png"];
    succeeds(&folder, &[&render[..], &["--turntable", "3", "--tolerance", "2.5"]].concat());
    succeeds(&folder, &[&render[..], &["--tolerance", "exact"]].concat());
    for bad in ["on", "-1", "inf", ""] {
        let tolerance = format!("--tolerance={bad}");
        let output = halfway(&folder, &[&render[..], &[&tolerance]].concat());
        assert_eq!(output.status.code(), Some(2), "{bad}");
        assert!(String::from_utf8_lossy(&output.stderr).contains("--tolerance <STEPS[,PIXELS]|exact>"), "{output:?}");
    }
}

#[test]
fn features_are_timed_beside_a_baseline() {
    let folder = folder("bench_features");
    let value = json_of(&folder, &["bench", "features", "--rounds", "1", "--json"]);
    let rows = value["rows"].as_array().expect("rows");
    let row = |name: &str| rows.iter().find(|row| row["feature"] == name).unwrap_or_else(|| panic!("no row {name}"));
    let baseline = row("one directional light (the baseline)");
    for stage in ["vertex", "fragment"] {
        for row in rows {
            is_timed(&row[stage]);
        }
        assert_eq!(baseline[stage]["ratio_to_baseline"], 1.0);
        // The scene has the requested lights, and only features of lights have a cost per light.
        for (name, lights) in [("no lights", 0), ("five point lights", 5), ("sixteen directional lights", 16)] {
            assert_eq!(row(name)[stage]["report"]["lights"], lights, "{name}");
        }
        assert!(row("five spot lights")[stage]["light_ns"].is_f64());
        assert!(row("no lights")[stage]["light_ns"].is_null() && row("four samples")[stage]["light_ns"].is_null());
    }
    // A plane of 360 × 360 cells that faces the camera: nothing is left out of it.
    assert_eq!(baseline["vertex"]["report"]["triangles"], 360 * 360 * 2);
    assert_eq!(baseline["vertex"]["report"]["patches_culled"], 0);
    let output = halfway(&folder, &["bench", "features", "--size", "64x64"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no option but --adapter, --rounds and --json"));
}

#[test]
fn lights_that_touch_nothing_are_timed_apart() {
    let folder = folder("bench_lights");
    let value = json_of(&folder, &["bench", "lights", "--adapter", "cpu", "--rounds", "1", "--json"]);
    assert!(value["pair_ns"].is_f64() && value["light_ns"].is_f64(), "{value}");
    // The twelve at each of 8,192 patches, however many others there are.
    let of_rows = |count: &str| {
        let rows = value["rows"].as_array().expect("rows");
        rows.iter().map(|row| row["report"][count].as_u64().expect("a count")).collect::<Vec<_>>()
    };
    assert_eq!(of_rows("lights"), [9, 12, 20_000]);
    assert_eq!(of_rows("light_pairs"), [0, 12 * 8_192, 12 * 8_192]);
    let output = halfway(&folder, &["bench", "lights", "--size", "64x64"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no option but --adapter, --rounds and --json"));
}
