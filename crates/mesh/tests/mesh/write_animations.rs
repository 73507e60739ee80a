//! Writers: animations of glTF are read as the same.

use glam::{Mat4, Vec3, Vec4};
use halfway_mesh::{
    Animations, Mesh, Model, MtlMaterial, Normals, Pose, SourceMaterial, Subdivision, load, write, write_quantised,
};

use crate::common::gltf_file::GltfFile;
use crate::common::{Folder, check_model};
use crate::gltf_animation::{clip, morph, skin, turning_cube};

fn animations(model: &Model) -> &Animations {
    model.animations.as_deref().expect("animations")
}

/// The poses of all animations, before, within and after them.
fn poses(model: &Model) -> Vec<Pose> {
    let animations = animations(model);
    let times = [-1.0, 0.0, 0.3, 0.5, 0.77, 1.0, 1.9, 7.3];
    (0..animations.clips().len()).flat_map(|clip| times.map(|time| animations.pose(clip, time))).collect()
}

/// Checks that two models are equal, and move alike.
#[track_caller]
fn check_equal(found: &Model, expected: &Model) {
    check_model(found);
    // Normals that the file did not have may be written.
    assert!(found.warnings.iter().all(|warning| expected.warnings.contains(warning)), "{:?}", found.warnings);
    assert_eq!((&found.parts, &found.lines, found.origin), (&expected.parts, &expected.lines, expected.origin));
    assert_eq!((&found.lights, &found.cameras), (&expected.lights, &expected.cameras));
    let clips = |model: &Model| -> Vec<(String, f64)> {
        animations(model).clips().iter().map(|clip| (clip.name.clone(), clip.duration)).collect()
    };
    assert_eq!(clips(found), clips(expected));
    assert!(poses(found).iter().any(|pose| *pose != Pose::default()));
    for (found, expected) in poses(found).iter().zip(&poses(expected)) {
        assert_eq!(found, expected);
    }
}

/// Writes a model as GLB and as glTF, reads both, and checks them. The nodes that writing adds come into their order when
/// they are written a second time; from then on the file is the same.
#[track_caller]
fn check_comes_back(model: &Model) {
    let folder = Folder::new();
    for name in ["model.glb", "model.gltf"] {
        let path = folder.path().join(name);
        assert_eq!(write(&path, model).unwrap(), Vec::<String>::new());
        check_equal(&load(&path).unwrap(), model);
        let [second, third] = [(); 2].map(|()| {
            let read = load(&path).unwrap();
            check_equal(&read, model);
            assert_eq!(write(&path, &read).unwrap(), Vec::<String>::new());
            std::fs::read(&path).unwrap()
        });
        assert!(second == third, "{name} has changed");
    }
}

#[test]
fn moving_nodes_come_back() {
    let (file, members) = turning_cube();
    check_comes_back(&file.load(&members).unwrap());
    // Far away, where places have 64 bits.
    let second = "{\"mesh\":0,\"translation\":[0,9,0]}";
    let above = "{\"children\":[0],\"translation\":[400000.25,5000000.5,0]}";
    let far = file.load(&members.replace(second, above).replace("[0,2]", "[2]")).unwrap();
    assert!(far.origin.y > 4e6);
    check_comes_back(&far);
}

#[test]
fn the_fish_comes_back() {
    let fish = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/fish.glb");
    check_comes_back(&load(&fish).unwrap());
}

/// Every interpolation of every path, with uneven numbers.
#[test]
fn all_interpolations_come_back() {
    for (interpolation, values) in [("STEP", 1), ("LINEAR", 1), ("CUBICSPLINE", 3)] {
        let (mut file, members) = turning_cube();
        let numbers = |width: usize| -> Vec<f32> {
            (0..3 * values * width).map(|i| 0.1 + (i as f32 * 0.7).sin() / 3.0 + 1e-7).collect()
        };
        let input = file.floats("SCALAR", &[0.1, 1.0 / 3.0, 1.7]);
        let three = file.floats("VEC3", &numbers(3));
        let four = file.floats("VEC4", &numbers(4));
        let moves = clip(&[
            (0, "translation", input, three, interpolation),
            (1, "scale", input, three, interpolation),
            (1, "rotation", input, four, interpolation),
        ]);
        let (before, _) = members.split_once("\"animations\"").unwrap();
        check_comes_back(&file.load(&format!("{before}\"animations\":[{moves},{moves}]")).unwrap());
    }
}

/// A node with several primitives, lines, a camera and a light; instances; names of nodes, of meshes and none; matrices and
/// turns; and nodes below all of that.
#[test]
fn what_hangs_on_moving_nodes_comes_back_in_its_order() {
    let (mut file, _) = turning_cube();
    // The second stands where the node does.
    let places = file.floats("VEC3", &[0.5, 0., 0., 0., 0., 0.]);
    let moves = clip(&[(0, "translation", 4, 5, "LINEAR"), (3, "rotation", 2, 3, "LINEAR")]);
    let members = format!(
        r#""nodes":[
        {{"name":"top","mesh":0,"camera":0,"extensions":{{"KHR_lights_punctual":{{"light":0}}}},"children":[3,1,2],
            "rotation":[0.1,0.2,0.3,0.9]}},
        {{"mesh":1,"matrix":[0,2,0,0,-0.7,0,0.1,0,0,0,3,0,0.1,0.2,0.3,1],"camera":1,
            "extensions":{{"KHR_lights_punctual":{{"light":0}}}}}},
        {{"name":"row","mesh":1,"extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{"TRANSLATION":{places}}}}}}}}},
        {{"name":"arm","children":[4],"translation":[0.1,0.7,1e-9]}},
        {{"mesh":1}}],
        "cameras":[{{"name":"eye","type":"perspective","perspective":{{"yfov":1,"znear":1}}}},
            {{"type":"orthographic","orthographic":{{"xmag":1,"ymag":1,"znear":1,"zfar":2}}}}],
        "extensions":{{"KHR_lights_punctual":{{"lights":[{{"type":"point"}}]}}}},"extensionsUsed":["KHR_lights_punctual"],
        "materials":[{{"name":"red"}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"material":0}},
            {{"attributes":{{"POSITION":0}},"mode":3}},{{"attributes":{{"POSITION":0}},"indices":1}}]}},
            {{"name":"of the mesh","primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],"animations":[{moves}]"#
    );
    let model = file.load(&members).unwrap();
    assert_eq!((model.parts.len(), model.lines.len(), model.lights.len(), model.cameras.len()), (6, 1, 2, 2));
    check_comes_back(&model);
}

#[test]
fn animations_of_other_models_are_said_to_be_lost() {
    let (file, members) = turning_cube();
    let model = file.load(&members).unwrap();
    let folder = Folder::new();
    for name in ["model.smf", "model.obj", "model.ply", "model.stl"] {
        let lost = write(&folder.path().join(name), &model).unwrap();
        let expected = "1 animations; the model is written in the pose of the file";
        assert!(lost.iter().any(|lost| lost == expected), "{name}: {lost:?}");
    }
    let changes: [fn(&mut Model); 5] = [
        |model| model.parts[0].world_from_part = Mat4::from_translation(Vec3::Z),
        |model| drop(model.parts.pop()),
        |model| model.lights[0].world_from_light = Mat4::from_translation(Vec3::Z),
        |model| model.cameras.push(model.cameras[0].clone()),
        |model| model.origin.x = 1.0,
    ];
    for (i, change) in changes.iter().enumerate() {
        let mut changed = model.clone();
        change(&mut changed);
        let path = folder.path().join("model.glb");
        let lost = write(&path, &changed).unwrap();
        assert_eq!(lost, ["1 animations, which no longer fit the model; it is written as it stands"], "{i}");
        let read = load(&path).unwrap();
        assert!(read.animations.is_none() && read.parts.len() == changed.parts.len(), "{i}");
    }
    // Meshes of parts that move as a whole may change.
    let mut fine = model.clone();
    for part in &mut fine.parts {
        part.mesh = part.mesh.subdivided(Subdivision::Midpoint, 1).unwrap();
    }
    let path = folder.path().join("model.glb");
    assert!(write(&path, &fine).unwrap().is_empty());
    let read = load(&path).unwrap();
    assert!(poses(&read) == poses(&model) && read.triangle_count() == 4 * model.triangle_count());
}

#[test]
fn quantised_nodes_move_alike() {
    let (file, members) = turning_cube();
    let model = file.load(&members).unwrap();
    let path = Folder::new().path().join("model.glb");
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    let (moved, lost) = write_quantised(&path, &model).unwrap();
    assert!(lost.is_empty() && moved < 2e-5, "{moved} {lost:?}");
    let read = load(&path).unwrap();
    for (found, expected) in poses(&read).iter().zip(&poses(&model)) {
        let (found, expected) = (&found.parts[0], &expected.parts[0]);
        let (mesh, still) = (&read.parts[0].mesh, &model.parts[0].mesh);
        for (p, q) in mesh.positions().iter().zip(still.positions()) {
            let (p, q) = (found.world_from_part.transform_point3(*p), expected.world_from_part.transform_point3(*q));
            // The cube is twice as large in the world, where f32 rounds it.
            assert!(f64::from(p.distance(q)) < 2.0 * moved + 1e-6);
        }
    }
}

/// A model of these members with an animation of these channels.
fn moving(file: &GltfFile, members: &str, channels: &[(usize, &str, usize, usize, &str)]) -> Model {
    file.load(&format!("{members},\"animations\":[{}]", clip(channels))).unwrap()
}

#[test]
fn morph_targets_come_back() {
    for (interpolation, values) in [("STEP", 1), ("LINEAR", 1), ("CUBICSPLINE", 3)] {
        for node in ["", ",\"weights\":[1,0.3]", ",\"weights\":[0,0]"] {
            let mut file = GltfFile::default();
            let members = morph(&mut file, node);
            let input = file.floats("SCALAR", &[0.1, 1.0 / 3.0, 1.7]);
            let numbers: Vec<f32> = (0..6 * values).map(|i| (i as f32 * 0.7).sin()).collect();
            let channels = [(0, "weights", input, file.floats("SCALAR", &numbers), interpolation)];
            check_comes_back(&moving(&file, &members, &channels));
            // Without normals, which are made anew in each pose, also of what is written.
            let bare = members.replace(",\"NORMAL\":1", "").replace(",\"NORMAL\":3", "");
            let model = moving(&file, &bare, &channels);
            assert_eq!(model.warnings.len(), 1);
            check_comes_back(&model);
        }
    }
}

/// Several primitives on several instances, whose weights one channel moves; targets without positions and without any list
/// that is read; tangents.
#[test]
fn one_channel_moves_the_weights_of_all_meshes_of_its_node() {
    let mut file = GltfFile::default();
    morph(&mut file, "");
    let places = file.floats("VEC3", &[0.5, 0., 0., 0., 1., 1.]);
    let tangents = file.floats("VEC4", &[1., 0., 0., 1.].repeat(3));
    let (input, output) = (file.floats("SCALAR", &[0., 2.]), file.floats("SCALAR", &[0.1, 0., 0., 0.7, 0.9, 1.]));
    let members = format!(
        r#""nodes":[{{"name":"row","mesh":0,"extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{"TRANSLATION":{places}}}}}}}}},
        {{"mesh":0,"translation":[0,7,0]}}],
        "meshes":[{{"primitives":[
            {{"attributes":{{"POSITION":0,"NORMAL":1,"TANGENT":{tangents}}},
            "targets":[{{"POSITION":2,"NORMAL":3}},{{"NORMAL":4}},{{"TANGENT":3,"POSITION":2}}]}},
            {{"attributes":{{"POSITION":0}},"targets":[{{"POSITION":4}},{{"COLOR_0":4}},{{"NORMAL":3,"TANGENT":3}}]}}]}}]"#
    );
    let model =
        moving(&file, &members, &[(0, "weights", input, output, "LINEAR"), (1, "weights", input, output, "STEP")]);
    assert_eq!((model.parts.len(), animations(&model).pose(0, 1.0).parts.len()), (6, 6));
    check_comes_back(&model);
}

/// Skins: with weights of any sum, in one set and in two; with morph targets; without normals; and far away.
#[test]
fn skins_come_back() {
    for upper in ["", ",\"rotation\":[0.1,0.2,0.3,0.9]"] {
        let mut file = GltfFile::default();
        let members = skin(&mut file, upper);
        let input = file.floats("SCALAR", &[0., 1.]);
        let output = file.floats("VEC4", &[0., 0., 0., 1., 0.7, 0.1, 0., 0.7]);
        let joints = file.bytes("VEC4", &[1, 0, 1, 0].repeat(6));
        let weights: Vec<f32> = (0..24).map(|i| (i as f32 * 0.7).sin().abs()).collect();
        let weights = file.floats("VEC4", &weights);
        let lifts: Vec<f32> = (0..18).map(|i| (i as f32 * 0.7).sin()).collect();
        let (lifts, zero_to_one) = (file.floats("VEC3", &lifts), file.floats("SCALAR", &[0., 1.]));
        let two_sets = format!("\"WEIGHTS_0\":4,\"JOINTS_1\":{joints},\"WEIGHTS_1\":{weights}}}");
        let morphed = format!("\"targets\":[{{\"POSITION\":{lifts}}}],\"attributes\"");
        for (from, to) in [
            ("\"WEIGHTS_0\":4}", "\"WEIGHTS_0\":4}".to_owned()),
            ("\"WEIGHTS_0\":4}", two_sets),
            ("\"attributes\"", morphed),
            (",\"NORMAL\":1", String::new()),
            ("\"children\":[2]", "\"children\":[2],\"translation\":[400000.25,5000000.5,0]".to_owned()),
            (",\"inverseBindMatrices\":5", String::new()),
        ] {
            assert!(members.contains(from));
            let mut channels = vec![(2, "rotation", input, output, "LINEAR")];
            if to.contains("targets") {
                channels.push((0, "weights", input, zero_to_one, "LINEAR"));
            }
            let model = moving(&file, &members.replace(from, &to), &channels);
            assert_eq!(to.contains("translation"), model.origin.y > 4e6, "{}", model.origin);
            check_comes_back(&model);
        }
        // A joint outside of the scene.
        let model = moving(&file, &members.replace("[0,1]", "[0]"), &[(2, "rotation", input, output, "LINEAR")]);
        check_comes_back(&model);
    }
}

#[test]
fn meshes_that_were_changed_do_not_bend() {
    let mut file = GltfFile::default();
    let members = skin(&mut file, "");
    let (input, output) = (file.floats("SCALAR", &[0., 1.]), file.floats("VEC4", &[0., 0., 0., 1., 0.7, 0., 0., 0.7]));
    let model = moving(&file, &members, &[(2, "rotation", input, output, "LINEAR")]);
    let folder = Folder::new();
    let path = folder.path().join("model.glb");
    let changes: [fn(Mesh) -> Mesh; 3] = [
        |mesh| mesh.subdivided(Subdivision::Midpoint, 1).unwrap(),
        |mesh| mesh.with_normals(Normals::Face).0,
        |mesh| mesh.with_colors(vec![Vec4::ONE; 6]).unwrap(),
    ];
    for change in changes {
        let mut changed = model.clone();
        changed.parts[0].mesh = change(changed.parts[0].mesh.clone());
        let lost = write(&path, &changed).unwrap();
        assert_eq!(lost, ["1 animations, which no longer fit the model; it is written as it stands"]);
        assert!(load(&path).unwrap().parts[0].mesh == changed.parts[0].mesh);
    }
    // As it was, with another material.
    let mut painted = model.clone();
    painted.materials = vec![SourceMaterial::Mtl(MtlMaterial::default())];
    painted.parts[0].material = Some(0);
    write(&path, &painted).unwrap();
    let read = load(&path).unwrap();
    assert!(read.parts == painted.parts && poses(&read) == poses(&model));
    // Meshes that bend are not rounded to integers.
    let (moved, lost) = write_quantised(&path, &model).unwrap();
    assert!(lost.is_empty() && moved < f64::MIN_POSITIVE, "{moved} {lost:?}");
    check_equal(&load(&path).unwrap(), &model);
}
