// Policies for a finished picture whose intensities exceed 1. Each function has a twin of the same name in
// `halfway_lighting::equations`.

// The largest argument of `aces`, which reaches 1 at 7.25. More would overflow its squares.
const ACES_WHITE: f32 = 8.0;

// The divisor of a picture whose largest channel is `largest`.
fn divisor(largest: f32, before: f32, smoothing: f32) -> f32 {
    let plain = max(largest, 1.0);
    return plain + smoothing * (before - plain);
}

// The quotient first: it is below 1, so that nothing overflows that the result does not.
fn reinhard(i: vec3f, per_white: f32) -> vec3f {
    return i / (1.0 + i) * (1.0 + i * per_white);
}

fn aces(intensity: vec3f) -> vec3f {
    let i = min(intensity, vec3f(ACES_WHITE));
    return min(i * (2.51 * i + 0.03) / (i * (2.43 * i + 0.59) + 0.14), vec3f(1.0));
}
