//! Lights and camera move; each frame keeps to its tolerance.

use halfway::prelude::*;
use halfway::render::{Adapter, AdapterChoice, Choosing};
use halfway_wild::{Animation, FrameFigures};

/// Of what the environment names, else of a graphics adapter; and the CPU.
fn adapters() -> [Adapter; 2] {
    let named = std::env::var_os("HALFWAY_ADAPTER").is_some();
    let choice = if named { AdapterChoice::default() } else { AdapterChoice::gpu() };
    [choice, AdapterChoice::cpu()].map(|choice| choice.open().unwrap_or_else(|error| panic!("{error}")))
}

fn animation(adapter: Adapter) -> Animation {
    Animation::new(adapter, UVec2::new(96, 64)).unwrap_or_else(|error| panic!("{error}"))
}

/// Of these frames; each is right.
fn figures(animation: &mut Animation, frames: impl Iterator<Item = u32>) -> Vec<FrameFigures> {
    frames.map(|frame| animation.judge_frame(frame).unwrap_or_else(|error| panic!("frame {frame}: {error}"))).collect()
}

/// Some of its 300 frames: one of each five in a row is within ½ step, and the one before it within 8. `halfway-wild
/// --animation 300` judges all.
#[test]
fn each_frame_keeps_to_its_tolerance() {
    // A driver takes far longer to compile a frame's shaders than the CPU takes to draw it.
    for (adapter, places) in adapters().into_iter().zip([3, 8]) {
        let by = adapter.describe();
        let mut animation = animation(adapter);
        // From each of these places five frames in a row.
        let all = figures(&mut animation, (0..places).flat_map(|place| 37 * place..37 * place + 5));
        for steps in Animation::STEPS {
            let of = || all.iter().filter(|figures| figures.steps.to_bits() == steps.to_bits());
            let at_vertices: u64 = of().map(|figures| figures.terms_at_vertices).sum();
            let spent = of().map(|figures| figures.spent).fold(0.0, f64::max);
            println!(
                "{by}, {steps} steps: {at_vertices} terms at vertices in {} frames, {spent:.2} spent",
                of().count()
            );
            assert_eq!(of().count(), places as usize, "{steps} steps");
            assert!(spent <= steps.into(), "{by}, {steps} steps: {spent} spent");
            assert!(steps < 2.0 || at_vertices > 0, "{by}, {steps} steps: nothing is shaded at vertices");
        }
    }
}

/// The same judge finds Gouraud shading in the place of what was chosen, in each of the first frames.
#[test]
fn frames_that_are_shaded_too_cheaply_are_found() {
    let [_, cpu] = adapters();
    let mut animation = animation(cpu).shaded(Shading::Gouraud);
    for frame in 0..3 {
        assert!(animation.judge_frame(frame).is_err(), "frame {frame}");
    }
}

/// What comes again is the same whatever was drawn between, unless choices are kept.
#[test]
fn frames_are_chosen_anew_unless_choices_are_kept() {
    let [_, cpu] = adapters();
    let between = |choosing| {
        let mut animation = animation(cpu.clone()).choosing(choosing);
        // The third of five has 2 steps and the first ½: less is at the vertices, and the rest comes back where it
        // clearly fits.
        let all = figures(&mut animation, [2, 0, 2].into_iter());
        [all[0], all[2]].map(|figures| figures.terms_at_vertices)
    };
    let [first, again] = between(Choosing::Anew);
    assert_eq!(first, again);
    let [first, again] = between(Choosing::Steadily);
    assert!(again < first, "{first}, then {again}");
}
