//! A crate in OBJ with images in PNG beside it, and a beach ball in GLB with its image in it.

use std::fmt::Write as _;

use glam::{Vec2, Vec3};
use halfway_mesh::{Mesh, UvSphere};

use super::glb;

/// The crate's material: both images with options, as programs write them.
pub(crate) const PLANKS: &str = "\
newmtl planks
Ka 1 1 1
Kd 1 1 1
Ks 0.12 0.11 0.1
Ns 18
d 1
illum 2
map_Kd crate.png
map_Bump -bm 0.02 crate_height.png
";

/// A cube of edge 1 that stands on y = 0, with the whole image on each side.
pub(crate) fn crate_obj() -> String {
    let mut text = "# A crate, with the whole image on each side.\nmtllib crate.mtl\no crate\n".to_owned();
    for corner in 0..8 {
        let at = |bit: u32| if corner >> bit & 1 == 1 { 0.5 } else { -0.5 };
        writeln!(text, "v {} {} {}", at(0), at(1) + 0.5, at(2)).expect("writing to a string");
    }
    text += "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    text += "vn 1 0 0\nvn -1 0 0\nvn 0 1 0\nvn 0 -1 0\nvn 0 0 1\nvn 0 0 -1\nusemtl planks\n";
    // Counter-clockwise from the lower left corner as seen from outside; bits are x, y, z.
    let sides = [[5, 1, 3, 7], [0, 4, 6, 2], [6, 7, 3, 2], [0, 1, 5, 4], [4, 5, 7, 6], [1, 0, 2, 3]];
    for (number, corners) in sides.into_iter().enumerate() {
        let corner = |(at, corner)| format!("{}/{}/{}", corner + 1, at + 1, number + 1);
        let corners: Vec<String> = corners.into_iter().enumerate().map(corner).collect();
        writeln!(text, "f {}", corners.join(" ")).expect("writing to a string");
    }
    text
}

/// Texels along each side of the crate's images.
const SIDE: u32 = 96;
/// How wide the boards around a side are.
const FRAME: u32 = 14;

/// A texel of a board on a side.
struct BoardTexel {
    number: u32,
    /// The height of the board's surface.
    height: f32,
    /// The texel lies between two boards.
    is_gap: bool,
    along: u32,
    across: u32,
}

/// Boards around a side, one from corner to corner, and four that stand behind it.
fn board(x: u32, y: u32) -> BoardTexel {
    let edge = |at: u32| at.min(SIDE - 1 - at);
    let (from_side, from_end) = (edge(x), edge(y));
    if from_end < FRAME {
        let number = if y < FRAME { 10 } else { 11 };
        return BoardTexel { number, height: 1.0, is_gap: from_end == FRAME - 1, along: x, across: y };
    }
    if from_side < FRAME {
        let number = if x < FRAME { 12 } else { 13 };
        return BoardTexel { number, height: 1.0, is_gap: from_side == FRAME - 1, along: y, across: x };
    }
    let aside = (x + y).abs_diff(SIDE - 1);
    if aside < 12 {
        let along = x + SIDE - y;
        return BoardTexel { number: 14, height: 0.8, is_gap: aside == 11, along, across: x + y };
    }
    let width = (SIDE - 2 * FRAME) / 4;
    let from_left = x - FRAME;
    let is_gap = from_left.is_multiple_of(width);
    BoardTexel { number: from_left / width, height: 0.4, is_gap, along: y, across: x }
}

/// Random-looking numbers from 0 to 1 (`pcg` of Jarzynski and Olano 2020).
fn grain(x: u32, y: u32) -> f32 {
    let state = (x.wrapping_mul(1_664_525) ^ y.wrapping_mul(22_695_477)).wrapping_mul(747_796_405) + 1;
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    f32::from((word >> 22 ^ word) as u8) / 255.0
}

/// Fibres along a board, from 0 to 1.
fn fibre(board: &BoardTexel, length: u32) -> f32 {
    grain(board.across * 31 + board.number * 977, board.along / length + board.number * 57)
}

/// Wood, each board in a shade of its own.
pub(crate) fn crate_color() -> Vec<u8> {
    let texel = |[x, y]: [u32; 2]| {
        let board = board(x, y);
        let own = 0.72 + 0.16 * grain(board.number, 3);
        let light = own + 0.08 * fibre(&board, 24) + 0.07 * fibre(&board, 9);
        let light = if board.is_gap { 0.4 * light } else { light };
        [222.0, 164.0, 98.0].map(|channel: f32| (channel * light).min(255.0) as u8)
    };
    png(SIDE, SIDE, &places(SIDE, SIDE).flat_map(texel).collect::<Vec<_>>(), 3)
}

/// How high the boards are.
pub(crate) fn crate_height() -> Vec<u8> {
    let texel = |[x, y]: [u32; 2]| {
        let board = board(x, y);
        let height = if board.is_gap { 0.2 } else { board.height * (0.92 + 0.08 * fibre(&board, 24)) };
        (255.0 * height) as u8
    };
    png(SIDE, SIDE, &places(SIDE, SIDE).map(texel).collect::<Vec<_>>(), 1)
}

fn places(width: u32, height: u32) -> impl Iterator<Item = [u32; 2]> {
    (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
}

/// A beach ball: six colours between white caps.
fn ball_color() -> Vec<u8> {
    const COLORS: [[u8; 3]; 6] =
        [[214, 40, 40], [250, 246, 235], [30, 100, 190], [250, 246, 235], [244, 190, 40], [250, 246, 235]];
    let texel = |[x, y]: [u32; 2]| {
        let is_cap = !(5..59).contains(&y);
        if is_cap { [250, 246, 235] } else { COLORS[(x * 6 / 120) as usize % 6] }
    };
    png(120, 64, &places(120, 64).flat_map(texel).collect::<Vec<_>>(), 3)
}

/// The ball, of radius ½, that lies on y = 0.
pub(crate) fn ball_glb() -> Vec<u8> {
    let mesh = Mesh::from(UvSphere::new(0.5, 36, 18));
    let floats = |numbers: Vec<f32>| numbers.into_iter().flat_map(f32::to_le_bytes).collect::<Vec<u8>>();
    let uvs = mesh.uvs().expect("a sphere has them");
    let parts = [
        floats(mesh.positions().iter().flat_map(Vec3::to_array).collect()),
        floats(mesh.normals().iter().flat_map(Vec3::to_array).collect()),
        floats(uvs.iter().flat_map(Vec2::to_array).collect()),
        mesh.indices().iter().flat_map(|index| (*index as u16).to_le_bytes()).collect(),
        ball_color(),
    ];
    let (mut bytes, mut views) = (Vec::new(), Vec::new());
    for part in &parts {
        views.push(format!(r#"{{"buffer":0,"byteOffset":{},"byteLength":{}}}"#, bytes.len(), part.len()));
        bytes.extend_from_slice(part);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    let (bounds, count) = (mesh.bounds(), mesh.positions().len());
    let json = format!(
        r#"{{"asset":{{"version":"2.0","generator":"make_assets"}},
"scene":0,"scenes":[{{"name":"ball","nodes":[0]}}],
"nodes":[{{"name":"ball","mesh":0,"translation":[0,0.5,0]}}],
"materials":[{{"name":"rubber","pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}},"metallicFactor":0,"roughnessFactor":0.35}}}}],
"textures":[{{"source":0,"sampler":0}}],
"samplers":[{{"magFilter":9729,"minFilter":9987,"wrapS":10497,"wrapT":33071}}],
"images":[{{"bufferView":4,"mimeType":"image/png"}}],
"meshes":[{{"name":"ball","primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}},"indices":3,"material":0}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":{count},"min":{:?},"max":{:?}}},
{{"bufferView":1,"componentType":5126,"type":"VEC3","count":{count}}},
{{"bufferView":2,"componentType":5126,"type":"VEC2","count":{count}}},
{{"bufferView":3,"componentType":5123,"type":"SCALAR","count":{}}}],
"bufferViews":[{}],
"buffers":[{{"byteLength":{}}}]}}"#,
        bounds.min.to_array(),
        bounds.max.to_array(),
        mesh.indices().len(),
        views.join(","),
        bytes.len()
    );
    glb(json.into_bytes(), bytes)
}

/// A PNG of 8 bits a channel, grey or RGB, not compressed (ISO/IEC 15948; RFC 1950 and 1951).
fn png(width: u32, height: u32, texels: &[u8], channels: u32) -> Vec<u8> {
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut chunk = |kind: &[u8; 4], data: &[u8]| {
        file.extend((data.len() as u32).to_be_bytes());
        let checked = [kind, data].concat();
        file.extend_from_slice(&checked);
        file.extend(crc(&checked).to_be_bytes());
    };
    let color = if channels == 1 { 0 } else { 2 };
    chunk(b"IHDR", &[&width.to_be_bytes()[..], &height.to_be_bytes(), &[8, color, 0, 0, 0]].concat());
    // Each row after the number of its filter, none.
    let rows: Vec<u8> = texels.chunks((width * channels) as usize).flat_map(|row| [&[0], row].concat()).collect();
    let mut data = vec![0x78, 0x01];
    let blocks = rows.chunks(65535);
    let last = blocks.len() - 1;
    for (number, block) in blocks.enumerate() {
        data.push(u8::from(number == last));
        data.extend((block.len() as u16).to_le_bytes());
        data.extend((!(block.len() as u16)).to_le_bytes());
        data.extend_from_slice(block);
    }
    data.extend(adler(&rows).to_be_bytes());
    chunk(b"IDAT", &data);
    chunk(b"IEND", &[]);
    file
}

fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc: u32, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| crc >> 1 ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 })
    })
}

fn adler(bytes: &[u8]) -> u32 {
    let [a, b] = bytes.iter().fold([1, 0], |[a, b]: [u32; 2], byte| {
        let a = (a + u32::from(*byte)) % 65521;
        [a, (a + b) % 65521]
    });
    b << 16 | a
}
