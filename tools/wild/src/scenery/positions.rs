//! Positions: the scene's unit of length, transforms, and how they change.

use fastrand::Rng;
use serde_json::{Value, json};

use super::{Object, short, shorts};
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
