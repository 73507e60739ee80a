//! The wgpu renderer: devices, targets, shaders, pipelines and passes.

pub(crate) mod attachments;
mod choose;
pub(crate) mod device;
pub(crate) mod draw;
mod format;
mod instance;
mod old_opengl;
pub(crate) mod passes;
pub(crate) mod pipelines;
pub(crate) mod plugin;
mod provoking_vertex;
pub(crate) mod read_back;
mod shaders;
pub(crate) mod shared_window;
pub(crate) mod state;
mod sub_pixel_grid;
pub(crate) mod surface;
pub(crate) mod texture;
pub(crate) mod timer;
pub(crate) mod window_pass;
