//! Materials and lights of file formats.

use core::f32::consts::{FRAC_1_PI, FRAC_PI_4};

use bevy_color::LinearRgba;
use bevy_math::Mat4;
use halfway_lighting::{Attenuation, Cone, DirectionalLight, Material, PointLight, SpotLight};
use halfway_mesh::{
    AlphaMode, GltfMaps, MetallicRoughness, MtlMaterial, SourceLight, SourceLightKind, SpecularGlossiness,
};
use halfway_scene::LightComponent;
use halfway_scene::import::{
    RADIANCE_SCALE, SHININESS_MAX, Warning, from_metallic_roughness, from_mtl, from_punctual, shininess_from_roughness,
};

const KA: [f32; 3] = [0.1, 0.2, 0.3];
const KD: [f32; 3] = [0.4, 0.5, 0.6];
const KS: [f32; 3] = [0.7, 0.8, 0.9];
const KE: [f32; 3] = [0.01, 0.02, 0.03];

fn color([red, green, blue]: [f32; 3]) -> LinearRgba {
    LinearRgba::rgb(red, green, blue)
}

/// A glTF material as it is where the file gives no factor.
fn bare() -> MetallicRoughness {
    MetallicRoughness {
        name: String::new(),
        base_color: [1.0; 4],
        metallic: 1.0,
        roughness: 1.0,
        emissive: [0.0; 3],
        double_sided: false,
        unlit: false,
        alpha: AlphaMode::Opaque,
        specular_glossiness: None,
        maps: GltfMaps::default(),
    }
}

/// A white light of intensity 1 without an end.
fn white(kind: SourceLightKind) -> SourceLight {
    SourceLight {
        name: String::new(),
        kind,
        color: [1.0; 3],
        intensity: 1.0,
        range: None,
        world_from_light: Mat4::IDENTITY,
    }
}

fn full() -> MtlMaterial {
    MtlMaterial {
        ka: Some(KA),
        kd: Some(KD),
        ks: Some(KS),
        ke: Some(KE),
        ns: Some(96.0),
        d: Some(0.5),
        tr: None,
        illum: Some(2),
        ..MtlMaterial::default()
    }
}

fn full_material() -> Material {
    let clear = Material { opacity: 0.5, ..Material::DEFAULT };
    Material {
        ambient: color(KA),
        diffuse: color(KD),
        specular: color(KS),
        emission: color(KE),
        shininess: 96.0,
        ..clear
    }
}

#[test]
fn mtl_values_are_taken_unchanged() {
    let none = MtlMaterial::default();
    let rows = [
        ("everything", full(), full_material(), vec![]),
        ("nothing", none, Material::default(), vec![]),
        ("illum missing", MtlMaterial { illum: None, ..full() }, full_material(), vec![]),
        (
            "illum 0 is a constant colour",
            MtlMaterial { illum: Some(0), ..full() },
            Material {
                shininess: 96.0,
                opacity: 0.5,
                ..Material::emissive(LinearRgba::rgb(0.4 + 0.01, 0.5 + 0.02, 0.6 + 0.03))
            },
            vec![],
        ),
        (
            "illum 1 has no highlight",
            MtlMaterial { illum: Some(1), ..full() },
            Material { specular: LinearRgba::rgb(0.0, 0.0, 0.0), ..full_material() },
            vec![],
        ),
        (
            "illum 3",
            MtlMaterial { illum: Some(3), ..full() },
            full_material(),
            vec![Warning::IllumNeedsRays { illum: 3 }],
        ),
        (
            "illum 10",
            MtlMaterial { illum: Some(10), ..full() },
            full_material(),
            vec![Warning::IllumNeedsRays { illum: 10 }],
        ),
        (
            "illum 11",
            MtlMaterial { illum: Some(11), ..full() },
            full_material(),
            vec![Warning::IllumUnknown { illum: 11 }],
        ),
        (
            "Kd above 1 is kept",
            MtlMaterial { kd: Some([2.0, 3.0, 4.0]), ..full() },
            Material { diffuse: LinearRgba::rgb(2.0, 3.0, 4.0), ..full_material() },
            vec![],
        ),
        (
            "Ns of 0 is kept",
            MtlMaterial { ns: Some(0.0), ..full() },
            Material { shininess: 0.0, ..full_material() },
            vec![],
        ),
        (
            "Ks without Ns",
            MtlMaterial { ns: None, ..full() },
            Material { shininess: 32.0, ..full_material() },
            vec![Warning::NoShininess { shininess: 32.0 }],
        ),
        (
            "Ks without Ns, but illum 1",
            MtlMaterial { ns: None, illum: Some(1), ..full() },
            Material { shininess: 32.0, specular: LinearRgba::rgb(0.0, 0.0, 0.0), ..full_material() },
            vec![],
        ),
    ];
    for (name, numbers, material, warnings) in rows {
        assert_eq!(from_mtl(&numbers), Ok((material, warnings)), "{name}");
    }
}

/// Of the extension for physically based materials, which is read as glTF is.
#[test]
fn mtl_roughness_and_metallic_become_those_of_gltf() {
    for (pr, pm, ns, expected) in [
        (Some(0.3), Some(1.0), None, (1.0, 0.3)),
        (Some(0.3), None, Some(5.0), (0.0, 0.3)),
        // 2/r⁴ − 2 = 30.
        (None, Some(0.5), Some(30.0), (0.5, 0.5)),
        (None, Some(0.5), None, (0.5, 1.0)),
    ] {
        let mtl = MtlMaterial { kd: Some(KD), pr, pm, ns, ks: Some([9.0; 3]), d: Some(0.25), ..MtlMaterial::default() };
        let (found, warnings) = from_mtl(&mtl).expect("valid numbers");
        assert_eq!(warnings, [Warning::PhysicallyBased]);
        let (metallic, roughness) = expected;
        let [r, g, b] = KD;
        let gltf = MetallicRoughness { base_color: [r, g, b, 1.0], metallic, roughness, ..bare() };
        let expected = Material { opacity: 0.25, ..from_metallic_roughness(&gltf).expect("valid numbers") };
        assert!((found.shininess / expected.shininess - 1.0).abs() < 1e-5, "{found:?}");
        assert_eq!(Material { shininess: expected.shininess, ..found }, expected);
    }
}

#[test]
fn mtl_opacity() {
    let disagree = |d, tr| Warning::OpacityDisagrees { d, tr };
    let rows = [
        ("neither", None, None, 1.0, vec![]),
        ("d", Some(0.25), None, 0.25, vec![]),
        ("Tr", None, Some(0.25), 0.75, vec![]),
        ("both, agreeing", Some(0.75), Some(0.25), 0.75, vec![]),
        ("both, agreeing as printed", Some(0.13), Some(0.88), 0.13, vec![]),
        ("both, a little apart", Some(0.5), Some(0.48), 0.5, vec![disagree(0.5, 0.48)]),
        ("both, Tr the other way round", Some(1.0), Some(1.0), 1.0, vec![disagree(1.0, 1.0)]),
        ("both, d wins", Some(0.25), Some(0.25), 0.25, vec![disagree(0.25, 0.25)]),
        ("d above 1", Some(1.5), None, 1.0, vec![Warning::OpacityClamped { key: "d", value: 1.5 }]),
        (
            "Tr above 1",
            None,
            Some(2.0),
            0.0,
            vec![
                Warning::OpacityClamped { key: "Tr", value: 2.0 },
                Warning::FullyTransparent { key: "Tr", value: 2.0 },
            ],
        ),
        ("d of 0", Some(0.0), None, 0.0, vec![Warning::FullyTransparent { key: "d", value: 0.0 }]),
        ("Tr of 1", None, Some(1.0), 0.0, vec![Warning::FullyTransparent { key: "Tr", value: 1.0 }]),
    ];
    for (name, d, tr, opacity, warnings) in rows {
        let got = from_mtl(&MtlMaterial { d, tr, ..full() });
        assert_eq!(got, Ok((Material { opacity, ..full_material() }, warnings)), "{name}");
    }
}

#[test]
fn mtl_nonsense_is_refused_by_key() {
    let rows = [
        (
            MtlMaterial { ka: Some([0.0, -0.5, 0.0]), ..full() },
            "MTL.Ka.green: the value is -0.5; expected a number from 0 to 1e12",
        ),
        (
            MtlMaterial { kd: Some([f32::NAN, 0.0, 0.0]), ..full() },
            "MTL.Kd.red: the value is NaN; expected a number from 0 to 1e12",
        ),
        (
            MtlMaterial { ks: Some([0.0, 0.0, f32::INFINITY]), ..full() },
            "MTL.Ks.blue: the value is inf; expected a number from 0 to 1e12",
        ),
        (
            MtlMaterial { ke: Some([-1.0; 3]), ..full() },
            "MTL.Ke.red: the value is -1.0; expected a number from 0 to 1e12",
        ),
        (MtlMaterial { ns: Some(-1.0), ..full() }, "MTL.Ns: the value is -1.0; expected a finite number, 0 or more"),
        (MtlMaterial { d: Some(f32::NAN), ..full() }, "MTL.d: the value is NaN; expected a finite number, 0 or more"),
        (MtlMaterial { tr: Some(-0.5), ..full() }, "MTL.Tr: the value is -0.5; expected a finite number, 0 or more"),
    ];
    for (numbers, message) in rows {
        assert_eq!(from_mtl(&numbers).expect_err(message).to_string(), message);
    }
}

#[test]
fn warnings_describe_every_approximation() {
    let rows = [
        (
            Warning::IllumNeedsRays { illum: 5 },
            "illum 5 asks for ray-traced reflection or refraction; taken as illum 2",
        ),
        (Warning::IllumUnknown { illum: 42 }, "illum 42 is not defined (expected 0 to 10); taken as illum 2"),
        (Warning::OpacityDisagrees { d: 1.0, tr: 1.0 }, "d 1.0 and Tr 1.0 disagree (expected d = 1 - Tr); d is used"),
        (Warning::OpacityClamped { key: "d", value: 2.0 }, "d 2.0 is above 1; taken as 1"),
        (Warning::FullyTransparent { key: "d", value: 0.0 }, "d 0.0 makes the material fully transparent"),
        (Warning::NoShininess { shininess: 32.0 }, "Ks is given without Ns; shininess 32.0 is used"),
    ];
    for (warning, message) in rows {
        assert_eq!(warning.to_string(), message);
    }
}

#[test]
fn roughness_becomes_shininess() {
    // By hand: 2/ρ⁴ − 2.
    let rows = [(1.0, 1.0), (0.9, 1.048_316), (0.5, 30.0), (0.25, 510.0), (0.1, SHININESS_MAX), (0.0, SHININESS_MAX)];
    for (roughness, expected) in rows {
        let got = shininess_from_roughness(roughness);
        assert!((got / expected - 1.0).abs() < 1e-5, "{roughness}: {got}");
    }
}

#[test]
fn metallic_roughness_is_approximated_as_documented() {
    let base = MetallicRoughness {
        base_color: [0.8, 0.4, 0.2, 0.5],
        metallic: 0.0,
        roughness: 0.5,
        emissive: [0.0, 1.0, 2.0],
        ..bare()
    };
    // n = 30, so that the peak is (30 + 8)/8 = 4.75: 0.04·4.75 = 0.19 for the dielectric, and c/max c for the metal.
    let rows = [
        ("dielectric", 0.0, [0.8, 0.4, 0.2], [0.19; 3]),
        ("metal", 1.0, [0.0; 3], [1.0, 0.5, 0.25]),
        ("between", 0.5, [0.4, 0.2, 0.1], [1.0, 0.523_809_5, 0.285_714_3]),
    ];
    for (name, metallic, diffuse, specular) in rows {
        let got = from_metallic_roughness(&MetallicRoughness { metallic, ..base.clone() }).expect(name);
        let near = |a: LinearRgba, b: [f32; 3]| {
            let worst = (a.red - b[0]).abs().max((a.green - b[1]).abs()).max((a.blue - b[2]).abs());
            assert!(worst < 1e-6, "{name}: {a:?} against {b:?}");
        };
        near(got.ambient, [0.8, 0.4, 0.2]);
        near(got.diffuse, diffuse);
        near(got.specular, specular);
        near(got.emission, [0.0, 1.0, 2.0]);
        assert_eq!((got.shininess, got.opacity), (30.0, 1.0), "{name}");
    }
    let alphas = [
        (AlphaMode::Opaque, 1.0),
        (AlphaMode::Blend, 0.5),
        (AlphaMode::Mask { cutoff: 0.5 }, 0.5),
        (AlphaMode::Mask { cutoff: 0.6 }, 0.5),
    ];
    for (alpha, opacity) in alphas {
        let got = from_metallic_roughness(&MetallicRoughness { alpha, ..base.clone() }).expect("valid");
        assert_eq!(got.opacity, opacity, "{alpha:?}");
    }
}

#[test]
fn every_corner_of_metallic_roughness_is_valid() {
    for metallic in [0.0, 0.5, 1.0] {
        for roughness in [0.0, 1e-30, 0.5, 1.0] {
            for channel in [0.0, 1e-30, 0.04, 1.0, 100.0] {
                let numbers =
                    MetallicRoughness { base_color: [channel, channel, 1.0, 1.0], metallic, roughness, ..bare() };
                let material = from_metallic_roughness(&numbers).unwrap_or_else(|error| panic!("{numbers:?}: {error}"));
                let black = MetallicRoughness { base_color: [0.0, 0.0, 0.0, 1.0], ..numbers.clone() };
                from_metallic_roughness(&black).unwrap_or_else(|error| panic!("{black:?}: {error}"));
                assert!(channel > 1.0 || material.specular.red <= 1.0, "{numbers:?}: {material:?}");
            }
        }
    }
}

#[test]
fn metallic_roughness_nonsense_is_refused_by_field() {
    let base = bare();
    let rows = [
        (
            MetallicRoughness { base_color: [1.0, f32::NAN, 1.0, 1.0], ..base.clone() },
            "MetallicRoughness.base_color.green: the value is NaN; expected a number from 0 to 1e12",
        ),
        (
            MetallicRoughness { base_color: [1.0, 1.0, 1.0, 1.5], ..base.clone() },
            "MetallicRoughness.base_color.alpha: the value is 1.5; expected a number from 0 to 1",
        ),
        (
            MetallicRoughness { metallic: 2.0, ..base.clone() },
            "MetallicRoughness.metallic: the value is 2.0; expected a number from 0 to 1",
        ),
        (
            MetallicRoughness { roughness: -0.5, ..base.clone() },
            "MetallicRoughness.roughness: the value is -0.5; expected a number from 0 to 1",
        ),
        (
            MetallicRoughness { emissive: [0.0, 0.0, f32::INFINITY], ..base.clone() },
            "MetallicRoughness.emissive.blue: the value is inf; expected a number from 0 to 1e12",
        ),
        (
            MetallicRoughness { alpha: AlphaMode::Mask { cutoff: f32::NAN }, ..base.clone() },
            "MetallicRoughness.alpha.cutoff: the value is NaN; expected a finite number, 0 or more",
        ),
    ];
    for (numbers, message) in rows {
        assert_eq!(from_metallic_roughness(&numbers).expect_err(message).to_string(), message);
    }
}

#[test]
fn punctual_lights() {
    let numbers = SourceLight { color: [1.0, 0.5, 0.25], intensity: 8.0, ..white(SourceLightKind::Point) };
    let shine = color([4.0, 2.0, 1.0]);
    let point = PointLight { attenuation: Attenuation::INVERSE_SQUARE, ..PointLight::new(shine) };
    let ranged = PointLight { range: Some(12.0), ..point };
    let cone = Cone { cutoff: FRAC_PI_4, inner: Some(0.25), exponent: 0.0 };
    let spot = SourceLightKind::Spot { inner: 0.25, outer: FRAC_PI_4 };
    let with = |kind, range| SourceLight { kind, range, ..numbers.clone() };
    let rows = [
        ("point", with(SourceLightKind::Point, None), LightComponent::Point(point)),
        ("point with a range", with(SourceLightKind::Point, Some(12.0)), LightComponent::Point(ranged)),
        ("spot", with(spot, Some(12.0)), LightComponent::Spot(SpotLight { light: ranged, cone })),
        (
            "directional",
            with(SourceLightKind::Directional, Some(12.0)),
            LightComponent::Directional(DirectionalLight::new(shine)),
        ),
    ];
    for (name, numbers, expected) in rows {
        assert_eq!(from_punctual(&numbers, 0.5), Ok(expected), "{name}");
    }
    let LightComponent::Point(radiance) = from_punctual(&numbers, RADIANCE_SCALE).expect("valid") else {
        panic!("a point light stays one")
    };
    assert!((radiance.diffuse.red - 8.0 * FRAC_1_PI).abs() < 1e-6);
}

#[test]
fn punctual_nonsense_is_refused_by_field() {
    let point = white(SourceLightKind::Point);
    let spot = |inner, outer| white(SourceLightKind::Spot { inner, outer });
    let rows = [
        (
            SourceLight { intensity: f32::INFINITY, ..point.clone() },
            "PunctualLight.intensity: the value is inf; expected a finite number, 0 or more",
        ),
        (
            SourceLight { intensity: f32::MAX, ..point.clone() },
            "PunctualLight.color·intensity·scale.red: the value is 3.4028235e38; expected a number from 0 to 1e12",
        ),
        (
            SourceLight { color: [1.0, -1.0, 1.0], ..point.clone() },
            "PunctualLight.color.green: the value is -1.0; expected a number from 0 to 1e12",
        ),
        (
            SourceLight { range: Some(0.0), ..point.clone() },
            "PointLight.range: the value is 0.0; expected a finite number above 0",
        ),
        (
            spot(1.0, 0.5),
            "SpotLight.cone.inner: the inner cone of 1.0 rad is wider than the cutoff of 0.5 rad; expected 0 to the cutoff",
        ),
        (
            spot(0.0, 2.0),
            "SpotLight.cone.cutoff: the value is 2.0; expected radians from 0 to π/2 (90°), or π (180°) for no cone",
        ),
    ];
    for (numbers, message) in rows {
        assert_eq!(from_punctual(&numbers, 1.0).expect_err(message).to_string(), message);
    }
    from_punctual(&point, f32::NAN).expect_err("a scale that is not a number");
}

#[test]
fn specular_glossiness_keeps_its_reflectance() {
    let of = |base: [f32; 3], specular: [f32; 3], glossiness: f32| {
        let [red, green, blue] = base;
        from_metallic_roughness(&MetallicRoughness {
            base_color: [red, green, blue, 1.0],
            metallic: 0.0,
            roughness: 1.0 - glossiness,
            specular_glossiness: Some(SpecularGlossiness { specular, glossiness, map: None }),
            ..bare()
        })
    };
    // With the reflectance of a dielectric it is about the same as without the extension: c·(1 − 0.04) for c.
    let plastic = of([0.5, 0.25, 0.0], [0.04; 3], 0.5).expect("valid");
    let same = from_metallic_roughness(&MetallicRoughness {
        base_color: [0.5, 0.25, 0.0, 1.0],
        metallic: 0.0,
        roughness: 0.5,
        ..bare()
    });
    let same = same.expect("valid");
    assert_eq!((plastic.specular, plastic.shininess), (same.specular, same.shininess));
    let expected = color([0.5 * 0.96, 0.25 * 0.96, 0.0]);
    assert_eq!(plastic.diffuse, expected);
    // A metal: no diffuse color, and ambient light by its reflectance.
    let gold = of([0.0; 3], [1.0, 0.5, 0.25], 0.75).expect("valid");
    assert_eq!(
        (gold.diffuse, gold.ambient, gold.specular),
        (color([0.0; 3]), color([1.0, 0.5, 0.25]), color([1.0, 0.5, 0.25]))
    );
    for (specular, glossiness, field) in
        [([2.0, 0.0, 0.0], 0.5, "specular_glossiness.specular"), ([0.0; 3], -1.0, "roughness")]
    {
        let error = of([1.0; 3], specular, glossiness).unwrap_err().to_string();
        assert!(error.contains(field), "{error}");
    }
}
