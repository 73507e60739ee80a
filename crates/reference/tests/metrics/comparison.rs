//! Comparisons.

use halfway_lighting::Encoding::{Raw, Srgb};
use halfway_reference::Image;
use halfway_reference::metrics::{SizeMismatch, Statistics, compare};

use crate::grey;

#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12, "{found} instead of {expected}");
}

#[test]
fn figures_of_four_pixels() {
    let expected = grey(2, &[0.2, 0.4, 0.6, 1.0]);
    let mut pixels = expected.pixels().to_vec();
    pixels[1][0] += 0.1;
    pixels[2][0] -= 0.3;
    pixels[3][2] += 0.5;
    let comparison = compare(&Image::new(2, 2, pixels), &expected, Raw).unwrap();
    let [red, green, blue] = &comparison.linear.channels;
    let worst = red.worst.unwrap();
    assert_eq!((worst.at, worst.channel, worst.expected), ((0, 1), 0, 0.6));
    near(red.max(), 0.3);
    near(red.mean, 0.1);
    near(red.bias, -0.05);
    near(red.rmse, (0.1_f64 / 4.0).sqrt());
    near(red.percentiles[0], 0.0);
    near(red.percentiles[3], 0.3);
    assert_eq!((green.max(), green.rmse, green.bias), (0.0, 0.0, 0.0));
    near(blue.max(), 0.5);
    let all = &comparison.linear.all;
    assert_eq!(all.worst.map(|worst| (worst.at, worst.channel)), Some(((1, 1), 2)));
    near(all.mean, 0.9 / 12.0);
    near(all.bias, 0.3 / 12.0);
    near(all.rmse, (0.35_f64 / 12.0).sqrt());
    near(comparison.range, 0.8);
    near(comparison.relative(0.4), 0.5);
    // 0.5 is 127.5 steps, rounded away from 0; 0.4 is 102; 0.3 is 76.5. Values above 1 are clamped.
    let steps = &comparison.steps.channels;
    assert_eq!(steps.each_ref().map(Statistics::max), [76.0, 0.0, 0.0]);
    assert_eq!((comparison.equal, comparison.counted), (0.5, 4));
    assert_eq!((comparison.anywhere.steps, comparison.anywhere.at), (76, (0, 1)));
    assert!(comparison.is_within(76) && !comparison.is_within(75));
}

#[test]
fn percentiles_are_nearest_ranks() {
    let expected = Image::new(1000, 1, vec![[0.0; 3]; 1000]);
    let actual = Image::new(1000, 1, (1..=1000).rev().map(|i| [f64::from(i); 3]).collect());
    let comparison = compare(&actual, &expected, Raw).unwrap();
    for statistics in comparison.linear.channels.iter().chain([&comparison.linear.all]) {
        assert_eq!(statistics.percentiles, [500.0, 950.0, 990.0, 999.0]);
    }
    let single = compare(&grey(1, &[0.25]), &grey(1, &[0.5]), Raw).unwrap();
    assert_eq!(single.linear.all.percentiles, [0.25; 4]);
}

#[test]
fn the_first_of_equal_errors_is_named() {
    let expected = grey(2, &[0.5; 4]);
    let mut pixels = expected.pixels().to_vec();
    pixels[3][0] += 0.25;
    pixels[2][1] -= 0.25;
    let worst = compare(&Image::new(2, 2, pixels), &expected, Raw).unwrap().linear.all.worst.unwrap();
    assert_eq!((worst.at, worst.channel), ((0, 1), 1));
}

#[test]
fn steps_are_those_of_the_encoding() {
    // The constants of the standard, by hand: 0.5 is 187.5 and 0.51 is 189.2 of 255.
    for (encoding, steps) in [(Srgb, 1.0), (Raw, 2.0)] {
        let comparison = compare(&grey(1, &[0.51]), &grey(1, &[0.5]), encoding).unwrap();
        assert_eq!(comparison.steps.all.max(), steps, "{encoding:?}");
    }
    let bright = compare(&grey(1, &[1.5]), &grey(1, &[1.0]), Srgb).unwrap();
    assert_eq!((bright.steps.all.max(), bright.linear.all.max(), bright.equal), (0.0, 0.5, 1.0));
}

#[test]
fn coverage_is_counted_apart() {
    let expected = grey(2, &[0.0, 0.0, 0.5, 0.5, 0.5, 0.5]).with_coverage(vec![false, false, false, true, true, true]);
    let actual = grey(2, &[0.0, 0.5, 0.0, 0.0, 0.6, 0.5]).with_coverage(vec![false, true, false, false, true, true]);
    let comparison = compare(&actual, &expected, Raw).unwrap();
    let coverage = comparison.coverage.unwrap();
    assert_eq!((coverage.both, coverage.neither), (2, 2));
    assert_eq!((coverage.only_actual, coverage.only_expected, coverage.different()), (1, 1, 2));
    assert_eq!(coverage.first_difference, Some((1, 0)));
    assert_eq!(comparison.counted, 2);
    near(comparison.linear.all.max(), 0.1);
    near(comparison.equal, 0.5);
    // Tolerances apply to the whole picture: here a background that is not black.
    assert_eq!((comparison.anywhere.steps, comparison.anywhere.at), (128, (1, 0)));
    // If the coverage of one picture is unknown, all pixels count.
    let unknown = compare(&grey(2, &[0.0; 6]), &expected, Raw).unwrap();
    assert_eq!((unknown.coverage, unknown.counted), (None, 6));
    assert!(comparison.to_string().contains("coverage differs on 2 pixels, first at (1, 0)"), "{comparison}");
}

#[test]
fn pixels_that_are_not_finite_are_reported_apart() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let expected = grey(2, &[0.5, 0.5, 0.5, 0.25]);
        let actual = grey(2, &[0.5, bad, 0.5, 0.5]);
        for (a, b) in [(&actual, &expected), (&expected, &actual)] {
            let comparison = compare(a, b, Srgb).unwrap();
            let not_finite = comparison.not_finite.unwrap();
            assert_eq!((not_finite.count, not_finite.first), (1, (1, 0)));
            assert_eq!(comparison.counted, 3);
            assert!((comparison.linear.all.mean - 0.25 / 3.0).abs() < 1e-12 && comparison.range.is_finite());
            assert!(!comparison.is_within(255));
            let [line, table] = [comparison.to_string(), comparison.table().to_string()];
            for text in [line, table] {
                assert!(text.contains("1 pixels") && text.contains("(1, 0)"), "{text}");
            }
        }
    }
    let [a, b] = [f64::NAN, 0.5].map(|value| grey(2, &[value, 0.5]));
    let known = compare(&a.with_coverage(vec![true; 2]), &b.with_coverage(vec![false, true]), Srgb).unwrap();
    assert_eq!(known.coverage.map(|coverage| (coverage.both, coverage.different())), Some((1, 0)));
    let all = compare(&grey(1, &[f64::NAN]), &grey(1, &[f64::NAN]), Srgb).unwrap();
    assert_eq!((all.counted, all.linear.all.worst), (0, None));
    assert!(all.to_string().contains("no pixel to compare"), "{all}");
}

#[test]
fn sizes_that_differ_are_named() {
    let mismatch = compare(&grey(2, &[0.0; 4]), &grey(3, &[0.0; 3]), Srgb).unwrap_err();
    assert_eq!(mismatch, SizeMismatch { actual: (2, 2), expected: (3, 1) });
    let text = mismatch.to_string();
    assert!(text.contains("2 × 2") && text.contains("3 × 1"), "{text}");
}

#[test]
fn pictures_without_pixels_are_equal() {
    let comparison = compare(&Image::new(0, 7, vec![]), &Image::new(0, 7, vec![]), Srgb).unwrap();
    assert_eq!((comparison.counted, comparison.equal, comparison.range), (0, 1.0, 0.0));
    assert!(comparison.is_within(0));
}

#[test]
fn the_line_and_the_table_name_the_largest_error() {
    let mut pixels = vec![[0.5; 3]; 12];
    pixels[7][1] = 0.52;
    let expected = grey(4, &[&[0.25][..], &[0.5; 11]].concat());
    pixels[0] = [0.25; 3];
    let comparison = compare(&Image::new(4, 3, pixels), &expected, Raw).unwrap();
    let line = comparison.to_string();
    assert!(!line.contains('\n'), "{line}");
    for part in ["up to 5 steps", "8.0e-2 of the range", "(3, 1) green: 0.520000 instead of 0.500000", "91.67 % of 12"]
    {
        assert!(line.contains(part), "{part} is missing in: {line}");
    }
    let table = comparison.table().to_string();
    for part in ["4 × 3 pixels", "coverage        not known", "99.9 %", "(3, 1) green: 133 instead of 128"] {
        assert!(table.contains(part), "{part} is missing in:\n{table}");
    }
    let equal = compare(&expected, &expected, Raw).unwrap().to_string();
    assert!(equal.starts_with("equal; 100.00 %"), "{equal}");
}
