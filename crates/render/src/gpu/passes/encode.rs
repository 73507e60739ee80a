//! The sets Draw and Deliver: encodes, submits and presents the passes.

use crate::gpu::attachments::{Delivery, FramePicture, Target};
use crate::gpu::device::Gpu;
use crate::gpu::draw::meshes::MeshBuffers;
use crate::gpu::draw::upload::Buffers;
use crate::gpu::passes::ScenePasses;
use crate::gpu::passes::over::OverPasses;
use crate::gpu::pipelines::cache::Pipelines;
use crate::gpu::timer::GpuTimer;
use crate::gpu::window_pass::WindowPass;
use bevy_color::LinearRgba;
use bevy_ecs::prelude::*;
use bevy_math::URect;
use halfway_frame::batch::batches::Batches;
use halfway_frame::error::RenderError;
use halfway_frame::passes::{Passes, Phase};
use halfway_frame::report::FrameReport;
use halfway_frame::times::FrameTimes;
use halfway_frame::view::camera::View;
use halfway_lighting::{Camera, Encoding, Load};

#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn draw(
    gpu: Res<Gpu>,
    view: Res<View>,
    target: Res<Target>,
    list: Res<Passes>,
    batches: Res<Batches>,
    meshes: Res<MeshBuffers>,
    pipelines: Res<Pipelines>,
    buffers: Res<Buffers>,
    over: Option<Res<OverPasses>>,
    mut timer: Option<ResMut<GpuTimer>>,
    mut report: ResMut<FrameReport>,
) {
    let Some(frame) = &target.frame else { return };
    if frame.delivery == Delivery::Encode {
        return;
    }
    let scene = ScenePasses {
        list: &list,
        batches: &batches,
        meshes: &meshes,
        pipelines: &pipelines,
        buffers: &buffers,
        over: over.as_deref(),
    };
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("frame") });
    {
        let timing = timer.as_mut().and_then(|timer| timer.begin(&gpu));
        let [first, last] = around(timing, frame.finished.is_some());
        let Some(mut pass) = begin(&mut encoder, (&target, frame), view.camera.unwrap_or_default(), first) else {
            return;
        };
        let left_out = scene.record(&mut pass);
        let unexplained = unexplained(left_out, &report);
        report.errors.extend(unexplained);
        drop(pass);
        finish(&mut encoder, (&list, &target), frame, last);
    }
    if let Some(mut timer) = timer {
        timer.end(&mut encoder);
    }
    gpu.queue.submit([encoder.finish()]);
    report.errors.extend(gpu.take_failure());
}

type TimestampWrites<'a> = Option<wgpu::RenderPassTimestampWrites<'a>>;

/// The time stamps that the first pass of a frame writes, and those of the last one if it is another.
fn around(timing: TimestampWrites<'_>, others_follow: bool) -> [TimestampWrites<'_>; 2] {
    match timing {
        Some(both) if others_follow => {
            let first = wgpu::RenderPassTimestampWrites { end_of_pass_write_index: None, ..both.clone() };
            [Some(first), Some(wgpu::RenderPassTimestampWrites { beginning_of_pass_write_index: None, ..both })]
        }
        only => [only, None],
    }
}

/// The passes over the finished picture, if the camera's policy needs any.
fn finish(
    encoder: &mut wgpu::CommandEncoder,
    (list, target): (&Passes, &Target),
    frame: &FramePicture,
    timestamp_writes: TimestampWrites<'_>,
) {
    if let (true, Some(passes), Some(finished)) = (list.has(Phase::Policy), &target.passes, &frame.finished) {
        passes.record(encoder, finished, timestamp_writes);
    }
}

/// Begins the pass of the scene; `None` without attachments.
fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    (target, frame): (&Target, &FramePicture),
    camera: Camera,
    timestamp_writes: TimestampWrites<'_>,
) -> Option<wgpu::RenderPass<'a>> {
    let (attachments, depth) = (target.attachments()?, target.depth(frame)?);
    let LinearRgba { red, green, blue, .. } = camera.background;
    let [r, g, b] = [red, green, blue].map(|linear| {
        let linear = f64::from(linear);
        if frame.output.encoded { Encoding::Srgb.encode(linear.clamp(0.0, 1.0)) } else { linear }
    });
    let clear = wgpu::Color { r, g, b, a: 1.0 };
    let (view, resolve_target, store) = match &attachments.multisampled {
        Some(samples) => (samples, Some(&frame.view), wgpu::StoreOp::Discard),
        None => (&frame.view, None, wgpu::StoreOp::Store),
    };
    let part = &frame.part;
    let keeps = part.load == Load::Keep;
    // Reversed depth: the far end is 0. One of the frame's own begins anew in each, and nobody reads it afterwards.
    let (clear_depth, store_depth) = match &part.depth {
        Some(_) => (!keeps, wgpu::StoreOp::Store),
        None => (true, wgpu::StoreOp::Discard),
    };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("scene"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target,
            ops: wgpu::Operations { load: if keeps { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(clear) }, store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations {
                load: if clear_depth { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load },
                store: store_depth,
            }),
            stencil_ops: None,
        }),
        timestamp_writes,
        ..Default::default()
    });
    if let Some(URect { min, max }) = part.viewport {
        let [width, height] = (max - min).to_array();
        pass.set_viewport(min.x as f32, min.y as f32, width as f32, height as f32, 0.0, 1.0);
        pass.set_scissor_rect(min.x, min.y, width, height);
    }
    Some(pass)
}

/// The error of omitted draws, if no other error explains them.
fn unexplained(draws: u32, report: &FrameReport) -> Option<RenderError> {
    (draws > 0 && report.errors.is_empty()).then_some(RenderError::LeftOut { draws })
}

/// Presents the frame in a window, and polls the device for its loss.
pub(crate) fn present(
    gpu: Res<Gpu>,
    mut target: ResMut<Target>,
    mut times: ResMut<FrameTimes>,
    mut report: ResMut<FrameReport>,
    over: Option<ResMut<WindowPass>>,
) {
    if let Some(surface) = target.take_surface_texture() {
        if let Some(mut over) = over {
            over.draw(&gpu, &surface.texture);
        }
        times.at_display(|| gpu.queue.present(surface));
    }
    // A lost device is the cause of all other errors.
    if let Err(error) = gpu.poll(wgpu::PollType::Poll) {
        report.errors.insert(0, error);
    }
}

/// Draws the frame that the render schedule has prepared for a [`TextureTarget`](crate::TextureTarget) with the
/// engine's encoder, which must come from the device of the world's [`Gpu`]. The pass begins as
/// the target's [`Load`](crate::Load) says.
///
/// The data of the pass is uploaded already: submit the encoder on the queue of that `Gpu`, before the render schedule
/// runs again. Until then a frame can be encoded more than once. [`GpuTimer`] does not time it.
///
/// # Errors
/// [`RenderError::NoFrame`] before the schedule has run with a `TextureTarget`, or the first error of
/// [`FrameReport::errors`] if the frame could not be prepared; [`RenderError::LeftOut`]. With `Ok`, the report lists
/// what was left out of the frame.
pub fn encode_frame(world: &World, encoder: &mut wgpu::CommandEncoder) -> Result<(), RenderError> {
    let ready = || {
        let target = world.get_resource::<Target>()?;
        let frame = target.frame.as_ref().filter(|frame| frame.delivery == Delivery::Encode)?;
        Some((target, frame, world.get_resource::<View>()?.camera.unwrap_or_default()))
    };
    let made = || {
        let (batches, meshes) = (world.get_resource::<Batches>()?, world.get_resource::<MeshBuffers>()?);
        let (pipelines, buffers) = (world.get_resource::<Pipelines>()?, world.get_resource::<Buffers>()?);
        let (list, over) = (world.get_resource::<Passes>()?, world.get_resource::<OverPasses>());
        Some(ScenePasses { list, batches, meshes, pipelines, buffers, over })
    };
    let none = || {
        let first = world.get_resource::<FrameReport>().and_then(|report| report.errors.first());
        first.cloned().unwrap_or(RenderError::NoFrame)
    };
    let (Some((target, frame, camera)), Some(scene)) = (ready(), made()) else { return Err(none()) };
    let mut pass = begin(encoder, (target, frame), camera, None).ok_or_else(none)?;
    let left_out = scene.record(&mut pass);
    drop(pass);
    finish(encoder, (scene.list, target), frame, None);
    let unexplained = world.get_resource::<FrameReport>().and_then(|report| unexplained(left_out, report));
    unexplained.map_or(Ok(()), Err)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plugin::RenderPlugin;
    use crate::{Headless, Pixels};
    use bevy_app::{App, PostUpdate};
    use bevy_math::{UVec2, Vec3};
    use bevy_transform::TransformPlugin;
    use bevy_transform::components::Transform;
    use halfway_asset::Assets;
    use halfway_frame::sets::RenderSet;
    use halfway_mesh::{Cuboid, Mesh, Mesh3d};

    /// Removes the meshes after the draws of a box are made: the frame has only this error.
    #[test]
    fn nothing_is_left_out_without_an_error() {
        fn lose_meshes(mut meshes: ResMut<MeshBuffers>) {
            *meshes = MeshBuffers::default();
        }
        let mut app = App::new();
        app.insert_resource(Gpu::open_headless().expect("an adapter"));
        app.add_plugins((TransformPlugin, RenderPlugin::default()));
        app.insert_resource(Headless { size: UVec2::new(32, 24), pixels: Pixels::Byte });
        app.finish();
        app.cleanup();
        let world = app.world_mut();
        let mesh = world.resource_mut::<Assets<Mesh>>().add(Mesh::from(Cuboid::default()));
        world.spawn((Mesh3d(mesh), Transform::default()));
        world.spawn((Camera::default(), Transform::from_xyz(0.0, 0.0, 3.0).looking_at(Vec3::ZERO, Vec3::Y)));
        app.update();
        let report = |app: &App| app.world().resource::<FrameReport>().clone();
        assert_eq!((report(&app).errors, report(&app).draws), (vec![], 1));
        app.add_systems(PostUpdate, lose_meshes.after(RenderSet::Upload).before(RenderSet::Draw));
        app.update();
        assert_eq!(report(&app).errors, [RenderError::LeftOut { draws: 1 }]);
    }
}
