//! Lines and points: those of small models, along the edges of meshes, and those that explain a scene.

use fastrand::Rng;
use halfway::lighting::Show;
use serde_json::{Value, json};

use super::{MODELS, Object, appearance, positions, short, shorts};
use crate::random::RngExt;

/// One of the small models, which are about 2 wide.
pub(super) fn model(random: &mut Rng, unit: f64) -> Value {
    let (path, _) = random.choose(&MODELS);
    let mut object = Object::new();
    object.set("name", "model".into());
    object.set("mesh", json!({ "path": path }));
    let size = unit * random.between(0.3, 1.2);
    let distance = random.between(0.0, 1.5) * unit;
    object.set(
        "transform",
        json!({
            "translation": shorts(positions::at_distance(random, distance)),
            "rotation": positions::quaternion(random),
            "scale": shorts([size; 3]),
        }),
    );
    object.perhaps(random, 60, "material", appearance::material);
    object.perhaps(random, 60, "faces", |random| random.choose(&["front", "back", "both", "both"]).into());
    object.perhaps(random, 25, "blend", |_| json!(true));
    object.perhaps(random, 60, "line_style", |random| style(random, unit));
    object.into()
}

/// The looks of lines and points.
pub(super) fn style(random: &mut Rng, unit: f64) -> Value {
    let mut style = Object::new();
    style.perhaps(random, 70, "line_width", |random| width(random, unit));
    style.perhaps(random, 70, "point_size", |random| width(random, unit));
    style.perhaps(random, 30, "color", |random| appearance::color(random, 1.0));
    style.perhaps(random, 50, "hidden", hidden);
    style.into()
}

/// Lines along edges, over a surface or alone.
pub(super) fn edges(random: &mut Rng, unit: f64) -> Value {
    let mut edges = Object::new();
    edges.perhaps(random, 85, "which", |random| match random.u64(0..=4) {
        0 => json!({ "feature": { "angle_deg": short(random.between(0.0, 180.0)) } }),
        kind => ["all", "feature", "boundary", "silhouette"][kind as usize - 1].into(),
    });
    edges.perhaps(random, 60, "color", |random| appearance::color(random, 1.0));
    edges.perhaps(random, 30, "opacity", |random| json!(short(random.f64())));
    edges.perhaps(random, 70, "width", |random| width(random, unit));
    edges.perhaps(random, 50, "hidden", hidden);
    edges.perhaps(random, 30, "surface", |random| random.percent(50).into());
    edges.into()
}

fn hidden(random: &mut Rng) -> Value {
    random.choose(&["omit", "dash"]).into()
}

/// Mostly some pixels.
fn width(random: &mut Rng, unit: f64) -> Value {
    if random.percent(80) {
        return json!(short(random.between(0.3, 6.0)));
    }
    format!("{:e}w", short(unit * random.between(0.005, 0.03))).into()
}

/// The names of what explains a scene.
pub(super) fn show(random: &mut Rng) -> Value {
    Show::NAMES.into_iter().filter(|_| random.percent(40)).collect::<Vec<_>>().into()
}
