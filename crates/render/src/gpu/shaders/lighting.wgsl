// The equations in eye space, linear RGB, without the functions of the kinds of light, which are in
// halfway_lighting::lights. It needs no other file and has no bindings; the vertex and the fragment stages share it.
// Each function and each constant here has a twin of the same name in halfway_lighting::equations, written apart; a
// test calls each function on the adapter and compares it with its twin.

// The switches of a pipeline. The equations with a switch off are those of draws that need no more.
override BLINN_PHONG: bool = true;          // else Phong
override LOCAL_VIEWER: bool = true;
override ATTENUATED_AMBIENT: bool = true;   // some light attenuates its ambient color
override SHARED_COLOR: bool = false;        // every light's specular color is its diffuse color
override SPECULAR: bool = true;             // some highlight is shaded, in this stage or the other
override RANGED: bool = true;               // some light has a range
override SQUARINGS: i32 = -1;               // the shininess is 2^SQUARINGS; -1: read it and take a power
override LEAN: bool = false;                // highlights have two axes: those of `axial`

// The terms of a light that are shaded; the others are shaded in the other stage, or are invisible. Ambient goes with
// diffuse.
struct Terms {
    diffuse: bool,
    specular: bool,
}

struct Light {
    position: vec3f,     // in eye space, or the unit vector toward the light
    inverse_range: f32,  // 0: no range
    diffuse: vec3f,
    constant: f32,
    specular: vec3f,
    linear: f32,
    direction: vec3f,    // the way a spot shines, unit
    quadratic: f32,
    ambient: vec3f,      // only of lights that attenuate their ambient; else it is in Material.base
    cos_cutoff: f32,
    exponent: f32,
    inner_scale: f32,    // s = clamp(cos φ · inner_scale + inner_offset, 0, 1); 0 and 1 without an inner cone
    inner_offset: f32,
    kind: u32,           // the number of its kind
}

struct Material {
    base: vec3f,         // ke + ka·(Ga + Σ La) of the lights that do not attenuate their ambient
    shininess: f32,
    diffuse: vec3f,
    opacity: f32,
    specular: vec3f,
    padding0: f32,
    ambient: vec3f,      // ka, for the lights that attenuate their ambient
    padding1: f32,
    emission: vec3f,     // of painted surfaces, in which it is not part of the base
    padding2: f32,
}

// A light as it arrives at a point: l toward the light, the n·l up to which it counts as in the plane of the surface,
// and att · spot.
struct Incidence {
    l: vec3f,
    grazing: f32,
    weight: f32,
}

// The light at a point, before the material: colour · att · spot · factor, of one light or summed over several.
struct Irradiance {
    ambient: vec3f,
    diffuse: vec3f,
    specular: vec3f,
}

// The largest attenuation.
const ATTENUATION_MAX: f32 = 1e6;
// A light at most this share of ‖p‖ away from p counts as being at p.
const COINCIDENT: f32 = 2e-6;
// A light no higher over the plane of a surface than this share of ‖p‖ and its distance counts as in it.
const GRAZING: f32 = 5e-7;
// l and v with a shorter sum (an angle of 1e-6 rad from l = −v) have no half vector: S = 0.
const HALFWAY_MIN: f32 = 1e-6;
// A shorter interpolated normal has no direction.
const NORMAL_MIN: f32 = 1e-6;
// The smallest normal number. Squares below it have lost their digits.
const MIN_POSITIVE: f32 = 1.17549435e-38;

// n / ‖n‖. Zero stays zero: a collapsed normal lights nothing, and is finite.
fn normalize_or_zero(n: vec3f) -> vec3f {
    return n * inverseSqrt(max(dot(n, n), MIN_POSITIVE));
}

fn transform_normal(normal_matrix: mat3x3f, n: vec3f) -> vec3f {
    return normalize_or_zero(normal_matrix[0] * n.x + normal_matrix[1] * n.y + normal_matrix[2] * n.z);
}

// The interpolated normal, renormalised; the geometric one where it vanishes (opposite vertex normals).
fn interpolated_normal(n: vec3f, geometric: vec3f) -> vec3f {
    return select(normalize_or_zero(n), geometric, dot(n, n) < NORMAL_MIN * NORMAL_MIN);
}

// x^e for x in 0..1, with 0⁰ = 1, which pow leaves indeterminate. An exponent that is known to be 2^squarings takes no
// logarithm; −1 stands for any other.
fn power(x: f32, e: f32, squarings: i32) -> f32 {
    if squarings >= 0 {
        var result = x;
        for (var i = 0; i < squarings; i++) {
            result *= result;
        }
        return result;
    }
    return select(pow(x, e), select(0.0, 1.0, e == 0.0), x <= 0.0);
}

fn attenuation(light: Light, d: f32) -> f32 {
    let divisor = light.constant + d * (light.linear + d * light.quadratic);
    return 1.0 / max(divisor, 1.0 / ATTENUATION_MAX);
}

// KHR_lights_punctual: clamp(1 − (d/R)⁴, 0, 1)².
fn range_window(d: f32, inverse_range: f32) -> f32 {
    let t = d * inverse_range;
    let w = clamp(1.0 - t * t * t * t, 0.0, 1.0);
    return w * w;
}

fn spot_factor(cosine: f32, light: Light) -> f32 {
    let cos_phi = min(cosine, 1.0);
    let inner = clamp(cos_phi * light.inner_scale + light.inner_offset, 0.0, 1.0);
    let falloff = power(max(cos_phi, 0.0), light.exponent, -1) * inner * inner;
    return select(0.0, falloff, cos_phi >= light.cos_cutoff);
}

// The direction and strength of a point light, or of a spot light when `cone` is set, at a point.
fn incidence(light: Light, cone: bool, p: vec3f, n: vec3f) -> Incidence {
    let to_light = light.position - p;
    let squared = dot(to_light, to_light);
    // A light at the point has no direction, and no distance: l falls back to n.
    let at_point = squared <= max(COINCIDENT * COINCIDENT * dot(p, p), MIN_POSITIVE);
    let inverse = inverseSqrt(max(squared, MIN_POSITIVE));
    let l = select(to_light * inverse, n, at_point);
    let d = select(squared * inverse, 0.0, at_point);
    var weight = attenuation(light, d);
    if RANGED {
        weight *= range_window(d, light.inverse_range);
    }
    if cone {
        weight *= spot_factor(-dot(l, light.direction), light);
    }
    let grazing = select(GRAZING + GRAZING * length(p) * inverse, 0.0, at_point);
    return Incidence(l, grazing, weight);
}

// v: toward the eye, or (0, 0, 1) for an infinite viewer. An eye on the surface looks along n.
fn view_vector(p: vec3f, n: vec3f) -> vec3f {
    if LOCAL_VIEWER {
        let squared = dot(p, p);
        return select(-p * inverseSqrt(max(squared, MIN_POSITIVE)), n, squared < MIN_POSITIVE);
    }
    return vec3f(0.0, 0.0, 1.0);
}

fn diffuse_term(n: vec3f, l: vec3f) -> f32 {
    return max(dot(n, l), 0.0);
}

// (v·r)^α with r = 2(n·l)n − l.
fn specular_phong(n: vec3f, l: vec3f, v: vec3f, alpha: f32) -> f32 {
    let n_dot_l = dot(n, l);
    let cos_r = clamp(2.0 * n_dot_l * dot(n, v) - dot(l, v), 0.0, 1.0);
    return select(0.0, power(cos_r, alpha, SQUARINGS), n_dot_l > 0.0);
}

// (n·h)^β with h = (l + v)/‖l + v‖, as ((n·(l + v))²/‖l + v‖²)^(β/2), which needs no square root.
fn specular_blinn_phong(n: vec3f, l: vec3f, v: vec3f, beta: f32) -> f32 {
    let sum = l + v;
    let squared = dot(sum, sum);
    let shortest = HALFWAY_MIN * HALFWAY_MIN;
    let n_dot_sum = max(dot(n, sum), 0.0);
    let cos_squared = min(n_dot_sum * n_dot_sum / max(squared, shortest), 1.0);
    let s = power(cos_squared, 0.5 * beta, SQUARINGS - 1);
    return select(0.0, s, (squared > shortest) & (dot(n, l) > 0.0));
}

// The exponent of a highlight that is not round, toward the halfway direction h, of any length.
fn axial_exponent(axes: mat2x3f, widths: vec3f, h: vec3f, otherwise: f32) -> f32 {
    let a = dot(h, axes[0]);
    let b = dot(h, axes[1]);
    let squared = a * a + b * b;
    let along = widths.x * a * a + 2.0 * widths.y * a * b + widths.z * b * b;
    return select(max(along / max(squared, 1e-30), 0.0), otherwise, squared <= 1e-30);
}

// The axes of a fragment's highlights, perpendicular to its normal, and the inverse of how wide they are, as
// axial_exponent takes them. Where nothing sets it highlights are round.
struct AxialGloss {
    axes: mat2x3f,
    widths: vec3f,
}

var<private> axial: AxialGloss;

fn specular_term(n: vec3f, l: vec3f, v: vec3f, material: Material) -> f32 {
    var exponent = material.shininess;
    if LEAN {
        exponent = axial_exponent(axial.axes, axial.widths, l + v, material.shininess);
    }
    if BLINN_PHONG {
        return specular_blinn_phong(n, l, v, exponent);
    }
    return specular_phong(n, l, v, exponent);
}

// The light of one source at a point.
fn irradiance(light: Light, incident: Incidence, n: vec3f, v: vec3f, material: Material, terms: Terms) -> Irradiance {
    var result = Irradiance();
    let weight = select(0.0, incident.weight, dot(n, incident.l) > incident.grazing);
    if terms.diffuse {
        result.diffuse = light.diffuse * (weight * diffuse_term(n, incident.l));
    }
    if terms.specular {
        var color = light.specular;
        if SHARED_COLOR {
            color = light.diffuse;
        }
        result.specular = color * (weight * specular_term(n, incident.l, v, material));
    }
    if ATTENUATED_AMBIENT && terms.diffuse {
        result.ambient = light.ambient * incident.weight;
    }
    return result;
}

// The sRGB curve (IEC 61966-2-1) of intensities in 0..1. Its upper part, 1.055·I^(1/2.4) − 0.055, is a polynomial of
// the fifth degree in ⁴√I here, fitted for the least greatest error: 6.8e-6, a 600th of an 8-bit step.
fn srgb_encoded(linear: vec3f) -> vec3f {
    let q = sqrt(sqrt(linear));
    let lower = -0.06134022 + q * (0.16202632 + q * 1.2554042);
    let curved = lower + q * q * q * (-0.57748237 + q * (0.28953271 - q * 0.06814721));
    return select(curved, 12.92 * linear, linear <= vec3f(0.0031308));
}
