//! Pixels against closed forms: numbers from angles and distances, without any evaluator.

use crate::render::edges::{mesh, screen};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, glowing};
use crate::render::stage::Stage;
use halfway::lighting::homogeneous::{LightPlace, from_homogeneous};
use halfway::prelude::*;

const SMOOTH: [Shading; 2] = [Shading::Gouraud, Shading::Phong];
/// kd and ks; every light is white.
const KD: f32 = 0.25;
const KS: f32 = 0.5;

fn glossy(shininess: f32) -> Material {
    let grey = |value| LinearRgba::rgb(value, value, value);
    Material {
        ambient: LinearRgba::BLACK,
        emission: LinearRgba::BLACK,
        diffuse: grey(KD),
        specular: grey(KS),
        shininess,
        ..Material::DEFAULT
    }
}

/// A direction `degrees` from +Z toward +X.
fn tilted(degrees: f32) -> Vec3 {
    let (x, z) = degrees.to_radians().sin_cos();
    Vec3::new(x, 0.0, z)
}

/// A wall that fills the picture, with its normal tilted, seen by an infinite viewer: v is +Z at every pixel.
fn wall(normal: f32, material: Material) -> Scene {
    let mut scene =
        Scene::in_eye_space().with(Thing::new(screen([tilted(normal).to_array(); 4])).with_material(material));
    scene.camera.viewer = Viewer::Infinite;
    scene
}

fn sun(toward: f32) -> Lamp {
    Lamp::directional(DirectionalLight::white(), -tilted(toward))
}

/// The color in the middle of the picture.
fn centre(stage: &mut Stage, scene: &Scene) -> f64 {
    let picture = stage.draw(scene);
    f64::from(picture.get_pixel(picture.width() / 2, picture.height() / 2).0[0])
}

fn assert_centre(row: &str, stage: &mut Stage, scene: &Scene, expected: f64, tolerance: f64) {
    let centre = centre(stage, scene);
    assert!((centre - expected).abs() <= tolerance, "{row}: {centre}, expected {expected}");
}

#[test]
fn lambert_and_both_highlights_at_chosen_angles() {
    let mut stage = Stage::new(9, 9);
    // l at θ and n at φ from v, in one plane: n·l = cos(θ − φ), r·v = cos(2φ − θ), n·h = cos(θ/2 − φ).
    for (theta, phi) in
        [(0.0, 0.0), (30.0, 0.0), (60.0, 0.0), (89.0, 0.0), (60.0, 30.0), (60.0, 25.0), (100.0, 40.0), (-50.0, 20.0)]
    {
        let cos = |degrees: f32| f64::from(degrees).to_radians().cos().max(0.0);
        for alpha in [1.0, 2.0, 19.5, 64.0] {
            for (reflectance, peak) in
                [(Reflectance::Phong, cos(2.0 * phi - theta)), (Reflectance::BlinnPhong, cos(0.5 * theta - phi))]
            {
                for shading in SMOOTH {
                    let mut scene = wall(phi, glossy(alpha)).lit(sun(theta));
                    scene.things[0] = scene.things[0].clone().shaded(shading).reflecting(reflectance);
                    let expected = f64::from(KD) * cos(theta - phi) + f64::from(KS) * peak.powf(alpha.into());
                    let row = format!("l at {theta}°, n at {phi}°, exponent {alpha}, {reflectance:?}, {shading:?}");
                    // A cosine is known to 3·10⁻⁷, and the exponent multiplies that.
                    assert_centre(&row, &mut stage, &scene, expected, 3e-7 * (1.0 + f64::from(alpha)));
                }
            }
        }
    }
}

#[test]
fn light_from_behind_makes_no_highlight() {
    let mut stage = Stage::new(9, 9);
    // n at 60° from v and l at 20° beyond v on the other side: n·l = cos 80° > 0 lights, and cos 100° does not, though
    // n·h = cos 40° in both.
    for (theta, lit) in [(-20.0, true), (-40.0, false)] {
        for reflectance in [Reflectance::Phong, Reflectance::BlinnPhong, Reflectance::BlinnPhongMatched] {
            for shading in SMOOTH {
                for shininess in [0.0, 0.5, 8.0] {
                    let mut scene = wall(60.0, glossy(shininess)).lit(sun(theta));
                    scene.things[0] = scene.things[0].clone().shaded(shading).reflecting(reflectance);
                    let centre = stage.draw(&scene).get_pixel(4, 4).0[0];
                    let row = format!("n·l {lit}, {reflectance:?}, {shading:?}, shininess {shininess}: {centre}");
                    assert_eq!(centre > 0.0, lit, "{row}");
                }
            }
        }
    }
}

/// A light before the middle of a matte wall at z = −4, at a distance.
fn before_the_wall(
    stage: &mut Stage,
    row: &str,
    distance: f32,
    light: PointLight,
    cone: Option<(Cone, f32)>,
    factor: f64,
) {
    let matte = Material::matte(LinearRgba::rgb(KD, KD, KD));
    let at = Vec3::new(0.0, 0.0, distance - 4.0);
    let lamp = match cone {
        None => Lamp::point(light, at),
        Some((cone, tilt)) => Lamp::spot(SpotLight { light, cone }, at, -tilted(tilt)),
    };
    for shading in [Shading::Flat, Shading::Phong] {
        // Flat shades the centroid, which is the middle of a triangle about it.
        let triangle =
            mesh(&[[-9.0, -9.0, -4.0], [9.0, -9.0, -4.0], [0.0, 18.0, -4.0]], &[[0.0, 0.0, 1.0]; 3], &[0, 1, 2]);
        let scene =
            Scene::in_eye_space().with(Thing::new(triangle).with_material(matte).shaded(shading)).lit(lamp.clone());
        let expected = f64::from(KD) * factor;
        // The distance is known to 10⁻⁷ of the wall's own, and its square weakens the light.
        let tolerance = 2e-6 * expected.max(0.1) * f64::from(4.0 / distance).max(1.0);
        // Hardware knows inverse square roots to two units in the last place, and a fade divides by a tenth or less.
        let fades = cone.is_some_and(|(cone, _)| cone.inner.is_some());
        let row = format!("{row}, {shading:?}");
        let centre = centre(stage, &scene);
        let tolerance = if fades && stage.is_hardware() { 10.0 * tolerance } else { tolerance };
        assert!((centre - expected).abs() <= tolerance, "{row}: {centre}, expected {expected}");
    }
}

#[test]
fn attenuation_at_chosen_distances() {
    let mut stage = Stage::new(33, 33);
    let rows: [(&str, Attenuation, Option<f32>, f32, f64); 8] = [
        ("none", Attenuation::NONE, None, 3.0, 1.0),
        ("constant", Attenuation::new(4.0, 0.0, 0.0), None, 0.5, 0.25),
        ("linear", Attenuation::new(0.0, 0.5, 0.0), None, 8.0, 0.25),
        ("inverse square", Attenuation::INVERSE_SQUARE, None, 2.0, 0.25),
        ("inverse square, near", Attenuation::INVERSE_SQUARE, None, 0.25, 16.0),
        ("all three", Attenuation::new(1.0, 0.5, 0.25), None, 2.0, 1.0 / 3.0),
        ("half way to the range: (1 − 1/16)²", Attenuation::NONE, Some(10.0), 5.0, 0.878_906_25),
        ("beyond the range", Attenuation::NONE, Some(4.5), 5.0, 0.0),
    ];
    for (row, attenuation, range, distance, factor) in rows {
        let light = PointLight { attenuation, range, ..PointLight::white() };
        before_the_wall(&mut stage, row, distance, light, None, factor);
    }
}

#[test]
fn spots_inside_on_and_outside_the_cone() {
    let mut stage = Stage::new(33, 33);
    let light = PointLight { attenuation: Attenuation::NONE, ..PointLight::white() };
    let cone = |cutoff: f32, inner: Option<f32>, exponent| Cone {
        cutoff: cutoff.to_radians(),
        inner: inner.map(f32::to_radians),
        exponent,
    };
    let cos = |degrees: f64| degrees.to_radians().cos();
    let fade = (cos(25.0) - cos(30.0)) / (cos(20.0) - cos(30.0));
    let rows: [(&str, Cone, f32, f64); 9] = [
        ("on the axis", cone(30.0, None, 0.0), 0.0, 1.0),
        ("just inside", cone(30.0, None, 0.0), 29.9, 1.0),
        ("just outside", cone(30.0, None, 0.0), 30.1, 0.0),
        ("exponent 2 at 30°", cone(45.0, None, 2.0), 30.0, 0.75),
        ("inside the inner cone", cone(30.0, Some(20.0), 0.0), 19.0, 1.0),
        ("between the cones", cone(30.0, Some(20.0), 0.0), 25.0, fade * fade),
        ("between, with an exponent", cone(30.0, Some(20.0), 3.0), 25.0, fade * fade * cos(25.0).powi(3)),
        ("on the edge of a cutoff of 0", cone(0.0, None, 0.0), 0.0, 1.0),
        ("on the axis under an exponent of 10³⁰", cone(30.0, None, 1e30), 0.0, 1.0),
    ];
    for (row, cone, tilt, factor) in rows {
        // The fade divides by a tenth; within the cones a cosine is known to 10⁻⁷.
        before_the_wall(&mut stage, row, 1.0, light, Some((cone, tilt)), factor);
    }
}

/// Ten colours on the line between two vertices: the normals' angles alone decide them.
#[test]
fn ten_colours_between_two_vertices() {
    const COUNT: u32 = 10;
    let unit = |[x, y, z]: [f64; 3]| bevy_math::DVec3::new(x, y, z).normalize();
    let (n1, n2, l) = (unit([-0.80, -0.04, 0.60]), unit([-0.65, -0.50, 0.60]), unit([-0.30, -2.20, 2.80]));
    let (al, bl, ab) = (n1.dot(l), n2.dot(l), n1.dot(n2));
    // The picture is 10 pixels wide. The vertices lie a sixteenth of a pixel outside the first and the last centre.
    let margin = 1.0 / 16.0;
    let mut stage = Stage::new(COUNT, 1);
    let mut scene = Scene::in_eye_space();
    let half = 0.5 * scene.camera.projection.height_at(10.0_f32);
    let [left, right] = [-1.0, 1.0].map(|side: f32| side * half * (9.0 + 2.0 * margin as f32) / 10.0);
    let corners = [[left, -1.0, -1.0], [right, -1.0, -1.0], [right, 1.0, -1.0], [left, 1.0, -1.0]];
    let [a, b] = [n1, n2].map(|n| n.as_vec3().to_array());
    let strip = mesh(&corners, &[a, b, b, a], &[0, 1, 2, 0, 2, 3]);
    let red = Material { ambient: LinearRgba::BLACK, ..Material::matte(LinearRgba::rgb(1.0, 0.0, 0.0)) };
    scene = scene
        .with(Thing::new(strip).with_material(red))
        .lit(Lamp::directional(DirectionalLight::white(), -l.as_vec3()));
    for shading in SMOOTH {
        scene.things[0].shading = Some(shading);
        let picture = stage.draw(&scene);
        for x in 0..COUNT {
            let t = (f64::from(x) + margin) / (9.0 + 2.0 * margin);
            let gouraud = (1.0 - t) * al + t * bl;
            let length = ((1.0 - t).powi(2) + 2.0 * t * (1.0 - t) * ab + t * t).sqrt();
            let expected = if shading == Shading::Gouraud { gouraud } else { gouraud / length };
            let [found, green, blue, _] = picture.get_pixel(x, 0).0;
            // Vertices may be snapped to 1/256 pixel; the colours change by 0.03 a pixel.
            assert!((f64::from(found) - expected).abs() < 2e-4, "{shading:?}, point {x}: {found}, expected {expected}");
            assert_eq!((green, blue), (0.0, 0.0), "a red surface gives back only red");
        }
    }
}

#[test]
fn a_light_with_w_of_zero_is_directional() {
    let mut stage = Stage::new(9, 9);
    let toward = Vec4::new(2.0, 3.0, 5.0, 0.0);
    let place = from_homogeneous(toward).expect("a place");
    assert!(matches!(place, LightPlace::Directional(_)), "{place:?}");
    let mut lamp = Lamp::directional(directional_light(), Vec3::NEG_Z);
    let scene = || Scene::in_eye_space().with(Thing::new(screen([[0.0, 0.0, 1.0]; 4])).with_material(glossy(8.0)));
    let along = stage.draw(&scene().lit(Lamp::directional(directional_light(), -toward.truncate())));
    lamp.at = place.transform();
    let placed = stage.draw(&scene().lit(lamp));
    // Two ways to the same rotation, which rounds.
    assert!(crate::render::compare::difference(&along, &placed) < 1e-6);
}

#[test]
fn a_hemisphere_mixes_sky_and_ground() {
    let mut stage = Stage::new(9, 9);
    for degrees in [0.0_f32, 30.0, 60.0, 80.0] {
        for (row, up, front) in
            [("the front", Vec3::Z, true), ("the back", Vec3::Z, false), ("ground", Vec3::NEG_Z, true)]
        {
            let light = HemisphereLight::new(LinearRgba::rgb(0.8, 0.8, 0.8), LinearRgba::rgb(0.2, 0.2, 0.2));
            let mut scene = wall(degrees, glossy(8.0)).lit(Lamp::hemisphere(light, up));
            if !front {
                // A back face is lit with −n, which looks the other way.
                scene = wall(180.0 - degrees, glossy(8.0)).lit(Lamp::hemisphere(light, up));
                scene.things[0].faces = Some(Faces::Both);
            }
            let n_dot_d = f64::from(degrees.to_radians().cos()) * if up == Vec3::Z { 1.0 } else { -1.0 };
            let sky = if front { 0.5 * (1.0 + n_dot_d) } else { 0.5 * (1.0 - n_dot_d) };
            let expected = f64::from(KD) * (0.2 * (1.0 - sky) + 0.8 * sky);
            assert_centre(&format!("{row} at {degrees}°"), &mut stage, &scene, expected, 1e-6);
        }
    }
}

#[test]
fn four_times_the_shininess_makes_phongs_highlight_of_blinns() {
    let mut stage = Stage::new(9, 9);
    for alpha in [5.0, 20.0, 100.0] {
        for degrees in [0.0, 2.0, 5.0, 10.0, 20.0, 40.0] {
            let mut draw = |reflectance, shininess| {
                let mut scene = wall(0.0, glossy(shininess)).lit(sun(degrees));
                scene.things[0].reflectance = Some(reflectance);
                stage.draw(&scene).get_pixel(4, 4).0[0]
            };
            let phong = draw(Reflectance::Phong, alpha);
            // The lobes' largest difference, as documented at `matched_shininess`.
            for (row, blinn, apart) in [
                ("β = 4α", draw(Reflectance::BlinnPhong, 4.0 * alpha), 0.16 / alpha),
                ("matched", draw(Reflectance::BlinnPhongMatched, alpha), 0.08 / alpha),
            ] {
                assert!((phong - blinn).abs() <= KS * apart, "{row}, α {alpha} at {degrees}°: {phong} and {blinn}");
            }
        }
    }
}

#[test]
fn emission_does_not_depend_on_the_view() {
    let mut stage = Stage::new(9, 9);
    for distance in [0.2, 1.0, 1e6] {
        let square =
            Thing::square(Vec3::NEG_Z * distance, Vec3::Z, 9.0 * distance).with_material(glowing(0.125, 0.0, 0.0));
        assert_centre(&format!("{distance} away"), &mut stage, &Scene::in_eye_space().with(square), 0.125, 0.0);
    }
}

/// The columns and rows that show something, and how many pixels do.
fn silhouette(stage: &mut Stage, scene: &Scene) -> (u32, u32, usize) {
    let picture = stage.draw(scene);
    let shown = || picture.enumerate_pixels().filter(|(_, _, pixel)| pixel.0[0] > 0.0);
    let extent = |of: fn((u32, u32)) -> u32| {
        let all = || shown().map(|(x, y, _)| of((x, y)));
        all().max().zip(all().min()).map_or(0, |(last, first)| last - first + 1)
    };
    (extent(|(x, _)| x), extent(|(_, y)| y), shown().count())
}

/// A sphere of a quarter of the picture's height covers π/64 of a square picture at every depth under an orthographic
/// camera, also beside and behind it; in a perspective it shrinks.
#[test]
fn a_sphere_has_one_size_at_all_depths_of_an_orthographic_view() {
    const SIDE: u32 = 160;
    let mut stage = Stage::new(SIDE, SIDE);
    let mut draw = |projection: Projection, depth: f32| {
        let ball = Thing::new(UvSphere::new(1.0, 96, 48)).with_material(glowing(0.5, 0.5, 0.5));
        let mut scene = Scene::in_eye_space().with(ball.at(Transform::from_xyz(0.3, -0.2, -depth)));
        scene.camera.projection = projection;
        silhouette(&mut stage, &scene)
    };
    let expected = std::f64::consts::PI / 64.0 * f64::from(SIDE * SIDE);
    for depth in [-40.0, 0.0, 2.0, 9.0, 3000.0] {
        let (width, height, pixels) = draw(Projection::orthographic(8.0).with_near(-50.0), depth);
        assert_eq!((width, height), (SIDE / 4, SIDE / 4), "at depth {depth}");
        assert!((pixels as f64 / expected - 1.0).abs() < 0.02, "{pixels} pixels at depth {depth}, expected {expected}");
    }
    let [near, far] = [5.0, 10.0].map(|depth| draw(Projection::perspective(0.8), depth).0);
    assert!(far < near * 3 / 5, "{near} and {far} columns in a perspective");
}

/// Under an orthographic camera v is +Z at every point, for the local viewer too: a wall under light along the view
/// shows one highlight everywhere.
#[test]
fn an_orthographic_view_sees_one_highlight_all_over_a_wall() {
    let mut stage = Stage::new(9, 9);
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        for viewer in [Viewer::Local, Viewer::Infinite] {
            let mut scene = wall(0.0, glossy(50.0)).lit(sun(10.0));
            scene.things[0].shading = Some(shading);
            scene.camera.viewer = viewer;
            scene.camera.projection = Projection::orthographic(1.5);
            let half_angle = 5_f32.to_radians();
            let expected = KD * 10_f32.to_radians().cos() + KS * half_angle.cos().powf(50.0);
            for (x, y, pixel) in stage.draw(&scene).enumerate_pixels() {
                let found = pixel.0[0];
                assert!((found - expected).abs() < 2e-6, "{shading:?}, ({x}, {y}): {found}, expected {expected}");
            }
        }
    }
}
