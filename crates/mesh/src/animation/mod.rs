//! Animations of model files: nodes, skins and morph targets that move in time.

mod curve;
mod shape;

use std::sync::Arc;

use glam::{DMat4, DQuat, DVec3, Mat4};

pub(crate) use self::curve::{Curve, Interpolation};
pub(crate) use self::shape::{Influences, MorphTarget, Moved, Shape, corners};
use crate::Mesh;

/// The animations of a model (glTF 2.0 §3.11): its nodes, skins and morph targets, and how they move.
///
/// The parts of the model itself are in the pose that the file gives to its nodes. [`pose`](Self::pose) gives the places and
/// the moved meshes at a time.
///
/// ```
/// use glam::Vec3;
/// use halfway_mesh::{Format, load_bytes};
///
/// // A triangle that goes from x = 0 to x = 8 in 2 seconds.
/// let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let (times, places) = ([0.0, 2.0], [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0]]);
/// let floats = positions.as_flattened().iter().chain(&times).chain(places.as_flattened());
/// let bytes: String = floats.flat_map(|x: &f32| x.to_le_bytes()).map(|byte| format!("%{byte:02x}")).collect();
/// let text = format!(
///     r#"{{"asset": {{"version": "2.0"}}, "nodes": [{{"mesh": 0}}],
///     "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
///     "animations": [{{"name": "away", "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "translation"}}}}],
///         "samplers": [{{"input": 1, "output": 2}}]}}],
///     "accessors": [
///         {{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [1, 1, 0]}},
///         {{"bufferView": 0, "byteOffset": 36, "componentType": 5126, "type": "SCALAR", "count": 2}},
///         {{"bufferView": 0, "byteOffset": 44, "componentType": 5126, "type": "VEC3", "count": 2}}],
///     "bufferViews": [{{"buffer": 0, "byteLength": 68}}],
///     "buffers": [{{"byteLength": 68, "uri": "data:,{bytes}"}}]}}"#
/// );
/// let model = load_bytes(Format::Gltf, text.as_bytes())?;
/// let animations = model.animations.expect("one");
/// assert_eq!((animations.clips()[0].name.as_str(), animations.clips()[0].duration), ("away", 2.0));
/// let pose = animations.pose(0, 0.5);
/// assert_eq!(pose.parts[0].world_from_part.w_axis.truncate(), Vec3::X * 2.0);
/// # Ok::<(), halfway_mesh::LoadError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Animations {
    pub(crate) clips: Vec<Clip>,
    /// Those of the scene, each before what is below it and children in the order of the file; then the others, parents
    /// before their children.
    pub(crate) nodes: Vec<Node>,
    pub(crate) parts: Vec<Placed>,
    pub(crate) lines: Vec<Placed>,
    pub(crate) lights: Vec<Placed>,
    pub(crate) cameras: Vec<Placed>,
    /// The model's origin, from which all places are counted.
    pub(crate) origin: DVec3,
}

/// One of the animations of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    /// Its name in the file; empty where it has none.
    pub name: String,
    /// The time of its last key frame in seconds.
    pub duration: f64,
    pub(crate) channels: Vec<Channel>,
}

/// A number of a node in time.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Channel {
    /// The node, by its place in [`Animations::nodes`].
    pub(crate) node: usize,
    pub(crate) target: Target,
    pub(crate) curve: Curve,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    Translation,
    Rotation,
    Scale,
    /// The weights of morph targets.
    Weights,
}

/// A node, in the pose of the file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Node {
    /// Its name in the file; empty where it has none.
    pub(crate) name: String,
    pub(crate) parent: Option<usize>,
    pub(crate) local: Local,
    /// The weights of the morph targets of its mesh.
    pub(crate) weights: Vec<f32>,
}

/// The matrices of nodes, parents of which come before their children.
pub(crate) fn worlds(nodes: &[Node]) -> Vec<DMat4> {
    let mut worlds: Vec<DMat4> = Vec::with_capacity(nodes.len());
    for node in nodes {
        let parent = node.parent.map_or(DMat4::IDENTITY, |parent| worlds[parent]);
        worlds.push(parent * node.local.matrix());
    }
    worlds
}

/// The transform of a node: to its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Local {
    Matrix(DMat4),
    /// The rotation as the file has it, of any length but 0; a channel's may be 0, and then turns nothing.
    Parts {
        translation: DVec3,
        rotation: DQuat,
        scale: DVec3,
    },
}

impl Local {
    pub(crate) fn matrix(&self) -> DMat4 {
        match *self {
            Self::Matrix(matrix) => matrix,
            Self::Parts { translation, rotation, scale } => {
                DMat4::from_scale_rotation_translation(scale, curve::unit(rotation), translation)
            }
        }
    }

    /// Replaces a part of it; of a matrix, the others are taken out of it.
    fn set(&mut self, target: Target, value: &[f64]) {
        let (mut scale, mut rotation, mut translation) = match *self {
            Self::Parts { translation, rotation, scale } => (scale, rotation, translation),
            Self::Matrix(matrix) => matrix.to_scale_rotation_translation(),
        };
        match (target, value) {
            (Target::Translation, &[x, y, z]) => translation = DVec3::new(x, y, z),
            (Target::Scale, &[x, y, z]) => scale = DVec3::new(x, y, z),
            (Target::Rotation, &[x, y, z, w]) => rotation = DQuat::from_xyzw(x, y, z, w),
            _ => return,
        }
        *self = Self::Parts { translation, rotation, scale };
    }
}

/// The place of a part, of lines, of a light or a camera.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Placed {
    /// The node, by its place in [`Animations::nodes`].
    pub(crate) node: usize,
    pub(crate) node_from_part: DMat4,
    /// The vertices that morph targets or a skin move.
    pub(crate) shape: Option<Arc<Shape>>,
    /// The skin, by which the place of its node does not count.
    pub(crate) skin: Option<Arc<Skin>>,
}

/// The joints of a skin: their nodes, by their places in [`Animations::nodes`], and the inverse bind matrices.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Skin {
    pub(crate) joints: Vec<(usize, DMat4)>,
}

impl Skin {
    /// The matrices that move vertices, of the matrices of nodes; in the world less `origin`.
    pub(crate) fn matrices(&self, world_from_node: impl Fn(usize) -> DMat4, origin: DVec3) -> Vec<DMat4> {
        self.joints.iter().map(|&(node, bind)| less(world_from_node(node) * bind, origin)).collect()
    }
}

/// A transform to the world less the origin.
pub(crate) fn less(mut world: DMat4, origin: DVec3) -> DMat4 {
    world.w_axis -= origin.extend(0.0);
    world
}

/// The moving things of a model at a time; those that do not move in the animation are not listed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// Of [`Model::parts`](crate::Model::parts).
    pub parts: Vec<PosedPart>,
    /// Of [`Model::lines`](crate::Model::lines): their indices and `world_from_part`.
    pub lines: Vec<(usize, Mat4)>,
    /// Of [`Model::lights`](crate::Model::lights): their indices and `world_from_light`.
    pub lights: Vec<(usize, Mat4)>,
    /// Of [`Model::cameras`](crate::Model::cameras): their indices and `world_from_camera`.
    pub cameras: Vec<(usize, Mat4)>,
}

/// A part at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct PosedPart {
    /// Its index in [`Model::parts`](crate::Model::parts).
    pub part: usize,
    /// Its transform, finite and affine.
    pub world_from_part: Mat4,
    /// Its mesh, if a skin or morph targets move its vertices. It [shares its triangles](Mesh::shares_triangles) with that
    /// of the part.
    pub mesh: Option<Mesh>,
}

impl Animations {
    /// The animations of the file, in its order; at least one.
    pub fn clips(&self) -> &[Clip] {
        &self.clips
    }

    /// Whether skins or morph targets move vertices; otherwise whole parts move.
    pub fn moves_vertices(&self) -> bool {
        self.parts.iter().any(|part| part.shape.is_some())
    }

    /// The pose in an animation, by its index in [`clips`](Self::clips), at a time in seconds. Before the first key frame it
    /// is that of the first; after the last one, the animation begins again from time 0. Without such an animation nothing
    /// moves. Anything whose numbers leave the range of f32 at that time is left out.
    pub fn pose(&self, clip: usize, time: f64) -> Pose {
        let Some(clip) = self.clips.get(clip) else { return Pose::default() };
        let time = clip.local_time(time);
        let mut nodes = self.nodes.clone();
        let (mut moves, mut morphs) = (vec![false; nodes.len()], vec![false; nodes.len()]);
        for channel in &clip.channels {
            let value = channel.curve.at(time, channel.target == Target::Rotation);
            if channel.target == Target::Weights {
                nodes[channel.node].weights = value.iter().map(|weight| *weight as f32).collect();
                morphs[channel.node] = true;
            } else {
                nodes[channel.node].local.set(channel.target, &value);
                moves[channel.node] = true;
            }
        }
        for (i, node) in nodes.iter().enumerate() {
            moves[i] |= node.parent.is_some_and(|parent| moves[parent]);
        }
        let worlds = worlds(&nodes);
        let matrix = |placed: &Placed| {
            let matrix = less(worlds[placed.node] * placed.node_from_part, self.origin).as_mat4();
            matrix.is_finite().then_some(matrix)
        };
        let moved = |all: &[Placed]| -> Vec<(usize, Mat4)> {
            let moving = all.iter().enumerate().filter(|(_, placed)| moves[placed.node]);
            moving.filter_map(|(i, placed)| Some((i, matrix(placed)?))).collect()
        };
        let posed = |(part, placed): (usize, &Placed)| {
            let moves_joint = |skin: &Arc<Skin>| skin.joints.iter().any(|&(node, _)| moves[node]);
            let bends = placed.skin.as_ref().is_some_and(moves_joint);
            let morphs = morphs[placed.node] && placed.shape.is_some();
            let goes = placed.skin.is_none() && moves[placed.node];
            if !bends && !morphs && !goes {
                return None;
            }
            let joints = placed.skin.as_ref().map(|skin| skin.matrices(|node| worlds[node], self.origin));
            let mesh = match &placed.shape {
                Some(shape) if bends || morphs => {
                    Some(shape.moved(&nodes[placed.node].weights, joints.as_deref()).mesh(shape)?)
                }
                _ => None,
            };
            let world_from_part = if placed.skin.is_some() { Mat4::IDENTITY } else { matrix(placed)? };
            Some(PosedPart { part, world_from_part, mesh })
        };
        Pose {
            parts: self.parts.iter().enumerate().filter_map(posed).collect(),
            lines: moved(&self.lines),
            lights: moved(&self.lights),
            cameras: moved(&self.cameras),
        }
    }
}

impl Clip {
    /// The time within the animation.
    fn local_time(&self, time: f64) -> f64 {
        if time > self.duration && self.duration > 0.0 { time.rem_euclid(self.duration) } else { time }
    }
}
