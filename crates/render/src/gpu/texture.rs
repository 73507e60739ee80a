//! A texture of an engine's own.

use crate::gpu::device::Gpu;
use crate::gpu::format::{DEPTH_FORMAT, is_float};
use bevy_ecs::prelude::{Res, ResMut, Resource};
use bevy_math::{URect, UVec2};
use halfway_frame::error::RenderError;
use halfway_frame::report::FrameReport;
use halfway_frame::values::FrameValues;
use halfway_lighting::{Camera, Encoding, Load, Samples};

/// A texture of an engine's own; while this resource is there it is the target, before
/// [`SurfaceTarget`](crate::SurfaceTarget) and [`Headless`](crate::Headless). The render schedule makes the frame
/// ready, and [`encode_frame`](crate::encode_frame) draws it by an encoder of the engine's own.
///
/// ```no_run
/// # use bevy_app::App;
/// # use bevy_math::UVec2;
/// # use halfway_render::{Gpu, RenderError, TextureTarget, encode_frame, wgpu};
/// # type Texture = wgpu::Texture;
/// # fn draw(device: wgpu::Device, queue: wgpu::Queue, texture: &Texture, app: &mut App) -> Result<(), RenderError> {
/// app.insert_resource(Gpu::from_device(device.clone(), queue.clone()));
/// let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
/// let size = UVec2::new(texture.width(), texture.height());
/// app.insert_resource(TextureTarget::new(view, texture.format(), size));
/// app.update();
/// let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
/// encode_frame(app.world(), &mut encoder)?;
/// queue.submit([encoder.finish()]);
/// # Ok(())
/// # }
/// ```
///
/// # In a scene of the engine's own
/// With [`Load::Keep`] and the engine's depth, lit meshes go into a scene that the engine has drawn: its surfaces hide
/// them, and they hide its surfaces.
///
/// ```no_run
/// # use bevy_math::{URect, UVec2};
/// # use halfway_render::{Load, TextureTarget, wgpu};
/// # fn target(color: wgpu::TextureView, depth: wgpu::TextureView) -> TextureTarget {
/// TextureTarget {
///     load: Load::Keep,
///     depth: Some(depth),
///     // The left half.
///     viewport: Some(URect::new(0, 0, 400, 600)),
///     ..TextureTarget::new(color, wgpu::TextureFormat::Rgba8UnormSrgb, UVec2::new(800, 600))
/// }
/// # }
/// ```
///
/// The depth is the one that bevy draws with: reversed, with an infinite far plane. Under a perspective camera a surface
/// at the distance z along the view has the depth near/z, with the distance of the camera's near plane: 1 at that plane,
/// 0 infinitely far away, and the greater depth wins. So the engine has to draw with the same near plane, the comparison
/// `Greater` or `GreaterEqual`, and, where it begins the frame, a depth cleared to 0.
/// [`OverView::clip_from_world`](crate::OverView::clip_from_world) is the matrix to use. An orthographic camera needs its
/// far plane for that: without one, depth spans the visible objects.
///
/// # Several cameras
/// Cameras that share a picture by a [`Viewport`](halfway_lighting::Viewport) do not share a texture: that is
/// [`RenderError::BadTarget`]. Cameras without one draw in turn, each in an update of its own, and the target's `viewport` is
/// the part of each. The first one clears the texture.
///
/// ```no_run
/// # use bevy_app::App;
/// # use bevy_ecs::prelude::Entity;
/// # use bevy_math::URect;
/// # use halfway_lighting::CameraTurn;
/// # use halfway_render::{Gpu, Load, RenderError, TextureTarget, encode_frame, wgpu};
/// # fn draw(app: &mut App, gpu: &Gpu, target: &TextureTarget, cameras: [(Entity, URect); 2]) -> Result<(), RenderError> {
/// for (number, (camera, part)) in cameras.into_iter().enumerate() {
///     let load = if number == 0 { Load::Clear } else { Load::Keep };
///     app.insert_resource(CameraTurn(Some(camera)));
///     app.insert_resource(TextureTarget { viewport: Some(part), load, ..target.clone() });
///     app.update();
///     let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
///     encode_frame(app.world(), &mut encoder)?;
///     gpu.queue.submit([encoder.finish()]);
/// }
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// These do not go together, and are [`RenderError::BadTarget`] with what to change: [`Load::Keep`] and four samples a
/// pixel, since the texture has one; a depth with another number of samples than the camera's; a policy of
/// [`Intensity`](halfway_lighting::Intensity) other than `Clamp`, which passes over the whole picture, and [`Load::Keep`]
/// or a viewport. The CPU draws into no texture.
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
    /// Whether the frame begins with what the texture and the depth hold. Default [`Load::Clear`].
    pub load: Load,
    /// The rectangle that the frame is drawn into, in pixels from the top left, inside of the texture and not empty. Its
    /// shape is the camera's. Default `None`: the whole texture.
    pub viewport: Option<URect>,
    /// The depth of the engine's scene: one level of a texture of the format `Depth32Float`, of the size of the view,
    /// with as many samples a pixel as the camera has, and `wgpu::TextureUsages::RENDER_ATTACHMENT`. It is read, and the
    /// frame's is stored in it. Default `None`: a depth of the frame's own.
    pub depth: Option<wgpu::TextureView>,
}

impl TextureTarget {
    /// The whole view of this format and size in pixels, cleared.
    pub fn new(view: wgpu::TextureView, format: wgpu::TextureFormat, size: UVec2) -> Self {
        Self { view, format, size, load: Load::Clear, viewport: None, depth: None }
    }

    /// Width and height of what is drawn into.
    pub(crate) fn drawn_size(&self) -> UVec2 {
        self.viewport.map_or(self.size, |URect { min, max }| max.saturating_sub(min))
    }
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
    /// The error of several cameras.
    pub(crate) fn shared(&self) -> RenderError {
        let reason = "cameras share the picture by their `Viewport`; expected cameras without one that draw in turn, by \
                      `CameraTurn`, each with the target's `viewport` as its part";
        RenderError::BadTarget { format: format!("{:?}", self.format), reason: reason.into() }
    }

    /// # Errors
    /// [`RenderError::BadTarget`] where a frame cannot be drawn as the camera and the objects ask.
    ///
    /// `samples` are averaged in it, and objects are blended in it where it `blends`: not where a policy follows.
    pub(crate) fn check(
        &self,
        gpu: &Gpu,
        camera: &Camera,
        (samples, blends): (Samples, bool),
    ) -> Result<(), RenderError> {
        let reason = self.misfit().or_else(|| self.missing(gpu, samples, blends));
        let reason = reason.or_else(|| self.clash(camera)).or_else(|| {
            let is_linear = self.format.is_srgb() || is_float(self.format);
            match camera.encoding {
                Encoding::Raw if self.format.is_srgb() => Some("the camera's encoding is raw, and the format's sRGB"),
                Encoding::Srgb if blends && !is_linear => Some("objects are blended, which takes an sRGB format"),
                Encoding::Srgb if samples == Samples::Four && !is_linear => {
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
        if ![Bgra8Unorm, Rgba8Unorm].contains(&self.format.remove_srgb_suffix()) && !is_float(self.format) {
            Some("expected Rgba8Unorm or Bgra8Unorm, either also as sRGB, Rgba16Float or Rgba32Float")
        } else if texture.sample_count() != 1 {
            Some("its texture has more than one sample a pixel")
        } else if !texture.usage().contains(wgpu::TextureUsages::RENDER_ATTACHMENT) {
            Some("its texture lacks the usage RENDER_ATTACHMENT")
        } else if !has_level(texture, self.size) {
            Some("its texture has no level of the target's size")
        } else {
            None
        }
    }

    /// The first of its fields that does not fit the others or the camera.
    fn clash(&self, camera: &Camera) -> Option<&'static str> {
        let is_part = self.viewport.is_some() || self.load == Load::Keep;
        if self.viewport.is_some_and(|viewport| viewport.max.cmpgt(self.size).any()) {
            Some("its viewport reaches beyond its size")
        } else if is_part && camera.intensity.acts_on_pictures() {
            Some(
                "the camera's intensity passes over the whole picture; with `Load::Keep` or a viewport expected \
                 `Intensity::Clamp`",
            )
        } else if self.load == Load::Keep && camera.samples == Samples::Four {
            Some(
                "it keeps what its texture holds, of which there is one sample a pixel, and the camera takes four; \
                 expected `Samples::One` or `Load::Clear`",
            )
        } else {
            self.depth.as_ref().and_then(|depth| self.misfit_of(depth.texture(), camera.samples))
        }
    }

    /// The reason why a texture cannot be its depth.
    fn misfit_of(&self, depth: &wgpu::Texture, samples: Samples) -> Option<&'static str> {
        if depth.format() != DEPTH_FORMAT {
            Some("its depth has another format than Depth32Float")
        } else if depth.sample_count() != samples.count() {
            Some(match samples {
                Samples::One => "its depth has several samples a pixel, and the camera one; expected `Samples::Four`",
                _ => "its depth has one sample a pixel, and the camera four; expected `Samples::One`",
            })
        } else if !depth.usage().contains(wgpu::TextureUsages::RENDER_ATTACHMENT) {
            Some("its depth lacks the usage RENDER_ATTACHMENT")
        } else if !has_level(depth, self.size) {
            Some("its depth has no level of the target's size")
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

fn has_level(texture: &wgpu::Texture, size: UVec2) -> bool {
    (0..texture.mip_level_count()).any(|level| {
        let level = texture.size().mip_level_size(level, wgpu::TextureDimension::D2);
        (level.width, level.height) == (size.x, size.y)
    })
}
