//! The scene of 256 moving lights: how many of them each object needs, how tight the bounds are, what they cost.

use std::hint::black_box;
use std::time::Instant;

use bevy_color::LinearRgba;
use halfway_lighting::bounds::{NormalCone, Patch, Receiver, STEP, Selected, linear_tolerance};
use halfway_lighting::equations::{Coefficients, Eye, Light, ShadedPoint, light_terms};
use halfway_lighting::{Attenuation, Encoding, Faces, Material, PointLight, Reflectance};

use super::support::direction;

const EYE: [f32; 3] = [0.0, 40.0, 100.0];
const LIGHTS: u32 = 256;
const HALF_A_STEP: f64 = 0.5 * STEP;

/// Uniform in [0, 1) by PCG's hash.
pub(crate) fn random(i: u32, k: u32) -> f32 {
    let s = (i * 8 + k).wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let w = ((s >> ((s >> 28) + 4)) ^ s).wrapping_mul(277_803_737);
    (((w >> 22) ^ w) >> 8) as f32 / 16_777_216.0
}

/// Lights of range 12 over a floor of 180 × 180 units.
fn lights(range: Option<f32>) -> Vec<Light<f32>> {
    (0..LIGHTS)
        .map(|i| {
            let [r, g, b] = [5.0, 3.0, 1.0].map(|n: f32| {
                let k = (n + 6.0 * random(i, 4)) % 6.0;
                2.0 * (1.0 - 0.6 * k.min(4.0 - k).clamp(0.0, 1.0))
            });
            let attenuation = Attenuation::new(1.0, 0.0, 0.5);
            let light = PointLight { attenuation, range, ..PointLight::new(LinearRgba::rgb(r, g, b)) };
            let at = |k| -90.0 + 180.0 * random(i, k);
            light.at([at(0), 1.0 + 5.0 * random(i, 1), at(2)])
        })
        .collect()
}

/// 400 spheres of radius 1.5, closed, so of every normal.
fn spheres() -> Vec<Patch<f32>> {
    (0..400u32)
        .map(|i| Patch {
            center: [((i % 20) as f32 - 9.5) * 8.0, 1.5, ((i / 20) as f32 - 9.5) * 8.0],
            radius: 1.5,
            normals: None,
            half_thickness: 1.5,
            faces: Faces::Front,
        })
        .collect()
}

/// The eighths of those spheres, as parts of a large mesh are.
fn octants() -> Vec<Patch<f32>> {
    let axis = (1f32 / 3.0).sqrt();
    // The corners of an octant are arccos(1/√3) from its middle; the smallest sphere around them has radius √(2/3).
    let (half_angle, radius) = (axis.acos(), (2f32 / 3.0).sqrt() * 1.5);
    spheres()
        .iter()
        .flat_map(|sphere| {
            (0..8u32).map(move |octant| {
                let axis = [0, 1, 2].map(|i| if octant >> i & 1 == 0 { axis } else { -axis });
                let center = [0, 1, 2].map(|i| sphere.center[i] + axis[i] * axis[0].abs() * 1.5);
                let normals = Some(NormalCone { axis, half_angle });
                Patch { center, radius, normals, half_thickness: (1.0 - axis[0].abs()) * 1.5, faces: Faces::Front }
            })
        })
        .collect()
}

/// A floor of 200 × 200 units in `side`² squares.
fn floor(side: u32) -> Vec<Patch<f32>> {
    let size = 200.0 / side as f32;
    (0..side * side)
        .map(|i| Patch {
            center: [((i % side) as f32 + 0.5) * size - 100.0, 0.0, ((i / side) as f32 + 0.5) * size - 100.0],
            radius: size * 0.5f32.sqrt(),
            normals: Some(NormalCone { axis: [0.0, 1.0, 0.0], half_angle: 0.0 }),
            half_thickness: 0.0,
            faces: Faces::Front,
        })
        .collect()
}

fn material(shade: f32) -> Coefficients<f32> {
    let gray = LinearRgba::rgb(shade, shade, shade);
    Coefficients::from(&Material {
        ambient: gray,
        diffuse: gray,
        specular: LinearRgba::WHITE,
        shininess: 32.0,
        ..Material::default()
    })
}

/// A tolerance with 0.05 of ambient light known.
fn tolerance() -> [f64; 3] {
    [linear_tolerance(Encoding::Srgb, HALF_A_STEP, 0.05 * 0.6); 3]
}

/// The mean numbers of diffuse and of specular terms that a patch needs.
fn needed(patches: &[Patch<f32>], lights: &[Light<f32>], reflectance: Reflectance, tolerance: [f64; 3]) -> [f64; 2] {
    let mut selected = Selected::default();
    let mut sums = [0usize; 2];
    for patch in patches {
        Receiver::new(patch, &material(0.8), &Eye::Local(EYE), reflectance).select(
            (0..).zip(lights),
            tolerance,
            &mut selected,
        );
        sums[0] += selected.diffuse.len();
        sums[1] += selected.specular.len();
    }
    sums.map(|sum| sum as f64 / patches.len() as f64)
}

/// Most of the 256 lights touch nothing of a patch, and fewer highlights than lights.
#[test]
fn a_patch_needs_few_of_many_lights() {
    let lights = lights(Some(12.0));
    // A tenth above the measured numbers, for Blinn–Phong and for Phong, whose normals turn r by twice their angle:
    // first with a tolerance of 0, then of half a step.
    let rows = [
        ("spheres", spheres(), [[[4.9, 4.9]; 2], [[4.6, 4.7], [4.6, 4.7]]]),
        ("octants of spheres", octants(), [[[4.5, 4.5]; 2], [[4.1, 2.3], [4.1, 4.0]]]),
        ("floor in 8 × 8", floor(8), [[[18.4, 18.4], [18.4, 16.8]], [[17.3, 13.0], [17.3, 12.2]]]),
        ("floor in 32 × 32", floor(32), [[[5.5, 5.5], [5.5, 4.0]], [[4.9, 2.0], [4.9, 1.8]]]),
    ];
    for (name, patches, most) in rows {
        for (tolerance, most) in [[0.0; 3], tolerance()].into_iter().zip(most) {
            for (reflectance, most) in [Reflectance::BlinnPhong, Reflectance::Phong].into_iter().zip(most) {
                let needed = needed(&patches, &lights, reflectance, tolerance);
                println!("{name}, {reflectance:?}, tolerance {:.0e}: {needed:.2?} of {LIGHTS}", tolerance[0]);
                assert!(needed[0] <= most[0] && needed[1] <= most[1], "{name}: {needed:?} of at most {most:?}");
            }
        }
    }
}

type TightnessRow = (&'static str, Vec<Patch<f32>>, Points, [f64; 2]);

/// The bound against the largest of many points on the surface itself, for bounds above half an 8-bit step.
#[test]
fn bounds_are_near_the_largest_term() {
    let lights = lights(Some(12.0));
    // The medians of bound/largest that are asked for, diffuse and specular: a tenth above those measured.
    let rows: [TightnessRow; 3] = [
        ("spheres", spheres(), on_sphere, [1.1, 1.6]),
        ("floor in 8 × 8", floor(8), on_square, [2.1, 9.0]),
        ("floor in 32 × 32", floor(32), on_square, [1.4, 4.7]),
    ];
    for (name, patches, points, most) in rows {
        let mut pairs = [const { Vec::new() }; 2];
        for patch in patches.iter().step_by(patches.len() / 50) {
            for light in &lights {
                gather(patch, light, points, &mut pairs);
            }
        }
        for (term, (pairs, most)) in ["diffuse", "specular"].iter().zip(pairs.iter().zip(most)) {
            let mut ratios: Vec<f64> = pairs.iter().map(|(bound, largest)| bound / largest).collect();
            ratios.sort_by(f64::total_cmp);
            let at = |share: f64| ratios[((ratios.len() - 1) as f64 * share) as usize];
            let quantiles = [0.0, 0.5, 0.9, 1.0].map(at);
            let visible = pairs.iter().filter(|(_, largest)| *largest > HALF_A_STEP).count();
            println!(
                "{name}, {term}: {} bounds and {visible} terms are visible; bound/largest: least, median, 90 %, most \
                {quantiles:.3?}",
                pairs.len()
            );
            assert!(
                quantiles[0] >= 1.0 && quantiles[1] <= most,
                "{name}, {term}: {quantiles:?}, median at most {most}"
            );
        }
    }
}

/// A point and normal of a patch from two numbers in [0, 1).
type Points = fn(&Patch<f32>, f64, f64) -> ShadedPoint<f64>;

fn on_sphere(patch: &Patch<f32>, a: f64, b: f64) -> ShadedPoint<f64> {
    let normal = direction(a, b);
    ShadedPoint {
        position: [0, 1, 2].map(|i| f64::from(patch.center[i]) + normal[i] * f64::from(patch.radius)),
        normal,
    }
}

fn on_square(patch: &Patch<f32>, a: f64, b: f64) -> ShadedPoint<f64> {
    let size = f64::from(patch.radius) * core::f64::consts::SQRT_2;
    let [x, y, z] = patch.center.map(f64::from);
    ShadedPoint { position: [x + (a - 0.5) * size, y, z + (b - 0.5) * size], normal: [0.0, 1.0, 0.0] }
}

/// Adds bound and largest term of the light where the bound is above the tolerance.
fn gather(patch: &Patch<f32>, light: &Light<f32>, points: Points, pairs: &mut [Vec<(f64, f64)>; 2]) {
    const STEPS: u32 = 24;
    let reflectance = Reflectance::BlinnPhong;
    let bounds = Receiver::new(patch, &material(0.8), &Eye::Local(EYE), reflectance).bounds(light);
    let bounds = [bounds.diffuse[0], bounds.specular[0]].map(f64::from);
    if bounds.iter().all(|&bound| bound <= HALF_A_STEP) {
        return;
    }
    let mut largest = [0f64; 2];
    for i in 0..STEPS * STEPS {
        let [a, b] = [i % STEPS, i / STEPS].map(|k| f64::from(k) / f64::from(STEPS - 1));
        let ShadedPoint { position, normal } = points(patch, a, b);
        let surface = ShadedPoint { position: position.map(|x| x as f32), normal: normal.map(|x| x as f32) };
        let terms = light_terms(&surface, &material(0.8), light, &Eye::Local(EYE), reflectance);
        largest = [largest[0].max(f64::from(terms.diffuse[0])), largest[1].max(f64::from(terms.specular[0]))];
    }
    for term in 0..2 {
        if bounds[term] > HALF_A_STEP {
            pairs[term].push((bounds[term], largest[term]));
        }
    }
}

/// The time of one core for 256 lights and 464 patches: the bounds alone, and with the selection.
#[test]
#[ignore = "prints times: cargo test --release -p halfway_lighting --test lighting -- --ignored --nocapture bounds::many_lights"]
fn times() {
    let patches: Vec<_> = spheres().into_iter().chain(floor(8)).collect();
    for (name, range) in [("range 12", Some(12.0)), ("no range", None)] {
        let lights = lights(range);
        for reflectance in [Reflectance::BlinnPhong, Reflectance::Phong] {
            let receivers =
                || patches.iter().map(|patch| Receiver::new(patch, &material(0.8), &Eye::Local(EYE), reflectance));
            let bounds = least_time(|| {
                for receiver in receivers() {
                    for light in &lights {
                        black_box(receiver.bounds(light));
                    }
                }
            });
            let mut selected = Selected::default();
            let selection = least_time(|| {
                for receiver in receivers() {
                    receiver.select((0..).zip(&lights), tolerance(), &mut selected);
                    black_box(&selected);
                }
            });
            let per_pair = 1e6 / (patches.len() * lights.len()) as f64;
            for (what, time) in [("bounds", bounds), ("selection", selection)] {
                println!("{name}, {reflectance:?}, {what}: {time:.3} ms, {:.1} ns a pair", time * per_pair);
            }
        }
    }
}

/// The least of fifty runs in milliseconds, which other work on the machine disturbs least.
pub(crate) fn least_time(mut run: impl FnMut()) -> f64 {
    let mut time = || {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64() * 1e3
    };
    (0..50).map(|_| time()).fold(f64::INFINITY, f64::min)
}
