// Patterns that fill space: twins of halfway_texture::noise and halfway_texture::solid. Needs nothing.

const MOST_OCTAVES: u32 = 16u;
const LEAST_WIDTH: f32 = 1e-3;

fn hash(cell: vec3u) -> vec3u {
    var v = cell * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v = v ^ (v >> vec3u(16u));
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// The product of the direction at a corner of a cell with the vector from there; f is the vector from the cell's first
// corner.
fn at_corner(cell: vec3u, f: vec3f, offset: vec3u) -> f32 {
    let number = hash(cell + offset).x >> 28u;
    let d = f - vec3f(offset);
    let u = select(d.y, d.x, number < 8u);
    let v = select(select(d.z, d.x, number == 12u || number == 14u), d.y, number < 4u);
    return select(-u, u, (number & 1u) == 0u) + select(-v, v, (number & 2u) == 0u);
}

fn gradient_noise(p: vec3f) -> f32 {
    let first = floor(p);
    let cell = bitcast<vec3u>(vec3i(first));
    let f = p - first;
    let s = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let front = mix(
        mix(at_corner(cell, f, vec3u(0u, 0u, 0u)), at_corner(cell, f, vec3u(1u, 0u, 0u)), s.x),
        mix(at_corner(cell, f, vec3u(0u, 1u, 0u)), at_corner(cell, f, vec3u(1u, 1u, 0u)), s.x), s.y,
    );
    let behind = mix(
        mix(at_corner(cell, f, vec3u(0u, 0u, 1u)), at_corner(cell, f, vec3u(1u, 0u, 1u)), s.x),
        mix(at_corner(cell, f, vec3u(0u, 1u, 1u)), at_corner(cell, f, vec3u(1u, 1u, 1u)), s.x), s.y,
    );
    return mix(front, behind, s.z);
}

// The remaining amplitude of noise that is averaged over parts so wide.
fn fade(width: f32) -> f32 {
    let t = clamp((width - 0.25) * 2.0, 0.0, 1.0);
    return 1.0 - t * t * (3.0 - 2.0 * t);
}

// Octaves that have faded out are not evaluated.
fn fractal(p: vec3f, octaves: u32, width: f32) -> f32 {
    let count = min(octaves, MOST_OCTAVES);
    var sum = 0.0;
    var frequency = 1.0;
    var amplitude = 1.0;
    var octave = 0u;
    var weight = fade(abs(width));
    while select(0.0, weight, octave < count) > 0.0 {
        sum += weight * amplitude * gradient_noise(p * frequency + f32(octave) * 0.37);
        octave += 1u;
        frequency *= 2.0;
        amplitude *= 0.5;
        weight = fade(frequency * abs(width));
    }
    return sum;
}

// The sine of an angle in turns, off by 1e-7: what WGSL has may be off by 5e-4.
fn sine_of_turns(turns: f32) -> f32 {
    let x = turns - floor(turns + 0.5);
    let y = 6.2831855 * select(select(-0.5, 0.5, x > 0.0) - x, x, abs(x) <= 0.25);
    let z = y * y;
    let series = -1.0 / 6.0 + z * (1.0 / 120.0 + z * (-1.0 / 5040.0 + z * (1.0 / 362880.0 - z / 39916800.0)));
    return y + y * z * series;
}

// The mean of a wave over a part so wide.
fn wave(t: f32, width: f32) -> f32 {
    let w = abs(width);
    let mean = sine_of_turns(0.5 * w) / max(3.1415927 * w, 1e-3);
    let contrast = select(select(mean, 1.0, 3.1415927 * w <= 1e-3), 0.0, w >= 1.0);
    return 0.5 + 0.5 * contrast * sine_of_turns(t);
}

fn marble(p: vec3f, octaves: u32, width: f32) -> f32 {
    return wave(p.x + fractal(p, octaves, width), width);
}

fn wood(p: vec3f, width: f32) -> f32 {
    let grain = 0.3 * fade(abs(width)) * gradient_noise(vec3f(p.x, 0.1 * p.y, p.z));
    return wave(sqrt(p.x * p.x + p.z * p.z) + grain, width);
}

// The place in a period of 2.
fn in_period(x: f32) -> f32 {
    return x - 2.0 * floor(0.5 * x);
}

// The mean of a wave over a box: 1 from 0 to 1, -1 from 1 to 2, and so on.
fn square_wave(x: f32, box_width: f32) -> f32 {
    let width = max(box_width, LEAST_WIDTH);
    let step_at = floor(x + 0.5);
    let narrow = (1.0 - 2.0 * in_period(step_at)) * clamp((x - step_at) / (0.5 * width), -1.0, 1.0);
    let wide = (abs(in_period(x - 0.5 * width) - 1.0) - abs(in_period(x + 0.5 * width) - 1.0)) / width;
    return select(wide, narrow, width <= 1.0);
}

fn checker(p: vec3f, widths: vec3f) -> f32 {
    let each = vec3f(
        square_wave(p.x, abs(widths.x)), square_wave(p.y, abs(widths.y)), square_wave(p.z, abs(widths.z)),
    );
    return 0.5 - 0.5 * each.x * each.y * each.z;
}

// t at a point of a solid, with the point's differences to the next pixels; kinds in the order of SolidKind.
fn solid_value(kind: u32, octaves: u32, q: vec3f, x: vec3f, y: vec3f) -> f32 {
    let width = sqrt(max(dot(x, x), dot(y, y)));
    var t = 0.0;
    if kind == 0u {
        t = checker(q + 0.5, sqrt(x * x + y * y));
    } else if kind == 1u {
        t = marble(q, octaves, width);
    } else if kind == 2u {
        t = wood(q, width);
    } else {
        t = clamp(0.5 + 0.5 * fractal(q, octaves, width), 0.0, 1.0);
    }
    // At the end of the number range, the mean.
    return select(0.5, t, abs(t) <= 1.0);
}
