//! Filters by a rectangle along the axes: ripmaps and summed areas.

use super::footprint::FootprintShape;
use super::{Number, in_image, mixed};
use crate::halves::Level;
use crate::ripmap::Ripmap;
use crate::sampling::{Sampling, Wrap};
use crate::sums::{SummedAreas, inside};

/// Interpolates the four images around the logarithms of the rectangle's sides.
pub(super) fn in_ripmap<T: Number>(
    ripmap: &Ripmap,
    sampling: Sampling,
    uv: [T; 2],
    footprint: &FootprintShape<T>,
) -> [T; 4] {
    let counts = ripmap.counts();
    let sides = footprint.sides();
    let [(i, along_u), (j, along_v)] = [0, 1].map(|axis| {
        let last = T::from_f64((counts[axis] - 1) as f64);
        let d = sides[axis].max(T::one()).binary_logarithm().max(T::zero()).min(last);
        (d.floor().to_usize().unwrap_or(0), d - d.floor())
    });
    let of = |i: usize, j: usize| {
        let (Level { width, height, .. }, texels) = ripmap.level([i, j]);
        in_image(texels, [width, height], sampling.wrap, sampling.minify, uv)
    };
    let row = |j: usize| {
        let a = of(i, j);
        if along_u == T::zero() { a } else { mixed(a, of(i + 1, j), along_u) }
    };
    let a = row(j);
    if along_v == T::zero() { a } else { mixed(a, row(j + 1), along_v) }
}

/// A rectangle is at most this many images wide.
const WIDEST: f64 = 4096.0;

/// The mean of the rectangle around a point. Sums and their differences are f64, whatever `T` is.
pub(super) fn mean<T: Number>(
    sums: &SummedAreas,
    size: [u32; 2],
    wrap: [Wrap; 2],
    uv: [T; 2],
    footprint: &FootprintShape<T>,
) -> [T; 4] {
    let sides = footprint.sides();
    let [columns, rows] = [0, 1].map(|axis| {
        let texels = f64::from(size[axis]);
        let side = sides[axis].to_f64().unwrap_or(f64::INFINITY).clamp(1.0, WIDEST * texels);
        Interval::new(wrap[axis], uv[axis].to_f64().unwrap_or(0.0), side, texels)
    });
    let mut sum = [0.0; 4];
    for (x, of_column) in columns.parts() {
        for (y, of_row) in rows.parts() {
            for (sum, number) in sum.iter_mut().zip(sums.to_corner(x, y)) {
                *sum += of_column * of_row * number;
            }
        }
    }
    let area = columns.length * rows.length;
    std::array::from_fn(|k| T::from_f64(sums.mean()[k] + sum[k] / area))
}

/// The integral over an interval of an axis, which may reach beyond the image, as a sum of integrals from 0 to points
/// inside it, each times a factor.
struct Interval {
    length: f64,
    parts: [(f64, f64); 4],
}

impl Interval {
    fn new(wrap: Wrap, middle: f64, length: f64, side: f64) -> Self {
        let middle = match wrap {
            Wrap::Repeat => (middle - middle.floor()) * side,
            Wrap::Mirror => (middle - 2.0 * (middle / 2.0).floor()) * side,
            Wrap::Clamp => (middle * side).clamp(-length, side + length),
        };
        let [a, b] = inside(wrap, middle + 0.5 * length, side);
        let [c, d] = inside(wrap, middle - 0.5 * length, side).map(|(at, factor)| (at, -factor));
        Self { length, parts: [a, b, c, d] }
    }

    fn parts(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.parts.iter().copied().filter(|(_, factor)| *factor != 0.0)
    }
}
