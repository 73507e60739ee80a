//! Environments: one of a few small images, which scenes name by a relative path.

use fastrand::Rng;
use serde_json::{Value, json};

use super::{IMAGES, Object, short};
use crate::random::RngExt;

pub(super) fn environment(random: &mut Rng) -> Value {
    let (shape, images) = match random.u64(0..=2) {
        0 => ("equirectangular", &IMAGES[..1]),
        1 => ("ball", &IMAGES[1..2]),
        _ => ("cube", &IMAGES[2..8]),
    };
    let mut environment = Object::new();
    environment.set("paths", images.iter().map(|(path, _)| *path).collect::<Vec<_>>().into());
    environment.set("shape", shape.into());
    environment.perhaps(random, 70, "strength", |random| match random.u64(0..=9) {
        0 => json!(0),
        1 => json!(short(random.magnitude(0, 6))),
        _ => json!(short(random.between(0.1, 1.5))),
    });
    environment.perhaps(random, 60, "rotation_deg", |random| json!(short(random.between(-400.0, 400.0))));
    environment.perhaps(random, 60, "sky", |random| json!(random.percent(50)));
    environment.into()
}
