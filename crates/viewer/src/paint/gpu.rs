//! Paints the panels with a graphics card, over the picture of a window.

use std::sync::{Arc, Mutex, PoisonError};

use egui::TextureOptions;
use egui::epaint::ImageDelta;
use egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor};
use halfway::prelude::UVec2;
use halfway::render::{DrawOverWindow, Gpu, wgpu};

use super::{Images, Painted};

/// The pass that paints what the viewer has left for it.
pub(crate) struct PaintPass {
    painted: Arc<Mutex<Painted>>,
    /// For a device that takes the place of a lost one.
    images: Images,
    made: Option<Made>,
}

/// The renderer of one device and format.
struct Made {
    renderer: Renderer,
    key: (u64, wgpu::TextureFormat),
}

impl PaintPass {
    pub(crate) fn new(painted: Arc<Mutex<Painted>>) -> Self {
        Self { painted, images: Images::default(), made: None }
    }
}

impl DrawOverWindow for PaintPass {
    fn draw(&mut self, gpu: &Gpu, picture: &wgpu::TextureView, format: wgpu::TextureFormat, size: UVec2) {
        let mut painted = self.painted.lock().unwrap_or_else(PoisonError::into_inner);
        let key = (gpu.id(), format);
        if self.made.as_ref().is_none_or(|made| made.key != key) {
            let options = RendererOptions { dithering: false, ..RendererOptions::default() };
            let mut renderer = Renderer::new(&gpu.device, format, options);
            for (id, image) in self.images.iter() {
                let whole = ImageDelta::full(image.clone(), TextureOptions::LINEAR);
                renderer.update_texture(&gpu.device, &gpu.queue, id, &whole);
            }
            self.made = Some(Made { renderer, key });
        }
        let Some(Made { renderer, .. }) = &mut self.made else { return };
        let textures = std::mem::take(&mut painted.textures);
        self.images.update(&textures);
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
        self.images.free(&textures);
    }
}

#[cfg(test)]
mod tests {
    use egui::{ClippedPrimitive, Color32, ColorImage, Mesh, Rect, TextureId, pos2};
    use halfway::render::{Adapter, AdapterChoice};

    use super::*;

    const SIZE: UVec2 = UVec2::new(64, 4);

    fn device() -> Gpu {
        match AdapterChoice::gpu().open().unwrap_or_else(|error| panic!("{error}")) {
            Adapter::Gpu(gpu) => gpu,
            Adapter::Cpu(_) => panic!("no driver"),
        }
    }

    /// The first pixel of a picture that the pass has drawn over black.
    fn first_pixel(pass: &mut PaintPass, gpu: &Gpu) -> [u8; 4] {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIZE.x, height: SIZE.y, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        pass.draw(gpu, &view, texture.format(), SIZE);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(4 * SIZE.element_product()),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE.x), rows_per_image: None };
        let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
        gpu.queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |_| ());
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
        let bytes = buffer.get_mapped_range(..).expect("it is mapped");
        [bytes[0], bytes[1], bytes[2], bytes[3]]
    }

    #[test]
    fn another_device_paints_with_the_same_images() {
        let painted = Arc::new(Mutex::new(Painted { scale: 1.0, ..Painted::default() }));
        let image = ColorImage::filled([2, 2], Color32::from_rgb(10, 200, 30));
        {
            let mut painted = painted.lock().unwrap();
            let delta = ImageDelta::full(image, TextureOptions::LINEAR);
            painted.textures.set.insert(TextureId::default(), [delta].into_iter().collect());
            let mut mesh = Mesh::default();
            mesh.add_colored_rect(Rect::from_min_max(pos2(0.0, 0.0), pos2(64.0, 4.0)), Color32::WHITE);
            let primitive = egui::epaint::Primitive::Mesh(mesh);
            painted.primitives = vec![ClippedPrimitive { clip_rect: Rect::EVERYTHING, primitive }];
        }
        let mut pass = PaintPass::new(painted);
        let first = first_pixel(&mut pass, &device());
        assert!(first[1] > 150 && first[0] < 40, "{first:?}");
        // The images came with the first frame only.
        assert_eq!(first_pixel(&mut pass, &device()), first);
    }
}
