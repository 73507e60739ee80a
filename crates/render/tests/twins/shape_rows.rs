//! The table of what `by_shape.wgsl` looks up: footprints, probes, ripmaps and summed areas, and all of them together.
//! Twins are `halfway_texture::lookup` or, of what it keeps to itself, the definition written out in another way.

#![allow(clippy::float_cmp, reason = "numbers of periods are whole")]

use halfway_texture::{UvTransform, Wrap, lookup};

use crate::adapter::Kind;
use crate::images::{HEIGHT, IMAGES, Look, NORMAL, OCCLUSION, OPACITY, SHININESS, WRAPS, largest, rows_of};
use crate::inputs::wide;
use crate::map_rows::{OF_SUM, ULP, exact, of_set, row};
use crate::shape_inputs as inputs;
use crate::table::Row;

/// σ₁ and σ₂ of the matrix (a b): half the sum and half the difference of the lengths of its conformal and
/// anticonformal part.
pub(crate) fn semiaxes([ax, ay, bx, by]: [f64; 4]) -> [f64; 2] {
    let (turns, mirrors) = ((ax + by).hypot(ay - bx), (ax - by).hypot(ay + bx));
    [0.5 * (turns + mirrors), 0.5 * (turns - mirrors).abs()]
}

/// uu, uv and vv.
pub(crate) fn moments([ax, ay, bx, by]: [f64; 4]) -> [f64; 3] {
    [ax * ax + bx * bx, ax * ay + bx * by, ay * ay + by * by]
}

/// The direction of the long axis, by its angle.
pub(crate) fn direction([uu, uv, vv]: [f64; 3]) -> [f64; 2] {
    let (sine, cosine) = (0.5 * (2.0 * uv).atan2(uu - vv)).sin_cos();
    // Of the two ways the one that begins with a positive number; along v, where the axis is rather v's.
    if uu < vv && sine < 0.0 { [-cosine, -sine] } else { [cosine, sine] }
}

fn footprint(x: &[f32]) -> Vec<f64> {
    let m = moments(wide(x));
    if m[0] + m[2] > 1e18 {
        return vec![1e18, 0.0, 1e18, 1e9, 1e9];
    }
    let [long, short] = semiaxes(wide(x));
    vec![m[0], m[1], m[2], long, short]
}

/// Three roundings of each sum; of roots half as much, and two more; the area loses what its products are larger than
/// it.
fn of_footprint(x: &[f32], expected: &[f64]) -> Vec<f64> {
    let [ax, ay, bx, by] = wide::<4>(x);
    let gross = (ax * ay).abs() + (bx * by).abs();
    let of_area = 2.0 * ULP * ((ax * by).abs() + (ay * bx).abs()) / expected[3].max(1e-30);
    let relative = |k: usize, ulps: f64| ulps * ULP * expected[k] + 1e-18;
    vec![relative(0, 3.0), 3.0 * ULP * gross + 1e-18, relative(2, 3.0), relative(3, 8.0), of_area + relative(4, 12.0)]
}

/// How far a filter by shape may be off whose place is known to 3 ULP of the side and to 4.5 ULP of the place, and each
/// number of whose footprint to 8 ULP and to `off`: by as much as it changes from there to there, twice, and by the
/// sum's roundings.
fn of_lookup(
    slot: usize,
    look: Look,
    (uv, blur): ([f64; 2], [f64; 2]),
    (footprint, off): ([[f64; 2]; 2], [[f64; 2]; 2]),
) -> f64 {
    let sampling = look.sampling();
    let at = |uv: [f64; 2], footprint: [[f64; 2]; 2]| lookup::filtered(&IMAGES[slot], &sampling, uv, footprint);
    let here = at(uv, footprint);
    let far = |there: [f64; 4]| (0..4).map(|k| (there[k] - here[k]).abs()).fold(0.0, f64::max);
    let mut sum = 0.0;
    for axis in 0..2 {
        let mut most = 0.0;
        for sign in [-1.0, 1.0] {
            let mut there = uv;
            // 3 ULP of the side and 2 texels more, as in other rows, are 9 ULP of the image.
            there[axis] += sign * (9.0 * ULP + 4.5 * ULP * uv[axis].abs() + blur[axis]);
            most = f64::max(most, far(at(there, footprint)));
        }
        sum += most;
        for way in 0..2 {
            let mut most = 0.0;
            for sign in [-1.0, 1.0] {
                let mut there = footprint;
                there[way][axis] += sign * (8.0 * ULP * there[way][axis].abs() + off[way][axis]);
                most = f64::max(most, far(at(uv, there)));
            }
            sum += most;
        }
    }
    // Weights of up to a hundred texels are summed.
    2.0 * sum + 4.0 * OF_SUM * largest(slot)
}

/// A look, a place, and both ways in texels.
fn parts(slot: usize, x: &[f32]) -> (Look, [f64; 2], [[f64; 2]; 2]) {
    let size = IMAGES[slot].size().map(f64::from);
    let way = |at: usize| std::array::from_fn(|k| f64::from(x[at + k]) / size[k]);
    (Look::from_bits(x[0]), wide(&x[1..]), [way(3), way(5)])
}

pub(crate) fn looked_up<const SLOT: usize>(x: &[f32]) -> Vec<f64> {
    let (look, uv, footprint) = parts(SLOT, x);
    lookup::filtered(&IMAGES[SLOT], &look.sampling(), uv, footprint).to_vec()
}

pub(crate) fn of_looked_up<const SLOT: usize>(x: &[f32], _: &[f64]) -> Vec<f64> {
    let (look, uv, footprint) = parts(SLOT, x);
    vec![of_lookup(SLOT, look, (uv, [0.0; 2]), (footprint, [[0.0; 2]; 2])); 4]
}

macro_rules! lookup_row {
    ($function:literal, $slot:ident, $image:literal, $shapes:expr, $least:expr) => {
        row(
            (
                $function,
                concat!($function, "(", $image, ", u32(s(i, 0)), v(i, 1).xy, footprint_shape(v(i, 3).xy, v(i, 5).xy))"),
            ),
            Kind::Texel,
            inputs::lookups($shapes, $least),
            looked_up::<$slot>,
            of_looked_up::<$slot>,
        )
    };
}
pub(crate) use lookup_row;

// ---- ripmaps --------------------------------------------------------------------------------------

fn ripmap_level<const SLOT: usize>(x: &[f32]) -> Vec<f64> {
    let (level, _) = IMAGES[SLOT].ripmap().level([x[0] as usize, x[1] as usize]);
    vec![level.start as f64, level.width.into(), level.height.into(), 0.0]
}

// ---- summed areas ---------------------------------------------------------------------------------

/// A part of the interval of this length around `middle`, in texels of an image of this side.
fn part_of(middle: f64, length: f64, side: f64, wrap: Wrap, number: usize) -> [f64; 3] {
    let at = match wrap {
        Wrap::Repeat => middle.rem_euclid(1.0) * side,
        Wrap::Mirror => middle.rem_euclid(2.0) * side,
        Wrap::Clamp => (middle * side).clamp(-length, side + length),
    };
    let (low, high) = (at - 0.5 * length, at + 0.5 * length);
    if wrap == Wrap::Clamp {
        let before = (high.min(0.0) - low).max(0.0);
        let behind = (high - low.max(side)).max(0.0);
        let inside = [low.clamp(0.0, side), high.clamp(0.0, side), 1.0];
        return [inside, [0.0, 1.0, before], [side - 1.0, side, behind]][number];
    }
    let [first, last] = [low, high].map(|at| at.div_euclid(side));
    let mirrored = |[from, to, count]: [f64; 3], period: f64| {
        let turned = wrap == Wrap::Mirror && period.rem_euclid(2.0) == 1.0;
        if turned { [side - to, side - from, count] } else { [from, to, count] }
    };
    match number {
        0 if first == last => mirrored([low - first * side, high - first * side, 1.0], first),
        0 => mirrored([low - first * side, side, 1.0], first),
        _ if first == last => [0.0; 3],
        1 => mirrored([0.0, high - last * side, 1.0], last),
        _ => [0.0, side, last - first - 1.0],
    }
}

/// The sums of a row at three columns less that at the first, weighted, in units of the largest.
fn strip(slot: usize, columns: [usize; 4], row: usize, weights: [f64; 3]) -> [f64; 4] {
    let sums = IMAGES[slot].summed_areas();
    let width = IMAGES[slot].size()[0] as usize + 1;
    let at = |column: usize| sums.sums()[row * width + column];
    std::array::from_fn(|k| {
        let sum: f64 = (0..3).map(|n| weights[n] * (at(columns[n + 1])[k] - at(columns[0])[k])).sum();
        sum / unit(slot)[k]
    })
}

fn unit(slot: usize) -> [f64; 4] {
    IMAGES[slot].summed_areas().largest().map(|largest| f64::from(largest as f32))
}

fn columns(x: &[f32]) -> [usize; 4] {
    std::array::from_fn(|k| x[k] as usize)
}

/// First halves are whole numbers of 2⁻²², whose differences are exact, and so are they times −1, 0 and 1; the second
/// halves are off by 2⁻⁴⁸, and their differences and sums by as many more. So what is lost is what rounding the result
/// loses.
fn of_strip(_: &[f32], expected: &[f64]) -> Vec<f64> {
    expected.iter().map(|number| ULP * number.abs() + 0.5f64.powi(42)).collect()
}

/// The sum of a rectangle by how much of each texel lies in it, less the mean's.
fn rectangle(slot: usize, x: &[f32]) -> Vec<f64> {
    let [left, right, top, bottom] = wide::<4>(x);
    let [width, height] = IMAGES[slot].size().map(|side| side as usize);
    let overlap = |at: usize, from: f64, to: f64| (to.min(at as f64 + 1.0) - from.max(at as f64)).max(0.0);
    let mean = IMAGES[slot].summed_areas().mean();
    let mut sum = [0.0; 4];
    for (y, column) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let area = overlap(column, left, right) * overlap(y, top, bottom);
        let texel = IMAGES[slot].level(0)[y * width + column];
        (0..4).for_each(|k| sum[k] += area * (f64::from(texel[k]) - mean[k]) / unit(slot)[k]);
    }
    sum.to_vec()
}

// ---- at a fragment --------------------------------------------------------------------------------

/// Two ways.
type WayPair = [[f64; 2]; 2];

/// The place of a fragment on the image of heights, and its ways, each with the largest that its sums could be.
fn placed(x: &[f32]) -> (Look, [[f64; 2]; 2], [WayPair; 2]) {
    let look = Look::from_bits(x[1]);
    let rows = rows_of(HEIGHT);
    let gross = rows.map(|row| row.map(f64::abs));
    let uv = of_set(look, x, 2);
    let place = [UvTransform::apply(&rows, uv), UvTransform::apply(&gross, uv.map(f64::abs))];
    let linear = |rows: [[f64; 3]; 2]| rows.map(|[a, b, _]| [a, b, 0.0]);
    let way = |at: usize| {
        let way = of_set(look, x, at);
        [UvTransform::apply(&linear(rows), way), UvTransform::apply(&linear(gross), way.map(f64::abs))]
    };
    let [a, b] = [way(6), way(10)];
    (look, place, [[a[0], b[0]], [a[1], b[1]]])
}

fn at_footprint(x: &[f32]) -> Vec<f64> {
    let (look, [place, _], [ways, _]) = placed(x);
    lookup::filtered(&IMAGES[HEIGHT], &look.sampling(), place, ways).to_vec()
}

/// Places and ways are off by three roundings of their sums; where they are by level, levels by 8 ULP besides.
fn of_at_footprint(x: &[f32], _: &[f64]) -> Vec<f64> {
    let (look, [place, gross], [ways, gross_ways]) = placed(x);
    let blur = gross.map(|gross| 3.0 * ULP * gross);
    let off = gross_ways.map(|way| way.map(|gross| 3.0 * ULP * gross));
    let of_level = if look.shape() == 0 { 16.0 * ULP * largest(HEIGHT) } else { 0.0 };
    vec![of_lookup(HEIGHT, look, (place, blur), (ways, off)) + of_level; 4]
}

fn footprint_rows() -> Vec<Row> {
    vec![
        row(
            ("shape_of", "f32(shape_of(u32(s(i, 0))))"),
            Kind::Scalar,
            inputs::looks(),
            |x| vec![Look::from_bits(x[0]).shape() as f64],
            exact,
        ),
        row(
            (
                "footprint_shape",
                "vec4f(footprint_shape(v(i, 0).xy, v(i, 2).xy).moments, footprint_shape(v(i, 0).xy, v(i, 2).xy).long)",
            ),
            Kind::Texel,
            inputs::footprints(),
            |x| footprint(x)[..4].to_vec(),
            |x, e| of_footprint(x, &[e, &[0.0]].concat())[..4].to_vec(),
        ),
        row(
            ("footprint_shape", "footprint_shape(v(i, 0).xy, v(i, 2).xy).short"),
            Kind::Scalar,
            inputs::footprints(),
            |x| footprint(x)[4..].to_vec(),
            |x, _| of_footprint(x, &footprint(x))[4..].to_vec(),
        ),
        // Half the difference of the moments is off by a rounding of the larger, relative to the radius; an angle by
        // half of it.
        row(
            ("long_direction", "long_direction(v(i, 0))"),
            Kind::Pair,
            inputs::moments_of_footprints(),
            |x| direction(wide(x)).to_vec(),
            |x, e| {
                let [uu, uv, vv] = wide::<3>(x);
                let radius = (0.5 * (uu - vv)).hypot(uv);
                let off = if radius > 0.0 { 2.0 * ULP * (uu + vv) / radius + 8.0 * ULP } else { 0.0 };
                vec![off; e.len()]
            },
        ),
        row(
            ("reduced", "f32(reduced(u32(s(i, 0))))"),
            Kind::Scalar,
            inputs::looks(),
            |x| vec![Look::from_bits(x[0]).reduced().bits().into()],
            exact,
        ),
    ]
}

fn probe_and_ripmap_rows() -> Vec<Row> {
    vec![
        lookup_row!("probes", HEIGHT, "height_image, 7u", &[3, 4, 5, 6], 1.001),
        row(
            ("ripmap_level", "vec4f(ripmap_level(3u, vec2u(vec2f(s(i, 0), s(i, 1)))))"),
            Kind::Texel,
            inputs::ripmap_levels(OPACITY),
            ripmap_level::<OPACITY>,
            exact,
        ),
        row(
            ("ripmap_level", "vec4f(ripmap_level(5u, vec2u(vec2f(s(i, 0), s(i, 1)))))"),
            Kind::Texel,
            inputs::ripmap_levels(OCCLUSION),
            ripmap_level::<OCCLUSION>,
            exact,
        ),
        lookup_row!("in_ripmap", OPACITY, "opacity_image, 3u", &[1], 1.001),
        lookup_row!("in_ripmap", OCCLUSION, "occlusion_image, 5u", &[1], 1.001),
    ]
}

fn sum_rows() -> Vec<Row> {
    vec![
        // All numbers are multiples of 2⁻⁸ up to some hundreds, and sides powers of two.
        row(
            ("part_of", "part_of(s(i, 0), s(i, 1), s(i, 2), u32(s(i, 3)), u32(s(i, 4)))"),
            Kind::Vector,
            inputs::intervals(),
            |x| {
                let [middle, length, side] = wide::<3>(x);
                part_of(middle, length, side, WRAPS[x[3] as usize], x[4] as usize).to_vec()
            },
            exact,
        ),
        row(
            (
                "strip",
                "strip(shininess_image, 4u, vec4i(vec4f(v(i, 0), s(i, 3))), i32(s(i, 4))).high * v(i, 6) + \
                 strip(shininess_image, 4u, vec4i(vec4f(v(i, 0), s(i, 3))), i32(s(i, 4))).low * v(i, 6)",
            ),
            Kind::Texel,
            inputs::strips(SHININESS),
            |x| strip(SHININESS, columns(x), x[4] as usize, wide(&x[6..])).to_vec(),
            of_strip,
        ),
        row(
            (
                "between_rows",
                "between_rows(strip(shininess_image, 4u, vec4i(vec4f(v(i, 0), s(i, 3))), i32(s(i, 4))), \
                 strip(shininess_image, 4u, vec4i(vec4f(v(i, 0), s(i, 3))), i32(s(i, 5))), v(i, 6))",
            ),
            Kind::Texel,
            inputs::strips(SHININESS),
            |x| {
                let [a, b] = [4, 5].map(|k| strip(SHININESS, columns(x), x[k] as usize, wide(&x[6..])));
                (0..4).map(|k| b[k] - a[k]).collect()
            },
            of_strip,
        ),
        // Three strips of three numbers up to 4, with weights up to 1.
        row(
            ("rectangle", "rectangle(shininess_image, 4u, v(i, 0).xy, v(i, 2).xy)"),
            Kind::Texel,
            inputs::rectangles(SHININESS),
            |x| rectangle(SHININESS, x),
            |_, e| vec![60.0 * ULP; e.len()],
        ),
        lookup_row!("summed", SHININESS, "shininess_image, 4u", &[2], 1.001),
        lookup_row!("summed", NORMAL, "normal_image, 6u", &[2], 1.001),
    ]
}

fn fragment_rows() -> Vec<Row> {
    vec![
        lookup_row!("at_shape", HEIGHT, "height_image, 7u", &[3, 4, 5, 6, 7], 0.05),
        lookup_row!("at_shape", OPACITY, "opacity_image, 3u", &[1], 0.05),
        lookup_row!("at_shape", SHININESS, "shininess_image, 4u", &[2], 0.05),
        row(
            (
                "at_footprint",
                "at_footprint(height_image, 7u, u32(s(i, 1)), Coordinates(vec4f(v(i, 2), s(i, 5)), \
                 vec4f(v(i, 6), s(i, 9)), vec4f(v(i, 10), s(i, 13))))",
            ),
            Kind::Texel,
            inputs::placed(HEIGHT),
            at_footprint,
            of_at_footprint,
        ),
    ]
}

pub(crate) fn shape_rows() -> Vec<Row> {
    [footprint_rows(), probe_and_ripmap_rows(), sum_rows(), fragment_rows()].into_iter().flatten().collect()
}
