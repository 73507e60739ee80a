// One record, and all lights of a scene with few, at fixed places. Needs lighting.wgsl and records.wgsl.

@group(0) @binding(1) var<uniform> surfaces: array<Surface, 1>;
@group(0) @binding(2) var<uniform> lights: array<Light, 8>;

fn add_counted(p: vec3f, n: vec3f, shininess: f32, terms: Terms) -> Irradiance {
    let v = view_vector(p, n);
    var sum = Irradiance();
    for (var i = 0u; i < DIRECTIONAL; i++) {
        sum = plus(sum, irradiance(lights[i], Incidence(lights[i].position, GRAZING, 1.0), n, v, shininess, terms));
    }
    let spots = DIRECTIONAL + POINTS;
    for (var i = DIRECTIONAL; i < spots; i++) {
        sum = plus(sum, irradiance(lights[i], incidence(lights[i], false, p, n), n, v, shininess, terms));
    }
    for (var i = spots; i < spots + SPOTS; i++) {
        sum = plus(sum, irradiance(lights[i], incidence(lights[i], true, p, n), n, v, shininess, terms));
    }
    return sum;
}

// Lists are in storage.
fn add_listed(sum: Irradiance, p: vec3f, n: vec3f, shininess: f32, counts: vec4u, terms: Terms) -> Irradiance {
    return sum;
}
