//! A pass over the finished picture of a window.

use crate::gpu::device::Gpu;
use bevy_ecs::prelude::Resource;
use bevy_math::UVec2;

/// Draws over the finished picture of a window, right before it is presented: panels, handles, text. Unlike an
/// [`OverPass`](crate::OverPass) it knows no depth, and the camera's intensity policy does not act on it. Pictures that
/// are taken do not have it.
#[derive(Resource)]
pub struct WindowPass(pub Box<dyn DrawOverWindow>);

/// The work of a [`WindowPass`].
pub trait DrawOverWindow: Send + Sync + 'static {
    /// Draws over the picture, and submits what it has encoded. The view has the format that is given, and `size` is its
    /// width and height in pixels.
    fn draw(&mut self, gpu: &Gpu, picture: &wgpu::TextureView, format: wgpu::TextureFormat, size: UVec2);
}

impl WindowPass {
    pub(crate) fn draw(&mut self, gpu: &Gpu, window: &wgpu::Texture) {
        let view = window.create_view(&wgpu::TextureViewDescriptor::default());
        self.0.draw(gpu, &view, window.format(), UVec2::new(window.width(), window.height()));
    }
}
