//! ꟻLIP: the difference that a viewer notices when two pictures alternate in one place.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "ꟻLIP: A Difference Evaluator for Alternating
//! Images", 2020, for pictures of low dynamic range. The value of a pixel is c^(1 − f). Here c is the difference of its
//! colours after the eye has blurred details away, and f that of edges and points, which the eye notices most. Each
//! filter is a sum of products of one along rows and one along columns, and is applied as such.

use std::f64::consts::{E, PI, SQRT_2};

use bevy_math::{DMat3, DVec3};
use halfway_lighting::Encoding;
use halfway_lighting::equations::Transcendental;
use image::RgbImage;
use rayon::prelude::*;

use super::bands::{BandPairs, PictureRows, SizeMismatch};
use super::comparison::same_size;
use super::ranks::{PERCENTILES, nearest_rank};
use crate::Image;

/// Pixels per degree of the field of view: a display of 0.7 m width and 3840 pixels seen from 0.7 m, as the authors
/// recommend. A lower number means a more distant viewer.
pub const PIXELS_PER_DEGREE: f64 = 67.0;

/// The perceived difference of two pictures, over all pixels: 0 is none, 1 the largest.
///
/// Andersson et al., "ꟻLIP: A Difference Evaluator for Alternating Images", 2020, for pictures of low dynamic range:
/// it compares the bytes that a display shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flip {
    /// The mean: the figure to quote.
    pub mean: f64,
    /// The largest.
    pub max: f64,
    /// The least value that [`PERCENTILES`](super::PERCENTILES) per cent of the pixels do not exceed.
    pub percentiles: [f64; 4],
}

/// Measures ꟻLIP at [`PIXELS_PER_DEGREE`]. Pixels that are not finite count as black.
///
/// ```
/// use halfway_lighting::Encoding;
/// use halfway_reference::Image;
/// use halfway_reference::metrics::flip;
///
/// let [gray, brighter, white] = [0.5, 0.51, 1.0].map(|gray| Image::new(16, 16, vec![[gray; 3]; 256]));
/// assert_eq!(flip(&gray, &gray, Encoding::Srgb)?.mean, 0.0);
/// assert!(flip(&gray, &brighter, Encoding::Srgb)?.mean < flip(&gray, &white, Encoding::Srgb)?.mean);
/// # Ok::<(), halfway_reference::metrics::SizeMismatch>(())
/// ```
///
/// # Errors
/// [`SizeMismatch`].
pub fn flip(actual: &dyn PictureRows, expected: &dyn PictureRows, encoding: Encoding) -> Result<Flip, SizeMismatch> {
    Ok(figures(map(actual, expected, encoding)?))
}

/// [`flip()`] over the pixels that both pictures cover, if the coverage of both is known. The others are made equal
/// first, since the eye's blur would spread them.
///
/// # Errors
/// [`SizeMismatch`].
pub fn flip_of_covered(actual: &Image, expected: &Image, encoding: Encoding) -> Result<Flip, SizeMismatch> {
    same_size(actual, expected)?;
    let Some((a, b)) = actual.covered().zip(expected.covered()) else { return flip(actual, expected, encoding) };
    let both: Vec<bool> = a.iter().zip(b).map(|(a, b)| *a && *b).collect();
    let own = both.iter().zip(actual.pixels().iter().zip(expected.pixels()));
    let alike = own.map(|(both, (own, other))| if *both { *own } else { *other }).collect();
    let (width, height) = actual.dimensions();
    let values = map(&Image::new(width, height, alike), expected, encoding)?;
    Ok(figures(values.into_iter().zip(both).filter(|(_, both)| *both).map(|(value, _)| value).collect()))
}

/// The figures of some values; all 0 if there are none.
fn figures(mut values: Vec<f32>) -> Flip {
    values.sort_unstable_by(f32::total_cmp);
    let at = |share| values.get(nearest_rank(values.len() as u64, share) as usize).copied().map_or(0.0, f64::from);
    let mean = values.iter().copied().map(f64::from).sum::<f64>() / values.len().max(1) as f64;
    Flip { mean, max: values.last().copied().map_or(0.0, f64::from), percentiles: PERCENTILES.map(at) }
}

/// The value of each pixel, row by row.
fn map(actual: &dyn PictureRows, expected: &dyn PictureRows, encoding: Encoding) -> Result<Vec<f32>, SizeMismatch> {
    /// The filters keep about 200 bytes a pixel.
    const PIXELS: u32 = 1 << 20;
    Ok(map_by(&BandPairs::new(actual, expected)?, encoding, PIXELS))
}

fn map_by(bands: &BandPairs, encoding: Encoding, pixels: u32) -> Vec<f32> {
    let method = Method::new(&Constants::PUBLISHED, PIXELS_PER_DEGREE);
    let reach = method.reach();
    let (width, height) = bands.size;
    let mut values = Vec::new();
    for rows in bands.ranges(pixels) {
        // Rows above and below affect the values, too.
        let around = rows.start.saturating_sub(reach)..height.min(rows.end.saturating_add(reach));
        let band = bands.band(around.clone());
        let map = method.map([&band.expected, &band.actual].map(|image| image.to_bytes(encoding)));
        let [first, end] = [rows.start, rows.end].map(|row| (row - around.start) as usize * width as usize);
        values.extend(map[first..end].iter().map(|value| *value as f32));
    }
    values
}

/// The constants of the method, named as in the paper.
#[derive(Clone, Copy, Debug)]
struct Constants {
    /// For each opponent channel (luminance, red–green, blue–yellow) the pairs a, b of the contrast sensitivity: at the
    /// distance x in degrees it is Σ a·√(π/b)·exp(−π²·x²/b). A pair with a = 0 adds nothing.
    sensitivity: [[(f64, f64); 2]; 3],
    /// w: the width of features in degrees.
    feature_width: f64,
    /// `q_c`: the exponent of colour differences.
    color_exponent: f64,
    /// `p_c` and `p_t`: the share `p_c` of the largest colour difference becomes the value `p_t`; both sides are
    /// linear.
    knee: (f64, f64),
    /// `q_f`: the exponent of feature differences.
    feature_exponent: f64,
}

impl Constants {
    const PUBLISHED: Self = Self {
        sensitivity: [[(1.0, 0.0047), (0.0, 1.0)], [(1.0, 0.0053), (0.0, 1.0)], [(34.1, 0.04), (13.5, 0.025)]],
        feature_width: 0.082,
        color_exponent: 0.7,
        knee: (0.4, 0.95),
        feature_exponent: 0.5,
    };
}

/// A filter along rows or columns, whose middle weight is that of the pixel itself.
type Kernel = Vec<f64>;

/// The method for a viewer at some distance.
struct Method {
    constants: Constants,
    /// For each opponent channel Gaussians, which filter along both axes, and the weight of each.
    sensitivity: [Vec<(f64, Kernel)>; 3],
    /// A Gaussian, and its first and second derivative.
    gaussian: Kernel,
    edge: Kernel,
    point: Kernel,
    /// The colour difference of green and blue, which is the largest.
    largest_difference: f64,
}

impl Method {
    fn new(constants: &Constants, pixels_per_degree: f64) -> Self {
        // Three standard deviations. That of exp(−π²·x²/b) is √(b/2)/π.
        let radius = |deviation: f64| (3.0 * deviation * pixels_per_degree).ceil() as i32;
        let widest = constants.sensitivity.iter().flatten().filter(|(a, _)| *a > 0.0).map(|(_, b)| *b);
        let sensitivity_radius = radius((widest.fold(0.0, f64::max) / 2.0).sqrt() / PI);
        let sensitivity = constants.sensitivity.map(|pairs| {
            let gaussians = pairs.into_iter().filter(|(a, _)| *a > 0.0).map(|(a, b)| {
                let kernel = kernel(sensitivity_radius, |i| {
                    let x = PI * f64::from(i) / pixels_per_degree;
                    E.pow(-x * x / b)
                });
                let sum: f64 = kernel.iter().sum();
                (a * (PI / b).sqrt() * sum * sum, normalized(kernel))
            });
            let gaussians: Vec<(f64, Kernel)> = gaussians.collect();
            let sum: f64 = gaussians.iter().map(|(weight, _)| weight).sum();
            gaussians.into_iter().map(|(weight, kernel)| (weight / sum, kernel)).collect()
        });
        let deviation = 0.5 * constants.feature_width * pixels_per_degree;
        let feature = |of: fn(f64) -> f64| {
            kernel(radius(0.5 * constants.feature_width), |i| {
                let x = f64::from(i) / deviation;
                of(x) * E.pow(-0.5 * x * x)
            })
        };
        let space = ColorSpace::new();
        let [green, blue] = [DVec3::Y, DVec3::Z].map(|color| space.hunt_adjusted_lab(color));
        Self {
            constants: *constants,
            sensitivity,
            gaussian: normalized(feature(|_| 1.0)),
            edge: normalized(feature(|x| -x)),
            point: normalized(feature(|x| x * x - 1.0)),
            largest_difference: hyab(green, blue).pow(constants.color_exponent),
        }
    }

    /// The distance in pixels up to which pixels affect each other's value.
    fn reach(&self) -> u32 {
        let all = self.sensitivity.iter().flatten().map(|(_, kernel)| kernel).chain([&self.gaussian]);
        all.map(|kernel| kernel.len() as u32 / 2).max().unwrap_or(0)
    }

    /// The value of each pixel of the expected and the actual picture, which have one size.
    fn map(&self, pictures: [RgbImage; 2]) -> Vec<f64> {
        let space = ColorSpace::new();
        let [expected, actual] = pictures.map(|picture| self.perceived(&space, &picture));
        expected.into_par_iter().zip(actual).map(|(expected, actual)| self.value(expected, actual)).collect()
    }

    fn value(&self, expected: Perceived, actual: Perceived) -> f64 {
        let Constants { color_exponent, knee: (at, height), feature_exponent, .. } = self.constants;
        let difference = hyab(expected.color, actual.color).pow(color_exponent) / self.largest_difference;
        let color = if difference < at {
            difference * height / at
        } else {
            height + (difference - at) / (1.0 - at) * (1.0 - height)
        };
        let [edge, point] = [expected.edge - actual.edge, expected.point - actual.point].map(f64::abs);
        let feature = (edge.max(point) / SQRT_2).pow(feature_exponent);
        color.pow(1.0 - feature)
    }

    /// The perceived color and features of each pixel.
    fn perceived(&self, space: &ColorSpace, picture: &RgbImage) -> Vec<Perceived> {
        let linear: [f64; 256] = std::array::from_fn(|byte| Encoding::Srgb.decode(byte as f64 / 255.0));
        let width = picture.width() as usize;
        let opponent = picture.pixels().map(|pixel| {
            space.opponent_from_rgb(DVec3::from_array(pixel.0.map(|channel| linear[usize::from(channel)])))
        });
        let opponent: Vec<DVec3> = opponent.collect();
        let channel = |k: usize| opponent.iter().map(|pixel| pixel[k]).collect();
        let planes = [0, 1, 2].map(|k| Plane { width, values: channel(k) });
        let blurred = [0, 1, 2].map(|k| planes[k].filtered_by_sum(&self.sensitivity[k]));
        let luminance = &planes[0];
        let magnitude = |across: &Kernel| {
            let [x, y] = [[across, &self.gaussian], [&self.gaussian, across]].map(|axes| luminance.filtered(axes));
            x.values.into_iter().zip(y.values).map(|(x, y)| x.hypotenuse(y)).collect::<Vec<f64>>()
        };
        let (edges, points) = (magnitude(&self.edge), magnitude(&self.point));
        let pixel = |i: usize| {
            let opponent = DVec3::from_array(std::array::from_fn(|k| blurred[k].values[i]));
            // The blur may produce colours that no display shows.
            let rgb = space.rgb_from_opponent(opponent).clamp(DVec3::ZERO, DVec3::ONE);
            Perceived { color: space.hunt_adjusted_lab(rgb), edge: edges[i], point: points[i] }
        };
        (0..opponent.len()).into_par_iter().map(pixel).collect()
    }
}

/// A pixel as the eye perceives it.
#[derive(Clone, Copy, Debug)]
struct Perceived {
    /// Blurred, in L*a*b* adjusted by Hunt.
    color: DVec3,
    /// The strength of an edge, and of a point, there.
    edge: f64,
    point: f64,
}

/// A number for each pixel, row by row.
struct Plane {
    width: usize,
    values: Vec<f64>,
}

impl Plane {
    /// Filtered by one kernel along rows and another along columns. Beyond the picture its border is repeated.
    fn filtered(&self, [along_rows, along_columns]: [&Kernel; 2]) -> Self {
        let width = self.width;
        if width == 0 {
            return Self { width, values: Vec::new() };
        }
        let mut between = vec![0.0; self.values.len()];
        between.par_chunks_mut(width).zip(self.values.par_chunks(width)).for_each(|(sums, row)| {
            let radius = along_rows.len() / 2;
            let [first, last] = [row[0], row[width - 1]].map(|border| std::iter::repeat_n(border, radius));
            let padded: Vec<f64> = first.chain(row.iter().copied()).chain(last).collect();
            for (offset, weight) in along_rows.iter().enumerate() {
                add_weighted(sums, &padded[offset..], *weight);
            }
        });
        let height = self.values.len() / width;
        let mut values = vec![0.0; self.values.len()];
        values.par_chunks_mut(width).enumerate().for_each(|(y, sums)| {
            for (offset, weight) in along_columns.iter().enumerate() {
                let row = (y + offset).saturating_sub(along_columns.len() / 2).min(height - 1);
                add_weighted(sums, &between[row * width..], *weight);
            }
        });
        Self { width, values }
    }

    /// The weighted sum of the results of the kernels, each applied along both axes.
    fn filtered_by_sum(&self, kernels: &[(f64, Kernel)]) -> Self {
        let mut sum = Self { width: self.width, values: vec![0.0; self.values.len()] };
        for (weight, kernel) in kernels {
            add_weighted(&mut sum.values, &self.filtered([kernel, kernel]).values, *weight);
        }
        sum
    }
}

fn add_weighted(sums: &mut [f64], values: &[f64], weight: f64) {
    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
}

fn kernel(radius: i32, weight: impl Fn(i32) -> f64) -> Kernel {
    (-radius..=radius).map(weight).collect()
}

/// The kernel scaled so that its positive weights add up to 1, and its negative ones to −1.
fn normalized(mut kernel: Kernel) -> Kernel {
    let sum = |sign: f64| kernel.iter().map(|weight| (sign * weight).max(0.0)).sum::<f64>();
    let (positive, negative) = (sum(1.0), sum(-1.0));
    for weight in &mut kernel {
        if *weight > 0.0 {
            *weight /= positive;
        } else if *weight < 0.0 {
            *weight /= negative;
        }
    }
    kernel
}

/// `HyAB`, the distance of two colours in L*a*b* (Abasi et al., "Distance metrics for very large color differences",
/// 2020): city-block between lightness and chroma.
fn hyab(a: DVec3, b: DVec3) -> f64 {
    let difference = a - b;
    difference.x.abs() + difference.y.hypotenuse(difference.z)
}

/// Linear sRGB and its relations to X, Y and Z, each relative to white.
struct ColorSpace {
    xyz_from_rgb: DMat3,
    rgb_from_xyz: DMat3,
}

impl ColorSpace {
    fn new() -> Self {
        /// Chromaticities x, y of the primaries (IEC 61966-2-1) and of the illuminant D65 (CIE 15).
        const PRIMARIES: [[f64; 2]; 3] = [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06]];
        const WHITE: [f64; 2] = [0.31271, 0.32902];
        let xyz = |[x, y]: [f64; 2]| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
        let white = xyz(WHITE);
        let [red, green, blue] = PRIMARIES.map(xyz);
        let primaries = DMat3::from_cols(red, green, blue);
        // These amounts of the primaries make white.
        let amounts = primaries.inverse() * white;
        let xyz_from_rgb = DMat3::from_diagonal(white.recip()) * primaries * DMat3::from_diagonal(amounts);
        Self { xyz_from_rgb, rgb_from_xyz: xyz_from_rgb.inverse() }
    }

    /// Luminance, red–green and blue–yellow of the opponent space `Y_y C_x C_z` (a linear L*a*b*): Y, X − Y and Y − Z.
    /// Its factors 116, 500 and 200 and its offset −16 are left out, since filters whose weights add up to 1 keep them.
    fn opponent_from_rgb(&self, rgb: DVec3) -> DVec3 {
        let DVec3 { x, y, z } = self.xyz_from_rgb * rgb;
        DVec3::new(y, x - y, y - z)
    }

    fn rgb_from_opponent(&self, opponent: DVec3) -> DVec3 {
        let DVec3 { x: y, y: red_green, z: blue_yellow } = opponent;
        self.rgb_from_xyz * DVec3::new(y + red_green, y, y - blue_yellow)
    }

    /// L*a*b* (CIE 15), with a* and b* multiplied by L*/100: colours are the more vivid the brighter (Hunt 1952).
    fn hunt_adjusted_lab(&self, rgb: DVec3) -> DVec3 {
        let [x, y, z] = (self.xyz_from_rgb * rgb).to_array().map(|share| {
            let knee: f64 = 6.0 / 29.0;
            if share > knee * knee * knee { share.pow(1.0 / 3.0) } else { share / (3.0 * knee * knee) + 4.0 / 29.0 }
        });
        let lightness = 116.0 * y - 16.0;
        DVec3::new(lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z))
    }
}

#[cfg(test)]
mod tests;
