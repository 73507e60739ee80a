//! The frame's draws, those that share their state together.

use crate::batch::key::DrawKey;
use crate::geometry::meshes::Form;
use halfway_asset::AssetId;
use halfway_mesh::Mesh;
use std::ops::Range;

/// All that is set before a mesh is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DrawState {
    pub(crate) key: DrawKey,
    pub(crate) mesh: AssetId<Mesh>,
    pub(crate) form: Form,
    /// 0 where each instance names its own.
    pub(crate) record: u32,
    /// The number of its set of images, from 1 on; 0 for none.
    pub(crate) maps: u32,
}

/// One draw command: a range of the mesh's indices, for a range of instances.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct IndexedDraw {
    pub(crate) indices: Range<u32>,
    pub(crate) instances: Range<u32>,
}

/// Draws one after the other that share their state.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DrawGroup {
    pub(crate) state: DrawState,
    draws: Range<usize>,
}

/// What is drawn, in this order.
#[derive(Debug, Default)]
pub(crate) struct Draws {
    groups: Vec<DrawGroup>,
    each: Vec<IndexedDraw>,
}

impl Draws {
    pub(crate) fn clear(&mut self) {
        self.groups.clear();
        self.each.clear();
    }

    pub(crate) fn push(&mut self, state: DrawState, indices: Range<u32>, instances: Range<u32>) {
        self.each.push(IndexedDraw { indices, instances });
        let end = self.each.len();
        match self.groups.last_mut() {
            Some(group) if group.state == state => group.draws.end = end,
            _ => self.groups.push(DrawGroup { state, draws: end - 1..end }),
        }
    }

    pub(crate) fn groups(&self) -> &[DrawGroup] {
        &self.groups
    }

    /// The draws of a group.
    pub(crate) fn of(&self, group: &DrawGroup) -> &[IndexedDraw] {
        self.each.get(group.draws.clone()).unwrap_or_default()
    }

    /// How many commands draw it all.
    pub(crate) fn count(&self) -> usize {
        self.each.len()
    }

    pub(crate) fn triangles(&self) -> u64 {
        let of_draw = |draw: &IndexedDraw| draw.indices.len() as u64 / 3 * draw.instances.len() as u64;
        self.each.iter().map(of_draw).sum()
    }
}
