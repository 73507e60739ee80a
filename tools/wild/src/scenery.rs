//! Generates scenes over the whole format of scene files; of models three small ones, of images on objects only normal maps.
//!
//! Most values are ordinary, so that most scenes show something; each may be extreme, and any key may be left out.

mod appearance;
mod camera;
mod environment;
mod files;
mod light;
mod lines;
mod mesh;
mod normals;
mod positions;
mod scalars;

use fastrand::Rng;
use serde_json::{Map, Value, json};

use crate::random::{RngExt, for_scene};

pub use files::{IMAGES, MODELS};

/// Scene number `number` of a seed, as the JSON of a scene file: the same one on every machine.
pub fn scene(seed: u64, number: u64) -> Value {
    let random = &mut for_scene(seed, number);
    let unit = positions::unit(random);
    let objects = objects(random, unit);
    let lights = light::lights(random, unit, objects.len());
    let mut scene = Object::new();
    scene.set("size", json!([random.u64(64..=128), random.u64(64..=128)]));
    scene.set("camera", camera::camera(random, unit));
    scene.set("lights", lights);
    scene.set("objects", objects.into());
    scene.perhaps(random, 50, "background", |random| appearance::color(random, 0.3));
    scene.perhaps(random, 50, "output", |random| random.choose(&["srgb", "raw"]).into());
    scene.perhaps(random, 15, "samples", |_| json!(4));
    scene.perhaps(random, 60, "ambient", |random| appearance::color(random, 0.4));
    scene.perhaps(random, 30, "viewer", |random| random.choose(&["local", "infinite"]).into());
    scene.perhaps(random, 80, "shading", appearance::shading);
    scene.perhaps(random, 70, "reflectance", appearance::reflectance);
    scene.perhaps(random, 35, "intensity", appearance::intensity);
    scene.perhaps(random, 20, "environment", environment::environment);
    // Last, so that all other numbers stay the same; not in an environment, in which some adapters do not draw solids
    // and images.
    if !scene.0.contains_key("environment")
        && let Some(Value::Array(objects)) = scene.0.get_mut("objects")
    {
        cut(random, unit, objects);
        turn_normals(random, objects);
    }
    if let Some(Value::Array(objects)) = scene.0.get_mut("objects") {
        for object in objects {
            if random.percent(12) {
                object["shading"] = appearance::terms(random);
            }
        }
    }
    if random.percent(15) {
        scene.set("lights", random.choose(&["studio", "three_point", "headlight"]).into());
    }
    if random.percent(12) {
        put_into_layers(random, &mut scene);
    }
    add_lines(random, unit, &mut scene);
    if !scene.0.contains_key("environment") {
        show_numbers(random, &mut scene);
    }
    if random.percent(15) {
        share_picture(random, unit, &mut scene);
    }
    show_part_of_light(random, &mut scene);
    scene.into()
}

/// Draws one term, or one light, alone.
fn show_part_of_light(random: &mut Rng, scene: &mut Object) {
    scene.perhaps(random, 8, "only", |random| random.choose(&["ambient", "diffuse", "specular", "emission"]).into());
    let lights = scene.0.get("lights").and_then(Value::as_array).map_or(0, Vec::len);
    // Emission belongs to no light.
    if lights > 0 && scene.0.get("only").is_none_or(|only| only != "emission") {
        scene.perhaps(random, 5, "light", |random| json!(random.u64(0..lights as u64)));
    }
}

/// Adds a small model, lines along edges, and lines that explain the scene.
fn add_lines(random: &mut Rng, unit: f64, scene: &mut Object) {
    let has_model = random.percent(30);
    if has_model {
        scene.perhaps(random, 30, "line_style", |random| lines::style(random, unit));
    }
    scene.perhaps(random, 8, "edges", |random| lines::edges(random, unit));
    scene.perhaps(random, 14, "show", lines::show);
    if let Some(Value::Array(objects)) = scene.0.get_mut("objects") {
        if has_model {
            objects.push(lines::model(random, unit));
        }
        for object in objects {
            if random.percent(10) {
                object["edges"] = lines::edges(random, unit);
            }
        }
    }
}

/// Shows numbers on some objects. One at the position of another shows the same.
fn show_numbers(random: &mut Rng, scene: &mut Object) {
    let Some(Value::Array(objects)) = scene.0.get_mut("objects") else { return };
    for at in 0..objects.len() {
        let takes_images = |object: &Value| object.get("maps").is_some() || object.get("solid").is_some();
        let numbers = if is_twin(objects, at) {
            objects[at - 1].get("scalars").cloned()
        } else if random.percent(80) {
            scalars::scalars(random, &objects[at])
        } else {
            None
        };
        let next_takes_images = objects.get(at + 1).is_some_and(|next| is_twin(objects, at + 1) && takes_images(next));
        if let Some(numbers) = numbers.filter(|_| !takes_images(&objects[at]) && !next_takes_images) {
            objects[at]["scalars"] = numbers;
        }
    }
}

/// Adds cameras, and gives each a part of the picture.
fn share_picture(random: &mut Rng, unit: f64, scene: &mut Object) {
    let size = [0, 1].map(|axis| scene.0["size"][axis].as_u64().unwrap_or(1));
    let mut viewports = camera::viewports(random, size).into_iter();
    if let Some(viewport) = viewports.next() {
        scene.0["camera"]["viewport"] = viewport;
    }
    let more = viewports.map(|viewport| {
        let mut camera = camera::camera(random, unit);
        camera["viewport"] = viewport;
        camera
    });
    let more: Vec<Value> = more.collect();
    scene.set("cameras", more.into());
}

/// Puts some objects and lights into layers, and has the camera see some of them.
fn put_into_layers(random: &mut Rng, scene: &mut Object) {
    if let Some(camera) = scene.0.get_mut("camera") {
        camera["layers"] = json!(random.choose(&[&[0][..], &[0, 1], &[0, 1, 31], &[1]]));
    }
    for list in ["objects", "lights"] {
        for item in scene.0.get_mut(list).and_then(Value::as_array_mut).into_iter().flatten() {
            if random.percent(40) {
                item["layers"] = json!(random.choose(&[&[0][..], &[1], &[1, 31], &[0, 2], &[]]));
            }
        }
    }
}

/// Puts normal maps on some objects, most of which are then lit at the pixels. An object at the position of another
/// gets the same map or none; likewise for solids.
fn turn_normals(random: &mut Rng, objects: &mut [Value]) {
    for at in 0..objects.len() {
        if is_twin(objects, at) {
            if let Some(maps) = objects[at - 1].get("maps").filter(|_| has_the_same(at)).cloned() {
                objects[at]["maps"] = maps;
            }
        } else if random.percent(20) {
            objects[at]["maps"] = normals::maps(random);
            if random.percent(70) {
                objects[at]["shading"] = "phong".into();
            }
        }
    }
}

/// Whether an object lies where the one before it does.
fn is_twin(objects: &[Value], at: usize) -> bool {
    at > 0 && ["mesh", "transform"].iter().all(|key| objects[at][key] == objects[at - 1][key])
}

/// Whether an object on top of another gets the same map or solid.
fn has_the_same(at: usize) -> bool {
    at.is_multiple_of(2)
}

/// Cuts some objects from solids. One on top of another is cut from the same or from none.
fn cut(random: &mut Rng, unit: f64, objects: &mut [Value]) {
    for at in 0..objects.len() {
        let solid = if is_twin(objects, at) {
            objects[at - 1].get("solid").filter(|_| has_the_same(at)).cloned()
        } else {
            random.percent(8).then(|| appearance::solid(random, unit))
        };
        if let Some(solid) = solid {
            objects[at]["solid"] = solid;
        }
    }
}

fn objects(random: &mut Rng, unit: f64) -> Vec<Value> {
    let count = match random.u64(0..=99) {
        0..2 => 0,
        2..40 => random.u64(1..=2),
        40..90 => random.u64(2..=6),
        _ => random.u64(6..=12),
    };
    let mut objects: Vec<Value> = Vec::new();
    for i in 0..count {
        // At the position of the one before, or the same shape elsewhere.
        let mut object = match objects.last() {
            Some(last) if random.percent(4) => last.clone(),
            Some(last) if random.percent(10) => {
                json!({"mesh": last["mesh"], "transform": positions::transform(random, unit)})
            }
            _ => object(random, unit),
        };
        object["name"] = format!("o{i}").into();
        objects.push(object);
    }
    objects
}

fn object(random: &mut Rng, unit: f64) -> Value {
    let mut object = Object::new();
    object.set("mesh", mesh::mesh(random, unit));
    object.perhaps(random, 90, "transform", |random| positions::transform(random, unit));
    object.perhaps(random, 24, "normals", |random| {
        let words = ["keep", "face", "uniform", "area", "angle", "max", "auto"];
        if random.percent(80) {
            return random.choose(&words).into();
        }
        json!({ "creased": { "angle_deg": short(random.between(0.0, 90.0)), "weighting": random.choose(&words[2..6]) } })
    });
    if object.0.get("transform").is_none_or(|transform| transform.get("matrix").is_none()) {
        object.perhaps(random, 6, "animation", |random| positions::animation(random, unit));
    }
    object.perhaps(random, 85, "material", appearance::material);
    object.perhaps(random, 15, "back_material", appearance::material);
    object.perhaps(random, 60, "faces", |random| random.choose(&["front", "back", "both", "both"]).into());
    object.perhaps(random, 25, "shading", appearance::shading);
    object.perhaps(random, 25, "reflectance", appearance::reflectance);
    object.perhaps(random, 10, "vertex_colors", |random| random.choose(&["multiply", "ignore"]).into());
    object.perhaps(random, 22, "blend", |_| json!(true));
    object.into()
}

/// A JSON object under construction.
struct Object(Map<String, Value>);

impl Object {
    fn new() -> Self {
        Self(Map::new())
    }

    fn set(&mut self, key: &str, value: Value) {
        self.0.insert(key.into(), value);
    }

    /// Gives the key a value in `percent` of a hundred cases.
    fn perhaps(&mut self, random: &mut Rng, percent: u64, key: &str, value: impl FnOnce(&mut Rng) -> Value) {
        if random.percent(percent) {
            let value = value(random);
            self.set(key, value);
        }
    }
}

impl From<Object> for Value {
    fn from(object: Object) -> Self {
        Self::Object(object.0)
    }
}

/// Four digits, so that files can be read.
fn short(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

fn shorts<const N: usize>(values: [f64; N]) -> Value {
    values.map(short).to_vec().into()
}

#[cfg(test)]
mod tests;
