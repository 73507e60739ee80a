//! Noise in space, and solids made of it.
//!
//! Everything is a function of a point and of the `width` of the footprint there: how far the point moves from a pixel
//! to the next, in units of the noise's cells. Detail finer than a pixel fades to its mean.
//!
//! ```
//! use halfway_texture::noise::{checker, fractal, marble};
//!
//! let p = [0.3_f64, 1.7, 2.2];
//! assert!((0.0..=1.0).contains(&marble(p, 5, 0.01)));
//! // From afar only the mean remains.
//! assert_eq!((fractal(p, 5, 10.0), checker(p, [1000.0; 3])), (0.0, 0.5));
//! ```

use crate::lookup::Number;

/// Three pseudo-random numbers from three: `pcg3d` of Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020.
/// 32-bit additions and products, the same on every machine and in WGSL.
pub fn hash([x, y, z]: [u32; 3]) -> [u32; 3] {
    let [mut x, mut y, mut z] = [x, y, z].map(|v| v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    let stir = |x: &mut u32, y: &mut u32, z: &mut u32| {
        *x = x.wrapping_add(y.wrapping_mul(*z));
        *y = y.wrapping_add(z.wrapping_mul(*x));
        *z = z.wrapping_add(x.wrapping_mul(*y));
    };
    stir(&mut x, &mut y, &mut z);
    [x, y, z] = [x, y, z].map(|v| v ^ v >> 16);
    stir(&mut x, &mut y, &mut z);
    [x, y, z]
}

/// Gradient noise of Perlin, "Improving Noise", 2002: 0 at whole numbers, within −1.04 to 1.04, its mean 0. Each cell's
/// corners have one of the twelve directions to the edges of a cube (four of them twice), by [`hash`]; between them
/// they are interpolated by 6t⁵ − 15t⁴ + 10t³. 0 at points that are not finite.
pub fn gradient_noise<T: Number>(p: [T; 3]) -> T {
    let floor = p.map(T::floor);
    let Some(cell) = whole(floor) else { return T::zero() };
    let f = [p[0] - floor[0], p[1] - floor[1], p[2] - floor[2]];
    let corner = |k: usize| {
        let offset = [k & 1, k >> 1 & 1, k >> 2];
        let [h, ..] = hash(std::array::from_fn(|axis| cell[axis].wrapping_add(offset[axis] as u32)));
        let d: [T; 3] = std::array::from_fn(|axis| f[axis] - T::from_f64(offset[axis] as f64));
        toward(h >> 28, d)
    };
    let [s, t, r] = f.map(faded_in);
    let mix = |a: T, b: T, part: T| a + part * (b - a);
    let row = |k: usize| mix(corner(k), corner(k + 1), s);
    mix(mix(row(0), row(2), t), mix(row(4), row(6), t), r)
}

/// The dot product of one of sixteen directions with a vector.
fn toward<T: Number>(number: u32, [x, y, z]: [T; 3]) -> T {
    let u = if number < 8 { x } else { y };
    let v = match number {
        0..=3 => y,
        12 | 14 => x,
        _ => z,
    };
    let signed = |x: T, bit: u32| if number & bit == 0 { x } else { -x };
    signed(u, 1) + signed(v, 2)
}

fn faded_in<T: Number>(t: T) -> T {
    t * t * t * (t * (t * T::from_f64(6.0) - T::from_f64(15.0)) + T::from_f64(10.0))
}

/// The cell of a point, modulo 2³²; `None` if it is not finite.
fn whole<T: Number>(floor: [T; 3]) -> Option<[u32; 3]> {
    let of = |x: T| x.to_i64().map(|number| number as u32);
    Some([of(floor[0])?, of(floor[1])?, of(floor[2])?])
}

/// The fraction of noise that remains under a footprint of this width, in its cells: all up to ¼, none from ¾ on,
/// falling by 3t² − 2t³ between (Ebert et al., *Texturing and Modeling*, 2003, on fading before aliasing).
pub fn fade<T: Number>(width: T) -> T {
    let t = ((width - T::from_f64(0.25)) * T::from_f64(2.0)).max(T::zero()).min(T::one());
    T::one() - t * t * (T::from_f64(3.0) - T::from_f64(2.0) * t)
}

/// The most octaves of a sum.
pub const MOST_OCTAVES: u32 = 16;

/// A fractal sum: Σ 2⁻ᵏ·noise(2ᵏ·p) over `octaves` octaves, at most [`MOST_OCTAVES`], each faded by [`fade`] of
/// 2ᵏ·`width`; octaves that have vanished are not evaluated. About −1 to 1, and within −2.08 to 2.08.
pub fn fractal<T: Number>(p: [T; 3], octaves: u32, width: T) -> T {
    let (mut sum, mut frequency, mut amplitude) = (T::zero(), T::one(), T::one());
    for octave in 0..octaves.min(MOST_OCTAVES) {
        let weight = fade(frequency * width.abs());
        // NaN counts as vanished.
        if weight.is_nan() || weight <= T::zero() {
            break;
        }
        // Octaves with the same origin would all be 0 there.
        let offset = T::from_f64(f64::from(octave) * 0.37);
        sum = sum + weight * amplitude * gradient_noise(p.map(|x| x * frequency + offset));
        frequency = frequency + frequency;
        amplitude = T::from_f64(0.5) * amplitude;
    }
    sum
}

/// Marble: veins across x, one a unit, bent by a fractal sum of `octaves` octaves. 0 to 1, its mean about ½: ½ + ½ sin
/// 2π(x + sum).
pub fn marble<T: Number>(p: [T; 3], octaves: u32, width: T) -> T {
    wave(p[0] + fractal(p, octaves, width), width)
}

/// Wood: rings around the y axis, one a unit, made uneven by noise that is ten times as long along the axis. 0 to 1.
pub fn wood<T: Number>([x, y, z]: [T; 3], width: T) -> T {
    let grain = gradient_noise([x, y * T::from_f64(0.1), z]) * T::from_f64(0.3) * fade(width.abs());
    wave((x * x + z * z).sqrt() + grain, width)
}

/// ½ + ½ sin 2πt under a footprint of width w: times sin(πw)/(πw), the mean of a wave over a box, up to its first 0 at
/// w = 1.
fn wave<T: Number>(t: T, width: T) -> T {
    let half = T::from_f64(0.5);
    let angle = T::from_f64(std::f64::consts::PI) * width.abs();
    let contrast = if width.is_nan() || width.abs() >= T::one() {
        T::zero()
    } else if angle > T::from_f64(1e-3) {
        angle.sine() / angle
    } else {
        T::one()
    };
    let t = t - t.floor();
    if contrast > T::zero() && t.is_finite() {
        half + half * contrast * (T::from_f64(std::f64::consts::TAU) * t).sine()
    } else {
        half
    }
}

/// A checker of cubes of side 1: 0 or 1, or the mean over a box of these widths along the axes, exactly. Widths below
/// [`LEAST_WIDTH`] count as that, so that a plane just between cubes is ½ everywhere instead of speckled by rounding.
pub fn checker<T: Number>(p: [T; 3], widths: [T; 3]) -> T {
    let half = T::from_f64(0.5);
    let product = (0..3).fold(T::one(), |product, axis| product * square_wave(p[axis], widths[axis].abs()));
    if product.is_finite() { half - half * product } else { half }
}

/// The narrowest box over which [`checker`] averages, in cubes.
pub const LEAST_WIDTH: f32 = 1e-3;

/// The mean of a wave over a box: 1 from 0 to 1, −1 from 1 to 2, and so on.
fn square_wave<T: Number>(x: T, width: T) -> T {
    let (half, one, two) = (T::from_f64(0.5), T::one(), T::from_f64(2.0));
    let width = width.max(T::from_f64(LEAST_WIDTH.into()));
    let period = |x: T| x - two * (x * half).floor();
    if width <= one {
        // The box contains one step at most; the distance from it is exact where the step is far.
        let step = (x + half).floor();
        let sign = one - two * period(step);
        return sign * ((x - step) / (half * width)).max(-one).min(one);
    }
    // Its integral: a triangle of the height 1.
    let integral = |x: T| one - (period(x) - one).abs();
    (integral(x + half * width) - integral(x - half * width)) / width
}
