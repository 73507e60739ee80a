//! The tables of `docs/scene-format.md` and the schema say the same: keys, defaults and ranges, by their values.

use std::collections::BTreeSet;
use std::path::Path;

use halfway_mesh::NormalWeighting;
use serde_json::{Value, json};

use halfway_scene::{SceneFile, json_schema};

fn page() -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/scene-format.md");
    std::fs::read_to_string(file).unwrap()
}

fn schema() -> Value {
    serde_json::from_str(&json_schema()).unwrap()
}

/// The schema in `docs/` is the one of the tables. To bring it up to date, run the test with the environment variable
/// `HALFWAY_WRITE_SCHEMA=1`.
#[test]
fn the_written_schema_is_up_to_date() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/scene.schema.json");
    if std::env::var_os("HALFWAY_WRITE_SCHEMA").is_some() {
        std::fs::write(file, json_schema()).unwrap();
    }
    let written = std::fs::read_to_string(file).unwrap_or_default();
    assert!(
        written == json_schema(),
        "{file} is out of date; write it anew by\n    HALFWAY_WRITE_SCHEMA=1 cargo test -p halfway_scene schema"
    );
}

/// The rows of the `index`-th table under a heading whose first cell is a key: the cells of each, without the backticks
/// of the key.
fn table(page: &str, heading: &str, index: usize) -> Vec<Vec<String>> {
    let (_, section) = page.split_once(&format!("\n{heading}\n")).unwrap_or_else(|| panic!("no heading {heading}"));
    let section = section.split("\n#").next().unwrap_or_default();
    let tables = section.split("\n\n").filter(|block| block.trim_start().starts_with("| key |"));
    let table = tables.into_iter().nth(index).unwrap_or_else(|| panic!("no table {index} under {heading}"));
    table
        .trim()
        .lines()
        .skip(2)
        .map(|row| {
            let cells = row.trim_matches('|').split(" | ").map(str::trim).enumerate();
            cells.map(|(i, cell)| if i == 0 { cell.trim_matches('`') } else { cell }.to_owned()).collect()
        })
        .collect()
}

/// The value that a cell shows: `null` for a dash, which stands for no such key.
fn shown(cell: &str) -> Option<Value> {
    let text = cell.strip_prefix('`')?.strip_suffix('`')?;
    serde_json::from_str(text).ok()
}

/// Whether two defaults are the same, 1 and 1.0 being one number.
fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => near(a.as_f64(), b.as_f64()),
        (Value::Array(a), Value::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
        _ => a == b,
    }
}

/// Equal to the rounding of `serde_json`, which reads numbers to within a few units of the last place of an `f64`.
fn near(a: Option<f64>, b: Option<f64>) -> bool {
    matches!((a, b), (Some(a), Some(b)) if (a - b).abs() <= 1e-14 * a.abs())
}

/// The words for the range of a key in its row, in the words of the page; colors are said once for all.
fn range_in_words(property: &Value) -> Option<String> {
    if property.get("const").is_some() || property.get("enum").is_some() {
        return None;
    }
    let number = if property.get("items").is_some() { &property["items"] } else { property };
    if let Some(either) = number.get("anyOf").and_then(Value::as_array)
        && either.iter().any(|one| one.get("maximum").is_some())
    {
        return range_in_words(&either[0]);
    }
    let get = |key: &str| number.get(key).and_then(Value::as_f64);
    match (get("minimum"), get("maximum"), get("exclusiveMinimum"), get("exclusiveMaximum")) {
        (Some(least), Some(most), ..) if (least, most) == (0.0, 1e12) => None,
        (Some(least), Some(most), ..) => Some(format!("{least} to {most}")),
        (Some(least), ..) => Some(format!("{least} or more")),
        (_, _, Some(above), Some(below)) => Some(format!("above {above} and below {below}")),
        (_, _, Some(above), None) => Some(format!("above {above}")),
        _ => None,
    }
}

/// Compares one table with the properties of one object of the schema; says every difference.
fn differences(rows: &[Vec<String>], object: &Value, what: &str) -> Vec<String> {
    let properties = object["properties"].as_object().unwrap_or_else(|| panic!("{what} has no properties"));
    let required: Vec<&str> = object["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    let documented: BTreeSet<&str> = rows.iter().map(|row| row[0].as_str()).collect();
    let known: BTreeSet<&str> = properties.keys().map(String::as_str).collect();
    let mut wrong: Vec<String> =
        documented.symmetric_difference(&known).map(|key| format!("{what}.{key}: not in both")).collect();
    for row in rows {
        let [key, text, default] = &row[..] else { panic!("{what}: three cells in {row:?}") };
        let Some(property) = properties.get(key) else { continue };
        let expected = property.get("default").cloned().unwrap_or(Value::Null);
        let agrees = match default.as_str() {
            "*required*" => required.contains(&key.as_str()),
            "left out" => property.get("default").is_none(),
            "as it is" => {
                same(&expected["scale"], &json!([1, 1, 1])) && same(&expected["translation"], &json!([0, 0, 0]))
            }
            _ => shown(default).is_some_and(|shown| same(&shown, &expected)),
        };
        if !agrees {
            wrong.push(format!("{what}.{key}: the page says {default}, the schema {expected}"));
        }
        // The words that the page has for a limit which is another key's value, and for single numbers.
        let words = if key == "inner_deg" { Some("0 to `cutoff_deg`".to_owned()) } else { range_in_words(property) };
        let numbers = property.get("const").into_iter().chain(property["enum"].as_array().into_iter().flatten());
        for number in numbers.filter(|one| one.is_number()) {
            if !text.contains(&format!("`{number}`")) {
                wrong.push(format!("{what}.{key}: the page does not say `{number}`: {text}"));
            }
        }
        if let Some(words) = words
            && !text.to_lowercase().contains(&words)
        {
            wrong.push(format!("{what}.{key}: the page does not say \"{words}\": {text}"));
        }
    }
    wrong
}

/// The definition in which the schema has the keys of materials: the object among the two things that a material can
/// be.
fn material(schema: &Value) -> Value {
    let ways = schema["$defs"]["MaterialEntry"]["anyOf"].as_array().expect("a name or values");
    ways.iter().find(|way| way.get("properties").is_some()).expect("values").clone()
}

#[test]
fn the_page_has_the_keys_defaults_and_ranges_of_the_schema() {
    let (page, schema) = (page(), schema());
    let definitions = &schema["$defs"];
    let wrong = [
        differences(&table(&page, "## The scene", 0), &schema, "scene"),
        differences(&table(&page, "## The scene", 1), &definitions["Tolerance"], "tolerance"),
        differences(&table(&page, "## Camera", 0), &definitions["CameraEntry"], "camera"),
        differences(&table(&page, "## Camera", 1), &definitions["IntrinsicsEntry"], "intrinsics"),
        differences(&table(&page, "## Camera", 2), &definitions["ViewportEntry"], "viewport"),
        differences(&table(&page, "## Animations", 0), &definitions["TrackEntry"], "track"),
        differences(&table(&page, "## Environment", 0), &definitions["EnvironmentEntry"], "environment"),
        differences(&table(&page, "## Objects", 0), &definitions["ObjectEntry"], "object"),
        differences(&table(&page, "### Edges", 0), &definitions["EdgesEntry"], "edges"),
        differences(&table(&page, "### Scalars", 0), &definitions["ScalarsEntry"], "scalars"),
        differences(&table(&page, "### Lines and points", 0), &definitions["LineStyleEntry"], "line_style"),
        differences(&table(&page, "### Displacement", 0), &definitions["DisplacementEntry"], "displacement"),
        differences(&table(&page, "### Solids", 0), &definitions["SolidEntry"], "solid"),
        differences(&table(&page, "### Transforms", 0), &definitions["TransformParts"], "transform"),
        differences(&table(&page, "### Materials", 0), &material(&schema), "material"),
    ]
    .concat();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_page_has_the_keys_and_defaults_of_every_light() {
    let (page, schema) = (page(), schema());
    let (shared, own) = (table(&page, "## Lights", 0), table(&page, "## Lights", 1));
    let kinds = schema["$defs"]["LightEntry"]["oneOf"].as_array().expect("kinds of light");
    assert_eq!(kinds.len(), 5);
    let mut wrong = Vec::new();
    for kind in kinds {
        let name = kind["properties"]["kind"]["const"].as_str().expect("a name");
        let kinds = ["point", "spot", "directional", "homogeneous", "hemisphere"];
        let column = kinds.iter().position(|it| *it == name).expect("a column");
        let mut rows = shared.clone();
        for row in &own {
            let cell = if row[column + 1] == "same" { &row[1] } else { &row[column + 1] };
            if cell != "–" {
                rows.push(vec![row[0].clone(), row[6].clone(), cell.clone()]);
            }
        }
        wrong.extend(differences(&rows, kind, name));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_page_has_the_defaults_and_ranges_of_surfaces() {
    let (page, schema) = (page(), schema());
    let mut seen = 0;
    for row in page.lines().filter(|line| line.starts_with("| `{\"")) {
        let cells: Vec<&str> = row.trim_matches('|').split(" | ").map(str::trim).collect();
        let Some(Value::Object(shape)) = shown(cells[0]) else { continue };
        let (name, values) = shape.iter().next().expect("one key");
        let definition = match name.as_str() {
            "uv_sphere" => "UvSphere",
            "plane" => "Plane",
            "box" => "Cuboid",
            "teapot" => "Teapot",
            "icosphere" => "Icosphere",
            "ellipsoid" => "EllipsoidEntry",
            "cylinder" => "CylinderEntry",
            "cone" => "ConeMeshEntry",
            "torus" => "TorusEntry",
            "capsule" => "CapsuleEntry",
            "disc" => "DiscEntry",
            "paraboloid" => "ParaboloidEntry",
            "hyperboloid" => "HyperboloidEntry",
            "hyperboloid_sheet" => "HyperboloidSheetEntry",
            "bezier" => "BezierEntry",
            "polynomial" => "PolynomialEntry",
            "height_field" => "HeightFieldEntry",
            _ => continue,
        };
        seen += 1;
        // Said once for all of them.
        let fineness = "`rows` (1 to 2048) × `columns` (1 to 4096)";
        assert!(page.contains(fineness) && page.contains("with a `chord_error` above 0"));
        let properties = schema["$defs"][definition]["properties"].as_object().expect("properties");
        for (key, property) in properties {
            assert!(same(&values[key], &property["default"]), "{name}.{key}: {} {property}", values[key]);
            let is_fineness =
                definition.ends_with("Entry") && ["rows", "columns", "chord_error"].contains(&key.as_str());
            let Some(words) = range_in_words(property).filter(|_| !is_fineness) else { continue };
            let lengths = is_length(property) && page.contains("Lengths of surfaces are from 1e-30 to 1e30.");
            assert!(lengths || cells[1].contains(&words), "{name}.{key}: {words}");
        }
    }
    assert_eq!(seen, 17);
}

fn is_length(property: &Value) -> bool {
    let number = property.get("items").unwrap_or(property);
    near(number["minimum"].as_f64(), Some(1e-30)) && near(number["maximum"].as_f64(), Some(1e30))
}

#[test]
fn the_page_says_what_is_used_where_there_are_no_normals() {
    let default = format!("{:?}", NormalWeighting::default()).to_lowercase();
    assert!(
        page().contains(&format!("`\"keep\"`: the file's or the surface's own, else `\"{default}\"`.")),
        "{default}"
    );
}

/// Every word that the schema offers is accepted by `SceneFile`.
#[test]
fn every_word_of_the_schema_is_accepted() {
    let schema = schema();
    let mut tried = 0;
    for (object, wrap) in
        [(&schema, ["{", "}"]), (&schema["$defs"]["ObjectEntry"], [r#"{"objects": [{"mesh": {"box": {}}, "#, "}]}"])]
    {
        for (key, property) in object["properties"].as_object().expect("properties") {
            let mut definitions = vec![property];
            while let Some(definition) = definitions.pop() {
                if let Some(name) = definition.get("$ref").and_then(Value::as_str) {
                    definitions.push(schema.pointer(name.trim_start_matches('#')).expect("a definition"));
                }
                for ways in ["oneOf", "anyOf"] {
                    definitions.extend(definition.get(ways).and_then(Value::as_array).into_iter().flatten());
                }
                if let Some(word) = definition.get("const").filter(|word| word.is_string()) {
                    let text = format!("{}\"{key}\": {word}{}", wrap[0], wrap[1]);
                    assert!(SceneFile::from_json(&text, "schema").is_ok(), "{text} is in the schema and refused");
                    tried += 1;
                }
            }
        }
    }
    assert!(tried > 20, "{tried} words");
}

/// A page that says something else is found out: the comparison itself can fail.
#[test]
fn a_page_that_contradicts_the_schema_is_found() {
    let (page, schema) = (page(), schema());
    for (right, wrong) in
        [("| `45` |", "| `50` |"), ("above 0 and below 180", "from 0 to 180"), ("| `near` |", "| `close` |")]
    {
        assert!(page.contains(right), "{right}");
        let spoilt = page.replace(right, wrong);
        let found = differences(&table(&spoilt, "## Camera", 0), &schema["$defs"]["CameraEntry"], "camera");
        assert!(!found.is_empty(), "{wrong} passes");
    }
}
