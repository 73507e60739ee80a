//! The orbit camera: a component with an orbit that mouse and keys move.

use crate::keys;
use crate::orbit::Orbit;
use bevy_app::{App, Plugin, PreUpdate};
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_input::keyboard::{KeyCode, KeyboardFocusLost, KeyboardInput};
use bevy_input::mouse::{AccumulatedMouseMotion, AccumulatedMouseScroll, MouseButton, MouseScrollPixelsPerLine};
use bevy_input::{ButtonInput, InputPlugin, InputSystems};
use bevy_math::{UVec2, Vec2, Vec3};
use bevy_time::{Real, Time, TimePlugin, TimeSystems};
use bevy_transform::components::Transform;
use halfway_lighting::{Camera, Projection, SharedPart, SharingCameras, Upright};
use std::f32::consts::{FRAC_PI_2, PI};

/// A camera that mouse and keys move around a target; needs [`OrbitCameraPlugin`].
///
/// The entity's [`Transform`] follows every change of [`orbit`](Self::orbit). Conversely, if another system moves the
/// `Transform`, the orbit continues from there, with its target `distance` in front of the eye. So an animated camera
/// stays animated, and its scale is left alone. A change of the entity's [`Upright`] levels the picture by it.
#[derive(Component, Clone, Debug, PartialEq)]
#[require(Transform)]
pub struct OrbitCamera {
    /// The current orbit.
    pub orbit: Orbit,
    /// The least distance that zooming reaches, above 0. Default a hundredth of the first one.
    pub nearest: f32,
    /// The greatest distance that zooming reaches, `nearest` or more. Default a hundred times the first one.
    pub farthest: f32,
    /// The view that Home and R return to.
    start: Orbit,
    /// The view that the `Transform` shows.
    shown: Option<Orbit>,
}

impl OrbitCamera {
    /// A camera on `orbit`, to which Home and R return.
    pub fn new(orbit: Orbit) -> Self {
        let (nearest, farthest) = (orbit.distance * 0.01, orbit.distance * 100.0);
        Self { orbit, nearest, farthest, start: orbit, shown: None }
    }

    /// A camera at `eye` that looks at `target`, as [`Orbit::looking_at`].
    pub fn looking_at(eye: Vec3, target: Vec3) -> Self {
        Self::new(Orbit::looking_at(eye, target))
    }

    /// A camera that takes over from `transform` and turns about the point `distance` in front of
    /// it. The picture stays as it is, also at a pole or with a roll, until the camera is moved.
    pub fn resume(transform: &Transform, distance: f32) -> Self {
        Self::resume_upright(transform, distance, Upright::default())
    }

    /// The same with another direction up, once it is moved.
    pub fn resume_upright(transform: &Transform, distance: f32, upright: Upright) -> Self {
        let orbit = Orbit::with_up(transform, distance, upright.0);
        Self { shown: Some(orbit), ..Self::new(orbit) }
    }

    /// Multiplies the distance, between [`nearest`](Self::nearest) and [`farthest`](Self::farthest).
    pub fn zoom(&mut self, factor: f32) {
        self.orbit.distance = (self.orbit.distance * factor).min(self.farthest).max(self.nearest);
    }

    /// Returns to the camera's first orbit.
    pub fn reset(&mut self) {
        self.orbit = self.start;
    }

    /// Applies the user's input, under the camera's projection; returns that of the moved camera.
    fn apply(&mut self, camera_input: &CameraInput, projection: Projection) -> Projection {
        let before = self.orbit.distance;
        if camera_input.reset {
            self.reset();
        }
        if camera_input.turn != Vec2::ZERO {
            self.orbit.turn(camera_input.turn.x, camera_input.turn.y);
        }
        if camera_input.pan != Vec2::ZERO {
            // The height of the picture at the target, so that objects there follow the pointer.
            let height = projection.height_at(self.orbit.distance);
            self.orbit.pan(-camera_input.pan.x * height, camera_input.pan.y * height);
        }
        if camera_input.zoom != 0.0 {
            self.zoom(camera_input.zoom.exp());
        }
        projection.moved(before, self.orbit.distance)
    }
}

/// Moves [`OrbitCamera`]s by `bevy_input`'s mouse and keys, in `PreUpdate`: of cameras that share the picture by a
/// [`Viewport`](halfway_lighting::Viewport), the one under the [`Pointer`], which keeps it until the last button is
/// released; else every one.
///
/// | input | effect |
/// |---|---|
/// | left drag | turns: half a turn over the height of the [`DragArea`], or of its part of it |
/// | right, middle or Shift + left drag | pans: objects at the target follow the pointer |
/// | wheel | zooms, a tenth nearer or farther a line; an orthographic picture shows a tenth less or more |
/// | arrow keys | turn, 90° a second |
/// | + and − | zoom, by e a second |
/// | Home, R | back to the start |
///
/// Keys with Control, Alt or Super are ignored. The plugin needs no window; `InputPlugin` and `TimePlugin` are added
/// where the App has none yet (add your own before). May be added more than once.
#[derive(Clone, Copy, Debug, Default)]
pub struct OrbitCameraPlugin;

impl Plugin for OrbitCameraPlugin {
    fn build(&self, app: &mut App) {
        if app.is_plugin_added::<Self>() {
            return;
        }
        if !app.is_plugin_added::<InputPlugin>() {
            app.add_plugins(InputPlugin);
        }
        if !app.is_plugin_added::<TimePlugin>() {
            app.add_plugins(TimePlugin);
        }
        app.init_resource::<DragArea>()
            .init_resource::<Pointer>()
            .add_systems(PreUpdate, drive.after(InputSystems).after(TimeSystems));
    }

    fn is_unique(&self) -> bool {
        false
    }
}

/// The size of the picture in the unit of `bevy_input`'s mouse motion, which decides how far a drag turns and pans.
/// Default 1280 × 720; a window keeps it at its own size in logical pixels.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct DragArea(pub Vec2);

impl Default for DragArea {
    fn default() -> Self {
        Self(Vec2::new(1280.0, 720.0))
    }
}

/// The place of the pointer on the picture, by which one of several cameras that share the picture is moved. A window keeps
/// it; without one it is nowhere, and the first camera is moved.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct Pointer {
    /// In pixels of the picture, from its upper left corner. Default `None`: beside the picture.
    pub at: Option<Vec2>,
    /// Width and height of the picture in pixels. Default 0 × 0.
    pub picture: UVec2,
}

impl Pointer {
    /// Whether it is on this part of the picture.
    fn is_on(&self, part: &SharedPart) -> bool {
        let [corner, size] = [part.corner, part.size].map(|pixels| UVec2::from(pixels).as_vec2());
        self.at.is_some_and(|at| at.cmpge(corner).all() && at.cmplt(corner + size).all())
    }
}

/// Which of the cameras that share the picture is moved.
#[derive(Default)]
struct Held {
    camera: Option<Entity>,
    /// Whether a button is down, so that the camera keeps it.
    is_dragged: bool,
}

impl Held {
    /// The part of the camera to move, in the frame in which a button is down or not; `None` where no cameras share the
    /// picture.
    fn part(&mut self, is_dragged: bool, pointer: &Pointer, sharing: &SharingCameras) -> Option<SharedPart> {
        let parts = sharing.parts(pointer.picture.max(UVec2::ONE).to_array());
        let was_dragged = std::mem::replace(&mut self.is_dragged, is_dragged);
        // Later cameras lie over earlier ones.
        let under = parts.iter().rev().find(|part| !was_dragged && pointer.is_on(part));
        let kept = || parts.iter().find(|part| Some(part.camera) == self.camera).or(parts.first());
        let part = under.or_else(kept).copied();
        self.camera = part.map(|part| part.camera);
        part
    }
}

/// The input for the cameras in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct CameraInput {
    /// Yaw and pitch in radians.
    turn: Vec2,
    /// The shift of the picture, in its heights, right and down.
    pan: Vec2,
    /// The logarithm of the factor on the distance.
    zoom: f32,
    reset: bool,
}

/// The input of `bevy_input`, and keys by their characters.
#[derive(SystemParam)]
struct Input<'w, 's> {
    keys: Res<'w, ButtonInput<KeyCode>>,
    buttons: Res<'w, ButtonInput<MouseButton>>,
    motion: Res<'w, AccumulatedMouseMotion>,
    scroll: Res<'w, AccumulatedMouseScroll>,
    pixels_per_line: Res<'w, MouseScrollPixelsPerLine>,
    presses: MessageReader<'w, 's, KeyboardInput>,
    focus_lost: MessageReader<'w, 's, KeyboardFocusLost>,
    /// The held + and − keys, stored by key, because the character may have changed at release.
    held: Local<'s, Vec<(KeyCode, f32)>>,
}

/// Turning by arrow keys, radians a second.
const KEY_TURN: f32 = FRAC_PI_2;
/// Zooming by keys, logarithm of the factor a second.
const KEY_ZOOM: f32 = 1.0;
/// Zooming by the wheel, logarithm of the factor a line.
const WHEEL_ZOOM: f32 = 0.1;
/// The longest frame that keys count for, in seconds: after a stall the camera does not leap.
const LONGEST_FRAME: f32 = 0.1;

impl Input<'_, '_> {
    /// The input for a picture of this height, in the unit of the mouse's motion.
    fn camera_input(&mut self, seconds: f32, height: f32) -> CameraInput {
        let reset = self.read_keys();
        let mut camera_input = self.drag(height.max(1.0));
        camera_input.reset = reset;
        let seconds = seconds.min(LONGEST_FRAME);
        if !modified(&self.keys) {
            let axis = |plus, minus| f32::from(self.keys.pressed(plus)) - f32::from(self.keys.pressed(minus));
            let arrows =
                Vec2::new(axis(KeyCode::ArrowRight, KeyCode::ArrowLeft), axis(KeyCode::ArrowUp, KeyCode::ArrowDown));
            camera_input.turn += arrows * KEY_TURN * seconds;
        }
        camera_input.zoom += self.held.iter().map(|&(_, zoom)| zoom).sum::<f32>() * KEY_ZOOM * seconds;
        camera_input.zoom -= self.scroll.to_lines(&self.pixels_per_line).delta.y * WHEEL_ZOOM;
        camera_input
    }

    fn is_dragged(&self) -> bool {
        self.buttons.get_pressed().next().is_some()
    }

    fn drag(&self, height: f32) -> CameraInput {
        let moved = self.motion.delta / height;
        // The pointer also moves in the frame of the release; a quick drag lies within one frame.
        let pressed = |button| self.buttons.pressed(button) || self.buttons.just_released(button);
        let shift = self.keys.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]);
        let left = pressed(MouseButton::Left);
        if pressed(MouseButton::Right) || pressed(MouseButton::Middle) || (left && shift) {
            CameraInput { pan: moved, ..CameraInput::default() }
        } else if left {
            // The scene follows the pointer, so the eye moves the other way.
            CameraInput { turn: Vec2::new(-moved.x, moved.y) * PI, ..CameraInput::default() }
        } else {
            CameraInput::default()
        }
    }

    /// Tracks + and −, and returns whether a reset was requested.
    fn read_keys(&mut self) -> bool {
        let mut reset = false;
        for key in self.presses.read() {
            if !key.state.is_pressed() {
                self.held.retain(|&(held, _)| held != key.key_code);
            } else if !key.repeat && !modified(&self.keys) {
                let command = keys::command(key.key_code, &key.logical_key);
                reset |= key.key_code == KeyCode::Home || command == Some('r');
                match command {
                    Some('+') => self.held.push((key.key_code, -1.0)),
                    Some('-') => self.held.push((key.key_code, 1.0)),
                    _ => {}
                }
            }
        }
        if self.focus_lost.read().count() > 0 {
            self.held.clear();
        }
        reset
    }
}

/// Whether a modifier is held, so that the next key is a shortcut of another program.
pub(crate) fn modified(keys: &ButtonInput<KeyCode>) -> bool {
    use KeyCode::{AltLeft, AltRight, ControlLeft, ControlRight, SuperLeft, SuperRight};
    keys.any_pressed([AltLeft, AltRight, ControlLeft, ControlRight, SuperLeft, SuperRight])
}

type Driven = (
    Entity,
    &'static mut OrbitCamera,
    &'static mut Transform,
    Option<&'static mut Camera>,
    Option<Ref<'static, Upright>>,
);

fn drive(
    mut input: Input,
    (area, pointer): (Res<DragArea>, Res<Pointer>),
    time: Res<Time<Real>>,
    sharing: SharingCameras,
    mut held: Local<Held>,
    mut cameras: Query<Driven>,
) {
    let part = held.part(input.is_dragged(), &pointer, &sharing);
    let share = part.map_or(1.0, |part| part.size[1] as f32 / pointer.picture.y.max(1) as f32);
    let all_input = input.camera_input(time.delta_secs(), area.0.y * share);
    for (entity, mut orbit, mut transform, camera, upright) in &mut cameras {
        let is_moved = part.is_none_or(|part| part.camera == entity);
        let camera_input = if is_moved { all_input } else { CameraInput::default() };
        if transform.is_changed() && orbit.shown == Some(orbit.orbit) {
            let orbit = orbit.bypass_change_detection();
            orbit.orbit = Orbit::with_up(&transform, orbit.orbit.distance, orbit.orbit.up);
            orbit.shown = Some(orbit.orbit);
        }
        if let Some(upright) = upright.filter(|upright| upright.is_changed() && upright.0 != orbit.orbit.up) {
            orbit.orbit = Orbit::with_up(&transform, orbit.orbit.distance, upright.0);
        }
        if camera_input != CameraInput::default() {
            let projection = camera.as_ref().map_or_else(Projection::default, |camera| camera.projection);
            let moved = orbit.apply(&camera_input, projection);
            if let Some(mut camera) = camera
                && moved != projection
            {
                camera.projection = moved;
            }
        }
        if orbit.shown != Some(orbit.orbit) {
            transform.translation = orbit.orbit.eye();
            transform.rotation = orbit.orbit.rotation();
            let orbit = orbit.bypass_change_detection();
            orbit.shown = Some(orbit.orbit);
        }
    }
}

#[cfg(test)]
mod tests;
