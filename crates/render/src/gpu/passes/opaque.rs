//! Opaque objects, sorted by their state and the nearest first.

use crate::gpu::passes::{ScenePasses, groups};
use halfway_frame::passes::Phase;

/// Draws them, and returns the number of omitted draws.
pub(crate) fn record(pass: &mut wgpu::RenderPass<'_>, scene: &ScenePasses<'_>) -> u32 {
    groups::record(pass, scene, Phase::Opaque)
}
