//! The window as a plugin.

use crate::open::WinitWindow;
use crate::orbit_camera::{OrbitCamera, OrbitCameraPlugin};
use crate::runner::{self, Settings};
use crate::title::{FrameTime, WindowTitle};
use crate::viewer_keys::ViewerKeysPlugin;
use bevy_app::{App, Plugin, PostUpdate, PreUpdate};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::ScheduleLabel;
use bevy_input::{InputPlugin, InputSystems};
use bevy_math::{UVec2, Vec3};
use bevy_transform::components::Transform;
use halfway_lighting::{Camera, Upright};
use halfway_render::{GpuTimer, RenderPlugin, RenderSet, SurfaceTarget};

/// Runs the App in a window: one `App::update` a frame, at the display's rate.
///
/// The App draws into the window instead of a headless picture; the adapter is open before
/// the first update, so `Startup` systems find [`Gpu`](halfway_render::Gpu) and [`SurfaceTarget`], or
/// [`Cpu`](halfway_render::Cpu) and [`CanvasTarget`](halfway_render::CanvasTarget), and the entity of the
/// [`WinitWindow`]. Keys, mouse buttons, wheel and pointer reach `bevy_input`, its `MouseMotion` in logical pixels.
/// While the window is minimised or covered, the App is not updated, and nothing is drawn. Pipelines are built beside
/// the frames, unless
/// [`Compile`](halfway_render::Compile) says otherwise.
///
/// The App ends when the window is closed ([`AppExit::Success`](bevy_app::AppExit), after a last update that receives
/// the message) or when it sends an `AppExit` itself. Without a display, or without the requested adapter, the run ends
/// at once with exit code 3 and a message that names the remedy. Each error of a frame is logged once. All messages go
/// to the log, or to standard error if no logger shows errors.
///
/// The runner must run on the main thread, once a process, as window systems require. `InputPlugin` is added where the
/// App has none yet (add your own before).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WindowPlugin {
    /// The program's name, the first part of the window's title. Default "halfway".
    pub title: String,
    /// Width and height that the window opens with, in logical pixels. Default 1280 × 720.
    pub size: UVec2,
    /// Whether the title also shows [`WindowTitle`] and, twice a second, the frame's counters
    /// ([`FrameReport`](halfway_render::FrameReport)), its times on the CPU
    /// ([`FrameTimes`](halfway_render::FrameTimes), without the wait for the display) and on the GPU ([`GpuTimer`],
    /// which is inserted for it), frames a second, shading and errors. Default true.
    pub status: bool,
    /// Whether mouse and keys move the camera. Adds [`OrbitCameraPlugin`], and gives an [`OrbitCamera`] to every new
    /// [`Camera`] without one and without a parent; of cameras that share the window, the one under the pointer moves. It
    /// turns about the point of the view axis nearest the origin, or,
    /// if that is not in front of the camera, about the point as far ahead as the origin is away. Default true.
    pub orbit: bool,
    /// Whether keys change the shading and close the window. Adds [`ViewerKeysPlugin`]. Default true.
    pub viewer_keys: bool,
}

impl Default for WindowPlugin {
    fn default() -> Self {
        Self { title: "halfway".into(), size: UVec2::new(1280, 720), status: true, orbit: true, viewer_keys: true }
    }
}

impl Plugin for WindowPlugin {
    fn build(&self, app: &mut App) {
        if !app.is_plugin_added::<InputPlugin>() {
            app.add_plugins(InputPlugin);
        }
        if self.orbit {
            app.add_plugins(OrbitCameraPlugin).add_systems(PreUpdate, give_orbits.before(InputSystems));
        }
        if self.viewer_keys {
            app.add_plugins(ViewerKeysPlugin);
        }
        app.init_resource::<WindowTitle>().init_resource::<FrameTime>();
        if self.status {
            app.init_resource::<GpuTimer>();
        }
        let settings = Settings { title: self.title.clone(), size: self.size, status: self.status };
        app.set_runner(move |app| runner::run(app, settings));
    }

    fn finish(&self, app: &mut App) {
        // By now every plugin is added, in any order.
        let renderer = app.get_added_plugins::<RenderPlugin>().first().map(|plugin| plugin.schedule);
        let schedule = renderer.unwrap_or(PostUpdate.intern());
        app.add_systems(schedule, announce.after(RenderSet::Draw).before(RenderSet::Deliver));
    }
}

type NewCameras<'w, 's> = Query<
    'w,
    's,
    (Entity, &'static Transform, Option<&'static Upright>),
    (Added<Camera>, Without<OrbitCamera>, Without<ChildOf>),
>;

/// Gives a camera without an orbit one that does not change its picture.
fn give_orbits(cameras: NewCameras, mut commands: Commands) {
    for (entity, transform, upright) in &cameras {
        let (distance, upright) = (distance_to_turn_at(transform), upright.copied().unwrap_or_default());
        commands.entity(entity).insert(OrbitCamera::resume_upright(transform, distance, upright));
    }
}

/// The distance from the eye to the point of the view axis nearest the origin, or to the origin if that point is not
/// well in front of the eye; 1 for an eye at the origin.
fn distance_to_turn_at(transform: &Transform) -> f32 {
    let away = transform.translation.length();
    let along = transform.translation.dot(transform.rotation * Vec3::Z);
    let distance = if along > 0.1 * away { along } else { away };
    if distance > 0.0 && distance.is_finite() { distance } else { 1.0 }
}

/// Announces a picture to the window system, so that it schedules the next redraw.
fn announce(window: Query<&WinitWindow>, surface: Option<Res<SurfaceTarget>>) {
    if surface.is_some_and(|surface| surface.acquired()) {
        window.iter().for_each(|window| window.0.pre_present_notify());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use halfway_lighting::Viewport;

    #[test]
    fn cameras_orbit_the_point_that_they_face() {
        let at = |x, y, z, target: Vec3| Transform::from_xyz(x, y, z).looking_at(target, Vec3::Y);
        let rows = [
            ("at the origin", at(0.0, 3.0, 4.0, Vec3::ZERO), 5.0),
            ("past the origin", at(0.0, 2.0, 6.0, Vec3::new(0.0, 2.0, -1.0)), 6.0),
            ("away from the origin", at(0.0, 0.0, 4.0, Vec3::new(0.0, 0.0, 9.0)), 4.0),
            ("across", at(3.0, 0.0, 0.0, Vec3::new(3.0, 0.0, -1.0)), 3.0),
            ("from the origin", at(0.0, 0.0, 0.0, Vec3::NEG_Z), 1.0),
            ("no number", Transform::from_xyz(f32::NAN, 0.0, 0.0), 1.0),
        ];
        for (name, transform, expected) in rows {
            let distance = distance_to_turn_at(&transform);
            // A few roundings.
            assert!((distance - expected).abs() < 1e-5, "{name}: {distance}");
        }
    }

    #[test]
    fn each_of_the_cameras_that_share_a_window_gets_an_orbit() {
        let mut app = App::new();
        app.add_plugins(WindowPlugin::default());
        app.finish();
        let place = Transform::from_xyz(0.0, 0.0, 5.0);
        let viewports = [2, 1, 3].map(|order| Viewport::default().with_order(order));
        let cameras = viewports.map(|viewport| app.world_mut().spawn((Camera::default(), place, viewport)).id());
        app.update();
        let orbits = cameras.map(|camera| app.world().get::<OrbitCamera>(camera).is_some());
        assert_eq!(orbits, [true; 3]);
    }

    #[test]
    fn new_cameras_get_an_orbit_and_keep_their_picture() {
        let mut app = App::new();
        app.add_plugins(WindowPlugin::default());
        app.finish();
        let transform = Transform::from_xyz(1.0, 2.0, 6.0).looking_at(Vec3::ZERO, Vec3::Y);
        let own = OrbitCamera::looking_at(Vec3::Z, Vec3::X);
        let camera = app.world_mut().spawn((Camera::default(), transform)).id();
        let with_own = app.world_mut().spawn((Camera::default(), own.clone())).id();
        let riding = app.world_mut().spawn((Camera::default(), ChildOf(camera))).id();
        app.update();
        app.update();
        let world = app.world();
        let orbit = world.get::<OrbitCamera>(camera).expect("one was given").orbit;
        // The target is the origin but for rounding.
        assert!(orbit.target.length() < 1e-5, "{}", orbit.target);
        assert_eq!(*world.get::<Transform>(camera).unwrap(), transform);
        assert_eq!(world.get::<OrbitCamera>(with_own).unwrap().orbit, own.orbit);
        assert!(world.get::<OrbitCamera>(riding).is_none(), "a camera that rides on something is left alone");

        app.world_mut().entity_mut(camera).remove::<OrbitCamera>();
        app.update();
        assert!(app.world().get::<OrbitCamera>(camera).is_none(), "taken away is taken away");
    }

    #[test]
    fn works_beside_plugins_that_are_there_already() {
        let mut app = App::new();
        app.add_plugins((InputPlugin, OrbitCameraPlugin, ViewerKeysPlugin, WindowPlugin::default()));
        app.add_plugins((OrbitCameraPlugin, ViewerKeysPlugin));
        app.finish();
        app.update();
    }
}
