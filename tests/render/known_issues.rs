//! What is known to be wrong. Each test asserts what happens now, and fails when that is mended: then its case moves to
//! where the right behaviour is tested.

use crate::render::scene::{Lamp, Scene, Thing, directional_light, glowing};
use crate::render::stage::{FULL, Stage};
use halfway::prelude::*;

/// A floor of edge 1, seen from above its middle at a share of its size, looking down at it.
fn low_over_a_floor(height: f32, turn: f32) -> Scene {
    let eye = Vec3::new(0.31 * height, height, 0.2 * height);
    let floor = Thing::new(Plane { size: 1.0, divisions: 1 }).of(glowing(1.0, 1.0, 1.0));
    let mut scene = Scene::seen_from(eye, eye + Vec3::new(0.4, -0.5, -1.0)).with(floor);
    for transform in [&mut scene.eye, &mut scene.things[0].frames[0]] {
        *transform =
            Transform::from_rotation(Quat::from_euler(EulerRot::XYZ, turn, 2.0 * turn, 3.0 * turn)) * *transform;
    }
    scene.camera.near = 0.2 * height;
    scene
}

/// Corners are held in f32, to 10⁻⁷ of the plane's size: seen from lower than about 10⁻⁶ of it they rise above the eye,
/// or past it. `surfaces::a_vast_floor_is_lit_however_low_the_camera_is` has the heights that work.
#[test]
fn a_plane_seen_from_lower_than_a_millionth_of_its_size_loses_coverage() {
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

/// What lies close behind is looked for in other pieces of a mesh, not in the same: where a sheet is wound twice around
/// a cylinder, 0.02 % apart, the inner turn, whose normals point away from the light, shows where the mesh is drawn
/// coarser. A tolerance of 0 pixels keeps it as it is. What is not connected is in `shells`.
#[test]
fn a_turn_close_inside_another_of_the_same_sheet_shows_when_both_are_coarser() {
    const AROUND: u32 = 256;
    let mut stage = Stage::new(128, 128);
    let (mut positions, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for along in 0..=2 * AROUND {
        // No corner of one turn is behind a corner of the other.
        let turns = along as f32 / (AROUND as f32 + 0.4);
        let (sin, cos) = (std::f32::consts::TAU * (turns + 0.3)).sin_cos();
        let out = if turns <= 1.0 { -1.0 } else { 1.0 };
        for across in 0..=64_u32 {
            let y = across as f32 / 32.0 - 1.0;
            positions.push(Vec3::new(sin * (1.0 + 0.0002 * turns), y, cos * (1.0 + 0.0002 * turns)));
            normals.push(out * Vec3::new(sin, 0.0, cos));
            if along < 2 * AROUND && across < 64 {
                let [a, b] = [65 * along + across, 65 * (along + 1) + across];
                indices.extend([a, b, b + 1, a, b + 1, a + 1]);
            }
        }
    }
    let sheet = Mesh::from_parts(positions, Some(normals), None, indices).expect("a sheet");
    let matt = Material { diffuse: LinearRgba::WHITE, ..glowing(0.0, 0.0, 0.0) };
    let mut shown = |levels: Tolerance| -> usize {
        let dark_pixels = |distance: f32| {
            let scene = Scene::seen_from(Vec3::Z * distance, Vec3::ZERO)
                .with(Thing::new(sheet.clone()).of(matt).shaded(Shading::Gouraud))
                .lit(Lamp::directional(directional_light(), Vec3::NEG_Z));
            stage.set(&scene);
            stage.levels(levels);
            let picture = stage.float();
            let middle = picture.width() as f32 / 2.0;
            // Well within the outline, where the outer turn is bright.
            let half = 0.5 * middle / (0.5 * scene.camera.fov_y).tan() / distance;
            let is_within = |x: u32, y: u32| (x as f32 - middle).abs().max((y as f32 - middle).abs()) < half;
            picture.enumerate_pixels().filter(|&(x, y, pixel)| is_within(x, y) && pixel.0[0] < 0.05).count()
        };
        [8.0, 16.0, 32.0].into_iter().map(dark_pixels).sum()
    };
    assert_eq!(shown(FULL), 0);
    let wrong = shown(Tolerance::DEFAULT);
    assert!(wrong > 0, "mended: a turn of a sheet hides what is close inside in the same sheet");
}
