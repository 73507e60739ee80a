//! Known issues. Each test asserts the present behaviour and fails once that is fixed: then its case moves to the tests
//! of the right behaviour.

use crate::render::scene::{Scene, Thing, glowing};
use crate::render::stage::Stage;
use halfway::prelude::*;

/// A floor of edge 1, seen from above its middle at a share of its size, looking down at it.
fn low_over_a_floor(height: f32, turn: f32) -> Scene {
    let eye = Vec3::new(0.31 * height, height, 0.2 * height);
    let floor = Thing::new(Plane { size: 1.0, divisions: 1 }).with_material(glowing(1.0, 1.0, 1.0));
    let mut scene = Scene::seen_from(eye, eye + Vec3::new(0.4, -0.5, -1.0)).with(floor);
    for transform in [&mut scene.eye, &mut scene.things[0].frames[0]] {
        *transform =
            Transform::from_rotation(Quat::from_euler(EulerRot::XYZ, turn, 2.0 * turn, 3.0 * turn)) * *transform;
    }
    scene.camera.projection = scene.camera.projection.with_near(0.2 * height);
    scene
}

/// Corners are held in f32, to 10⁻⁷ of the plane's size: seen from lower than about 10⁻⁶ of it they rise above the eye,
/// or past it. `surfaces::a_vast_floor_is_lit_however_low_the_camera_is` has the heights that work.
#[test]
fn a_plane_seen_from_a_tiny_height_loses_coverage() {
    let mut stage = Stage::new(16, 16);
    let mut missing = |height: f32| -> usize {
        let background = |turn: u8| {
            let picture = stage.draw(&low_over_a_floor(height, 0.13 * f32::from(turn)));
            picture.pixels().filter(|pixel| pixel.0[0] < 0.5).count()
        };
        (0..40).map(background).sum()
    };
    assert_eq!(missing(1e-5), 0, "from a hundred-thousandth of its size the floor fills the picture");
    let lost: usize = [3e-7, 1e-7, 1e-8].into_iter().map(missing).sum();
    assert!(lost > 0, "mended: the floor fills the picture from a hundred-millionth of its size");
}
