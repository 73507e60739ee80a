//! Pipelines built in the background: no frame waits for its specialised ones, and pictures do not change.

use crate::render::compare::{FLOAT, Failures, assert_identical};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, other_material, point_light};
use crate::render::stage::Stage;
use halfway::prelude::*;

/// A ball under two lights.
fn ball() -> Scene {
    Scene::seen_from(Vec3::Z * 3.0, Vec3::ZERO)
        .ambient(0.1)
        .with(Thing::new(UvSphere::new(1.0, 16, 8)))
        .lit(Lamp::point(point_light(), Vec3::new(3.0, 4.0, 5.0)))
        .lit(Lamp::directional(directional_light(), Vec3::NEG_Z))
}

/// A stage on which pipelines are built beside the frames, as in a window.
fn stage() -> Stage {
    let mut stage = Stage::new(24, 24);
    stage.world().insert_resource(Compile::Beside);
    stage
}

/// Pipelines built, those pending, and those that the frame waited for.
fn counts(stage: &Stage) -> (u32, u32, u32) {
    let report = stage.report();
    assert_eq!(report.errors, []);
    assert_eq!(report.pipelines, report.pipelines_live, "nothing is given up here");
    (report.pipelines, report.pipelines_pending, report.pipelines_awaited)
}

/// Of an object with both terms: three shadings by two reflectances.
const RELATIVES: u32 = 6;

#[test]
fn the_second_frame_requests_generic_pipelines() {
    let mut stage = stage();
    let first = stage.draw(&ball());
    assert_eq!(counts(&stage), (1, 0, 1));
    let second = stage.float();
    assert_eq!(counts(&stage), (1, RELATIVES, 0));
    stage.compile();
    let last = stage.float();
    assert_eq!(counts(&stage), (1 + RELATIVES, 0, 0));
    assert_eq!(stage.report().lights_assigned, 0, "its own pipeline draws, which has the lights compiled in");
    assert_identical("the second frame", &first, &second);
    assert_identical("the last frame", &first, &last);
}

#[test]
fn frames_without_anything_to_draw_do_not_count_as_the_first() {
    let mut stage = stage();
    let scene = ball();
    stage.set(&Scene { things: Vec::new(), ..scene.clone() });
    stage.frame();
    stage.frame();
    assert_eq!(counts(&stage), (0, 0, 0));
    stage.draw(&scene);
    assert_eq!((counts(&stage), stage.report().lights_assigned), ((1, 0, 1), 0));
}

#[test]
fn a_new_kind_is_drawn_at_once_and_by_its_own_pipeline_in_time() {
    let rows: [(&str, bool, fn(&mut Scene)); 13] = [
        ("a shininess that is a power of two", true, |scene| scene.things[0].material.shininess = 32.0),
        ("one light less", true, |scene| scene.lamps.truncate(1)),
        ("one light more", true, |scene| {
            scene.lamps.push(Lamp::point(point_light(), Vec3::new(-3.0, 0.0, 3.0)));
        }),
        ("a range", true, |scene| {
            scene.lamps[0] = Lamp::point(PointLight { range: Some(9.0), ..point_light() }, Vec3::new(2.0, 2.0, 3.0));
        }),
        ("an ambient that attenuates", true, |scene| {
            scene.lamps[0] = Lamp::point(PointLight { attenuate_ambient: true, ..point_light() }, Vec3::ONE * 2.0);
        }),
        ("lights of one colour each", true, |scene| {
            scene.lamps[0] = Lamp::point(PointLight::white(), Vec3::ONE * 2.0);
            scene.lamps[1] = Lamp::directional(DirectionalLight::white(), Vec3::NEG_Z);
        }),
        ("Phong's reflectance", true, |scene| scene.view_reflectance = Some(Reflectance::Phong)),
        ("flat shading", true, |scene| scene.view_shading = Some(Shading::Flat)),
        ("Gouraud shading", true, |scene| scene.view_shading = Some(Shading::Gouraud)),
        // The generic pipelines of these are not built in advance.
        ("without a highlight", false, |scene| scene.things[0].material.specular = LinearRgba::BLACK),
        ("an infinite viewer", false, |scene| scene.camera.viewer = Viewer::Infinite),
        ("both faces", false, |scene| {
            scene.things[0].faces = Some(Faces::Both);
            scene.things[0].back = Some(other_material());
        }),
        ("blended", false, |scene| scene.things[0].blend = true),
    ];
    let mut failures = Failures::default();
    for (row, foreseen, change) in rows {
        let mut stage = stage();
        let mut scene = ball();
        scene.view_shading = Some(Shading::Phong);
        stage.draw(&scene);
        stage.compile();
        change(&mut scene);
        failures.draw(&format!("{row}, generic"), &mut stage, &scene, FLOAT);
        let generic = u32::from(!foreseen);
        assert_eq!(counts(&stage), (1 + RELATIVES + generic, 1, generic), "{row}");
        // Specialised pipelines have their lights compiled in; generic ones read lists.
        assert!(stage.report().lights_assigned > 0, "{row} is not drawn by a generic pipeline");
        stage.compile();
        let picture = stage.float();
        let (built, pending, awaited) = counts(&stage);
        assert_eq!((pending, awaited, stage.report().lights_assigned), (0, 0, 0), "{row}");
        assert!(built > 1 + RELATIVES, "{row}");
        let mut now = Stage::new(24, 24);
        assert_identical(row, &now.draw(&scene), &picture);
        assert_eq!(counts(&now), (1, 0, 1), "{row}");
    }
    failures.finish();
}

#[test]
fn no_frame_after_the_first_waits_in_a_scene_that_changes() {
    let mut stage = stage();
    let mut scene = ball();
    stage.draw(&scene);
    stage.compile();
    let before = stage.report().pipelines;
    let mut asked = 0;
    for shininess in [8.0, 16.0, 21.0] {
        for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
            for reflectance in [Reflectance::Phong, Reflectance::BlinnPhong] {
                for lamps in [1, 2] {
                    scene.things[0].material.shininess = shininess;
                    (scene.view_shading, scene.view_reflectance) = (Some(shading), Some(reflectance));
                    stage.set(&Scene { lamps: scene.lamps[..lamps].to_vec(), ..scene.clone() });
                    let report = stage.frame();
                    assert_eq!((report.errors.as_slice(), report.pipelines_awaited), (&[][..], 0));
                    asked += 1;
                }
            }
        }
    }
    stage.compile();
    // One of each existed before: the first frame's.
    assert_eq!(counts(&stage), (before + asked - 1, 0, 0));
}

#[test]
fn records_are_looked_up_once_the_pipeline_for_it_is_there() {
    let mut scene = Scene::in_eye_space().ambient(0.2).lit(Lamp::point(point_light(), Vec3::new(0.3, 0.2, 0.0)));
    for i in 0_u8..6 {
        let at = Vec3::new(f32::from(i) * 0.2 - 0.5, 0.1, -2.0 - f32::from(i) * 0.1);
        let mut thing = Thing::square(at, Vec3::Z, 0.8).blended(0.5);
        thing.material.diffuse.red = f32::from(i) * 0.1;
        scene = scene.with(thing);
    }
    let mut stage = stage();
    let mut failures = Failures::default();
    failures.draw("a draw each", &mut stage, &scene, FLOAT);
    assert_eq!((stage.report().draws, counts(&stage)), (6, (1, 0, 1)));
    stage.compile();
    let picture = stage.float();
    failures.compare("one draw", &mut stage, &picture, FLOAT);
    failures.finish();
    // Two that look up records, its own and the generic one.
    assert_eq!((stage.report().draws, counts(&stage)), (1, (1 + RELATIVES + 2, 0, 0)));
}

#[test]
fn both_sides_of_what_is_blended_change_pipelines_together() {
    let mut scene = ball();
    scene.things[0] = scene.things[0].clone().blended(0.5).faces(Faces::Both).back(other_material());
    let mut stage = stage();
    stage.draw(&scene);
    assert_eq!(counts(&stage), (2, 0, 2));
    stage.compile();
    assert_eq!(counts(&stage), (2 + 2 * RELATIVES, 0, 0));
    scene.lamps.truncate(1);
    let mut failures = Failures::default();
    failures.draw("generic", &mut stage, &scene, FLOAT);
    failures.finish();
    assert_eq!(counts(&stage), (2 + 2 * RELATIVES, 2, 0));
    stage.compile();
    assert_eq!(counts(&stage), (4 + 2 * RELATIVES, 0, 0));
    assert_identical("its own", &Stage::new(24, 24).draw(&scene), &stage.float());
}

#[test]
fn headless_pictures_wait_for_pipelines_by_default() {
    let mut stage = Stage::new(24, 24);
    let mut scene = ball();
    for (lamps, built) in [(2, 1), (1, 2), (0, 3)] {
        scene.lamps.truncate(lamps);
        stage.draw(&scene);
        assert_eq!((counts(&stage), stage.report().lights_assigned), ((built, 0, 1), 0));
    }
    stage.world().insert_resource(Compile::Beside);
    let mut scene = ball();
    scene.things[0].material.shininess = 32.0;
    stage.draw(&scene);
    // It waited for the generic one alone, which reads lists.
    assert_eq!(counts(&stage), (3 + 1, 1, 1));
    assert!(stage.report().lights_assigned > 0);
}

#[test]
fn many_lights_build_only_the_pipelines_that_draw() {
    let mut scene = Scene::in_eye_space().with(Thing::square(Vec3::NEG_Z * 2.0, Vec3::Z, 1.0));
    for i in 0..12_u8 {
        scene = scene.lit(Lamp::point(point_light(), Vec3::new(0.1 * f32::from(i), 0.2, 0.0)));
    }
    let mut stage = stage();
    stage.draw(&scene);
    assert_eq!(counts(&stage), (1, 0, 1));
    stage.compile();
    assert_eq!(counts(&stage), (1 + RELATIVES, 0, 0));
    scene.things[0].material.shininess = 32.0;
    let mut failures = Failures::default();
    failures.draw("generic", &mut stage, &scene, FLOAT);
    failures.finish();
    assert_eq!(counts(&stage), (1 + RELATIVES, 1, 0));
    stage.compile();
    assert_identical("its own", &Stage::new(24, 24).draw(&scene), &stage.float());
    assert_eq!(counts(&stage), (1 + RELATIVES + 1, 0, 0));
}
