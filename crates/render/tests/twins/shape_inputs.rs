//! Arguments for the functions of `by_shape.wgsl`: every edge of their definitions, and numbers over the whole range.

use crate::images::{IMAGES, Look, WRAPS};
use crate::inputs::{Input, between, input, magnitude, many};
use crate::shape_rows::moments;
use fastrand::Rng;

/// One of 0 to count − 1.
fn below(random: &mut Rng, count: usize) -> f32 {
    between(random, 0.0, count as f32).floor().min(count as f32 - 1.0)
}

fn one_of<T: Copy>(random: &mut Rng, of: &[T]) -> T {
    of[below(random, of.len()) as usize]
}

pub(crate) fn looks() -> Vec<Input> {
    many([], 300, |random| {
        let shape = below(random, 8) as usize;
        input(&[Look::random(random).by_shape(shape).bits()])
    })
}

/// Two ways: of an ellipse with a long semiaxis from `least` on, as long as 40 texels, as slim as 1 : 40.
fn ways(random: &mut Rng, least: f32) -> [f32; 4] {
    let long = magnitude(random, least.log10(), 1.6);
    let short = long * magnitude(random, -1.6, 0.0);
    let [turn, phase] = [0; 2].map(|_| between(random, 0.0, std::f32::consts::TAU));
    // The ellipse's conjugate half-axes at a phase.
    let at = |phase: f32| {
        let (x, y) = (long * phase.cos(), short * phase.sin());
        [x * turn.cos() - y * turn.sin(), x * turn.sin() + y * turn.cos()]
    };
    let ([ax, ay], [bx, by]) = (at(phase), at(phase + std::f32::consts::FRAC_PI_2));
    [ax, ay, bx, by]
}

/// Two ways, also of no size, in one line, alike, and without an end.
pub(crate) fn footprints() -> Vec<Input> {
    let edges = [
        [0.0; 4],
        [3.0, 0.0, 0.0, 3.0],
        [3.0, 4.0, 6.0, 8.0],
        [0.0, 2.0, 0.5, 0.0],
        [1e8, 0.0, 0.0, 1.0],
        [1e10, 0.0, 0.0, 1.0],
        [2.0, 1e12, 5e12, 1.0],
        [1e30, 0.0, 0.0, 1e30],
    ];
    many(edges.map(|ways| input(&ways)), 2000, |random| input(&ways(random, 1e-3)))
}

/// uu, uv and vv, also of circles.
pub(crate) fn moments_of_footprints() -> Vec<Input> {
    let edges =
        [[4.0, 0.0, 4.0], [4.0, 0.0, 1.0], [1.0, 0.0, 4.0], [2.0, 1.0, 2.0], [2.0, -1.0, 2.0], [1e18, 0.0, 1e18]];
    many(edges.map(|moments| input(&moments)), 2000, |random| {
        let of = moments(ways(random, 1e-2).map(f64::from));
        input(&of.map(|number| number as f32))
    })
}

/// A look by one of these shapes, a place, and both ways, in texels.
pub(crate) fn lookups(shapes: &[usize], least: f32) -> Vec<Input> {
    many([], 1200, |random| {
        let shape = one_of(random, shapes);
        let look = Look::random(random).by_shape(shape).bits();
        let [u, v] = [0; 2].map(|_| between(random, -3.0, 4.0));
        let [ax, ay, bx, by] = ways(random, least);
        input(&[look, u, v, ax, ay, bx, by])
    })
}

/// Each image of a ripmap.
pub(crate) fn ripmap_levels(slot: usize) -> Vec<Input> {
    let [columns, rows] = IMAGES[slot].ripmap().counts();
    (0..rows).flat_map(|j| (0..columns).map(move |i| input(&[i as f32, j as f32]))).collect()
}

/// The middle of an interval in images, its length in texels, a side, what is beyond, and the number of the part.
pub(crate) fn intervals() -> Vec<Input> {
    many([], 4000, |random| {
        let middle = (256.0 * between(random, -3.0, 4.0)).floor() / 256.0;
        let length = (128.0 * magnitude(random, 0.0, 1.7)).floor() / 128.0;
        let side = one_of(random, &[1.0, 2.0, 4.0, 8.0]);
        input(&[middle, length, side, below(random, WRAPS.len()), below(random, 3)])
    })
}

/// Four columns and two rows of sums, and the weights of three columns: −1, 0 or 1.
pub(crate) fn strips(slot: usize) -> Vec<Input> {
    let [width, height] = IMAGES[slot].size().map(|side| side as usize);
    many([], 500, |random| {
        let columns = [0; 4].map(|_| below(random, width + 1));
        let rows = [0; 2].map(|_| below(random, height + 1));
        let weights = [0; 3].map(|_| below(random, 3) - 1.0);
        input(&[&columns[..], &rows, &weights].concat())
    })
}

/// From where to where along u and along v, in texels within the image.
pub(crate) fn rectangles(slot: usize) -> Vec<Input> {
    let [width, height] = IMAGES[slot].size().map(|side| side as f32);
    many([input(&[0.0, width, 0.0, height])], 1000, |random| {
        let mut ends = |side: f32| {
            let [a, b] = [0; 2].map(|_| between(random, -0.3, side + 0.3).clamp(0.0, side));
            [a.min(b), a.max(b)]
        };
        let ([left, right], [top, bottom]) = (ends(width), ends(height));
        input(&[left, right, top, bottom])
    })
}

/// A slot, a look, both sets of coordinates, and their ways: from much less than a texel to the whole image.
pub(crate) fn placed(slot: usize) -> Vec<Input> {
    many([], 1200, |random| {
        let shape = one_of(random, &[0, 3, 4, 5, 6, 7]);
        let look = Look::random(random);
        let look = if shape == 0 { look.smooth() } else { look.by_shape(shape) };
        let mut numbers = vec![slot as f32, look.bits()];
        numbers.extend([0; 4].map(|_| between(random, -2.0, 2.0)));
        for _ in 0..2 {
            let size = magnitude(random, -3.0, 0.0);
            numbers.extend([0; 4].map(|_| size * between(random, -1.0, 1.0)));
        }
        input(&numbers)
    })
}

/// Moments, also of what is no larger than a texel, and of circles.
pub(crate) fn to_widen() -> Vec<Input> {
    let edges =
        [[0.25, 0.0, 0.25], [4.0, 0.0, 0.25], [0.25, 0.0, 4.0], [2.5, 1.5, 2.5], [1.0, 0.0, 1.0], [9.0, 0.0, 9.0]];
    many(edges.map(|moments| input(&moments)), 2000, |random| {
        let of = moments(ways(random, 0.1).map(f64::from));
        input(&of.map(|number| number as f32))
    })
}

/// Both ways, the short semiaxis as it is lengthened, and how large a level is along both axes.
pub(crate) fn ellipses() -> Vec<Input> {
    many([], 2000, |random| {
        let ways = ways(random, 1.1);
        let [long, short] = crate::shape_rows::semiaxes(ways.map(f64::from));
        let short = short.max(long / 16.0).max(1.0) as f32;
        let scale = one_of(random, &[[1.0, 1.0], [0.5, 0.5], [0.25, 0.5], [8.0, 1.0], [0.4, 1.0 / 3.0]]);
        input(&[&ways[..], &[short], &scale].concat())
    })
}

/// r² of 0 to 1.
pub(crate) fn distances() -> Vec<Input> {
    many([0.0, 1.0, 0.5].map(|r2| input(&[r2])), 500, |random| input(&[between(random, 0.0, 1.0)]))
}

/// A coordinate, a side, a reach and what is beyond.
pub(crate) fn reaches() -> Vec<Input> {
    many([], 1000, |random| {
        let side = below(random, 40) + 1.0;
        input(&[between(random, -4.0, 4.0), side, between(random, 1.0, 20.0), below(random, WRAPS.len())])
    })
}

/// The wrap modes, a position, a level, and both axes of an ellipse in texels of the level.
pub(crate) fn in_ellipses(slot: usize) -> Vec<Input> {
    let count = IMAGES[slot].levels().len();
    many([], 600, |random| {
        let wraps = [0; 2].map(|_| below(random, WRAPS.len()));
        let uv = [0; 2].map(|_| between(random, -2.0, 3.0));
        let number = below(random, count);
        // Neither semiaxis less than a texel.
        let is_wide = |ways: &[f32; 4]| crate::shape_rows::semiaxes(ways.map(f64::from))[1] > 1.02;
        let ways = std::iter::repeat_with(|| ways(random, 1.05)).find(is_wide).expect("some are wide");
        input(&[&wraps[..], &uv, &[number], &ways].concat())
    })
}
