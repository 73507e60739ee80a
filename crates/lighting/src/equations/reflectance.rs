//! Reflection at a surface: the diffuse and the two specular terms.

use super::scene::Coefficients;
use super::vector::{add, dot, neg, normalize, scale, sub};
use super::{NORMAL_MIN, Real};
use crate::{Reflectance, matched_shininess};

/// l and v are taken as opposite, and the halfway vector as undefined, where ‖l + v‖ is at most this. In `f32` the sum
/// of two unit vectors is known to about 10⁻⁷, so a shorter one has no direction.
pub const HALFWAY_MIN: f32 = 1e-6;

// ANCHOR: power
/// `max(x, 0)^e` for a cosine x and an exponent e ≥ 0, with 0⁰ = 1 as in OpenGL.
///
/// x is clamped to [0, 1]: a rounded cosine of 1.0000001 would otherwise grow past any bound with e. An error of x is
/// multiplied by e: in `f32`, where a cosine near 1 is known to about 2·10⁻⁷, a highlight of exponent 10⁴ is right to
/// 0.5 % of its peak.
pub fn power<T: Real>(x: T, e: T) -> T {
    let x = x.max(T::zero()).min(T::one());
    if e == T::zero() {
        T::one()
    } else if x == T::zero() {
        T::zero()
    } else {
        x.pow(e)
    }
}
// ANCHOR_END: power

// ANCHOR: reflect
/// `r = 2(n·l)n − l`: the direction of l mirrored about n. n and l have unit length.
pub fn reflect<T: Real>(l: [T; 3], n: [T; 3]) -> [T; 3] {
    let nl = dot(n, l);
    sub(scale(n, nl + nl), l)
}
// ANCHOR_END: reflect

// ANCHOR: half_vector
/// `h = (l + v)/‖l + v‖`, or `None` where l and v are opposite (‖l + v‖ at most [`HALFWAY_MIN`]).
pub fn half_vector<T: Real>(l: [T; 3], v: [T; 3]) -> Option<[T; 3]> {
    normalize_above(add(l, v), HALFWAY_MIN)
}
// ANCHOR_END: half_vector

/// `max(n·l, 0)`: Lambert's cosine.
pub fn diffuse_term<T: Real>(n: [T; 3], l: [T; 3]) -> T {
    dot(n, l).max(T::zero())
}

// ANCHOR: specular_phong
/// Phong 1975: `max(r·v, 0)^α`, and 0 unless n·l > 0.
pub fn specular_phong<T: Real>(n: [T; 3], l: [T; 3], v: [T; 3], alpha: T) -> T {
    if dot(n, l) > T::zero() { power(dot(reflect(l, n), v), alpha) } else { T::zero() }
}
// ANCHOR_END: specular_phong

// ANCHOR: specular_blinn_phong
/// Blinn 1977: `max(n·h, 0)^β`, and 0 unless n·l > 0. Where l = −v there is no halfway vector and the term is 0.
pub fn specular_blinn_phong<T: Real>(n: [T; 3], l: [T; 3], v: [T; 3], beta: T) -> T {
    if dot(n, l) > T::zero() { half_vector(l, v).map_or(T::zero(), |h| power(dot(n, h), beta)) } else { T::zero() }
}
// ANCHOR_END: specular_blinn_phong

/// The exponent that the specular term of `reflectance` takes for a material's shininess.
pub fn specular_exponent<T: Real>(reflectance: Reflectance, shininess: T) -> T {
    match reflectance {
        Reflectance::Phong | Reflectance::BlinnPhong => shininess,
        Reflectance::BlinnPhongMatched => matched_shininess(shininess),
    }
}

/// The specular term S of `reflectance` for a material.
pub fn specular_term<T: Real>(
    reflectance: Reflectance,
    n: [T; 3],
    l: [T; 3],
    v: [T; 3],
    material: &Coefficients<T>,
) -> T {
    let exponent = specular_exponent(reflectance, material.shininess);
    match reflectance {
        Reflectance::Phong => specular_phong(n, l, v, exponent),
        Reflectance::BlinnPhong | Reflectance::BlinnPhongMatched => specular_blinn_phong(n, l, v, exponent),
    }
}

/// The exponent of a highlight that is not round, toward the halfway direction h = l + v, of any length: that of
/// Ashikhmin and Shirley, "An Anisotropic Phong BRDF Model", 2000, with axes that need not be those of the highlight:
/// (Σ mᵢⱼ·aᵢ·aⱼ)/(a₁² + a₂²), where a are h's lengths along `axes`, which are perpendicular to n, and m is `widths`,
/// the inverse of how wide it is (m₁₁, m₁₂, m₂₂). Where h has no length along them (squares of at most 10⁻³⁰) it is
/// `otherwise`; below 0 it never is.
pub fn axial_exponent<T: Real>(axes: [[T; 3]; 2], widths: [T; 3], h: [T; 3], otherwise: T) -> T {
    let [a, b] = axes.map(|axis| dot(h, axis));
    let squared = a * a + b * b;
    if squared <= T::from_f64(1e-30) {
        return otherwise;
    }
    let [aa, ab, bb] = widths;
    ((aa * a * a + (ab + ab) * a * b + bb * b * b) / squared).max(T::zero())
}

// ANCHOR: interpolated_normal
/// An interpolated normal brought back to unit length, or the geometric normal where nothing is left of it (length at
/// most [`NORMAL_MIN`]), as between vertices with opposite normals.
pub fn interpolated_normal<T: Real>(n: [T; 3], geometric: [T; 3]) -> [T; 3] {
    normalize_above(n, NORMAL_MIN).unwrap_or(geometric)
}
// ANCHOR_END: interpolated_normal

/// n turned to the side from which `reference` is seen: n where `reference`·v ≥ 0, else −n.
///
/// With the geometric normal as the reference it turns a shading normal for a back face; with n itself it turns n
/// toward the viewer.
pub fn face_forward<T: Real>(n: [T; 3], reference: [T; 3], v: [T; 3]) -> [T; 3] {
    if dot(reference, v) < T::zero() { neg(n) } else { n }
}

/// The normal of the side that is seen: n on a front face, −n on a back face.
pub fn side_normal<T: Real>(n: [T; 3], front_facing: bool) -> [T; 3] {
    if front_facing { n } else { neg(n) }
}

fn normalize_above<T: Real>(a: [T; 3], shortest: f32) -> Option<[T; 3]> {
    if super::vector::length(a) > T::from_f64(f64::from(shortest)) { normalize(a) } else { None }
}
