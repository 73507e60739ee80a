//! Solid textures match the oracle, objects without them do not pay for them, and detail finer than a pixel fades.

use crate::render::compare::{FLOAT, judge};
use crate::render::conformance::solids::solid;
use crate::render::scene::{Lamp, Scene, Thing, material, point_light};
use crate::render::stage::Stage;
use halfway::prelude::*;
use halfway::reference::Image;

const SHADINGS: [Shading; 3] = [Shading::Flat, Shading::Gouraud, Shading::Phong];

fn scene(shading: Shading, solid: Option<SolidTexture>) -> Scene {
    let thing = Thing { solid, ..Thing::new(UvSphere::new(1.0, 24, 12)) };
    let mut scene = Scene::seen_from(Vec3::new(0.4, 1.0, 3.0), Vec3::ZERO)
        .ambient(0.2)
        .with(thing)
        .lit(Lamp::point(point_light(), Vec3::new(1.2, 1.6, 1.8)));
    scene.view_shading = Some(shading);
    scene
}

#[test]
fn objects_without_a_solid_cost_no_more_beside_one() {
    for shading in SHADINGS {
        let mut stage = Stage::new(64, 48);
        let alone = stage.draw(&scene(shading, None));
        let pipelines = stage.report().pipelines;
        // Behind the other, and so invisible.
        let mut both = scene(shading, None);
        let behind = Thing { solid: Some(solid(SolidKind::Marble)), ..Thing::new(UvSphere::new(0.1, 6, 3)) };
        both.things.push(behind.at(Transform::from_xyz(-0.2, -0.5, -1.5)));
        let beside = stage.draw(&both);
        assert!(beside == alone, "{shading:?}");
        // On the CPU there are none.
        assert!(stage.is_on_cpu() || stage.report().pipelines > pipelines, "{shading:?}: the solid has one of its own");
    }
}

#[test]
fn a_solid_of_one_color_is_another_material() {
    let times = |color: LinearRgba| LinearRgba::rgb(0.25 * color.red, 0.5 * color.green, color.blue);
    let own = Material { ambient: times(material().ambient), diffuse: times(material().diffuse), ..material() };
    let mut stage = Stage::new(64, 48);
    for shading in SHADINGS {
        for kind in SolidKind::ALL {
            let even = SolidTexture { colors: [[0.25, 0.5, 1.0]; 2], ..solid(kind) };
            let cut = stage.draw(&scene(shading, Some(even)));
            let mut plain = scene(shading, None);
            plain.things[0].material = own;
            let plain = stage.draw(&plain);
            let most = cut.iter().zip(plain.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(most < 2e-6, "{shading:?}, {kind:?}: {most:e}");
        }
    }
}

#[test]
fn a_picture_of_another_solid_is_found() {
    let mut stage = Stage::new(64, 48);
    for kind in SolidKind::ALL {
        let right = solid(kind);
        let mut moved = right;
        moved.solid_from_object[0][3] += 0.02;
        let mut paler = right;
        paler.colors[1][0] -= 0.02;
        let other = SolidKind::ALL[(kind as usize + 1) % SolidKind::ALL.len()];
        let mut wrongs =
            vec![Some(moved), Some(paler), Some(right.scaled(1.02)), Some(SolidTexture { kind: other, ..right }), None];
        if matches!(kind, SolidKind::Marble | SolidKind::Noise) {
            wrongs.push(Some(right.with_octaves(1)));
        }
        for (number, wrong) in wrongs.into_iter().enumerate() {
            let picture = stage.draw(&scene(Shading::Phong, wrong));
            stage.set(&scene(Shading::Phong, Some(right)));
            stage.frame();
            let (verdict, _) = judge(&mut stage, &Image::from_float(&picture), FLOAT.until_wrong());
            assert!(!verdict.is_within(), "{kind:?}, {number}: {verdict}");
        }
    }
}

#[test]
fn numbers_that_cannot_be_used_are_refused_by_name() {
    let right = solid(SolidKind::Wood);
    let mut no_place = right;
    no_place.solid_from_object[1][2] = f32::INFINITY;
    let mut too_bright = right;
    too_bright.colors[1][2] = 1.5;
    for (wrong, says) in [
        (right.with_octaves(0), "SolidTexture.octaves: the value is 0.0; expected 1 to 16"),
        (right.with_octaves(17), "SolidTexture.octaves: the value is 17.0; expected 1 to 16"),
        (no_place, "SolidTexture.solid_from_object: the value is inf; expected finite numbers"),
        (too_bright, "SolidTexture.colors: the value is 1.5; expected 0 to 1"),
    ] {
        let mut stage = Stage::new(64, 48);
        stage.set(&scene(Shading::Phong, Some(wrong)));
        let errors: Vec<String> = stage.frame().errors.iter().map(ToString::to_string).collect();
        assert!(errors.len() == 1 && errors[0].contains(says), "{errors:?}");
        let size = UVec2::new(64, 48);
        let refused = halfway::reference::Oracle::new(stage.world(), size).expect_err("refused too").to_string();
        assert!(refused.contains(says), "{refused}");
    }
}

/// Where positions or their derivatives overflow, the color is the mean of both, as for any solid seen from afar.
#[test]
fn a_solid_that_is_too_fine_for_numbers_has_its_mean() {
    let mut stage = Stage::new(64, 48);
    for kind in SolidKind::ALL {
        for scale in [1e21, 1e30, 1e37] {
            let [first, second] = solid(kind).colors;
            let mean = [0, 1, 2].map(|c| 0.5 * (first[c] + second[c]));
            let fine = stage.draw(&scene(Shading::Phong, Some(solid(kind).scaled(scale))));
            let even = stage.draw(&scene(Shading::Phong, Some(SolidTexture { colors: [mean; 2], ..solid(kind) })));
            let most = fine.iter().zip(even.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(most < 1e-4, "{kind:?} × {scale:e}: {most:e}");
        }
    }
}

#[test]
fn a_solid_stays_with_its_object() {
    // Turned with the camera and the light, the object looks the same.
    let mut stage = Stage::new(64, 48);
    let turn = Transform::from_rotation(Quat::from_rotation_y(0.7)).with_translation(Vec3::new(0.3, -0.2, 0.1));
    for kind in SolidKind::ALL {
        let still = scene(Shading::Phong, Some(solid(kind)));
        let mut turned = still.clone();
        turned.eye = turn * still.eye;
        turned.things[0].frames = vec![turn];
        turned.lamps[0].at = turn * still.lamps[0].at;
        let (still, turned) = (stage.draw(&still), stage.draw(&turned));
        let off = still.iter().zip(turned.iter()).filter(|(a, b)| (*a - *b).abs() > 1e-3).count();
        // But for pixels at the outline.
        assert!(off < still.len() / 200, "{kind:?}: {off} of {}", still.len());
    }
}

/// The reference picture is this many times as large along each side.
const N: u32 = 9;

/// The mean over each block of N × N pixels, and the one in its middle.
fn reduced(fine: &Image) -> [Vec<[f64; 3]>; 2] {
    let (width, height) = fine.dimensions();
    let mut both = [Vec::new(), Vec::new()];
    for (y, x) in (0..height / N).flat_map(|y| (0..width / N).map(move |x| (y, x))) {
        let block = || (0..N * N).map(|k| fine.pixel(N * x + k % N, N * y + k / N));
        let share = 1.0 / f64::from(N * N);
        both[0].push([0, 1, 2].map(|c| block().map(|pixel| share * pixel[c]).sum::<f64>()));
        both[1].push(fine.pixel(N * x + N / 2, N * y + N / 2));
    }
    both
}

fn rms<'a>(a: &[[f64; 3]], b: impl Iterator<Item = &'a [f64; 3]>) -> f64 {
    let squares = a.iter().zip(b).flat_map(|(a, b)| (0..3).map(|c| (a[c] - b[c]).powi(2)));
    (squares.sum::<f64>() / (3 * a.len()) as f64).sqrt()
}

/// The error of faded patterns relative to one sample a pixel is below this; it is 0.361.
const MOST_OFF: f64 = 0.4;

/// A checkered floor to the horizon, against the mean of 81 samples a pixel, whose footprints are a ninth as long.
#[test]
fn a_checkered_floor_has_no_moire() {
    let [width, height] = [96, 64];
    let place = Mat4::from_translation(Vec3::new(0.3, 0.2, 0.1)) * Mat4::from_rotation_y(0.35);
    let solid = SolidTexture::new(SolidKind::Checker, [[0.0; 3], [1.0; 3]]).placed(place.to_cols_array_2d());
    let floor = Thing { solid: Some(solid), ..Thing::new(Plane { size: 400.0, divisions: 1 }) };
    let mut scene = Scene::seen_from(Vec3::new(0.0, 1.5, 0.0), Vec3::new(0.0, 0.9, -2.0)).ambient(1.0);
    scene =
        scene.with(floor.with_material(Material { ambient: LinearRgba::WHITE, ..Material::matte(LinearRgba::BLACK) }));
    let mut stage = Stage::new(width, height);
    let picture = Image::from_float(&stage.draw(&scene));
    stage.target_size(N * width, N * height);
    stage.frame();
    let [truth, point] = reduced(&stage.oracle().draw());
    let [faded, unfaded] = [rms(&truth, picture.pixels().iter()), rms(&truth, point.iter())];
    println!("RMS {faded:.4} faded, {unfaded:.4} by one sample, a factor of {:.3}", faded / unfaded);
    assert!(unfaded > 0.1, "the floor is finer than pixels: {unfaded}");
    assert!(faded < MOST_OFF * unfaded, "{faded} of {unfaded}");
}
