// Images at a fragment, and what they do to its normal. Needs mesh.wgsl.

// The lookup of the image of each kind in halfway_texture, as MapLook::bits has it; NO_MAP if there is none.
const NO_MAP: u32 = 65535;
override COLOR_MAP: u32 = 65535;
override SPECULAR_MAP: u32 = 65535;
override EMISSION_MAP: u32 = 65535;
override OPACITY_MAP: u32 = 65535;
override SHININESS_MAP: u32 = 65535;
override OCCLUSION_MAP: u32 = 65535;
override NORMAL_MAP: u32 = 65535;
override HEIGHT_MAP: u32 = 65535;
override TOKSVIG: bool = false;        // highlights take how long the mean of the normals of an image is
// LEAN, of lighting.wgsl: highlights take the spread of the slopes of an image's normals. NORMAL_MAP then looks up two
// images: the slopes in place of the normals, and in place of the heights their products.
override MASKED: bool = false;         // what has an opacity below the cutoff is not there
override TANGENT_SIGN: f32 = 1;        // -1 where the surface is lit inside out
override BITANGENT_SIGN: f32 = 1;      // -1 where fronts wind clockwise

// The transform from the mesh's coordinates to an image's, and the positions of its levels. All of them lie in one
// texture without levels, one after the other, in rows as wide as the texture: software adapters load from one level
// for four pixels at once.
struct Placing {
    row0: vec4f,                    // w: how much the image counts
    row1: vec4f,
    levels: vec4u,                  // how many, and the width of the texture
    level: array<vec4u, 14>,        // the number of the first texel, columns, rows
}

struct Placings {
    cutoff: vec4f,                  // the first of them
    each: array<Placing, 8>,
}

@group(1) @binding(0) var<uniform> placings: Placings;
@group(1) @binding(1) var color_image: texture_2d<f32>;
@group(1) @binding(2) var specular_image: texture_2d<f32>;
@group(1) @binding(3) var emission_image: texture_2d<f32>;
@group(1) @binding(4) var opacity_image: texture_2d<f32>;
@group(1) @binding(5) var shininess_image: texture_2d<f32>;
@group(1) @binding(6) var occlusion_image: texture_2d<f32>;
@group(1) @binding(7) var normal_image: texture_2d<f32>;
@group(1) @binding(8) var height_image: texture_2d<f32>;

// Numbers that an image is looked up by: filters 0 nearest, 1 bilinear, 2 B-spline, 3 Catmull-Rom; levels 0 none, 1 the
// nearest, 2 two of them; beyond the image 0 the image again, 1 mirrored, 2 its edge.
fn magnify_of(look: u32) -> u32 {
    return look & 3u;
}
fn minify_of(look: u32) -> u32 {
    return look >> 2u & 3u;
}
fn levels_of(look: u32) -> u32 {
    return look >> 4u & 3u;
}
fn wrap_of(look: u32) -> vec2u {
    return vec2u(look >> 6u & 3u, look >> 8u & 3u);
}
fn channel_of(look: u32, texel: vec4f) -> f32 {
    return texel[look >> 10u & 3u];
}
fn takes_second(look: u32) -> bool {
    return (look >> 12u & 1u) == 1u;
}

// ---- the image at a point: twins of halfway_texture::lookup -------------------------------------

// A coordinate in texels: taken into the image, or where it ends to within two texels of it.
fn wrapped(u: f32, side: f32, wrap: u32) -> f32 {
    if wrap == 0u {
        return (u - floor(u)) * side;
    }
    if wrap == 1u {
        let there_and_back = u - 2.0 * floor(0.5 * u);
        return side * select(there_and_back, 2.0 - there_and_back, there_and_back > 1.0);
    }
    return clamp(u * side, -2.0, side + 2.0);
}

// Of 0 and above alone: the remainder of negative numbers is not one number on all drivers.
fn remainder(at: i32, side: i32) -> i32 {
    let below = at < 0;
    let rest = select(at, -1 - at, below) % side;
    return select(rest, side - 1 - rest, below);
}

fn wrapped_index(at: i32, side: i32, wrap: u32) -> i32 {
    if wrap == 0u {
        return remainder(at, side);
    }
    if wrap == 1u {
        let there_and_back = remainder(at, 2 * side);
        return min(there_and_back, 2 * side - 1 - there_and_back);
    }
    return clamp(at, 0, side - 1);
}

// The weights of the texels around a point, at the part f of the way between two of them.
fn texel_weights(f: f32, filter_kind: u32) -> vec4f {
    let g = 1.0 - f;
    if filter_kind == 2u {
        return vec4f(g * g * g, (3.0 * f - 6.0) * f * f + 4.0, ((-3.0 * f + 3.0) * f + 3.0) * f + 1.0, f * f * f) / 6.0;
    }
    if filter_kind == 3u {
        return 0.5 * vec4f(
            ((2.0 - f) * f - 1.0) * f, (3.0 * f - 5.0) * f * f + 2.0, ((4.0 - 3.0 * f) * f + 1.0) * f, (f - 1.0) * f * f,
        );
    }
    return vec4f(0.0, g, f, 0.0);
}

fn texel_of(image: texture_2d<f32>, slot: u32, level: vec4u, at: vec2i) -> vec4f {
    let number = level.x + u32(at.y) * level.y + u32(at.x);
    let width = placings.each[slot].levels.y;
    return textureLoad(image, vec2u(number % width, number / width), 0);
}

fn in_image(image: texture_2d<f32>, slot: u32, level: vec4u, wrap: vec2u, uv: vec2f, filter_kind: u32) -> vec4f {
    let size = vec2i(level.yz);
    let texels = vec2f(wrapped(uv.x, f32(size.x), wrap.x), wrapped(uv.y, f32(size.y), wrap.y));
    if filter_kind == 0u {
        return texel_of(image, slot, level, clamp(vec2i(floor(texels)), vec2i(0), size - 1));
    }
    let first = floor(texels - 0.5);
    let part = texels - 0.5 - first;
    let columns = texel_weights(part.x, filter_kind);
    let rows = texel_weights(part.y, filter_kind);
    var low = 0;
    var high = 4;
    if filter_kind == 1u {
        low = 1;
        high = 3;
    }
    var sum = vec4f();
    for (var y = low; y < high; y++) {
        let row = wrapped_index(i32(first.y) + y - 1, size.y, wrap.y);
        for (var x = low; x < high; x++) {
            let column = wrapped_index(i32(first.x) + x - 1, size.x, wrap.x);
            sum += rows[y] * columns[x] * texel_of(image, slot, level, vec2i(column, row));
        }
    }
    return sum;
}

fn in_level(image: texture_2d<f32>, slot: u32, wrap: vec2u, uv: vec2f, number: u32, filter_kind: u32) -> vec4f {
    return in_image(image, slot, placings.each[slot].level[number], wrap, uv, filter_kind);
}

fn at_level(image: texture_2d<f32>, slot: u32, look: u32, uv: vec2f, d: f32) -> vec4f {
    let wrap = wrap_of(look);
    let minify = minify_of(look);
    if !(d > 0.0) {
        return in_level(image, slot, wrap, uv, 0u, magnify_of(look));
    }
    if levels_of(look) == 0u {
        return in_level(image, slot, wrap, uv, 0u, minify);
    }
    let last = f32(placings.each[slot].levels.x - 1u);
    if levels_of(look) == 1u {
        return in_level(image, slot, wrap, uv, u32(min(floor(d + 0.5), last)), minify);
    }
    let level = min(d, last);
    let finer = floor(level);
    let a = in_level(image, slot, wrap, uv, u32(finer), minify);
    if level == finer {
        return a;
    }
    return mix(a, in_level(image, slot, wrap, uv, u32(finer) + 1u, minify), level - finer);
}

// The derivatives of a number along u and v: the difference half a texel of the level to either side.
fn gradient(image: texture_2d<f32>, slot: u32, look: u32, uv: vec2f, d: f32) -> vec2f {
    var texel = 1.0;
    if levels_of(look) != 0u && d > 0.0 {
        texel = exp2(min(d, f32(placings.each[slot].levels.x - 1u)));
    }
    let across = texel / vec2f(placings.each[slot].level[0].yz);
    let u = vec2f(0.5 * across.x, 0.0);
    let v = vec2f(0.0, 0.5 * across.y);
    let along_u = channel_of(look, at_level(image, slot, look, uv + u, d) - at_level(image, slot, look, uv - u, d));
    let along_v = channel_of(look, at_level(image, slot, look, uv + v, d) - at_level(image, slot, look, uv - v, d));
    return vec2f(along_u, along_v) / across;
}

// ---- where a fragment lies -----------------------------------------------------------------------

// Both sets of coordinates, and their differences from a pixel to the next, along x and along y.
struct Coordinates {
    uv: vec4f,
    dx: vec4f,
    dy: vec4f,
}

// `at` are the coordinates at the pixel's center, w that of clip space there. at/w and 1/w are linear over the
// picture, so that their differences are their derivatives; the rule of quotients has those of the coordinates.
fn coordinates(uv: vec4f, at: vec4f, w: f32) -> Coordinates {
    let over_w = at / w;
    let dx = dpdx(over_w) - at * dpdx(1.0 / w);
    let dy = dpdy(over_w) - at * dpdy(1.0 / w);
    return Coordinates(uv, dx * w, dy * w);
}

fn of_set(look: u32, both: vec4f) -> vec2f {
    return select(both.xy, both.zw, takes_second(look));
}

// A difference of the mesh's coordinates as one of an image's.
fn way_on(slot: u32, way: vec2f) -> vec2f {
    return vec2f(dot(placings.each[slot].row0.xy, way), dot(placings.each[slot].row1.xy, way));
}

// Numbers outside the range count as 0.
fn place_on(slot: u32, look: u32, c: Coordinates) -> vec2f {
    let at = way_on(slot, of_set(look, c.uv)) + vec2f(placings.each[slot].row0.z, placings.each[slot].row1.z);
    return select(vec2f(), at, abs(at) <= vec2f(3.4e38));
}

// D = log2 of the longer side of the footprint.
fn level_on(slot: u32, look: u32, c: Coordinates) -> f32 {
    let size = vec2f(placings.each[slot].level[0].yz);
    let x = way_on(slot, of_set(look, c.dx)) * size;
    let y = way_on(slot, of_set(look, c.dy)) * size;
    return 0.5 * log2(max(dot(x, x), dot(y, y)));
}

// ---- twins of halfway_lighting::equations ----------------------------------------------------------

fn mapped_normal(n: vec3f, t: vec3f, w: f32, texel: vec3f, s: f32, otherwise: vec3f) -> vec3f {
    let x = 2.0 * texel - 1.0;
    let sum = t * (x.x * s) + cross(n, t) * (w * x.y * s) + n * x.z;
    // By its largest number first, so that squares stay numbers.
    let largest = max(max(abs(sum.x), abs(sum.y)), abs(sum.z));
    let turned = normalize_or_zero(sum / max(largest, 1e-30));
    return select(otherwise, turned, length(n) > NORMAL_MIN && dot(turned, turned) > 0.0);
}

fn lobe_axes(n: vec3f, t: vec3f, w: f32) -> mat2x3f {
    let along = normalize_or_zero(t - n * dot(n, t));
    return mat2x3f(along, w * cross(n, along));
}

fn bumped_normal(n: vec3f, m: vec3f, e1: vec3f, e2: vec3f, rises: vec2f, otherwise: vec3f) -> vec3f {
    let size = length(n);
    if size <= NORMAL_MIN {
        return otherwise;
    }
    let unit = n / size;
    let up = m / size;
    let area = dot(unit, cross(e1, e2));
    if area == 0.0 {
        return otherwise;
    }
    let g = cross(e2, unit) * (rises.x / area) + cross(unit, e1) * (rises.y / area);
    let turned = normalize_or_zero(unit * (1.0 + dot(g, up)) - g * dot(unit, up));
    return select(otherwise, turned, dot(turned, turned) > 0.0);
}

// ---- twins of halfway_texture::normals --------------------------------------------------------------

fn mean_length(texel: vec3f, s: f32) -> f32 {
    let found = length(2.0 * texel - 1.0);
    return select(found / max(found + s * s * (1.0 - found), MIN_POSITIVE), 1.0, found >= 1.0);
}

fn slope_covariance(mean: vec2f, squares: vec3f, s: f32) -> vec3f {
    let within = clamp(s, -1e6, 1e6);
    let xx = max(squares.x - mean.x * mean.x, 0.0);
    let yy = max(squares.z - mean.y * mean.y, 0.0);
    return within * within * vec3f(xx, squares.y - mean.x * mean.y, yy);
}

fn spread_length(covariance: vec3f) -> f32 {
    return 1.0 / (1.0 + 0.5 * (covariance.x + covariance.z));
}

fn lean_lobe(covariance: vec3f, s: f32) -> vec4f {
    let wide = clamp(s * covariance, vec3f(-1e12), vec3f(1e12));
    let xx = wide.x + 1.0;
    let yy = wide.z + 1.0;
    let determinant = max(xx * yy - wide.y * wide.y, xx + yy - 1.0);
    return vec4f(s / determinant * vec3f(yy, -wide.y, xx), inverseSqrt(determinant));
}

fn toksvig(mean: f32, exponent: f32) -> vec2f {
    let within = clamp(mean, 0.0, 1.0);
    let f = within / max(within + exponent * (1.0 - within), MIN_POSITIVE);
    return vec2f(f * exponent, (1.0 + f * exponent) / (1.0 + exponent));
}
