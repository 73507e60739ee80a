//! Finishes the pictures of windows.

use crate::cpu::canvas::Canvas;
#[cfg(feature = "wgpu")]
use crate::gpu::surface::SurfaceTarget;
use crate::pending::Destination;
use crate::picture::Picture;
use crate::taken::put_together;
#[cfg(feature = "wgpu")]
use crate::window_picture::FinishedWindow;
use crate::window_picture::WindowPicture;
use bevy_ecs::prelude::*;
use halfway_frame::report::FrameReport;

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
