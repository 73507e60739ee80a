//! Pictures of frames, with what is laid over and behind them.

use crate::background;
use crate::has_lines::has_lines;
use crate::jitter;
use crate::legend::draw_legend;
use crate::lines;
use crate::pending::{Destination, PendingPicture, check_frame, run_frame};
use crate::picture::Picture;
use crate::views::{self, Views};
use bevy_app::App;
use bevy_ecs::prelude::World;
use halfway_frame::error::RenderError;
#[cfg(doc)]
use halfway_frame::report::FrameReport;
use halfway_frame::view::camera::View;
use halfway_lighting::{Legend, Load};

/// Runs one frame of `app` ([`App::update`]) and waits for its picture: systems run and time passes. [`take_picture`]
/// draws the world as it is. Every problem of the frame is an error here: the first of [`FrameReport::errors`] is
/// returned.
///
/// # Errors
/// The frame's first error, or why its picture could not be read back.
pub fn render_picture(app: &mut App) -> Result<Picture, RenderError> {
    app.update();
    if jitter::side(app.world_mut()).is_some() {
        return take_picture(app.world_mut());
    }
    finished(app.world_mut())
}

/// Draws the world as it is now and waits for its picture. Only the schedule that draws runs: no `Startup`, no
/// `Update`, and no time passes. That schedule is [`RenderPlugin::schedule`](crate::RenderPlugin::schedule),
/// `PostUpdate` by default, so that transforms are propagated first; systems of the app's own that are in it run, too.
/// Where the camera has 16 or 64 [`Samples`](halfway_lighting::Samples), it runs for each of them and once more.
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
    match jitter::side(world) {
        Some(side) => jitter::averaged(world, side, frame_picture),
        None => frame_picture(world),
    }
}

fn frame_picture(world: &mut World) -> Result<Picture, RenderError> {
    run_frame(world)?;
    finished(world)
}

/// The picture of the newest frame with its backgrounds, its lines and its legend, of all cameras that share it.
fn finished(world: &mut World) -> Result<Picture, RenderError> {
    check_frame(world)?;
    put_together(world, Destination::Taken, Err)
}

/// The same whatever errors the frame has. `refused` gets those of backgrounds and lines, and says whether they end it.
pub(crate) fn put_together(
    world: &mut World,
    destination: Destination,
    mut refused: impl FnMut(RenderError) -> Result<(), RenderError>,
) -> Result<Picture, RenderError> {
    let size = world.get_resource::<Views>().filter(|views| !views.is_empty()).map(Views::size);
    let are_several = world.get_resource::<Views>().is_some_and(Views::are_several);
    let mut whole = None;
    views::for_each(world, |world, place| {
        let mut picture = PendingPicture::of_camera(world, destination)?.wait()?;
        let Some(size) = size else {
            finish(world, &mut picture, None, destination).or_else(&mut refused)?;
            add_legend(world, &mut picture);
            whole = Some(picture);
            return Ok(());
        };
        let whole = whole.get_or_insert_with(|| picture.black(size));
        let kept = (place.load == Load::Keep).then(|| whole.part(place.corner, place.size));
        finish(world, &mut picture, kept.as_ref(), destination).or_else(&mut refused)?;
        if !are_several {
            add_legend(world, &mut picture);
        }
        whole.put(place.corner, &picture)
    })?;
    let mut picture = whole.ok_or(RenderError::NoPicture)?;
    if are_several {
        add_legend(world, &mut picture);
    }
    Ok(picture)
}

/// Adds the world's legend, if it has one: to the part that a camera draws, or to the whole picture of several.
fn add_legend(world: &World, picture: &mut Picture) {
    if let (Some(legend), Some(view)) = (world.get_resource::<Legend>(), world.get_resource::<View>()) {
        draw_legend(picture, legend, view.camera.unwrap_or_default().encoding);
    }
}

/// Adds a camera's background, or what the part that it draws `kept`, and its lines to its picture.
fn finish(
    world: &mut World,
    picture: &mut Picture,
    kept: Option<&Picture>,
    destination: Destination,
) -> Result<(), RenderError> {
    if let Some(mut camera) = world.get_resource::<View>().and_then(|view| view.camera) {
        if destination == Destination::Window {
            camera.background_opacity = 1.0;
        }
        background::put_behind(world, picture, kept, &camera)?;
    }
    if has_lines(world) {
        lines::draw_over_frame(world, picture)?;
    }
    Ok(())
}
