// Up to 8 points and 8 spots. Needs uniform.wgsl.

fn add_counted(p: vec3f, n: vec3f, shininess: f32, terms: Terms) -> Irradiance {
    let v = view_vector(p, n);
    var sum = add_directional(Irradiance(), 0u, p, n, v, shininess, terms);
    sum = add_four(sum, DIRECTIONAL, POINTS, 0u, false, p, n, v, shininess, terms);
    sum = add_four(sum, DIRECTIONAL, POINTS, 4u, false, p, n, v, shininess, terms);
    let spots = DIRECTIONAL + POINTS;
    sum = add_four(sum, spots, SPOTS, 0u, true, p, n, v, shininess, terms);
    sum = add_four(sum, spots, SPOTS, 4u, true, p, n, v, shininess, terms);
    return sum;
}
