//! Diffuse light from an environment.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::directions::unit;
use super::{Environment, density, direction};
use crate::lookup::Number;

impl Environment {
    /// The nine coefficients of its light, over a level of at most 256 rows.
    pub fn harmonics(&self) -> Harmonics {
        let texels = self.texels_of(256);
        let weights: f64 = texels.iter().map(|(_, solid_angle, _)| solid_angle).sum();
        let add = |mut sums: [[f64; 4]; 9], (d, solid_angle, color): &([f64; 3], f64, [f64; 4])| {
            for (sum, value) in sums.iter_mut().zip(basis(*d)) {
                (0..4).for_each(|k| sum[k] += solid_angle * value * color[k]);
            }
            sums
        };
        let sums = texels.iter().fold([[0.0; 4]; 9], add);
        Harmonics { coefficients: sums.map(|sum| sum.map(|sum| sum * 4.0 * PI / weights)) }
    }

    /// Directions, solid angles and colors of the texels of the first level with at most this many rows.
    fn texels_of(&self, rows: u32) -> Vec<([f64; 3], f64, [f64; 4])> {
        let levels = self.images[0].levels();
        let number = levels.iter().position(|level| level.height <= rows).unwrap_or(levels.len() - 1);
        let (level, shape) = (levels[number], self.shape);
        let of_face = |face: usize| {
            let texels = self.images[face].level(number).par_iter().enumerate();
            texels.map(move |(at, texel)| {
                let [x, y] = [at % level.width as usize, at / level.width as usize].map(|at| at as f64 + 0.5);
                let uv = [x / f64::from(level.width), y / f64::from(level.height)];
                let solid_angle = density(shape, uv) / (f64::from(level.width) * f64::from(level.height));
                (unit(direction(shape, face, uv)), solid_angle, texel.map(f64::from))
            })
        };
        (0..self.images.len()).into_par_iter().flat_map(of_face).collect()
    }
}

/// Light in spherical harmonics up to order 2, for diffuse surfaces: nine colors in place of an image.
///
/// From Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001. They hold nearly
/// all of the diffuse light: for one distant light, the worst case, the largest error is 3/32 of the light on a surface
/// that faces it.
///
/// ```
/// use halfway_texture::environment::Harmonics;
///
/// let mut sky = Harmonics::default();
/// sky.add_far_light([0.0, 1.0, 0.0], [1.0; 4]);
/// let [up, down] = [1.0, -1.0].map(|y| sky.mean_light([0.0_f64, y, 0.0])[0]);
/// assert!((up - 1.0).abs() < 0.1 && down.abs() < 0.1);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Harmonics {
    /// L₀₀, L₁₋₁, L₁₀, L₁₁, L₂₋₂, L₂₋₁, L₂₀, L₂₁, L₂₂, each with the four channels of texels.
    pub coefficients: [[f64; 4]; 9],
}

impl Harmonics {
    /// Adds a distant light whose diffuse light on a surface that faces it is `color`.
    pub fn add_far_light(&mut self, direction: [f64; 3], color: [f64; 4]) {
        for (coefficient, value) in self.coefficients.iter_mut().zip(basis(unit(direction))) {
            (0..4).for_each(|k| coefficient[k] += PI * value * color[k]);
        }
    }

    /// The diffuse light on a surface of normal n, (1/π)∫ L(ω) max(n·ω, 0) dω: constant light stays as it is. May be
    /// below 0 by the error.
    pub fn mean_light<T: Number>(&self, normal: [T; 3]) -> [T; 4] {
        let basis = basis(unit(normal));
        let mut sum = [T::zero(); 4];
        for ((coefficient, share), value) in self.coefficients.iter().zip(SHARES).zip(basis) {
            for (sum, number) in sum.iter_mut().zip(coefficient) {
                *sum = *sum + T::from_f64(share * number) * value;
            }
        }
        sum
    }

    /// The light as the coefficients of a polynomial of a normal (x, y, z) of length 1, for red, green and blue: of 1,
    /// y, z, x, xy, yz, 3z² − 1, xz and x² − y².
    pub fn polynomial(&self) -> [[f64; 3]; 9] {
        // The squares of the harmonics' factors, times π.
        const FACTORS: [f64; 9] = [0.25, 0.75, 0.75, 0.75, 3.75, 3.75, 5.0 / 16.0, 3.75, 15.0 / 16.0];
        std::array::from_fn(|i| {
            let factor = SHARES[i] * (FACTORS[i] / PI).sqrt();
            std::array::from_fn(|k| factor * self.coefficients[i][k])
        })
    }
}

/// Aₗ/π of the clamped cosine: 1, 2/3, 1/4.
const SHARES: [f64; 9] = [1.0, 2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 0.25, 0.25, 0.25, 0.25, 0.25];

/// The real spherical harmonics of order 0 to 2 in a direction of length 1.
fn basis<T: Number>([x, y, z]: [T; 3]) -> [T; 9] {
    let of = |square: f64| T::from_f64((square / PI).sqrt());
    let (c0, c1, c2) = (of(0.25), of(0.75), of(3.75));
    let [c3, c4] = [of(5.0 / 16.0), of(15.0 / 16.0)];
    let one = T::one();
    [
        c0,
        c1 * y,
        c1 * z,
        c1 * x,
        c2 * x * y,
        c2 * y * z,
        c3 * (T::from_f64(3.0) * z * z - one),
        c2 * x * z,
        c4 * (x * x - y * y),
    ]
}
