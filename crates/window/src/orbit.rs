//! An orbit: the position of an eye on a sphere around a target. Plain geometry, no input.

use bevy_math::{Quat, Vec3};
use bevy_transform::components::Transform;
use std::f32::consts::FRAC_PI_2;

/// The steepest pitch, in radians: a little short of straight up or down, where yaw is undefined.
pub const PITCH_LIMIT: f32 = FRAC_PI_2 - 1e-3;

/// An eye on a sphere around a target, looking at it with one direction up.
///
/// Where that is +Y, eye = target + distance · (cos pitch · sin yaw, sin pitch, cos pitch · cos yaw). For another one all of
/// this is turned by the smallest turn that brings +Y there, as [`View::rotation`](halfway_lighting::View::rotation) has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// The point looked at, in the space of the camera's parent (the world where it has none). Finite.
    pub target: Vec3,
    /// From the target to the eye, in units of length, above 0.
    pub distance: f32,
    /// About [`up`](Self::up), in radians; where that is +Y, 0 looks along −Z and π/2 along −X. Any number; turning keeps it
    /// in [−π, π].
    pub yaw: f32,
    /// Above the horizontal, in radians, in ±[`PITCH_LIMIT`]; positive looks down.
    pub pitch: f32,
    /// The direction that is up in the picture, of any length above 0. Default +Y.
    pub up: Vec3,
}

impl Orbit {
    /// The orbit of an eye at `eye` that looks at `target`.
    ///
    /// An eye straight above or below gets yaw 0; one at the target (or at a distance that is not finite) is placed 1
    /// unit along +Z from it.
    pub fn looking_at(eye: Vec3, target: Vec3) -> Self {
        let backward = eye - target;
        let distance = backward.length();
        if !(distance > 0.0 && distance.is_finite()) {
            return Self { target, distance: 1.0, yaw: 0.0, pitch: 0.0, up: Vec3::Y };
        }
        let (yaw, pitch) = angles(backward, backward.x.atan2(backward.z));
        Self { target, distance, yaw, pitch, up: Vec3::Y }
    }

    /// The orbit of a camera at `transform`, around the point `distance` in front of it, with +Y up. A roll is levelled.
    pub fn from_transform(transform: &Transform, distance: f32) -> Self {
        Self::with_up(transform, distance, Vec3::Y)
    }

    /// The same with another direction up.
    pub fn with_up(transform: &Transform, distance: f32, up: Vec3) -> Self {
        let rotation = turn_to(up).inverse() * transform.rotation;
        let backward = rotation * Vec3::Z;
        // Looking straight down or up, the direction of the picture's top gives the yaw.
        let top = rotation * Vec3::Y * -backward.y.signum();
        let steep = backward.x.hypot(backward.z) < 1e-3;
        let heading = if steep { top } else { backward };
        let (yaw, pitch) = angles(backward, heading.x.atan2(heading.z));
        let target = transform.translation - transform.rotation * Vec3::Z * distance;
        Self { target, distance, yaw, pitch, up }
    }

    /// The position of the eye.
    pub fn eye(&self) -> Vec3 {
        self.target + self.rotation() * Vec3::Z * self.distance
    }

    /// The rotation from the camera's axes to those of its parent.
    pub fn rotation(&self) -> Quat {
        turn_to(self.up) * Quat::from_rotation_y(self.yaw) * Quat::from_rotation_x(-self.pitch)
    }

    /// Turns about the target, in radians; the pitch stops at ±[`PITCH_LIMIT`].
    pub fn turn(&mut self, yaw: f32, pitch: f32) {
        let full = std::f32::consts::TAU;
        let turned = self.yaw + yaw;
        self.yaw = turned - full * (turned / full).round();
        self.pitch = (self.pitch + pitch).clamp(-PITCH_LIMIT, PITCH_LIMIT);
    }

    /// Moves eye and target along the picture's right and up, in units of length.
    pub fn pan(&mut self, right: f32, up: f32) {
        self.target += self.rotation() * Vec3::new(right, up, 0.0);
    }
}

/// The turn that brings +Y to a direction.
fn turn_to(up: Vec3) -> Quat {
    match up.try_normalize() {
        None | Some(Vec3::Y) => Quat::IDENTITY,
        // Every turn about a horizontal axis is as small.
        Some(up) if up.y < -1.0 + 1e-6 => Quat::from_xyzw(0.0, 0.0, 1.0, 0.0),
        Some(up) => Quat::from_rotation_arc(Vec3::Y, up),
    }
}

/// Yaw and pitch of the direction from the target to the eye, of any length.
fn angles(backward: Vec3, yaw: f32) -> (f32, f32) {
    let pitch = backward.y.atan2(backward.x.hypot(backward.z));
    (yaw, pitch.clamp(-PITCH_LIMIT, PITCH_LIMIT))
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "limits are met exactly")]
mod tests {
    use super::*;
    use std::f32::consts::{FRAC_PI_4, PI};

    /// A few roundings of trigonometric functions and of sums of numbers of this size.
    fn close(a: Vec3, b: Vec3) -> bool {
        a.abs_diff_eq(b, 4e-6 * (1.0 + a.length().max(b.length())))
    }

    #[test]
    fn eye_and_target_round_trip() {
        let rows = [
            ("in front", Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO),
            ("behind", Vec3::new(0.0, 0.0, -5.0), Vec3::ZERO),
            ("right", Vec3::new(3.0, 0.0, 0.0), Vec3::ZERO),
            ("above and aside", Vec3::new(1.0, 4.0, -2.0), Vec3::new(0.5, 0.25, 3.0)),
            ("below", Vec3::new(-1.0, -7.0, 2.0), Vec3::new(5.0, 1.0, 1.0)),
            ("far", Vec3::new(2e4, 1e4, -3e4), Vec3::new(10.0, 0.0, 0.0)),
            ("near", Vec3::new(1e-3, 2e-3, 1e-3), Vec3::ZERO),
        ];
        for (name, eye, target) in rows {
            let orbit = Orbit::looking_at(eye, target);
            assert!(close(orbit.eye(), eye), "{name}: {} instead of {eye}", orbit.eye());
            let forward = orbit.rotation() * Vec3::NEG_Z;
            assert!(close(forward, (target - eye).normalize()), "{name}: looks along {forward}");
            let up = orbit.rotation() * Vec3::Y;
            assert!(up.y >= 0.0, "{name}: the picture is upside down");
        }
    }

    /// Whatever is up, the views of the viewer are those of `--view` and `--up`.
    #[test]
    fn another_direction_is_up() {
        use halfway_lighting::View;
        for up in [Vec3::Y, Vec3::Z, Vec3::X, Vec3::NEG_Y, Vec3::NEG_Z, Vec3::new(0.3, -0.2, 2.0)] {
            for (azimuth, elevation) in [(0.0, 0.0), (0.5, 0.4), (-2.0, -1.2)] {
                let orbit = Orbit { up, ..Orbit::looking_at(Vec3::new(0.0, 0.0, 3.0), Vec3::ZERO) };
                let orbit = Orbit { yaw: azimuth, pitch: elevation, ..orbit };
                let view = View { azimuth, elevation }.rotation(up);
                assert!(orbit.rotation().dot(view).abs() > 1.0 - 1e-6, "{up}: {} and {view}", orbit.rotation());
                assert!((orbit.rotation() * Vec3::X).dot(up).abs() < 1e-5, "{up}: the horizon is level");
                let transform = Transform::from_translation(orbit.eye()).with_rotation(orbit.rotation());
                let back = Orbit::with_up(&transform, 3.0, up);
                assert!((back.yaw - azimuth).abs() < 1e-5 && (back.pitch - elevation).abs() < 1e-5, "{back:?}");
                assert!(close(back.target, Vec3::ZERO));
            }
        }
    }

    #[test]
    fn known_angles() {
        let side = Orbit::looking_at(Vec3::new(2.0, 0.0, 0.0), Vec3::ZERO);
        assert_eq!((side.distance, side.yaw, side.pitch), (2.0, FRAC_PI_2, 0.0));
        let above = Orbit::looking_at(Vec3::new(0.0, 1.0, 1.0), Vec3::ZERO);
        assert_eq!((above.yaw, above.pitch), (0.0, FRAC_PI_4));
    }

    #[test]
    fn agrees_with_a_transform_that_looks_at_the_target() {
        let (eye, target) = (Vec3::new(3.0, 2.0, -4.0), Vec3::new(0.0, 1.0, 0.5));
        let transform = Transform::from_translation(eye).looking_at(target, Vec3::Y);
        let orbit = Orbit::looking_at(eye, target);
        // Equal up to sign and rounding.
        assert!(orbit.rotation().dot(transform.rotation).abs() > 1.0 - 1e-6);
        let back = Orbit::from_transform(&transform, orbit.distance);
        assert!(close(back.target, target), "{}", back.target);
        assert!((back.yaw - orbit.yaw).abs() < 1e-5 && (back.pitch - orbit.pitch).abs() < 1e-5, "{back:?}");
    }

    #[test]
    fn a_camera_that_looks_straight_down_or_up_keeps_its_heading() {
        for (name, direction) in [("down", Vec3::NEG_Y), ("up", Vec3::Y)] {
            for yaw in [-2.0, 0.0, 0.7, 3.0_f32] {
                // The direction of the picture's top under this yaw.
                let heading = Vec3::new(-yaw.sin(), 0.0, -yaw.cos());
                let top = heading * if direction.y < 0.0 { 1.0 } else { -1.0 };
                let orbit = Orbit::from_transform(&Transform::IDENTITY.looking_to(direction, top), 2.0);
                assert!((orbit.yaw - yaw).abs() < 1e-4, "{name}: {} instead of {yaw}", orbit.yaw);
                assert_eq!(orbit.pitch.abs(), PITCH_LIMIT, "{name}");
            }
        }
    }

    #[test]
    fn no_eye_to_speak_of() {
        for eye in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
            let orbit = Orbit::looking_at(eye, Vec3::ZERO);
            assert_eq!(orbit.eye(), Vec3::Z, "{eye}");
        }
    }

    #[test]
    fn the_pitch_stops_short_of_the_poles() {
        let mut orbit = Orbit::looking_at(Vec3::Z, Vec3::ZERO);
        orbit.turn(0.0, 10.0);
        assert_eq!(orbit.pitch, PITCH_LIMIT);
        assert!((orbit.rotation() * Vec3::Y).y > 0.0, "up stays up");
        orbit.turn(0.0, -100.0);
        assert_eq!(orbit.pitch, -PITCH_LIMIT);
        let above = Orbit::looking_at(Vec3::new(0.0, 9.0, 0.0), Vec3::ZERO);
        assert_eq!(above.pitch, PITCH_LIMIT);
    }

    #[test]
    fn the_yaw_stays_small_however_often_it_turns() {
        let mut orbit = Orbit::looking_at(Vec3::Z, Vec3::ZERO);
        for _ in 0..1000 {
            orbit.turn(1.0, 0.0);
            assert!(orbit.yaw.abs() <= PI + 1e-6, "{}", orbit.yaw);
        }
    }

    #[test]
    fn panning_moves_along_the_picture() {
        let mut orbit = Orbit::looking_at(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO);
        orbit.pan(2.0, 3.0);
        assert_eq!(orbit.target, Vec3::new(2.0, 3.0, 0.0));
        let mut side = Orbit::looking_at(Vec3::new(5.0, 0.0, 0.0), Vec3::ZERO);
        side.pan(2.0, 0.0);
        assert!(close(side.target, Vec3::new(0.0, 0.0, -2.0)), "{}", side.target);
    }
}
