//! The twin against `halfway_lighting::equations` in f64, over random inputs and the edges, on every width.

use super::*;
use crate::simd::lanes::MOST_LANES;
use crate::simd::lobe::Gloss;
use crate::simd::width::{VectorWidth, with_vectors};
use fastrand::Rng;
use halfway_lighting::Reflectance;
use halfway_lighting::equations::{
    self, Coefficients, Colors, ConeTerms, Directional, Eye, Hemisphere, Light, Point, ShadedPoint, Spot, face_forward,
    vector::normalize,
};

/// One lane's input.
#[derive(Clone, Copy, Debug)]
struct Case {
    p: [f32; 3],
    n: [f32; 3],
    light: LightRecord,
    kind: Kind,
    exponent: f32,
    reflectance: Reflectance,
    local_viewer: bool,
}

fn within(random: &mut Rng, low: f32, high: f32) -> f32 {
    low + (high - low) * random.f32()
}

fn direction(random: &mut Rng) -> [f32; 3] {
    loop {
        let v = [within(random, -1.0, 1.0), within(random, -1.0, 1.0), within(random, -1.0, 1.0)];
        if let Some(unit) = normalize(v.map(f64::from)) {
            return unit.map(|x| x as f32);
        }
    }
}

fn random_case(random: &mut Rng) -> Case {
    let p = [within(random, -2.0, 2.0), within(random, -2.0, 2.0), within(random, -9.0, -0.5)];
    let kind = Kind::ALL[(random.f32() * Kind::ALL.len() as f32) as usize];
    let toward = direction(random);
    let far = within(random, 0.1, 4.0);
    let position = [0, 1, 2].map(|axis| p[axis] + far * toward[axis]);
    let aim = direction(random);
    let shines = normalize([0, 1, 2].map(|axis| f64::from(0.7 * aim[axis] - toward[axis])));
    let (cutoff, inner) = (within(random, 0.2, 1.5), within(random, 0.0, 0.9));
    let (cos_cutoff, cos_inner) = (cutoff.cos(), (cutoff * inner).cos());
    let faded = random.f32() < 0.5;
    let width = cos_inner - cos_cutoff;
    Case {
        p,
        n: direction(random),
        light: LightRecord {
            position: if matches!(kind, Kind::Directional | Kind::Hemisphere) { toward } else { position },
            inverse_range: if random.f32() < 0.5 { 0.0 } else { 1.0 / within(random, 0.5, 5.0) },
            constant: within(random, 0.1, 1.0),
            linear: within(random, 0.0, 1.0),
            quadratic: within(random, 0.0, 1.0),
            direction: shines.map_or([0.0, 0.0, -1.0], |d| d.map(|x| x as f32)),
            cos_cutoff,
            exponent: (random.f32() * 5.0).floor() * 2.5,
            inner_scale: if faded { 1.0 / width } else { 0.0 },
            inner_offset: if faded { -cos_cutoff / width } else { 1.0 },
            ambient: if random.f32() < 0.5 { [0.0; 3] } else { [random.f32(), 0.5, 0.25] },
            diffuse: [random.f32(), random.f32(), random.f32()],
            specular: [random.f32(), random.f32(), random.f32()],
            ..LightRecord::default()
        },
        kind,
        exponent: [0.0, 1.0, 5.0, 32.0, 100.5, 1000.0][(random.f32() * 6.0) as usize],
        reflectance: if random.f32() < 0.5 { Reflectance::Phong } else { Reflectance::BlinnPhong },
        local_viewer: random.f32() < 0.8,
    }
}

fn side() -> MaterialRecord {
    MaterialRecord {
        base: [0.1, 0.2, 0.3],
        diffuse: [0.9, 0.7, 0.5],
        specular: [0.4, 0.6, 0.8],
        ambient: [0.3, 0.2, 0.1],
        opacity: 1.0,
        ..MaterialRecord::default()
    }
}

fn expected(case: &Case) -> [f64; 3] {
    let f = |v: [f32; 3]| v.map(f64::from);
    let light = &case.light;
    let [fade, offset] = [light.inner_scale, light.inner_offset].map(f64::from);
    let colors = Colors { la: f(light.ambient), ld: f(light.diffuse), ls: f(light.specular) };
    let point = Point {
        position: f(light.position),
        colors,
        attenuation: f([light.constant, light.linear, light.quadratic]),
        range: (light.inverse_range > 0.0).then(|| 1.0 / f64::from(light.inverse_range)),
        attenuate_ambient: true,
    };
    let source = match case.kind {
        Kind::Directional => Light::Directional(Directional { toward: f(light.position), colors }),
        Kind::Hemisphere => {
            Light::Hemisphere(Hemisphere { up: f(light.position), sky: f(light.diffuse), ground: f(light.specular) })
        }
        Kind::Point => Light::Point(point),
        Kind::Spot => Light::Spot(Spot {
            point,
            cone: ConeTerms {
                direction: f(light.direction),
                cos_cutoff: f64::from(light.cos_cutoff),
                cos_inner: (fade > 0.0).then(|| (1.0 - offset) / fade),
                exponent: f64::from(light.exponent),
            },
        }),
    };
    let side = side();
    let material = Coefficients {
        ka: f(side.ambient),
        kd: f(side.diffuse),
        ks: f(side.specular),
        ke: f(side.base),
        shininess: f64::from(case.exponent),
        ..Coefficients::black()
    };
    let view = if case.local_viewer { Eye::Local([0.0; 3]) } else { Eye::Infinite([0.0, 0.0, 1.0]) };
    let surface = ShadedPoint { position: f(case.p), normal: f(case.n) };
    equations::shade(&surface, &material, &[source], [0.0; 3], &view, case.reflectance)
}

/// The result of the twin for a case, in every lane.
fn shaded<S: Simd>(simd: S, case: &Case) -> [[f32; MOST_LANES]; 3] {
    let (p, n) = (splat3(simd, case.p), splat3(simd, case.n));
    let points = Points::new(simd, p, n, to_viewer(simd, p, n, case.local_viewer));
    let gloss = Gloss::new(case.reflectance, &MaterialRecord { shininess: case.exponent, ..side() });
    let light = LightRecord { kind: case.kind as u32, ..case.light };
    let lights = SurfaceLights { both: LightRange { start: 0, count: 1 }, ..SurfaceLights::default() };
    let both = ShadedTerms { diffuse: true, specular: true };
    let terms = gathered(simd, (&[light], &[0]), &lights, &points, gloss, both);
    let color = reflected(simd, &terms, &side());
    let mut lanes = [[0.0; MOST_LANES]; 3];
    for c in 0..3 {
        color[c].store_slice(&mut lanes[c][..crate::simd::lanes::lanes::<S>()]);
    }
    lanes
}

fn on(width: VectorWidth, case: &Case) -> [[f32; MOST_LANES]; 3] {
    let level = width.level().expect("one of this CPU's");
    with_vectors!(level, simd => shaded(simd, case))
}

/// The error allowed for f32: rounding near the cosine's maximum is multiplied by the exponent (see
/// `equations::power`), and that of a cone's cosine by the steepness of its fade.
fn tolerance(case: &Case) -> f64 {
    2e-6 * f64::from(1.0 + case.exponent) + 1e-6 * f64::from(case.light.inner_scale)
}

fn is_on_an_edge(case: &Case) -> bool {
    // Either side of these is right: n·l = 0, and φ = cutoff.
    let f = |v: [f32; 3]| v.map(f64::from);
    let to_light = match case.kind {
        Kind::Hemisphere => return false,
        Kind::Directional => f(case.light.position),
        _ => [0, 1, 2].map(|axis| f64::from(case.light.position[axis]) - f64::from(case.p[axis])),
    };
    let Some(l) = normalize(to_light) else { return false };
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let beside_cone = -dot(l, f(case.light.direction)) - f64::from(case.light.cos_cutoff);
    dot(l, f(case.n)).abs() < 1e-5 || case.kind == Kind::Spot && beside_cone.abs() < 1e-5
}

#[test]
fn shades_as_the_equations_in_f64_do() {
    let mut random = Rng::with_seed(1);
    let mut worst: f64 = 0.0;
    for _ in 0..20_000 {
        let case = random_case(&mut random);
        if is_on_an_edge(&case) {
            continue;
        }
        let expected = expected(&case);
        for width in VectorWidth::available() {
            let found = on(width, &case);
            for c in 0..3 {
                for lane in 0..width.lanes() {
                    assert_eq!(found[c][lane].to_bits(), found[c][0].to_bits(), "{width}: lanes differ: {case:?}");
                }
                let error = (f64::from(found[c][0]) - expected[c]).abs();
                worst = worst.max(error / tolerance(&case));
                assert!(error <= tolerance(&case), "{width}: {} instead of {}: {case:?}", found[c][0], expected[c]);
            }
        }
    }
    assert!(worst > 0.05, "the tolerance could be tighter: {worst}");
}

#[test]
fn widths_give_the_same_bits() {
    let mut random = Rng::with_seed(2);
    for _ in 0..5_000 {
        let case = random_case(&mut random);
        let bits = |width| [0, 1, 2].map(|c| on(width, &case)[c][0].to_bits());
        for width in VectorWidth::available() {
            assert_eq!(bits(width), bits(VectorWidth::available().last().expect("one")), "{width}: {case:?}");
        }
    }
}

#[test]
fn the_edges_are_those_of_the_equations() {
    let straight = Case {
        p: [0.0, 0.0, -2.0],
        n: [0.0, 0.0, 1.0],
        light: LightRecord { diffuse: [0.5; 3], specular: [0.5; 3], ..LightRecord::default() },
        kind: Kind::Directional,
        exponent: 32.0,
        reflectance: Reflectance::BlinnPhong,
        local_viewer: true,
    };
    let at = |position, [constant, linear, quadratic]: [f32; 3]| LightRecord {
        position,
        constant,
        linear,
        quadratic,
        ..straight.light
    };
    let near = |share: f32| {
        // The eye looks along the normal, which the light's direction is not.
        let light = at([2.0 * share, 0.0, -2.0 + 1e-12], [0.5, 1.0, 1.0]);
        Case { kind: Kind::Point, light, n: [0.6, 0.0, 0.8], ..straight }
    };
    let sized = |size: f32| Case {
        kind: Kind::Point,
        p: [0.0, 0.0, -2.0 * size],
        n: [0.0, 0.6, 0.8],
        light: at([0.5 * size, size, -size], [1.0, 0.0, 0.0]),
        ..straight
    };
    let sideways = face_forward([1.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    let cases = [
        ("0⁰", Case { exponent: 0.0, n: sideways, light: at([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]), ..straight }),
        ("l = −v", Case { light: at([0.0, 0.0, -1.0], [1.0, 0.0, 0.0]), ..straight }),
        ("d = 0", Case { kind: Kind::Point, light: at([0.0, 0.0, -2.0], [0.5, 1.0, 1.0]), ..straight }),
        ("a = 0 and d = 0", Case { kind: Kind::Point, light: at([0.0, 0.0, -2.0], [0.0, 0.0, 1.0]), ..straight }),
        (
            "a light nearer than rounding tells",
            Case { kind: Kind::Point, n: [0.0, 0.6, 0.8], light: at([3e-6, 0.0, -2.0], [0.5, 1.0, 1.0]), ..straight },
        ),
        (
            "one a little farther",
            Case { kind: Kind::Point, n: [0.6, 0.0, 0.8], light: at([5e-6, 0.0, -2.0], [0.5, 1.0, 1.0]), ..straight },
        ),
        ("the eye on the surface", Case { p: [0.0; 3], ..straight }),
        ("a light behind", Case { light: at([0.0, 0.0, -1.0], [1.0, 0.0, 0.0]), ..straight }),
        ("a light 10⁻⁶ of the way to the eye from the point", near(1e-6)),
        ("a light 10⁻⁵ of the way from it", near(1e-5)),
        ("a light 10⁻²⁵ from a point at 10⁻²⁵", sized(1e-25)),
        ("the same of 10⁻¹⁸", sized(1e-18)),
        ("the same of 10¹⁸", sized(1e18)),
        ("the same of 10²⁵", sized(1e25)),
        ("the same of 10³⁸", sized(1e38)),
        (
            "a light 10³⁰ away that fades",
            Case { kind: Kind::Point, light: at([1e30, 2e30, 2e30], [1.0, 0.1, 0.01]), ..straight },
        ),
        (
            "a spot 10²⁵ away",
            Case {
                kind: Kind::Spot,
                light: LightRecord {
                    direction: [0.0, -0.6, -0.8],
                    cos_cutoff: 0.5,
                    ..at([0.0, 6e24, 8e24], [1.0, 0.0, 0.0])
                },
                ..straight
            },
        ),
        (
            "a cutoff of 0",
            Case {
                kind: Kind::Spot,
                light: LightRecord { position: [0.0; 3], cos_cutoff: 1.0, ..straight.light },
                ..straight
            },
        ),
    ];
    for (name, case) in cases {
        for reflectance in [Reflectance::Phong, Reflectance::BlinnPhong] {
            let case = Case { reflectance, ..case };
            let expected = expected(&case);
            for width in VectorWidth::available() {
                let found = on(width, &case);
                for c in 0..3 {
                    let error = (f64::from(found[c][0]) - expected[c]).abs();
                    // One of an attenuation of 10⁶ is rounded as any number of that size.
                    let tolerance = 1e-6 * (1.0 + expected[c].abs());
                    assert!(error <= tolerance, "{name} on {width}: {} instead of {}", found[c][0], expected[c]);
                }
            }
        }
    }
}
