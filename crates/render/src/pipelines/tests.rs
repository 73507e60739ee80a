//! Which pipelines are there, and what waits for them.

use super::*;
use crate::pipeline::tests::key;

fn numbered(number: u16) -> PipelineKey {
    PipelineKey { squarings: Some(number as u8), clockwise: number > 255, ..key() }
}

/// A frame that draws these: how many by their own pipelines, which it waited for, and its report.
fn frame(
    pipelines: &mut Pipelines,
    gpu: &Gpu,
    compile: Compile,
    keys: &[PipelineKey],
) -> (usize, Vec<PipelineKey>, FrameReport) {
    pipelines.begin(gpu, compile);
    let answers: Vec<_> = keys.iter().map(|&key| pipelines.admit(key)).collect();
    let mut report = FrameReport::default();
    let before = pipelines.unforeseen.len();
    report.errors.extend(answers.iter().filter_map(|&key| pipelines.ensure(gpu, key).err()));
    let awaited = pipelines.unforeseen[before..].to_vec();
    pipelines.report(&mut report);
    (answers.iter().zip(keys).filter(|(answer, key)| answer == key).count(), awaited, report)
}

#[test]
fn no_special_one_is_awaited_after_the_first_frame() {
    let gpu = Gpu::open_headless().unwrap();
    let mut pipelines = Pipelines::default();
    let (own, awaited, _) = frame(&mut pipelines, &gpu, Compile::Beside, &[key()]);
    assert_eq!((own, awaited), (1, vec![key()]));
    // At once, so that the generic one is not there either.
    let other = numbered(3);
    let (own, awaited, report) = frame(&mut pipelines, &gpu, Compile::Beside, &[key(), other]);
    assert_eq!((own, awaited, report.pipelines_awaited), (1, vec![other.generic()], 1));
    for number in 4..12 {
        let (own, awaited, _) = frame(&mut pipelines, &gpu, Compile::Beside, &[numbered(number)]);
        assert_eq!((own, awaited), (0, vec![]));
    }
    while frame(&mut pipelines, &gpu, Compile::Beside, &[]).2.pipelines_pending > 0 {
        std::thread::yield_now();
    }
    let keys: Vec<_> = (3..12).map(numbered).collect();
    let (own, awaited, report) = frame(&mut pipelines, &gpu, Compile::Beside, &keys);
    assert_eq!((own, awaited, report.pipelines), (9, vec![], 1 + 6 + 9));
}

#[test]
fn what_cannot_be_built_is_reported_and_not_tried_again() {
    let gpu = Gpu::open_headless().unwrap();
    let mut pipelines = Pipelines::default();
    // No adapter takes three samples a pixel.
    let wrong = PipelineKey { samples: 3, ..key() };
    for (frames, awaited) in [(1, 1), (3, 0)] {
        for _ in 0..frames {
            let (_, _, report) = frame(&mut pipelines, &gpu, Compile::Now, &[wrong, key()]);
            assert!(matches!(&report.errors[..], [RenderError::Device(_)]), "{:?}", report.errors);
            assert_eq!((report.pipelines_awaited, report.pipelines_live), (2 * awaited, 1));
        }
    }
    // Beside the frames: the specialised one once, the generic one, which draws in its place, in every frame.
    let other = PipelineKey { squarings: Some(2), ..wrong };
    let mut errors = 0;
    loop {
        let (own, _, report) = frame(&mut pipelines, &gpu, Compile::Beside, &[other]);
        assert_eq!(own, 0);
        errors = report.errors.len().max(errors);
        if report.pipelines_pending == 0 && errors > 1 {
            break;
        }
        std::thread::yield_now();
    }
    let (_, awaited, report) = frame(&mut pipelines, &gpu, Compile::Beside, &[other]);
    assert_eq!((awaited, report.errors.len()), (vec![], 1));
    assert_eq!(gpu.take_failure(), None);
}

#[test]
fn the_one_unused_for_longest_makes_room() {
    let gpu = Gpu::open_headless().unwrap();
    let mut pipelines = Pipelines::default();
    let mut draws = |keys: &[u16]| {
        pipelines.begin(&gpu, Compile::Now);
        keys.iter().filter(|&&number| pipelines.admit(numbered(number)) == numbered(number)).count()
    };
    let all: Vec<u16> = (0..MOST_SPECIAL as u16).collect();
    assert_eq!(draws(&all), MOST_SPECIAL);
    // All but two are used on; one of the two in one frame more.
    assert_eq!(draws(&all[1..]), MOST_SPECIAL - 1);
    for _ in 2..=KEPT_FRAMES {
        assert_eq!(draws(&all[2..]), MOST_SPECIAL - 2);
        assert_eq!(draws(&[]), 0);
    }
    assert_eq!(draws(&[200, 201, 202]), 0, "in the first frame nothing is given up for them");
    assert_eq!(draws(&[200, 201, 202]), 2);
    // 0 and 1 have been given up, and nothing else that was used lately.
    assert_eq!(draws(&[0, 1]), 0);
    assert_eq!(draws(&[0, 1]), 0);
    assert_eq!(draws(&all[2..]), MOST_SPECIAL - 2);
    assert_eq!(draws(&[200, 201]), 2);
}
