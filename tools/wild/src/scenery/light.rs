//! Lights of all kinds and numbers.

use fastrand::Rng;
use serde_json::{Value, json};

use super::positions::at_distance;
use super::{Object, appearance, short, shorts};
use crate::random::RngExt;

/// The lights of a scene of N objects: from none to 300, or the format's default.
pub(super) fn lights(random: &mut Rng, unit: f64, objects: usize) -> Value {
    let count = match random.u64(0..=99) {
        0..2 => return Value::Null,
        2..6 => 0,
        6..56 => random.u64(1..=3),
        56..80 => random.u64(4..=8),
        80..94 => random.u64(9..=40),
        _ => random.u64(41..=300),
    };
    // Together about as bright as three.
    let brightness = (3.0 / count as f64).clamp(0.02, 1.0);
    (0..count).map(|_| light(random, unit, objects, brightness)).collect()
}

fn light(random: &mut Rng, unit: f64, objects: usize, brightness: f64) -> Value {
    let kind = random.choose(&["point", "point", "spot", "spot", "directional", "homogeneous", "hemisphere"]);
    let mut light = Object::new();
    light.set("kind", kind.into());
    let bright = if random.percent(4) { random.magnitude(2, 10) } else { 1.0 } * brightness;
    if kind == "hemisphere" {
        light.perhaps(random, 85, "sky", |random| appearance::color(random, 0.8 * bright));
        light.perhaps(random, 85, "ground", |random| appearance::color(random, 0.4 * bright));
    } else {
        light.set("diffuse", appearance::color(random, 1.2 * bright));
        light.perhaps(random, 85, "specular", |random| appearance::color(random, 1.2 * bright));
        light.perhaps(random, 30, "ambient", |random| appearance::color(random, 0.3 * bright));
    }
    light.perhaps(random, 30, "attach", |random| match random.u64(0..=4) {
        0 => json!("world"),
        1..3 if objects > 0 => {
            let index = random.u64(..objects as u64);
            json!({ "object": if random.percent(50) { json!(index) } else { format!("o{index}").into() } })
        }
        _ => json!("camera"),
    });
    match kind {
        "directional" | "hemisphere" => light.set("direction", direction(random)),
        "homogeneous" => light.set("position", homogeneous(random, unit)),
        _ => light.set("position", shorts(position(random, unit))),
    }
    if kind != "directional" && kind != "hemisphere" {
        falloff(random, unit, &mut light);
    }
    if kind == "spot" || (kind == "homogeneous" && random.percent(40)) {
        light.set("direction", direction(random));
        cone(random, &mut light);
    }
    light.into()
}

/// Usually around the objects, sometimes among them or far away.
fn position(random: &mut Rng, unit: f64) -> [f64; 3] {
    let distance = match random.u64(0..=9) {
        0 => random.between(0.0, 1.0),
        1 => random.magnitude(3, 12),
        _ => random.between(1.5, 6.0),
    };
    at_distance(random, distance * unit)
}

fn homogeneous(random: &mut Rng, unit: f64) -> Value {
    let [x, y, z] = position(random, unit);
    match random.u64(0..=3) {
        0 => shorts([x, y, z, 1.0]),
        1 => shorts([2.0 * x, 2.0 * y, 2.0 * z, 2.0]),
        2 => shorts([-x, -y, -z, -1.0]),
        _ => shorts([x, y, z, 0.0]),
    }
}

fn direction(random: &mut Rng) -> Value {
    let length = if random.percent(10) { random.magnitude(-20, 20) } else { 1.0 };
    shorts(random.direction().map(|c| c * length))
}

/// Constants in the scene's unit, so that light reaches the objects of large scenes.
fn falloff(random: &mut Rng, unit: f64, light: &mut Object) {
    light.set("attenuation", {
        let [a, b, c] = match random.u64(0..=5) {
            0 => [1.0, 0.0, 0.0],
            1 => [0.0, 0.0, random.between(0.05, 0.5)],
            2 => [0.0, random.between(0.1, 0.7), 0.0],
            _ => [random.between(0.2, 1.0), random.between(0.0, 0.2), random.between(0.0, 0.1)],
        };
        shorts([a, b / unit, c / unit / unit])
    });
    light.perhaps(random, 35, "range", |random| json!(short(random.between(0.5, 8.0) * unit)));
    light.perhaps(random, 15, "attenuate_ambient", |_| json!(true));
}

fn cone(random: &mut Rng, light: &mut Object) {
    let cutoff = match random.u64(0..=9) {
        0 => 180.0,
        1 => 90.0,
        2 => short(random.between(0.1, 5.0)),
        _ => short(random.between(10.0, 80.0)),
    };
    light.set("cutoff_deg", json!(cutoff));
    light.perhaps(random, 50, "inner_deg", |random| match random.u64(0..=4) {
        0 => json!(0),
        1 => json!(cutoff),
        _ => json!(short(cutoff * random.between(0.0, 0.99))),
    });
    light.perhaps(random, 50, "exponent", |random| json!(short(random.magnitude(-2, 6))));
}
