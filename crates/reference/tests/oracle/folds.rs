//! The judge on surfaces that the rounding of vertices folds.

use bevy_math::Vec3;
use halfway_lighting::{AlphaMode, Material};
use halfway_mesh::{Mesh, Plane};

use crate::mutants::{all_pixels, assert_caught, moved, on_grid, oracle, snapped, with};
use crate::scene::{Stage, glow};

/// A blended sheet that runs away from the eye and is tilted, so that its far triangles are thinner than a coarse grid:
/// there rounding turns some over, and the sheet is folded.
fn sheet(change: impl Fn(&Mesh) -> Mesh) -> Stage {
    let mut stage = Stage::new();
    let (sine, cosine) = 0.4_f32.sin_cos();
    let tilted = |p: Vec3| Vec3::new(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y, p.z);
    let sheet = moved(&Plane { size: 4.0, divisions: 100 }.into(), |p| tilted(Vec3::new(p.x, -0.3, p.z - 3.2)));
    stage.add(change(&sheet), (Material { opacity: 0.5, ..glow(1.0, 0.6, 0.3) }, AlphaMode::Blend));
    stage
}

#[test]
fn folded_sheets_pass_and_their_holes_are_found() {
    let mut truth = sheet(Mesh::clone);
    let judged = oracle(&mut truth);
    let plain = judged.draw();
    let folded = oracle(&mut sheet(|mesh| snapped(mesh, 16.0))).draw();
    let is_twice = |(x, y): &(u32, u32)| folded.pixel(*x, *y)[0] > 1.2 * plain.pixel(*x, *y)[0];
    assert!(all_pixels().filter(is_twice).count() > 3, "nowhere is the sheet seen twice");
    let verdict = on_grid(&judged, 4, &folded);
    assert!(verdict.is_within(), "{verdict}");
    // Nothing is folded where triangles are large, and nowhere does a fold open the sheet.
    let inside = |x: u32, y: u32| {
        let all = (0..9).map(|i| (f64::from(x + i % 3) - 0.5, f64::from(y + i / 3) - 0.5));
        all.into_iter().all(|(x, y)| judged.probe(x, y).nearest.is_some())
    };
    let inside: Vec<(u32, u32)> = all_pixels().filter(|(x, y)| *x > 0 && *y > 0 && inside(*x, *y)).collect();
    let depth =
        |x: u32, y: u32| judged.probe(f64::from(x) + 0.5, f64::from(y) + 0.5).nearest.map_or(0.0, |it| it.depth);
    let by_depth = |nearest: bool| {
        inside.iter().max_by(|a, b| {
            let [a, b] = [a, b].map(|(x, y)| if nearest { -depth(*x, *y) } else { depth(*x, *y) });
            a.total_cmp(&b)
        })
    };
    let (near, far) = (by_depth(true).expect("a sheet"), by_depth(false).expect("a sheet"));
    assert_caught("a hole far away", &mut truth, &with(&plain, [(*far, [0.0; 3])]));
    let doubled = plain.pixel(near.0, near.1).map(|i| 1.5 * i);
    assert_caught("a fold near by", &mut truth, &with(&plain, [(*near, doubled)]));
}
