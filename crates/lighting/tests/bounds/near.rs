//! Lights found by where they are: the lists are those of all lights, and what touches nothing is hardly looked at.

use halfway_lighting::bounds::{LightTree, NearLights, NormalCone, Patch, Receiver, Region, Selected};
use halfway_lighting::equations::{Coefficients, Eye, Light, Place};
use halfway_lighting::{Attenuation, Faces, Material, PointLight, Reflectance};
use proptest::prelude::*;

use crate::many_lights::random;
use crate::select::{lights, some_tolerance};
use crate::support::{Scene, any_direction, cases, scene, source};

/// A region that holds the patch of a scene, with this much room around it in radii.
fn region(scene: &Scene, (way, room): ([f32; 3], f32), tolerance: [f64; 3]) -> Region {
    let offset = room * scene.radius.max(1e-3);
    let Material { ambient, diffuse, specular, .. } = scene.material;
    let brightest = [ambient, diffuse, specular].iter().flat_map(|it| [it.red, it.green, it.blue]).fold(0.0, f32::max);
    let tolerance = tolerance.into_iter().fold(f64::INFINITY, f64::min);
    let aside = [0, 1, 2].map(|k| scene.center[k] + way[k] * offset);
    Region { brightest, tolerance, ..Region::EMPTY }.with(scene.center, scene.radius).with(aside, scene.radius)
}

/// The lists of a patch by way of a tree, which may have been made of the same lights elsewhere.
fn by_tree(
    scene: &Scene,
    region: &Region,
    lights: &[Light<f32>],
    tolerance: [f64; 3],
    elsewhere: Option<&[Light<f32>]>,
) -> Selected<f32> {
    let (mut tree, mut near, mut selected) = (LightTree::default(), NearLights::default(), Selected::default());
    tree.rebuild(elsewhere.unwrap_or(lights));
    if elsewhere.is_some() {
        tree.follow(lights);
    }
    near.begin(*region);
    near.select(&tree, lights, &scene.receiver(), tolerance, &mut selected);
    selected
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn the_lists_are_those_of_all_lights(
        scene in scene(),
        sources in prop::collection::vec(source(), 0..60),
        tolerance in some_tolerance(),
        way in any_direction(),
        room in prop_oneof![1 => Just(0.0), 3 => 0f32..4.0],
    ) {
        let lights = lights(&scene, &sources);
        let mut plain = Selected::default();
        scene.receiver().select((0..).zip(&lights), tolerance, &mut plain);
        let region = region(&scene, (way, room), tolerance);
        // As though they had all been somewhere else.
        let mut elsewhere = lights.clone();
        for (light, i) in elsewhere.iter_mut().zip(0..) {
            if let Place::Point(at) = &mut light.place {
                *at = [0, 1, 2].map(|k| random(i, k));
            }
        }
        for elsewhere in [None, Some(&elsewhere[..])] {
            let selected = by_tree(&scene, &region, &lights, tolerance, elsewhere);
            prop_assert_eq!(&selected.diffuse, &plain.diffuse);
            prop_assert_eq!(&selected.specular, &plain.specular);
            for ((found, plain), tolerance) in selected.left_out.into_iter().zip(plain.left_out).zip(tolerance) {
                // More is said to be left out, where lights were not looked at, and never more than may be.
                prop_assert!(found <= tolerance && found >= plain * (1.0 - 1e-13), "{found}, {plain}, {tolerance}");
            }
        }
    }
}

/// Squares of a floor of 128 × 128 units, 16,384 of them, with a region around every sixteen by sixteen.
fn floor() -> Vec<(Region, Vec<Patch<f32>>)> {
    let patch = |x: u32, z: u32| Patch {
        center: [x as f32 - 63.5, 0.0, z as f32 - 63.5],
        radius: 0.71,
        normals: Some(NormalCone { axis: [0.0, 1.0, 0.0], half_angle: 0.0 }),
        half_thickness: 0.0,
        faces: Faces::Front,
    };
    (0..64)
        .map(|i| {
            let (x, z) = (i % 8 * 16, i / 8 * 16);
            let patches: Vec<_> = (0..256).map(|k| patch(x + k % 16, z + k / 16)).collect();
            let nowhere = Region { brightest: 1.0, tolerance: TOLERANCE, ..Region::EMPTY };
            (patches.iter().fold(nowhere, |region, patch| region.with(patch.center, patch.radius)), patches)
        })
        .collect()
}

const TOLERANCE: f64 = 1e-4;

/// A lamp that falls with the square of the distance.
fn lamp(at: [f32; 3], range: Option<f32>) -> Light<f32> {
    PointLight { attenuation: Attenuation::new(1.0, 0.0, 1.0), range, ..PointLight::white() }.at(at)
}

#[test]
fn lights_that_touch_nothing_are_not_looked_at() {
    let patches = floor();
    let material = Coefficients::from(&Material::BRASS);
    // Below the floor, out of range; or so far that what 20,000 of them add is less than a 64th of the tolerance.
    for (range, depth) in [(Some(20.0), -40.0), (None, -2e5)] {
        let far =
            |i| lamp([400.0 * random(i, 0) - 200.0, depth * (1.0 + random(i, 1)), 400.0 * random(i, 2) - 200.0], range);
        let near_by = |i| PointLight::white().at([10.0 * i as f32 - 55.0, 40.0, 5.0]);
        let lights: Vec<Light<f32>> = (0..12).map(near_by).chain((12..20_000).map(far)).collect();
        let (mut tree, mut near, mut selected) = (LightTree::default(), NearLights::default(), Selected::default());
        tree.rebuild(&lights);
        for (region, patches) in &patches {
            near.begin(*region);
            for patch in patches {
                let receiver = Receiver::new(patch, &material, &Eye::Local([0.0, 50.0, 0.0]), Reflectance::BlinnPhong);
                near.select(&tree, &lights, &receiver, [TOLERANCE; 3], &mut selected);
                assert_eq!(selected.diffuse, (0..12).collect::<Vec<_>>());
            }
        }
        // The twelve, at each of 16,384 patches. Of those without a range some are looked at where it depends on them
        // whether another's highlight is left out: less than a hundredth as often as by looking at all.
        let (pairs, least) = (near.take_pairs(), 16_384 * 12);
        let most = if range.is_some() { least } else { least + 16_384 * 20_000 / 100 };
        assert!((least..=most).contains(&pairs), "{range:?}: {pairs} pairs");
        println!("{range:?}: {pairs} pairs");
    }
}

#[test]
fn where_the_weak_are_too_many_each_is_looked_at() {
    // A thousand far away, and ten that are nearer and each as much as a hundred of those.
    let far = (0..1000).map(|i| lamp([1e3 + i as f32 * 1e-3, 0.0, 0.0], None));
    let lights: Vec<Light<f32>> = far.chain((0..10).map(|i| lamp([1e2 + i as f32 * 1e-3, 0.0, 0.0], None))).collect();
    let patch = Patch { center: [0.0; 3], radius: 1.0, normals: None, half_thickness: 1.0, faces: Faces::Front };
    let material = Coefficients::from(&Material::matte(bevy_color::LinearRgba::WHITE));
    let receiver = Receiver::new(&patch, &material, &Eye::Infinite([0.0, 0.0, 1.0]), Reflectance::BlinnPhong);
    let sum: f64 = lights.iter().map(|light| f64::from(receiver.bounds(light).diffuse[0])).sum();
    let (mut tree, mut near) = (LightTree::default(), NearLights::default());
    tree.rebuild(&lights);
    // All fit, the thousand unseen; the thousand fit unseen, but not all ten beside them.
    for (share, pairs, kept) in [(100.0, 10, 0), (0.99, 1010, 1), (0.74, 1010, 6)] {
        let tolerance = sum * share;
        let region = Region { brightest: 1.0, tolerance, ..Region::EMPTY }.with(patch.center, patch.radius);
        near.begin(region);
        let (mut selected, mut plain) = (Selected::default(), Selected::default());
        near.select(&tree, &lights, &receiver, [tolerance; 3], &mut selected);
        receiver.select((0..).zip(&lights), [tolerance; 3], &mut plain);
        assert_eq!((&selected.diffuse, &selected.specular), (&plain.diffuse, &plain.specular), "{share}");
        assert_eq!((near.take_pairs(), selected.diffuse.len()), (pairs, kept), "{share}");
    }
}

#[test]
#[should_panic(expected = "as many lights as before")]
fn fewer_lights_are_not_followed() {
    let lights: Vec<Light<f32>> = (0..4).map(|i| lamp([i as f32, 0.0, 0.0], None)).collect();
    let mut tree = LightTree::default();
    tree.rebuild(&lights);
    tree.follow(&lights[..3]);
}

#[test]
fn a_tree_that_follows_is_the_one_made_anew() {
    let at =
        |turn: f32| (0..300).map(move |i| lamp([turn + random(i, 0), random(i, 1), turn * random(i, 2)], Some(2.0)));
    let (here, there): (Vec<_>, Vec<_>) = (at(1.0).collect(), at(2.0).collect());
    let [mut tree, mut anew] = [(); 2].map(|()| LightTree::default());
    tree.rebuild(&here);
    anew.rebuild(&here);
    tree.follow(&there);
    assert_ne!(tree, anew);
    tree.follow(&here);
    assert_eq!(tree, anew);
}

#[test]
fn patches_without_bounds_are_reached_by_all_lights() {
    let lights: Vec<Light<f32>> = (0..40).map(|i| lamp([i as f32, 0.0, 0.0], Some(2.0))).collect();
    let mut tree = LightTree::default();
    tree.rebuild(&lights);
    let material = Coefficients::from(&Material::BRASS);
    for (center, radius) in [([0.0; 3], f32::INFINITY), ([0.0; 3], f32::NAN), ([f32::NAN, 0.0, 0.0], 1.0)] {
        let patch = Patch { center, radius, normals: None, half_thickness: radius, faces: Faces::Front };
        let receiver = Receiver::new(&patch, &material, &Eye::Local([0.0; 3]), Reflectance::BlinnPhong);
        let (mut near, mut selected, mut plain) = (NearLights::default(), Selected::default(), Selected::default());
        near.begin(Region { brightest: 1.0, tolerance: 0.0, ..Region::EMPTY }.with(center, radius));
        near.select(&tree, &lights, &receiver, [0.0; 3], &mut selected);
        receiver.select((0..).zip(&lights), [0.0; 3], &mut plain);
        assert_eq!((&selected.diffuse, &selected.specular), (&plain.diffuse, &plain.specular), "{patch:?}");
        assert_eq!(near.take_pairs(), 40);
    }
}

#[test]
#[ignore = "prints times: cargo test --release --workspace --test bounds -- --ignored --nocapture near::times"]
fn times() {
    let patches = floor();
    let eye = Eye::Local([0.0, 50.0, 0.0]);
    for (name, material) in [("brass", Material::BRASS), ("matte", Material::matte(bevy_color::LinearRgba::WHITE))] {
        let material = Coefficients::from(&material);
        for count in [12u32, 32] {
            let lights: Vec<Light<f32>> =
                (0..count).map(|i| PointLight::white().at([10.0 * i as f32 - 55.0, 40.0, 5.0])).collect();
            let (mut tree, mut near, mut selected) = (LightTree::default(), NearLights::default(), Selected::default());
            tree.rebuild(&lights);
            let plain = crate::many_lights::least_time(|| {
                for patch in patches.iter().flat_map(|(_, patches)| patches) {
                    let receiver = Receiver::new(patch, &material, &eye, Reflectance::BlinnPhong);
                    receiver.select((0..).zip(&lights), [TOLERANCE; 3], &mut selected);
                    std::hint::black_box(&selected);
                }
            });
            let found = crate::many_lights::least_time(|| {
                for (region, patches) in &patches {
                    near.begin(*region);
                    for patch in patches {
                        let receiver = Receiver::new(patch, &material, &eye, Reflectance::BlinnPhong);
                        near.select(&tree, &lights, &receiver, [TOLERANCE; 3], &mut selected);
                        std::hint::black_box(&selected);
                    }
                }
            });
            let receivers = crate::many_lights::least_time(|| {
                for patch in patches.iter().flat_map(|(_, patches)| patches) {
                    std::hint::black_box(Receiver::new(patch, &material, &eye, Reflectance::BlinnPhong));
                }
            });
            let per_pair = 1e6 / f64::from(16_384 * count);
            println!(
                "{name}, {count} lights: plain {:.1} ns a pair, near {:.1}, receivers alone {:.1}",
                plain * per_pair,
                found * per_pair,
                receivers * per_pair
            );
        }
    }
}
