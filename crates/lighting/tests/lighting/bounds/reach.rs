//! Beyond its reach a light adds less than ε, and just within it more.

use bevy_color::LinearRgba;
use halfway_lighting::bounds::reach;
use halfway_lighting::equations::{Light, ShadedPoint, incidence};
use halfway_lighting::{Attenuation, DirectionalLight, PointLight};
use proptest::prelude::*;

use super::support::{Kind, cases, source};

/// att·(Ld + Ls), and La where attenuated, at a distance: the largest channel.
fn brightness(light: &Light<f64>, d: f64) -> f64 {
    let surface = ShadedPoint { position: [d, 0.0, 0.0], normal: [-1.0, 0.0, 0.0] };
    let weight = incidence(&surface, light).weight;
    let ambient = f64::from(u8::from(light.attenuate_ambient));
    (0..3).map(|c| weight * (ambient * light.la[c] + light.ld[c] + light.ls[c])).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn a_light_falls_below_epsilon_at_its_reach(mut source in source(), exponent in -6f64..3.0, beyond in 1f64..10.0) {
        source.kind = Kind::Point;
        source.position = [0.0; 3];
        let epsilon = 10f64.powf(exponent);
        let light = source.light::<f64>();
        for reach in [reach(&light, epsilon), f64::from(reach(&source.light::<f32>(), epsilon as f32))] {
            if reach.is_infinite() {
                prop_assert!(brightness(&light, 1e30) > 0.99 * epsilon);
                continue;
            }
            // An ε rounded to f32 moves the reach; by no more than 10⁻⁶ of ε.
            prop_assert!(brightness(&light, reach * beyond) <= epsilon * (1.0 + 1e-6));
            if reach > 0.0 {
                // Where the light falls steeply, at a range's end, 10⁻⁵ of the distance is much light; so only "more".
                prop_assert!(brightness(&light, reach * (1.0 - 1e-5)) >= epsilon * (1.0 - 1e-6));
            } else {
                prop_assert!(brightness(&light, 0.0) <= epsilon * (1.0 + 1e-6));
            }
        }
    }
}

#[test]
fn reach_has_its_closed_forms() {
    let rows = [
        ("inverse square", Attenuation::INVERSE_SQUARE, None, 10.0),
        ("linear", Attenuation::new(0.0, 1.0, 0.0), None, 100.0),
        ("no falloff", Attenuation::NONE, None, f64::INFINITY),
        ("no falloff, but an end", Attenuation::NONE, Some(3.0), 3.0 * (1.0 - 0.1f64).powf(0.25)),
        ("too weak at its place already", Attenuation::new(200.0, 0.0, 1.0), None, 0.0),
    ];
    for (name, attenuation, range, expected) in rows {
        // Ld and Ls of a half each: 1 together.
        let half = LinearRgba::rgb(0.5, 0.0, 0.5);
        let light: Light<f64> = PointLight { attenuation, range, ..PointLight::from_color(half) }.at([4.0, 5.0, 6.0]);
        let reached = reach(&light, 0.01);
        let same = reached == expected || (reached / expected - 1.0).abs() < 2e-6;
        assert!(same, "{name}: {reached} instead of {expected}");
    }
    // Near its place, where the cap takes part: 1/d² = 5·10⁵.
    let near: Light<f64> = PointLight {
        attenuation: Attenuation::INVERSE_SQUARE,
        ..PointLight::from_color(LinearRgba::rgb(0.5, 0.5, 0.5))
    }
    .at([0.0; 3]);
    let reached = reach(&near, 5e5);
    assert!((reached / 2e-6f64.sqrt() - 1.0).abs() < 2e-6, "an inverse-square light near its place: {reached}");
    assert_eq!(reach(&near, 1.1e6), 0.0, "brighter than the cap");
    let sun: Light<f64> = DirectionalLight::white().along([0.0, -1.0, 0.0]).expect("not 0");
    assert_eq!(reach(&sun, 0.01), f64::INFINITY);
    let black: Light<f64> = PointLight::from_color(LinearRgba::BLACK).at([0.0; 3]);
    assert_eq!(reach(&black, 0.01), 0.0);
}
