//! Light from all directions: what an environment adds.
//!
//! ```text
//! I += o·kd·s·E(n) + ks·s·L(r, α)      r = 2(n·v)n − v
//! ```
//!
//! E(n) is the mean light that a matt surface of the normal n receives, o what occlusion leaves of it; L(r, α) the
//! light around the mirrored direction, as wide as the lobe of the exponent α; s the environment's strength.

use super::Real;
use super::reflect;
use super::vector::{add, mul, scale};
use crate::Reflectance;

// ANCHOR: mirrored
/// r: the direction that is seen in a mirror of the normal n from v. Both have unit length.
pub fn mirrored<T: Real>(n: [T; 3], v: [T; 3]) -> [T; 3] {
    reflect(v, n)
}
// ANCHOR_END: mirrored

/// The exponent of Phong's lobe that is as wide as the one of a highlight: of Blinn–Phong's β it is β/4, since the
/// halfway vector turns half as far as the light.
pub fn lobe_exponent<T: Real>(reflectance: Reflectance, exponent: T) -> T {
    match reflectance {
        Reflectance::Phong => exponent,
        Reflectance::BlinnPhong | Reflectance::BlinnPhongMatched => T::from_f64(0.25) * exponent,
    }
}

// ANCHOR: lobe_angle
/// The angle of texels that, looked up bilinearly, have the variance of Phong's lobe: s = 2/√(α + 3) radians.
///
/// The lobe (r·l)^α, normalized over the hemisphere by (α + 1)/2π, has the mean 2/(α + 3) of sin²θ, and so a variance of
/// 1/(α + 3) along each of two axes. The weights of a bilinear lookup are a box of the variance s²/12 beside a tent of
/// s²/6: s²/4 in all.
pub fn lobe_angle<T: Real>(alpha: T) -> T {
    T::from_f64(2.0) / (alpha + T::from_f64(3.0)).sqrt()
}
// ANCHOR_END: lobe_angle

// ANCHOR: mean_light
/// E(n), of the polynomial of a normal of unit length: its coefficients of 1, y, z, x, xy, yz, 3z² − 1, xz and x² − y².
/// Never below 0.
pub fn mean_light<T: Real>(c: &[[T; 3]; 9], n: [T; 3]) -> [T; 3] {
    let [x, y, z] = n;
    let terms = [T::one(), y, z, x, x * y, y * z, T::from_f64(3.0) * z * z - T::one(), x * z, x * x - y * y];
    let sum = c.iter().zip(terms).fold([T::zero(); 3], |sum, (color, term)| add(sum, scale(*color, term)));
    sum.map(|channel| channel.max(T::zero()))
}
// ANCHOR_END: mean_light

// ANCHOR: surroundings
/// The part of the sum that goes with the ambient terms, `kd·s·E`, and the one that goes with highlights, `ks·s·L`.
pub fn surroundings<T: Real>([kd, ks]: [[T; 3]; 2], strength: T, [mean, seen]: [[T; 3]; 2]) -> [[T; 3]; 2] {
    [scale(mul(kd, mean), strength), scale(mul(ks, seen), strength)]
}
// ANCHOR_END: surroundings
