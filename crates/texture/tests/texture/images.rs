//! Pyramids and filters: exact cases, and f32 against f64.

use halfway_texture::{LevelFilter, Pyramid, Sampling, TexelFilter, TexelImage, UvTransform, Wrap, lookup};
use proptest::prelude::*;

const FILTERS: [TexelFilter; 4] =
    [TexelFilter::Nearest, TexelFilter::Bilinear, TexelFilter::BSpline, TexelFilter::CatmullRom];
const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];

/// An image whose texels all differ.
fn numbered(width: u32, height: u32) -> Pyramid {
    let texel = |x: u32, y: u32| {
        let number = |seed: u32| f64::from((x * 7919 + y * 104_729 + seed * 31) % 1000) as f32 / 999.0;
        [number(1), number(2), number(3), number(4)]
    };
    Pyramid::new(TexelImage::from_fn(width, height, texel).expect("a small image"))
}

fn mean(texels: &[[f32; 4]]) -> [f64; 4] {
    std::array::from_fn(|k| texels.iter().map(|texel| f64::from(texel[k])).sum::<f64>() / texels.len() as f64)
}

fn distance(a: [f64; 4], b: [f64; 4]) -> f64 {
    (0..4).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max)
}

#[test]
fn every_level_keeps_the_mean_at_four_thirds_of_the_memory() {
    for (width, height) in [(1, 1), (2, 2), (64, 64), (5, 3), (37, 1), (1, 19), (100, 75), (127, 129)] {
        let pyramid = numbered(width, height);
        let levels = pyramid.levels();
        assert_eq!(levels.len() as u32, width.max(height).ilog2() + 1, "{width} × {height}");
        for (number, pair) in levels.windows(2).enumerate() {
            let halves = [pair[0].width, pair[0].height].map(|side| (side / 2).max(1));
            assert_eq!([pair[1].width, pair[1].height], halves);
            let off = distance(mean(pyramid.level(number + 1)), mean(pyramid.level(0)));
            assert!(off < 1e-6, "{width} × {height}, level {}: {off:e}", number + 1);
        }
        let least = levels.iter().map(|level| level.width as usize * level.height as usize).sum::<usize>();
        assert_eq!(pyramid.texels().len(), least);
        if width == 64 {
            assert_eq!(least, (4 * 64 * 64 - 1) / 3);
        }
    }
}

#[test]
fn a_level_is_the_mean_of_the_area_under_it() {
    let row = TexelImage::from_fn(3, 1, |x, _| [x as f32; 4]).expect("three texels");
    // Of three texels one remains; of five two: (0 + 1 + 2/2)/2.5 and (2/2 + 3 + 4)/2.5.
    assert_eq!(Pyramid::new(row).level(1), [[1.0; 4]]);
    let row = TexelImage::from_fn(5, 1, |x, _| [x as f32; 4]).expect("five texels");
    assert_eq!(Pyramid::new(row).level(1), [[0.8; 4], [3.2; 4]]);
}

#[test]
fn filters_agree_with_their_formulas() {
    let pyramid = numbered(7, 5);
    for (y, x) in (0..5).flat_map(|y| (0..7).map(move |x| (y, x))) {
        let texel = pyramid.level(0)[y * 7 + x].map(f64::from);
        let center = [(x as f64 + 0.5) / 7.0, (y as f64 + 0.5) / 5.0];
        for wrap in WRAPS {
            for filter in [TexelFilter::Nearest, TexelFilter::Bilinear, TexelFilter::CatmullRom] {
                let found = lookup::in_level(&pyramid, 0, [wrap; 2], filter, center);
                assert!(distance(found, texel) < 1e-12, "{filter:?} {wrap:?} at {x}, {y}");
            }
        }
    }
    // Halfway between two texels: their mean; of the cubics −1/16, 9/16 and 1/48, 23/48.
    let row = Pyramid::new(TexelImage::from_fn(4, 1, |x, _| [[0.0, 1.0, 0.0, 0.0][x as usize]; 4]).expect("a row"));
    for (filter, expected) in
        [(TexelFilter::Bilinear, 0.5), (TexelFilter::BSpline, 23.0 / 48.0), (TexelFilter::CatmullRom, 9.0 / 16.0)]
    {
        let found: [f64; 4] = lookup::in_level(&row, 0, [Wrap::Repeat; 2], filter, [0.5, 0.5]);
        assert!(distance(found, [expected; 4]) < 1e-12, "{filter:?}: {found:?}");
    }
}

#[test]
fn wrapping_repeats_mirrors_or_clamps() {
    let row = Pyramid::new(TexelImage::from_fn(3, 1, |x, _| [x as f32; 4]).expect("a row"));
    for (wrap, expected) in [
        (Wrap::Repeat, [0.0, 1.0, 2.0, 0.0, 1.0, 2.0, 0.0, 1.0, 2.0]),
        (Wrap::Mirror, [2.0, 1.0, 0.0, 0.0, 1.0, 2.0, 2.0, 1.0, 0.0]),
        (Wrap::Clamp, [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 2.0]),
    ] {
        for (place, expected) in (-3..6).zip(expected) {
            let u = (f64::from(place) + 0.5) / 3.0;
            for filter in [TexelFilter::Nearest, TexelFilter::Bilinear, TexelFilter::CatmullRom] {
                let found = lookup::in_level(&row, 0, [wrap, Wrap::Clamp], filter, [u, 0.5]);
                assert!(distance(found, [expected; 4]) < 1e-9, "{wrap:?} {filter:?} at {place}: {found:?}");
            }
        }
    }
}

#[test]
fn the_level_follows_the_footprints_longer_side() {
    let d = |footprint: [[f64; 2]; 2]| lookup::level([64, 32], footprint);
    assert_eq!(d([[1.0 / 64.0, 0.0], [0.0, 1.0 / 32.0]]), 0.0);
    assert_eq!(d([[4.0 / 64.0, 0.0], [0.0, 1.0 / 32.0]]), 2.0);
    assert_eq!(d([[1.0 / 64.0, 0.0], [0.0, 8.0 / 32.0]]), 3.0);
    // Along the diagonal of three by four texels.
    assert!((d([[3.0 / 64.0, 4.0 / 32.0], [0.0, 0.0]]) - 5_f64.log2()).abs() < 1e-15);
}

#[test]
fn level_filters_choose_their_levels() {
    let pyramid = numbered(16, 16);
    let uv = [0.37_f64, 0.61];
    let of = |levels, d: f64| lookup::at_level(&pyramid, &Sampling { levels, ..Sampling::default() }, uv, d);
    let level = |number| lookup::in_level(&pyramid, number, [Wrap::Repeat; 2], TexelFilter::Bilinear, uv);
    for d in [-3.0, 0.0, f64::NAN] {
        assert_eq!(of(LevelFilter::Linear, d), level(0));
    }
    assert_eq!(of(LevelFilter::None, 3.0), level(0));
    assert_eq!(of(LevelFilter::Nearest, 1.4), level(1));
    assert_eq!(of(LevelFilter::Nearest, 1.5), level(2));
    assert_eq!(of(LevelFilter::Linear, 2.0), level(2));
    let between: [f64; 4] = std::array::from_fn(|k| 0.75 * level(1)[k] + 0.25 * level(2)[k]);
    assert!(distance(of(LevelFilter::Linear, 1.25), between) < 1e-15);
    for d in [4.0, 9.5, f64::INFINITY] {
        assert_eq!(of(LevelFilter::Linear, d), level(4));
        assert_eq!(of(LevelFilter::Nearest, d), level(4));
    }
}

#[test]
fn coordinates_are_scaled_then_rotated_then_translated() {
    let quarter = std::f32::consts::FRAC_PI_2;
    let transform = UvTransform { offset: [0.25, 0.5], rotation: quarter, scale: [2.0, 3.0] };
    let found = UvTransform::apply(&transform.rows(), [1.0_f64, 1.0]);
    // (1, 1) becomes (2, 3), then (3, −2), v running downward.
    assert!((found[0] - 3.25).abs() < 1e-6 && (found[1] + 1.5).abs() < 1e-6, "{found:?}");
    assert_eq!(UvTransform::apply(&UvTransform::default().rows(), [0.3_f64, 0.7]), [0.3, 0.7]);
}

fn any_sampling() -> impl Strategy<Value = Sampling> {
    let filter = || prop::sample::select(FILTERS.to_vec());
    let wrap = || prop::sample::select(WRAPS.to_vec());
    let levels = prop::sample::select(vec![
        LevelFilter::None,
        LevelFilter::Nearest,
        LevelFilter::Linear,
        LevelFilter::Ripmap,
        LevelFilter::SummedArea,
        LevelFilter::Anisotropic2,
        LevelFilter::Anisotropic16,
        LevelFilter::Elliptical,
    ]);
    (wrap(), wrap(), filter(), filter(), levels).prop_map(|(u, v, magnify, minify, levels)| Sampling {
        wrap: [u, v],
        magnify,
        minify,
        levels,
    })
}

proptest! {
    /// Weights sum to 1, whatever filter, level and wrap.
    #[test]
    fn one_color_stays_one_color(sampling in any_sampling(), u in -9.0..9.0_f64, v in -9.0..9.0_f64, d in -2.0..9.0_f64) {
        let even = Pyramid::new(TexelImage::from_fn(13, 6, |_, _| [0.2, 0.4, 0.6, 0.8]).expect("small"));
        let found = lookup::at_level(&even, &sampling, [u, v], d);
        prop_assert!(distance(found, [0.2, 0.4, 0.6, 0.8]) < 1e-6, "{found:?}");
    }

    /// Nothing panics, and all is finite.
    #[test]
    fn any_coordinate_gives_a_finite_color(sampling in any_sampling(), uv in any::<[f32; 2]>(), footprint in any::<[[f32; 2]; 2]>()) {
        let found = lookup::filtered(&numbered(5, 8), &sampling, uv, footprint);
        prop_assert!(found.iter().all(|number| number.is_finite()), "{found:?}");
    }

    /// f32 is near f64 where the filter is continuous.
    #[test]
    fn single_precision_is_near_double(
        wrap in prop::sample::select(WRAPS.to_vec()),
        filter in prop::sample::select(FILTERS[1..].to_vec()),
        u in -3.0..3.0_f32, v in -3.0..3.0_f32, d in -1.0..4.0_f32,
    ) {
        let pyramid = numbered(16, 9);
        let sampling = Sampling { wrap: [wrap; 2], magnify: filter, minify: filter, levels: LevelFilter::Linear };
        let single = lookup::at_level(&pyramid, &sampling, [u, v], d).map(f64::from);
        let double = lookup::at_level(&pyramid, &sampling, [u, v].map(f64::from), d.into());
        // At D = 0 the two filters meet, and levels do at whole numbers.
        prop_assert!(distance(single, double) < 2e-5, "{single:?} {double:?}");
    }

    /// No B-spline and no bilinear mean leaves the range of the texels.
    #[test]
    fn means_stay_within_the_texels(u in -3.0..3.0_f64, v in -3.0..3.0_f64, d in -1.0..4.0_f64) {
        for filter in [TexelFilter::Bilinear, TexelFilter::BSpline] {
            let sampling = Sampling { magnify: filter, minify: filter, ..Sampling::default() };
            let found = lookup::at_level(&numbered(16, 9), &sampling, [u, v], d);
            prop_assert!(found.iter().all(|number| (-1e-12..=1.0 + 1e-12).contains(number)), "{found:?}");
        }
    }
}
