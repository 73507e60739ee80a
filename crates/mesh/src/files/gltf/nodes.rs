//! The transforms of nodes, in f64.

use glam::{DMat4, DQuat, DVec3, DVec4};
use gltf::Document;

use super::document::NodeTransform;
use super::fault::{Fault, check_finite};
use crate::animation::{Local, Node};

/// How far the last row of a matrix may be from (0, 0, 0, 1): a few roundings of `f32`, as a product or an inverse of
/// matrices leaves them.
const ROUNDED: f32 = 1e-5;

/// The nodes that something stands at: those of the scene, and the joints of skins with all that is above them.
pub(super) struct Nodes<'a> {
    document: &'a Document,
    transforms: Vec<NodeTransform>,
    /// The parent of each node of the file.
    parents: Vec<Option<usize>>,
    /// The place of each node of the file in `entered`.
    places: Vec<Option<usize>>,
    /// Parents come before their children.
    pub(super) entered: Vec<Node>,
    worlds: Vec<DMat4>,
    /// How many matrices had a last row that was corrected, and the first of them.
    pub(super) mended: Option<(usize, String)>,
}

impl<'a> Nodes<'a> {
    pub(super) fn new(document: &'a Document, transforms: Vec<NodeTransform>) -> Self {
        let count = document.nodes().len();
        let mut parents = vec![None; count];
        for node in document.nodes() {
            node.children().for_each(|child| parents[child.index()] = Some(node.index()));
        }
        let (entered, worlds) = (Vec::new(), Vec::new());
        Self { document, transforms, parents, places: vec![None; count], entered, worlds, mended: None }
    }

    /// Enters a node below another one, which has been entered; returns its place.
    pub(super) fn enter(&mut self, node: usize, parent: Option<usize>) -> Result<usize, Fault> {
        if let Some(place) = self.places[node] {
            return Ok(place);
        }
        let parent = parent.and_then(|parent| self.places[parent]);
        let transform = self.transforms.get(node).copied().unwrap_or_default();
        let local = local(node, &transform, &mut self.mended)?;
        let world = parent.map_or(DMat4::IDENTITY, |parent| self.worlds[parent]) * local.matrix();
        if !world.as_mat4().is_finite() {
            let found = "a transform that leaves the range of f32";
            return Err(Fault::element(format!("nodes[{node}]"), found, "a smaller one is"));
        }
        self.worlds.push(world);
        let name = self.document.as_json().nodes.get(node).and_then(|node| node.name.clone()).unwrap_or_default();
        self.entered.push(Node { name, parent, local, weights: Vec::new() });
        self.places[node] = Some(self.worlds.len() - 1);
        Ok(self.worlds.len() - 1)
    }

    /// Enters a node and all those above it that have not been entered; returns its place.
    pub(super) fn enter_with_parents(&mut self, node: usize) -> Result<usize, Fault> {
        let mut chain = vec![node];
        while let Some(parent) = self.parents[chain[chain.len() - 1]].filter(|parent| self.places[*parent].is_none()) {
            if chain.len() > self.parents.len() {
                let expected = "a tree, in which no node is above itself, is";
                return Err(Fault::element(format!("nodes[{node}]"), "below itself", expected));
            }
            chain.push(parent);
        }
        chain.into_iter().rev().try_fold(0, |_, node| self.enter(node, self.parents[node]))
    }

    /// The place of a node of the file, if it was entered.
    pub(super) fn place(&self, node: usize) -> Option<usize> {
        self.places.get(node).copied().flatten()
    }

    pub(super) fn world(&self, place: usize) -> DMat4 {
        self.worlds[place]
    }

    pub(super) fn set_weights(&mut self, place: usize, weights: Option<&[f32]>) {
        self.entered[place].weights = weights.unwrap_or_default().to_vec();
    }
}

/// The transform of a node. A matrix whose last row is off by rounding is corrected and counted.
fn local(node: usize, transform: &NodeTransform, mended: &mut Option<(usize, String)>) -> Result<Local, Fault> {
    let field = |name: &str| format!("nodes[{node}].{name}");
    if let Some(matrix) = transform.matrix {
        check_finite(&|| field("matrix"), &matrix.map(|x| x as f32))?;
        let mut matrix = DMat4::from_cols_array(&matrix);
        let last_row = matrix.row(3);
        if last_row != DVec4::W {
            let found = format!("last row {:?}", last_row.as_vec4().to_array());
            if (last_row - DVec4::W).abs().max_element() > f64::from(ROUNDED) {
                return Err(Fault::element(field("matrix"), found, "0, 0, 0, 1 is"));
            }
            mended.get_or_insert_with(|| (0, format!("{}: {found}", field("matrix")))).0 += 1;
            for (axis, last) in [0.0, 0.0, 0.0, 1.0].into_iter().enumerate() {
                matrix.col_mut(axis).w = last;
            }
        }
        return Ok(Local::Matrix(matrix));
    }
    let translation = transform.translation.unwrap_or_default();
    let rotation = transform.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let scale = transform.scale.unwrap_or([1.0; 3]);
    check_finite(&|| field("translation"), &translation.map(|x| x as f32))?;
    check_finite(&|| field("rotation"), &rotation.map(|x| x as f32))?;
    check_finite(&|| field("scale"), &scale.map(|x| x as f32))?;
    let quaternion = DQuat::from_array(rotation);
    // Its length is of no account, but written again it has the same digits.
    if quaternion.length() == 0.0 {
        return Err(Fault::element(field("rotation"), format!("{rotation:?}"), "a unit quaternion is"));
    }
    let (translation, scale) = (DVec3::from_array(translation), DVec3::from_array(scale));
    Ok(Local::Parts { translation, rotation: quaternion, scale })
}
