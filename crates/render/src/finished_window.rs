//! Windows that show finished pictures: with lines and a legend over them, and with what lies behind their surfaces.

use crate::cpu::canvas::{Canvas, CanvasTarget};
#[cfg(feature = "wgpu")]
use crate::gpu::surface::SurfaceTarget;
use crate::picture::Picture;
use crate::taken::{Destination, put_together};
use bevy_ecs::prelude::*;
use halfway_frame::report::FrameReport;
use halfway_lighting::{Camera, Edges, Legend, Load, Show, Viewport};
use halfway_mesh::Lines3d;
use image::RgbaImage;

/// While this resource exists, the newest picture that a window shows is kept here too, without its panels. `None` before
/// the first frame, and after one that failed.
///
/// A picture that the graphics card draws is read back for it, which takes a few milliseconds a frame.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct WindowPicture(pub Option<RgbaImage>);

/// Whether the frame's picture is finished in memory before a window shows it. Frames that need no more than their passes
/// are shown as they are drawn.
#[derive(Resource, Default)]
pub(crate) struct FinishedWindow {
    pub(crate) is_asked: bool,
    /// The finished picture, for the window of a device.
    #[cfg(feature = "wgpu")]
    pub(crate) picture: Option<RgbaImage>,
}

type WithLines = Or<(With<Edges>, With<Lines3d>)>;

/// Finds out whether a window's frame has lines, a legend, a background of two colours or a camera that keeps what is
/// there, or is to be kept itself.
#[cfg_attr(
    feature = "wgpu",
    expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")
)]
pub(crate) fn ask(
    canvas: Option<Res<CanvasTarget>>,
    #[cfg(feature = "wgpu")] surface: Option<Res<SurfaceTarget>>,
    lines: Query<(), WithLines>,
    shows: Query<&Show>,
    cameras: Query<(&Camera, Option<&Viewport>)>,
    legend: Option<Res<Legend>>,
    kept: Option<ResMut<WindowPicture>>,
    mut window: ResMut<FinishedWindow>,
) {
    #[cfg(feature = "wgpu")]
    let is_window = canvas.is_some() || surface.is_some();
    #[cfg(not(feature = "wgpu"))]
    let is_window = canvas.is_some();
    let is_over = || legend.is_some() || !lines.is_empty() || shows.iter().any(Show::any);
    let is_behind = |(camera, viewport): (&Camera, Option<&Viewport>)| {
        camera.background_below.is_some() || viewport.is_some_and(|viewport| viewport.load == Load::Keep)
    };
    window.is_asked = is_window && (kept.is_some() || is_over() || cameras.iter().any(is_behind));
    #[cfg(feature = "wgpu")]
    {
        window.picture = None;
    }
    if let Some(mut kept) = kept {
        kept.0 = None;
    }
}

/// Whether the window's picture is to be finished.
pub(crate) fn is_asked(window: Res<FinishedWindow>) -> bool {
    window.is_asked
}

/// Finishes the picture of the frame that was drawn. What cannot be laid over or behind it is an error of the frame, and
/// the rest is shown.
pub(crate) fn finish(world: &mut World) {
    let mut errors = Vec::new();
    let picture = put_together(world, Destination::Window, |error| {
        errors.push(error);
        Ok(())
    });
    world.resource_mut::<FrameReport>().errors.extend(errors);
    // A frame without a picture has errors already.
    let Ok(Picture::Byte(picture)) = picture else { return };
    if let Some(mut kept) = world.get_resource_mut::<WindowPicture>() {
        kept.0 = Some(picture.clone());
    }
    #[cfg(feature = "wgpu")]
    if world.contains_resource::<SurfaceTarget>() {
        world.resource_mut::<FinishedWindow>().picture = Some(picture);
        return;
    }
    world.resource_mut::<Canvas>().show_shared(picture.dimensions().into(), picture.into_raw());
}
