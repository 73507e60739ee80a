//! Random values over sixteen decades, and the ends of the number range: never NaN, infinite or negative.

use core::f32::consts::{FRAC_PI_2, PI};

use bevy_color::LinearRgba;
use halfway_lighting::equations::vector::normalize;
use halfway_lighting::equations::{Coefficients, Light, Real, Surface, View, shade};
use halfway_lighting::{
    Attenuation, CHANNEL_MAX, Cone, DirectionalLight, Material, PointLight, Reflectance, SpotLight,
};

use crate::support::{ALL_REFLECTANCES, Pcg};

const LOW: f64 = -8.0;
const HIGH: f64 = 8.0;

fn number(rng: &mut Pcg) -> f32 {
    if rng.chance(0.15) { 0.0 } else { rng.magnitude(LOW, HIGH) as f32 }
}

fn color(rng: &mut Pcg) -> LinearRgba {
    LinearRgba::rgb(number(rng), number(rng), number(rng))
}

fn material(rng: &mut Pcg) -> Material {
    Material {
        ambient: color(rng),
        diffuse: color(rng),
        specular: color(rng),
        emission: color(rng),
        shininess: number(rng),
        opacity: rng.unit() as f32,
    }
}

fn point_light(rng: &mut Pcg) -> PointLight {
    let mut attenuation = Attenuation::new(number(rng), number(rng), number(rng));
    if attenuation.validate().is_err() {
        attenuation = Attenuation::INVERSE_SQUARE;
    }
    PointLight {
        ambient: color(rng),
        diffuse: color(rng),
        specular: color(rng),
        attenuation,
        range: rng.chance(0.5).then(|| rng.magnitude(LOW, HIGH) as f32),
        attenuate_ambient: rng.chance(0.5),
    }
}

fn cone(rng: &mut Pcg) -> Cone {
    let cutoff = match rng.between(0.0, 4.0) as u8 {
        0 => 0.0,
        1 => PI,
        2 => FRAC_PI_2,
        _ => (rng.unit() as f32) * FRAC_PI_2,
    };
    let share = [0.0, 1.0, rng.unit() as f32][rng.between(0.0, 3.0) as usize];
    Cone { cutoff, inner: rng.chance(0.5).then_some(cutoff * share), exponent: number(rng) }
}

/// One random scene in f64; `light_at` and `eye_at` may sit exactly on the surface.
struct Sample {
    material: Material,
    light: Light<f64>,
    surface: Surface<f64>,
    view: View<f64>,
}

fn sample(rng: &mut Pcg) -> Sample {
    let material = material(rng);
    material.validate().expect("a valid material");
    let position = rng.signed(LOW, HIGH);
    let near = |rng: &mut Pcg| match rng.between(0.0, 4.0) as u8 {
        0 => position,
        1 => [position[0], position[1], rng.magnitude(LOW, HIGH)],
        _ => rng.signed(LOW, HIGH),
    };
    let light = match rng.between(0.0, 3.0) as u8 {
        0 => {
            let light = point_light(rng);
            light.validate().expect("a valid light");
            light.at(near(rng))
        }
        1 => {
            let spot = SpotLight { light: point_light(rng), cone: cone(rng) };
            spot.validate().expect("a valid spot light");
            spot.at(near(rng), rng.signed(LOW, HIGH)).expect("a direction")
        }
        _ => {
            let light = DirectionalLight { ambient: color(rng), diffuse: color(rng), specular: color(rng) };
            light.validate().expect("a valid light");
            light.along(rng.signed(LOW, HIGH)).expect("a direction")
        }
    };
    let view = if rng.chance(0.5) { View::Local(near(rng)) } else { View::Infinite(rng.direction()) };
    Sample { material, light, surface: Surface { position, normal: rng.direction() }, view }
}

fn check<T: Real>(name: &str, got: [T; 3]) {
    for value in got {
        assert!(value.is_finite() && value >= T::zero(), "{name}: {got:?}");
    }
}

fn to_f32(a: [f64; 3]) -> [f32; 3] {
    a.map(|x| x as f32)
}

fn light_in_f32(light: &Light<f64>) -> Light<f32> {
    use halfway_lighting::equations::{ConeTerms, Place};
    Light {
        place: match light.place {
            Place::Point(p) => Place::Point(to_f32(p)),
            Place::Directional(l) => Place::Directional(normalize(to_f32(l)).expect("unit")),
        },
        la: to_f32(light.la),
        ld: to_f32(light.ld),
        ls: to_f32(light.ls),
        attenuation: to_f32(light.attenuation),
        range: light.range.map(|x| x as f32),
        cone: light.cone.map(|cone| ConeTerms {
            direction: normalize(to_f32(cone.direction)).expect("unit"),
            cos_cutoff: cone.cos_cutoff as f32,
            cos_inner: cone.cos_inner.map(|x| x as f32),
            exponent: cone.exponent as f32,
        }),
        attenuate_ambient: light.attenuate_ambient,
    }
}

#[test]
fn sixteen_decades_stay_finite_and_non_negative() {
    let mut rng = Pcg::new(20);
    let mut lit = 0;
    for round in 0..30_000 {
        let Sample { material, light, surface, view } = sample(&mut rng);
        let reflectance = ALL_REFLECTANCES[round % 3];
        let name = format!("round {round}, {material:?}, {light:?}, {surface:?}, {view:?}, {reflectance:?}");
        let double = shade(&surface, &Coefficients::from(&material), &[light], [1.0; 3], &view, reflectance);
        check(&name, double);
        let dark = shade(&surface, &Coefficients::from(&material), &[], [1.0; 3], &view, reflectance);
        lit += usize::from(double != dark);
        let surface =
            Surface { position: to_f32(surface.position), normal: normalize(to_f32(surface.normal)).expect("unit") };
        let view = match view {
            View::Local(eye) => View::Local(to_f32(eye)),
            View::Infinite(v) => View::Infinite(normalize(to_f32(v)).expect("unit")),
        };
        let light = light_in_f32(&light);
        check(&name, shade(&surface, &Coefficients::from(&material), &[light], [1.0f32; 3], &view, reflectance));
    }
    assert!(lit > 10_000, "the sweep must light surfaces to mean anything; it lit {lit}");
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
        opacity: 1.0,
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
                let surface = Surface { position: p, normal: [0.0, 0.0, 1.0] };
                let lights = [light.at(q), spot.at(q, [0.0, 0.0, -f32::MAX]).expect("a direction")];
                for shininess in [0.0, 1.0, f32::MAX] {
                    let coefficients = Coefficients::from(&Material { shininess, ..material });
                    let ga = [CHANNEL_MAX; 3];
                    for reflectance in ALL_REFLECTANCES {
                        let got = shade(&surface, &coefficients, &lights, ga, &View::Local(q), reflectance);
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
        ..PointLight::from_color(brightest)
    };
    let material = Coefficients::from(&Material { specular: brightest, ..Material::matte(brightest) });
    let surface = Surface { position: [0f32; 3], normal: [0.0, 0.0, 1.0] };
    let lights = vec![light.at([0.0; 3]); 100_000];
    let got = shade(&surface, &material, &lights, [0.0; 3], &View::Infinite([0.0, 0.0, 1.0]), Reflectance::Phong);
    check("all at the lit point", got);
}
