//! A degenerate case equals the simpler case that it reduces to.

use crate::render::compare::{assert_identical, brightest, difference};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, glowing, material, point_light};
use crate::render::stage::Stage;
use halfway::prelude::*;

const SHADINGS: [Shading; 3] = [Shading::Flat, Shading::Gouraud, Shading::Phong];
const REFLECTANCES: [Reflectance; 3] = [Reflectance::Phong, Reflectance::BlinnPhong, Reflectance::BlinnPhongMatched];

/// A sphere over a floor, without lights.
fn still_life() -> Scene {
    Scene::seen_from(Vec3::new(0.4, 1.4, 3.2), Vec3::ZERO)
        .ambient(0.2)
        .with(Thing::new(UvSphere::new(0.8, 16, 8)))
        .with(Thing::square(Vec3::new(0.0, -0.8, 0.0), Vec3::Y, 6.0))
}

fn lit(lamps: impl IntoIterator<Item = Lamp>) -> Scene {
    let mut scene = still_life();
    scene.lamps.extend(lamps);
    scene
}

/// The scene with another material on everything.
fn with_material_everywhere(mut scene: Scene, material: Material) -> Scene {
    for thing in &mut scene.things {
        thing.material = material;
    }
    scene
}

const AT: Vec3 = Vec3::new(1.0, 2.0, 1.5);

fn point(light: PointLight) -> Lamp {
    Lamp::point(light, AT)
}

fn spot(light: PointLight, cone: Cone) -> Lamp {
    Lamp::spot(SpotLight { light, cone }, AT, -AT)
}

#[test]
fn without_lights_there_is_emission_and_ambient() {
    let mut stage = Stage::new(32, 32);
    // ke + ka·Ga of `material`, by hand.
    let expected = [0.02 + 0.15 * 0.2, 0.01 + 0.25 * 0.2, 0.03 + 0.35 * 0.2];
    for shading in SHADINGS {
        let mut scene = still_life();
        scene.view_shading = Some(shading);
        let picture = stage.draw(&scene);
        let covered: Vec<_> = picture.pixels().filter(|pixel| pixel.0[0] > 0.0).collect();
        assert!(covered.len() > 300, "{shading:?} covers {} pixels", covered.len());
        for pixel in covered {
            // Two roundings of numbers below 0.1.
            assert!((0..3).all(|k| (pixel.0[k] - expected[k]).abs() < 2e-8), "{shading:?}: {:?}", pixel.0);
        }
    }
}

#[test]
fn equivalent_scenes_are_equal_to_the_bit() {
    let black = LinearRgba::BLACK;
    let no_ks = Material { specular: black, ..material() };
    let no_ls = PointLight { specular: black, ..point_light() };
    let spotted = Cone { cutoff: 0.5, inner: None, exponent: 2.0 };
    let rows = [
        ("a cutoff of π is a point light", lit([spot(point_light(), Cone::NONE)]), lit([point(point_light())])),
        (
            "a cutoff of π ignores inner cone and exponent",
            lit([spot(point_light(), Cone { inner: Some(0.1), exponent: 9.0, ..Cone::NONE })]),
            lit([point(point_light())]),
        ),
        (
            "an inner cone as wide as the cutoff is a hard edge",
            lit([spot(point_light(), Cone { inner: Some(0.5), ..spotted })]),
            lit([spot(point_light(), spotted)]),
        ),
        (
            "without ks the shininess does nothing",
            with_material_everywhere(lit([point(point_light())]), Material { shininess: 3.0, ..no_ks }),
            with_material_everywhere(lit([point(point_light())]), no_ks),
        ),
        (
            "lights without Ls make no highlight",
            lit([point(no_ls)]),
            with_material_everywhere(lit([point(point_light())]), no_ks),
        ),
        (
            "an opacity without AlphaMode does nothing",
            with_material_everywhere(lit([point(point_light())]), Material { opacity: 0.3, ..material() }),
            lit([point(point_light())]),
        ),
    ];
    let mut stage = Stage::new(48, 48);
    for (row, a, b) in rows {
        for shading in SHADINGS {
            let [a, b] = [&a, &b].map(|scene| Scene { view_shading: Some(shading), ..scene.clone() });
            let pictures = [&a, &b].map(|scene| stage.draw(scene));
            assert_identical(&format!("{row}, {shading:?}"), &pictures[0], &pictures[1]);
        }
    }
}

#[test]
fn nearly_equal_scenes_are_nearly_equal() {
    let dark = PointLight::new(LinearRgba::BLACK);
    let white = PointLight { ambient: LinearRgba::BLACK, ..PointLight::white() };
    let nudged = PointLight { specular: LinearRgba::rgb(1.0, 1.0, 1.0 - f32::EPSILON), ..white };
    let unweakened = PointLight { attenuation: Attenuation::NONE, ..point_light() };
    let ranged = PointLight { range: Some(1e4), ..point_light() };
    let wide = Cone { cutoff: std::f32::consts::FRAC_PI_2, inner: None, exponent: 0.0 };
    let direction = Vec3::new(-0.5, -0.8, -0.6);
    let far = Lamp::point(unweakened, direction * -1e6);
    let with_alpha =
        |shininess| with_material_everywhere(lit([point(point_light())]), Material { shininess, ..material() });
    let ambient_of = |light: f32, global: f32| {
        let grey = LinearRgba::rgb(light, light, light);
        lit([point(PointLight { ambient: grey, ..point_light() })]).ambient(global)
    };
    let rows = [
        // Directions of a light 10⁶ away differ by up to 4·10⁻⁶ rad over the scene; times the shininess of 19.5.
        (
            "a far point light is a directional one",
            lit([far]),
            lit([Lamp::directional(directional_light(), direction)]),
            2e-4,
        ),
        // (2/10⁴)⁴ is lost to rounding.
        ("a range far beyond the scene does nothing", lit([point(ranged)]), lit([point(point_light())]), 1e-6),
        (
            "half a space of cone is a point light for what it faces",
            lit([spot(point_light(), wide)]),
            lit([point(point_light())]),
            1e-6,
        ),
        // A constant, interpolated.
        ("a black light is no light", lit([point(dark)]).ambient(0.9), lit([]).ambient(0.9), 1e-6),
        // Other code adds the same terms; one light's specular colour is off by a rounding step.
        ("a shared light colour is two equal ones", lit([point(white)]), lit([point(nudged)]), 1e-6),
        // x³² by squaring and by logarithm: 32 roundings of x, and a shininess 3·10⁻⁶ larger.
        ("32 is 32.0001", with_alpha(32.0), with_alpha(32.0001), 2e-5),
        ("1 is 1.000001", with_alpha(1.0), with_alpha(1.000_001), 2e-5),
        ("2 is 2.000001", with_alpha(2.0), with_alpha(2.000_001), 2e-5),
        ("a light's ambient adds to the global one", ambient_of(0.25, 0.125), ambient_of(0.125, 0.25), 1e-6),
    ];
    let mut stage = Stage::new(48, 48);
    for (row, a, b, bar) in rows {
        for shading in SHADINGS {
            for reflectance in [Reflectance::Phong, Reflectance::BlinnPhong] {
                let [a, b] = [&a, &b].map(|scene| Scene {
                    view_shading: Some(shading),
                    view_reflectance: Some(reflectance),
                    ..scene.clone()
                });
                let pictures = [&a, &b].map(|scene| stage.draw(scene));
                let difference = difference(&pictures[0], &pictures[1]);
                assert!(
                    difference <= bar,
                    "{row}, {shading:?}, {reflectance:?}: differ by {difference:e}, not {bar:e}"
                );
                assert!(brightest(&pictures[0]) > 0.2, "{row} shows nothing");
            }
        }
    }
}

#[test]
fn without_ks_every_reflectance_is_lambert() {
    let mut stage = Stage::new(33, 33);
    // A square straight ahead under a directional light 60° off its normal: kd·Ld·½.
    let light = DirectionalLight { ambient: LinearRgba::BLACK, ..directional_light() };
    let direction = Vec3::new(-(0.75f32.sqrt()), 0.0, -0.5);
    let matte =
        Material { ambient: LinearRgba::BLACK, emission: LinearRgba::BLACK, specular: LinearRgba::BLACK, ..material() };
    for shading in SHADINGS {
        for reflectance in REFLECTANCES {
            let square = Thing::square(Vec3::NEG_Z * 3.0, Vec3::Z, 9.0)
                .with_material(matte)
                .shaded(shading)
                .reflecting(reflectance);
            let picture = stage.draw(&Scene::in_eye_space().with(square).lit(Lamp::directional(light, direction)));
            for pixel in picture.pixels() {
                let expected = [0.70 * 0.90 * 0.5, 0.45 * 0.80 * 0.5, 0.30 * 1.00 * 0.5];
                // A handful of roundings of numbers below 1.
                let close = (0..3).all(|k| (pixel.0[k] - expected[k]).abs() < 5e-7);
                assert!(close, "{shading:?}, {reflectance:?}: {:?}, expected {expected:?}", pixel.0);
            }
        }
    }
}

#[test]
fn emission_is_untouched_by_lights_and_transforms() {
    let mut stage = Stage::new(33, 33);
    let transforms = [
        Transform::IDENTITY,
        Transform::from_rotation(Quat::from_rotation_y(1.0)),
        Transform::from_scale(Vec3::new(0.5, 2.0, 1.5)),
        Transform::from_scale(Vec3::new(-1.0, 1.0, 1.0)),
    ];
    for shading in SHADINGS {
        for transform in transforms {
            for lamps in [vec![], vec![point(point_light()), Lamp::directional(directional_light(), Vec3::NEG_Z)]] {
                let count = lamps.len();
                let sphere =
                    Thing::new(UvSphere::default()).with_material(glowing(0.3, 0.6, 0.9)).shaded(shading).at(transform);
                let mut scene = Scene::seen_from(Vec3::Z * 4.0, Vec3::ZERO).ambient(0.5).with(sphere);
                scene.lamps = lamps;
                let row = format!("{shading:?}, {count} lights, {transform:?}");
                assert_eq!(stage.draw(&scene).get_pixel(16, 16).0, [0.3, 0.6, 0.9, 1.0], "{row}");
            }
        }
    }
}

#[test]
fn objects_inherit_the_cameras_shading_and_reflectance() {
    let mut stage = Stage::new(48, 48);
    let scene = |view: Option<(Shading, Reflectance)>, own: Option<(Shading, Reflectance)>| {
        let mut scene = lit([point(point_light())]);
        (scene.view_shading, scene.view_reflectance) = view.unzip();
        for thing in &mut scene.things {
            (thing.shading, thing.reflectance) = own.unzip();
        }
        scene
    };
    for shading in SHADINGS {
        for reflectance in REFLECTANCES {
            let asked = (shading, reflectance);
            let other = (Shading::Flat, Reflectance::Phong);
            let own = stage.draw(&scene(None, Some(asked)));
            assert_identical(&format!("{asked:?} of the view"), &own, &stage.draw(&scene(Some(asked), None)));
            assert_identical(&format!("{asked:?} wins"), &own, &stage.draw(&scene(Some(other), Some(asked))));
        }
    }
    let plain = stage.draw(&scene(None, None));
    let named = (Shading::Phong, Reflectance::BlinnPhong);
    assert_identical("the defaults by name", &plain, &stage.draw(&scene(None, Some(named))));
}

#[test]
fn the_order_in_which_lights_are_spawned_changes_rounding_only() {
    let mut stage = Stage::new(32, 32);
    let lamps = [
        point(point_light()),
        spot(point_light(), Cone::new(0.6)),
        Lamp::directional(directional_light(), Vec3::new(1.0, -1.0, -1.0)),
        Lamp::point(PointLight::new(LinearRgba::rgb(0.1, 0.9, 0.3)), Vec3::new(-1.0, 0.5, 2.0)),
    ];
    let forward = stage.draw(&lit(lamps.clone()));
    let backward = stage.draw(&lit(lamps.into_iter().rev()));
    assert!(difference(&forward, &backward) < 2e-6, "{}", difference(&forward, &backward));
}
