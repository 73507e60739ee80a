//! Shared by the tests of surfaces.

use glam::DVec3;
use halfway_mesh::BezierPatch;

/// p = (u, u² − u v + v³/2, v) turned so that its outward side is up: v runs against x.
pub(crate) fn cubic() -> BezierPatch {
    let c = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let (o, zero) = (DVec3::ZERO, 0.0);
    let rows = [
        [o, c(-1.0, zero, zero), o, c(zero, 0.5, zero)],
        [c(zero, zero, 1.0), c(zero, -1.0, zero), o, o],
        [c(zero, 1.0, zero), o, o, o],
    ];
    BezierPatch::from_polynomial(4, rows.concat()).unwrap()
}

/// Points all over a surface, none of them at a special place.
pub(crate) fn scattered() -> impl Iterator<Item = (f64, f64)> {
    // The additive recurrence of the plastic number (M. Roberts, "The unreasonable effectiveness of quasirandom
    // sequences", 2018).
    (1..200)
        .map(|i| (f64::from(i) * 0.754_877_666_246_693).fract())
        .zip((1..200).map(|i| (f64::from(i) * 0.569_840_290_998_053).fract()))
}
