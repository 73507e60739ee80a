//! The matched exponent against the exact curve, computed here.

use core::f64::consts::FRAC_PI_4;

use halfway_lighting::equations::specular_term;
use halfway_lighting::{Reflectance, matched_shininess};

use crate::support::{close, glossy, in_plane};

/// Nodes of the quadrature: ψ and weight, over the part of 0…π/4 where a lobe of exponent α is above e⁻²⁰⁰.
///
/// Midpoints in s with ψ = top·(1 − s⁴): the lobe ends at π/4 like (π/4 − ψ)^α, which s⁴ smooths for small α.
fn nodes(alpha: f64) -> Vec<(f64, f64, f64)> {
    const COUNT: u32 = 1500;
    // cos^α 2ψ < exp(−2αψ²)
    let top = FRAC_PI_4.min(10.0 / alpha.sqrt());
    (0..COUNT)
        .map(|i| {
            let s = (f64::from(i) + 0.5) / f64::from(COUNT);
            let psi = top * (1.0 - s.powi(4));
            // cos 2ψ at the end of the lobe without cancellation: sin(2(π/4 − ψ)).
            let cos_two_psi = (2.0 * (FRAC_PI_4 - top + top * s.powi(4))).sin();
            (psi, cos_two_psi, 4.0 * top * s.powi(3) / f64::from(COUNT))
        })
        .collect()
}

/// The β that minimises ∫ (cos^α 2ψ − cos^β ψ)² dψ: where the derivative by β changes sign, by bisection.
fn exact(alpha: f64) -> f64 {
    let nodes = nodes(alpha);
    let slope = |beta: f64| -> f64 {
        nodes
            .iter()
            .map(|&(psi, cos_two_psi, weight)| {
                let (log_cos, phong) = (psi.cos().ln(), cos_two_psi.powf(alpha));
                let blinn = (beta * log_cos).exp();
                weight * (phong - blinn) * blinn * log_cos
            })
            .sum()
    };
    let (mut low, mut high) = (3.9 * alpha, 9.0 * alpha);
    let sign = slope(low) > 0.0;
    assert_ne!(sign, slope(high) > 0.0, "the minimum for {alpha} is not between {low} and {high}");
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (slope(middle) > 0.0) == sign {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[test]
fn the_fit_keeps_its_documented_error() {
    let mut worst = 0f64;
    for step in -16..=16 {
        let alpha = 10f64.powf(f64::from(step) / 4.0);
        worst = worst.max((matched_shininess(alpha) / exact(alpha) - 1.0).abs());
    }
    assert!(worst < 4e-3, "documented: below 0.4 %; found {worst}");
    assert!(worst > 3e-3, "the documented figure is far too large; found {worst}");
}

#[test]
fn both_ends_are_the_documented_ones() {
    close(exact(1e-3) / 1e-3, 7.15, 0.01, "slope at 0, exact");
    close(matched_shininess(1e-9) / 1e-9, 7.15, 7.15 * 4e-3, "slope at 0, fitted");
    for alpha in [1e3, 1e4] {
        close(exact(alpha) - 4.0 * alpha, 1.25, 1e-3, "exact, large");
        close(matched_shininess(alpha) - 4.0 * alpha, 1.25, 2e-3, "fitted, large");
    }
    assert_eq!(matched_shininess(0.0), 0.0);
    assert_eq!(matched_shininess(f32::MAX), f32::MAX);
    assert_eq!(matched_shininess(1e20f32), 4e20);
}

/// The largest difference of the two lobes anywhere, in parts of the peak.
fn lobe_difference(alpha: f64, beta: f64) -> f64 {
    nodes(alpha)
        .iter()
        .map(|&(psi, cos_two_psi, _)| (cos_two_psi.powf(alpha) - psi.cos().powf(beta)).abs())
        .fold(0.0, f64::max)
}

#[test]
fn lobes_agree_within_the_documented_difference() {
    for alpha in [5.0, 7.0, 10.0, 20.0, 50.0, 100.0, 1000.0] {
        let matched = lobe_difference(alpha, matched_shininess(alpha));
        assert!(matched < 0.08 / alpha, "matched at {alpha}: {}", matched * alpha);
        let bare = lobe_difference(alpha, 4.0 * alpha);
        assert!(bare < 0.16 / alpha, "4α at {alpha}: {}", bare * alpha);
        assert!(matched < 0.7 * bare, "the match is worth having at {alpha}: {matched} against {bare}");
    }
    close(lobe_difference(1.0, matched_shininess(1.0)), 0.16, 0.01, "α = 1");
}

#[test]
fn matched_highlights_are_phongs_on_a_surface() {
    let n = [0.0, 0.0, 1.0];
    for shininess in [5.0, 20.0, 200.0] {
        for step in 0..=200 {
            // h is ψ from n and r is 2ψ from v, whatever the angle of l.
            let psi = FRAC_PI_4 * f64::from(step) / 200.0;
            for l_angle in [-0.7, 0.0, 0.7] {
                let (l, v) = (in_plane(l_angle), in_plane(2.0 * psi - l_angle));
                let phong = specular_term(Reflectance::Phong, n, l, v, &glossy(shininess));
                let matched = specular_term(Reflectance::BlinnPhongMatched, n, l, v, &glossy(shininess));
                let bare = specular_term(Reflectance::BlinnPhong, n, l, v, &glossy(4.0 * shininess));
                let name = format!("α {shininess}, ψ {psi}, l at {l_angle}");
                close(matched, phong, 0.08 / shininess, &name);
                close(bare, phong, 0.16 / shininess, &format!("β = 4α, {name}"));
            }
        }
    }
}

#[test]
fn it_grows_and_the_two_precisions_agree() {
    let mut last = 0.0;
    for step in -80..=300 {
        let alpha = 10f64.powf(f64::from(step) / 10.0);
        let beta = matched_shininess(alpha);
        assert!(beta > last, "at {alpha}");
        last = beta;
        let single = f64::from(matched_shininess(alpha as f32));
        close(single / beta, 1.0, 1e-6, &format!("f32 at {alpha}"));
    }
}
