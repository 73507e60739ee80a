//! OFF files.

use glam::{DVec3, Vec2, Vec3, Vec4};
use halfway_mesh::{Format, Model, load_bytes};

fn load(text: impl AsRef<[u8]>) -> Model {
    load_bytes(Format::Off, text.as_ref()).unwrap()
}

/// A square of one polygon.
const SQUARE: &str = "OFF\n4 1 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

#[test]
fn polygons_are_read_in_every_spelling() {
    let expected = load(SQUARE);
    let [part] = &expected.parts[..] else { panic!("{} parts", expected.parts.len()) };
    assert_eq!(part.mesh.positions(), [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y]);
    assert_eq!(part.mesh.indices(), [0, 1, 2, 0, 2, 3]);
    assert_eq!((part.name.as_str(), part.mesh.normals()[0]), ("model", Vec3::Z));
    assert!(expected.warnings.is_empty(), "{:?}", expected.warnings);
    for (name, text) in [
        ("counts beside the word", SQUARE.replace("OFF\n", "OFF ")),
        ("no word", SQUARE.replace("OFF\n", "")),
        ("two counts", SQUARE.replace("4 1 4", "4 1")),
        ("comments", SQUARE.replace("OFF\n", "# made by hand\nOFF # a square\n\n").replace("1 0 0\n", "1 0 0 # x\n\n")),
        ("other line ends", SQUARE.replace('\n', " \r\n")),
        ("byte order mark", format!("\u{feff}{SQUARE}")),
        ("weights", SQUARE.replace("OFF", "4OFF").replace(" 0\n", " 0 1\n").replace("1 1 0 1", "2 2 0 2")),
    ] {
        let model = load(&text);
        assert_eq!(model.parts[0].mesh, part.mesh, "{name}");
        assert!(model.warnings.is_empty(), "{name}: {:?}", model.warnings);
    }
}

#[test]
fn vertices_may_have_normals_colours_and_texture_coordinates() {
    let text =
        "STCNOFF\n3 1 0\n0 0 0 0 0 2 255 0 0 0.25 1\n1 0 0 0 0 -1 0 255 0 0 0\n0 1 0 0 0 1 0 0 255 1 1\n3 0 1 2\n";
    let mesh = load(text).parts[0].mesh.clone();
    assert_eq!(mesh.normals(), [Vec3::Z, -Vec3::Z, Vec3::Z]);
    assert_eq!(mesh.uvs().unwrap(), [Vec2::new(0.25, 0.0), Vec2::Y, Vec2::X]);
    assert_eq!(
        mesh.colors().unwrap(),
        [Vec4::new(1.0, 0.0, 0.0, 1.0), Vec4::new(0.0, 1.0, 0.0, 1.0), Vec4::new(0.0, 0.0, 1.0, 1.0)]
    );
    // From 0 to 1, with an opacity.
    let text = "COFF\n3 1 0\n0 0 0 1 0 0 0.5\n1 0 0 1 1 1 1\n0 1 0 0 0 0 0\n3 0 1 2\n";
    assert_eq!(load(text).parts[0].mesh.colors().unwrap()[0], Vec4::new(1.0, 0.0, 0.0, 0.5));
}

#[test]
fn colours_of_faces_split_vertices() {
    let two = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n3 0 2 3\n";
    let model = load(two);
    let mesh = &model.parts[0].mesh;
    assert_eq!((mesh.positions().len(), mesh.normals()), (6, &[Vec3::Z; 6][..]));
    let colors = mesh.colors().unwrap();
    let of_triangles: Vec<_> = mesh.triangles().map(|corners| corners.map(|corner| colors[corner as usize])).collect();
    assert_eq!(of_triangles, [[Vec4::new(1.0, 0.0, 0.0, 1.0); 3], [Vec4::ONE; 3]]);
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
}

#[test]
fn without_faces_the_vertices_are_points() {
    let model = load("COFF\n2 0 0\n0 0 0 255 0 0\n1 0 0 0 255 0\n");
    assert_eq!((model.parts.len(), model.point_count()), (0, 2));
    assert_eq!(model.lines[0].lines.colors().unwrap()[0], Vec4::new(1.0, 0.0, 0.0, 1.0));
}

#[test]
fn positions_far_away_have_an_origin() {
    let far = "OFF\n4 1 0\n400000.0 5000000.0 0\n400000.1 5000000.0 0\n400000.1 5000000.1 0\n9e9 nan 0\n3 0 1 2\n";
    let model = load(far);
    assert!((model.origin - DVec3::new(4e5, 5e6, 0.0)).length() < 1.0, "{}", model.origin);
    let size = model.bounds().unwrap().size();
    assert!((size - Vec3::new(0.1, 0.1, 0.0)).length() < 1e-6, "{size}");
    assert_eq!(model.warnings, ["1 vertices of no face are not finite, and are put at 0"]);
    assert_eq!(load(SQUARE).origin, DVec3::ZERO);
}

#[test]
fn oddities_are_warnings() {
    let rows = [
        (format!("{SQUARE}more\n"), "model.off:8: text after the last face is skipped"),
        (SQUARE.replace("1 1 0\n", "1 1 0 7\n"), "model.off:5: numbers after the 3 of a vertex are skipped"),
        (SQUARE.replace("4 0 1 2 3", "4 0 1 2 3 12"), "model.off:7: a colour by its number in a map is skipped"),
        (
            SQUARE.replace("4 0 1 2 3", "4 0 1 2 3 1 2 3 4 5"),
            "model.off:7: numbers after the corners of a face that are no colour are skipped",
        ),
        (
            SQUARE.replace("4 1 4", "4 2 4").replace("4 0 1 2 3", "2 0 1\n4 0 1 2 3"),
            "model.off:7: a face of fewer than three corners is skipped",
        ),
        (
            SQUARE.replace("4 0 1 2 3", "4 0 2 1 3"),
            "1 polygons that cross themselves, or have too many corners, are cut somehow",
        ),
        (
            "NOFF\n3 1 0\n0 0 0 0 0 0\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n".to_owned(),
            "1 normals of zero length are replaced by computed ones",
        ),
        (
            "COFF\n3 1 0\n0 0 0 1 1 1\n1 0 0 1 1 1\n0 1 0 1 1 1\n3 0 1 2 1 0 0\n".to_owned(),
            "the colours of faces are skipped, since vertices have colours, too",
        ),
        ("STOFF\n1 0 0\n0 0 0 0 0\n".to_owned(), "texture coordinates of points are skipped"),
    ];
    for (text, expected) in rows {
        assert_eq!(load(&text).warnings, [expected], "{text}");
    }
}

#[test]
fn malformed_files_are_refused_by_line() {
    const FACE: &str = "a number of corners, and as many vertices, counted from 0, are expected";
    const WORD: &str = "`OFF`, perhaps with ST, C, N or 4 before it, is expected";
    const COUNTS: &str = "the numbers of vertices and faces are expected";
    let rows = [
        ("# nothing\n".to_owned(), ":1: no words; `OFF` is expected".to_owned()),
        ("ply\n".to_owned(), format!(":1: `ply`; {WORD}")),
        ("XOFF\n".to_owned(), format!(":1: `XOFF`; {WORD}")),
        (
            "nOFF 3\n".to_owned(),
            ":1: `nOFF 3`; vertices of three dimensions, and so `OFF` or `4OFF`, are expected".into(),
        ),
        ("OFF BINARY\n".to_owned(), ":1: binary OFF; OFF in text is expected".into()),
        ("OFF\n".to_owned(), format!(":1: the end of the file after its first line; {COUNTS}")),
        ("OFF\n4\n".to_owned(), format!(":2: `4`; {COUNTS}")),
        ("OFF\n-1 3 0\n".to_owned(), format!(":2: `-1 3 0`; {COUNTS}")),
        (
            "OFF\n99999999999999 1 0\n0 0 0\n".to_owned(),
            ":3: the end of the file after 1 of 99999999999999 vertices; a line for each vertex is expected".into(),
        ),
        (
            SQUARE.replace("4 0 1 2 3\n", ""),
            ":6: the end of the file after 0 of 1 faces; a line for each face is expected".into(),
        ),
        (SQUARE.replace("1 1 0\n", "1 1\n"), ":5: `1 1`; 3 numbers of a vertex are expected".into()),
        (SQUARE.replace("1 1 0\n", "1 one 0\n"), ":5: `one` of a vertex; a number is expected".into()),
        (
            SQUARE.replace("OFF", "COFF"),
            ":3: `0 0 0`; 3 numbers of a vertex, and three or four of its colour, are expected".into(),
        ),
        (SQUARE.replace("4 0 1 2 3", "4 0 1 2"), format!(":7: `4 0 1 2`; {FACE}")),
        (SQUARE.replace("4 0 1 2 3", "four"), format!(":7: `four`; {FACE}")),
        (SQUARE.replace("4 0 1 2 3", "4 0 1 2 -1"), format!(":7: `4 0 1 2 -1`; {FACE}")),
        (
            SQUARE.replace("4 0 1 2 3", "4 0 1 2 4"),
            ":7: the vertex 4 of a face; one of the 4 vertices, counted from 0, is expected".into(),
        ),
        (SQUARE.replace("4 0 1 2 3", "4 0 1 2 3 red"), ":7: `red` in `4`; a finite number is expected".into()),
        (SQUARE.replace("1 1 0\n", "1 inf 0\n"), ": vertex 2: [1.0, inf, 0.0]; finite numbers are expected".into()),
        ("OFF 0 0 0\n".to_owned(), ": no triangles, lines or points; at least one is expected".into()),
    ];
    for (text, expected) in rows {
        let error = load_bytes(Format::Off, text.as_bytes()).unwrap_err().to_string();
        assert_eq!(error, format!("model.off{expected}"), "{text}");
    }
}
