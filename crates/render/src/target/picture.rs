//! Pictures read back from the headless target.

use crate::device::gpu::Gpu;
use crate::error::RenderError;
use crate::frame::report::FrameReport;
use crate::target::canvas::{Canvas, CanvasTarget};
use crate::target::format::Picture;
use crate::target::frame::Target;
use bevy_app::App;
use bevy_ecs::prelude::{Resource, World};
use bevy_ecs::schedule::InternedScheduleLabel;
use image::{Rgba, Rgba32FImage, RgbaImage};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// A picture on its way from what has drawn it. Poll it with [`PendingPicture::try_take`] while other frames
/// are drawn, or wait for it with [`PendingPicture::wait`].
pub struct PendingPicture(Pending);

enum Pending {
    /// The GPU copies it.
    Copied(ReadBack),
    /// The CPU has drawn it; until it is taken.
    There(Option<Picture>),
}

impl PendingPicture {
    /// Starts to copy the newest headless picture; later frames do not change what arrives.
    ///
    /// # Errors
    /// [`RenderError::NoPicture`] before the first headless frame or while a window is the target;
    /// [`RenderError::TooLarge`] or [`RenderError::Memory`] where there is no room for the copy.
    pub fn request(world: &World) -> Result<Self, RenderError> {
        if let (Some(gpu), Some(target)) = (world.get_resource::<Gpu>(), world.get_resource::<Target>()) {
            let texture = target.picture().ok_or(RenderError::NoPicture)?;
            return Ok(Self(Pending::Copied(ReadBack::start(gpu, texture)?)));
        }
        let canvas = world.get_resource::<Canvas>().filter(|_| !world.contains_resource::<CanvasTarget>());
        let picture = canvas.ok_or(RenderError::NoPicture)?.picture()?;
        Ok(Self(Pending::There(Some(picture))))
    }

    /// The picture if it has arrived; `None` while it has not, and after it was taken.
    ///
    /// # Errors
    /// [`RenderError::DeviceLost`] or [`RenderError::Device`] when the device was lost or failed on the way.
    pub fn try_take(&mut self) -> Result<Option<Picture>, RenderError> {
        match &mut self.0 {
            Pending::Copied(copy) => copy.try_take(),
            Pending::There(picture) => Ok(picture.take()),
        }
    }

    /// Blocks until the picture has arrived.
    ///
    /// # Errors
    /// [`RenderError::DeviceLost`] or [`RenderError::Device`] when the device was lost or failed on the way;
    /// [`RenderError::NoPicture`] where it was taken.
    pub fn wait(self) -> Result<Picture, RenderError> {
        match self.0 {
            Pending::Copied(copy) => copy.wait(),
            Pending::There(picture) => picture.ok_or(RenderError::NoPicture),
        }
    }
}

/// A texture that is copied into memory.
struct ReadBack {
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
    fn start(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Self, RenderError> {
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
        // The receiver is gone only when nobody wants the picture any more.
        buffer.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
        Ok(Self { gpu: gpu.clone(), buffer, width, height, row_bytes, format, mapped })
    }

    fn try_take(&mut self) -> Result<Option<Picture>, RenderError> {
        self.gpu.poll(wgpu::PollType::Poll)?;
        match self.mapped.try_recv() {
            Ok(Ok(())) => self.read().map(Some),
            Ok(Err(error)) => Err(RenderError::Device(error.to_string())),
            Err(TryRecvError::Empty | TryRecvError::Disconnected) => Ok(None),
        }
    }

    fn wait(self) -> Result<Picture, RenderError> {
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

/// Runs one frame of `app` ([`App::update`]) and waits for its picture: systems run and time passes. [`take_picture`]
/// draws the world as it is. Everything the frame could not do is an error here: the first of
/// [`FrameReport::errors`].
///
/// # Errors
/// The frame's first error, or why its picture could not be read back.
pub fn render_picture(app: &mut App) -> Result<Picture, RenderError> {
    app.update();
    picture_of_frame(app.world())
}

/// Draws the world as it is now and waits for its picture. Only the schedule that draws runs: no `Startup`, no
/// `Update`, and no time passes. That schedule is [`RenderPlugin::schedule`](crate::RenderPlugin::schedule),
/// `PostUpdate` by default, so that transforms are propagated first; systems of the app's own that are in it run, too.
///
/// [`render_picture`] steps the app instead. A scene that is spawned in `Startup` is there after the first step.
///
/// ```
/// use bevy_app::App;
/// use bevy_math::UVec2;
/// use bevy_transform::{TransformPlugin, components::Transform};
/// use halfway_asset::Assets;
/// use halfway_lighting::{Camera, Material};
/// use halfway_mesh::{Mesh, Mesh3d, UvSphere};
/// use halfway_render::{AdapterChoice, Headless, RenderError, RenderPlugin, take_picture};
///
/// # fn main() -> Result<(), RenderError> {
/// let mut app = App::new();
/// app.add_plugins((TransformPlugin, RenderPlugin::default()))
///     .insert_resource(Headless { size: UVec2::new(64, 48), ..Headless::default() })
///     .insert_resource(AdapterChoice::cpu());
/// let world = app.world_mut();
/// world.spawn((Camera::default(), Transform::from_xyz(0.0, 0.0, 4.0)));
/// let sphere = world.resource_mut::<Assets<Mesh>>().add(UvSphere::default());
/// let ball = world.spawn((Mesh3d(sphere), Material::emissive(bevy_color::LinearRgba::RED))).id();
/// let with = take_picture(world)?;
/// world.despawn(ball);
/// let without = take_picture(world)?;
/// assert_ne!(with, without);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// The frame's first error, or why its picture could not be read back; [`RenderError::NoPicture`] in a world without
/// a [`RenderPlugin`](crate::RenderPlugin).
pub fn take_picture(world: &mut World) -> Result<Picture, RenderError> {
    let schedule = world.get_resource::<DrawnIn>().ok_or(RenderError::NoPicture)?.0;
    world.try_run_schedule(schedule).map_err(|_| RenderError::NoPicture)?;
    picture_of_frame(world)
}

/// The schedule that draws a frame.
#[derive(Resource, Clone, Copy)]
pub(crate) struct DrawnIn(pub(crate) InternedScheduleLabel);

fn picture_of_frame(world: &World) -> Result<Picture, RenderError> {
    if let Some(error) = world.get_resource::<FrameReport>().and_then(|report| report.errors.first()) {
        return Err(error.clone());
    }
    PendingPicture::request(world)?.wait()
}
