//! What draws: an adapter and its device, or the CPU.

pub(crate) mod adapter;
pub(crate) mod choice;
pub(crate) mod cpu;
pub(crate) mod gpu;
pub(crate) mod gpu_timer;
mod instance;
mod old_opengl;
pub(crate) mod provoking_vertex;
pub(crate) mod sub_pixel_grid;
