//! Filters by the shape of a footprint: exact cases, f32 against f64, and the rounding of sums in f32.

use halfway_texture::{LevelFilter, Pyramid, Sampling, TexelFilter, TexelImage, Wrap, lookup};
use proptest::prelude::*;

const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
const SHAPED: [LevelFilter; 7] = [
    LevelFilter::Ripmap,
    LevelFilter::SummedArea,
    LevelFilter::Anisotropic2,
    LevelFilter::Anisotropic4,
    LevelFilter::Anisotropic8,
    LevelFilter::Anisotropic16,
    LevelFilter::Elliptical,
];

/// An image whose texels all differ.
fn numbered(width: u32, height: u32) -> Pyramid {
    let texel = |x: u32, y: u32| {
        let number = |seed: u32| f64::from((x * 7919 + y * 104_729 + seed * 31) % 1000) as f32 / 999.0;
        [number(1), number(2), number(3), number(4)]
    };
    Pyramid::new(TexelImage::from_fn(width, height, texel).expect("a small image"))
}

fn distance(a: [f64; 4], b: [f64; 4]) -> f64 {
    (0..4).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max)
}

/// The texel at an index that may lie beyond the image.
fn texel(pyramid: &Pyramid, wrap: Wrap, [x, y]: [i64; 2]) -> [f64; 4] {
    let [width, height] = pyramid.size().map(i64::from);
    let index = |at: i64, side: i64| match wrap {
        Wrap::Repeat => at.rem_euclid(side),
        Wrap::Mirror => at.rem_euclid(2 * side).min(2 * side - 1 - at.rem_euclid(2 * side)),
        Wrap::Clamp => at.clamp(0, side - 1),
    };
    pyramid.level(0)[(index(y, height) * width + index(x, width)) as usize].map(f64::from)
}

/// The weighted mean of texels.
fn mean_by(pyramid: &Pyramid, wrap: Wrap, range: [[i64; 2]; 2], weight: impl Fn(f64, f64) -> f64) -> [f64; 4] {
    let (mut sum, mut weights) = ([0.0; 4], 0.0);
    for (y, x) in (range[1][0]..range[1][1]).flat_map(|y| (range[0][0]..range[0][1]).map(move |x| (y, x))) {
        let weight = weight(x as f64, y as f64);
        weights += weight;
        let texel = texel(pyramid, wrap, [x, y]);
        (0..4).for_each(|k| sum[k] += weight * texel[k]);
    }
    sum.map(|sum| sum / weights)
}

/// The part of the texel from `x` to `x + 1` that lies within half of `length` of `middle`.
fn overlap(x: f64, middle: f64, length: f64) -> f64 {
    ((x + 1.0).min(middle + 0.5 * length) - x.max(middle - 0.5 * length)).max(0.0)
}

fn sampling_by(levels: LevelFilter, wrap: Wrap) -> Sampling {
    Sampling { levels, wrap: [wrap; 2], ..Sampling::default() }
}

#[test]
fn every_ripmap_level_keeps_the_mean() {
    for (width, height) in [(1, 1), (64, 64), (5, 3), (37, 1), (1, 19), (100, 75)] {
        let pyramid = numbered(width, height);
        let ripmap = pyramid.ripmap();
        let [columns, rows] = ripmap.counts();
        assert_eq!([columns, rows], [width, height].map(|side| side.ilog2() as usize + 1));
        let whole = pyramid.summed_areas().mean();
        for (i, j) in (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j))) {
            let (level, texels) = ripmap.level([i, j]);
            assert_eq!([level.width, level.height], [width >> i, height >> j]);
            let mean: [f64; 4] = std::array::from_fn(|k| {
                texels.iter().map(|texel| f64::from(texel[k])).sum::<f64>() / texels.len() as f64
            });
            assert!(distance(mean, whole) < 1e-6, "{width} × {height}, {i}, {j}");
        }
        assert!(ripmap.texels().len() <= 4 * (width * height) as usize);
    }
    // On the diagonal lie the levels of the pyramid, rounded in another order.
    let pyramid = numbered(64, 64);
    for number in 0..7 {
        let (_, texels) = pyramid.ripmap().level([number, number]);
        for (a, b) in texels.iter().zip(pyramid.level(number)) {
            assert!(distance(a.map(f64::from), b.map(f64::from)) < 1e-6);
        }
    }
}

#[test]
fn a_ripmap_is_halved_along_the_footprints_long_axis() {
    let pyramid = numbered(16, 16);
    let found = lookup::filtered(
        &pyramid,
        &sampling_by(LevelFilter::Ripmap, Wrap::Repeat),
        [0.3_f64, 0.6],
        [[0.25, 0.0], [0.0, 0.0625]],
    );
    // 4 texels along u, 1 along v: the image of 4 × 16.
    let (level, texels) = pyramid.ripmap().level([2, 0]);
    assert_eq!([level.width, level.height], [4, 16]);
    let image = TexelImage::new(4, 16, texels.to_vec()).expect("a level");
    let expected = lookup::in_level(&Pyramid::new(image), 0, [Wrap::Repeat; 2], TexelFilter::Bilinear, [0.3, 0.6]);
    assert!(distance(found, expected) < 1e-12);
}

#[test]
fn summed_areas_give_the_mean_of_any_rectangle() {
    let pyramid = numbered(13, 7);
    for wrap in WRAPS {
        for (u, v, width, height) in [
            (0.5, 0.5, 13.0, 7.0),
            (0.31, 0.77, 4.0, 2.5),
            (-1.4, 2.3, 1.0, 6.2),
            (0.02, 0.98, 3.3, 1.7),
            (5.6, -3.1, 40.0, 33.3),
            (0.9, 1.4, 2.0, 2.0),
        ] {
            let footprint = [[width / 13.0, 0.0], [0.0, height / 7.0]];
            let found = lookup::filtered(&pyramid, &sampling_by(LevelFilter::SummedArea, wrap), [u, v], footprint);
            let expected = mean_by(&pyramid, wrap, [[-200, 200], [-100, 100]], |x, y| {
                overlap(x, u * 13.0, width) * overlap(y, v * 7.0, height)
            });
            assert!(distance(found, expected) < 1e-12, "{wrap:?} {u} {v} {width} {height}: {found:?} {expected:?}");
        }
    }
}

/// A texel's square around a point weighs the texels around it as the bilinear filter does: enlarging and reducing
/// meet.
#[test]
fn the_least_rectangle_is_the_bilinear_filter() {
    let pyramid = numbered(9, 6);
    for wrap in WRAPS {
        for k in 0..50 {
            let uv = [0.173 * f64::from(k) - 4.0, 0.091 * f64::from(k) - 1.0];
            // The longer semiaxis is just over a texel, the shorter far below.
            let footprint = [[1.000_000_1 / 9.0, 0.0], [0.0, 0.01]];
            let found = lookup::filtered(&pyramid, &sampling_by(LevelFilter::SummedArea, wrap), uv, footprint);
            let expected = lookup::in_level(&pyramid, 0, [wrap; 2], TexelFilter::Bilinear, uv);
            assert!(distance(found, expected) < 1e-6, "{wrap:?} {uv:?}");
        }
    }
}

/// The rounding errors of sums in f32, of sums without the mean, and of sums in f64: the mean of 2 × 2 texels far from
/// the corner where the sums begin, of an image of 1024 × 1024 texels around 0.7.
#[test]
fn sums_in_single_precision_are_too_coarse() {
    const SIDE: usize = 1024;
    let value = |x: usize, y: usize| 0.7 + 0.1 * ((x * 131 + y * 71) % 17) as f32 / 16.0;
    let image =
        TexelImage::from_fn(SIDE as u32, SIDE as u32, |x, y| [value(x as usize, y as usize); 4]).expect("an image");
    let table = |offset: f32| {
        let mut sums = vec![0.0_f32; (SIDE + 1) * (SIDE + 1)];
        for y in 0..SIDE {
            let mut row = 0.0_f32;
            for x in 0..SIDE {
                row += value(x, y) - offset;
                sums[(y + 1) * (SIDE + 1) + x + 1] = sums[y * (SIDE + 1) + x + 1] + row;
            }
        }
        sums
    };
    let mean_of = |sums: &[f32], offset: f32, x: usize, y: usize| {
        let at = |x: usize, y: usize| sums[y * (SIDE + 1) + x];
        (at(x + 2, y + 2) - at(x, y + 2) - at(x + 2, y) + at(x, y)) / 4.0 + offset
    };
    let pyramid = Pyramid::new(image);
    let (plain, centered) = (table(0.0), table(0.75));
    let mut off = [0.0_f64; 3];
    for k in 900..1000 {
        let exact =
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| f64::from(value(k + i, k + j))).iter().sum::<f64>() / 4.0;
        let [u, v] = [(k + 1) as f64 / SIDE as f64; 2];
        let side = 2.0 / SIDE as f64;
        let sampling = sampling_by(LevelFilter::SummedArea, Wrap::Clamp);
        let ours = lookup::filtered(&pyramid, &sampling, [u, v], [[side, 0.0], [0.0, side]])[0];
        let found = [f64::from(mean_of(&plain, 0.0, k, k)), f64::from(mean_of(&centered, 0.75, k, k)), ours];
        (0..3).for_each(|kind| off[kind] = off[kind].max((found[kind] - exact).abs()));
    }
    println!("largest error of a mean: f32 {:.1e}, f32 less the mean {:.1e}, as kept {:.1e}", off[0], off[1], off[2]);
    // Sums near 10⁶ are told apart by 1/16 in f32; those of differences stay near 10³.
    assert!(off[0] > 5e-3, "{off:?}");
    assert!(off[1] < off[0] / 30.0, "{off:?}");
    assert!(off[2] < 1e-10, "{off:?}");
}

/// The formula of the probes, on an image that is wide enough for no probe to leave it.
#[test]
fn probes_lie_along_the_long_axis() {
    let pyramid = numbered(256, 256);
    let texel = 1.0 / 256.0;
    let uv = [0.4_f64, 0.55];
    // σ₁ = 12 along (3, 4)/5, σ₂ = 4: three probes of level 2, 4 texels apart, all of weight 1.
    let footprint = [[7.2 * texel, 9.6 * texel], [-3.2 * texel, 2.4 * texel]];
    let found = lookup::filtered(&pyramid, &sampling_by(LevelFilter::Anisotropic16, Wrap::Repeat), uv, footprint);
    let probe = |k: f64| {
        let at = [uv[0] + 2.4 * k * texel, uv[1] + 3.2 * k * texel];
        lookup::in_level(&pyramid, 2, [Wrap::Repeat; 2], TexelFilter::Bilinear, at)
    };
    let expected: [f64; 4] = std::array::from_fn(|k| (probe(-1.0)[k] + probe(0.0)[k] + probe(1.0)[k]) / 3.0);
    assert!(distance(found, expected) < 1e-9, "{found:?} {expected:?}");
    // Of at most two: level log₂ 6, 6 texels apart, weights ½, 1, ½.
    let found = lookup::filtered(&pyramid, &sampling_by(LevelFilter::Anisotropic2, Wrap::Repeat), uv, footprint);
    let probe = |k: f64| {
        let at = [uv[0] + 3.6 * k * texel, uv[1] + 4.8 * k * texel];
        lookup::at_level(&pyramid, &Sampling::default(), at, 6_f64.log2())
    };
    let expected: [f64; 4] = std::array::from_fn(|k| (probe(-1.0)[k] + 2.0 * probe(0.0)[k] + probe(1.0)[k]) / 4.0);
    assert!(distance(found, expected) < 1e-9, "{found:?} {expected:?}");
    // Of a square there is but one: trilinear.
    let square = [[3.0 * texel, 0.0], [0.0, 3.0 * texel]];
    let found = lookup::filtered(&pyramid, &sampling_by(LevelFilter::Anisotropic8, Wrap::Repeat), uv, square);
    let expected = lookup::filtered(&pyramid, &Sampling::default(), uv, square);
    assert!(distance(found, expected) < 1e-9, "{found:?} {expected:?}");
}

/// The ellipse against its definition, texel by texel, in the image itself: σ₂ = 1.
#[test]
fn the_elliptical_mean_is_that_of_a_gaussian() {
    let pyramid = numbered(64, 48);
    for (wrap, uv) in [(Wrap::Repeat, [0.51, 0.47]), (Wrap::Mirror, [1.97, -0.03]), (Wrap::Clamp, [0.02, 0.99])] {
        // σ₁ = 5 along (4, 3)/5, σ₂ = 1, in texels.
        let footprint = [[4.0 / 64.0, 3.0 / 48.0], [-0.6 / 64.0, 0.8 / 48.0]];
        let found = lookup::filtered(&pyramid, &sampling_by(LevelFilter::Elliptical, wrap), uv, footprint);
        let [cx, cy] = [uv[0] * 64.0, uv[1] * 48.0];
        let expected = mean_by(&pyramid, wrap, [[-200, 300], [-200, 300]], |x, y| {
            let [x, y] = [x + 0.5 - cx, y + 0.5 - cy];
            let r2 = ((0.8 * x + 0.6 * y) / 5.0).powi(2) + (-0.6 * x + 0.8 * y).powi(2);
            if r2 < 1.0 { (-2.0 * r2).exp() - (-2.0_f64).exp() } else { 0.0 }
        });
        // The series of the weights is off by 3·10⁻⁶.
        assert!(distance(found, expected) < 5e-6, "{wrap:?}: {found:?} {expected:?}");
    }
}

/// Each filter by shape keeps detail across the long axis that the trilinear one blurs.
#[test]
fn thin_footprints_keep_detail_across_them() {
    // Rows of two colors, and a footprint of 16 texels along them and 1 across.
    let image = TexelImage::from_fn(64, 64, |_, y| [(y % 2) as f32; 4]).expect("an image");
    let pyramid = Pyramid::new(image);
    let footprint = [[16.0 / 64.0, 0.0], [0.0, 1.0 / 64.0]];
    let contrast = |levels| {
        let at = |row: f64| {
            lookup::filtered(&pyramid, &sampling_by(levels, Wrap::Repeat), [0.5, (row + 0.5) / 64.0], footprint)[0]
        };
        at(1.0) - at(2.0)
    };
    assert!(contrast(LevelFilter::Linear) < 1e-6);
    for (levels, least) in [
        (LevelFilter::Ripmap, 0.999),
        (LevelFilter::SummedArea, 0.999),
        (LevelFilter::Anisotropic16, 0.999),
        (LevelFilter::Elliptical, 0.6),
    ] {
        assert!(contrast(levels) > least, "{levels:?}: {}", contrast(levels));
    }
}

#[test]
fn footprints_without_shape_have_their_cases() {
    let pyramid = numbered(16, 8);
    let uv = [0.37_f64, 0.61];
    for levels in SHAPED {
        let at = |footprint| lookup::filtered(&pyramid, &sampling_by(levels, Wrap::Repeat), uv, footprint);
        let enlarged = lookup::in_level(&pyramid, 0, [Wrap::Repeat; 2], TexelFilter::Bilinear, uv);
        for footprint in [[[0.0; 2]; 2], [[f64::NAN, 0.0], [0.0, 0.1]], [[0.06, 0.0], [0.0, 0.1]]] {
            assert_eq!(at(footprint), enlarged, "{levels:?} {footprint:?}");
        }
        let last = lookup::in_level(&pyramid, 4, [Wrap::Repeat; 2], TexelFilter::Bilinear, uv);
        for footprint in [[[f64::INFINITY, 0.0], [0.0, 0.1]], [[1e200, 0.0], [0.0, 1e200]]] {
            assert_eq!(at(footprint), last, "{levels:?} {footprint:?}");
        }
        // The two derivatives in one line, as at the horizon.
        assert!(at([[0.3, 0.4], [0.6, 0.8]]).iter().all(|number| number.is_finite()), "{levels:?}");
    }
}

#[test]
fn parallel_halving_agrees_with_one_thread() {
    // 1024 × 60 texels are halved in parallel, its left half alone is not.
    let image = |width| TexelImage::from_fn(width, 60, |x, y| [((x * 31 + y * 17) % 101) as f32; 4]).expect("an image");
    let (wide, narrow) = (Pyramid::new(image(1024)), Pyramid::new(image(512)));
    for number in 1..=5 {
        let [w, n] = [&wide, &narrow].map(|pyramid| pyramid.levels()[number].width as usize);
        for (a, b) in wide.level(number).chunks_exact(w).zip(narrow.level(number).chunks_exact(n)) {
            assert_eq!(a[..n], *b, "level {number}");
        }
    }
}

proptest! {
    /// f32 is near f64, and both within the texels' range, whatever the footprint.
    #[test]
    fn single_precision_is_near_double(
        levels in prop::sample::select(SHAPED.to_vec()),
        wrap in prop::sample::select(WRAPS.to_vec()),
        u in -2.0..2.0_f32, v in -2.0..2.0_f32,
        footprint in prop::array::uniform2(prop::array::uniform2(-0.4..0.4_f32)),
    ) {
        let pyramid = numbered(32, 19);
        let single = lookup::filtered(&pyramid, &sampling_by(levels, wrap), [u, v], footprint).map(f64::from);
        let double = lookup::filtered(&pyramid, &sampling_by(levels, wrap), [u, v].map(f64::from), footprint.map(|row| row.map(f64::from)));
        // Texels differ by 1 from neighbour to neighbour, and places by 2⁻²² · 2 · 32 texels: 1.5e-5; levels by as much
        // more.
        prop_assert!(distance(single, double) < 2e-4, "{single:?} {double:?}");
        prop_assert!(double.iter().all(|number| (-1e-9..=1.0 + 1e-9).contains(number)), "{double:?}");
    }

    /// A little larger is a little different: no filter jumps where a probe, a level or a texel comes in.
    #[test]
    fn filters_change_steadily_with_the_footprint(
        levels in prop::sample::select(SHAPED.to_vec()),
        u in -2.0..2.0_f64, v in -2.0..2.0_f64,
        footprint in prop::array::uniform2(prop::array::uniform2(-0.4..0.4_f64)),
    ) {
        let pyramid = numbered(32, 19);
        let at = |scale: f64| {
            lookup::filtered(&pyramid, &sampling_by(levels, Wrap::Repeat), [u, v], footprint.map(|row| row.map(|x| scale * x)))
        };
        prop_assume!(lookup::level([32, 19], footprint) > 0.01);
        prop_assert!(distance(at(1.0), at(1.0 + 1e-9)) < 1e-5, "{:?} {:?}", at(1.0), at(1.0 + 1e-9));
    }
}
