// Light from all directions: twins of halfway_lighting::equations and halfway_texture::environment. Needs nothing.

fn mirrored(n: vec3f, v: vec3f) -> vec3f {
    return 2.0 * dot(n, v) * n - v;
}

// The exponent of Phong's lobe that is as wide as a highlight's.
fn lobe_exponent(blinn_phong: bool, exponent: f32) -> f32 {
    return select(exponent, 0.25 * exponent, blinn_phong);
}

fn lobe_angle(alpha: f32) -> f32 {
    return 2.0 / sqrt(alpha + 3.0);
}

// The coefficients are of 1, y, z, x, xy, yz, 3zz - 1, xz and xx - yy.
fn mean_light(c: array<vec3f, 9>, n: vec3f) -> vec3f {
    let constant = c[0] + c[1] * n.y + c[2] * n.z + c[3] * n.x;
    let mixed = c[4] * (n.x * n.y) + c[5] * (n.y * n.z) + c[7] * (n.x * n.z);
    let squares = c[6] * (3.0 * n.z * n.z - 1.0) + c[8] * (n.x * n.x - n.y * n.y);
    return max(constant + mixed + squares, vec3f());
}

// The position of a direction on its face of a cube map, and the number of the face.
fn on_cube(d: vec3f) -> vec3f {
    let a = abs(d);
    var place = vec3f(select(-d.x, d.x, d.z >= 0.0), -d.y, a.z);
    var face = select(5.0, 4.0, d.z >= 0.0);
    if a.x >= a.y && a.x >= a.z {
        place = vec3f(select(d.z, -d.z, d.x >= 0.0), -d.y, a.x);
        face = select(1.0, 0.0, d.x >= 0.0);
    } else if a.y >= a.z {
        place = vec3f(d.x, select(-d.z, d.z, d.y >= 0.0), a.y);
        face = select(3.0, 2.0, d.y >= 0.0);
    }
    // A vector of length 0 is in the middle.
    let length = select(place.z, 1.0, place.z == 0.0);
    return vec3f(0.5 * (place.xy / length + 1.0), face);
}
