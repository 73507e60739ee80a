//! `f32` against `f64`.

use bevy_color::LinearRgba;
use halfway_lighting::equations::vector::{dot, normalize, sub};
use halfway_lighting::equations::{
    Coefficients, Surface, View, half_vector, shade, specular_blinn_phong, specular_phong,
};
use halfway_lighting::{Cone, Material, SpotLight};

use crate::support::{ALL_REFLECTANCES, Pcg, close, in_plane};

fn to_f32(a: [f64; 3]) -> [f32; 3] {
    a.map(|x| x as f32)
}

fn to_f64(a: [f32; 3]) -> [f64; 3] {
    a.map(f64::from)
}

#[test]
fn ordinary_scenes_agree() {
    let mut rng = Pcg::new(5);
    let mut compared = 0;
    for round in 0..20_000 {
        let spot = SpotLight { cone: Cone { cutoff: 0.8, inner: Some(0.3), exponent: 2.0 }, ..Default::default() };
        let material =
            Material { shininess: rng.between(0.0, 128.0) as f32, ..Material::plastic(LinearRgba::rgb(0.9, 0.5, 0.1)) };
        // Both evaluations start from the same f32 numbers, so that only the arithmetic differs.
        let [position, place] = [rng.signed(-1.0, 1.0), rng.signed(-1.0, 1.0)].map(to_f32);
        let [normal, direction] = [rng.direction(), rng.direction()].map(to_f32);
        let aim = sub(to_f64(position), to_f64(place));
        let direction = to_f32([0, 1, 2].map(|i| aim[i] + f64::from(direction[i])));
        let reflectance = ALL_REFLECTANCES[round % 3];
        let normal64 = normalize(to_f64(normal)).expect("unit");
        let to_light = normalize(sub(to_f64(place), to_f64(position))).expect("apart");
        // At the gate the highlight jumps, and rounding decides on which side a point falls.
        if dot(normal64, to_light).abs() < 1e-5 {
            continue;
        }
        let double = shade(
            &Surface { position: to_f64(position), normal: normal64 },
            &Coefficients::from(&material),
            &[spot.at(to_f64(place), to_f64(direction)).expect("a direction")],
            [0.1; 3],
            &View::Local([0.0; 3]),
            reflectance,
        );
        let single = shade(
            &Surface { position, normal: normalize(normal).expect("unit") },
            &Coefficients::from(&material),
            &[spot.at(place, direction).expect("a direction")],
            [0.1; 3],
            &View::Local([0.0; 3]),
            reflectance,
        );
        for i in 0..3 {
            // A cosine is off by about 2e-7; the largest exponent here, matched from 128, multiplies that by 513.
            close(f64::from(single[i]), double[i], 1.5e-4, &format!("round {round}, {reflectance:?}"));
        }
        compared += 1;
    }
    assert!(compared > 19_000, "{compared} compared");
}

/// A highlight of exponent 10⁴ is 0.8 degrees wide under Blinn–Phong. In `f32` it keeps its peak and its shape.
#[test]
fn a_sharp_highlight_survives_f32() {
    let mut rng = Pcg::new(6);
    let (mut worst, mut peak) = (0f64, 1f64);
    for _ in 0..2000 {
        let n = to_f32(rng.direction());
        let (l, v) = (rng.direction(), to_f64(n));
        let Some(towards) = half_vector(l, v) else { continue };
        if dot(l, v) < 0.1 {
            continue;
        }
        // n is the halfway vector, tilted by up to 1.5 degrees.
        let tilt = rng.direction().map(|x| x * rng.between(0.0, 0.025));
        let normal = normalize([0, 1, 2].map(|i| towards[i] + tilt[i])).expect("unit");
        let [n32, l32, v32] = [normal, l, v].map(|a| normalize(to_f32(a)).expect("unit"));
        let single = f64::from(specular_blinn_phong(n32, l32, v32, 1e4));
        let double = specular_blinn_phong(normal, l, v, 1e4);
        worst = worst.max((single - double).abs());
        let on_peak = specular_blinn_phong(normalize(to_f32(towards)).expect("unit"), l32, v32, 1e4);
        peak = peak.min(f64::from(on_peak));
    }
    assert!(worst < 5e-3, "the largest error is {worst}");
    assert!(peak > 0.995, "a peak fell to {peak}");
}

#[test]
fn a_sharp_phong_highlight_survives_f32() {
    let n = [0.0, 0.0, 1.0];
    for step in 0..1000 {
        let off = f64::from(step) * 3e-5;
        for l_angle in [0.1, 0.7, 1.3] {
            let (l, v) = (in_plane(l_angle), in_plane(-l_angle + off));
            let double = specular_phong(n, l, v, 1e4);
            let single = specular_phong(to_f32(n), to_f32(l), to_f32(v), 1e4);
            // Three roundings of a cosine near 1, 6e-8 each, times the exponent, times the highlight itself.
            close(f64::from(single), double, 2.5e-3, &format!("{off} rad off a peak at {l_angle}"));
        }
    }
}
