//! The state that belongs to a device.

use crate::gpu::attachments::Target;
use crate::gpu::draw::meshes::MeshBuffers;
use crate::gpu::draw::upload::Buffers;
use crate::gpu::pipelines::cache::Pipelines;
use crate::gpu::timer::GpuTimer;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;

/// All resources that belong to a device.
#[derive(SystemParam)]
pub(crate) struct GpuState<'w> {
    target: ResMut<'w, Target>,
    meshes: ResMut<'w, MeshBuffers>,
    buffers: ResMut<'w, Buffers>,
    pipelines: ResMut<'w, Pipelines>,
    timer: Option<ResMut<'w, GpuTimer>>,
}

impl GpuState<'_> {
    /// Drops them.
    pub(crate) fn forget(&mut self) {
        *self.target = Target::default();
        *self.meshes = MeshBuffers::default();
        *self.buffers = Buffers::default();
        *self.pipelines = Pipelines::default();
        if let Some(timer) = &mut self.timer {
            timer.forget_device();
        }
    }
}
