//! Skins, morph targets and animations of glTF, against closed forms.

use std::f32::consts::FRAC_1_SQRT_2;

use glam::{DVec3, Mat4, Quat, Vec3};
use halfway_mesh::{Animations, Model, Pose};

use crate::common::gltf_file::GltfFile;

const TRIANGLE: [f32; 9] = [0., 0., 0., 1., 0., 0., 0., 1., 0.];
const UP: [f32; 9] = [0., 0., 1., 0., 0., 1., 0., 0., 1.];

fn animations(model: &Model) -> &Animations {
    model.animations.as_deref().expect("animations")
}

fn close(a: &[Vec3], b: &[Vec3]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.distance(*b) < 1e-5)
}

/// The animations of a file: `(node, path, input, output, interpolation)` of each channel of one animation.
pub(crate) fn clip(channels: &[(usize, &str, usize, usize, &str)]) -> String {
    let each = |i: usize, (node, path, ..): &(usize, &str, usize, usize, &str)| {
        format!(r#"{{"sampler":{i},"target":{{"node":{node},"path":"{path}"}}}}"#)
    };
    let list: Vec<String> = channels.iter().enumerate().map(|(i, channel)| each(i, channel)).collect();
    let sampler = |(_, _, input, output, interpolation): &(usize, &str, usize, usize, &str)| {
        format!(r#"{{"input":{input},"output":{output},"interpolation":"{interpolation}"}}"#)
    };
    let samplers: Vec<String> = channels.iter().map(sampler).collect();
    format!(r#"{{"name":"move","channels":[{}],"samplers":[{}]}}"#, list.join(","), samplers.join(","))
}

/// A cube that turns about z by 90° a second, below a parent that goes along x; a light and a camera hang on it.
pub(crate) fn turning_cube() -> (GltfFile, String) {
    let corner = |i: usize| [i & 1, (i >> 1) & 1, i >> 2].map(|bit| bit as f32 - 0.5);
    let corners: Vec<f32> = (0..8).flat_map(corner).collect();
    let faces =
        [0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5];
    let mut file = GltfFile::default();
    file.floats("VEC3", &corners);
    file.bytes("SCALAR", &faces);
    file.floats("SCALAR", &[0., 1., 2.]);
    file.floats("VEC4", &[0., 0., 0., 1., 0., 0., FRAC_1_SQRT_2, FRAC_1_SQRT_2, 0., 0., 1., 0.]);
    file.floats("SCALAR", &[0., 2.]);
    file.floats("VEC3", &[0., 0., 0., 4., 0., 0.]);
    let clip = clip(&[(1, "rotation", 2, 3, "LINEAR"), (0, "translation", 4, 5, "LINEAR")]);
    let members = format!(
        r#""scenes":[{{"nodes":[0,2]}}],"nodes":[{{"children":[1]}},{{"mesh":0,"scale":[2,2,2],"camera":0,
        "extensions":{{"KHR_lights_punctual":{{"light":0}}}}}},{{"mesh":0,"translation":[0,9,0]}}],
        "cameras":[{{"type":"perspective","perspective":{{"yfov":1,"znear":1}}}}],
        "extensions":{{"KHR_lights_punctual":{{"lights":[{{"type":"point"}}]}}}},
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],"animations":[{clip}]"#
    );
    (file, members)
}

#[test]
fn a_cube_turns_and_goes() {
    let (file, members) = turning_cube();
    let model = file.load(&members).unwrap();
    // The pose of the file.
    assert_eq!(model.parts[0].world_from_part, Mat4::from_scale(Vec3::splat(2.0)));
    let animations = animations(&model);
    let [clip] = animations.clips() else { panic!("{:?}", animations.clips()) };
    assert_eq!((clip.name.as_str(), clip.duration), ("move", 2.0));
    for (time, place, turn) in
        [(0.0, 0.0, 0.0), (0.5, 1.0, 45.0), (1.25, 2.5, 112.5), (2.0, 4.0, 180.0), (2.5, 1.0, 45.0)]
    {
        let Pose { parts, lines, lights, cameras } = animations.pose(0, time);
        // The second cube stays.
        let [part] = &parts[..] else { panic!("{} parts", parts.len()) };
        assert_eq!((part.part, part.mesh.is_none(), lines.len()), (0, true, 0));
        let turn = Quat::from_rotation_z(f32::to_radians(turn));
        let expected = Mat4::from_scale_rotation_translation(Vec3::splat(2.0), turn, Vec3::X * place);
        assert!(part.world_from_part.abs_diff_eq(expected, 1e-6), "{time}: {}", part.world_from_part);
        assert_eq!((lights, cameras), (vec![(0, part.world_from_part)], vec![(0, part.world_from_part)]));
    }
    assert_eq!(animations.pose(1, 0.5), Pose::default());
    // Before the first key frame as at it.
    assert_eq!(animations.pose(0, -3.0), animations.pose(0, 0.0));
}

#[test]
fn a_moving_model_far_away_keeps_its_place() {
    let (file, members) = turning_cube();
    let second = "{\"mesh\":0,\"translation\":[0,9,0]}";
    assert!(members.contains(second));
    let above = "{\"children\":[0],\"translation\":[400000.25,5000000.5,0]}";
    let far = members.replace(second, above).replace("[0,2]", "[2]");
    let model = file.load(&far).unwrap();
    let origin = model.origin;
    assert!((origin - DVec3::new(400_000.25, 5_000_000.5, 0.0)).abs().max_element() < 2.0, "{origin}");
    let pose = animations(&model).pose(0, 1.0);
    let place = pose.parts[0].world_from_part.w_axis.truncate().as_dvec3() + origin;
    assert_eq!(place, DVec3::new(400_002.25, 5_000_000.5, 0.0));
}

/// A strip of two squares from y = 0 to 2, whose lower end hangs on one joint and whose upper end on another, at y = 1.
pub(crate) fn skin(file: &mut GltfFile, upper: &str) -> String {
    file.floats("VEC3", &[0., 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0., 0., 2., 0., 1., 2., 0.]);
    file.floats("VEC3", &[0., 0., 1.].repeat(6));
    file.bytes("SCALAR", &[0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4]);
    file.bytes("VEC4", &[0, 1, 0, 0].repeat(6));
    let weights = [[1., 0.], [1., 0.], [1., 1.], [1., 1.], [0., 1.], [0., 1.]];
    file.floats("VEC4", &weights.iter().flat_map(|[a, b]| [*a, *b, 0., 0.]).collect::<Vec<_>>());
    let mut bind = Mat4::IDENTITY.to_cols_array().to_vec();
    bind.extend(Mat4::from_translation(Vec3::NEG_Y).to_cols_array());
    file.floats("MAT4", &bind);
    // The place of the skinned node itself does not count.
    format!(
        r#""scenes":[{{"nodes":[0,1]}}],"nodes":[{{"mesh":0,"skin":0,"translation":[50,60,70]}},{{"children":[2]}},{{"translation":[0,1,0]{upper}}}],
        "skins":[{{"joints":[1,2],"inverseBindMatrices":5}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"JOINTS_0":3,"WEIGHTS_0":4}},"indices":2}}]}}]"#
    )
}

/// The strip under a turn of its upper joint about z: by formula.
fn bent(turn: Quat) -> [Vec3; 6] {
    let upper = |p: Vec3| turn * (p - Vec3::Y) + Vec3::Y;
    let half = |p: Vec3| (p + upper(p)) / 2.0;
    let [a, b, c] = [Vec3::ZERO, Vec3::Y, Vec3::Y * 2.0].map(|p| [p, p + Vec3::X]);
    [a[0], a[1], half(b[0]), half(b[1]), upper(c[0]), upper(c[1])]
}

#[test]
fn a_skin_bends_in_the_pose_of_the_file_and_in_time() {
    let mut file = GltfFile::default();
    let quarter = format!(",\"rotation\":[0,0,{FRAC_1_SQRT_2},{FRAC_1_SQRT_2}]");
    let still = skin(&mut file, &quarter);
    let model = file.load(&still).unwrap();
    assert_eq!((model.warnings.len(), model.animations.is_none()), (0, true), "{:?}", model.warnings);
    let [part] = &model.parts[..] else { panic!("{} parts", model.parts.len()) };
    assert_eq!(part.world_from_part, Mat4::IDENTITY);
    let expected = bent(Quat::from_rotation_z(std::f32::consts::FRAC_PI_2));
    assert!(close(part.mesh.positions(), &expected), "{:?}", part.mesh.positions());
    assert!(close(part.mesh.normals(), &[Vec3::Z; 6]));

    // About x, so that normals turn: those of the upper end, and by half the one between.
    let mut file = GltfFile::default();
    let members = skin(&mut file, "");
    let input = file.floats("SCALAR", &[0., 1.]);
    let output = file.floats("VEC4", &[0., 0., 0., 1., FRAC_1_SQRT_2, 0., 0., FRAC_1_SQRT_2]);
    let clip = clip(&[(2, "rotation", input, output, "LINEAR")]);
    let model = file.load(&format!("{members},\"animations\":[{clip}]")).unwrap();
    assert!(close(model.parts[0].mesh.positions(), &bent(Quat::IDENTITY)));
    for time in [0.0, 0.25, 0.5, 1.0] {
        let pose = animations(&model).pose(0, time);
        let mesh = pose.parts[0].mesh.as_ref().expect("a moved mesh");
        assert!(mesh.shares_triangles(&model.parts[0].mesh));
        let turn = Quat::from_rotation_x(time as f32 * std::f32::consts::FRAC_PI_2);
        assert!(close(mesh.positions(), &bent(turn)), "{time}: {:?}", mesh.positions());
        assert!(mesh.normals()[5].distance(turn * Vec3::Z) < 1e-5, "{time}");
        assert!(mesh.normals()[0].distance(Vec3::Z) < 1e-5, "{time}");
    }
}

#[test]
fn skins_need_their_joints() {
    let mut file = GltfFile::default();
    let members = skin(&mut file, "");
    for (from, to, expected) in [
        (
            "\"joints\":[1,2]",
            "\"joints\":[1]",
            "nodes[0].mesh: joint 1; one of the 1 joints of skins[0], from 0, is expected",
        ),
        (
            "\"joints\":[1,2]",
            "\"joints\":[1,2,0]",
            "skins[0]: 2 inverse bind matrices; one for each of the 3 joints is expected",
        ),
        ("\"JOINTS_0\":3", "\"JOINTS_0\":4", "accessors[4]: Vec4 of F32; Vec4 of one of [U8, U16] is expected"),
        ("\"joints\":[1,2]", "\"joints\":[1,7]", "skins[0].joints[1]: index out of bounds"),
        (
            "\"inverseBindMatrices\":5",
            "\"inverseBindMatrices\":4",
            "accessors[4]: Vec4 of F32; Mat4 of one of [F32] is expected",
        ),
    ] {
        assert!(members.contains(from));
        let error = file.load(&members.replace(from, to)).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    // Joints that are below themselves, outside of the scene.
    let looped = members.replace("{\"children\":[2]}", "{\"children\":[2]},{\"children\":[3]}");
    let looped = looped.replace("\"joints\":[1,2]", "\"joints\":[1,2,2]");
    assert!(file.load(&looped.replace("[0,1]", "[0]")).is_err());

    let model = file.load(&members.replace("\"WEIGHTS_0\":4", "\"_OTHER\":4")).unwrap();
    assert_eq!(model.parts[0].world_from_part.w_axis.truncate(), Vec3::new(50.0, 60.0, 70.0));
    assert_eq!(model.warnings, ["1 meshes of nodes with a skin have no joints or no weights, and stay as they are"]);
}

/// A triangle with two morph targets: one lifts its third corner by z = 2, the other moves all along x.
pub(crate) fn morph(file: &mut GltfFile, node: &str) -> String {
    file.floats("VEC3", &TRIANGLE);
    file.floats("VEC3", &UP);
    file.floats("VEC3", &[0., 0., 0., 0., 0., 0., 0., 0., 2.]);
    file.floats("VEC3", &[0., 0., 0., 0., 0., 0., 0., -1., 0.]);
    file.floats("VEC3", &[1., 0., 0., 1., 0., 0., 1., 0., 0.]);
    format!(
        r#""nodes":[{{"mesh":0{node}}}],"meshes":[{{"weights":[0.5,0],"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1}},
        "targets":[{{"POSITION":2,"NORMAL":3}},{{"POSITION":4}}]}}]}}]"#
    )
}

fn lifted([first, second]: [f32; 2]) -> [Vec3; 3] {
    let by = Vec3::X * second;
    [by, Vec3::X + by, Vec3::Y + Vec3::Z * 2.0 * first + by]
}

#[test]
fn morph_targets_move_by_their_weights() {
    for (node, weights) in
        [("", [0.5, 0.0]), (",\"weights\":[1,0.25]", [1.0, 0.25]), (",\"weights\":[0,0]", [0.0, 0.0])]
    {
        let mut file = GltfFile::default();
        let members = morph(&mut file, node);
        let model = file.load(&members).unwrap();
        assert!(model.warnings.is_empty(), "{:?}", model.warnings);
        let mesh = &model.parts[0].mesh;
        assert!(close(mesh.positions(), &lifted(weights)), "{:?}", mesh.positions());
        assert!(mesh.normals()[2].distance(Vec3::new(0.0, -weights[0], 1.0).normalize()) < 1e-6);
    }
    // Without normals in the file they are made of the moved triangles.
    let mut file = GltfFile::default();
    let bare = morph(&mut file, ",\"weights\":[1,0]").replace(",\"NORMAL\":1", "").replace(",\"NORMAL\":3", "");
    let mesh = &file.load(&bare).unwrap().parts[0].mesh;
    assert!(close(mesh.normals(), &[Vec3::new(0.0, -2.0, 1.0).normalize(); 3]), "{:?}", mesh.normals());
    assert!(!mesh.has_given_normals());
}

#[test]
fn weights_move_in_time_by_all_interpolations() {
    for (interpolation, values, at_half) in [
        ("STEP", vec![0., 0., 1., 4.], [0.0, 0.0]),
        ("LINEAR", vec![0., 0., 1., 4.], [0.25, 1.0]),
        // Tangents of 0 but the first key frame's last one: 3t² − 2t³, and 2·(t³ − 2t² + t) more of the second.
        ("CUBICSPLINE", vec![9., 9., 0., 0., 0., 1., 0., 0., 1., 4., 9., 9.], [0.15625, 0.90625]),
    ] {
        let mut file = GltfFile::default();
        let members = morph(&mut file, "");
        let (input, output) = (file.floats("SCALAR", &[0., 2.]), file.floats("SCALAR", &values));
        let clip = clip(&[(0, "weights", input, output, interpolation)]);
        let model = file.load(&format!("{members},\"animations\":[{clip}]")).unwrap();
        let pose = animations(&model).pose(0, 0.5);
        let mesh = pose.parts[0].mesh.as_ref().expect("a moved mesh");
        assert!(close(mesh.positions(), &lifted(at_half)), "{interpolation}: {:?}", mesh.positions());
    }
}

#[test]
fn faults_of_animations_are_refused_by_element() {
    let (file, members) = turning_cube();
    for (from, to, expected) in [
        (
            "\"node\":1",
            "\"node\":8",
            "animations[0].channels[0].target.node: 8; one of the 3 nodes, from 0, is expected",
        ),
        ("\"input\":2", "\"input\":5", "accessors[5]: Vec3 of F32; Scalar of one of [F32] is expected"),
        ("\"input\":2", "\"input\":4", "accessors[3]: 3 values for 2 key frames; one for each is expected"),
        ("\"input\":2", "\"input\":77", "animations[0].samplers[0].input: index out of bounds"),
        (
            "\"output\":3,\"interpolation\":\"LINEAR\"",
            "\"output\":3,\"interpolation\":\"CUBICSPLINE\"",
            "accessors[3]: 3 values for 3 key frames; three for each are expected",
        ),
        ("\"LINEAR\"}", "\"ROUND\"}", "animations[0].samplers[0].interpolation: invalid value"),
        ("{\"sampler\":0", "{\"sampler\":5", "animations[0].channels[0].sampler: index out of bounds"),
    ] {
        assert!(members.contains(from), "{from}");
        let error = file.load(&members.replacen(from, to, 1)).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    let mut file = GltfFile::default();
    let members = morph(&mut file, "");
    let (input, output) = (file.floats("SCALAR", &[1., 1.]), file.floats("SCALAR", &[0., 1., 0., 1.]));
    let clip = clip(&[(0, "weights", input, output, "LINEAR")]);
    let error = file.load(&format!("{members},\"animations\":[{clip}]")).unwrap_err().to_string();
    assert!(error.contains("accessors[5]: time 1 after 1; times that grow are expected"), "{error}");
    let short = members.replace("\"POSITION\":4", "\"POSITION\":5");
    let mut file = GltfFile::default();
    morph(&mut file, "");
    file.floats("VEC3", &[0.; 6]);
    let error = file.load(&short).unwrap_err().to_string();
    assert!(error.contains("meshes[0].primitives[0].targets[1]: 2 positions for 3 vertices"), "{error}");
}

#[test]
fn what_cannot_be_moved_is_said() {
    let mut file = GltfFile::default();
    let members = morph(&mut file, "").replace("{\"POSITION\":4}", "{\"POSITION\":4,\"COLOR_0\":4}");
    let model = file.load(&members).unwrap();
    assert_eq!(
        model.warnings,
        ["1 primitives have morph targets of colours or texture coordinates, which are skipped"]
    );
    let lines = members.replace("\"attributes\"", "\"mode\":3,\"attributes\"").replace(",\"COLOR_0\":4", "");
    let model = file.load(&lines).unwrap();
    assert_eq!(model.warnings, ["the morph targets and joints of 1 primitives of lines or points are skipped"]);
}
