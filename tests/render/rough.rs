//! Rough surfaces from afar: on the CPU each pixel may go by the corner that is nearest, so that triangles may be
//! larger than where all three corners count.

use crate::render::scene::{Lamp, Scene, Thing, directional_light, material, point_light};
use crate::render::stage::{FULL, Stage};
use halfway::prelude::*;
use halfway::reference::metrics::{Bars, FINENESS, Verdict, judge_moved};
use halfway::reference::{Image, Oracle};

const SIZE: u32 = 64;
/// Of pictures that are judged.
const JUDGED: u32 = 44;
/// Hardly any step: no normal may turn, and nothing but how far corners are tells what will do.
const TOLERANCE: Tolerance = Tolerance { steps: 0.01, pixels: 0.5 };

/// A ball of 25,280 triangles with hills, and with noise of its own for each seed.
fn ball(noise: f32, seed: u32) -> Mesh {
    let smooth = Mesh::from(UvSphere::new(1.0, 160, 80));
    let random = |p: Vec3| {
        let mix = |all: u32, x: f32| (all ^ (x + 2.0).to_bits()).wrapping_mul(0x9E37_79B1).rotate_left(13);
        p.to_array().into_iter().fold(seed, mix) as f32 / u32::MAX as f32
    };
    let moved = smooth.displaced(|i| {
        let p = smooth.positions()[i];
        0.05 * (3.0 * p.x + 1.0).sin() * (4.0 * p.y).sin() + noise * (random(p) - 0.5)
    });
    moved.expect("finite heights").0
}

fn scene(mesh: Mesh, shading: Shading, distance: f32) -> Scene {
    Scene::seen_from(Vec3::new(0.2, 0.35, 0.9).normalize() * distance, Vec3::ZERO)
        .ambient(0.1)
        .with(Thing::new(mesh).of(material()).shaded(shading))
        .lit(Lamp::directional(directional_light(), Vec3::new(-0.6, -0.7, -1.0)))
        .lit(Lamp::point(point_light(), Vec3::new(-3.0, 2.0, 4.0)))
}

/// The triangles that are drawn, once coarser ones are there.
fn drawn(stage: &mut Stage, scene: &Scene, tolerance: Tolerance) -> u64 {
    stage.set(scene);
    stage.levels(tolerance);
    stage.report().triangles
}

/// Gouraud shading goes by all corners.
#[test]
fn rough_surfaces_take_fewer_triangles_by_the_nearest_corner_and_smooth_ones_do_not() {
    let mut stage = Stage::on_the_cpu(SIZE, SIZE);
    for noise in [0.02, 0.0] {
        for distance in [5.0, 8.0, 12.0] {
            let [gouraud, phong, auto] = [Shading::Gouraud, Shading::Phong, Shading::Auto]
                .map(|shading| drawn(&mut stage, &scene(ball(noise, 0), shading, distance), TOLERANCE));
            println!("noise {noise}, from {distance}: {gouraud} triangles by all corners, {phong} and {auto}");
            assert_eq!(phong, auto);
            assert!(if noise > 0.0 { 10 * phong < 9 * gouraud } else { phong == gouraud }, "from {distance}");
        }
    }
    // What reaches before the near plane is cut there, which makes other corners.
    let mut near = scene(ball(0.02, 0), Shading::Phong, 8.0);
    near.camera.near = 7.5;
    let before = drawn(&mut stage, &near, TOLERANCE);
    near.camera.near = 1.0;
    assert!(10 * drawn(&mut stage, &near, TOLERANCE) < 9 * before);
}

/// What judges pictures of a scene: the oracle, and what it draws.
struct Truth {
    oracle: Oracle,
    picture: Image,
    fine: Image,
}

impl Truth {
    /// Of what is on the stage.
    fn new(stage: &mut Stage) -> Self {
        let oracle = stage.oracle();
        let fine = Oracle::new(stage.world(), UVec2::splat(JUDGED * FINENESS)).expect("a scene").draw();
        Self { picture: oracle.draw(), oracle, fine }
    }

    fn judge(&self, picture: &Image, pixels: f64, bars: Bars) -> Verdict {
        let bars = bars.within(TOLERANCE.steps.into());
        judge_moved(&self.oracle, (&self.picture, &self.fine), pixels, picture, bars).expect("one size")
    }
}

/// Where all is noise, nearly all that another surface shows is within the tolerance, too. Within less than half of the
/// pixels that corners may be away the picture is not, nor is what is two pixels away.
#[test]
fn what_the_nearest_corners_show_is_within_the_tolerance() {
    let mut stage = Stage::on_the_cpu(JUDGED, JUDGED);
    for (shading, distance, seed) in [(Shading::Phong, 5.0, 1), (Shading::Auto, 6.0, 2)] {
        let scene = scene(ball(0.02, seed), shading, distance);
        let whole = drawn(&mut stage, &scene, FULL);
        let coarse = drawn(&mut stage, &scene, TOLERANCE);
        assert!(3 * coarse < 2 * whole, "from {distance}: {coarse} of {whole}");
        let picture = Image::from_float(&stage.float());
        drawn(&mut stage, &scene, FULL);
        let truth = Truth::new(&mut stage);
        let verdict = truth.judge(&picture, TOLERANCE.pixels.into(), Bars::FLOAT);
        println!("from {distance}, {coarse} of {whole} triangles: {verdict}");
        assert!(verdict.is_within() && verdict.counted > 0.05, "from {distance}: {verdict}");
        if seed > 1 {
            continue;
        }
        // Half a pixel of sampling is added to this.
        let closer = truth.judge(&picture, -0.25, Bars::FLOAT.until_wrong());
        assert!(!closer.is_within(), "from {distance} within a quarter of a pixel: {closer}");
        let last = (JUDGED * JUDGED) as usize - 1;
        let aside = (0..=last).map(|pixel| picture.pixels()[(pixel + 2).min(last)]).collect();
        let aside = Image::new(JUDGED, JUDGED, aside);
        let aside = truth.judge(&aside, TOLERANCE.pixels.into(), Bars::FLOAT.until_wrong());
        assert!(!aside.is_within(), "from {distance}, two pixels away: {aside}");
    }
}
