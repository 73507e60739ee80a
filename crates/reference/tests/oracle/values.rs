//! Pixels against hand arithmetic.

use bevy_color::LinearRgba;
use bevy_math::{DVec3, Vec3};
use bevy_transform::components::GlobalTransform;
use halfway_lighting::{
    Attenuation, BackMaterial, Camera, DirectionalLight, Faces, Frequency, GlobalAmbient, Material, PointLight,
    Reflectance, Shading, Terms, Viewer, matched_shininess,
};

use crate::scene::{SHADINGS, Stage, assert_close, chalk, glow, grey, ray, triangle, wall};

/// A tilted triangle whose red value under [`axial`] light is the share of its first corner, and whose normals cancel
/// nowhere.
const CORNERS: [Vec3; 3] = [Vec3::new(-2.0, -1.0, -2.0), Vec3::new(2.0, -1.0, -2.0), Vec3::new(0.0, 7.0, -8.0)];
const NORMALS: [Vec3; 3] = [Vec3::Z, Vec3::X, Vec3::X];

fn axial(i: f32) -> DirectionalLight {
    DirectionalLight { specular: LinearRgba::BLACK, ..DirectionalLight::new(grey(i)) }
}

/// The shares of the corners at the point of the tilted triangle that a ray meets: the ray is cut with the triangle's
/// plane, and the areas are those of the triangle seen along Z.
fn shares(ray: DVec3) -> Option<[f64; 3]> {
    let [a, b, c] = CORNERS.map(Vec3::as_dvec3);
    let plane = (b - a).cross(c - a);
    let p = ray * (a.dot(plane) / ray.dot(plane));
    let area = |a: DVec3, b: DVec3, c: DVec3| (b - a).truncate().perp_dot((c - a).truncate());
    let whole = area(a, b, c);
    let shares = [area(p, b, c), area(a, p, c), area(a, b, p)].map(|part| part / whole);
    shares.iter().all(|share| *share > 1e-9).then_some(shares)
}

/// Calls `check` with the colour of every pixel inside the tilted triangle and the shares of its corners there.
fn on_the_triangle(stage: &mut Stage, check: impl Fn([f64; 3], [f64; 3])) {
    let (width, height) = (24, 16);
    let image = stage.draw(width, height);
    let mut count = 0;
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        if let Some(shares) = shares(ray(x, y, width, height)) {
            check(image.pixel(x, y), shares);
            count += 1;
        }
    }
    assert!(count > 50, "{count} pixels of the triangle");
}

#[test]
fn lambert_with_emission_and_ambient() {
    for shading in SHADINGS {
        let mut stage = Stage::new();
        stage.world.insert_resource(GlobalAmbient(grey(0.5)));
        let material = Material {
            ambient: LinearRgba::rgb(0.25, 0.5, 1.0),
            diffuse: LinearRgba::rgb(0.5, 0.25, 0.0),
            emission: LinearRgba::rgb(0.125, 0.0, 0.25),
            ..Material::DEFAULT
        };
        stage.add(wall(8.0, 2.0), (material, shading));
        // n·l = 4/5; the light's own ambient is 1/4.
        let sun = DirectionalLight { ambient: grey(0.25), ..DirectionalLight::new(grey(2.0)) };
        stage.sun(sun, Vec3::new(-3.0, 0.0, -4.0));
        let image = stage.draw(9, 9);
        let expected = [0.125 + 0.25 * 0.75 + 0.5 * 1.6, 0.5 * 0.75 + 0.25 * 1.6, 0.25 + 0.75];
        for pixel in image.pixels() {
            assert_close(&format!("{shading:?}"), *pixel, expected);
        }
    }
}

#[test]
fn a_light_at_the_eye_shines_back_along_v() {
    let constants = [0.5, 0.25, 0.125];
    for (reflectance, exponent) in [
        (Reflectance::BlinnPhong, 8.0),
        (Reflectance::Phong, 8.0),
        (Reflectance::BlinnPhongMatched, matched_shininess(8.0)),
    ] {
        let mut stage = Stage::new();
        let material = Material { diffuse: grey(0.5), specular: grey(0.75), shininess: 8.0, ..chalk(0.0) };
        stage.add(wall(9.0, 2.0), (material, reflectance));
        let [a, b, c] = constants;
        let light = PointLight { attenuation: Attenuation::new(a, b, c), ..PointLight::white() };
        stage.world.spawn((light, GlobalTransform::IDENTITY));
        let image = stage.draw(11, 7);
        for (x, y) in [(5, 3), (0, 0), (9, 2), (3, 6)] {
            let p = 2.0 * ray(x, y, 11, 7);
            let d = p.length();
            let cos = 2.0 / d;
            let highlight = match reflectance {
                // r·v = cos 2ψ, h = v.
                Reflectance::Phong => (2.0 * cos * cos - 1.0f64).max(0.0).powf(exponent),
                _ => cos.powf(exponent),
            };
            let att = 1.0 / (f64::from(a) + f64::from(b) * d + f64::from(c) * d * d);
            let i = att * (0.5 * cos + 0.75 * highlight);
            assert_close(&format!("{reflectance:?} at ({x}, {y})"), image.pixel(x, y), [i; 3]);
        }
    }
}

#[test]
fn an_infinite_viewer_looks_along_z_of_the_eye() {
    let mut stage = Stage::new();
    stage.camera().viewer = Viewer::Infinite;
    let material = Material { specular: grey(1.0), shininess: 4.0, ..chalk(0.0) };
    stage.add(wall(9.0, 2.0), material);
    // l = (3, 0, 4)/5, h = (3, 0, 9)/√90, n·h = 9/√90.
    stage.sun(DirectionalLight::white(), Vec3::new(-3.0, 0.0, -4.0));
    let expected = (81.0f64 / 90.0).powi(2);
    for pixel in stage.draw(6, 6).pixels() {
        assert_close("infinite viewer", *pixel, [expected; 3]);
    }
}

#[test]
fn gouraud_interpolates_in_space_and_clamps_nothing() {
    let mut stage = Stage::new();
    stage.add(triangle(CORNERS, Some(NORMALS)), (chalk(0.5), Shading::Gouraud));
    stage.sun(axial(8.0), Vec3::NEG_Z);
    on_the_triangle(&mut stage, |found, shares| assert_close("Gouraud", found, [4.0 * shares[0]; 3]));
}

#[test]
fn phong_interpolates_and_renormalises_the_normal() {
    let mut stage = Stage::new();
    stage.add(triangle(CORNERS, Some(NORMALS)), chalk(0.5));
    stage.sun(axial(1.0), Vec3::NEG_Z);
    on_the_triangle(&mut stage, |found, [z, u, v]| {
        assert_close("Phong", found, [0.5 * z / z.hypot(u + v); 3]);
    });
}

#[test]
fn phong_interpolates_the_point() {
    let mut stage = Stage::new();
    stage.add(triangle(CORNERS, Some([Vec3::Z; 3])), chalk(1.0));
    let light = PointLight { attenuation: Attenuation::INVERSE_SQUARE, ..PointLight::white() };
    stage.world.spawn((light, GlobalTransform::from_xyz(1.0, 0.0, 0.0)));
    on_the_triangle(&mut stage, |found, shares| {
        let p: DVec3 = CORNERS.into_iter().zip(shares).map(|(corner, share)| corner.as_dvec3() * share).sum();
        let to_light = DVec3::X - p;
        let d = to_light.length();
        assert_close("point", found, [to_light.z / (d * d * d); 3]);
    });
}

#[test]
fn flat_shades_the_centroid_with_the_visible_sides_normal() {
    let [a, b, c] = CORNERS;
    let centroid = CORNERS.map(Vec3::as_dvec3).into_iter().sum::<DVec3>() / 3.0;
    let n = (b - a).as_dvec3().cross((c - a).as_dvec3()).normalize();
    let light = PointLight { attenuation: Attenuation::new(0.0, 1.0, 0.0), ..PointLight::white() };
    for (corners, kd) in [([a, b, c], 0.5), ([a, c, b], 0.25)] {
        let mut stage = Stage::new();
        let back = BackMaterial(chalk(0.25));
        stage.add(triangle(corners, Some(NORMALS)), (chalk(0.5), back, Faces::Both, Shading::Flat));
        stage.world.spawn((light, GlobalTransform::from_xyz(0.0, 1.0, 1.0)));
        let to_light = DVec3::new(0.0, 1.0, 1.0) - centroid;
        let expected = kd * n.dot(to_light) / to_light.length_squared();
        on_the_triangle(&mut stage, |found, _| assert_close("flat", found, [expected; 3]));
    }
}

#[test]
fn back_faces_take_the_back_material_and_the_flipped_normal() {
    let [a, b, c] = CORNERS;
    for shading in SHADINGS {
        for (faces, seen) in [(Faces::Front, false), (Faces::Back, true), (Faces::Both, true)] {
            let mut stage = Stage::new();
            let looks = (chalk(0.5), BackMaterial(chalk(0.25)), faces, shading);
            stage.add(triangle([a, c, b], Some([Vec3::new(0.0, -3.0, -4.0); 3])), looks);
            stage.sun(axial(1.0), Vec3::NEG_Z);
            // Flat: the plane's normal is (0, −6, 8)/10 on the side that is seen.
            let expected = if seen { 0.25 * 0.8 } else { 0.0 };
            on_the_triangle(&mut stage, |found, _| {
                let what = format!("{shading:?}, {faces:?}");
                // The given normals are kept in f32.
                assert!((found[0] - expected).abs() < 1e-7, "{what}: {found:?} instead of {expected}");
            });
        }
    }
}

#[test]
fn terms_are_evaluated_where_they_say() {
    let light = PointLight {
        ambient: grey(0.5),
        attenuation: Attenuation::new(2.0, 0.0, 0.0),
        attenuate_ambient: true,
        ..PointLight::white()
    };
    let material = Material { ambient: grey(1.0), diffuse: grey(0.5), specular: grey(0.25), ..Material::DEFAULT };
    let mut parts = Vec::new();
    for terms in [
        Terms { diffuse: Frequency::Vertex, specular: Frequency::Never },
        Terms { diffuse: Frequency::Never, specular: Frequency::Fragment },
        Terms { diffuse: Frequency::Vertex, specular: Frequency::Fragment },
        Terms { diffuse: Frequency::Never, specular: Frequency::Never },
    ] {
        let mut stage = Stage::new();
        stage.world.insert_resource(GlobalAmbient(grey(0.125)));
        let looks = (Material { emission: grey(0.0625), ..material }, Shading::Terms(terms));
        stage.add(triangle(CORNERS, Some(NORMALS)), looks);
        stage.world.spawn((light, GlobalTransform::from_xyz(0.0, 0.0, 50.0)));
        parts.push(stage.draw(24, 16));
    }
    let base = 0.0625 + 0.125;
    let shares = shares(ray(11, 8, 24, 16)).expect("on the triangle");
    let at = |part: usize| parts[part].pixel(11, 8)[0];
    assert!((at(3) - base).abs() < 1e-15, "nothing but emission and ambient");
    // The ambient that attenuates goes with the diffuse term; l of the first corner leans by (2, 1, 52).
    let diffuse = 0.25 + 0.25 * shares[0] * 52.0 / DVec3::new(2.0, 1.0, 52.0).length();
    let sideways = |corner: f64, x: f64| 0.25 * corner * (x / DVec3::new(x, 1.0, 52.0).length()).max(0.0);
    let third = 0.25 * shares[2] * 0.0;
    assert_close("diffuse", [at(0); 3], [base + diffuse + sideways(shares[1], -2.0) + third; 3]);
    assert!(at(1) > base, "a highlight");
    assert_close("both", [at(2); 3], [at(0) + at(1) - base; 3]);
}

#[test]
fn opposite_normals_fall_back_to_the_triangle() {
    let mut stage = Stage::new();
    let corners = [Vec3::new(-1.0, -1.0, -2.0), Vec3::new(1.0, -1.0, -2.0), Vec3::new(0.0, 1.0, -2.0)];
    // At the centre, half way up, the weights are 1/4, 1/4 and 1/2, and the normals cancel.
    stage.add(triangle(corners, Some([Vec3::X, Vec3::X, Vec3::NEG_X])), chalk(1.0));
    stage.sun(axial(1.0), Vec3::NEG_Z);
    assert_close("centre", stage.draw(3, 3).pixel(1, 1), [1.0; 3]);
}

#[test]
fn objects_inherit_the_cameras_defaults() {
    let mut stage = Stage::new();
    let flat = stage.add(triangle(CORNERS, Some([Vec3::X; 3])), chalk(1.0));
    stage.sun(axial(1.0), Vec3::NEG_Z);
    let camera = stage.camera;
    stage.world.entity_mut(camera).insert(Shading::Flat);
    on_the_triangle(&mut stage, |found, _| assert_close("flat", found, [0.8; 3]));
    stage.world.entity_mut(flat).insert(Shading::Gouraud);
    on_the_triangle(&mut stage, |found, _| assert_close("Gouraud", found, [0.0; 3]));
}

#[test]
fn the_background_is_where_nothing_is() {
    let mut stage = Stage::new();
    stage.camera().background = LinearRgba::rgb(0.25, 2.0, 0.5);
    stage.add(wall(1.0, 2.0), glow(1.0, 0.0, 0.0));
    let image = stage.draw(8, 8);
    assert_close("outside", image.pixel(0, 0), [0.25, 2.0, 0.5]);
    assert_close("inside", image.pixel(4, 4), [1.0, 0.0, 0.0]);
    let covered = image.covered().expect("the oracle knows");
    assert!(!covered[0] && covered[4 * 8 + 4]);
    assert_eq!(covered.iter().filter(|covered| **covered).count(), 16);
}

#[test]
fn a_missing_ambient_resource_means_its_default() {
    let mut stage = Stage::new();
    stage.world.remove_resource::<GlobalAmbient>();
    stage.add(wall(8.0, 2.0), Material { ambient: grey(1.0), ..chalk(0.0) });
    assert_close("Ga", stage.draw(2, 2).pixel(0, 0), [f64::from(0.1f32); 3]);
    // The camera's own defaults are taken as they are.
    assert_eq!(stage.camera().projection.near().to_bits(), Camera::default().projection.near().to_bits());
}
