//! From transforms and homogeneous coordinates to places.

use bevy_transform::components::{GlobalTransform, Transform};
use glam::{Quat, Vec3, Vec4};
use halfway_lighting::homogeneous::{LightPlace, from_homogeneous};
use halfway_lighting::{light_direction, light_position, rotation_along};

use crate::support::Pcg;

fn global(transform: Transform) -> GlobalTransform {
    GlobalTransform::from(transform)
}

#[test]
fn a_light_shines_along_its_local_minus_z() {
    let rows = [
        ("at rest", Transform::IDENTITY, Vec3::NEG_Z),
        (
            "a quarter turn about Y",
            Transform::from_rotation(Quat::from_rotation_y(core::f32::consts::FRAC_PI_2)),
            Vec3::NEG_X,
        ),
        (
            "looking at a point",
            Transform::from_xyz(0.0, 5.0, 0.0).looking_at(Vec3::new(0.0, 5.0, 9.0), Vec3::Y),
            Vec3::Z,
        ),
        ("scaled", Transform::from_scale(Vec3::new(1.0, 1.0, 1e-30)), Vec3::NEG_Z),
        ("mirrored in z", Transform::from_scale(Vec3::new(1.0, 1.0, -2.0)), Vec3::Z),
        ("flat in x and y", Transform::from_scale(Vec3::new(0.0, 0.0, 3.0)), Vec3::NEG_Z),
    ];
    for (name, transform, expected) in rows {
        let got = light_direction(&global(transform)).unwrap_or_else(|error| panic!("{name}: {error}"));
        // A rotation by an f32 quaternion.
        assert!(got.distance(expected) < 1e-6, "{name}: {got}");
    }
}

#[test]
fn a_light_without_place_or_direction_is_refused() {
    let flat = global(Transform::from_scale(Vec3::new(1.0, 1.0, 0.0)));
    assert_eq!(
        light_direction(&flat).expect_err("no direction").to_string(),
        "GlobalTransform.local −Z axis: the direction is [-0.0, -0.0, -0.0]; expected a finite vector that is not 0"
    );
    let broken = global(Transform::from_scale(Vec3::splat(f32::NAN)));
    light_direction(&broken).expect_err("NaN");
    let lost = global(Transform::from_xyz(0.0, f32::INFINITY, 0.0));
    assert_eq!(
        light_position(&lost).expect_err("an infinite position").to_string(),
        "GlobalTransform.translation: the position is [0.0, inf, 0.0]; expected finite coordinates"
    );
    assert_eq!(light_position(&global(Transform::from_xyz(1.0, 2.0, 3.0))), Ok(Vec3::new(1.0, 2.0, 3.0)));
}

#[test]
fn rotations_turn_minus_z_to_any_direction() {
    let mut rng = Pcg::new(9);
    let random = (0..500).map(|_| Vec3::from_array(rng.direction().map(|x| x as f32)) * 1e-20);
    for along in [Vec3::Z, Vec3::NEG_Z, Vec3::Y, Vec3::NEG_Y, Vec3::X * 1e30].into_iter().chain(random) {
        let rotation = rotation_along(along).expect("a direction");
        let got = light_direction(&global(Transform::from_rotation(rotation))).expect("a direction");
        let expected = (along / along.abs().max_element()).normalize();
        // glam's shortest arc stops 2e-3 rad short of the half turn and takes the half turn itself there.
        assert!(got.distance(expected) < 2e-3, "{along}: {got}");
    }
    assert_eq!(
        rotation_along(Vec3::ZERO).expect_err("no direction").to_string(),
        "Light.direction: the direction is [0.0, 0.0, 0.0]; expected a finite vector that is not 0"
    );
}

#[test]
fn homogeneous_positions() {
    let rows = [
        ("w = 1", Vec4::new(1.0, 2.0, 3.0, 1.0), LightPlace::Point(Vec3::new(1.0, 2.0, 3.0))),
        ("w = 2", Vec4::new(2.0, 4.0, 6.0, 2.0), LightPlace::Point(Vec3::new(1.0, 2.0, 3.0))),
        ("w = -1", Vec4::new(1.0, 2.0, 3.0, -1.0), LightPlace::Point(Vec3::new(-1.0, -2.0, -3.0))),
        ("the origin", Vec4::new(0.0, 0.0, 0.0, 1.0), LightPlace::Point(Vec3::ZERO)),
        ("w = 0", Vec4::new(0.0, 0.0, 5.0, 0.0), LightPlace::Directional(Vec3::Z)),
        ("w = -0", Vec4::new(0.0, -5.0, 0.0, -0.0), LightPlace::Directional(Vec3::NEG_Y)),
        ("w = 0, tiny", Vec4::new(1e-30, 0.0, 0.0, 0.0), LightPlace::Directional(Vec3::X)),
        ("w = 0, huge", Vec4::new(0.0, f32::MAX, 0.0, 0.0), LightPlace::Directional(Vec3::Y)),
    ];
    for (name, position, expected) in rows {
        assert_eq!(from_homogeneous(position), Ok(expected), "{name}");
        assert_eq!(LightPlace::try_from(position), Ok(expected), "{name}");
    }
}

#[test]
fn impossible_homogeneous_positions_are_refused() {
    for (position, printed) in [
        (Vec4::ZERO, "[0.0, 0.0, 0.0, 0.0]"),
        (Vec4::new(f32::NAN, 0.0, 0.0, 1.0), "[NaN, 0.0, 0.0, 1.0]"),
        (Vec4::new(1.0, 0.0, 0.0, f32::INFINITY), "[1.0, 0.0, 0.0, inf]"),
        (Vec4::new(1.0, 0.0, 0.0, 1e-45), "[1.0, 0.0, 0.0, 1e-45]"),
    ] {
        let message = format!(
            "Light.position: the homogeneous position is {printed}; expected finite coordinates, not all 0, with a \
             finite xyz/w"
        );
        assert_eq!(from_homogeneous(position).expect_err("refused").to_string(), message);
    }
}

#[test]
fn a_place_is_a_transform() {
    let point = LightPlace::Point(Vec3::new(1.0, 2.0, 3.0)).transform();
    assert_eq!(light_position(&global(point)), Ok(Vec3::new(1.0, 2.0, 3.0)));
    for toward in [Vec3::Z, Vec3::NEG_Z, Vec3::Y, Vec3::new(0.6, 0.0, -0.8)] {
        let transform = LightPlace::Directional(toward).transform();
        let travels = light_direction(&global(transform)).expect("a direction");
        assert!(travels.distance(-toward) < 1e-6, "toward {toward}, travels {travels}");
    }
}
