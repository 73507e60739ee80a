//! Surfaces of every tessellation, and meshes written out.

use fastrand::Rng;
use serde_json::{Value, json};

use super::{Object, short, shorts};
use crate::random::RngExt;

pub(super) fn mesh(random: &mut Rng, unit: f64) -> Value {
    let size = unit * random.between(0.4, 1.6);
    if random.percent(30) {
        return surface(random, size);
    }
    match random.u64(0..=99) {
        0..35 => json!({ "uv_sphere": {
            "radius": short(size),
            "segments": random.magnitude(1, 5).floor() as u64 + 1,
            "rings": random.magnitude(1, 4).floor() as u64,
        }}),
        35..50 => json!({ "box": { "size": shorts([size, unit * random.between(0.2, 1.6), unit]) } }),
        50..65 => {
            let divisions = random.magnitude(0, 4).floor() as u64;
            json!({ "plane": { "size": short(size * random.choose(&[1.0, 2.0, 8.0])), "divisions": divisions } })
        }
        // Its size is fixed.
        65..75 if (0.25..4.0).contains(&unit) => json!({ "teapot": { "divisions": random.u64(1..=6) } }),
        65..80 => {
            let cells = random.u64(1..=8);
            inline(random, terrain(cells, size))
        }
        80..90 => inline(random, tetrahedron(size)),
        _ => {
            let count = random.u64(1..=8);
            let mesh = soup(random, count, size);
            inline(random, mesh)
        }
    }
}

/// A surface by formula, cut by count or by chord error.
fn surface(random: &mut Rng, size: f64) -> Value {
    let mut keys = Object::new();
    let name = random.choose(&[
        "icosphere",
        "ellipsoid",
        "cylinder",
        "cone",
        "torus",
        "capsule",
        "disc",
        "paraboloid",
        "hyperboloid",
        "hyperboloid_sheet",
        "bezier",
        "polynomial",
        "height_field",
    ]);
    let share = |random: &mut Rng| short(size * random.between(0.3, 0.9));
    if !["ellipsoid", "bezier", "polynomial", "height_field"].contains(&name) {
        keys.set("radius", json!(short(size)));
    }
    match name {
        "icosphere" => keys.set("divisions", json!(random.u64(1..=8))),
        "ellipsoid" => keys.set("radii", shorts([size, share(random), share(random)])),
        "cylinder" | "cone" => {
            keys.set("height", json!(share(random)));
            keys.perhaps(random, 70, "capped", |random| random.percent(50).into());
        }
        "torus" => keys.set("tube", json!(share(random))),
        "capsule" => keys.set("length", json!(share(random))),
        "disc" => {
            keys.perhaps(random, 70, "center", |random| shorts(random.direction().map(|c| c * size)));
            keys.perhaps(random, 70, "normal", |random| shorts(random.direction()));
        }
        "paraboloid" => keys.set("height", json!(share(random))),
        "hyperboloid" => {
            keys.set("waist", json!(share(random)));
            keys.set("height", json!(short(size * random.between(0.5, 2.0))));
        }
        "hyperboloid_sheet" => {
            keys.set("gap", json!(share(random)));
            keys.set("height", json!(share(random)));
            keys.perhaps(random, 70, "upper", |random| random.percent(50).into());
        }
        "height_field" => {
            let [rows, columns] = [random.u64(2..=5), random.u64(2..=5)];
            let row =
                |random: &mut Rng| -> Value { (0..columns).map(|_| short(random.f64())).collect::<Vec<_>>().into() };
            keys.set("size", shorts([2.0 * size, size]));
            keys.set("amount", json!(share(random)));
            keys.set("heights", (0..rows).map(|_| row(random)).collect::<Vec<_>>().into());
        }
        _ => {
            let [rows, columns] = [random.u64(2..=4), random.u64(2..=4)];
            let along = |i: u64, count: u64| 2.0 * size * (i as f64 / (count - 1) as f64 - 0.5);
            let rows = (0..rows).map(|i| {
                let point = |j: u64| {
                    let [x, y, z] = random.direction().map(|c| 0.4 * size * c);
                    shorts([x - along(j, columns), y, z + along(i, rows)])
                };
                Value::from((0..columns).map(point).collect::<Vec<_>>())
            });
            let points = Value::from(rows.collect::<Vec<_>>());
            keys.set(if name == "bezier" { "points" } else { "coefficients" }, points);
        }
    }
    if name != "icosphere" {
        keys.perhaps(random, 60, "rows", |random| random.u64(3..=12).into());
        keys.perhaps(random, 60, "columns", |random| random.u64(3..=24).into());
        keys.perhaps(random, 25, "chord_error", |random| json!(short(size * random.between(0.01, 0.1))));
    }
    json!({ name: Value::from(keys) })
}

/// Positions and triangles.
type Written = (Vec<[f64; 3]>, Vec<u64>);

/// Written out, with normals and texture coordinates or without.
fn inline(random: &mut Rng, (mut positions, indices): Written) -> Value {
    let size = positions.iter().flatten().fold(0.0, |most: f64, c| most.max(c.abs()));
    let uneven = random.between(0.0, 0.3) * size;
    for position in &mut positions {
        for c in position {
            *c = short(*c + random.between(-uneven, uneven));
        }
    }
    let mut inline = Object::new();
    inline.set("indices", indices.into());
    inline.perhaps(random, 30, "normals", |random| {
        let toward = random.direction();
        let normals = positions.iter().flat_map(|_| {
            let [x, y, z] = random.direction();
            [toward[0] + 0.7 * x, toward[1] + 0.7 * y, toward[2] + 0.7 * z].map(short)
        });
        normals.collect::<Vec<f64>>().into()
    });
    inline.perhaps(random, 10, "uvs", |random| {
        (0..2 * positions.len()).map(|_| short(random.f64())).collect::<Vec<f64>>().into()
    });
    inline.perhaps(random, 25, "colors", |random| {
        // Some outside of 0 to 1.
        (0..4 * positions.len()).map(|_| short(random.between(-0.1, 1.1))).collect::<Vec<f64>>().into()
    });
    inline.set("positions", positions.concat().into());
    let inline = Value::from(inline);
    json!({ "inline": inline })
}

/// Squares of two triangles each, facing +Y.
fn terrain(cells: u64, size: f64) -> Written {
    let width = cells + 1;
    let along = |i: u64| (i as f64 / cells as f64 - 0.5) * 2.0 * size;
    let positions = (0..width * width).map(|i| [along(i % width), 0.0, along(i / width)]).collect();
    let corners = (0..cells * cells).map(|i| i / cells * width + i % cells);
    (positions, corners.flat_map(|i| [i, i + width, i + 1, i + 1, i + width, i + width + 1]).collect())
}

fn tetrahedron(size: f64) -> Written {
    let corners = [[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]];
    let corners = corners.map(|corner: [f64; 3]| corner.map(|c| c * size * 0.6));
    (corners.to_vec(), vec![0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3])
}

/// Triangles anywhere, which may share corners, be slivers or have no area.
fn soup(random: &mut Rng, triangles: u64, size: f64) -> Written {
    let vertices = random.u64(3..=2 + 2 * triangles);
    let positions = (0..vertices).map(|_| std::array::from_fn(|_| random.between(-size, size))).collect();
    (positions, (0..3 * triangles).map(|_| random.u64(..vertices)).collect())
}
