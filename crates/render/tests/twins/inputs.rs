//! Arguments for the functions: every edge of their definitions, and numbers over the whole range.

use fastrand::Rng;
use halfway_lighting::equations::{Colors, ConeTerms, Directional, Hemisphere, Light, Point, ShadedPoint, Spot};

use crate::adapter::INPUT;

pub(crate) type Input = [f32; INPUT];

/// The numbers, and zeros.
pub(crate) fn input(numbers: &[f32]) -> Input {
    let mut input = [0.0; INPUT];
    input[..numbers.len()].copy_from_slice(numbers);
    input
}

pub(crate) fn wide<const N: usize>(numbers: &[f32]) -> [f64; N] {
    std::array::from_fn(|k| numbers[k].into())
}

pub(crate) fn between(random: &mut Rng, low: f32, high: f32) -> f32 {
    low + (high - low) * random.f32()
}

/// Over all magnitudes from 10^low to 10^high.
pub(crate) fn magnitude(random: &mut Rng, low: f32, high: f32) -> f32 {
    10f32.powf(between(random, low, high))
}

pub(crate) fn direction(random: &mut Rng) -> [f32; 3] {
    loop {
        let a = [0; 3].map(|_| between(random, -1.0, 1.0));
        let square: f32 = a.iter().map(|x| x * x).sum();
        if (0.01..=1.0).contains(&square) {
            return a.map(|x| x / square.sqrt());
        }
    }
}

fn color(random: &mut Rng) -> [f32; 3] {
    [0; 3].map(|_| between(random, 0.0, 2.0))
}

/// A light and a lit point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lit {
    pub(crate) position: [f32; 3],
    range: Option<f32>,
    attenuation: [f32; 3],
    /// Direction, cos(cutoff), cos(inner) and exponent.
    cone: ([f32; 3], f32, Option<f32>, f32),
    colors: [[f32; 3]; 3],
    pub(crate) p: [f32; 3],
    pub(crate) n: [f32; 3],
    pub(crate) shininess: f32,
}

/// Where the parts of [`Lit`] stand in an input.
pub(crate) const P: usize = 23;
pub(crate) const N: usize = 26;
pub(crate) const SHININESS: usize = 29;
/// cos(inner) and the range, or 0 where there is none: for the twin alone.
const INNER: usize = 30;
const RANGE: usize = 31;

impl Lit {
    pub(crate) fn random(random: &mut Rng) -> Self {
        let n = direction(random);
        let size = magnitude(random, -12.0, 12.0);
        let p = direction(random).map(|x| x * size);
        let distance = size * magnitude(random, -2.0, 3.0);
        let mut l = direction(random);
        if dot(l, n) < 0.0 && random.f32() < 0.8 {
            l = l.map(|x| -x);
        }
        let position = std::array::from_fn(|k| p[k] + distance * l[k]);
        let aim = direction(random);
        let toward: [f32; 3] = std::array::from_fn(|k| 0.3 * aim[k] - l[k]);
        let length = dot(toward, toward).sqrt();
        let cos_cutoff = between(random, 0.0, 0.9);
        let inner = (random.f32() < 0.5).then(|| between(random, cos_cutoff + 0.02, 1.0));
        Self {
            position,
            range: (random.f32() < 0.5).then(|| distance * magnitude(random, -0.2, 1.0)),
            attenuation: [between(random, 0.1, 2.0), random.f32() / distance, random.f32() / distance / distance],
            cone: (toward.map(|x| x / length), cos_cutoff, inner, between(random, 0.0, 8.0)),
            colors: [color(random), color(random), color(random)],
            p,
            n,
            shininess: magnitude(random, -1.0, 3.0),
        }
    }

    pub(crate) fn input(&self) -> Input {
        let [la, ld, ls] = self.colors;
        let [a, b, c] = self.attenuation;
        let (direction, cos_cutoff, inner, exponent) = self.cone;
        let width = inner.map_or(0.0, |inner| f64::from(inner) - f64::from(cos_cutoff));
        let (scale, offset) = if width > 0.0 { (1.0 / width, -f64::from(cos_cutoff) / width) } else { (0.0, 1.0) };
        let vectors =
            [(self.position, self.range.map_or(0.0, f32::recip)), (ld, a), (ls, b), (direction, c), (la, cos_cutoff)];
        let mut numbers: Vec<f32> = vectors.into_iter().flat_map(|(v, s)| [v[0], v[1], v[2], s]).collect();
        numbers.extend([exponent, scale as f32, offset as f32]);
        numbers.extend(self.p.into_iter().chain(self.n));
        numbers.extend([self.shininess, inner.unwrap_or(0.0), self.range.unwrap_or(0.0)]);
        input(&numbers)
    }
}

/// The light that an input holds, as the twin takes it.
pub(crate) fn spot(x: &[f32]) -> Spot<f64> {
    let some = |k: usize| (x[k] != 0.0).then_some(f64::from(x[k]));
    let colors = Colors { la: wide(&x[16..]), ld: wide(&x[4..]), ls: wide(&x[8..]) };
    let attenuation = [x[7], x[11], x[15]].map(f64::from);
    let point = Point { position: wide(x), colors, attenuation, range: some(RANGE), attenuate_ambient: true };
    Spot { point, cone: cone(x) }
}

pub(crate) fn light(x: &[f32]) -> Light<f64> {
    Light::Spot(spot(x))
}

/// The same without a cone.
pub(crate) fn point(x: &[f32]) -> Light<f64> {
    Light::Point(spot(x).point)
}

/// Parallel rays, toward where the light stands. Its record has an ambient color all the same, which is added.
pub(crate) fn directional(x: &[f32]) -> Light<f64> {
    Light::Directional(Directional { toward: wide(x), colors: spot(x).point.colors })
}

/// Light from all around: the position of the record is the direction toward the sky.
pub(crate) fn hemisphere(x: &[f32]) -> Light<f64> {
    Light::Hemisphere(Hemisphere { up: wide(x), sky: wide(&x[4..]), ground: wide(&x[8..]) })
}

pub(crate) fn cone(x: &[f32]) -> ConeTerms<f64> {
    let cos_inner = (x[INNER] != 0.0).then_some(f64::from(x[INNER]));
    ConeTerms { direction: wide(&x[12..]), cos_cutoff: x[19].into(), cos_inner, exponent: x[20].into() }
}

pub(crate) fn surface(x: &[f32]) -> ShadedPoint<f64> {
    ShadedPoint { position: wide(&x[P..]), normal: wide(&x[N..]) }
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn many(
    edges: impl IntoIterator<Item = Input>,
    count: usize,
    mut random: impl FnMut(&mut Rng) -> Input,
) -> Vec<Input> {
    let mut source = Rng::with_seed(0x9e37_79b9_7f4a_7c15);
    let mut inputs: Vec<Input> = edges.into_iter().collect();
    inputs.extend((0..count).map(|_| random(&mut source)));
    inputs
}

/// x and e: 0⁰, both ends, a cosine rounded past 0, and exponents to 10⁴.
pub(crate) fn powers() -> Vec<Input> {
    let edges = [0.0f32, -0.25, 1.0, 0.5, 0.999_999_9, 1e-30]
        .into_iter()
        .flat_map(|x| [0.0f32, 1.0, 0.3, 32.0, 1e4].map(|e| input(&[x, e])));
    many(edges, 2000, |random| input(&[between(random, 0.0, 1.0).sqrt(), magnitude(random, -2.0, 4.0)]))
}

/// x and k, for x^(2^k).
pub(crate) fn squarings() -> Vec<Input> {
    let edges = [0.0f32, 1.0, 0.5].into_iter().flat_map(|x| [0.0f32, 1.0, 7.0, 16.0].map(|k| input(&[x, k])));
    many(edges, 200, |random| input(&[between(random, 0.9, 1.0), between(random, 0.0, 13.9).floor()]))
}

/// Lights and points in general position, and `edges`.
pub(crate) fn lit(edges: impl IntoIterator<Item = Lit>) -> Vec<Input> {
    many(edges.into_iter().map(|lit| lit.input()), 3000, |random| Lit::random(random).input())
}

/// Lights whose position is a direction toward them.
pub(crate) fn sunny() -> Vec<Input> {
    many([], 3000, |random| Lit { position: direction(random), ..Lit::random(random) }.input())
}

/// A light above, at and beside the point, and one that counts as being at it; eyes at the point.
pub(crate) fn coincident() -> Vec<Lit> {
    let base = Lit {
        position: [0.0, 0.0, -5.0],
        range: None,
        attenuation: [0.0, 0.0, 1.0],
        cone: ([0.0, 0.0, -1.0], 0.0, None, 0.0),
        colors: [[0.2, 0.1, 0.3], [1.0, 0.5, 0.25], [0.5, 1.0, 2.0]],
        p: [0.0, 0.0, -5.0],
        n: [0.0, 0.0, 1.0],
        shininess: 20.0,
    };
    let constant = Lit { attenuation: [4.0, 1.0, 0.0], ..base };
    vec![
        base,
        constant,
        Lit { range: Some(1e-9), ..constant },
        // A millionth of ‖p‖ away: at the point. Four millionths: not.
        Lit { position: [5e-6, 0.0, -5.0], ..constant },
        Lit { position: [2e-5, 0.0, -5.0], ..constant },
        Lit { position: [0.0, 0.0, -5.000_005], ..base },
        Lit { position: [0.0, 0.0, -4.999_98], ..base },
        Lit { position: [0.0, 0.0, -4.999_98], ..constant },
        Lit { position: [0.0; 3], p: [0.0; 3], ..base },
        Lit { position: [0.0; 3], p: [0.0; 3], ..constant },
        Lit { position: [0.0, 0.0, 1e-12], p: [0.0; 3], ..constant },
        // At the end of its range, and beyond.
        Lit { position: [0.0, 0.0, -1.0], range: Some(4.0), ..constant },
        Lit { position: [0.0, 0.0, -1.0], range: Some(3.0), ..constant },
        Lit { position: [0.0, 0.0, -1.0], range: Some(4.1), ..constant },
        // In its plane, as far as that is known, and above it.
        Lit { position: [1.0, 0.0, -4.999_998_5], ..constant },
        Lit { position: [0.1, 0.0, -4.999_998], ..constant },
        Lit { position: [0.1, 0.0, -4.999_996], ..constant },
        // Behind the surface.
        Lit { position: [0.0, 0.0, -9.0], ..constant },
    ]
}

/// cos φ in the last place, and a cone with an edge at every place of it.
pub(crate) fn cones() -> Vec<Input> {
    let base = Lit { range: None, ..Lit::random(&mut Rng::with_seed(5)) };
    let with = |cosine: f32, cutoff: f32, inner: Option<f32>, exponent: f32| {
        let mut numbers = Lit { cone: ([0.0, 0.0, -1.0], cutoff, inner, exponent), ..base }.input();
        numbers[32] = cosine;
        numbers
    };
    let edges = [
        // The edge, just outside, the axis, beyond it by rounding; 0⁰ at the edge of a right angle.
        with(0.5, 0.5, None, 2.0),
        with(0.499_999_97, 0.5, None, 2.0),
        with(1.0, 1.0, None, 8.0),
        with(1.000_000_1, 0.5, None, 1e4),
        with(0.0, 0.0, None, 0.0),
        with(-0.1, 0.0, None, 0.0),
        with(0.75, 0.5, Some(0.75), 0.0),
        with(0.5, 0.5, Some(0.75), 0.0),
        with(0.6, 0.6, Some(0.6), 1.0),
    ];
    many(edges, 1000, |random| {
        let cutoff = between(random, -0.2, 0.95);
        let inner = (random.f32() < 0.5).then(|| between(random, cutoff + 0.02, 1.0));
        with(between(random, -0.2, 1.0), cutoff, inner, magnitude(random, -2.0, 2.5))
    })
}

/// Two axes, how wide highlights are along them, a halfway direction, and an exponent otherwise; among the directions
/// those of the normal, which have no length along the axes, and widths that are none.
pub(crate) fn spreads() -> Vec<Input> {
    let row = |axes: [[f32; 3]; 2], widths: [f32; 3], h: [f32; 3], otherwise: f32| {
        input(&[&axes[0][..], &axes[1], &widths, &h, &[otherwise]].concat())
    };
    let sides = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let edges = [
        row(sides, [20.0, 3.0, 5.0], [0.0, 0.0, 1.0], 7.0),
        row(sides, [20.0, 3.0, 5.0], [1e-16, 0.0, 1.0], 7.0),
        row(sides, [20.0, 3.0, 5.0], [1.0, 0.0, 1.0], 7.0),
        row(sides, [20.0, 3.0, 5.0], [0.0, -2.0, 1.0], 7.0),
        row(sides, [1.0, -9.0, 1.0], [1.0, 1.0, 1.0], 7.0),
        row([[0.0; 3]; 2], [20.0, 3.0, 5.0], [1.0, 0.0, 1.0], 7.0),
    ];
    many(edges, 2000, |random| {
        let (n, t) = (direction(random), direction(random));
        let cross = |a: [f32; 3], b: [f32; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let [a, b] = [magnitude(random, -1.0, 3.0), magnitude(random, -1.0, 3.0)];
        let widths = [a, between(random, -0.9, 0.9) * (a * b).sqrt(), b];
        row([t, cross(n, t)], widths, direction(random), magnitude(random, -1.0, 3.0))
    })
}

/// n, l, v and an exponent; l = −v and its neighbours, a light in the surface's plane and behind it.
pub(crate) fn highlights() -> Vec<Input> {
    let row = |n: [f32; 3], l: [f32; 3], v: [f32; 3], e: f32| {
        input(&[n[0], n[1], n[2], l[0], l[1], l[2], v[0], v[1], v[2], e])
    };
    let z = [0.0, 0.0, 1.0];
    let edges = [
        row(z, z, z, 0.0),
        row(z, z, z, 1e4),
        row(z, [0.6, 0.0, 0.8], [-0.6, 0.0, -0.8], 0.0),
        row(z, [0.6, 0.0, 0.8], [-0.6, 0.0, -0.799_999_95], 2.0),
        row([0.6, 0.0, 0.8], [0.6, 0.0, 0.8], [-0.599_997, 0.0, -0.800_002_2], 2.0),
        row(z, [1.0, 0.0, 0.0], z, 3.0),
        row(z, [0.6, 0.0, -0.8], z, 0.0),
        row(z, [0.6, 0.0, 0.8], [0.8, 0.0, -0.6], 0.0),
        row(z, [0.6, 0.0, 0.8], [-0.6, 0.0, 0.8], 1e4),
    ];
    many(edges, 3000, |random| {
        let (n, l, v) = (direction(random), direction(random), direction(random));
        // Half of them near the peak, where a large exponent shows.
        let near = |a: [f32; 3], to: [f32; 3], share: f32| -> [f32; 3] {
            let sum: [f32; 3] = std::array::from_fn(|k| to[k] + share * a[k]);
            let length = dot(sum, sum).sqrt().max(1e-3);
            sum.map(|x| x / length)
        };
        let e = magnitude(random, -1.0, 4.0);
        if random.f32() < 0.5 {
            let share = 1.0 / (1.0 + e).sqrt();
            row(n, near(l, n, share), near(v, n, share), e)
        } else {
            row(n, l, v, e)
        }
    })
}

/// Those of [`vectors`], and one whose square is no normal number.
pub(crate) fn short_vectors() -> Vec<Input> {
    [vectors(), vec![input(&[1e-30, 0.0, 0.0, 0.0, 0.6, 0.8])]].concat()
}

/// Vectors of lengths 10⁻¹⁵ to 10¹⁵, and 0; with each a unit vector.
pub(crate) fn vectors() -> Vec<Input> {
    let edges = [[0.0f32; 3], [0.0, 3e-7, 4e-7], [0.0, 3e-6, 4e-6], [0.0, -2.0, 0.0]];
    let edges = edges.map(|a| input(&[a[0], a[1], a[2], 0.0, 0.6, 0.8]));
    many(edges, 1000, |random| {
        let (a, size, b) = (direction(random), magnitude(random, -15.0, 15.0), direction(random));
        input(&[a[0] * size, a[1] * size, a[2] * size, b[0], b[1], b[2]])
    })
}

/// A matrix, as columns, and a unit vector; one of them is of rank 1.
pub(crate) fn matrices() -> Vec<Input> {
    let flat = input(&[0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    many([flat], 1000, |random| {
        let mut numbers: Vec<f32> = (0..9).map(|_| between(random, -1.0, 1.0)).collect();
        numbers.extend(direction(random));
        input(&numbers)
    })
}

/// Constants a, b, c and a distance: d = 0 with and without a, and both ends of the number range.
pub(crate) fn falls() -> Vec<Input> {
    let row = |[a, b, c]: [f32; 3], d: f32| {
        let mut numbers = [0.0; INPUT];
        (numbers[7], numbers[11], numbers[15], numbers[32]) = (a, b, c, d);
        numbers
    };
    let constants = [[1.0f32, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.25, 0.5, 2.0], [1e-9, 0.0, 0.0]];
    let edges = constants.into_iter().flat_map(|abc| [0.0f32, 1e-3, 1e-4, 1.0, 1e15, 1e18].map(|d| row(abc, d)));
    many(edges, 1000, |random| row([0; 3].map(|_| magnitude(random, -6.0, 3.0)), magnitude(random, -12.0, 12.0)))
}

/// A distance and a range.
pub(crate) fn ranges() -> Vec<Input> {
    let edges = [(0.0f32, 2.0f32), (2.0, 2.0), (2.1, 2.0), (1.0, 1e30), (1e18, 2.0)]
        .map(|(d, range)| input(&[d, range, range.recip()]));
    many(edges, 1000, |random| {
        let range = magnitude(random, -12.0, 12.0);
        input(&[range * between(random, 0.0, 1.2), range, range.recip()])
    })
}

/// From 0 to 1 in steps of 1/4000, and the place where the curve's parts meet.
pub(crate) fn intensities() -> Vec<Input> {
    let steps = (0..=4000u16).map(|k| f32::from(k) / 4000.0);
    steps.chain([0.003_130_8, 0.003_130_9, 1e-30]).map(|x| input(&[x])).collect()
}

/// Intensities of all magnitudes, and around where ACES' curve reaches 1.
pub(crate) fn bright() -> Vec<Input> {
    let edges = [0.0, 1.0, 7.0, 7.2, 7.25, 7.3, 8.0, 9.0, 1e18, 3e38].map(|x| input(&[x]));
    many(edges, 1000, |random| input(&[magnitude(random, -6.0, 3.0)]))
}

/// Intensities with 1/w² of a white point w of 1 and more, and none.
pub(crate) fn white_points() -> Vec<Input> {
    let edges = [0.0, 1.0, 1e18, 3e38].into_iter().flat_map(|x: f32| [0.0, 0.0625, 1.0].map(|w| input(&[x, w])));
    many(edges, 1000, |random| input(&[magnitude(random, -6.0, 6.0), magnitude(random, -6.0, 0.0)]))
}

/// A largest channel, the divisor before and the share of it that stays.
pub(crate) fn divisors() -> Vec<Input> {
    let edges = [[0.0, 1.0, 0.0], [0.5, 9.0, 0.5], [1.0, 1.0, 0.9], [3e38, 1.0, 0.0]].map(|x: [f32; 3]| input(&x));
    many(edges, 1000, |random| {
        input(&[magnitude(random, -2.0, 6.0), 1.0 + magnitude(random, -2.0, 6.0), between(random, 0.0, 0.999)])
    })
}

/// Coefficients of a polynomial of a normal, and the normal.
pub(crate) fn harmonics() -> Vec<Input> {
    let mut random = Rng::with_seed(23);
    let mut one = || {
        let coefficients = (0..9).flat_map(|_| [0; 3].map(|_| between(&mut random, -1.0, 1.0))).collect::<Vec<_>>();
        input(&[&coefficients[..], &direction(&mut random)].concat())
    };
    (0..256).map(|_| one()).collect()
}

/// Directions of any length, along axes and along seams among them.
pub(crate) fn directions() -> Vec<Input> {
    let mut random = Rng::with_seed(29);
    let steps = [-1.0, 0.0, 1.0];
    let grid = steps.into_iter().flat_map(|x| steps.into_iter().flat_map(move |y| steps.map(|z| [x, y, z])));
    let grid: Vec<_> = grid.map(|d| input(&d)).collect();
    let mut any = || {
        let size = magnitude(&mut random, -3.0, 3.0);
        input(&direction(&mut random).map(|x| x * size))
    };
    grid.into_iter().chain((0..256).map(|_| any())).collect()
}
