//! The table of what maps.wgsl looks up: one row a call. The twins are those of `halfway_texture::lookup`; of what it
//! keeps to itself the definition is written out here, and the rows of `in_level` hold it to the lookup.

use halfway_texture::{LevelFilter, Pyramid, TexelFilter, TexelImage, Wrap, lookup};

use crate::adapter::Kind;
use crate::images::{COLOR, EMISSION, FILTERS, HEIGHT, IMAGES, Look, SPECULAR, WRAPS, largest};
use crate::inputs::{Input, wide};
use crate::map_inputs as inputs;
use crate::table::Row;

/// The step of f32 at 1. WGSL's basic operations are right to half of it, relative to their results; its division
/// to 2.5 of it, `exp2(x)` to 3 + 2·|x|.
pub(crate) const ULP: f64 = f32::EPSILON as f64;

pub(crate) fn row(
    (function, call): (&'static str, &'static str),
    kind: Kind,
    inputs: Vec<Input>,
    twin: fn(&[f32]) -> Vec<f64>,
    allowed: fn(&[f32], &[f64]) -> Vec<f64>,
) -> Row {
    assert!(call.contains(&format!("{function}(")), "{call} calls {function}");
    Row { function, call, kind, constants: &[], inputs, twin, allowed }
}

pub(crate) fn exact(_: &[f32], expected: &[f64]) -> Vec<f64> {
    vec![0.0; expected.len()]
}

// ---- numbers that an image is looked up by --------------------------------------------------------

fn fields(x: &[f32]) -> [f64; 6] {
    Look::from_bits(x[0]).fields().map(|field| field as f64)
}

pub(crate) fn look_rows() -> Vec<Row> {
    let looks = inputs::looks;
    vec![
        row(("magnify_of", "f32(magnify_of(u32(s(i, 0))))"), Kind::Scalar, looks(), |x| vec![fields(x)[0]], exact),
        row(("minify_of", "f32(minify_of(u32(s(i, 0))))"), Kind::Scalar, looks(), |x| vec![fields(x)[1]], exact),
        row(("levels_of", "f32(levels_of(u32(s(i, 0))))"), Kind::Scalar, looks(), |x| vec![fields(x)[2]], exact),
        row(("wrap_of", "vec2f(wrap_of(u32(s(i, 0))))"), Kind::Pair, looks(), |x| fields(x)[3..5].to_vec(), exact),
        row(
            ("channel_of", "channel_of(u32(s(i, 0)), vec4f(v(i, 1), s(i, 4)))"),
            Kind::Scalar,
            looks(),
            |x| vec![x[1 + Look::from_bits(x[0]).channel() as usize].into()],
            exact,
        ),
        row(
            ("takes_second", "select(0.0, 1.0, takes_second(u32(s(i, 0))))"),
            Kind::Scalar,
            looks(),
            |x| vec![if Look::from_bits(x[0]).takes_second() { 1.0 } else { 0.0 }],
            exact,
        ),
        row(
            ("of_set", "of_set(u32(s(i, 0)), vec4f(v(i, 1), s(i, 4)))"),
            Kind::Pair,
            looks(),
            |x| of_set(Look::from_bits(x[0]), x, 1).to_vec(),
            exact,
        ),
    ]
}

/// Of the two sets that stand in an input from `at` on.
pub(crate) fn of_set(look: Look, x: &[f32], at: usize) -> [f64; 2] {
    wide(&x[at + if look.takes_second() { 2 } else { 0 }..])
}

// ---- texels -----------------------------------------------------------------------------------------

/// The coordinate u in texels.
fn wrapped(u: f64, side: f64, wrap: Wrap) -> f64 {
    match wrap {
        Wrap::Repeat => u.rem_euclid(1.0) * side,
        Wrap::Mirror => (1.0 - (1.0 - u.rem_euclid(2.0)).abs()) * side,
        Wrap::Clamp => (u * side).clamp(-2.0, side + 2.0),
    }
}

/// The texel that a number stands for that may lie beyond the image.
fn wrapped_index(at: i64, side: i64, wrap: Wrap) -> i64 {
    match wrap {
        Wrap::Repeat => at.rem_euclid(side),
        // The image and its mirror image, one after the other.
        Wrap::Mirror => (0..side).chain((0..side).rev()).nth(at.rem_euclid(2 * side) as usize).expect("within both"),
        Wrap::Clamp => at.clamp(0, side - 1),
    }
}

/// The weights of a filter: its result for four texels with a number each.
fn texel_weights(f: f64, filter: TexelFilter) -> [f64; 4] {
    let own = |x, _| std::array::from_fn(|k| if k == x as usize { 1.0 } else { 0.0 });
    let image = Pyramid::new(TexelImage::from_fn(4, 1, own).expect("four texels"));
    lookup::in_level(&image, 0, [Wrap::Clamp; 2], filter, [(1.5 + f) / 4.0, 0.5])
}

pub(crate) fn texel_rows() -> Vec<Row> {
    vec![
        // u − floor(u) is off by half a ULP at most, where u is little below a whole number; so is the product.
        // Mirrored, the range is twice as large.
        row(
            ("wrapped", "wrapped(s(i, 0), s(i, 1), u32(s(i, 2)))"),
            Kind::Scalar,
            inputs::coordinates(),
            |x| vec![wrapped(x[0].into(), x[1].into(), WRAPS[x[2] as usize])],
            |x, _| vec![2.0 * ULP * (f64::from(x[1]) + 2.0)],
        ),
        row(
            ("remainder", "f32(remainder(i32(s(i, 0)), i32(s(i, 1))))"),
            Kind::Scalar,
            inputs::indices(),
            |x| vec![(x[0] as i64).rem_euclid(x[1] as i64) as f64],
            exact,
        ),
        row(
            ("wrapped_index", "f32(wrapped_index(i32(s(i, 0)), i32(s(i, 1)), u32(s(i, 2))))"),
            Kind::Scalar,
            inputs::indices(),
            |x| vec![wrapped_index(x[0] as i64, x[1] as i64, WRAPS[x[2] as usize]) as f64],
            exact,
        ),
        row(
            ("texel_weights", "texel_weights(s(i, 0), u32(s(i, 1)))"),
            Kind::Texel,
            inputs::parts(),
            |x| texel_weights(x[0].into(), FILTERS[x[1] as usize]).to_vec(),
            |_, e| vec![OF_WEIGHT; e.len()],
        ),
        row(
            (
                "texel_of",
                "texel_of(height_image, 7u, placings.each[7].level[u32(s(i, 0))], vec2i(vec2f(s(i, 1), s(i, 2))))",
            ),
            Kind::Texel,
            inputs::texels(),
            |x| {
                let [level, column, row] = [x[0], x[1], x[2]].map(|x| x as usize);
                let width = IMAGES[HEIGHT].levels()[level].width as usize;
                IMAGES[HEIGHT].level(level)[row * width + column].map(f64::from).to_vec()
            },
            exact,
        ),
    ]
}

/// At most 6 operations on numbers up to 6, each off by half a ULP, are 18 ULP, a sixth of which counts, with 2.5 for
/// the division; on numbers up to 5 they are 15, half of which counts.
const OF_WEIGHT: f64 = 8.0 * ULP;
/// No filter's weights sum up to more in magnitude, along both axes: 1.25² of Catmull-Rom.
pub(crate) const GROSS: f64 = 1.6;
/// The weights of a row are off by 4 · 8 ULP together, and so are those of a column; each counts as often as the
/// magnitudes of the others sum up to, 1.25: their products are off by 80 ULP. Sixteen sums of numbers up to 1.6 are
/// off by 13 ULP, products by 2, mixing two levels by 5.
pub(crate) const OF_SUM: f64 = 100.0 * ULP;
/// By how much of the largest texel a filter changes on the way of a texel along one axis: Catmull-Rom's slopes, 3 in
/// all, by 1.25.
const SLOPE: f64 = 4.0;

// ---- the image at a point -------------------------------------------------------------------------

/// How far a value may be off whose place is known to 3 ULP of the side, and further to `blur` texels of the image,
/// along each axis: by the slope of the filters without steps, and by what is around, where they have steps. 3 ULP of
/// the side and 2 texels more, of a level of two texels or more, are less than 9 ULP of the image; of one texel it does
/// not matter.
pub(crate) fn of_place(slot: usize, uv: [f64; 2], blur: [f64; 2], at: impl Fn([f64; 2]) -> [f64; 4]) -> [f64; 4] {
    let size = IMAGES[slot].size().map(f64::from);
    let off: [f64; 2] = std::array::from_fn(|k| 3.0 * ULP * (size[k] + 2.0) + blur[k]);
    let largest = largest(slot);
    let here = at(uv);
    let mut allowed = [largest * (SLOPE * (off[0] + off[1]) + OF_SUM); 4];
    for signs in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
        let there = at(std::array::from_fn(|k| uv[k] + signs[k] * (9.0 * ULP + blur[k] / size[k])));
        for k in 0..4 {
            allowed[k] = f64::max(allowed[k], (there[k] - here[k]).abs() + largest * OF_SUM);
        }
    }
    allowed
}

fn in_level<const SLOT: usize>(x: &[f32], uv: [f64; 2]) -> [f64; 4] {
    let wrap = [x[0], x[1]].map(|wrap| WRAPS[wrap as usize]);
    lookup::in_level(&IMAGES[SLOT], x[4] as usize, wrap, FILTERS[x[5] as usize], uv)
}

fn at_level<const SLOT: usize>(x: &[f32], uv: [f64; 2]) -> [f64; 4] {
    lookup::at_level(&IMAGES[SLOT], &Look::from_bits(x[0]).sampling(), uv, x[3].into())
}

fn gradient(x: &[f32]) -> [f64; 2] {
    let look = Look::from_bits(x[0]);
    lookup::gradient(&IMAGES[HEIGHT], &look.sampling(), wide(&x[1..]), x[3].into(), look.channel())
}

/// Two values half a texel of the level apart, over that distance. exp2 is off by 3 + 2·4 ULP at the last level, and so
/// is the distance; the places, at most 4.5 from 0, by half a ULP more.
fn of_gradient(x: &[f32], expected: &[f64]) -> Vec<f64> {
    let uv = wide(&x[1..]);
    let d = f64::from(x[3]).clamp(0.0, (IMAGES[HEIGHT].levels().len() - 1) as f64);
    let texel = if Look::from_bits(x[0]).sampling().levels == LevelFilter::None { 1.0 } else { d.exp2() };
    let size = IMAGES[HEIGHT].size().map(f64::from);
    let blur = size.map(|side| ULP * (4.5 * side + 11.0 * texel));
    let value = of_place(HEIGHT, uv, blur, |uv| at_level::<HEIGHT>(x, uv)).into_iter().fold(0.0, f64::max);
    (0..2).map(|k| 2.0 * value * size[k] / texel + 16.0 * ULP * expected[k].abs()).collect()
}

macro_rules! image_rows {
    ($rows:ident, $slot:ident, $image:literal, $number:literal) => {
        $rows.push(row(
            (
                "in_level",
                concat!(
                    "in_level(",
                    $image,
                    ", vec2u(vec2f(s(i, 0), s(i, 1))), v(i, 2).xy, u32(s(i, 4)), u32(s(i, 5)))"
                ),
            ),
            Kind::Texel,
            inputs::in_levels($slot),
            |x| in_level::<$slot>(x, wide(&x[2..])).to_vec(),
            |x, _| of_place($slot, wide(&x[2..]), [0.0; 2], |uv| in_level::<$slot>(x, uv)).to_vec(),
        ));
        $rows.push(row(
            (
                "in_image",
                concat!(
                    "in_image(",
                    $image,
                    ", placings.each[",
                    $number,
                    "].level[u32(s(i, 4))], vec2u(vec2f(s(i, 0), s(i, 1))), v(i, 2).xy, u32(s(i, 5)))"
                ),
            ),
            Kind::Texel,
            inputs::in_levels($slot),
            |x| in_level::<$slot>(x, wide(&x[2..])).to_vec(),
            |x, _| of_place($slot, wide(&x[2..]), [0.0; 2], |uv| in_level::<$slot>(x, uv)).to_vec(),
        ));
        $rows.push(row(
            ("at_level", concat!("at_level(", $image, ", u32(s(i, 0)), v(i, 1).xy, s(i, 3))")),
            Kind::Texel,
            inputs::at_levels(),
            |x| at_level::<$slot>(x, wide(&x[1..])).to_vec(),
            |x, _| of_place($slot, wide(&x[1..]), [0.0; 2], |uv| at_level::<$slot>(x, uv)).to_vec(),
        ));
    };
}

pub(crate) fn image_rows() -> Vec<Row> {
    let mut rows = vec![row(
        ("gradient", "gradient(height_image, 7u, u32(s(i, 0)), v(i, 1).xy, s(i, 3))"),
        Kind::Pair,
        inputs::gradients(),
        |x| gradient(x).to_vec(),
        of_gradient,
    )];
    image_rows!(rows, COLOR, "color_image, 0u", "0");
    image_rows!(rows, SPECULAR, "specular_image, 1u", "1");
    image_rows!(rows, EMISSION, "emission_image, 2u", "2");
    image_rows!(rows, HEIGHT, "height_image, 7u", "7");
    rows
}
