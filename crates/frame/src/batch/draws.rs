//! The frame's draws, those that share their state together.

use crate::batch::key::DrawKey;
use crate::geometry::meshes::Form;
use crate::phases::PassCounts;
use halfway_asset::AssetId;
use halfway_mesh::Mesh;
use std::ops::Range;

/// All that is set before a mesh is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawState {
    /// The features that the draw uses.
    pub key: DrawKey,
    /// Its mesh.
    pub mesh: AssetId<Mesh>,
    /// The layout of the mesh.
    pub form: Form,
    /// 0 where each instance names its own.
    pub record: u32,
    /// The number of its set of images, from 1 on; 0 for none.
    pub maps: u32,
}

/// One draw command: a range of the mesh's indices, for a range of instances.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IndexedDraw {
    /// The indices of its triangles, among those of the mesh.
    pub indices: Range<u32>,
    /// Its instances, among those of the frame.
    pub instances: Range<u32>,
}

impl IndexedDraw {
    fn triangles(&self) -> u64 {
        self.indices.len() as u64 / 3 * self.instances.len() as u64
    }
}

/// Draws one after the other that share their state.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawGroup {
    /// The state that all of its draws share.
    pub state: DrawState,
    draws: Range<usize>,
}

/// The draws of a frame, in order.
#[derive(Debug, Default)]
pub struct Draws {
    groups: Vec<DrawGroup>,
    each: Vec<IndexedDraw>,
}

impl Draws {
    /// Removes all draws.
    pub fn clear(&mut self) {
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

    /// The groups of draws that share their state, in order.
    pub fn groups(&self) -> &[DrawGroup] {
        &self.groups
    }

    /// The draws of a group.
    pub fn in_group(&self, group: &DrawGroup) -> &[IndexedDraw] {
        self.each.get(group.draws.clone()).unwrap_or_default()
    }

    /// The number of draw commands.
    pub(crate) fn count(&self) -> usize {
        self.each.len()
    }

    pub(crate) fn triangles(&self) -> u64 {
        self.each.iter().map(IndexedDraw::triangles).sum()
    }

    /// The draws and triangles of some groups.
    pub fn counts(&self, groups: &[DrawGroup]) -> PassCounts {
        let draws = || groups.iter().flat_map(|group| self.in_group(group));
        PassCounts { draws: draws().count() as u32, triangles: draws().map(IndexedDraw::triangles).sum() }
    }
}
