// The environment of a scene, looked up. Needs environment.wgsl.

// Its levels lie in one texture without levels, one after the other, in rows as wide as the texture. Each is six faces
// with a border of one texel.
struct Surroundings {
    row0: vec4f,                    // from eye space to the environment
    row1: vec4f,
    row2: vec4f,
    mean: array<vec3f, 9>,          // see mean_light
    strength: f32,
    first_angle: f32,               // log2 of the angle of the first level's texels
    sky_level: f32,
    width: u32,                     // of the texture
    way: vec4f,                     // x and y of the ray through the picture's top right corner, at depth 1
    levels: vec4u,                  // how many
    level: array<vec4u, 12>,        // the number of the first texel, and texels along a face
}

@group(2) @binding(0) var<uniform> around: Surroundings;
@group(2) @binding(1) var surroundings_image: texture_2d<f32>;

fn environment_direction(d: vec3f) -> vec3f {
    return vec3f(dot(around.row0.xyz, d), dot(around.row1.xyz, d), dot(around.row2.xyz, d));
}

fn surroundings_texel(number: u32) -> vec3f {
    return textureLoad(surroundings_image, vec2u(number % around.width, number / around.width), 0).rgb;
}

fn surroundings_in_level(place: vec3f, number: u32) -> vec3f {
    let level = around.level[number];
    let width = level.y + 2u;
    // The border's texel has the number 0.
    let at = place.xy * f32(level.y) + 0.5;
    let first = min(vec2u(at), vec2u(level.y));
    let part = at - vec2f(first);
    let texel = level.x + (u32(place.z) * width + first.y) * width + first.x;
    let above = mix(surroundings_texel(texel), surroundings_texel(texel + 1u), part.x);
    let below = mix(surroundings_texel(texel + width), surroundings_texel(texel + width + 1u), part.x);
    return mix(above, below, part.y);
}

// The light from a direction of the environment, between the two levels around this one.
fn surroundings_at(d: vec3f, level: f32) -> vec3f {
    let within = clamp(level, 0.0, f32(around.levels.x - 1u));
    let finer = floor(within);
    let place = on_cube(d);
    let a = surroundings_in_level(place, u32(finer));
    let b = surroundings_in_level(place, min(u32(finer) + 1u, around.levels.x - 1u));
    return mix(a, b, within - finer);
}

// Its light in the ambient, and to the specular part, before the material.
struct Arriving {
    mean: vec3f,
    seen: vec3f,
}

fn surroundings_of(n: vec3f, v: vec3f, alpha: f32) -> Arriving {
    let seen = surroundings_at(environment_direction(mirrored(n, v)), log2(lobe_angle(alpha)) - around.first_angle);
    return Arriving(around.strength * mean_light(around.mean, environment_direction(n)), around.strength * seen);
}
