//! The ends of the number range: never NaN, infinite or negative.

use bevy_color::LinearRgba;
use halfway_lighting::equations::{Coefficients, Eye, Real, ShadedPoint, shade};
use halfway_lighting::{Attenuation, CHANNEL_MAX, Cone, Material, PointLight, Reflectance, SpotLight};

use crate::support::ALL_REFLECTANCES;

fn check<T: Real>(name: &str, got: [T; 3]) {
    for value in got {
        assert!(value.is_finite() && value >= T::zero(), "{name}: {got:?}");
    }
}

#[test]
fn the_ends_of_f32_stay_finite_and_non_negative() {
    let brightest = LinearRgba::rgb(CHANNEL_MAX, CHANNEL_MAX, CHANNEL_MAX);
    let material = Material {
        ambient: brightest,
        diffuse: brightest,
        specular: brightest,
        emission: brightest,
        shininess: f32::MAX,
        ..Material::DEFAULT
    };
    material.validate().expect("the largest values are allowed");
    let coordinates = [0.0, f32::MIN_POSITIVE, -1.0, 1e19, -f32::MAX, f32::MAX];
    let mut points = Vec::new();
    for x in coordinates {
        for z in coordinates {
            points.push([x, 0.0, z]);
        }
    }
    for attenuation in [Attenuation::NONE, Attenuation::INVERSE_SQUARE, Attenuation::new(0.0, 1e-38, 0.0)] {
        let light = PointLight {
            ambient: brightest,
            diffuse: brightest,
            specular: brightest,
            attenuation,
            range: Some(f32::MAX),
            attenuate_ambient: true,
        };
        let spot = SpotLight { light, cone: Cone { cutoff: 0.0, inner: Some(0.0), exponent: f32::MAX } };
        for &p in &points {
            for &q in &points {
                let surface = ShadedPoint { position: p, normal: [0.0, 0.0, 1.0] };
                let lights = [light.at(q), spot.at(q, [0.0, 0.0, -f32::MAX]).expect("a direction")];
                for shininess in [0.0, 1.0, f32::MAX] {
                    let coefficients = Coefficients::from(&Material { shininess, ..material });
                    let ga = [CHANNEL_MAX; 3];
                    for reflectance in ALL_REFLECTANCES {
                        let got = shade(&surface, &coefficients, &lights, ga, &Eye::Local(q), reflectance);
                        check(&format!("{p:?} {q:?} {attenuation:?} {shininess:e}"), got);
                    }
                }
            }
        }
    }
}

#[test]
fn a_hundred_thousand_lights_at_the_limit_stay_finite() {
    let brightest = LinearRgba::rgb(CHANNEL_MAX, CHANNEL_MAX, CHANNEL_MAX);
    let light = PointLight {
        attenuation: Attenuation::INVERSE_SQUARE,
        ambient: brightest,
        attenuate_ambient: true,
        ..PointLight::new(brightest)
    };
    let material = Coefficients::from(&Material { specular: brightest, ..Material::matte(brightest) });
    let surface = ShadedPoint { position: [0f32; 3], normal: [0.0, 0.0, 1.0] };
    let lights = vec![light.at([0.0; 3]); 100_000];
    let got = shade(&surface, &material, &lights, [0.0; 3], &Eye::Infinite([0.0, 0.0, 1.0]), Reflectance::Phong);
    check("all at the lit point", got);
}
