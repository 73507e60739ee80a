//! Summed-area tables, by which the mean of any rectangle takes a few lookups.

use rayon::prelude::*;

use crate::sampling::Wrap;

/// The integral along an axis from 0 to a point that may lie beyond the image, as integrals from 0 to two points inside
/// it, each times a factor.
pub(crate) fn inside(wrap: Wrap, at: f64, side: f64) -> [(f64, f64); 2] {
    let period = (at / side).floor();
    let rest = (at - period * side).clamp(0.0, side);
    match wrap {
        Wrap::Mirror if period.rem_euclid(2.0) >= 1.0 => [(side - rest, -1.0), (side, period + 1.0)],
        Wrap::Repeat | Wrap::Mirror => [(rest, 1.0), (side, period)],
        // The outermost texel continues without end.
        Wrap::Clamp if at < 0.0 => [(1.0, at), (0.0, 0.0)],
        Wrap::Clamp if at > side => [(side, 1.0 + at - side), (side - 1.0, side - at)],
        Wrap::Clamp => [(at, 1.0), (0.0, 0.0)],
    }
}

/// A summed-area table (Crow 1984): at each corner (x, y) of the texels, the sum to the left and above, minus that many
/// times the image's mean. A rectangle's sum is S(x₁, y₁) − S(x₀, y₁) − S(x₁, y₀) + S(x₀, y₀).
///
/// Sums of n texels in f32 are off by up to n·2⁻²⁴ of their mean, and their differences as much. Subtracting the mean
/// first (Hensley et al. 2005) leaves sums that grow with the contrast alone, and they are stored in f64: 32 bytes a
/// texel, twice the image's memory.
///
/// ```
/// use halfway_texture::{Pyramid, TexelImage};
///
/// let pyramid = Pyramid::new(TexelImage::from_fn(4, 4, |x, _| [x as f32; 4])?);
/// let table = pyramid.summed_areas();
/// assert_eq!((table.mean()[0], table.sums().len()), (1.5, 25));
/// # Ok::<(), halfway_texture::TextureError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SummedAreas {
    width: usize,
    height: usize,
    mean: [f64; 4],
    largest: [f64; 4],
    /// (width + 1)·(height + 1) sums, row by row.
    sums: Vec<[f64; 4]>,
}

impl SummedAreas {
    /// From the texels of an image of this size.
    pub(crate) fn new(texels: &[[f32; 4]], size: [u32; 2]) -> Self {
        let [width, height] = size.map(|side| side as usize);
        let texels = &texels[..width * height];
        let of_row = |row: &[[f32; 4]]| row.iter().fold([0.0; 4], |sum, texel| plus(sum, texel.map(f64::from)));
        let rows: Vec<[f64; 4]> = texels.par_chunks_exact(width).map(of_row).collect();
        let mean = rows.into_iter().fold([0.0; 4], plus).map(|sum| sum / (width * height) as f64);
        let mut sums = vec![[0.0; 4]; (width + 1) * (height + 1)];
        // Along the rows, and then down the columns.
        let below = &mut sums[width + 1..];
        below.par_chunks_exact_mut(width + 1).zip(texels.par_chunks_exact(width)).for_each(|(sums, row)| {
            let mut sum = [0.0; 4];
            for (to, texel) in sums[1..].iter_mut().zip(row) {
                sum = plus(sum, std::array::from_fn(|k| f64::from(texel[k]) - mean[k]));
                *to = sum;
            }
        });
        for y in 2..=height {
            let (above, row) = sums.split_at_mut(y * (width + 1));
            let above = &above[(y - 1) * (width + 1)..];
            row[..=width].iter_mut().zip(above).for_each(|(sum, above)| *sum = plus(*sum, *above));
        }
        let larger = |a: [f64; 4], b: [f64; 4]| std::array::from_fn(|k| a[k].max(b[k].abs()));
        let largest = sums.par_chunks(width + 1).map(|row| row.iter().copied().fold([0.0; 4], larger));
        let largest = largest.reduce(|| [0.0; 4], larger);
        Self { width, height, mean, largest, sums }
    }

    /// The mean of the image.
    pub fn mean(&self) -> [f64; 4] {
        self.mean
    }

    /// The largest magnitude of each number of the sums.
    pub fn largest(&self) -> [f64; 4] {
        self.largest
    }

    /// The sums minus the mean's, row by row: one more in a row than there are columns, and one more row than the
    /// image has.
    pub fn sums(&self) -> &[[f64; 4]] {
        &self.sums
    }

    /// Bytes of memory.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.sums[..])
    }

    /// The sum to the left of x and above y, minus the mean's, each texel being a square of its value.
    pub(crate) fn to_corner(&self, x: f64, y: f64) -> [f64; 4] {
        let (x, y) = (x.clamp(0.0, self.width as f64), y.clamp(0.0, self.height as f64));
        let [column, row] = [(x as usize).min(self.width - 1), (y as usize).min(self.height - 1)];
        let (a, b) = (x - column as f64, y - row as f64);
        let at = |column: usize, row: usize| self.sums[row * (self.width + 1) + column];
        let corners = [at(column, row), at(column + 1, row), at(column, row + 1), at(column + 1, row + 1)];
        let weights = [(1.0 - a) * (1.0 - b), a * (1.0 - b), (1.0 - a) * b, a * b];
        std::array::from_fn(|k| (0..4).map(|corner| weights[corner] * corners[corner][k]).sum())
    }
}

fn plus(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|k| a[k] + b[k])
}
