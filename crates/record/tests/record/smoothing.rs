//! Renormalised frames of the reference renderer depend on the frame before.

use bevy_app::App;
use bevy_math::UVec2;
use halfway_lighting::{Camera, Intensity};
use halfway_record::{FrameToDraw, ReferenceDrawing};
use halfway_render::{Picture, Pixels};
use std::ops::ControlFlow;

/// The red of the background, frame by frame.
const REDS: [f32; 8] = [4.0, 4.0, 2.0, 2.0, 8.0, 0.5, 0.5, 0.5];

/// The divisors of the frames under this policy.
fn divisors(policies: impl Fn(usize) -> Intensity) -> Vec<f64> {
    let mut app = App::new();
    let camera = app.world_mut().spawn(Camera::default()).id();
    let frame = |(number, red): (usize, f32)| {
        let mut view = app.world_mut().get_mut::<Camera>(camera).expect("it was spawned");
        view.intensity = policies(number);
        view.background.red = red;
        let frame = FrameToDraw { number: number as u32, size: UVec2::new(4, 2), pixels: Pixels::Float };
        let picture = ReferenceDrawing::default().picture(&mut app, frame, &|_, _| ControlFlow::Continue(()));
        let Ok(Picture::Float(picture)) = picture else { panic!("a picture of floats") };
        f64::from(red) / f64::from(picture.get_pixel(1, 1).0[0])
    };
    REDS.into_iter().enumerate().map(frame).collect()
}

/// By hand: the first frame has none before it; for later ones the fraction `smoothing` of the last divisor is kept.
fn expected(smoothing: f64) -> Vec<f64> {
    let mut last = None;
    let follow = |red: f32| {
        let own = f64::from(red).max(1.0);
        let now = last.map_or(own, |last: f64| own + smoothing * (last - own));
        last = Some(now);
        now
    };
    REDS.into_iter().map(follow).collect()
}

/// One rounding to f32 each.
const ROUNDING: f64 = 1e-6;

#[test]
fn smoothing_keeps_a_fraction_of_the_last_divisor() {
    for smoothing in [0.0, 0.25, 0.75] {
        let found = divisors(|_| Intensity::Renormalize { smoothing });
        let expected = expected(smoothing.into());
        for (number, (found, expected)) in found.iter().zip(&expected).enumerate() {
            assert!((found / expected - 1.0).abs() < ROUNDING, "{smoothing}, frame {number}: {found} for {expected}");
        }
    }
    // The result without smoothing.
    let (with, without) = (expected(0.75), expected(0.0));
    assert!(with.iter().zip(without).any(|(with, without)| (with / without - 1.0).abs() > 0.5));
}

#[test]
fn another_policy_between_resets_the_divisor() {
    let clamped =
        |number: usize| if number == 4 { Intensity::Clamp } else { Intensity::Renormalize { smoothing: 0.75 } };
    let found = divisors(clamped);
    // Red of 8 is not divided, and the next frame, of 0.5, has no divisor before it.
    assert!((found[4] - 1.0).abs() < ROUNDING && (found[5] - 1.0).abs() < ROUNDING, "{found:?}");
}
