//! The sub-pixel grid that an adapter snaps vertices to.

use crate::gpu::device::Gpu;
use halfway_frame::error::RenderError;
use std::sync::mpsc;

/// The pixels of the measurement, in a row; fewer bits than this can be measured.
const PIXELS: u32 = 16;
/// Bytes of a row as it is copied to a buffer.
const ROW_BYTES: u32 = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT;

/// A triangle in pixel k, whose left edge lies 0.4/2ᵏ of a pixel to the right of the pixel's centre. It covers the
/// centre only if the edge is snapped to it: by a grid of k bits or fewer, half a step of which is 0.5/2ᵏ.
const TEXT: &str = "
@vertex
fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    let k = i / 3u;
    let x = f32(k) + select(0.5 + 0.4 / f32(1u << k), 1.0, i % 3u == 2u);
    let y = select(select(0.0, 2.0, i % 3u == 1u), -2.0, i % 3u == 0u);
    return vec4f(x / 8.0 - 1.0, y, 0.5, 1.0);
}

@fragment
fn fs() -> @location(0) vec4f {
    return vec4f(1.0);
}
";

impl Gpu {
    /// The bits of the sub-pixel grid that the adapter snaps vertices to, measured by a small drawing. Vulkan
    /// guarantees 4 or more; most adapters have 8.
    ///
    /// # Errors
    /// [`RenderError::Device`] when the device fails.
    pub fn sub_pixel_bits(&self) -> Result<u32, RenderError> {
        let row = self.draw_edges()?;
        let is_covered = |k: &u32| row[4 * *k as usize] > 0;
        Ok((1..PIXELS).find(is_covered).unwrap_or(PIXELS))
    }

    fn draw_edges(&self) -> Result<Vec<u8>, RenderError> {
        let Self { device, queue, .. } = self;
        let format = wgpu::TextureFormat::Rgba8Unorm;
        let size = wgpu::Extent3d { width: PIXELS, height: 1, depth_or_array_layers: 1 };
        let picture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("sub-pixel grid"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("sub-pixel grid"),
            size: ROW_BYTES.into(),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let pipeline = edges_pipeline(device, format);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let view = picture.create_view(&wgpu::TextureViewDescriptor::default());
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            });
            pass.set_pipeline(&pipeline);
            pass.draw(0..3 * PIXELS, 0..1);
        }
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(ROW_BYTES), rows_per_image: Some(1) };
        let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(picture.as_image_copy(), to, size);
        queue.submit([encoder.finish()]);
        let (sender, mapped) = mpsc::channel();
        // The receiver is dropped only after an error.
        buffer.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
        let failed = |error: &dyn std::fmt::Display| RenderError::Device(error.to_string());
        device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| failed(&error))?;
        mapped.recv().map_err(|error| failed(&error))?.map_err(|error| failed(&error))?;
        let row = buffer.get_mapped_range(..).map_err(|error| failed(&error))?.to_vec();
        Ok(row)
    }
}

fn edges_pipeline(device: &wgpu::Device, format: wgpu::TextureFormat) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("sub-pixel grid"),
        source: wgpu::ShaderSource::Wgsl(TEXT.into()),
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("sub-pixel grid"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
