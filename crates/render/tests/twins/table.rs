//! The table of twins: each function of lighting.wgsl, what it is called with, and how far it may be from its twin.
//!
//! A row's one name stands for the WGSL function that is called on the adapter and for the Rust function that it is
//! compared with, so a row without its twin does not compile.

use halfway_lighting::Reflectance;
use halfway_lighting::equations::{self, Coefficients, Eye, Incidence, Irradiance, Light, Point};

use crate::adapter::Kind;
use crate::inputs::{self, Input, N, P, SHININESS, cone, directional, hemisphere, light, point, spot, surface, wide};

/// Calls of one function.
pub(crate) struct Row {
    pub(crate) function: &'static str,
    /// The WGSL expression.
    pub(crate) call: &'static str,
    pub(crate) kind: Kind,
    /// The overrides that the pipeline is specialised for.
    pub(crate) constants: &'static [(&'static str, f64)],
    pub(crate) inputs: Vec<Input>,
    /// The Rust function of the same name, in f64, with the same input.
    pub(crate) twin: fn(&[f32]) -> Vec<f64>,
    /// How far each number of the result may be from the twin's, for an input and the twin's result.
    pub(crate) allowed: fn(&[f32], &[f64]) -> Vec<f64>,
}

trait Parts {
    fn parts(self) -> Vec<f64>;
}

impl Parts for f64 {
    fn parts(self) -> Vec<f64> {
        vec![self]
    }
}

impl Parts for [f64; 3] {
    fn parts(self) -> Vec<f64> {
        self.to_vec()
    }
}

/// The place, then the number of the face.
impl Parts for (usize, [f64; 2]) {
    fn parts(self) -> Vec<f64> {
        let (face, [u, v]) = self;
        vec![u, v, face as f64]
    }
}

/// Where Rust says that there is no normal the shader has 0.
impl Parts for Option<[f64; 3]> {
    fn parts(self) -> Vec<f64> {
        self.unwrap_or_default().to_vec()
    }
}

impl Parts for Incidence<f64> {
    fn parts(self) -> Vec<f64> {
        [&self.l[..], &[self.grazing, self.weight]].concat()
    }
}

impl Parts for Irradiance<f64> {
    fn parts(self) -> Vec<f64> {
        [self.ambient, self.diffuse, self.specular].concat()
    }
}

macro_rules! row {
    ($name:ident($call:literal) -> $kind:ident, $constants:expr, $inputs:expr, |$x:ident| ($($argument:expr),*), $allowed:expr) => {
        Row {
            function: stringify!($name),
            call: concat!(stringify!($name), "(", $call, ")"),
            kind: Kind::$kind,
            constants: $constants,
            inputs: $inputs,
            twin: |$x| Parts::parts($name($($argument),*)),
            allowed: $allowed,
        }
    };
}

/// The step of f32 at 1. WGSL's basic operations are right to half of it, relative to their results; its division
/// to 2.5 of it, `inverseSqrt` to 2.
const ULP: f64 = f32::EPSILON as f64;
/// Results below the normal numbers may be 0.
const LEAST: f64 = f32::MIN_POSITIVE as f64;

/// The same for each number of the result.
fn each(expected: &[f64], allowed: f64) -> Vec<f64> {
    vec![allowed; expected.len()]
}

/// The error that WGSL allows `pow(x, e)`, which is `exp2(e · log2(x))`: 2⁻²¹ for a logarithm of x in [0.5, 2], else 3
/// ULP, and 3 + 2·|e · log2(x)| ULP for the exponential.
fn of_power(x: f64, e: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    if x == 0.0 {
        return 0.0;
    }
    let logarithm = if x >= 0.5 { 0.5f64.powi(21) } else { 3.0 * ULP * x.log2().abs() };
    let exponent = e * x.log2();
    let relative = (e * logarithm + exponent.abs() * ULP) * std::f64::consts::LN_2 + (3.0 + 2.0 * exponent.abs()) * ULP;
    power(x, e) * relative.exp_m1() + LEAST
}

/// The change of `x^e` where x is known to `blur`, and what the power itself is off by.
fn of_blurred_power(x: f64, blur: f64, e: f64) -> f64 {
    let [low, high] = [x - blur, x + blur].map(|x| power(x, e));
    (high - low).abs() + of_power(x + blur, e)
}

/// Of S: for unit vectors n·h is off by what the rounding of l + v, relative to its length, turns h.
fn of_highlight(phong: bool, n: [f64; 3], l: [f64; 3], v: [f64; 3], blur: f64, e: f64) -> f64 {
    if phong {
        return of_blurred_power(dot(reflect(l, n), v), 3.0 * blur, e);
    }
    half_vector(l, v).map_or(0.0, |h| of_blurred_power(dot(n, h), 2.0 * blur / length(add(l, v)) + blur, e))
}

/// Lengths along the axes are off by some ULP of those of the vectors, by which each product is off, over the squares
/// of them.
fn of_axial(x: &[f32]) -> Vec<f64> {
    let (axes, widths): ([[f64; 3]; 2], [f64; 3]) = ([wide(x), wide(&x[3..])], wide(&x[6..]));
    let h: [f64; 3] = wide(&x[9..]);
    let [a, b] = axes.map(|axis| dot(h, axis).abs());
    let squared = a * a + b * b;
    if squared <= 1e-30 {
        return vec![0.0];
    }
    let off = 3.0 * ULP * length(h) * length(axes[0]).max(length(axes[1]));
    let most = widths.map(f64::abs).into_iter().fold(0.0, f64::max);
    vec![8.0 * most * (off * (a + b) + off * off) / squared + 16.0 * ULP * most]
}

fn vectors_of(x: &[f32]) -> ([f64; 3], [f64; 3], [f64; 3], f64) {
    (wide(x), wide(&x[3..]), wide(&x[6..]), f64::from(x[9]))
}

/// Of att·spot: the distance is known to 4 ULP, which its square takes twice and the window four times; the cosine of
/// the cone to 8 ULP, which its power and its fade steepen.
fn of_weight(x: &[f32], ranged: bool, coned: bool) -> f64 {
    let mut bare = spot(x).point;
    if !ranged {
        bare.range = None;
    }
    let Incidence { l, weight, .. } = incidence(&surface(x), &Light::Point(bare));
    bare.range = None;
    let unwindowed = incidence(&surface(x), &Light::Point(bare)).weight;
    let falloff = 30.0 * ULP * weight + if ranged { 40.0 * ULP * unwindowed } else { 0.0 };
    if !coned {
        return falloff + LEAST;
    }
    let cone = cone(x);
    let cos_phi = -dot(l, cone.direction);
    let spot = spot_factor(cos_phi, &cone);
    falloff + unwindowed * of_spot(cos_phi, 8.0 * ULP, x, spot) + LEAST
}

/// Of the cone's factor at a cosine that is known to `blur`. At the very edge it is one side's or the other's.
fn of_spot(cos_phi: f64, blur: f64, x: &[f32], spot: f64) -> f64 {
    let (cone, scale) = (cone(x), f64::from(x[21]));
    let off = [cos_phi - blur, cos_phi + blur].map(|cosine| (spot_factor(cosine, &cone) - spot).abs());
    // The fade's scale and offset are rounded: their sum is off by their ULPs.
    let fade = 2.0 * ULP * (2.0 * scale + 1.0);
    off[0].max(off[1]) + of_power(cos_phi.min(1.0), cone.exponent) + fade * power(cos_phi, cone.exponent) + LEAST
}

fn of_irradiance(x: &[f32], expected: &[f64], reflectance: Reflectance, shared: bool) -> Vec<f64> {
    of_irradiance_from(&light(x), of_weight(x, true, true), x, expected, reflectance, shared)
}

/// The same for a light whose weight is known to `of_weight`.
fn of_irradiance_from(
    light: &Light<f64>,
    of_weight: f64,
    x: &[f32],
    expected: &[f64],
    reflectance: Reflectance,
    shared: bool,
) -> Vec<f64> {
    let surface = surface(x);
    let Incidence { l, grazing, weight } = incidence(&surface, light);
    let colors = spot(x).point.colors;
    let v = view_vector(&surface, &Eye::Local([0.0; 3]));
    let n = surface.normal;
    let s = specular_term(reflectance, n, l, v, &glossy(x[SHININESS]));
    let of_s = of_highlight(reflectance == Reflectance::Phong, n, l, v, 16.0 * ULP, f64::from(x[SHININESS]));
    // At the very height that counts as in the plane it is one side's or the other's.
    let either = if (dot(n, l) - grazing).abs() < 8.0 * ULP { weight } else { 0.0 };
    let of_diffuse = (of_weight + either) * diffuse_term(n, l) + weight * 10.0 * ULP;
    let of_specular = (of_weight + either) * (s + of_s) + weight * of_s;
    let specular = if shared { colors.ld } else { colors.ls };
    let colors = [(colors.la, of_weight), (colors.ld, of_diffuse), (specular, of_specular)];
    let allowed = colors.into_iter().flat_map(|(color, off)| color.map(|c| c * off + LEAST));
    allowed.zip(expected).map(|(allowed, expected)| allowed + 2.0 * ULP * expected).collect()
}

const PHONG: &[(&str, f64)] = &[("BLINN_PHONG", 0.0)];
const NOTHING: &[(&str, f64)] = &[];

/// The light with its specular colour its diffuse colour.
fn shared(x: &[f32]) -> Light<f64> {
    let mut spot = spot(x);
    spot.point.colors.ls = spot.point.colors.ld;
    Light::Spot(spot)
}

fn without_range(x: &[f32]) -> Light<f64> {
    Light::Point(Point { range: None, ..spot(x).point })
}

/// A material of this shininess.
fn glossy(shininess: f32) -> Coefficients<f64> {
    Coefficients { shininess: f64::from(shininess), ..Coefficients::black() }
}

fn incidence(surface: &equations::ShadedPoint<f64>, light: &Light<f64>) -> Incidence<f64> {
    equations::incidence(surface, light).expect("a direction")
}

use equations::irradiance as any_light;
use equations::irradiance as directional_light;
use equations::irradiance as hemisphere_light;
use equations::irradiance as point_light;
use equations::irradiance as spot_light;

use equations::vector::{add, dot, length, normalize_or_zero};
use equations::{
    aces, attenuation, axial_exponent, diffuse_term, divisor, half_vector, interpolated_normal, irradiance, lobe_angle,
    lobe_exponent, mean_light, mirrored, power, range_window, reflect, reinhard, specular_blinn_phong, specular_phong,
    specular_term, spot_factor, srgb_encoded, transform_normal, view_vector,
};

use halfway_texture::environment::on_cube;

#[rustfmt::skip]
#[expect(clippy::too_many_lines, reason = "a table: one row a function of the texts")]
pub(crate) fn rows() -> Vec<Row> {
    vec![
        row!(power("s(i, 0), s(i, 1), -1") -> Scalar, NOTHING, inputs::powers(),
            |x| (f64::from(x[0]), f64::from(x[1])), |x, e| each(e, of_power(f64::from(x[0]), f64::from(x[1])))),
        // Each of k squarings doubles the error that it is given, and adds half a ULP.
        row!(power("s(i, 0), 0.0, i32(s(i, 1))") -> Scalar, NOTHING, inputs::squarings(),
            |x| (f64::from(x[0]), f64::from(x[1]).exp2()),
            |x, e| each(e, e[0] * f64::from((x[1].exp2() * f32::EPSILON).exp_m1()) + LEAST)),
        row!(attenuation("light(i, 0), s(i, 32)") -> Scalar, NOTHING, inputs::falls(),
            |x| ([x[7], x[11], x[15]].map(f64::from), f64::from(x[32])), |_, e| each(e, 5.0 * ULP * e[0] + LEAST)),
        // (d/R)⁴ is off by 6 ULP where it counts, below 1; its square root of the window twice that.
        row!(range_window("s(i, 0), s(i, 2)") -> Scalar, NOTHING, inputs::ranges(),
            |x| (f64::from(x[0]), f64::from(x[1])), |_, e| each(e, 16.0 * ULP)),
        row!(spot_factor("s(i, 32), light(i, 0)") -> Scalar, NOTHING, inputs::cones(),
            |x| (f64::from(x[32]), &cone(x)), |x, e| each(e, of_spot(f64::from(x[32]), 0.0, x, e[0]))),
        row!(incidence("light(i, 0), true, v(i, 23), v(i, 26)") -> Incidence, NOTHING, inputs::lit(inputs::coincident()),
            |x| (&surface(x), &light(x)),
            |x, e| [6.0 * ULP, 6.0 * ULP, 6.0 * ULP, 8.0 * ULP * e[3], of_weight(x, true, true)].to_vec()),
        row!(incidence("light(i, 0), false, v(i, 23), v(i, 26)") -> Incidence, &[("RANGED", 0.0)], inputs::lit(inputs::coincident()),
            |x| (&surface(x), &without_range(x)),
            |x, e| [6.0 * ULP, 6.0 * ULP, 6.0 * ULP, 8.0 * ULP * e[3], of_weight(x, false, false)].to_vec()),
        row!(view_vector("v(i, 0), v(i, 3)") -> Vector, NOTHING, inputs::vectors(),
            |x| (&equations::ShadedPoint { position: wide(x), normal: wide(&x[3..]) }, &Eye::Local([0.0; 3])),
            |_, e| each(e, 5.0 * ULP)),
        row!(view_vector("v(i, 0), v(i, 3)") -> Vector, &[("LOCAL_VIEWER", 0.0)], inputs::vectors(),
            |x| (&equations::ShadedPoint { position: wide(x), normal: wide(&x[3..]) }, &Eye::Infinite([0.0, 0.0, 1.0])),
            |_, e| each(e, 0.0)),
        row!(diffuse_term("v(i, 0), v(i, 3)") -> Scalar, NOTHING, inputs::highlights(),
            |x| (wide(x), wide(&x[3..])), |_, e| each(e, 3.0 * ULP)),
        row!(axial_exponent("mat2x3f(v(i, 0), v(i, 3)), v(i, 6), v(i, 9), s(i, 12)") -> Scalar, NOTHING,
            inputs::spreads(),
            |x| ([wide(x), wide(&x[3..])], wide(&x[6..]), wide(&x[9..]), f64::from(x[12])), |x, _| of_axial(x)),
        row!(specular_phong("v(i, 0), v(i, 3), v(i, 6), s(i, 9)") -> Scalar, PHONG, inputs::highlights(),
            |x| (wide(x), wide(&x[3..]), wide(&x[6..]), f64::from(x[9])),
            |x, e| { let (n, l, v, a) = vectors_of(x); each(e, of_highlight(true, n, l, v, 4.0 * ULP, a)) }),
        row!(specular_blinn_phong("v(i, 0), v(i, 3), v(i, 6), s(i, 9)") -> Scalar, NOTHING, inputs::highlights(),
            |x| (wide(x), wide(&x[3..]), wide(&x[6..]), f64::from(x[9])),
            |x, e| { let (n, l, v, a) = vectors_of(x); each(e, of_highlight(false, n, l, v, 4.0 * ULP, a)) }),
        // An exponent of 32 that the pipeline knows.
        row!(specular_blinn_phong("v(i, 0), v(i, 3), v(i, 6), s(i, 9)") -> Scalar, &[("SQUARINGS", 5.0)], inputs::highlights(),
            |x| (wide(x), wide(&x[3..]), wide(&x[6..]), 32.0),
            |x, e| { let (n, l, v, _) = vectors_of(x); each(e, of_highlight(false, n, l, v, 4.0 * ULP, 32.0)) }),
        row!(specular_phong("v(i, 0), v(i, 3), v(i, 6), s(i, 9)") -> Scalar, &[("SQUARINGS", 5.0)], inputs::highlights(),
            |x| (wide(x), wide(&x[3..]), wide(&x[6..]), 32.0),
            |x, e| { let (n, l, v, _) = vectors_of(x); each(e, of_highlight(true, n, l, v, 4.0 * ULP, 32.0)) }),
        row!(specular_term("v(i, 0), v(i, 3), v(i, 6), glossy(s(i, 9))") -> Scalar, PHONG, inputs::highlights(),
            |x| (Reflectance::Phong, wide(x), wide(&x[3..]), wide(&x[6..]), &glossy(x[9])),
            |x, e| { let (n, l, v, a) = vectors_of(x); each(e, of_highlight(true, n, l, v, 4.0 * ULP, a)) }),
        row!(specular_term("v(i, 0), v(i, 3), v(i, 6), glossy(s(i, 9))") -> Scalar, NOTHING, inputs::highlights(),
            |x| (Reflectance::BlinnPhong, wide(x), wide(&x[3..]), wide(&x[6..]), &glossy(x[9])),
            |x, e| { let (n, l, v, a) = vectors_of(x); each(e, of_highlight(false, n, l, v, 4.0 * ULP, a)) }),
        row!(irradiance("light(i, 0), incidence(light(i, 0), true, v(i, 23), v(i, 26)), v(i, 26), \
                view_vector(v(i, 23), v(i, 26)), glossy(s(i, 29)), Terms(true, true)") -> Irradiance,
            NOTHING, inputs::lit(inputs::coincident()),
            |x| (&surface(x), &light(x), &Eye::Local([0.0; 3]), Reflectance::BlinnPhong, &glossy(x[SHININESS])),
            |x, e| of_irradiance(x, e, Reflectance::BlinnPhong, false)),
        row!(irradiance("light(i, 0), incidence(light(i, 0), true, v(i, 23), v(i, 26)), v(i, 26), \
                view_vector(v(i, 23), v(i, 26)), glossy(s(i, 29)), Terms(true, true)") -> Irradiance,
            &[("BLINN_PHONG", 0.0), ("SHARED_COLOR", 1.0)], inputs::lit(inputs::coincident()),
            |x| (&surface(x), &shared(x), &Eye::Local([0.0; 3]), Reflectance::Phong, &glossy(x[SHININESS])),
            |x, e| of_irradiance(x, e, Reflectance::Phong, true)),
        row!(directional_light("light(i, 0), v(i, 23), v(i, 26), view_vector(v(i, 23), v(i, 26)), glossy(s(i, 29)), Terms(true, true)")
                -> Irradiance, NOTHING, inputs::sunny(),
            |x| (&surface(x), &directional(x), &Eye::Local([0.0; 3]), Reflectance::BlinnPhong, &glossy(x[SHININESS])),
            |x, e| of_irradiance_from(&directional(x), 0.0, x, e, Reflectance::BlinnPhong, false)),
        row!(point_light("light(i, 0), v(i, 23), v(i, 26), view_vector(v(i, 23), v(i, 26)), glossy(s(i, 29)), Terms(true, true)")
                -> Irradiance, NOTHING, inputs::lit(inputs::coincident()),
            |x| (&surface(x), &point(x), &Eye::Local([0.0; 3]), Reflectance::BlinnPhong, &glossy(x[SHININESS])),
            |x, e| of_irradiance_from(&point(x), of_weight(x, true, false), x, e, Reflectance::BlinnPhong, false)),
        row!(spot_light("light(i, 0), v(i, 23), v(i, 26), view_vector(v(i, 23), v(i, 26)), glossy(s(i, 29)), Terms(true, true)")
                -> Irradiance, NOTHING, inputs::lit(inputs::coincident()),
            |x| (&surface(x), &light(x), &Eye::Local([0.0; 3]), Reflectance::BlinnPhong, &glossy(x[SHININESS])),
            |x, e| of_irradiance(x, e, Reflectance::BlinnPhong, false)),
        // The cosine is known to 4 ULP, and each product to half of one.
        row!(hemisphere_light("light(i, 0), v(i, 23), v(i, 26), v(i, 26), glossy(s(i, 29)), Terms(true, true)")
                -> Irradiance, NOTHING, inputs::sunny(),
            |x| (&surface(x), &hemisphere(x), &Eye::Local([0.0; 3]), Reflectance::BlinnPhong, &glossy(x[SHININESS])),
            |_, e| each(e, 16.0 * ULP)),
        row!(any_light("of_kind(3u, i, 0), v(i, 23), v(i, 26), v(i, 26), glossy(s(i, 29)), Terms(true, true)")
                -> Irradiance, NOTHING, inputs::sunny(),
            |x| (&surface(x), &hemisphere(x), &Eye::Local([0.0; 3]), Reflectance::BlinnPhong, &glossy(x[SHININESS])),
            |_, e| each(e, 16.0 * ULP)),
        row!(any_light("of_kind(0u, i, 0), v(i, 23), v(i, 26), view_vector(v(i, 23), v(i, 26)), glossy(s(i, 29)), Terms(true, true)")
                -> Irradiance, NOTHING, inputs::sunny(),
            |x| (&surface(x), &directional(x), &Eye::Local([0.0; 3]), Reflectance::BlinnPhong, &glossy(x[SHININESS])),
            |x, e| of_irradiance_from(&directional(x), 0.0, x, e, Reflectance::BlinnPhong, false)),
        row!(any_light("of_kind(1u, i, 0), v(i, 23), v(i, 26), view_vector(v(i, 23), v(i, 26)), glossy(s(i, 29)), Terms(true, true)")
                -> Irradiance, NOTHING, inputs::lit(inputs::coincident()),
            |x| (&surface(x), &point(x), &Eye::Local([0.0; 3]), Reflectance::BlinnPhong, &glossy(x[SHININESS])),
            |x, e| of_irradiance_from(&point(x), of_weight(x, true, false), x, e, Reflectance::BlinnPhong, false)),
        row!(any_light("of_kind(2u, i, 0), v(i, 23), v(i, 26), view_vector(v(i, 23), v(i, 26)), glossy(s(i, 29)), Terms(true, true)")
                -> Irradiance, NOTHING, inputs::lit(inputs::coincident()),
            |x| (&surface(x), &light(x), &Eye::Local([0.0; 3]), Reflectance::BlinnPhong, &glossy(x[SHININESS])),
            |x, e| of_irradiance(x, e, Reflectance::BlinnPhong, false)),
        row!(normalize_or_zero("v(i, 0)") -> Vector, NOTHING, inputs::short_vectors(),
            |x| (long_enough(wide(x))), |_, e| each(e, 5.0 * ULP)),
        row!(transform_normal("mat3x3f(v(i, 0), v(i, 3), v(i, 6)), v(i, 9)") -> Vector, NOTHING, inputs::matrices(),
            |x| (columns(x), wide(&x[9..])), |x, e| each(e, of_transform(x))),
        row!(interpolated_normal("v(i, 0), v(i, 3)") -> Vector, NOTHING, inputs::short_vectors(),
            |x| (wide(x), wide(&x[3..])), |_, e| each(e, 5.0 * ULP)),
        // The polynomial is 6.8·10⁻⁶ from the curve, and q is known to 3 ULP.
        row!(srgb_encoded("vec3f(s(i, 0))") -> Repeated, NOTHING, inputs::intensities(),
            |x| (f64::from(x[0])), |_, e| each(e, 6.8e-6 + 6.0 * ULP)),
        // A difference, a product and a sum, of numbers up to the larger of the two.
        row!(divisor("s(i, 0), s(i, 1), s(i, 2)") -> Scalar, NOTHING, inputs::divisors(),
            |x| (f64::from(x[0]), f64::from(x[1]), f64::from(x[2])),
            |x, e| each(e, 3.0 * ULP * f64::from(x[0].max(x[1]).max(1.0)))),
        // A quotient of 2.5 ULP and four operations.
        row!(reinhard("vec3f(s(i, 0)), s(i, 1)") -> Repeated, NOTHING, inputs::white_points(),
            |x| (f64::from(x[0]), f64::from(x[1])), |_, e| each(e, 6.0 * ULP * e[0] + LEAST)),
        // A quotient and eight operations, with constants that are rounded.
        row!(aces("vec3f(s(i, 0))") -> Repeated, NOTHING, inputs::bright(),
            |x| (f64::from(x[0])), |_, e| each(e, 10.0 * ULP * e[0] + LEAST)),
        row!(mirrored("v(i, 0), v(i, 6)") -> Vector, NOTHING, inputs::highlights(),
            |x| (wide(x), wide(&x[6..])), |_, e| each(e, 6.0 * ULP)),
        row!(lobe_exponent("false, s(i, 9)") -> Scalar, NOTHING, inputs::highlights(),
            |x| (Reflectance::Phong, f64::from(x[9])), |_, e| each(e, 0.0)),
        row!(lobe_exponent("true, s(i, 9)") -> Scalar, NOTHING, inputs::highlights(),
            |x| (Reflectance::BlinnPhongMatched, f64::from(x[9])), |_, e| each(e, LEAST)),
        // WGSL grants a square root what it grants 1/inverseSqrt: 2 ULP, and 2.5 more of each division.
        row!(lobe_angle("s(i, 9)") -> Scalar, NOTHING, inputs::highlights(),
            |x| (f64::from(x[9])), |_, e| each(e, 8.0 * ULP * e[0])),
        row!(mean_light("array<vec3f, 9>(v(i, 0), v(i, 3), v(i, 6), v(i, 9), v(i, 12), v(i, 15), v(i, 18), v(i, 21), v(i, 24)), \
                v(i, 27)") -> Vector, NOTHING, inputs::harmonics(),
            |x| (&std::array::from_fn(|k| wide(&x[3 * k..])), wide(&x[27..])), |_, e| each(e, 40.0 * ULP)),
        // A place is a quotient, of which half is taken after 1 is added.
        row!(on_cube("v(i, 0)") -> Vector, NOTHING, inputs::directions(),
            |x| (wide(x)), |_, e| vec![4.0 * ULP, 4.0 * ULP, 0.0][..e.len()].to_vec()),
    ]
}

fn columns(x: &[f32]) -> [[f64; 3]; 3] {
    [wide(x), wide(&x[3..]), wide(&x[6..])]
}

/// A vector whose square is no normal number of f32 counts as 0; the shaders get none but 0 itself.
fn long_enough(a: [f64; 3]) -> [f64; 3] {
    if length(a) * length(a) < LEAST { [0.0; 3] } else { a }
}

/// Three roundings of each sum, relative to what is left of it, and those of the normalisation.
fn of_transform(x: &[f32]) -> f64 {
    let (n, columns) = (wide::<3>(&x[9..]), columns(x));
    let row = |i: usize| (0..3).map(|k| columns[k][i] * n[k]).sum::<f64>();
    let left = length([row(0), row(1), row(2)]);
    let gross: f64 = (0..3).map(|k| length(columns[k]) * n[k].abs()).sum();
    if left == 0.0 { 0.0 } else { 5.0 * ULP + 3.0 * ULP * gross / left }
}

/// The constants of lighting.wgsl and what they are in Rust.
pub(crate) fn constants() -> Vec<(&'static str, f32)> {
    macro_rules! named {
        ($($name:ident),*) => { vec![$((stringify!($name), equations::$name)),*] };
    }
    let mut constants = named![ACES_WHITE, ATTENUATION_MAX, COINCIDENT, GRAZING, HALFWAY_MIN, NORMAL_MIN];
    constants.push(("MIN_POSITIVE", f32::MIN_POSITIVE));
    constants
}

/// An input in words, for a message.
pub(crate) fn described(input: &Input) -> String {
    let last = input.iter().rposition(|&x| x != 0.0).unwrap_or(0);
    format!("{:?}", &input[..=last.max(P.min(N))])
}
