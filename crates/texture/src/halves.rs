//! Images of half the width or height.

use rayon::prelude::*;

/// One image of a [`Pyramid`](crate::Pyramid) or [`Ripmap`](crate::Ripmap).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level {
    /// Texels in a row, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// The index of its first texel among those of all levels.
    pub start: usize,
}

/// Images of fewer texels than this are halved by one thread: two would take longer.
const PARALLEL: usize = 1 << 15;

/// Half of a side, rounded down, at least 1.
pub(crate) fn half(side: u32) -> u32 {
    (side / 2).max(1)
}

/// The part of a row or column under a texel of the smaller image: its first and last neighbour, and the overlap with
/// each, in units of the larger image's texels times the smaller one's count.
struct Under {
    first: usize,
    shares: Vec<f64>,
}

fn under(from: usize, to: usize) -> Vec<Under> {
    let share = |x: usize| {
        // From from/to·x to from/to·(x + 1), in whole numbers: over `to`.
        let (low, high) = (x * from, (x + 1) * from);
        let (first, end) = (low / to, high.div_ceil(to));
        let shares = (first..end).map(|at| (((at + 1) * to).min(high) - (at * to).max(low)) as f64).collect();
        Under { first, shares }
    };
    (0..to).map(share).collect()
}

/// The weighted mean of the larger image's texels under a texel of the smaller one; `source` gives them by their number
/// in the row or column.
fn mean(under: &Under, whole: f64, source: impl Fn(usize) -> [f32; 4]) -> [f32; 4] {
    let mut sum = [0.0_f64; 4];
    for (k, covered) in under.shares.iter().enumerate() {
        for (sum, number) in sum.iter_mut().zip(source(under.first + k)) {
            *sum += covered * f64::from(number);
        }
    }
    sum.map(|sum| (sum / whole) as f32)
}

/// The image with `width` texels in a row in place of `size[0]`, each the mean of the area under it.
pub(crate) fn narrower(texels: &[[f32; 4]], size: [u32; 2], width: u32) -> Vec<[f32; 4]> {
    let ([from, height], to) = (size.map(|side| side as usize), width as usize);
    let under = under(from, to);
    let mut means = vec![[0.0; 4]; to * height];
    let row = |(row, means): (&[[f32; 4]], &mut [[f32; 4]])| {
        for (mean, under) in means.iter_mut().zip(&under) {
            *mean = self::mean(under, from as f64, |at| row[at]);
        }
    };
    if from * height < PARALLEL {
        texels.chunks_exact(from).zip(means.chunks_exact_mut(to)).for_each(row);
    } else {
        texels[..from * height].par_chunks_exact(from).zip(means.par_chunks_exact_mut(to)).for_each(row);
    }
    means
}

/// The image with `height` rows in place of `size[1]`, each texel the mean of the area under it.
pub(crate) fn lower(texels: &[[f32; 4]], size: [u32; 2], height: u32) -> Vec<[f32; 4]> {
    let ([width, from], to) = (size.map(|side| side as usize), height as usize);
    let under = under(from, to);
    let mut means = vec![[0.0; 4]; width * to];
    let row = |(under, means): (&Under, &mut [[f32; 4]])| {
        for (x, mean) in means.iter_mut().enumerate() {
            *mean = self::mean(under, from as f64, |at| texels[at * width + x]);
        }
    };
    if from * width < PARALLEL {
        under.iter().zip(means.chunks_exact_mut(width)).for_each(row);
    } else {
        under.par_iter().zip(means.par_chunks_exact_mut(width)).for_each(row);
    }
    means
}
