//! The table of the elliptical mean of `by_shape.wgsl`: its ellipse, its weights, and what it makes of a level.

use halfway_texture::Wrap;

use crate::adapter::Kind;
use crate::images::{EMISSION, HEIGHT, IMAGES, WRAPS, largest};
use crate::inputs::wide;
use crate::map_rows::{ULP, row};
use crate::shape_inputs as inputs;
use crate::shape_rows::{direction, looked_up, lookup_row, moments, of_looked_up, semiaxes};
use crate::table::Row;

/// The moments of an ellipse by its semiaxes' squares and its long axis.
fn of_axes([large, small]: [f64; 2], [u, v]: [f64; 2]) -> [f64; 3] {
    [small + (large - small) * u * u, (large - small) * u * v, small + (large - small) * v * v]
}

/// Both eigenvalues, the larger first.
fn eigenvalues([uu, uv, vv]: [f64; 3]) -> [f64; 2] {
    let radius = (0.5 * (uu - vv)).hypot(uv);
    [0.5 * (uu + vv) + radius, 0.5 * (uu + vv) - radius]
}

fn widened(m: [f64; 3]) -> [f64; 3] {
    of_axes(eigenvalues(m).map(|square| square.max(1.0)), direction(m))
}

/// The ellipse of moments: a, b, c and ac − b².
fn inverse([uu, uv, vv]: [f64; 3]) -> [f64; 4] {
    let determinant = uu * vv - uv * uv;
    [vv / determinant, -uv / determinant, uu / determinant, 1.0 / determinant]
}

/// The moments in texels of the level, widened, of an input with both ways, the short semiaxis and the scale.
fn of_level(x: &[f32]) -> [f64; 3] {
    let ways = wide::<4>(x);
    let short = f64::from(x[4]);
    let [uu, uv, vv] = of_axes([semiaxes(ways)[0].max(short), short].map(|axis| axis * axis), direction(moments(ways)));
    let scale = wide::<2>(&x[5..]);
    // No more than 64 texels along an axis.
    let limited = |square: f64, scale: f64| scale.min(64.0 / square.sqrt());
    let [x, y] = [limited(uu, scale[0]), limited(vv, scale[1])];
    widened([uu * x * x, uv * x * y, vv * y * y])
}

/// The moments are off by some 20 roundings of their trace: those of the direction, of products and of the widening. An
/// inverse is off by itself times that, twice over; a determinant, relative to itself, by that over the smaller
/// eigenvalue.
fn of_ellipse(x: &[f32], expected: &[f64]) -> Vec<f64> {
    let m = of_level(x);
    let off = 20.0 * ULP * (m[0] + m[2]);
    let small = eigenvalues(m)[1];
    let mut allowed = vec![off / (small * small) + 4.0 * ULP / small; 3];
    allowed.push(expected[3] * (2.0 * off / small + 8.0 * ULP));
    allowed
}

fn within(u: f64, side: f64, reach: f64, wrap: Wrap) -> f64 {
    match wrap {
        Wrap::Repeat => u.rem_euclid(1.0) * side,
        Wrap::Mirror => u.rem_euclid(2.0) * side,
        Wrap::Clamp => (u * side).clamp(-reach - 2.0, side + reach + 2.0),
    }
}

fn gaussian(r2: f64) -> f64 {
    std::f64::consts::E * ((-2.0 * r2).exp() - (-2.0f64).exp())
}

/// The ellipse of an input of `in_ellipse`, as the call has it.
fn ellipse(x: &[f32]) -> [f64; 4] {
    inverse(moments(wide(&x[5..])))
}

/// The mean of all texels of a level, weighted where they are in the ellipse, and the sum of the weights over their
/// number.
fn mean(slot: usize, x: &[f32], uv: [f64; 2], [a, b, c, determinant]: [f64; 4]) -> ([f64; 4], f64) {
    let number = x[4] as usize;
    let level = IMAGES[slot].levels()[number];
    let sides = [level.width, level.height].map(i64::from);
    let wraps = [x[0], x[1]].map(|wrap| WRAPS[wrap as usize]);
    let index = |at: i64, axis: usize| {
        let side = sides[axis];
        match wraps[axis] {
            Wrap::Repeat => at.rem_euclid(side),
            Wrap::Mirror => at.rem_euclid(2 * side).min(2 * side - 1 - at.rem_euclid(2 * side)),
            Wrap::Clamp => at.clamp(0, side - 1),
        }
    };
    let reach = [c, a].map(|of| (of / determinant).sqrt());
    let middle = [0, 1].map(|k| within(uv[k], sides[k] as f64, reach[k], wraps[k]));
    let around = |axis: usize| {
        let first = middle[axis].floor() as i64;
        first - 45..=first + 45
    };
    let (mut sum, mut weights, mut count) = ([0.0; 4], 0.0, 0.0);
    for (row, column) in around(1).flat_map(|row| around(0).map(move |column| (row, column))) {
        let (x, y) = (column as f64 + 0.5 - middle[0], row as f64 + 0.5 - middle[1]);
        let r2 = a * x * x + 2.0 * b * x * y + c * y * y;
        if r2 >= 1.0 {
            continue;
        }
        let texel = IMAGES[slot].level(number)[(index(row, 1) * sides[0] + index(column, 0)) as usize];
        (0..4).for_each(|k| sum[k] += gaussian(r2) * f64::from(texel[k]));
        weights += gaussian(r2);
        count += 1.0;
    }
    (sum.map(|sum| sum / weights), weights / count)
}

/// The series is off by 3.1·10⁻⁶ of each weight, of which the mean is known, and so are sums by some roundings; the
/// place is known to 3 ULP of the side and 4.5 of itself, and the ellipse, of ways with that many roundings, to 20 ULP
/// of its ways.
fn of_mean(slot: usize, x: &[f32]) -> Vec<f64> {
    let uv = wide::<2>(&x[2..]);
    let (here, weight) = mean(slot, x, uv, ellipse(x));
    let far = |there: [f64; 4]| (0..4).map(|k| (there[k] - here[k]).abs()).fold(0.0, f64::max);
    let mut sum = 0.0;
    for axis in 0..2 {
        let mut there = uv;
        there[axis] += 9.0 * ULP + 4.5 * ULP * uv[axis].abs();
        sum += far(mean(slot, x, there, ellipse(x)).0);
    }
    for way in 5..9 {
        let mut there = x[5..9].iter().map(|&number| f64::from(number)).collect::<Vec<_>>();
        there[way - 5] *= 1.0 + 20.0 * ULP;
        sum += far(mean(slot, x, uv, inverse(moments([there[0], there[1], there[2], there[3]]))).0);
    }
    vec![2.0 * sum + largest(slot) * (2.0 * (3.1e-6 + 20.0 * ULP) / weight + 100.0 * ULP); 4]
}

macro_rules! in_ellipse_row {
    ($slot:ident, $image:literal) => {
        row(
            (
                "in_ellipse",
                concat!(
                    "in_ellipse(",
                    $image,
                    ", vec2u(vec2f(s(i, 0), s(i, 1))), v(i, 2).xy, u32(s(i, 4)), ellipse_of(footprint_shape(v(i, 5).xy, \
                     v(i, 7).xy), footprint_shape(v(i, 5).xy, v(i, 7).xy).short, vec2f(1.0)))"
                ),
            ),
            Kind::Texel,
            inputs::in_ellipses($slot),
            |x| mean($slot, x, wide(&x[2..]), ellipse(x)).0.to_vec(),
            |x, _| of_mean($slot, x),
        )
    };
}

pub(crate) fn ellipse_rows() -> Vec<Row> {
    vec![
        // The roundings of the eigenvalues, relative to the larger.
        row(
            ("widened", "widened(v(i, 0))"),
            Kind::Vector,
            inputs::to_widen(),
            |x| widened(wide(x)).to_vec(),
            |x, e| vec![8.0 * ULP * (f64::from(x[0]) + f64::from(x[2]) + 1.0); e.len()],
        ),
        row(
            ("ellipse_of", "ellipse_of(footprint_shape(v(i, 0).xy, v(i, 2).xy), s(i, 4), v(i, 5).xy)"),
            Kind::Texel,
            inputs::ellipses(),
            |x| inverse(of_level(x)).to_vec(),
            of_ellipse,
        ),
        // The series' error, and the sums' of numbers up to e.
        row(
            ("gaussian", "gaussian(s(i, 0))"),
            Kind::Scalar,
            inputs::distances(),
            |x| vec![gaussian(x[0].into())],
            |_, _| vec![3.1e-6 + 12.0 * ULP],
        ),
        row(
            ("within", "within(s(i, 0), s(i, 1), s(i, 2), u32(s(i, 3)))"),
            Kind::Scalar,
            inputs::reaches(),
            |x| vec![within(x[0].into(), x[1].into(), x[2].into(), WRAPS[x[3] as usize])],
            |x, _| vec![2.0 * ULP * (2.0 * f64::from(x[1]) + f64::from(x[2]) + 2.0)],
        ),
        in_ellipse_row!(HEIGHT, "height_image, 7u"),
        in_ellipse_row!(EMISSION, "emission_image, 2u"),
        lookup_row!("elliptical", HEIGHT, "height_image, 7u", &[7], 1.001),
        lookup_row!("elliptical", EMISSION, "emission_image, 2u", &[7], 1.001),
    ]
}
