//! PLY files, in ASCII and binary.
#![expect(clippy::float_cmp, reason = "numbers that are whole fractions of powers of two, or copied")]

use glam::{DVec3, Vec2, Vec3, Vec4};
use halfway_mesh::{Format, Model, ScalarValues, load_bytes};

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
        (
            "element again",
            TRIANGLE.replace("element face 1", "element vertex 1"),
            ":7: `element vertex 1`; an `element` of another name is expected",
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
            "fraction of a vertex",
            TRIANGLE.replace("uchar int", "uchar double").replace("3 0 1 2", "3 0 1 1.5"),
            ":13: face 0, vertex_index: 1.5; a vertex, counted from 0, is expected",
        ),
        (
            "outside, faces first",
            FACES_FIRST.replace("3 0 1 2", "3 0 1 3"),
            ":13: face 0, vertex_indices: vertex 3; one of 3 vertices that stand before it, from 0, is expected",
        ),
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

const FACES_FIRST: &str = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_index\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n";

#[test]
fn elements_may_come_in_any_order() {
    assert_eq!(load(FACES_FIRST), load(TRIANGLE));
    // A polygon is cut once its vertices are known.
    let dart = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_index\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nend_header\n4 0 1 2 3\n2 -1 0\n0 3 0\n-2 -1 0\n0 0 0\n";
    let mesh = load(dart).parts[0].mesh.clone();
    assert!(mesh.triangles().all(|triangle| triangle.contains(&3) && triangle.contains(&1)));
    let edges = FACES_FIRST
        .replace("face 1\nproperty list uchar int vertex_index", "edge 1\nproperty int vertex1\nproperty int vertex2");
    assert_eq!(load(edges.replace("3 0 1 2", "0 2")).line_count(), 1);
    assert!(message(edges.replace("3 0 1 2", "0 3")).contains("edge 0, vertices: vertex 3; one of 3 vertices"));
}

#[test]
fn header_lines_may_end_in_carriage_returns() {
    let text = binary(false);
    let end = text.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
    let header = String::from_utf8_lossy(&text[..end]).replace('\n', "\r");
    let mut bytes = header.into_bytes();
    bytes.extend(&text[end..]);
    assert_eq!(load(bytes), load(text));
    assert_eq!(load(TRIANGLE.replace('\n', "\r")), load(TRIANGLE));
    // The first byte of the body is that of an LF: 2¹⁰ + 2 in binary32 begins with 0x00, so 10 is in the first number.
    let mut bytes = TRIANGLE.replace("ascii", "binary_little_endian").replace('\n', "\r").into_bytes();
    bytes.truncate(bytes.windows(11).position(|window| window == b"end_header\r").unwrap() + 11);
    let x = f32::from_bits(0x3f80_000a);
    for number in [x, 0., 0., 1., 0., 0., 0., 1., 0.] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.push(3);
    for index in 0..3_i32 {
        bytes.extend(index.to_le_bytes());
    }
    assert_eq!(load(bytes).parts[0].mesh.positions()[0].x, x);
}

#[test]
fn vertices_that_nothing_uses_may_be_anything() {
    let with = |row: &str| TRIANGLE.replace("vertex 3", "vertex 4").replace("3 0 1 2\n", &format!("{row}\n3 0 1 2\n"));
    let plain = load(TRIANGLE);
    let model = load(with("nan 0 inf"));
    assert_eq!(model.warnings, ["1 vertices have numbers that are not finite, as `x` of vertex 3; nothing uses them"]);
    assert_eq!(model.parts[0].mesh.bounds(), plain.parts[0].mesh.bounds());
    // Far away: framed by what is drawn, and placed by it.
    let far = load(with("1e30 1e6 1e6"));
    assert_eq!((far.parts[0].mesh.bounds(), far.origin), (plain.parts[0].mesh.bounds(), DVec3::ZERO));
    let cloud = with("nan 0 0").replace("face 1", "face 0").replace("3 0 1 2\n", "");
    let cloud = load(cloud);
    assert_eq!(
        (cloud.point_count(), &cloud.warnings[0][..]),
        (3, "1 points have numbers that are not finite, and are left out")
    );
}

#[test]
fn normals_that_are_not_finite_are_made_anew() {
    let model = load(ascii().replace("2 -1 0 0 0 1 0.25", "2 -1 0 0 nan 1 0.25"));
    assert_eq!(model.parts[0].mesh.normals(), [Vec3::Z; 4]);
    assert!(
        model.warnings.contains(&"1 numbers of normals are not finite; the normals are made anew".to_owned()),
        "{:?}",
        model.warnings
    );
}

#[test]
fn faces_may_have_colours_and_texture_coordinates_of_their_own() {
    let square = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float heat\nelement face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty int texnumber\nend_header\n0 0 0 0\n1 0 0 1\n1 1 0 2\n0 1 0 3\n";
    let model = load(format!("{square}3 0 1 2 6 0 0 1 0 1 1 255 0 0 7\n3 0 2 3 6 0 0 1 1 0 1 0 0 255 8\n"));
    let mesh = &model.parts[0].mesh;
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    assert_eq!((mesh.positions().len(), mesh.indices()), (6, &[0, 1, 2, 3, 4, 5][..]));
    let (red, blue) = (Vec4::new(1., 0., 0., 1.), Vec4::new(0., 0., 1., 1.));
    assert_eq!(mesh.colors(), Some(&[red, red, red, blue, blue, blue][..]));
    assert_eq!(mesh.uvs().unwrap(), [Vec2::Y, Vec2::ONE, Vec2::X, Vec2::Y, Vec2::X, Vec2::ZERO]);
    let values: Vec<_> = model.properties.iter().map(|property| (&property.name[..], &property.values)).collect();
    let heat = ScalarValues::Vertices(vec![0., 1., 2., 0., 2., 3.]);
    assert_eq!(values, [("heat", &heat), ("texnumber", &ScalarValues::Faces(vec![7., 8.]))]);

    // A polygon, of one colour with its neighbour: corners with equal coordinates stay one vertex.
    let model = load(format!("{square}4 0 1 2 3 8 0 0 1 0 1 1 0 1 9 9 9 7\n3 0 2 3 0 9 9 9 8\n"));
    let mesh = &model.parts[0].mesh;
    assert_eq!(model.warnings, ["1 faces have no finite pair of texture coordinates a corner; they get (0, 0)"]);
    assert_eq!((mesh.positions().len(), mesh.triangle_count()), (4 + 2, 3));
    assert_eq!(mesh.uvs().unwrap()[..4], [Vec2::Y, Vec2::ONE, Vec2::X, Vec2::ZERO]);
    assert_eq!(model.properties[1].values, ScalarValues::Faces(vec![7., 7., 8.]));

    let both = square.replace("property float heat", "property uchar red\nproperty uchar green\nproperty uchar blue");
    let both = both
        .replace(" 0 0\n", " 0 0 1 2\n")
        .replace("0 1\n", "0 1 1 2\n")
        .replace("0 2\n", "0 2 1 2\n")
        .replace("0 3\n", "0 3 1 2\n");
    let model = load(format!("{both}3 0 1 2 0 255 0 0 7\n3 0 2 3 0 0 0 255 8\n"));
    assert!(
        model.warnings.contains(&"the colours of faces are skipped, since vertices have their own".to_owned()),
        "{:?}",
        model.warnings
    );
}

#[test]
fn corners_may_be_listed_as_doubles() {
    for scalar in ["double", "float", "short"] {
        assert_eq!(load(TRIANGLE.replace("uchar int", &format!("uchar {scalar}"))), load(TRIANGLE), "{scalar}");
    }
}

#[test]
fn models_far_away_have_an_origin() {
    let rows = "400000.125 5000000 0\n400001.125 5000000 0\n400000.125 5000001 0\n";
    let far = TRIANGLE.replace("float", "double").replace("0 0 0\n1 0 0\n0 1 0\n", rows);
    let model = load(far);
    assert_ne!(model.origin, DVec3::ZERO);
    let at = |i: usize| model.origin + model.parts[0].mesh.positions()[i].as_dvec3();
    assert_eq!((at(0), at(2)), (DVec3::new(400_000.125, 5e6, 0.0), DVec3::new(400_000.125, 5_000_001.0, 0.0)));
}

#[test]
fn large_binary_files_are_read_alike_with_and_without_the_short_way() {
    // Triangles, quadrangles and a polygon among them, over several buffers; a property beside the list takes the long way.
    let mut files = [false, true].map(|has_more| {
        let more = if has_more { "property uchar of_face\n" } else { "" };
        format!("ply\nformat binary_big_endian 1.0\nelement vertex 40000\nproperty float x\nproperty double y\nproperty short z\nelement face 30000\nproperty list uchar uint vertex_indices\n{more}end_header\n").into_bytes()
    });
    for (has_more, file) in files.iter_mut().enumerate() {
        for i in 0..40_000_u32 {
            file.extend((i as f32 * 0.5).to_be_bytes());
            file.extend(f64::from(i % 200).to_be_bytes());
            file.extend(((i % 7) as i16).to_be_bytes());
        }
        for i in 0..30_000_u32 {
            let size = if i == 20_000 { 9 } else { 3 + u32::from(i % 5 == 0) };
            file.push(size as u8);
            (0..size).for_each(|k| file.extend(((i + 200 * k) % 40_000).to_be_bytes()));
            file.extend(&[1][..has_more]);
        }
    }
    let [plain, with_more] = files.each_ref().map(load);
    assert_eq!(plain.parts, with_more.parts);
    assert_eq!(plain.triangle_count(), 30_000 + 6_000 - 1 + 6);
    // The last corner of the last face.
    let [plain, _] = &mut files;
    let end = plain.len();
    plain[end - 4..].copy_from_slice(&40_000_u32.to_be_bytes());
    assert_eq!(
        message(&plain[..]),
        "model.ply: face 29999, vertex_indices: vertex 40000; one of 40000 vertices that stand before it, from 0, is expected"
    );
    plain.pop();
    assert_eq!(message(&plain[..]), "model.ply: face 29999, vertex_indices: the end of the file; a number is expected");
}
