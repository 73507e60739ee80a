//! Lines over the finished picture: the edges of meshes, lines and points, and those that explain a scene.

mod disc;
mod drawing;
mod edges;
mod explained;
mod marks;
mod mix;
mod segment;
mod strokes;

use crate::lines::drawing::Drawing;
use crate::picture::Picture;
use crate::quantities::{Surfaces, no_camera};
use bevy_ecs::prelude::*;
use halfway_frame::error::RenderError;
use halfway_lighting::{Camera, Show, current_camera};
#[cfg(doc)]
use {halfway_lighting::Edges, halfway_mesh::Lines3d};

/// Draws all lines over the newest frame's picture.
///
/// # Errors
/// Those of [`Surfaces::take`] and of [`draw_lines`].
pub(crate) fn draw_over_frame(world: &mut World, picture: &mut Picture) -> Result<(), RenderError> {
    let surfaces = Surfaces::take(world)?;
    draw_lines(world, picture, &surfaces)
}

/// Draws all lines of the world over a picture that shows these surfaces, in the camera's encoding: [`Edges`], those of
/// [`Lines3d`] and of [`Show`]. [`take_picture`](crate::take_picture) and [`render_picture`](crate::render_picture) have
/// done it.
///
/// # Errors
/// [`RenderError::Invalid`] for an invalid component, [`RenderError::MissingMesh`] where a [`Lines3d`] leads to no lines,
/// [`RenderError::BadTransform`], [`RenderError::NoCamera`], and [`RenderError::ManyCameras`] where it is no camera's
/// [turn](halfway_lighting::CameraTurn).
pub fn draw_lines(world: &mut World, picture: &mut Picture, surfaces: &Surfaces) -> Result<(), RenderError> {
    let drawing = Drawing::new(surfaces);
    let camera = current_camera(world).map_err(no_camera)?;
    let encoding = world.get::<Camera>(camera).ok_or(RenderError::NoCamera)?.encoding;
    let show = world.get::<Show>(camera).copied().unwrap_or_default();
    edges::draw(picture, &drawing, &edges::edged_objects(world)?, encoding);
    // Later marks cover earlier ones that are equally near.
    let explained = explained::marks(world, &drawing, show)?;
    let mut marks = explained.on_ground;
    marks.extend(strokes::marks(world, &drawing)?);
    marks.extend(explained.among);
    marks::draw(picture, &drawing, &marks, encoding);
    marks::draw(picture, &drawing, &explained.over, encoding);
    Ok(())
}
