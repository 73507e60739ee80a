// One record and lights at fixed places: a software adapter reads them once for eight pixels.

@group(0) @binding(1) var<uniform> draws: array<Draw, 1>;
@group(0) @binding(2) var<uniform> lights: array<Light, MOST_LIGHTS>;

// The terms of the i-th of `count` lights of one kind.
fn of_first(terms: Terms, i: u32, count: u32) -> Terms {
    return Terms(terms.diffuse, terms.specular && i < HIGHLIGHTS * count / 2u);
}

// The driver unrolls a loop as long as what comes out is short, and reads at fixed places only in unrolled ones: so many
// lights are several loops.
fn add_counted(p: vec3f, n: vec3f, shininess: f32, terms: Terms) -> Irradiance {
    let v = to_viewer(p, n, terms);
    var sum = Irradiance();
    for (var i = 0u; i < DIRECTIONAL; i++) {
        sum = add_light(sum, lights[i], lights[i].position, 1.0, n, v, shininess, of_first(terms, i, DIRECTIONAL));
    }
POINT_LOOPS
SPOT_LOOPS
    return sum;
}

// Lists are in storage.
fn add_listed(sum: Irradiance, p: vec3f, n: vec3f, shininess: f32, counts: vec4u, terms: Terms) -> Irradiance {
    return sum;
}
