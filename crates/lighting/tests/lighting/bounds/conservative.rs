//! Brute force: no sampled point of a patch exceeds its bounds, whatever the light.

use bevy_color::LinearRgba;
use proptest::prelude::*;

use halfway_lighting::bounds::{NormalCone, Patch, Receiver, Selected};
use halfway_lighting::equations::{Coefficients, Eye, Light, ShadedPoint, light_terms};
use halfway_lighting::{Attenuation, Faces, Material, PointLight, Reflectance};

use super::support::{around, cases, exceeds, samples, scene, source};

/// Points of one patch under one light.
const SAMPLES: usize = 24;

proptest! {
    #![proptest_config(cases(400))]

    /// The terms are evaluated in `f64`, from the components; the bounds in both number types.
    #[test]
    fn no_point_exceeds_its_bounds(scene in scene(), source in source(), samples in samples(SAMPLES)) {
        let source = around(&scene, source);
        let light = source.light::<f64>();
        let wide = scene.receiver::<f64>().bounds(&light);
        let narrow = scene.receiver::<f32>().bounds(&source.light());
        for u in samples {
            let surface = scene.sample(&light, u);
            let terms = scene.terms(&surface, &light);
            let excess = exceeds(&terms, &wide, &light).map(|text| format!("f64: {text}"))
                .or_else(|| exceeds(&terms, &narrow, &light).map(|text| format!("f32: {text}")));
            prop_assert!(excess.is_none(), "{} at {surface:?}", excess.unwrap_or_default());
        }
    }
}

type EdgeRow = (&'static str, [f32; 3], f32, [f32; 3], [f32; 3]);

/// Rows at the ends of the number range and at degenerate geometry: the light at the very point, opposite l and v,
/// squares that overflow or underflow, a range that ends at the point.
#[test]
fn bounds_hold_at_the_edges() {
    let up = [0.0, 0.0, 1.0];
    // Name, centre and radius of the patch, places of the light and of the eye.
    let rows: [EdgeRow; 8] = [
        ("light at the point", [1.0, 2.0, 3.0], 0.0, [1.0, 2.0, 3.0], [1.0, 2.0, 9.0]),
        ("eye at the point", [1.0, 2.0, 3.0], 0.0, [1.0, 2.0, 9.0], [1.0, 2.0, 3.0]),
        ("l = -v", [0.0; 3], 0.0, [5.0, 0.0, 1e-7], [-5.0, 0.0, 0.0]),
        ("a huge scene", [0.0; 3], 1e18, [0.0, 0.0, 3e19], [1e19, 0.0, 3e19]),
        ("beyond the number range", [-3e38, 0.0, 0.0], 1.0, [3e38, 0.0, 1e38], [0.0, 0.0, 1e38]),
        ("a tiny scene", [0.0; 3], 1e-25, [0.0, 0.0, 3e-25], [1e-25, 0.0, 3e-25]),
        ("an infinite sphere", [0.0; 3], f32::INFINITY, [0.0, 0.0, 3.0], [1.0, 0.0, 3.0]),
        ("no sphere", [0.0; 3], f32::NAN, [0.0, 0.0, 3.0], [1.0, 0.0, 3.0]),
    ];
    let material = Material { shininess: 4.0, ..Material::BRASS };
    for (name, center, radius, place, eye) in rows {
        for reflectance in [Reflectance::Phong, Reflectance::BlinnPhong] {
            for range in [None, Some(1e-24), Some(7.0), Some(3e38)] {
                let normals = Some(NormalCone { axis: up, half_angle: 0.0 });
                let patch = Patch { center, radius, normals, half_thickness: 0.0, faces: Faces::Front };
                let coefficients = Coefficients::from(&material);
                let light = PointLight { range, attenuate_ambient: true, ..PointLight::white() };
                let bounds =
                    Receiver::new(&patch, &coefficients, &Eye::Local(eye), reflectance).bounds(&light.at(place));
                let light: Light<f64> = light.at(place.map(f64::from));
                let surface = ShadedPoint { position: center.map(f64::from), normal: up.map(f64::from) };
                let view = Eye::Local(eye.map(f64::from));
                let terms = light_terms(&surface, &Coefficients::from(&material), &light, &view, reflectance);
                let excess = exceeds(&terms, &bounds, &light);
                assert!(excess.is_none(), "{name}, {reflectance:?}, range {range:?}: {}", excess.unwrap_or_default());
            }
        }
    }
}

/// Where attenuation and highlight leave the number range of `f32`, bright colours bring the terms back into it.
#[test]
fn bounds_hold_where_factors_vanish() {
    let bright = LinearRgba::rgb(1e12, 1e12, 1e12);
    let material = Material { diffuse: bright, specular: bright, shininess: 1e4, ..Material::BRASS };
    let light = PointLight { attenuation: Attenuation::INVERSE_SQUARE, ..PointLight::new(bright) };
    let normal = [0.0, 0.6, 0.8];
    for place in [[0.0f32, 0.0, 1e25], [0.0, 0.0, 1.0]] {
        let patch = Patch {
            center: [0.0f32; 3],
            radius: 0.0,
            normals: Some(NormalCone { axis: normal.map(|x| x as f32), half_angle: 0.0 }),
            half_thickness: 0.0,
            faces: Faces::Front,
        };
        let (view, reflectance) = (Eye::Infinite([0.0, 0.0, 1.0]), Reflectance::BlinnPhong);
        let bounds = Receiver::new(&patch, &Coefficients::from(&material), &view, reflectance).bounds(&light.at(place));
        let light: Light<f64> = light.at(place.map(f64::from));
        let surface = ShadedPoint { position: [0.0; 3], normal };
        let view = Eye::Infinite([0.0, 0.0, 1.0]);
        let terms = light_terms(&surface, &Coefficients::from(&material), &light, &view, reflectance);
        assert!(terms.diffuse[0] > 0.0);
        let excess = exceeds(&terms, &bounds, &light);
        assert!(excess.is_none(), "{place:?}: {}", excess.unwrap_or_default());
    }
}

/// White without highlights, lit at a point of a patch of this radius, thickness and cone around +Z: whether the term is
/// above 0, and whether its bound is and the light is kept without a tolerance.
fn is_lit_and_kept(patch: &Patch<f32>, light: &PointLight, at: [f64; 3], surface: &ShadedPoint<f64>) -> [bool; 3] {
    let material = Material::matte(LinearRgba::WHITE);
    let view = Eye::Infinite([0.0, 0.0, 1.0]);
    let receiver = Receiver::new(patch, &Coefficients::from(&material), &view, Reflectance::BlinnPhong);
    let narrow = light.at(at.map(|x| x as f32));
    let mut selected = Selected::default();
    receiver.select([(7, &narrow)], [0.0; 3], &mut selected);
    let (coefficients, view) = (Coefficients::from(&material), Eye::Infinite([0.0, 0.0, 1.0]));
    let terms = light_terms(surface, &coefficients, &light.at(at), &view, Reflectance::BlinnPhong);
    [terms.diffuse[0] > 0.0, receiver.bounds(&narrow).diffuse[0] > 0.0, selected.diffuse == [7]]
}

/// Lights that one point with one normal faces by a thousandth of the radius, and none by less.
#[test]
fn barely_lit_patches_are_lit() {
    for (radius, half_angle) in [(0.01f64, 0.0f64), (1.0, 0.0), (1.0, 0.3), (100.0, 0.3), (1.0, 0.6)] {
        let (sin, cos) = half_angle.sin_cos();
        let normal = [sin, 0.0, cos];
        let center = [3.0, -2.0, 1.0];
        let (barely, patch) = (1e-3 * radius, |half_thickness: f64| Patch {
            center: center.map(|x| x as f32),
            radius: radius as f32,
            normals: Some(NormalCone { axis: [0.0f32, 0.0, 1.0], half_angle: half_angle as f32 }),
            half_thickness: half_thickness as f32,
            faces: Faces::Front,
        });
        // A ball, at its lowest point along the normal; and a disk, at its edge away from the light.
        let height = (barely - 3.0 * radius * sin) / cos;
        let along = (barely - radius) / 0.8;
        let rows = [
            (
                patch(radius),
                normal.map(|x| -radius * x),
                [along * (0.8 * sin - 0.6 * cos), 0.0, along * (0.8 * cos + 0.6 * sin)],
            ),
            (patch(0.0), [-radius, 0.0, 0.0], [2.0 * radius, 0.0, height]),
        ];
        for (patch, point, light) in rows {
            let position = [0, 1, 2].map(|k| center[k] + point[k] * (1.0 - 1e-9));
            let at = |lower: f64| [0, 1, 2].map(|k| center[k] + light[k] - lower * normal[k]);
            let surface = ShadedPoint { position, normal };
            assert_eq!(is_lit_and_kept(&patch, &PointLight::white(), at(0.0), &surface), [true; 3], "{patch:?}");
            let below = at(2.0 * barely);
            assert_eq!(is_lit_and_kept(&patch, &PointLight::white(), below, &surface), [false; 3], "{patch:?}");
        }
    }
}

/// A light so near that it counts as being at the point, which it lights from behind, with hardly a range.
#[test]
fn coincident_lights_are_kept() {
    let center = [1000.0, 0.0, 0.0];
    let normals = Some(NormalCone { axis: [0.0f32, 0.0, 1.0], half_angle: 0.0 });
    let patch =
        Patch { center: [1000.0f32, 0.0, 0.0], radius: 1e-4, normals, half_thickness: 0.0, faces: Faces::Front };
    let surface = ShadedPoint { position: center, normal: [0.0, 0.0, 1.0] };
    for range in [None, Some(1e-4)] {
        let light = PointLight { range, ..PointLight::white() };
        assert_eq!(is_lit_and_kept(&patch, &light, [1000.0, 0.0, -1.5e-3], &surface), [true; 3], "{range:?}");
        assert_eq!(is_lit_and_kept(&patch, &light, [1000.0, 0.0, -3e-3], &surface), [false; 3], "{range:?}");
    }
}
