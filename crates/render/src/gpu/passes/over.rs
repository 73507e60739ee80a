//! Custom passes of an App, over the scene and before the policy.

use crate::gpu::attachments::Target;
use crate::gpu::device::Gpu;
use crate::gpu::format::DEPTH_FORMAT;
use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_math::{DMat4, Mat4, UVec2};
use halfway_frame::error::RenderError;
use halfway_frame::passes::{PassCounts, Passes, Phase};
use halfway_frame::report::FrameReport;
use halfway_frame::view::camera::{PictureSize, View};
use std::error::Error;

/// A custom pass of an App, which draws over the scene on wgpu: lines, labels, a grid. It shares the scene's
/// attachments, so that the scene hides the parts behind it, and the camera's intensity policy applies to it. Register
/// it with [`AddOverPass::add_over_pass`].
///
/// The CPU does not draw such passes: [`FrameReport::passes_refused`] counts them, and the log names each once.
///
/// ```
/// # use halfway_render::{AddOverPass, OverPass, OverView, PassCounts, RenderPlugin, wgpu};
/// # use bevy_app::App;
/// # use bevy_ecs::prelude::World;
/// # use std::error::Error;
/// /// Draws nothing yet.
/// struct Grid;
///
/// impl OverPass for Grid {
///     fn name(&self) -> &str {
///         "grid"
///     }
///
///     fn prepare(&mut self, _: &OverView, _: &World) -> Result<PassCounts, Box<dyn Error>> {
///         Ok(PassCounts::default())
///     }
///
///     fn draw(&self, _: &mut wgpu::RenderPass<'_>) {}
/// }
///
/// let mut app = App::new();
/// app.add_over_pass(Grid);
/// ```
pub trait OverPass: Send + Sync + 'static {
    /// Its name, for errors and the log.
    fn name(&self) -> &str;

    /// Prepares this frame's draws, before the frame is encoded, and returns their numbers. Without draws,
    /// [`OverPass::draw`] is not called.
    ///
    /// The world is that of the frame, without the passes themselves.
    ///
    /// # Errors
    /// Any: the pass is then left out of the frame, and [`FrameReport::errors`] holds [`RenderError::Pass`] with its
    /// message.
    fn prepare(&mut self, view: &OverView<'_>, world: &World) -> Result<PassCounts, Box<dyn Error>>;

    /// Draws into the scene's pass. Pipelines, bindings and buffers are as the scene left them, so set all that you
    /// use; reset a viewport or a scissor before the end, since other passes follow.
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>);
}

/// The frame that an [`OverPass`] draws over.
pub struct OverView<'a> {
    /// The device that draws the frame.
    pub device: &'a wgpu::Device,
    /// Its queue. Data written to it in [`OverPass::prepare`] is available when the frame is drawn.
    pub queue: &'a wgpu::Queue,
    /// The attachments that pipelines must fit.
    pub target: OverTarget,
    /// World to clip: z/w is the depth, 1 at the near plane and 0 at the far plane or infinitely far away. Rounded to f32 once.
    pub clip_from_world: Mat4,
    /// The camera and its matrices in f64, for scenes far from the origin.
    pub view: &'a View,
    /// Width and height in pixels of the picture, or of the viewport that a [`TextureTarget`](crate::TextureTarget) has.
    pub size: UVec2,
}

/// The attachments of a frame. Pipelines made for an equal value fit: keep it beside pipelines and buffers, and
/// recreate them when it changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OverTarget {
    /// The format of the only color attachment.
    pub format: wgpu::TextureFormat,
    /// The format of the depth, which is reversed: draw where it is `GreaterEqual`.
    pub depth_format: wgpu::TextureFormat,
    /// Samples a pixel.
    pub samples: u32,
    /// Whether shaders write sRGB values themselves. If not, they write linear ones, or what an
    /// [`Encoding::Raw`](halfway_lighting::Encoding::Raw) picture holds.
    pub encoded: bool,
    /// Identifies the device: the number changes when a device is lost or replaced.
    pub device: u64,
}

/// The App's custom passes, in the order in which they were added.
#[derive(Resource, Default)]
pub(crate) struct OverPasses(Vec<Registered>);

struct Registered {
    pass: Box<dyn OverPass>,
    /// Whether it draws in this frame.
    draws: bool,
    /// Whether the log has reported that the CPU does not draw it.
    refused: bool,
}

/// Registers custom passes.
pub trait AddOverPass {
    /// Adds a pass over the scene, after those added earlier. May be called before or after adding the plugins.
    fn add_over_pass(&mut self, pass: impl OverPass) -> &mut Self;
}

impl AddOverPass for App {
    fn add_over_pass(&mut self, pass: impl OverPass) -> &mut Self {
        self.init_resource::<OverPasses>();
        let registered = Registered { pass: Box::new(pass), draws: false, refused: false };
        self.world_mut().resource_mut::<OverPasses>().0.push(registered);
        self
    }
}

/// Prepares the passes, lists their draws, and reports their errors.
pub(crate) fn prepare(world: &mut World) {
    world.resource_scope(|world, mut over: Mut<OverPasses>| {
        let prepared: Vec<_> = over.0.iter_mut().map(|registered| registered.prepare(world)).collect();
        for each in prepared {
            match each {
                Ok(counts) => world.resource_mut::<Passes>().add(Phase::Over, counts),
                Err(error) => world.resource_mut::<FrameReport>().errors.push(error),
            }
        }
        world.resource_scope(|world, passes: Mut<Passes>| passes.report(&mut world.resource_mut::<FrameReport>()));
    });
}

/// Whether the App has custom passes.
pub(crate) fn is_any(over: Option<Res<OverPasses>>) -> bool {
    over.is_some()
}

/// Reports that the CPU draws none of them: in each frame's report, and once for each pass in the log.
pub(crate) fn refuse_on_cpu(mut over: ResMut<OverPasses>, mut report: ResMut<FrameReport>) {
    report.passes_refused = over.0.len() as u32;
    for Registered { pass, refused, .. } in &mut over.0 {
        if !std::mem::replace(refused, true) {
            log::warn!("the pass {} is not drawn: the CPU draws, and passes of an App's own need wgpu", pass.name());
        }
    }
}

/// Draws those that are ready.
pub(crate) fn record(pass: &mut wgpu::RenderPass<'_>, over: Option<&OverPasses>) {
    for registered in over.iter().flat_map(|over| &over.0).filter(|registered| registered.draws) {
        registered.pass.draw(pass);
    }
}

impl Registered {
    fn prepare(&mut self, world: &World) -> Result<PassCounts, RenderError> {
        self.draws = false;
        let Some(view) = OverView::new(world) else { return Ok(PassCounts::default()) };
        let prepared = self.pass.prepare(&view, world);
        let counts = prepared
            .map_err(|error| RenderError::Pass { pass: self.pass.name().to_owned(), reason: error.to_string() })?;
        self.draws = counts.draws > 0;
        Ok(counts)
    }
}

impl<'a> OverView<'a> {
    /// `None` without a frame or a camera.
    fn new(world: &'a World) -> Option<Self> {
        let (gpu, view) = (world.get_resource::<Gpu>()?, world.get_resource::<View>()?);
        let output = world.get_resource::<Target>()?.frame.as_ref()?.output;
        view.camera?;
        let clip_from_eye = clip_from_eye(view);
        Some(Self {
            device: &gpu.device,
            queue: &gpu.queue,
            target: OverTarget {
                format: output.format,
                depth_format: DEPTH_FORMAT,
                samples: output.samples,
                encoded: output.encoded,
                device: gpu.id(),
            },
            clip_from_world: (clip_from_eye * DMat4::from(view.eye_from_world)).as_mat4(),
            view,
            size: world.get_resource::<PictureSize>()?.0,
        })
    }
}

/// Eye to clip, in world units.
fn clip_from_eye(view: &View) -> DMat4 {
    DMat4::from_cols_array_2d(&view.lens.cast().matrix())
}
