//! Positions: the scene's unit of length, the camera, transforms.

use fastrand::Rng;
use serde_json::{Value, json};

use super::{Object, appearance, short, shorts};
use crate::random::RngExt;

/// The length that all others are multiples of: usually 1.
pub(super) fn unit(random: &mut Rng) -> f64 {
    match random.u64(0..=99) {
        0..3 => random.magnitude(-60, 60),
        3..15 => random.magnitude(-14, 14),
        _ => 1.0,
    }
}

/// A point at this distance from the origin, in any direction.
pub(super) fn at_distance(random: &mut Rng, distance: f64) -> [f64; 3] {
    random.direction().map(|c| c * distance)
}

/// Usually from outside, sometimes from near by or from inside.
pub(super) fn camera(random: &mut Rng, unit: f64) -> Value {
    let distance = match random.u64(0..=19) {
        0 => random.between(0.05, 0.8),
        1..4 => random.between(0.8, 2.0),
        4 => random.magnitude(3, 9),
        _ => random.between(3.0, 9.0),
    };
    let mut camera = Object::new();
    camera.set("position", shorts(at_distance(random, distance * unit)));
    let aside = random.between(0.0, 0.4) * distance.min(2.0);
    camera.perhaps(random, 70, "target", |random| shorts(at_distance(random, aside * unit)));
    camera.set("up", shorts(random.direction()));
    // In scenes of another size the default would clip everything.
    let mut near = match random.u64(0..=3) {
        0 => random.magnitude(-10, -1),
        _ => 0.1,
    };
    match random.u64(0..=9) {
        0 => camera.set("intrinsics", intrinsics(random)),
        1..3 => {
            near = random.between(-9.0, 2.0);
            camera.set("height", json!(short(random.between(0.5, 7.0) * unit)));
            camera.perhaps(random, 40, "far", |random| json!(short((near + random.between(2.0, 20.0)) * unit)));
            film(random, &mut camera);
        }
        _ => {
            camera.perhaps(random, 60, "fov_y_deg", |random| match random.u64(0..=9) {
                0 => json!(short(random.between(120.0, 165.0))),
                1 => json!(short(random.between(1.0, 10.0))),
                _ => json!(short(random.between(20.0, 90.0))),
            });
            film(random, &mut camera);
        }
    }
    camera.set("near", json!(short(near * unit)));
    camera.perhaps(random, 10, "shading", appearance::shading);
    camera.perhaps(random, 10, "reflectance", appearance::reflectance);
    camera.into()
}

/// Usually in the middle, with square pixels.
fn film(random: &mut Rng, camera: &mut Object) {
    camera.perhaps(random, 20, "shift", |random| shorts([random.between(-0.6, 0.6), random.between(-0.6, 0.6)]));
    camera.perhaps(random, 15, "aspect", |random| json!(short(random.between(0.3, 3.0))));
    camera.perhaps(random, 15, "pixel_aspect", |random| json!(short(random.between(0.4, 2.5))));
}

fn intrinsics(random: &mut Rng) -> Value {
    let size = [random.u64(40..=400), random.u64(40..=400)];
    let focal = short(random.between(0.5, 3.0) * size[1] as f64);
    let center = size.map(|side| side as f64 * random.between(0.2, 0.8));
    json!({ "focal": shorts([focal, focal * random.between(0.5, 2.0)]), "center": shorts(center), "size": size })
}

/// One key of a transform that is in parts, in time; the judge sees it at time 0.
pub(super) fn animation(random: &mut Rng, unit: f64) -> Value {
    let of = random.choose(&["translation", "rotation"]);
    let value = |random: &mut Rng| {
        let distance = random.between(0.0, 2.0) * unit;
        if of == "rotation" { quaternion(random) } else { shorts(at_distance(random, distance)) }
    };
    let (first, last) = (value(random), value(random));
    let mut track = Object::new();
    track.set("of", of.into());
    track.set("keys", json!([[0, first], [short(random.between(0.5, 3.0)), last]]));
    track.perhaps(random, 60, "interpolation", |random| random.choose(&["linear", "step"]).into());
    track.perhaps(random, 60, "repeat", |random| random.percent(50).into());
    json!([Value::from(track)])
}

/// In parts or as a matrix; mirrored, skew and flattened ones among them.
pub(super) fn transform(random: &mut Rng, unit: f64) -> Value {
    let distance = random.between(0.0, 2.5) * unit;
    let translation = at_distance(random, distance);
    let size = random.between(0.4, 1.6);
    if random.percent(20) {
        return matrix(random, translation, size);
    }
    let mut transform = Object::new();
    transform.perhaps(random, 85, "translation", |_| shorts(translation));
    transform.perhaps(random, 75, "rotation", quaternion);
    transform.perhaps(random, 60, "scale", |random| scale(random, size));
    transform.into()
}

/// Six digits, so that its length is near enough to 1 for the format.
pub(super) fn quaternion(random: &mut Rng) -> Value {
    let ([x, y, z], share) = (random.direction(), random.between(-1.0, 1.0));
    let rest = (1.0 - share * share).sqrt();
    json!([x * rest, y * rest, z * rest, share].map(|c| (c * 1e6).round() / 1e6))
}

fn scale(random: &mut Rng, size: f64) -> Value {
    let mut axis = |least: f64, most: f64| size * random.between(least, most);
    let uneven = [axis(0.3, 1.5), axis(0.3, 1.5), axis(0.3, 1.5)];
    match random.u64(0..=19) {
        0 => shorts([uneven[0], 0.0, uneven[2]]),
        1 => shorts([uneven[0], uneven[1], uneven[2] * 1e-3]),
        2..5 => shorts([-uneven[0], uneven[1], uneven[2]]),
        5 => shorts([-size; 3]),
        6..12 => shorts(uneven),
        _ => shorts([size; 3]),
    }
}

fn matrix(random: &mut Rng, [x, y, z]: [f64; 3], size: f64) -> Value {
    let mut column = || -> [f64; 3] { std::array::from_fn(|_| size * random.between(-1.0, 1.0)) };
    let (a, b, mut c) = (column(), column(), column());
    // One column in the plane of the others: no volume is left.
    if random.percent(10) {
        c = std::array::from_fn(|i| f64::midpoint(a[i], b[i]));
    }
    json!({ "matrix": shorts([a[0], a[1], a[2], 0.0, b[0], b[1], b[2], 0.0, c[0], c[1], c[2], 0.0, x, y, z, 1.0]) })
}
