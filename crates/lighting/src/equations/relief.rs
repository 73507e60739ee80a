//! Normals that images turn.

use super::vector::{add, cross, dot, length, normalize, normalize_or_zero, scale, sub};
use super::{NORMAL_MIN, Real};

// ANCHOR: mapped_normal
/// The unit normal that a texel of a normal map names: x·t + y·w·(n × t) + z·n for (x, y, z) = (2c − 1)·(s, s, 1).
///
/// n and t are the interpolated normal and tangent, neither brought to unit length, as `MikkTSpace` (Mikkelsen 2008)
/// has it and those programs that make such maps; w is 1, or −1 where the image is mirrored or the transform mirrors; s
/// is glTF's `normalTexture.scale` (2.0 §3.9.3). Where n vanishes (length at most [`NORMAL_MIN`]) or nothing is left of
/// the sum it is `otherwise`.
pub fn mapped_normal<T: Real>(n: [T; 3], t: [T; 3], w: T, texel: [T; 3], s: T, otherwise: [T; 3]) -> [T; 3] {
    let [x, y, z] = texel.map(|c| c + c - T::one());
    let b = scale(cross(n, t), w);
    let sum = add(add(scale(t, x * s), scale(b, y * s)), scale(n, z));
    if length(n) > T::from_f64(NORMAL_MIN.into()) { normalize(sum).unwrap_or(otherwise) } else { otherwise }
}
// ANCHOR_END: mapped_normal

/// The ways along which the normals of an image lie apart: perpendicular to n, a unit normal of the image. The first is
/// t as far as it is so, at unit length, or 0 where nothing is left of it; the second w·(n × that). t and w are as in
/// [`mapped_normal`].
pub fn lobe_axes<T: Real>(n: [T; 3], t: [T; 3], w: T) -> [[T; 3]; 2] {
    let along = normalize_or_zero(sub(t, scale(n, dot(n, t))));
    [along, scale(cross(n, along), w)]
}

// ANCHOR: bumped_normal
/// The unit normal of a surface that is raised along its normals, by its slope alone (Blinn 1978, "Simulation of
/// wrinkled surfaces").
///
/// `along` are two ways on the surface, and `rises` by how much the height differs at their ends. g, the gradient of
/// the height on the surface, follows from them (Mikkelsen 2010, "Bump mapping unparametrized surfaces on the GPU"):
/// g = (δ₁·(e₂ × n) + δ₂·(n × e₁))/(n·(e₁ × e₂)). Heights are lengths of the mesh as it was modelled; m is what its
/// transform makes of a unit length along the normal. The normal of what is raised and then transformed is
/// n·(1 + g·m) − (n·m)·g, up to its length: n − h·g where the transform scales all alike, by h.
///
/// n and m are interpolated, neither brought to unit length. Where n vanishes (length at most [`NORMAL_MIN`]), the two
/// ways are one, or nothing is left of the normal, it is `otherwise`.
pub fn bumped_normal<T: Real>(n: [T; 3], m: [T; 3], along: [[T; 3]; 2], rises: [T; 2], otherwise: [T; 3]) -> [T; 3] {
    let size = length(n);
    if size <= T::from_f64(NORMAL_MIN.into()) {
        return otherwise;
    }
    let (n, m) = (scale(n, T::one() / size), scale(m, T::one() / size));
    let area = dot(n, cross(along[0], along[1]));
    if area == T::zero() {
        return otherwise;
    }
    let g = add(scale(cross(along[1], n), rises[0] / area), scale(cross(n, along[0]), rises[1] / area));
    let raised = sub(scale(n, T::one() + dot(g, m)), scale(g, dot(n, m)));
    normalize(raised).unwrap_or(otherwise)
}
// ANCHOR_END: bumped_normal

#[cfg(test)]
mod tests {
    use super::super::{normal_matrix, transform_normal};
    use super::*;

    fn apply(m: [[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
        add(add(scale(m[0], v[0]), scale(m[1], v[1])), scale(m[2], v[2]))
    }

    fn close(a: [f64; 3], b: [f64; 3]) {
        assert!(length(sub(a, b)) < 1e-12, "{a:?} and {b:?}");
    }

    /// Columns of matrices that turn, stretch, shear and mirror.
    const MATRICES: [[[f64; 3]; 3]; 4] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[2.0, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 3.0]],
        [[0.6, 0.8, 0.1], [-0.8, 0.9, 0.0], [0.3, 0.7, 1.5]],
        [[-1.0, 0.2, 0.0], [0.4, 1.0, 0.3], [0.0, -0.5, 2.0]],
    ];

    #[test]
    fn a_raised_plane_has_the_normal_of_what_it_is_raised_to() {
        // The plane z = 0, raised to z = 0.7·x − 0.4·y.
        for m in MATRICES {
            let n = transform_normal(normal_matrix(m), [0.0, 0.0, 1.0]).expect("a normal");
            let along = [[1.0, 0.2, 0.0], [-0.3, 0.8, 0.0]];
            let rises = along.map(|[x, y, _]| 0.7 * x - 0.4 * y);
            let bumped = bumped_normal(n, apply(m, [0.0, 0.0, 1.0]), along.map(|e| apply(m, e)), rises, n);
            close(bumped, transform_normal(normal_matrix(m), [-0.7, 0.4, 1.0]).expect("a normal"));
            // The back has the opposite one.
            let n = n.map(|x| -x);
            let back = bumped_normal(n, apply(m, [0.0, 0.0, 1.0]), along.map(|e| apply(m, e)), rises, n);
            close(back, bumped.map(|x| -x));
        }
    }

    #[test]
    fn a_texel_names_a_normal_between_tangent_and_normal() {
        let (n, t): ([f64; 3], _) = ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
        let of = |texel, w, s| mapped_normal(n, t, w, texel, s, n);
        close(of([0.5, 0.5, 1.0], 1.0, 1.0), n);
        close(of([1.0, 0.5, 0.5], 1.0, 1.0), t);
        close(of([0.5, 1.0, 0.5], 1.0, 1.0), [0.0, 1.0, 0.0]);
        close(of([0.5, 1.0, 0.5], -1.0, 1.0), [0.0, -1.0, 0.0]);
        close(of([1.0, 0.5, 1.0], 1.0, 0.0), n);
        close(of([0.5, 0.5, 0.5], 1.0, 1.0), n);
        close(mapped_normal([0.0; 3], t, 1.0, [1.0, 0.5, 1.0], 1.0, n), n);
    }

    #[test]
    fn axes_lie_beside_the_normal() {
        let n = normalize([0.3_f64, -0.2, 1.0]).expect("a normal");
        let [u, v] = lobe_axes(n, [0.9, 0.1, 0.4], 1.0);
        assert!(dot(u, n).abs() < 1e-12 && dot(v, n).abs() < 1e-12 && dot(u, v).abs() < 1e-12);
        assert!((length(u) - 1.0).abs() < 1e-12 && (length(v) - 1.0).abs() < 1e-12 && u[0] > 0.9);
        close(cross(u, v), n);
        let [same, mirrored] = lobe_axes(n, [0.9, 0.1, 0.4], -1.0);
        close(same, u);
        close(mirrored, v.map(|x| -x));
        assert_eq!(lobe_axes(n, [0.0; 3], 1.0), [[0.0; 3]; 2]);
    }

    #[test]
    fn a_flat_height_keeps_its_normal() {
        let n = [0.0, 0.6, 0.8];
        let along = [[1.0, 0.0, 0.0], [0.0, 0.8, -0.6]];
        close(bumped_normal(n, n, along, [0.0; 2], n), n);
        close(bumped_normal(n, n, [along[0]; 2], [1.0; 2], n), n);
        close(bumped_normal([0.0; 3], n, along, [1.0; 2], n), n);
    }
}
