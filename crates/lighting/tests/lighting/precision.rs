//! Sharp highlights in `f32` against `f64`.

use halfway_lighting::equations::vector::{dot, normalize};
use halfway_lighting::equations::{half_vector, specular_blinn_phong, specular_phong};

use crate::support::{Pcg, close, in_plane, to_f32, to_f64};

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
