//! Skins.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DMat4;
use gltf::Document;

use super::accessor::{self, Accessors};
use super::fault::Fault;
use super::nodes::Nodes;
use crate::animation::Skin;

/// Reads each skin once, when a node first has it.
pub(super) struct Skins<'a> {
    document: &'a Document,
    read: HashMap<usize, Arc<Skin>>,
}

impl<'a> Skins<'a> {
    pub(super) fn new(document: &'a Document) -> Self {
        Self { document, read: HashMap::new() }
    }

    pub(super) fn skin(
        &mut self,
        skin: &gltf::Skin<'a>,
        nodes: &mut Nodes,
        accessors: &mut Accessors<'a>,
    ) -> Result<Arc<Skin>, Fault> {
        if let Some(known) = self.read.get(&skin.index()) {
            return Ok(Arc::clone(known));
        }
        let element = format!("skins[{}]", skin.index());
        let mut joints = Vec::new();
        for joint in skin.joints() {
            joints.push((nodes.enter_with_parents(joint.index())?, DMat4::IDENTITY));
        }
        // Not the accessor of the skin itself, which would borrow it.
        let json = &self.document.as_json().skins[skin.index()];
        let matrices = json.inverse_bind_matrices.and_then(|index| self.document.accessors().nth(index.value()));
        if let Some(matrices) = matrices {
            let matrices = accessors.floats::<16>(&matrices, &accessor::MATRIX)?;
            if matrices.len() < joints.len() {
                let expected = format!("one for each of the {} joints is", joints.len());
                return Err(Fault::element(element, format!("{} inverse bind matrices", matrices.len()), expected));
            }
            for ((_, bind), matrix) in joints.iter_mut().zip(matrices) {
                *bind = DMat4::from_cols_array(&matrix.map(f64::from));
                // The last row of an affine matrix, which roundings may have left.
                for (axis, last) in [0.0, 0.0, 0.0, 1.0].into_iter().enumerate() {
                    bind.col_mut(axis).w = last;
                }
            }
        }
        let skin_of_model = Arc::new(Skin { joints });
        self.read.insert(skin.index(), Arc::clone(&skin_of_model));
        Ok(skin_of_model)
    }
}
