//! The contents of the pipeline cache, and the frames that wait for it.

use super::*;
use halfway_lighting::record::Cull;

fn numbered(number: u16) -> DrawKey {
    DrawKey { squarings: Some(number as u8), clockwise: number > 255, ..DrawKey::plain() }
}

/// Draws a frame: returns the number of draws by their own pipelines, the awaited pipelines, and the report.
fn frame(
    pipelines: &mut Pipelines,
    gpu: &Gpu,
    compile: Compile,
    keys: &[DrawKey],
) -> (usize, Vec<DrawKey>, FrameReport) {
    frame_into(ShaderOutput::default(), pipelines, gpu, compile, keys)
}

/// The same with another output.
fn frame_into(
    output: ShaderOutput,
    pipelines: &mut Pipelines,
    gpu: &Gpu,
    compile: Compile,
    keys: &[DrawKey],
) -> (usize, Vec<DrawKey>, FrameReport) {
    pipelines.begin(gpu, output, compile);
    let answers: Vec<_> = keys.iter().map(|&key| pipelines.admit(key)).collect();
    let mut report = FrameReport::default();
    let before = pipelines.unforeseen.len();
    report.errors.extend(answers.iter().filter_map(|&key| pipelines.ensure(gpu, key).err()));
    let awaited = pipelines.unforeseen[before..].iter().map(|key| key.draw).collect();
    pipelines.report(&mut report);
    (answers.iter().zip(keys).filter(|(answer, key)| answer == key).count(), awaited, report)
}

#[test]
fn no_special_one_is_awaited_after_the_first_frame() {
    let gpu = Gpu::open_headless().unwrap();
    let mut pipelines = Pipelines::default();
    let (own, awaited, _) = frame(&mut pipelines, &gpu, Compile::Beside, &[DrawKey::plain()]);
    assert_eq!((own, awaited), (1, vec![DrawKey::plain()]));
    // At once, so that the generic one is not built either.
    let other = numbered(3);
    let (own, awaited, report) = frame(&mut pipelines, &gpu, Compile::Beside, &[DrawKey::plain(), other]);
    assert_eq!((own, awaited, report.pipelines_awaited), (1, vec![other.generic()], 1));
    for number in 4..12 {
        let (own, awaited, _) = frame(&mut pipelines, &gpu, Compile::Beside, &[numbered(number)]);
        assert_eq!((own, awaited), (0, vec![]));
    }
    settle(&mut pipelines, &gpu);
    let keys: Vec<_> = (3..12).map(numbered).collect();
    let (own, awaited, report) = frame(&mut pipelines, &gpu, Compile::Beside, &keys);
    assert_eq!((own, awaited, report.pipelines), (9, vec![], 1 + 6 + 9));
}

#[test]
fn a_failed_pipeline_is_reported_and_not_retried() {
    let gpu = Gpu::open_headless().unwrap();
    let mut pipelines = Pipelines::default();
    // No adapter takes three samples a pixel.
    let wrong = ShaderOutput { samples: 3, ..ShaderOutput::default() };
    let (own, _, report) = frame(&mut pipelines, &gpu, Compile::Now, &[DrawKey::plain()]);
    assert_eq!((own, report.pipelines_live, report.errors), (1, 1, vec![]));
    // The first frame tries its own, the second the generic one in its place, which fails as well, in every frame.
    for (own, awaited) in [(1, 1), (0, 1), (0, 0), (0, 0)] {
        let (by_own, _, report) = frame_into(wrong, &mut pipelines, &gpu, Compile::Now, &[DrawKey::plain()]);
        assert!(matches!(&report.errors[..], [RenderError::Device(_)]), "{:?}", report.errors);
        assert_eq!((by_own, report.pipelines_awaited, report.pipelines_live), (own, awaited, 1));
    }
    // In the background: the specialised one fails once, the generic one, which should replace it, in every frame.
    let other = DrawKey { squarings: Some(2), ..DrawKey::plain() };
    let mut errors = 0;
    loop {
        let (own, _, report) = frame_into(wrong, &mut pipelines, &gpu, Compile::Beside, &[other]);
        assert_eq!(own, 0);
        errors = report.errors.len().max(errors);
        if report.pipelines_pending == 0 && errors > 1 {
            break;
        }
        std::thread::yield_now();
    }
    let (_, awaited, report) = frame_into(wrong, &mut pipelines, &gpu, Compile::Beside, &[other]);
    assert_eq!((awaited, report.errors.len()), (vec![], 1));
    assert_eq!(gpu.take_failure(), None);
}

#[test]
fn the_generic_one_draws_where_the_special_one_cannot_be_built() {
    let gpu = Gpu::open_headless().unwrap();
    for compile in [Compile::Now, Compile::Beside] {
        let mut pipelines = Pipelines::default();
        frame(&mut pipelines, &gpu, compile, &[DrawKey::plain().generic()]);
        let failed = || PipelineVariant { used: 0, state: VariantState::Failed(RenderError::Device("broken".into())) };
        let keys = [DrawKey::plain(), DrawKey::plain().looking_up()].map(|key| pipelines.key(key));
        pipelines.variants.extend(keys.map(|key| (key, failed())));
        for _ in 0..3 {
            let (own, awaited, report) = frame(&mut pipelines, &gpu, compile, &[DrawKey::plain()]);
            assert_eq!((own, awaited, report.errors), (0, vec![], vec![]), "{compile:?}");
            assert!(!pipelines.looks_up(DrawKey::plain()), "{compile:?}: each record is a draw");
        }
    }
}

/// Draws empty frames under `Compile::Beside` until no pipeline is pending.
fn settle(pipelines: &mut Pipelines, gpu: &Gpu) -> FrameReport {
    loop {
        let (.., report) = frame(pipelines, gpu, Compile::Beside, &[]);
        if report.pipelines_pending == 0 {
            return report;
        }
        std::thread::yield_now();
    }
}

#[test]
fn a_build_that_panics_fails_alone() {
    let gpu = Gpu::open_headless().unwrap();
    let mut pipelines = Pipelines::default();
    frame(&mut pipelines, &gpu, Compile::Beside, &[DrawKey::plain(), DrawKey::plain().generic()]);
    let (shared, shaders) = (gpu.clone(), Arc::clone(&pipelines.shaders));
    let build = move |wanted: PipelineKey| {
        assert!(wanted.draw != numbered(3), "as a driver may");
        build(&shared, &shaders, wanted)
    };
    pipelines.background = Background::Running(Builder::with_build(build).expect("a thread"));
    // Both are requested; from then on the generic one replaces the one that panics.
    let (.., report) = frame(&mut pipelines, &gpu, Compile::Beside, &[numbered(3), numbered(4)]);
    let mut errors = report.errors;
    // When the panic is collected, the other may still be pending.
    loop {
        let (.., report) = frame(&mut pipelines, &gpu, Compile::Beside, &[]);
        errors.extend(report.errors);
        if report.pipelines_pending == 0 {
            break;
        }
        std::thread::yield_now();
    }
    assert_eq!(errors, [RenderError::Device("as a driver may".into())]);
    for _ in 0..3 {
        let (own, awaited, report) = frame(&mut pipelines, &gpu, Compile::Beside, &[numbered(3), numbered(4)]);
        assert_eq!((own, awaited, report.errors), (1, vec![], vec![]), "told once");
    }
}

#[test]
fn frames_build_for_themselves_where_there_is_no_thread() {
    let gpu = Gpu::open_headless().unwrap();
    let mut pipelines = Pipelines { background: Background::Unavailable, ..Pipelines::default() };
    for number in 0..3 {
        let (own, _, report) = frame(&mut pipelines, &gpu, Compile::Beside, &[numbered(number)]);
        assert_eq!((own, report.pipelines_awaited, report.errors), (1, 1, vec![]));
        assert!(pipelines.looks_up(numbered(number)));
    }
}

#[test]
fn both_passes_fit_in_the_cache_in_one_frame() {
    let gpu = Gpu::open_headless().unwrap();
    let mut pipelines = Pipelines::default();
    let mut draw = |keys: &[DrawKey]| {
        pipelines.begin(&gpu, ShaderOutput::default(), Compile::Now);
        keys.iter().filter(|&&key| pipelines.admit(key) == key).count()
    };
    let all: Vec<_> = (0..MOST_SPECIAL as u16).map(numbered).collect();
    assert_eq!(draw(&all), MOST_SPECIAL);
    for _ in 0..KEPT_FRAMES {
        assert_eq!(draw(&[]), 0);
    }
    let blended = DrawKey { blend: true, cull: Cull::None, ..DrawKey::plain() };
    assert_eq!(blended.passes().count(), 2);
    assert_eq!(draw(&[blended]), 0, "in the first frame nothing is given up for it");
    assert_eq!(draw(&[blended]), 1);
}

#[test]
fn the_least_recently_used_pipeline_is_evicted() {
    let gpu = Gpu::open_headless().unwrap();
    let mut pipelines = Pipelines::default();
    let mut draws = |keys: &[u16]| {
        pipelines.begin(&gpu, ShaderOutput::default(), Compile::Now);
        keys.iter().filter(|&&number| pipelines.admit(numbered(number)) == numbered(number)).count()
    };
    let all: Vec<u16> = (0..MOST_SPECIAL as u16).collect();
    assert_eq!(draws(&all), MOST_SPECIAL);
    // All but two are used further; one of the two in one more frame.
    assert_eq!(draws(&all[1..]), MOST_SPECIAL - 1);
    for _ in 2..=KEPT_FRAMES {
        assert_eq!(draws(&all[2..]), MOST_SPECIAL - 2);
        assert_eq!(draws(&[]), 0);
    }
    assert_eq!(draws(&[200, 201, 202]), 0, "in the first frame nothing is given up for them");
    assert_eq!(draws(&[200, 201, 202]), 2);
    // 0 and 1 were evicted, and nothing else that was used recently.
    assert_eq!(draws(&[0, 1]), 0);
    assert_eq!(draws(&[0, 1]), 0);
    assert_eq!(draws(&all[2..]), MOST_SPECIAL - 2);
    assert_eq!(draws(&[200, 201]), 2);
}
