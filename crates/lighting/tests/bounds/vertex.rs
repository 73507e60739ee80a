//! What shading terms at vertices changes: no sampled point of a triangle is off by more than is said.

use halfway_lighting::bounds::{
    Grain, NormalCone, Patch, PowerSlopes, TermChange, VertexChange, VertexChanges, VertexShading,
};
use halfway_lighting::equations::vector::{add, cross, dot, length, normalize, scale, sub};
use halfway_lighting::equations::{
    Coefficients, ConeTerms, Eye, GRAZING, Light, Place, Real, ShadedPoint, light_terms, specular_exponent,
};
use halfway_lighting::{Faces, Reflectance};

type V = [f64; 3];

/// Numbers that look random: `SplitMix64` (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// Uniform in its logarithm.
    fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn chance(&mut self, share: f64) -> bool {
        self.next() < share
    }

    fn direction(&mut self) -> V {
        let (z, turn) = (self.between(-1.0, 1.0), self.between(0.0, core::f64::consts::TAU));
        let r = (1.0 - z * z).max(0.0).sqrt();
        [r * turn.cos(), r * turn.sin(), z]
    }
}

/// A triangle under a light.
#[derive(Clone, Copy, Debug)]
struct Case {
    corners: [V; 3],
    normals: [V; 3],
    faces: Faces,
    light: Light<f64>,
    view: Eye<f64>,
    reflectance: Reflectance,
    shininess: f64,
}

/// White but for its attenuated ambient.
fn white_material(shininess: f64) -> Coefficients<f64> {
    Coefficients { ka: [1.0; 3], kd: [1.0; 3], ks: [1.0; 3], ke: [0.0; 3], shininess }
}

impl Case {
    /// Triangles of unit size; a quarter of the lights aim at the terminator, half of the highlights at the triangle.
    fn random(random: &mut Random) -> Self {
        let size = random.magnitude(0.003, 1.0);
        let corners = [0; 3].map(|_| scale(random.direction(), size * random.next().sqrt()));
        let face = normalize(cross(sub(corners[1], corners[0]), sub(corners[2], corners[0])));
        let axis = if random.chance(0.8) { face.unwrap_or([0.0, 0.0, 1.0]) } else { random.direction() };
        let bent = random.magnitude(1e-3, 1.0);
        // Some are normals of a sphere, inside or outside; some have nothing to do with the surface.
        let curved = if random.chance(0.6) { random.between(-1.0, 1.0) * bent / size } else { 0.0 };
        let noise = if curved == 0.0 { bent } else { 0.0 };
        let normals = corners.map(|corner| {
            let moved = add(add(axis, scale(corner, curved)), scale(random.direction(), noise));
            normalize(moved).unwrap_or(axis)
        });
        let distance = random.magnitude(1.05, 100.0) * size;
        let mut toward = random.direction();
        if random.chance(0.25) {
            // Near the plane of the normals.
            toward = sub(toward, scale(axis, dot(toward, axis) * random.between(0.9, 1.1)));
        }
        let toward = normalize(toward).unwrap_or(axis);
        let at = scale(toward, distance);
        let eye = if random.chance(0.5) {
            // The mirrored direction.
            let mirrored = sub(scale(axis, 2.0 * dot(toward, axis)), toward);
            normalize(add(mirrored, scale(random.direction(), random.magnitude(1e-3, 1.0)))).unwrap_or(axis)
        } else {
            random.direction()
        };
        let view = if random.chance(0.3) {
            Eye::Infinite(eye)
        } else {
            Eye::Local(scale(eye, random.magnitude(1.05, 100.0) * size))
        };
        let is_point = random.chance(0.7);
        let inverse_square = random.chance(0.3);
        let attenuation = if inverse_square {
            [0.0, 0.0, 1.0]
        } else {
            [random.next(), random.next() / distance, random.next() / (distance * distance)]
        };
        let cone = (is_point && random.chance(0.4)).then(|| {
            let off = scale(random.direction(), random.magnitude(1e-3, 1.0));
            let direction = normalize(add(scale(toward, -1.0), off)).unwrap_or([0.0, 0.0, 1.0]);
            let cos_cutoff = random.next();
            let exponents = [0.0, 1.0, random.magnitude(0.5, 128.0)];
            let cos_inner = random.chance(0.3).then(|| cos_cutoff + (1.0 - cos_cutoff) * random.next());
            let exponent = exponents[(3.0 * random.next()) as usize];
            ConeTerms { direction, cos_cutoff, cos_inner, exponent }
        });
        let reflectances = [Reflectance::BlinnPhong, Reflectance::BlinnPhong, Reflectance::Phong];
        let white = [1.0; 3];
        Self {
            corners,
            normals,
            faces: if random.chance(0.8) { Faces::Front } else { Faces::Back },
            light: Light {
                place: if is_point { Place::Point(at) } else { Place::Directional(toward) },
                la: white,
                ld: white,
                ls: white,
                attenuation,
                range: random.chance(0.2).then(|| distance * random.magnitude(0.5, 4.0)),
                cone,
                attenuate_ambient: true,
            },
            view,
            reflectance: reflectances[(3.0 * random.next()) as usize],
            shininess: match random.next() {
                n if n < 0.05 => 0.0,
                n if n < 0.1 => 1.0,
                _ => random.magnitude(0.5, 600.0),
            },
        }
    }

    /// It, its light and its eye elsewhere.
    fn moved(self, by: V) -> Self {
        let Place::Point(light) = self.light.place else { unreachable!("of point lights only") };
        let Eye::Local(eye) = self.view else { unreachable!("of eyes at a place only") };
        Self {
            corners: self.corners.map(|corner| add(corner, by)),
            light: Light { place: Place::Point(add(light, by)), ..self.light },
            view: Eye::Local(add(eye, by)),
            ..self
        }
    }

    fn shading<T: Real>(&self) -> Option<VertexShading<T>> {
        let of = |a: V| a.map(T::of);
        let center = scale(add(add(self.corners[0], self.corners[1]), self.corners[2]), 1.0 / 3.0);
        let radius = self.corners.map(|corner| length(sub(corner, center))).into_iter().fold(0.0, f64::max);
        let rounded = length(center) * f64::from(f32::EPSILON);
        let axis = normalize(add(add(self.normals[0], self.normals[1]), self.normals[2]))?;
        let angle = |n: V| length(cross(n, axis)).atan2(dot(n, axis));
        let half_angle = self.normals.map(angle).into_iter().fold(0.0, f64::max) + 1e-6;
        let patch = Patch {
            center: of(center),
            radius: T::of(radius * (1.0 + 1e-6) + rounded),
            normals: Some(NormalCone { axis: of(axis), half_angle: T::of(half_angle) }),
            half_thickness: T::of(radius),
            faces: self.faces,
        };
        let grain = Grain::none().with(self.corners.map(of), self.normals.map(of));
        let view = match self.view {
            Eye::Local(eye) => Eye::Local(of(eye)),
            Eye::Infinite(v) => Eye::Infinite(of(v)),
        };
        let slopes = PowerSlopes::new(T::of(specular_exponent(self.reflectance, self.shininess)));
        VertexShading::new(&patch, &grain, slopes, &view, self.reflectance)
    }

    /// Ambient, diffuse and specular factors.
    fn terms(&self, position: V, normal: V) -> V {
        let side = if self.faces == Faces::Back { -1.0 } else { 1.0 };
        let point = ShadedPoint { position, normal: scale(normal, side) };
        let material = white_material(self.shininess);
        let terms = light_terms(&point, &material, &self.light, &self.view, self.reflectance);
        [terms.ambient[0], terms.diffuse[0], terms.specular[0]]
    }

    /// What exceeds its bound, in words, with `factor` of each bound counted; else the largest changes.
    fn check<T: Real>(&self, steps: u32, factor: f64) -> Result<Option<[f64; 3]>, String> {
        let change = self.shading::<T>().and_then(|shading| shading.change(&self.light.cast::<T>()));
        change.map(|change| self.check_change(change, steps, factor)).transpose()
    }

    fn check_change<T: Real>(&self, change: VertexChange<T>, steps: u32, factor: f64) -> Result<[f64; 3], String> {
        let wide = |change: TermChange<T>| {
            [change.brighter, change.darker, change.least].map(|x| x.to_f64().expect("a number"))
        };
        let bounds = [wide(change.ambient), wide(change.diffuse), wide(change.specular)];
        let at_corners = [0, 1, 2].map(|i: usize| self.terms(self.corners[i], self.normals[i]));
        let mut share = [0.0f64; 3];
        for i in 0..=steps {
            for j in 0..=steps - i {
                let b = [i, j, steps - i - j].map(|n| f64::from(n) / f64::from(steps));
                let mean = |of: [V; 3]| (0..3).fold([0.0; 3], |sum, k| add(sum, scale(of[k], b[k])));
                let Some(normal) = normalize(mean(self.normals)) else { continue };
                let (exact, interpolated) = (self.terms(mean(self.corners), normal), mean(at_corners));
                for k in 0..3 {
                    let [brighter, darker, least] = bounds[k];
                    let (off, room) = (interpolated[k] - exact[k], 1e-9 * (1.0 + exact[k]));
                    if !(off <= factor * brighter + room && -off <= factor * darker + room) {
                        let name = ["ambient", "diffuse", "specular"][k];
                        return Err(format!("{name}: off by {off:e}; +{brighter:e} −{darker:e} at {b:?}"));
                    }
                    let smaller = exact[k].min(interpolated[k]);
                    if smaller.is_nan() || smaller < least - room {
                        return Err(format!("term {k}: {smaller:e}, and at least {least:e}"));
                    }
                    let bound = if off > 0.0 { brighter } else { darker };
                    if bound > 0.0 {
                        share[k] = share[k].max(off.abs() / bound);
                    }
                }
            }
        }
        Ok(share)
    }
}

fn count(release: u64) -> u64 {
    let asked = std::env::var("HALFWAY_BOUND_CASES").ok().and_then(|text| text.parse().ok());
    asked.unwrap_or(if cfg!(debug_assertions) { release / 40 } else { release })
}

/// More of them by `HALFWAY_BOUND_CASES`.
#[test]
fn no_point_is_off_by_more_than_is_said() {
    let (mut random, cases) = (Random(2026), count(100_000));
    let mut said = 0u64;
    let mut shares = [[0u64; 11]; 3];
    for number in 0..cases {
        let case = Case::random(&mut random);
        for found in [case.check::<f64>(8, 1.0), case.check::<f32>(8, 1.0)] {
            match found {
                Ok(None) => {}
                Ok(Some(share)) => {
                    said += 1;
                    for k in 0..3 {
                        shares[k][(10.0 * share[k]) as usize] += 1;
                    }
                }
                Err(text) => panic!("case {number}: {text}\n{case:#?}"),
            }
        }
    }
    println!("{said} of {} said; changes in tenths of their bounds: {shares:?}", 2 * cases);
    assert!(said > cases, "of most nothing is said");
}

/// Eight lights at once: no point is off by more, and where the plain text says nothing, neither do they.
#[test]
fn bounds_on_lanes_hold_too() {
    let (mut random, mut changes) = (Random(77), VertexChanges::default());
    let (mut said, mut largest) = (0, 0.0f64);
    for number in 0..count(40_000) {
        let case = Case::random(&mut random);
        let Some(shading) = case.shading::<f32>() else { continue };
        // The light of this case among others, so that it comes to lie in any lane.
        let own = number % 11;
        let lights: Vec<Light<f32>> = (0..11)
            .map(|i| if i == own { case.light.cast() } else { Case::random(&mut random).light.cast() })
            .collect();
        changes.begin();
        let found = changes.find(&shading, &lights, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10])[own as usize];
        let plain = shading.change(&lights[own as usize]);
        assert_eq!(found.is_some(), plain.is_some(), "case {number}: {case:#?}");
        let Some((found, plain)) = found.zip(plain) else { continue };
        said += 1;
        case.check_change(found, 8, 1.0).unwrap_or_else(|text| panic!("case {number}: {text}\n{case:#?}"));
        for (found, plain) in [(found.diffuse, plain.diffuse), (found.specular, plain.specular)] {
            for (found, plain) in [(found.brighter, plain.brighter), (found.darker, plain.darker)] {
                largest = largest.max(f64::from((found - plain).abs()) / f64::from(plain.max(1e-5)));
            }
        }
    }
    println!("{said} said; off from the plain text by {largest:.1e}");
    assert!(said > 100 && largest < 2e-2, "off by {largest:e}");
}

/// The same check finds bounds that are too small.
#[test]
fn half_a_bound_is_exceeded() {
    let mut random = Random(2026);
    let mut exceeded = [0; 3];
    for _ in 0..20_000 {
        if let Err(text) = Case::random(&mut random).check::<f64>(8, 0.5) {
            for (exceeded, name) in exceeded.iter_mut().zip(["ambient", "diffuse", "specular"]) {
                *exceeded += u32::from(text.starts_with(name));
            }
        }
    }
    println!("{exceeded:?}");
    assert!(exceeded.iter().all(|&times| times > 0), "{exceeded:?}");
}

/// From this size on a triangle at 512 units has corners in single precision.
const SINGLE: f64 = 1e-3;

/// A flat triangle of this size, `far` from the eye, with a light so low over its plane that it counts as in it at some
/// of its points and as above it at others.
fn in_the_plane(random: &mut Random, far: f64, size: f64) -> Case {
    let corners = [0; 3].map(|_| {
        let turn = random.between(0.0, core::f64::consts::TAU);
        [far + size * turn.cos(), size * turn.sin(), 0.0]
    });
    let turn = random.between(0.0, core::f64::consts::TAU);
    let weights = [random.next(), random.next(), random.next()];
    let sum: f64 = weights.iter().sum();
    let step = (0..3).fold([0.0; 3], |p, k| add(p, scale(corners[k], weights[k] / sum)));
    let below = [far + turn.cos(), turn.sin(), 0.0];
    let height = f64::from(GRAZING) * (length(step) + length(sub(below, step)));
    // Numbers of single precision where those tell the corners apart, so that both precisions are of the same scene.
    let exact = |p: V| if size < SINGLE { p } else { p.map(|x| f64::from(x as f32)) };
    // Some are so low that the highlight is weak where it ends.
    let [x, y, z] = random.direction();
    let eye = add([far, 0.0, 0.0], scale([x, y, z.abs() * random.magnitude(1e-3, 1.0)], random.magnitude(1.0, 10.0)));
    let white = [1.0; 3];
    Case {
        corners: corners.map(exact),
        normals: [[0.0, 0.0, 1.0]; 3],
        faces: Faces::Front,
        light: Light {
            place: Place::Point(exact([below[0], below[1], height])),
            la: white,
            ld: white,
            ls: white,
            attenuation: [1.0, 0.0, 0.0],
            range: None,
            cone: None,
            attenuate_ambient: true,
        },
        view: Eye::Local(exact(eye)),
        reflectance: if random.chance(0.5) { Reflectance::BlinnPhong } else { Reflectance::Phong },
        shininess: random.magnitude(0.5, 32.0),
    }
}

/// Where a light counts as in the plane of the surface its terms end in a step, and the bounds have room for that;
/// those of the same triangle beside the eye, where the step is smaller, have not.
#[test]
fn the_step_in_the_plane_of_a_light_is_within_the_bounds() {
    let (mut random, mut changes) = (Random(93), VertexChanges::default());
    let (mut exceeded, mut singles) = ([0; 2], 0);
    for number in 0..count(4_000) {
        let size = random.magnitude(1e-6, 0.3);
        let case = in_the_plane(&mut random, 512.0, size);
        let holds = |found: Result<[f64; 3], String>| {
            found.unwrap_or_else(|text| panic!("case {number}: {text}\n{case:#?}"));
        };
        let change = |case: &Case| case.shading::<f64>().and_then(|shading| shading.change(&case.light));
        // Of some nothing is said, whose eye is among the points.
        let Some(own) = change(&case) else { continue };
        holds(case.check_change(own, 8, 1.0));
        let light = case.light.cast();
        let single = case.shading::<f32>().filter(|_| size >= SINGLE);
        if let Some((shading, found)) = single.and_then(|shading| Some((shading, shading.change(&light)?))) {
            holds(case.check_change(found, 8, 1.0));
            changes.begin();
            holds(case.check_change(changes.find(&shading, &[light], &[0])[0].expect("as before"), 8, 1.0));
            singles += 1;
        }
        let near = change(&case.moved([-512.0, 0.0, 0.0])).expect("apart from light and eye");
        for (k, planted) in
            [VertexChange { diffuse: near.diffuse, ..own }, VertexChange { specular: near.specular, ..own }]
                .into_iter()
                .enumerate()
        {
            exceeded[k] += u32::from(case.check_change(planted, 8, 1.0).is_err());
        }
    }
    println!("{exceeded:?} {singles}");
    assert!(exceeded.into_iter().chain([singles]).all(|times| times > 0), "{exceeded:?} {singles}");
}

/// Prints what one light costs for one patch.
#[test]
#[ignore = "it prints times"]
fn times() {
    let mut random = Random(7);
    let cases: Vec<Case> = (0..2000).map(|_| Case { shininess: 32.0, ..Case::random(&mut random) }).collect();
    let made: Vec<_> =
        cases.iter().filter_map(|case| Some((case.shading::<f32>()?, case.light.cast::<f32>()))).collect();
    let mut changes = VertexChanges::default();
    for _ in 0..3 {
        let start = std::time::Instant::now();
        for _ in 0..100 {
            for (shading, light) in &made {
                std::hint::black_box(shading.change(light));
            }
        }
        println!("{:.1} ns a change", start.elapsed().as_secs_f64() * 1e7 / made.len() as f64);
        for lights in [4, 8] {
            let of_patch: Vec<Light<f32>> =
                made.iter().take(lights).map(|(_, light)| Light { cone: None, ..*light }).collect();
            let numbers: Vec<u32> = (0..lights as u32).collect();
            changes.begin();
            let start = std::time::Instant::now();
            for (shading, _) in &made {
                std::hint::black_box(changes.find(shading, &of_patch, &numbers));
            }
            println!("{:.1} ns for {lights} lights at once", start.elapsed().as_secs_f64() * 1e9 / made.len() as f64);
        }
        let start = std::time::Instant::now();
        for _ in 0..20 {
            for case in &cases {
                std::hint::black_box(case.shading::<f32>());
            }
        }
        println!("{:.1} ns a patch", start.elapsed().as_secs_f64() * 1e9 / 20.0 / cases.len() as f64);
    }
}

/// Also where squares and powers of its edges leave the range of single precision.
#[test]
fn the_circle_around_a_triangle_is_known_at_any_size() {
    for (corners, radius) in [
        ([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.75_f32.sqrt(), 0.0]], 1.0 / 3f32.sqrt()),
        // Obtuse, and of two corners at one place.
        ([[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [2.0, 0.0, 0.0]], 1.0),
        ([[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 3.0, 1.0]], 1.5),
        ([[1.0; 3]; 3], 0.0),
    ] {
        for size in [1e-30_f32, 1e-22, 1e-10, 1.0, 1e10, 1e20, 1e30] {
            let scaled = corners.map(|corner| corner.map(|along| along * size));
            let found = Grain::none().with(scaled, [[0.0; 3]; 3]).corners;
            let expected = radius * size;
            assert!(found >= expected && found <= expected * (1.0 + 1e-4), "{size}: {found} for {expected}");
        }
    }
}
