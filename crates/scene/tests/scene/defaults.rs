//! Defaults of keys that are left out; a written file means the same as the one read.

use halfway_lighting::{Camera, Cone, Material, PointLight, Projection, Reflectance, Shading};
use halfway_mesh::{Cuboid, Plane, Teapot, UvSphere};

use halfway_scene::{
    AttachEntry, CameraEntry, ConeEntry, LightEntry, LightKind, MaterialEntry, MeshEntry, ObjectEntry, SceneFile,
    TransformEntry,
};

fn parse(text: &str) -> SceneFile {
    SceneFile::from_json(text, "test").unwrap()
}

/// The format's own description, with every key spelled out; the defaults have to be these.
const WRITTEN_OUT: &str = r#"{
  "schema_version": 1,
  "size": [1280, 720],
  "background": [0, 0, 0],
  "output": "srgb",
  "intensity": "clamp",
  "samples": 1,
  "ambient": [0.1, 0.1, 0.1],
  "viewer": "local",
  "shading": "phong",
  "reflectance": "blinn_phong",
  "camera": {"position": [0, 0, 3], "target": [0, 0, 0], "up": [0, 1, 0], "fov_y_deg": 45, "near": 0.1},
  "lights": [
    {"kind": "point", "position": [2, 0, 2], "ambient": [0, 0, 0], "diffuse": [1, 1, 1], "specular": [1, 1, 1],
     "attenuation": [1, 0.09, 0.032], "range": null, "attenuate_ambient": false, "attach": "world"},
    {"kind": "spot", "position": [2, 0, 2], "direction": [0, -1, 0], "cutoff_deg": 30, "inner_deg": null,
     "exponent": 0, "ambient": [0, 0, 0], "diffuse": [1, 1, 1], "specular": [1, 1, 1],
     "attenuation": [1, 0.09, 0.032], "range": null, "attenuate_ambient": false, "attach": "world"},
    {"kind": "directional", "direction": [0, -1, -1], "ambient": [0, 0, 0], "diffuse": [1, 1, 1],
     "specular": [1, 1, 1], "attach": "world"},
    {"kind": "homogeneous", "position": [0, 0, 1, 0], "direction": [0, -1, 0], "cutoff_deg": 180, "inner_deg": null,
     "exponent": 0, "ambient": [0, 0, 0], "diffuse": [1, 1, 1], "specular": [1, 1, 1],
     "attenuation": [1, 0.09, 0.032], "range": null, "attenuate_ambient": false, "attach": "world"}
  ],
  "objects": [
    {"name": null, "mesh": {"uv_sphere": {"radius": 1, "segments": 32, "rings": 16}}, "normals": "keep",
     "transform": {"translation": [0, 0, 0], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]},
     "material": {"ambient": [0.2, 0.2, 0.2], "diffuse": [0.8, 0.8, 0.8], "specular": [0, 0, 0],
                  "emission": [0, 0, 0], "shininess": 32, "opacity": 1},
     "back_material": null, "shading": null, "reflectance": null},
    {"mesh": {"plane": {"size": 2, "divisions": 1}}},
    {"mesh": {"box": {"size": [1, 1, 1]}}},
    {"mesh": {"teapot": {"divisions": 8}}}
  ]
}"#;

const LEFT_OUT: &str = r#"{
  "camera": {},
  "lights": [{"kind": "point"}, {"kind": "spot"}, {"kind": "directional"}, {"kind": "homogeneous"}],
  "objects": [{"mesh": {"uv_sphere": {}}, "material": {}}, {"mesh": {"plane": {}}}, {"mesh": {"box": {}}},
              {"mesh": {"teapot": {}}}]
}"#;

#[test]
fn defaults_are_those_of_the_format() {
    assert_eq!(parse(LEFT_OUT), parse(WRITTEN_OUT));
    assert_eq!(parse("{}"), SceneFile::default());
    assert_eq!(parse(r#"{"camera": null, "lights": null}"#), SceneFile::default());
    let object = &parse(r#"{"objects": [{"mesh": {"box": {}}}]}"#).objects[0];
    assert_eq!(*object, ObjectEntry::new(MeshEntry::Box(Cuboid::default())));
}

#[test]
fn defaults_agree_with_those_of_the_components() {
    assert_eq!(MaterialEntry::default().material(), Some(Material::default()));
    // The format's plane reaches from −1 to 1; the surface's own default is a unit square.
    let plane = Plane { size: 2.0, ..Plane::default() };
    for (mesh, default) in [
        ("uv_sphere", MeshEntry::UvSphere(UvSphere::default())),
        ("box", MeshEntry::Box(Cuboid::default())),
        ("teapot", MeshEntry::Teapot(Teapot::default())),
        ("plane", MeshEntry::Plane(plane)),
    ] {
        let scene = parse(&format!(r#"{{"objects": [{{"mesh": {{"{mesh}": {{}}}}}}]}}"#));
        assert_eq!(scene.objects[0].mesh, default);
    }
    assert_eq!(LightEntry::white(LightKind::Point).light, PointLight::default());
    assert_eq!(ConeEntry::default().cutoff_deg.to_radians(), Cone::default().cutoff);
    let (scene, camera) = (SceneFile::default(), Camera::default());
    let CameraEntry { fov_y_deg, near, .. } = CameraEntry::default();
    assert_eq!(Projection::perspective(fov_y_deg.to_radians()).with_near(near), camera.projection);
    assert_eq!(scene.output, camera.encoding);
    assert_eq!(scene.viewer, camera.viewer);
    assert_eq!(scene.reflectance, Reflectance::default());
    assert_eq!(scene.shading, Shading::default());
}

/// Every key at a value that is not its default.
const UNUSUAL: &str = r#"{
  "size": [1, 16384],
  "background": [0.01, 0.012, 0.02],
  "output": "raw",
  "samples": 4,
  "ambient": [0, 1e12, 0.3],
  "viewer": "infinite",
  "shading": "gouraud",
  "reflectance": "blinn_phong_matched",
  "camera": {"position": [1e-7, 2, 3e20], "target": [0.1, 0.2, 0.3], "up": [1, 0, 0.5], "fov_y_deg": 179.9, "near": 1e-20},
  "lights": [
    {"kind": "spot", "position": [1, 2, 3], "direction": [0.1, 0, 0], "cutoff_deg": 90, "inner_deg": 90,
     "exponent": 128, "attenuation": [0, 0, 1], "range": 7.5, "attenuate_ambient": true, "attach": {"object": "a \"b\" [c, d]"}},
    {"kind": "homogeneous", "position": [1, 2, 3, -4], "cutoff_deg": 0, "attach": "camera"},
    {"kind": "directional", "ambient": [0.1, 0.2, 0.3]}
  ],
  "objects": [
    {"name": "a \"b\" [c, d]", "mesh": {"path": "models/a b.GLB"}, "normals": "max",
     "transform": {"matrix": [1,0,0,0, 0.5,1,0,0, 0,0,1,0, 7,8,9,1]}, "material": "Red Plastic",
     "back_material": {"emission": [1, 0, 0]}, "faces": "both", "shading": "flat", "reflectance": "phong", "blend": true},
    {"mesh": {"inline": {"positions": [0,0,0, 1,0,0, 0,1,0], "normals": [0,0,1, 0,0,1, 0,0,1], "uvs": [0,0, 1,0, 0,1],
     "indices": [0, 1, 2]}}, "faces": "front", "blend": false, "transform": {"rotation": [0, 0.70710678, 0, 0.70710678]}}
  ]
}"#;

#[test]
fn written_and_read_again_a_scene_is_the_same() {
    for text in ["{}", LEFT_OUT, WRITTEN_OUT, UNUSUAL] {
        let scene = parse(text);
        let written = scene.to_json().unwrap();
        assert_eq!(parse(&written), scene, "{written}");
        assert_eq!(parse(&written).to_json().unwrap(), written);
    }
}

#[test]
fn any_number_survives_being_written() {
    // Exponents and fractions of all sizes; a fixed linear congruential sequence (Knuth, MMIX).
    let mut state = 1_u64;
    for _ in 0..2000 {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let number = f32::from_bits((state >> 33) as u32);
        if !number.is_finite() {
            continue;
        }
        let mut scene = SceneFile::for_model("a.obj");
        let light = LightEntry {
            position: [f64::from(number), -f64::from(number), 1.0, 1.0],
            ..LightEntry::white(LightKind::Point)
        };
        scene.lights = Some(vec![light].into());
        assert_eq!(parse(&scene.to_json().unwrap()), scene, "{number:?}");
    }
}

#[test]
fn lists_of_numbers_stand_on_one_line() {
    let written = parse(UNUSUAL).to_json().unwrap();
    assert!(written.contains("\n  \"size\": [1, 16384],\n"), "{written}");
    assert!(written.contains("\"position\": [1e-7, 2.0, 3e+20],\n"), "{written}");
    assert!(written.contains("\"name\": \"a \\\"b\\\" [c, d]\",\n"), "{written}");
    assert!(written.ends_with("}\n"));
}

#[test]
fn rotations_near_unit_length_become_unit() {
    for (rotation, accepted) in [("0, 0.707, 0, 0.707", true), ("0, 0.7, 0, 0.7", true), ("0, 0.5, 0, 0.5", false)] {
        let text =
            format!(r#"{{"objects": [{{"mesh": {{"box": {{}}}}, "transform": {{"rotation": [{rotation}]}}}}]}}"#);
        let scene = SceneFile::from_json(&text, "test");
        assert_eq!(scene.is_ok(), accepted, "{rotation}");
        let Ok(scene) = scene else { continue };
        let x = scene.objects[0].transform.matrix().x_axis;
        // A quarter turn about +Y takes +X to −Z, to the rounding of f32.
        assert!((x - bevy_math::DVec4::NEG_Z).length() < 1e-6, "{rotation}: {x}");
    }
}

#[test]
fn kinds_of_light_and_frames() {
    let scene = parse(UNUSUAL);
    let lights = scene.lights.as_ref().unwrap().entries();
    assert_eq!(lights[0].attach, AttachEntry::Object("a \"b\" [c, d]".into()));
    assert_eq!(lights[1].attach, AttachEntry::Camera);
    assert_eq!((lights[1].kind, lights[1].position), (LightKind::Homogeneous, [1.0, 2.0, 3.0, -4.0]));
    assert_eq!((lights[2].kind, lights[2].cone.direction), (LightKind::Directional, [0.0, -1.0, -1.0]));
    assert!(matches!(scene.objects[0].transform, TransformEntry::Matrix(_)));
}
