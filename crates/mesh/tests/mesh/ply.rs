//! PLY files, in ASCII and binary.

use glam::{Vec2, Vec3, Vec4};
use halfway_mesh::{Format, Model, load_bytes};

fn load(bytes: impl AsRef<[u8]>) -> Model {
    load_bytes(Format::Ply, bytes.as_ref()).unwrap()
}

fn message(bytes: impl AsRef<[u8]>) -> String {
    load_bytes(Format::Ply, bytes.as_ref()).unwrap_err().to_string()
}

/// A square of two triangles and a dart, with everything that is read.
const HEADER: &str = "comment caf\u{e9}\nobj_info none\nelement vertex 4\nproperty float x\nproperty double y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\nproperty short quality\nelement face 2\nproperty list uchar int vertex_indices\nelement edge 1\nproperty int vertex1\nproperty list uint char names\nend_header\n";

const VERTICES: [[f64; 13]; 4] = [
    [2., -1., 0., 0., 0., 1., 0.25, 0.75, 255., 0., 0., 255., -7.],
    [0., 3., 0., 0., 0., 1., 0., 0., 0., 255., 0., 0., 7.],
    [-2., -1., 0., 0., 0., 1., 1., 1., 0., 0., 255., 51., 0.],
    [0., 0., 0., 0., 0., 1., 0.5, 0., 255., 255., 255., 255., 0.],
];
const FACES: [&[i32]; 2] = [&[0, 1, 2, 3], &[0, 1, 2]];

fn ascii() -> String {
    let row = |numbers: &[f64]| numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
    let vertices: Vec<String> = VERTICES.iter().map(|vertex| row(vertex)).collect();
    let faces: Vec<String> = FACES
        .iter()
        .map(|face| format!("{} {}", face.len(), row(&face.iter().map(|&i| i.into()).collect::<Vec<_>>())))
        .collect();
    format!("ply\nformat ascii 1.0\n{HEADER}{}\n{}\n5 2 65 66\n", vertices.join("\n"), faces.join("\r\n"))
}

fn binary(big: bool) -> Vec<u8> {
    let format = if big { "binary_big_endian" } else { "binary_little_endian" };
    let mut file = format!("ply\nformat {format} 1.0\n{HEADER}").into_bytes();
    let mut push = |mut bytes: Vec<u8>| {
        if big {
            bytes.reverse();
        }
        file.extend(bytes);
    };
    for vertex in VERTICES {
        for (i, number) in vertex.into_iter().enumerate() {
            push(match i {
                1 => number.to_le_bytes().into(),
                8..12 => vec![number as u8],
                12 => (number as i16).to_le_bytes().into(),
                _ => (number as f32).to_le_bytes().into(),
            });
        }
    }
    for face in FACES {
        push(vec![face.len() as u8]);
        for index in face {
            push(index.to_le_bytes().into());
        }
    }
    push(5_i32.to_le_bytes().into());
    push(2_u32.to_le_bytes().into());
    push(vec![65]);
    push(vec![66]);
    file
}

#[test]
fn all_encodings_give_the_same_mesh() {
    let expected = load(ascii());
    let mesh = &expected.parts[0].mesh;
    assert_eq!(mesh.positions(), [Vec3::new(2., -1., 0.), Vec3::new(0., 3., 0.), Vec3::new(-2., -1., 0.), Vec3::ZERO]);
    assert_eq!(mesh.normals(), [Vec3::Z; 4]);
    // v runs upward in the file.
    assert_eq!(mesh.uvs().unwrap()[..2], [Vec2::new(0.25, 0.25), Vec2::new(0.0, 1.0)]);
    let colors = mesh.colors().unwrap();
    assert_eq!((colors[0], colors[2]), (Vec4::new(1., 0., 0., 1.), Vec4::new(0., 0., 1., 0.2)));
    assert_eq!(mesh.triangle_count(), 3);
    // The dart is cut at its notch.
    assert!(mesh.triangles().take(2).all(|triangle| triangle.contains(&3) && triangle.contains(&1)));
    assert_eq!(expected.warnings, ["the 1 elements `edge` are skipped"]);
    assert_eq!(expected.properties.iter().map(|property| &property.name[..]).collect::<Vec<_>>(), ["quality"]);
    for big in [false, true] {
        assert_eq!(load(binary(big)), expected, "{big}");
    }
}

const TRIANGLE: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

#[test]
fn common_variants_of_files_are_read() {
    let plain = load(TRIANGLE);
    assert_eq!(plain.parts[0].mesh.normals(), [Vec3::Z; 3]);
    assert!(plain.warnings.is_empty() && plain.parts[0].mesh.colors().is_none(), "{:?}", plain.warnings);
    assert_eq!(load(TRIANGLE.replace('\n', "\r\n")), plain);
    // Broken lines, sized names of types, blank lines.
    assert_eq!(
        load(TRIANGLE.replace("1 0 0\n", "1\n0\n\n0\n").replace("float", "float32").replace("uchar", "uint8")),
        plain
    );
    // A count of nothing that takes room says nothing.
    let empty = TRIANGLE.replace("element face", "element nothing 18446744073709551615\nelement face");
    assert_eq!(load(empty).triangle_count(), 1);

    let strips = TRIANGLE.replace("face", "tristrips").replace("3 0 1 2\n", "9 0 1 2 0 -1 2 1 0 -1\n");
    assert_eq!(load(strips).parts[0].mesh.indices(), [0, 1, 2, 1, 0, 2, 2, 1, 0]);
    let small = TRIANGLE.replace("face 1", "face 3").replace("3 0 1 2\n", "0\n2 0 1\n3 0 1 2\n");
    assert_eq!(load(small).warnings, ["2 faces of fewer than three corners are skipped"]);
    let floats = TRIANGLE
        .replace("property float z", "property float z\nproperty float red\nproperty float green\nproperty float blue");
    let floats = floats
        .replace("0 0 0\n", "0 0 0 1 0 1\n")
        .replace("1 0 0\n", "1 0 0 1 0 1\n")
        .replace("0 1 0\n", "0 1 0 1 0 1\n");
    assert_eq!(load(floats).parts[0].mesh.colors(), Some(&[Vec4::new(1., 0., 1., 1.); 3][..]));
}

#[test]
fn malformed_files_are_refused_by_line_or_element() {
    let rows = [
        ("no magic", TRIANGLE.replacen("ply", "plx", 1), ":1: `plx`; `ply` is expected"),
        ("no end", "ply\nformat ascii 1.0\n".to_owned(), ":3: the end of the file; `end_header` is expected"),
        ("encoding", TRIANGLE.replace("ascii", "utf8"), ":2: `format utf8 1.0`; `format`, one of ascii,"),
        ("version", TRIANGLE.replace("1.0", "2.0"), ":2: `format ascii 2.0`; `format`, one of ascii,"),
        ("no format", TRIANGLE.replace("format ascii 1.0\n", ""), ":8: `end_header`; a `format` before it is expected"),
        ("count", TRIANGLE.replace("face 1", "face -1"), ":7: `element face -1`; `element`, a name and a number are"),
        ("type", TRIANGLE.replace("float z", "real z"), ":6: `property real z`; `property`, its type or"),
        (
            "length in floats",
            TRIANGLE.replace("uchar", "float"),
            ":8: `property list float int vertex_index`; `property`,",
        ),
        (
            "property of nothing",
            TRIANGLE.replace("element vertex 3\n", ""),
            ":3: `property float x`; an `element` before it is expected",
        ),
        ("statement", TRIANGLE.replace("element face", "elephant face"), ":7: `elephant face 1`; `format`, `element`,"),
        (
            "no x",
            TRIANGLE.replace("float x", "float q"),
            ":9: vertex 0, x, y and z: no such properties; three numbers are",
        ),
        ("word", TRIANGLE.replace("1 0 0", "1 zero 0"), ":11: vertex 1, y: `zero`; a number is expected"),
        ("NaN", TRIANGLE.replace("1 0 0", "1 nan 0"), ":11: vertex 1, y: NaN; a finite number is expected"),
        ("beyond f32", TRIANGLE.replace("1 0 0", "1 1e39 0"), ":11: vertex 1, y: inf; a finite number is expected"),
        (
            "fraction",
            TRIANGLE.replace("3 0 1 2", "3 0 1 1.5"),
            ":13: face 0, vertex_index: `1.5`; a whole number is expected",
        ),
        (
            "outside",
            TRIANGLE.replace("3 0 1 2", "3 0 1 3"),
            ":13: face 0, vertex_index: vertex 3; one of 3 vertices that stand before it, from 0, is expected",
        ),
        (
            "negative",
            TRIANGLE.replace("3 0 1 2", "3 0 1 -1"),
            ":13: face 0, vertex_index: -1; a vertex, counted from 0, is",
        ),
        (
            "negative length",
            TRIANGLE.replace("3 0 1 2", "-3 0 1 2"),
            ":13: face 0, vertex_index: a list of -3; a length from 0",
        ),
        (
            "short",
            TRIANGLE.replace("3 0 1 2", "3 0 1"),
            ":13: face 0, vertex_index: the end of the file; a number is expected",
        ),
        (
            "absurd count",
            TRIANGLE.replace("vertex 3", "vertex 18446744073709551615"),
            ":13: vertex 4, y: the end of the file; a number is expected",
        ),
        (
            "absurd length",
            TRIANGLE.replace("3 0 1 2", "4000000000 0 1 2"),
            ":13: face 0, vertex_index: the end of the file; a number is expected",
        ),
        (
            "nothing",
            TRIANGLE.replace("vertex 3", "vertex 0").replace("face 1", "face 0"),
            ": no triangles, lines or points; at least one is expected",
        ),
    ];
    for (name, text, expected) in rows {
        let message = message(text);
        assert!(message.starts_with(&format!("model.ply{expected}")), "{name}: {message}");
    }
    let whole = binary(false);
    // An edge of 10 bytes, faces of 17 and 13, vertices of 42.
    let start = whole.len() - 10 - 13 - 17 - 4 * 42;
    assert!(message(&whole[..start + 43]).starts_with("model.ply: vertex 1, x: the end of the file"));
    for end in 0..whole.len() {
        assert!(load_bytes(Format::Ply, &whole[..end]).is_err(), "{end}");
    }
}
