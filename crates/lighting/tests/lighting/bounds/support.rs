//! Patches, lights and viewers of all kinds for proptest, and points on the patches that seek the brightest place.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use bevy_color::LinearRgba;
use halfway_lighting::bounds::{NormalCone, Patch, Receiver, TermBounds};
use halfway_lighting::equations::vector::{add, cross, dot, length, normalize, scale, sub};
use halfway_lighting::equations::{
    Coefficients, Eye, Light, LightTerms, Real, ShadedPoint, Spot, incidence, light_terms, view_vector,
};
use halfway_lighting::lights::LightSource;
use halfway_lighting::{
    Attenuation, Cone, DirectionalLight, Faces, HemisphereLight, Material, PointLight, Reflectance, SpotLight,
};
use proptest::prelude::*;

/// A light and where it is, in numbers that `f32` and `f64` both hold.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Source {
    pub(crate) light: PointLight,
    pub(crate) kind: Kind,
    pub(crate) position: [f32; 3],
    pub(crate) direction: [f32; 3],
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    Point,
    Spot(Cone),
    Directional,
    Hemisphere,
}

impl Source {
    pub(crate) fn light<T: Real>(&self) -> Light<T> {
        let [position, direction] = [self.position, self.direction].map(|a| a.map(|x| T::from_f64(f64::from(x))));
        let PointLight { ambient, diffuse, specular, .. } = self.light;
        match self.kind {
            Kind::Point => self.light.at(position),
            Kind::Spot(cone) => SpotLight { light: self.light, cone }.at(position, direction).expect("not 0"),
            Kind::Hemisphere => HemisphereLight::new(diffuse, specular).toward(direction).expect("not 0"),
            Kind::Directional => DirectionalLight { ambient, diffuse, specular }.along(direction).expect("not 0"),
        }
    }
}

/// A patch with everything that one evaluation takes besides lights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scene {
    pub(crate) center: [f32; 3],
    pub(crate) radius: f32,
    pub(crate) cone: Option<([f32; 3], f32)>,
    /// As a share of the radius.
    pub(crate) thickness: f32,
    pub(crate) faces: Faces,
    pub(crate) material: Material,
    pub(crate) view: Eye<f32>,
    pub(crate) reflectance: Reflectance,
}

impl Scene {
    pub(crate) fn receiver<T: Real>(&self) -> Receiver<T> {
        let of = |a: [f32; 3]| a.map(|x| T::from_f64(f64::from(x)));
        let patch = Patch {
            center: of(self.center),
            radius: T::from_f64(f64::from(self.radius)),
            normals: self
                .cone
                .map(|(axis, angle)| NormalCone { axis: of(axis), half_angle: T::from_f64(f64::from(angle)) }),
            half_thickness: T::from_f64(f64::from(self.radius * self.thickness)),
            faces: self.faces,
        };
        Receiver::new(&patch, &Coefficients::from(&self.material), &self.view(), self.reflectance)
    }

    fn view<T: Real>(&self) -> Eye<T> {
        let of = |a: [f32; 3]| a.map(|x| T::from_f64(f64::from(x)));
        match self.view {
            Eye::Local(eye) => Eye::Local(of(eye)),
            Eye::Infinite(v) => Eye::Infinite(normalize(of(v)).expect("not 0")),
        }
    }

    /// The exact terms at a point.
    pub(crate) fn terms(&self, surface: &ShadedPoint<f64>, light: &Light<f64>) -> LightTerms<f64> {
        light_terms(surface, &Coefficients::from(&self.material), light, &self.view(), self.reflectance)
    }

    /// A point and a normal of the patch, from six numbers in [0, 1).
    ///
    /// Half of the points are those nearest to the light or the eye, and half of the normals are turned as far as the
    /// cone allows toward l, h, or the normal that mirrors l into v: where the terms are largest.
    pub(crate) fn sample(&self, light: &Light<f64>, u: [f64; 6]) -> ShadedPoint<f64> {
        let center = self.center.map(f64::from);
        // Inside the sphere also after rounding.
        let radius = f64::from(self.radius) * (1.0 - 1e-9);
        let position = match *light {
            Light::Directional(_) | Light::Hemisphere(_) => None,
            Light::Point(point) | Light::Spot(Spot { point, .. }) => Some(point.position),
        };
        let target = match (position, self.view()) {
            (Some(light), _) if u[0] < 0.35 => normalize(sub(light, center)),
            (_, Eye::Local(eye)) if u[0] < 0.5 => normalize(sub(eye, center)),
            _ => None,
        };
        let outward = target.unwrap_or_else(|| direction(u[1], u[2]));
        let share = if u[1] < 0.7 { 1.0 } else { u[2].cbrt() };
        let offset = self.flattened(scale(outward, radius * share));
        let position = add(center, offset);
        let normal = self.normal(position, light, [u[3], u[4], u[5]]);
        ShadedPoint { position, normal }
    }

    /// An offset from the centre brought into the patch's thickness.
    fn flattened(&self, offset: [f64; 3]) -> [f64; 3] {
        let Some((axis, _)) = self.cone else { return offset };
        let axis = normalize(axis.map(f64::from)).expect("not 0");
        let (height, most) = (dot(offset, axis), f64::from(self.radius * self.thickness) * (1.0 - 1e-9));
        add(offset, scale(axis, height.clamp(-most, most) - height))
    }

    fn normal(&self, position: [f64; 3], light: &Light<f64>, u: [f64; 3]) -> [f64; 3] {
        let free = direction(u[1], u[2]);
        let side = match self.faces {
            Faces::Front => 1.0,
            Faces::Back => -1.0,
            Faces::Both => [1.0, -1.0][usize::from(u[2] < 0.5)],
        };
        let probe = ShadedPoint { position, normal: free };
        let l = match light {
            // Light from all around is brightest toward the sky or toward the ground.
            Light::Hemisphere(light) => scale(light.up, if u[0] < 0.125 { 1.0 } else { -1.0 }),
            _ => incidence(&probe, light).expect("a direction").l,
        };
        let v = view_vector(&probe, &self.view());
        let wish = match u[0] {
            u if u < 0.25 => l,
            u if u < 0.6 => normalize(add(l, v)).unwrap_or(l),
            _ => free,
        };
        let Some((axis, half_angle)) = self.cone else { return wish };
        let axis = normalize(axis.map(f64::from)).expect("not 0");
        let angle = f64::from(half_angle).min(PI) * (1.0 - 1e-9);
        scale(turned(axis, scale(wish, side), angle), side)
    }
}

/// `from` turned toward `to`, by `angle` at most.
fn turned(from: [f64; 3], to: [f64; 3], angle: f64) -> [f64; 3] {
    let across = cross(from, to);
    let between = length(across).atan2(dot(from, to));
    if between <= angle {
        return to;
    }
    // Opposite directions are turned through any third one.
    let side = normalize(cross(across, from)).or_else(|| normalize(cross(from, [from[1], from[2], -from[0]])));
    let Some(side) = side else { return from };
    normalize(add(scale(from, angle.cos()), scale(side, angle.sin()))).expect("unit")
}

/// Uniform on the unit sphere.
pub(crate) fn direction(a: f64, b: f64) -> [f64; 3] {
    let z = 2.0 * a - 1.0;
    let r = (1.0 - z * z).max(0.0).sqrt();
    [r * (TAU * b).cos(), r * (TAU * b).sin(), z]
}

/// A description of the first term that exceeds its bound, or `None`. `f32` counts numbers below its smallest normal
/// one as 0.
pub(crate) fn exceeds<T: Real>(terms: &LightTerms<f64>, bounds: &TermBounds<T>, light: &Light<f64>) -> Option<String> {
    // An ambient that is not attenuated is no part of the bounds.
    let ambient = if light.steady_ambient() == [0.0; 3] { terms.ambient } else { [0.0; 3] };
    let rows = [
        ("ambient", ambient, bounds.ambient),
        ("diffuse", terms.diffuse, bounds.diffuse),
        ("specular", terms.specular, bounds.specular),
    ];
    rows.into_iter().find_map(|(name, term, bound)| {
        (0..3).find_map(|c| {
            let bound = bound[c].to_f64().expect("a number");
            (term[c].is_nan() || term[c] > bound + f64::from(f32::MIN_POSITIVE))
                .then(|| format!("{name} {c}: {:e} above its bound {bound:e}", term[c]))
        })
    })
}

/// 10^x with x uniform.
fn magnitude(low: f32, high: f32) -> impl Strategy<Value = f32> {
    (low..=high).prop_map(|x| 10f32.powf(x))
}

fn number() -> BoxedStrategy<f32> {
    prop_oneof![1 => Just(0.0), 4 => magnitude(-4.0, 4.0)].boxed()
}

fn color() -> impl Strategy<Value = LinearRgba> {
    [number(), number(), number()].prop_map(|[r, g, b]| LinearRgba::rgb(r, g, b))
}

pub(crate) fn any_direction() -> impl Strategy<Value = [f32; 3]> {
    (0f64..1.0, 0f64..1.0).prop_map(|(a, b)| direction(a, b).map(|x| x as f32))
}

fn exponent(high: f32) -> impl Strategy<Value = f32> {
    prop_oneof![1 => Just(0.0), 1 => Just(1.0), 4 => magnitude(-2.0, high.log10())]
}

fn cone() -> impl Strategy<Value = Cone> {
    let cutoff = prop_oneof![1 => Just(0.0), 1 => Just(FRAC_PI_2 as f32), 6 => 0f32..FRAC_PI_2 as f32];
    let inner = prop::option::of(prop_oneof![1 => Just(0.0), 1 => Just(1.0), 4 => 0f32..1.0]);
    (cutoff, inner, exponent(128.0)).prop_map(|(cutoff, share, exponent)| Cone {
        cutoff,
        inner: share.map(|share| cutoff * share),
        exponent,
    })
}

/// Lights around a sphere of radius 1 at the origin, for [`placed`]: inside it, near it and far away, of all kinds;
/// spots aimed at the sphere's inside, past it, and along its silhouette.
pub(crate) fn source() -> impl Strategy<Value = Source> {
    let kind = prop_oneof![2 => Just(Kind::Point), 3 => cone().prop_map(Kind::Spot), 1 => Just(Kind::Directional), 1 => Just(Kind::Hemisphere)];
    let falloff = ([number(), number(), number()], prop::option::of(magnitude(-1.0, 3.0)), any::<bool>());
    let place = (any_direction(), distance());
    let aim = (any_direction(), prop_oneof![Just(0.0), 0f32..1.5, Just(1e4)]);
    ((color(), color(), color()), falloff, kind, place, aim).prop_map(
        |((ambient, diffuse, specular), ([a, b, c], range, attenuate_ambient), kind, (way, d), (off, miss))| {
            let attenuation = Attenuation::new(a, b, if a + b + c == 0.0 { 1.0 } else { c });
            let light = PointLight { ambient, diffuse, specular, attenuation, range, attenuate_ambient };
            let position = way.map(|x| x * d);
            // Toward a point that is `miss` off the middle of the sphere.
            let aimed = [0, 1, 2].map(|i| off[i] * miss - position[i]);
            let direction = normalize(aimed).unwrap_or(way);
            Source { light, kind, position, direction }
        },
    )
}

/// From the middle of a unit sphere: inside, on it, near it, far away.
fn distance() -> impl Strategy<Value = f32> {
    prop_oneof![1 => Just(0.0), 2 => 0f32..1.0, 1 => Just(1.0), 4 => 1f32..3.0, 3 => magnitude(0.4, 4.0)]
}

pub(crate) fn scene() -> impl Strategy<Value = Scene> {
    let angle = prop_oneof![2 => Just(0.0), 4 => 0f32..0.5, 3 => 0f32..PI as f32, 1 => Just(PI as f32)];
    let cone = prop_oneof![1 => Just(None), 6 => (any_direction(), angle).prop_map(Some)];
    let faces = prop::sample::select(&[Faces::Front, Faces::Back, Faces::Both]);
    let reflectance =
        prop::sample::select(&[Reflectance::Phong, Reflectance::BlinnPhong, Reflectance::BlinnPhongMatched]);
    let material = (color(), color(), color(), exponent(1e4)).prop_map(|(ambient, diffuse, specular, shininess)| {
        Material { ambient, diffuse, specular, emission: LinearRgba::BLACK, shininess, ..Material::DEFAULT }
    });
    let view = prop_oneof![
        1 => any_direction().prop_map(Eye::Infinite),
        3 => (any_direction(), distance()).prop_map(|(way, d)| Eye::Local(way.map(|x| x * d))),
    ];
    let sphere = ([-1e2f32..1e2, -1e2f32..1e2, -1e2f32..1e2], prop_oneof![1 => Just(0.0), 8 => magnitude(-2.0, 2.0)]);
    let thickness = prop_oneof![1 => Just(0.0), 1 => Just(1.0), 3 => 0f32..1.0];
    (sphere, cone, thickness, faces, material, view, reflectance).prop_map(
        |((center, radius), cone, thickness, faces, material, view, reflectance)| {
            let view = match view {
                Eye::Local(eye) => Eye::Local(placed(eye, center, radius)),
                infinite @ Eye::Infinite(_) => infinite,
            };
            Scene { center, radius, cone, thickness, faces, material, view, reflectance }
        },
    )
}

/// A place around the unit sphere brought to a patch; to a patch that is a point as if it had radius 1.
pub(crate) fn placed(place: [f32; 3], center: [f32; 3], radius: f32) -> [f32; 3] {
    let size = if radius == 0.0 { 1.0 } else { radius };
    [0, 1, 2].map(|i| center[i] + place[i] * size)
}

/// A source around the patch of a scene.
pub(crate) fn around(scene: &Scene, mut source: Source) -> Source {
    source.position = placed(source.position, scene.center, scene.radius);
    source.light.range = source.light.range.map(|range| if scene.radius == 0.0 { range } else { range * scene.radius });
    source
}

pub(crate) fn samples(count: usize) -> impl Strategy<Value = Vec<[f64; 6]>> {
    prop::collection::vec(prop::array::uniform6(0f64..1.0), count)
}

/// Many in release, some in the dev profile.
pub(crate) fn cases(dev: u32) -> ProptestConfig {
    let cases = if cfg!(debug_assertions) { dev } else { dev * 80 };
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(11),
        ..ProptestConfig::default()
    }
}
