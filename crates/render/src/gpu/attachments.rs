//! The attachments of a frame: textures, or the picture of a window's surface.

use crate::gpu::device::Gpu;
use crate::gpu::format::{DEPTH_FORMAT, drawn_format, headless_format, is_float};
use crate::gpu::passes::policy::PicturePasses;
use crate::gpu::shaders::picture::PicturePolicyRecord;
use crate::gpu::surface::{Lost, SurfaceLost, SurfaceTarget};
use crate::gpu::texture::TextureTarget;
use crate::headless::Headless;
use crate::picture::Pixels;
use crate::window_picture::FinishedWindow;
use bevy_ecs::prelude::*;
use bevy_math::{URect, UVec2};
use halfway_frame::error::RenderError;
use halfway_frame::report::FrameReport;
use halfway_frame::times::FrameTimes;
use halfway_frame::values::{FrameValues, PixelValues, WaitsForLevels};
use halfway_frame::view::camera::{PictureSize, View};
use halfway_lighting::{AlphaMode, Camera, CameraTurn, Encoding, Load, Samples, SharingCameras, Shown};
use halfway_mesh::Mesh3d;

/// The target of the frame.
#[derive(Resource, Default)]
pub(crate) struct Target {
    attachments: Option<Attachments>,
    /// The camera's policy, if it acts on the finished picture.
    pub(crate) passes: Option<PicturePasses>,
    pub(crate) frame: Option<FramePicture>,
}

/// The textures of one configuration.
pub(crate) struct Attachments {
    made_as: Configuration,
    /// The headless picture; a surface brings its own.
    pub(crate) picture: Option<wgpu::Texture>,
    pub(crate) multisampled: Option<wgpu::TextureView>,
    /// `None` where an engine gives its own.
    depth: Option<wgpu::TextureView>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
struct Configuration {
    size: UVec2,
    format: wgpu::TextureFormat,
    /// The format that the scene is drawn in: the same, unless passes over the finished picture follow.
    drawn: wgpu::TextureFormat,
    samples: Samples,
    headless: bool,
    own_depth: bool,
}

/// The output of the shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ShaderOutput {
    pub(crate) format: wgpu::TextureFormat,
    /// The shaders write sRGB bytes: the target that was given has no sRGB format.
    pub(crate) encoded: bool,
    /// Samples a pixel.
    pub(crate) samples: u32,
}

/// The picture of this frame.
pub(crate) struct FramePicture {
    pub(crate) output: ShaderOutput,
    /// The view that the scene is drawn into.
    pub(crate) view: wgpu::TextureView,
    /// The view that the passes over the finished picture write, where there are any.
    pub(crate) finished: Option<wgpu::TextureView>,
    pub(crate) delivery: Delivery,
    pub(crate) part: FramePart,
}

/// The place of a frame among what its target holds: all of it, but in an engine's texture.
#[derive(Clone, Debug, Default)]
pub(crate) struct FramePart {
    pub(crate) load: Load,
    /// In pixels of the target.
    pub(crate) viewport: Option<URect>,
    /// The engine's depth.
    pub(crate) depth: Option<wgpu::TextureView>,
}

/// The destination of the picture.
#[derive(Debug, PartialEq)]
pub(crate) enum Delivery {
    /// It can be read back.
    Read,
    /// A window shows it.
    Present(wgpu::SurfaceTexture),
    /// An engine draws it, by [`encode_frame`](crate::encode_frame).
    Encode,
}

impl Default for ShaderOutput {
    /// Bytes as they are, one sample a pixel.
    fn default() -> Self {
        Self { format: wgpu::TextureFormat::Rgba8Unorm, encoded: false, samples: 1 }
    }
}

impl ShaderOutput {
    fn values(&self) -> PixelValues {
        match is_float(self.format) {
            true => PixelValues::Floats,
            false if self.encoded || self.format.is_srgb() => PixelValues::Bytes(Encoding::Srgb),
            false => PixelValues::Bytes(Encoding::Raw),
        }
    }
}

impl Target {
    pub(crate) fn attachments(&self) -> Option<&Attachments> {
        self.attachments.as_ref()
    }

    /// The depth of a frame: the engine's, or its own.
    pub(crate) fn depth<'a>(&'a self, frame: &'a FramePicture) -> Option<&'a wgpu::TextureView> {
        frame.part.depth.as_ref().or(self.attachments.as_ref()?.depth.as_ref())
    }

    /// The window's picture, if the frame has one that is not shown yet. The frame is over then.
    pub(crate) fn take_surface_texture(&mut self) -> Option<wgpu::SurfaceTexture> {
        match self.frame.take_if(|frame| frame.delivery != Delivery::Encode)?.delivery {
            Delivery::Present(texture) => Some(texture),
            Delivery::Read | Delivery::Encode => None,
        }
    }

    /// The newest headless picture's texture.
    pub(crate) fn picture(&self) -> Option<&wgpu::Texture> {
        self.attachments.as_ref()?.picture.as_ref()
    }
}

/// Replaces the size that the CPU or a headless picture has by that of a window's surface or an engine's texture.
pub(crate) fn measure(
    surface: Option<Res<SurfaceTarget>>,
    texture: Option<Res<TextureTarget>>,
    mut size: ResMut<PictureSize>,
    mut waits: ResMut<WaitsForLevels>,
) {
    if let Some(own) = texture.map(|texture| texture.drawn_size()).or(surface.map(|surface| surface.size())) {
        size.0 = own;
        waits.0 = false;
    }
}

/// Makes the attachments that the camera and the target ask for, and acquires the surface's picture.
#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn prepare(
    gpu: Res<Gpu>,
    headless: Res<Headless>,
    surface: Option<ResMut<SurfaceTarget>>,
    texture: Option<Res<TextureTarget>>,
    (turn, sharing): (Res<CameraTurn>, SharingCameras),
    finished: Res<FinishedWindow>,
    view: Res<View>,
    size: Res<PictureSize>,
    alphas: Query<(Entity, &AlphaMode), With<Mesh3d>>,
    shown: Shown,
    mut target: ResMut<Target>,
    mut values: ResMut<FrameValues>,
    mut report: ResMut<FrameReport>,
    mut times: ResMut<FrameTimes>,
    mut commands: Commands,
) {
    target.frame = None;
    // The view has reported it.
    if size.0.min_element() == 0 {
        return;
    }
    let camera = view.camera.unwrap_or_default();
    let (size, part) = match &texture {
        Some(texture) => {
            let TextureTarget { load, viewport, depth, .. } = &**texture;
            (texture.size, FramePart { load: *load, viewport: *viewport, depth: depth.clone() })
        }
        None => (size.0, FramePart::default()),
    };
    let limit = gpu.device.limits().max_texture_dimension_2d;
    if size.max_element() > limit {
        let needed = u64::from(size.max_element());
        report.errors.push(RenderError::TooLarge {
            what: "the picture's longer side, in pixels,".into(),
            needed,
            limit: limit.into(),
        });
        return;
    }
    let is_shown = shown.by_entity();
    let blends = alphas.iter().any(|(entity, alpha)| alpha.blends() && is_shown(entity));
    // Before passes over the finished picture, surfaces are blended and samples averaged elsewhere.
    let pixels = if texture.is_none() && surface.is_none() { headless.pixels } else { Pixels::Byte };
    let drawn = camera.intensity.acts_on_pictures().then(|| drawn_format(&gpu, pixels, camera.samples, blends));
    let drawn = match drawn.transpose() {
        Ok(drawn) => drawn,
        Err(error) => {
            report.errors.push(error);
            return;
        }
    };
    let (samples, blends) = if drawn.is_some() { (Samples::One, false) } else { (camera.samples, blends) };
    // Blending and resolving need linear values, which only the format gives.
    let encodes = camera.encoding == Encoding::Srgb;
    let (format, given, delivery) = match (texture, surface) {
        (Some(texture), _) => {
            let is_shared = !sharing.parts(size.to_array()).is_empty();
            let shared = if is_shared { Err(texture.shared()) } else { Ok(()) };
            if let Err(error) = shared.and_then(|()| texture.check(&gpu, &camera, (samples, blends))) {
                report.errors.push(error);
                return;
            }
            (texture.format, Some(texture.view.clone()), Delivery::Encode)
        }
        (None, None) => match headless_format(&gpu, headless.pixels, samples, blends, encodes) {
            Ok(format) => (format, None, Delivery::Read),
            Err(error) => {
                report.errors.push(error);
                return;
            }
        },
        // It is read back before the window shows it.
        (None, Some(mut surface)) if finished.is_asked => {
            surface.pick_format(encodes);
            let format = if encodes { wgpu::TextureFormat::Rgba8UnormSrgb } else { wgpu::TextureFormat::Rgba8Unorm };
            (format, None, Delivery::Read)
        }
        // Each camera draws into a picture of its own, and all are copied to the window.
        (None, Some(mut surface)) if turn.0.is_some() => {
            surface.pick_format(encodes);
            (surface.format(), None, Delivery::Read)
        }
        (None, Some(mut surface)) => {
            surface.pick_format(encodes);
            match times.at_display(|| surface.acquire(&gpu)) {
                Ok(Some(texture)) => (surface.format(), Some(view_of(&texture.texture)), Delivery::Present(texture)),
                Ok(None) => return,
                Err(Lost) => {
                    commands.insert_resource(SurfaceLost);
                    return;
                }
            }
        }
    };
    let own = (given.is_none(), part.depth.is_none());
    let output = target.attach(&gpu, &camera, size, (format, drawn), own);
    values.0 = Some(output.values().under(camera.intensity));
    let Some(view) = given.or_else(|| target.picture().map(view_of)) else { return };
    report.bytes_uploaded += target.begin(&gpu, &camera, (output, drawn), view, (delivery, part));
    report.picture_passes = target.passes.as_ref().map_or(0, PicturePasses::count);
}

impl Target {
    /// Makes the textures of a configuration, unless they are there; returns what is written into the target.
    fn attach(
        &mut self,
        gpu: &Gpu,
        camera: &Camera,
        size: UVec2,
        (format, drawn): (wgpu::TextureFormat, Option<wgpu::TextureFormat>),
        (headless, own_depth): (bool, bool),
    ) -> ShaderOutput {
        let drawn = drawn.unwrap_or(format);
        let made_as = Configuration { size, format, drawn, samples: camera.samples, headless, own_depth };
        if self.attachments.as_ref().is_none_or(|attachments| attachments.made_as != made_as) {
            self.attachments = Some(Attachments::new(gpu, made_as));
        }
        let encoded = camera.encoding == Encoding::Srgb && !format.is_srgb() && !is_float(format);
        ShaderOutput { format, encoded, samples: camera.samples.count() }
    }

    /// Begins the frame that comes into `view`: by the scene's pass, or by passes over the finished picture, whose
    /// bytes sent are returned.
    fn begin(
        &mut self,
        gpu: &Gpu,
        camera: &Camera,
        (output, drawn): (ShaderOutput, Option<wgpu::TextureFormat>),
        view: wgpu::TextureView,
        (delivery, part): (Delivery, FramePart),
    ) -> u64 {
        let before = self.passes.take();
        let record = PicturePolicyRecord::new(camera.intensity, output.encoded);
        let (Some(drawn), Some(record), Some(attachments)) = (drawn, record, self.attachments()) else {
            self.frame = Some(FramePicture { output, view, finished: None, delivery, part });
            return 0;
        };
        let formats = [drawn, output.format];
        let (passes, sent) = PicturePasses::prepare(before, gpu, attachments.made_as.size, formats, record);
        let output = ShaderOutput { format: drawn, encoded: false, ..output };
        let (drawn, finished) = (passes.drawn().clone(), Some(view));
        self.frame = Some(FramePicture { output, view: drawn, finished, delivery, part });
        self.passes = Some(passes);
        sent
    }
}

fn view_of(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

impl Attachments {
    fn new(gpu: &Gpu, made_as: Configuration) -> Self {
        let Configuration { size, format, drawn, samples, headless, own_depth } = made_as;
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
        let view = |texture: wgpu::Texture| view_of(&texture);
        Self {
            made_as,
            picture: headless.then(|| texture("picture", format, 1, attachment | wgpu::TextureUsages::COPY_SRC)),
            multisampled: (samples == Samples::Four).then(|| view(texture("samples", drawn, 4, attachment))),
            depth: own_depth.then(|| view(texture("depth", DEPTH_FORMAT, samples.count(), attachment))),
        }
    }
}
