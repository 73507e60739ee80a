//! What happens when something else draws.

use crate::cpu::meshes::{self as mesh_pieces, MeshPieces};
use crate::device::cpu::Cpu;
use crate::device::gpu::Gpu;
use crate::device::gpu_timer::GpuTimer;
use crate::draw::meshes::MeshBuffers;
use crate::draw::upload::Buffers;
use crate::pipelines::cache::Pipelines;
use crate::target::canvas::Canvas;
use crate::target::frame::Target;
use bevy_ecs::prelude::*;
use halfway_frame::geometry::meshes::Geometries;
use halfway_frame::geometry::workshop::Workshop;

/// What has drawn a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DrawnBy {
    Gpu(u64),
    Cpu,
}

/// Forgets all that belongs to what has drawn before, once it is another [`Gpu`], or the CPU and no GPU: the frame
/// makes it anew from what the App holds. What belongs to a device is held nowhere else, but for a window's surface,
/// which knows its device, and for pictures that are still on their way.
#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn forget(
    gpu: Option<Res<Gpu>>,
    cpu: Option<Res<Cpu>>,
    mut drawn_by: Local<Option<DrawnBy>>,
    (mut workshop, mut geometries): (ResMut<Workshop>, ResMut<Geometries>),
    mut target: ResMut<Target>,
    mut meshes: ResMut<MeshBuffers>,
    mut buffers: ResMut<Buffers>,
    mut pipelines: ResMut<Pipelines>,
    mut pieces: ResMut<MeshPieces>,
    mut canvas: ResMut<Canvas>,
    timer: Option<ResMut<GpuTimer>>,
) {
    let draws = gpu.map(|gpu| DrawnBy::Gpu(gpu.id())).or(cpu.map(|_| DrawnBy::Cpu));
    if draws.is_none() || std::mem::replace(&mut *drawn_by, draws) == draws {
        return;
    }
    workshop.cut = if draws == Some(DrawnBy::Cpu) { Some(mesh_pieces::of_levels) } else { None };
    // Their triangles have been taken.
    geometries.forget_all();
    *target = Target::default();
    *meshes = MeshBuffers::default();
    *buffers = Buffers::default();
    *pipelines = Pipelines::default();
    *pieces = MeshPieces::default();
    *canvas = Canvas::default();
    if let Some(mut timer) = timer {
        timer.forget_device();
    }
}
