//! The frame's draws, those that share their state together.

use crate::batch::key::DrawKey;
use crate::geometry::meshes::Form;
use bevy_asset::AssetId;
use bytemuck::{Pod, Zeroable};
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
    /// The first of the lights that are bound at fixed places.
    pub(crate) lights: u32,
    /// The number of its set of images, from 1 on; 0 for none.
    pub(crate) maps: u32,
}

/// One draw, laid out as commands read it from a buffer.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct IndexedDraw {
    pub(crate) index_count: u32,
    pub(crate) instance_count: u32,
    pub(crate) first_index: u32,
    /// Added to each index; always 0.
    base_vertex: i32,
    pub(crate) first_instance: u32,
}

impl IndexedDraw {
    pub(crate) fn indices(&self) -> Range<u32> {
        self.first_index..self.first_index + self.index_count
    }

    pub(crate) fn instances(&self) -> Range<u32> {
        self.first_instance..self.first_instance + self.instance_count
    }
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
    /// A group of this many draws or more is one command that reads them from a buffer.
    multi_draw: Option<u32>,
}

/// How a group is drawn.
pub(crate) enum GroupCommands<'a> {
    /// Draw by draw.
    Each(&'a [IndexedDraw]),
    /// By one command that reads `count` draws, from byte `offset` of their buffer on.
    Multi { offset: u64, count: u32 },
}

impl Draws {
    pub(crate) fn begin(&mut self, multi_draw: Option<u32>) {
        self.clear();
        self.multi_draw = multi_draw;
    }

    /// Whether this number of draws that share their state is one command.
    pub(crate) fn is_one_command(&self, draws: impl FnOnce() -> usize) -> bool {
        self.multi_draw.is_some_and(|from| draws() >= from as usize)
    }

    pub(crate) fn clear(&mut self) {
        self.groups.clear();
        self.each.clear();
    }

    pub(crate) fn push(&mut self, state: DrawState, indices: Range<u32>, instances: Range<u32>) {
        self.each.push(IndexedDraw {
            index_count: indices.end - indices.start,
            instance_count: instances.end - instances.start,
            first_index: indices.start,
            base_vertex: 0,
            first_instance: instances.start,
        });
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

    pub(crate) fn commands(&self, group: &DrawGroup) -> GroupCommands<'_> {
        let Range { start, end } = group.draws;
        if self.is_one_command(|| end - start) {
            let offset = (start * size_of::<IndexedDraw>()) as u64;
            GroupCommands::Multi { offset, count: (end - start) as u32 }
        } else {
            GroupCommands::Each(self.of(group))
        }
    }

    /// How many commands draw it all.
    pub(crate) fn command_count(&self) -> usize {
        let count = |group| match self.commands(group) {
            GroupCommands::Each(draws) => draws.len(),
            GroupCommands::Multi { .. } => 1,
        };
        self.groups.iter().map(count).sum()
    }

    /// What the buffer has to hold that commands read; empty where none does.
    pub(crate) fn read(&self) -> &[IndexedDraw] {
        let is_read = self.groups.iter().any(|group| matches!(self.commands(group), GroupCommands::Multi { .. }));
        if is_read { &self.each } else { &[] }
    }

    pub(crate) fn triangles(&self) -> u64 {
        self.each.iter().map(|draw| u64::from(draw.index_count / 3) * u64::from(draw.instance_count)).sum()
    }
}
