//! Noise and solids: determinism, statistics, and fading with distance.

use halfway_texture::noise::{checker, fade, fractal, gradient_noise, hash, marble, wood};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Points that lie on no lattice.
fn points(count: u32) -> impl Iterator<Item = [f64; 3]> {
    (0..count).map(|k| [0.754_877, 0.569_840, 0.321_984].map(|step| f64::from(k) * step * 7.0))
}

#[test]
fn the_hash_is_the_published_one() {
    // By the steps of pcg3d, worked out by hand for (0, 0, 0): all three are 1013904223 at first.
    let c = 1_013_904_223_u32;
    let x = c.wrapping_add(c.wrapping_mul(c));
    let y = c.wrapping_add(c.wrapping_mul(x));
    let z = c.wrapping_add(x.wrapping_mul(y));
    let [x, y, z] = [x ^ x >> 16, y ^ y >> 16, z ^ z >> 16];
    let x = x.wrapping_add(y.wrapping_mul(z));
    let y = y.wrapping_add(z.wrapping_mul(x));
    assert_eq!(hash([0; 3]), [x, y, z.wrapping_add(x.wrapping_mul(y))]);
    // The four bits that choose a direction are all about as frequent, over 32³ cells.
    let mut counts = [0_u32; 16];
    for k in 0..1 << 15 {
        counts[(hash([k & 31, k >> 5 & 31, k >> 10])[0] >> 28) as usize] += 1;
    }
    // 2048 expected each, standard deviation 44: within five.
    assert!(counts.iter().all(|count| count.abs_diff(2048) < 220), "{counts:?}");
}

#[test]
fn noise_is_zero_at_whole_numbers_and_repeatable() {
    for k in -50..50 {
        assert_eq!(gradient_noise([f64::from(k), f64::from(3 * k), f64::from(-k)]), 0.0);
    }
    for bad in [f64::NAN, f64::INFINITY, 1e30] {
        assert_eq!(gradient_noise([bad, 0.5, 0.5]), 0.0);
    }
    // Its value at a point, worked out from the formula: in the middle of a cell all weights are ½.
    let mean = (0..8).map(|k| {
        let offset = [k & 1, k >> 1 & 1, k >> 2];
        let h = hash(offset)[0] >> 28;
        let d = offset.map(|o| 0.5 - f64::from(o));
        let u = if h < 8 { d[0] } else { d[1] };
        let v = if h < 4 {
            d[1]
        } else if h == 12 || h == 14 {
            d[0]
        } else {
            d[2]
        };
        (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
    });
    assert_eq!(gradient_noise([0.5, 0.5, 0.5]), mean.sum::<f64>() / 8.0);
}

#[test]
fn noise_has_the_documented_mean_and_variance() {
    let count = 200_000;
    let (mut sum, mut squares, mut most) = (0.0, 0.0, 0.0_f64);
    for p in points(count) {
        let value = gradient_noise(p);
        sum += value;
        squares += value * value;
        most = most.max(value.abs());
    }
    let (mean, variance) = (sum / f64::from(count), squares / f64::from(count));
    println!("gradient noise: mean {mean:.5}, standard deviation {:.4}, largest {most:.3}", variance.sqrt());
    // Values 1/√n apart: 0.27/√(200,000) is 0.0006, times five.
    assert!(mean.abs() < 0.003 && (0.2..0.35).contains(&variance.sqrt()) && most <= 1.04);
    // One of the few cells in which it is more than 1.
    let rare = gradient_noise([16.5, 36.45, 20.45]);
    assert!((1.01..1.04).contains(&rare), "{rare}");
}

/// The power along a line of 256 cells, by the frequency: hardly any above 1 cycle a cell. A line through space also
/// has low ones, which need no fading.
#[test]
fn noise_lies_in_a_band() {
    const CELLS: usize = 256;
    const SAMPLES: usize = 8 * CELLS;
    let mut power = vec![0.0; SAMPLES / 2];
    for line in 0..4 {
        let values: Vec<f64> =
            (0..SAMPLES).map(|k| gradient_noise([k as f64 / 8.0 + 0.03, 17.4 + 31.7 * f64::from(line), 5.3])).collect();
        for (frequency, power) in power.iter_mut().enumerate() {
            let (mut re, mut im) = (0.0, 0.0);
            for (k, value) in values.iter().enumerate() {
                let angle = TAU * (frequency * k % SAMPLES) as f64 / SAMPLES as f64;
                re += value * angle.cos();
                im += value * angle.sin();
            }
            *power += re * re + im * im;
        }
    }
    let total: f64 = power.iter().sum();
    let share = |low: f64, high: f64| {
        let place = |cycles: f64| (cycles * CELLS as f64) as usize;
        power[place(low)..place(high)].iter().sum::<f64>() / total
    };
    let shares = [share(0.0, 0.5), share(0.5, 1.0), share(1.0, 2.0), share(2.0, 4.0)];
    println!(
        "power below ½ cycle a cell {:.3}, ½ to 1 {:.3}, 1 to 2 {:.4}, above {:.5}",
        shares[0], shares[1], shares[2], shares[3]
    );
    assert!(shares[1] > 0.05 && shares[2] < 0.01 && shares[3] < 5e-4, "{shares:?}");
}

#[test]
fn octaves_fade_as_the_footprint_grows() {
    assert_eq!((fade(0.2), fade(0.5), fade(0.8)), (1.0, 0.5, 0.0));
    let p = [3.7, 1.2, -8.4];
    // From a width of 3/4 of the first octave's cell on, only the mean remains; below 1/4 of the last one's,
    // everything.
    assert_eq!(fractal(p, 5, 0.75), 0.0);
    assert_eq!(fractal(p, 5, 0.25 / 16.0), fractal(p, 5, 0.0));
    assert_eq!(fractal(p, 5, 0.25 / 4.0), fractal(p, 5, 0.25 / 4.0));
    assert_eq!(fractal(p, 3, 0.25 / 4.0), fractal(p, 3, 0.0));
    // A faded octave equals one that is left out.
    assert_eq!(fractal(p, 9, 0.75 / 8.0), fractal(p, 3, 0.75 / 8.0));
    for width in [f64::NAN, f64::INFINITY, -0.1, 1.5] {
        for value in [fractal(p, 8, width), marble(p, 8, width), wood(p, width), checker(p, [width; 3])] {
            assert!(value.is_finite(), "{width}: {value}");
        }
    }
    assert_eq!([marble(p, 4, 1.0), wood(p, 1.0)], [0.5; 2]);
}

/// For pixels of a growing width, the fading sum is nearer to the mean over the pixel than the whole sum is.
#[test]
fn fading_is_nearer_to_the_mean_over_the_pixel() {
    for width in [0.1, 0.2, 0.4, 0.8] {
        let [mut fading, mut whole] = [0.0; 2];
        for p in points(300) {
            let samples = (0..512).map(|k| {
                let at = |k: i32| (f64::from(k % 8) + 0.5) / 8.0 - 0.5;
                fractal([p[0] + width * at(k), p[1] + width * at(k / 8), p[2] + width * at(k / 64)], 6, 0.0)
            });
            let truth = samples.sum::<f64>() / 512.0;
            fading += (fractal(p, 6, width) - truth).powi(2);
            whole += (fractal(p, 6, 0.0) - truth).powi(2);
        }
        let [fading, whole] = [fading, whole].map(|sum: f64| (sum / 300.0).sqrt());
        println!("width {width}: RMS from the mean over the pixel {fading:.3} fading, {whole:.3} whole");
        assert!(fading < whole, "{width}");
    }
}

#[test]
fn the_checkers_mean_is_exact() {
    assert_eq!([checker([0.5; 3], [0.0; 3]), checker([1.5, 0.5, 0.5], [0.0; 3])], [0.0, 1.0]);
    for p in points(40) {
        let widths = [0.3 + p[0] % 2.0, 0.2 + p[1] % 1.5, 0.7];
        let n = 60;
        let at = |k: i32, axis: usize| p[axis] + widths[axis] * ((f64::from(k) + 0.5) / f64::from(n) - 0.5);
        let white = |k: i32| {
            let cell = [at(k % n, 0), at(k / n % n, 1), at(k / n / n, 2)].map(|x: f64| x.floor() as i64);
            cell.iter().sum::<i64>().rem_euclid(2)
        };
        let truth = (0..n * n * n).map(white).sum::<i64>() as f64 / f64::from(n * n * n);
        // A sample stands for 1/60 of each side: edges are off by half of that.
        assert!((checker(p, widths) - truth).abs() < 0.02, "{p:?}: {} {truth}", checker(p, widths));
    }
}

proptest! {
    /// f32 is near f64, and both in their ranges.
    #[test]
    fn single_precision_is_near_double(p in prop::array::uniform3(-50.0..50.0_f32), width in 0.0..1.0_f32) {
        let q = p.map(f64::from);
        let pairs = [
            (gradient_noise(p), gradient_noise(q), 1.04, 2e-5),
            // 2⁵ times as steep as the first octave, at half the amplitude each.
            (fractal(p, 6, width), fractal(q, 6, width.into()), 2.08, 2e-4),
            (marble(p, 6, width), marble(q, 6, width.into()), 1.0, 1e-3),
            (wood(p, width), wood(q, width.into()), 1.0, 1e-3),
            (checker(p, [width + 0.1; 3]), checker(q, [f64::from(width + 0.1); 3]), 1.0, 1e-3),
        ];
        for (single, double, most, near) in pairs {
            prop_assert!((f64::from(single) - double).abs() < near, "{single} {double}");
            prop_assert!(double.abs() <= most + 1e-9);
        }
    }

    /// Noise is continuous up to the second derivative: no cell is visible.
    #[test]
    fn cells_meet(x in -20_i32..20, y in -3.0..3.0_f64, z in -3.0..3.0_f64) {
        let at = |offset: f64| gradient_noise([f64::from(x) + offset, y, z]);
        let h = 1e-3;
        prop_assert!((at(1e-9) - at(-1e-9)).abs() < 1e-8);
        let [before, after] = [-1.0, 1.0].map(|side| (at(3.0 * side * h) - 2.0 * at(2.0 * side * h) + at(side * h)) / (h * h));
        // The third derivative is at most about 100.
        prop_assert!((before - after).abs() < 0.5, "{before} {after}");
    }
}
