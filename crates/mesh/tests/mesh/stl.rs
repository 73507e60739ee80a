//! STL files, in ASCII and binary.

use glam::Vec3;
use halfway_mesh::{Format, Model, load_bytes};

fn load(bytes: impl AsRef<[u8]>) -> Model {
    load_bytes(Format::Stl, bytes.as_ref()).unwrap()
}

fn message(bytes: impl AsRef<[u8]>) -> String {
    load_bytes(Format::Stl, bytes.as_ref()).unwrap_err().to_string()
}

const TRIANGLES: [[[f32; 3]; 4]; 2] = [
    [[0., 0., 1.], [0., 0., 0.], [1., 0., 0.], [1., 1., 0.]],
    [[0., 0., 1.], [-0., 0., 0.], [1., 1., 0.], [0., 1., 0.]],
];

fn ascii() -> String {
    let facets = TRIANGLES.map(|[n, a, b, c]| {
        let vertices = [a, b, c].map(|p| format!("      vertex {} {} {:e}\n", p[0], p[1], p[2])).concat();
        let [x, y, z] = n;
        format!("  facet normal {x} {y} {z}\n    outer loop\n{vertices}    endloop\n  endfacet\n")
    });
    format!("solid a square\n{}endsolid a square\n", facets.concat())
}

fn binary(header: &str) -> Vec<u8> {
    let mut file = header.as_bytes().to_vec();
    file.resize(80, b' ');
    file.extend((TRIANGLES.len() as u32).to_le_bytes());
    for triangle in TRIANGLES {
        file.extend(triangle.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        file.extend([0, 0]);
    }
    file
}

#[test]
fn triangles_share_their_equal_corners() {
    let text = load(ascii());
    let [part] = &text.parts[..] else { panic!("{} parts", text.parts.len()) };
    assert_eq!(part.name, "a square");
    assert_eq!(part.mesh.positions(), [Vec3::ZERO, Vec3::X, Vec3::new(1., 1., 0.), Vec3::Y]);
    assert_eq!(part.mesh.indices(), [0, 1, 2, 0, 2, 3]);
    assert_eq!(part.mesh.normals(), [Vec3::Z; 4]);
    assert!(text.warnings.is_empty(), "{:?}", text.warnings);
    // Some binary files begin as if they were text.
    for header in ["made by a program", "solid as a rock", ""] {
        let model = load(binary(header));
        assert_eq!(model.parts[0].mesh, part.mesh, "{header:?}");
        assert!(model.warnings.is_empty() && model.parts[0].name == "model", "{header:?}: {:?}", model.warnings);
    }
    // More bytes than the count asks for are left.
    let mut longer = binary("");
    longer.extend([0; 100]);
    assert_eq!(load(longer).parts[0].mesh, part.mesh);
    assert_eq!(load(ascii().to_uppercase().replace('\n', "\r\n")).parts[0].mesh, part.mesh);
}

#[test]
fn solids_become_parts_and_oddities_are_warnings() {
    let two = load(format!("{}{}solid empty\nendsolid\n", ascii(), ascii().replace("a square", "")));
    let names: Vec<_> = two.parts.iter().map(|part| &part.name[..]).collect();
    assert_eq!(names, ["a square", "model"]);

    let against = load(ascii().replace("normal 0 0 1", "normal 0 0 -1"));
    assert_eq!(against.warnings, ["2 triangles have a normal that points against their winding; the winding counts"]);
    // The normals of degenerate triangles are ignored.
    assert!(load(ascii().replace("normal 0 0 1", "normal nan 0 -inf")).warnings.is_empty());
    let odd = load(ascii().replace("endsolid", "color 1 0 0\nendsolid"));
    assert_eq!(odd.warnings, ["model.stl:16: `color` is skipped"]);
    let mut colored = binary("");
    let last = colored.len() - 1;
    colored[last] = 0x80;
    colored[last - 1] = 1;
    colored[last] = 0;
    let model = load(colored);
    assert_eq!(model.warnings, ["the attributes of 1 triangles, which are no colours, are skipped"]);
    assert_eq!(model.parts[0].mesh.colors(), None);
    // A normal is not needed.
    assert_eq!(load(ascii().replace("facet normal 0 0 1", "facet")).parts[0].mesh, two.parts[0].mesh);
}

#[test]
fn malformed_files_are_refused() {
    let rows = [
        (
            "two numbers",
            ascii().replace("vertex 1 1 0e0", "vertex 1 1"),
            ":7: `endloop` after `vertex`; three finite numbers are expected",
        ),
        (
            "NaN",
            ascii().replace("vertex 1 1 0e0", "vertex 1 1 nan"),
            ":6: `nan` after `vertex`; three finite numbers are expected",
        ),
        ("beyond f32", ascii().replace("1 1 0e0", "1 1e39 0"), ":6: `1e39` after `vertex`; three finite numbers are"),
        (
            "half a normal",
            ascii().replace("normal 0 0 1", "normal 0 0"),
            ":3: `outer` after `normal`; three numbers are",
        ),
        ("a facet in a facet", ascii().replacen("endfacet", "", 1), ":9: `facet`; `endfacet` before it is expected"),
        ("four vertices", ascii().replace("endloop", "vertex 0 0 0"), ":7: `vertex`; three vertices in a facet are"),
        ("two vertices", ascii().replace("vertex 1 1 0e0\n", ""), ":7: `endfacet`; three vertices before it are"),
        ("outside a facet", "solid\nvertex 0 0 0\n".to_owned(), ":2: `vertex`; three vertices in a facet are"),
        ("cut", ascii()[..100].to_owned(), ":"),
        (
            "inside a facet",
            "solid\nfacet normal 0 0 1\nouter loop\n".to_owned(),
            ":3: the end of the file inside a facet;",
        ),
        ("no triangles", "solid\nendsolid\n".to_owned(), ": no triangles, lines or points; at least one is expected"),
        ("something else", "v 0 0 0\n".to_owned(), ": STL: 8 bytes; `solid`, or at least 84 bytes, are expected"),
    ];
    for (name, text, expected) in rows {
        let message = message(text);
        assert!(message.starts_with(&format!("model.stl{expected}")), "{name}: {message}");
    }
    let mut whole = binary("");
    for length in 1..whole.len() {
        let expected = if length < 84 { "at least 84 bytes" } else { "the 184 bytes that 2 triangles take" };
        assert!(message(&whole[..length]).contains(expected), "{length}");
    }
    whole[80..84].fill(0xFF);
    assert!(message(&whole).contains("184 bytes; `solid`, or the 214748364834 bytes that 4294967295 triangles take"));
    let mut infinite = binary("");
    infinite[84 + 50 + 12..][..4].copy_from_slice(&f32::INFINITY.to_le_bytes());
    assert_eq!(message(infinite), "model.stl: triangle 1: the corner [inf, 0.0, 0.0]; finite numbers are expected");
}

/// The header's beginning says nothing where the size is that of a binary file, or more.
#[test]
fn binary_is_told_by_its_size() {
    let mut file = binary("solid");
    file.push(b'\n');
    assert_eq!(load(&file).parts[0].mesh, load(ascii()).parts[0].mesh);
    // Spaces instead of a count ask for more than there is.
    assert!(message([b' '; 100]).contains("the 26948814484 bytes that 538976288 triangles take"));
}

#[test]
fn white_space_may_stand_anywhere() {
    let expected = load(ascii());
    let one_line = ascii().replace('\n', " ");
    let a_word_a_line = ascii().replace("solid a square", "solid").replace(' ', "\n");
    for (text, name) in [
        (one_line.clone(), "a square"),
        (format!("\u{feff}{one_line}"), "a square"),
        (format!("\n\n {one_line}"), "a square"),
        (a_word_a_line, "model"),
        (ascii().replace('\n', "\t \r\n\r\n"), "a square"),
    ] {
        let model = load(&text);
        let [part] = &model.parts[..] else { panic!("{text:?}: {} parts", model.parts.len()) };
        assert_eq!((&part.mesh, &part.name[..]), (&expected.parts[0].mesh, name), "{text:?}");
        assert!(model.warnings.is_empty(), "{text:?}: {:?}", model.warnings);
    }
    let two = load(format!("{one_line}{}", one_line.replace("a square", "b")));
    assert_eq!(two.parts.iter().map(|part| &part.name[..]).collect::<Vec<_>>(), ["a square", "b"]);
}

/// The linear intensity of this many 31sts in sRGB.
fn linear(x: f32) -> f32 {
    ((x / 31.0 + 0.055) / 1.055).powf(2.4)
}

fn with_attributes(header: &[u8], attributes: [u16; 2]) -> Vec<u8> {
    let mut file = binary("");
    file[..header.len()].copy_from_slice(header);
    for (triangle, attribute) in attributes.into_iter().enumerate() {
        let at = 84 + 50 * triangle + 48;
        file[at..at + 2].copy_from_slice(&attribute.to_le_bytes());
    }
    file
}

#[test]
fn attributes_that_are_colours_become_those_of_vertices() {
    let red_of_viscam = 0x8000 | 31 << 10 | 15;
    let rows = [
        ("VisCAM", with_attributes(b"", [0, red_of_viscam]), [[1.0; 3], [1.0, 0.0, linear(15.0)]]),
        (
            "Magics",
            with_attributes(b"a COLOR=\xFF\0\0\xFF", [31 << 10 | 15, 0x8000]),
            [[linear(15.0), 0.0, 1.0], [1.0, 0.0, 0.0]],
        ),
    ];
    for (name, file, expected) in rows {
        let model = load(file);
        assert!(model.warnings.is_empty(), "{name}: {:?}", model.warnings);
        let mesh = &model.parts[0].mesh;
        // Two of four corners have two colours. Their normals are shared all the same.
        assert_eq!((mesh.positions().len(), mesh.normals()), (6, &[Vec3::Z; 6][..]), "{name}");
        let colors = mesh.colors().expect("they are there");
        for (triangle, expected) in mesh.triangles().zip(expected) {
            for corner in triangle {
                let off = (colors[corner as usize].truncate() - Vec3::from(expected)).abs().max_element();
                assert!(off < 1e-5, "{name}: {}", colors[corner as usize]);
            }
        }
    }
    let model = load(with_attributes(b"COLOR=\xFF\xFF\xFF\xFF,MATERIAL=\0\0\0", [0x8000; 2]));
    assert_eq!(model.warnings, ["the material in the header is skipped"]);
    assert_eq!(model.parts[0].mesh.positions().len(), 4);
}

/// Positions that f32 would round are counted from an origin.
#[test]
fn far_solids_have_an_origin() {
    let far = ascii().replace("vertex ", "vertex 5000000.").replace("5000000.-0", "5000000.0");
    let model = load(&far);
    assert!((model.origin.x - 5e6).abs() < 1.0, "{}", model.origin);
    let size = model.bounds().unwrap().size();
    // 5000000.0 and 5000000.1: f32 has steps of 0.5 there.
    assert!((size.x - 0.1).abs() < 1e-6, "{size}");
    assert_eq!(load(ascii()).origin, glam::DVec3::ZERO);
}
