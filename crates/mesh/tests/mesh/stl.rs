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
    assert_eq!(load(colored).warnings, ["the attributes (colours, by some programs) of 1 triangles are skipped"]);
}

#[test]
fn malformed_files_are_refused() {
    let rows = [
        (
            "two numbers",
            ascii().replace("vertex 1 1 0e0", "vertex 1 1"),
            ":6: `vertex 1 1`; `vertex` and three numbers are",
        ),
        (
            "NaN",
            ascii().replace("vertex 1 1 0e0", "vertex 1 1 nan"),
            ":6: `nan` in `vertex`; a finite number is expected",
        ),
        (
            "no normal",
            ascii().replace("facet normal 0 0 1", "facet"),
            ":2: `facet`; `facet normal` and three numbers are",
        ),
        (
            "four vertices",
            ascii().replace("endloop", "vertex 0 0 0"),
            ":7: `vertex 0 0 0`; three vertices in a facet are",
        ),
        ("two vertices", ascii().replace("vertex 1 1 0e0\n", ""), ":7: `endfacet`; three vertices before it are"),
        ("outside a facet", "solid\nvertex 0 0 0\n".to_owned(), ":2: `vertex 0 0 0`; three vertices in a facet are"),
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
