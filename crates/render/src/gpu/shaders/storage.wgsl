// Any number of records and lights. Needs lighting.wgsl and records.wgsl. Not uniform: lavapipe compiles a shader anew
// for every value that a loop's end or a condition takes from a uniform buffer.

@group(0) @binding(1) var<storage, read> surfaces: array<Surface>;
// All lights of the scene by kind: directional, point, spot.
@group(0) @binding(2) var<storage, read> lights: array<Light>;
@group(0) @binding(3) var<storage, read> lists: array<u32>;

fn light_numbered(i: u32) -> Light {
    if LISTED {
        return lights[lists[i]];
    }
    return lights[i];
}

// Adds `counts` lights of each kind, the numbers from `counts.w` on.
fn add_listed(before: Irradiance, p: vec3f, n: vec3f, shininess: f32, counts: vec4u, terms: Terms) -> Irradiance {
    let v = view_vector(p, n);
    var sum = before;
    let first_point = counts.w + counts.x;
    let first_spot = first_point + counts.y;
    for (var i = counts.w; i < first_point; i++) {
        let light = light_numbered(i);
        sum = plus(sum, irradiance(light, Incidence(light.position, GRAZING, 1.0), n, v, shininess, terms));
    }
    for (var i = first_point; i < first_spot; i++) {
        let light = light_numbered(i);
        sum = plus(sum, irradiance(light, incidence(light, false, p, n), n, v, shininess, terms));
    }
    for (var i = first_spot; i < first_spot + counts.z; i++) {
        let light = light_numbered(i);
        sum = plus(sum, irradiance(light, incidence(light, true, p, n), n, v, shininess, terms));
    }
    return sum;
}

fn add_counted(p: vec3f, n: vec3f, shininess: f32, terms: Terms) -> Irradiance {
    return add_listed(Irradiance(), p, n, shininess, vec4u(DIRECTIONAL, POINTS, SPOTS, 0), terms);
}
