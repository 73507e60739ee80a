//! Defaults, presets and validation.

use core::f32::consts::{FRAC_PI_2, FRAC_PI_6, PI};

use bevy_color::LinearRgba;
use halfway_lighting::{
    Attenuation, BackMaterial, CHANNEL_MAX, Cone, DirectionalLight, Faces, GlobalAmbient, InvalidValue, Material,
    PointLight, Reflectance, Shading, SpotLight, Viewer,
};

use crate::support::gray;

#[test]
fn builders_change_their_field_alone() {
    let (red, grey) = (LinearRgba::rgb(1.0, 0.0, 0.0), gray(0.25));
    let point = PointLight::new(bevy_color::Color::LinearRgba(red)).with_range(4.0).with_ambient(grey);
    let expected = PointLight { ambient: grey, diffuse: red, specular: red, range: Some(4.0), ..PointLight::white() };
    assert_eq!(point, expected);
    assert_eq!(point.with_attenuation(Attenuation::NONE), PointLight { attenuation: Attenuation::NONE, ..expected });
    let spot = SpotLight::new(red).with_range(4.0).with_ambient(grey).with_cutoff_degrees(180.0);
    assert_eq!(spot, SpotLight { light: expected, cone: Cone::NONE });
    let spot = spot.with_cutoff(0.5).with_inner_degrees(0.0).with_exponent(2.0);
    assert_eq!(spot.cone, Cone { cutoff: 0.5, inner: Some(0.0), exponent: 2.0 });
    let sun = DirectionalLight::new(red).with_ambient(grey);
    assert_eq!(sun, DirectionalLight { ambient: grey, diffuse: red, specular: red });
}

#[test]
fn defaults_are_the_scene_formats() {
    let light = PointLight::default();
    assert_eq!(light, PointLight::white());
    assert_eq!([light.ambient, light.diffuse, light.specular], [gray(0.0), gray(1.0), gray(1.0)]);
    assert_eq!(light.attenuation, Attenuation { constant: 1.0, linear: 0.09, quadratic: 0.032 });
    assert_eq!((light.range, light.attenuate_ambient), (None, false));
    assert_eq!(Cone::default(), Cone { cutoff: FRAC_PI_6, inner: None, exponent: 0.0 });
    assert_eq!(SpotLight::default(), SpotLight::white(FRAC_PI_6));
    assert_eq!(DirectionalLight::default(), DirectionalLight::white());
    assert_eq!(GlobalAmbient::default().0, gray(0.1));
    let material = Material::default();
    assert_eq!([material.ambient, material.diffuse], [gray(0.2), gray(0.8)]);
    assert_eq!([material.specular, material.emission], [gray(0.0), gray(0.0)]);
    assert_eq!((material.shininess, material.opacity), (32.0, 1.0));
    assert_eq!(Shading::default(), Shading::Phong);
    assert_eq!(Reflectance::default(), Reflectance::BlinnPhong);
    assert_eq!(Faces::default(), Faces::Front);
    assert_eq!(Viewer::default(), Viewer::Local);
}

#[test]
fn sides_shown() {
    for (faces, front, back) in [(Faces::Front, true, false), (Faces::Back, false, true), (Faces::Both, true, true)] {
        assert_eq!((faces.shows_front(), faces.shows_back()), (front, back), "{faces:?}");
    }
}

#[test]
fn everything_this_crate_builds_is_valid() {
    let color = LinearRgba::rgb(0.9, 0.1, 0.2);
    PointLight::white().validate().unwrap();
    SpotLight::white(0.0).validate().unwrap();
    SpotLight { cone: Cone::NONE, ..Default::default() }.validate().unwrap();
    DirectionalLight::new(color).validate().unwrap();
    GlobalAmbient::default().validate().unwrap();
    Attenuation::NONE.validate().unwrap();
    Attenuation::INVERSE_SQUARE.validate().unwrap();
    BackMaterial(Material::matte(color)).validate().unwrap();
    for material in [Material::matte(color), Material::plastic(color), Material::emissive(color)] {
        material.validate().unwrap();
    }
    for (name, preset) in Material::PRESETS {
        preset.validate().unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

#[test]
fn presets_are_the_published_table() {
    // Shininess from the table's fraction of 128, by hand.
    let rows = [
        ("brass", [0.329_412, 0.223_529, 0.027_451], [0.780_392, 0.568_627, 0.113_725], 27.897_436),
        ("emerald", [0.0215, 0.1745, 0.0215], [0.07568, 0.61424, 0.07568], 76.8),
        ("pearl", [0.25, 0.20725, 0.20725], [1.0, 0.829, 0.829], 11.264),
        ("red plastic", [0.0, 0.0, 0.0], [0.5, 0.0, 0.0], 32.0),
        ("Black-Rubber", [0.02, 0.02, 0.02], [0.01, 0.01, 0.01], 10.0),
    ];
    for (name, ambient, diffuse, shininess) in rows {
        let preset = Material::named(name).unwrap_or_else(|| panic!("{name} is missing"));
        let rgb = |color: LinearRgba| [color.red, color.green, color.blue];
        assert_eq!((rgb(preset.ambient), rgb(preset.diffuse)), (ambient, diffuse), "{name}");
        assert!((preset.shininess - shininess).abs() < 1e-5, "{name}: {}", preset.shininess);
    }
    assert_eq!(Material::PRESETS.len(), 24);
    for (index, (name, preset)) in Material::PRESETS.iter().enumerate() {
        assert_eq!(Material::named(name), Some(*preset), "{name} does not find itself");
        let twins = Material::PRESETS[..index].iter().filter(|(_, other)| other == preset).count();
        assert_eq!(twins, 0, "{name} repeats another row");
    }
    assert_eq!(Material::named("unobtainium"), None);
    assert_eq!(Material::named(""), None);
}

#[test]
fn angles_converted_from_degrees_are_accepted() {
    for (degrees, none) in [(0f32, false), (30.0, false), (90.0, false), (180.0, true)] {
        let cone = Cone::new(degrees.to_radians());
        cone.validate().unwrap_or_else(|error| panic!("{degrees}: {error}"));
        assert_eq!(cone.is_none(), none, "{degrees}");
    }
}

/// One row a refused value: the name of the row, the verdict, the whole message.
type Refused = (&'static str, Result<(), InvalidValue>, &'static str);

fn refuse(rows: impl IntoIterator<Item = Refused>) {
    for (name, verdict, message) in rows {
        let error = verdict.err().unwrap_or_else(|| panic!("{name} was accepted"));
        assert_eq!(error.to_string(), message, "{name}");
    }
}

#[test]
fn bad_lights_are_refused_by_name() {
    let point = PointLight::white();
    let fall = |constant, linear, quadratic| {
        PointLight { attenuation: Attenuation { constant, linear, quadratic }, ..point }.validate()
    };
    refuse([
        (
            "no attenuation",
            fall(0.0, 0.0, 0.0),
            "PointLight.attenuation: constant, linear and quadratic are all 0; at least one must be positive",
        ),
        (
            "no attenuation, alone",
            Attenuation::new(0.0, 0.0, 0.0).validate(),
            "Attenuation.constant: constant, linear and quadratic are all 0; at least one must be positive",
        ),
        (
            "negative linear",
            fall(1.0, -0.5, 0.0),
            "PointLight.attenuation.linear: the value is -0.5; expected a finite number, 0 or more",
        ),
        (
            "NaN constant",
            fall(f32::NAN, 0.0, 1.0),
            "PointLight.attenuation.constant: the value is NaN; expected a finite number, 0 or more",
        ),
        (
            "infinite quadratic",
            fall(1.0, 0.0, f32::INFINITY),
            "PointLight.attenuation.quadratic: the value is inf; expected a finite number, 0 or more",
        ),
        (
            "zero range",
            PointLight { range: Some(0.0), ..point }.validate(),
            "PointLight.range: the value is 0.0; expected a finite number above 0",
        ),
        (
            "NaN range",
            PointLight { range: Some(f32::NAN), ..point }.validate(),
            "PointLight.range: the value is NaN; expected a finite number above 0",
        ),
        (
            "negative colour",
            PointLight { diffuse: LinearRgba::rgb(1.0, -0.25, 1.0), ..point }.validate(),
            "PointLight.diffuse.green: the value is -0.25; expected a number from 0 to 1e12",
        ),
        (
            "non-finite colour",
            DirectionalLight { specular: LinearRgba::rgb(1.0, 1.0, f32::INFINITY), ..Default::default() }.validate(),
            "DirectionalLight.specular.blue: the value is inf; expected a number from 0 to 1e12",
        ),
        (
            "NaN global ambient",
            GlobalAmbient(LinearRgba::rgb(f32::NAN, 0.0, 0.0)).validate(),
            "GlobalAmbient.0.red: the value is NaN; expected a number from 0 to 1e12",
        ),
        (
            "a spot's inner light",
            SpotLight { light: PointLight { range: Some(-1.0), ..point }, cone: Cone::default() }.validate(),
            "SpotLight.light.range: the value is -1.0; expected a finite number above 0",
        ),
    ]);
}

#[test]
fn bad_cones_are_refused_by_name() {
    let expected_cutoff = |value: &str| {
        format!("Cone.cutoff: the value is {value}; expected radians from 0 to π/2 (90°), or π (180°) for no cone")
    };
    for cutoff in [-0.1, FRAC_PI_2 + 0.01, PI + 0.01, f32::NAN, f32::INFINITY] {
        let error = Cone::new(cutoff).validate().expect_err("a cutoff outside its range");
        assert_eq!(error.to_string(), expected_cutoff(&format!("{cutoff:?}")));
    }
    let cone = |inner, exponent| Cone { cutoff: 0.5, inner, exponent }.validate();
    refuse([
        (
            "inner outside cutoff",
            cone(Some(0.75), 0.0),
            "Cone.inner: the inner cone of 0.75 rad is wider than the cutoff of 0.5 rad; expected 0 to the cutoff",
        ),
        ("negative inner", cone(Some(-0.5), 0.0), "Cone.inner: the value is -0.5; expected a finite number, 0 or more"),
        ("NaN inner", cone(Some(f32::NAN), 0.0), "Cone.inner: the value is NaN; expected a finite number, 0 or more"),
        (
            "negative exponent",
            cone(None, -1.0),
            "Cone.exponent: the value is -1.0; expected a finite number, 0 or more",
        ),
        (
            "infinite exponent",
            SpotLight { light: PointLight::white(), cone: Cone { exponent: f32::INFINITY, ..Cone::default() } }
                .validate(),
            "SpotLight.cone.exponent: the value is inf; expected a finite number, 0 or more",
        ),
    ]);
    Cone { cutoff: 0.5, inner: Some(0.5), exponent: 0.0 }.validate().expect("an inner cone as wide as the cutoff");
}

#[test]
fn bad_materials_are_refused_by_name() {
    let m = Material::default();
    refuse([
        (
            "negative ambient",
            Material { ambient: LinearRgba::rgb(-1.0, 0.0, 0.0), ..m }.validate(),
            "Material.ambient.red: the value is -1.0; expected a number from 0 to 1e12",
        ),
        (
            "NaN diffuse",
            Material { diffuse: LinearRgba::rgb(0.0, f32::NAN, 0.0), ..m }.validate(),
            "Material.diffuse.green: the value is NaN; expected a number from 0 to 1e12",
        ),
        (
            "specular beyond the limit",
            Material { specular: LinearRgba::rgb(0.0, 0.0, CHANNEL_MAX * 2.0), ..m }.validate(),
            "Material.specular.blue: the value is 2000000000000.0; expected a number from 0 to 1e12",
        ),
        (
            "infinite emission",
            Material { emission: LinearRgba::rgb(f32::INFINITY, 0.0, 0.0), ..m }.validate(),
            "Material.emission.red: the value is inf; expected a number from 0 to 1e12",
        ),
        (
            "negative shininess",
            Material { shininess: -1.0, ..m }.validate(),
            "Material.shininess: the value is -1.0; expected a finite number, 0 or more",
        ),
        (
            "NaN shininess",
            Material { shininess: f32::NAN, ..m }.validate(),
            "Material.shininess: the value is NaN; expected a finite number, 0 or more",
        ),
        (
            "opacity above 1",
            Material { opacity: 1.5, ..m }.validate(),
            "Material.opacity: the value is 1.5; expected a number from 0 to 1",
        ),
        (
            "negative opacity",
            Material { opacity: -0.5, ..m }.validate(),
            "Material.opacity: the value is -0.5; expected a number from 0 to 1",
        ),
        (
            "NaN opacity",
            Material { opacity: f32::NAN, ..m }.validate(),
            "Material.opacity: the value is NaN; expected a number from 0 to 1",
        ),
        (
            "a back material",
            BackMaterial(Material { shininess: f32::INFINITY, ..m }).validate(),
            "BackMaterial.shininess: the value is inf; expected a finite number, 0 or more",
        ),
    ]);
    let alpha_is_ignored = Material { diffuse: LinearRgba::new(0.5, 0.5, 0.5, f32::NAN), ..m };
    alpha_is_ignored.validate().expect("alpha is ignored");
}
