//! Rows that the CPU draws under every adapter: drivers exceed the bars for four samples with a mask or an environment
//! (llvmpipe by up to 5e-2 of the range where a triangle covers part of a pixel, for an unknown reason), and the
//! planted faults test the judge. They are the same on every adapter: `cargo xtask test` runs them once, with all
//! tests, and not again on the adapters that it tests afterwards.

use super::{FLOAT, Row, SIZE, Scene, conform_on, environment, maps};
use crate::render::compare::judge;
use crate::render::stage::Stage;
use halfway::reference::Image;

fn stage() -> Stage {
    Stage::on_the_cpu(SIZE.x, SIZE.y)
}

#[test]
fn every_mask_conforms_with_four_samples() {
    conform_on(stage(), "masks, four samples", &maps::rows_of_masks_with_four_samples());
}

#[test]
fn environments_conform_with_four_samples() {
    conform_on(stage(), "environment, four samples", &environment::rows_of_four());
}

/// Planted faults: of a mask, a cutoff that is off by 0.06, and none; of an environment, one that is turned, and one
/// that is brighter.
#[test]
fn faults_are_found_with_four_samples() {
    let mut stage = stage();
    let faults: [(Vec<Row>, [fn(&mut Scene); 2]); 2] = [
        (
            maps::rows_of_masks_with_four_samples(),
            [
                |scene| scene.things.iter_mut().for_each(|thing| thing.mask = thing.mask.map(|cutoff| cutoff + 0.06)),
                |scene| scene.things.iter_mut().for_each(|thing| thing.mask = None),
            ],
        ),
        (
            environment::rows_of_four(),
            [
                |scene| scene.environment.as_mut().expect("one").rotation += 0.1,
                |scene| scene.environment.as_mut().expect("one").strength *= 1.05,
            ],
        ),
    ];
    for (rows, faults) in &faults {
        for (Row { name, scene, float, .. }, (number, fault)) in
            // Of masks on one side and of mirrors alone; the others take long.
            rows
                .iter()
                .filter(|row| row.name.ends_with("one side") || row.name.ends_with("a mirror"))
                .flat_map(|row| faults.iter().enumerate().map(move |fault| (row, fault)))
        {
            let mut wrong = scene.clone();
            fault(&mut wrong);
            let picture = stage.draw(&wrong);
            stage.set(scene);
            stage.frame();
            let (verdict, _) = judge(&mut stage, &Image::from_float(&picture), float.until_wrong());
            assert!(!verdict.is_within(), "{name}: fault {number} is not found");
        }
    }
}

/// A planted fault: each image that is left out is found where opacity counts.
#[test]
fn an_image_that_is_left_out_is_found() {
    let rows = maps::rows_of_all_kinds();
    let whole = &rows.iter().find(|row| row.name == "all, phong, both sides, blended").expect("a row").scene;
    let mut stage = stage();
    for number in 0..whole.things[0].maps.len() {
        let mut without = whole.clone();
        without.things.iter_mut().for_each(|thing| drop(thing.maps.remove(number)));
        let picture = Image::from_float(&stage.draw(&without));
        stage.set(whole);
        stage.frame();
        let (verdict, _) = judge(&mut stage, &picture, FLOAT.until_wrong());
        assert!(!verdict.is_within(), "without {:?}: {verdict}", whole.things[0].maps[number].0);
    }
}
