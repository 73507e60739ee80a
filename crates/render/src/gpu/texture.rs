//! A texture of an engine's own.

use crate::gpu::device::Gpu;
use crate::gpu::format::is_float;
use bevy_ecs::prelude::{Res, ResMut, Resource};
use bevy_math::UVec2;
use halfway_frame::error::RenderError;
use halfway_frame::report::FrameReport;
use halfway_frame::values::FrameValues;
use halfway_lighting::{Camera, Encoding, Samples};

/// A texture of an engine's own; while this resource is there it is the target, before
/// [`SurfaceTarget`](crate::SurfaceTarget) and [`Headless`](crate::Headless). The render schedule makes the frame
/// ready, and [`encode_frame`](crate::encode_frame) draws it by an encoder of the engine's own.
///
/// ```no_run
/// # use bevy_app::App;
/// # use bevy_math::UVec2;
/// # use halfway_render::{Gpu, RenderError, TextureTarget, encode_frame, wgpu};
/// # struct Engine { instance: wgpu::Instance, adapter: wgpu::Adapter, device: wgpu::Device, queue: wgpu::Queue }
/// # fn draw(engine: Engine, texture: &wgpu::Texture, app: &mut App) -> Result<(), RenderError> {
/// let Engine { instance, adapter, device, queue } = engine;
/// app.insert_resource(Gpu::from_existing(instance, adapter, device.clone(), queue.clone()));
/// app.insert_resource(TextureTarget {
///     view: texture.create_view(&wgpu::TextureViewDescriptor::default()),
///     format: texture.format(),
///     size: UVec2::new(texture.width(), texture.height()),
/// });
/// app.update();
/// let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
/// encode_frame(app.world(), &mut encoder)?;
/// queue.submit([encoder.finish()]);
/// # Ok(())
/// # }
/// ```
#[derive(Resource, Clone, Debug)]
pub struct TextureTarget {
    /// One level of a texture of one sample a pixel, with `wgpu::TextureUsages::RENDER_ATTACHMENT`, of the device of
    /// the world's [`Gpu`].
    pub view: wgpu::TextureView,
    /// The format of the view: `Rgba8Unorm`, `Bgra8Unorm`, either of them as sRGB, `Rgba16Float` or `Rgba32Float`.
    /// Bytes hold what the camera's encoding says, floating point linear I as [`Pixels::Float`](crate::Pixels::Float)
    /// has it. Under
    /// [`Encoding::Srgb`] and [`Intensity::Clamp`](halfway_lighting::Intensity::Clamp) what is blended, or averaged of
    /// four samples, needs an sRGB format or floating point; under
    /// [`Encoding::Raw`] no sRGB format will do.
    pub format: wgpu::TextureFormat,
    /// Width and height of the view in pixels.
    pub size: UVec2,
}

/// Says that the CPU cannot draw into a device's texture, and has it draw nothing.
pub(crate) fn refuse_on_cpu(
    texture: Option<Res<TextureTarget>>,
    mut values: ResMut<FrameValues>,
    mut report: ResMut<FrameReport>,
) {
    if let Some(texture) = texture
        && values.0.take().is_some()
    {
        let reason = "the CPU draws, and the texture is a device's; expected a `Gpu` in the world".into();
        report.errors.push(RenderError::BadTarget { format: format!("{:?}", texture.format), reason });
    }
}

impl TextureTarget {
    /// # Errors
    /// [`RenderError::BadTarget`] where a frame cannot be drawn as the camera and the objects ask.
    pub(crate) fn check(&self, gpu: &Gpu, camera: &Camera, blends: bool) -> Result<(), RenderError> {
        let reason = self.misfit().or_else(|| self.missing(gpu, camera.samples, blends)).or_else(|| {
            let is_linear = self.format.is_srgb() || is_float(self.format);
            match camera.encoding {
                Encoding::Raw if self.format.is_srgb() => Some("the camera's encoding is raw, and the format's sRGB"),
                Encoding::Srgb if blends && !is_linear => Some("objects are blended, which takes an sRGB format"),
                Encoding::Srgb if camera.samples == Samples::Four && !is_linear => {
                    Some("four samples are averaged, which takes an sRGB format")
                }
                _ => None,
            }
        });
        let bad = |reason: &str| RenderError::BadTarget { format: format!("{:?}", self.format), reason: reason.into() };
        reason.map_or(Ok(()), |reason| Err(bad(reason)))
    }

    /// The reason why no frame can be drawn into it.
    fn misfit(&self) -> Option<&'static str> {
        use wgpu::TextureFormat::{Bgra8Unorm, Rgba8Unorm};
        let texture = self.view.texture();
        let has_level = (0..texture.mip_level_count()).any(|level| {
            let size = texture.size().mip_level_size(level, wgpu::TextureDimension::D2);
            (size.width, size.height) == (self.size.x, self.size.y)
        });
        if ![Bgra8Unorm, Rgba8Unorm].contains(&self.format.remove_srgb_suffix()) && !is_float(self.format) {
            Some("expected Rgba8Unorm or Bgra8Unorm, either also as sRGB, Rgba16Float or Rgba32Float")
        } else if texture.sample_count() != 1 {
            Some("its texture has more than one sample a pixel")
        } else if !texture.usage().contains(wgpu::TextureUsages::RENDER_ATTACHMENT) {
            Some("its texture lacks the usage RENDER_ATTACHMENT")
        } else if !has_level {
            Some("its texture has no level of the target's size")
        } else {
            None
        }
    }

    /// The operation that the device cannot do in its format.
    fn missing(&self, gpu: &Gpu, samples: Samples, blends: bool) -> Option<&'static str> {
        use wgpu::TextureFormatFeatureFlags as Flags;
        let features = gpu.format_features(self.format);
        if !features.allowed_usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT) {
            Some("the device cannot draw into it")
        } else if blends && !features.flags.contains(Flags::BLENDABLE) {
            Some("objects are blended, which the device cannot do in it")
        } else if samples == Samples::Four
            && !features.flags.contains(Flags::MULTISAMPLE_X4 | Flags::MULTISAMPLE_RESOLVE)
        {
            Some("the camera takes four samples a pixel, which the device cannot average in it")
        } else {
            None
        }
    }
}
