//! The edges of the equations, each with the value that it must have, in f64 and in f32.

use core::f32::consts::FRAC_PI_2;

use bevy_color::LinearRgba;
use halfway_lighting::equations::{
    Coefficients, Eye, Light, ShadedPoint, interpolated_normal, normal_matrix, shade, transform_normal,
};
use halfway_lighting::{Attenuation, Cone, DirectionalLight, Material, PointLight, Reflectance, SpotLight};

use crate::support::{ALL_REFLECTANCES, close, close3, in_plane, to_f32, to_f64};

const BLINN: [Reflectance; 2] = [Reflectance::BlinnPhong, Reflectance::BlinnPhongMatched];
/// Powers of two, so that no product rounds.
const KD: f32 = 0.25;
const KS: f32 = 0.5;

/// The intensity of one light at a point, as `kd·diffuse + ks·specular` with every colour white.
struct Row {
    name: &'static str,
    surface: ShadedPoint<f64>,
    light: Light<f64>,
    view: Eye<f64>,
    shininess: f32,
    reflectances: &'static [Reflectance],
    diffuse: f64,
    specular: f64,
}

const UP: [f64; 3] = [0.0, 0.0, 1.0];
const DOWN: [f64; 3] = [0.0, 0.0, -1.0];
const AT_ORIGIN: ShadedPoint<f64> = ShadedPoint { position: [0.0; 3], normal: UP };
const FROM_ABOVE: Eye<f64> = Eye::Infinite(UP);

/// A light straight above, seen from straight above: every row changes what it is about.
fn row(name: &'static str) -> Row {
    Row {
        name,
        surface: AT_ORIGIN,
        light: toward(UP),
        view: FROM_ABOVE,
        shininess: 8.0,
        reflectances: &ALL_REFLECTANCES,
        diffuse: 1.0,
        specular: 1.0,
    }
}

/// A directional light in this direction.
fn toward(l: [f64; 3]) -> Light<f64> {
    DirectionalLight::white().along(l.map(|x| -x)).expect("a direction")
}

fn point(attenuation: Attenuation, at: [f64; 3]) -> Light<f64> {
    PointLight { attenuation, ..PointLight::white() }.at(at)
}

/// A spot one unit above the origin, whose axis is `tilt` off the vertical.
fn spot(cone: Cone, tilt: f64) -> Light<f64> {
    let light = PointLight { attenuation: Attenuation::NONE, ..PointLight::white() };
    SpotLight { light, cone }.at(UP, in_plane(tilt).map(|x| -x)).expect("a direction")
}

fn rows() -> Vec<Row> {
    let grazing = in_plane(80f64.to_radians());
    let hard = |cutoff| Cone { cutoff, inner: None, exponent: 0.0 };
    let equal = Cone { cutoff: 0.5, inner: Some(0.5), exponent: 0.0 };
    let dark = |name| Row { diffuse: 0.0, specular: 0.0, ..row(name) };
    // v is at 80° on the side of l, so that n·h > 0 although n·l < 0.
    let behind = in_plane(100f64.to_radians());
    vec![
        Row {
            shininess: 0.0,
            light: toward(grazing),
            view: Eye::Infinite(grazing),
            diffuse: grazing[2],
            ..row("0⁰: shininess 0 where r·v < 0")
        },
        Row {
            light: spot(hard(FRAC_PI_2), core::f64::consts::FRAC_PI_2),
            ..row("0⁰: exponent 0 at the edge of half a space")
        },
        Row {
            light: toward(grazing),
            view: Eye::Infinite(grazing.map(|x| -x)),
            reflectances: &BLINN,
            diffuse: grazing[2],
            specular: 0.0,
            ..row("h = 0 where l = −v")
        },
        Row {
            surface: ShadedPoint { normal: [0.0, 0.0, 1.0 + 1e-6], ..AT_ORIGIN },
            shininess: 1e5,
            diffuse: 1.0 + 1e-6,
            ..row("a cosine above 1 under a high shininess")
        },
        Row { light: spot(Cone { exponent: 1e30, ..hard(0.5) }, 0.0), ..row("a cosine of 1 under a high exponent") },
        Row { light: spot(equal, 0.499), ..row("inner cone as wide as the cutoff, inside") },
        Row { light: spot(equal, 0.501), ..dark("inner cone as wide as the cutoff, outside") },
        Row { light: spot(hard(0.0), 0.0), ..row("cutoff 0, on the axis") },
        Row { light: spot(hard(0.0), 1e-2), ..dark("cutoff 0, off the axis") },
        Row { light: point(Attenuation::NONE, [0.0; 3]), ..row("a light on the surface") },
        Row {
            light: point(Attenuation::new(4.0, 1.0, 1.0), [0.0; 3]),
            diffuse: 0.25,
            specular: 0.25,
            ..row("a light on the surface: att = 1/a")
        },
        Row {
            light: point(Attenuation::INVERSE_SQUARE, [0.0; 3]),
            diffuse: 1e6,
            specular: 1e6,
            ..row("a light on the surface: the cap where a = 0")
        },
        Row { light: point(Attenuation::NONE, DOWN), ..dark("a light inside the surface") },
        Row { view: Eye::Local([0.0; 3]), ..row("an eye on the surface") },
        Row { light: toward(behind), view: Eye::Infinite(grazing), ..dark("n·l < 0 with n·h > 0") },
        Row { light: toward([1.0, 0.0, 0.0]), shininess: 0.0, ..dark("n·l = 0 with shininess 0") },
        Row { shininess: 1e4, ..row("the peak of a shininess of 10⁴") },
        Row { light: point(Attenuation::NONE, [0.0, 0.0, 1e-12]), ..row("a light 10⁻¹² away") },
        Row { light: point(Attenuation::NONE, [0.0, 0.0, 1e18]), ..row("a light 10¹⁸ away") },
        Row {
            surface: ShadedPoint { position: [1e7, -1e7, 0.0], normal: UP },
            light: point(Attenuation::NONE, [1e7, -1e7, 2.0]),
            view: Eye::Local([1e7, -1e7, 3.0]),
            ..row("10⁷ units from the origin")
        },
    ]
}

#[test]
fn every_edge_has_its_value() {
    for Row { name, surface, light, view, shininess, reflectances, diffuse, specular } in rows() {
        let material = Material {
            specular: LinearRgba::rgb(KS, KS, KS),
            shininess,
            ..Material::matte(LinearRgba::rgb(KD, KD, KD))
        };
        let expected = f64::from(KD) * diffuse + f64::from(KS) * specular;
        for &reflectance in reflectances {
            let double = shade(&surface, &Coefficients::from(&material), &[light], [0.0; 3], &view, reflectance);
            close3(double, [expected; 3], expected * 1e-14, &format!("{name}, {reflectance:?}"));
            let (surface, light, view) = (surface_in_f32(&surface), light.cast(), view_in_f32(&view));
            let single = shade(&surface, &Coefficients::from(&material), &[light], [0.0; 3], &view, reflectance);
            // A handful of roundings; the cosine of 80° went through f32.
            close3(to_f64(single), [expected; 3], expected * 1e-6, &format!("{name}, {reflectance:?}, f32"));
        }
    }
}

fn surface_in_f32(surface: &ShadedPoint<f64>) -> ShadedPoint<f32> {
    ShadedPoint { position: to_f32(surface.position), normal: to_f32(surface.normal) }
}

fn view_in_f32(view: &Eye<f64>) -> Eye<f32> {
    match *view {
        Eye::Local(eye) => Eye::Local(to_f32(eye)),
        Eye::Infinite(v) => Eye::Infinite(to_f32(v)),
    }
}

#[test]
fn normals_that_cancel_are_geometric() {
    let geometric = in_plane(0.2);
    for angle in [0.0, 0.7, 2.0] {
        let (a, b) = (in_plane(angle), in_plane(angle + core::f64::consts::PI));
        let middle: [f64; 3] = core::array::from_fn(|i| 0.5 * (a[i] + b[i]));
        assert_eq!(interpolated_normal(middle, geometric), geometric, "in f64 at {angle}");
        let middle: [f32; 3] = core::array::from_fn(|i| 0.5 * (a[i] as f32 + b[i] as f32));
        assert_eq!(interpolated_normal(middle, to_f32(geometric)), to_f32(geometric), "in f32 at {angle}");
    }
}

/// M of a child inside its parent.
fn inside(parent: [[f64; 3]; 3], child: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    child.map(|column| core::array::from_fn(|i| (0..3).map(|k| parent[k][i] * column[k]).sum()))
}

#[test]
fn normals_under_mirrors_and_flattened_axes() {
    let scale = |x: f64, y: f64, z: f64| [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]];
    let n = [0.6, 0.0, 0.8];
    let rows = [
        ("a mirrored child", inside(scale(1.0, 1.0, 1.0), scale(-1.0, 1.0, 1.0)), [-0.6, 0.0, 0.8]),
        ("a mirrored parent", inside(scale(1.0, 1.0, -1.0), scale(1.0, 1.0, 1.0)), [0.6, 0.0, -0.8]),
        (
            "a mirrored child of a mirrored parent",
            inside(scale(-1.0, 1.0, 1.0), scale(1.0, 1.0, -1.0)),
            [-0.6, 0.0, -0.8],
        ),
        ("the same mirror twice", inside(scale(-1.0, 1.0, 1.0), scale(-1.0, 1.0, 1.0)), n),
        ("an axis of scale 0", scale(2.0, 3.0, 0.0), UP),
        // det M = 0 has no sign to undo: the winding turns over, and the normal with it.
        ("an axis of scale 0 and a mirror", scale(-2.0, 3.0, 0.0), DOWN),
        ("10⁻¹² as large", scale(1e-12, 1e-12, 1e-12), n),
        ("10¹² as large", scale(1e12, 1e12, 1e12), n),
    ];
    for (name, m, expected) in rows {
        let double = transform_normal(normal_matrix(m), n).unwrap_or_else(|| panic!("{name} leaves no normal"));
        let single = transform_normal(normal_matrix(m.map(to_f32)), to_f32(n)).map(to_f64).expect("a normal in f32");
        for (got, tolerance) in [(double, 1e-15), (single, 1e-7)] {
            for i in 0..3 {
                close(got[i], expected[i], tolerance, name);
            }
        }
    }
}
