//! A change of drawer: what belonged to the one before is forgotten.

use crate::cpu::canvas::Canvas;
use crate::cpu::device::Cpu;
use crate::cpu::meshes::{self as mesh_pieces, MeshPieces};
#[cfg(feature = "wgpu")]
use crate::gpu::{device::Gpu, state::GpuState};
use bevy_ecs::prelude::*;
use halfway_frame::geometry::meshes::Geometries;
use halfway_frame::geometry::workshop::Workshop;

/// The drawer of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DrawnBy {
    #[cfg(feature = "wgpu")]
    Gpu(u64),
    Cpu,
}

/// Forgets all that belongs to the drawer before, once it is another [`Gpu`](crate::Gpu), or the CPU and no GPU: the
/// frame makes it anew from what the App holds. What belongs to a device is held nowhere else, but for a window's
/// surface, which knows its device, and for pictures that are still on their way.
pub(crate) fn forget(
    cpu: Option<Res<Cpu>>,
    #[cfg(feature = "wgpu")] gpu: Option<Res<Gpu>>,
    #[cfg(feature = "wgpu")] mut on_gpu: GpuState,
    mut drawn_by: Local<Option<DrawnBy>>,
    (mut workshop, mut geometries): (ResMut<Workshop>, ResMut<Geometries>),
    mut pieces: ResMut<MeshPieces>,
    mut canvas: ResMut<Canvas>,
) {
    let draws = cpu.map(|_| DrawnBy::Cpu);
    #[cfg(feature = "wgpu")]
    let draws = gpu.map(|gpu| DrawnBy::Gpu(gpu.id())).or(draws);
    if draws.is_none() || std::mem::replace(&mut *drawn_by, draws) == draws {
        return;
    }
    workshop.cut = if draws == Some(DrawnBy::Cpu) { Some(mesh_pieces::of_levels) } else { None };
    // Their triangles have been taken.
    geometries.forget_all();
    *pieces = MeshPieces::default();
    *canvas = Canvas::default();
    #[cfg(feature = "wgpu")]
    on_gpu.forget();
}
