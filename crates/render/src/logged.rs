//! Errors and warnings of frames, logged once each.

use std::collections::HashSet;

use bevy_ecs::prelude::*;
use halfway_lighting::{AlphaMode, Material};
use halfway_mesh::Mesh3d;

use crate::cpu::canvas::CanvasTarget;
#[cfg(feature = "wgpu")]
use crate::gpu::surface::SurfaceTarget;
#[cfg(feature = "wgpu")]
use crate::gpu::texture::TextureTarget;
use halfway_frame::error::label;
use halfway_frame::report::FrameReport;
use halfway_frame::why_empty::{EmptyReason, why_empty};

/// The messages that have been logged.
#[derive(Resource, Default)]
pub(crate) struct Logged(HashSet<String>);

/// The most messages, so that errors with ever new texts do not use unlimited memory.
const MOST: usize = 1000;

impl Logged {
    /// Records the message, and returns whether it is new.
    fn is_new(&mut self, message: &str) -> bool {
        self.0.len() < MOST && !self.0.contains(message) && self.0.insert(message.to_owned())
    }
}

/// Logs each error of the frame, unless a window shows the frames: the window reports errors itself, also without a
/// logger.
///
/// The log target has a name of its own, so that a program that prints the errors of
/// [`render_picture`](crate::render_picture) can turn these off.
pub(crate) fn log_errors(
    report: Res<FrameReport>,
    #[cfg(feature = "wgpu")] surface: Option<Res<SurfaceTarget>>,
    canvas: Option<Res<CanvasTarget>>,
    mut logged: ResMut<Logged>,
) {
    #[cfg(feature = "wgpu")]
    if surface.is_some() {
        return;
    }
    if canvas.is_some() {
        return;
    }
    for error in &report.errors {
        let message = error.to_string();
        if logged.is_new(&message) {
            log::error!(target: "halfway_render::errors", "{message}");
        }
    }
}

type Opacity = (Entity, &'static Material, Option<&'static AlphaMode>, Option<&'static Name>);

/// Logs materials with an opacity that has no effect.
pub(crate) fn log_ineffective_opacity(
    objects: Query<Opacity, (With<Mesh3d>, Changed<Material>)>,
    mut logged: ResMut<Logged>,
) {
    let is_opaque = |alpha: Option<&AlphaMode>| alpha.is_none_or(|alpha| *alpha == AlphaMode::Opaque);
    let mut hidden = objects.iter().filter(|(_, material, alpha, _)| material.opacity < 1.0 && is_opaque(*alpha));
    let Some((entity, _, _, name)) = hidden.next() else { return };
    let message = "an opacity below 1 does not show without blending: insert `AlphaMode::Blend`, or a mask";
    if logged.is_new(message) {
        let others = match hidden.count() {
            0 => String::new(),
            1 => " and of another object".into(),
            count => format!(" and of {count} other objects"),
        };
        log::warn!("{message} (material of {}{others})", label(entity, name));
    }
}

/// Whether the frame may show nothing.
pub(crate) fn may_be_empty(report: Res<FrameReport>) -> bool {
    report.errors.is_empty() && (report.visible == 0 || report.lights == 0)
}

#[cfg(feature = "wgpu")]
const NO_LINES: &str = "an engine's texture does not show lines and points (`Edges`, `Lines3d`, `Show`); windows and \
                        pictures that are taken do (`take_picture`)";

/// Logs once that an engine's texture does not show lines and points.
#[cfg(feature = "wgpu")]
pub(crate) fn log_lines(world: &mut World) {
    let is_texture = world.contains_resource::<TextureTarget>();
    if is_texture && crate::has_lines(world) && world.resource_mut::<Logged>().is_new(NO_LINES) {
        log::warn!("{NO_LINES}");
    }
}

/// Logs why the frame shows nothing.
pub(crate) fn log_why_empty(world: &mut World) {
    // A camera may be inside an object on purpose; `why_empty` still gives that reason on request.
    let reason = why_empty(world).filter(|reason| !matches!(reason, EmptyReason::CameraInside { .. }));
    let Some(reason) = reason else { return };
    if world.resource_mut::<Logged>().is_new(&reason.to_string()) {
        // A name of its own, so that a program can give the remedy in its own words.
        log::warn!(target: "halfway_render::empty", "the picture shows nothing: {reason}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_new_once() {
        let mut logged = Logged::default();
        assert!(logged.is_new("no light") && !logged.is_new("no light") && logged.is_new("no camera"));
        let new = (0..2 * MOST).filter(|i| logged.is_new(&i.to_string())).count();
        assert_eq!(new, MOST - 2);
    }
}
