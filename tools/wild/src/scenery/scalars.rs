//! Numbers on meshes.

use fastrand::Rng;
use halfway::lighting::Choices;
use halfway::scene::ColorMap;
use serde_json::{Value, json};

use super::{Object, appearance, short, shorts};
use crate::random::RngExt;

/// Numbers for an object whose vertices or faces can be counted here: a mesh that is written out, a box, or the model that
/// has some. `None` for others.
pub(super) fn scalars(random: &mut Rng, object: &Value) -> Option<Value> {
    let mut scalars = Object::new();
    let mesh = &object["mesh"];
    let count = |list: &str| mesh["inline"][list].as_array().map_or(0, |numbers| numbers.len() as u64 / 3);
    let (vertices, faces) = match () {
        () if mesh.get("box").is_some() => (0, 12),
        () => (count("positions"), count("indices")),
    };
    if mesh["path"].as_str().is_some_and(|path| path.ends_with("sheet.ply")) {
        scalars.set("property", random.choose(&["heat", "load"]).into());
    } else if vertices > 0 && random.percent(60) {
        scalars.set("at_vertices", numbers(random, vertices));
    } else if faces > 0 {
        scalars.set("on_faces", numbers(random, faces));
    } else {
        return None;
    }
    scalars.perhaps(random, 80, "map", |random| random.choose(ColorMap::CHOICES).key.into());
    scalars.perhaps(random, 40, "range", |random| {
        let low = random.between(-2.0, 1.0);
        shorts([low, low + random.between(0.1, 3.0)])
    });
    scalars.perhaps(random, 30, "missing", |random| appearance::color(random, 1.0));
    scalars.perhaps(random, 30, "isolines", |random| random.u64(0..=12).into());
    Some(scalars.into())
}

fn numbers(random: &mut Rng, count: u64) -> Value {
    let numbers: Vec<Value> = (0..count).map(|_| json!(short(random.between(-1.0, 1.0)))).collect();
    numbers.into()
}
