//! The table of what maps.wgsl does to normals: twins of `halfway_lighting::equations` and `halfway_texture::normals`.

use halfway_lighting::equations::vector::{add, cross, dot, length, scale, sub};
use halfway_lighting::equations::{NORMAL_MIN, bumped_normal, lobe_axes, mapped_normal};
use halfway_texture::normals::{lean_lobe, mean_length, slope_covariance, spread_length, toksvig};

use crate::adapter::Kind;
use crate::inputs::wide;
use crate::map_inputs as inputs;
use crate::map_rows::{ULP, row};
use crate::table::Row;

/// n, t, w, the texel, the scale and what counts otherwise.
fn mapped(x: &[f32]) -> [f64; 3] {
    mapped_normal(wide(x), wide(&x[3..]), x[6].into(), wide(&x[7..]), x[10].into(), wide(&x[11..]))
}

/// The texel's numbers are off by a ULP, and each of the three parts of the sum by five roundings; what is left of the
/// sum is brought to length 1.
fn of_mapped(x: &[f32], _: &[f64]) -> Vec<f64> {
    let (n, t, w, s) = (wide::<3>(x), wide::<3>(&x[3..]), f64::from(x[6]), f64::from(x[10]));
    let [x, y, z] = wide::<3>(&x[7..]).map(|c| 2.0 * c - 1.0);
    let parts = [scale(t, x * s), scale(cross(n, t), w * y * s), scale(n, z)];
    let left = length(add(add(parts[0], parts[1]), parts[2]));
    let gross = length(t) * s.abs() + length(n) * length(t) * (w * s).abs() + length(n);
    if length(n) <= f64::from(NORMAL_MIN) || left == 0.0 {
        return vec![0.0; 3];
    }
    vec![6.0 * ULP * gross / left + 5.0 * ULP; 3]
}

/// n, m, both ways, both rises and what counts otherwise.
fn bumped(x: &[f32]) -> [f64; 3] {
    bumped_normal(wide(x), wide(&x[3..]), [wide(&x[6..]), wide(&x[9..])], wide(&x[12..]), wide(&x[14..]))
}

/// n and m over the length of n are off by 5 ULP, and what is cross and dot of them by as many more; the area, relative
/// to itself, by 10 ULP of the product of both ways; so g, and so what is left of the normal, which is brought to
/// length 1.
fn of_bumped(x: &[f32], _: &[f64]) -> Vec<f64> {
    let (n, m, e1, e2) = (wide::<3>(x), wide::<3>(&x[3..]), wide::<3>(&x[6..]), wide::<3>(&x[9..]));
    let rises = wide::<2>(&x[12..]);
    let size = length(n);
    let (unit, up) = (scale(n, 1.0 / size), scale(m, 1.0 / size));
    let area = dot(unit, cross(e1, e2));
    if size <= f64::from(NORMAL_MIN) || area == 0.0 {
        return vec![0.0; 3];
    }
    let g = add(scale(cross(e2, unit), rises[0] / area), scale(cross(unit, e1), rises[1] / area));
    let left = length(sub(scale(unit, 1.0 + dot(g, up)), scale(g, dot(unit, up))));
    if left == 0.0 {
        return vec![0.0; 3];
    }
    let gross = (length(e2) * rises[0].abs() + length(e1) * rises[1].abs()) / area.abs();
    let of_area = 10.0 * ULP * length(e1) * length(e2) / area.abs();
    let of_g = gross * (of_area + 10.0 * ULP);
    let of_sum = 2.0 * length(up) * (of_g + 10.0 * ULP * gross) + 10.0 * ULP;
    vec![of_sum / left + 5.0 * ULP; 3]
}

/// A texel and a factor of slopes.
fn of_mean_length(x: &[f32], e: &[f64]) -> Vec<f64> {
    // The length is off by 6 ULP, by which the quotient changes as its derivative says, twice that near 0; and it is
    // rounded.
    let length = length(wide::<3>(x).map(|c| 2.0 * c - 1.0)).min(1.0);
    let square = f64::from(x[3]).powi(2);
    let divisor = length + square * (1.0 - length);
    vec![12.0 * ULP * square / divisor.powi(2).max(1e-30) + 6.0 * ULP * e[0]]
}

/// Each product is off by half a ULP of itself, and so is their difference; it is not below 0 where it is a variance.
fn of_covariance(x: &[f32], e: &[f64]) -> Vec<f64> {
    let ([a, b], [aa, ab, bb]) = (wide::<2>(x), wide::<3>(&x[2..]));
    let s = f64::from(x[5]).clamp(-1e6, 1e6);
    let gross = [aa.abs() + a * a, ab.abs() + (a * b).abs(), bb.abs() + b * b];
    (0..3).map(|k| ULP * s * s * gross[k] + 2.0 * ULP * e[k].abs()).collect()
}

/// The error of s·Σ + I moves its determinant, by which all is divided.
fn of_lobe(x: &[f32], e: &[f64]) -> Vec<f64> {
    let s = f64::from(x[3]);
    let [xx, xy, yy] = wide::<3>(x).map(|number| (s * number).clamp(-1e12, 1e12));
    let (xx, yy) = (xx + 1.0, yy + 1.0);
    let determinant = (xx * yy - xy * xy).max(xx + yy - 1.0);
    let relative = 8.0 * ULP + 4.0 * ULP * (xx * yy + xy * xy) / determinant;
    e.iter().map(|e| relative * e.abs()).collect()
}

/// The tangent less its part along n is off by some ULP of the tangent, over what is left of it.
fn of_axes(x: &[f32], _: &[f64]) -> Vec<f64> {
    let (n, t, w) = (wide::<3>(x), wide::<3>(&x[3..]), f64::from(x[6]));
    let left = length(sub(t, scale(n, dot(n, t))));
    if left == 0.0 {
        return vec![0.0; 9];
    }
    let of_first = 8.0 * ULP * length(t) / left + 4.0 * ULP;
    let of_second = w.abs() * (of_first + 4.0 * ULP);
    [[of_first; 3], [of_second; 3], [0.0; 3]].concat()
}

fn lean_rows() -> Vec<Row> {
    vec![
        row(
            ("slope_covariance", "slope_covariance(v(i, 0).xy, v(i, 2), s(i, 5))"),
            Kind::Vector,
            inputs::moments(),
            |x| slope_covariance(wide(x), wide(&x[2..]), x[5].into()).to_vec(),
            of_covariance,
        ),
        row(
            ("spread_length", "spread_length(v(i, 0))"),
            Kind::Scalar,
            inputs::covariances(),
            |x| vec![spread_length(wide(x))],
            |_, e| vec![6.0 * ULP * e[0]],
        ),
        row(
            ("lean_lobe", "lean_lobe(v(i, 0), s(i, 3))"),
            Kind::Texel,
            inputs::covariances(),
            |x| lean_lobe(wide(x), x[3].into()).to_vec(),
            of_lobe,
        ),
        row(
            (
                "lobe_axes",
                "Irradiance(lobe_axes(v(i, 0), v(i, 3), s(i, 6))[0], lobe_axes(v(i, 0), v(i, 3), s(i, 6))[1], vec3f())",
            ),
            Kind::Irradiance,
            inputs::axes(),
            |x| {
                let [u, v] = lobe_axes(wide(x), wide(&x[3..]), x[6].into());
                [u, v, [0.0; 3]].concat()
            },
            of_axes,
        ),
    ]
}

pub(crate) fn normal_rows() -> Vec<Row> {
    lean_rows().into_iter().chain(rows_of_normals()).collect()
}

fn rows_of_normals() -> Vec<Row> {
    vec![
        row(
            ("mean_length", "mean_length(v(i, 0), s(i, 3))"),
            Kind::Scalar,
            inputs::texels_with_scales(),
            |x| vec![mean_length(wide(x), x[3].into())],
            of_mean_length,
        ),
        // Two products, a sum and a quotient of numbers that are not negative.
        row(
            ("toksvig", "toksvig(s(i, 0), s(i, 1))"),
            Kind::Pair,
            inputs::lengths_with_exponents(),
            |x| toksvig(x[0].into(), x[1].into()).to_vec(),
            |_, e| e.iter().map(|e| 12.0 * ULP * e).collect(),
        ),
        row(
            ("mapped_normal", "mapped_normal(v(i, 0), v(i, 3), s(i, 6), v(i, 7), s(i, 10), v(i, 11))"),
            Kind::Vector,
            inputs::mapped_normals(),
            |x| mapped(x).to_vec(),
            of_mapped,
        ),
        row(
            ("bumped_normal", "bumped_normal(v(i, 0), v(i, 3), v(i, 6), v(i, 9), v(i, 12).xy, v(i, 14))"),
            Kind::Vector,
            inputs::bumped_normals(),
            |x| bumped(x).to_vec(),
            of_bumped,
        ),
    ]
}
