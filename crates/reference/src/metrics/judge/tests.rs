//! The judgement of single pixels, with made-up surroundings.

use super::*;
use std::sync::atomic::AtomicUsize;

const SIZE: u32 = 40;

/// A ramp from 0 to 1, left to right.
fn ramp() -> Image {
    let pixels = (0..SIZE * SIZE).map(|i| [f64::from(i % SIZE) / f64::from(SIZE - 1); 3]);
    Image::new(SIZE, SIZE, pixels.collect())
}

fn with(image: &Image, changes: &[((u32, u32), [f64; 3])]) -> Image {
    let mut pixels = image.pixels().to_vec();
    for ((x, y), pixel) in changes {
        pixels[(y * SIZE + x) as usize] = *pixel;
    }
    Image::new(SIZE, SIZE, pixels)
}

/// Pixels that may show these greys, and all between the two of each pair.
fn pixels<const N: usize>(is_edge: bool, greys: [[f64; 2]; N]) -> impl Fn(u32, u32) -> Possible {
    move |_, _| Possible {
        is_edge,
        ranges: greys.map(|[low, high]| ColorRange { low: [low; 3], high: [high; 3] }).to_vec(),
        layers: 0,
    }
}

fn float(surroundings: impl Fn(u32, u32) -> Possible + Sync, actual: &Image) -> Verdict {
    judge_with(surroundings, Samples::One, &ramp(), actual, Bars::FLOAT).expect("one size")
}

fn no_possible_colors(x: u32, y: u32) -> Possible {
    panic!("({x}, {y}) is within the bar")
}

#[test]
fn pixels_within_the_bar_are_not_asked_about() {
    let slightly_off = Image::new(SIZE, SIZE, ramp().pixels().iter().map(|p| p.map(|i| i + 1.5e-4)).collect());
    let verdict = float(no_possible_colors, &slightly_off);
    assert!(verdict.is_within(), "{verdict}");
    assert!((verdict.most - 1.5e-4).abs() < 1e-9 && (verdict.worst - 1.5e-4).abs() < 1e-9, "{verdict}");
    assert_eq!((verdict.edges, verdict.counted, verdict.equal), (0.0, 1.0, 0.0));
}

/// After the first wrong pixel, only those that other threads are working on are asked.
#[test]
fn few_pixels_are_asked_once_one_is_wrong() {
    let asked = AtomicUsize::new(0);
    let surroundings = |x, y| {
        asked.fetch_add(1, Ordering::Relaxed);
        pixels(true, [[0.2, 0.25], [0.7, 0.7]])(x, y)
    };
    let judged = |actual: &Image, bars| {
        asked.store(0, Ordering::Relaxed);
        let verdict = judge_with(surroundings, Samples::One, &ramp(), actual, bars).expect("one size");
        (verdict.is_within(), asked.load(Ordering::Relaxed))
    };
    let all_wrong = Image::new(SIZE, SIZE, vec![[0.45; 3]; (SIZE * SIZE) as usize]);
    let (is_within, of_all) = judged(&all_wrong, Bars::FLOAT);
    assert!(!is_within && of_all > 1000, "{of_all}");
    let (is_within, few) = judged(&all_wrong, Bars::FLOAT.until_wrong());
    assert!(!is_within && few <= rayon::current_num_threads(), "{few}");
    // A right pixel over the bar is no reason to stop; the one wrong pixel behind it is found.
    let mut changes = vec![((3, 5), [0.2; 3]), ((30, 5), [0.7; 3])];
    assert_eq!(judged(&with(&ramp(), &changes), Bars::FLOAT.until_wrong()), (true, 2));
    changes.push(((10, 39), [0.45; 3]));
    assert!(!judged(&with(&ramp(), &changes), Bars::FLOAT.until_wrong()).0);
}

#[test]
fn only_the_two_sides_of_an_edge_are_right() {
    let found = |value: f64| with(&ramp(), &[((3, 5), [value; 3])]);
    let both_sides = || pixels(true, [[0.2, 0.25], [0.7, 0.7]]);
    for value in [0.2, 0.22, 0.25, 0.251, 0.7, 0.701] {
        let verdict = float(both_sides(), &found(value));
        assert!(verdict.is_within() && verdict.edges > 0.0, "{value}: {verdict}");
    }
    // Colours between the sides belong to neither.
    for (value, nearest) in [(0.8, 0.7), (0.45, 0.25)] {
        let verdict = float(both_sides(), &found(value));
        assert!(!verdict.is_within() && verdict.edges == 0.0, "{verdict}");
        assert_eq!(verdict.at.map(|worst| worst.at), Some((3, 5)));
        assert!(verdict.to_string().contains(&format!("(3, 5) red: {value:.6} instead of {nearest:.6}")), "{verdict}");
    }
}

#[test]
fn the_middle_of_an_edge_has_its_own_bar() {
    let middle = ramp().pixel(3, 5)[0];
    for (off, is_right) in [(1e-3, true), (3e-3, false)] {
        let verdict = float(pixels(true, [[0.7, 0.7]]), &with(&ramp(), &[((3, 5), [middle + off; 3])]));
        assert_eq!(verdict.is_within(), is_right, "{off}: {verdict}");
    }
}

#[test]
fn steep_slopes_have_several_right_values() {
    let found = with(&ramp(), &[((3, 5), [0.09; 3])]);
    for (is_edge, low, within) in [(false, 0.045, true), (false, 0.065, false), (true, 0.065, true)] {
        let verdict = float(pixels(is_edge, [[low, 0.09]]), &found);
        assert_eq!((verdict.is_within(), verdict.edges > 0.0), (within, within), "{low}: {verdict}");
    }
}

#[test]
fn with_four_samples_the_centre_alone_is_wrong_at_an_edge() {
    let judged = |samples: Samples, picture: &Image| {
        judge_with(pixels(true, [[0.4, 0.4]]), samples, &ramp(), picture, Bars::FLOAT).expect("one size")
    };
    assert!(judged(Samples::One, &ramp()).is_within());
    assert!(!judged(Samples::Four, &ramp()).is_within(), "every pixel of the ramp has others beside it");
}

#[test]
fn no_share_of_wrong_pixels_is_excused() {
    // All but one are on edges, and right; the verdict counts them, and still finds the other.
    let all = Image::new(SIZE, SIZE, vec![[1.0; 3]; (SIZE * SIZE) as usize]);
    let verdict = float(pixels(true, [[1.0, 1.0]]), &all);
    assert!(verdict.is_within() && verdict.edges > 0.9, "{verdict}");
    let one = with(&all, &[((3, 5), [0.5; 3])]);
    let verdict = float(pixels(true, [[1.0, 1.0]]), &one);
    assert!(!verdict.is_within(), "{verdict}");
    assert_eq!(verdict.at.map(|worst| worst.at), Some((3, 5)));
}

#[test]
fn bad_numbers_are_never_within() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1e-3] {
        let verdict =
            float(pixels(true, [[f64::NEG_INFINITY, f64::INFINITY]]), &with(&ramp(), &[((7, 2), [0.1, bad, 0.1])]));
        assert!(!verdict.is_within(), "{verdict}");
        assert_eq!((verdict.bad, verdict.first_bad.map(|(at, _)| at)), (1, Some((7, 2))));
        assert!(verdict.to_string().contains("(7, 2)"), "{verdict}");
    }
    // An oracle with NaN gives no picture to judge by.
    let unknown = with(&ramp(), &[((7, 2), [f64::NAN; 3])]);
    let verdict =
        judge_with(pixels(false, [[0.0, 0.0]]), Samples::One, &unknown, &ramp(), Bars::FLOAT).expect("one size");
    assert!(!verdict.is_within() && verdict.worst.is_infinite(), "{verdict}");
}

#[test]
fn bytes_may_be_one_step_off_on_a_hundredth() {
    let encoding = Encoding::Srgb;
    let decode = |byte: u32| [encoding.decode(f64::from(byte) / 255.0); 3];
    let expected = Image::new(SIZE, SIZE, (0..SIZE * SIZE).map(|i| decode(i % SIZE * 6)).collect());
    let off = |by: u32, every: u32| {
        let pixel = |i: u32| decode(i % SIZE * 6 + if i.is_multiple_of(every) { by } else { 0 });
        Image::new(SIZE, SIZE, (0..SIZE * SIZE).map(pixel).collect())
    };
    let judged = |actual: &Image| {
        judge_with(pixels(false, [[0.5, 0.5]]), Samples::One, &expected, actual, Bars::bytes(encoding))
            .expect("one size")
    };
    let (few, many, far) = (judged(&off(1, 101)), judged(&off(1, 50)), judged(&off(2, 400)));
    assert!(few.is_within() && few.worst == 1.0 && few.equal >= 0.99, "{few}");
    assert!(!many.is_within() && many.worst == 1.0 && many.equal < 0.99, "{many}");
    assert!(!far.is_within() && far.worst == 2.0, "{far}");
}

#[test]
fn right_background_does_not_improve_the_figures() {
    let covered: Vec<bool> = (0..SIZE * SIZE).map(|i| i % SIZE < 4).collect();
    let expected = ramp().with_coverage(covered);
    // A wrong pixel of the object, and a right and a wrong one of the background.
    let actual = with(&ramp(), &[((2, 2), [0.5; 3]), ((30, 30), [0.1; 3])]);
    let verdict =
        judge_with(pixels(false, [[0.0, 0.0]]), Samples::One, &expected, &actual, Bars::FLOAT).expect("one size");
    let counted = f64::from(4 * SIZE + 1) / f64::from(SIZE * SIZE);
    assert_eq!((verdict.counted, verdict.at.map(|worst| worst.at)), (counted, Some((30, 30))));
    assert!((verdict.equal - f64::from(4 * SIZE - 1) / f64::from(4 * SIZE + 1)).abs() < 1e-12);
}

#[test]
fn uniform_pictures_are_judged_by_their_brightness() {
    let one = |value: f64| Image::new(2, 2, vec![[value; 3]; 4]);
    for (expected, off, relative) in [(0.5, 0.5005, 1e-3), (0.0, 1e-3, 1e-3)] {
        let verdict = judge_with(pixels(false, [[0.0, 0.0]]), Samples::One, &one(expected), &one(off), Bars::FLOAT)
            .expect("one size");
        assert!((verdict.worst - relative).abs() < 1e-9, "{verdict}");
    }
}
