//! Writes the project's own models into `assets/`: `cargo run -p halfway_mesh --example make_assets`.
//!
//! The output is the same at every run; the crate's tests compare it with the files.

use std::f32::consts::{FRAC_1_SQRT_2, TAU};
use std::fmt::Write as _;
use std::path::Path;

use glam::{Vec2, Vec3};
use halfway_mesh::{Bounds, Mesh, Teapot};

#[path = "make_assets/fish.rs"]
mod fish;
#[path = "make_assets/textured.rs"]
mod textured;

fn main() -> std::io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets");
    for (name, bytes) in assets() {
        println!("{name}: {} bytes", bytes.len());
        std::fs::write(folder.join(name), bytes)?;
    }
    Ok(())
}

/// Every file and its content.
pub fn assets() -> [(&'static str, Vec<u8>); 11] {
    [
        ("cube.smf", CUBE.into()),
        ("teapot.mtl", BRASS.into()),
        ("teapot.obj", teapot_obj().into_bytes()),
        ("lantern.glb", lantern_glb()),
        ("crate.mtl", textured::PLANKS.into()),
        ("crate.obj", textured::crate_obj().into_bytes()),
        ("crate.png", textured::crate_color()),
        ("crate_height.png", textured::crate_height()),
        ("ball.glb", textured::ball_glb()),
        ("fish.glb", fish::fish_glb()),
        ("helix.obj", helix_obj().into_bytes()),
    ]
}

/// A cube of edge 2, two triangles a side.
const CUBE: &str = "\
#$SMF 1.0
## A cube about the origin, with edges of length 2.
#$vertices 8
#$faces 12
v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
## back and front
f 1 3 2
f 1 4 3
f 5 6 7
f 5 7 8
## left and right
f 1 5 8
f 1 8 4
f 2 3 7
f 2 7 6
## bottom and top
f 1 2 6
f 1 6 5
f 4 8 7
f 4 7 3
";

/// The textbook's brass, as in the teapots of the OpenGL Programming Guide.
const BRASS: &str = "\
newmtl brass
Ka 0.329412 0.223529 0.027451
Kd 0.780392 0.568627 0.113725
Ks 0.992157 0.941176 0.807843
Ns 27.8974
d 1
illum 2
";

/// Two strands of lines around the y axis, joined by rungs between points.
fn helix_obj() -> String {
    const STEPS: usize = 96;
    const RUNGS: usize = 24;
    let mut text = String::from("# A double helix of lines and points; written by make_assets.\n");
    for (strand, color) in ["0.92 0.55 0.15", "0.2 0.55 0.95"].into_iter().enumerate() {
        for step in 0..=STEPS {
            let t = step as f32 / STEPS as f32;
            let (sin, cos) = (TAU * (2.0 * t + 0.5 * strand as f32)).sin_cos();
            let _ = writeln!(text, "v {:.4} {:.4} {:.4} {color}", 0.7 * cos, 3.0 * t - 1.5, 0.7 * sin);
        }
    }
    for strand in 0..2 {
        let _ = writeln!(text, "o strand{strand}");
        let first = 1 + strand * (STEPS + 1);
        let numbers: Vec<String> = (first..=first + STEPS).map(|number| number.to_string()).collect();
        let _ = writeln!(text, "l {}", numbers.join(" "));
    }
    text.push_str("o rungs\n");
    for rung in 0..=RUNGS {
        let step = 1 + rung * STEPS / RUNGS;
        let other = step + STEPS + 1;
        let _ = writeln!(text, "l {step} {other}\np {step} {other}");
    }
    text
}

/// How many cells an edge of the teapot's patches has.
const DIVISIONS: u32 = 8;

/// The teapot's objects, and how many of its patches in order each takes; the bottom comes last.
const OBJECTS: [(&str, usize); 5] = [("body", 12), ("handle", 4), ("spout", 4), ("lid", 8), ("bottom", 4)];

fn teapot_obj() -> String {
    let mesh = Mesh::from(Teapot::new(DIVISIONS));
    let mut lines = ["v", "vt", "vn"].map(NumberedLines::new);
    let corners: Vec<[usize; 3]> = (0..mesh.positions().len())
        .map(|i| {
            let uv = mesh.uvs().map_or(Vec2::ZERO, |uvs| uvs[i]);
            [
                lines[0].number(&mesh.positions()[i].to_array(), 5),
                lines[1].number(&[uv.x, 1.0 - uv.y], 4),
                lines[2].number(&mesh.normals()[i].to_array(), 4),
            ]
        })
        .collect();

    let mut text = format!(
        "# The Utah teapot, {DIVISIONS} x {DIVISIONS} cells a patch; written by make_assets.\nmtllib teapot.mtl\n{}{}{}",
        lines[0].text, lines[1].text, lines[2].text
    );
    let per_patch = (DIVISIONS as usize + 1).pow(2);
    let mut triangles = mesh.triangles().peekable();
    let mut end = 0;
    for (name, patches) in OBJECTS {
        end += patches * per_patch;
        let _ = writeln!(text, "o {name}\nusemtl brass");
        while let Some(triangle) = triangles.next_if(|[a, ..]| (*a as usize) < end) {
            let [a, b, c] = triangle.map(|i| corners[i as usize].map(|n| n.to_string()).join("/"));
            let _ = writeln!(text, "f {a} {b} {c}");
        }
    }
    text
}

/// Statements of one kind, each written once.
struct NumberedLines {
    keyword: &'static str,
    text: String,
    known: std::collections::HashMap<String, usize>,
}

impl NumberedLines {
    fn new(keyword: &'static str) -> Self {
        Self { keyword, text: String::new(), known: std::collections::HashMap::new() }
    }

    /// The number of the statement with these numbers, from 1.
    fn number(&mut self, numbers: &[f32], decimals: usize) -> usize {
        let words: Vec<String> = numbers
            .iter()
            .map(|x| {
                let word = format!("{x:.decimals$}");
                let short = word.trim_end_matches('0').trim_end_matches('.');
                if short == "-0" { "0".to_owned() } else { short.to_owned() }
            })
            .collect();
        let line = format!("{} {}\n", self.keyword, words.join(" "));
        let next = self.known.len() + 1;
        *self.known.entry(line).or_insert_with_key(|line| {
            self.text.push_str(line);
            next
        })
    }
}

/// A shape of positions, normals and triangles.
#[derive(Default)]
struct LanternPart {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    indices: Vec<u16>,
}

impl LanternPart {
    /// Adds a closed band: rings of equally many vertices, one above the other. Seen from the front a ring runs to the
    /// left.
    fn add_rings(&mut self, rings: &[Vec<(Vec3, Vec3)>]) {
        let around = rings[0].len();
        let first = self.positions.len();
        for &(position, normal) in rings.iter().flatten() {
            self.positions.push(position);
            self.normals.push(normal.normalize());
        }
        for ring in 0..rings.len() - 1 {
            for i in 0..around {
                let at = |ring: usize, i: usize| first + ring * around + i % around;
                let [a, b, c, d] = [at(ring, i), at(ring, i + 1), at(ring + 1, i), at(ring + 1, i + 1)];
                for triangle in [[a, d, b], [a, c, d]] {
                    let [p, q, r] = triangle.map(|i| self.positions[i]);
                    if p != q && q != r && r != p {
                        self.indices.extend(triangle.map(|i| i as u16));
                    }
                }
            }
        }
    }
}

/// Sine and cosine of i / n of a turn.
fn turn(i: usize, n: usize) -> (f32, f32) {
    (i as f32 / n as f32 * TAU).sin_cos()
}

/// The surface of revolution about the Y axis of a profile of (radius, height), from its lower end upward. Its bands
/// meet in edges, or smoothly.
fn lathe(profile: &[(f32, f32)], segments: usize, smooth: bool) -> LanternPart {
    let slope = |i: usize| {
        let ((r0, y0), (r1, y1)) = (profile[i], profile[i + 1]);
        Vec2::new(y1 - y0, r0 - r1).normalize()
    };
    let bands = profile.len() - 1;
    let mean = |i: usize| slope(i.saturating_sub(1)) + slope(i.min(bands - 1));
    let ring = |(radius, height): (f32, f32), normal: Vec2| -> Vec<(Vec3, Vec3)> {
        (0..segments)
            .map(|i| {
                let (sin, cos) = turn(i, segments);
                let position = Vec3::new(radius * cos, height, radius * sin);
                (position, Vec3::new(normal.x * cos, normal.y, normal.x * sin))
            })
            .collect()
    };
    let mut shape = LanternPart::default();
    if smooth {
        let rings: Vec<_> = profile.iter().enumerate().map(|(i, &point)| ring(point, mean(i))).collect();
        shape.add_rings(&rings);
    } else {
        for band in 0..bands {
            shape.add_rings(&[ring(profile[band], slope(band)), ring(profile[band + 1], slope(band))]);
        }
    }
    shape
}

/// A ring about the Y axis.
fn torus(radius: f32, thickness: f32, segments: usize, sides: usize) -> LanternPart {
    let ring = |j: usize| {
        let (sin_side, cos_side) = turn(j % sides, sides);
        (0..segments)
            .map(|i| {
                let (sin, cos) = turn(i, segments);
                let normal = Vec3::new(cos_side * cos, sin_side, cos_side * sin);
                (Vec3::new(cos, 0.0, sin) * radius + normal * thickness, normal)
            })
            .collect()
    };
    let mut shape = LanternPart::default();
    shape.add_rings(&(0..=sides).map(ring).collect::<Vec<_>>());
    shape
}

/// The flame's profile: a drop.
fn drop_profile() -> Vec<(f32, f32)> {
    (0..=12)
        .map(|i| {
            let t = i as f32 / 12.0;
            let radius = if i == 12 { 0.0 } else { (std::f32::consts::PI * t).sin() * (1.0 - t).sqrt() };
            (radius, 2.0 * t - 0.6)
        })
        .collect()
}

/// The meshes of the lantern with the number of their material.
fn lantern_shapes() -> [(&'static str, LanternPart, usize); 7] {
    let base = [(0.0, -1.0), (0.62, -1.0), (0.66, -0.92), (0.5, -0.84), (0.5, -0.76), (0.0, -0.76)];
    let roof = [(0.0, 0.7), (0.62, 0.7), (0.66, 0.76), (0.3, 1.0), (0.16, 1.04), (0.16, 1.12), (0.0, 1.16)];
    let candle = [(0.17, -0.76), (0.16, -0.22), (0.13, -0.19), (0.0, -0.21)];
    [
        ("base", lathe(&base, 32, false), 0),
        ("roof", lathe(&roof, 32, false), 0),
        ("bar", lathe(&[(0.03, -0.76), (0.03, 0.7)], 12, true), 0),
        ("ring", torus(0.2, 0.025, 32, 10), 0),
        ("glass", lathe(&[(0.4, -0.76), (0.4, 0.7)], 32, true), 1),
        ("candle", lathe(&candle, 24, false), 2),
        ("flame", lathe(&drop_profile(), 16, true), 3),
    ]
}

const LANTERN_MATERIALS: &str = r#"[
{"name":"iron","pbrMetallicRoughness":{"baseColorFactor":[0.17,0.16,0.15,1],"metallicFactor":1,"roughnessFactor":0.4}},
{"name":"glass","alphaMode":"BLEND","doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[0.8,0.9,0.9,0.2],"metallicFactor":0,"roughnessFactor":0.1}},
{"name":"wax","pbrMetallicRoughness":{"baseColorFactor":[0.9,0.84,0.7,1],"metallicFactor":0,"roughnessFactor":0.7}},
{"name":"flame","emissiveFactor":[1,0.66,0.22],"pbrMetallicRoughness":{"baseColorFactor":[0,0,0,1],"metallicFactor":0,"roughnessFactor":1}}
]"#;

const LANTERN_LIGHTS: &str = r#"{"KHR_lights_punctual":{"lights":[{"name":"candle light","type":"point","color":[1,0.72,0.36],"intensity":3,"range":12}]}}"#;

/// How many bars stand around the glass.
const BARS: usize = 6;

/// The nodes: the lantern, its pieces, the arms that carry the bars, and the bars.
fn lantern_nodes() -> String {
    let children = |numbers: std::ops::Range<usize>| numbers.map(|i| i.to_string()).collect::<Vec<_>>().join(",");
    let mut nodes = vec![
        format!(r#"{{"name":"lantern","children":[{}]}}"#, children(1..7 + BARS)),
        r#"{"name":"base","mesh":0}"#.to_owned(),
        r#"{"name":"roof","mesh":1}"#.to_owned(),
        // Upright: a quarter of a turn about the X axis.
        format!(
            r#"{{"name":"ring","mesh":3,"translation":[0,1.34,0],"rotation":[{FRAC_1_SQRT_2},0,0,{FRAC_1_SQRT_2}]}}"#
        ),
        r#"{"name":"glass","mesh":4}"#.to_owned(),
        r#"{"name":"candle","mesh":5}"#.to_owned(),
        format!(
            r#"{{"name":"flame","mesh":6,"translation":[0,-0.07,0],"scale":[0.06,0.12,0.06],"children":[{}]}}"#,
            7 + 2 * BARS
        ),
    ];
    for i in 0..BARS {
        // Half the angle, as quaternions have it.
        let (sin, cos) = turn(2 * i + 1, 4 * BARS);
        nodes.push(format!(r#"{{"name":"arm","rotation":[0,{sin},0,{cos}],"children":[{}]}}"#, 7 + BARS + i));
    }
    for _ in 0..BARS {
        nodes.push(r#"{"name":"bar","mesh":2,"translation":[0.47,0,0]}"#.to_owned());
    }
    nodes.push(
        r#"{"name":"candle light","translation":[0,0.5,0],"extensions":{"KHR_lights_punctual":{"light":0}}}"#
            .to_owned(),
    );
    nodes.join(",\n")
}

/// The lantern: iron, glass, a candle, and the light of its flame.
fn lantern_glb() -> Vec<u8> {
    let mut bytes = Vec::new();
    let (mut meshes, mut accessors, mut views) = (Vec::new(), Vec::new(), Vec::new());
    let mut view = |bytes: &mut Vec<u8>, data: &[u8], target: u32| {
        let text =
            format!(r#"{{"buffer":0,"byteOffset":{},"byteLength":{},"target":{target}}}"#, bytes.len(), data.len());
        views.push(text);
        bytes.extend_from_slice(data);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    };
    for (i, (name, shape, material)) in lantern_shapes().into_iter().enumerate() {
        let floats = |v: &[Vec3]| v.iter().flat_map(Vec3::to_array).flat_map(f32::to_le_bytes).collect::<Vec<_>>();
        view(&mut bytes, &floats(&shape.positions), 34962);
        view(&mut bytes, &floats(&shape.normals), 34962);
        let indices: Vec<u8> = shape.indices.iter().copied().flat_map(u16::to_le_bytes).collect();
        view(&mut bytes, &indices, 34963);

        let Some(Bounds { min, max }) = Bounds::from_points(shape.positions.iter().copied()) else {
            continue;
        };
        let (count, first) = (shape.positions.len(), 3 * i);
        accessors.push(format!(
            r#"{{"bufferView":{first},"componentType":5126,"type":"VEC3","count":{count},"min":{:?},"max":{:?}}}"#,
            min.to_array(),
            max.to_array()
        ));
        let (normals, indices) = (first + 1, first + 2);
        accessors.push(format!(r#"{{"bufferView":{normals},"componentType":5126,"type":"VEC3","count":{count}}}"#));
        accessors.push(format!(
            r#"{{"bufferView":{indices},"componentType":5123,"type":"SCALAR","count":{}}}"#,
            shape.indices.len()
        ));
        meshes.push(format!(
            r#"{{"name":"{name}","primitives":[{{"attributes":{{"POSITION":{first},"NORMAL":{normals}}},"indices":{indices},"material":{material}}}]}}"#
        ));
    }
    let json = format!(
        r#"{{"asset":{{"version":"2.0","generator":"make_assets"}},"extensionsUsed":["KHR_lights_punctual"],
"extensions":{LANTERN_LIGHTS},
"scene":0,"scenes":[{{"name":"lantern","nodes":[0]}}],
"nodes":[{}],
"materials":{LANTERN_MATERIALS},
"meshes":[{}],
"accessors":[{}],
"bufferViews":[{}],
"buffers":[{{"byteLength":{}}}]}}"#,
        lantern_nodes(),
        meshes.join(",\n"),
        accessors.join(",\n"),
        views.join(",\n"),
        bytes.len()
    );
    glb(json.into_bytes(), bytes)
}

/// The binary container.
fn glb(json: Vec<u8>, data: Vec<u8>) -> Vec<u8> {
    let header = gltf::binary::Header { magic: *b"glTF", version: 2, length: 0 };
    let glb = gltf::Glb { header, json: json.into(), bin: Some(data.into()) };
    glb.to_vec().expect("writing to memory does not fail")
}
