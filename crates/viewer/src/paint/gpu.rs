//! Paints the panels with a graphics card, over the picture of a window.

use std::sync::{Arc, Mutex, PoisonError};

use egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor};
use halfway::prelude::UVec2;
use halfway::render::{DrawOverWindow, Gpu, wgpu};

use super::Painted;

/// The pass that paints what the viewer has left for it.
pub(crate) struct PaintPass {
    painted: Arc<Mutex<Painted>>,
    made: Option<Made>,
}

/// The renderer of one device and format.
struct Made {
    renderer: Renderer,
    key: (wgpu::Device, wgpu::TextureFormat),
}

impl PaintPass {
    pub(crate) fn new(painted: Arc<Mutex<Painted>>) -> Self {
        Self { painted, made: None }
    }
}

impl DrawOverWindow for PaintPass {
    fn draw(&mut self, gpu: &Gpu, picture: &wgpu::TextureView, format: wgpu::TextureFormat, size: UVec2) {
        let mut painted = self.painted.lock().unwrap_or_else(PoisonError::into_inner);
        let key = (gpu.device.clone(), format);
        if self.made.as_ref().is_none_or(|made| made.key != key) {
            let options = RendererOptions { dithering: false, ..RendererOptions::default() };
            self.made = Some(Made { renderer: Renderer::new(&gpu.device, format, options), key });
        }
        let Some(Made { renderer, .. }) = &mut self.made else { return };
        let textures = std::mem::take(&mut painted.textures);
        for (id, deltas) in &textures.set {
            deltas.iter().for_each(|delta| renderer.update_texture(&gpu.device, &gpu.queue, *id, delta));
        }
        let screen = ScreenDescriptor { size_in_pixels: size.to_array(), pixels_per_point: painted.scale };
        let label = Some("panels");
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
        let before = renderer.update_buffers(&gpu.device, &gpu.queue, &mut encoder, &painted.primitives, &screen);
        {
            let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label,
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: picture,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
                })],
                ..Default::default()
            });
            renderer.render(&mut pass.forget_lifetime(), &painted.primitives, &screen);
        }
        gpu.queue.submit(before.into_iter().chain([encoder.finish()]));
        textures.free.iter().for_each(|id| renderer.free_texture(id));
    }
}
