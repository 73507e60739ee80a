//! The headless target.

use crate::cpu::canvas::CanvasTarget;
use crate::picture::Pixels;
use bevy_ecs::prelude::*;
use bevy_math::UVec2;
use halfway_frame::values::{FrameValues, WaitsForLevels};
use halfway_frame::view::camera::PictureSize;

/// The headless target: pictures of this size, to be read back. The default target.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct Headless {
    /// Width and height in pixels, each at least 1. Default 1280 × 720.
    pub size: UVec2,
    /// The values of a pixel. Default [`Pixels::Byte`].
    pub pixels: Pixels,
}

impl Default for Headless {
    fn default() -> Self {
        Self { size: UVec2::new(1280, 720), pixels: Pixels::default() }
    }
}

/// Sets the size of the frame's picture: that of the CPU's window, or of the headless picture.
pub(crate) fn measure(
    headless: Res<Headless>,
    canvas: Option<Res<CanvasTarget>>,
    mut size: ResMut<PictureSize>,
    mut values: ResMut<FrameValues>,
    mut waits: ResMut<WaitsForLevels>,
) {
    values.0 = None;
    waits.0 = canvas.is_none();
    size.0 = canvas.map_or(headless.size, |canvas| canvas.size);
}
