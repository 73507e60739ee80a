//! Pictures with faults that are not listed, and mistakes of scenes with more than a first renderer has.

use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use bevy_math::{UVec2, Vec4};
use halfway_asset::Assets;
use halfway_lighting::{AlphaMode, Camera, Intensity, Material};
use halfway_mesh::{Mesh, Mesh3d};
use halfway_reference::Oracle;
use halfway_reference::marking::{Marker, mistaken_picture};
use halfway_reference::mistakes::{Mistake, Mistakes};
use image::RgbImage;

use crate::right::image;
use crate::task::{LampKind, SIZE, Task};
use crate::tasks;

fn right_picture(task: &Task) -> RgbImage {
    mistaken_picture(&task.oracle(), Mistakes::NONE, task.encoding)
}

/// Pictures of other scenes than the task's.
fn faults(task: impl Fn() -> Task) -> Vec<(&'static str, RgbImage)> {
    let changed = |change: fn(&mut Task)| {
        let mut task = task();
        change(&mut task);
        right_picture(&task)
    };
    let mut noise = right_picture(&task());
    let mut state = 1_u32;
    for pixel in noise.pixels_mut() {
        for channel in &mut pixel.0 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *channel = channel.saturating_add((state >> 27) as u8);
        }
    }
    let stripes = RgbImage::from_fn(SIZE.0, SIZE.1, |x, y| image::Rgb([(4 * x) as u8, (5 * y) as u8, 128]));
    vec![
        ("noise", noise),
        ("stripes", stripes),
        ("black", RgbImage::new(SIZE.0, SIZE.1)),
        ("another place of the camera", changed(|task| task.eye.x += 0.4)),
        ("another colour", changed(|task| task.things.iter_mut().for_each(|it| it.front.kd.rotate_left(1)))),
        ("three times the shininess", changed(|task| task.things.iter_mut().for_each(|it| it.front.shininess *= 3.0))),
        (
            "a light elsewhere",
            changed(|task| {
                if let LampKind::Bulb(at) = &mut task.lamps[0].kind {
                    (at.x, at.y) = (-at.x + 0.5, at.y - 1.0);
                }
            }),
        ),
    ]
}

#[test]
fn faults_that_are_not_listed_have_no_explanation() {
    for (name, number) in [("ball", 0), ("eggs", 1), ("glare", 6)] {
        let task = || tasks::all().swap_remove(number);
        assert_eq!(task().name, name);
        let marker = Marker::new(&task().oracle(), task().encoding);
        for (fault, picture) in faults(task) {
            if picture == right_picture(&task()) {
                continue;
            }
            let found = marker.diagnose(&image(&picture, task().encoding)).expect("pictures of one size");
            println!("{fault} in {name}: right {:.2}, {:?}", found.right, found.nearest);
            assert!(found.explanations.is_empty(), "{fault} in {name}: {found:?}");
            assert!(found.right < 0.999, "{fault} in {name}: {found:?}");
        }
    }
}

/// The mistake that is named first for the oracle's own picture of a changed task.
fn named(change: impl Fn(&mut World), mistake: Mistake) -> Vec<Mistake> {
    let task = tasks::all().swap_remove(0);
    let mut world = task.world();
    change(&mut world);
    let oracle = Oracle::new(&mut world, UVec2::new(SIZE.0, SIZE.1)).expect("it can be drawn").with_clamping(true);
    let picture = mistaken_picture(&oracle, mistake.into(), task.encoding);
    let found = Marker::new(&oracle, task.encoding).diagnose(&image(&picture, task.encoding));
    let found = found.expect("pictures of one size");
    found.explanations.first().map(|it| it.causes[0].alternatives.clone()).unwrap_or_default()
}

#[test]
fn mistakes_with_colours_opacity_and_tone_mapping_are_named() {
    let paint = |world: &mut World| {
        let handle = world.query::<&Mesh3d>().single(world).expect("one ball").0.clone();
        let mut meshes = world.resource_mut::<Assets<Mesh>>();
        let mesh = meshes.get(&handle).expect("its mesh").clone();
        let colors = mesh.normals().iter().map(|n| Vec4::new(0.5 + 0.5 * n.x, 0.5 + 0.5 * n.y, 1.0, 1.0)).collect();
        let painted = meshes.add(mesh.with_colors(colors).expect("a colour a vertex"));
        world.query::<&mut Mesh3d>().single_mut(world).expect("one ball").0 = painted;
    };
    assert_eq!(named(paint, Mistake::VertexColorsIgnored), [Mistake::VertexColorsIgnored]);
    let thin = |world: &mut World| {
        let ball = world.query_filtered::<Entity, With<Mesh3d>>().single(world).expect("one ball");
        world.get_mut::<Material>(ball).expect("its material").opacity = 0.6;
        world.entity_mut(ball).insert(AlphaMode::Blend);
        world.query::<&mut Camera>().single_mut(world).expect("a camera").background = LinearRgba::rgb(0.1, 0.5, 0.2);
    };
    assert_eq!(named(thin, Mistake::OpacityIgnored), [Mistake::OpacityIgnored]);
    for intensity in [Intensity::Aces, Intensity::Reinhard { white: 2.0 }] {
        let tone = |world: &mut World| {
            world.query::<&mut Camera>().single_mut(world).expect("a camera").intensity = intensity;
        };
        assert_eq!(named(tone, Mistake::ToneMappingMissing), [Mistake::ToneMappingMissing]);
    }
}
