// The lighting text: one for the vertex and the fragment stage. Eye space, linear RGB.
// Each function is the twin of the one of the same name in halfway_lighting::equations.

// Which of a light's terms are added; the others are shaded at the other frequency, or cannot be seen. Ambient goes
// with diffuse.
struct Terms {
    diffuse: bool,
    specular: bool,
}

struct Light {
    position: vec3f,     // finite light: eye space; directional: unit vector toward the light
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
    padding0: f32,
    padding1: vec4f,
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
}

// What reaches a point, before the material: sums over lights of colour · att · spot · factor.
struct Irradiance {
    ambient: vec3f,
    diffuse: vec3f,
    specular: vec3f,
}

const MAX_ATTENUATION: f32 = 1e6;
// Below this |l + v|² (an angle of 1e-6 rad from l = −v) the half vector is rounding noise: S = 0.
const HALF_VECTOR_EPSILON: f32 = 1e-12;
const SMALLEST_NORMAL: f32 = 1.17549435e-38;

// base^exponent for base in 0..1, with 0⁰ = 1, which pow leaves indeterminate.
fn power(base: f32, exponent: f32) -> f32 {
    return select(pow(base, exponent), select(0.0, 1.0, exponent == 0.0), base <= 0.0);
}

// x^(2^squarings): an exponent that is a power of two takes no logarithm.
fn square(x: f32, squarings: i32) -> f32 {
    var result = x;
    for (var i = 0; i < squarings; i++) {
        result *= result;
    }
    return result;
}

fn attenuation(d: f32, light: Light) -> f32 {
    let denominator = light.constant + d * (light.linear + d * light.quadratic);
    return 1.0 / max(denominator, 1.0 / MAX_ATTENUATION);
}

// KHR_lights_punctual: clamp(1 − (d/R)⁴, 0, 1)².
fn range_window(d: f32, inverse_range: f32) -> f32 {
    let t = d * inverse_range;
    let w = clamp(1.0 - t * t * t * t, 0.0, 1.0);
    return w * w;
}

fn spot_factor(l: vec3f, light: Light) -> f32 {
    let cos_phi = min(-dot(l, light.direction), 1.0);
    let inner = clamp(cos_phi * light.inner_scale + light.inner_offset, 0.0, 1.0);
    let falloff = power(max(cos_phi, 0.0), light.exponent) * inner * inner;
    return select(0.0, falloff, cos_phi >= light.cos_cutoff);
}

// (v·r)^α with r = 2(n·l)n − l.
fn specular_phong(n: vec3f, l: vec3f, v: vec3f, alpha: f32) -> f32 {
    let cos_r = clamp(2.0 * dot(n, l) * dot(n, v) - dot(l, v), 0.0, 1.0);
    if SQUARINGS >= 0 {
        return square(cos_r, SQUARINGS);
    }
    return power(cos_r, alpha);
}

// (n·h)^β with h = (l + v)/‖l + v‖, as ((n·(l + v))²/‖l + v‖²)^(β/2), which needs no square root.
fn specular_blinn_phong(n: vec3f, l: vec3f, v: vec3f, beta: f32) -> f32 {
    let sum = l + v;
    let squared = dot(sum, sum);
    let n_dot_sum = max(dot(n, sum), 0.0);
    let cos_squared = min(n_dot_sum * n_dot_sum / max(squared, HALF_VECTOR_EPSILON), 1.0);
    var s: f32;
    if SQUARINGS >= 1 {
        s = square(cos_squared, SQUARINGS - 1);
    } else {
        s = power(cos_squared, 0.5 * beta);
    }
    return select(0.0, s, squared > HALF_VECTOR_EPSILON);
}

// Adds one light that arrives from l with strength `arriving` (att · spot).
fn add_light(sum: Irradiance, light: Light, l: vec3f, arriving: f32, n: vec3f, v: vec3f, shininess: f32, terms: Terms) -> Irradiance {
    var result = sum;
    let n_dot_l = dot(n, l);
    if terms.diffuse {
        result.diffuse += light.diffuse * (arriving * max(n_dot_l, 0.0));
    }
    if terms.specular {
        var s: f32;
        if BLINN_PHONG {
            s = specular_blinn_phong(n, l, v, shininess);
        } else {
            s = specular_phong(n, l, v, shininess);
        }
        var colour = light.specular;
        if SHARED_COLOUR {
            colour = light.diffuse;
        }
        result.specular += colour * select(0.0, arriving * s, n_dot_l > 0.0);
    }
    if ATTENUATED_AMBIENT && terms.diffuse {
        result.ambient += light.ambient * arriving;
    }
    return result;
}

// Adds a point light, or a spot when `cone` is set, at its distance.
fn add_finite_light(sum: Irradiance, light: Light, cone: bool, p: vec3f, n: vec3f, v: vec3f, shininess: f32, terms: Terms) -> Irradiance {
    let to_light = light.position - p;
    let squared = dot(to_light, to_light);
    // A light on the surface has no direction: l falls back to n.
    let at_surface = squared < SMALLEST_NORMAL;
    let inverse = inverseSqrt(max(squared, SMALLEST_NORMAL));
    let l = select(to_light * inverse, n, at_surface);
    let d = squared * inverse;
    var arriving = attenuation(d, light);
    if RANGED {
        arriving *= range_window(d, light.inverse_range);
    }
    if cone {
        arriving *= spot_factor(l, light);
    }
    return add_light(sum, light, l, arriving, n, v, shininess, terms);
}

// v: toward the eye, or (0, 0, 1) for an infinite viewer. An eye on the surface looks along n.
fn to_viewer(p: vec3f, n: vec3f, terms: Terms) -> vec3f {
    if LOCAL_VIEWER && terms.specular {
        let squared = dot(p, p);
        return select(-p * inverseSqrt(max(squared, SMALLEST_NORMAL)), n, squared < SMALLEST_NORMAL);
    }
    return vec3f(0.0, 0.0, 1.0);
}

// I = ke + ka·(Ga + Σ La) + Σ …, from what arrives.
fn reflected(arriving: Irradiance, material: Material) -> vec3f {
    return material.base + added(arriving, material);
}

// The part of I that the lights of one list add.
fn added(arriving: Irradiance, material: Material) -> vec3f {
    var sum = material.diffuse * arriving.diffuse;
    if VERTEX_SPECULAR || FRAGMENT_SPECULAR {
        sum += material.specular * arriving.specular;
    }
    if ATTENUATED_AMBIENT {
        sum += material.ambient * arriving.ambient;
    }
    return sum;
}
