// The environment behind everything. Needs lighting.wgsl and surroundings.wgsl.

override ENCODED: bool = false;        // the target takes bytes as they are: the sRGB curve is the shader's

struct Sky {
    @builtin(position) clip: vec4f,
    @location(0) at: vec2f,            // -1 to 1 over the picture
}

// One triangle around the picture.
@vertex
fn vs_sky(@builtin(vertex_index) number: u32) -> Sky {
    let at = vec2f(select(-1.0, 3.0, number == 1u), select(-1.0, 3.0, number == 2u));
    return Sky(vec4f(at, 0.0, 1.0), at);
}

@fragment
fn fs_sky(in: Sky) -> @location(0) vec4f {
    let way = environment_direction(vec3f(in.at * around.way.xy + around.way.zw, -1.0));
    let color = around.strength * surroundings_at(way, around.sky_level);
    if ENCODED {
        return vec4f(srgb_encoded(clamp(color, vec3f(0.0), vec3f(1.0))), 1.0);
    }
    return vec4f(color, 1.0);
}
