//! Positions far from the origin of their coordinates, as those of maps.

use glam::DVec3;

/// How many times its size the middle of a box may be away from the origin before its positions are counted from an
/// origin of their own. Up to there f32 keeps 18 bits of the size.
const FAR: f64 = 64.0;

/// The origin from which positions in this box are counted, so that f32 keeps them: near the middle of a box that is far
/// away beside its size, and 0 otherwise. A multiple of a power of two near the size, so that differences from it are
/// exact in f64 as long as the positions are.
///
/// ```
/// use glam::DVec3;
/// use halfway_mesh::origin_of_box;
///
/// let house = [DVec3::new(400_000.0, 5_000_000.0, 0.0), DVec3::new(400_010.0, 5_000_012.0, 6.0)];
/// assert_eq!(origin_of_box(house[0], house[1]), DVec3::new(400_008.0, 5_000_008.0, 0.0));
/// assert_eq!(origin_of_box(DVec3::ZERO, DVec3::splat(10.0)), DVec3::ZERO);
/// ```
pub fn origin_of_box(min: DVec3, max: DVec3) -> DVec3 {
    let (middle, size) = (min * 0.5 + max * 0.5, (max - min).max_element());
    // A single point is far from anywhere but the origin.
    if !middle.is_finite() || middle.abs().max_element() <= FAR * size {
        return DVec3::ZERO;
    }
    if size == 0.0 {
        return middle;
    }
    let step = size.log2().floor().exp2();
    let origin = (middle / step).round() * step;
    if origin.is_finite() { origin } else { DVec3::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_far_boxes_have_an_origin() {
        let around = |middle: f64| origin_of_box(DVec3::splat(middle - 0.5), DVec3::splat(middle + 0.5));
        assert_eq!(around(64.0), DVec3::ZERO);
        assert_eq!(around(65.0), DVec3::splat(65.0));
        assert_eq!(around(-1e9), DVec3::splat(-1e9));
        assert_eq!(origin_of_box(DVec3::X, DVec3::X), DVec3::X);
        let (tiny, least) = (DVec3::splat(1.0 + 1e-12), DVec3::splat(f64::MIN_POSITIVE));
        assert!((origin_of_box(DVec3::ONE, tiny) - DVec3::ONE).length() < 1e-11);
        assert_eq!(origin_of_box(-least, least), DVec3::ZERO);
        for infinite in [DVec3::INFINITY, DVec3::NAN, DVec3::MAX] {
            assert_eq!(origin_of_box(-infinite, infinite), DVec3::ZERO);
        }
    }
}
