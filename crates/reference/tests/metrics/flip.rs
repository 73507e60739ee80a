//! The perceived difference.

use halfway_lighting::Encoding::Srgb;
use halfway_reference::Image;
use halfway_reference::metrics::flip;

const SIDE: u32 = 48;

fn plain(value: f64) -> Image {
    Image::new(SIDE, SIDE, vec![[value; 3]; (SIDE * SIDE) as usize])
}

#[test]
fn equal_and_opposite_pictures_end_the_scale() {
    let nothing = flip(&plain(0.5), &plain(0.5), Srgb).unwrap();
    assert_eq!((nothing.mean, nothing.max, nothing.percentiles), (0.0, 0.0, [0.0; 4]));
    let all = flip(&plain(1.0), &plain(0.0), Srgb).unwrap();
    // The paper maps the largest distance of two colours, green and blue, to 1; black and white come close.
    assert!(all.mean > 0.95 && all.max <= 1.0, "{all:?}");
}

#[test]
fn larger_changes_give_larger_values() {
    let spot = |value: f64, side: u32| {
        let inside = |i: u32| (i % SIDE) < side && (i / SIDE) < side;
        let pixel = |i| if inside(i) { [value; 3] } else { [0.5; 3] };
        Image::new(SIDE, SIDE, (0..SIDE * SIDE).map(pixel).collect())
    };
    let of = |image: &Image| flip(image, &plain(0.5), Srgb).unwrap();
    let (faint, strong, wide) = (of(&spot(0.52, 8)), of(&spot(0.7, 8)), of(&spot(0.7, 24)));
    assert!(0.0 < faint.mean && faint.mean < strong.mean && strong.mean < wide.mean, "{faint:?} {strong:?} {wide:?}");
    // 64 of 2304 pixels are 2.8 %, and the eye's blur carries a little beyond them.
    assert!(strong.percentiles[0] == 0.0 && strong.percentiles[2] > 0.1, "{strong:?}");
    assert!(strong.percentiles.is_sorted() && strong.percentiles[3] <= strong.max, "{strong:?}");
}

#[test]
fn sizes_must_agree_and_may_be_zero() {
    let empty = Image::new(0, 0, vec![]);
    assert!(flip(&plain(0.0), &empty, Srgb).is_err());
    assert_eq!(flip(&empty, &empty, Srgb).unwrap().mean, 0.0);
}
