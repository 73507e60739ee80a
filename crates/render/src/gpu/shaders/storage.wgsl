// Any number of records and lights. Needs records.wgsl and what that needs. Not uniform: lavapipe compiles a shader anew
// for every value that a loop's end or a condition takes from a uniform buffer.

@group(0) @binding(1) var<storage, read> surfaces: array<Surface>;
// All lights of the scene that lists name.
@group(0) @binding(2) var<storage, read> lights: array<Light>;
@group(0) @binding(3) var<storage, read> lists: array<u32>;

fn light_numbered(i: u32) -> Light {
    if LISTED {
        return lights[lists[i]];
    }
    return lights[i];
}

// Adds the lights of a range of `lists`.
fn add_listed(before: Irradiance, p: vec3f, n: vec3f, shininess: f32, range: vec2u, terms: Terms) -> Irradiance {
    let v = view_vector(p, n);
    var sum = before;
    for (var i = range.x; i < range.x + range.y; i++) {
        sum = plus(sum, any_light(light_numbered(i), p, n, v, shininess, terms));
    }
    return sum;
}

fn add_counted(p: vec3f, n: vec3f, shininess: f32, terms: Terms) -> Irradiance {
    return add_listed(Irradiance(), p, n, shininess, vec2u(0, LIGHTS), terms);
}
