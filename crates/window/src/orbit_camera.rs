//! The orbit camera: an orbit on an entity, moved by mouse and keys.

use crate::keys;
use crate::orbit::Orbit;
use bevy_app::{App, Plugin, PreUpdate};
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_input::keyboard::{KeyCode, KeyboardFocusLost, KeyboardInput};
use bevy_input::mouse::{AccumulatedMouseMotion, AccumulatedMouseScroll, MouseButton, MouseScrollPixelsPerLine};
use bevy_input::{ButtonInput, InputPlugin, InputSystems};
use bevy_math::{Vec2, Vec3};
use bevy_time::{Real, Time, TimePlugin, TimeSystems};
use bevy_transform::components::Transform;
use halfway_lighting::{Camera, Projection};
use std::f32::consts::{FRAC_PI_2, PI};

/// A camera that mouse and keys move around a target; needs [`OrbitCameraPlugin`].
///
/// The entity's [`Transform`] follows [`orbit`](Self::orbit), whoever changes it. The other way
/// round too: where something else moves the `Transform`, the orbit goes on from there, `distance`
/// in front of the eye. So an animated camera stays animated, and its scale is left alone.
#[derive(Component, Clone, Debug, PartialEq)]
#[require(Transform)]
pub struct OrbitCamera {
    /// Where the camera is.
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
    /// A camera on `orbit`, which is also where Home and R go back to.
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
        let orbit = Orbit::of(transform, distance);
        Self { shown: Some(orbit), ..Self::new(orbit) }
    }

    /// Multiplies the distance, between [`nearest`](Self::nearest) and [`farthest`](Self::farthest).
    pub fn zoom(&mut self, factor: f32) {
        self.orbit.distance = (self.orbit.distance * factor).min(self.farthest).max(self.nearest);
    }

    /// Goes back to where the camera started.
    pub fn reset(&mut self) {
        self.orbit = self.start;
    }

    /// Moves by what the user asked for, under the camera's projection; returns that of the moved camera.
    fn apply(&mut self, wish: &Wish, projection: Projection) -> Projection {
        let before = self.orbit.distance;
        if wish.reset {
            self.reset();
        }
        if wish.turn != Vec2::ZERO {
            self.orbit.turn(wish.turn.x, wish.turn.y);
        }
        if wish.pan != Vec2::ZERO {
            // The height of the picture at the target: what is there follows the pointer.
            let height = projection.height_at(self.orbit.distance);
            self.orbit.pan(-wish.pan.x * height, wish.pan.y * height);
        }
        if wish.zoom != 0.0 {
            self.zoom(wish.zoom.exp());
        }
        projection.moved(before, self.orbit.distance)
    }
}

/// Moves every [`OrbitCamera`] by `bevy_input`'s mouse and keys, in `PreUpdate`.
///
/// | input | what it does |
/// |---|---|
/// | left drag | turns: half a turn over the height of the [`DragArea`] |
/// | right, middle or Shift + left drag | pans: what is at the target follows the pointer |
/// | wheel | zooms, a tenth nearer or farther a line; an orthographic picture shows a tenth less or more |
/// | arrow keys | turn, 90° a second |
/// | + and − | zoom, by e a second |
/// | Home, R | back to the start |
///
/// Keys with Control, Alt or Super are left to others. Knows no window; `InputPlugin` and
/// `TimePlugin` are added where the App has none yet (add your own before). May be added more than once.
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
        app.init_resource::<DragArea>().add_systems(PreUpdate, drive.after(InputSystems).after(TimeSystems));
    }

    fn is_unique(&self) -> bool {
        false
    }
}

/// The size, in the unit of `bevy_input`'s mouse motion, of the picture that is dragged over: how
/// far a drag turns and pans. Default 1280 × 720; a window keeps it at its own size in logical pixels.
#[derive(Resource, Clone, Copy, Debug, PartialEq)]
pub struct DragArea(pub Vec2);

impl Default for DragArea {
    fn default() -> Self {
        Self(Vec2::new(1280.0, 720.0))
    }
}

/// The input for the cameras in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Wish {
    /// Yaw and pitch in radians.
    turn: Vec2,
    /// Of what is seen, in heights of the picture, right and down.
    pan: Vec2,
    /// The logarithm of the factor on the distance.
    zoom: f32,
    reset: bool,
}

/// `bevy_input`, and the keys that count by their character.
#[derive(SystemParam)]
struct Input<'w, 's> {
    keys: Res<'w, ButtonInput<KeyCode>>,
    buttons: Res<'w, ButtonInput<MouseButton>>,
    motion: Res<'w, AccumulatedMouseMotion>,
    scroll: Res<'w, AccumulatedMouseScroll>,
    pixels_per_line: Res<'w, MouseScrollPixelsPerLine>,
    presses: MessageReader<'w, 's, KeyboardInput>,
    focus_lost: MessageReader<'w, 's, KeyboardFocusLost>,
    /// The + and − keys held. By key, because the character may be another one when it is let go.
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
    fn wish(&mut self, seconds: f32, area: Vec2) -> Wish {
        let reset = self.read_keys();
        let mut wish = self.drag(area.y.max(1.0));
        wish.reset = reset;
        let seconds = seconds.min(LONGEST_FRAME);
        if !modified(&self.keys) {
            let axis = |plus, minus| f32::from(self.keys.pressed(plus)) - f32::from(self.keys.pressed(minus));
            let arrows =
                Vec2::new(axis(KeyCode::ArrowRight, KeyCode::ArrowLeft), axis(KeyCode::ArrowUp, KeyCode::ArrowDown));
            wish.turn += arrows * KEY_TURN * seconds;
        }
        wish.zoom += self.held.iter().map(|&(_, zoom)| zoom).sum::<f32>() * KEY_ZOOM * seconds;
        wish.zoom -= self.scroll.to_lines(&self.pixels_per_line).delta.y * WHEEL_ZOOM;
        wish
    }

    fn drag(&self, height: f32) -> Wish {
        let moved = self.motion.delta / height;
        // In the frame of the release the pointer has moved too; a quick drag is all in one frame.
        let pressed = |button| self.buttons.pressed(button) || self.buttons.just_released(button);
        let shift = self.keys.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]);
        let left = pressed(MouseButton::Left);
        if pressed(MouseButton::Right) || pressed(MouseButton::Middle) || (left && shift) {
            Wish { pan: moved, ..Wish::default() }
        } else if left {
            // The scene follows the pointer, so the eye goes the other way.
            Wish { turn: Vec2::new(-moved.x, moved.y) * PI, ..Wish::default() }
        } else {
            Wish::default()
        }
    }

    /// Keeps account of + and −, and says whether the way back was asked for.
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

/// Whether a key is held that makes a shortcut of others out of the next one.
pub(crate) fn modified(keys: &ButtonInput<KeyCode>) -> bool {
    use KeyCode::{AltLeft, AltRight, ControlLeft, ControlRight, SuperLeft, SuperRight};
    keys.any_pressed([AltLeft, AltRight, ControlLeft, ControlRight, SuperLeft, SuperRight])
}

fn drive(
    mut input: Input,
    area: Res<DragArea>,
    time: Res<Time<Real>>,
    mut cameras: Query<(&mut OrbitCamera, &mut Transform, Option<&mut Camera>)>,
) {
    let wish = input.wish(time.delta_secs(), area.0);
    for (mut orbit, mut transform, camera) in &mut cameras {
        if transform.is_changed() && orbit.shown == Some(orbit.orbit) {
            let orbit = orbit.bypass_change_detection();
            orbit.orbit = Orbit::of(&transform, orbit.orbit.distance);
            orbit.shown = Some(orbit.orbit);
        }
        if wish != Wish::default() {
            let projection = camera.as_ref().map_or_else(Projection::default, |camera| camera.projection);
            let moved = orbit.apply(&wish, projection);
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
