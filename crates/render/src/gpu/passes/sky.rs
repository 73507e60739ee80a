//! The sky: one triangle over the whole picture, behind everything.

use crate::gpu::draw::upload::Buffers;

/// Draws the environment, if its pipeline exists.
pub(crate) fn record(pass: &mut wgpu::RenderPass<'_>, buffers: &Buffers) {
    if let Some((pipeline, surroundings)) = buffers.surroundings.sky() {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(2, surroundings, &[]);
        pass.draw(0..3, 0..1);
    }
}
