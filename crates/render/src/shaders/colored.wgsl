// The entry points of draws whose vertices have colors: these multiply the ambient and diffuse reflectance, and the
// opacity. Needs mesh.wgsl.

struct Vertex {
    @location(6) position: vec3f,
    @location(7) normal: vec3f,
    @location(10) color: vec4f,      // linear, each channel from 0 to 1
}

// ke + color·(ambient and diffuse terms) + the specular ones, and the opacity.
fn tinted(arriving: Irradiance, material: Material, emission: vec3f, color: vec4f) -> vec4f {
    let sum = emission + color.rgb * material.base + tinted_terms(arriving, material, color.rgb);
    return vec4f(sum, material.opacity * color.a);
}

fn tinted_terms(arriving: Irradiance, material: Material, color: vec3f) -> vec3f {
    var sum = color * material.diffuse * arriving.diffuse;
    if ATTENUATED_AMBIENT {
        sum += color * material.ambient * arriving.ambient;
    }
    if SPECULAR {
        sum += material.specular * arriving.specular;
    }
    return sum;
}

fn tinted_front(p: vec3f, n: vec3f, color: vec4f, record: u32) -> vec4f {
    let arriving = vertex_terms(p, n, draws[record].front.shininess, record);
    return tinted(arriving, draws[record].front, draws[record].front_emission, color);
}

fn tinted_back(p: vec3f, n: vec3f, color: vec4f, record: u32) -> vec4f {
    let arriving = vertex_terms(p, n, draws[record].back.shininess, record);
    return tinted(arriving, draws[record].back, draws[record].back_emission, color);
}

fn output(shade: vec4f) -> vec4f {
    return vec4f(written(shade.rgb), select(1.0, shade.a, BLEND));
}

// ---- flat: the color is that of the centroid ----------------------------------------------------

struct FlatVertex {
    @location(6) position: vec3f,
    @location(7) normal: vec3f,
    @location(8) centroid: vec3f,
    @location(10) color: vec4f,
}

struct Flat {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat, first) shade: vec4f,
}

@vertex
fn vs_flat(object: Object, vertex: FlatVertex) -> Flat {
    let p = eye_position(object, vertex.centroid);
    let n = eye_normal(object, vertex.normal);
    let record = record_of(object.record);
    var shade: vec4f;
    if !TWO_SIDED || dot(n, p) <= 0.0 {
        shade = tinted_front(p, n, vertex.color, record);
    } else {
        shade = tinted_back(p, -n, vertex.color, record);
    }
    return Flat(clip_position(eye_position(object, vertex.position)), shade);
}

@fragment
fn fs_flat(in: Flat) -> @location(0) vec4f {
    return output(in.shade);
}

// ---- no term at the fragments: Gouraud, or no lights --------------------------------------------

struct Gouraud {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(perspective, centroid) front: vec4f,
    @location(1) @interpolate(perspective, centroid) back: vec4f,
}

@vertex
fn vs_gouraud(object: Object, vertex: Vertex) -> Gouraud {
    let p = eye_position(object, vertex.position);
    let n = eye_normal(object, vertex.normal);
    let record = record_of(object.record);
    var back = vec4f();
    if TWO_SIDED {
        back = tinted_back(p, -n, vertex.color, record);
    }
    return Gouraud(clip_position(p), tinted_front(p, n, vertex.color, record), back);
}

@fragment
fn fs_gouraud(in: Gouraud, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let shade = select(in.back, in.front, front || !TWO_SIDED);
    return output(vec4f(interpolated(shade.rgb), clamp(shade.a, 0.0, 1.0)));
}

// ---- some term at the fragments: Phong, or mixed ------------------------------------------------

struct Mixed {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(perspective, centroid) p: vec3f,
    @location(1) @interpolate(perspective, centroid) n: vec3f,
    @location(2) @interpolate(perspective, centroid) color: vec4f,
    @location(3) @interpolate(perspective, centroid) front: vec3f,   // the terms of the vertices, of either side
    @location(4) @interpolate(perspective, centroid) back: vec3f,
    @location(5) @interpolate(flat, either) record: u32,
}

@vertex
fn vs_mixed(object: Object, vertex: Vertex) -> Mixed {
    let p = eye_position(object, vertex.position);
    let n = eye_normal(object, vertex.normal);
    let record = record_of(object.record);
    let color = vertex.color;
    var front = vec3f();
    var back = vec3f();
    if VERTEX_DIFFUSE || VERTEX_SPECULAR {
        let terms = vertex_terms(p, n, draws[record].front.shininess, record);
        front = tinted_terms(terms, draws[record].front, color.rgb);
        if TWO_SIDED {
            let behind = vertex_terms(p, -n, draws[record].back.shininess, record);
            back = tinted_terms(behind, draws[record].back, color.rgb);
        }
    }
    return Mixed(clip_position(p), p, n, color, front, back, object.record);
}

@fragment
fn fs_mixed(in: Mixed, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let n = fragment_normal(in.p, in.n, front);
    let record = record_of(in.record);
    let color = clamp(in.color, vec4f(), vec4f(1.0));
    var material = draws[record].front;
    var emission = draws[record].front_emission;
    var of_vertices = in.front;
    var side = n;
    if TWO_SIDED && !front {
        material = draws[record].back;
        emission = draws[record].back_emission;
        of_vertices = in.back;
        side = -n;
    }
    let terms = fragment_terms(in.p, side, material.shininess, record);
    let shade = tinted(terms, material, emission, color);
    return output(vec4f(shade.rgb + interpolated(of_vertices), shade.a));
}
