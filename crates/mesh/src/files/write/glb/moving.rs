//! Models that move: the nodes of their file as a tree, what hangs on them, and the animations.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DMat4, DQuat, DVec3, Mat4, Vec3};
use serde_json::{Map, Value, json};

use super::{Document, FLOAT, UNSIGNED_SHORT};
use crate::animation::{
    Animations, Channel, Influences, Interpolation, Local, Node, Placed, Shape, Skin, Target, less, worlds,
};
use crate::{Mesh, Model, Part};

/// Whether the model is as it was read, so far as its animations tell where things are.
pub(super) fn fits(animations: &Animations, model: &Model) -> bool {
    let worlds = worlds(&animations.nodes);
    let has_its_mesh = |(part, placed): (&Part, &Placed)| match &placed.shape {
        Some(shape) => rest(animations, &worlds, (placed, shape)).is_some_and(|mesh| mesh == part.mesh),
        None => true,
    };
    let place = |placed: &Placed| match &placed.skin {
        Some(_) => Mat4::IDENTITY,
        None => less(worlds[placed.node] * placed.node_from_part, animations.origin).as_mat4(),
    };
    let stand = |found: Vec<Mat4>, expected: &[Placed]| {
        found.len() == expected.len() && found.iter().zip(expected).all(|(found, placed)| *found == place(placed))
    };
    let parts = model.parts.iter().map(|part| part.world_from_part).collect();
    let lines = model.lines.iter().map(|lines| lines.world_from_part).collect();
    let lights = model.lights.iter().map(|light| light.world_from_light).collect();
    let cameras = model.cameras.iter().map(|camera| camera.world_from_camera).collect();
    model.origin == animations.origin
        && stand(parts, &animations.parts)
        && stand(lines, &animations.lines)
        && stand(lights, &animations.lights)
        && stand(cameras, &animations.cameras)
        && model.parts.iter().zip(&animations.parts).all(has_its_mesh)
}

/// The mesh of a part in the pose of the file, as it is read.
fn rest(animations: &Animations, worlds: &[DMat4], (placed, shape): (&Placed, &Shape)) -> Option<Mesh> {
    let weights = &animations.nodes[placed.node].weights;
    if placed.skin.is_none() && weights.iter().all(|weight| *weight == 0.0) {
        return Some(shape.mesh.clone());
    }
    let joints = placed.skin.as_ref().map(|skin| skin.matrices(|node| worlds[node], DVec3::ZERO));
    let mut moved = shape.moved(weights, joints.as_deref());
    if placed.skin.is_some() {
        moved.shift(animations.origin);
    }
    moved.mesh(shape)
}

/// The nodes below each node of the animations: first those for what hangs on it, then those of the file, so that parts are
/// read in the order in which they are written.
struct Tree<'a> {
    nodes: &'a [Node],
    below: Vec<Vec<usize>>,
    /// The nodes that have the meshes with morph targets of each node: itself or some below it.
    morphed: Vec<Vec<usize>>,
    /// The skins already written, by their address.
    skins: HashMap<*const Skin, usize>,
}

impl Document {
    /// A model with its animations.
    pub(super) fn moving(&mut self, animations: &Animations, model: &Model) {
        let nodes = &animations.nodes;
        self.nodes = nodes.iter().map(described).collect();
        let lists = || vec![Vec::new(); nodes.len()];
        let mut tree = Tree { nodes, below: lists(), morphed: lists(), skins: HashMap::new() };
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
        self.clips(animations, &tree);
    }

    fn moving_part(&mut self, tree: &mut Tree, part: &Part, placed: &Placed) {
        let (mesh, part_from_mesh) = self.mesh(part, placed.shape.as_deref());
        let place = (placed.node, placed.node_from_part * part_from_mesh.unwrap_or(DMat4::IDENTITY));
        let node = self.hang(tree, place, Some(&part.name), ("mesh", mesh));
        if placed.shape.as_ref().is_some_and(|shape| !shape.targets.is_empty()) {
            tree.morphed[placed.node].push(node);
            let weights = &tree.nodes[placed.node].weights;
            if !weights.is_empty() {
                self.nodes[node]["weights"] = json!(weights);
            }
        }
        if let Some(skin) = &placed.skin {
            let index = *tree.skins.entry(Arc::as_ptr(skin)).or_insert_with(|| self.skin(skin));
            self.nodes[node]["skin"] = json!(index);
        }
    }

    /// Adds a skin; returns its number.
    fn skin(&mut self, skin: &Skin) -> usize {
        let joints: Vec<usize> = skin.joints.iter().map(|(node, _)| *node).collect();
        let matrices: Vec<f32> = skin.joints.iter().flat_map(|(_, bind)| bind.as_mat4().to_cols_array()).collect();
        let matrices = self.numbers("MAT4", 16, &matrices);
        self.skins.push(json!({ "joints": joints, "inverseBindMatrices": matrices }));
        self.skins.len() - 1
    }

    /// The attributes of a mesh whose vertices move, with their joints and weights.
    pub(super) fn attributes_of(&mut self, shape: &Shape) -> Map<String, Value> {
        let mut attributes = self.floats_of(&shape.mesh, shape.has_normals);
        for (set, (joints, weights)) in shape.influences.iter().flat_map(Influences::sets).enumerate() {
            let joints = self.shorts(UNSIGNED_SHORT, "VEC4", joints.into_iter(), false);
            attributes.insert(format!("JOINTS_{set}"), json!(joints));
            attributes.insert(format!("WEIGHTS_{set}"), json!(self.floats("VEC4", weights.into_iter())));
        }
        attributes
    }

    /// The morph targets of a mesh. Lists that belong to none of the mesh are left out.
    pub(super) fn targets(&mut self, shape: &Shape) -> Value {
        let has_tangents = shape.mesh.tangents().is_some();
        let described = shape.targets.iter().map(|target| {
            let mut described = Map::new();
            if !target.positions.is_empty() {
                described.insert("POSITION".to_owned(), json!(self.positions(&target.positions)));
            }
            for (key, list, is_used) in
                [("NORMAL", &target.normals, shape.has_normals), ("TANGENT", &target.tangents, has_tangents)]
            {
                if is_used && !list.is_empty() {
                    let list = self.floats("VEC3", list.iter().map(Vec3::to_array));
                    described.insert(key.to_owned(), json!(list));
                }
            }
            if described.is_empty() {
                // A target has one list at least.
                let zeros = vec![Vec3::ZERO; shape.mesh.positions().len()];
                described.insert("POSITION".to_owned(), json!(self.positions(&zeros)));
            }
            Value::Object(described)
        });
        described.collect()
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

    fn clips(&mut self, animations: &Animations, tree: &Tree) {
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
                let here = [channel.node];
                let nodes = match &tree.morphed[channel.node][..] {
                    morphed @ [_, ..] if channel.target == Target::Weights => morphed,
                    _ => &here,
                };
                for node in nodes {
                    channels.push(json!({ "sampler": samplers.len(), "target": { "node": node, "path": path } }));
                }
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
