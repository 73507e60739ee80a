//! Edge cases of the equations on the adapter: equal to f64 where that is defined, finite everywhere.

use std::f32::consts::FRAC_PI_2;

use crate::render::compare::{FLOAT, Failures, assert_finite, brightest};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, material, point_light};
use crate::render::stage::Stage;
use halfway::prelude::*;
use halfway::reference::metrics::Bars;

const SHADINGS: [Shading; 3] = [Shading::Flat, Shading::Gouraud, Shading::Phong];
const REFLECTANCES: [Reflectance; 3] = [Reflectance::Phong, Reflectance::BlinnPhong, Reflectance::BlinnPhongMatched];

/// A mesh of one triangle or more with the normals given.
pub(crate) fn mesh(positions: &[[f32; 3]], normals: &[[f32; 3]], indices: &[u32]) -> Mesh {
    let vectors = |of: &[[f32; 3]]| of.iter().copied().map(Vec3::from_array).collect::<Vec<_>>();
    Mesh::from_parts(vectors(positions), Some(vectors(normals)), None, indices.to_vec()).expect("a valid mesh")
}

/// A square at z = −4 that fills a picture of the default camera, with one normal at all corners.
pub(crate) fn screen(normals: [[f32; 3]; 4]) -> Mesh {
    let positions = [[-2.0, -2.0, -4.0], [2.0, -2.0, -4.0], [2.0, 2.0, -4.0], [-2.0, 2.0, -4.0]];
    mesh(&positions, &normals, &[0, 1, 2, 0, 2, 3])
}

pub(crate) fn unweakened() -> PointLight {
    PointLight { attenuation: Attenuation::NONE, ..point_light() }
}

#[test]
fn a_light_on_the_surface_shines_along_the_normal() {
    // With the camera at the origin, eye space is world space to the bit, and so is the distance 0.
    let toward_eye = [[0.0, 0.0, 1.0]; 3];
    let triangle = mesh(&[[-3.0, -3.0, -4.0], [3.0, -3.0, -4.0], [0.0, 6.0, -4.0]], &toward_eye, &[0, 1, 2]);
    let lights = [
        ("no falloff", unweakened()),
        ("1/(1 + …)", point_light()),
        ("inverse square", PointLight { attenuation: Attenuation::INVERSE_SQUARE, ..point_light() }),
        ("a range", PointLight { range: Some(2.0), ..point_light() }),
        ("a tiny range", PointLight { range: Some(1e-37), ..point_light() }),
        ("attenuated ambient", PointLight { attenuate_ambient: true, ..point_light() }),
    ];
    let mut stage = Stage::new(33, 33);
    let mut failures = Failures::default();
    for (name, light) in lights {
        for reflectance in REFLECTANCES {
            // Flat shades the centroid, Gouraud the corners.
            for (shading, at) in
                [(Shading::Flat, Vec3::new(0.0, 0.0, -4.0)), (Shading::Gouraud, Vec3::new(-3.0, -3.0, -4.0))]
            {
                for cone in [None, Some(Cone { cutoff: FRAC_PI_2, inner: Some(0.5), exponent: 2.0 })] {
                    let lamp = match cone {
                        None => Lamp::point(light, at),
                        Some(cone) => Lamp::spot(SpotLight { light, cone }, at, Vec3::new(0.5, 0.2, -1.0)),
                    };
                    let thing = Thing::new(triangle.clone()).shaded(shading).reflecting(reflectance);
                    let scene = Scene::in_eye_space().ambient(0.1).with(thing).lit(lamp);
                    let row = format!("{name}, {shading:?}, {reflectance:?}, cone {}", cone.is_some());
                    failures.draw(&row, &mut stage, &scene, FLOAT);
                }
            }
            // Under Phong the light is at a pixel's centre, where rounding decides which way it shines.
            let thing = Thing::new(triangle.clone()).reflecting(reflectance);
            let scene = Scene::in_eye_space().with(thing).lit(Lamp::point(light, Vec3::new(0.0, 0.0, -4.0)));
            assert_finite(&format!("{name}, Phong, {reflectance:?}"), &stage.draw(&scene));
        }
    }
    failures.finish();
}

#[test]
fn a_light_opposite_the_viewer_makes_no_highlight() {
    // Normals that face away from the eye, as a smooth silhouette may have, and a light behind the surface: n·l > 0
    // with l = −v.
    let away = Thing::new(screen([[0.0, 0.0, -1.0]; 4]));
    let mut stage = Stage::new(33, 33);
    let mut failures = Failures::default();
    for shading in [Shading::Gouraud, Shading::Phong] {
        for reflectance in REFLECTANCES {
            for shininess in [0.0, 0.5, 1.0, 19.5, 64.0] {
                let material = Material { shininess, ..material() };
                let thing = away.clone().with_material(material).shaded(shading).reflecting(reflectance);
                let row = format!("{shading:?}, {reflectance:?}, shininess {shininess}");
                let behind = Lamp::directional(directional_light(), Vec3::Z);
                let mut scene = Scene::in_eye_space().with(thing.clone()).lit(behind);
                scene.camera.viewer = Viewer::Infinite;
                failures.draw(&format!("everywhere, {row}"), &mut stage, &scene, FLOAT);
                let scene = Scene::in_eye_space().with(thing).lit(Lamp::point(unweakened(), Vec3::NEG_Z * 9.0));
                assert_finite(&format!("at the centre, {row}"), &stage.draw(&scene));
            }
        }
    }
    failures.finish();
}

#[test]
fn a_shininess_of_zero_lights_all_that_faces_the_light() {
    // 0⁰ = 1: also where the reflection is perpendicular to the view, or farther.
    let mut stage = Stage::new(48, 48);
    let mut failures = Failures::default();
    for shading in SHADINGS {
        for reflectance in REFLECTANCES {
            for lamp in [
                Lamp::directional(directional_light(), Vec3::new(-1.0, -0.1, 0.3)),
                Lamp::directional(directional_light(), Vec3::new(-0.2, -0.4, -1.0)),
            ] {
                let sphere = Thing::new(UvSphere::new(1.0, 24, 12)).shaded(shading).reflecting(reflectance);
                let scene = Scene::seen_from(Vec3::new(0.2, 0.3, 3.0), Vec3::ZERO)
                    .with(sphere.with_material(Material { shininess: 0.0, ..material() }))
                    .lit(lamp);
                failures.draw(&format!("{shading:?}, {reflectance:?}"), &mut stage, &scene, FLOAT);
            }
        }
    }
    failures.finish();
}

#[test]
fn every_shininess_keeps_its_highlight() {
    let mut stage = Stage::new(48, 48);
    let mut failures = Failures::default();
    for shininess in [0.0, 0.3, 1.0, 1.5, 2.0, 3.7, 8.0, 32.0, 32.0001, 100.0, 128.0, 1000.5, 8192.0, 1e4, 65536.0, 1e5]
    {
        // A cosine near 1 is known to 2·10⁻⁷ in f32, and the exponent multiplies what is missing; a matched exponent is
        // four times as large. Without a highlight of that size, the bars of everything else.
        let rounding = 4.0 * 2e-7 * f64::from(shininess);
        let bars = Bars { most: FLOAT.most + rounding, worst: FLOAT.worst + rounding, ..FLOAT };
        for reflectance in REFLECTANCES {
            let sphere = Thing::new(UvSphere::new(1.0, 96, 48)).reflecting(reflectance);
            let scene = Scene::seen_from(Vec3::new(0.0, 0.0, 2.6), Vec3::ZERO)
                .with(sphere.with_material(Material { shininess, ..material() }))
                // From beside the eye, so that the highlight is near the centre.
                .lit(Lamp::point(unweakened(), Vec3::new(0.3, 0.2, 3.0)));
            failures.draw(&format!("{shininess}, {reflectance:?}"), &mut stage, &scene, bars);
        }
    }
    failures.finish();
}

/// The part of the unit sphere about +Z that is `width` radians wide, in `n` × `n` cells.
fn part_of_a_sphere(n: u32, width: f32) -> Mesh {
    let at = |i: u32| width * (i as f32 / n as f32 - 0.5);
    let points = (0..=n).flat_map(|j| (0..=n).map(move |i| Vec3::new(at(i).tan(), at(j).tan(), 1.0).normalize()));
    let points: Vec<Vec3> = points.collect();
    let cells = (0..n).flat_map(|j| (0..n).map(move |i| j * (n + 1) + i));
    let indices = cells.flat_map(|a| [a, a + 1, a + n + 2, a, a + n + 2, a + n + 1]).collect();
    Mesh::from_parts(points.clone(), Some(points), None, indices).expect("a part of a sphere")
}

#[test]
fn a_shininess_of_ten_thousand_on_a_fine_mesh() {
    // A highlight half a degree wide over triangles of a fifth of a degree, under every frequency.
    let mut stage = Stage::new(64, 64);
    let mut failures = Failures::default();
    let mesh = part_of_a_sphere(64, 0.2);
    let rounding = 4.0 * 2e-7 * 1e4;
    for shading in SHADINGS {
        for reflectance in REFLECTANCES {
            let sphere = Thing::new(mesh.clone()).shaded(shading).reflecting(reflectance);
            let sphere = sphere.with_material(Material { shininess: 1e4, specular: LinearRgba::WHITE, ..material() });
            let mut scene = Scene::seen_from(Vec3::new(0.0, 0.0, 1.3), Vec3::ZERO)
                .with(sphere)
                .lit(Lamp::point(unweakened(), Vec3::new(0.03, 0.02, 1.4)));
            scene.camera.projection = Projection::perspective(0.3);
            let row = format!("{shading:?}, {reflectance:?}");
            let bars = Bars { most: FLOAT.most + rounding, worst: FLOAT.worst + rounding, ..FLOAT };
            let picture = stage.draw(&scene);
            failures.compare(&row, &mut stage, &picture, bars);
            // kd·Ld + ks·Ls of green; between two vertices most of the second is lost, but there is more than the
            // first.
            let peak = if shading == Shading::Phong { 1.3 } else { 0.7 };
            failures.unless(brightest(&picture) > peak, || format!("{row}: the peak is {}", brightest(&picture)));
        }
    }
    failures.finish();
}

#[test]
fn the_peak_of_a_highlight_is_never_lost() {
    // n, l and v all along z in the centre of an odd picture: S = 1 whatever the exponent.
    let mut stage = Stage::new(33, 33);
    for shininess in [0.0, 1.0, 31.9, 32.0, 1e4, 1e5, 1e8, 1e20, 1e38] {
        for reflectance in REFLECTANCES {
            let thing = Thing::new(screen([[0.0, 0.0, 1.0]; 4])).reflecting(reflectance);
            let thing = thing.with_material(Material { shininess, diffuse: LinearRgba::BLACK, ..material() });
            let scene = Scene::in_eye_space().with(thing).lit(Lamp::directional(directional_light(), Vec3::NEG_Z));
            let picture = stage.draw(&scene);
            let row = format!("shininess {shininess:e}, {reflectance:?}");
            assert_finite(&row, &picture);
            let expected = 0.4 * 0.6 + 0.02 + 0.15 * 0.1;
            let peak = picture.get_pixel(16, 16).0[0];
            // The pixel's centre is the axis to 10⁻⁷ rad, whose square is lost to rounding; 10⁻³ of ks·Ls for an
            // adapter's logarithm of 1.
            assert!((peak - expected).abs() < 3e-4, "{row}: {peak}, expected {expected}");
            // ks·Ls of the brightest channel, and what is not specular.
            assert!(brightest(&picture) <= 0.6 + 0.1, "{row}: brighter than the light, {}", brightest(&picture));
        }
    }
}

#[test]
fn cones_at_the_ends_of_their_range() {
    let rows = [
        ("half a space", Cone { cutoff: FRAC_PI_2, inner: None, exponent: 0.0 }),
        ("half a space with an exponent", Cone { cutoff: FRAC_PI_2, inner: None, exponent: 0.5 }),
        ("half a space with an inner cone", Cone { cutoff: FRAC_PI_2, inner: Some(0.0), exponent: 1.0 }),
        ("inner as wide as the cutoff", Cone { cutoff: 0.4, inner: Some(0.4), exponent: 0.0 }),
        ("inner nearly as wide", Cone { cutoff: 0.4, inner: Some(0.399_999), exponent: 0.0 }),
        ("exponent 0", Cone { cutoff: 0.3, inner: None, exponent: 0.0 }),
        ("exponent 128", Cone { cutoff: 0.6, inner: None, exponent: 128.0 }),
        ("exponent 10⁴", Cone { cutoff: 0.6, inner: None, exponent: 1e4 }),
        ("narrow", Cone { cutoff: 0.05, inner: Some(0.01), exponent: 1.0 }),
    ];
    let mut stage = Stage::new(48, 48);
    let mut failures = Failures::default();
    for (name, cone) in rows {
        for shading in SHADINGS {
            // Beside the wall of squares: a part of it is behind the light.
            let lamp = Lamp::spot(
                SpotLight { light: unweakened(), cone },
                Vec3::new(0.6, 0.3, -3.2),
                Vec3::new(-0.6, -0.3, -0.4),
            );
            let wall = Thing::new(Plane { size: 5.0, divisions: 9 }).shaded(shading);
            let wall = wall.at(Transform::from_xyz(0.0, 0.0, -4.0).with_rotation(Quat::from_rotation_x(FRAC_PI_2)));
            let scene = Scene::in_eye_space().ambient(0.1).with(wall).lit(lamp);
            // A cosine is known to 10⁻⁷; the exponent, and the steepness of a narrow fade, multiply that.
            let rounding = 2e-7 * f64::from(cone.exponent) + if cone.cutoff < 0.1 { 1e-3 } else { 0.0 };
            let bars = Bars { most: FLOAT.most + rounding, worst: FLOAT.worst + rounding, ..FLOAT };
            failures.draw(&format!("{name}, {shading:?}"), &mut stage, &scene, bars);
        }
    }
    failures.finish();
}

#[test]
fn a_cutoff_of_zero_lights_the_axis_alone() {
    let mut stage = Stage::new(33, 33);
    let thing = Thing::new(screen([[0.0, 0.0, 1.0]; 4])).with_material(Material::matte(LinearRgba::WHITE));
    for cone in [Cone::new(0.0), Cone { cutoff: 0.0, inner: Some(0.0), exponent: 3.0 }] {
        let light = PointLight { attenuation: Attenuation::NONE, ..PointLight::white() };
        let spot = Lamp::spot(SpotLight { light, cone }, Vec3::ZERO, Vec3::NEG_Z);
        let picture = stage.draw(&Scene::in_eye_space().with(thing.clone()).lit(spot));
        for (x, y, pixel) in picture.enumerate_pixels() {
            let expected = if (x, y) == (16, 16) { 1.0 } else { 0.0 };
            assert!((pixel.0[0] - expected).abs() < 1e-6, "{cone:?}: pixel ({x}, {y}) is {:?}", pixel.0);
        }
    }
}

#[test]
fn a_light_very_near_a_surface_is_bounded() {
    let mut stage = Stage::new(48, 48);
    let mut failures = Failures::default();
    let wall = Thing::new(screen([[0.0, 0.0, 1.0]; 4]));
    let light = |attenuation| PointLight { attenuation, ..point_light() };
    for (name, attenuation) in [
        ("inverse square", Attenuation::INVERSE_SQUARE),
        ("inverse", Attenuation::new(0.0, 1.0, 0.0)),
        ("a tiny constant", Attenuation::new(1e-30, 0.0, 0.0)),
        ("a huge constant", Attenuation::new(1e30, 0.0, 0.0)),
    ] {
        for shading in SHADINGS {
            for gap in [0.5, 0.05, 1e-3, 1e-5, 1e-7, 0.0] {
                let lamp = Lamp::point(light(attenuation), Vec3::new(0.05, 0.03, -4.0 + gap));
                let scene = Scene::in_eye_space().with(wall.clone().shaded(shading)).lit(lamp);
                let row = format!("{name}, {gap} before the wall, {shading:?}");
                let picture = stage.draw(&scene);
                assert_finite(&row, &picture);
                // 10⁶ is the attenuation's cap; (kd·Ld + ks·Ls) < 1.3.
                assert!(brightest(&picture) <= 1.3e6, "{row}: {}", brightest(&picture));
                if gap >= 0.05 {
                    failures.compare(&row, &mut stage, &picture, FLOAT);
                }
            }
        }
    }
    failures.finish();
}

#[test]
fn lights_farther_than_the_root_of_f32_max_keep_direction() {
    // d² overflows f32 from 1.8·10¹⁹ on.
    let mut stage = Stage::new(24, 24);
    let mut failures = Failures::default();
    let direction = Vec3::new(0.3, 0.5, 0.8);
    for distance in [1e10, 1e18, 1e19, 1e20, 1e25, 1e30, 3e38] {
        for shading in SHADINGS {
            for (name, lamp) in [
                ("point", Lamp::point(unweakened(), direction * distance)),
                ("attenuated", Lamp::point(point_light(), direction * distance)),
                ("ranged", Lamp::point(PointLight { range: Some(3e38), ..unweakened() }, direction * distance)),
                (
                    "spot",
                    Lamp::spot(
                        SpotLight { light: unweakened(), cone: Cone::new(0.5) },
                        direction * distance,
                        -direction,
                    ),
                ),
            ] {
                let sphere = Thing::new(UvSphere::new(1.0, 16, 8)).shaded(shading);
                let scene = Scene::seen_from(Vec3::Z * 3.0, Vec3::ZERO).with(sphere).lit(lamp);
                failures.draw(&format!("{name}, {distance:e} away, {shading:?}"), &mut stage, &scene, FLOAT);
            }
        }
    }
    failures.finish();
}

// More than eight are read from a list. A clamp of each coordinate would turn their directions by 21°.
#[test]
fn nine_lights_at_f32_max_keep_their_directions() {
    let mut stage = Stage::new(48, 48);
    let mut failures = Failures::default();
    let dim = LinearRgba::rgb(0.2, 0.15, 0.1);
    let light = PointLight { ambient: LinearRgba::BLACK, diffuse: dim, specular: dim, ..unweakened() };
    let [x, y, z] = [0.3, 0.5, 0.8].map(|coordinate| coordinate * 1e38);
    for shading in SHADINGS {
        let sphere = Thing::new(UvSphere::new(1.0, 16, 8)).shaded(shading);
        let mut scene = Scene::seen_from(Vec3::Z * 3.0, Vec3::ZERO).with(sphere);
        for at in
            [[x, y, z], [-x, y, z], [x, -y, z], [-x, -y, z], [y, x, z], [-y, x, z], [x, z, y], [z, x, y], [z, y, x]]
        {
            scene = scene.lit(Lamp::point(light, Vec3::from_array(at)));
        }
        failures.draw(&format!("{shading:?}"), &mut stage, &scene, FLOAT);
        // All nine at one position, as in the scene that failed.
        let mut scene = Scene { lamps: vec![], ..scene };
        for _ in 0..9 {
            scene = scene.lit(Lamp::point(light, Vec3::new(x, y, z)));
        }
        failures.draw(&format!("{shading:?}, at one place"), &mut stage, &scene, FLOAT);
    }
    failures.finish();
}
