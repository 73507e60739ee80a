//! OBJ and MTL files.
#![expect(clippy::float_cmp, reason = "numbers that are whole fractions of powers of two, or copied")]

use std::fmt::Write as _;

use glam::{DVec3, Vec2, Vec3, Vec4};
use halfway_mesh::{Format, Model, MtlMaps, MtlMaterial, SourceMaterial, load, load_bytes};

use crate::common::Folder;

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn load_text(text: &str) -> Model {
    let folder = Folder::new();
    load(&folder.write("model.obj", text)).unwrap()
}

fn load_with_mtl(obj: &str, mtl: &str) -> Model {
    let folder = Folder::new();
    folder.write("model.mtl", mtl);
    load(&folder.write("model.obj", obj)).unwrap()
}

#[test]
fn the_forms_of_faces() {
    let with_rest = format!("{SQUARE}vt 0 0\nvt 1 0.25\nvn 0 0 2\n");
    let rows = [
        ("triangle", "f 1 2 3", 1, false),
        ("quadrangle", "f 1 2 3 4", 2, false),
        ("texture coordinates", "f 1/1 2/2 3/1", 1, true),
        ("normals", "f 1//1 2//1 3//1", 1, false),
        ("both", "f 1/1/1 2/2/1 3/1/1 4/2/1", 2, true),
        ("negative", "f -4/-2/-1 -3/-1/-1 -2/-2/-1", 1, true),
        ("old keyword", "fo 1 2 3", 1, false),
        ("comment behind", "f 1 2 3 # 4", 1, false),
        ("continued", "f 1 2 \\\n 3 4", 2, false),
        ("comment that ends in a backslash", "# C:\\\nf 1 2 3", 1, false),
        ("comment behind that ends in a backslash", "v 9 9 9 # corner \\\nf 1 2 3", 1, false),
        ("white space", " f\t1  2 3 \r", 1, false),
        ("nothing after two slashes", "f 1// 2// 3//", 1, false),
        ("nothing after one slash", "f 1/ 2/ 3/", 1, false),
        ("nothing after the last slash", "f 1/1/ 2/2/ 3/1/", 1, true),
    ];
    for (name, face, triangles, uvs) in rows {
        let model = load_text(&format!("{with_rest}{face}\n"));
        assert!(model.warnings.is_empty(), "{name}: {:?}", model.warnings);
        let [part] = &model.parts[..] else { panic!("{name}: {} parts", model.parts.len()) };
        assert_eq!(part.mesh.triangle_count(), triangles, "{name}");
        assert_eq!(part.mesh.uvs().is_some(), uvs, "{name}");
        assert_eq!(part.mesh.normals()[0], Vec3::Z, "{name}");
        let [a, b, ..] = part.mesh.triangles().next().unwrap().map(|i| i as usize);
        assert_eq!(part.mesh.positions()[b], Vec3::X, "{name}");
        if let Some(uvs) = part.mesh.uvs() {
            // v runs upward in the file.
            assert_eq!((uvs[a], uvs[b]), (Vec2::new(0.0, 1.0), Vec2::new(1.0, 0.75)), "{name}");
        }
    }
}

#[test]
fn given_normals_are_used() {
    let model = load_text(&format!("{SQUARE}vn 3 0 4\nf 1//1 2//1 3//1\n"));
    for n in model.parts[0].mesh.normals() {
        assert!(n.distance(Vec3::new(0.6, 0.0, 0.8)) < 1e-7, "{n}");
    }
}

#[test]
fn faces_may_come_before_their_vertices() {
    let model = load_text(&format!("o early\nf 1 2 3\no late\nf 2 3 4\n{SQUARE}"));
    assert_eq!(model.triangle_count(), 2);
    assert_eq!(model.parts[1].mesh.bounds().max, Vec3::new(1.0, 1.0, 0.0));
}

#[test]
fn objects_groups_and_materials_become_parts() {
    let obj = format!(
        "mtllib model.mtl\n{SQUARE}f 1 2 3\no Left Side\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\nf 2 3 4\ng right #1\nf 2 3 4\no empty\n"
    );
    let model = load_with_mtl(&obj, "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    let parts: Vec<_> =
        model.parts.iter().map(|part| (&part.name[..], part.material, part.mesh.triangle_count())).collect();
    assert_eq!(parts, [("", None, 1), ("Left Side", Some(0), 1), ("Left Side", Some(1), 2), ("right #1", Some(1), 1)]);
    assert_eq!(model.materials.iter().map(SourceMaterial::name).collect::<Vec<_>>(), ["red", "blue"]);
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
}

#[test]
fn a_bare_usemtl_takes_the_material_away() {
    let obj = format!("mtllib model.mtl\n{SQUARE}usemtl red\nf 1 2 3\nusemtl\nf 1 3 4\n");
    let model = load_with_mtl(&obj, "newmtl red\nKd 1 0 0\n");
    assert_eq!(model.parts.iter().map(|part| part.material).collect::<Vec<_>>(), [Some(0), None]);
    assert_eq!(model.parts.iter().map(|part| part.mesh.triangle_count()).collect::<Vec<_>>(), [1, 1]);
    assert_eq!(model.warnings, ["model.obj:8: `usemtl` without a name: the faces after it have no material"]);
}

#[test]
fn every_statement_of_a_material_is_kept() {
    let mtl = "\u{feff}# two materials\nnewmtl all of it\n Ka 0.1 0.2 0.3\nKd 0.5\nKs 1 1 1 # white\n\tKe 0 0 2.5\nNs 27.8974\nd 0.75\nTr 0.5\nillum 2\nNi 1.5\nPr 0.25\nPm 1\nTf 1 1 1\nnewmtl nothing\n";
    let model = load_with_mtl(&format!("mtllib model.mtl\n{SQUARE}usemtl all of it\nf 1 2 3\n"), mtl);
    let all = MtlMaterial {
        name: "all of it".to_owned(),
        ka: Some([0.1, 0.2, 0.3]),
        kd: Some([0.5; 3]),
        ks: Some([1.0; 3]),
        ke: Some([0.0, 0.0, 2.5]),
        ns: Some(27.8974),
        d: Some(0.75),
        tr: Some(0.5),
        illum: Some(2),
        pr: Some(0.25),
        pm: Some(1.0),
        maps: MtlMaps::default(),
    };
    let nothing = MtlMaterial { name: "nothing".to_owned(), ..MtlMaterial::default() };
    assert_eq!(model.materials, [SourceMaterial::Mtl(all), SourceMaterial::Mtl(nothing)]);
    assert_eq!(model.parts[0].material, Some(0));
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
}

#[test]
fn material_libraries_may_have_spaces_or_several_names() {
    let folder = Folder::new();
    folder.write("my brass.mtl", "newmtl brass\n");
    folder.write("sub/red.mtl", "newmtl red\n");
    folder.write("blue.mtl", "newmtl blue\n");
    let obj = format!("mtllib my brass.mtl\nmtllib sub/red.mtl blue.mtl\n{SQUARE}usemtl blue\nf 1 2 3\n");
    let model = load(&folder.write("model.obj", obj)).unwrap();
    assert_eq!(model.materials.iter().map(SourceMaterial::name).collect::<Vec<_>>(), ["brass", "red", "blue"]);
    assert_eq!(model.parts[0].material, Some(2));
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table of statements and their warnings")]
fn skipped_contents_give_warnings() {
    let rows: [(&str, String, &[&str]); 17] = [
        (
            "normal that is not finite",
            format!("{SQUARE}vn nan nan nan\nvn 0 0 1\nf 1//1 2//2 3//2\n"),
            &[
                "model.obj:5: a normal that is not finite is taken for (0, 0, 0)",
                "``: 1 normals of zero length are replaced by computed ones",
            ],
        ),
        (
            "index 0",
            format!("{SQUARE}vn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1\nf 1/1/0 3/0/0 4/1/0\n"),
            &[
                "model.obj:8: a normal that there is not, as 0, in `f` counts as none (and 2 more such lines)",
                "model.obj:8: a texture coordinate that there is not, as 0, in `f` counts as none",
                "``: 1 of 6 vertices have no texture coordinate; they get (0, 0)",
                "``: 3 of 6 vertices have no normal; they get a computed one",
            ],
        ),
        (
            "nothing of what is referred to",
            format!("{SQUARE}f 1/1/1 2/2/2 3/3/3\nf 1/1/1 3/3/3 4/4/4\n"),
            &[
                "model.obj:6: the normal 4 in `f`, and every other beyond the 0 that there are, counts as none",
                "model.obj:6: the texture coordinate 4 in `f`, and every other beyond the 0 that there are, counts as none",
            ],
        ),
        (
            "references beyond what there is",
            format!("{SQUARE}vn 0 0 1\nf 1//1 2//1 3//7\nf 1//-2 3//1 4//1\n"),
            &[
                "model.obj:6: the normal 7 in `f`, and every other beyond the 1 that there are, counts as none",
                "model.obj:7: a normal that there is not, as -2, in `f` counts as none",
                "``: 2 of 6 vertices have no normal; they get a computed one",
            ],
        ),
        (
            "position that nothing uses",
            format!("{SQUARE}v nan inf 0\nv 1 2 1e39\nf 1 2 3\n"),
            &["model.obj:5: a position that is not finite is skipped; nothing uses it (and 1 more such lines)"],
        ),
        (
            "colours up to 255",
            "v 0 0 0 255 0 51\nv 1 0 0 0 0 0\nv 0 1 0\nf 1 2 3\n".to_owned(),
            &["model.obj:1: colours of `v` are whole numbers up to 255, and are divided by it"],
        ),
        (
            "missing library",
            format!("mtllib gone.mtl\n{SQUARE}f 1 2 3\n"),
            &["FOLDER/gone.mtl: cannot be read: MISSING"],
        ),
        (
            "library outside",
            format!("mtllib ../model.mtl /etc/model.mtl\n{SQUARE}f 1 2 3\n"),
            &[
                "../model.mtl: outside the folder of the model, not read",
                "/etc/model.mtl: outside the folder of the model, not read",
            ],
        ),
        (
            "unknown material",
            format!("{SQUARE}usemtl gold\nf 1 2 3\n"),
            &["model.obj:5: the material `gold` is nowhere defined"],
        ),
        (
            "lines and points",
            format!("{SQUARE}l 1 2 3\np 1\np 2\nf 1 2 3\nf 1 2\n"),
            &["model.obj:9: a face of fewer than three corners is skipped"],
        ),
        (
            "seven numbers",
            "v 0 0 0 1 0 0 1\nv 1 0 0\nv 0 1 0 1\nf 1 2 3\n".to_owned(),
            &["model.obj:1: the seventh number of `v` is skipped"],
        ),
        (
            "unknown group",
            format!("{SQUARE}s left\nf 1 2 3\n"),
            &["model.obj:5: `s` without the number of a group is skipped"],
        ),
        (
            "some normals",
            format!("{SQUARE}vn 0 0 3\nf 1//1 2//1 3\n"),
            &["``: 1 of 3 vertices have no normal; they get a computed one"],
        ),
        (
            "end of a normal missing",
            format!("{SQUARE}vn 0 0 3\nf 1//1 2// 3//1\n"),
            &["``: 1 of 3 vertices have no normal; they get a computed one"],
        ),
        (
            "no name of a material",
            format!("{SQUARE}usemtl\nf 1 2 3\n"),
            &["model.obj:5: `usemtl` without a name: the faces after it have no material"],
        ),
        (
            "some texture coordinates",
            format!("{SQUARE}vt 0 0\nf 1/1 2 3\n"),
            &["``: 2 of 3 vertices have no texture coordinate; they get (0, 0)"],
        ),
        (
            "zero normals",
            format!("{SQUARE}vn 0 0 0\no sheet\nf 1//1 2//1 3//1\n"),
            &["`sheet`: 3 normals of zero length are replaced by computed ones"],
        ),
    ];
    for (name, text, expected) in rows {
        let folder = Folder::new();
        let model = load(&folder.write("model.obj", text)).unwrap();
        // Number 2 on every system.
        let missing = std::io::Error::from_raw_os_error(2);
        let expected: Vec<String> = expected
            .iter()
            .map(|text| {
                text.replace("FOLDER", &folder.path().display().to_string()).replace("MISSING", &missing.to_string())
            })
            .collect();
        assert_eq!(model.warnings, expected, "{name}");
        assert_eq!(model.parts[0].mesh.normals()[0], Vec3::Z, "{name}");
    }
    let model = load_with_mtl(
        &format!("mtllib model.mtl\n{SQUARE}f 1 2 3\n"),
        "newmtl a\nmap_Ka a.png\nmap_Ka b.png\nd -halo 0.5\nKd spectral a.rfl\ndisp d.png\nmap_Pr r.png\nPs 0.5\nTf 0 1 1\nrefl -type sphere r.png\n",
    );
    assert_eq!(
        model.warnings,
        [
            "model.mtl:3: the texture `map_Ka` is skipped",
            "model.mtl:4: `d -halo` is skipped",
            "model.mtl:5: `Kd spectral` is skipped",
            "model.mtl:6: the texture `disp` is skipped",
            "model.mtl:7: the texture `map_Pr` is skipped",
            "model.mtl:8: `Ps` is skipped",
            "model.mtl:9: `Tf` is skipped",
            "model.mtl:10: the texture `refl` is skipped",
        ]
    );
}

#[test]
fn malformed_files_are_refused_by_line() {
    const CORNERS: &str = "corners of the form v, v/vt, v//vn or v/vt/vn are expected";
    let with = |line: &str| format!("{SQUARE}{line}\n").into_bytes();
    let rows: [(&str, Vec<u8>, String); 24] = [
        ("two coordinates", b"v 0 0\n".into(), ":1: `v 0 0`; `v` and three numbers are expected".into()),
        ("five numbers", b"v 0 0 0 1 1\n".into(), ":1: `v 0 0 0 1 1`; `v` and three numbers are expected".into()),
        ("NaN position", with("v nan 0 0\nf 1 2 5"), ":5: `NaN` in `v`; a finite number is expected".into()),
        ("infinite position", with("v 0 1e400 0\nl 1 5"), ":5: `inf` in `v`; a finite number is expected".into()),
        ("no number in a normal", with("vn 0 0 x"), ":5: `x` in `vn`; a finite number is expected".into()),
        ("two of a normal", with("vn 0 0"), ":5: `vn 0 0`; `vn` and three numbers are expected".into()),
        ("no texture coordinate", with("vt"), ":5: `vt`; `vt` and two numbers are expected".into()),
        ("infinite texture coordinate", with("vt inf 0"), ":5: `inf` in `vt`; a finite number is expected".into()),
        (
            "index 0",
            with("f 0 1 2"),
            ":5: the position 0 in `f`; a position from 1 to 4, or from -4 to -1, is expected".into(),
        ),
        (
            "index out of range",
            with("f 1 2 3\nf 1 2 5"),
            ":6: the position 5 in `f`; a position from 1 to 4, or from -4 to -1, is expected".into(),
        ),
        (
            "negative out of range",
            with("f 1 2 -5"),
            ":5: the position -5 in `f`; a position from 1 to 4, or from -4 to -1, is expected".into(),
        ),
        (
            "largest of all indices",
            with("f 1 2 9223372036854775807"),
            ":5: the position 9223372036854775807 in `f`; a position from 1 to 4, or from -4 to -1, is expected".into(),
        ),
        ("four parts", with("f 1/1/1/1 2 3"), format!(":5: `1/1/1/1` in `f`; {CORNERS}")),
        ("not a number", with("f 1 2 x"), format!(":5: `x` in `f`; {CORNERS}")),
        ("fraction", with("f 1 2 1.5"), format!(":5: `1.5` in `f`; {CORNERS}")),
        ("beyond i64", with("f 1 2 9223372036854775808"), format!(":5: `9223372036854775808` in `f`; {CORNERS}")),
        ("no library", with("mtllib"), ":5: `mtllib`; `mtllib` and a file name is expected".into()),
        ("continued line", with("f 1 \\\n2 \\\n3\nf 1 2 9"), ":8: the position 9 in `f`; a position from 1 to 4, or from -4 to -1, is expected".into()),
        ("no faces", with(""), ": no triangles, lines or points; at least one is expected".into()),
        ("a small face", with("f 1 2"), ": no triangles, lines or points; at least one is expected (model.obj:5: a face of fewer than three corners is skipped)".into()),
        ("a small line", with("l 1"), ": no triangles, lines or points; at least one is expected (model.obj:5: a line of fewer than two vertices is skipped)".into()),
        (
            "a line out of range",
            with("l 1 2 9"),
            ":5: the position 9 in `l`; a position from 1 to 4, or from -4 to -1, is expected".into(),
        ),
        ("a point by a name", with("p one"), ":5: `one` in `p`; vertices of the form v or v/vt are expected".into()),
        ("no number", b"v 0 0 caf\xE9\n".into(), ":1: `café` in `v`; a finite number is expected".into()),
    ];
    for (name, text, expected) in rows {
        let folder = Folder::new();
        let path = folder.write("model.obj", text);
        assert_eq!(load(&path).unwrap_err().to_string(), format!("{}{expected}", path.display()), "{name}");
    }
}

/// One odd statement costs no more than itself.
#[test]
fn malformed_statements_of_a_library_are_left_out() {
    let rows = [
        ("no name", "newmtl\n", "1: `newmtl`; `newmtl` and a name is"),
        ("no material", "Kd 1 1 1\n", "1: `Kd 1 1 1`; `newmtl` and a name before it is"),
        ("two numbers", "newmtl a\nKd 1 1\n", "2: `Kd 1 1`; a colour of three numbers is"),
        ("four numbers", "newmtl a\nKd 0.5 0.5 0.5 1.0\n", "2: `Kd 0.5 0.5 0.5 1.0`; a colour of three numbers is"),
        ("commas", "newmtl a\nKd 0,8 0,2 0,2\n", "2: `0,8` in `Kd`; a finite number is"),
        ("no numbers", "newmtl a\nKs\n", "2: `Ks`; a colour of three numbers is"),
        ("NaN", "newmtl a\nKe 0 nan 0\n", "2: `nan` in `Ke`; a finite number is"),
        ("negative", "newmtl a\nKa 0 -1 0\n", "2: `Ka 0 -1 0`; a colour of three numbers from 0 to 10¹² is"),
        ("infinite", "newmtl a\nNs 1e99\n", "2: `1e99` in `Ns`; a finite number is"),
        ("negative exponent", "newmtl a\nNs -5\n", "2: `Ns -5`; a number from 0 on is"),
        ("two exponents", "newmtl a\nNs 1 2\n", "2: `Ns 1 2`; one number is"),
        ("word", "newmtl a\nd half\n", "2: `half` in `d`; a finite number is"),
        ("rough", "newmtl a\nPr 1.5\n", "2: `Pr 1.5`; a number from 0 to 1 is"),
        ("model", "newmtl a\nillum 256\n", "2: `illum 256`; `illum` and a number from 0 to 255 is"),
        ("fraction", "newmtl a\nillum 2.0\n", "2: `illum 2.0`; `illum` and a number from 0 to 255 is"),
        ("no model", "newmtl a\nillum\n", "2: `illum`; `illum` and a number from 0 to 255 is"),
    ];
    for (name, mtl, expected) in rows {
        let model =
            load_with_mtl(&format!("mtllib model.mtl\n{SQUARE}f 1 2 3\n"), &format!("{mtl}newmtl b\nKd 1 0 0\n"));
        assert_eq!(model.warnings, [format!("model.mtl:{expected} expected, and the statement is skipped")], "{name}");
        let last = model.materials.last().expect("b");
        assert!(matches!(last, SourceMaterial::Mtl(b) if b.name == "b" && b.kd == Some([1.0, 0.0, 0.0])), "{name}");
        if let [SourceMaterial::Mtl(a), _] = &model.materials[..] {
            assert_eq!(*a, MtlMaterial { name: "a".to_owned(), ..MtlMaterial::default() }, "{name}");
        }
    }
    let model = load_with_mtl(&format!("mtllib model.mtl\n{SQUARE}f 1 2 3\n"), "newmtl p\nKd 0.8 0.2 0.2\nKd 1 1\n");
    assert!(matches!(&model.materials[..], [SourceMaterial::Mtl(p)] if p.kd == Some([0.8, 0.2, 0.2])));
}

/// Libraries in folders, with the backslashes of other systems, and images beside them, beside the model, or only known
/// by their names.
#[test]
fn images_are_found_beside_the_library_or_the_model() {
    let rows: [(&str, &str, Option<&str>); 6] = [
        ("wood.png", "mats/wood.png", None),
        ("mats\\wood.png", "mats/wood.png", None),
        ("wood.png", "wood.png", None),
        ("/home/artist/wood.png", "mats/wood.png", Some("mats/wood.png")),
        ("C:\\textures\\wood.png", "wood.png", Some("wood.png")),
        ("../wood.png", "wood.png", Some("wood.png")),
    ];
    for (name, place, fallback) in rows {
        let folder = Folder::new();
        folder.write("mats/paint.mtl", format!("newmtl p\nmap_Kd {name}\n"));
        let image = folder.write(place, "image");
        let obj = format!("mtllib mats\\paint.mtl\n{SQUARE}usemtl p\nf 1 2 3\n");
        let model = load(&folder.write("model.obj", obj)).unwrap();
        let [SourceMaterial::Mtl(mtl)] = &model.materials[..] else { panic!("{name}: {:?}", model.materials) };
        assert_eq!(&*mtl.maps.kd.as_ref().unwrap().bytes, b"image", "{name}");
        let expected = fallback.map(|_| {
            let name = name.replace('\\', "/");
            format!("paint.mtl:2: the texture {name} of `map_Kd` is not there; {} is read", image.display())
        });
        assert_eq!(model.warnings, Vec::from_iter(expected), "{name}");
    }
}

/// The image of `map_Kd` multiplies the ambient reflectance, too.
#[test]
fn an_ambient_image_that_is_the_diffuse_one_is_shown() {
    let folder = Folder::new();
    folder.write("a.png", "image");
    folder.write("model.mtl", "newmtl p\nmap_Ka -clamp on a.png\nmap_Kd a.png\n");
    let model = load(&folder.write("model.obj", format!("mtllib model.mtl\n{SQUARE}usemtl p\nf 1 2 3\n"))).unwrap();
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
}

#[test]
fn concave_polygons_are_cut_along_their_insides() {
    // A dart seen from above: the fan from its first corner would cover the notch.
    let dart = "v 2 -1 0\nv 0 3 0\nv -2 -1 0\nv 0 0 0\n";
    for (name, text) in [
        ("after", format!("{dart}f 1 2 3 4\n")),
        ("before", format!("f 1 2 3 4\n{dart}")),
        ("with uvs", format!("{dart}vt 0 0\nf 1/1 2/1 3/1 4/1\n")),
    ] {
        let model = load_text(&text);
        let mesh = &model.parts[0].mesh;
        let area = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|i| mesh.positions()[i as usize]);
            0.5 * (b - a).cross(c - a).z
        };
        let areas: Vec<f32> = mesh.triangles().map(area).collect();
        // Half of base 4 and height 4, less half of base 4 and height 1.
        let whole: f32 = areas.iter().sum();
        assert!(areas.iter().all(|area| *area > 0.0) && (whole - 6.0).abs() < 1e-6, "{name}: {areas:?}");
    }
}

#[test]
fn self_intersecting_polygons_give_a_warning() {
    for (name, face) in [("bow", "f 1 3 2 4"), ("twisted", "f 1 3 2 4 5")] {
        let model = load_text(&format!("{SQUARE}v 0.5 3 0\n{face}\n"));
        assert_eq!(
            model.warnings,
            ["model.obj:6: a polygon that crosses itself, or has too many corners, is cut somehow"],
            "{name}"
        );
    }
}

#[test]
fn parts_of_the_same_name_and_material_are_one() {
    let text = format!("{SQUARE}g a\nf 1 2 3\ng b\nf 1 3 4\ng a\nf 2 3 4\n");
    let model = load_text(&text);
    let parts: Vec<_> = model.parts.iter().map(|part| (&part.name[..], part.mesh.triangle_count())).collect();
    assert_eq!(parts, [("a", 2), ("b", 1)]);
    // A vertex that two faces use alike is one vertex.
    assert_eq!(model.parts[0].mesh.positions().len(), 4);
}

#[test]
fn colours_of_vertices_are_kept() {
    let model = load_text("v 0 0 0\nv 1 0 0 1 0 0.5\nv 0 1 0\nf 1 2 3\n");
    let colors = model.parts[0].mesh.colors().unwrap();
    assert_eq!((colors[0], colors[2]), (Vec4::ONE, Vec4::ONE));
    // 0.5 in sRGB, decoded; a few roundings of f32.
    assert!(colors[1].distance(Vec4::new(1.0, 0.0, 0.214_041_14, 1.0)) < 1e-6, "{}", colors[1]);
    assert!(load_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").parts[0].mesh.colors().is_none());
    let colors = |rest: &str| {
        let model = load_text(&format!("v 0 0 0\nv 1 0 0 255 0 51\nv 0 1 0 {rest}\nf 1 2 3\n"));
        model.parts[0].mesh.colors().unwrap().to_vec()
    };
    let of_255 = colors("0 0 0");
    assert_eq!((of_255[0], of_255[2]), (Vec4::ONE, Vec4::W));
    // 51 / 255 is 0.2 in sRGB, decoded.
    assert!(of_255[1].distance(Vec4::new(1.0, 0.0, 0.033_104_767, 1.0)) < 1e-6, "{}", of_255[1]);
    // Fractions beside them: the numbers are what they are.
    assert!(colors("0.5 0 0")[1].x > 1e5);
}

#[test]
fn smoothing_groups_part_the_normals() {
    // A roof: two sides that meet in an edge along x.
    let roof = "v 0 0 0\nv 1 0 0\nv 0 1 1\nv 1 1 1\nv 0 2 0\nv 1 2 0\n";
    let normals = |groups: [&str; 2]| {
        let text = format!("{roof}{}\nf 1 2 4 3\n{}\nf 3 4 6 5\n", groups[0], groups[1]);
        let model = load_text(&text);
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        let mesh = model.parts[0].mesh.clone();
        let at_ridge = |n: &&Vec3| n.y.abs() < 1e-6;
        (mesh.positions().len(), mesh.normals().iter().filter(at_ridge).count())
    };
    // Smooth over the ridge: its two vertices are shared and look straight up.
    assert_eq!(normals(["", ""]), (6, 2));
    assert_eq!(normals(["s 1", "s 1"]), (6, 2));
    assert_eq!(normals(["s on", "# goes on"]), (6, 2));
    assert_eq!(normals(["s 1", "s 2"]), (8, 0));
    // Without smoothing every triangle has vertices of its own.
    assert_eq!(normals(["s 1", "s off"]).1, 0);
    assert_eq!(normals(["s off", "s 0"]), (12, 0));
    // Normals of the file win.
    let given = load_text(&format!("{roof}vn 0 0 1\ns 1\nf 1//1 2//1 3//1\n"));
    assert_eq!(given.parts[0].mesh.normals(), [Vec3::Z; 3]);
}

/// The vertex normals of a model at a position, part by part.
fn normals_at(model: &Model, p: Vec3) -> Vec<Vec3> {
    let meshes = model.parts.iter().map(|part| &part.mesh);
    let vertices = meshes.flat_map(|mesh| mesh.positions().iter().zip(mesh.normals()));
    vertices.filter(|(q, _)| **q == p).map(|(_, n)| *n).collect()
}

#[test]
fn smoothing_runs_across_the_borders_of_materials_and_groups() {
    // A roof whose sides meet in the edge from (0, 1, 1) to (1, 1, 1); the last two vertices repeat that edge.
    let roof = "v 0 0 0\nv 1 0 0\nv 0 1 1\nv 1 1 1\nv 0 2 0\nv 1 2 0\nv 0 1 1\nv 1 1 1\n";
    let ridge = Vec3::new(0.0, 1.0, 1.0);
    let rows = [
        // Name, what stands before the two sides, the second side, whether the ridge is smooth, the parts.
        ("one part", ["s 1", ""], "f 3 4 6 5", true, 1),
        ("materials", ["s 1\nusemtl a", "usemtl b"], "f 3 4 6 5", true, 2),
        ("materials, no groups", ["usemtl a", "usemtl b"], "f 3 4 6 5", true, 2),
        ("materials, vertices of their own", ["s 1\nusemtl a", "usemtl b"], "f 7 8 6 5", true, 2),
        ("materials, two groups", ["s 1\nusemtl a", "s 2\nusemtl b"], "f 3 4 6 5", false, 2),
        ("materials, flat", ["s off\nusemtl a", "usemtl b"], "f 3 4 6 5", false, 2),
        ("groups of faces", ["s 1\ng a", "g b"], "f 3 4 6 5", true, 2),
        ("objects", ["s 1\no a", "o b"], "f 3 4 6 5", true, 2),
        ("objects that touch", ["s 1\no a", "o b"], "f 7 8 6 5", false, 2),
    ];
    for (name, [first, second], face, is_smooth, parts) in rows {
        let model = load_text(&format!("{roof}{first}\nf 1 2 4 3\n{second}\n{face}\n"));
        assert_eq!(model.parts.len(), parts, "{name}");
        let normals = normals_at(&model, ridge);
        assert!(normals.len() >= parts, "{name}");
        // The sides face (0, ∓1, 1)/√2; their mean looks straight up.
        let expected = |n: &Vec3| if is_smooth { n.distance(Vec3::Z) < 1e-6 } else { (n.y.abs() - n.z).abs() < 1e-6 };
        assert!(normals.iter().all(expected), "{name}: {normals:?}");
    }
    // Parts with normals of their own keep them, and say nothing of the others.
    let model = load_text(&format!("{roof}vn 1 0 0\ns 1\nusemtl a\nf 1//1 2//1 4//1 3//1\nusemtl b\nf 3 4 6 5\n"));
    let given: Vec<Vec3> = normals_at(&model, ridge);
    assert!(given[0] == Vec3::X && (given[1].y - given[1].z).abs() < 1e-6, "{given:?}");
}

#[test]
fn a_group_of_smoothing_may_have_a_comment() {
    let model = load_text(&format!("{SQUARE}s 1 # round\nf 1 2 3\n"));
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
}

#[test]
fn names_may_be_latin_1() {
    let folder = Folder::new();
    folder.write("model.mtl", b"newmtl gr\xFCn\nKd 0 1 0\n");
    let mut obj = format!("mtllib model.mtl\n{SQUARE}").into_bytes();
    obj.extend(b"g caf\xE9\nusemtl gr\xFCn\nf 1 2 3\n");
    let model = load(&folder.write("model.obj", obj)).unwrap();
    assert_eq!((&model.parts[0].name[..], model.parts[0].material), ("café", Some(0)));
    assert_eq!(model.materials[0].name(), "grün");
    let latin = "a line that is not UTF-8 is read as Latin-1";
    let expected = [format!("model.obj:6: {latin} (and 1 more such lines)"), format!("model.mtl:1: {latin}")];
    assert_eq!(model.warnings, expected);
}

#[test]
fn material_names_may_contain_hashes_and_precede_comments() {
    let mtl = "newmtl a\nnewmtl Material #25\nnewmtl Material #26\nnewmtl b # blue\n";
    for (used, expected) in [
        ("a", Some(0)),
        ("a # x", Some(0)),
        ("a  #x", Some(0)),
        ("Material #25", Some(1)),
        ("Material #26", Some(2)),
        ("b # blue", Some(3)),
        ("b", Some(3)),
        ("a#x", None),
    ] {
        let model = load_with_mtl(&format!("mtllib model.mtl # of it\n{SQUARE}usemtl {used}\nf 1 2 3\n"), mtl);
        assert_eq!(model.parts[0].material, expected, "{used}");
        assert_eq!(model.warnings.is_empty(), expected.is_some(), "{used}: {:?}", model.warnings);
    }
}

#[test]
fn many_parts_and_faces_are_read_in_proportion() {
    // Ten thousand groups that come and go, and a polygon of ten thousand corners: nothing here may be quadratic.
    let vertices = (0..10_000).map(|i| {
        let (sin, cos) = (i as f32 * 6e-4).sin_cos();
        format!("v {cos} {sin} 0\nv {i} 2 1\n")
    });
    let faces = (1..10_000).map(|i| format!("g g{}\nf {} {} {}\n", i % 5000, 2 * i - 1, 2 * i, 2 * i + 1));
    let ring = (0..10_000).map(|i| format!(" {}", 2 * i + 1));
    let text: String = vertices.chain(faces).chain(["g ring\nf".to_owned()]).chain(ring).collect();
    let model = load_text(&text);
    assert_eq!((model.parts.len(), model.triangle_count()), (5001, 9999 + 9998));
}

#[test]
fn lines_may_end_in_carriage_returns() {
    let mtl = "newmtl red\nKd 1 0 0\n";
    let obj = format!("# a comment\nmtllib model.mtl\n{SQUARE}usemtl red\nf 1 2 3\nf 1 3 \\\n4\n");
    let plain = load_with_mtl(&obj, mtl);
    assert_eq!(plain.triangle_count(), 2);
    for end in ["\r", "\r\n"] {
        assert_eq!(load_with_mtl(&obj.replace('\n', end), &mtl.replace('\n', end)), plain, "{end:?}");
    }
    let error = load_bytes(Format::Obj, b"v 0 0 0\rv 0 0\r").unwrap_err();
    assert_eq!(error.to_string(), "model.obj:2: `v 0 0`; `v` and three numbers are expected");
}

#[test]
fn comments_end_with_their_line() {
    let model = load_text("v -1 -1 0 # corner\\\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n");
    assert_eq!(
        model.parts[0].mesh.positions(),
        [Vec3::new(-1., -1., 0.), Vec3::new(1., -1., 0.), Vec3::new(1., 1., 0.)]
    );
}

#[test]
fn models_far_away_have_an_origin() {
    let near = load_text("v 0 0 0\nv 0.25 0 0\nv 0.125 0.25 0.125\nv 0 0.25 0\nf 1 2 3 4\n");
    assert_eq!(near.origin, DVec3::ZERO);
    let far = load_text(
        "v 0 0 0\nv 408201.5 0 4080928\nv 408201.75 0 4080928\nv 408201.625 0.25 4080928.125\nv 408201.5 0.25 4080928\nf 2 3 4 5\n",
    );
    assert!(far.origin.distance(DVec3::new(408_201.5, 0.0, 4_080_928.0)) < 1.0, "{}", far.origin);
    let shift = (DVec3::new(408_201.5, 0.0, 4_080_928.0) - far.origin).as_vec3();
    let [near, far] = [&near, &far].map(|model| &model.parts[0].mesh);
    let moved: Vec<Vec3> = near.positions().iter().map(|p| *p + shift).collect();
    assert_eq!(far.positions(), moved);
    assert_eq!((far.indices(), far.normals()), (near.indices(), near.normals()));
    // Lines, too.
    let lines = load_text("v 1000000.125 0 0\nv 1000000.375 0 0\nl 1 2\n");
    assert_eq!(lines.lines[0].lines.bounds().size().x, 0.25);
}

#[test]
fn errors_name_their_line_in_large_files() {
    // Several pieces that are read at once, with a continued line at every place where one may end.
    let mut text = String::new();
    for i in 0..60_000 {
        writeln!(text, "v {i} 0 1\nv {i} 1 \\\n 0\nvt 0 0\nf -1/-1 -2/-1 1/1").expect("a string");
    }
    let model = load_bytes(Format::Obj, text.as_bytes()).unwrap();
    assert_eq!((model.triangle_count(), model.parts[0].mesh.positions().len()), (60_000, 120_000));
    let error = load_bytes(Format::Obj, format!("{text}f 1 2 x\n").as_bytes()).unwrap_err();
    assert!(error.to_string().starts_with("model.obj:300001: `x` in `f`"), "{error}");
    let error = load_bytes(Format::Obj, format!("f 1 2 3\n{text}f 1 2 0\n").as_bytes()).unwrap_err();
    assert!(error.to_string().starts_with("model.obj:300002: the position 0 in `f`"), "{error}");
}
