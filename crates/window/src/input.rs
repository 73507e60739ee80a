//! winit's events as `bevy_input`'s messages.

use crate::keys;
use crate::orbit_camera::Pointer;
use bevy_ecs::prelude::*;
use bevy_input::keyboard::{Key, KeyboardFocusLost, KeyboardInput};
use bevy_input::mouse::{MouseButton, MouseButtonInput, MouseMotion, MouseScrollUnit, MouseWheel};
use bevy_input::touch::TouchPhase;
use bevy_input::{ButtonInput, ButtonState};
use bevy_math::DVec2;
use winit::event::{ElementState, KeyEvent, MouseScrollDelta, WindowEvent};

/// Sends the input events of one window into a world.
///
/// `MouseMotion` is the motion of the pointer in logical pixels. Raw device events are not used: their counts are no
/// distance on the screen, and with tablets, touch screens and remote desktops they are positions.
pub(crate) struct Forward {
    window: Entity,
    /// The last position of the pointer, in physical pixels.
    pointer: Option<DVec2>,
}

impl Forward {
    pub(crate) fn new(window: Entity) -> Self {
        Self { window, pointer: None }
    }

    /// Sends `event` if it is input; `scale` is the window's physical pixels a logical one.
    pub(crate) fn event(&mut self, event: &WindowEvent, scale: f64, world: &mut World) {
        match event {
            // A key held while the window gains the focus was not pressed in it.
            WindowEvent::KeyboardInput { event, is_synthetic, .. } if !(*is_synthetic && event.state.is_pressed()) => {
                world.write_message(self.key(event));
            }
            WindowEvent::MouseInput { state, button, .. } => {
                let (button, state) = (mouse_button(*button), button_state(*state));
                world.write_message(MouseButtonInput { button, state, window: self.window });
            }
            WindowEvent::CursorMoved { position, .. } => {
                let position = DVec2::new(position.x, position.y);
                world.get_resource_or_init::<Pointer>().at = Some(position.as_vec2());
                if let Some(before) = self.pointer.replace(position) {
                    let delta = ((position - before) / scale).as_vec2();
                    world.write_message(MouseMotion { delta });
                }
            }
            WindowEvent::CursorLeft { .. } => {
                self.pointer = None;
                world.get_resource_or_init::<Pointer>().at = None;
            }
            WindowEvent::MouseWheel { delta, phase, .. } => {
                world.write_message(self.wheel(*delta, *phase));
            }
            WindowEvent::Focused(false) => self.release_all(world),
            _ => {}
        }
    }

    fn key(&self, event: &KeyEvent) -> KeyboardInput {
        KeyboardInput {
            key_code: keys::physical(event.physical_key),
            logical_key: keys::logical(&event.logical_key),
            state: button_state(event.state),
            text: event.text.as_ref().map(|text| text.as_str().into()),
            repeat: event.repeat,
            window: self.window,
        }
    }

    fn wheel(&self, delta: MouseScrollDelta, phase: winit::event::TouchPhase) -> MouseWheel {
        let (unit, x, y) = match delta {
            MouseScrollDelta::LineDelta(x, y) => (MouseScrollUnit::Line, x, y),
            MouseScrollDelta::PixelDelta(delta) => (MouseScrollUnit::Pixel, delta.x as f32, delta.y as f32),
        };
        let phase = match phase {
            winit::event::TouchPhase::Started => TouchPhase::Started,
            winit::event::TouchPhase::Moved => TouchPhase::Moved,
            winit::event::TouchPhase::Ended => TouchPhase::Ended,
            winit::event::TouchPhase::Cancelled => TouchPhase::Canceled,
        };
        MouseWheel { unit, x, y, window: self.window, phase }
    }

    /// Releases held keys, since their release events may go to another window. `bevy_input` does so by itself for
    /// physical keys only.
    fn release_all(&mut self, world: &mut World) {
        world.write_message(KeyboardFocusLost);
        if let Some(mut keys) = world.get_resource_mut::<ButtonInput<Key>>() {
            keys.release_all();
        }
        let held = world.get_resource::<ButtonInput<MouseButton>>();
        let held: Vec<MouseButton> = held.map(|held| held.get_pressed().copied().collect()).unwrap_or_default();
        let window = self.window;
        let released = |button| MouseButtonInput { button, state: ButtonState::Released, window };
        world.write_message_batch(held.into_iter().map(released));
    }
}

fn button_state(state: ElementState) -> ButtonState {
    match state {
        ElementState::Pressed => ButtonState::Pressed,
        ElementState::Released => ButtonState::Released,
    }
}

fn mouse_button(button: winit::event::MouseButton) -> MouseButton {
    use winit::event::MouseButton as From;
    match button {
        From::Left => MouseButton::Left,
        From::Right => MouseButton::Right,
        From::Middle => MouseButton::Middle,
        From::Back => MouseButton::Back,
        From::Forward => MouseButton::Forward,
        From::Other(number) => MouseButton::Other(number),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_app::App;
    use bevy_input::InputPlugin;
    use bevy_input::keyboard::KeyCode;
    use bevy_input::mouse::{AccumulatedMouseMotion, AccumulatedMouseScroll};
    use bevy_math::Vec2;
    use winit::dpi::PhysicalPosition;
    use winit::event::{DeviceId, MouseButton as From};

    fn stage() -> (App, Forward) {
        let mut app = App::new();
        app.add_plugins(InputPlugin);
        (app, Forward::new(Entity::PLACEHOLDER))
    }

    fn moved(x: f64, y: f64) -> WindowEvent {
        WindowEvent::CursorMoved { device_id: DeviceId::dummy(), position: PhysicalPosition::new(x, y) }
    }

    fn clicked(button: From, state: ElementState) -> WindowEvent {
        WindowEvent::MouseInput { device_id: DeviceId::dummy(), state, button }
    }

    fn motion(app: &mut App) -> Vec2 {
        app.update();
        app.world().resource::<AccumulatedMouseMotion>().delta
    }

    #[test]
    fn motion_is_in_logical_pixels_and_adds_up() {
        let (mut app, mut forward) = stage();
        for event in [moved(100.0, 50.0), moved(110.0, 40.0), moved(120.0, 60.0)] {
            forward.event(&event, 2.0, app.world_mut());
        }
        assert_eq!(motion(&mut app), Vec2::new(10.0, 5.0));
        assert_eq!(motion(&mut app), Vec2::ZERO, "the next frame");
        // The place is in the picture's own pixels.
        assert_eq!(app.world().resource::<Pointer>().at, Some(Vec2::new(120.0, 60.0)));
    }

    #[test]
    fn the_pointer_that_comes_back_elsewhere_has_not_moved() {
        let (mut app, mut forward) = stage();
        let left = WindowEvent::CursorLeft { device_id: DeviceId::dummy() };
        for event in [moved(5.0, 5.0), left] {
            forward.event(&event, 1.0, app.world_mut());
        }
        assert_eq!(app.world().resource::<Pointer>().at, None);
        forward.event(&moved(600.0, 400.0), 1.0, app.world_mut());
        assert_eq!(motion(&mut app), Vec2::ZERO);
    }

    #[test]
    fn mouse_buttons() {
        let rows = [
            (From::Left, MouseButton::Left),
            (From::Right, MouseButton::Right),
            (From::Middle, MouseButton::Middle),
            (From::Back, MouseButton::Back),
            (From::Forward, MouseButton::Forward),
            (From::Other(9), MouseButton::Other(9)),
        ];
        let (mut app, mut forward) = stage();
        for (winit, expected) in rows {
            forward.event(&clicked(winit, ElementState::Pressed), 1.0, app.world_mut());
            app.update();
            assert!(app.world().resource::<ButtonInput<MouseButton>>().pressed(expected), "{expected:?}");
            forward.event(&clicked(winit, ElementState::Released), 1.0, app.world_mut());
            app.update();
            assert!(!app.world().resource::<ButtonInput<MouseButton>>().pressed(expected), "{expected:?}");
        }
    }

    #[test]
    fn the_wheel_in_lines_and_in_pixels() {
        let rows = [
            (MouseScrollDelta::LineDelta(1.0, -2.0), MouseScrollUnit::Line, Vec2::new(1.0, -2.0)),
            (
                MouseScrollDelta::PixelDelta(PhysicalPosition::new(3.0, 40.0)),
                MouseScrollUnit::Pixel,
                Vec2::new(3.0, 40.0),
            ),
        ];
        for (delta, unit, expected) in rows {
            let (mut app, mut forward) = stage();
            let (device_id, phase) = (DeviceId::dummy(), winit::event::TouchPhase::Moved);
            forward.event(&WindowEvent::MouseWheel { device_id, delta, phase }, 1.0, app.world_mut());
            app.update();
            let scroll = app.world().resource::<AccumulatedMouseScroll>();
            assert_eq!((scroll.unit, scroll.delta), (unit, expected));
        }
    }

    #[test]
    fn losing_the_focus_releases_every_key() {
        let (mut app, mut forward) = stage();
        let (key_code, logical_key) = (KeyCode::KeyW, Key::Character("w".into()));
        let (state, window) = (ButtonState::Pressed, Entity::PLACEHOLDER);
        let key =
            KeyboardInput { key_code, logical_key: logical_key.clone(), state, text: None, repeat: false, window };
        app.world_mut().write_message(key);
        forward.event(&clicked(From::Left, ElementState::Pressed), 1.0, app.world_mut());
        app.update();
        assert!(app.world().resource::<ButtonInput<KeyCode>>().pressed(key_code));
        assert!(app.world().resource::<ButtonInput<Key>>().pressed(logical_key));
        assert!(app.world().resource::<ButtonInput<MouseButton>>().pressed(MouseButton::Left));

        forward.event(&WindowEvent::Focused(false), 1.0, app.world_mut());
        app.update();
        assert_eq!(app.world().resource::<ButtonInput<KeyCode>>().get_pressed().len(), 0);
        assert_eq!(app.world().resource::<ButtonInput<Key>>().get_pressed().len(), 0);
        assert_eq!(app.world().resource::<ButtonInput<MouseButton>>().get_pressed().len(), 0);
    }
}
