//! Where pictures go: a texture, or a window's surface.

use crate::device::gpu::Gpu;
use crate::error::RenderError;
use crate::frame::report::FrameReport;
use crate::frame::times::FrameTimes;
use crate::view::camera::View;
use bevy_ecs::prelude::*;
use bevy_math::UVec2;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use halfway_lighting::{Blend, Encoding, Samples, Shown};
use halfway_mesh::Mesh3d;

/// The headless target: pictures of this size, to be read back. The default target.
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Resource, Clone, Debug, Default, PartialEq)]
pub struct Headless {
    /// Width and height in pixels, each at least 1. Default 1280 × 720.
    pub size: UVec2,
    /// What a pixel holds. Default [`Pixels::Byte`].
    pub pixels: Pixels,
}

impl Default for Headless {
    fn default() -> Self {
        Self { size: UVec2::new(1280, 720), pixels: Pixels::default() }
    }
}

/// What a pixel of a headless picture holds.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum Pixels {
    /// 8 bits a channel, encoded as the camera says.
    #[default]
    Byte,
    /// Linear I in 32-bit floating point, before the intensity policy. An adapter that cannot blend
    /// or resolve 32-bit floats draws in 16 bits.
    Float,
}

/// A window's surface; while this resource is there it is the target instead of [`Headless`].
#[derive(Resource)]
pub struct SurfaceTarget {
    surface: wgpu::Surface<'static>,
    formats: Vec<wgpu::TextureFormat>,
    config: wgpu::SurfaceConfiguration,
    stale: bool,
    acquired: bool,
    /// It has shown blended objects, and keeps the format that blends them: another one waits for the GPU.
    blends: bool,
}

impl SurfaceTarget {
    /// A target of `size` physical pixels on `surface`, presented without tearing.
    ///
    /// # Errors
    /// [`RenderError::Device`] when the adapter cannot present to the surface.
    pub fn new(gpu: &Gpu, surface: wgpu::Surface<'static>, size: UVec2) -> Result<Self, RenderError> {
        let capabilities = surface.get_capabilities(&gpu.adapter);
        let config = surface
            .get_default_config(&gpu.adapter, size.x.max(1), size.y.max(1))
            .ok_or_else(|| RenderError::Device(format!("{} cannot present to this window", gpu.describe())))?;
        Ok(Self { surface, formats: capabilities.formats, config, stale: true, acquired: false, blends: false })
    }

    /// Follows the window to `size` physical pixels; a size of 0 (minimised) is ignored.
    pub fn resize(&mut self, size: UVec2) {
        if size.x > 0 && size.y > 0 && size != self.size() {
            (self.config.width, self.config.height) = (size.x, size.y);
            (self.stale, self.acquired) = (true, false);
        }
    }

    /// Replaces a lost surface by a new one of the same window.
    pub fn replace(&mut self, surface: wgpu::Surface<'static>) {
        self.surface = surface;
        (self.stale, self.acquired) = (true, false);
    }

    /// Whether the newest frame has a picture of the surface to draw into and present. Where it has
    /// none the frame is skipped without waiting for the display, so whoever asks for frames waits.
    pub fn acquired(&self) -> bool {
        self.acquired
    }

    fn size(&self) -> UVec2 {
        UVec2::new(self.config.width, self.config.height)
    }

    fn pick_format(&mut self, encodes: bool) {
        let format = pick_format(&self.formats, self.config.format, encodes);
        self.stale |= format != self.config.format;
        self.config.format = format;
    }

    /// The next picture of the surface; `None` means skip this frame.
    fn acquire(&mut self, gpu: &Gpu) -> Result<Option<wgpu::SurfaceTexture>, Lost> {
        use wgpu::CurrentSurfaceTexture as Current;
        self.acquired = false;
        if std::mem::take(&mut self.stale) {
            self.surface.configure(&gpu.device, &self.config);
        }
        let texture = match self.surface.get_current_texture() {
            Current::Success(texture) => Some(texture),
            Current::Suboptimal(texture) => {
                self.stale = true;
                Some(texture)
            }
            Current::Outdated => {
                self.stale = true;
                None
            }
            Current::Lost => return Err(Lost),
            Current::Timeout | Current::Occluded | Current::Validation => None,
        };
        self.acquired = texture.is_some();
        Ok(texture)
    }
}

/// The window's surface is gone: whoever owns the window makes a new one and calls
/// [`SurfaceTarget::replace`]. Set by the frame that found out.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceLost;

struct Lost;

/// What the frame draws into.
#[derive(Resource, Default)]
pub(crate) struct Target {
    size: UVec2,
    attachments: Option<Attachments>,
    pub(crate) frame: Option<Frame>,
}

/// The textures of one configuration.
pub(crate) struct Attachments {
    made_for: Made,
    /// The headless picture; a surface brings its own.
    pub(crate) picture: Option<wgpu::Texture>,
    pub(crate) multisampled: Option<wgpu::TextureView>,
    pub(crate) depth: wgpu::TextureView,
}

#[derive(Clone, Copy, PartialEq, Eq)]
struct Made {
    size: UVec2,
    format: wgpu::TextureFormat,
    samples: Samples,
    headless: bool,
}

/// The picture of this frame.
pub(crate) struct Frame {
    pub(crate) format: wgpu::TextureFormat,
    /// The format takes bytes as they are, and the shaders write them encoded as sRGB.
    pub(crate) encoded: bool,
    pub(crate) samples: Samples,
    pub(crate) view: wgpu::TextureView,
    pub(crate) surface: Option<wgpu::SurfaceTexture>,
}

impl Frame {
    /// What the bytes hold; `None` for floating point.
    pub(crate) fn encoding(&self) -> Option<Encoding> {
        let is_srgb = self.encoded || self.format.is_srgb();
        (!is_float(self.format)).then_some(if is_srgb { Encoding::Srgb } else { Encoding::Raw })
    }
}

pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

impl Target {
    pub(crate) fn size(&self) -> UVec2 {
        self.size
    }

    pub(crate) fn attachments(&self) -> Option<&Attachments> {
        self.attachments.as_ref()
    }

    /// The newest headless picture's texture.
    pub(crate) fn picture(&self) -> Option<&wgpu::Texture> {
        self.attachments.as_ref()?.picture.as_ref()
    }
}

/// Learns the size before the view needs it.
pub(crate) fn measure(headless: Res<Headless>, surface: Option<Res<SurfaceTarget>>, mut target: ResMut<Target>) {
    target.size = surface.map_or(headless.size, |surface| surface.size());
}

/// Makes the attachments that the camera and the target ask for, and acquires the surface's picture.
#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn prepare(
    gpu: Res<Gpu>,
    headless: Res<Headless>,
    surface: Option<ResMut<SurfaceTarget>>,
    view: Res<View>,
    blended: Query<Entity, (With<Blend>, With<Mesh3d>)>,
    shown: Shown,
    mut target: ResMut<Target>,
    mut report: ResMut<FrameReport>,
    mut times: ResMut<FrameTimes>,
    mut commands: Commands,
) {
    target.frame = None;
    // The view has said so.
    if target.size.min_element() == 0 {
        return;
    }
    let camera = view.camera.unwrap_or_default();
    let limit = gpu.device.limits().max_texture_dimension_2d;
    if target.size.max_element() > limit {
        let needed = u64::from(target.size.max_element());
        report.errors.push(RenderError::TooLarge {
            what: "the picture's longer side, in pixels,".into(),
            needed,
            limit: limit.into(),
        });
        return;
    }
    // A software adapter decodes and encodes all 16 pixels of a block to write some of them. Blending and resolving need
    // linear values, which only the format gives.
    let may_encode = gpu.is_software() && camera.samples == Samples::One;
    let blends = blended.iter().any(shown.by_entity());
    let format_encodes = |blends: bool| camera.encoding == Encoding::Srgb && (blends || !may_encode);
    let (format, acquired) = match surface {
        None => (headless_format(&gpu, headless.pixels, camera.samples, format_encodes(blends)), None),
        Some(mut surface) => {
            surface.blends |= blends;
            let encodes = format_encodes(surface.blends);
            surface.pick_format(encodes);
            match times.at_display(|| surface.acquire(&gpu)) {
                Ok(Some(texture)) => (surface.config.format, Some(texture)),
                Ok(None) => return,
                Err(Lost) => {
                    commands.insert_resource(SurfaceLost);
                    return;
                }
            }
        }
    };
    let made_for = Made { size: target.size, format, samples: camera.samples, headless: acquired.is_none() };
    if target.attachments.as_ref().is_none_or(|attachments| attachments.made_for != made_for) {
        target.attachments = Some(Attachments::new(&gpu, made_for));
    }
    let texture = acquired.as_ref().map(|acquired| &acquired.texture).or(target.picture());
    let Some(view) = texture.map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default())) else {
        return;
    };
    let encoded = camera.encoding == Encoding::Srgb && !format.is_srgb() && !is_float(format);
    target.frame = Some(Frame { format, encoded, samples: camera.samples, view, surface: acquired });
}

fn headless_format(gpu: &Gpu, pixels: Pixels, samples: Samples, encodes: bool) -> wgpu::TextureFormat {
    match pixels {
        Pixels::Byte if encodes => wgpu::TextureFormat::Rgba8UnormSrgb,
        Pixels::Byte => wgpu::TextureFormat::Rgba8Unorm,
        Pixels::Float if draws_f32(gpu, samples) => wgpu::TextureFormat::Rgba32Float,
        Pixels::Float => wgpu::TextureFormat::Rgba16Float,
    }
}

/// Of a surface's formats the one that is `current` but for the encoding, else another of bytes that encodes as asked, else
/// the first.
fn pick_format(formats: &[wgpu::TextureFormat], current: wgpu::TextureFormat, encodes: bool) -> wgpu::TextureFormat {
    let sibling = if encodes { current.add_srgb_suffix() } else { current.remove_srgb_suffix() };
    let is_sibling = |format: &&wgpu::TextureFormat| **format == sibling;
    let is_like_it = |format: &&wgpu::TextureFormat| {
        let shows_bytes = format.remove_srgb_suffix() == wgpu::TextureFormat::Rgba8Unorm
            || format.remove_srgb_suffix() == wgpu::TextureFormat::Bgra8Unorm;
        shows_bytes && format.is_srgb() == encodes
    };
    let found = formats.iter().find(is_sibling).or_else(|| formats.iter().find(is_like_it)).or(formats.first());
    found.copied().unwrap_or(current)
}

fn is_float(format: wgpu::TextureFormat) -> bool {
    matches!(format, wgpu::TextureFormat::Rgba32Float | wgpu::TextureFormat::Rgba16Float)
}

fn draws_f32(gpu: &Gpu, samples: Samples) -> bool {
    use wgpu::TextureFormatFeatureFlags as Flags;
    let needed = match samples {
        Samples::One => Flags::BLENDABLE,
        Samples::Four => Flags::BLENDABLE | Flags::MULTISAMPLE_X4 | Flags::MULTISAMPLE_RESOLVE,
    };
    let enabled = gpu
        .device
        .features()
        .contains(wgpu::Features::FLOAT32_BLENDABLE | wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);
    enabled && gpu.adapter.get_texture_format_features(wgpu::TextureFormat::Rgba32Float).flags.contains(needed)
}

impl Attachments {
    fn new(gpu: &Gpu, made_for: Made) -> Self {
        let Made { size, format, samples, headless } = made_for;
        let texture = |label, format, sample_count, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let view = |texture: wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        Self {
            made_for,
            picture: headless.then(|| texture("picture", format, 1, attachment | wgpu::TextureUsages::COPY_SRC)),
            multisampled: (samples == Samples::Four).then(|| view(texture("samples", format, 4, attachment))),
            depth: view(texture("depth", DEPTH_FORMAT, samples.count(), attachment)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::pick_format;
    use wgpu::TextureFormat::{Bgra8Unorm, Bgra8UnormSrgb, Rgba8Unorm, Rgba8UnormSrgb, Rgba16Float};

    #[test]
    fn surfaces_change_their_encoding_and_nothing_else() {
        let all = [Rgba8UnormSrgb, Rgba16Float, Bgra8UnormSrgb, Rgba8Unorm, Bgra8Unorm];
        for (current, encodes, expected) in [
            (Bgra8UnormSrgb, true, Bgra8UnormSrgb),
            (Bgra8UnormSrgb, false, Bgra8Unorm),
            (Bgra8Unorm, true, Bgra8UnormSrgb),
            (Rgba8Unorm, false, Rgba8Unorm),
        ] {
            assert_eq!(pick_format(&all, current, encodes), expected, "{current:?}, {encodes}");
        }
        let few = [Rgba16Float, Rgba8UnormSrgb, Bgra8Unorm];
        assert_eq!(pick_format(&few, Rgba8UnormSrgb, false), Bgra8Unorm, "a float is no byte");
        assert_eq!(pick_format(&[Rgba8Unorm], Rgba8Unorm, true), Rgba8Unorm, "nothing encodes");
    }
}
