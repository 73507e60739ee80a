// An image at a fragment where its filter goes by D alone. Needs maps.wgsl.

fn at_footprint(image: texture_2d<f32>, slot: u32, look: u32, c: Coordinates) -> vec4f {
    return at_level(image, slot, look, place_on(slot, look, c), level_on(slot, look, c));
}
