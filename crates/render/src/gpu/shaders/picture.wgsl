// Passes over the finished picture, which stands in floating point.

struct PicturePolicy {
    // The share of the last divisor that stays.
    smoothing: f32,
    // 1 over the square of Reinhard's white point.
    per_white: f32,
    // 0: by the divisor, 1: Reinhard's curve, 2: that of ACES.
    curve: u32,
    // Whether the target takes sRGB bytes as they are.
    encoded: u32,
}

@group(0) @binding(0) var<uniform> policy: PicturePolicy;
@group(0) @binding(1) var drawn: texture_2d<f32>;
// One texel: in `next_divisor` that of the frame before, in `finished` that of this one.
@group(0) @binding(2) var divided_by: texture_2d<f32>;

// A triangle over all of the picture.
@vertex
fn whole(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return vec4f(4.0 * corner - 1.0, 0.0, 1.0);
}

// The side in texels of the block that becomes one texel.
const BLOCK: u32 = 8;
// The largest number: larger values are clamped to it.
const MOST: f32 = 3.4028234e38;

// The largest channel of a block; NaN counts as 0.
fn largest_of_block(at: vec2u) -> f32 {
    let size = textureDimensions(drawn);
    let first = at * BLOCK;
    let end = min(first + BLOCK, size);
    var found = 0.0;
    for (var y = first.y; y < end.y; y++) {
        for (var x = first.x; x < end.x; x++) {
            let i = textureLoad(drawn, vec2u(x, y), 0).rgb;
            let largest = max(max(i.r, i.g), i.b);
            found = select(found, min(largest, MOST), largest > found);
        }
    }
    return found;
}

@fragment
fn largest(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(largest_of_block(vec2u(at.xy)));
}

@fragment
fn next_divisor(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let before = textureLoad(divided_by, vec2u(), 0).r;
    return vec4f(divisor(largest_of_block(vec2u(at.xy)), before, policy.smoothing));
}

@fragment
fn finished(@builtin(position) at: vec4f) -> @location(0) vec4f {
    var i = min(textureLoad(drawn, vec2u(at.xy), 0).rgb, vec3f(MOST));
    switch policy.curve {
        case 0u: { i /= textureLoad(divided_by, vec2u(), 0).r; }
        case 1u: { i = reinhard(i, policy.per_white); }
        default: { i = aces(i); }
    }
    if policy.encoded != 0u {
        i = srgb_encoded(clamp(i, vec3f(), vec3f(1.0)));
    }
    return vec4f(i, 1.0);
}
