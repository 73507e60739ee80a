//! Whether a window shows a finished picture: with lines and a legend over it, and with what lies behind its surfaces.

use crate::cpu::canvas::CanvasTarget;
#[cfg(feature = "wgpu")]
use crate::gpu::surface::SurfaceTarget;
use bevy_ecs::prelude::*;
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

/// The systems that hand a frame's picture to a window.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Present;

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
