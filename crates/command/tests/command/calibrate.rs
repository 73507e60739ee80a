//! Prices are measured, kept, taken where frames are timed, and never where pictures are written.

use crate::command::{folder, halfway, succeeds};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

const CALIBRATE: [&str; 4] = ["calibrate", "--adapter", "cpu", "--json"];

/// A scene of which many patches may be shaded at their vertices within 8 steps.
fn ball(folder: &Path) -> String {
    let scene = json!({
        "size": [160, 120],
        "camera": { "position": [0, 0, 3] },
        "lights": [{ "kind": "directional", "direction": [-1, -1, -1] }],
        "objects": [{ "mesh": { "uv_sphere": { "segments": 192, "rings": 96 } }, "material": "brass" }],
    });
    fs::write(folder.join("ball.json"), scene.to_string()).expect("it can be written");
    "ball.json".to_owned()
}

/// What `bench` draws by, how many terms it shades at vertices under automatic shading, and what it says to people.
fn used(folder: &Path) -> (Value, u64, String) {
    let bench = ["bench", &ball(folder), "--rounds", "1", "--adapter", "cpu", "--tolerance", "8,0", "--json"];
    let output = halfway(folder, &bench);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{error}");
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let rows = value["rows"].as_array().expect("rows");
    let auto = rows.iter().find(|row| row["shading"] == "auto").expect("a row");
    (value["prices"].clone(), auto["report"]["terms_at_vertices"].as_u64().expect("a count"), error)
}

fn picture(folder: &Path) -> Vec<u8> {
    let render = ["render", &ball(folder), "--adapter", "cpu", "-o", "auto.png"];
    succeeds(folder, &[&render[..], &["--shading", "auto", "--tolerance", "8,0"]].concat());
    fs::read(folder.join("auto.png")).expect("it was written")
}

/// What was measured; and whether it was kept, the file.
fn measured(folder: &Path) -> (Value, PathBuf) {
    let found: Value = serde_json::from_str(&succeeds(folder, &CALIBRATE)).expect("JSON");
    let file = PathBuf::from(found["file"].as_str().expect("there is a folder"));
    let doubts = found["doubts"].as_array().expect("a list");
    let is_taken = !found["weight"].is_null();
    assert!(!is_taken || doubts.is_empty(), "{found}");
    assert_eq!(found["kept"], is_taken, "{found}");
    assert_eq!(found["not_kept"].is_null(), is_taken, "{found}");
    (found, file)
}

/// What a file of prices says, with these.
fn text(found: &Value, prices: &Value) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let measured_on = &found["measured_on"];
    let file = json!({
        "format": "halfway prices 1", "halfway": version, "measured_on": measured_on, "prices": prices,
    });
    file.to_string()
}

#[test]
fn kept_prices_are_for_frames_and_not_for_pictures() {
    let folder = folder("calibrate");
    let (prices, at_vertices, _) = used(&folder);
    assert_eq!((&prices["measured"], &prices["file"], at_vertices), (&false.into(), &Value::Null, 0));
    let as_ever = picture(&folder);

    let (found, file) = measured(&folder);
    assert!(file.starts_with(folder.join("cache")), "{}", file.display());
    assert_eq!(file.exists(), found["kept"] == true);
    let (prices, ..) = used(&folder);
    assert_eq!(prices["measured"], found["kept"]);

    // By these, everything goes to the vertices that may.
    let mut free = json!({ "light": 0.0, "pixel": 0.0, "look": 0.0, "draw": 0.0 });
    (free["diffuse_alone"], free["specular_alone"]) = (0.75.into(), 0.5.into());
    fs::create_dir_all(file.parent().expect("a folder")).expect("it can be made");
    fs::write(&file, text(&found, &free)).expect("it can be written");
    let (prices, at_vertices, said) = used(&folder);
    assert!(at_vertices > 0, "the prices make no difference");
    assert_eq!((&prices["measured"], prices["file"].as_str()), (&true.into(), file.to_str()));
    assert_eq!((&prices["light"], &prices["diffuse_alone"], said.as_str()), (&0.0.into(), &0.75.into(), ""));
    assert!(picture(&folder) == as_ever, "a picture depends on what was measured");
    let table = succeeds(&folder, &["bench", "s4", "--size", "16x16", "--rounds", "1", "--adapter", "cpu"]);
    assert!(table.contains("prices of automatic shading: measured, from "), "{table}");

    // A folder may be deleted at any time.
    fs::remove_dir_all(folder.join("cache")).expect("it is there");
    assert_eq!(used(&folder).1, 0);
}

#[test]
fn files_that_are_no_prices_are_told_once_and_not_used() {
    let folder = folder("calibrate_damaged");
    let (found, file) = measured(&folder);
    let good = json!({
        "light": 0.0, "pixel": 0.0, "look": 0.0, "draw": 0.0, "diffuse_alone": 1.0, "specular_alone": 1.0,
    });
    let mut negative = good.clone();
    negative["look"] = (-1.0).into();
    let mut foreign = found.clone();
    foreign["measured_on"]["driver_version"] = "another".into();
    fs::create_dir_all(file.parent().expect("a folder")).expect("it can be made");
    for (text, problem) in [
        (String::new(), "damaged"),
        (text(&found, &good).replace("prices 1", "prices 0"), "another format"),
        (text(&found, &negative), "VertexPrices.look"),
        (text(&foreign, &good), "another adapter or driver"),
        ("[".repeat(100_000), "damaged"),
    ] {
        fs::write(&file, text).expect("it can be written");
        let (prices, at_vertices, said) = used(&folder);
        assert_eq!((&prices["measured"], at_vertices), (&false.into(), 0), "{problem}");
        assert!(said.matches("warning: ").count() == 1 && said.contains(problem), "{problem}: {said}");
    }
}

#[test]
fn where_nothing_can_be_kept_it_is_said() {
    let folder = folder("calibrate_nowhere");
    fs::write(folder.join("cache"), "no folder").expect("it can be written");
    let output = halfway(&folder, &CALIBRATE[..3]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("not kept: "), "{output:?}");
    assert!(said.contains("| a light at a vertex | "), "{said}");
}
