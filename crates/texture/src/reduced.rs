//! Images larger than the limits are scaled down while they are turned into texels.

use image::DynamicImage;

use crate::error::TextureError;
use crate::limits::{LONGEST_SIDE, MOST_TEXELS};
use crate::texels::TexelImage;

/// About how many texels are turned at once, so that a large image is never in memory twice.
const STRIP: u32 = 1 << 20;

/// The size within the limits that an image is scaled down to, of about the same shape; `None` if it is within them.
pub(crate) fn reduced_size((width, height): (u32, u32)) -> Option<[u32; 2]> {
    let texels = u64::from(width) * u64::from(height);
    if width.max(height) <= LONGEST_SIDE && texels <= MOST_TEXELS {
        return None;
    }
    let by_side = f64::from(width.max(height)) / f64::from(LONGEST_SIDE);
    let by_area = (texels as f64 / MOST_TEXELS as f64).sqrt();
    let side = |side: u32| ((f64::from(side) / by_side.max(by_area)) as u32).max(1);
    Some([side(width), side(height)])
}

/// The image scaled down: each texel is the mean over its area. `texels` turns some rows, from the given one on.
pub(crate) fn reduced(
    image: &DynamicImage,
    [width, height]: [u32; 2],
    texels: impl Fn(&DynamicImage, u32) -> Result<Vec<[f32; 4]>, TextureError>,
) -> Result<TexelImage, TextureError> {
    let (from_width, from_height) = (image.width(), image.height());
    let columns: Vec<_> = (0..from_width).map(|x| shares(x, from_width, width)).collect();
    let mut sums = vec![[0.0_f32; 4]; width as usize * height as usize];
    let mut row = vec![[0.0_f32; 4]; width as usize];
    let mut largest = [f32::NEG_INFINITY; 4];
    let rows_at_once = (STRIP / from_width).max(1);
    for first in (0..from_height).step_by(rows_at_once as usize) {
        let strip = image.crop_imm(0, first, from_width, rows_at_once.min(from_height - first));
        let strip = texels(&strip, first)?;
        for (y, from) in (first..).zip(strip.chunks_exact(from_width as usize)) {
            row.fill([0.0; 4]);
            for (texel, shares) in from.iter().zip(&columns) {
                largest = std::array::from_fn(|channel| largest[channel].max(texel[channel]));
                for &(column, share) in shares {
                    add(&mut row[column], *texel, share);
                }
            }
            for (target, share) in shares(y, from_height, height) {
                let start = target * width as usize;
                for (sum, value) in sums[start..][..width as usize].iter_mut().zip(&row) {
                    add(sum, *value, share);
                }
            }
        }
    }
    for sum in &mut sums {
        // Rounding may have lifted it above all that it is a mean of. No number stays none.
        *sum = std::array::from_fn(
            |channel| {
                if sum[channel] > largest[channel] { largest[channel] } else { sum[channel] }
            },
        );
    }
    Ok(TexelImage::checked(width, height, sums).reduced_from(from_width, from_height))
}

/// The one or two of `fewer` places that the place `at` of `many` falls into, and the part of their value that it makes.
fn shares(at: u32, many: u32, fewer: u32) -> [(usize, f32); 2] {
    // In units of 1/(many·fewer), in which all borders are whole numbers.
    let (many, fewer, at) = (u64::from(many), u64::from(fewer), u64::from(at));
    let (start, end) = (at * fewer, (at + 1) * fewer);
    let first = start / many;
    let border = ((first + 1) * many).min(end);
    let share = |length: u64| (length as f64 / many as f64) as f32;
    // The second has no part, and may not exist, where all of it falls into the first.
    let second = if border < end { first + 1 } else { first };
    [(first as usize, share(border - start)), (second as usize, share(end - border))]
}

fn add(sum: &mut [f32; 4], value: [f32; 4], share: f32) {
    for (sum, value) in sum.iter_mut().zip(value) {
        *sum += value * share;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_each_place_sum_to_one() {
        for (many, fewer) in [(9, 4), (8193, 8192), (10, 5), (7, 7), (5, 1)] {
            let mut sums = vec![0.0_f64; fewer as usize];
            for (place, share) in (0..many).flat_map(|at| shares(at, many, fewer)) {
                sums[place] += f64::from(share);
            }
            assert!(sums.iter().all(|sum| (sum - 1.0).abs() < 1e-6), "{many} to {fewer}: {sums:?}");
        }
    }

    #[test]
    fn sizes_keep_their_shape_within_the_limits() {
        assert_eq!(reduced_size((8192, 4096)), None);
        assert_eq!(reduced_size((16384, 8192)), Some([8192, 4096]));
        assert_eq!(reduced_size((16384, 16384)), Some([5792, 5792]));
        assert_eq!(reduced_size((100_000, 3)), Some([8192, 1]));
    }

    #[test]
    fn texels_are_means_over_their_areas() {
        let rows = image::RgbImage::from_fn(8, 4, |x, y| image::Rgb([(x * 30) as u8, (y * 60) as u8, 255]));
        let texels = |strip: &DynamicImage, _| {
            Ok(strip.to_rgb32f().pixels().map(|pixel| [pixel[0] * 255.0, pixel[1] * 255.0, pixel[2], 1.0]).collect())
        };
        let image = reduced(&rows.into(), [2, 2], texels).expect("it is smaller");
        assert_eq!(image.size(), [2, 2]);
        for (found, expected) in image.texels().iter().zip([[45.0, 30.0], [165.0, 30.0], [45.0, 150.0], [165.0, 150.0]])
        {
            let off = (0..2).map(|channel| (found[channel] - expected[channel]).abs()).fold(0.0, f32::max);
            assert!(off < 1e-3 && (found[2] - 1.0).abs() < 1e-6, "{found:?}");
        }
        let said = image.reduction().expect("it was larger");
        assert_eq!(said, "is scaled down from 8 × 4 to 2 × 2 texels, to keep within the limits");
    }
}
