//! Scenes put into a world: components, hierarchy, frames.

use std::path::Path;

use bevy_app::App;
use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use bevy_math::{Mat4, Vec3};
use bevy_transform::TransformPlugin;
use bevy_transform::components::{GlobalTransform, Transform};
use halfway_asset::Assets;
use halfway_lighting::{
    AlphaMode, BackMaterial, Cone, DirectionalLight, Faces, Frequency, GlobalAmbient, LightRig, Material, PointLight,
    Reflectance, Shading, SpotLight, Terms, Viewer, light_direction,
};
use halfway_lighting::{Camera, Encoding, Intensity, Projection, Samples, VertexColors};
use halfway_mesh::{Mesh, Mesh3d, MeshPlugin};

use halfway_scene::{SceneError, SceneFile, Spawned, spawn};

/// The needs of a scene in an app: meshes and transforms. No GPU, no window.
pub(super) fn app() -> App {
    let mut app = App::new();
    app.add_plugins((MeshPlugin, TransformPlugin));
    app
}

/// Spawns the scene of a text, with paths from the root of the project, and lets transforms propagate.
fn spawned(text: &str) -> (App, Spawned) {
    let scene = SceneFile::from_json(text, "test").unwrap();
    let mut app = app();
    let root = &Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let spawned = spawn(&scene, root, app.world_mut()).unwrap();
    app.update();
    (app, spawned)
}

fn get<T: Component + Clone>(app: &App, entity: Entity) -> Option<T> {
    app.world().get::<T>(entity).cloned()
}

fn global(app: &App, entity: Entity) -> Mat4 {
    get::<GlobalTransform>(app, entity).unwrap().to_matrix()
}

fn direction(app: &App, entity: Entity) -> Vec3 {
    light_direction(&get(app, entity).unwrap()).unwrap()
}

fn name(app: &App, entity: Entity) -> String {
    get::<Name>(app, entity).unwrap().to_string()
}

/// A unit vector that went through a few f32 rotations.
fn assert_close(a: Vec3, b: Vec3) {
    assert!((a - b).length() < 1e-6 * b.length().max(1.0), "{a} is not {b}");
}

#[test]
fn the_camera_carries_the_view() {
    let (app, spawned) = spawned(
        r#"{"background": [0.1, 0.2, 0.3], "output": "raw", "samples": 4, "ambient": [0.4, 0.5, 0.6],
            "viewer": "infinite", "shading": "flat", "reflectance": "phong",
            "camera": {"position": [3, 1, 0], "target": [0, 1, 0], "fov_y_deg": 90, "near": 0.5}}"#,
    );
    let camera: Camera = get(&app, spawned.camera).unwrap();
    assert_eq!(camera.background, LinearRgba::rgb(0.1, 0.2, 0.3));
    assert_eq!((camera.samples, camera.encoding, camera.viewer), (Samples::Four, Encoding::Raw, Viewer::Infinite));
    assert_eq!(camera.projection, Projection::perspective(std::f32::consts::FRAC_PI_2).with_near(0.5));
    assert_eq!(get::<Shading>(&app, spawned.camera), Some(Shading::Flat));
    assert_eq!(get::<Reflectance>(&app, spawned.camera), Some(Reflectance::Phong));
    assert_eq!(app.world().resource::<GlobalAmbient>().0, LinearRgba::rgb(0.4, 0.5, 0.6));
    let world_from_eye = global(&app, spawned.camera);
    assert_close(world_from_eye.transform_vector3(Vec3::NEG_Z), Vec3::NEG_X);
    assert_close(world_from_eye.transform_vector3(Vec3::Y), Vec3::Y);
    assert_eq!(world_from_eye.w_axis.truncate(), Vec3::new(3.0, 1.0, 0.0));
}

#[test]
fn the_camera_carries_the_intensity_policy() {
    for (given, expected) in [
        ("\"clamp\"", Intensity::Clamp),
        ("\"renormalise\"", Intensity::Renormalize { smoothing: 0.0 }),
        ("{\"renormalise\": {}}", Intensity::Renormalize { smoothing: 0.0 }),
        ("{\"renormalise\": {\"smoothing\": 0.75}}", Intensity::Renormalize { smoothing: 0.75 }),
        ("\"reinhard\"", Intensity::Reinhard { white: 4.0 }),
        ("{\"reinhard\": {}}", Intensity::Reinhard { white: 4.0 }),
        ("{\"reinhard\": {\"white\": 2.5}}", Intensity::Reinhard { white: 2.5 }),
        ("\"aces\"", Intensity::Aces),
    ] {
        let text = format!("{{\"intensity\": {given}}}");
        let (app, camera) = spawned(&text);
        assert_eq!(get::<Camera>(&app, camera.camera).unwrap().intensity, expected, "{text}");
        let scene = SceneFile::from_json(&text, "test").unwrap();
        let again = SceneFile::from_json(&scene.to_json().unwrap(), "written").unwrap();
        assert_eq!(again, scene, "{text}");
    }
}

#[test]
fn objects_carry_their_appearance() {
    let (app, spawned) = spawned(
        r#"{"objects": [
            {"name": "plain", "mesh": {"box": {}}},
            {"mesh": {"box": {}}, "material": "brass", "back_material": {"diffuse": [1, 0, 0]}, "faces": "both",
             "shading": "gouraud", "reflectance": "blinn_phong_matched", "blend": true,
             "transform": {"translation": [1, 2, 3], "scale": [-1, 1, 1]}},
            {"mesh": {"box": {}}, "normals": "uniform"}
        ]}"#,
    );
    let [plain, rich, weighted] = spawned.objects[..] else { panic!("three objects") };
    assert_eq!(name(&app, plain), "plain");
    assert_eq!(get::<Material>(&app, plain), Some(Material::default()));
    assert_eq!(get::<Faces>(&app, plain), Some(Faces::Front));
    assert!(get::<Shading>(&app, plain).is_none() && get::<Reflectance>(&app, plain).is_none());
    assert!(get::<BackMaterial>(&app, plain).is_none() && get::<AlphaMode>(&app, plain).is_none());

    assert_eq!(name(&app, rich), "objects[1]");
    assert_eq!(get::<Material>(&app, rich), Some(Material::BRASS));
    assert_eq!(get::<BackMaterial>(&app, rich).unwrap().0.diffuse, LinearRgba::rgb(1.0, 0.0, 0.0));
    assert_eq!(get::<Faces>(&app, rich), Some(Faces::Both));
    assert_eq!(get::<Shading>(&app, rich), Some(Shading::Gouraud));
    assert_eq!(get::<Reflectance>(&app, rich), Some(Reflectance::BlinnPhongMatched));
    assert!(get::<AlphaMode>(&app, rich) == Some(AlphaMode::Blend));
    let transform: Transform = get(&app, rich).unwrap();
    assert_eq!(transform, Transform::from_xyz(1.0, 2.0, 3.0).with_scale(Vec3::new(-1.0, 1.0, 1.0)));

    let meshes = app.world().resource::<Assets<Mesh>>();
    let handles = [plain, rich, weighted].map(|object| get::<Mesh3d>(&app, object).unwrap().0);
    assert_eq!(handles[0], handles[1], "equal shapes share their mesh");
    assert_ne!(handles[0], handles[2], "but not with other normals");
    assert_eq!(meshes.len(), 2);
}

#[test]
fn a_sheared_matrix_reaches_the_object_unchanged() {
    let columns = [1.0, 0.25, 0.0, 0.0, -2.0, 1.0, 0.5, 0.0, 0.1, 0.2, -0.3, 0.0, 4.0, 5.0, 6.0, 1.0];
    let (app, spawned) = spawned(&format!(
        r#"{{"objects": [{{"name": "leaning", "mesh": {{"box": {{}}}}, "transform": {{"matrix": {columns:?}}}}}],
             "lights": [{{"kind": "point", "position": [1, 1, 1], "attach": {{"object": "leaning"}}}}]}}"#
    ));
    let object = spawned.objects[0];
    assert_eq!(name(&app, object), "leaning");
    assert!(get::<Mesh3d>(&app, object).is_some());
    assert!(get::<ChildOf>(&app, object).is_some(), "a single Transform cannot shear");
    let (found, expected) = (global(&app, object), Mat4::from_cols_array(&columns));
    for (a, b) in found.to_cols_array().into_iter().zip(columns) {
        // Two rotations and their product in f32: rounding steps of the largest axis, which is 2.3.
        assert!((a - b).abs() < 4e-6, "{found} is not {expected}");
    }
    // A light attached to it is in the sheared frame.
    let light = global(&app, spawned.lights[0]).w_axis.truncate();
    assert_close(light, expected.transform_point3(Vec3::ONE));
}

#[test]
fn lights_have_the_files_values() {
    let (app, spawned) = spawned(
        r#"{"lights": [
            {"kind": "point", "position": [1, 2, 3], "ambient": [0.1, 0, 0], "diffuse": [0, 0.5, 0],
             "specular": [0, 0, 2], "attenuation": [0, 0, 1], "range": 9, "attenuate_ambient": true},
            {"kind": "spot", "position": [0, 5, 0], "direction": [0, 0, 2], "cutoff_deg": 60, "inner_deg": 30,
             "exponent": 3},
            {"kind": "directional", "direction": [5, 0, 0]},
            {"kind": "homogeneous", "position": [2, 4, 6, 2]},
            {"kind": "homogeneous", "position": [2, 4, 6, -2], "cutoff_deg": 45, "direction": [1, 0, 0]},
            {"kind": "homogeneous", "position": [0, 3, 0, 0]}
        ]}"#,
    );
    let at = |i: usize| spawned.lights[i];
    let point: PointLight = get(&app, at(0)).unwrap();
    assert_eq!(point.ambient, LinearRgba::rgb(0.1, 0.0, 0.0));
    assert_eq!(point.diffuse, LinearRgba::rgb(0.0, 0.5, 0.0));
    assert_eq!(point.specular, LinearRgba::rgb(0.0, 0.0, 2.0));
    assert_eq!((point.attenuation.constant, point.attenuation.quadratic), (0.0, 1.0));
    assert_eq!((point.range, point.attenuate_ambient), (Some(9.0), true));
    assert_eq!(get::<Transform>(&app, at(0)).unwrap().translation, Vec3::new(1.0, 2.0, 3.0));

    let spot: SpotLight = get(&app, at(1)).unwrap();
    let cone = Cone { cutoff: 60_f32.to_radians(), inner: Some(30_f32.to_radians()), exponent: 3.0 };
    assert_eq!(spot, SpotLight { light: PointLight::white(), cone });
    assert_close(direction(&app, at(1)), Vec3::Z);

    assert_eq!(get::<DirectionalLight>(&app, at(2)), Some(DirectionalLight::new(LinearRgba::WHITE)));
    assert_close(direction(&app, at(2)), Vec3::X);

    // w ≠ 0 is a point at xyz/w, with a cone only where one is given; w = 0 shines away from the direction.
    assert_eq!(get::<PointLight>(&app, at(3)), Some(PointLight::white()));
    assert_eq!(global(&app, at(3)).w_axis.truncate(), Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(get::<SpotLight>(&app, at(4)).unwrap().cone, Cone::new(45_f32.to_radians()));
    assert_eq!(global(&app, at(4)).w_axis.truncate(), Vec3::new(-1.0, -2.0, -3.0));
    assert_close(direction(&app, at(4)), Vec3::X);
    assert_eq!(get::<DirectionalLight>(&app, at(5)), Some(DirectionalLight::new(LinearRgba::WHITE)));
    assert_close(direction(&app, at(5)), Vec3::NEG_Y);
}

#[test]
fn a_cone_on_a_light_at_infinity_is_one_factor() {
    // The rays travel along −Y; the cone's axis is 60° away from them.
    let axis = format!("[{}, -0.5, 0]", 0.75_f32.sqrt());
    let diffuse = |keys: &str| {
        let (app, spawned) = spawned(&format!(
            r#"{{"lights": [{{"kind": "homogeneous", "position": [0, 1, 0, 0], "ambient": [1, 1, 1],
                 "direction": {axis}, {keys}}}]}}"#
        ));
        let light: DirectionalLight = get(&app, spawned.lights[0]).unwrap();
        assert_eq!(light.diffuse, light.specular);
        (light.diffuse.red, light.ambient.red)
    };
    assert_eq!(diffuse(r#""cutoff_deg": 59"#), (0.0, 1.0));
    assert_eq!(diffuse(r#""cutoff_deg": 59, "attenuate_ambient": true"#), (0.0, 0.0));
    assert_eq!(diffuse(r#""cutoff_deg": 61"#), (1.0, 1.0));
    assert_eq!(diffuse(r#""cutoff_deg": 180, "exponent": 2"#), (1.0, 1.0));
    let (factor, _) = diffuse(r#""cutoff_deg": 90, "exponent": 2"#);
    // cos² 60° = 1/4, in f32 directions.
    assert!((factor - 0.25).abs() < 1e-6, "{factor}");
}

#[test]
fn lights_move_with_their_parents() {
    let (mut app, spawned) = spawned(
        r#"{"camera": {"position": [0, 0, 5]},
            "objects": [{"name": "cart", "mesh": {"box": {}}, "transform": {"translation": [10, 0, 0]}}],
            "lights": [
                {"kind": "point", "position": [0, 1, 0], "attach": {"object": "cart"}},
                {"kind": "directional", "direction": [0, 0, -1], "attach": "camera"},
                {"kind": "point", "position": [0, 1, 0]}
            ]}"#,
    );
    let [on_cart, on_camera, fixed] = spawned.lights[..] else { panic!("three lights") };
    assert_eq!(get::<ChildOf>(&app, on_cart).map(|c| c.parent()), Some(spawned.objects[0]));
    assert_eq!(get::<ChildOf>(&app, on_camera).map(|c| c.parent()), Some(spawned.camera));
    assert!(get::<ChildOf>(&app, fixed).is_none());
    assert_eq!(global(&app, on_cart).w_axis.truncate(), Vec3::new(10.0, 1.0, 0.0));

    *app.world_mut().get_mut::<Transform>(spawned.objects[0]).unwrap() = Transform::from_xyz(0.0, 0.0, -3.0);
    *app.world_mut().get_mut::<Transform>(spawned.camera).unwrap() =
        Transform::from_xyz(5.0, 0.0, 0.0).looking_at(Vec3::ZERO, Vec3::Y);
    app.update();
    assert_eq!(global(&app, on_cart).w_axis.truncate(), Vec3::new(0.0, 1.0, -3.0));
    assert_close(direction(&app, on_camera), Vec3::NEG_X);
    assert_eq!(global(&app, fixed).w_axis.truncate(), Vec3::Y);
}

#[test]
fn a_scene_without_camera_and_lights_gets_them() {
    let (app, spawned) = spawned(
        r#"{"size": [300, 100], "objects": [
            {"mesh": {"box": {}}, "transform": {"translation": [100, 50, 0], "scale": [2, 2, 2]}}]}"#,
    );
    // The box reaches from (99, 49, −1) to (101, 51, 1); the picture's half height is tan 22.5° of the depth.
    let eye_from_world = global(&app, spawned.camera).inverse();
    let heights = (0..8).map(|i| {
        let corner =
            Vec3::new(99.0, 49.0, -1.0) + 2.0 * Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
        let p = eye_from_world.transform_point3(corner);
        assert!(p.z < 0.0 && p.x.abs() < -p.z * 3.0 * 22.5_f32.to_radians().tan(), "{corner} at {p}");
        p.y / (-p.z * 22.5_f32.to_radians().tan())
    });
    let (low, high) = heights.fold((f32::MAX, f32::MIN), |(low, high), y| (low.min(y), high.max(y)));
    assert!(low > -1.0 && high < 1.0 && high - low > 1.7, "{low} to {high} of −1 to 1");
    assert_eq!(spawned.lights.len(), 3);
    let on_camera =
        spawned.lights.iter().filter(|&&l| get::<ChildOf>(&app, l).is_some_and(|c| c.parent() == spawned.camera));
    assert_eq!(on_camera.count(), 1, "the headlight");
}

#[test]
fn an_empty_list_of_lights_is_darkness() {
    let (_, spawned) = spawned(r#"{"lights": [], "objects": [{"mesh": {"path": "assets/lantern.glb"}}]}"#);
    assert!(spawned.lights.is_empty());
}

#[test]
fn a_model_brings_parts_materials_and_lights() {
    let (app, spawned) = spawned(r#"{"objects": [{"name": "lantern", "mesh": {"path": "assets/lantern.glb"}}]}"#);
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/lantern.glb");
    let model = halfway_mesh::load(&file).unwrap();
    assert!(model.parts.len() > 1 && !model.lights.is_empty(), "the test needs parts and lights");

    let object = spawned.objects[0];
    assert!(get::<Mesh3d>(&app, object).is_none(), "parts are children");
    let children: Vec<Entity> = app.world().get::<Children>(object).unwrap().iter().collect();
    let parts = children.iter().filter(|&&child| get::<Mesh3d>(&app, child).is_some());
    assert_eq!(parts.count(), model.parts.len());
    let bars = children.iter().filter(|&&child| name(&app, child) == "bar");
    let bars: Vec<_> = bars.map(|&bar| get::<Mesh3d>(&app, bar).unwrap()).collect();
    assert!(bars.len() == 6 && bars.iter().all(|bar| *bar == bars[0]), "one mesh of the file is one mesh here");
    assert_eq!(spawned.lights.len(), model.lights.len());
    for (&light, source) in spawned.lights.iter().zip(&model.lights) {
        assert_eq!(get::<ChildOf>(&app, light).map(|c| c.parent()), Some(object));
        assert_close(global(&app, light).w_axis.truncate(), source.world_from_light.w_axis.truncate());
    }
    let own: Vec<Material> = children.iter().filter_map(|&child| get(&app, child)).collect();
    assert!(own.iter().any(|material| *material != Material::default()), "the model's own materials");
    let glass = children.iter().find(|&&child| name(&app, child) == "glass").unwrap();
    assert!(
        get::<AlphaMode>(&app, *glass) == Some(AlphaMode::Blend) && get::<Faces>(&app, *glass) == Some(Faces::Both)
    );
}

#[test]
fn a_material_of_the_scene_wins_over_the_models() {
    let (app, spawned) =
        spawned(r#"{"objects": [{"mesh": {"path": "assets/lantern.glb"}, "material": "jade", "faces": "front"}]}"#);
    let children = app.world().get::<Children>(spawned.objects[0]).unwrap();
    for child in children.iter().filter(|&child| get::<Mesh3d>(&app, child).is_some()) {
        assert_eq!(get::<Material>(&app, child), Some(Material::JADE));
        assert_eq!(get::<Faces>(&app, child), Some(Faces::Front));
        assert!(get::<AlphaMode>(&app, child).is_none());
    }
}

#[test]
fn an_invalid_scene_leaves_the_world_unchanged() {
    let scene = SceneFile::from_json(
        r#"{"objects": [{"mesh": {"box": {}}}, {"mesh": {"path": "missing/model.obj"}}]}"#,
        "test",
    )
    .unwrap();
    let mut app = app();
    let before = app.world().entities().len();
    let error = spawn(&scene, Path::new("/base"), app.world_mut()).unwrap_err();
    assert_eq!(error.key(), Some("objects[1].mesh.path"));
    assert!(error.to_string().contains("/base/missing/model.obj"), "{error}");
    assert_eq!(app.world().entities().len(), before);
    assert!(!app.world().contains_resource::<GlobalAmbient>());

    let error = spawn(&SceneFile::default(), Path::new(""), &mut World::new()).unwrap_err();
    assert!(matches!(error, SceneError::NoMeshAssets));
}

/// The camera of a scene of one plane, 2 wide, upright and facing +Z, in a picture of 2 : 1.
fn camera_of(camera: &str) -> (Camera, Transform) {
    let plane = r#"{"mesh": {"plane": {}}, "transform": {"rotation_deg": [90, 0, 0]}}"#;
    let plane = plane.replace(r#""rotation_deg": [90, 0, 0]"#, r#""rotation": [0.70710678, 0, 0, 0.70710678]"#);
    let (app, spawned) = spawned(&format!(r#"{{"size": [64, 32], "camera": {camera}, "objects": [{plane}]}}"#));
    (get(&app, spawned.camera).unwrap(), get(&app, spawned.camera).unwrap())
}

#[test]
fn views_take_the_place_of_position_and_target() {
    let (camera, front) = camera_of(r#"{"view": "front", "fov_y_deg": 90}"#);
    // At nine tenths of the picture's height, with a tangent of 1.
    assert!(front.translation.distance(Vec3::new(0.0, 0.0, 1.0 / 0.9)) < 1e-5, "{front:?}");
    assert!(camera.projection.near() < 1.0 / 0.9 && camera.projection.near() > 0.0);
    let (_, angles) = camera_of(r#"{"view": {"azimuth_deg": 0, "elevation_deg": 0}, "fov_y_deg": 90}"#);
    assert_eq!(front, angles);
    let (_, from_above) = camera_of(r#"{"view": "front", "up": [0, 0, 1]}"#);
    assert!((*from_above.forward() - Vec3::Y).length() < 1e-6 && (*from_above.up() - Vec3::Z).length() < 1e-6);
    // `fit` alone keeps the direction.
    let (_, fitted) = camera_of(r#"{"position": [0, 0, 50], "fit": 0.5, "fov_y_deg": 90}"#);
    assert!(fitted.translation.distance(Vec3::new(0.0, 0.0, 2.0)) < 1e-5, "{fitted:?}");
    let (zoomed, place) = camera_of(r#"{"position": [0, 0, 5], "zoom": 2, "fov_y_deg": 90}"#);
    let height: f32 = zoomed.projection.height_at(1.0);
    assert!((height - 1.0).abs() < 1e-6 && place.translation == Vec3::new(0.0, 0.0, 5.0), "{height}");
}

#[test]
fn loaded_models_show_both_sides_of_open_surfaces() {
    use halfway_mesh::{Format, Normals, load_bytes};
    use halfway_scene::{LoadedModel, MeshEntry, ObjectEntry};

    let open = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let closed = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    for (text, faces, corners) in [(open, Faces::Both, 3), (closed, Faces::Front, 12)] {
        let model = load_bytes(Format::Obj, text.as_bytes()).unwrap().into();
        let model = LoadedModel { path: "a.obj".into(), model, material: Material::BRASS };
        let object = ObjectEntry { normals: Normals::Auto, ..ObjectEntry::new(MeshEntry::Model(model)) };
        let scene = SceneFile { objects: vec![object], ..SceneFile::default() };
        let mut app = app();
        let spawned = spawn(&scene, Path::new(""), app.world_mut()).unwrap();
        let object = spawned.objects[0];
        assert_eq!(get::<Faces>(&app, object), Some(faces));
        assert_eq!(get::<Material>(&app, object), Some(Material::BRASS));
        let mesh = get::<Mesh3d>(&app, object).unwrap();
        let mesh = app.world().resource::<Assets<Mesh>>().get(&mesh.0).unwrap();
        assert_eq!(mesh.positions().len(), corners, "a tetrahedron is creased");
    }
}

#[test]
fn loaded_models_show_the_colours_of_their_vertices_as_they_are() {
    use halfway_mesh::{Format, load_bytes};
    use halfway_scene::options::{finish, unknown_material};
    use halfway_scene::{LoadedModel, MeshEntry, ObjectEntry};

    let colored = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n";
    let white = finish(LinearRgba::WHITE);
    for (given, colors, expected) in [
        (unknown_material(), VertexColors::Multiply, white),
        (unknown_material(), VertexColors::Ignore, unknown_material()),
        (Material::BRASS, VertexColors::Multiply, Material::BRASS),
    ] {
        let model = load_bytes(Format::Obj, colored.as_bytes()).unwrap().into();
        let model = LoadedModel { path: "a.obj".into(), model, material: given };
        let object = ObjectEntry { vertex_colors: colors, ..ObjectEntry::new(MeshEntry::Model(model)) };
        let scene = SceneFile { objects: vec![object], ..SceneFile::default() };
        let mut app = app();
        let spawned = spawn(&scene, Path::new(""), app.world_mut()).unwrap();
        assert_eq!(get::<Material>(&app, spawned.objects[0]), Some(expected));
    }
}

#[test]
fn rigs_follow_the_camera_and_terms_are_shaded_apart() {
    let text = r#"{"lights": "three_point", "shading": {"terms": {"diffuse": "vertex"}}, "objects": [
        {"mesh": {"box": {}}, "shading": {"terms": {"diffuse": "never", "specular": "triangle"}}},
        {"mesh": {"box": {}}, "shading": "unlit"}]}"#;
    let (app, scene) = spawned(text);
    assert_eq!(scene.lights.len(), LightRig::ThreePoint.lights().len());
    assert!(scene.lights.iter().all(|&l| get::<ChildOf>(&app, l).is_some_and(|c| c.parent() == scene.camera)));
    let terms = |diffuse, specular| Some(Shading::Terms(Terms { diffuse, specular }));
    assert_eq!(get(&app, scene.camera), terms(Frequency::Vertex, Frequency::Fragment));
    assert_eq!(get(&app, scene.objects[0]), terms(Frequency::Never, Frequency::Triangle));
    assert_eq!(get(&app, scene.objects[1]), Some(Shading::Unlit));
    let scene = SceneFile::from_json(text, "test").unwrap();
    assert_eq!(SceneFile::from_json(&scene.to_json().unwrap(), "test").unwrap(), scene);
}
