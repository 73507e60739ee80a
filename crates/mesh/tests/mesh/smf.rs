//! SMF files.

use glam::{DVec3, Mat4, Vec2, Vec3, Vec4};
use halfway_mesh::{Model, NormalWeighting, Normals, load};

use crate::common::Folder;

fn load_text(text: impl AsRef<[u8]>) -> Model {
    let folder = Folder::new();
    load(&folder.write("model.smf", text)).unwrap()
}

/// Positions that f32 would round are counted from an origin, transformed ones too.
#[test]
fn far_positions_have_an_origin() {
    let far = load_text(b"v 5000000.1 0 0\nv 5000000.3 0 0\nv 5000000.1 0.2 0\nv 5000000.3 0.2 0\nf 1 2 4 3\n");
    let moved = b"trans 5000000 0 0\nv 0.1 0 0\nv 0.3 0 0\nv 0.1 0.2 0\nv 0.3 0.2 0\nv 9e9 0 0\nf 1 2 4 3\n";
    for model in [far, load_text(moved)] {
        assert!((model.origin.x - 5e6).abs() < 1.0, "{}", model.origin);
        let size = model.bounds().unwrap().size();
        assert!((size - Vec3::new(0.2, 0.2, 0.0)).length() < 1e-6 && model.triangle_count() == 2, "{size}");
    }
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
    let model = load_text(
        "set foo 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\ntex a.ppm\nc 1 0 0\nn 0 0 1\nn 0 0 1\nr 0 0\nbind r face\nr 0 0\nf 1 2 3\nbegin\nbegin\n",
    );
    assert_eq!(model.triangle_count(), 1);
    assert_eq!(
        model.warnings,
        [
            "model.smf:1: `set` is skipped",
            "model.smf:5: `tex` is skipped",
            "model.smf:6: `c` without a `bind` before it is skipped",
            "model.smf:7: `n` without a `bind` before it is skipped (and 1 more such lines)",
            "model.smf:9: `r` without a `bind` before it is skipped",
            "model.smf:11: `r` bound to faces is skipped",
            "model.smf:14: 2 `begin` without an `end`",
        ]
    );
}

#[test]
fn vertices_may_be_homogeneous_and_in_transforms() {
    let close = |name: &str, text: &str, expected: [Vec3; 3]| {
        let model = load_text(format!("{text}f 1 2 3\n"));
        assert!(model.warnings.is_empty(), "{name}: {:?}", model.warnings);
        for (p, q) in model.parts[0].mesh.positions().iter().zip(expected) {
            // Sines and cosines of right angles are rounded.
            assert!(p.distance(q) < 1e-6, "{name}: {p} {q}");
        }
    };
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    close("w", "v 0 0 0 2\nv 2 0 0 2\nv 0 -3 0 -3\n", [Vec3::ZERO, Vec3::X, Vec3::Y]);
    close(
        "trans",
        &format!("trans 1 2 3\n{corners}"),
        [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| p + Vec3::new(1., 2., 3.)),
    );
    close("scale", &format!("scale 2 3 4\n{corners}"), [Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * 3.0]);
    close("rot", &format!("rot z 90\n{corners}"), [Vec3::ZERO, Vec3::Y, Vec3::NEG_X]);
    close(
        "the last is applied first",
        &format!("trans 5 0 0\nrot z 90\n{corners}"),
        [Vec3::X * 5.0, Vec3::new(5.0, 1.0, 0.0), Vec3::new(4.0, 0.0, 0.0)],
    );
    close(
        "mmult",
        &format!("trans 5 0 0\nmmult 0 -1 0 0  1 0 0 0  0 0 1 0  0 0 0 1\n{corners}"),
        [Vec3::X * 5.0, Vec3::new(5.0, 1.0, 0.0), Vec3::new(4.0, 0.0, 0.0)],
    );
    close(
        "mload forgets",
        &format!("trans 5 0 0\nmload 1 0 0 0  0 1 0 0  0 0 1 7  0 0 0 1\n{corners}"),
        [Vec3::Z * 7.0, Vec3::new(1.0, 0.0, 7.0), Vec3::new(0.0, 1.0, 7.0)],
    );
    close(
        "projective",
        &format!("mload 1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 2\n{corners}"),
        [Vec3::ZERO, Vec3::X * 0.5, Vec3::Y * 0.5],
    );
    // `end` forgets what its scope did.
    close("scopes", "begin\nbegin\nscale 9 9 9\nend\nv 0 0 0\nend\nv 1 0 0\nv 0 1 0\n", [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

#[test]
fn scopes_count_their_own_vertices() {
    let model = load_text(
        "v 9 9 9\nbegin\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nbegin\ntrans 0 0 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nend\nf 4 5 6\nend\nf 2 3 4\n\
         set vertex_correction 1\nf 0 1 2\nf 1 2 3\n",
    );
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    let expected: [u32; 18] = [1, 2, 3, 4, 5, 6, 4, 5, 6, 1, 2, 3, 0, 1, 2, 1, 2, 3];
    assert_eq!(model.parts[0].mesh.indices(), expected);
    assert_eq!(model.parts[0].mesh.positions()[5], Vec3::new(1.0, 0.0, 1.0));
}

#[test]
fn bound_attributes_are_kept() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
    let of_vertices = load_text(format!(
        "{square}bind n vertex\nn 0 0 2\nn 3 0 4\nn 0 0 1\nn 0 0 1\nbind r vertex\nr 0 0\nr 1 0\nr 1 0.25\nr 0 1\nbind c vertex\n{}",
        "c 1 0 0\n".repeat(4)
    ));
    assert!(of_vertices.warnings.is_empty(), "{:?}", of_vertices.warnings);
    let mesh = &of_vertices.parts[0].mesh;
    assert_eq!(mesh.normals(), [Vec3::Z, Vec3::new(0.6, 0.0, 0.8), Vec3::Z, Vec3::Z]);
    // v runs upward in the file.
    assert_eq!(mesh.uvs().unwrap()[2], Vec2::new(1.0, 0.75));
    assert_eq!(mesh.colors().unwrap(), [Vec4::new(1.0, 0.0, 0.0, 1.0); 4]);

    let of_faces = load_text(format!("{square}bind c face\nc 1 0 0\nc 0 1 0\nbind n face\nn 0 0 1\nn 0 1 0\n"));
    let mesh = &of_faces.parts[0].mesh;
    assert_eq!(mesh.positions().len(), 6);
    assert_eq!(mesh.normals(), [Vec3::Z, Vec3::Z, Vec3::Z, Vec3::Y, Vec3::Y, Vec3::Y]);
    assert_eq!(mesh.colors().unwrap()[2..4], [Vec4::new(1.0, 0.0, 0.0, 1.0), Vec4::new(0.0, 1.0, 0.0, 1.0)]);

    // The normal of a face counts for all triangles that it is cut into.
    let cut = load_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 4\nbind n face\nn 0 1 0\nn 1 0 0\n");
    let [y, x] = [Vec3::Y, Vec3::X];
    assert_eq!(cut.parts[0].mesh.normals(), [y, y, y, y, y, y, x, x, x]);
    assert_eq!(cut.warnings, ["model.smf:5: a face of more than three corners, which SMF does not have, is cut"]);

    // Turned with their vertices, as planes are.
    let turned = load_text(format!("scale 1 2 1\nrot x 90\n{square}bind n vertex\n{}", "n 0 0 1\n".repeat(4)));
    for n in turned.parts[0].mesh.normals() {
        assert!(n.distance(Vec3::NEG_Y) < 1e-6, "{n}");
    }

    let few = load_text(format!("{square}bind n vertex\nn 0 1 0\n"));
    assert_eq!(few.parts[0].mesh.normals(), [Vec3::Y, Vec3::Z, Vec3::Z, Vec3::Z]);
    assert_eq!(
        few.warnings,
        [
            "model.smf: 1 `n` for 4 vertices; what is missing is a computed normal, what is left over is skipped",
            "3 vertices without a normal get a computed one",
        ]
    );
}

#[test]
fn groups_become_parts() {
    let model = load_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\ng first\ng left side\nf 1 2 3\ng right\nf 1 3 4\ng empty\n",
    );
    let parts: Vec<_> = model.parts.iter().map(|part| (&part.name[..], part.mesh.positions().len())).collect();
    assert_eq!(parts, [("left side", 3), ("right", 3)]);
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
}

#[test]
fn malformed_files_are_refused_by_line() {
    let start = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let rows: [(&str, Vec<u8>, &str); 31] = [
        ("two numbers", b"v 0 0\n".into(), ":1: `v 0 0`; `v` and three numbers are expected"),
        ("five numbers", b"v 0 0 0 1 1\n".into(), ":1: `v 0 0 0 1 1`; `v` and three numbers are expected"),
        (
            "w of 0",
            b"v 1 0 0 0\n".into(),
            ":1: `v 1 0 0 0`; a fourth number of `v` by which the others can be divided is expected",
        ),
        (
            "w that overflows",
            b"v 1e30 0 0 1e-30\n".into(),
            ":1: `v 1e30 0 0 1e-30`; a fourth number of `v` by which the others can be divided is expected",
        ),
        ("end", b"begin\nend\nend\n".into(), ":3: `end`; a `begin` before it is expected"),
        (
            "no axis",
            b"rot w 90\n".into(),
            ":1: `rot w 90`; `rot`, one of x, y and z, and an angle in degrees are expected",
        ),
        ("half a matrix", b"mload 1 0 0 0\n".into(), ":1: `mload 1 0 0 0`; sixteen numbers are expected"),
        ("no vector", b"trans 1 0\n".into(), ":1: `trans 1 0`; three numbers are expected"),
        (
            "vertex far away",
            b"scale 1e30 1 1\nv 1e30 0 0\n".into(),
            ":2: `v 1e30 0 0`; a vertex that its transform leaves in the range of f32 is expected",
        ),
        (
            "vertex at infinity",
            b"mload 1 0 0 0  0 1 0 0  0 0 1 0  1 0 0 0\nv 0 1 0\n".into(),
            ":2: `v 0 1 0`; a vertex that its transform leaves in the range of f32 is expected",
        ),
        (
            "correction",
            b"set vertex_correction x\n".into(),
            ":1: `set vertex_correction x`; `set vertex_correction` and a whole number is expected",
        ),
        (
            "binding",
            b"bind q face\n".into(),
            ":1: `bind q face`; `bind`, one of c, n and r, and one of vertex and face are expected",
        ),
        (
            "two bindings",
            b"bind n face\nn 0 0 1\nbind n vertex\n".into(),
            ":3: `bind n vertex`; the same binding as above for values of which there are some is expected",
        ),
        ("colour", b"bind c face\nc 1 0\n".into(), ":2: `c 1 0`; `c` and three numbers are expected"),
        ("texture coordinate", b"bind r vertex\nr 1 inf\n".into(), ":2: `inf` in `r`; a finite number is expected"),
        (
            "polygon before its vertices",
            b"v 0 0 0\nf 1 2 3 4\nv 1 0 0\nv 1 1 0\nv 0 1 0\n".into(),
            ":2: `f 1 2 3 4`; vertices that stand above a face of more than three corners are expected",
        ),
        ("no numbers", b"\nv\n".into(), ":2: `v`; `v` and three numbers are expected"),
        ("a word", b"v 0 zero 0\n".into(), ":1: `zero` in `v`; a finite number is expected"),
        ("NaN", b"v 0 0 0\nv 0 NaN 0\n".into(), ":2: `NaN` in `v`; a finite number is expected"),
        ("infinity", b"v 0 0 -inf\n".into(), ":1: `-inf` in `v`; a finite number is expected"),
        ("beyond f32", b"v 0 0 1e39\n".into(), ":1: `1e39` in `v`; a finite number is expected"),
        ("index 0", format!("{start}f 0 1 2\n").into(), ":4: the vertex number 0 in `f`; a number from 1 is expected"),
        (
            "index out of range",
            format!("{start}f 1 2 3\n#\nf 1 2 4\n").into(),
            ":6: the vertex number 4 in `f`; one of the 3 vertices, counted from 1, is expected",
        ),
        ("no vertices", b"f 1 2 3\n".into(), ":1: the vertex number 3 in `f`; a vertex that a `v` defines is expected"),
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
            "two corners",
            format!("{start}f 1 2\n").into(),
            ":4: `f 1 2`; `f` and three vertex numbers, counted from 1, are expected",
        ),
        ("no faces", start.into(), ": no triangles, lines or points; at least one is expected"),
        ("comments alone", b"# nothing\n\n".into(), ": no triangles, lines or points; at least one is expected"),
        ("wrong UTF-8", b"v 0 0 0\nv 0 \xFF 0\n".into(), ":2: `ÿ` in `v`; a finite number is expected"),
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

#[test]
fn lecture_meshes_have_the_normals_computed_by_hand() {
    // As they are printed. Each normal is the sum of the unit normals of the triangles around the vertex, normalised.
    let cube = "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n\
        f 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 1 6 5\nf 3 7 8\nf 3 8 4\nf 1 5 7\nf 1 7 3\nf 2 4 8\nf 2 8 6\n";
    // How many of the triangles around each vertex are on the side along x, y and z, by hand.
    let cube_sums = [
        [-2.0, -2.0, -2.0],
        [2.0, -1.0, -1.0],
        [-1.0, 2.0, -1.0],
        [1.0, 1.0, -2.0],
        [-1.0, -1.0, 2.0],
        [1.0, -2.0, 1.0],
        [-2.0, 1.0, 1.0],
        [2.0, 2.0, 2.0],
    ];
    let pyramid = "##SMF 1.0\n##vertices 5\n##faces 6\nv 2.0 0.0 2.0\nv 2.0 0.0 -2.0\nv -2.0 0.0 -2.0\nv -2.0 0.0 2.0\n\
        v 0.0 5.0 0.0\nf 1 3 2\nf 1 4 3\nf 3 5 2\nf 2 5 1\nf 1 5 4\nf 4 5 3\n";
    // The base faces −y. A side rises by 5 over 2, so it faces (5, 2)/√29 outward and up.
    let [out, up] = [5.0, 2.0].map(|x: f64| x / 29.0_f64.sqrt());
    let pyramid_sums = [
        [out, 2.0 * up - 2.0, out],
        [out, 2.0 * up - 1.0, -out],
        [-out, 2.0 * up - 2.0, -out],
        [-out, 2.0 * up - 1.0, out],
        [0.0, 4.0 * up, 0.0],
    ];
    for (name, text, sums) in [("cube", cube, &cube_sums[..]), ("pyramid", pyramid, &pyramid_sums)] {
        let model = load_text(text);
        assert!(model.warnings.is_empty(), "{name}: {:?}", model.warnings);
        let [part] = &model.parts[..] else { panic!("{name}: {} parts", model.parts.len()) };
        assert_eq!(part.mesh.positions().len(), sums.len(), "{name}");
        let (mesh, report) = part.mesh.clone().with_normals(Normals::Weighted(NormalWeighting::Uniform));
        assert!(report.is_clean(), "{name}: {report:?}");
        for (i, (n, sum)) in mesh.normals().iter().zip(sums).enumerate() {
            // Rounded to f32 in each coordinate.
            let expected = DVec3::from_array(*sum).normalize();
            assert!(n.as_dvec3().distance(expected) < 1e-7, "{name}, vertex {}: {n} {expected}", i + 1);
        }
    }
}
