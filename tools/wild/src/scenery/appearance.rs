//! Colours, materials, shading.

use fastrand::Rng;
use halfway::lighting::Choices;
use halfway::prelude::{Reflectance, Shading};
use serde_json::{Value, json};

use super::{Object, positions, short, shorts};
use crate::random::RngExt;

/// A few of the presets; which one makes no difference to the code that draws it.
const PRESETS: [&str; 6] = ["brass", "gold", "emerald", "chrome", "red_plastic", "cyan_rubber"];

/// A colour with channels up to about `brightness`: any, grey, or with channels that are 0.
pub(super) fn color(random: &mut Rng, brightness: f64) -> Value {
    let mut channel = || random.between(0.0, brightness);
    let rgb = [channel(), channel(), channel()];
    match random.u64(0..=9) {
        0 => json!([0, 0, 0]),
        1 => shorts([rgb[0]; 3]),
        2 => shorts([rgb[0], 0.0, rgb[2]]),
        3 => shorts([0.0, rgb[1], 0.0]),
        _ => shorts(rgb),
    }
}

/// One of the values of a type that have names, by its key.
fn named<T: Choices>(random: &mut Rng) -> Value {
    random.choose(T::CHOICES).key.into()
}

pub(super) fn shading(random: &mut Rng) -> Value {
    named::<Shading>(random)
}

/// Each term of the lights at a frequency of its own.
pub(super) fn terms(random: &mut Rng) -> Value {
    let frequencies: &[&str] =
        if random.percent(30) { &["triangle", "never"] } else { &["vertex", "fragment", "never"] };
    let mut frequency = || random.choose(frequencies);
    json!({"terms": {"diffuse": frequency(), "specular": frequency()}})
}

pub(super) fn reflectance(random: &mut Rng) -> Value {
    named::<Reflectance>(random)
}

/// A policy for intensities above 1.
pub(super) fn intensity(random: &mut Rng) -> Value {
    match random.u64(0..=6) {
        0 => json!("clamp"),
        1 => json!("renormalise"),
        2 => json!({"renormalise": {"smoothing": short(random.between(0.0, 0.99))}}),
        3 => json!("reinhard"),
        4 => json!({"reinhard": {"white": short(1.0 + random.magnitude(-2, 3))}}),
        _ => json!("aces"),
    }
}

/// A solid texture. Some cells a unit: finer ones would need more digits of a position than 32 bits have.
pub(super) fn solid(random: &mut Rng, unit: f64) -> Value {
    let mut solid = Object::new();
    solid.perhaps(random, 90, "kind", |random| random.choose(&["checker", "marble", "wood", "noise"]).into());
    solid.perhaps(random, 60, "octaves", |random| random.u64(1..=8).into());
    let cells = random.magnitude(-2, 1) / unit;
    let stretched = [0; 3].map(|_| cells * random.between(0.6, 1.4));
    let moved = positions::at_distance(random, 2.0);
    solid.set(
        "transform",
        json!({"scale": shorts(stretched), "rotation": positions::quaternion(random), "translation": shorts(moved)}),
    );
    solid.perhaps(random, 70, "colors", |random| json!([color(random, 1.0), color(random, 1.0)]));
    solid.into()
}

pub(super) fn material(random: &mut Rng) -> Value {
    if random.percent(25) {
        return random.choose(&PRESETS).into();
    }
    let mut material = Object::new();
    material.perhaps(random, 60, "ambient", |random| color(random, 1.0));
    material.perhaps(random, 80, "diffuse", |random| color(random, 1.0));
    material.perhaps(random, 70, "specular", |random| color(random, 1.0));
    material.perhaps(random, 15, "emission", |random| color(random, 0.5));
    material.perhaps(random, 80, "shininess", |random| match random.u64(0..=9) {
        0 => json!(0),
        1 => json!(1),
        2 => json!(short(random.f64())),
        3 => json!(short(random.magnitude(8, 11))),
        _ => json!(short(random.magnitude(0, 7))),
    });
    material.perhaps(random, 60, "opacity", |random| match random.u64(0..=9) {
        0 => json!(0),
        1 => json!(1),
        _ => json!(short(random.f64())),
    });
    material.into()
}
