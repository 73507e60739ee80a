// Up to 16 directional lights, 32 points and 16 spots. Needs uniform.wgsl. A driver spends time and memory on what a
// pipeline leaves unused, so few lights have a shorter text, few.wgsl.

fn add_counted(p: vec3f, n: vec3f, shininess: f32, terms: Terms) -> Irradiance {
    let v = view_vector(p, n);
    var sum = add_directional(Irradiance(), 0u, p, n, v, shininess, terms);
    sum = add_directional(sum, 8u, p, n, v, shininess, terms);
    sum = add_four(sum, DIRECTIONAL, POINTS, 0u, false, p, n, v, shininess, terms);
    sum = add_four(sum, DIRECTIONAL, POINTS, 4u, false, p, n, v, shininess, terms);
    sum = add_four(sum, DIRECTIONAL, POINTS, 8u, false, p, n, v, shininess, terms);
    sum = add_four(sum, DIRECTIONAL, POINTS, 12u, false, p, n, v, shininess, terms);
    sum = add_four(sum, DIRECTIONAL, POINTS, 16u, false, p, n, v, shininess, terms);
    sum = add_four(sum, DIRECTIONAL, POINTS, 20u, false, p, n, v, shininess, terms);
    sum = add_four(sum, DIRECTIONAL, POINTS, 24u, false, p, n, v, shininess, terms);
    sum = add_four(sum, DIRECTIONAL, POINTS, 28u, false, p, n, v, shininess, terms);
    let spots = DIRECTIONAL + POINTS;
    sum = add_four(sum, spots, SPOTS, 0u, true, p, n, v, shininess, terms);
    sum = add_four(sum, spots, SPOTS, 4u, true, p, n, v, shininess, terms);
    sum = add_four(sum, spots, SPOTS, 8u, true, p, n, v, shininess, terms);
    sum = add_four(sum, spots, SPOTS, 12u, true, p, n, v, shininess, terms);
    return sum;
}
