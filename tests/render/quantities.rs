//! The surface that each pixel shows, and pictures of its properties, against the oracle's and closed forms.

use crate::render::compare::{FLOAT, Failures};
use crate::render::conformance::colors::colored;
use crate::render::conformance::solids::solid;
use crate::render::scene::{Map, Scene, Thing, glowing, other_material, rotated, scaled};
use crate::render::sides::hemisphere;
use crate::render::stage::Stage;
use bevy_math::{DVec2, DVec3};
use halfway::lighting::Choices;
use halfway::prelude::*;
use halfway::reference::metrics::{self, Bars, Verdict};
use halfway::reference::{Image, Nearest, Oracle, Shows};
use halfway::render::{Quantity, QuantityImage, QuantityValues, SurfacePoint, Surfaces, pick, take_quantities};
use halfway::texture::TexelImage;
use std::collections::HashSet;

const SIZE: UVec2 = UVec2::new(96, 72);

/// Instances of one mesh, one of many patches, mirrored and sheared ones, a bowl seen from both sides, a mask, and a
/// pane before them.
fn scene(camera: Camera) -> Scene {
    let ball = UvSphere::new(0.4, 12, 6);
    let fine = Thing::new(UvSphere::new(0.7, 160, 80)).at(Transform::from_xyz(-1.0, 0.6, -1.0));
    let holes = TexelImage::from_fn(8, 8, |x, y| [f32::from((x / 2 + y / 2) % 2 == 0); 4]).expect("an image");
    let mut grate = Thing::square(Vec3::new(0.9, -0.4, 0.9), Vec3::new(-0.2, 0.1, 1.0), 1.1);
    grate.mask = Some(0.5);
    grate.maps = vec![(MapKind::Opacity, Map::new(holes))];
    let scene = Scene::seen_from(Vec3::new(0.3, 0.9, 4.2), Vec3::ZERO)
        .with(Thing::new(ball).at(Transform::from_xyz(0.9, 0.7, -0.4)))
        .with(fine)
        .with(Thing::new(ball).frames([scaled(1.3, 0.6, 1.0), rotated(0.3, 0.4, 0.9)]))
        .with(Thing::new(ball).at(Transform::from_xyz(0.2, -0.8, 0.4).with_scale(Vec3::new(-1.2, 0.8, 1.0))))
        .with(Thing::new(hemisphere(16, 8)).at(Transform::from_xyz(-1.1, -0.6, 0.2)).faces(Faces::Both))
        .with(grate)
        .with(Thing::square(Vec3::new(-0.4, 0.0, 1.6), Vec3::Z, 0.5).blended(0.3));
    Scene { camera, ..scene }
}

/// The nearest surface by the oracle in the middle of a pixel, and whether all points about it show the same triangle.
fn expected(oracle: &Oracle, [x, y]: [u32; 2], reach: f64) -> (Option<Nearest>, bool) {
    let [x, y] = [x, y].map(|at| f64::from(at) + 0.5);
    let middle = oracle.probe(x, y).nearest;
    let id = |nearest: Option<Nearest>| nearest.map(|it| (it.object, it.triangle));
    let around = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];
    let same = |[dx, dy]: [f64; 2]| id(oracle.probe(x + reach * dx, y + reach * dy).nearest) == id(middle);
    (middle, around.into_iter().all(same))
}

/// Whether the surface is the oracle's, to 10⁻⁶ of its depth.
fn agree(expected: &Nearest, found: &SurfacePoint) -> bool {
    (expected.object, expected.triangle) == (found.entity, Some(found.triangle))
        && expected.front == found.front
        && (expected.depth - found.depth).abs() <= 1e-6 * expected.depth
        && (expected.position - found.position).length() <= 1e-6 * expected.depth
}

/// Planted faults: another object or triangle, the other side, and twice the error that is allowed.
fn faults_are_found(expected: &Nearest, found: SurfacePoint) {
    let more = 2e-6 * expected.depth;
    let faults = [
        SurfacePoint { entity: Entity::PLACEHOLDER, ..found },
        SurfacePoint { triangle: found.triangle + 1, ..found },
        SurfacePoint { front: !found.front, ..found },
        SurfacePoint { depth: expected.depth + more, ..found },
        SurfacePoint { position: expected.position + more * DVec3::X, ..found },
    ];
    for fault in faults {
        assert!(!agree(expected, &fault), "{fault:?} passes for {expected:?}");
    }
}

#[test]
fn surfaces_are_those_that_the_oracle_finds() {
    let cameras = [
        ("perspective", Camera::default()),
        ("orthographic", Camera::orthographic(3.4)),
        ("four samples", Camera { samples: Samples::Four, ..Camera::default() }),
    ];
    let mut failures = Failures::default();
    for (name, camera) in cameras {
        let mut stage = Stage::new(SIZE.x, SIZE.y);
        stage.pixels(Pixels::Byte);
        stage.set(&scene(camera));
        // The picture is drawn with levels of detail, the numbers are those of the mesh.
        stage.world().insert_resource(ViewTolerance(Tolerance { pixels: 2.0, ..Tolerance::EXACT }));
        stage.frame();
        assert_eq!(stage.report().errors, []);
        let reach = 1.5 / f64::from(1 << stage.grid_bits());
        let oracle = stage.oracle();
        let surfaces = Surfaces::take(stage.world()).unwrap_or_else(|error| panic!("{name}: {error}"));
        let (mut compared, mut empty, mut seen) = (0, 0, HashSet::new());
        for (x, y) in (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y))) {
            let (expected, is_certain) = expected(&oracle, [x, y], reach);
            if !is_certain {
                continue;
            }
            compared += 1;
            let found = surfaces.at(x, y);
            let Some((expected, found)) = expected.zip(found) else {
                failures.unless(expected.is_none() && found.is_none(), || {
                    format!("{name}, ({x}, {y}): {found:?} instead of {expected:?}")
                });
                empty += 1;
                continue;
            };
            seen.insert(found.entity);
            if seen.len() < 2 {
                faults_are_found(&expected, found);
            }
            failures
                .unless(agree(&expected, &found), || format!("{name}, ({x}, {y}): {found:?} instead of {expected:?}"));
        }
        // The bowl and the fine sphere are small triangles.
        failures.unless(compared > 5000 && empty > 1000, || format!("{name}: {compared} compared, {empty} empty"));
        failures.unless(seen.len() == 7, || format!("{name}: {} objects are seen", seen.len()));
    }
    failures.finish();
}

#[test]
fn a_point_is_what_its_plane_says() {
    let mut stage = Stage::new(40, 30);
    // A square of 8 at z = −5, seen from the origin: its uv run from the left to the right and upwards.
    let scene = Scene::in_eye_space().with(Thing::square(Vec3::new(0.0, 0.0, -5.0), Vec3::Z, 8.0));
    let square = stage.set(&scene)[0];
    stage.frame();
    let surfaces = Surfaces::take(stage.world()).expect("surfaces");
    let half = (45_f64.to_radians() / 2.0).tan();
    for (x, y) in [(0, 0), (19, 14), (39, 29), (7, 22)] {
        let at = DVec2::new(f64::from(x) - 19.5, 14.5 - f64::from(y)) / 15.0 * half;
        let position = 5.0 * at.extend(-1.0);
        let found = surfaces.at(x, y).expect("the square");
        assert_eq!((found.entity, found.object, found.part, found.front), (square, 1, 1, true));
        // The camera's angle is an f32.
        assert!((found.position - position).length() < 1e-6, "{found:?}");
        assert!((found.depth - 5.0).abs() < 1e-6 && (found.distance - position.length()).abs() < 1e-6);
        assert!((found.normal - DVec3::Z).length() < 1e-6 && (found.face_normal - DVec3::Z).length() < 1e-6);
        assert!((found.barycentrics.element_sum() - 1.0).abs() < 1e-12);
    }
    assert_eq!(surfaces.at(40, 0), None);
    assert_eq!(pick(stage.world(), 19, 14).expect("surfaces"), surfaces.at(19, 14));
}

#[test]
fn numbers_count_objects_and_their_parts_hidden_ones_included() {
    let mut stage = Stage::new(60, 20);
    let square = |x: f32| Thing::square(Vec3::new(x, 0.0, -5.0), Vec3::Z, 1.0);
    let things =
        stage.set(&[-2.0, -1.0, 0.0, 1.0, 2.0].map(square).into_iter().fold(Scene::in_eye_space(), Scene::with));
    // The first, the second and the fourth hang on one root; the third is hidden.
    let world = stage.world();
    let root = world.spawn((Transform::default(), Visibility::default())).id();
    world.entity_mut(root).add_children(&[things[0], things[1], things[3]]);
    world.entity_mut(things[2]).insert(Visibility::Hidden);
    stage.frame();
    let quantities = [Quantity::Id, Quantity::Part, Quantity::Triangle, Quantity::Coverage];
    let images = take_quantities(stage.world(), &quantities).expect("pictures");
    let row = |image: usize| -> Vec<u32> {
        let middle = 10 * 60..11 * 60;
        let mut row = match &images[image].values {
            QuantityValues::Numbers(numbers) => numbers[middle].to_vec(),
            QuantityValues::Floats(floats) => floats[middle].iter().map(|&share| share as u32).collect(),
        };
        row.dedup();
        row
    };
    assert_eq!(row(3), [0, 1, 0, 1, 0]);
    assert_eq!(row(0), [0, 1, 0, 1, 3, 0]);
    assert_eq!(row(1), [0, 1, 2, 0, 3, 1, 0]);
    assert!(row(2).iter().all(|&triangle| triangle <= 2));
    stage.world().entity_mut(root).despawn();
}

#[test]
fn albedo_and_coverage_are_those_of_the_materials() {
    let mut stage = Stage::new(32, 24);
    let mut red = Thing::square(Vec3::new(0.0, 0.0, -5.0), Vec3::Z, 2.0);
    red.material = Material { diffuse: LinearRgba::rgb(0.75, 0.25, 0.5), ..glowing(3.0, 3.0, 3.0) };
    let pane = Thing::square(Vec3::new(0.0, 1.0, -4.0), Vec3::Z, 1.5).blended(0.25);
    let pane = Thing { material: Material { diffuse: LinearRgba::BLACK, ..pane.material }, ..pane };
    let blends = {
        stage.set(&Scene::in_eye_space());
        stage.frame();
        stage.blends_floats()
    };
    let scene = Scene::in_eye_space().ambient(0.3).with(red);
    stage.set(&if blends { scene.with(pane) } else { scene });
    stage.frame();
    let images = take_quantities(stage.world(), &[Quantity::Albedo, Quantity::Coverage]).expect("pictures");
    let at = |image: usize, x: usize, y: usize| -> Vec<f32> {
        let channels = images[image].quantity.channels().len();
        let QuantityValues::Floats(values) = &images[image].values else { panic!("numbers") };
        values[channels * (32 * y + x)..][..channels].to_vec()
    };
    assert_eq!((at(0, 16, 14), at(1, 16, 14)), (vec![0.75, 0.25, 0.5], vec![1.0]));
    assert_eq!((at(0, 1, 1), at(1, 1, 1)), (vec![0.0; 3], vec![0.0]));
    if blends {
        // Only the pane is in the upper third; where it covers the square it takes a quarter of its colour.
        assert_eq!((at(0, 16, 4), at(1, 16, 4)), (vec![0.0; 3], vec![0.25]));
        assert_eq!((at(0, 16, 9), at(1, 16, 9)), (vec![0.5625, 0.1875, 0.375], vec![1.0]));
    }
}

/// The scene with colours and opacities at the vertices of a flat object, of a smooth one and of one with a mask, an image,
/// a solid, an unlit object, and a bowl of another material within.
fn painted(camera: Camera) -> Scene {
    let mut scene = scene(camera);
    let [unlit, fine, flat, mirrored, bowl, grate, pane] = &mut scene.things[..] else { panic!("seven things") };
    unlit.shading = Some(Shading::Unlit);
    let stripes = TexelImage::from_fn(16, 4, |x, y| [0.2 + 0.05 * x as f32, 0.9 - 0.2 * y as f32, 0.5, 1.0]);
    unlit.maps = vec![(MapKind::Color, Map { amount: 0.8, ..Map::new(stripes.expect("an image")) })];
    fine.mesh = colored(fine.mesh.clone());
    fine.shading = Some(Shading::Gouraud);
    *flat = Thing { mask: Some(0.35), mesh: colored(flat.mesh.clone()), ..flat.clone() }.shaded(Shading::Flat);
    mirrored.solid = Some(solid(SolidKind::Marble));
    bowl.back = Some(other_material());
    // The camera looks into it.
    bowl.frames[0].rotation = Quat::from_rotation_x(-1.2);
    grate.material = other_material();
    pane.mesh = colored(pane.mesh.clone());
    // Beyond the others it lies before the background.
    pane.frames[0].scale = Vec3::splat(2.5);
    scene
}

/// A picture of the newest frame's albedo or coverage.
fn averaged(stage: &mut Stage, quantity: Quantity) -> Image {
    let [QuantityImage { values: QuantityValues::Floats(values), size, .. }] =
        &take_quantities(stage.world(), &[quantity]).unwrap_or_else(|error| panic!("{quantity:?}: {error}"))[..]
    else {
        panic!("{quantity:?}: not one picture of numbers")
    };
    let channels = quantity.channels().len();
    let pixel = |values: &[f32]| std::array::from_fn(|channel| f64::from(values[channel % channels]));
    Image::new(size.x, size.y, values.chunks(channels).map(pixel).collect())
}

/// The two as the oracle shows them.
const AVERAGES: [(Quantity, Shows); 2] = [(Quantity::Albedo, Shows::Albedo), (Quantity::Coverage, Shows::Coverage)];

fn judged(stage: &mut Stage, shows: Shows, actual: &Image, bars: Bars) -> Verdict {
    let oracle = stage.oracle().showing(shows);
    metrics::judge_on_grid(&oracle, &oracle.draw(), stage.grid_bits(), actual, bars).expect("pictures of one size")
}

/// Draws the scene; on adapters that do not blend floats without what blends.
fn set(stage: &mut Stage, mut scene: Scene) {
    stage.frame();
    let blends = stage.blends_floats();
    scene.things.retain(|thing| blends || !thing.blend);
    stage.set(&scene);
    stage.frame();
    assert_eq!(stage.report().errors, []);
}

#[test]
fn albedo_and_coverage_are_those_that_the_oracle_draws() {
    let cameras = [
        ("perspective", Camera::default()),
        ("orthographic", Camera::orthographic(3.4)),
        ("four samples", Camera { samples: Samples::Four, ..Camera::default() }),
        ("toned", Camera { intensity: Intensity::Reinhard { white: 2.0 }, ..Camera::default() }),
    ];
    let mut failures = Failures::default();
    for (name, camera) in cameras {
        let mut stage = Stage::new(SIZE.x, SIZE.y);
        let mut scene = Scene { view_shading: Some(Shading::Flat), ..painted(camera) };
        if camera.samples == Samples::Four {
            // Beside the edge of a triangle that is seen edge-on its colours are extrapolated.
            scene.things[0].maps.clear();
            scene.things[1].colors = Some(VertexColors::Ignore);
        }
        set(&mut stage, scene);
        for (quantity, shows) in AVERAGES {
            let drawn = averaged(&mut stage, quantity);
            let verdict = judged(&mut stage, shows, &drawn, FLOAT);
            failures.unless(verdict.is_within(), || format!("{name}, {quantity:?}: {verdict}"));
            failures.unless(verdict.counted > 0.2, || format!("{name}, {quantity:?}: only {verdict} counts"));
        }
    }
    failures.finish();
}

#[test]
fn faults_in_albedo_and_coverage_are_found() {
    fn darker(thing: &mut Thing) {
        let LinearRgba { red, green, blue, .. } = thing.material.diffuse;
        thing.material.diffuse = LinearRgba::rgb(0.99 * red, 0.99 * green, 0.99 * blue);
    }
    type Plant = fn(&mut [Thing]);
    let of_albedo: [(&str, Plant); 6] = [
        ("an unlit object", |things| darker(&mut things[0])),
        ("an object with a solid", |things| darker(&mut things[3])),
        ("an object with a mask", |things| darker(&mut things[5])),
        ("the back's material", |things| things[4].back = None),
        ("colours that are ignored", |things| things[1].colors = Some(VertexColors::Ignore)),
        ("colours between the corners of a flat object", |things| things[2].shading = Some(Shading::Phong)),
    ];
    let of_coverage: [(&str, Plant); 4] = [
        ("another opacity", |things| things[6].material.opacity *= 1.01),
        ("no mask", |things| things[5].mask = None),
        ("another mask of colours", |things| things[2].mask = Some(0.45)),
        ("opacities between the corners of a flat object", |things| things[2].shading = Some(Shading::Phong)),
    ];
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    stage.frame();
    let blends = stage.blends_floats();
    let rows = of_albedo.map(|row| (AVERAGES[0], row)).into_iter().chain(of_coverage.map(|row| (AVERAGES[1], row)));
    for ((quantity, shows), (fault, plant)) in rows {
        if fault == "another opacity" && !blends {
            continue;
        }
        let mut wrong = painted(Camera::default());
        plant(&mut wrong.things);
        set(&mut stage, wrong);
        let wrong = averaged(&mut stage, quantity);
        set(&mut stage, painted(Camera::default()));
        let verdict = judged(&mut stage, shows, &wrong, FLOAT.until_wrong());
        assert!(!verdict.is_within(), "{quantity:?}, {fault}: {verdict}");
    }
}

/// Samples that are taken in several frames.
#[test]
fn albedo_and_coverage_are_means_of_sixteen_samples() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    set(&mut stage, painted(Camera { samples: Samples::Sixteen, ..Camera::default() }));
    for (quantity, shows) in AVERAGES {
        let drawn = averaged(&mut stage, quantity);
        let oracle = stage.oracle().showing(shows);
        let differing = |side| {
            let expected = oracle.clone().with_supersampling(side).draw();
            let differ = |(a, b): &(&[f64; 3], &[f64; 3])| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > 0.02);
            drawn.pixels().iter().zip(expected.pixels()).filter(differ).count()
        };
        let [right, fewer] = [4, 2].map(differing);
        // The grid decides some samples along edges; a planted fault: four samples.
        assert!(
            right < 60 && fewer > 5 * right.max(20),
            "{quantity:?}: {right} pixels differ, of four samples {fewer}"
        );
    }
}

#[test]
fn every_quantity_has_a_picture_of_its_size_and_the_frame_stays_as_it_was() {
    let mut stage = Stage::new(SIZE.x, SIZE.y);
    let blended = scene(Camera::default());
    let things = blended.things.iter().filter(|thing| !thing.blend).cloned().collect();
    stage.set(&Scene { things, ..blended });
    let before = stage.float();
    let all: Vec<Quantity> = Quantity::CHOICES.iter().map(|choice| choice.value).collect();
    for image in take_quantities(stage.world(), &all).expect("pictures") {
        let count = (SIZE.x * SIZE.y) as usize * image.quantity.channels().len();
        match image.values {
            QuantityValues::Floats(floats) => {
                assert_eq!(floats.len(), count);
                assert!(floats.iter().all(|value| value.is_finite()), "{:?}", image.quantity);
                assert!(floats.iter().any(|value| *value != 0.0), "{:?}", image.quantity);
            }
            QuantityValues::Numbers(numbers) => assert_eq!(numbers.len(), count),
        }
    }
    assert_eq!(stage.float(), before);
}

#[test]
fn there_are_no_surfaces_before_the_first_frame() {
    let mut stage = Stage::new(8, 6);
    let error = Surfaces::take(stage.world()).err().map(|error| error.to_string()).unwrap_or_default();
    assert!(error.contains("draw a frame"), "{error}");
}
