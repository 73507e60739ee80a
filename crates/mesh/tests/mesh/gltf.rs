//! glTF files, in text and binary.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use glam::{Mat4, Quat, Vec2, Vec3, Vec4};
use halfway_mesh::{
    AlphaMode, GltfMaps, LoadError, MetallicRoughness, Model, SourceCamera, SourceLightKind, SourceMaterial,
    SourceProjection, load,
};

use crate::common::{Folder, TRIANGLE_JSON, glb, triangle_data};

fn load_glb(json: &str, data: &[u8]) -> Result<Model, LoadError> {
    let folder = Folder::new();
    load(&folder.write("model.glb", glb(json, data)))
}

/// The triangle's file with parts of its text replaced, each of which it must have.
fn with(replacements: &[(&str, &str)]) -> String {
    replacements.iter().fold(TRIANGLE_JSON.to_owned(), |json, (from, to)| {
        assert!(json.contains(from), "{from}");
        json.replace(from, to)
    })
}

fn check_triangle(model: &Model) {
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    let [part] = &model.parts[..] else { panic!("{} parts", model.parts.len()) };
    assert_eq!((&part.name[..], part.material), ("node", Some(0)));
    assert_eq!(part.world_from_part, Mat4::from_translation(Vec3::Z * 5.0));
    assert_eq!(part.mesh.positions(), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(part.mesh.normals(), [Vec3::Z; 3]);
    assert_eq!(part.mesh.uvs(), Some(&[Vec2::Y, Vec2::ONE, Vec2::ZERO][..]));
    assert_eq!(part.mesh.indices(), [0, 1, 2]);
    assert_eq!(
        model.materials,
        [SourceMaterial::MetallicRoughness(MetallicRoughness {
            name: "red".to_owned(),
            base_color: [1.0, 0.0, 0.0, 1.0],
            metallic: 0.25,
            roughness: 0.5,
            emissive: [0.0; 3],
            double_sided: false,
            unlit: false,
            alpha: AlphaMode::Opaque,
            specular_glossiness: None,
            maps: GltfMaps::default(),
        })]
    );
    let bounds = model.bounds().unwrap();
    assert_eq!((bounds.min, bounds.max), (Vec3::Z * 5.0, Vec3::new(1.0, 1.0, 5.0)));
    assert_eq!(model.triangle_count(), 1);
}

#[test]
fn data_may_lie_in_the_file_or_beside_it() {
    check_triangle(&load_glb(TRIANGLE_JSON, &triangle_data()).unwrap());

    let folder = Folder::new();
    folder.write("my data.bin", triangle_data());
    folder.write("sub/data.bin", triangle_data());
    let padded = STANDARD.encode(triangle_data());
    for uri in [
        format!("data:application/octet-stream;base64,{padded}"),
        format!("data:application/gltf-buffer;base64,{}", padded.trim_end_matches('=')),
        "my%20data.bin".to_owned(),
        "sub/data.bin".to_owned(),
    ] {
        let json = with(&[("{\"byteLength\":104}", &format!("{{\"byteLength\":104,\"uri\":\"{uri}\"}}"))]);
        check_triangle(&load(&folder.write("model.gltf", json)).unwrap());
    }
}

#[test]
fn nodes_are_composed_and_meshes_shared() {
    let nodes = r#""nodes":[
        {"name":"root","children":[1,2],"translation":[10,0,0],"scale":[2,2,2]},
        {"name":"turned","mesh":0,"rotation":[0,0,0.70710678,0.70710678]},
        {"children":[3],"matrix":[1,0,0,0, 0,1,0,0, 0,0,-1,0, 0,3,0,1]},
        {"mesh":0}],"#;
    let json = with(&[("\"nodes\":[{\"name\":\"node\",\"mesh\":0,\"translation\":[0,0,5]}],", nodes)]);
    let model = load_glb(&json, &triangle_data()).unwrap();
    let [turned, mirrored] = &model.parts[..] else { panic!("{} parts", model.parts.len()) };
    assert_eq!((&turned.name[..], &mirrored.name[..]), ("turned", "mesh"));
    assert_eq!(turned.mesh.positions().as_ptr(), mirrored.mesh.positions().as_ptr());

    let world_from_root = Mat4::from_scale_rotation_translation(Vec3::splat(2.0), Quat::IDENTITY, Vec3::X * 10.0);
    let quarter = Mat4::from_rotation_z(std::f32::consts::FRAC_PI_2);
    // Quaternion and angle are rounded to f32.
    assert!(turned.world_from_part.abs_diff_eq(world_from_root * quarter, 1e-6));
    let flip = Mat4::from_translation(Vec3::Y * 3.0) * Mat4::from_scale(Vec3::new(1.0, 1.0, -1.0));
    assert_eq!(mirrored.world_from_part, world_from_root * flip);
    assert!(mirrored.world_from_part.determinant() < 0.0);
}

#[test]
fn the_scene_is_the_default_one_or_the_first_or_all() {
    let nodes = "\"nodes\":[{\"mesh\":0,\"name\":\"a\"},{\"mesh\":0,\"name\":\"b\",\"children\":[2]},{\"mesh\":0,\"name\":\"c\"}],";
    let old_nodes = "\"nodes\":[{\"name\":\"node\",\"mesh\":0,\"translation\":[0,0,5]}],";
    let two = "\"scenes\":[{\"nodes\":[0]},{\"nodes\":[1]}],";
    let rows: [(&str, &str, &str, &[&str]); 4] = [
        ("default", "\"scene\":1,", two, &["b", "c"]),
        ("first", "", two, &["a"]),
        ("no scene", "", "", &["a", "b", "c"]),
        ("order of a scene", "", "\"scenes\":[{\"nodes\":[1,0]}],", &["b", "c", "a"]),
    ];
    for (name, scene, scenes, expected) in rows {
        let json = with(&[(old_nodes, nodes), ("\"scene\":0,", scene), ("\"scenes\":[{\"nodes\":[0]}],", scenes)]);
        let model = load_glb(&json, &triangle_data()).unwrap();
        assert_eq!(model.parts.iter().map(|part| &part.name[..]).collect::<Vec<_>>(), expected, "{name}");
    }
}

/// Six vertices in a row of two triangles' strip, without normals.
fn strip(mode: u32, indices: &str) -> (String, Vec<u8>) {
    let positions: [[f32; 3]; 6] = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 1., 0.], [0., 2., 0.], [1., 2., 0.]];
    let data = positions.iter().flatten().copied().flat_map(f32::to_le_bytes).chain([1, 2, 3, 0]).collect();
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],"scenes":[{{"nodes":[0]}}],
        "meshes":[{{"primitives":[{{"mode":{mode},"attributes":{{"POSITION":0}}{indices}}},{{"attributes":{{"POSITION":0}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":6,"min":[0,0,0],"max":[1,2,0]}},
        {{"bufferView":1,"componentType":5121,"type":"SCALAR","count":3}}],
        "bufferViews":[{{"buffer":0,"byteLength":72}},{{"buffer":0,"byteOffset":72,"byteLength":3}}],
        "buffers":[{{"byteLength":76}}]}}"#
    );
    (json, data)
}

/// A row: name, mode, the text of the indices, the indices and the number of vertices of the mesh, the warnings.
type ModeRow = (&'static str, u32, &'static str, &'static [u32], usize, Vec<String>);

#[test]
fn strips_fans_and_lists_become_triangles() {
    let smooth = "primitives have no normals; smooth ones are computed, where glTF asks for flat ones";
    let rows: [ModeRow; 6] = [
        ("list", 4, "", &[0, 1, 2, 3, 4, 5], 6, vec![format!("2 {smooth}")]),
        ("strip", 5, "", &[0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4], 6, vec![format!("2 {smooth}")]),
        ("fan", 6, "", &[1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0], 6, vec![format!("2 {smooth}")]),
        // Indices 1, 2, 3 of one byte each; the unused vertices are left out.
        ("indexed", 4, ",\"indices\":1", &[0, 1, 2], 3, vec![format!("2 {smooth}")]),
        ("points", 0, "", &[], 0, vec![format!("1 {smooth}")]),
        ("line strip", 3, "", &[], 0, vec![format!("1 {smooth}")]),
    ];
    for (name, mode, indices, expected, vertices, warnings) in rows {
        let (json, data) = strip(mode, indices);
        let model = load_glb(&json, &data).unwrap();
        assert_eq!(model.warnings, warnings, "{name}");
        assert_eq!(model.parts.len(), 1 + usize::from(!expected.is_empty()), "{name}");
        assert_eq!(model.lines.len(), usize::from(expected.is_empty()), "{name}");
        if !expected.is_empty() {
            assert_eq!(model.parts[0].mesh.indices(), expected, "{name}");
            assert_eq!(model.parts[0].mesh.positions().len(), vertices, "{name}");
            // Strips and fans turn every other triangle round, so that all face one way.
            assert!(model.parts[0].mesh.report().problems.misoriented_edges == 0 || mode == 6, "{name}");
        }
    }
}

#[test]
fn integer_texture_coordinates_strides_and_sparse_values() {
    // Texture coordinates as bytes, four apart, in the place of the floats; the second position replaced sparsely.
    let mut data = triangle_data();
    data[72..84].copy_from_slice(&[0, 255, 0, 0, 255, 255, 0, 0, 51, 0, 0, 0]);
    data.extend([1, 0, 0, 0]);
    data.extend([7.0_f32, 0.0, 0.0].into_iter().flat_map(f32::to_le_bytes));
    let json = with(&[
        (
            "{\"bufferView\":2,\"componentType\":5126,\"type\":\"VEC2\",\"count\":3}",
            "{\"bufferView\":2,\"componentType\":5121,\"normalized\":true,\"type\":\"VEC2\",\"count\":3}",
        ),
        (
            "{\"buffer\":0,\"byteOffset\":72,\"byteLength\":24}",
            "{\"buffer\":0,\"byteOffset\":72,\"byteLength\":24,\"byteStride\":4}",
        ),
        (
            "\"max\":[1,1,0]}",
            "\"max\":[1,1,0],\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":4,\"componentType\":5121},\"values\":{\"bufferView\":5}}}",
        ),
        (
            "{\"buffer\":0,\"byteOffset\":96,\"byteLength\":6}",
            "{\"buffer\":0,\"byteOffset\":96,\"byteLength\":6},{\"buffer\":0,\"byteOffset\":104,\"byteLength\":1},{\"buffer\":0,\"byteOffset\":108,\"byteLength\":12}",
        ),
        ("\"byteLength\":104", "\"byteLength\":120"),
    ]);
    let mesh = load_glb(&json, &data).unwrap().parts.remove(0).mesh;
    assert_eq!(mesh.positions(), [Vec3::ZERO, Vec3::X * 7.0, Vec3::Y]);
    assert_eq!(mesh.uvs().unwrap(), [Vec2::Y, Vec2::ONE, Vec2::new(0.2, 0.0)]);
}

#[test]
fn materials_keep_their_factors() {
    let old = "{\"name\":\"red\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0,0,1],\"metallicFactor\":0.25,\"roughnessFactor\":0.5}}";
    let new = "{},{\"name\":\"leaf\",\"alphaMode\":\"MASK\",\"doubleSided\":true,\"emissiveFactor\":[0,0.5,0]},{\"alphaMode\":\"MASK\",\"alphaCutoff\":0.25},{\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,0.2,0.3,0.4]}},{\"extensions\":{\"KHR_materials_unlit\":{}}}";
    let model = load_glb(&with(&[(old, new)]), &triangle_data()).unwrap();
    let default = MetallicRoughness {
        name: String::new(),
        base_color: [1.0; 4],
        metallic: 1.0,
        roughness: 1.0,
        emissive: [0.0; 3],
        double_sided: false,
        unlit: false,
        alpha: AlphaMode::Opaque,
        specular_glossiness: None,
        maps: GltfMaps::default(),
    };
    let expected = [
        default.clone(),
        MetallicRoughness {
            name: "leaf".to_owned(),
            emissive: [0.0, 0.5, 0.0],
            double_sided: true,
            alpha: AlphaMode::Mask { cutoff: 0.5 },
            ..default.clone()
        },
        MetallicRoughness { alpha: AlphaMode::Mask { cutoff: 0.25 }, ..default.clone() },
        MetallicRoughness { alpha: AlphaMode::Blend, base_color: [0.1, 0.2, 0.3, 0.4], ..default.clone() },
        MetallicRoughness { unlit: true, ..default },
    ];
    assert_eq!(model.materials, expected.map(SourceMaterial::MetallicRoughness));
}

#[test]
fn lights_stand_where_their_nodes_do() {
    let lights = r#"{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],"extensionsRequired":["KHR_lights_punctual"],
        "extensions":{"KHR_lights_punctual":{"lights":[
        {"type":"directional","color":[1,0.5,0.25],"intensity":3},
        {"type":"point","name":"bulb","range":10},
        {"type":"spot","spot":{"innerConeAngle":0.1,"outerConeAngle":0.5}},
        {"type":"spot","spot":{}}]}}"#;
    let node =
        |light: u32, rest: &str| format!("{{\"extensions\":{{\"KHR_lights_punctual\":{{\"light\":{light}}}}},{rest}}}");
    let nodes = format!(
        "\"nodes\":[{{\"mesh\":0,\"translation\":[0,2,0],\"children\":[1,2,3,4]}},{},{},{},{}],",
        node(0, "\"name\":\"sun\",\"rotation\":[-0.70710678,0,0,0.70710678]"),
        node(1, "\"name\":\"not this\",\"translation\":[1,0,0]"),
        node(2, "\"scale\":[2,2,2]"),
        node(3, "\"name\":\"lamp\"")
    );
    let json = with(&[
        ("{\"version\":\"2.0\"}", lights),
        ("\"nodes\":[{\"name\":\"node\",\"mesh\":0,\"translation\":[0,0,5]}],", &nodes),
    ]);
    let model = load_glb(&json, &triangle_data()).unwrap();
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    let [sun, bulb, cone, lamp] = &model.lights[..] else { panic!("{} lights", model.lights.len()) };

    assert_eq!((&sun.name[..], sun.kind), ("sun", SourceLightKind::Directional));
    assert_eq!((sun.color, sun.intensity, sun.range), ([1.0, 0.5, 0.25], 3.0, None));
    // A quarter of a turn about −X points its −Z down.
    assert!(sun.world_from_light.transform_vector3(Vec3::NEG_Z).distance(Vec3::NEG_Y) < 1e-6);

    assert_eq!((&bulb.name[..], bulb.kind), ("bulb", SourceLightKind::Point));
    assert_eq!((bulb.color, bulb.intensity, bulb.range), ([1.0; 3], 1.0, Some(10.0)));
    assert_eq!(bulb.world_from_light.transform_point3(Vec3::ZERO), Vec3::new(1.0, 2.0, 0.0));

    assert_eq!(cone.kind, SourceLightKind::Spot { inner: 0.1, outer: 0.5 });
    assert_eq!(lamp.kind, SourceLightKind::Spot { inner: 0.0, outer: std::f32::consts::FRAC_PI_4 });
}

#[test]
fn skipped_contents_give_warnings() {
    let json = with(&[
        (
            "{\"version\":\"2.0\"}",
            "{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_materials_clearcoat\",\"KHR_texture_basisu\"],\"cameras\":[{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":1,\"ymag\":1,\"zfar\":10,\"znear\":0}}]",
        ),
        ("\"scenes\":[{\"nodes\":[0]}]", "\"scenes\":[{\"nodes\":[0]},{\"nodes\":[]}]"),
        // Attributes of the application's own pass.
        ("\"TEXCOORD_0\":2}", "\"TEXCOORD_0\":2,\"_ID\":3,\"_OTHER\":3},\"targets\":[{\"POSITION\":0}]"),
    ]);
    assert_eq!(
        load_glb(&json, &triangle_data()).unwrap().warnings,
        [
            "the extension KHR_materials_clearcoat is skipped",
            "the extension KHR_texture_basisu is skipped",
            "only the default scene of 2 is read",
        ]
    );
}

#[test]
fn a_metallic_roughness_texture_is_skipped_by_name() {
    let of_material = "\"metallicFactor\":0.25";
    let json = with(&[
        (of_material, "\"metallicRoughnessTexture\":{\"index\":1},\"metallicFactor\":0.25"),
        (
            "\"materials\":[",
            "\"images\":[{\"uri\":\"unread.png\"}],\"textures\":[{\"source\":0},{\"source\":0}],\"materials\":[",
        ),
    ]);
    assert_eq!(
        load_glb(&json, &triangle_data()).unwrap().warnings,
        [
            // The image that no material names.
            "textures are skipped (1)",
            "materials[0]: the metallic-roughness texture is skipped; the factors alone count",
        ]
    );
}

#[test]
fn a_transform_of_textures_may_be_required() {
    let head = r#"{"version":"2.0"},"extensionsUsed":["KHR_texture_transform"],
        "extensionsRequired":["KHR_texture_transform"],
        "images":[{"uri":"data:image/png;base64,AAAA"}],"textures":[{"source":0}]"#;
    let texture = r#""baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":
        {"offset":[0.5,0.25],"rotation":0.125,"scale":[2,4]}}},"metallicFactor":0.25"#;
    let json = with(&[(r#"{"version":"2.0"}"#, head), (r#""metallicFactor":0.25"#, texture)]);
    let model = load_glb(&json, &triangle_data()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(model.warnings, [""; 0]);
    let [SourceMaterial::MetallicRoughness(MetallicRoughness { maps, .. })] = &model.materials[..] else {
        panic!("one material: {:?}", model.materials)
    };
    let map = maps.base_color.as_ref().expect("its image");
    assert_eq!((map.offset, map.rotation, map.scale), ([0.5, 0.25], 0.125, [2.0, 4.0]));
}

#[test]
fn matrices_may_be_off_by_rounding() {
    let node = "{\"name\":\"node\",\"mesh\":0,\"translation\":[0,0,5]}";
    let of = |last: &str| format!("{{\"mesh\":0,\"matrix\":[2,0,0,0, 0,2,0,0, 0,0,2,0, 1,2,3,{last}]}}");
    let file = |nodes: &str, roots: &str| with(&[(node, nodes), ("{\"nodes\":[0]}", roots)]);
    let two = format!("{},{}", of("0.99999994"), of("1.000001"));
    let model = load_glb(&file(&two, "{\"nodes\":[0,1]}"), &triangle_data()).unwrap();
    assert_eq!(
        model.warnings,
        ["nodes[0].matrix: last row [0.0, 0.0, 0.0, 0.99999994] is taken for 0, 0, 0, 1 (and 1 more such matrices)"]
    );
    let expected = Mat4::from_translation(Vec3::new(1.0, 2.0, 3.0)) * Mat4::from_scale(Vec3::splat(2.0));
    assert!(model.parts.iter().all(|part| part.world_from_part == expected));
    let error = load_glb(&file(&of("0.9999"), "{\"nodes\":[0]}"), &triangle_data()).unwrap_err().to_string();
    assert!(error.ends_with("nodes[0].matrix: last row [0.0, 0.0, 0.0, 0.9999]; 0, 0, 0, 1 is expected"), "{error}");
}

#[test]
fn cameras_are_kept() {
    let cameras = r#""cameras":[
        {"name":"eye","type":"perspective","perspective":{"yfov":0.5,"znear":0.1,"aspectRatio":1.5}},
        {"type":"orthographic","orthographic":{"xmag":2,"ymag":1,"zfar":10,"znear":0}}],"#;
    let nodes = r#""nodes":[{"name":"node","mesh":0,"translation":[0,0,5],"camera":0},{"name":"plan","camera":1}],"#;
    let file = |cameras: &str| {
        with(&[
            ("\"nodes\":[{\"name\":\"node\",\"mesh\":0,\"translation\":[0,0,5]}],", &format!("{cameras}{nodes}")),
            ("\"scenes\":[{\"nodes\":[0]}]", "\"scenes\":[{\"nodes\":[0,1]}]"),
        ])
    };
    let model = load_glb(&file(cameras), &triangle_data()).unwrap();
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    let projection = SourceProjection::Perspective { yfov: 0.5, aspect: Some(1.5), near: 0.1, far: None };
    let eye =
        SourceCamera { name: "eye".to_owned(), projection, world_from_camera: Mat4::from_translation(Vec3::Z * 5.0) };
    let projection = SourceProjection::Orthographic { half_width: 2.0, half_height: 1.0, near: 0.0, far: 10.0 };
    let plan = SourceCamera { name: "plan".to_owned(), projection, world_from_camera: Mat4::IDENTITY };
    assert_eq!(model.cameras, [eye, plan]);

    for (name, from, to, expected) in [
        (
            "other projection",
            "\"perspective\",\"persp",
            "\"orthographic\",\"persp",
            "cameras[0]: no projection of its type; one is expected",
        ),
        ("no angle", "0.5", "0", "cameras[0].perspective: [0.0, 1.5, 0.1"),
        ("far before near", "\"zfar\":10", "\"zfar\":0", "cameras[1].orthographic: [2.0, 1.0, 0.0, 0.0]"),
        ("far too far", "\"zfar\":10", "\"zfar\":1e39", "cameras[1].orthographic: [2.0, 1.0, 0.0, inf]"),
        ("no width", "\"xmag\":2", "\"xmag\":0", "cameras[1].orthographic: [0.0"),
    ] {
        assert!(cameras.contains(from), "{name}");
        let message = load_glb(&file(&cameras.replace(from, to)), &triangle_data()).unwrap_err().to_string();
        assert!(message.contains(expected), "{name}: {message}");
    }
}

/// The values at the corners of the triangle.
type Corners<T> = [T; 3];

/// An attribute: name, shape, component type, whether it is normalised, byte stride, bytes.
type AttributeRow<'a> = (&'a str, &'a str, u32, bool, usize, &'a [u8]);

/// A triangle whose attributes are given by their types and bytes, four bytes apart or more.
fn attributes(extension: &str, rows: &[AttributeRow]) -> Result<Model, LoadError> {
    let mut data = Vec::new();
    let (mut views, mut accessors, mut names) = (Vec::new(), Vec::new(), Vec::new());
    for (i, (name, shape, component, normalized, stride, bytes)) in rows.iter().enumerate() {
        let bounds = if *name == "POSITION" { ",\"min\":[0,0,0],\"max\":[1,1,1]" } else { "" };
        views.push(format!(
            "{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{},\"byteStride\":{stride}}}",
            data.len(),
            bytes.len()
        ));
        accessors.push(format!(
            "{{\"bufferView\":{i},\"componentType\":{component},\"normalized\":{normalized},\"type\":\"{shape}\",\"count\":3{bounds}}}"
        ));
        names.push(format!("\"{name}\":{i}"));
        data.extend_from_slice(bytes);
        data.resize(data.len().next_multiple_of(4), 0);
    }
    let json = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},{extension}\"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{{\"attributes\":{{{}}}}}]}}],\"accessors\":[{}],\"bufferViews\":[{}],\"buffers\":[{{\"byteLength\":{}}}]}}",
        names.join(","),
        accessors.join(","),
        views.join(","),
        data.len()
    );
    load_glb(&json, &data)
}

const I8: u32 = 5120;
const U8: u32 = 5121;
const I16: u32 = 5122;
const U16: u32 = 5123;
const F32: u32 = 5126;

#[test]
fn attributes_may_be_quantised() {
    const EXTENSION: &str =
        "\"extensionsUsed\":[\"KHR_mesh_quantization\"],\"extensionsRequired\":[\"KHR_mesh_quantization\"],";
    let words = |numbers: &[i16]| -> Vec<u8> { numbers.iter().flat_map(|x| x.to_le_bytes()).collect() };
    let positions = words(&[0, 0, 0, 0, 7, 0, 0, 0, 0, -9, 0, 0]);
    let model = attributes(
        EXTENSION,
        &[
            ("POSITION", "VEC3", I16, false, 8, &positions),
            ("NORMAL", "VEC3", I8, true, 4, &[0, 0, 127, 0, 0, 0, 129, 0, 0, 0, 128, 0]),
            ("TEXCOORD_0", "VEC2", U8, false, 4, &[1, 2, 0, 0, 3, 4, 0, 0, 255, 0, 0, 0]),
        ],
    )
    .unwrap();
    let mesh = &model.parts[0].mesh;
    assert_eq!(mesh.positions(), [Vec3::ZERO, Vec3::X * 7.0, Vec3::Y * -9.0]);
    // −128 is −1 too.
    assert_eq!(mesh.normals(), [Vec3::Z, Vec3::NEG_Z, Vec3::NEG_Z]);
    assert_eq!(mesh.uvs(), Some(&[Vec2::new(1.0, 2.0), Vec2::new(3.0, 4.0), Vec2::new(255.0, 0.0)][..]));

    let halves = words(&[0, 0, 0, 0, 32767, 0, 0, 0, 0, -32768, 0, 0]);
    let rows: [(u32, bool, &[u8], Corners<Vec3>); 4] = [
        (I16, true, &halves, [Vec3::ZERO, Vec3::X, Vec3::NEG_Y]),
        (U16, true, &halves, [Vec3::ZERO, Vec3::X * (32767.0 / 65535.0), Vec3::Y * (32768.0 / 65535.0)]),
        (I8, false, &[0, 0, 0, 0, 1, 0, 0, 0, 0, 255, 0, 0], [Vec3::ZERO, Vec3::X, Vec3::NEG_Y]),
        (U8, true, &[0, 0, 0, 0, 255, 0, 0, 0, 0, 51, 0, 0], [Vec3::ZERO, Vec3::X, Vec3::Y * 0.2]),
    ];
    for (component, normalized, bytes, expected) in rows {
        let stride = bytes.len() / 3;
        let row = ("POSITION", "VEC3", component, normalized, stride, bytes);
        let model = attributes(EXTENSION, &[row]).unwrap();
        assert_eq!(model.parts[0].mesh.positions(), expected, "{component}");
        let message = attributes("", &[row]).unwrap_err().to_string();
        assert!(message.contains("Vec3 of one of [F32] is expected"), "{component}: {message}");
    }
}

#[test]
fn colours_and_tangents_are_kept() {
    let floats = |numbers: &[f32]| -> Vec<u8> { numbers.iter().flat_map(|x| x.to_le_bytes()).collect() };
    let positions = floats(&[0., 0., 0., 1., 0., 0., 0., 1., 0.]);
    let position = ("POSITION", "VEC3", F32, false, 12, &positions[..]);
    let normals = floats(&[0., 0., 1., 0., 0., 1., 0., 0., 1.]);
    let normal = ("NORMAL", "VEC3", F32, false, 12, &normals[..]);
    let rgb = floats(&[1., 0., 0., 0., 2., 0., 0., 0., 1.]);
    let [red, green, blue] = [Vec4::new(1., 0., 0., 1.), Vec4::new(0., 2., 0., 1.), Vec4::new(0., 0., 1., 1.)];
    let bytes = [255, 0, 0, 255, 0, 51, 0, 255, 0, 0, 255, 0];
    let rows: [(AttributeRow, Corners<Vec4>); 2] = [
        (("COLOR_0", "VEC3", F32, false, 12, &rgb), [red, green, blue]),
        (("COLOR_0", "VEC4", U8, true, 4, &bytes), [red, Vec4::new(0., 0.2, 0., 1.), Vec4::new(0., 0., 1., 0.)]),
    ];
    for (color, expected) in rows {
        let [second, third] = ["TEXCOORD_1", "TEXCOORD_2"].map(|name| (name, "VEC2", F32, false, 8, &positions[..24]));
        let model = attributes("", &[position, color, second, third]).unwrap();
        let coordinates = model.parts[0].mesh.uv_set(1).unwrap();
        assert_eq!(coordinates, [Vec2::ZERO, Vec2::Y, Vec2::ZERO]);
        assert_eq!(model.parts[0].mesh.colors(), Some(&expected[..]), "{}", color.1);
        let warning =
            "of 1 primitives only the first two texture coordinates and the first colours are read".to_owned();
        assert!(model.warnings.contains(&warning), "{:?}", model.warnings);
    }
    let tangents = floats(&[1., 0., 0., 1., 1., 0., 0., -1., 0., 1., 0., 1.]);
    let model = attributes("", &[position, normal, ("TANGENT", "VEC4", F32, false, 16, &tangents)]).unwrap();
    assert_eq!(model.parts[0].mesh.tangents().unwrap()[1], Vec4::new(1., 0., 0., -1.));
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    // They belong to normals of the file.
    let model = attributes("", &[position, ("TANGENT", "VEC4", F32, false, 16, &tangents)]).unwrap();
    assert!(model.parts[0].mesh.tangents().is_none());
    let bad = floats(&[1., 0., 0., 0.5, 1., 0., 0., -1., 0., 1., 0., 1.]);
    let model = attributes("", &[position, normal, ("TANGENT", "VEC4", F32, false, 16, &bad)]).unwrap();
    assert!(model.parts[0].mesh.tangents().is_none());
    assert!(model.warnings[0].starts_with("the tangents of 1 primitives are skipped"), "{:?}", model.warnings);
}
