//! The figures of the authors' own implementation, and pictures in bands.

use super::*;

/// A picture of bytes: width, height, and its pixels row by row.
struct Bytes {
    size: [u32; 2],
    pixels: Vec<[u8; 3]>,
}

impl Bytes {
    fn from_fn(size: [u32; 2], pixel: impl FnMut((u32, u32)) -> [u8; 3]) -> Self {
        let places = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        Self { size, pixels: places.map(pixel).collect() }
    }

    fn map(&self, pixel: impl FnMut(&[u8; 3]) -> [u8; 3]) -> Self {
        Self { size: self.size, pixels: self.pixels.iter().map(pixel).collect() }
    }
}

fn noise(size: [u32; 2], seed: u32) -> Bytes {
    let mut state = seed;
    let mut byte = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    Bytes::from_fn(size, |_| [byte(), byte(), byte()])
}

/// Three ramps: along x, along y, and down along x.
fn ramps(size: [u32; 2]) -> Bytes {
    let [width, height] = size;
    let share = |at: u32, of: u32| (255 * at / of.max(1)) as u8;
    Bytes::from_fn(size, |(x, y)| [share(x, width), share(y, height), 255 - share(x, width)])
}

/// The expected and the actual picture of a name.
fn pair(name: &str) -> [Bytes; 2] {
    let plain = |size, color| Bytes::from_fn(size, |_| color);
    let grey = |is_bright: bool| if is_bright { [220; 3] } else { [40; 3] };
    match name {
        "identical" => [7, 7].map(|seed| noise([17, 9], seed)),
        "one pixel" => [plain([1, 1], [200, 30, 40]), plain([1, 1], [180, 60, 90])],
        "green and blue" => [plain([9, 7], [0, 255, 0]), plain([9, 7], [0, 0, 255])],
        "black and white" => [plain([8, 5], [0; 3]), plain([8, 5], [255; 3])],
        "hue shift" => {
            let expected = ramps([64, 47]);
            let mix = |a: u8, b: u8| ((6 * u32::from(a) + 2 * u32::from(b)) / 8) as u8;
            let actual = expected.map(|[r, g, b]| [mix(*r, *g), mix(*g, *b), mix(*b, *r)]);
            [expected, actual]
        }
        "noise" => [noise([33, 27], 1), noise([33, 27], 2)],
        "faint noise" => {
            let (expected, grain) = (ramps([45, 38]), noise([45, 38], 3));
            let pixels = expected.pixels.iter().zip(&grain.pixels);
            let pixels = pixels.map(|(a, b)| [0, 1, 2].map(|k| a[k].saturating_add(b[k] % 13)));
            [Bytes { pixels: pixels.collect(), ..grain }, expected]
        }
        "edges" => [20, 21].map(|edge| Bytes::from_fn([41, 32], |(x, y)| grey(x + y / 4 < edge))),
        "soft edge" => {
            let soft = |(x, _): (u32, u32)| [(40 + 20 * x.clamp(12, 21) - 240) as u8; 3];
            [Bytes::from_fn([36, 11], |(x, _)| grey(x > 16)), Bytes::from_fn([36, 11], soft)]
        }
        "points" => [9, 18].map(|every| Bytes::from_fn([37, 29], |(x, y)| grey(x % every == 4 && y % 9 == 4))),
        "row" => [Bytes::from_fn([37, 1], |(x, _)| grey(x % 7 < 3)), Bytes::from_fn([37, 1], |(x, _)| grey(x % 7 < 4))],
        "column" => [noise([1, 23], 5), noise([1, 23], 6)],
        "yellow and blue stripes" => {
            let stripe = |is_blue: bool| if is_blue { [40, 60, 200] } else { [200, 190, 60] };
            [3, 4].map(|width| Bytes::from_fn([40, 40], |(x, _)| stripe(x / width % 2 == 0)))
        }
        _ => panic!("no pair is called {name}"),
    }
}

/// The least value that pixels with half of the sum of all do not exceed.
fn weighted_median(map: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = map.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let half = 0.5 * sorted.iter().sum::<f64>();
    let mut sum = 0.0;
    let reaches = |value: &f64| {
        sum += value;
        sum >= half
    };
    sorted.into_iter().find(reaches).unwrap_or(0.0)
}

/// A pair and the pixels per degree; the mean, the weighted median and some pixels' numbers and values.
type Row = (&'static str, f64, f64, f64, [(usize, f64); 3]);

/// Of nv-flip 0.1.2, a binding of the authors' C++ code in single precision.
#[rustfmt::skip]
const AUTHORS: &[Row] = &[
    ("identical", 67.0, 0.00000, 0.00000, [(0, 0.00000), (0, 0.00000), (0, 0.00000)]),
    ("one pixel", 67.0, 0.37599, 0.37599, [(0, 0.37599), (0, 0.37599), (0, 0.37599)]),
    ("green and blue", 67.0, 1.00000, 1.00000, [(0, 1.00000), (15, 1.00000), (47, 1.00000)]),
    ("black and white", 67.0, 0.96739, 0.96739, [(0, 0.96739), (10, 0.96739), (30, 0.96739)]),
    ("hue shift", 5.0, 0.51012, 0.59825, [(2942, 0.95815), (182, 0.66053), (168, 0.35830)]),
    ("hue shift", 20.0, 0.51193, 0.59906, [(2942, 0.95843), (1719, 0.66342), (76, 0.35977)]),
    ("hue shift", 67.0, 0.52822, 0.61424, [(2877, 0.96095), (1971, 0.68051), (1068, 0.37939)]),
    ("hue shift", 120.0, 0.54049, 0.62533, [(3005, 0.96173), (1413, 0.69028), (1323, 0.39598)]),
    ("noise", 5.0, 0.91525, 0.97499, [(87, 0.99672), (801, 0.98225), (803, 0.88787)]),
    ("noise", 20.0, 0.84537, 0.95451, [(17, 0.98982), (280, 0.97133), (803, 0.74937)]),
    ("noise", 67.0, 0.45553, 0.49021, [(17, 0.96304), (836, 0.54430), (662, 0.36326)]),
    ("noise", 120.0, 0.34528, 0.37874, [(164, 0.69323), (757, 0.42892), (476, 0.25280)]),
    ("faint noise", 5.0, 0.18793, 0.20163, [(1647, 0.41376), (1234, 0.22332), (326, 0.14981)]),
    ("faint noise", 20.0, 0.16841, 0.18056, [(1552, 0.31400), (1674, 0.20140), (775, 0.13655)]),
    ("faint noise", 67.0, 0.14978, 0.15180, [(1348, 0.22356), (230, 0.16298), (534, 0.13556)]),
    ("faint noise", 120.0, 0.15160, 0.15253, [(1304, 0.20995), (426, 0.16211), (571, 0.14045)]),
    ("edges", 5.0, 0.02354, 0.95682, [(143, 0.97606), (795, 0.97606), (754, 0.95682)]),
    ("edges", 20.0, 0.03846, 0.96068, [(143, 0.97235), (1080, 0.96068), (142, 0.21146)]),
    ("edges", 67.0, 0.06625, 0.49898, [(1285, 0.66537), (104, 0.47743), (261, 0.02033)]),
    ("edges", 120.0, 0.07861, 0.36134, [(21, 0.46602), (386, 0.34079), (1278, 0.01957)]),
    ("soft edge", 5.0, 0.13539, 0.64567, [(16, 0.86842), (15, 0.66294), (20, 0.42958)]),
    ("soft edge", 20.0, 0.13758, 0.63262, [(16, 0.85172), (195, 0.68954), (193, 0.36232)]),
    ("soft edge", 67.0, 0.13469, 0.52189, [(18, 0.63230), (15, 0.52189), (23, 0.03251)]),
    ("soft edge", 120.0, 0.12257, 0.35345, [(18, 0.49180), (193, 0.35345), (188, 0.03037)]),
    ("points", 5.0, 0.00555, 0.99267, [(161, 0.99267), (179, 0.99267), (827, 0.99267)]),
    ("points", 20.0, 0.01155, 0.25058, [(161, 0.98157), (162, 0.25058), (474, 0.02023)]),
    ("points", 67.0, 0.04618, 0.41308, [(179, 0.61726), (569, 0.19846), (479, 0.00666)]),
    ("points", 120.0, 0.06819, 0.17966, [(494, 0.35235), (528, 0.15481), (469, 0.01134)]),
    ("row", 5.0, 0.12930, 0.95682, [(3, 0.95682), (10, 0.95682), (24, 0.95682)]),
    ("row", 20.0, 0.21418, 0.95609, [(3, 0.95609), (24, 0.95609), (9, 0.22465)]),
    ("row", 67.0, 0.29447, 0.47984, [(32, 0.65141), (24, 0.47984), (20, 0.07993)]),
    ("row", 120.0, 0.27466, 0.31540, [(32, 0.43131), (11, 0.34904), (15, 0.20742)]),
    ("column", 5.0, 0.91804, 0.97398, [(22, 0.99740), (10, 0.98488), (21, 0.95099)]),
    ("column", 20.0, 0.91126, 0.96676, [(22, 0.99346), (20, 0.97715), (10, 0.92435)]),
    ("column", 67.0, 0.78781, 0.84682, [(22, 0.98801), (12, 0.89387), (3, 0.65729)]),
    ("column", 120.0, 0.76195, 0.80421, [(22, 0.98688), (17, 0.83888), (7, 0.69261)]),
    ("yellow and blue stripes", 5.0, 0.52577, 0.97382, [(6, 0.98793), (887, 0.98793), (604, 0.05355)]),
    ("yellow and blue stripes", 20.0, 0.69083, 0.96286, [(38, 0.98634), (37, 0.97934), (2, 0.50089)]),
    ("yellow and blue stripes", 67.0, 0.59372, 0.73958, [(37, 0.95750), (30, 0.79163), (28, 0.39307)]),
    ("yellow and blue stripes", 120.0, 0.32616, 0.39472, [(37, 0.61348), (17, 0.42543), (0, 0.25548)]),
];

/// Single precision adds some hundred weights to within 10⁻⁷, of which the exponent of feature differences makes
/// 3 · 10⁻⁴ where there is no feature; as an exponent of colour differences that is at most this.
const PIXEL: f64 = 1.5e-4;
/// The means of many pixels are closer.
const MEAN: f64 = 4e-5;

/// The rows for which a method gives another figure, as text.
fn deviations(method: impl Fn(f64) -> Method) -> Vec<String> {
    let deviation = |(name, pixels_per_degree, mean, median, pixels): &Row| {
        let pictures = pair(name).map(|Bytes { size: [width, height], pixels }| {
            RgbImage::from_raw(width, height, pixels.as_flattened().to_vec()).expect("three bytes a pixel")
        });
        let map = method(*pixels_per_degree).map(pictures);
        let found_mean = map.iter().sum::<f64>() / map.len() as f64;
        let found_median = weighted_median(&map);
        let is_near = |a: f64, b: f64, tolerance: f64| (a - b).abs() <= tolerance;
        let is_equal = is_near(found_mean, *mean, MEAN)
            && is_near(found_median, *median, PIXEL)
            && pixels.iter().all(|(i, value)| is_near(map[*i], *value, PIXEL));
        (!is_equal).then(|| {
            let found = pixels.map(|(i, _)| (i, map[i]));
            format!("{name}, {pixels_per_degree}: {found_mean} {found_median} {found:?} in place of {mean} {median} {pixels:?}")
        })
    };
    AUTHORS.iter().filter_map(deviation).collect()
}

#[test]
fn the_figures_are_the_authors() {
    let deviations = deviations(|pixels_per_degree| Method::new(&Constants::PUBLISHED, pixels_per_degree));
    assert!(deviations.is_empty(), "{}", deviations.join("\n"));
}

/// A change of the method, in words and by what makes it.
type Fault<T> = (&'static str, fn(&mut T));

#[test]
fn other_constants_are_found() {
    let changes: [Fault<Constants>; 9] = [
        ("a narrower filter of luminance", |it| it.sensitivity[0][0].1 *= 0.98),
        ("a narrower filter of red and green", |it| it.sensitivity[1][0].1 *= 0.98),
        ("filters of luminance and of red and green swapped", |it| it.sensitivity.swap(0, 1)),
        ("blue and yellow by one Gaussian", |it| it.sensitivity[2][1].0 = 0.0),
        ("narrower features", |it| it.feature_width *= 0.98),
        ("another exponent of colours", |it| it.color_exponent = 0.71),
        ("another exponent of features", |it| it.feature_exponent = 0.51),
        ("another knee", |it| it.knee.0 = 0.41),
        ("another height of the knee", |it| it.knee.1 = 0.94),
    ];
    for (fault, change) in changes {
        let mut constants = Constants::PUBLISHED;
        change(&mut constants);
        let deviations = deviations(|pixels_per_degree| Method::new(&constants, pixels_per_degree));
        assert!(deviations.len() > 2, "{fault}: {deviations:?}");
    }
}

#[test]
fn other_filters_are_found() {
    let changes: [Fault<Method>; 5] = [
        ("points taken for edges", |it| it.point = it.edge.clone()),
        ("edges taken for points", |it| it.edge = it.point.clone()),
        ("no features", |it| [&mut it.edge, &mut it.point].into_iter().flatten().for_each(|weight| *weight = 0.0)),
        ("features not blurred along", |it| it.gaussian = vec![0.0, 1.0, 0.0]),
        ("another largest difference", |it| it.largest_difference *= 1.01),
    ];
    for (fault, change) in changes {
        let deviations = deviations(|pixels_per_degree| {
            let mut method = Method::new(&Constants::PUBLISHED, pixels_per_degree);
            change(&mut method);
            method
        });
        assert!(deviations.len() > 2, "{fault}: {deviations:?}");
    }
}

/// A seam would appear if a band lacked a row that affects its values.
#[test]
fn bands_give_the_same_values_as_the_whole() {
    let [width, height] = [23, 97];
    let image = |seed| {
        let pixels = noise([width, height], seed).pixels;
        Image::new(width, height, pixels.iter().map(|pixel| pixel.map(|byte| f64::from(byte) / 255.0)).collect())
    };
    let (a, b) = (image(1), image(2));
    let bands = BandPairs::new(&a, &b).expect("one size");
    let whole = map_by(&bands, Encoding::Srgb, width * height);
    for rows in [1, 7, 48] {
        assert!(map_by(&bands, Encoding::Srgb, width * rows) == whole, "bands of {rows} rows");
    }
}
