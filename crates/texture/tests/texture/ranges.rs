//! Ranges of images against what filters give.

use halfway_texture::{LevelFilter, Pyramid, Sampling, TexelFilter, TexelImage, TexelRange, Wrap, lookup};

/// Numbers from 0 to 1 that follow from no other.
struct Hashed(u64);

impl Hashed {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f64 / (1_u64 << 24) as f64
    }
}

/// Dark to the left, bright to the right, with single texels that are neither.
fn image(width: u32, height: u32, hashed: &mut Hashed) -> TexelImage {
    let texel = |at: u32| {
        let bright = if 2 * (at % width) < width { 0.05 } else { 0.9 };
        [0; 4].map(|_| if hashed.next() < 0.02 { hashed.next() as f32 } else { bright })
    };
    TexelImage::new(width, height, (0..width * height).map(texel).collect()).expect("an image")
}

fn samplings() -> Vec<Sampling> {
    let mut all = Vec::new();
    for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
        for filter in [TexelFilter::Nearest, TexelFilter::Bilinear, TexelFilter::BSpline, TexelFilter::CatmullRom] {
            for levels in [LevelFilter::None, LevelFilter::Nearest, LevelFilter::Linear, LevelFilter::Elliptical] {
                all.push(Sampling { wrap: [wrap; 2], magnify: filter, minify: filter, levels });
            }
        }
    }
    all
}

/// How many lookups leave the range that is `made` of that of the part they lie in.
fn outside(made: impl Fn(TexelRange) -> TexelRange) -> usize {
    let mut hashed = Hashed(7);
    let mut outside = 0;
    for size in [[1, 1], [5, 3], [64, 48], [131, 70], [256, 9]] {
        let pyramid = Pyramid::new(image(size[0], size[1], &mut hashed));
        for sampling in samplings() {
            for _ in 0..60 {
                let low = [0; 2].map(|_| (hashed.next() * 4.0 - 2.0) as f32);
                let high = low.map(|low| low + (hashed.next().powi(4) * 1.5) as f32);
                let range = made(pyramid.range_within(sampling, low, high).expect("small texels"));
                for _ in 0..8 {
                    let uv = [0, 1].map(|k| f64::from(low[k]) + hashed.next() * f64::from(high[k] - low[k]));
                    let footprint = [0; 2].map(|_| [0; 2].map(|_| hashed.next().powi(6) * 0.7));
                    let found = lookup::filtered(&pyramid, &sampling, uv, footprint).map(|x| x as f32);
                    outside += (0..4).filter(|&k| !(range.least[k]..=range.most[k]).contains(&found[k])).count();
                }
            }
        }
    }
    outside
}

#[test]
fn no_lookup_leaves_the_range_of_where_it_is() {
    assert_eq!(outside(|range| range), 0);
    // Planted faults.
    assert!(outside(|range| TexelRange { most: range.most.map(|most| 0.5 * most), ..range }) > 1000);
    assert!(outside(|range| TexelRange { least: range.least.map(|least| least + 0.02), ..range }) > 1000);
}

#[test]
fn what_is_far_does_not_widen_the_range() {
    let mut hashed = Hashed(3);
    let pyramid = Pyramid::new(image(512, 512, &mut hashed));
    let flat = TexelImage::from_fn(512, 512, |x, _| [if x < 496 { 0.1 } else { 0.9 }; 4]).expect("an image");
    let striped = Pyramid::new(flat);
    let of = |pyramid: &Pyramid, levels| {
        let sampling = Sampling { levels, ..Sampling::default() };
        pyramid.range_within(sampling, [0.1, 0.2], [0.3, 0.4]).expect("small texels").most[0]
    };
    assert!(of(&striped, LevelFilter::None) < 0.1001, "of the image itself");
    // Of 8 texels a row the last, a quarter of which is bright, is a neighbour of the first.
    assert!((of(&striped, LevelFilter::Linear) - 0.3).abs() < 1e-3);
    assert!(of(&pyramid, LevelFilter::None) <= 1.0 && pyramid.ranges().bytes() <= 44 * 1024);
    let large = Pyramid::new(TexelImage::from_fn(4, 4, |_, _| [3e38; 4]).expect("an image"));
    assert_eq!(large.range_within(Sampling::default(), [0.0; 2], [1.0; 2]), None);
}
