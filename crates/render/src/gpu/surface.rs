//! A window's surface.

use crate::gpu::device::Gpu;
use bevy_ecs::prelude::Resource;
use bevy_math::UVec2;
use halfway_frame::error::RenderError;

/// A window's surface; while this resource exists it is the target instead of [`Headless`](crate::Headless).
#[derive(Resource)]
pub struct SurfaceTarget {
    surface: wgpu::Surface<'static>,
    /// The number of its device.
    gpu: u64,
    formats: Vec<wgpu::TextureFormat>,
    /// Whether pictures can be copied to it; OpenGL only draws.
    takes_copies: bool,
    config: wgpu::SurfaceConfiguration,
    stale: bool,
    acquired: bool,
}

impl SurfaceTarget {
    /// A target of `size` physical pixels on `surface`, presented without tearing.
    ///
    /// # Errors
    /// [`RenderError::Device`] when the adapter cannot present to the surface, or the [`Gpu`] was made without one.
    pub fn new(gpu: &Gpu, surface: wgpu::Surface<'static>, size: UVec2) -> Result<Self, RenderError> {
        let adapter = gpu.adapter.as_ref().ok_or_else(|| {
            RenderError::Device("a window takes the adapter; expected a `Gpu` of `Gpu::from_existing`".into())
        })?;
        let capabilities = surface.get_capabilities(adapter);
        let config = surface
            .get_default_config(adapter, size.x.max(1), size.y.max(1))
            .ok_or_else(|| RenderError::Device(format!("{} cannot present to this window", gpu.describe())))?;
        let takes_copies = capabilities.usages.contains(wgpu::TextureUsages::COPY_DST);
        let formats = capabilities.formats;
        Ok(Self { surface, gpu: gpu.id(), formats, takes_copies, config, stale: true, acquired: false })
    }

    /// Follows the window to `size` physical pixels; a size of 0 (minimised) is ignored.
    pub fn resize(&mut self, size: UVec2) {
        if size.x > 0 && size.y > 0 && size != self.size() {
            (self.config.width, self.config.height) = (size.x, size.y);
            (self.stale, self.acquired) = (true, false);
        }
    }

    /// Whether the newest frame has acquired a picture of the surface. Without one the frame is skipped without waiting
    /// for the display, so the caller should wait before the next frame.
    pub fn acquired(&self) -> bool {
        self.acquired
    }

    /// In physical pixels.
    pub(crate) fn size(&self) -> UVec2 {
        UVec2::new(self.config.width, self.config.height)
    }

    /// The format of its pictures.
    pub(crate) fn format(&self) -> wgpu::TextureFormat {
        self.config.format
    }

    /// Selects a format with this encoding, if there is one.
    pub(crate) fn pick_format(&mut self, encodes: bool) {
        let format = pick_format(&self.formats, self.config.format, encodes);
        self.stale |= format != self.config.format;
        self.config.format = format;
    }

    pub(crate) fn takes_copies(&self) -> bool {
        self.takes_copies
    }

    /// The same for a picture that others are copied to, where the surface takes copies.
    pub(crate) fn acquire_for_copies(&mut self, gpu: &Gpu) -> Result<Option<wgpu::SurfaceTexture>, Lost> {
        if self.takes_copies && !self.config.usage.contains(wgpu::TextureUsages::COPY_DST) {
            self.config.usage |= wgpu::TextureUsages::COPY_DST;
            self.stale = true;
        }
        self.acquire(gpu)
    }

    /// The next picture of the surface; `None` means skip this frame.
    pub(crate) fn acquire(&mut self, gpu: &Gpu) -> Result<Option<wgpu::SurfaceTexture>, Lost> {
        self.acquired = false;
        // The device may belong to another instance by now.
        if self.gpu != gpu.id() {
            return Err(Lost);
        }
        if std::mem::take(&mut self.stale) {
            self.surface.configure(&gpu.device, &self.config);
        }
        let answer = answer(self.surface.get_current_texture())?;
        self.stale = answer.is_stale;
        let texture = answer.texture;
        self.acquired = texture.is_some();
        Ok(texture)
    }
}

/// The window's surface is lost, or it belongs to another device than the world's [`Gpu`]: the owner of the window
/// should replace its [`SurfaceTarget`] by a new one. Inserted by the frame that detects it.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceLost;

#[derive(Debug)]
pub(crate) struct Lost;

/// The answer of a surface to a frame.
#[derive(Debug)]
struct Answer {
    /// Without one the frame is skipped, and the next one tries again.
    texture: Option<wgpu::SurfaceTexture>,
    /// Whether the surface has to be reconfigured before the next try.
    is_stale: bool,
}

fn answer(current: wgpu::CurrentSurfaceTexture) -> Result<Answer, Lost> {
    use wgpu::CurrentSurfaceTexture as Current;
    let (texture, is_stale) = match current {
        Current::Success(texture) => (Some(texture), false),
        Current::Suboptimal(texture) => (Some(texture), true),
        Current::Outdated => (None, true),
        Current::Lost => return Err(Lost),
        Current::Timeout | Current::Occluded | Current::Validation => (None, false),
    };
    Ok(Answer { texture, is_stale })
}

/// The format among a surface's formats that equals `current` except for the encoding, else another of bytes with this
/// encoding, else the first.
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

#[cfg(test)]
mod tests {
    use super::{answer, pick_format};
    use wgpu::CurrentSurfaceTexture as Current;
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

    // No available driver can be made to time out.
    #[test]
    fn a_surface_without_a_texture_skips_the_frame() {
        for (current, is_stale) in [
            (Current::Timeout, false),
            (Current::Occluded, false),
            (Current::Validation, false),
            (Current::Outdated, true),
        ] {
            let name = format!("{current:?}");
            let answer = answer(current).unwrap_or_else(|_| panic!("{name} is taken as lost"));
            assert!(answer.texture.is_none(), "{name} has a picture");
            assert_eq!(answer.is_stale, is_stale, "{name}: whether it is configured anew");
        }
        assert!(answer(Current::Lost).is_err(), "a lost surface is kept");
    }
}
