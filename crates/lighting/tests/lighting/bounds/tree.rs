//! The tree of lights: its lists are those of all lights, and it evaluates few that are out of range.

use halfway_lighting::bounds::{LightTree, NormalCone, Patch, Receiver, Selected};
use halfway_lighting::equations::{Coefficients, Eye, Light};
use halfway_lighting::{Attenuation, Faces, Material, PointLight, Reflectance};
use proptest::prelude::*;

use super::many_lights::{least_time, random};
use super::select::{lights, some_tolerance};
use super::support::{cases, scene, source};

/// The lists of a patch by way of a tree.
fn by_tree(receiver: &Receiver<f32>, lights: &[Light<f32>], tolerance: [f64; 3]) -> Selected {
    let (mut tree, mut selected) = (LightTree::default(), Selected::default());
    tree.rebuild(lights);
    tree.select(lights, receiver, tolerance, &mut selected);
    selected
}

/// The lists of a patch from all lights, one by one.
fn by_hand(receiver: &Receiver<f32>, lights: &[Light<f32>], tolerance: [f64; 3]) -> Selected {
    let mut selected = Selected::default();
    receiver.select((0..).zip(lights), tolerance, &mut selected);
    selected
}

proptest! {
    #![proptest_config(cases(20))]

    #[test]
    fn the_lists_are_those_of_all_lights(
        scene in scene(),
        sources in prop::collection::vec(source(), 0..100),
        tolerance in some_tolerance(),
    ) {
        let (lights, receiver) = (lights(&scene, &sources), scene.receiver());
        let found = by_tree(&receiver, &lights, tolerance);
        let plain = by_hand(&receiver, &lights, tolerance);
        prop_assert_eq!((&found.diffuse, &found.specular, found.left_out),
            (&plain.diffuse, &plain.specular, plain.left_out));
        prop_assert!(found.evaluated <= plain.evaluated);
    }
}

fn lamp(at: [f32; 3], range: Option<f32>) -> Light<f32> {
    PointLight { attenuation: Attenuation::new(1.0, 0.0, 1.0), range, ..PointLight::white() }.at(at)
}

/// A receiver of white without highlights.
fn matte(patch: &Patch<f32>) -> Receiver<f32> {
    let material = Coefficients::from(&Material::matte(bevy_color::LinearRgba::WHITE));
    Receiver::new(patch, &material, &Eye::Infinite([0.0, 0.0, 1.0]), Reflectance::BlinnPhong)
}

/// A box is as exact as coordinates are: lights whose range ends just beyond a patch, far from the origin, and lights
/// that count as being at a point of it, with hardly a range.
#[test]
fn ranges_that_end_at_a_patch_are_found() {
    for far in [1.0f32, 1e3, 1e6, 1e9] {
        let center = [far, -0.3 * far, 0.7 * far];
        let patch = Patch { center, radius: 1.0, normals: None, half_thickness: 1.0, faces: Faces::Front };
        let receiver = matte(&patch);
        let directions = [[1.0f32, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut lights = Vec::new();
        for range in [1e-6 * far, 1e-3 * far, 1.0, 30.0, 10.0 * far] {
            for share in [0.5, 0.99, 0.999_99, 1.0, 1.000_01, 1.01, 2.0] {
                let distances = [1.0 + range * share, 1.0 + 2e-6 * far * share];
                lights.extend(distances.into_iter().flat_map(|distance| {
                    directions.map(|way| lamp([0, 1, 2].map(|k| center[k] + way[k] * distance), Some(range)))
                }));
            }
        }
        let (found, plain) = (by_tree(&receiver, &lights, [0.0; 3]), by_hand(&receiver, &lights, [0.0; 3]));
        assert_eq!(found.diffuse, plain.diffuse, "{far}");
        assert!((1..lights.len()).contains(&found.diffuse.len()), "{far}");
    }
}

#[test]
fn patches_without_bounds_are_reached_by_all_lights() {
    let lights: Vec<Light<f32>> = (0..40).map(|i| lamp([i as f32, 0.0, 0.0], Some(2.0))).collect();
    for (center, radius) in
        [([0.0; 3], f32::INFINITY), ([0.0; 3], f32::NAN), ([f32::NAN, 0.0, 0.0], 1.0), ([3e38; 3], 3e38)]
    {
        let patch = Patch { center, radius, normals: None, half_thickness: radius, faces: Faces::Front };
        let found = by_tree(&matte(&patch), &lights, [0.0; 3]);
        assert_eq!((found.diffuse.len(), found.evaluated), (40, 40), "{patch:?}");
    }
}

#[test]
fn lights_without_a_box_are_found_everywhere() {
    let patch = Patch { center: [5.0; 3], radius: 1.0, normals: None, half_thickness: 1.0, faces: Faces::Front };
    let lights = [
        lamp([0.0; 3], None),
        lamp([100.0; 3], Some(1.0)),
        lamp([3e38; 3], Some(3e38)),
        lamp([5.0; 3], Some(1.0)),
        halfway_lighting::DirectionalLight::white().along([0.0, -1.0, 0.0]).expect("not 0"),
    ];
    assert_eq!(by_tree(&matte(&patch), &lights, [0.0; 3]).diffuse, [0, 2, 3, 4]);
    assert_eq!(by_tree(&matte(&patch), &[], [0.0; 3]).evaluated, 0);
}

/// Squares of a floor of 100 × 100 units, 10,000 of them.
fn floor() -> impl Iterator<Item = Receiver<f32>> {
    (0..10_000u16).map(|i| {
        matte(&Patch {
            center: [f32::from(i % 100) - 49.5, 0.0, f32::from(i / 100) - 49.5],
            radius: 0.71,
            normals: Some(NormalCone { axis: [0.0, 1.0, 0.0], half_angle: 0.0 }),
            half_thickness: 0.0,
            faces: Faces::Front,
        })
    })
}

/// So many lamps over a square with sides of so many units.
fn lamps(count: u32, side: f32, range: f32) -> Vec<Light<f32>> {
    let at = |i| [side * (random(i, 0) - 0.5), 1.0 + random(i, 1), side * (random(i, 2) - 0.5)];
    (0..count).map(|i| lamp(at(i), Some(range))).collect()
}

/// How many lights each patch of the floor needs in the mean, and how many are evaluated for it.
fn counts(lights: &[Light<f32>]) -> [f64; 2] {
    let (mut tree, mut selected, mut counts) = (LightTree::default(), Selected::default(), [0; 2]);
    tree.rebuild(lights);
    for receiver in floor() {
        tree.select(lights, &receiver, [0.0; 3], &mut selected);
        counts[0] += selected.diffuse.len();
        counts[1] += selected.evaluated;
    }
    counts.map(|count| count as f64 / 10_000.0)
}

/// Of 10,000 lights, each patch has those evaluated that touch it and about as many around them; more lights elsewhere
/// change nothing.
#[test]
fn evaluations_are_linear_in_the_lights_that_touch() {
    let near = lamps(10_000, 100.0, 3.0);
    let [touching, evaluated] = counts(&near);
    println!("10,000 lights: {touching:.1} touch a patch, {evaluated:.1} are evaluated");
    assert!(touching > 10.0 && evaluated < 2.5 * touching, "{touching}, {evaluated}");
    // Below the floor, beyond their range; and beside it.
    let elsewhere = near.iter().flat_map(|light| {
        let Light::Point(halfway_lighting::equations::Point { position: [x, y, z], .. }) = *light else {
            panic!("a point")
        };
        [[x, y - 50.0, z], [x + 200.0, y, z]].map(|at| lamp(at, Some(3.0)))
    });
    let all: Vec<_> = near.iter().copied().chain(elsewhere).collect();
    assert_eq!(counts(&all), [touching, evaluated]);
    assert_eq!(counts(&all[10_000..]), [0.0, 0.0]);
}

#[test]
#[ignore = "prints times: cargo test --release -p halfway_lighting --test lighting -- --ignored --nocapture bounds::tree::times"]
fn times() {
    let receivers: Vec<_> = floor().collect();
    let rows = [
        ("256 over the floor", lamps(256, 100.0, 3.0)),
        ("10,000 over the floor", lamps(10_000, 100.0, 3.0)),
        ("10,000 over 4 times the area", lamps(10_000, 200.0, 3.0)),
        ("12 without a range", (0..12u8).map(|i| lamp([f32::from(i), 9.0, 0.0], None)).collect()),
    ];
    for (name, lights) in rows {
        let (mut tree, mut selected) = (LightTree::default(), Selected::default());
        let rebuild = least_time(|| tree.rebuild(&lights));
        for tolerance in [0.0, 1e-4] {
            let selection = least_time(|| {
                for receiver in &receivers {
                    tree.select(&lights, receiver, [tolerance; 3], &mut selected);
                    std::hint::black_box(&selected);
                }
            });
            println!("{name}, tolerance {tolerance}: {:.0} ns a patch, rebuild {rebuild:.3} ms", selection * 100.0);
        }
    }
}
