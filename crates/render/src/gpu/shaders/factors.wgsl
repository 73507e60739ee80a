// Images at a fragment, and their factors. Needs by_level.wgsl or by_shape.wgsl.

fn filtered(image: texture_2d<f32>, slot: u32, look: u32, c: Coordinates) -> vec4f {
    return clamp(at_footprint(image, slot, look, c), vec4f(), vec4f(1.0));
}

// The factor of an image: 1 + a(t - 1).
fn factor(image: texture_2d<f32>, slot: u32, look: u32, c: Coordinates) -> vec4f {
    return 1.0 + placings.each[slot].row0.w * (filtered(image, slot, look, c) - 1.0);
}
