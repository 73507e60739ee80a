//! Writers: what is written is read as the same.

use glam::{Mat4, Vec2, Vec3, Vec4};
use halfway_mesh::{
    AlphaMode, Cuboid, GltfMaps, LinePart, Lines, Mesh, MetallicRoughness, Model, MtlMaterial, Part, SourceCamera,
    SourceChannel, SourceLevels, SourceLight, SourceLightKind, SourceMap, SourceMaterial, SourceProjection, SourceWrap,
    Teapot, WriteError, load, write, write_ascii, write_quantised,
};
use proptest::prelude::*;

use crate::common::{Folder, check_model};

fn part(name: &str, mesh: Mesh, material: Option<usize>) -> Part {
    Part { name: name.to_owned(), mesh, material, world_from_part: Mat4::IDENTITY }
}

/// Numbers of all sizes, whose decimals are long.
fn odd_mesh() -> Mesh {
    let positions = vec![
        Vec3::new(0.1, 1.0 / 3.0, -1e-30),
        Vec3::new(1e30, f32::MIN_POSITIVE, 16_777_215.0),
        Vec3::new(-0.0, 2.0_f32.sqrt(), 1e-7),
        Vec3::new(f32::from_bits(1), 5.0, 6.0),
    ];
    let normals = [Vec3::new(1.0, 2.0, 3.0), Vec3::new(-0.3, 0.7, 1e-8), Vec3::new(5.0, -7.0, 11.0), Vec3::Z];
    let uvs = vec![Vec2::new(0.1, 0.9), Vec2::new(1.0 / 3.0, 2.0 / 3.0), Vec2::new(-5.3, 7.1), Vec2::new(0.0, 1e-3)];
    Mesh::from_parts(positions, Some(normals.to_vec()), Some(uvs), vec![0, 1, 2, 2, 1, 3]).unwrap()
}

/// Without the vertices that no triangle uses, which no reader of OBJ and glTF keeps.
fn teapot() -> Mesh {
    Mesh::from(Teapot::new(3)).with_tangents().unwrap()
}

fn of_parts(parts: Vec<Part>) -> Model {
    Model { parts, ..Model::default() }
}

#[test]
fn meshes_come_back_bit_by_bit() {
    let folder = Folder::new();
    let plain = of_parts(vec![part("model", odd_mesh(), None)]);
    let teapot = of_parts(vec![part("model", teapot(), None)]);
    for (what, model) in [("odd", plain), ("teapot", teapot)] {
        for name in ["model.smf", "model.obj", "model.glb"] {
            let path = folder.path().join(name);
            write(&path, &model).unwrap();
            let read = load(&path).unwrap();
            assert!(read.warnings.is_empty(), "{what} {name}: {:?}", read.warnings);
            check_model(&read);
            let (found, expected) = (&read.parts[0], &model.parts[0]);
            assert_eq!(found.name, expected.name, "{what} {name}");
            // OBJ numbers vertices in the order of their use.
            let corners = |mesh: &Mesh| -> Vec<[u32; 8]> {
                let corner = |&i: &u32| {
                    let (p, n) = (mesh.positions()[i as usize], mesh.normals()[i as usize]);
                    let uv = mesh.uvs().unwrap_or_default().get(i as usize).copied().unwrap_or_default();
                    [p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y].map(f32::to_bits)
                };
                mesh.indices().iter().map(corner).collect()
            };
            assert!(corners(&found.mesh) == corners(&expected.mesh), "{what} {name}");
            assert_eq!(found.mesh.uvs().is_some(), expected.mesh.uvs().is_some(), "{what} {name}");
            if !name.ends_with("obj") {
                assert!(found.mesh.indices() == expected.mesh.indices(), "{what} {name}");
            }
        }
    }
}

#[test]
fn colours_come_back() {
    let folder = Folder::new();
    let colors =
        vec![Vec4::ONE, Vec4::new(0.5, 0.25, 0.0, 1.0), Vec4::new(0.1, 0.001, 0.9, 1.0), Vec4::new(0., 0., 0., 1.)];
    let model = of_parts(vec![part("model", odd_mesh().with_colors(colors.clone()).unwrap(), None)]);
    for name in ["model.smf", "model.obj", "model.glb"] {
        let path = folder.path().join(name);
        assert_eq!(write(&path, &model).unwrap(), Vec::<String>::new(), "{name}");
        let mesh = load(&path).unwrap().parts.remove(0).mesh;
        let found: Vec<Vec4> = mesh.indices().iter().map(|&i| mesh.colors().unwrap()[i as usize]).collect();
        for (found, i) in found.iter().zip([0, 1, 2, 2, 1, 3]) {
            // Encoded in sRGB and decoded, each with a few roundings of f32.
            assert!(found.distance(colors[i]) < 1e-6, "{name}: {found} {}", colors[i]);
        }
    }
}

/// Two placed parts of one mesh, one of them mirrored, with materials, a light and cameras.
fn scene() -> Model {
    let mesh = odd_triangle();
    let mut model = of_parts(vec![part("left one", mesh.clone(), Some(0)), part("right\none", mesh, None)]);
    model.parts[0].world_from_part = Mat4::from_translation(Vec3::new(1.0, 2.0, 3.0));
    model.parts[1].world_from_part = Mat4::from_scale(Vec3::new(-2.0, 1.0, 1.0));
    model.materials = vec![
        SourceMaterial::MetallicRoughness(MetallicRoughness {
            name: "gold \"24\"".to_owned(),
            base_color: [1.0, 0.7, 0.1, 0.5],
            metallic: 0.9,
            roughness: 0.3,
            emissive: [0.0, 0.25, 0.1],
            double_sided: true,
            unlit: true,
            alpha: AlphaMode::Mask { cutoff: 0.3 },
            specular_glossiness: None,
            maps: GltfMaps::default(),
        }),
        SourceMaterial::Mtl(MtlMaterial {
            name: String::new(),
            ka: Some([0.1; 3]),
            kd: Some([0.1, 0.2, 0.3]),
            ns: Some(6.0),
            d: Some(0.25),
            illum: Some(2),
            ..MtlMaterial::default()
        }),
    ];
    let light = |name: &str, kind| SourceLight {
        name: name.to_owned(),
        kind,
        color: [1.0, 0.5, 0.1],
        intensity: 3.3,
        range: Some(7.7),
        world_from_light: Mat4::from_rotation_x(0.7),
    };
    model.lights =
        vec![light("lamp", SourceLightKind::Spot { inner: 0.1, outer: 0.6 }), light("", SourceLightKind::Point)];
    let camera = |projection| SourceCamera {
        name: "eye".to_owned(),
        projection,
        world_from_camera: Mat4::from_translation(Vec3::Z),
    };
    model.cameras = vec![
        camera(SourceProjection::Perspective { yfov: 0.7, aspect: None, near: 0.1, far: Some(9.9) }),
        camera(SourceProjection::Orthographic { half_width: 2.0, half_height: 1.1, near: 0.0, far: 9.9 }),
    ];
    model
}

fn odd_triangle() -> Mesh {
    Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::new(0.1, 1.0, 0.3)], vec![0, 1, 2]).unwrap()
}

#[test]
fn glb_holds_all_of_a_model() {
    let folder = Folder::new();
    let path = folder.path().join("model.glb");
    let mut model = scene();
    let lost = write(&path, &model).unwrap();
    assert_eq!(lost, ["1 MTL materials lose Ka, Ks, illum and what is above 1; Ns becomes a roughness"]);
    let read = load(&path).unwrap();
    assert_eq!((&read.parts, &read.lights, &read.cameras), (&model.parts, &model.lights, &model.cameras));
    assert_ne!(read.parts[0].mesh.positions().as_ptr(), read.parts[1].mesh.positions().as_ptr());
    assert_eq!(read.materials[0], model.materials[0]);
    let SourceMaterial::MetallicRoughness(plastic) = &read.materials[1] else { panic!("{:?}", read.materials[1]) };
    assert_eq!((plastic.base_color, plastic.alpha), ([0.1, 0.2, 0.3, 0.25], AlphaMode::Blend));
    // 2/r⁴ − 2 = 6.
    assert!((plastic.roughness.powi(4) - 0.25).abs() < 1e-6 && plastic.metallic == 0.0);

    // Parts of one mesh and one material stay so.
    model.parts[1].material = Some(0);
    write(&path, &model).unwrap();
    let read = load(&path).unwrap();
    assert_eq!(read.parts[0].mesh.positions().as_ptr(), read.parts[1].mesh.positions().as_ptr());

    let model = of_parts(vec![part("", teapot(), None)]);
    write(&path, &model).unwrap();
    let read = load(&path).unwrap();
    assert!(read.parts[0].mesh.tangents() == model.parts[0].mesh.tangents());
    let obj = folder.path().join("model.obj");
    assert_eq!(write(&obj, &model).unwrap(), ["1 parts lose their tangents"]);
    let twins = of_parts(vec![part("twin", odd_triangle(), None), part("twin", odd_triangle(), None)]);
    let said = "1 parts have the name and the material of another, and will be read as one with it";
    assert_eq!(write(&obj, &twins).unwrap(), [said]);
    assert_eq!(load(&obj).unwrap().parts.len(), 1);
}

fn farthest(a: &[Vec3], b: &[Vec3]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| f64::from(a.distance(*b))).fold(0.0, f64::max)
}

#[test]
fn quantised_meshes_are_read_within_their_error() {
    let folder = Folder::new();
    let path = folder.path().join("model.glb");
    let placed = Mat4::from_scale_rotation_translation(
        Vec3::new(1.0, -2.0, 1.0),
        glam::Quat::from_rotation_y(0.7),
        Vec3::new(5.0, 0.0, -3.0),
    );
    let mut model = of_parts(vec![part("teapot", teapot(), None), part("box", Cuboid::default().into(), None)]);
    model.parts[0].world_from_part = placed;
    write(&path, &model).unwrap();
    let bytes = |path: &std::path::Path| std::fs::metadata(path).unwrap().len();
    let plain = bytes(&path);
    let (moved, lost) = write_quantised(&path, &model).unwrap();
    assert!(lost.is_empty(), "{lost:?}");
    assert!(bytes(&path) * 10 < plain * 7, "{} of {plain} bytes", bytes(&path));

    let read = load(&path).unwrap();
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    for (read, part) in read.parts.iter().zip(&model.parts) {
        let (mesh, expected) = (&read.mesh, &part.mesh);
        // Where they stand: the steps are in the node's matrix.
        let part_from_read = part.world_from_part.as_dmat4().inverse() * read.world_from_part.as_dmat4();
        let positions: Vec<Vec3> =
            mesh.positions().iter().map(|p| part_from_read.transform_point3(p.as_dvec3()).as_vec3()).collect();
        assert!(farthest(&positions, expected.positions()) <= moved, "{moved}");
        // Half a step of 1/32767 along each axis, and f32.
        assert!(farthest(mesh.normals(), expected.normals()) < 3e-5);
        assert_eq!(mesh.indices(), expected.indices());
        let uvs = mesh.uvs().zip(expected.uvs()).into_iter().flat_map(|(a, b)| a.iter().zip(b));
        assert!(uvs.into_iter().all(|(a, b)| a.distance(*b) < 1.1e-5));
        assert_eq!(mesh.tangents().is_some(), expected.tangents().is_some());
    }
    // Half a step of the teapot's longest edge, 4.82 / 65535, along each axis.
    assert!(moved < 1e-4, "{moved}");

    let text = write_quantised(&folder.path().join("model.obj"), &model).unwrap_err().to_string();
    assert!(text.ends_with("model.obj: only .glb holds integers of 16 bits"), "{text}");
}

#[test]
fn text_formats_warn_of_losses() {
    let folder = Folder::new();
    let model = scene();
    let common = ["2 places of parts; their vertices are moved instead", "2 lights", "2 cameras"];
    let smf = folder.path().join("model.smf");
    let lost = write(&smf, &model).unwrap();
    assert_eq!(lost[..3], common);
    assert_eq!(lost[3..], ["2 materials", "the names and borders of 2 parts"]);
    let obj = folder.path().join("model.obj");
    let lost = write(&obj, &model).unwrap();
    assert_eq!(lost[..3], common);
    assert_eq!(
        lost[3..],
        ["1 materials get another name", "1 materials lose their alpha mode, and which faces they show",]
    );
    for path in [&smf, &obj] {
        let read = load(path).unwrap();
        let (found, expected) = (read.bounds().unwrap(), model.bounds().unwrap());
        // A point of f32 moved in f64, and in f32 here.
        assert!(
            found.min.distance(expected.min) < 1e-6 && found.max.distance(expected.max) < 1e-6,
            "{}",
            path.display()
        );
        for part in &read.parts {
            // Fronts stay fronts, in the mirrored part too.
            for [a, b, c] in part.mesh.triangles().map(|triangle| triangle.map(|i| i as usize)) {
                let p = part.mesh.positions();
                assert!((p[b] - p[a]).cross(p[c] - p[a]).dot(part.mesh.normals()[a]) > 0.0);
            }
        }
    }
    let read = load(&obj).unwrap();
    assert_eq!(read.warnings, ["model.obj:12: the material `none` is nowhere defined"]);
    let parts: Vec<_> = read.parts.iter().map(|part| (&part.name[..], part.material)).collect();
    assert_eq!(parts, [("left one", Some(0)), ("right one", None)]);
    let names: Vec<_> = read.materials.iter().map(SourceMaterial::name).collect();
    assert_eq!(names, ["gold \"24\"", "material_1"]);
    let SourceMaterial::Mtl(plastic) = &read.materials[1] else { panic!() };
    assert_eq!((plastic.ka, plastic.kd, plastic.ns), (Some([0.1; 3]), Some([0.1, 0.2, 0.3]), Some(6.0)));
    assert_eq!((plastic.d, plastic.illum), (Some(0.25), Some(2)));
}

#[test]
fn failed_writes_leave_no_file() {
    let folder = Folder::new();
    let model = of_parts(vec![part("", odd_triangle(), None)]);
    let message = |name: &str, model: &Model| {
        let path = folder.path().join(name);
        write(&path, model).unwrap_err().to_string().replace(&path.display().to_string(), "FILE")
    };
    let known = "names no format that is written; smf, obj, glb, gltf, ply or stl is expected";
    assert_eq!(message("model.off", &model), format!("FILE: the extension \"off\" {known}"));
    assert_eq!(message("model", &model), format!("FILE: the extension \"\" {known}"));
    assert_eq!(message("model.obj", &Model::default()), "FILE: the model has no parts; at least one is expected");
    assert!(message("no/such/folder.obj", &model).starts_with("FILE: cannot be written: "));
    let mut far = model.clone();
    far.parts[0].world_from_part = Mat4::from_scale(Vec3::splat(1e38) * 2.0) * Mat4::from_translation(Vec3::X);
    assert!(matches!(write(&folder.path().join("far.smf"), &far), Err(WriteError::NotFinite { part: 0, .. })));

    folder.write("whole.glb", "as it was");
    std::fs::create_dir_all(folder.path().join("taken.smf")).unwrap();
    assert!(message("taken.smf", &model).starts_with("FILE: cannot be written: "));
    let names: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names.len(), 2, "{names:?}");
}

/// A model in every format that holds it, and read again.
fn again(folder: &Folder, name: &str, model: &Model) -> (Model, Vec<String>) {
    let path = folder.path().join(name);
    let lost = write(&path, model).unwrap();
    let read = load(&path).unwrap();
    check_model(&read);
    (read, lost)
}

#[test]
fn ply_comes_back() {
    let folder = Folder::new();
    let mesh = odd_mesh().with_colors(vec![Vec4::new(1.0, 0.5, 0.0, 0.2); 4]).unwrap();
    let model = of_parts(vec![part("model", mesh.clone(), None)]);
    let (binary, lost) = again(&folder, "model.ply", &model);
    assert_eq!(lost, ["colours are rounded to 8 bits"]);
    let path = folder.path().join("ascii.ply");
    assert_eq!(write_ascii(&path, &model).unwrap(), lost);
    assert!(std::fs::read_to_string(&path).unwrap().starts_with("ply\nformat ascii 1.0\n"));
    let ascii = load(&path).unwrap();
    for read in [&binary, &ascii] {
        let found = &read.parts[0].mesh;
        let bits = |mesh: &Mesh| mesh.positions().iter().map(|p| p.to_array().map(f32::to_bits)).collect::<Vec<_>>();
        assert_eq!(bits(found), bits(&mesh));
        assert_eq!((found.indices(), found.normals()), (mesh.indices(), mesh.normals()));
        // Texture coordinates run upward there, in f32.
        assert!(found.uvs().unwrap().iter().zip(mesh.uvs().unwrap()).all(|(a, b)| a.distance(*b) < 1e-6));
        assert!(
            found.colors().unwrap().iter().all(|c| (*c - Vec4::new(1.0, 0.5, 0.0, 0.2)).abs().max_element() < 0.01)
        );
    }
    let error = write_ascii(&folder.path().join("model.stl"), &model).unwrap_err().to_string();
    assert!(error.ends_with("model.stl: only .ply is binary or ASCII"), "{error}");
}

#[test]
fn ply_holds_lines_or_points() {
    let folder = Folder::new();
    let lines = Lines::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1], [1, 2]], vec![2]).unwrap();
    let lines = LinePart { name: "model".to_owned(), lines, material: None, world_from_part: Mat4::IDENTITY };
    let model = Model { lines: vec![lines], ..of_parts(vec![part("model", odd_triangle(), None)]) };
    let (read, lost) = again(&folder, "both.ply", &model);
    assert_eq!((read.triangle_count(), read.line_count(), read.point_count()), (1, 2, 0));
    assert_eq!(lost, ["1 points", "the names and borders of 2 parts"]);
    let cloud = Lines::cloud(vec![Vec3::ZERO, Vec3::X]).unwrap();
    let cloud = LinePart { name: "model".to_owned(), lines: cloud, material: None, world_from_part: Mat4::IDENTITY };
    let (read, lost) = again(&folder, "cloud.ply", &Model { lines: vec![cloud], ..Model::default() });
    assert_eq!((read.point_count(), read.lines[0].lines.positions()[1]), (2, Vec3::X));
    assert!(lost.is_empty(), "{lost:?}");
}

#[test]
fn stl_comes_back() {
    let folder = Folder::new();
    let model = scene();
    let (read, lost) = again(&folder, "model.stl", &model);
    assert_eq!(
        lost,
        [
            "2 places of parts; their vertices are moved instead",
            "2 lights",
            "2 cameras",
            "2 materials",
            "the names and borders of 2 parts"
        ]
    );
    assert_eq!(read.triangle_count(), 2);
    // The mirrored part, too, keeps its front: its normals agree with its winding.
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    let plain = of_parts(vec![part("model", odd_triangle(), None)]);
    assert_eq!(again(&folder, "plain.stl", &plain).0.parts[0].mesh.positions(), odd_triangle().positions());
    let (_, lost) = again(&folder, "odd.stl", &of_parts(vec![part("", teapot(), None)]));
    assert!(lost.contains(&"1 parts lose their texture coordinates".to_owned()), "{lost:?}");
}

/// Positions of a model far away keep the numbers of its file.
#[test]
fn far_models_keep_their_numbers() {
    let folder = Folder::new();
    let text = "v 400000.1 5000000.2 0.3\nv 400010.7 5000000.2 0\nv 400000.1 5000009.4 6.5\nf 1 2 3\n";
    let numbers = [[400_000.1, 5_000_000.2, 0.3], [400_010.7, 5_000_000.2, 0.0], [400_000.1, 5_000_009.4, 6.5]];
    let origin = glam::DVec3::new(400_008.0, 5_000_008.0, 0.0);
    let place = |[x, y, z]: [f64; 3]| (glam::DVec3::new(x, y, z) - origin).as_vec3();
    let mesh = Mesh::new(numbers.map(place).to_vec(), vec![0, 1, 2]).unwrap();
    let model = Model { origin, ..of_parts(vec![part("far", mesh, None)]) };
    for name in ["far.obj", "far.smf"] {
        write(&folder.path().join(name), &model).unwrap();
        let written = std::fs::read_to_string(folder.path().join(name)).unwrap();
        for line in text.lines().take(3) {
            assert!(written.contains(&format!("{line}\n")), "{name}: {written}");
        }
    }
    write_ascii(&folder.path().join("far.ply"), &model).unwrap();
    let written = std::fs::read_to_string(folder.path().join("far.ply")).unwrap();
    assert!(written.contains("property double x") && written.contains("\n400010.7 5000000.2 0 "), "{written}");
    write(&folder.path().join("far.ply"), &model).unwrap();
    let written = std::fs::read(folder.path().join("far.ply")).unwrap();
    let near: f64 = f64::from_le_bytes(
        written[written.windows(11).position(|w| w == b"end_header\n").unwrap() + 11..][..8].try_into().unwrap(),
    );
    assert!((near - 400_000.1).abs() < 1e-6, "{near}");
    write(&folder.path().join("far.gltf"), &model).unwrap();
    let json = std::fs::read_to_string(folder.path().join("far.gltf")).unwrap();
    assert!(json.contains(r#""children":[0],"translation":[400008.0,5000008.0,0.0]"#), "{json}");
    let lost = write(&folder.path().join("far.stl"), &model).unwrap();
    assert_eq!(lost, ["positions, which are far from 0, are rounded to single precision, by at most 2.0e-1"]);
}

/// The first bytes of a PNG, so that writers know it for one.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n and more";

fn map(bytes: &[u8]) -> SourceMap {
    SourceMap::new("../odd \\ name?.png".to_owned(), bytes.into())
}

#[test]
fn gltf_and_glb_keep_images() {
    let folder = Folder::new();
    let mut model = scene();
    let image = map(PNG);
    let SourceMaterial::MetallicRoughness(pbr) = &mut model.materials[0] else { panic!() };
    pbr.maps.base_color = Some(SourceMap {
        wrap: [SourceWrap::Clamp, SourceWrap::Mirror],
        smooth: false,
        levels: SourceLevels::None,
        uv_set: 1,
        offset: [0.25, 0.5],
        rotation: 0.5,
        scale: [2.0, 3.0],
        ..image.clone()
    });
    pbr.maps.normal = Some(SourceMap { amount: 0.5, ..image.clone() });
    pbr.maps.occlusion = Some(SourceMap { amount: 0.75, ..map(b"\xFF\xD8\xFF and more") });
    let SourceMaterial::Mtl(mtl) = &mut model.materials[1] else { panic!() };
    mtl.maps.kd = Some(image.clone());
    mtl.maps.ks = Some(image.clone());
    mtl.maps.ke = Some(map(b"BM and more"));
    mtl.maps.norm = Some(map(b""));
    for name in ["model.glb", "a model.gltf"] {
        let path = folder.path().join(name);
        let lost = write(&path, &model).unwrap();
        assert_eq!(
            lost[1..],
            [
                "1 images of highlights, opacity or height, which glTF has in other forms",
                "1 images that are neither PNG nor JPEG nor WebP",
                "1 images that could not be read",
            ],
            "{name}"
        );
        let read = load(&path).unwrap();
        assert!(read.warnings.is_empty(), "{name}: {:?}", read.warnings);
        let (SourceMaterial::MetallicRoughness(found), SourceMaterial::MetallicRoughness(expected)) =
            (&read.materials[0], &model.materials[0])
        else {
            panic!()
        };
        let pairs = [
            (&found.maps.base_color, &expected.maps.base_color),
            (&found.maps.normal, &expected.maps.normal),
            (&found.maps.occlusion, &expected.maps.occlusion),
        ];
        for (found, expected) in pairs {
            let (found, expected) = (found.as_ref().unwrap(), expected.as_ref().unwrap());
            assert_eq!(SourceMap { name: expected.name.clone(), ..found.clone() }, *expected, "{name}");
        }
        let SourceMaterial::MetallicRoughness(of_mtl) = &read.materials[1] else { panic!() };
        assert_eq!(&*of_mtl.maps.base_color.as_ref().unwrap().bytes, PNG);
        assert_eq!(read.parts.len(), model.parts.len());
    }
    let mut names: Vec<_> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["a model.bin", "a model.gltf", "a model_0.png", "a model_1.jpg", "model.glb"]);
}

#[test]
fn obj_keeps_images_beside_it() {
    let folder = Folder::new();
    let mut model = scene();
    let placed = SourceMap { offset: [0.25, 0.5], scale: [2.0, 4.0], wrap: [SourceWrap::Clamp; 2], ..map(PNG) };
    let SourceMaterial::MetallicRoughness(pbr) = &mut model.materials[0] else { panic!() };
    pbr.maps.base_color = Some(SourceMap { rotation: 1.0, uv_set: 1, wrap: [SourceWrap::Mirror; 2], ..map(b"GIF89a") });
    pbr.maps.occlusion = Some(map(PNG));
    let SourceMaterial::Mtl(mtl) = &mut model.materials[1] else { panic!() };
    mtl.maps.kd = Some(placed.clone());
    mtl.maps.d = Some(SourceMap { channel: Some(SourceChannel::Green), ..placed.clone() });
    mtl.maps.bump = Some(SourceMap { amount: 0.5, ..placed });
    let (read, lost) = again(&folder, "model.obj", &model);
    for expected in [
        "1 occlusion images",
        "2 rotations of images",
        "2 images that are mirrored, or end along one axis alone",
        "2 images by the second texture coordinates, which take the first",
    ] {
        assert!(lost.iter().any(|lost| lost == expected), "{expected}: {lost:?}");
    }
    assert_eq!(read.warnings, ["model.obj:12: the material `none` is nowhere defined"]);
    let (SourceMaterial::Mtl(gold), SourceMaterial::Mtl(found)) = (&read.materials[0], &read.materials[1]) else {
        panic!()
    };
    let SourceMaterial::Mtl(expected) = &model.materials[1] else { panic!() };
    for (found, expected) in [
        (&found.maps.kd, &expected.maps.kd),
        (&found.maps.d, &expected.maps.d),
        (&found.maps.bump, &expected.maps.bump),
    ] {
        let (found, expected) = (found.as_ref().unwrap(), expected.as_ref().unwrap());
        assert_eq!(SourceMap { name: expected.name.clone(), ..found.clone() }, *expected);
    }
    assert_eq!(gold.maps.kd.as_ref().unwrap().name, "model_0.gif");
    // The image of another file of this name stays.
    folder.write("model_0.gif", "something else");
    let (read, _) = again(&folder, "model.obj", &model);
    let SourceMaterial::Mtl(gold) = &read.materials[0] else { panic!() };
    assert_eq!(gold.maps.kd.as_ref().unwrap().name, "model_1.gif");
    assert_eq!(std::fs::read(folder.path().join("model_0.gif")).unwrap(), b"something else");
    // The opacity of a masked material is in its image's alpha.
    assert_eq!(gold.maps.d.as_ref().unwrap().channel, Some(SourceChannel::Alpha));
    let (_, lost) = again(&folder, "model.smf", &model);
    assert!(lost.contains(&"2 materials lose their images".to_owned()), "{lost:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever their size, positions come back to the bit, near or far from 0.
    #[test]
    fn positions_of_any_size_come_back(
        corners in proptest::collection::vec([-1.0_f32..1.0, -1.0_f32..1.0, -1.0_f32..1.0], 3..12),
        exponent in -20_i32..20,
        far in proptest::option::of(8_i32..20),
    ) {
        let size = 2.0_f32.powi(exponent);
        let positions: Vec<Vec3> = corners.iter().map(|p| Vec3::from(*p) * size).collect();
        let indices: Vec<u32> = (0..positions.len() as u32 / 3 * 3).collect();
        let positions = positions[..indices.len()].to_vec();
        let mesh = Mesh::new(positions, indices).unwrap();
        let origin = glam::DVec3::splat(far.map_or(0.0, |far| f64::from(size) * 2.0_f64.powi(far)));
        let model = Model { origin, ..of_parts(vec![part("model", mesh.clone(), None)]) };
        let folder = Folder::new();
        for name in ["m.obj", "m.smf", "m.ply", "m.glb", "m.gltf"] {
            let path = folder.path().join(name);
            write(&path, &model).unwrap();
            // Readers choose an origin of their own.
            let read = load(&path).unwrap();
            let found = &read.parts[0];
            let world = |p: &Vec3| read.origin + found.world_from_part.as_dmat4().transform_point3(p.as_dvec3());
            let found: Vec<_> = found.mesh.triangles().flatten().map(|corner| world(&found.mesh.positions()[corner as usize])).collect();
            for (found, corner) in found.iter().zip(mesh.indices()) {
                let expected = origin + mesh.positions()[*corner as usize].as_dvec3();
                let off = (*found - expected).abs().max_element();
                prop_assert!(off <= f64::from(size) * 3e-7, "{name}: {found} {expected}");
            }
        }
    }
}
