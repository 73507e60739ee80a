//! Levels of detail: with a tolerance, fewer triangles where more would not show.

use crate::render::compare::assert_identical;
use crate::render::scene::{Lamp, Scene, Thing, directional_light, material, point_light};
use crate::render::stage::Stage;
use halfway::prelude::*;
use halfway::reference::Oracle;

const PIXELS: Tolerance = Tolerance { steps: 0.0, pixels: 1.0 };

fn sphere(segments: u32) -> Mesh {
    UvSphere::new(1.0, segments, segments / 2).into()
}

/// A ball of 36,540 triangles with hills and noise, as a scan has them.
fn rough_ball() -> Mesh {
    let smooth = Mesh::from(UvSphere::new(1.0, 192, 96));
    let random = |p: Vec3| {
        let mix = |all: u32, x: f32| (all ^ (x + 2.0).to_bits()).wrapping_mul(0x9E37_79B1).rotate_left(13);
        p.to_array().into_iter().fold(7, mix) as f32 / u32::MAX as f32
    };
    let moved = smooth.displaced(|i| {
        let p = smooth.positions()[i];
        0.05 * (3.0 * p.x + 1.0).sin() * (4.0 * p.y).sin() + 0.01 * (random(p) - 0.5)
    });
    moved.expect("finite heights").0
}

/// One thing at the origin, lit from two sides.
fn one(thing: Thing, distance: f32) -> Scene {
    Scene::seen_from(Vec3::new(0.2, 0.35, 0.9).normalize() * distance, Vec3::ZERO)
        .ambient(0.1)
        .with(thing.with_material(material()))
        .lit(Lamp::directional(directional_light(), Vec3::new(-0.6, -0.7, -1.0)))
        .lit(Lamp::point(point_light(), Vec3::new(-3.0, 2.0, 4.0)))
}

/// Triangles drawn in the first frame of the scene, and triangles modelled.
fn triangles(stage: &mut Stage, scene: &Scene, tolerance: Tolerance) -> (u64, u64) {
    stage.world().insert_resource(ViewTolerance(tolerance));
    stage.set(scene);
    stage.frame();
    assert_eq!((stage.report().levels_pending, stage.report().errors.len()), (0, 0));
    (stage.report().triangles, stage.report().triangles_in)
}

#[test]
fn farther_objects_are_drawn_with_fewer_triangles() {
    let mut stage = Stage::new(64, 64);
    let mut before = u64::MAX;
    for distance in [4.0, 16.0, 64.0] {
        let thing = Thing::new(sphere(256)).shaded(Shading::Phong).faces(Faces::Both);
        let (drawn, modelled) = triangles(&mut stage, &one(thing, distance), PIXELS);
        println!("distance {distance}: {drawn} of {modelled} triangles");
        assert_eq!(modelled, 256 * 127 * 2);
        assert!(drawn < before && drawn < modelled, "distance {distance}: {drawn} after {before}");
        before = drawn;
    }
}

#[test]
fn more_pixels_mean_fewer_triangles() {
    let mut stage = Stage::new(64, 64);
    for (row, mesh) in [("smooth", sphere(256)), ("rough", rough_ball())] {
        let scene = one(Thing::new(mesh).shaded(Shading::Phong).faces(Faces::Both), 6.0);
        let pixels = [4.0, 1.0, 0.25, 0.1, 0.05, 0.01, 0.0];
        let drawn = pixels.map(|pixels| triangles(&mut stage, &scene, Tolerance { steps: 0.0, pixels }));
        println!("{row}: {drawn:?}");
        // No part of the surface is drawn at two levels: then there could be more than all.
        assert!(drawn.is_sorted() && drawn[0] < drawn[2] && drawn[2] < drawn[6], "{row}: {drawn:?}");
        assert_eq!(drawn[6].0, drawn[6].1, "{row}: 0 pixels");
    }
}

#[test]
fn nothing_is_simplified_unless_asked_for() {
    let mut stage = Stage::new(64, 64);
    let scene = one(Thing::new(sphere(128)).shaded(Shading::Phong).faces(Faces::Both), 40.0);
    stage.world().insert_resource(ViewTolerance::default());
    let plain = stage.draw(&scene);
    assert_eq!(stage.report().triangles, stage.report().triangles_in);
    let (drawn, modelled) = triangles(&mut stage, &scene, PIXELS);
    assert!(drawn < modelled / 2, "{drawn} of {modelled}");
    // Levels that are there stay unused.
    let (drawn, modelled) = triangles(&mut stage, &scene, Tolerance::EXACT);
    assert_eq!(drawn, modelled);
    assert_identical("off again", &plain, &stage.float());
}

/// In every process and by any number of threads, since a picture that is read back waits for its levels.
#[test]
fn the_first_picture_has_its_levels() {
    let scene = one(Thing::new(rough_ball()).shaded(Shading::Phong), 12.0);
    let [first, second] = [0, 1].map(|_| {
        let mut stage = Stage::new(48, 48);
        stage.world().insert_resource(ViewTolerance(PIXELS));
        let first = stage.draw(&scene);
        assert!(stage.report().triangles < stage.report().triangles_in / 2, "{:?}", stage.report());
        let second = stage.float();
        assert_identical("the second picture", &first, &second);
        assert_eq!(stage.report().bytes_uploaded, 0, "everything was there");
        first
    });
    assert_identical("another App", &first, &second);
}

#[test]
fn flat_gouraud_and_blended_objects_keep_all_triangles() {
    let rows: [(&str, Thing, bool); 6] = [
        ("Phong", Thing::new(sphere(128)).shaded(Shading::Phong), false),
        ("mirrored", Thing::new(sphere(128)).at(Transform::from_scale(Vec3::new(-1.0, 1.0, 1.0))), false),
        ("stretched", Thing::new(sphere(128)).at(Transform::from_scale(Vec3::new(1.0, 1.5, 1.0))), false),
        ("Gouraud", Thing::new(sphere(128)).shaded(Shading::Gouraud), true),
        ("flat", Thing::new(sphere(128)).shaded(Shading::Flat), true),
        ("blended", Thing::new(sphere(128)).blended(0.5), true),
    ];
    for (row, thing, all) in rows {
        let mut stage = Stage::new(48, 48);
        let blend = thing.blend;
        let mut scene = one(thing.faces(Faces::Both), 40.0);
        scene.things[0].blend = blend;
        let (drawn, modelled) = triangles(&mut stage, &scene, PIXELS);
        // Blended ones are drawn twice, far sides first.
        let whole = if blend { 2 * modelled } else { modelled };
        assert!(if all { drawn == whole } else { drawn < modelled / 2 }, "{row}: {drawn} of {modelled}");
    }
}

#[test]
fn an_object_has_a_tolerance_of_its_own() {
    let mut stage = Stage::new(48, 48);
    let scene = one(Thing::new(sphere(128)).shaded(Shading::Phong).faces(Faces::Both), 40.0);
    let (drawn, modelled) = triangles(&mut stage, &scene, PIXELS);
    let world = stage.world();
    let object = world.query_filtered::<Entity, With<Mesh3d>>().single(world).expect("one object");
    world.entity_mut(object).insert(Tolerance::EXACT);
    stage.frame();
    assert_eq!(stage.report().triangles, modelled);
    stage.world().entity_mut(object).remove::<Tolerance>();
    stage.frame();
    assert_eq!(stage.report().triangles, drawn);
}

/// The share of triangles drawn, and how many times as far a picture within so many pixels is from the truth as the
/// exact picture: RMS over the pixels off the outline. The truth is the mesh in 16 × 16 samples a pixel.
fn share_and_error(pixels: f32) -> (f64, f64) {
    let scene = one(Thing::new(rough_ball()).shaded(Shading::Phong), 6.0);
    let mut stage = Stage::on_the_cpu(40, 40);
    let picture = |stage: &mut Stage, tolerance: Tolerance| {
        stage.world().insert_resource(ViewTolerance(tolerance));
        let picture = stage.draw(&scene);
        (picture, stage.report().triangles)
    };
    let (exact, all) = picture(&mut stage, Tolerance::EXACT);
    let size = stage.world().resource::<Headless>().size;
    let truth = Oracle::new(stage.world(), size).expect("a scene").with_supersampling(16).draw();
    let (coarse, few) = picture(&mut stage, Tolerance { steps: 0.0, pixels });
    let background = exact.get_pixel(0, 0).0;
    let rms = |picture: &image::Rgba32FImage| {
        let (mut sum, mut count) = (0.0, 0);
        for y in 1..39 {
            for x in 1..39 {
                let around = (0..9).map(|i| exact.get_pixel(x + i % 3 - 1, y + i / 3 - 1).0);
                if around.into_iter().all(|pixel| pixel != background) {
                    let (found, expected) = (picture.get_pixel(x, y).0, truth.pixels()[(40 * y + x) as usize]);
                    sum += (0..3).map(|c| (f64::from(found[c]) - expected[c]).powi(2)).sum::<f64>();
                    count += 3;
                }
            }
        }
        assert!(count > 400, "{count} values inside");
        (sum / f64::from(count)).sqrt()
    };
    (few as f64 / all as f64, rms(&coarse) / rms(&exact))
}

#[test]
fn a_pixel_halves_the_triangles_and_hardly_adds_to_the_error() {
    let (share, error) = share_and_error(1.0);
    println!("{share:.2} of the triangles, {error:.2} of the error");
    assert!(share <= 0.5 && error <= 1.15, "{share:.2} of the triangles, {error:.2} of the error");
    // A tolerance that is too large is detected.
    let (share, error) = share_and_error(24.0);
    assert!(share < 0.2 && error > 1.2, "within 24 pixels: {share:.2} of the triangles, {error:.2} of the error");
}
