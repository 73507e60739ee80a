//! Copies textures into memory.

use crate::gpu::device::Gpu;
use crate::picture::Picture;
use halfway_frame::error::RenderError;
use image::{Rgba, Rgba32FImage, RgbaImage};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// A texture that is copied into memory.
pub(crate) struct ReadBack {
    /// The device that it comes from, which another may have replaced by now.
    gpu: Gpu,
    buffer: wgpu::Buffer,
    width: u32,
    height: u32,
    row_bytes: u32,
    format: wgpu::TextureFormat,
    mapped: Receiver<Result<(), wgpu::BufferAsyncError>>,
}

impl ReadBack {
    pub(crate) fn start(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Self, RenderError> {
        let (width, height, format) = (texture.width(), texture.height(), texture.format());
        let pixel_bytes = format.block_copy_size(None).ok_or(RenderError::NoPicture)?;
        let row_bytes = (width * pixel_bytes).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let size = u64::from(row_bytes) * u64::from(height);
        let limit = gpu.device.limits().max_buffer_size;
        if size > limit {
            return Err(RenderError::TooLarge {
                what: "reading the picture back, in bytes,".into(),
                needed: size,
                limit,
            });
        }
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read-back"),
            size,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("read-back") });
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row_bytes), rows_per_image: None },
            },
            texture.size(),
        );
        gpu.queue.submit([encoder.finish()]);
        let (sender, mapped) = channel();
        // The receiver is dropped only if the picture is no longer wanted.
        buffer.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
        Ok(Self { gpu: gpu.clone(), buffer, width, height, row_bytes, format, mapped })
    }

    pub(crate) fn try_take(&mut self) -> Result<Option<Picture>, RenderError> {
        self.gpu.poll(wgpu::PollType::Poll)?;
        match self.mapped.try_recv() {
            Ok(Ok(())) => self.read().map(Some),
            Ok(Err(error)) => Err(RenderError::Device(error.to_string())),
            Err(TryRecvError::Empty | TryRecvError::Disconnected) => Ok(None),
        }
    }

    pub(crate) fn wait(self) -> Result<Picture, RenderError> {
        let failed = |error: &dyn std::fmt::Display| RenderError::Device(error.to_string());
        self.gpu.poll(wgpu::PollType::wait_indefinitely())?;
        self.mapped.recv().map_err(|error| failed(&error))?.map_err(|error| failed(&error))?;
        self.read()
    }

    fn read(&self) -> Result<Picture, RenderError> {
        let bytes = self.buffer.get_mapped_range(..).map_err(|error| RenderError::Device(error.to_string()))?;
        let rows = bytes.chunks_exact(self.row_bytes as usize);
        let picture = if self.format == wgpu::TextureFormat::Rgba32Float {
            Some(float(self, rows))
        } else {
            let row = self.width as usize * 4;
            let pixels = rows.flat_map(|bytes| &bytes[..row]).copied().collect();
            RgbaImage::from_raw(self.width, self.height, pixels).map(Picture::Byte)
        };
        drop(bytes);
        self.buffer.unmap();
        picture.ok_or_else(|| RenderError::Device("the driver returned a picture of the wrong size".into()))
    }
}

fn float<'a>(pending: &ReadBack, rows: impl Iterator<Item = &'a [u8]>) -> Picture {
    let mut image = Rgba32FImage::new(pending.width, pending.height);
    for (out, bytes) in image.rows_mut().zip(rows) {
        for (pixel, bytes) in out.zip(bytes.chunks_exact(size_of::<[f32; 4]>())) {
            *pixel = Rgba(bytemuck::pod_read_unaligned(bytes));
        }
    }
    Picture::Float(image)
}
