//! Attenuation, range window and cone against closed forms.

use core::f32::consts::PI;
use core::f64::consts::FRAC_PI_6;

use halfway_lighting::Cone;
use halfway_lighting::equations::{ATTENUATION_MAX, ConeTerms, attenuation, range_window, spot_factor};

use crate::support::close;

#[test]
fn attenuation_by_hand() {
    let cap = f64::from(ATTENUATION_MAX);
    let rows: [(&str, [f64; 3], f64, f64); 10] = [
        ("none", [1.0, 0.0, 0.0], 123.0, 1.0),
        ("constant", [4.0, 0.0, 0.0], 0.5, 0.25),
        ("linear", [0.0, 0.5, 0.0], 8.0, 0.25),
        ("inverse square", [0.0, 0.0, 1.0], 4.0, 0.0625),
        ("all three", [1.0, 0.5, 0.25], 2.0, 1.0 / 3.0),
        ("d = 0 with a", [2.0, 1.0, 1.0], 0.0, 0.5),
        ("d = 0 without a", [0.0, 0.0, 1.0], 0.0, cap),
        ("below the cap's distance", [0.0, 0.0, 1.0], 1e-4, cap),
        ("above the cap's distance", [0.0, 0.0, 1.0], 2e-3, 250_000.0),
        ("a below the cap", [1e-9, 0.0, 0.0], 7.0, cap),
    ];
    for (name, constants, d, expected) in rows {
        close(attenuation(constants, d), expected, expected * 1e-12, name);
        // Two or three roundings of 6e-8 each.
        let single = attenuation(constants.map(|x| x as f32), d as f32);
        close(f64::from(single), expected, expected * 3e-7, name);
    }
}

#[test]
fn attenuation_is_finite_at_the_ends_of_f32() {
    let constants = [0.0, 1e-38, 1e-8, 1.0, 1e8, f32::MAX];
    let distances = [0.0, f32::MIN_POSITIVE, 1e-8, 1.0, 1e8, 1e30, f32::MAX, f32::INFINITY];
    for a in constants {
        for b in constants {
            for c in constants {
                for d in distances {
                    let att = attenuation([a, b, c], d);
                    assert!((0.0..=ATTENUATION_MAX * 1.000_001).contains(&att), "{a:e} {b:e} {c:e} at {d:e}: {att:e}");
                }
            }
        }
    }
    assert_eq!(attenuation([1.0, 0.0, 0.0], f32::INFINITY), 1.0, "no falloff stays none, even infinitely far away");
}

#[test]
fn range_window_by_hand() {
    let rows: [(&str, f64, f64, f64); 6] = [
        ("at the light", 0.0, 10.0, 1.0),
        ("half way: (1 - 1/16)^2", 5.0, 10.0, 0.878_906_25),
        ("at the range", 10.0, 10.0, 0.0),
        ("beyond", 11.0, 10.0, 0.0),
        ("far beyond", 1e300, 1e-300, 0.0),
        ("endless range", 1.0, 1e300, 1.0),
    ];
    for (name, d, range, expected) in rows {
        close(range_window(d, range), expected, 1e-15, name);
    }
    assert_eq!(range_window(f32::MAX, f32::MIN_POSITIVE), 0.0);
    assert_eq!(range_window(f32::MAX, f32::MAX), 0.0);
}

fn cone(cutoff: f32, inner: Option<f32>, exponent: f32) -> ConeTerms<f64> {
    Cone { cutoff, inner, exponent }.along([0.0, 0.0, -1.0]).expect("a cone")
}

#[test]
fn spot_by_hand() {
    let deg = f32::to_radians;
    let cos = |degrees: f64| degrees.to_radians().cos();
    // Angles came through f32, so that their cosines are known to about 1e-7.
    let fade = (cos(25.0) - cos(30.0)) / (cos(20.0) - cos(30.0));
    let rows = [
        ("on the axis", cone(deg(30.0), None, 0.0), 0.0, 1.0),
        ("inside, exponent 0", cone(deg(30.0), None, 0.0), 29.9, 1.0),
        ("outside", cone(deg(30.0), None, 0.0), 30.1, 0.0),
        ("exponent 2 at 30 degrees: 3/4", cone(deg(45.0), None, 2.0), 30.0, 0.75),
        ("behind", cone(deg(90.0), None, 1.0), 135.0, 0.0),
        ("inside the inner cone", cone(deg(30.0), Some(deg(20.0)), 0.0), 19.0, 1.0),
        ("between the cones", cone(deg(30.0), Some(deg(20.0)), 0.0), 25.0, fade * fade),
        ("between, with an exponent", cone(deg(30.0), Some(deg(20.0)), 3.0), 25.0, fade * fade * cos(25.0).powi(3)),
        ("outside both", cone(deg(30.0), Some(deg(20.0)), 0.0), 31.0, 0.0),
        ("inner as wide as the cutoff, inside", cone(deg(30.0), Some(deg(30.0)), 0.0), 29.9, 1.0),
        ("inner as wide as the cutoff, outside", cone(deg(30.0), Some(deg(30.0)), 0.0), 30.1, 0.0),
        ("a needle of one degree is bright on its axis", cone(deg(1.0), Some(deg(0.5)), 0.0), 0.0, 1.0),
        ("cutoff 0 on the axis", cone(0.0, None, 0.0), 0.0, 1.0),
        ("cutoff 0 and inner 0 on the axis", cone(0.0, Some(0.0), 5.0), 0.0, 1.0),
        ("cutoff 0 off the axis", cone(0.0, None, 0.0), 0.01, 0.0),
    ];
    for (name, cone, degrees, expected) in rows {
        close(spot_factor(cos(degrees), &cone), expected, 1e-5, name);
    }
}

#[test]
fn the_edge_of_a_cone_belongs_to_it() {
    for cos_cutoff in [0.25, 0.5, 0.75, 1.0] {
        let cone = |cos_inner| ConeTerms { direction: [0.0, 0.0, -1.0], cos_cutoff, cos_inner, exponent: 2.0 };
        let on = cos_cutoff * cos_cutoff;
        assert_eq!(spot_factor(cos_cutoff, &cone(None)), on, "a hard edge at {cos_cutoff}");
        assert_eq!(spot_factor(cos_cutoff, &cone(Some(cos_cutoff))), on, "inner as wide as the cutoff, {cos_cutoff}");
        assert_eq!(spot_factor(cos_cutoff - 1e-15, &cone(None)), 0.0, "just outside {cos_cutoff}");
    }
    let fading = ConeTerms { direction: [0.0, 0.0, -1.0], cos_cutoff: 0.5, cos_inner: Some(0.75), exponent: 0.0 };
    assert_eq!([0.5, 0.625, 0.75].map(|cos| spot_factor(cos, &fading)), [0.0, 0.25, 1.0], "a fade ends at its edges");
}

#[test]
fn a_right_angle_cone_ends_at_the_right_angle() {
    let half_space = |exponent| ConeTerms { direction: [0.0, 0.0, -1.0], cos_cutoff: 0.0, cos_inner: None, exponent };
    assert_eq!(spot_factor(0.0, &half_space(0.0)), 1.0, "0^0 = 1, and the edge belongs to the cone");
    assert_eq!(spot_factor(0.0, &half_space(2.0)), 0.0);
    assert_eq!(spot_factor(-1e-9, &half_space(0.0)), 0.0);
}

#[test]
fn the_fade_falls_from_one_to_zero() {
    let cone = cone(FRAC_PI_6 as f32, Some(0.2), 0.0);
    let mut last = 1.0;
    for step in 0..=1000 {
        let phi = FRAC_PI_6 * f64::from(step) / 1000.0;
        let factor = spot_factor(phi.cos(), &cone);
        assert!(factor <= last && (0.0..=1.0).contains(&factor), "at {phi}: {factor} after {last}");
        last = factor;
    }
    assert!(last < 1e-6, "the fade ends at the cutoff, not at {last}");
}

#[test]
fn no_cone_is_none() {
    assert_eq!(Cone { cutoff: PI, inner: Some(0.1), exponent: 9.0 }.along([0f64, 0.0, -1.0]), None);
    assert!(Cone::default().along([0f64, 0.0, -1.0]).is_some());
}
