//! Images of normals on objects.

use fastrand::Rng;
use serde_json::{Value, json};

use super::{IMAGES, Object, short, shorts};
use crate::random::RngExt;

/// `maps` with an image of normals alone, enlarged or reduced, by any filter except the nearest texel: rounding decides
/// which texel is nearest, and in a small highlight the judge cannot tell that from an error.
pub(super) fn maps(random: &mut Rng) -> Value {
    let mut normal = Object::new();
    normal.set("path", IMAGES[8].0.into());
    normal.perhaps(random, 85, "far_normals", |random| random.choose(&["mean", "toksvig", "lean", "lean"]).into());
    // Steeper ones, turned into the surface, or none.
    normal.perhaps(random, 60, "amount", |random| match random.u64(0..=9) {
        0 => json!(0),
        1 => json!(short(random.magnitude(0, 3))),
        _ => json!(short(random.between(-1.0, 1.0))),
    });
    normal.perhaps(random, 70, "scale", |random| {
        let times = random.magnitude(-1, 2);
        shorts([times, times * random.between(-1.5, 1.5)])
    });
    normal.perhaps(random, 40, "rotation_deg", |random| json!(short(random.between(-400.0, 400.0))));
    normal.perhaps(random, 40, "offset", |random| shorts([0; 2].map(|_| random.between(-2.0, 2.0))));
    for key in ["wrap_u", "wrap_v"] {
        normal.perhaps(random, 40, key, |random| random.choose(&["repeat", "mirror", "clamp"]).into());
    }
    for key in ["magnify", "minify"] {
        normal.perhaps(random, 60, key, |random| random.choose(&["bilinear", "b_spline", "catmull_rom"]).into());
    }
    normal.perhaps(random, 90, "levels", |random| random.choose(&LEVELS).into());
    json!({ "normal": Value::from(normal) })
}

const LEVELS: [&str; 10] = [
    "none",
    "nearest",
    "linear",
    "ripmap",
    "summed_areas",
    "anisotropic_2",
    "anisotropic_4",
    "anisotropic_8",
    "anisotropic_16",
    "elliptical",
];
