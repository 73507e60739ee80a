//! The window that several cameras share: their pictures are copied to it.

use crate::gpu::attachments::Target;
use crate::gpu::device::Gpu;
use crate::gpu::surface::{Lost, SurfaceLost, SurfaceTarget};
use crate::gpu::window_pass::WindowPass;
use crate::views::Views;
use bevy_ecs::prelude::*;
use halfway_frame::times::FrameTimes;

/// Puts the cameras' pictures together in the window.
pub(crate) fn present(
    gpu: Res<Gpu>,
    mut surface: ResMut<SurfaceTarget>,
    views: Res<Views>,
    target: Res<Target>,
    mut times: ResMut<FrameTimes>,
    over: Option<ResMut<WindowPass>>,
    mut commands: Commands,
) {
    match times.at_display(|| surface.acquire_for_copies(&gpu)) {
        Ok(Some(texture)) => {
            copy_together(&gpu, (&views, &target), &texture.texture);
            if let Some(mut over) = over {
                over.draw(&gpu, &texture.texture);
            }
            times.at_display(|| gpu.queue.present(texture));
        }
        Ok(None) => {}
        Err(Lost) => commands.insert_resource(SurfaceLost),
    }
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
