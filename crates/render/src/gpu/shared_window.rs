//! Pictures that are copied to a window: those of several cameras that share it, and those that are finished in memory.

use crate::gpu::attachments::Target;
use crate::gpu::device::Gpu;
use crate::gpu::surface::{Lost, SurfaceLost, SurfaceTarget};
use crate::gpu::window_pass::WindowPass;
use crate::views::Views;
use crate::window_picture::FinishedWindow;
use bevy_ecs::prelude::*;
use halfway_frame::error::RenderError;
use halfway_frame::report::FrameReport;
use halfway_frame::times::FrameTimes;
use image::RgbaImage;

/// Puts the cameras' pictures together in the window, or shows the finished picture.
#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn present(
    gpu: Res<Gpu>,
    mut surface: ResMut<SurfaceTarget>,
    views: Res<Views>,
    target: Res<Target>,
    mut finished: ResMut<FinishedWindow>,
    mut times: ResMut<FrameTimes>,
    mut report: ResMut<FrameReport>,
    over: Option<ResMut<WindowPass>>,
    mut between: Local<Option<Between>>,
    mut commands: Commands,
) {
    let picture = finished.picture.take();
    // Without one the frame has errors.
    if finished.is_asked && picture.is_none() {
        return;
    }
    match times.at_display(|| surface.acquire_for_copies(&gpu)) {
        Ok(Some(texture)) => {
            let drawn = (!surface.takes_copies()).then(|| Between::of(&mut between, &gpu, &texture.texture));
            let window = drawn.as_ref().map_or(&texture.texture, |between| &between.texture);
            match picture {
                Some(picture) => report.errors.extend(write(&gpu, picture, window).err()),
                None => copy_together(&gpu, (&views, &target), window),
            }
            if let Some(between) = drawn {
                between.draw(&gpu, &texture.texture);
            }
            if let Some(mut over) = over {
                over.draw(&gpu, &texture.texture);
            }
            times.at_display(|| gpu.queue.present(texture));
        }
        Ok(None) => {}
        Err(Lost) => commands.insert_resource(SurfaceLost),
    }
}

/// A picture of the window's size that takes copies, and draws itself into a window that does not.
pub(crate) struct Between {
    texture: wgpu::Texture,
    blitter: wgpu::util::TextureBlitter,
    gpu: u64,
}

impl Between {
    /// The one that is kept, or another where it does not fit the window.
    fn of<'a>(kept: &'a mut Option<Self>, gpu: &Gpu, window: &wgpu::Texture) -> &'a Self {
        let fits = |between: &Self| {
            let texture = &between.texture;
            between.gpu == gpu.id() && texture.size() == window.size() && texture.format() == window.format()
        };
        kept.take_if(|between| !fits(between));
        kept.get_or_insert_with(|| {
            let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("between"),
                size: window.size(),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: window.format(),
                usage: wgpu::TextureUsages::COPY_DST
                    | wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            let blitter = wgpu::util::TextureBlitter::new(&gpu.device, window.format());
            Self { texture, blitter, gpu: gpu.id() }
        })
    }

    fn draw(&self, gpu: &Gpu, window: &wgpu::Texture) {
        let [from, to] =
            [&self.texture, window].map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default()));
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("window") });
        self.blitter.copy(&gpu.device, &mut encoder, &from, &to);
        gpu.queue.submit([encoder.finish()]);
    }
}

/// Writes a picture's bytes to the window's, of which it has the encoding.
fn write(gpu: &Gpu, mut picture: RgbaImage, window: &wgpu::Texture) -> Result<(), RenderError> {
    match window.format().remove_srgb_suffix() {
        wgpu::TextureFormat::Rgba8Unorm => {}
        wgpu::TextureFormat::Bgra8Unorm => picture.pixels_mut().for_each(|pixel| pixel.0.swap(0, 2)),
        other => {
            let what = "a window of this display cannot show lines, a legend or a background of two colors";
            return Err(RenderError::Device(format!("{what}: its pictures are {other:?}; expected bytes")));
        }
    }
    // The window may have changed its size since the frame began.
    let size = wgpu::Extent3d {
        width: picture.width().min(window.width()),
        height: picture.height().min(window.height()),
        depth_or_array_layers: 1,
    };
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * picture.width()), rows_per_image: None };
    gpu.queue.write_texture(window.as_image_copy(), &picture, layout, size);
    Ok(())
}

/// Copies the pictures of all cameras to the window's.
fn copy_together(gpu: &Gpu, (views, first): (&Views, &Target), window: &wgpu::Texture) {
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("window") });
    // Where no camera draws, it is black.
    let black = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store };
    let view = window.create_view(&wgpu::TextureViewDescriptor::default());
    drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("window"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: black,
        })],
        ..Default::default()
    }));
    for (place, target) in views.targets(first) {
        let Some(picture) = target.picture() else { continue };
        let origin = wgpu::Origin3d { x: place.corner.x, y: place.corner.y, z: 0 };
        let to = wgpu::TexelCopyTextureInfo { origin, ..window.as_image_copy() };
        encoder.copy_texture_to_texture(picture.as_image_copy(), to, picture.size());
    }
    gpu.queue.submit([encoder.finish()]);
}
