//! Models that move: the nodes of their file as a tree, what hangs on them, and the animations.

use std::collections::HashMap;

use glam::{DMat4, DQuat, DVec3, Mat4};
use serde_json::{Map, Value, json};

use super::{Document, FLOAT};
use crate::animation::{Animations, Channel, Interpolation, Local, Node, Placed, Target, less, worlds};
use crate::{Model, Part};

/// Whether the model is as it was read, so far as its animations tell where things are.
pub(super) fn fits(animations: &Animations, model: &Model) -> bool {
    let worlds = worlds(&animations.nodes);
    let place = |placed: &Placed| less(worlds[placed.node] * placed.node_from_part, animations.origin).as_mat4();
    let stand = |found: Vec<Mat4>, expected: &[Placed]| {
        found.len() == expected.len() && found.iter().zip(expected).all(|(found, placed)| *found == place(placed))
    };
    let parts = model.parts.iter().map(|part| part.world_from_part).collect();
    let lines = model.lines.iter().map(|lines| lines.world_from_part).collect();
    let lights = model.lights.iter().map(|light| light.world_from_light).collect();
    let cameras = model.cameras.iter().map(|camera| camera.world_from_camera).collect();
    model.origin == animations.origin
        && !animations.moves_vertices()
        && stand(parts, &animations.parts)
        && stand(lines, &animations.lines)
        && stand(lights, &animations.lights)
        && stand(cameras, &animations.cameras)
}

/// The nodes below each node of the animations: first those for what hangs on it, then those of the file, so that parts are
/// read in the order in which they are written.
struct Tree<'a> {
    nodes: &'a [Node],
    below: Vec<Vec<usize>>,
}

impl Document {
    /// A model with its animations.
    pub(super) fn moving(&mut self, animations: &Animations, model: &Model) {
        let nodes = &animations.nodes;
        self.nodes = nodes.iter().map(described).collect();
        let mut tree = Tree { nodes, below: vec![Vec::new(); nodes.len()] };
        for (part, placed) in model.parts.iter().zip(&animations.parts) {
            self.moving_part(&mut tree, part, placed);
        }
        for (part, placed) in model.lines.iter().zip(&animations.lines) {
            let mesh = self.lines(part);
            self.hang(&mut tree, (placed.node, placed.node_from_part), Some(&part.name), ("mesh", mesh));
        }
        // A light and a camera without a name are read with that of their node.
        let named = |name: &str| if name.is_empty() { Some("") } else { None };
        for (light, placed) in model.lights.iter().zip(&animations.lights) {
            let extensions = self.light(light);
            let place = (placed.node, placed.node_from_part);
            self.hang(&mut tree, place, named(&light.name), ("extensions", extensions));
        }
        for (camera, placed) in model.cameras.iter().zip(&animations.cameras) {
            let index = self.camera(camera);
            let place = (placed.node, placed.node_from_part);
            self.hang(&mut tree, place, named(&camera.name), ("camera", index));
        }
        for (i, node) in nodes.iter().enumerate() {
            match node.parent {
                Some(parent) => tree.below[parent].push(i),
                None => self.roots.push(i),
            }
        }
        for (i, below) in tree.below.iter().enumerate().filter(|(_, below)| !below.is_empty()) {
            self.nodes[i]["children"] = json!(below);
        }
        self.clips(animations);
    }

    fn moving_part(&mut self, tree: &mut Tree, part: &Part, placed: &Placed) {
        let (mesh, part_from_mesh) = self.mesh(part);
        let place = (placed.node, placed.node_from_part * part_from_mesh.unwrap_or(DMat4::IDENTITY));
        self.hang(tree, place, Some(&part.name), ("mesh", mesh));
    }

    /// Hangs a thing on a node: by a key of the node itself where it stands at its origin, has its name and is the first,
    /// else by a node below it. A model that is read and written again so has no more nodes than before. Returns the node
    /// that has the key.
    fn hang(
        &mut self,
        tree: &mut Tree,
        (node, node_from_thing): (usize, DMat4),
        name: Option<&str>,
        (key, value): (&str, Value),
    ) -> usize {
        let is_first = tree.below[node].is_empty() && self.nodes[node].get(key).is_none();
        if is_first && node_from_thing == DMat4::IDENTITY && name.is_none_or(|name| name == tree.nodes[node].name) {
            self.nodes[node][key] = value;
            return node;
        }
        let below = self.node(name.unwrap_or_default(), node_from_thing, key, value);
        tree.below[node].push(below);
        below
    }

    fn clips(&mut self, animations: &Animations) {
        // The accessors of times already written, by their bits: channels often share them.
        let mut times = HashMap::new();
        for clip in &animations.clips {
            let (mut channels, mut samplers) = (Vec::new(), Vec::new());
            for channel in &clip.channels {
                let path = match channel.target {
                    Target::Translation => "translation",
                    Target::Rotation => "rotation",
                    Target::Scale => "scale",
                    Target::Weights => "weights",
                };
                channels.push(json!({ "sampler": samplers.len(), "target": { "node": channel.node, "path": path } }));
                samplers.push(self.sampler(channel, &mut times));
            }
            let mut described = json!({ "channels": channels, "samplers": samplers });
            if !clip.name.is_empty() {
                described["name"] = json!(clip.name);
            }
            self.animations.push(described);
        }
    }

    fn sampler(&mut self, channel: &Channel, times: &mut HashMap<Vec<u32>, usize>) -> Value {
        let curve = &channel.curve;
        let bits = curve.times().iter().map(|time| time.to_bits()).collect();
        let input = *times.entry(bits).or_insert_with(|| {
            let accessor = self.numbers("SCALAR", 1, curve.times());
            // The times grow.
            self.accessors[accessor]["min"] = json!(curve.times().first().as_slice());
            self.accessors[accessor]["max"] = json!(curve.times().last().as_slice());
            accessor
        });
        let output = match channel.target {
            Target::Translation | Target::Scale => self.numbers("VEC3", 3, curve.values()),
            Target::Rotation => self.numbers("VEC4", 4, curve.values()),
            Target::Weights => self.numbers("SCALAR", 1, curve.values()),
        };
        let interpolation = match curve.interpolation() {
            Interpolation::Step => "STEP",
            Interpolation::Linear => "LINEAR",
            Interpolation::CubicSpline => "CUBICSPLINE",
        };
        json!({ "input": input, "output": output, "interpolation": interpolation })
    }

    /// An accessor of numbers that are not vertices, so many to an item.
    fn numbers(&mut self, shape: &str, width: usize, numbers: &[f32]) -> usize {
        let bytes = numbers.iter().flat_map(|number| number.to_le_bytes());
        self.accessor(bytes, None, FLOAT, shape, numbers.len() / width)
    }
}

/// A node without what hangs on it. A transform that is none is left out.
fn described(node: &Node) -> Value {
    let mut described = Map::new();
    let mut set = |key: &str, value: Value| {
        described.insert(key.to_owned(), value);
    };
    if !node.name.is_empty() {
        set("name", json!(node.name));
    }
    match node.local {
        Local::Matrix(matrix) => set("matrix", json!(matrix.to_cols_array())),
        Local::Parts { translation, rotation, scale } => {
            if translation != DVec3::ZERO {
                set("translation", json!(translation.to_array()));
            }
            if rotation != DQuat::IDENTITY {
                set("rotation", json!(rotation.to_array()));
            }
            if scale != DVec3::ONE {
                set("scale", json!(scale.to_array()));
            }
        }
    }
    Value::Object(described)
}
