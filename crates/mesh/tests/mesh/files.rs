//! Opening files, malformed files of all formats, and the project's own models.

#[path = "../../examples/make_assets.rs"]
#[allow(dead_code, unreachable_pub, reason = "an example has a main function, and shares its files with this test")]
mod make_assets;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use glam::Vec3;
use halfway_mesh::{
    Format, GltfMaps, LoadError, LoadOptions, LoadProgress, Mesh, Model, MtlMaps, SourceLightKind, SourceMaterial,
    Teapot, load, load_bytes, load_stream, load_with,
};

use crate::common::{Folder, TRIANGLE_JSON, check_model, glb, triangle_data};

fn asset(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets").join(name)
}

#[test]
fn only_regular_files_of_known_kinds_are_opened() {
    let folder = Folder::new();
    folder.write("folder.obj/x", "x");
    for (name, content) in [
        ("model.smf", ""),
        ("model.obj", ""),
        ("model.gltf", ""),
        ("model.glb", ""),
        ("model.ply", ""),
        ("model.STL", ""),
    ] {
        folder.write(name, content);
    }
    // Number 2 on every system.
    let missing = || format!("cannot be read: {}", std::io::Error::from_raw_os_error(2));
    let unknown = "is unknown; smf, obj, gltf, glb, ply, stl, off or 3mf is expected";
    let rows = [
        ("gone.smf", missing()),
        ("gone.obj", missing()),
        ("gone.GLB", missing()),
        ("folder.obj", "not a regular file".to_owned()),
        ("model.smf", "the file is empty".to_owned()),
        ("model.obj", "the file is empty".to_owned()),
        ("model.gltf", "the file is empty".to_owned()),
        ("model.glb", "the file is empty".to_owned()),
        (
            "model.fbx",
            format!("the extension \"fbx\" {unknown}; Blender, or `assimp export` of Assimp, converts it to glb"),
        ),
        ("model.step", format!("the extension \"step\" {unknown}; FreeCAD or Gmsh converts it to stl")),
        ("model.usdz", format!("the extension \"usdz\" {unknown}; Blender converts it to glb")),
        ("model.vtp", format!("the extension \"vtp\" {unknown}; meshio or ParaView converts it to ply or stl")),
        ("model", format!("the extension \"\" {unknown}")),
        ("model.ply", "the file is empty".to_owned()),
        ("model.STL", "the file is empty".to_owned()),
    ];
    for (name, expected) in rows {
        let path = folder.path().join(name);
        let error = load(&path).unwrap_err();
        assert_eq!(error.to_string(), format!("{}: {expected}", path.display()));
        assert_eq!(error.path(), path);
    }
}

#[cfg(unix)]
#[test]
fn devices_are_not_read() {
    let folder = Folder::new();
    let path = folder.path().join("endless.obj");
    std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
    assert!(matches!(load(&path), Err(LoadError::NotAFile { .. })));
}

#[test]
fn extensions_are_read_in_either_case() {
    let folder = Folder::new();
    let path = folder.write("MODEL.SMF", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_eq!(load(&path).unwrap().triangle_count(), 1);
}

#[test]
fn the_extension_selects_the_format() {
    for format in Format::ALL {
        let name = format!("a.b.{}", format.extension().to_ascii_uppercase());
        assert_eq!(Format::from_path(Path::new(&name)), Some(format));
    }
    assert_eq!(Format::from_path(Path::new("obj")), None);
    let model = load_bytes(Format::Smf, b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    assert_eq!((model.triangle_count(), &model.parts[0].name[..]), (1, "model"));
    assert_eq!(load_bytes(Format::Stl, b"").unwrap_err().to_string(), "model.stl: the file is empty");
    let error = load_bytes(Format::Obj, b"v 0 0\n").unwrap_err().to_string();
    assert_eq!(error, "model.obj:1: `v 0 0`; `v` and three numbers are expected");
}

#[test]
fn large_files_report_how_far_they_are_and_can_be_stopped() {
    let folder = Folder::new();
    let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_owned();
    text.push_str(&"# nothing of account\n".repeat(300_000));
    let mut soup = vec![0; 84 + 50 * 100_000];
    soup[80..84].copy_from_slice(&100_000_u32.to_le_bytes());
    let bytes = text.len() as u64;
    for (name, content, length) in [
        ("large.obj", text.as_bytes(), bytes),
        ("large.smf", text.as_bytes(), bytes),
        ("large.stl", &soup, soup.len() as u64),
        ("large.gltf", text.as_bytes(), bytes),
    ] {
        let path = folder.write(name, content);
        let mut told: Vec<LoadProgress> = Vec::new();
        let _ = load_with(&path, LoadOptions::default(), &mut |progress| {
            told.push(progress);
            ControlFlow::Continue(())
        });
        assert!(told.len() >= 4, "{name}: {told:?}");
        assert!(told.iter().all(|at| at.of == length && at.done <= length), "{name}: {told:?}");
        assert!(told.is_sorted_by(|a, b| a.done < b.done), "{name}: {told:?}");

        let mut calls = 0;
        let stopped = load_with(&path, LoadOptions::default(), &mut |_| {
            calls += 1;
            ControlFlow::Break(())
        });
        assert_eq!(calls, 1, "{name}");
        assert_eq!(stopped.unwrap_err().to_string(), format!("{}: stopped", path.display()));
    }
}

#[test]
fn large_buffers_report_too() {
    let folder = Folder::new();
    folder.write("large.bin", vec![0; 3 << 20]);
    let json = TRIANGLE_JSON.replace("{\"byteLength\":104}", "{\"byteLength\":3145728,\"uri\":\"large.bin\"}");
    let path = folder.write("model.gltf", json);
    let stopped = load_with(&path, LoadOptions::default(), &mut |at| {
        assert_eq!(at.of, 3 << 20);
        if at.done < 2 << 20 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    assert!(matches!(stopped, Err(LoadError::Stopped { path }) if path.ends_with("large.bin")));
}

#[cfg(unix)]
#[test]
fn files_outside_the_folder_need_an_option() {
    let folder = Folder::new();
    let library = folder.write("outside/red.mtl", "newmtl red\n");
    std::fs::create_dir_all(folder.path().join("inside")).unwrap();
    std::os::unix::fs::symlink(&library, folder.path().join("inside/link.mtl")).unwrap();
    std::os::unix::fs::symlink(folder.path().join("outside"), folder.path().join("inside/door")).unwrap();
    folder.write("inside/own.mtl", "newmtl red\n");
    std::os::unix::fs::symlink("own.mtl", folder.path().join("inside/alias.mtl")).unwrap();
    let absolute = library.display().to_string();
    for (reference, is_inside) in [
        ("own.mtl", true),
        ("alias.mtl", true),
        ("link.mtl", false),
        ("door/red.mtl", false),
        ("../outside/red.mtl", false),
        (&absolute, false),
    ] {
        let obj = format!("mtllib {reference}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
        let path = folder.write("inside/model.obj", obj);
        let model = load(&path).unwrap();
        assert_eq!(model.parts[0].material.is_some(), is_inside, "{reference}: {:?}", model.warnings);
        let refused = format!("{}: outside the folder of the model, not read", &reference[..reference.len().min(61)]);
        let is_refused = model.warnings.iter().any(|warning| warning.starts_with(&refused[..reference.len().min(50)]));
        assert_eq!(is_refused, !is_inside, "{reference}: {:?}", model.warnings);
        let model = load_with(&path, LoadOptions { outside: true, ..LoadOptions::default() }, &mut |_| {
            ControlFlow::Continue(())
        })
        .unwrap();
        assert_eq!((model.parts[0].material, &model.warnings[..]), (Some(0), &[][..]), "{reference}");
    }
}

/// Loads a file and checks that it does not panic and that any model is valid.
fn survive(path: &Path) -> bool {
    load(path).is_ok_and(|model| {
        check_model(&model);
        true
    })
}

/// The places of the runs of digits in a text.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let mut found: Vec<std::ops::Range<usize>> = Vec::new();
    for (at, _) in text.char_indices().filter(|(_, c)| c.is_ascii_digit()) {
        match found.last_mut() {
            Some(last) if last.end == at => last.end = at + 1,
            _ => found.push(at..at + 1),
        }
    }
    found
}

const OBJ: &str = "mtllib model.mtl\no a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0 1\nvt 0 0\nvt 1 1\nvn 0 0 1\nusemtl m\nf 1/1/1 2/2/1 3/1/1 -1/-1/-1\ng b\nl 1 2\nf 1 2 3\n";
const MTL: &str = "newmtl m\nKa 1 1 1\nKd 0.5\nNs 10\nd 1\nTr 0\nillum 2\nmap_Kd a.png\n";
const SMF: &str = "#$SMF 1.0\nbegin\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nend\n";

/// The small files to corrupt: name, the file written, the text in it that is corrupted.
fn victims() -> [(&'static str, &'static str); 4] {
    [("model.gltf", TRIANGLE_JSON), ("model.obj", OBJ), ("model.mtl", MTL), ("model.smf", SMF)]
}

/// Loads the model with one of its files spoilt.
fn load_spoilt(folder: &Folder, name: &str, text: &[u8]) -> bool {
    match name {
        "model.gltf" => survive(&folder.write("model.glb", spoilt_glb(text))),
        "model.mtl" => {
            folder.write("model.mtl", text);
            survive(&folder.write("model.obj", OBJ))
        }
        _ => {
            folder.write("model.mtl", MTL);
            survive(&folder.write(name, text))
        }
    }
}

/// A binary file whose JSON may be no text.
fn spoilt_glb(json: &[u8]) -> Vec<u8> {
    let placeholder = " ".repeat(json.len());
    let mut file = glb(&placeholder, &triangle_data());
    file[20..20 + json.len()].copy_from_slice(json);
    file
}

#[test]
fn no_number_makes_a_reader_panic() {
    let values = [
        "",
        "0",
        "-1",
        "7",
        "255",
        "65536",
        "4294967295",
        "4294967296",
        "18446744073709551615",
        "1e39",
        "1e999",
        "1.5",
    ];
    let folder = Folder::new();
    let mut survived = 0;
    for (name, text) in victims() {
        for place in numbers(text) {
            for value in values {
                let spoilt = format!("{}{value}{}", &text[..place.start], &text[place.end..]);
                survived += usize::from(load_spoilt(&folder, name, spoilt.as_bytes()));
            }
        }
    }
    // Many numbers may take other values; were none of the files sound, nothing would be tested.
    assert!(survived > 100, "{survived}");
}

#[test]
fn no_byte_makes_a_reader_panic() {
    let folder = Folder::new();
    let mut survived = 0;
    for (name, text) in victims() {
        for at in 0..text.len() {
            for byte in [0, b'"', b'9', b'-', 0xFF] {
                let mut spoilt = text.as_bytes().to_vec();
                spoilt[at] = byte;
                survived += usize::from(load_spoilt(&folder, name, &spoilt));
            }
        }
    }
    assert!(survived > 100, "{survived}");
}

#[test]
fn no_truncation_makes_a_reader_panic() {
    let folder = Folder::new();
    for name in ["teapot.obj", "lantern.glb", "cube.smf", "teapot.mtl"] {
        let whole = std::fs::read(asset(name)).unwrap();
        for part in 1..40 {
            survive(&folder.write(name, &whole[..whole.len() * part / 40]));
        }
    }
}

#[test]
fn the_assets_are_what_the_program_writes() {
    for (name, expected) in make_assets::assets() {
        let found = std::fs::read(asset(name)).unwrap();
        assert!(found.len() < 400 * 1024, "{name}: {} bytes", found.len());
        // The sines of the lantern, the ball and the fish are not rounded to decimals: systems may differ in the last bit.
        let same = if Path::new(name).extension().is_some_and(|ending| ending == "glb") {
            found.len() == expected.len()
        } else {
            found == expected
        };
        assert!(same, "{name} is not what `cargo run -p halfway_mesh --example make_assets` writes");
    }
}

#[test]
fn the_teapot_file_is_the_teapot() {
    let model = load(&asset("teapot.obj")).unwrap();
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    let names: Vec<_> = model.parts.iter().map(|part| &part.name[..]).collect();
    assert_eq!(names, ["body", "handle", "spout", "lid", "bottom"]);
    let teapot = Mesh::from(Teapot::new(8));
    assert_eq!(model.triangle_count(), teapot.triangle_count());
    let corners = |mesh: &Mesh| -> Vec<(Vec3, Vec3)> {
        mesh.indices().iter().map(|&i| (mesh.positions()[i as usize], mesh.normals()[i as usize])).collect()
    };
    let file: Vec<_> = model.parts.iter().flat_map(|part| corners(&part.mesh)).collect();
    for ((p, n), (q, m)) in file.into_iter().zip(corners(&teapot)) {
        // Five decimals of positions, four of normals.
        assert!(p.distance(q) < 1e-5 && n.distance(m) < 1e-4, "{p} {q} {n} {m}");
    }
    let [SourceMaterial::Mtl(brass)] = &model.materials[..] else { panic!("{:?}", model.materials) };
    assert_eq!(
        (brass.name.as_str(), brass.kd, brass.ns),
        ("brass", Some([0.780_392, 0.568_627, 0.113_725]), Some(27.8974))
    );
}

#[test]
fn the_lantern_has_its_parts_and_its_light() {
    let model: Model = load(&asset("lantern.glb")).unwrap();
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    let count = |name: &str| model.parts.iter().filter(|part| part.name == name).count();
    assert_eq!(["base", "roof", "bar", "ring", "glass", "candle", "flame"].map(count), [1, 1, 6, 1, 1, 1, 1]);
    for part in &model.parts {
        let problems = part.mesh.report().problems;
        assert_eq!((problems.degenerate_triangles, problems.misoriented_edges), (0, 0), "{}: {problems}", part.name);
    }
    // Six bars on a circle.
    for bar in model.parts.iter().filter(|part| part.name == "bar") {
        let foot = bar.world_from_part.transform_point3(Vec3::ZERO);
        assert!((foot.length() - 0.47).abs() < 1e-6 && foot.y == 0.0, "{foot}");
    }
    let [light] = &model.lights[..] else { panic!("{} lights", model.lights.len()) };
    assert_eq!((light.kind, light.range), (SourceLightKind::Point, Some(12.0)));
    assert!(light.world_from_light.transform_point3(Vec3::ZERO).distance(Vec3::NEG_Y * 0.01) < 1e-6);
}

#[test]
fn the_fish_moves_all_that_it_has() {
    let model = load(&asset("fish.glb")).unwrap();
    check_model(&model);
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    for part in &model.parts {
        let report = part.mesh.report();
        assert_eq!((report.closed, report.pieces, report.inward), (1, 1, 0), "{}: {report}", part.name);
    }
    let animations = model.animations.as_ref().unwrap();
    let [swim] = animations.clips() else { panic!("{:?}", animations.clips()) };
    assert_eq!((swim.name.as_str(), swim.duration), ("swim", 4.0));
    let body = model.parts.iter().position(|part| part.name == "body").unwrap();
    // Halfway around the circle of radius 1, with a belly full of water.
    let pose = animations.pose(0, 2.0);
    assert_eq!(pose.parts.len(), 5);
    let mesh = pose.parts.iter().find(|part| part.part == body).unwrap().mesh.as_ref().unwrap();
    let middle = (mesh.bounds().min + mesh.bounds().max) / 2.0;
    assert!(middle.distance(Vec3::NEG_Z) < 0.2, "{middle}");
    assert!(mesh.bounds().size().z > model.parts[body].mesh.bounds().size().z);
}

#[test]
fn the_crate_and_the_ball_have_their_images() {
    for (name, expected) in [("crate.obj", "kd bump"), ("ball.glb", "base_color")] {
        let model = load(&asset(name)).unwrap();
        assert!(model.warnings.is_empty(), "{name}: {:?}", model.warnings);
        let [material] = &model.materials[..] else { panic!("{name}: {} materials", model.materials.len()) };
        let (each, words) = match material {
            SourceMaterial::Mtl(mtl) => {
                let MtlMaps { kd, ks, ke, d, ns, norm, bump } = &mtl.maps;
                (vec![kd, ks, ke, d, ns, norm, bump], "kd ks ke d ns norm bump")
            }
            SourceMaterial::MetallicRoughness(gltf) => {
                let GltfMaps { base_color, emissive, occlusion, normal } = &gltf.maps;
                (vec![base_color, emissive, occlusion, normal], "base_color emissive occlusion normal")
            }
        };
        let found: Vec<_> = words.split(' ').zip(each).filter_map(|(word, map)| Some((word, map.as_ref()?))).collect();
        assert_eq!(found.iter().map(|(word, _)| *word).collect::<Vec<_>>().join(" "), expected, "{name}");
        for (_, map) in found {
            let bytes = &map.bytes;
            assert!(bytes.starts_with(b"\x89PNG") && bytes.len() < 100 * 1024, "{name}: {} bytes", bytes.len());
        }
        let problems = model.parts[0].mesh.report().problems;
        assert_eq!((problems.degenerate_triangles, problems.misoriented_edges), (0, 0), "{name}: {problems}");
        let bounds = model.bounds().unwrap();
        assert!(bounds.min.y.abs() < 1e-6 && (bounds.max.y - 1.0).abs() < 1e-6, "{name}: {bounds:?}");
    }
}

#[test]
fn the_cube_is_closed() {
    let model = load(&asset("cube.smf")).unwrap();
    assert!(model.warnings.is_empty() && model.parts[0].mesh.report().problems.is_none());
    let bounds = model.bounds().unwrap();
    assert_eq!((bounds.min, bounds.max, model.triangle_count()), (Vec3::NEG_ONE, Vec3::ONE, 12));
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn files_and_streams_have_limits() {
    let folder = Folder::new();
    let path = folder.write("model.obj", TRIANGLE);
    let length = TRIANGLE.len() as u64;
    for (limit, fits) in [(Some(length), true), (Some(length - 1), false), (None, true)] {
        let options = LoadOptions { limit, ..LoadOptions::default() };
        let name = Path::new("standard input");
        let from_file = load_with(&path, options, &mut |_| ControlFlow::Continue(()));
        let from_stream = load_stream(Format::Obj, name, TRIANGLE.as_bytes(), options);
        for (found, name) in [(from_file, path.as_path()), (from_stream, name)] {
            match found {
                Ok(model) => assert!(fits && model.triangle_count() == 1),
                Err(error) => {
                    let expected =
                        format!("{}: the file is larger than {} bytes, the limit", name.display(), length - 1);
                    assert!(!fits && error.to_string() == expected, "{error}");
                }
            }
        }
    }
    // Files that the model refers to have the same limit.
    let path = folder.write("paint.obj", format!("mtllib paint.mtl\n{TRIANGLE}"));
    folder.write("paint.mtl", format!("newmtl a\n#{}\n", "x".repeat(200)));
    let options = LoadOptions { limit: Some(100), ..LoadOptions::default() };
    let loaded = load_with(&path, options, &mut |_| ControlFlow::Continue(()));
    let said = match loaded {
        Ok(model) => model.warnings.join("; "),
        Err(error) => error.to_string(),
    };
    assert!(said.contains("larger than 100 bytes"), "{said}");
}

#[test]
fn a_format_can_be_given_in_place_of_the_extension() {
    let folder = Folder::new();
    let path = folder.write("model.txt", TRIANGLE);
    let options = LoadOptions { format: Some(Format::Obj), ..LoadOptions::default() };
    assert!(load_with(&path, options, &mut |_| ControlFlow::Continue(())).is_ok());
}

#[cfg(unix)]
#[test]
fn named_pipes_are_read_to_their_end() {
    let folder = Folder::new();
    let path = folder.path().join("pipe.obj");
    let made = std::process::Command::new("mkfifo").arg(&path).status();
    assert!(made.is_ok_and(|status| status.success()));
    let writer = std::thread::spawn({
        let path = path.clone();
        move || std::fs::write(path, TRIANGLE)
    });
    assert_eq!(load(&path).unwrap().triangle_count(), 1);
    assert!(writer.join().is_ok_and(|written| written.is_ok()));
}
