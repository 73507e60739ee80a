//! Arguments for the functions of maps.wgsl: every edge of their definitions, and numbers over the whole range.

use crate::images::{FILTERS, HEIGHT, IMAGES, Look, WRAPS};
use crate::inputs::{Input, between, direction, input, magnitude, many};
use fastrand::Rng;

/// One of 0 to count − 1.
fn below(random: &mut Rng, count: usize) -> f32 {
    between(random, 0.0, count as f32).floor().min(count as f32 - 1.0)
}

/// A look, and four numbers.
pub(crate) fn looks() -> Vec<Input> {
    many([0.0, 0x1fff as f32].map(|bits| input(&[bits, 1.0, 2.0, 3.0, 4.0])), 300, |random| {
        input(&[Look::random(random).bits(), 1.0, 2.0, 3.0, 4.0])
    })
}

/// Both ends of an image, both sides of them, what is mirrored, and what is far away.
const PLACES: [f32; 23] = [
    0.0,
    1.0,
    -1.0,
    0.5,
    -0.5,
    1.5,
    -0.25,
    1.25,
    2.0,
    -2.0,
    3.0,
    1e-9,
    -1e-9,
    1e-30,
    -1e-30,
    0.999_999_94,
    1.000_000_1,
    2.000_000_2,
    1e6,
    1e6 + 0.3125,
    -12_345.678,
    1e30,
    -1e30,
];

/// A place on an image, anywhere.
fn place(random: &mut Rng) -> f32 {
    if below(random, 2) < 1.0 { between(random, -2.5, 3.5) } else { PLACES[below(random, PLACES.len()) as usize] }
}

/// A coordinate, a side and what is beyond.
pub(crate) fn coordinates() -> Vec<Input> {
    let sides = [1.0f32, 2.0, 5.0, 4096.0];
    let edges =
        PLACES.into_iter().flat_map(|u| sides.into_iter().flat_map(move |side| wraps(move |wrap| vec![u, side, wrap])));
    many(edges, 1000, |random| input(&[place(random), below(random, 300) + 1.0, below(random, WRAPS.len())]))
}

fn wraps(numbers: impl Fn(f32) -> Vec<f32>) -> impl Iterator<Item = Input> {
    [0.0, 1.0, 2.0].into_iter().map(move |wrap| input(&numbers(wrap)))
}

/// A number of a texel, a side and what is beyond: all of twice the image and the mirrored one on either side.
pub(crate) fn indices() -> Vec<Input> {
    let near = [1i8, 2, 3, 5, 8].into_iter().flat_map(|side| (-4 * side..=4 * side).map(move |at| (at, side)));
    let edges = near.flat_map(|(at, side)| wraps(move |wrap| vec![at.into(), side.into(), wrap]));
    many(edges, 500, |random| {
        input(&[between(random, -16e6, 16e6).floor(), below(random, 5000) + 1.0, below(random, WRAPS.len())])
    })
}

/// A part of the way between two texels, and a filter between texels.
pub(crate) fn parts() -> Vec<Input> {
    let edges =
        [0.0f32, 1.0, 0.5, 1e-9, 0.999_999_94].into_iter().flat_map(|f| [1.0, 2.0, 3.0].map(|k| input(&[f, k])));
    many(edges, 500, |random| input(&[between(random, 0.0, 1.0), below(random, 3) + 1.0]))
}

/// Each texel of an image: its level, column and row.
pub(crate) fn texels() -> Vec<Input> {
    let levels = IMAGES[HEIGHT].levels().iter().enumerate();
    let each = levels.flat_map(|(number, level)| {
        let rows = 0..level.height;
        rows.flat_map(move |y| (0..level.width).map(move |x| input(&[number as f32, x as f32, y as f32])))
    });
    each.collect()
}

/// The wrap modes along u and v, a position, a level and a filter.
pub(crate) fn in_levels(slot: usize) -> Vec<Input> {
    let count = IMAGES[slot].levels().len();
    many([], 2500, |random| {
        let [along_u, along_v] = [0; 2].map(|_| below(random, WRAPS.len()));
        let [u, v] = [0; 2].map(|_| place(random));
        input(&[along_u, along_v, u, v, below(random, count), below(random, FILTERS.len())])
    })
}

/// D in steps of 1/16, where levels follow each other, and far beyond them. So rounding it to a level is exact.
fn level(random: &mut Rng) -> f32 {
    if below(random, 8) < 1.0 {
        return [0.0, -1e30, 1e30, -1e-9, 1e-9][below(random, 5) as usize];
    }
    (16.0 * between(random, -1.0, 6.0)).floor() / 16.0
}

/// A look, a place and D.
pub(crate) fn at_levels() -> Vec<Input> {
    many([], 2500, |random| {
        let look = Look::random(random).bits();
        input(&[look, place(random), place(random), level(random)])
    })
}

/// The same without filters that have steps, and not far away.
pub(crate) fn gradients() -> Vec<Input> {
    many([], 2500, |random| {
        let look = Look::random(random).without_steps().bits();
        input(&[look, between(random, -3.0, 4.0), between(random, -3.0, 4.0), level(random)])
    })
}

/// Both sets of coordinates, and how they change along x and along y: from much less than a texel to the whole image.
fn placed_in(random: &mut Rng, slot: f32, look: Look, size: Option<f32>) -> Input {
    let mut numbers = vec![slot, look.bits()];
    numbers.extend([0; 4].map(|_| between(random, -3.0, 3.0)));
    for _ in 0..2 {
        let size = size.unwrap_or_else(|| magnitude(random, -4.0, 0.5));
        numbers.extend([0; 4].map(|_| size * between(random, -1.0, 1.0)));
    }
    input(&numbers)
}

/// A slot, a look, and what [`placed_in`] has.
pub(crate) fn placed() -> Vec<Input> {
    many([], 1000, |random| {
        let (slot, look) = (below(random, IMAGES.len()), Look::random(random));
        placed_in(random, slot, look, None)
    })
}

/// The same with footprints that are points.
pub(crate) fn points() -> Vec<Input> {
    many([], 50, |random| {
        let (slot, look) = (below(random, IMAGES.len()), Look::random(random));
        placed_in(random, slot, look, Some(0.0))
    })
}

/// The same in one slot, without steps.
pub(crate) fn placed_on(slot: usize) -> Vec<Input> {
    many([], 1500, |random| {
        let look = Look::random(random).smooth();
        placed_in(random, slot as f32, look, None)
    })
}

fn joined(parts: &[&[f32]]) -> Input {
    input(&parts.concat())
}

/// n, t, w, a texel, a scale, and the normal otherwise; n that vanishes or nearly does, and a texel of no direction.
pub(crate) fn mapped_normals() -> Vec<Input> {
    let (z, x, other) = ([0.0f32, 0.0, 1.0], [1.0f32, 0.0, 0.0], [0.0f32, 0.6, 0.8]);
    let row = |n: [f32; 3], t: [f32; 3], texel: [f32; 3], s: f32| joined(&[&n, &t, &[1.0], &texel, &[s], &other]);
    let edges = [
        row([0.0; 3], x, [0.5, 0.5, 1.0], 1.0),
        row([0.0, 0.0, 5e-7], x, [0.5, 0.5, 1.0], 1.0),
        row([0.0, 0.0, 2e-6], x, [0.5, 0.5, 1.0], 1.0),
        row(z, x, [0.5; 3], 1.0),
        row(z, [0.0; 3], [1.0, 0.0, 0.5], 1.0),
        row(z, z, [0.5, 1.0, 0.5], 1.0),
        row(z, x, [1.0, 0.5, 0.5], 0.0),
        row(z, x, [0.5, 0.5, 0.0], 1.0),
        row(z, x, [1.0, 1.0, 1.0], -2.0),
    ];
    many(edges, 2000, |random| {
        let [n, t] = [0; 2].map(|_| {
            let size = magnitude(random, -1.0, 1.0);
            direction(random).map(|x| x * size)
        });
        let w = if below(random, 2) < 1.0 { 1.0 } else { -1.0 };
        let texel = [0; 3].map(|_| between(random, 0.0, 1.0));
        joined(&[&n, &t, &[w], &texel, &[between(random, -2.0, 3.0)], &direction(random)])
    })
}

/// A texel of normals, and a factor of their slopes: also of vectors of length 0, 1 and more.
pub(crate) fn texels_with_scales() -> Vec<Input> {
    let row = |texel: [f32; 3], s: f32| joined(&[&texel, &[s]]);
    let edges = [
        row([0.5; 3], 1.0),
        row([0.5; 3], 0.0),
        row([0.5, 0.5, 1.0], 2.0),
        row([1.0; 3], 1.0),
        row([0.5, 0.5, 0.75], 0.0),
        row([0.5, 0.5, 0.75], -2.0),
    ];
    many(edges, 2000, |random| {
        let (direction, length) = (direction(random), between(random, 0.0, 1.2));
        let texel = direction.map(|x| 0.5 * length * x + 0.5);
        row(texel, magnitude(random, -1.5, 1.5))
    })
}

/// Mean slopes, the means of their products, and a factor; among them what leaves no variance, and less.
pub(crate) fn moments() -> Vec<Input> {
    let row = |mean: [f32; 2], squares: [f32; 3], s: f32| joined(&[&mean, &squares, &[s]]);
    let edges = [
        row([0.5, 0.25], [0.25, 0.125, 0.0625], 1.0),
        row([0.5, 0.25], [0.2, 0.125, 0.05], -2.0),
        row([16.0, -16.0], [256.0, -256.0, 256.0], 1.0),
        row([0.0; 2], [1.0, 0.5, 1.0], 0.0),
        row([0.0; 2], [256.0, 0.5, 1.0], 3e6),
    ];
    many(edges, 2000, |random| {
        let [x, y] = [between(random, -3.0, 3.0), between(random, -3.0, 3.0)];
        let more = [between(random, 0.0, 2.0), between(random, -1.0, 1.0), between(random, 0.0, 2.0)];
        row([x, y], [x * x + more[0], x * y + more[1], y * y + more[2]], magnitude(random, -1.5, 1.5))
    })
}

/// Covariances, and an exponent; among them none, those along one axis, and what is none.
pub(crate) fn covariances() -> Vec<Input> {
    let row = |covariance: [f32; 3], s: f32| joined(&[&covariance, &[s]]);
    let edges = [
        row([0.0; 3], 0.0),
        row([0.0; 3], 40.0),
        row([0.5, 0.0, 0.0], 40.0),
        row([0.5, 0.5, 0.5], 40.0),
        row([0.1, 3.0, 0.2], 40.0),
        row([1e14, 0.0, 2.0], 1e4),
        row([0.5, 0.1, 0.3], 0.0),
    ];
    many(edges, 2000, |random| {
        let [a, b] = [magnitude(random, -3.0, 1.0), magnitude(random, -3.0, 1.0)];
        row([a, between(random, -0.95, 0.95) * (a * b).sqrt(), b], magnitude(random, -1.0, 3.0))
    })
}

/// A normal, a tangent and w; among the tangents none.
pub(crate) fn axes() -> Vec<Input> {
    let row = |n: [f32; 3], t: [f32; 3], w: f32| joined(&[&n, &t, &[w]]);
    let z = [0.0, 0.0, 1.0];
    let edges = [row(z, [0.0; 3], 1.0), row(z, [1.0, 0.0, 0.0], -1.0), row(z, [0.6, 0.0, 0.8], 0.5)];
    many(edges, 2000, |random| row(direction(random), direction(random), between(random, -1.0, 1.0)))
}

/// The length of a mean, and an exponent.
pub(crate) fn lengths_with_exponents() -> Vec<Input> {
    let row = |length: f32, exponent: f32| joined(&[&[length, exponent]]);
    let edges = [row(0.0, 10.0), row(0.0, 0.0), row(1.0, 0.0), row(1.0, 40.0), row(-0.5, 5.0), row(1.5, 5.0)];
    many(edges, 2000, |random| row(between(random, 0.0, 1.0), magnitude(random, -1.0, 5.0)))
}

/// n, m, both ways, both rises, and the normal otherwise; n that vanishes, and ways that are one, or none.
pub(crate) fn bumped_normals() -> Vec<Input> {
    let (z, x, y, other) = ([0.0f32, 0.0, 1.0], [1.0f32, 0.0, 0.0], [0.0f32, 1.0, 0.0], [0.0f32, 0.6, 0.8]);
    let row = |n: [f32; 3], m: [f32; 3], e1: [f32; 3], e2: [f32; 3], rises: [f32; 2]| {
        joined(&[&n, &m, &e1, &e2, &rises, &other])
    };
    let edges = [
        row([0.0; 3], z, x, y, [0.3, 0.4]),
        row([0.0, 0.0, 5e-7], z, x, y, [0.3, 0.4]),
        row([0.0, 0.0, 2e-6], [0.0, 0.0, 2e-6], x, y, [0.3, 0.4]),
        row(z, z, x, x, [0.3, 0.4]),
        row(z, z, x, [0.0; 3], [0.3, 0.4]),
        row(z, z, x, z, [0.3, 0.4]),
        row(z, z, x, y, [0.0; 2]),
        row(z, z, y, x, [0.3, 0.4]),
        row(z, [0.0; 3], x, y, [0.3, 0.4]),
        // A surface that its transform flattens: nothing but the slope is left, and there is none.
        row(z, x, x, y, [-1.0, 0.0]),
    ];
    many(edges, 2000, |random| {
        let [n, m, e1, e2] = [0; 4].map(|_| {
            let size = magnitude(random, -1.0, 1.0);
            direction(random).map(|x| x * size)
        });
        joined(&[&n, &m, &e1, &e2, &[between(random, -1.0, 1.0), between(random, -1.0, 1.0)], &direction(random)])
    })
}
