//! Several cameras in one picture: they are drawn one after the other, each into a picture of its own.

use crate::cpu::canvas::{Canvas, CanvasTarget};
#[cfg(feature = "wgpu")]
use crate::gpu::{attachments::Target, timer::GpuTimer};
use bevy_ecs::prelude::*;
use bevy_math::UVec2;
use halfway_frame::report::FrameReport;
use halfway_frame::view::camera::PictureSize;
use halfway_frame::{CameraFrame, FurtherCamera};
use halfway_lighting::{CameraTurn, Load, SharedPart, SharingCameras};

/// The cameras that share the picture of the frame, in the order in which they are drawn. Empty where a camera has the
/// picture for itself.
#[derive(Resource, Default)]
pub(crate) struct Views {
    /// Width and height of the whole picture.
    size: UVec2,
    each: Vec<CameraView>,
}

/// A camera, and what its frame has left. While it is the camera's turn, and for the first one also between frames, that
/// is in the resources of the world instead.
struct CameraView {
    camera: Entity,
    place: Place,
    left: Left,
}

/// The part of the whole picture that a camera draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    /// The pixel of its upper left corner.
    pub(crate) corner: UVec2,
    pub(crate) size: UVec2,
    pub(crate) load: Load,
}

#[derive(Default)]
struct Left {
    frame: CameraFrame,
    canvas: Canvas,
    #[cfg(feature = "wgpu")]
    target: Target,
}

impl Views {
    /// The schedules of the cameras after the first.
    pub(crate) fn further(&self) -> impl Iterator<Item = FurtherCamera> + use<> {
        (1..self.each.len() as u32).map(FurtherCamera)
    }

    /// Whether cameras share the picture.
    pub(crate) fn are_there(views: Option<Res<Self>>) -> bool {
        views.is_some_and(|views| !views.each.is_empty())
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.each.is_empty()
    }

    pub(crate) fn are_several(&self) -> bool {
        self.each.len() > 1
    }

    /// Drops what the cameras' frames have left, after a change of the adapter.
    pub(crate) fn forget(&mut self) {
        self.each.iter_mut().for_each(|view| view.left = Left::default());
    }

    /// Width and height of the whole picture.
    pub(crate) fn size(&self) -> UVec2 {
        self.size
    }

    /// Each canvas with its place, the first being `first`.
    pub(crate) fn canvases<'a>(&'a self, first: &'a Canvas) -> impl Iterator<Item = (Place, &'a Canvas)> {
        self.each
            .iter()
            .enumerate()
            .map(move |(number, view)| (view.place, if number == 0 { first } else { &view.left.canvas }))
    }

    /// Each target with its place, the first being `first`.
    #[cfg(feature = "wgpu")]
    pub(crate) fn targets<'a>(&'a self, first: &'a Target) -> impl Iterator<Item = (Place, &'a Target)> {
        self.each
            .iter()
            .enumerate()
            .map(move |(number, view)| (view.place, if number == 0 { first } else { &view.left.target }))
    }

    /// The number of the camera that shows a pixel of the whole picture: the last one that draws there.
    pub(crate) fn showing(&self, pixel: UVec2) -> Option<usize> {
        self.each.iter().rposition(|view| view.place.has(pixel))
    }
}

impl Place {
    fn has(&self, pixel: UVec2) -> bool {
        pixel.cmpge(self.corner).all() && (pixel - self.corner).cmplt(self.size).all()
    }
}

/// Begins the turn of the first camera, where several share the picture.
pub(crate) fn begin(
    cameras: SharingCameras,
    mut views: ResMut<Views>,
    mut turn: ResMut<CameraTurn>,
    mut size: ResMut<PictureSize>,
) {
    let whole = size.0;
    let parts = cameras.parts(whole.to_array());
    if parts.is_empty() && views.each.is_empty() {
        return;
    }
    let mut before = std::mem::take(&mut views.each);
    views.size = whole;
    let view = |SharedPart { camera, corner, size, load }| {
        let known = before.iter_mut().find(|view| view.camera == camera);
        let left = known.map(|view| std::mem::take(&mut view.left)).unwrap_or_default();
        CameraView { camera, place: Place { corner: corner.into(), size: size.into(), load }, left }
    };
    views.each = parts.into_iter().map(view).collect();
    if let Some(first) = views.each.first_mut() {
        // It has been another number's, if the order has changed, and is too old then.
        first.left = Left::default();
        turn.0 = Some(first.camera);
        size.0 = first.place.size;
    }
}

/// Draws the other cameras.
pub(crate) fn draw_further(world: &mut World) {
    #[cfg(feature = "wgpu")]
    let timer = world.remove_resource::<GpuTimer>();
    for further in world.resource::<Views>().further() {
        in_turn(world, further.0 as usize, |world, _| {
            let first = world.resource::<FrameReport>().clone();
            world.run_schedule(further);
            let mut report = world.resource_mut::<FrameReport>();
            let further = std::mem::replace(&mut *report, first);
            report.add(further);
        });
    }
    #[cfg(feature = "wgpu")]
    if let Some(timer) = timer {
        world.insert_resource(timer);
    }
    world.insert_resource(CameraTurn(None));
    if world.contains_resource::<CanvasTarget>() {
        show_together(world);
    }
}

/// Puts the cameras' pictures together in the canvas that a window shows.
fn show_together(world: &mut World) {
    let (mut canvas, views) = (world.remove_resource::<Canvas>().unwrap_or_default(), world.resource::<Views>());
    let begun = canvas.begin_shared(views.size);
    let Ok(mut whole) = begun else {
        world.insert_resource(canvas);
        world.resource_mut::<FrameReport>().errors.extend(begun.err());
        return;
    };
    for (place, bytes) in views.canvases(&canvas).filter_map(|(place, canvas)| Some((place, canvas.own_bytes()?))) {
        let row = |y: u32| 4 * ((place.corner.y + y) * views.size.x + place.corner.x) as usize;
        for (y, from) in (0..).zip(bytes.chunks_exact(4 * place.size.x as usize)) {
            whole[row(y)..][..from.len()].copy_from_slice(from);
        }
    }
    canvas.show_shared(views.size, whole);
    world.insert_resource(canvas);
}

/// Calls `each` once for every camera's view, in order, while the world's resources are those of its frame; for a picture
/// that one camera has for itself once, with its size.
pub(crate) fn for_each<T, E>(
    world: &mut World,
    mut each: impl FnMut(&mut World, Place) -> Result<T, E>,
) -> Result<Vec<T>, E> {
    let count = world.get_resource::<Views>().map_or(0, |views| views.each.len());
    if count > 0 {
        return (0..count).map(|number| in_turn(world, number, &mut each)).collect();
    }
    let size = world.get_resource::<PictureSize>().copied().unwrap_or_default().0;
    Ok(vec![each(world, Place { corner: UVec2::ZERO, size, load: Load::Clear })?])
}

/// Calls `work` while it is the turn of the camera with this number.
pub(crate) fn in_turn<T>(world: &mut World, number: usize, work: impl FnOnce(&mut World, Place) -> T) -> T {
    let (camera, place) = {
        let view = &world.resource::<Views>().each[number];
        (view.camera, view.place)
    };
    let size = world.get_resource::<PictureSize>().copied().unwrap_or_default();
    world.insert_resource(CameraTurn(Some(camera)));
    world.insert_resource(PictureSize(place.size));
    // The first one's are in the world already.
    if number > 0 {
        exchange(world, number);
    }
    let result = work(world, place);
    if number > 0 {
        exchange(world, number);
    }
    world.insert_resource(CameraTurn(None));
    world.insert_resource(size);
    result
}

/// Exchanges what the frame of a camera has left for what is in the world.
fn exchange(world: &mut World, number: usize) {
    fn swap<T: Resource<Mutability = bevy_ecs::component::Mutable>>(world: &mut World, left: &mut T) {
        if let Some(mut there) = world.get_resource_mut::<T>() {
            std::mem::swap(&mut *there, left);
        }
    }
    world.resource_scope(|world, mut views: Mut<Views>| {
        let left = &mut views.each[number].left;
        left.frame.exchange(world);
        swap(world, &mut left.canvas);
        #[cfg(feature = "wgpu")]
        swap(world, &mut left.target);
    });
}
