//! SMF files.

mod common;

use bevy_math::{Mat4, Vec3};
use common::Folder;
use halfway_mesh::{Model, load};

fn load_text(text: impl AsRef<[u8]>) -> Model {
    let folder = Folder::new();
    load(&folder.write("model.smf", text)).unwrap()
}

#[test]
fn vertices_and_faces_are_read() {
    let rows: [(&str, &[u8]); 6] = [
        ("plain", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        ("comments and blank lines", b"#$SMF 1.0\n## one\n# two\n\nv 0 0 0\n   \nv 1 0 0 # x\nv 0 1 0\n\nf 1 2 3"),
        ("white space", b"\tv  0 0\t0 \r\nv 1 0 0\r\n v 0 1 0\r\nf\t1  2 3 \r\n"),
        ("number forms", b"v 0. -0 +0\nv 1e0 0.0 .0\nv 0 10E-1 0\nf 1 2 3\n"),
        ("faces first", b"f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"),
        ("byte order mark, foreign comment", b"\xEF\xBB\xBF# caf\xE9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
    ];
    for (name, text) in rows {
        let model = load_text(text);
        assert!(model.warnings.is_empty(), "{name}: {:?}", model.warnings);
        let [part] = &model.parts[..] else { panic!("{name}: {} parts", model.parts.len()) };
        assert_eq!((&part.name[..], part.material, part.world_from_part), ("model", None, Mat4::IDENTITY), "{name}");
        assert_eq!(part.mesh.positions(), [Vec3::ZERO, Vec3::X, Vec3::Y], "{name}");
        assert_eq!(part.mesh.normals(), [Vec3::Z; 3], "{name}");
        assert_eq!(part.mesh.indices(), [0, 1, 2], "{name}");
    }
}

#[test]
fn other_statements_are_skipped_with_a_warning() {
    let model = load_text("begin\nv 0 0 0\nv 1 0 0\nv 0 1 0\nbind c vertex\nc 1 0 0\nc 0 1 0\nc 0 0 1\nf 1 2 3\nend\n");
    assert_eq!(model.triangle_count(), 1);
    assert_eq!(
        model.warnings,
        [
            "model.smf:1: `begin` is skipped",
            "model.smf:5: `bind` is skipped",
            "model.smf:6: `c` is skipped (and 2 more such lines)",
            "model.smf:10: `end` is skipped",
        ]
    );
}

#[test]
fn malformed_files_are_refused_by_line() {
    let start = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let rows: [(&str, Vec<u8>, &str); 17] = [
        ("two numbers", b"v 0 0\n".into(), ":1: `v 0 0`; `v` and three numbers are expected"),
        ("four numbers", b"v 0 0 0 0\n".into(), ":1: `v 0 0 0 0`; `v` and three numbers are expected"),
        ("no numbers", b"\nv\n".into(), ":2: `v`; `v` and three numbers are expected"),
        ("a word", b"v 0 zero 0\n".into(), ":1: `zero` in `v`; a finite number is expected"),
        ("NaN", b"v 0 0 0\nv 0 NaN 0\n".into(), ":2: `NaN` in `v`; a finite number is expected"),
        ("infinity", b"v 0 0 -inf\n".into(), ":1: `-inf` in `v`; a finite number is expected"),
        ("beyond f32", b"v 0 0 1e39\n".into(), ":1: `1e39` in `v`; a finite number is expected"),
        (
            "index 0",
            format!("{start}f 0 1 2\n").into(),
            ":4: the vertex number 0 in `f`; a number from 1 to 3 is expected",
        ),
        (
            "index out of range",
            format!("{start}f 1 2 3\n#\nf 1 2 4\n").into(),
            ":6: the vertex number 4 in `f`; a number from 1 to 3 is expected",
        ),
        ("no vertices", b"f 1 2 3\n".into(), ":1: the vertex number 1 in `f`; a number from 1 to 0 is expected"),
        (
            "negative index",
            format!("{start}f -1 2 3\n").into(),
            ":4: `f -1 2 3`; `f` and three vertex numbers, counted from 1, are expected",
        ),
        (
            "absurd index",
            format!("{start}f 1 2 99999999999999999999\n").into(),
            ":4: `f 1 2 99999999999999999999`; `f` and three vertex numbers, counted from 1, are expected",
        ),
        (
            "fraction",
            format!("{start}f 1 2 3.5\n").into(),
            ":4: `f 1 2 3.5`; `f` and three vertex numbers, counted from 1, are expected",
        ),
        (
            "quadrangle",
            format!("{start}f 1 2 3 1\n").into(),
            ":4: `f 1 2 3 1`; `f` and three vertex numbers, counted from 1, are expected",
        ),
        ("no faces", start.into(), ": no triangles; at least one is expected"),
        ("comments alone", b"# nothing\n\n".into(), ": no triangles; at least one is expected"),
        ("wrong UTF-8", b"v 0 0 0\nv 0 \xFF 0\n".into(), ":2: the byte 0xFF; UTF-8 text is expected"),
    ];
    for (name, text, expected) in rows {
        let folder = Folder::new();
        let path = folder.write("model.smf", text);
        let error = load(&path).unwrap_err();
        assert_eq!(error.to_string(), format!("{}{expected}", path.display()), "{name}");
        assert_eq!(error.path(), path, "{name}");
    }
}

#[test]
fn long_lines_are_quoted_in_part() {
    let folder = Folder::new();
    let path = folder.write("model.smf", format!("v {}\n", "ä".repeat(100_000)));
    assert!(load(&path).unwrap_err().to_string().len() < 400);
}

#[test]
fn a_file_of_something_else_has_few_warnings() {
    let words: Vec<String> = (0..1000).map(|i| format!("word{i:04}{}", "x".repeat(1000))).collect();
    let warnings = load_text(format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n{}", words.join("\n"))).warnings;
    assert_eq!(warnings.len(), 21);
    assert!(warnings.iter().all(|warning| warning.len() < 120), "{warnings:?}");
    assert_eq!(warnings[20], "model.smf:25: something else is skipped or not found (and 979 more such lines)");
}
