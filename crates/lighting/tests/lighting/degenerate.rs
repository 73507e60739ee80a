//! Degenerate inputs give the results of the simpler inputs they equal.

use core::f32::consts::PI;

use bevy_color::LinearRgba;
use halfway_lighting::equations::{Coefficients, Directional, Eye, Light, ShadedPoint, light_contribution, shade};
use halfway_lighting::homogeneous::{LightPlace, from_homogeneous};
use halfway_lighting::{Attenuation, Cone, DirectionalLight, Material, PointLight, Reflectance, SpotLight};

use crate::support::{ALL_REFLECTANCES, Pcg, close3, distinct_material, shade_dark};

const VIEW: Eye<f64> = Eye::Local([0.0; 3]);

fn surfaces() -> impl Iterator<Item = ShadedPoint<f64>> {
    let mut rng = Pcg::new(3);
    (0..300).map(move |_| ShadedPoint {
        position: [rng.between(-2.0, 2.0), rng.between(-2.0, 2.0), rng.between(-6.0, -1.0)],
        normal: rng.direction(),
    })
}

#[test]
fn no_lights_leave_emission_and_ambient() {
    let material = distinct_material(10.0);
    let ga = [0.5, 0.25, 2.0];
    let expected = [0.03125 + 0.125 * 0.5, 0.25 * 0.25, 0.015_625 + 0.375 * 2.0];
    for surface in surfaces() {
        for reflectance in ALL_REFLECTANCES {
            assert_eq!(shade(&surface, &Coefficients::from(&material), &[], ga, &VIEW, reflectance), expected);
        }
    }
}

#[test]
fn black_lights_are_no_lights() {
    let material = distinct_material(10.0);
    let black = PointLight::new(LinearRgba::BLACK).at([1.0, 2.0, 0.0]);
    for surface in surfaces() {
        let dark = shade_dark(&surface, &material, &[], &VIEW, Reflectance::BlinnPhong);
        assert_eq!(shade_dark(&surface, &material, &[black; 3], &VIEW, Reflectance::BlinnPhong), dark);
    }
}

#[test]
fn without_specular_it_is_lambert() {
    let material = Material { emission: LinearRgba::BLACK, ..Material::matte(LinearRgba::rgb(0.25, 0.5, 0.75)) };
    let sun = DirectionalLight::white().along([0.0, -3.0, -4.0]).expect("a direction");
    for surface in surfaces() {
        let cosine = (0.6 * surface.normal[1] + 0.8 * surface.normal[2]).max(0.0);
        for reflectance in ALL_REFLECTANCES {
            let got = shade_dark(&surface, &material, &[sun], &VIEW, reflectance);
            close3(got, [0.25 * cosine, 0.5 * cosine, 0.75 * cosine], 1e-15, "Lambert");
        }
    }
}

#[test]
fn emission_ignores_everything_but_itself() {
    let material = Material::emissive(LinearRgba::rgb(0.5, 1.0, 2.0));
    for surface in surfaces() {
        let lights = [PointLight::white().at([0.0, 1.0, 0.0])];
        let got = shade(&surface, &Coefficients::from(&material), &lights, [1.0; 3], &VIEW, Reflectance::Phong);
        assert_eq!(got, [0.5, 1.0, 2.0]);
    }
}

#[test]
fn a_far_point_light_is_directional() {
    let material = distinct_material(20.0);
    let far = PointLight { attenuation: Attenuation::NONE, ..PointLight::white() };
    let toward = [0.48, 0.6, 0.64];
    let point = far.at(toward.map(|x| x * 1e6));
    let sun = DirectionalLight::white().along(toward.map(|x| -x)).expect("a direction");
    for surface in surfaces() {
        // Just at the gate the two may fall on different sides of it.
        let nl: f64 = (0..3).map(|i| surface.normal[i] * toward[i]).sum();
        if nl.abs() < 1e-5 {
            continue;
        }
        for reflectance in ALL_REFLECTANCES {
            let a = shade_dark(&surface, &material, &[point], &VIEW, reflectance);
            let b = shade_dark(&surface, &material, &[sun], &VIEW, reflectance);
            // l differs by |p|/10⁶ ≤ 7e-6 rad, times the steepest slope, which grows as √exponent.
            close3(a, b, 1e-4, "a light a million units away");
        }
    }
}

#[test]
fn a_cutoff_of_pi_is_a_point_light() {
    let light = PointLight { attenuate_ambient: true, ambient: LinearRgba::rgb(0.1, 0.2, 0.3), ..PointLight::white() };
    let spot = SpotLight { light, cone: Cone { cutoff: PI, inner: Some(0.2), exponent: 40.0 } };
    let position = [1.0, 3.0, -2.0];
    let (as_spot, as_point) = (spot.at(position, [0.0, 1.0, 0.0]).expect("a direction"), light.at(position));
    assert_eq!(as_spot, as_point);
    for surface in surfaces() {
        let material = distinct_material(10.0);
        assert_eq!(
            shade_dark(&surface, &material, &[as_spot], &VIEW, Reflectance::BlinnPhong),
            shade_dark(&surface, &material, &[as_point], &VIEW, Reflectance::BlinnPhong)
        );
    }
}

#[test]
fn w_of_zero_is_directional() {
    let place = from_homogeneous([0.0, 3.0, 4.0, 0.0].into()).expect("a direction");
    let LightPlace::Directional(toward) = place else { panic!("w = 0 gave {place:?}") };
    let Light::Point(lamp) = PointLight::white().at([0.0; 3]) else { panic!("a point") };
    let from_w = Light::Directional(Directional { toward: toward.to_array().map(f64::from), colors: lamp.colors });
    let sun = DirectionalLight::white().along([0.0, -3.0, -4.0]).expect("a direction");
    let material = Coefficients::from(&distinct_material(10.0));
    for surface in surfaces() {
        let a = light_contribution(&surface, &material, &from_w, &VIEW, Reflectance::BlinnPhong);
        let b = light_contribution(&surface, &material, &sun, &VIEW, Reflectance::BlinnPhong);
        // The direction went through f32. A point light's attenuation must not touch it.
        close3(a, b, 1e-6, "w = 0 against a directional light");
    }
}

#[test]
fn an_exponent_of_zero_lights_the_whole_side() {
    let material = Material { specular: LinearRgba::WHITE, shininess: 0.0, ..Material::matte(LinearRgba::BLACK) };
    let sun = DirectionalLight::white().along([0.0, -3.0, -4.0]).expect("a direction");
    for surface in surfaces() {
        let lit = 0.6 * surface.normal[1] + 0.8 * surface.normal[2] > 0.0;
        for reflectance in ALL_REFLECTANCES {
            let got = shade_dark(&surface, &material, &[sun], &VIEW, reflectance);
            assert_eq!(got, [f64::from(u8::from(lit)); 3], "{reflectance:?}");
        }
    }
}

#[test]
fn an_endless_range_is_no_range() {
    let light = PointLight::white();
    let ranged = PointLight { range: Some(f32::MAX), ..light };
    let material = distinct_material(10.0);
    for surface in surfaces() {
        let [a, b] = [light, ranged]
            .map(|light| shade_dark(&surface, &material, &[light.at([1.0, 1.0, 1.0])], &VIEW, Reflectance::Phong));
        assert_eq!(a, b);
    }
}
