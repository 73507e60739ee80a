//! Random pixels of random scenes, explained.

#![expect(clippy::float_cmp, reason = "the same functions give the same bits")]

use std::path::Path;
use std::time::Duration;

use bevy_time::TimeUpdateStrategy;
use fastrand::Rng;
use halfway::lighting::{Frequency, Reflectance};
use halfway::prelude::*;
use halfway::reference::Oracle;
use halfway::reference::explain::{ExplainedLayer, ExplainedLight, ExplainedPoint, Explanation, TermColors};
use halfway::scene::{SceneFile, spawn};
use halfway_wild::scene;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/wild");
const SEED: u64 = 2026;
const SCENES: u64 = 120;
const PIXELS: usize = 24;

/// Sums of terms that are added in another order differ by the rounding of f64, relative to the largest of them.
const ROUNDING: f64 = 1e-12;

fn oracle(file: &SceneFile) -> Option<Oracle> {
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::reference()).insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    spawn(file, Path::new(FOLDER), app.world_mut()).expect("a scene of the folder");
    app.finish();
    app.cleanup();
    app.update();
    // A camera without a direction has no picture.
    Oracle::new(app.world_mut(), UVec2::from_array(file.size)).ok()
}

#[track_caller]
fn close(what: &str, sum: [f64; 3], expected: [f64; 3]) {
    let scale = expected.iter().chain(&sum).fold(1e-300, |most: f64, channel| most.max(channel.abs()));
    for (a, b) in sum.iter().zip(expected) {
        assert!((a - b).abs() <= ROUNDING * scale, "{what}: {sum:?} instead of {expected:?}");
    }
}

fn mul(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] * b[k])
}

fn sum(colors: impl IntoIterator<Item = [f64; 3]>) -> [f64; 3] {
    colors.into_iter().fold([0.0; 3], |sum, color| [0, 1, 2].map(|k| sum[k] + color[k]))
}

/// The names of the terms in their order.
const TERMS: [&str; 3] = ["ambient", "diffuse", "specular"];

/// Multiplies the terms of a light from their factors.
fn check_light(light: &ExplainedLight, point: &ExplainedPoint) {
    let Some((colors, way)) = light.colors.zip(light.way) else { return };
    let weight = way.attenuation * way.window * way.spot;
    let weighted = |share: f64, color: [f64; 3]| color.map(|channel| channel * share);
    let material = &point.material;
    let faces = if way.is_behind { 0.0 } else { 1.0 };
    let diffuse = weighted(faces * weight * way.n_dot_l.max(0.0), mul(material.kd, colors.ld));
    close("diffuse", light.terms.diffuse, diffuse);
    close("specular", light.terms.specular, weighted(faces * weight * way.power, mul(material.ks, colors.ls)));
    let ambient = if light.is_steady { 1.0 } else { weight };
    close("ambient", light.terms.ambient, weighted(ambient, mul(material.ka, colors.la)));
    if way.n_dot_l > 0.0 && way.exponent > 0.0 {
        let power = way.cosine.clamp(0.0, 1.0).powf(way.exponent);
        assert!((power - way.power).abs() <= 1e-9 * power.max(1e-3), "{power} instead of {}", way.power);
    }
}

/// Adds a layer up from its parts.
fn check_layer(layer: &ExplainedLayer) {
    for point in &layer.points {
        point.lights.iter().for_each(|light| check_light(light, point));
        for (k, name) in TERMS.into_iter().enumerate() {
            close(name, sum(point.lights.iter().map(|light| light.counted.each()[k])), point.sums.each()[k]);
        }
    }
    let factors = &layer.factors;
    let surface = mul(factors.color, factors.solid);
    let occluded = surface.map(|channel| channel * factors.occlusion);
    let all = [occluded, surface, factors.specular];
    for (k, (name, factor)) in TERMS.into_iter().zip(all).enumerate() {
        let points = layer.points.iter().map(|point| {
            let weight = point.corner.map_or(1.0, |(_, weight)| weight);
            point.sums.each()[k].map(|channel| channel * weight)
        });
        close(name, sum(points), layer.lights.each()[k]);
        let steady = if name == "ambient" { layer.steady_ambient } else { [0.0; 3] };
        let before = sum([steady, layer.lights.each()[k], layer.environment.each()[k]]);
        close(name, mul(factor, before), layer.sums.each()[k]);
    }
    let parts = layer.sums.each().into_iter().chain([layer.emission]);
    close("intensity", sum(parts), layer.intensity);
}

/// The features that were met, so that the test says which it has not seen.
#[derive(Default, Debug)]
struct Met {
    flat: u32,
    gouraud: u32,
    phong: u32,
    mixed: u32,
    unlit: u32,
    by_phong: u32,
    by_halfway: u32,
    blended: u32,
    backs: u32,
    images: u32,
    environments: u32,
    divided: u32,
    curves: u32,
    backgrounds: u32,
}

impl Met {
    fn count(&mut self, explained: &Explanation) {
        use Frequency::{Fragment, Triangle, Vertex};
        self.divided += u32::from(explained.divisor.is_some());
        self.curves += u32::from(matches!(explained.policy, Intensity::Reinhard { .. } | Intensity::Aces));
        for sample in &explained.samples {
            self.backgrounds += u32::from(sample.layers.is_empty());
            for layer in &sample.layers {
                let shading = match (layer.lit, layer.terms.diffuse, layer.terms.specular) {
                    (false, ..) => &mut self.unlit,
                    (_, Triangle, Triangle) => &mut self.flat,
                    (_, Vertex, Vertex) => &mut self.gouraud,
                    (_, Fragment, Fragment) => &mut self.phong,
                    _ => &mut self.mixed,
                };
                *shading += 1;
                self.by_phong += u32::from(layer.reflectance == Reflectance::Phong);
                self.by_halfway += u32::from(layer.reflectance != Reflectance::Phong);
                self.blended += u32::from(layer.opacity < 1.0);
                self.backs += u32::from(!layer.front);
                let factors = &layer.factors;
                self.images += u32::from(factors.color != [1.0; 3] || factors.solid != [1.0; 3]);
                self.environments += u32::from(layer.environment != TermColors::default());
            }
        }
    }

    fn least(&self) -> u32 {
        let Self { flat, gouraud, phong, mixed, unlit, by_phong, by_halfway, blended, .. } = self;
        let Self { backs, images, environments, divided, curves, backgrounds, .. } = self;
        let all = [flat, gouraud, phong, mixed, unlit, by_phong, by_halfway, blended];
        let more = [backs, images, environments, divided, curves, backgrounds];
        all.into_iter().chain(more).copied().min().unwrap_or(0)
    }
}

#[test]
fn an_explained_pixel_is_the_oracles_to_the_bit_and_its_parts_add_up() {
    let mut met = Met::default();
    for number in 0..SCENES {
        let mut file = SceneFile::from_json(&scene(SEED, number).to_string(), "scene").expect("a scene");
        file.all_cameras_mut().for_each(|camera| camera.viewport = None);
        let Some(oracle) = oracle(&file) else { continue };
        let random = &mut Rng::with_seed(number);
        let oracle = oracle.with_clamping(random.bool()).with_supersampling(random.u32(1..=2));
        let image = oracle.draw();
        let bytes = image.to_bytes(file.output);
        let [width, height] = file.size;
        for _ in 0..PIXELS {
            let [x, y] = [random.u32(0..width), random.u32(0..height)];
            let explained = oracle.explain(x, y).expect("a pixel of the picture");
            assert_eq!(explained.color, image.pixel(x, y), "scene {number}, pixel ({x}, {y})");
            assert_eq!(explained.bytes, bytes.get_pixel(x, y).0, "scene {number}, pixel ({x}, {y})");
            explained.samples.iter().flat_map(|sample| &sample.layers).for_each(check_layer);
            met.count(&explained);
            let texts = [explained.to_string(), explained.to_latex(), explained.to_json().to_string()];
            assert!(texts.iter().all(|text| !text.contains("NaN") && !text.contains("inf")), "scene {number}");
            if explained.divisor.is_some() {
                break;
            }
        }
    }
    assert!(met.least() >= 4, "{met:?}");
}
