//! Thousands of corrupted files of every format: each is refused or gives a valid model, and takes memory in proportion
//! to its bytes. The same at every run; `HALFWAY_SEED` and `HALFWAY_VARIANTS` ask for others and for more.

use std::panic::{AssertUnwindSafe, catch_unwind};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use fastrand::Rng;
use halfway_mesh::{Format, load_bytes};

use crate::common::{TRIANGLE_JSON, check_model, glb, triangle_data};
use crate::counting::most_for;
use crate::{ALLOCATOR, alone};

const SMF: &str = "#$SMF 1.0\nbegin\ntrans 1 2 3\nscale 2 2 2\nrot x 30\nv 0 0 0\nv 1 0 0 1\nv 1 1 0\nv 0 1 0\nbind n vertex\nn 0 0 1\nn 0 0 1\nn 0 0 1\nn 0 0 1\nbind c face\nc 1 0 0\nc 0 0.5 1\nbind r vertex\nr 0 1\nf 1 2 3\ng second\nf 1 3 4\nf 1 2 3 4\nset vertex_correction 0\nend\nmload 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\nf 1 2 4\n";
const OBJ: &str = "mtllib model.mtl\no a\nv 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0\nv 0 1 0 1\nv 0.5 0.2 0\nvt 0 0\nvt 1 1\nvn 0 0 1\nusemtl m\nf 1/1/1 2/2/1 3/1/1 -2/-1/-1\ns 1\ng b\nl 1 2\nf 1 2 3 4 5\nf 1 2 \\\n 3\ns off\nf 7 6 2 1\nv 3 3 3\nv 4 3 3\n";
const PLY: &str = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n";
const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";

fn ply(big: Option<bool>) -> Vec<u8> {
    let Some(big) = big else {
        return format!(
            "ply\nformat ascii 1.0\n{PLY}0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n4 0 1 2 -1\n"
        )
        .into();
    };
    let format = if big { "binary_big_endian" } else { "binary_little_endian" };
    let mut file = format!("ply\nformat {format} 1.0\n{PLY}").into_bytes();
    let bytes = |word: [u8; 4]| if big { [word[3], word[2], word[1], word[0]] } else { word };
    for p in [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
        file.extend(p.iter().flat_map(|x| bytes(x.to_le_bytes())));
        file.extend([255, 0, 51]);
    }
    file.push(3);
    file.extend([0_i32, 1, 2, 4, 0, 1, 2, -1].iter().flat_map(|number| bytes(number.to_le_bytes())));
    file
}

fn binary_stl() -> Vec<u8> {
    let mut file = vec![b' '; 80];
    file.extend(2_u32.to_le_bytes());
    for x in [0.0_f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].repeat(2) {
        file.extend(x.to_le_bytes());
        if (file.len() - 84) % 50 == 48 {
            file.extend([0, 0]);
        }
    }
    file
}

/// The triangle with a sparse accessor, strides, quantised attributes, a camera and a light.
fn rich_gltf() -> (String, Vec<u8>) {
    let json = r#"{"asset":{"version":"2.0"},"extensionsUsed":["KHR_mesh_quantization","KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","spot":{"outerConeAngle":0.5}}]}},
"scenes":[{"nodes":[0,2]}],
"nodes":[{"mesh":0,"children":[1],"scale":[2,2,2]},{"mesh":0,"camera":0,"rotation":[0,0,1,0]},{"extensions":{"KHR_lights_punctual":{"light":0}}}],
"cameras":[{"type":"perspective","perspective":{"yfov":0.5,"znear":0.1}}],
"meshes":[{"primitives":[{"mode":5,"attributes":{"POSITION":0,"NORMAL":1,"COLOR_0":2},"indices":3},{"mode":6,"attributes":{"POSITION":0}}]}],
"accessors":[
{"bufferView":0,"componentType":5122,"type":"VEC3","count":4,"min":[0,0,0],"max":[9,9,9],"sparse":{"count":1,"indices":{"bufferView":3,"componentType":5121},"values":{"bufferView":4}}},
{"bufferView":1,"componentType":5120,"normalized":true,"type":"VEC3","count":4},
{"bufferView":2,"componentType":5121,"normalized":true,"type":"VEC4","count":4},
{"bufferView":3,"componentType":5121,"type":"SCALAR","count":4}],
"bufferViews":[
{"buffer":0,"byteOffset":0,"byteLength":32,"byteStride":8},
{"buffer":0,"byteOffset":32,"byteLength":16,"byteStride":4},
{"buffer":0,"byteOffset":48,"byteLength":16},
{"buffer":0,"byteOffset":64,"byteLength":4},
{"buffer":0,"byteOffset":68,"byteLength":8}],
"buffers":[{"byteLength":76}]}"#;
    let mut data: Vec<u8> =
        [0_i16, 0, 0, 0, 5, 0, 0, 0, 0, 5, 0, 0, 5, 5, 0, 0].iter().flat_map(|x| x.to_le_bytes()).collect();
    data.extend([0, 0, 127, 0].repeat(4));
    data.extend([255, 128, 0, 255].repeat(4));
    data.extend([0, 1, 2, 3, 9, 0, 0, 0, 0, 0, 0, 0]);
    (json.to_owned(), data)
}

/// The valid files that are corrupted.
fn corpus() -> Vec<(&'static str, Format, Vec<u8>)> {
    let (json, data) = rich_gltf();
    let uri = |json: &str, length: usize, data: &[u8]| {
        let buffer = format!("{{\"byteLength\":{length}}}");
        assert!(json.contains(&buffer));
        let with_uri = format!("{{\"byteLength\":{length},\"uri\":\"data:;base64,{}\"}}", STANDARD.encode(data));
        json.replace(&buffer, &with_uri).into_bytes()
    };
    vec![
        ("SMF", Format::Smf, SMF.into()),
        ("OBJ", Format::Obj, OBJ.into()),
        ("GLB", Format::Glb, glb(TRIANGLE_JSON, &triangle_data())),
        ("rich GLB", Format::Glb, glb(&json, &data)),
        ("glTF", Format::Gltf, uri(TRIANGLE_JSON, 104, &triangle_data())),
        ("rich glTF", Format::Gltf, uri(&json, 76, &data)),
        ("PLY in ASCII", Format::Ply, ply(None)),
        ("PLY, little end first", Format::Ply, ply(Some(false))),
        ("PLY, big end first", Format::Ply, ply(Some(true))),
        ("STL in ASCII", Format::Stl, STL.into()),
        ("binary STL", Format::Stl, binary_stl()),
        ("OFF", Format::Off, include_bytes!("../../../../fuzz/seeds/off/all.off").into()),
        ("OFF with colours of faces", Format::Off, include_bytes!("../../../../fuzz/seeds/off/faces.off").into()),
        ("3MF", Format::ThreeMf, include_bytes!("../../../../fuzz/seeds/threemf/plates.3mf").into()),
    ]
}

/// A part of so many bytes, one at least and 24 at most.
fn part_of(length: usize, random: &mut Rng) -> std::ops::Range<usize> {
    let start = random.usize(..length);
    start..(start + random.usize(1..=24)).min(length)
}

const NUMBERS: [&str; 16] = [
    "",
    "0",
    "-1",
    "1",
    "7",
    "255",
    "65536",
    "2147483648",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "1e39",
    "1e-45",
    "-1e999",
    "nan",
    "0.1.2",
];
const WORDS: [u32; 8] = [0, 1, 0x7F, 0xFF, 0x7FFF_FFFF, 0x8000_0000, 0x7FC0_0000, 0xFFFF_FFFF];

/// Corrupts a file in a random way.
fn spoil(file: &mut Vec<u8>, random: &mut Rng) {
    let length = file.len();
    if length == 0 {
        return;
    }
    let at = random.usize(..length);
    match random.usize(..8) {
        0 => file[at] ^= 1 << random.usize(..8),
        1 => file[at] = [0, b'"', b'-', b'/', b' ', b'\n', b'9', 0xFF][random.usize(..8)],
        2 => file.truncate(at),
        3 => drop(file.drain(part_of(length, random))),
        4 => {
            let piece = file[part_of(length, random)].to_vec();
            file.splice(at..at, piece);
        }
        5 => file.insert(at, random.u8(..)),
        6 => {
            // A number as text, the whole run of its digits.
            let is_digit = |byte: &u8| byte.is_ascii_digit();
            let Some(start) = file[at..].iter().position(is_digit).map(|skip| at + skip) else { return };
            let end = file[start..].iter().position(|byte| !is_digit(byte)).map_or(length, |run| start + run);
            file.splice(start..end, NUMBERS[random.usize(..NUMBERS.len())].bytes());
        }
        _ => {
            let word = WORDS[random.usize(..WORDS.len())].to_le_bytes();
            let end = (at + 4).min(length);
            file[at..end].copy_from_slice(&word[..end - at]);
        }
    }
}

fn asked(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(otherwise)
}

#[test]
fn corrupted_files_are_refused_or_valid() {
    let _alone = alone();
    let (seed, variants) = (asked("HALFWAY_SEED", 1), asked("HALFWAY_VARIANTS", 3000));
    for (name, format, sound) in corpus() {
        if let Err(error) = load_bytes(format, &sound) {
            panic!("{name}: {error}");
        }
        let mut survived = 0;
        for variant in 0..variants {
            let mut random = Rng::with_seed(seed << 32 | variant);
            let mut file = sound.clone();
            for _ in 0..=random.usize(..3) {
                spoil(&mut file, &mut random);
            }
            let (outcome, peak) = ALLOCATOR.peak_of(|| {
                catch_unwind(AssertUnwindSafe(|| match load_bytes(format, &file) {
                    Ok(model) => {
                        check_model(&model);
                        1
                    }
                    Err(error) => {
                        assert!(error.to_string().starts_with("model."), "{error}");
                        0
                    }
                }))
            });
            let Ok(one) = outcome else {
                panic!("{name}, seed {seed}, variant {variant}: {:?}", file.escape_ascii().to_string())
            };
            survived += one;
            let most = most_for(file.len());
            assert!(peak <= most, "{name}, seed {seed}, variant {variant}: {peak} bytes for {}", file.len());
        }
        // If no corrupted file were valid, only refusal would be tested.
        assert!(survived * 50 > variants, "{name}: {survived} of {variants}");
    }
}
