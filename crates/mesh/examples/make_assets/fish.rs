//! A fish whose animation has all that glTF's have: nodes, a skin, a morph target, and every interpolation.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Quat, Vec3};
use halfway_mesh::{Mesh, UvSphere};

use super::glb;

/// Vertices around the body, and rings from the mouth to the end of the tail.
const AROUND: usize = 20;
const RINGS: usize = 32;

/// Where the joints are, along x; the fish looks along x.
const JOINTS: [f32; 3] = [0.15, -0.25, -0.6];

/// The seconds of the animation.
const SECONDS: f32 = 4.0;

/// The buffer and the accessors of a file, each with a view of its own.
#[derive(Default)]
struct Lists {
    bytes: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl Lists {
    /// Adds an accessor; returns its number. `target` and `more` are members of the view and of the accessor.
    fn add(
        &mut self,
        data: &[u8],
        target: Option<u32>,
        (component, shape, count): (u32, &str, usize),
        more: &str,
    ) -> usize {
        let target = target.map_or(String::new(), |target| format!(r#","target":{target}"#));
        let (start, view) = (self.bytes.len(), self.views.len());
        self.views.push(format!(r#"{{"buffer":0,"byteOffset":{start},"byteLength":{}{target}}}"#, data.len()));
        self.bytes.extend_from_slice(data);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.accessors.push(format!(
            r#"{{"bufferView":{view},"componentType":{component},"type":"{shape}","count":{count}{more}}}"#
        ));
        self.accessors.len() - 1
    }

    /// Vectors of vertices, with their least and greatest numbers where they are positions.
    fn vectors(&mut self, vectors: &[Vec3], are_positions: bool) -> usize {
        let bytes: Vec<u8> = vectors.iter().flat_map(Vec3::to_array).flat_map(f32::to_le_bytes).collect();
        let bound = |pick: fn(Vec3, Vec3) -> Vec3| vectors.iter().copied().reduce(pick).unwrap_or_default().to_array();
        let bounds = format!(r#","min":{:?},"max":{:?}"#, bound(Vec3::min), bound(Vec3::max));
        self.add(&bytes, Some(34962), (5126, "VEC3", vectors.len()), if are_positions { &bounds } else { "" })
    }

    fn indices(&mut self, indices: &[u32]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|index| (*index as u16).to_le_bytes()).collect();
        self.add(&bytes, Some(34963), (5123, "SCALAR", indices.len()), "")
    }

    /// Numbers of an animation or a skin.
    fn numbers(&mut self, shape: &str, width: usize, numbers: &[f32], more: &str) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        self.add(&bytes, None, (5126, shape, numbers.len() / width), more)
    }

    /// Times of key frames, which are multiples of a step.
    fn times(&mut self, step: f32, count: usize) -> usize {
        let times: Vec<f32> = (0..count).map(|i| step * i as f32).collect();
        let bounds = format!(r#","min":[0],"max":[{}]"#, times[count - 1]);
        self.numbers("SCALAR", 1, &times, &bounds)
    }
}

/// The middle of a ring along x, and half the height and half the width of the fish there. 0 is the mouth, 1 the end of
/// the tail.
fn ring(t: f32) -> (f32, f32, f32) {
    // x, half the height, half the width.
    const PROFILE: [[f32; 3]; 12] = [
        [0.85, 0.0, 0.0],
        [0.82, 0.09, 0.08],
        [0.66, 0.22, 0.16],
        [0.42, 0.34, 0.21],
        [0.14, 0.39, 0.22],
        [-0.14, 0.36, 0.19],
        [-0.38, 0.26, 0.14],
        [-0.58, 0.13, 0.07],
        [-0.68, 0.1, 0.045],
        [-0.8, 0.2, 0.03],
        [-1.02, 0.36, 0.015],
        [-1.0, 0.0, 0.0],
    ];
    let at = t * (PROFILE.len() - 1) as f32;
    let first = (at as usize).min(PROFILE.len() - 2);
    let part = at - first as f32;
    let [x, height, width] = [0, 1, 2].map(|i| PROFILE[first][i] + part * (PROFILE[first + 1][i] - PROFILE[first][i]));
    (x, height, width)
}

/// The body: positions, triangles and the colour of each vertex, orange with white bands and dark ends.
fn body() -> (Mesh, Vec<[u8; 4]>) {
    let (mut positions, mut colors, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..=RINGS {
        let (x, height, width) = ring(i as f32 / RINGS as f32);
        for j in 0..AROUND {
            let (sin, cos) = (TAU * j as f32 / AROUND as f32).sin_cos();
            positions.push(Vec3::new(x, height * cos, width * sin));
            colors.push(match i {
                9 | 10 | 16 | 17 | 23 => [240, 238, 230, 255],
                8 | 11 | 15 | 18 | 22 | 24 | 30.. => [38, 22, 14, 255],
                _ if cos < -0.7 => [228, 130, 50, 255],
                _ => [226, 78, 14, 255],
            });
        }
    }
    let (around, rings) = (AROUND as u32, RINGS as u32);
    for (i, j) in (0..rings).flat_map(|i| (0..around).map(move |j| (i, j))) {
        let at = |i: u32, j: u32| i * around + j % around;
        let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)];
        // The first and the last ring are points.
        if i > 0 {
            indices.extend([a, d, b]);
        }
        if i + 1 < rings {
            indices.extend([a, c, d]);
        }
    }
    (Mesh::new(positions, indices).expect("a mesh"), colors)
}

/// The body with its belly full of water.
fn puffed(body: &Mesh) -> Mesh {
    let mut mesh = body.clone();
    let puff = |p: &Vec3| {
        // From the gills to the middle of the body.
        let t = ((0.62 - p.x) / 0.95).clamp(0.0, 1.0);
        let amount = 16.0 * (t * (1.0 - t)).powi(2);
        Vec3::new(p.x, p.y * (1.0 + 0.35 * amount), p.z * (1.0 + 1.1 * amount))
    };
    mesh.set_positions(body.positions().iter().map(puff).collect()).expect("as many");
    mesh.with_normals(halfway_mesh::Normals::Weighted(halfway_mesh::NormalWeighting::default())).0
}

/// The joints that move a vertex at x, and by how much: two that are beside it.
fn influences(x: f32) -> ([u8; 4], [f32; 4]) {
    let last = JOINTS.len() - 1;
    let after = JOINTS.iter().position(|joint| x > *joint).unwrap_or(last + 1);
    if after == 0 || after > last {
        return ([after.min(last) as u8, 0, 0, 0], [1.0, 0.0, 0.0, 0.0]);
    }
    let part = (JOINTS[after - 1] - x) / (JOINTS[after - 1] - JOINTS[after]);
    ([after as u8 - 1, after as u8, 0, 0], [1.0 - part, part, 0.0, 0.0])
}

/// A fin, which hangs from its origin down and backward.
fn fin() -> Mesh {
    let sphere = Mesh::from(UvSphere::new(1.0, 12, 8));
    let flat = |p: &Vec3| Vec3::new(0.11 * p.x - 0.12, 0.17 * p.y - 0.12, 0.015 * p.z);
    Mesh::new(sphere.positions().iter().map(flat).collect(), sphere.indices().to_vec()).expect("a mesh")
}

/// The members of a mesh without a skin.
fn mesh(lists: &mut Lists, name: &str, mesh: &Mesh, material: usize) -> String {
    let (positions, normals) = (lists.vectors(mesh.positions(), true), lists.vectors(mesh.normals(), false));
    let indices = lists.indices(mesh.indices());
    format!(
        r#"{{"name":"{name}","primitives":[{{"attributes":{{"POSITION":{positions},"NORMAL":{normals}}},"indices":{indices},"material":{material}}}]}}"#
    )
}

/// The body's mesh, with its skin and its morph target, and the number of its inverse bind matrices.
fn body_mesh(lists: &mut Lists) -> (String, usize) {
    let (mesh, colors) = body();
    let puffed = puffed(&mesh);
    let difference = |to: &[Vec3], from: &[Vec3]| to.iter().zip(from).map(|(to, from)| *to - *from).collect::<Vec<_>>();
    let count = mesh.positions().len();
    let (positions, normals) = (lists.vectors(mesh.positions(), true), lists.vectors(mesh.normals(), false));
    let color = lists.add(colors.as_flattened(), Some(34962), (5121, "VEC4", count), r#","normalized":true"#);
    let (joints, weights): (Vec<_>, Vec<_>) = mesh.positions().iter().map(|p| influences(p.x)).unzip();
    let joints = lists.add(joints.as_flattened(), Some(34962), (5121, "VEC4", count), "");
    let weights: Vec<u8> = weights.into_iter().flatten().flat_map(f32::to_le_bytes).collect();
    let weights = lists.add(&weights, Some(34962), (5126, "VEC4", count), "");
    let moved = lists.vectors(&difference(puffed.positions(), mesh.positions()), true);
    let turned = lists.vectors(&difference(puffed.normals(), mesh.normals()), false);
    let indices = lists.indices(mesh.indices());
    let binds: Vec<f32> =
        JOINTS.iter().flat_map(|x| glam::Mat4::from_translation(Vec3::X * -*x).to_cols_array()).collect();
    let binds = lists.numbers("MAT4", 16, &binds, "");
    let text = format!(
        r#"{{"name":"body","weights":[0],"primitives":[{{"attributes":{{"POSITION":{positions},"NORMAL":{normals},"COLOR_0":{color},"JOINTS_0":{joints},"WEIGHTS_0":{weights}}},
"targets":[{{"POSITION":{moved},"NORMAL":{turned}}}],"indices":{indices},"material":0}}]}}"#
    );
    (text, binds)
}

/// The animation: the fish swims in a circle, beats its tail and its fins, fills its belly with water and blinks.
fn swim(lists: &mut Lists) -> String {
    let (mut channels, mut samplers) = (Vec::new(), Vec::new());
    let mut channel = |nodes: &[usize], path: &str, (input, output): (usize, usize), interpolation: &str| {
        for node in nodes {
            channels.push(format!(r#"{{"sampler":{},"target":{{"node":{node},"path":"{path}"}}}}"#, samplers.len()));
        }
        samplers.push(format!(r#"{{"input":{input},"output":{output},"interpolation":"{interpolation}"}}"#));
    };
    let whole = lists.times(1.0, 5);
    // A circle by splines: before, at and after each quarter.
    let place: Vec<f32> = (0..5_u8)
        .flat_map(|i| {
            let (sin, cos) = (FRAC_PI_2 * f32::from(i)).sin_cos();
            let (p, v) = (Vec3::new(sin, 0.0, cos), Vec3::new(cos, 0.0, -sin) * (TAU / SECONDS));
            [v, p, v].map(|v| v.to_array())
        })
        .flatten()
        .collect();
    channel(&[FISH], "translation", (whole, lists.numbers("VEC3", 3, &place, "")), "CUBICSPLINE");
    let turns = |angles: &[f32], axis: Vec3| -> Vec<f32> {
        angles.iter().flat_map(|angle| Quat::from_axis_angle(axis, *angle).to_array()).collect()
    };
    let heading: Vec<f32> = (0..5_u8).map(|i| FRAC_PI_2 * f32::from(i)).collect();
    channel(&[FISH], "rotation", (whole, lists.numbers("VEC4", 4, &turns(&heading, Vec3::Y), "")), "LINEAR");
    let often = lists.times(0.125, 33);
    let wave = |height: f32, delay: f32| -> Vec<f32> {
        (0..33_u8).map(|i| height * (TAU * (f32::from(i) / 8.0 - delay)).sin()).collect()
    };
    for (joint, height, delay) in [(MIDDLE, 0.28, 0.1), (TAIL, 0.5, 0.3)] {
        let output = lists.numbers("VEC4", 4, &turns(&wave(height, delay), Vec3::Y), "");
        channel(&[joint], "rotation", (often, output), "LINEAR");
    }
    for (fin, side) in FINS.into_iter().zip([-1.0, 1.0]) {
        let angles: Vec<f32> = wave(0.4, 0.0).iter().map(|angle| side * (0.7 + angle)).collect();
        channel(&[fin], "rotation", (often, lists.numbers("VEC4", 4, &turns(&angles, Vec3::X), "")), "LINEAR");
    }
    let puff = lists.numbers("SCALAR", 1, &[0.0, 0.0, 1.0, 0.0, 0.0], "");
    channel(&[BODY], "weights", (whole, puff), "LINEAR");
    let shut = lists.times(0.5, 3);
    let lids = lists.numbers("VEC3", 3, &[1., 1., 1., 1., 0.15, 1., 1., 1., 1.], "");
    channel(&EYES, "scale", (shut, lids), "STEP");
    format!(
        r#"{{"name":"swim","channels":[{}],
"samplers":[{}]}}"#,
        channels.join(",\n"),
        samplers.join(",\n")
    )
}

/// The nodes that move.
const FISH: usize = 0;
const BODY: usize = 1;
const MIDDLE: usize = 3;
const TAIL: usize = 4;
const EYES: [usize; 2] = [5, 6];
const FINS: [usize; 2] = [7, 8];

/// The fish, its body, its joints, the eyes and fins that hang on its head, and a camera.
fn nodes() -> String {
    let [head, middle, tail] = [JOINTS[0], JOINTS[1] - JOINTS[0], JOINTS[2] - JOINTS[1]];
    [
        r#"{"name":"fish","children":[2],"translation":[0,0,1]}"#.to_owned(),
        r#"{"name":"body","mesh":0,"skin":0}"#.to_owned(),
        format!(r#"{{"name":"head","children":[3,5,6,7,8],"translation":[{head},0,0]}}"#),
        format!(r#"{{"name":"middle","children":[4],"translation":[{middle},0,0]}}"#),
        format!(r#"{{"name":"tail","translation":[{tail},0,0]}}"#),
        r#"{"name":"eye","mesh":1,"translation":[0.5,0.07,0.14]}"#.to_owned(),
        r#"{"name":"eye","mesh":1,"translation":[0.5,0.07,-0.14]}"#.to_owned(),
        r#"{"name":"fin","mesh":2,"translation":[0.2,-0.08,0.2]}"#.to_owned(),
        r#"{"name":"fin","mesh":2,"translation":[0.2,-0.08,-0.2]}"#.to_owned(),
        // By 0.4 downward.
        r#"{"name":"diver","camera":0,"translation":[0,2.5,5.9],"rotation":[-0.19866933,0,0,0.98006658]}"#.to_owned(),
    ]
    .join(",\n")
}

const MATERIALS: &str = r#"[
{"name":"skin","pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0.4}},
{"name":"eye","pbrMetallicRoughness":{"baseColorFactor":[0.02,0.02,0.025,1],"metallicFactor":0,"roughnessFactor":0.15}},
{"name":"fin","pbrMetallicRoughness":{"baseColorFactor":[0.85,0.28,0.05,1],"metallicFactor":0,"roughnessFactor":0.5}}
]"#;

pub(crate) fn fish_glb() -> Vec<u8> {
    let mut lists = Lists::default();
    let (body, binds) = body_mesh(&mut lists);
    let eye = mesh(&mut lists, "eye", &Mesh::from(UvSphere::new(0.055, 12, 8)), 1);
    let fin = mesh(&mut lists, "fin", &fin(), 2);
    let swim = swim(&mut lists);
    let json = format!(
        r#"{{"asset":{{"version":"2.0","generator":"make_assets"}},
"scene":0,"scenes":[{{"name":"fish","nodes":[0,1,9]}}],
"nodes":[{}],
"cameras":[{{"type":"perspective","perspective":{{"yfov":0.44,"znear":0.1}}}}],
"materials":{MATERIALS},
"meshes":[{body},
{eye},
{fin}],
"skins":[{{"joints":[2,3,4],"inverseBindMatrices":{binds}}}],
"animations":[{swim}],
"accessors":[{}],
"bufferViews":[{}],
"buffers":[{{"byteLength":{}}}]}}"#,
        nodes(),
        lists.accessors.join(",\n"),
        lists.views.join(",\n"),
        lists.bytes.len()
    );
    glb(json.into_bytes(), lists.bytes)
}
