//! Pictures that are being read back from the adapter.

use crate::cpu::canvas::{Canvas, CanvasTarget};
#[cfg(feature = "wgpu")]
use crate::gpu::{attachments::Target, device::Gpu, read_back::ReadBack};
use crate::picture::Picture;
use crate::views::Views;
use bevy_ecs::prelude::{ResMut, Resource, World};
use bevy_ecs::schedule::InternedScheduleLabel;
use bevy_math::UVec2;
use halfway_frame::error::RenderError;
use halfway_frame::report::FrameReport;
use std::sync::atomic::{AtomicBool, Ordering};

/// A picture that is being read back. Poll it with [`PendingPicture::try_take`] while other frames are drawn, or wait
/// for it with [`PendingPicture::wait`].
pub struct PendingPicture(Pending);

enum Pending {
    /// The GPU copies it.
    #[cfg(feature = "wgpu")]
    Copied(ReadBack),
    /// The CPU has drawn it; `None` once it is taken.
    There(Option<Picture>),
    /// It is put together of the pictures of several cameras.
    Together { size: UVec2, parts: Vec<(UVec2, PendingPicture)>, arrived: Vec<Option<Picture>> },
}

/// The use that a picture is finished for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Destination {
    Taken,
    /// A window, which is opaque.
    Window,
}

impl PendingPicture {
    /// Starts to copy the newest headless picture; later frames do not change what arrives. It is as the drawer left it:
    /// opaque, and without lines and points, which [`take_picture`](crate::take_picture) and
    /// [`render_picture`](crate::render_picture) add. Cameras that [keep](halfway_lighting::Load::Keep) what is there clear
    /// it.
    ///
    /// In a system that runs before the frame of its update is drawn, in `Update` say, that is the picture of the update
    /// before: the log says so once. Ask after [`RenderSet::Deliver`](crate::RenderSet::Deliver), or after the update.
    ///
    /// # Errors
    /// [`RenderError::NoPicture`] before the first headless frame or while a window is the target;
    /// [`RenderError::TooLarge`] or [`RenderError::Memory`] if there is no memory for the copy.
    pub fn request(world: &World) -> Result<Self, RenderError> {
        let picture = Self::of_newest_frame(world)?;
        if let Some(age) = world.get_resource::<PictureAge>() {
            age.log_once();
        }
        Ok(picture)
    }

    fn of_newest_frame(world: &World) -> Result<Self, RenderError> {
        let Some(views) = world.get_resource::<Views>().filter(|views| !views.is_empty()) else {
            return Self::of_camera(world, Destination::Taken);
        };
        #[cfg(feature = "wgpu")]
        if let (Some(gpu), Some(first)) = (world.get_resource::<Gpu>(), world.get_resource::<Target>()) {
            let parts = views.targets(first).map(|(place, target)| Ok((place.corner, Self::of_target(gpu, target)?)));
            return Ok(Self::together(views.size(), parts.collect::<Result<_, _>>()?));
        }
        let first = canvas(world)?;
        let parts = views.canvases(first).map(|(place, canvas)| Ok((place.corner, Self::of_canvas(canvas)?)));
        Ok(Self::together(views.size(), parts.collect::<Result<_, _>>()?))
    }

    /// Starts to copy the picture of the camera whose turn it is. One that the CPU draws for a window is for nothing else.
    pub(crate) fn of_camera(world: &World, destination: Destination) -> Result<Self, RenderError> {
        #[cfg(feature = "wgpu")]
        if let (Some(gpu), Some(target)) = (world.get_resource::<Gpu>(), world.get_resource::<Target>()) {
            return Self::of_target(gpu, target);
        }
        match destination {
            Destination::Taken => Self::of_canvas(canvas(world)?),
            Destination::Window => Self::of_canvas(world.get_resource().ok_or(RenderError::NoPicture)?),
        }
    }

    #[cfg(feature = "wgpu")]
    fn of_target(gpu: &Gpu, target: &Target) -> Result<Self, RenderError> {
        let texture = target.picture().ok_or(RenderError::NoPicture)?;
        Ok(Self(Pending::Copied(ReadBack::start(gpu, texture)?)))
    }

    fn of_canvas(canvas: &Canvas) -> Result<Self, RenderError> {
        Ok(Self(Pending::There(Some(canvas.picture()?))))
    }

    fn together(size: UVec2, parts: Vec<(UVec2, Self)>) -> Self {
        let arrived = vec![None; parts.len()];
        Self(Pending::Together { size, parts, arrived })
    }

    /// The picture if it has arrived; `None` before, and after it was taken.
    ///
    /// # Errors
    /// [`RenderError::DeviceLost`] or [`RenderError::Device`] when the device was lost or failed on the way.
    pub fn try_take(&mut self) -> Result<Option<Picture>, RenderError> {
        match &mut self.0 {
            #[cfg(feature = "wgpu")]
            Pending::Copied(copy) => copy.try_take(),
            Pending::There(picture) => Ok(picture.take()),
            Pending::Together { size, parts, arrived } => {
                for ((_, part), arrived) in
                    parts.iter_mut().zip(arrived.iter_mut()).filter(|(_, there)| there.is_none())
                {
                    *arrived = part.try_take()?;
                }
                if !arrived.iter().all(Option::is_some) {
                    return Ok(None);
                }
                let corners = std::mem::take(parts).into_iter().map(|(corner, _)| corner);
                put_together(*size, corners.zip(std::mem::take(arrived).into_iter().flatten()))
            }
        }
    }

    /// Blocks until the picture has arrived.
    ///
    /// # Errors
    /// [`RenderError::DeviceLost`] or [`RenderError::Device`] when the device was lost or failed on the way;
    /// [`RenderError::NoPicture`] if it was taken.
    pub fn wait(self) -> Result<Picture, RenderError> {
        match self.0 {
            #[cfg(feature = "wgpu")]
            Pending::Copied(copy) => copy.wait(),
            Pending::There(picture) => picture.ok_or(RenderError::NoPicture),
            Pending::Together { size, parts, arrived } => {
                let there = parts.into_iter().zip(arrived).map(|((corner, part), there)| match there {
                    Some(picture) => Ok((corner, picture)),
                    None => Ok((corner, part.wait()?)),
                });
                put_together(size, there.collect::<Result<Vec<_>, _>>()?)?.ok_or(RenderError::NoPicture)
            }
        }
    }
}

fn canvas(world: &World) -> Result<&Canvas, RenderError> {
    let canvas = world.get_resource::<Canvas>().filter(|_| !world.contains_resource::<CanvasTarget>());
    canvas.ok_or(RenderError::NoPicture)
}

/// The pictures of several cameras in one, each over those before it; `None` without any.
fn put_together(
    size: UVec2,
    parts: impl IntoIterator<Item = (UVec2, Picture)>,
) -> Result<Option<Picture>, RenderError> {
    let mut whole = None;
    for (corner, part) in parts {
        whole.get_or_insert_with(|| part.black(size)).put(corner, &part)?;
    }
    Ok(whole)
}

/// Runs the schedule that draws, and waits for the picture as the drawer left it.
///
/// # Errors
/// As [`take_picture`](crate::take_picture).
pub(crate) fn draw_frame(world: &mut World) -> Result<Picture, RenderError> {
    run_frame(world)?;
    check_frame(world)?;
    PendingPicture::request(world)?.wait()
}

/// Runs the schedule that draws.
///
/// # Errors
/// [`RenderError::NoPicture`] without one.
pub(crate) fn run_frame(world: &mut World) -> Result<(), RenderError> {
    let schedule = world.get_resource::<DrawnIn>().ok_or(RenderError::NoPicture)?.0;
    world.try_run_schedule(schedule).map_err(|_| RenderError::NoPicture)
}

/// Passes on the first error of the newest frame.
pub(crate) fn check_frame(world: &World) -> Result<(), RenderError> {
    let first = world.get_resource::<FrameReport>().and_then(|report| report.errors.first());
    first.map_or(Ok(()), |error| Err(error.clone()))
}

/// The schedule that draws a frame.
#[derive(Resource, Clone, Copy)]
pub(crate) struct DrawnIn(pub(crate) InternedScheduleLabel);

/// Whether the newest picture is that of the update before, as long as the update that runs has not drawn its own.
#[derive(Resource, Default)]
pub(crate) struct PictureAge {
    is_a_frame_old: bool,
    is_logged: AtomicBool,
}

impl PictureAge {
    /// When an update begins.
    pub(crate) fn grow(mut age: ResMut<Self>) {
        age.is_a_frame_old = true;
    }

    /// When a frame is drawn.
    pub(crate) fn renew(mut age: ResMut<Self>) {
        age.is_a_frame_old = false;
    }

    /// Logs once that a picture is asked for that is a frame old.
    fn log_once(&self) {
        if self.is_a_frame_old && !self.is_logged.swap(true, Ordering::Relaxed) {
            log::warn!(
                "the picture is a frame old: it is asked for before the frame of this update is drawn; ask after \
                 `RenderSet::Deliver`, or after the update"
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AdapterChoice, Headless, RenderPlugin, render_picture, take_picture};
    use bevy_app::{App, Update};
    use bevy_math::UVec2;
    use bevy_transform::TransformPlugin;
    use halfway_lighting::Camera;

    #[test]
    fn a_picture_that_is_a_frame_old_is_logged() {
        fn ask(world: &mut World) {
            // There is none before the first frame.
            let _ = PendingPicture::request(world);
        }
        let mut app = App::new();
        app.add_plugins((TransformPlugin, RenderPlugin::default()))
            .insert_resource(Headless { size: UVec2::new(8, 6), ..Headless::default() })
            .insert_resource(AdapterChoice::cpu());
        app.world_mut().spawn(Camera::default());
        let logged = |app: &App| app.world().resource::<PictureAge>().is_logged.load(Ordering::Relaxed);
        for _ in 0..2 {
            render_picture(&mut app).expect("a picture");
            take_picture(app.world_mut()).expect("a picture");
        }
        assert!(!logged(&app));
        app.add_systems(Update, ask);
        app.update();
        assert!(logged(&app));
    }
}
