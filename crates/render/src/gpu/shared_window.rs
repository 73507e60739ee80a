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
    mut commands: Commands,
) {
    let picture = finished.picture.take();
    // Without one the frame has errors.
    if finished.is_asked && picture.is_none() {
        return;
    }
    match times.at_display(|| surface.acquire_for_copies(&gpu)) {
        Ok(Some(texture)) => {
            match picture {
                Some(picture) => report.errors.extend(write(&gpu, picture, &texture.texture).err()),
                None => copy_together(&gpu, (&views, &target), &texture.texture),
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
