//! The passes of a view on wgpu, a file for each phase. Those from the sky to the App's own share one render pass of
//! wgpu, with its color and its depth; an intensity policy has render passes of its own over the finished picture.

mod blended;
pub(crate) mod encode;
mod groups;
mod opaque;
pub(crate) mod over;
pub(crate) mod policy;
mod sky;

use crate::gpu::draw::meshes::MeshBuffers;
use crate::gpu::draw::upload::Buffers;
use crate::gpu::passes::over::OverPasses;
use crate::gpu::pipelines::cache::Pipelines;
use halfway_frame::batch::batches::Batches;
use halfway_frame::passes::{Passes, Phase};

/// The data of a scene's passes.
pub(crate) struct ScenePasses<'a> {
    pub(crate) list: &'a Passes,
    pub(crate) batches: &'a Batches,
    pub(crate) meshes: &'a MeshBuffers,
    pub(crate) pipelines: &'a Pipelines,
    pub(crate) buffers: &'a Buffers,
    pub(crate) over: Option<&'a OverPasses>,
}

impl ScenePasses<'_> {
    /// Draws all passes, and returns the number of omitted draws.
    pub(crate) fn record(&self, pass: &mut wgpu::RenderPass<'_>) -> u32 {
        let mut left_out = 0;
        for phase in Phase::ALL.into_iter().filter(|&phase| self.list.has(phase)) {
            match phase {
                Phase::Sky => sky::record(pass, self.buffers),
                Phase::Opaque => left_out += opaque::record(pass, self),
                Phase::Blended => left_out += blended::record(pass, self),
                Phase::Over => over::record(pass, self.over),
                // It follows the scene's pass.
                Phase::Policy => {}
            }
        }
        left_out
    }
}
