//! The whole equation against numbers worked out by hand.

use core::f64::consts::FRAC_1_SQRT_2;

use bevy_color::LinearRgba;
use halfway_lighting::equations::{
    Coefficients, Eye, GRAZING, Incidence, Light, LightTerms, ShadedPoint, Spot, incidence, light_contribution,
    light_terms, shade, view_vector,
};
use halfway_lighting::{
    Attenuation, Cone, DirectionalLight, GlobalAmbient, HemisphereLight, Material, PointLight, Reflectance, SpotLight,
    Viewer,
};

use crate::support::{close, close3, distinct_material};

/// A point at the origin facing +Z.
const SURFACE: ShadedPoint<f64> = ShadedPoint { position: [0.0; 3], normal: [0.0, 0.0, 1.0] };

/// The direction and strength at the surface of a light that does not come from all around.
fn arriving(light: &Light<f64>) -> Incidence<f64> {
    incidence(&SURFACE, light).expect("a direction")
}
const VIEW: Eye<f64> = Eye::Infinite([0.0, 0.0, 1.0]);

/// At (3, 0, 4): d = 5, l = (0.6, 0, 0.8), n·l = 0.8, r·v = 0.8, n·h = 3/√10; attenuation 1/(1 + 5·0.2 + 25·0.08) =
/// 1/4.
fn light() -> PointLight {
    PointLight {
        ambient: LinearRgba::rgb(0.5, 0.25, 0.125),
        diffuse: LinearRgba::rgb(1.0, 2.0, 3.0),
        specular: LinearRgba::rgb(4.0, 0.5, 8.0),
        attenuation: Attenuation::new(1.0, 0.2, 0.08),
        range: None,
        attenuate_ambient: false,
    }
}

const PLACE: [f64; 3] = [3.0, 0.0, 4.0];

/// The constants of `light()` went through f32: 0.2 and 0.08 are off by 1e-8 relative.
const F32_CONSTANTS: f64 = 1e-7;

#[test]
fn one_light_by_hand() {
    let material = distinct_material(2.0);
    let coefficients = Coefficients::from(&material);
    let ga = [0.5, 0.25, 1.0];
    let unlit = [0.03125 + 0.125 * 0.5, 0.25 * 0.25, 0.015_625 + 0.375];
    let ambient = [0.125 * 0.5, 0.25 * 0.25, 0.375 * 0.125];
    let diffuse = [0.5 * 1.0, 0.625 * 2.0, 0.75 * 3.0].map(|x| x * 0.8 / 4.0);
    let gloss = [0.875 * 4.0, 1.0 * 0.5, 0.0625 * 8.0];
    // Exponent 2: Phong 0.8² = 0.64, Blinn–Phong 9/10.
    for (reflectance, s) in [(Reflectance::Phong, 0.64), (Reflectance::BlinnPhong, 0.9)] {
        let specular = gloss.map(|x| x * s / 4.0);
        let expected = core::array::from_fn(|i| unlit[i] + ambient[i] + diffuse[i] + specular[i]);
        let got = shade(&SURFACE, &coefficients, &[light().at(PLACE)], ga, &VIEW, reflectance);
        close3(got, expected, F32_CONSTANTS, &format!("{reflectance:?}"));
        let terms = light_terms(&SURFACE, &coefficients, &light().at(PLACE), &VIEW, reflectance);
        close3(terms.ambient, ambient, 1e-15, "ambient term");
        close3(terms.diffuse, diffuse, F32_CONSTANTS, "diffuse term");
        close3(terms.specular, specular, F32_CONSTANTS, "specular term");
    }
}

#[test]
fn attenuated_ambient_is_opengls() {
    let material = distinct_material(2.0);
    let coefficients = Coefficients::from(&material);
    let away = ShadedPoint { normal: [0.0, 0.0, -1.0], ..SURFACE };
    let full = [0.125 * 0.5, 0.25 * 0.25, 0.375 * 0.125];
    for (attenuate_ambient, share) in [(false, 1.0), (true, 0.25)] {
        let light = PointLight { attenuate_ambient, ..light() };
        let got = light_contribution(&away, &coefficients, &light.at(PLACE), &VIEW, Reflectance::Phong);
        close3(got, full.map(|x| x * share), F32_CONSTANTS, "a surface turned away has only the ambient term");
        let spot = SpotLight { light, cone: Cone::new(0.1) };
        let outside = spot.at(PLACE, [0.0, 1.0, 0.0]).expect("a direction");
        let got = light_contribution(&away, &coefficients, &outside, &VIEW, Reflectance::Phong);
        let share = if attenuate_ambient { 0.0 } else { 1.0 };
        close3(got, full.map(|x| x * share), 1e-15, "outside the cone");
    }
}

#[test]
fn strength_on_arrival_is_a_product() {
    let window = (1.0 - 0.5f64.powi(4)).powi(2);
    let ranged = PointLight { range: Some(10.0), ..light() };
    let Incidence { l, weight, .. } = arriving(&ranged.at(PLACE));
    close3(l, [0.6, 0.0, 0.8], 1e-15, "l");
    close(weight, 0.25 * window, F32_CONSTANTS, "attenuation times window");
    // The axis points from the light straight down: cos φ = 0.8, squared by the exponent.
    let spot = SpotLight { light: ranged, cone: Cone { cutoff: 1.0, inner: None, exponent: 2.0 } };
    let spot = spot.at(PLACE, [0.0, 0.0, -3.0]).expect("a direction");
    close(arriving(&spot).weight, 0.25 * window * 0.64, F32_CONSTANTS, "times cone");
}

#[test]
fn lights_add_up_in_any_number() {
    let coefficients = Coefficients::from(&distinct_material(8.0));
    let lights: Vec<Light<f64>> = (0..500)
        .map(|i| {
            let angle = f64::from(i);
            light().at([angle.cos() * 3.0, angle.sin() * 3.0, 2.0 + angle / 100.0])
        })
        .collect();
    let ga = [0.1, 0.2, 0.3];
    let all = shade(&SURFACE, &coefficients, &lights, ga, &VIEW, Reflectance::BlinnPhong);
    let mut sum = shade(&SURFACE, &coefficients, &[], ga, &VIEW, Reflectance::BlinnPhong);
    for light in &lights {
        let one = light_contribution(&SURFACE, &coefficients, light, &VIEW, Reflectance::BlinnPhong);
        sum = core::array::from_fn(|i| sum[i] + one[i]);
    }
    assert_eq!(all, sum);
}

#[test]
fn the_viewer_is_local_or_infinite() {
    let off_axis = ShadedPoint { position: [3.0, 0.0, -4.0], ..SURFACE };
    close3(view_vector(&off_axis, &Eye::in_eye_space(Viewer::Local)), [-0.6, 0.0, 0.8], 1e-15, "toward the eye");
    assert_eq!(view_vector(&off_axis, &Eye::in_eye_space(Viewer::Infinite)), [0.0, 0.0, 1.0]);
    let eye = Eye::Local([3.0, 5.0, -4.0]);
    assert_eq!(view_vector(&off_axis, &eye), [0.0, 1.0, 0.0], "an eye anywhere, as in world space");
    let at_the_eye = Eye::Local(off_axis.position);
    assert_eq!(view_vector(&off_axis, &at_the_eye), off_axis.normal, "an eye on the surface looks along n");
}

#[test]
fn eye_and_world_space_agree() {
    // A rigid change of space: a quarter turn about Y and a shift.
    let eye_from_world = |[x, y, z]: [f64; 3]| [z + 1.0, y - 2.0, -x + 0.5];
    let turned = |[x, y, z]: [f64; 3]| [z, y, -x];
    let surface = ShadedPoint { position: [0.5, 0.25, -3.0], normal: [0.0, FRAC_1_SQRT_2, FRAC_1_SQRT_2] };
    let (position, direction, eye) = ([1.0, 2.0, 1.0], [-0.5, -1.75, -4.0], [0.3, 1.0, 2.0]);
    let spot = SpotLight { light: light(), cone: Cone { cutoff: 0.7, inner: Some(0.1), exponent: 3.0 } };
    let coefficients = Coefficients::from(&distinct_material(12.0));
    let world = light_contribution(
        &surface,
        &coefficients,
        &spot.at(position, direction).expect("a direction"),
        &Eye::Local(eye),
        Reflectance::BlinnPhong,
    );
    let in_eye_space = light_contribution(
        &ShadedPoint { position: eye_from_world(surface.position), normal: turned(surface.normal) },
        &coefficients,
        &spot.at(eye_from_world(position), turned(direction)).expect("a direction"),
        &Eye::Local(eye_from_world(eye)),
        Reflectance::BlinnPhong,
    );
    assert!(world[0] > 0.1, "the point is lit: {world:?}");
    close3(in_eye_space, world, 1e-13, "the space makes no difference");
}

#[test]
fn a_light_at_the_lit_point_is_finite() {
    let material = Coefficients::from(&Material::plastic(LinearRgba::WHITE));
    for (attenuation, weight) in [(Attenuation::NONE, 1.0), (Attenuation::INVERSE_SQUARE, 1e6)] {
        let here = PointLight { attenuation, ..PointLight::white() }.at(SURFACE.position);
        let Incidence { l, weight: got, .. } = arriving(&here);
        assert_eq!(l, SURFACE.normal, "l falls back to n");
        close(got, weight, weight * 1e-12, "1/a, or the cap");
        let color = light_contribution(&SURFACE, &material, &here, &VIEW, Reflectance::BlinnPhong);
        close3(color, [1.5 * weight; 3], weight * 1e-12, "kd + ks, both at full strength");
    }
}

/// A floor at a distance of 5 from the eye and lights that stand in it, 2 away, or shine along it.
#[test]
fn a_light_in_the_plane_of_the_surface_is_behind_it() {
    let material = Coefficients::from(&Material::plastic(LinearRgba::WHITE));
    let floor = ShadedPoint { position: [0.0, -3.0, -4.0], normal: [0.0, 1.0, 0.0] };
    let eye = Eye::Local([0.0; 3]);
    let grazing = f64::from(GRAZING);
    let lit = |light: &Light<f64>| {
        [Reflectance::Phong, Reflectance::BlinnPhong].map(|reflectance| {
            let LightTerms { diffuse, specular, .. } = light_terms(&floor, &material, light, &eye, reflectance);
            assert_eq!(diffuse[0] > 0.0, specular[0] > 0.0, "{reflectance:?}: both or none");
            diffuse[0] > 0.0
        })
    };
    for (n_dot_l, is_lit) in [(0.0, false), (0.99, false), (1.01, true), (1e3, true)] {
        let rise = n_dot_l * grazing * (1.0 + 5.0 / 2.0);
        let point = PointLight::white().at([2.0 * (1.0 - rise * rise).sqrt(), 2.0f64.mul_add(rise, -3.0), -4.0]);
        assert_eq!(lit(&point), [is_lit; 2], "a point light, {n_dot_l} times what counts");
        let rise = n_dot_l * grazing;
        let sun = DirectionalLight::white().along([-(1.0 - rise * rise).sqrt(), -rise, 0.0]).expect("a direction");
        assert_eq!(lit(&sun), [is_lit; 2], "a sun, {n_dot_l} times what counts");
    }
    let attenuated = PointLight { attenuate_ambient: true, ambient: LinearRgba::WHITE, ..PointLight::white() };
    let terms = light_terms(&floor, &material, &attenuated.at([2.0, -3.0, -4.0]), &eye, Reflectance::Phong);
    assert!(terms.ambient[0] > 0.0, "ambient light comes from all around");
}

#[test]
fn a_hemisphere_is_a_mixture_by_the_normal() {
    let light = HemisphereLight::new(LinearRgba::rgb(0.8, 0.4, 0.2), LinearRgba::rgb(0.1, 0.2, 0.6));
    let material = Coefficients::from(&Material { diffuse: LinearRgba::rgb(0.5, 0.5, 0.5), ..Material::default() });
    for (normal, sky) in
        [([0.0, 1.0, 0.0], 1.0), ([0.6, 0.8, 0.0], 0.9), ([1.0, 0.0, 0.0], 0.5), ([0.0, -1.0, 0.0], 0.0)]
    {
        let surface = ShadedPoint { normal, ..SURFACE };
        let light = light.toward([0.0, 3.0, 0.0]).expect("a direction");
        assert_eq!(incidence(&surface, &light), None, "it comes from all around");
        let terms = light_terms(&surface, &material, &light, &VIEW, Reflectance::Phong);
        let expected = [(0.8, 0.1), (0.4, 0.2), (0.2, 0.6)].map(|(a, b)| 0.5 * (a * sky + b * (1.0 - sky)));
        close3(terms.diffuse, expected, 1e-7, "the mixture");
        assert_eq!((terms.ambient, terms.specular), ([0.0; 3], [0.0; 3]));
    }
}

#[test]
fn components_keep_their_values_on_the_way_in() {
    let spot = SpotLight {
        light: PointLight { range: Some(7.0), attenuate_ambient: true, ..light() },
        cone: Cone { cutoff: 0.0, inner: Some(0.0), exponent: 6.0 },
    };
    let got: Light<f32> = spot.at([1.0, 2.0, 3.0], [0.0, -2.0, 0.0]).expect("a direction");
    let Light::Spot(Spot { point, cone }) = got else { panic!("{got:?} is no spot") };
    assert_eq!(point.position, [1.0, 2.0, 3.0]);
    assert_eq!(
        (point.colors.la, point.colors.ld, point.colors.ls),
        ([0.5, 0.25, 0.125], [1.0, 2.0, 3.0], [4.0, 0.5, 8.0])
    );
    assert_eq!((point.attenuation, point.range, point.attenuate_ambient), ([1.0, 0.2, 0.08], Some(7.0), true));
    assert_eq!((cone.direction, cone.cos_cutoff, cone.cos_inner), ([0.0, -1.0, 0.0], 1.0, Some(1.0)));
    assert_eq!(cone.exponent, 6.0);
    let sun: Light<f32> = DirectionalLight::white().along([0.0, -4.0, 0.0]).expect("a direction");
    let Light::Directional(sun) = sun else { panic!("{sun:?} is no sun") };
    assert_eq!(sun.toward, [0.0, 1.0, 0.0], "toward the light: against its rays");
    assert_eq!(GlobalAmbient(LinearRgba::rgb(1.0, 2.0, 3.0)).ga::<f64>(), [1.0, 2.0, 3.0]);
}

#[test]
fn a_light_without_a_direction_is_refused() {
    let rows = [
        (
            [0.0, 0.0, 0.0],
            "SpotLight.direction: the direction is [0.0, 0.0, 0.0]; expected a finite vector that is not 0",
        ),
        (
            [1.0, f64::NAN, 0.0],
            "SpotLight.direction: the direction is [1.0, NaN, 0.0]; expected a finite vector that is not 0",
        ),
    ];
    for (direction, message) in rows {
        let error = SpotLight::default().at([0.0; 3], direction).expect_err("no direction");
        assert_eq!(error.to_string(), message);
        let error = DirectionalLight::white().along(direction).expect_err("no direction");
        assert_eq!(error.to_string(), message.replace("SpotLight", "DirectionalLight"));
    }
}
