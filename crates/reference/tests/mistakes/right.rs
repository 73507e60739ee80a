//! Right pictures.

use halfway_lighting::Encoding;
use halfway_reference::Image;
use halfway_reference::marking::{Marker, mistaken_picture};
use halfway_reference::metrics::{Bars, judge};
use halfway_reference::mistakes::Mistakes;
use image::{DynamicImage, RgbImage};

use crate::small;
use crate::task::Task;
use crate::tasks;

pub(crate) fn image(picture: &RgbImage, encoding: Encoding) -> Image {
    Image::from_bytes(&DynamicImage::from(picture.clone()).into_rgba8(), encoding)
}

fn passes(task: &Task, picture: &RgbImage) -> bool {
    let oracle = task.oracle();
    let bars = Bars { equal: 0.0, ..Bars::bytes(task.encoding) };
    let verdict = judge(&oracle, &oracle.draw(), &image(picture, task.encoding), bars).expect("pictures of one size");
    assert!(verdict.counted > 0.05, "{}: {verdict}", task.name);
    verdict.is_within()
}

#[test]
fn a_student_without_mistakes_draws_the_oracles_picture() {
    for task in tasks::all() {
        for clamps in [false, true] {
            let oracle = task.oracle().with_clamping(clamps);
            let (right, mistaken) = (oracle.draw(), oracle.draw_mistaken(Mistakes::NONE));
            for (at, (a, b)) in right.pixels().iter().zip(mistaken.pixels()).enumerate() {
                for k in 0..3 {
                    assert!((a[k] - b[k]).abs() <= 1e-12 * a[k].max(1.0), "{}, pixel {at}: {b:?} for {a:?}", task.name);
                }
            }
        }
    }
}

#[test]
fn right_pictures_of_either_renderer_pass() {
    for task in tasks::all() {
        let oracle = task.oracle();
        let own = mistaken_picture(&oracle, Mistakes::NONE, task.encoding);
        let marker = Marker::new(&oracle, task.encoding);
        for (by, picture) in [("the oracle", own), ("the small renderer", small::draw(&task, Mistakes::NONE))] {
            assert!(passes(&task, &picture), "{} by {by}", task.name);
            let found = marker.diagnose(&image(&picture, task.encoding)).expect("pictures of one size");
            assert!(found.explanations.is_empty() && found.right >= 1.0, "{} by {by}: {found:?}", task.name);
        }
    }
}
