//! Pixels, explained. Those of random scenes are explained in `tools/wild/tests/explained.rs`.

use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::components::GlobalTransform;
use halfway_lighting::{
    AlphaMode, Attenuation, DirectionalLight, Faces, GlobalAmbient, HemisphereLight, Intensity, Material, PointLight,
    Reflectance, Shading,
};
use halfway_reference::OracleError;
use halfway_reference::explain::Explanation;

use crate::scene::{Stage, assert_close, assert_same, chalk, glow, grey, wall};

/// The middle of three by three pixels, in which bytes are as they are.
fn middle(stage: &mut Stage) -> Explanation {
    stage.camera().encoding = halfway_lighting::Encoding::Raw;
    let oracle = stage.oracle(3, 3).with_clamping(true);
    let explained = oracle.explain(1, 1).expect("a pixel of the picture");
    assert_close("drawn", explained.color, oracle.draw().pixel(1, 1));
    explained
}

#[track_caller]
fn says(explained: &Explanation, lines: &[&str]) {
    let text = explained.to_string();
    for line in lines {
        assert!(text.contains(line), "{line}\n{text}");
    }
}

#[test]
fn every_kind_of_light_says_what_it_adds() {
    let mut stage = Stage::new();
    stage.world.insert_resource(GlobalAmbient(grey(0.5)));
    let looks = Material { ambient: grey(0.2), specular: grey(0.25), shininess: 2.0, ..chalk(0.5) };
    stage.add(wall(9.0, 4.0), (Name::new("wall"), looks, Reflectance::Phong));
    stage.sun(DirectionalLight { ambient: grey(0.25), ..DirectionalLight::white() }, Vec3::NEG_Z);
    let at = |z: f32| GlobalTransform::from_xyz(0.0, 0.0, z);
    let lamp = PointLight { attenuation: Attenuation::new(0.0, 1.0, 0.0), ..PointLight::white() };
    stage.world.spawn((Name::new("lamp"), lamp, at(-2.0)));
    stage.world.spawn((Name::new("behind"), lamp, at(-9.0)));
    stage.world.spawn((Name::new("out of reach"), PointLight { range: Some(1.0), ..lamp }, at(0.0)));
    stage.world.spawn((Name::new("outside"), HemisphereLight::new(grey(0.25), LinearRgba::BLACK), at(0.0)));
    let explained = middle(&mut stage);
    says(
        &explained,
        &[
            "Pixel (1, 1) of 3 × 3: 255 255 255 of 255",
            "\"wall\", triangle 0, seen from the front; Phong shading",
            "p   (0, 0, -4.0000), at depth 4.0000",
            "ka  (0.2, 0.2, 0.2)   kd  (0.5, 0.5, 0.5)",
            "α = 2, Phong reflectance",
            "Ga  (0.5, 0.5, 0.5)   ambient = ka·(Ga + ΣLa) = (0.1500, 0.1500, 0.1500)",
            "ambient  = ka·La = (0.0500, 0.0500, 0.0500), La (0.25, 0.25, 0.25)",
            "diffuse  = kd·Ld·(n·l) = (0.5000, 0.5000, 0.5000)",
            "specular = ks·Ls·(r·v)^2 = (0.2500, 0.2500, 0.2500)",
            "Light \"lamp\", point, Ld = Ls = (1, 1, 1)",
            "l = (0, 0, 1.0000), d = 2.0000",
            "att = 1/(d) = 0.5000",
            "diffuse  = att·kd·Ld·(n·l) = (0.2500, 0.2500, 0.2500)",
            "specular = att·ks·Ls·(r·v)^2 = (0.1250, 0.1250, 0.1250)",
            "n·l = -1.0000: behind the surface, no diffuse, no specular",
            "n·l = 1.0000, but it does not reach the point",
            "diffuse  = kd·lerp(ground, sky, (1 + n·d)/2) = (0.0625, 0.0625, 0.0625)",
            "I = ambient  (0.1500, 0.1500, 0.1500)",
            "=          (1.3375, 1.3375, 1.3375)",
            "clamped  (1.0000, 1.0000, 1.0000)",
        ],
    );
    let json = explained.to_json();
    assert_eq!(json["samples"][0]["layers"][0]["points"][0]["lights"].as_array().map(Vec::len), Some(5));
    // Many lights that add nothing are counted.
    for _ in 0..6 {
        stage.world.spawn((lamp, at(-9.0)));
    }
    let text = middle(&mut stage).to_string();
    assert!(text.contains("8 more lights add nothing") && !text.contains("\"behind\""), "{text}");
}

#[test]
fn layers_are_explained_in_the_order_of_drawing() {
    let mut stage = Stage::new();
    stage.camera().background = LinearRgba::rgb(0.5, 0.25, 0.0);
    let veil = Material { opacity: 0.25, ..glow(0.0, 0.0, 4.0) };
    stage.add(wall(9.0, 2.0), (Name::new("veil"), veil, AlphaMode::Blend));
    let unlit = (Name::new("sign"), chalk(0.5), Shading::Unlit, AlphaMode::Blend);
    let sign = stage.add(wall(9.0, 3.0), unlit);
    stage.world.entity_mut(sign).insert(Material { opacity: 0.5, ..chalk(0.5) });
    let explained = middle(&mut stage);
    says(
        &explained,
        &[
            "meets 2 surfaces, in the order of drawing over (0.5000, 0.2500, 0)",
            "\"sign\", triangle 0, seen from the front; unlit: its base colour, whatever shines",
            "Opacity 0.5000: 0.5000·(0.5000, 0.5000, 0.5000) + 0.5000·(0.5000, 0.2500, 0) = (0.5000, 0.3750, 0.2500)",
            "clamped  (0, 0, 1.0000)",
            "Opacity 0.2500: 0.2500·(0, 0, 1.0000) + 0.7500·(0.5000, 0.3750, 0.2500) = (0.3750, 0.2812, 0.4375)",
            "Without a curve: (0.3750, 0.2812, 0.4375); times 255: 96 72 112",
        ],
    );
    let [sample] = &explained.samples[..] else { panic!("one sample") };
    assert_eq!(sample.layers.iter().map(|layer| layer.name.as_str()).collect::<Vec<_>>(), ["sign", "veil"]);
}

#[test]
fn corners_samples_policies_and_backs() {
    let mut stage = Stage::new();
    stage.camera().intensity = Intensity::Renormalize { smoothing: 0.0 };
    stage.sun(DirectionalLight::new(grey(4.0)), Vec3::NEG_Z);
    let parent = stage.world.spawn((Name::new("house"), GlobalTransform::IDENTITY)).id();
    let looks = (Name::new("door"), chalk(1.0), Shading::Gouraud, Faces::Both, ChildOf(parent));
    stage.add_at(wall(9.0, -4.0), crate::scene::scaled(1.0, 1.0, -1.0), looks);
    stage.camera().encoding = halfway_lighting::Encoding::Raw;
    let oracle = stage.oracle(3, 3).with_supersampling(2);
    let explained = oracle.explain(1, 1).expect("a pixel of the picture");
    assert_same("drawn", explained.color, oracle.draw().pixel(1, 1));
    assert_eq!(explained.divisor, Some(4.0));
    says(
        &explained,
        &[
            "Sample 1 of 4, (1.25, 1.25) meets one surface",
            "\"house/door\", triangle",
            "seen from the back; Gouraud shading: once a vertex, interpolated",
            "Corner 3 of 3: vertex",
            "The corners with their weights",
            "Mean of the samples: (4.0000, 4.0000, 4.0000)",
            "The whole picture is divided by its largest channel, 4.0000: (1.0000, 1.0000, 1.0000)",
        ],
    );
    let points = &explained.samples[0].layers[0].points;
    let weights: f64 = points.iter().filter_map(|point| Some(point.corner?.1)).sum();
    assert!(points.len() == 3 && (weights - 1.0).abs() < 1e-12);
}

#[test]
fn pixels_outside_and_pixels_of_nothing() {
    let mut stage = Stage::new();
    stage.camera().background = LinearRgba::rgb(0.5, 0.25, 0.0);
    let oracle = stage.oracle(3, 2);
    for (x, y) in [(3, 0), (0, 2), (u32::MAX, u32::MAX)] {
        let error = oracle.explain(x, y).expect_err("it lies outside");
        assert_eq!(error, OracleError::Outside { x, y, width: 3, height: 2 });
        let expected = "lies outside the picture of 3 × 2 pixels; expected a column from 0 to 2 and a row from 0 to 1";
        assert!(error.to_string().contains(expected), "{error}");
    }
    says(
        &oracle.explain(2, 1).expect("a pixel of the picture"),
        &["The point (2.5, 1.5) meets nothing: the background is (0.5000, 0.2500, 0)"],
    );
}
