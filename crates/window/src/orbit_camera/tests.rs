//! The orbit camera in an App without a window.

#![expect(clippy::float_cmp, reason = "limits are met exactly, and what nothing moves stays as it is")]

use super::*;
use bevy_ecs::message::Message;
use bevy_input::ButtonState;
use bevy_input::keyboard::Key;
use bevy_input::mouse::{MouseButtonInput, MouseMotion, MouseScrollUnit, MouseWheel};
use bevy_input::touch::TouchPhase;
use bevy_math::Vec3;
use bevy_time::TimeUpdateStrategy;
use halfway_lighting::Viewport;
use std::time::Duration;

const EYE: Vec3 = Vec3::new(0.0, 0.0, 5.0);
/// A few roundings of numbers of about 1.
const ROUNDING: f32 = 1e-5;

struct Stage {
    app: App,
    camera: Entity,
}

impl Stage {
    /// A camera at `EYE` that looks at the origin; a frame lasts `milliseconds`, the picture is 720 high.
    fn new(milliseconds: u64) -> Self {
        let mut app = App::new();
        // Twice, which must not turn twice.
        app.add_plugins((OrbitCameraPlugin, OrbitCameraPlugin));
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(milliseconds)));
        let camera = app.world_mut().spawn(OrbitCamera::looking_at(EYE, Vec3::ZERO)).id();
        app.update();
        Self { app, camera }
    }

    fn orbit(&self) -> Orbit {
        self.app.world().get::<OrbitCamera>(self.camera).unwrap().orbit
    }

    fn transform(&self) -> Transform {
        *self.app.world().get::<Transform>(self.camera).unwrap()
    }

    fn send(&mut self, message: impl Message) -> &mut Self {
        self.app.world_mut().write_message(message);
        self
    }

    fn key(&mut self, key_code: KeyCode, text: &str, state: ButtonState) -> &mut Self {
        let logical_key = Key::Character(text.into());
        let window = Entity::PLACEHOLDER;
        self.send(KeyboardInput { key_code, logical_key, state, text: None, repeat: false, window })
    }

    fn press(&mut self, key_code: KeyCode, text: &str) -> &mut Self {
        self.key(key_code, text, ButtonState::Pressed)
    }

    fn release(&mut self, key_code: KeyCode, text: &str) -> &mut Self {
        self.key(key_code, text, ButtonState::Released)
    }

    fn drag(&mut self, button: MouseButton, x: f32, y: f32) -> &mut Self {
        let window = Entity::PLACEHOLDER;
        self.send(MouseButtonInput { button, state: ButtonState::Pressed, window });
        self.send(MouseMotion { delta: Vec2::new(x, y) });
        self.frames(1);
        self.send(MouseButtonInput { button, state: ButtonState::Released, window });
        self.frames(1)
    }

    fn wheel(&mut self, unit: MouseScrollUnit, y: f32) -> &mut Self {
        let (window, phase) = (Entity::PLACEHOLDER, TouchPhase::Moved);
        self.send(MouseWheel { unit, x: 0.0, y, window, phase }).frames(1)
    }

    fn frames(&mut self, count: usize) -> &mut Self {
        for _ in 0..count {
            self.app.update();
        }
        self
    }
}

fn near(a: f32, b: f32) -> bool {
    (a - b).abs() <= ROUNDING * (1.0 + a.abs())
}

#[test]
fn the_transform_shows_the_orbit() {
    let mut stage = Stage::new(16);
    assert_eq!(stage.transform(), Transform::from_translation(EYE));
    stage.app.world_mut().get_mut::<OrbitCamera>(stage.camera).unwrap().orbit.target = Vec3::X;
    stage.frames(1);
    assert_eq!(stage.transform().translation, EYE + Vec3::X);
}

#[test]
fn left_drags_turn() {
    // Half a turn over 720 pixels.
    let rows = [
        ("right", 360.0, 0.0, -FRAC_PI_2, 0.0),
        ("left", -180.0, 0.0, PI / 4.0, 0.0),
        ("down", 0.0, 180.0, 0.0, PI / 4.0),
        ("up", 0.0, -180.0, 0.0, -PI / 4.0),
        ("down past the pole", 0.0, 720.0, 0.0, crate::PITCH_LIMIT),
        ("up past the pole", 0.0, -9000.0, 0.0, -crate::PITCH_LIMIT),
    ];
    for (name, x, y, yaw, pitch) in rows {
        let mut stage = Stage::new(16);
        stage.drag(MouseButton::Left, x, y);
        let orbit = stage.orbit();
        assert!(near(orbit.yaw, yaw) && near(orbit.pitch, pitch), "{name}: {orbit:?}");
        assert_eq!((orbit.target, orbit.distance), (Vec3::ZERO, 5.0), "{name}");
        assert!(stage.transform().translation.abs_diff_eq(orbit.eye(), ROUNDING), "{name}");
    }
}

#[test]
fn other_drags_pan() {
    // The default camera sees 2·5·tan 22.5° = 4.142 high at the target; a quarter of the picture is 1.0355.
    let quarter = 10.0 * (PI / 8.0).tan() / 4.0;
    for button in [MouseButton::Right, MouseButton::Middle] {
        let mut stage = Stage::new(16);
        stage.drag(button, 180.0, 180.0);
        let orbit = stage.orbit();
        assert!(near(orbit.target.x, -quarter) && near(orbit.target.y, quarter), "{button:?}: {orbit:?}");
        assert_eq!((orbit.yaw, orbit.pitch, orbit.distance), (0.0, 0.0, 5.0), "{button:?}");
    }
    let mut stage = Stage::new(16);
    stage.press(KeyCode::ShiftLeft, "").drag(MouseButton::Left, 180.0, 0.0);
    assert!(near(stage.orbit().target.x, -quarter), "Shift and left: {:?}", stage.orbit());
    assert_eq!(stage.orbit().yaw, 0.0);
}

#[test]
fn panning_follows_the_field_of_view_and_the_area() {
    let mut stage = Stage::new(16);
    stage.app.insert_resource(DragArea(Vec2::new(200.0, 100.0)));
    let camera = Camera::perspective(FRAC_PI_2);
    stage.app.world_mut().entity_mut(stage.camera).insert(camera);
    stage.drag(MouseButton::Right, 50.0, 0.0);
    // 90° see 10 high at a distance of 5, and 50 pixels are half of it.
    assert!(near(stage.orbit().target.x, -5.0), "{:?}", stage.orbit());
}

#[test]
fn the_wheel_zooms_an_orthographic_picture() {
    let mut stage = Stage::new(16);
    let projection = Projection::orthographic(4.0).with_near(1.0);
    stage.app.world_mut().entity_mut(stage.camera).insert(Camera { projection, ..Camera::default() });
    let shown = |stage: &Stage| stage.app.world().get::<Camera>(stage.camera).expect("a camera").projection;
    stage.wheel(MouseScrollUnit::Line, 10.0);
    let nearer = 5.0 * (-1.0_f32).exp();
    assert!(near(shown(&stage).height_at(9.0), 4.0 * (-1.0_f32).exp()), "{:?}", shown(&stage));
    // The plane stays 4 before the target.
    assert!(near(shown(&stage).near(), nearer - 4.0), "{:?}", shown(&stage));
    stage.press(KeyCode::Home, "").frames(1);
    assert!(near(shown(&stage).height_at(9.0), 4.0) && near(shown(&stage).near(), 1.0), "{:?}", shown(&stage));
}

#[test]
fn a_drag_within_one_frame_counts() {
    let mut stage = Stage::new(16);
    let (button, window) = (MouseButton::Left, Entity::PLACEHOLDER);
    stage.send(MouseButtonInput { button, state: ButtonState::Pressed, window });
    stage.send(MouseMotion { delta: Vec2::new(-180.0, 0.0) });
    stage.send(MouseButtonInput { button, state: ButtonState::Released, window }).frames(2);
    assert!(near(stage.orbit().yaw, PI / 4.0), "{:?}", stage.orbit());
}

#[test]
fn moving_without_a_button_does_nothing() {
    let mut stage = Stage::new(16);
    let before = stage.orbit();
    stage.send(MouseMotion { delta: Vec2::new(50.0, 50.0) }).frames(1);
    assert_eq!(stage.orbit(), before);
}

#[test]
fn the_wheel_zooms_exponentially_between_the_limits() {
    let mut stage = Stage::new(16);
    stage.wheel(MouseScrollUnit::Line, 3.0);
    assert!(near(stage.orbit().distance, 5.0 * (-0.3_f32).exp()));
    stage.wheel(MouseScrollUnit::Line, -3.0);
    assert!(near(stage.orbit().distance, 5.0));
    // 100 pixels are a line unless the App says otherwise.
    stage.wheel(MouseScrollUnit::Pixel, 100.0);
    assert!(near(stage.orbit().distance, 5.0 * (-0.1_f32).exp()));
    stage.wheel(MouseScrollUnit::Line, 1e6);
    assert_eq!(stage.orbit().distance, 5.0 * 0.01);
    stage.wheel(MouseScrollUnit::Line, -1e6);
    assert_eq!(stage.orbit().distance, 5.0 * 100.0);
}

#[test]
fn limits_out_of_order_do_not_panic() {
    let mut camera = OrbitCamera::looking_at(EYE, Vec3::ZERO);
    (camera.nearest, camera.farthest) = (2.0, 1.0);
    camera.zoom(f32::NAN);
    camera.zoom(0.5);
    assert_eq!(camera.orbit.distance, 2.0);
}

#[test]
fn arrow_keys_turn_alike_at_any_frame_rate() {
    for (milliseconds, frames) in [(10, 60), (20, 30), (60, 10)] {
        let mut stage = Stage::new(milliseconds);
        stage.press(KeyCode::ArrowRight, "").press(KeyCode::ArrowUp, "").frames(frames);
        let orbit = stage.orbit();
        // 90° a second for 0.6 s; sixty roundings.
        let turned = FRAC_PI_2 * 0.6;
        assert!((orbit.yaw - turned).abs() < 1e-4 && (orbit.pitch - turned).abs() < 1e-4, "{milliseconds}: {orbit:?}");
        stage.release(KeyCode::ArrowRight, "").release(KeyCode::ArrowUp, "").frames(3);
        assert_eq!(stage.orbit(), orbit, "{milliseconds}: still after letting go");
    }
}

#[test]
fn plus_and_minus_zoom_alike_at_any_frame_rate() {
    for (milliseconds, frames) in [(10, 50), (50, 10)] {
        for (key_code, text, expected) in [
            (KeyCode::NumpadAdd, "+", (-0.5_f32).exp()),
            (KeyCode::Equal, "=", (-0.5_f32).exp()),
            (KeyCode::Minus, "-", 0.5_f32.exp()),
        ] {
            let mut stage = Stage::new(milliseconds);
            stage.press(key_code, text).frames(frames);
            let distance = stage.orbit().distance;
            // By e a second for half a second; fifty roundings.
            assert!((distance / 5.0 / expected - 1.0).abs() < 1e-4, "{text} at {milliseconds}: {distance}");
        }
    }
}

#[test]
fn a_zoom_key_is_let_go_whatever_it_types_by_then() {
    let mut stage = Stage::new(10);
    stage.press(KeyCode::Equal, "+").frames(1);
    stage.release(KeyCode::Equal, "=").frames(1);
    let distance = stage.orbit().distance;
    assert_eq!(stage.frames(3).orbit().distance, distance);

    stage.press(KeyCode::Equal, "+").send(KeyboardFocusLost).frames(1);
    let distance = stage.orbit().distance;
    assert_eq!(stage.frames(3).orbit().distance, distance, "after the focus is lost");
}

#[test]
fn a_stall_does_not_make_the_camera_leap() {
    let mut stage = Stage::new(200);
    stage.press(KeyCode::ArrowRight, "").frames(1);
    assert!(near(stage.orbit().yaw, FRAC_PI_2 * LONGEST_FRAME), "{:?}", stage.orbit());
}

#[test]
fn home_and_r_go_back_and_shortcuts_do_not() {
    for (name, key_code, text) in [("Home", KeyCode::Home, ""), ("R", KeyCode::KeyR, "r")] {
        let mut stage = Stage::new(16);
        let start = stage.orbit();
        stage.drag(MouseButton::Left, 100.0, 50.0).wheel(MouseScrollUnit::Line, 4.0);
        let moved = stage.orbit();
        stage.press(KeyCode::ControlLeft, "").frames(1).press(key_code, text).frames(1);
        assert_eq!(stage.orbit(), moved, "Control and {name}");
        stage.release(key_code, text).release(KeyCode::ControlLeft, "").frames(1);
        stage.press(key_code, text).frames(1);
        assert_eq!(stage.orbit(), start, "{name}");
        assert_eq!(stage.transform(), Transform::from_translation(EYE), "{name}");
    }
}

#[test]
fn a_camera_that_something_else_moves_stays_where_it_is_put() {
    let mut stage = Stage::new(16);
    let elsewhere = Transform::from_xyz(3.0, 4.0, 5.0).looking_at(Vec3::ONE, Vec3::Y).with_scale(Vec3::splat(2.0));
    *stage.app.world_mut().get_mut::<Transform>(stage.camera).unwrap() = elsewhere;
    stage.frames(2);
    assert_eq!(stage.transform(), elsewhere);
    assert!(stage.orbit().eye().abs_diff_eq(elsewhere.translation, ROUNDING));
    // And a drag goes on from there.
    stage.drag(MouseButton::Left, 36.0, 0.0);
    let expected = {
        let mut orbit = Orbit::from_transform(&elsewhere, 5.0);
        orbit.turn(-PI / 20.0, 0.0);
        orbit.eye()
    };
    assert!(stage.transform().translation.abs_diff_eq(expected, 4.0 * ROUNDING));
    assert_eq!(stage.transform().scale, Vec3::splat(2.0));
}

#[test]
fn taking_over_leaves_the_picture_as_it_is() {
    let rolled = Transform::from_xyz(0.0, 9.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::X);
    let mut stage = Stage::new(16);
    let camera = stage.app.world_mut().spawn((OrbitCamera::resume(&rolled, 9.0), rolled)).id();
    stage.frames(3);
    assert_eq!(*stage.app.world().get::<Transform>(camera).unwrap(), rolled);
}

/// Two cameras side by side, the right one over a third of the picture in the middle, in a picture of 900 × 720.
struct Shared {
    stage: Stage,
    cameras: [Entity; 3],
}

impl Shared {
    fn new() -> Self {
        let mut stage = Stage::new(16);
        let world = stage.app.world_mut();
        world.despawn(stage.camera);
        world.insert_resource(Pointer { at: None, picture: UVec2::new(900, 720) });
        let viewports = [
            Viewport::fractions([0.0, 0.0, 0.5, 1.0]).with_order(-1),
            Viewport::fractions([0.5, 0.0, 0.5, 0.5]),
            Viewport::pixels([300, 0, 300, 720]).with_order(1),
        ];
        let orbit = || (Camera::default(), OrbitCamera::looking_at(EYE, Vec3::ZERO));
        let cameras = viewports.map(|viewport| world.spawn((orbit(), viewport)).id());
        stage.app.update();
        Self { stage, cameras }
    }

    fn point(&mut self, x: f32, y: f32) -> &mut Self {
        self.stage.app.world_mut().resource_mut::<Pointer>().at = Some(Vec2::new(x, y));
        self
    }

    /// The yaw of each camera in eighths of a turn.
    fn yaws(&self) -> [f32; 3] {
        let yaw = |camera| self.stage.app.world().get::<OrbitCamera>(camera).expect("an orbit").orbit.yaw;
        self.cameras.map(|camera| (yaw(camera) / (PI / 4.0) * 1e3).round() / 1e3)
    }
}

#[test]
fn of_cameras_that_share_the_picture_the_one_under_the_pointer_moves() {
    let rows = [
        ("the left one", [100.0, 300.0], [1.0, 0.0, 0.0]),
        // Its part is half as high: a drag turns it twice as far.
        ("the right one", [700.0, 100.0], [0.0, 2.0, 0.0]),
        ("the one over both", [440.0, 300.0], [0.0, 0.0, 1.0]),
        ("the one over both, at its edge", [300.0, 0.0], [0.0, 0.0, 1.0]),
        ("none: the first", [700.0, 700.0], [1.0, 0.0, 0.0]),
    ];
    for (name, [x, y], expected) in rows {
        let mut shared = Shared::new();
        shared.point(x, y).stage.drag(MouseButton::Left, -180.0, 0.0);
        assert_eq!(shared.yaws(), expected, "{name}");
    }
}

#[test]
fn a_drag_keeps_its_camera_until_the_button_is_released() {
    let mut shared = Shared::new();
    let (button, window) = (MouseButton::Left, Entity::PLACEHOLDER);
    shared.point(100.0, 300.0).stage.send(MouseButtonInput { button, state: ButtonState::Pressed, window }).frames(1);
    shared.point(700.0, 100.0).stage.send(MouseMotion { delta: Vec2::new(-180.0, 0.0) }).frames(1);
    assert_eq!(shared.yaws(), [1.0, 0.0, 0.0]);
    // The pointer moves on in the frame of the release.
    shared.stage.send(MouseMotion { delta: Vec2::new(-180.0, 0.0) });
    shared.stage.send(MouseButtonInput { button, state: ButtonState::Released, window }).frames(1);
    assert_eq!(shared.yaws(), [2.0, 0.0, 0.0]);
    shared.stage.drag(MouseButton::Left, -180.0, 0.0);
    assert_eq!(shared.yaws(), [2.0, 2.0, 0.0]);
}

#[test]
fn wheel_and_keys_move_the_camera_under_the_pointer_and_the_last_one_when_it_leaves() {
    let mut shared = Shared::new();
    let distances = |shared: &Shared| {
        let world = shared.stage.app.world();
        shared.cameras.map(|camera| world.get::<OrbitCamera>(camera).expect("an orbit").orbit.distance)
    };
    shared.point(700.0, 100.0).stage.wheel(MouseScrollUnit::Line, 3.0);
    let nearer = 5.0 * (-0.3_f32).exp();
    let found = distances(&shared);
    assert!(found[0] == 5.0 && near(found[1], nearer) && found[2] == 5.0, "{found:?}");
    shared.stage.app.world_mut().resource_mut::<Pointer>().at = None;
    shared.stage.press(KeyCode::ArrowRight, "").frames(10).release(KeyCode::ArrowRight, "").frames(1);
    let yaws = shared.yaws();
    assert!(yaws[0] == 0.0 && yaws[1] > 0.0 && yaws[2] == 0.0, "{yaws:?}");
    // A camera that is gone is not waited for.
    let gone = shared.cameras[1];
    shared.stage.app.world_mut().despawn(gone);
    shared.stage.wheel(MouseScrollUnit::Line, 3.0);
    let first = shared.stage.app.world().get::<OrbitCamera>(shared.cameras[0]).expect("an orbit").orbit.distance;
    assert!(near(first, nearer), "{first}");
}

#[test]
fn another_upright_direction_levels_the_picture_by_it() {
    let mut stage = Stage::new(16);
    stage.app.world_mut().entity_mut(stage.camera).insert(Upright(Vec3::X));
    stage.frames(1);
    let level = |stage: &Stage| (stage.transform().rotation * Vec3::X).dot(Vec3::X).abs() < ROUNDING;
    assert!(level(&stage) && stage.transform().translation.distance(EYE) < ROUNDING, "{:?}", stage.transform());
    stage.drag(MouseButton::Left, 100.0, 50.0);
    assert!(level(&stage), "and stays so while it is turned");
    assert!((stage.transform().rotation * Vec3::Y).dot(Vec3::X) > 0.5, "{:?}", stage.transform());
}
