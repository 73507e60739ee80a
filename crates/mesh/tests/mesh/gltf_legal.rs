//! Legal glTF that readers often refuse.

use glam::{DVec3, Mat4, Vec3};
use halfway_mesh::{Format, Model, SourceMap, SourceMaterial, load, load_bytes};

use crate::common::gltf_file::GltfFile;
use crate::common::{Folder, TRIANGLE_JSON, glb, triangle_data};

const TRIANGLE: [f32; 9] = [0., 0., 0., 1., 0., 0., 0., 1., 0.];
const SMOOTH: &str = "1 primitives have no normals; smooth ones are computed, where glTF asks for flat ones";
const MESH: &str = r#""nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]"#;

/// A file of a triangle with the members of its JSON.
fn triangle(members: &str) -> Model {
    let mut file = GltfFile::default();
    file.floats("VEC3", &TRIANGLE);
    file.load(members).unwrap_or_else(|error| panic!("{error}"))
}

/// The triangle of the shared file with parts of its text replaced.
fn with(replacements: &[(&str, &str)]) -> Model {
    let json = replacements.iter().fold(TRIANGLE_JSON.to_owned(), |json, (from, to)| {
        assert!(json.contains(from), "{from}");
        json.replace(from, to)
    });
    load_bytes(Format::Glb, &glb(&json, &triangle_data())).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn an_accessor_without_a_view_is_all_zeros() {
    let mut file = GltfFile::default();
    file.floats("VEC3", &TRIANGLE);
    file.zeros("VEC3", 3);
    let target = MESH.replace("}}]", r#"},"targets":[{"POSITION":1}]}]"#);
    let weighted = target.replace("\"mesh\":0}", "\"mesh\":0,\"weights\":[1]}");
    let model = file.load(&weighted).unwrap();
    assert_eq!(model.parts[0].mesh.positions(), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(model.warnings, [SMOOTH]);
}

#[test]
fn channels_that_move_nothing_are_left_out() {
    let samplers = r#""samplers":[{"input":3,"output":0}]"#;
    let skipped =
        "channels of animations are skipped, since they move no node that is shown, or a property that is not known";
    for (target, count) in [
        (r#"{"path":"translation"}"#, 1),
        (r#"{"node":0,"path":"brightness"}"#, 1),
        (r#"{"path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":"/nodes/0/scale"}}}"#, 1),
        // A node that is not in the scene.
        (r#"{"node":1,"path":"translation"}"#, 1),
        (r#"{"node":0,"path":"translation"}"#, 0),
    ] {
        let mut file = GltfFile::default();
        file.floats("VEC3", &TRIANGLE);
        file.zeros("VEC3", 1);
        file.zeros("VEC3", 1);
        file.floats("SCALAR", &[0., 1., 2.]);
        let members = format!(
            r#""scenes":[{{"nodes":[0]}}],{},"animations":[{{"channels":[{{"sampler":0,"target":{target}}}],{samplers}}}]"#,
            MESH.replace("{\"mesh\":0}", "{\"mesh\":0},{}")
        );
        let model = file.load(&members).unwrap();
        assert_eq!(model.animations.is_some(), count == 0, "{target}");
        let warning = format!("{count} {skipped}");
        assert_eq!(model.warnings.contains(&warning), count > 0, "{target}: {:?}", model.warnings);
    }
    // Other faults beside such a channel are still errors.
    let mut file = GltfFile::default();
    file.floats("VEC3", &TRIANGLE);
    let channel =
        r#","animations":[{"channels":[{"sampler":0,"target":{"path":"scale"}}],"samplers":[]}],"materials":7"#;
    let error = file.load(&format!("{MESH}{channel}")).unwrap_err().to_string();
    assert!(error.contains("JSON: invalid type: integer `7`"), "{error}");
}

#[test]
fn textures_need_no_source_of_their_own() {
    // Unused.
    let model = triangle(&format!("{MESH},\"textures\":[{{}}]"));
    assert_eq!(model.warnings, ["textures are skipped (1)", SMOOTH]);

    let image = r#""images":[{"uri":"data:,first"},{"uri":"data:,second"}],"#;
    let ktx2 = "textures[0] is in Basis Universal (KHR_texture_basisu), which is not decoded; `ktx extract` gets a PNG out of it";
    let rows: [(&str, Option<&[u8]>, &str); 6] = [
        ("{}", None, "materials[0]: the base color texture is skipped, since textures[0] has no source"),
        (r#"{"source":0,"extensions":{"EXT_texture_webp":{"source":1}}}"#, Some(b"second"), ""),
        (r#"{"extensions":{"EXT_texture_webp":{"source":1}}}"#, Some(b"second"), ""),
        (r#"{"source":0,"extensions":{"EXT_texture_webp":{"source":9}}}"#, Some(b"first"), ""),
        (
            r#"{"source":0,"extensions":{"KHR_texture_basisu":{"source":1}}}"#,
            Some(b"first"),
            "textures[0]: the image for programs without Basis Universal is shown, since KHR_texture_basisu is not decoded",
        ),
        (
            r#"{"extensions":{"KHR_texture_basisu":{"source":1}}}"#,
            None,
            &format!("materials[0]: the base color texture is skipped, since {ktx2}"),
        ),
    ];
    for (texture, bytes, warning) in rows {
        let materials = format!(r#"{image}"textures":[{texture}],"materials":["#);
        let material = r#""baseColorTexture":{"index":0},"metallicFactor":0.25"#;
        let model = with(&[("\"materials\":[", &materials), ("\"metallicFactor\":0.25", material)]);
        let [SourceMaterial::MetallicRoughness(gltf)] = &model.materials[..] else { panic!("{:?}", model.materials) };
        assert_eq!(gltf.maps.base_color.as_ref().map(|map| &map.bytes[..]), bytes, "{texture}");
        let warnings = if warning.is_empty() { vec![] } else { vec![warning.to_owned()] };
        assert_eq!(model.warnings, warnings, "{texture}");
    }
}

#[test]
fn an_image_without_bytes_is_a_warning() {
    let textures = r#""images":[{}],"textures":[{"source":0}],"materials":["#;
    let material = r#""baseColorTexture":{"index":0},"metallicFactor":0.25"#;
    let model = with(&[("\"materials\":[", textures), ("\"metallicFactor\":0.25", material)]);
    assert_eq!(model.warnings, ["images[0]: the image cannot be read: it has neither a uri nor a bufferView"]);
}

#[test]
fn primitives_need_no_positions_nor_their_bounds() {
    let both = MESH.replace("[{\"attributes\"", "[{\"attributes\":{}},{\"attributes\"");
    let model = triangle(&both);
    assert_eq!(model.parts.len(), 1);
    assert_eq!(model.warnings, [SMOOTH, "1 primitives have no positions and are skipped"]);

    let model = with(&[(",\"min\":[0,0,0],\"max\":[1,1,0]", "")]);
    assert_eq!(model.bounds().unwrap().max, Vec3::new(1.0, 1.0, 5.0));
    let warning =
        "the positions of 1 primitives have no least and greatest values, which glTF asks for; they are computed";
    assert_eq!(model.warnings, [warning]);
}

#[test]
fn a_percent_sign_may_be_a_part_of_a_name() {
    let folder = Folder::new();
    for (name, uri) in [
        ("10%.bin", "10%.bin"),
        ("10%.bin", "10%25.bin"),
        ("100% real.bin", "100%%20real.bin"),
        // As some programs write them, that do not know of escapes.
        ("a%20b.bin", "a%20b.bin"),
    ] {
        let data = folder.write(name, triangle_data());
        let json = TRIANGLE_JSON.replace("{\"byteLength\":104}", &format!("{{\"byteLength\":104,\"uri\":\"{uri}\"}}"));
        let model = load(&folder.write("model.gltf", json)).unwrap_or_else(|error| panic!("{uri}: {error}"));
        assert_eq!((model.parts.len(), model.warnings.len()), (1, 0), "{uri}");
        std::fs::remove_file(data).unwrap();
    }
}

#[test]
fn data_uris_may_be_text() {
    let data = triangle_data().iter().map(|byte| format!("%{byte:02X}")).collect::<Vec<_>>().concat();
    for head in ["data:,", "data:application/octet-stream,", "data:text/plain;charset=utf-8,"] {
        let uri = format!("{{\"byteLength\":104,\"uri\":\"{head}{data}\"}}");
        let json = TRIANGLE_JSON.replace("{\"byteLength\":104}", &uri);
        let model = load_bytes(Format::Gltf, json.as_bytes()).unwrap_or_else(|error| panic!("{head}: {error}"));
        assert_eq!(model.parts[0].mesh.positions(), [Vec3::ZERO, Vec3::X, Vec3::Y], "{head}");
    }
}

#[test]
fn extensions_that_change_no_shape_may_be_required() {
    for extension in ["KHR_materials_clearcoat", "KHR_texture_basisu", "EXT_texture_webp", "KHR_xmp_json_ld"] {
        let lists = format!(r#""extensionsUsed":["{extension}"],"extensionsRequired":["{extension}"]"#);
        let model = triangle(&format!("{MESH},{lists}"));
        let skipped = format!("the extension {extension} is skipped, though the file requires it");
        let is_skipped = extension != "EXT_texture_webp";
        assert_eq!(model.warnings.contains(&skipped), is_skipped, "{extension}: {:?}", model.warnings);
    }
}

#[test]
fn parents_at_map_coordinates_do_not_round() {
    let place = DVec3::new(400_000.3, 5_000_000.7, 12.1);
    let nodes = |translation: &str| {
        format!(
            r#""nodes":[{{"children":[1,2],"translation":{translation}}},{{"mesh":0,"translation":[0.1,0.2,0.3]}},{{"mesh":0,"translation":[-2.5,0,1]}}],"scenes":[{{"nodes":[0]}}],{}"#,
            &MESH[MESH.find("\"meshes\"").unwrap()..]
        )
    };
    let (near, far) = (triangle(&nodes("[0,0,0]")), triangle(&nodes("[400000.3,5000000.7,12.1]")));
    assert_eq!(near.origin, DVec3::ZERO);
    assert!((far.origin - place).abs().max_element() < 4.0, "{}", far.origin);
    for (near, far_part) in near.parts.iter().zip(&far.parts) {
        let at = |part: &Mat4| part.w_axis.truncate().as_dvec3();
        let difference = at(&far_part.world_from_part) + far.origin - at(&near.world_from_part) - place;
        assert!(difference.abs().max_element() < 1e-6, "{difference}");
        assert_eq!(near.mesh, far_part.mesh);
    }
    // Cameras and lights too.
    let camera = r#","cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}]"#;
    let seen = nodes("[400000.3,5000000.7,12.1]").replace("\"mesh\":0,\"translation\":[-2.5,0,1]", "\"camera\":0");
    let model = triangle(&(seen + camera));
    let camera = model.cameras[0].world_from_camera.w_axis.truncate().as_dvec3() + model.origin;
    assert!((camera - place).abs().max_element() < 1e-6, "{camera}");
}

#[test]
fn far_positions_are_counted_from_a_point_near_them() {
    let far: Vec<f32> = TRIANGLE.iter().map(|x| x * 4.0 + 4_000_000.0).collect();
    for mode in [4, 3, 0] {
        let mut file = GltfFile::default();
        file.floats("VEC3", &far);
        let mesh = MESH.replace("{\"attributes\"", &format!("{{\"mode\":{mode},\"attributes\""));
        let model = file.load(&mesh.replace("\"mesh\":0}", "\"mesh\":0,\"translation\":[0.5,0,0]}")).unwrap();
        assert_ne!(model.origin, DVec3::ZERO);
        let (positions, place) = match (&model.parts[..], &model.lines[..]) {
            ([part], []) => (part.mesh.positions(), part.world_from_part),
            ([], [lines]) => (lines.lines.positions(), lines.world_from_part),
            _ => panic!("{mode}"),
        };
        assert!(positions.iter().all(|p| p.abs().max_element() < 8.0), "{positions:?}");
        for (p, file) in positions.iter().zip(far.as_chunks::<3>().0) {
            let expected = Vec3::from_array(*file).as_dvec3() + DVec3::X * 0.5;
            assert_eq!(place.transform_point3(*p).as_dvec3() + model.origin, expected, "{mode}");
        }
    }
}

#[test]
fn a_mesh_stands_where_its_instances_do() {
    let mut file = GltfFile::default();
    file.floats("VEC3", &TRIANGLE);
    file.floats("VEC3", &[1., 0., 0., 0., 2., 0.]);
    file.floats("VEC4", &[0., 0., 0., 1., 0., 0., 1., 0.]);
    file.floats("VEC3", &[1., 1., 1., 2., 2., 2.]);
    let extension = r#"{"mesh":0,"translation":[0,0,5],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":1,"ROTATION":2,"SCALE":3}}}}"#;
    let lists = r#""extensionsUsed":["EXT_mesh_gpu_instancing"],"extensionsRequired":["EXT_mesh_gpu_instancing"],"#;
    let members = lists.to_owned() + &MESH.replace("{\"mesh\":0}", extension);
    let model = file.load(&members).unwrap();
    assert_eq!(model.warnings, [SMOOTH]);
    let [first, second] = &model.parts[..] else { panic!("{} parts", model.parts.len()) };
    assert!(first.mesh.is_clone_of(&second.mesh));
    assert_eq!(first.world_from_part, Mat4::from_translation(Vec3::new(1.0, 0.0, 5.0)));
    // Half a turn about z, twice as large.
    assert!(second.world_from_part.transform_point3(Vec3::X).distance(Vec3::new(-2.0, 2.0, 5.0)) < 1e-6);

    for (from, to, expected) in [
        (
            "\"SCALE\":3",
            "\"SCALE\":0",
            "nodes[0].extensions.EXT_mesh_gpu_instancing.attributes: [2, 2, 3] values; as many of each are expected",
        ),
        ("\"SCALE\":3", "\"SCALE\":9", "attributes.SCALE: 9; one of the 4 accessors, from 0, is expected"),
        ("\"ROTATION\":2", "\"ROTATION\":1", "accessors[1]: Vec3 of F32; Vec4 of one of"),
    ] {
        let error = file.load(&members.replace(from, to)).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn specular_glossiness_materials_are_read() {
    let extension = r#""extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[0.5,0.25,0,0.75],
        "specularFactor":[0.1,0.2,0.3],"glossinessFactor":0.75,"diffuseTexture":{"index":0},"specularGlossinessTexture":{"index":1}}},"#;
    let images =
        r#""images":[{"uri":"data:,kd"},{"uri":"data:,ks"}],"textures":[{"source":0},{"source":1}],"materials":["#;
    let lists = "{\"version\":\"2.0\"},\"extensionsRequired\":[\"KHR_materials_pbrSpecularGlossiness\"]";
    let name = "\"name\":\"red\",";
    let model =
        with(&[("{\"version\":\"2.0\"}", lists), ("\"materials\":[", images), (name, &format!("{name}{extension}"))]);
    let [SourceMaterial::MetallicRoughness(gltf)] = &model.materials[..] else { panic!("{:?}", model.materials) };
    assert_eq!((gltf.base_color, gltf.metallic, gltf.roughness), ([0.5, 0.25, 0.0, 0.75], 0.0, 0.25));
    let specular = gltf.specular_glossiness.as_ref().unwrap();
    assert_eq!((specular.specular, specular.glossiness), ([0.1, 0.2, 0.3], 0.75));
    let bytes = |map: &Option<SourceMap>| map.as_ref().map(|map| map.bytes.to_vec());
    assert_eq!(bytes(&gltf.maps.base_color), Some(b"kd".to_vec()));
    assert_eq!(bytes(&specular.map), Some(b"ks".to_vec()));
    assert_eq!(
        model.warnings,
        ["materials[0]: of the specular-glossiness texture only the color counts; the glossiness is the factor's"]
    );
}

/// A square of two triangles whose positions and indices are packed: two buffers, of which the second has no data.
fn packed_square() -> String {
    // By meshoptimizer's encoder.
    let (positions, indices) = (
        "a00000013f000000ffffff013f0000007e7d7e0000010c000000ff010c0000007e000000000000000000000000000000000000000000000000000000000000000000000000",
        "e1f010007687566778a9866589689801690000",
    );
    let data = [positions, indices].concat();
    let escapes = data.as_bytes().chunks(2).map(|two| format!("%{}{}", char::from(two[0]), char::from(two[1])));
    let data = escapes.collect::<Vec<_>>().concat();
    let (first, second) = (positions.len() / 2, indices.len() / 2);
    let length = first + second;
    format!(
        r#"{{"asset":{{"version":"2.0"}},"extensionsUsed":["EXT_meshopt_compression"],"extensionsRequired":["EXT_meshopt_compression"],
        "nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":4,"min":[0,0,0],"max":[1,1,0]}},
            {{"bufferView":1,"componentType":5123,"type":"SCALAR","count":6}}],
        "bufferViews":[
            {{"buffer":1,"byteLength":48,"byteStride":12,"extensions":{{"EXT_meshopt_compression":
                {{"buffer":0,"byteLength":{first},"byteStride":12,"count":4,"mode":"ATTRIBUTES"}}}}}},
            {{"buffer":1,"byteOffset":48,"byteLength":12,"extensions":{{"EXT_meshopt_compression":
                {{"buffer":0,"byteOffset":{first},"byteLength":{second},"byteStride":2,"count":6,"mode":"TRIANGLES"}}}}}}],
        "buffers":[{{"byteLength":{length},"uri":"data:,{data}"}},
            {{"byteLength":60,"extensions":{{"EXT_meshopt_compression":{{"fallback":true}}}}}}]}}"#
    )
}

#[test]
fn a_mesh_that_draco_packed_is_no_heap_of_zeros() {
    let mut file = GltfFile::default();
    file.zeros("VEC3", 3);
    file.floats("VEC3", &TRIANGLE);
    let draco = r#"}},"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}}}]"#;
    let packed = MESH.replace("}}]", &draco[1..]);
    let error = file.load(&packed).unwrap_err().to_string();
    let expected = "the extension KHR_draco_mesh_compression is required, which is not supported; `gltf-transform copy` writes the file without it";
    assert!(error.ends_with(expected), "{error}");
    // Beside it there may be the mesh as it is.
    let both = packed
        .replace("\"POSITION\":0}},\"ext", "\"POSITION\":1},\"ext")
        .replace("{\"POSITION\":0},\"ext", "{\"POSITION\":1},\"ext");
    let model = file.load(&format!("\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],{both}")).unwrap();
    assert_eq!(model.warnings, ["the extension KHR_draco_mesh_compression is skipped", SMOOTH]);
}

#[test]
fn packed_views_are_unpacked() {
    let text = packed_square();
    for text in [text.clone(), text.replace("EXT_meshopt", "KHR_meshopt")] {
        let model = load_bytes(Format::Gltf, text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(model.warnings, [SMOOTH]);
        let mesh = &model.parts[0].mesh;
        assert_eq!(mesh.positions(), [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)]);
        let mut triangles: Vec<[u32; 3]> = mesh.triangles().collect();
        for corners in &mut triangles {
            let least = (0..3).min_by_key(|k| corners[*k]).unwrap();
            corners.rotate_left(least);
        }
        assert_eq!(triangles, [[0, 1, 2], [1, 3, 2]]);
    }
    for (from, to, expected) in [
        (
            "\"count\":4,\"mode\"",
            "\"count\":9,\"mode\"",
            "bufferViews[0].extensions.EXT_meshopt_compression: count 9; at least one item, and no more than the view holds, is expected",
        ),
        (
            "\"byteStride\":2,",
            "\"byteStride\":3,",
            "bufferViews[1].extensions.EXT_meshopt_compression: byteStride 3; 2 or 4 is expected",
        ),
        (
            "\"buffer\":0,\"byteOffset\"",
            "\"buffer\":1,\"byteOffset\"",
            "bytes that are not there; a part of a buffer with data is expected",
        ),
        (
            "\"count\":6,\"mode\"",
            "\"count\":3,\"mode\"",
            "bufferViews[1].extensions.EXT_meshopt_compression: packed data that do not make 3 items; a whole stream is expected",
        ),
        ("\"TRIANGLES\"", "\"SQUARES\"", "unknown variant `SQUARES`"),
        (
            "\"byteOffset\":48",
            "\"byteOffset\":4800000000",
            "at most 64 times the bytes of the file, in all views, are expected",
        ),
    ] {
        assert!(text.contains(from), "{from}");
        let error = load_bytes(Format::Gltf, text.replacen(from, to, 1).as_bytes()).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}
