//! Difference pictures.

use colorous::MAGMA;
use halfway_lighting::Encoding::Raw;
use halfway_reference::Image;
use halfway_reference::metrics::{Scale, Unit, difference};
use image::{Rgb, RgbImage};

use crate::grey;

const GREEN: Rgb<u8> = Rgb([0, 220, 90]);
const BLUE: Rgb<u8> = Rgb([0, 200, 255]);

fn magma(share: f64) -> Rgb<u8> {
    let colorous::Color { r, g, b } = MAGMA.eval_continuous(share);
    Rgb([r, g, b])
}

fn steps(steps: &[u32]) -> Vec<f64> {
    steps.iter().map(|step| f64::from(*step) / 255.0).collect()
}

fn holds(picture: &RgbImage, color: Rgb<u8>) -> bool {
    picture.pixels().any(|pixel| *pixel == color)
}

#[test]
fn pixels_have_the_color_of_their_error() {
    let (actual, expected) = (grey(2, &steps(&[100, 103, 104, 100])), grey(2, &steps(&[100, 100, 100, 110])));
    for (upper, colors) in [(None, [0.0, 0.3, 0.4, 1.0]), (Some(5.0), [0.0, 0.6, 0.8, 1.0])] {
        let picture = difference(&actual, &expected, Raw, Scale { upper, ..Scale::default() }).unwrap();
        // Two pixels become 320, and the legend stands below.
        assert_eq!(picture.width(), 320);
        assert!(picture.height() > 320);
        for ((x, y), share) in [(0, 0), (1, 0), (0, 1), (1, 1)].into_iter().zip(colors) {
            for (dx, dy) in [(0, 0), (159, 159)] {
                assert_eq!(*picture.get_pixel(160 * x + dx, 160 * y + dy), magma(share), "({x}, {y})");
            }
        }
        assert!(!holds(&picture, GREEN) && !holds(&picture, BLUE), "nothing to mark");
    }
}

#[test]
fn linear_errors_have_a_scale_of_their_own() {
    let (actual, expected) = (grey(2, &[0.5, 0.5003]), grey(2, &[0.5, 0.5]));
    let picture = difference(&actual, &expected, Raw, Scale { unit: Unit::Linear, upper: None }).unwrap();
    assert_eq!((*picture.get_pixel(0, 0), *picture.get_pixel(319, 0)), (magma(0.0), magma(0.0003 / 0.0005)));
}

#[test]
fn coverage_and_not_finite_pixels_are_marked() {
    let expected = grey(2, &[0.5, 0.5, 0.0, 0.5]).with_coverage(vec![true, true, false, true]);
    let actual = grey(2, &[0.5, 0.0, 0.5, f64::NAN]).with_coverage(vec![true, false, true, true]);
    let picture = difference(&actual, &expected, Raw, Scale::default()).unwrap();
    let at = |x: u32, y: u32| *picture.get_pixel(160 * x, 160 * y);
    assert_eq!([at(0, 0), at(1, 0), at(0, 1), at(1, 1)], [magma(0.0), GREEN, GREEN, BLUE]);
    let legend = image::imageops::crop_imm(&picture, 0, 320, 320, picture.height() - 320).to_image();
    assert!(holds(&legend, GREEN) && holds(&legend, BLUE), "the legend says what the colours are");
}

#[test]
fn large_and_odd_pictures_keep_their_pixels() {
    for (width, height) in [(700, 3), (3, 700), (1, 1), (0, 0)] {
        let image = Image::new(width, height, vec![[0.5; 3]; (width * height) as usize]);
        let picture = difference(&image, &image, Raw, Scale::default()).unwrap();
        assert!(picture.width() >= width.max(320), "{width} × {height}: {:?}", picture.dimensions());
        assert!(picture.height() > height, "{width} × {height}: {:?}", picture.dimensions());
    }
}
