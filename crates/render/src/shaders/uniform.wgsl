// One record and lights at fixed places: a software adapter reads them once for eight pixels. Needs lighting.wgsl and
// records.wgsl.

@group(0) @binding(1) var<uniform> draws: array<Draw, 1>;
@group(0) @binding(2) var<uniform> lights: array<Light, 64>;

// The terms of the i-th of `count` lights of one kind.
fn of_first(terms: Terms, i: u32, count: u32) -> Terms {
    return Terms(terms.diffuse, terms.specular && i < HIGHLIGHTS * count / 2u);
}

// Adds the directional lights of the numbers `start` to `start` + 7. Numbers count from the stage's first.
fn add_directional(
    before: Irradiance, start: u32, p: vec3f, n: vec3f, v: vec3f, shininess: f32, terms: Terms,
) -> Irradiance {
    var sum = before;
    for (var i = start; i < min(DIRECTIONAL, start + 8u); i++) {
        let incident = Incidence(lights[FIRST + i].position, GRAZING, 1.0);
        sum = plus(sum, irradiance(lights[FIRST + i], incident, n, v, shininess, of_first(terms, i, DIRECTIONAL)));
    }
    return sum;
}

// Adds those of the numbers `start` to `start` + 3 among the `count` points or spots that begin at `first`. The driver
// unrolls a loop as long as what comes out is short, and reads at fixed places only in unrolled ones: many lights are
// several loops. The numbers are constants wherever this is called.
fn add_four(
    before: Irradiance, first: u32, count: u32, start: u32, cone: bool,
    p: vec3f, n: vec3f, v: vec3f, shininess: f32, terms: Terms,
) -> Irradiance {
    var sum = before;
    for (var i = first + start; i < first + min(count, start + 4u); i++) {
        let incident = incidence(lights[FIRST + i], cone, p, n);
        sum = plus(sum, irradiance(lights[FIRST + i], incident, n, v, shininess, of_first(terms, i - first, count)));
    }
    return sum;
}

// Lists are in storage.
fn add_listed(sum: Irradiance, p: vec3f, n: vec3f, shininess: f32, counts: vec4u, terms: Terms) -> Irradiance {
    return sum;
}
