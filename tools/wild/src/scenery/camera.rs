//! The camera, of every projection.

use fastrand::Rng;
use serde_json::{Value, json};

use super::positions::at_distance;
use super::{Object, appearance, short, shorts};
use crate::random::RngExt;

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

/// Parts of the picture for several cameras: usually side by side, sometimes over one another.
pub(super) fn viewports(random: &mut Rng, [width, height]: [u64; 2]) -> Vec<Value> {
    let [across, down] = [random.between(0.2, 0.8), random.between(0.2, 0.8)];
    let parts = match random.u64(0..=3) {
        0 => vec![[0.0, 0.0, across, 1.0], [across, 0.0, 1.0 - across, 1.0]],
        1 => {
            vec![[0.0, 0.0, 1.0, down], [0.0, down, across, 1.0 - down], [across, down, 0.9 - 0.9 * across, 1.0 - down]]
        }
        2 => vec![[0.0, 0.0, 1.0, 1.0], [0.5 * across, 0.5 * down, 0.5, 0.5]],
        _ => vec![[0.0, 0.0, 0.5, 0.5], [0.5, 0.0, 0.5, 0.5], [0.0, 0.5, 0.5, 0.5], [0.5, 0.5, 0.5, 0.5]],
    };
    let viewport = |part: [f64; 4]| {
        let mut viewport = Object::new();
        if random.percent(60) {
            // Rounded down, so that a part ends within the picture.
            viewport.set("fractions", part.map(|share| (share * 1e3).floor() / 1e3).to_vec().into());
        } else {
            let [left, top, wide, high] = part;
            let pixels = [(left, width), (top, height), (wide, width), (high, height)];
            viewport.set("pixels", pixels.map(|(share, side)| (share * side as f64).floor() as u64).to_vec().into());
        }
        viewport.perhaps(random, 40, "order", |random| random.u64(0..=3).into());
        viewport.perhaps(random, 40, "load", |random| random.choose(&["clear", "clear", "keep"]).into());
        viewport.into()
    };
    parts.into_iter().map(viewport).collect()
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
