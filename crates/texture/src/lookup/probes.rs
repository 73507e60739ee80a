//! Anisotropic filtering by probes along the footprint's long axis.

use super::footprint::FootprintShape;
use super::{Number, between_levels, finite};
use crate::pyramid::Pyramid;
use crate::sampling::Sampling;

/// The mean of probes: see [`LevelFilter::Anisotropic2`](crate::LevelFilter::Anisotropic2).
pub(super) fn mean<T: Number>(
    pyramid: &Pyramid,
    sampling: Sampling,
    uv: [T; 2],
    footprint: &FootprintShape<T>,
    most: u8,
) -> [T; 4] {
    let n = (footprint.long / footprint.short.max(T::one())).min(T::from_f64(most.into()));
    let apart = footprint.long / n;
    let d = apart.binary_logarithm();
    let probe = |uv: [T; 2]| between_levels(pyramid, sampling.wrap, sampling.minify, uv.map(finite), d);
    let [width, height] = pyramid.size().map(|side| T::from_f64(side.into()));
    let [u, v] = footprint.direction();
    let step = [apart * u / width, apart * v / height];
    let mut sum = probe(uv);
    let mut left = n - T::one();
    let mut k = T::one();
    while left > T::zero() {
        let weight = T::from_f64(0.5) * left.min(T::from_f64(2.0));
        for side in [k, -k] {
            let texel = probe([uv[0] + side * step[0], uv[1] + side * step[1]]);
            for (sum, number) in sum.iter_mut().zip(texel) {
                *sum = *sum + weight * number;
            }
        }
        left = left - T::from_f64(2.0);
        k = k + T::one();
    }
    sum.map(|sum| sum / n)
}
