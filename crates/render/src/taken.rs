//! Pictures of frames, with what is laid over and behind them.

use crate::background;
use crate::legend::Legend;
use crate::lines;
use crate::pending::{draw_frame, drawn_picture};
use crate::picture::Picture;
use bevy_app::App;
use bevy_ecs::prelude::World;
use halfway_frame::error::RenderError;
#[cfg(doc)]
use halfway_frame::report::FrameReport;
use halfway_frame::view::camera::View;

/// Runs one frame of `app` ([`App::update`]) and waits for its picture: systems run and time passes. [`take_picture`]
/// draws the world as it is. Every problem of the frame is an error here: the first of [`FrameReport::errors`] is
/// returned.
///
/// # Errors
/// The frame's first error, or why its picture could not be read back.
pub fn render_picture(app: &mut App) -> Result<Picture, RenderError> {
    app.update();
    let picture = drawn_picture(app.world())?;
    finished(app.world_mut(), picture)
}

/// Draws the world as it is now and waits for its picture. Only the schedule that draws runs: no `Startup`, no
/// `Update`, and no time passes. That schedule is [`RenderPlugin::schedule`](crate::RenderPlugin::schedule),
/// `PostUpdate` by default, so that transforms are propagated first; systems of the app's own that are in it run, too.
///
/// [`render_picture`] steps the app instead. A scene that is spawned in `Startup` is there after the first step.
///
/// ```
/// use bevy_app::App;
/// use bevy_math::UVec2;
/// use bevy_transform::{TransformPlugin, components::Transform};
/// use halfway_asset::Assets;
/// use halfway_lighting::{Camera, Material};
/// use halfway_mesh::{Mesh, Mesh3d, UvSphere};
/// use halfway_render::{AdapterChoice, Headless, RenderError, RenderPlugin, take_picture};
///
/// # fn main() -> Result<(), RenderError> {
/// let mut app = App::new();
/// app.add_plugins((TransformPlugin, RenderPlugin::default()))
///     .insert_resource(Headless { size: UVec2::new(64, 48), ..Headless::default() })
///     .insert_resource(AdapterChoice::cpu());
/// let world = app.world_mut();
/// world.spawn((Camera::default(), Transform::from_xyz(0.0, 0.0, 4.0)));
/// let sphere = world.resource_mut::<Assets<Mesh>>().add(UvSphere::default());
/// let ball = world.spawn((Mesh3d(sphere), Material::emissive(bevy_color::LinearRgba::RED))).id();
/// let with = take_picture(world)?;
/// world.despawn(ball);
/// let without = take_picture(world)?;
/// assert_ne!(with, without);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// The frame's first error, or why its picture could not be read back; [`RenderError::NoPicture`] in a world without
/// a [`RenderPlugin`](crate::RenderPlugin).
pub fn take_picture(world: &mut World) -> Result<Picture, RenderError> {
    let picture = draw_frame(world)?;
    finished(world, picture)
}

/// The picture with its background, its lines and its legend.
fn finished(world: &mut World, mut picture: Picture) -> Result<Picture, RenderError> {
    background::put_behind(world, &mut picture)?;
    if lines::has_lines(world) {
        lines::draw_over_frame(world, &mut picture)?;
    }
    if let (Some(legend), Some(view)) = (world.get_resource::<Legend>(), world.get_resource::<View>()) {
        legend.draw(&mut picture, view.camera.unwrap_or_default().encoding);
    }
    Ok(picture)
}
