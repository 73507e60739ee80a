//! A change of the adapter: drops all state of the previous one.

use crate::cpu::canvas::Canvas;
use crate::cpu::device::Cpu;
use crate::cpu::meshes::{self as mesh_pieces, MeshPieces};
#[cfg(feature = "wgpu")]
use crate::gpu::{device::Gpu, state::GpuState};
use crate::views::Views;
use bevy_ecs::prelude::*;
use halfway_frame::geometry::meshes::Geometries;
use halfway_frame::geometry::workshop::Workshop;

/// The adapter of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DrawnBy {
    #[cfg(feature = "wgpu")]
    Gpu(u64),
    Cpu,
}

/// Drops all state of the previous adapter, after a change to another [`Gpu`](crate::Gpu) or to the CPU: the frame
/// rebuilds it from the App's data. No other place holds state of a device, except a window's surface, which knows its
/// device, and pending pictures.
pub(crate) fn forget(
    cpu: Option<Res<Cpu>>,
    #[cfg(feature = "wgpu")] gpu: Option<Res<Gpu>>,
    #[cfg(feature = "wgpu")] mut on_gpu: GpuState,
    mut drawn_by: Local<Option<DrawnBy>>,
    (mut workshop, mut geometries): (ResMut<Workshop>, ResMut<Geometries>),
    mut pieces: ResMut<MeshPieces>,
    (mut canvas, mut views): (ResMut<Canvas>, ResMut<Views>),
) {
    let draws = cpu.map(|_| DrawnBy::Cpu);
    #[cfg(feature = "wgpu")]
    let draws = gpu.map(|gpu| DrawnBy::Gpu(gpu.id())).or(draws);
    if draws.is_none() || std::mem::replace(&mut *drawn_by, draws) == draws {
        return;
    }
    workshop.cut = if draws == Some(DrawnBy::Cpu) { Some(mesh_pieces::of_levels) } else { None };
    // Their triangles were moved out.
    geometries.forget_all();
    *pieces = MeshPieces::default();
    *canvas = Canvas::default();
    views.forget();
    #[cfg(feature = "wgpu")]
    on_gpu.forget();
}
