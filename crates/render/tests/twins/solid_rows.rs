//! The table of the functions of solids.wgsl: twins of `halfway_texture::noise` and `halfway_texture::solid`. Of what
//! these keep to themselves the definition is written out here.

use halfway_texture::noise::{LEAST_WIDTH, checker, fade, fractal, gradient_noise, hash, marble, wood};
use halfway_texture::solid::{SolidKind, solid_value};
use std::f64::consts::{PI, TAU};

use crate::adapter::Kind;
use crate::inputs::{Input, between, direction, input, magnitude, many, wide};
use crate::map_rows::{ULP, exact, row};
use crate::table::Row;
use fastrand::Rng;

/// The directions by their numbers, as Perlin 2002 lists them.
const DIRECTIONS: [[f64; 3]; 16] = [
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [-1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [-1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, -1.0, 1.0],
    [0.0, 1.0, -1.0],
    [0.0, -1.0, -1.0],
    [1.0, 1.0, 0.0],
    [0.0, -1.0, 1.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, -1.0],
];

/// Places where cells meet, both sides of them, and any others.
fn coordinate(random: &mut Rng) -> f32 {
    const EDGES: [f32; 10] = [0.0, 1.0, -1.0, 0.5, -0.5, 1e-9, -1e-9, 0.999_999_94, -7.0, 12.0];
    let number = between(random, 0.0, 40.0) as usize;
    EDGES.get(number).copied().unwrap_or_else(|| between(random, -50.0, 50.0))
}

/// Widths that leave all, some and nothing, and where that changes.
fn width(random: &mut Rng) -> f32 {
    const EDGES: [f32; 8] = [0.0, 0.25, 0.75, 1.0, 0.5, 1e-4, 1e-3, 2.5];
    let number = between(random, 0.0, 24.0) as usize;
    EDGES.get(number).copied().unwrap_or_else(|| magnitude(random, -3.0, 0.5))
}

fn octaves(random: &mut Rng) -> f32 {
    between(random, 0.0, 20.0).floor()
}

/// Halves of 16 bits of three numbers.
fn halves() -> Vec<Input> {
    let edges = [0.0, 1.0, 65535.0].map(|x| input(&[x; 6]));
    many(edges, 2000, |random| input(&[0; 6].map(|_| between(random, 0.0, 65536.0).floor().min(65535.0))))
}

fn hashed(x: &[f32]) -> [u32; 3] {
    hash([0, 1, 2].map(|k| x[k] as u32 | (x[k + 3] as u32) << 16))
}

/// A cell, a part of it, and one of its corners.
fn corners() -> Vec<Input> {
    many([], 2000, |random| {
        let cell = [0; 3].map(|_| between(random, -100.0, 100.0).floor());
        let part = [0; 3].map(|_| between(random, 0.0, 1.0));
        let corner = [0; 3].map(|_| between(random, 0.0, 2.0).floor().min(1.0));
        input(&[cell, part, corner].concat())
    })
}

fn at_corner(x: &[f32]) -> f64 {
    let of = [0, 1, 2].map(|k| (x[k] as i64 + x[k + 6] as i64) as u32);
    let direction = DIRECTIONS[(hash(of)[0] >> 28) as usize];
    (0..3).map(|k| direction[k] * (f64::from(x[k + 3]) - f64::from(x[k + 6]))).sum()
}

/// A point, octaves and a width.
fn points() -> Vec<Input> {
    many([], 3000, |random| {
        let [x, y, z] = [0; 3].map(|_| coordinate(random));
        input(&[x, y, z, octaves(random), width(random)])
    })
}

/// A point, and widths along the axes.
fn boxes() -> Vec<Input> {
    many([], 3000, |random| {
        let [x, y, z] = [0; 3].map(|_| coordinate(random));
        input(&[x, y, z, width(random), width(random), width(random)])
    })
}

/// A kind, octaves, a point and both ways.
fn places() -> Vec<Input> {
    many([], 4000, |random| {
        let [x, y, z] = [0; 3].map(|_| coordinate(random));
        let ways = [0; 2].map(|_| {
            let size = width(random);
            direction(random).map(|c| c * size)
        });
        let kind = between(random, 0.0, 4.0).floor().min(3.0);
        input(&[&[kind, octaves(random).max(1.0), x, y, z], &ways[0][..], &ways[1][..]].concat())
    })
}

/// The largest of three magnitudes.
fn largest(x: &[f32]) -> f64 {
    x[..3].iter().fold(0.0, |largest, number| f64::max(largest, number.abs().into()))
}

/// Noise itself is off by some 40 roundings of numbers up to 1; each octave's place by half a ULP of it, which counts
/// three times as much at most, and as much as the octave does.
fn of_fractal(x: &[f32], octaves: f64) -> f64 {
    octaves.min(16.0) * ULP * (48.0 + 4.0 * largest(x))
}

/// Of a wave at a place that is off by so much.
fn of_wave(place: f64) -> f64 {
    PI * place + 16.0 * ULP
}

fn of_wood(x: &[f32]) -> f64 {
    of_wave(ULP * (24.0 + 8.0 * largest(x)))
}

/// The mean from the integral, which is a triangle.
fn square_wave(x: f64, width: f64) -> f64 {
    let width = width.max(LEAST_WIDTH.into());
    let integral = |x: f64| 1.0 - (x.rem_euclid(2.0) - 1.0).abs();
    (integral(x + 0.5 * width) - integral(x - 0.5 * width)) / width
}

/// Its place is exact; what is wider than a step takes two places beside it, which are rounded.
fn of_square_wave(x: f32, width: f32) -> f64 {
    ULP * (8.0 + 2.0 * f64::from(x.abs() + width))
}

fn of_checker(x: &[f32]) -> f64 {
    (0..3).map(|k| of_square_wave(x[k], x[k + 3])).sum::<f64>() + 4.0 * ULP
}

fn kind(x: &[f32]) -> SolidKind {
    SolidKind::ALL[x[0] as usize]
}

/// Widths are off by four roundings, which an octave and a wave take as they are. A checker's place is rounded once
/// more, and counts over its width.
fn of_solid(x: &[f32]) -> f64 {
    let q = &x[2..];
    let widths = [0, 1, 2].map(|axis| f64::from(x[5 + axis]).hypot(x[8 + axis].into()).max(LEAST_WIDTH.into()));
    match kind(x) {
        SolidKind::Checker => {
            (0..3).map(|k| ULP * (16.0 + 4.0 * (largest(q) + widths[k]) + 2.0 * (largest(q) + 1.0) / widths[k])).sum()
        }
        SolidKind::Marble => of_wave(2.0 * of_fractal(q, x[1].into()) + ULP * (largest(q) + 8.0)),
        SolidKind::Wood => 2.0 * of_wood(q),
        SolidKind::Noise => 2.0 * of_fractal(q, x[1].into()),
    }
}

pub(crate) fn solid_rows() -> Vec<Row> {
    vec![
        // Equal to the bit.
        row(
            ("hash", "vec3f(hash(vec3u(v(i, 0)) + (vec3u(v(i, 3)) << vec3u(16u))) & vec3u(65535u))"),
            Kind::Vector,
            halves(),
            |x| hashed(x).map(|h| f64::from(h & 65535)).to_vec(),
            exact,
        ),
        row(
            ("hash", "vec3f(hash(vec3u(v(i, 0)) + (vec3u(v(i, 3)) << vec3u(16u))) >> vec3u(16u))"),
            Kind::Vector,
            halves(),
            |x| hashed(x).map(|h| f64::from(h >> 16)).to_vec(),
            exact,
        ),
        row(
            ("at_corner", "at_corner(bitcast<vec3u>(vec3i(v(i, 0))), v(i, 3), vec3u(v(i, 6)))"),
            Kind::Scalar,
            corners(),
            |x| vec![at_corner(x)],
            |_, _| vec![2.0 * ULP],
        ),
        row(
            ("gradient_noise", "gradient_noise(v(i, 0))"),
            Kind::Scalar,
            points(),
            |x| vec![gradient_noise(wide(x))],
            |_, _| vec![40.0 * ULP],
        ),
        row(("fade", "fade(s(i, 4))"), Kind::Scalar, points(), |x| vec![fade(x[4].into())], |_, _| vec![8.0 * ULP]),
        row(
            ("fractal", "fractal(v(i, 0), u32(s(i, 3)), s(i, 4))"),
            Kind::Scalar,
            points(),
            |x| vec![fractal(wide(x), x[3] as u32, x[4].into())],
            |x, _| vec![of_fractal(x, x[3].into())],
        ),
        // The series ends at 6·10⁻⁸, and its terms are at most π/2.
        row(
            ("sine_of_turns", "sine_of_turns(s(i, 0))"),
            Kind::Scalar,
            points(),
            |x| vec![(TAU * f64::from(x[0])).sin()],
            |_, _| vec![8.0 * ULP],
        ),
        row(
            ("wave", "wave(s(i, 0), s(i, 4))"),
            Kind::Scalar,
            points(),
            |x| {
                let angle = PI * f64::from(x[4]).max(1e-9);
                let contrast = if x[4] < 1.0 { angle.sin() / angle } else { 0.0 };
                vec![0.5 + 0.5 * contrast * (TAU * f64::from(x[0])).sin()]
            },
            // Below an angle of a thousandth the contrast counts as 1, which is 1.7·10⁻⁷ more.
            |_, _| vec![16.0 * ULP],
        ),
        row(
            ("marble", "marble(v(i, 0), u32(s(i, 3)), s(i, 4))"),
            Kind::Scalar,
            points(),
            |x| vec![marble(wide(x), x[3] as u32, x[4].into())],
            |x, _| vec![of_wave(of_fractal(x, x[3].into()) + ULP * (largest(x) + 2.0))],
        ),
        row(
            ("wood", "wood(v(i, 0), s(i, 4))"),
            Kind::Scalar,
            points(),
            |x| vec![wood(wide(x), x[4].into())],
            |x, _| vec![of_wood(x)],
        ),
        row(
            ("in_period", "in_period(s(i, 0))"),
            Kind::Scalar,
            points(),
            |x| vec![f64::from(x[0]).rem_euclid(2.0)],
            |_, _| vec![2.0 * ULP],
        ),
        row(
            ("square_wave", "square_wave(s(i, 0), s(i, 3))"),
            Kind::Scalar,
            boxes(),
            |x| vec![square_wave(x[0].into(), x[3].into())],
            |x, _| vec![of_square_wave(x[0], x[3])],
        ),
        row(
            ("checker", "checker(v(i, 0), v(i, 3))"),
            Kind::Scalar,
            boxes(),
            |x| vec![checker(wide(x), wide(&x[3..]))],
            |x, _| vec![of_checker(x)],
        ),
        row(
            ("solid_value", "solid_value(u32(s(i, 0)), u32(s(i, 1)), v(i, 2), v(i, 5), v(i, 8))"),
            Kind::Scalar,
            places(),
            |x| vec![solid_value(kind(x), x[1] as u32, wide(&x[2..]), [wide(&x[5..]), wide(&x[8..])])],
            |x, _| vec![of_solid(x)],
        ),
    ]
}
