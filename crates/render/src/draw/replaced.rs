//! What happens when the device is another one.

use crate::device::gpu::Gpu;
use crate::device::gpu_timer::GpuTimer;
use crate::draw::meshes::MeshBuffers;
use crate::draw::upload::Buffers;
use crate::geometry::meshes::Geometries;
use crate::pipelines::cache::Pipelines;
use crate::target::frame::Target;
use bevy_ecs::prelude::*;

/// Forgets all that belongs to a device, once [`Gpu`] is another one: the frame makes it anew from what the App holds.
/// What belongs to a device is held nowhere else, but for a window's surface, which knows its device, and for pictures
/// that are still on their way.
#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn forget(
    gpu: Res<Gpu>,
    mut drawn_on: Local<Option<u64>>,
    mut geometries: ResMut<Geometries>,
    mut target: ResMut<Target>,
    mut meshes: ResMut<MeshBuffers>,
    mut buffers: ResMut<Buffers>,
    mut pipelines: ResMut<Pipelines>,
    timer: Option<ResMut<GpuTimer>>,
) {
    if drawn_on.replace(gpu.id()) == Some(gpu.id()) {
        return;
    }
    // Their triangles have gone to the other device.
    geometries.forget_all();
    *target = Target::default();
    *meshes = MeshBuffers::default();
    *buffers = Buffers::default();
    *pipelines = Pipelines::default();
    if let Some(mut timer) = timer {
        timer.forget_device();
    }
}
