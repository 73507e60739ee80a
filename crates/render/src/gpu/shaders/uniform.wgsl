// One record, and all lights of a scene with few, at fixed places. Needs records.wgsl and what that needs.

@group(0) @binding(1) var<uniform> surfaces: array<Surface, 1>;
@group(0) @binding(2) var<uniform> lights: array<Light, 8>;

fn add_counted(p: vec3f, n: vec3f, material: Material, terms: Terms) -> Irradiance {
    let v = view_vector(p, n);
    var sum = Irradiance();
    for (var i = 0u; i < LIGHTS; i++) {
        sum = plus(sum, any_light(lights[i], p, n, v, material, terms));
    }
    return sum;
}

// Lists are in storage.
fn add_listed(sum: Irradiance, p: vec3f, n: vec3f, material: Material, range: vec2u, terms: Terms) -> Irradiance {
    return sum;
}
