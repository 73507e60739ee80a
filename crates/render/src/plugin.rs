//! The plugin.

use crate::drawers::add_drawers;
use crate::finished_window;
use crate::logged::{self, Logged};
use crate::pending::{DrawnIn, PictureAge};
use crate::views;
use crate::window_picture::{self, Present};
use bevy_app::{App, First, Plugin, PostUpdate};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
#[cfg(doc)]
use halfway_frame::FramePlugin;
use halfway_frame::ReadCamera;
#[cfg(doc)]
use halfway_frame::report::FrameReport;
use halfway_frame::sets::RenderSet;

/// Draws every entity with a [`Mesh3d`](halfway_mesh::Mesh3d) through the world's [`Camera`](halfway_lighting::Camera), once a run of its
/// schedule.
///
/// Needs current `GlobalTransform`s: it runs after `TransformSystems::Propagate` if that set is in the same schedule,
/// and an App with a schedule of its own propagates before. If no system propagates them, the frame is not drawn, and
/// [`FrameReport::errors`] says so.
///
/// Each error of a frame is logged once by the `log` crate (target `halfway_render::errors`; a window says them
/// itself), and so is each warning: an opacity that is not shown without
/// [`AlphaMode::Blend`](halfway_lighting::AlphaMode::Blend), why a picture shows nothing
/// ([`why_empty`](crate::why_empty)), and that a picture is asked for that is a frame old
/// ([`PendingPicture::request`](crate::PendingPicture::request)).
///
/// Brings [`FramePlugin`] and the plugins of meshes, lighting and textures. May be added before or after other plugins,
/// and to an App that has
/// cameras, lights and objects already.
#[derive(Clone, Debug)]
pub struct RenderPlugin {
    /// The schedule that draws a frame. Default `PostUpdate`.
    pub schedule: InternedScheduleLabel,
}

impl Default for RenderPlugin {
    fn default() -> Self {
        Self { schedule: PostUpdate.intern() }
    }
}

impl Plugin for RenderPlugin {
    fn build(&self, app: &mut App) {
        add_drawers(app, self.schedule);
        app.insert_resource(DrawnIn(self.schedule))
            .init_resource::<Logged>()
            .init_resource::<PictureAge>()
            .add_systems(First, PictureAge::grow)
            .add_systems(
                self.schedule,
                (
                    PictureAge::renew.in_set(RenderSet::Deliver),
                    window_picture::ask.in_set(RenderSet::View).after(ReadCamera),
                    finished_window::finish
                        .in_set(RenderSet::Deliver)
                        .after(views::draw_further)
                        .before(Present)
                        .run_if(window_picture::is_asked),
                    (
                        logged::log_errors,
                        logged::log_ineffective_opacity,
                        #[cfg(feature = "wgpu")]
                        logged::log_lines,
                        logged::log_why_empty.run_if(logged::may_be_empty),
                    )
                        .chain()
                        .after(RenderSet::Deliver),
                ),
            );
    }
}
