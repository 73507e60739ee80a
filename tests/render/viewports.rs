//! Several cameras in one picture: each fills its part as if it were alone, and sees its own layers.

use crate::render::compare::{FLOAT, Failures, SRGB};
use crate::render::scene::{Lamp, scaled};
use crate::render::scene::{Scene, Thing, directional_light, glowing, material, other_material, point_light, rotated};
use crate::render::stage::Stage;
use halfway::lighting::CameraTurn;
use halfway::prelude::*;
use halfway::record::{FrameToDraw, ReferenceDrawing};
use halfway::reference::Oracle;
use halfway::reference::metrics;
use halfway::render::{
    Canvas, CanvasTarget, PendingPicture, Quantity, QuantityValues, RenderError, pick, take_quantities,
};
use std::ops::ControlFlow;

const SIZE: UVec2 = UVec2::new(97, 64);

/// A sphere, a floor and a turned cube, under a lamp and a sun.
fn scene() -> Scene {
    Scene::seen_from(Vec3::new(0.4, 1.4, 3.2), Vec3::new(0.0, -0.1, 0.0))
        .ambient(0.15)
        .with(Thing::new(UvSphere::new(0.8, 12, 6)).at(rotated(0.1, 0.2, 0.3)).with_material(material()))
        .with(Thing::new(Plane { size: 4.0, divisions: 4 }).at(Transform::from_xyz(0.0, -0.8, 0.0)))
        .with(
            Thing::new(Cuboid::default())
                .frames([scaled(0.5, 0.7, 0.4), rotated(0.4, 0.6, 0.2)])
                .with_material(other_material()),
        )
        .lit(Lamp::point(point_light(), Vec3::new(1.2, 1.6, 1.8)))
        .lit(Lamp::directional(directional_light(), Vec3::new(0.7, -1.0, -0.2)))
}

/// A camera that shares the picture.
#[derive(Clone, Copy)]
struct Sharer {
    camera: Camera,
    place: Transform,
    viewport: Viewport,
    shading: Shading,
}

/// Above at the left, a perspective; above at the right, a plan, which is drawn first; below, four samples and Renormalize,
/// with a gap at its right.
fn sharers() -> [Sharer; 3] {
    let looking = |eye: Vec3, up| Transform::from_translation(eye).looking_at(Vec3::ZERO, up);
    let blue = LinearRgba::rgb(0.05, 0.1, 0.4);
    [
        Sharer {
            camera: Camera::default(),
            place: looking(Vec3::new(0.4, 1.4, 3.2), Vec3::Y),
            viewport: Viewport::fractions([0.0, 0.0, 0.5, 0.5]),
            shading: Shading::Phong,
        },
        Sharer {
            camera: Camera { background: blue, ..Camera::orthographic(3.0) },
            place: looking(Vec3::new(0.0, 5.0, 0.0), Vec3::NEG_Z),
            viewport: Viewport::fractions([0.5, 0.0, 0.5, 0.5]).with_order(-1),
            shading: Shading::Flat,
        },
        Sharer {
            camera: Camera { samples: Samples::Four, ..Camera::perspective(0.6) },
            place: looking(Vec3::new(-2.0, 0.6, 2.4), Vec3::Y),
            viewport: Viewport::pixels([0, 32, 80, 1000]),
            shading: Shading::Gouraud,
        },
    ]
}

impl Sharer {
    /// The left edge, upper edge, width and height.
    fn part(&self) -> [u32; 4] {
        self.viewport.rectangle(SIZE.to_array()).expect("a part")
    }

    fn bundle(self) -> impl Bundle {
        (self.camera, self.place, self.viewport, self.shading)
    }
}

/// Replaces the scene's camera.
fn share(stage: &mut Stage, sharers: &[Sharer]) -> Vec<Entity> {
    let world = stage.world();
    let cameras: Vec<_> = world.query_filtered::<Entity, With<Camera>>().iter(world).collect();
    for camera in cameras {
        assert!(world.despawn(camera));
    }
    sharers.iter().map(|sharer| stage.spawn(sharer.bundle())).collect()
}

fn take(stage: &mut Stage, pixels: Pixels) -> Picture {
    stage.pixels(pixels);
    stage.try_draw().unwrap_or_else(|error| panic!("{error}"))
}

fn part(picture: &Picture, [left, top, width, height]: [u32; 4]) -> Picture {
    picture.part(UVec2::new(left, top), UVec2::new(width, height))
}

#[test]
fn each_part_is_the_picture_that_its_camera_draws_alone() {
    for pixels in [Pixels::Byte, Pixels::Float] {
        let mut stage = Stage::new(SIZE.x, SIZE.y);
        stage.set(&scene());
        share(&mut stage, &sharers());
        // The second frame keeps memory of the first.
        take(&mut stage, pixels);
        let shared = take(&mut stage, pixels);
        assert_eq!(shared.dimensions(), SIZE.into());
        let draws = stage.report().draws;
        let mut alone = 0;
        for (number, sharer) in sharers().into_iter().enumerate() {
            let [_, _, width, height] = sharer.part();
            let mut stage = Stage::new(width, height);
            stage.set(&scene());
            share(&mut stage, &[Sharer { viewport: Viewport::default(), ..sharer }]);
            let drawn = take(&mut stage, pixels);
            assert!(part(&shared, sharer.part()) == drawn, "camera {number} draws another picture among others");
            alone += stage.report().draws;
        }
        assert_eq!(draws, alone);
        let corner = part(&shared, [80, 32, 17, 32]);
        assert_eq!(corner, shared.black(UVec2::new(17, 32)), "beside the parts it is black");
    }
}

#[test]
fn each_part_is_the_oracles() {
    let mut failures = Failures::default();
    for (pixels, bars) in [(Pixels::Float, FLOAT), (Pixels::Byte, SRGB)] {
        let mut stage = Stage::new(SIZE.x, SIZE.y);
        stage.set(&scene());
        // Adapters differ in where they take four samples.
        let sharers = sharers().map(|mut sharer| {
            sharer.camera.samples = Samples::One;
            sharer
        });
        let cameras = share(&mut stage, &sharers);
        let shared = take(&mut stage, pixels);
        for (number, (&camera, sharer)) in cameras.iter().zip(&sharers).enumerate() {
            let [_, _, width, height] = sharer.part();
            let drawn = match part(&shared, sharer.part()) {
                Picture::Byte(image) => halfway::reference::Image::from_bytes(&image, Encoding::Srgb),
                Picture::Float(image) => halfway::reference::Image::from_float(&image),
            };
            let judged = |stage: &mut Stage, camera| {
                let bars = stage.rounding(bars);
                let bits = stage.grid_bits();
                stage.world().insert_resource(CameraTurn(Some(camera)));
                let oracle = Oracle::new(stage.world(), UVec2::new(width, height)).expect("an oracle");
                stage.world().insert_resource(CameraTurn(None));
                let oracle = oracle.with_clamping(bars.are_clamped());
                let expected = oracle.draw();
                metrics::judge_on_grid(&oracle, &expected, bits, &drawn, bars).expect("pictures of one size")
            };
            let verdict = judged(&mut stage, camera);
            failures.unless(verdict.is_within(), || format!("camera {number}, {pixels:?}: {verdict}"));
            // A planted fault: the turn of another camera.
            let other = judged(&mut stage, cameras[(number + 1) % cameras.len()]);
            failures.unless(!other.is_within(), || format!("camera {number}, {pixels:?}: another camera passes"));
        }
    }
    failures.finish();
}

#[test]
fn the_reference_draws_the_same_parts() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.set(&scene());
    let mut sharers = sharers();
    for sharer in &mut sharers {
        sharer.camera.samples = Samples::One;
    }
    share(&mut stage, &sharers);
    let Picture::Float(shared) = take(&mut stage, Pixels::Float) else { panic!("not a float") };
    let frame = FrameToDraw { number: 0, size: SIZE, pixels: Pixels::Float };
    let expected = ReferenceDrawing::default().picture(&mut stage.app, frame, &|_, _| ControlFlow::Continue(()));
    let Picture::Float(expected) = expected.expect("a picture") else { panic!("not a float") };
    let differ =
        |(a, b): (&image::Rgba<f32>, &image::Rgba<f32>)| a.0.iter().zip(b.0).any(|(a, b)| (a - b).abs() > 1e-3);
    let differing = shared.pixels().zip(expected.pixels()).filter(|pair| differ(*pair)).count();
    // The grid of sub-pixels decides some pixels along edges.
    assert!(differing < 40, "{differing} pixels differ");
}

#[test]
fn the_reference_has_the_quantities_of_all_parts() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.set(&scene());
    let cameras = share(&mut stage, &sharers());
    take(&mut stage, Pixels::Byte);
    let all = [Quantity::Albedo, Quantity::Coverage, Quantity::Depth];
    let drawn = take_quantities(stage.world(), &all).expect("quantities");
    let of_reference =
        |stage: &mut Stage| ReferenceDrawing::default().take_quantities(stage.world(), SIZE, &all).expect("quantities");
    let differing = |expected: &[halfway::render::QuantityImage]| -> Vec<usize> {
        let pairs = drawn.iter().zip(expected).map(|(a, b)| {
            assert_eq!((a.quantity, a.size), (b.quantity, b.size));
            let (QuantityValues::Floats(a), QuantityValues::Floats(b)) = (&a.values, &b.values) else {
                panic!("numbers")
            };
            a.iter().zip(b).filter(|(a, b)| (*a - *b).abs() > 1e-3).count()
        });
        pairs.collect()
    };
    // Edges differ: by the grid, and in the part of four samples by where these lie.
    let right = differing(&of_reference(&mut stage));
    assert!(right[0] < 600 && right[1] < 200 && right[2] < 40, "{right:?} values differ");
    // A planted fault: a camera that looks from elsewhere.
    stage.world().entity_mut(cameras[1]).insert(sharers()[0].place);
    take(&mut stage, Pixels::Byte);
    let wrong = differing(&of_reference(&mut stage));
    assert!(wrong.iter().zip(right).all(|(wrong, right)| *wrong > 200 + right), "{wrong:?} values differ");
}

#[test]
fn a_camera_that_keeps_draws_over_what_is_there() {
    let front = Thing::square(Vec3::new(0.0, 0.0, 1.0), Vec3::Z, 0.5).with_material(glowing(0.9, 0.3, 0.1));
    let mut scene = scene().with(front);
    scene.camera.background = LinearRgba::rgb(0.1, 0.6, 0.2);
    for samples in [Samples::One, Samples::Four] {
        let overlay = Sharer {
            camera: Camera { background: LinearRgba::WHITE, samples, ..Camera::default() },
            place: Transform::from_xyz(0.0, 0.0, 3.0),
            viewport: Viewport { load: Load::Keep, ..Viewport::fractions([0.5, 0.25, 0.5, 0.75]).with_order(1) },
            shading: Shading::Phong,
        };
        let main = Sharer { viewport: Viewport::default(), ..sharers()[0] };
        let mut stage = Stage::new(SIZE.x, SIZE.y);
        let things = stage.set(&scene);
        stage.world().entity_mut(things[3]).insert(Layers::layer(5));
        let cameras = share(&mut stage, &[main, overlay]);
        stage.world().entity_mut(cameras[1]).insert(Layers::layer(5));
        let kept = take(&mut stage, Pixels::Float);
        stage.world().entity_mut(cameras[1]).insert(Viewport { load: Load::Clear, ..overlay.viewport });
        let cleared = take(&mut stage, Pixels::Float);
        stage.world().despawn(cameras[1]);
        let below = take(&mut stage, Pixels::Float);
        let [Picture::Float(kept), Picture::Float(cleared), Picture::Float(below)] = [kept, cleared, below] else {
            panic!("not a float")
        };
        let (mut shown, mut mixed) = (0, 0);
        for ((x, y, kept), (cleared, below)) in kept.enumerate_pixels().zip(cleared.pixels().zip(below.pixels())) {
            // The overlay is red 0.9 on white.
            let [left, top, ..] = overlay.part();
            let is_inside = x >= left && y >= top;
            let share = if is_inside { (1.0 - cleared.0[2]) / 0.9 } else { 0.0 };
            shown += u32::from(share > 0.999);
            mixed += u32::from(share > 0.001 && share < 0.999);
            let expected =
                [0.9, 0.3, 0.1].iter().zip(below.0).map(|(color, below)| share * color + (1.0 - share) * below);
            let same = kept.0.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5);
            assert!(same, "{samples:?}, ({x}, {y}): {kept:?} over {below:?} with {share}");
        }
        assert!(shown > 100, "{shown} pixels show the overlay");
        assert_eq!(mixed > 0, samples == Samples::Four, "{mixed} pixels show it in part");
    }
}

#[test]
fn the_reference_keeps_what_is_there() {
    let front = Thing::square(Vec3::new(0.0, 0.0, 1.0), Vec3::Z, 0.5).with_material(glowing(0.9, 0.3, 0.1));
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    let things = stage.set(&scene().with(front));
    stage.world().entity_mut(things[3]).insert(Layers::layer(5));
    let [main, ..] = sharers();
    let overlay = Viewport { load: Load::Keep, ..Viewport::fractions([0.5, 0.25, 0.5, 0.75]).with_order(1) };
    let overlay = Sharer { viewport: overlay, place: Transform::from_xyz(0.0, 0.0, 3.0), ..main };
    let cameras = share(&mut stage, &[Sharer { viewport: Viewport::default(), ..main }, overlay]);
    stage.world().entity_mut(cameras[1]).insert(Layers::layer(5));
    let Picture::Byte(drawn) = take(&mut stage, Pixels::Byte) else { panic!("not bytes") };
    let frame = FrameToDraw { number: 0, size: SIZE, pixels: Pixels::Byte };
    let expected = ReferenceDrawing::default().picture(&mut stage.app, frame, &|_, _| ControlFlow::Continue(()));
    let Picture::Byte(expected) = expected.expect("a picture") else { panic!("not bytes") };
    let differ = |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 1);
    let differing = drawn.pixels().zip(expected.pixels()).filter(|pair| differ(*pair)).count();
    assert!(differing < 30, "{differing} pixels differ");
    // A planted fault: a camera that clears instead.
    stage.world().entity_mut(cameras[1]).insert(Viewport { load: Load::Clear, ..overlay.viewport });
    let Picture::Byte(cleared) = take(&mut stage, Pixels::Byte) else { panic!("not bytes") };
    let differing = cleared.pixels().zip(expected.pixels()).filter(|pair| differ(*pair)).count();
    assert!(differing > 300, "{differing} pixels differ");
}

#[test]
fn a_camera_sees_the_objects_and_lights_of_its_layers() {
    let mut failures = Failures::default();
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    let draw = |stage: &mut Stage, camera: Option<Layers>, failures: &mut Failures, row: &str| {
        let things = stage.set(&scene());
        let world = stage.world();
        let lights: Vec<_> = world.query_filtered::<Entity, With<PointLight>>().iter(world).collect();
        let cameras: Vec<_> = world.query_filtered::<Entity, With<Camera>>().iter(world).collect();
        // The cube hangs on a frame, which it takes its layer from.
        let frame = world.get::<ChildOf>(things[2]).expect("a frame").parent();
        world.entity_mut(frame).insert(Layers::layer(1));
        world.entity_mut(lights[0]).insert(Layers::layer(2).and(4));
        if let Some(layers) = camera {
            world.entity_mut(cameras[0]).insert(layers);
        }
        let picture = stage.float();
        failures.compare(row, stage, &picture, FLOAT);
        let FrameReport { objects, lights, .. } = *stage.report();
        (objects, lights)
    };
    for (row, layers, expected) in [
        ("none", None, (2, 1)),
        ("the default", Some(Layers::default()), (2, 1)),
        ("the cube's, too", Some(Layers::default().and(1)), (3, 1)),
        ("the lamp's, too", Some(Layers::default().and(4)), (2, 2)),
        ("all", Some(Layers(u32::MAX)), (3, 2)),
    ] {
        let found = draw(&mut stage, layers, &mut failures, row);
        failures.unless(found == expected, || format!("{row}: {found:?} objects and lights, expected {expected:?}"));
    }
    failures.finish();
}

#[test]
fn cameras_without_parts_of_their_own_are_refused() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.set(&scene());
    let [first, second, _] = share(&mut stage, &sharers())[..] else { panic!("three cameras") };
    stage.world().entity_mut(second).remove::<Viewport>();
    assert_eq!(stage.try_draw().err(), Some(RenderError::ManyCameras(3)));
    let message = RenderError::ManyCameras(3).to_string();
    assert!(message.contains("`Viewport`"), "{message}");
    stage.world().entity_mut(second).insert(Viewport::pixels([97, 0, 5, 5]));
    assert_eq!(stage.try_draw().err(), Some(RenderError::EmptyPicture { width: 0, height: 0 }));
    stage.world().entity_mut(second).insert(Viewport::fractions([0.5, 0.0, 0.75, 0.5]));
    let error = stage.try_draw().expect_err("a part outside").to_string();
    assert!(error.contains("Viewport.part.left + width"), "{error}");
    // One camera that has the picture for itself again.
    stage.world().despawn(second);
    let world = stage.world();
    let cameras: Vec<_> =
        world.query_filtered::<Entity, With<Camera>>().iter(world).filter(|it| *it != first).collect();
    stage.world().despawn(cameras[0]);
    stage.world().entity_mut(first).insert(Viewport::default());
    let whole = take(&mut stage, Pixels::Byte);
    let mut alone = Stage::new(SIZE.x, SIZE.y);
    alone.set(&scene());
    share(&mut alone, &[Sharer { viewport: Viewport::default(), ..sharers()[0] }]);
    assert!(take(&mut alone, Pixels::Byte) == whole);
}

/// Matrices are kept on objects from frame to frame, and cameras take turns.
#[test]
fn cameras_that_move_or_change_their_order_draw_as_if_new() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.set(&scene());
    let mut sharers = sharers();
    let cameras = share(&mut stage, &sharers);
    for step in 0_u8..6 {
        let place = &mut sharers[usize::from(step) % 3].place;
        place.translation += Vec3::new(0.1, 0.2, -0.1);
        sharers[usize::from(step + 1) % 3].viewport.order = i32::from(step) - 3;
        for (&camera, sharer) in cameras.iter().zip(&sharers) {
            stage.world().entity_mut(camera).insert((sharer.place, sharer.viewport));
        }
        let shared = take(&mut stage, Pixels::Byte);
        let mut anew = Stage::new(SIZE.x, SIZE.y);
        anew.set(&scene());
        share(&mut anew, &sharers);
        assert!(take(&mut anew, Pixels::Byte) == shared, "after step {step}");
    }
}

/// The frame of each camera is kept until its next turn. Objects have one pair of matrices for all of them.
#[test]
fn what_has_not_changed_is_kept_for_each_camera() {
    let (mut stage, mut anew) = (Stage::new(SIZE.x, SIZE.y), Stage::new(SIZE.x, SIZE.y));
    let mut sharers = sharers();
    stage.set(&scene());
    let mut cameras = share(&mut stage, &sharers);
    let mut before = None;
    let changed = |stage: &mut Stage, step: usize| {
        let world = stage.world();
        let objects: Vec<_> = world.query_filtered::<Entity, With<Mesh3d>>().iter(world).collect();
        let lamps: Vec<_> = world.query_filtered::<Entity, With<PointLight>>().iter(world).collect();
        let mut put = |entities: &[Entity], place: Transform| {
            for &entity in entities {
                world.entity_mut(entity).insert(place);
            }
        };
        match step {
            // Objects stand, and their matrices are needed again.
            2 => put(&lamps, Transform::from_xyz(-1.0, 1.0, 2.0)),
            3 => {
                for &object in &objects {
                    world.entity_mut(object).insert(other_material());
                }
            }
            // Out of sight.
            5 => put(&objects, Transform::from_xyz(0.0, 0.0, 500.0)),
            7 => put(&objects, rotated(-0.2, 0.3, 0.1)),
            9 => _ = world.despawn(objects[0]),
            _ => {}
        }
    };
    for step in 0..11 {
        match step {
            4 => sharers[2].place.translation.x += 0.2,
            // The last is drawn first, and last again after objects have come.
            6 => sharers[2].viewport.order = -5,
            8 => sharers[2].viewport.order = 0,
            10 => {
                // One goes, and comes as another.
                let gone = cameras.remove(0);
                stage.world().despawn(gone);
                take(&mut stage, Pixels::Byte);
                cameras.insert(0, stage.spawn(sharers[0].bundle()));
            }
            _ => {}
        }
        for (&camera, sharer) in cameras.iter().zip(&sharers) {
            let mut camera = stage.world().entity_mut(camera);
            if camera.get() != Some(&sharer.place) || camera.get() != Some(&sharer.viewport) {
                camera.insert((sharer.place, sharer.viewport));
            }
        }
        changed(&mut stage, step);
        let shared = take(&mut stage, Pixels::Byte);
        assert_eq!(stage.report().matrices == 0, [1, 2, 3, 5, 6].contains(&step), "in step {step}");
        let of_last = part(&shared, sharers[2].part());
        let differs = before.replace(of_last.clone()) != Some(of_last);
        assert_eq!(differs, [0, 2, 3, 4, 5, 7, 9].contains(&step), "step {step} shows");
        anew.set(&scene());
        (0..=step).for_each(|step| changed(&mut anew, step));
        share(&mut anew, &sharers);
        assert!(take(&mut anew, Pixels::Byte) == shared, "after step {step}");
        // Nothing has changed since.
        assert!(take(&mut stage, Pixels::Byte) == shared, "again after step {step}");
        assert_eq!(stage.report().matrices, 0, "again after step {step}");
    }
}

#[test]
fn quantities_are_those_of_the_camera_that_shows_a_pixel() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    let things = stage.set(&scene());
    share(&mut stage, &sharers());
    take(&mut stage, Pixels::Byte);
    let all = [Quantity::Depth, Quantity::Id, Quantity::Normal];
    let shared = take_quantities(stage.world(), &all).expect("quantities");
    for sharer in sharers() {
        let [left, top, width, height] = sharer.part();
        let mut alone = Stage::new(width, height);
        alone.set(&scene());
        share(&mut alone, &[Sharer { viewport: Viewport::default(), ..sharer }]);
        take(&mut alone, Pixels::Byte);
        for (shared, alone) in shared.iter().zip(take_quantities(alone.world(), &all).expect("quantities")) {
            let channels = shared.quantity.channels().len();
            for y in 0..height {
                let from = channels * ((top + y) * SIZE.x + left) as usize;
                let row = channels * (y * width) as usize;
                let length = channels * width as usize;
                let same = match (&shared.values, &alone.values) {
                    (QuantityValues::Floats(a), QuantityValues::Floats(b)) => a[from..][..length] == b[row..][..length],
                    (QuantityValues::Numbers(a), QuantityValues::Numbers(b)) => {
                        a[from..][..length] == b[row..][..length]
                    }
                    _ => false,
                };
                assert!(same, "{:?}, row {y} of {width} × {height}", shared.quantity);
            }
        }
    }
    // The sphere in the middle of the plan, and nothing beside the parts.
    let found = pick(stage.world(), 72, 16).expect("surfaces").expect("a surface");
    assert!(things.contains(&found.entity) && (found.depth - 4.2).abs() < 0.1, "{found:?}");
    assert_eq!(pick(stage.world(), 90, 60).expect("surfaces"), None);
}

#[test]
fn pictures_that_are_read_later_and_windows_show_all_cameras() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.set(&scene());
    share(&mut stage, &sharers());
    let taken = take(&mut stage, Pixels::Byte);
    let mut pending = PendingPicture::request(stage.app.world()).expect("a picture");
    let read = loop {
        if let Some(picture) = pending.try_take().expect("a picture") {
            break picture;
        }
    };
    assert!(read == taken && pending.try_take() == Ok(None));

    let mut stage = Stage::on_the_cpu(8, 8);
    stage.set(&scene());
    let cameras = share(&mut stage, &sharers());
    stage.app.insert_resource(CanvasTarget { size: SIZE });
    let mut on_the_cpu = Stage::on_the_cpu(SIZE.x, SIZE.y);
    on_the_cpu.set(&scene());
    share(&mut on_the_cpu, &sharers());
    let Picture::Byte(taken) = take(&mut on_the_cpu, Pixels::Byte) else { panic!("not bytes") };
    for _ in 0..2 {
        assert_eq!(stage.frame().errors, []);
        let (size, bytes) = stage.app.world().resource::<Canvas>().bytes().expect("a frame");
        assert!(size == SIZE && bytes == &taken.as_raw()[..]);
    }
    for &camera in &cameras[1..] {
        assert!(stage.world().despawn(camera));
    }
    stage.world().entity_mut(cameras[0]).remove::<Viewport>();
    assert_eq!(stage.frame().errors, []);
    let (size, bytes) = stage.app.world().resource::<Canvas>().bytes().expect("a frame");
    assert!(size == SIZE && bytes != &taken.as_raw()[..]);
}
