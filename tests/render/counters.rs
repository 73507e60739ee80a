//! The counters of a frame: no work is done twice, or for invisible objects.

use crate::render::compare::{Failures, assert_as_expected, assert_identical};
use crate::render::scene::{Lamp, Scene, Thing, directional_light, other_material, point_light};
use crate::render::stage::Stage;
use halfway::prelude::*;

/// A row-by-column of an affine matrix and a normal matrix, as 32-bit floats, and a number.
const INSTANCE_BYTES: u64 = 4 * (12 + 9 + 1);

/// Ten by ten equal spheres at one depth.
fn crowd() -> Scene {
    let mut scene = Scene::seen_from(Vec3::Z * 14.0, Vec3::ZERO).ambient(0.1);
    let sphere = Thing::new(UvSphere::new(0.4, 8, 4));
    for i in 0..100 {
        let at = Vec3::new((i % 10) as f32 - 4.5, (i / 10) as f32 - 4.5, 0.0);
        scene.things.push(sphere.clone().at(Transform::from_translation(at)));
    }
    scene
        .lit(Lamp::point(point_light(), Vec3::new(3.0, 4.0, 5.0)))
        .lit(Lamp::directional(directional_light(), Vec3::NEG_Z))
}

#[test]
fn a_hundred_equal_objects_are_one_draw() {
    let mut stage = Stage::new(32, 32);
    stage.draw(&crowd());
    let report = stage.report();
    assert_eq!((report.objects, report.visible, report.draws, report.materials, report.lights), (100, 100, 1, 1, 2));
    assert_eq!(report.triangles, 100 * 2 * 8 * 3);
    assert_eq!(report.matrices, 100);
    assert_eq!(report.errors, []);
    // The CPU has no pipelines.
    assert_eq!(report.pipelines, u32::from(!stage.is_on_cpu()));
}

#[test]
fn draws_are_as_many_as_differ() {
    let mut stage = Stage::new(16, 16);
    stage.draw(&crowd());
    let rows: [(&str, fn(usize, &mut Thing), u32, u32); 8] = [
        ("three materials", |i, thing| thing.material.shininess = (i % 3 + 5) as f32, 1, 3),
        ("two sides of a material", |i, thing| thing.back = (i % 2 == 0).then(other_material), 1, 1),
        (
            "two sides shown",
            |i, thing| {
                thing.back = (i % 2 == 0).then(other_material);
                thing.faces = Some(Faces::Both);
            },
            1,
            2,
        ),
        (
            "two meshes",
            |i, thing| {
                if i % 2 == 0 {
                    thing.mesh = Cuboid::default().into();
                }
            },
            2,
            1,
        ),
        (
            "three shadings",
            |i, thing| thing.shading = Some([Shading::Flat, Shading::Gouraud, Shading::Phong][i % 3]),
            3,
            1,
        ),
        ("two reflectances", |i, thing| thing.reflectance = (i % 2 == 0).then_some(Reflectance::Phong), 2, 1),
        ("mirrored and not", |i, thing| thing.frames[0].scale.x = if i % 2 == 0 { 1.0 } else { -1.0 }, 2, 1),
        ("all blended", |_, thing| thing.blend = true, 1, 1),
    ];
    for (row, change, draws, materials) in rows {
        let mut scene = crowd();
        scene.things.iter_mut().enumerate().for_each(|(i, thing)| change(i, thing));
        stage.draw(&scene);
        let report = stage.report();
        assert_eq!((report.draws, report.materials, report.visible), (draws, materials, 100), "{row}");
    }
}

#[test]
fn equal_meshes_of_many_materials_are_one_draw() {
    let mut scene = Scene::seen_from(Vec3::Z * 40.0, Vec3::ZERO)
        .ambient(0.1)
        .lit(Lamp::point(point_light(), Vec3::new(3.0, 4.0, 5.0)))
        .lit(Lamp::directional(directional_light(), Vec3::NEG_Z));
    for i in 0..600 {
        let mut thing = Thing::new(UvSphere::new(0.4, 8, 4));
        let part = i as f32 / 600.0;
        thing.material.diffuse = LinearRgba::rgb(part, 1.0 - part, 0.5);
        thing.material.shininess = 4.5 + part;
        let at = Vec3::new((i % 30) as f32 - 14.5, (i / 30) as f32 - 9.5, 0.0);
        scene.things.push(thing.at(Transform::from_translation(at)));
    }
    let mut stage = Stage::new(96, 64);
    for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
        for blend in [false, true] {
            scene.view_shading = Some(shading);
            for thing in &mut scene.things {
                thing.blend = blend;
                thing.material.opacity = if blend { 0.7 } else { 1.0 };
            }
            let row = format!("{shading:?}, blended {blend}");
            stage.draw(&scene);
            let report = stage.report();
            assert_eq!((report.draws, report.materials, report.visible), (1, 600, 600), "{row}");
            assert_as_expected(&row, &mut stage, &scene);
        }
    }
}

#[test]
fn an_equal_frame_computes_and_uploads_nothing() {
    let mut stage = Stage::new(32, 32);
    let mut scene = crowd();
    for (i, thing) in scene.things.iter_mut().enumerate() {
        thing.shading = Some([Shading::Flat, Shading::Gouraud, Shading::Phong][i % 3]);
        thing.blend = i % 7 == 0;
    }
    stage.set(&scene);
    let first = stage.float();
    // The CPU reads instances where they are.
    let instances = if stage.is_on_cpu() { 0 } else { 100 };
    assert!(stage.report().bytes_uploaded > instances * INSTANCE_BYTES);
    let pipelines = stage.report().pipelines;
    for frame in 0..3 {
        let again = stage.float();
        let report = stage.report();
        let counts = (report.bytes_uploaded, report.matrices, report.pipelines, report.visible);
        assert_eq!(counts, (0, 0, pipelines, 100), "frame {frame} after the first");
        assert_identical("again", &first, &again);
    }
}

#[test]
fn a_change_uploads_only_the_changed_bytes() {
    let mut stage = Stage::new(32, 32);
    let things = stage.set(&crowd());
    stage.float();
    let mut after = |row: &str,
                     change: &mut dyn FnMut(&mut World),
                     matrices: u32,
                     bytes: std::ops::RangeInclusive<u64>| {
        change(stage.world());
        stage.frame();
        let report = stage.report();
        assert_eq!(report.matrices, matrices, "{row}");
        assert!(bytes.contains(&report.bytes_uploaded), "{row} uploads {} bytes, not {bytes:?}", report.bytes_uploaded);
    };
    let middle = things[47];
    after("nothing", &mut |_| (), 0, 0..=0);
    after(
        "one object moved aside",
        &mut |world| world.get_mut::<Transform>(middle).unwrap().translation.x += 0.1,
        1,
        4..=INSTANCE_BYTES,
    );
    after(
        "one object written but not moved",
        &mut |world| world.get_mut::<Transform>(middle).unwrap().set_changed(),
        0,
        0..=0,
    );
    after(
        "one light dimmed",
        &mut |world| {
            let mut lights = world.query::<&mut PointLight>();
            lights.single_mut(world).unwrap().diffuse = LinearRgba::rgb(0.2, 0.3, 0.4);
        },
        0,
        // Three channels of one light.
        4..=12,
    );
    after(
        "one object's name",
        &mut |world| {
            world.entity_mut(middle).insert(Name::new("named"));
        },
        0,
        0..=0,
    );
    after("the target's shape", &mut |world| world.resource_mut::<Headless>().size.x = 40, 0, 4..=16);
    after("the background", &mut |world| set_background(world, 0.5), 0, 0..=0);
    after(
        "all materials",
        &mut |world| world.query::<&mut Material>().iter_mut(world).for_each(|mut material| material.diffuse.red = 0.1),
        0,
        4..=256,
    );
    after(
        "the camera",
        &mut |world| {
            let mut cameras = world.query_filtered::<&mut Transform, With<Camera>>();
            cameras.single_mut(world).unwrap().translation.x += 0.5;
        },
        100,
        // Every instance, and the lights, which are in eye space.
        50 * INSTANCE_BYTES..=100 * INSTANCE_BYTES + 2 * 96,
    );
}

fn set_background(world: &mut World, grey: f32) {
    let mut cameras = world.query::<&mut Camera>();
    cameras.single_mut(world).unwrap().background = LinearRgba::rgb(grey, grey, grey);
}

#[test]
fn pipelines_do_not_grow_when_a_scene_repeats_itself() {
    let mut stage = Stage::new(16, 16);
    let mut count = 0;
    for round in 0..3 {
        for shading in [Shading::Flat, Shading::Gouraud, Shading::Phong] {
            for lamps in [0, 1, 2] {
                let mut scene = crowd();
                scene.view_shading = Some(shading);
                scene.lamps.truncate(lamps);
                stage.set(&scene);
                stage.float();
            }
        }
        if round > 0 {
            assert_eq!(stage.report().pipelines, count, "round {round}");
        }
        count = stage.report().pipelines;
    }
    // Three shadings by two lists, and one for no lights at all, whatever the shading.
    assert_eq!(count, 7);
}

#[test]
fn numbers_alone_make_no_pipelines() {
    let mut stage = Stage::new(16, 16);
    let mut scene = crowd();
    scene.things.truncate(1);
    stage.draw(&scene);
    let count = stage.report().pipelines;
    let changes: [(&str, fn(&mut Scene)); 7] = [
        ("a colour", |scene| scene.things[0].material.diffuse.red = 0.3),
        ("a shininess", |scene| scene.things[0].material.shininess = 21.0),
        ("an opacity that is ignored", |scene| scene.things[0].material.opacity = 0.5),
        ("a place", |scene| scene.things[0].frames[0].translation.x = 0.3),
        ("a scale", |scene| scene.things[0].frames[0].scale.y = 0.3),
        ("a light's place", |scene| scene.lamps[0].at.translation.y = 0.3),
        ("the ambient", |scene| scene.ambient.red = 0.3),
    ];
    for (row, change) in changes {
        let mut changed = scene.clone();
        change(&mut changed);
        stage.draw(&changed);
        assert_eq!(stage.report().pipelines, count, "{row}");
    }
}

#[test]
fn objects_outside_the_frustum_are_not_drawn() {
    // A picture twice as wide as high, 90° high: |y| ≤ depth, |x| ≤ 2·depth. A sphere's box has a radius of √3.
    let reach = 3f32.sqrt();
    let beside = |slope: f32, distance: f32| {
        // The point at `distance` outside of the plane |x| = slope·depth, on its normal from depth 10.
        let plane = Vec3::new(slope * 10.0, 0.0, -10.0);
        plane + Vec3::new(1.0, 0.0, slope).normalize() * distance
    };
    let upward = |p: Vec3| Vec3::new(0.0, p.x, p.z);
    let rows = [
        ("ahead", Vec3::NEG_Z * 10.0, Some(true)),
        ("very far ahead", Vec3::NEG_Z * 1e5, None),
        ("behind", Vec3::Z * 10.0, Some(false)),
        ("just behind", Vec3::Z * (reach + 0.01), Some(false)),
        ("around the camera", Vec3::Z * 0.5, None),
        ("partly right", beside(2.0, 0.8), Some(true)),
        ("right", beside(2.0, reach * 1.001), Some(false)),
        ("partly left", beside(2.0, 0.8) * Vec3::new(-1.0, 1.0, 1.0), Some(true)),
        ("left", beside(2.0, reach * 1.001) * Vec3::new(-1.0, 1.0, 1.0), Some(false)),
        ("partly above", upward(beside(1.0, 0.8)), Some(true)),
        ("above", upward(beside(1.0, reach * 1.001)), Some(false)),
        ("partly below", upward(beside(1.0, 0.8)) * Vec3::new(1.0, -1.0, 1.0), Some(true)),
        ("below", upward(beside(1.0, reach * 1.001)) * Vec3::new(1.0, -1.0, 1.0), Some(false)),
    ];
    let mut stage = Stage::new(192, 96);
    for (row, at, seen) in rows {
        let mut scene = Scene::in_eye_space()
            .with(Thing::new(UvSphere::new(1.0, 24, 12)).at(Transform::from_translation(at)))
            .lit(Lamp::directional(directional_light(), Vec3::NEG_Z));
        scene.camera.projection = Projection::perspective(std::f32::consts::FRAC_PI_2);
        let picture = stage.draw(&scene);
        let report = stage.report();
        assert_eq!(report.objects, 1, "{row}");
        let shows = picture.pixels().any(|pixel| pixel.0[0] > 0.0);
        match seen {
            // Visible parts must have been drawn, and culled ones must not.
            Some(true) => {
                assert!(shows && report.visible == 1 && report.draws == 1, "{row}: shows {shows}, {report:?}");
            }
            Some(false) => assert!(!shows && report.visible == 0 && report.draws == 0, "{row}: {report:?}"),
            None => assert_eq!((report.visible, report.draws), (1, 1), "{row}"),
        }
    }
}

#[test]
fn visible_sheared_objects_are_never_culled() {
    // A long thin object whose centre is far outside and whose end is in the middle of the picture.
    let mut stage = Stage::new(32, 32);
    let turn = Transform::from_rotation(Quat::from_rotation_z(0.7));
    let long = Transform::from_scale(Vec3::new(60.0, 0.2, 0.2));
    let rows = [
        ("stretched", vec![Transform::from_xyz(29.8, 0.0, -5.0).with_scale(Vec3::new(60.0, 0.2, 0.2))]),
        ("mirrored", vec![Transform::from_xyz(29.8, 0.0, -5.0).with_scale(Vec3::new(-60.0, 0.2, 0.2))]),
        ("sheared", vec![Transform::from_xyz(21.0, 0.0, -5.0), long, turn]),
        (
            "a parent's",
            vec![
                Transform::from_xyz(0.0, 29.8, -5.0),
                Transform::from_rotation(Quat::from_rotation_z(std::f32::consts::FRAC_PI_2)),
                long,
            ],
        ),
    ];
    for (row, frames) in rows {
        let scene = Scene::in_eye_space()
            .with(Thing::new(Cuboid::default()).frames(frames))
            .lit(Lamp::directional(directional_light(), Vec3::NEG_Z));
        let picture = stage.draw(&scene);
        assert_eq!(stage.report().visible, 1, "{row}");
        assert_as_expected(row, &mut stage, &scene);
        assert!(picture.get_pixel(16, 16).0[0] > 0.0, "{row} does not reach the centre");
    }
}

#[test]
fn shaders_hold_only_the_features_of_their_draw() {
    // Each of these is a variant of its own beside the plain one.
    let rows: [(&str, fn(&mut Scene)); 10] = [
        ("without a highlight", |scene| scene.things[0].material.specular = LinearRgba::BLACK),
        ("a shininess that is a power of two", |scene| scene.things[0].material.shininess = 32.0),
        ("Phong's reflectance", |scene| scene.view_reflectance = Some(Reflectance::Phong)),
        ("an infinite viewer", |scene| scene.camera.viewer = Viewer::Infinite),
        ("one light less", |scene| scene.lamps.truncate(1)),
        ("a range", |scene| scene.lamps[0] = Lamp::point(PointLight { range: Some(9.0), ..point_light() }, Vec3::ONE)),
        ("an ambient that attenuates", |scene| {
            scene.lamps[0] = Lamp::point(PointLight { attenuate_ambient: true, ..point_light() }, Vec3::ONE);
        }),
        ("lights of one colour each", |scene| {
            scene.lamps[0] = Lamp::point(PointLight::white(), Vec3::ONE);
            scene.lamps[1] = Lamp::directional(DirectionalLight::white(), Vec3::NEG_Z);
        }),
        ("both faces", |scene| scene.things[0].faces = Some(Faces::Both)),
        ("four samples", |scene| scene.camera.samples = Samples::Four),
    ];
    let mut failures = Failures::default();
    for shading in [Shading::Gouraud, Shading::Phong] {
        for (row, change) in rows {
            let mut stage = Stage::new(16, 16);
            let mut scene = crowd();
            scene.things.truncate(1);
            scene.view_shading = Some(shading);
            stage.draw(&scene);
            change(&mut scene);
            stage.draw(&scene);
            let pipelines = stage.report().pipelines;
            failures.unless(pipelines == 2, || format!("{row}, {shading:?}: {pipelines} pipelines"));
        }
    }
    failures.finish();
}
