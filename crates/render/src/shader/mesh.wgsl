// Bindings, specialisation and the entry points: one pair for each frequency of a draw's terms.

// What a draw does not use is not in its pipeline.
override SPECULAR: bool = true;
override BLINN_PHONG: bool = true;
override LOCAL_VIEWER: bool = true;
override ATTENUATED_AMBIENT: bool = true;
override SHARED_COLOUR: bool = false;  // every light's specular colour is its diffuse colour
override RANGED: bool = true;          // some light has a range
override SQUARINGS: i32 = -1;          // the shininess is 2^SQUARINGS; -1: read it and take a power
override TWO_SIDED: bool = true;
override BLEND: bool = false;
override GEOMETRIC_FALLBACK: bool = false;
// How many lights of each kind the vertex and the fragment list hold. With DYNAMIC_COUNTS they are
// read from the draw instead, so that long lists of any length share a pipeline.
override DYNAMIC_COUNTS: bool = false;
override VERTEX_DIRECTIONAL: u32 = 0;
override VERTEX_POINT: u32 = 0;
override VERTEX_SPOT: u32 = 0;
override FRAGMENT_DIRECTIONAL: u32 = 0;
override FRAGMENT_POINT: u32 = 0;
override FRAGMENT_SPOT: u32 = 0;

struct View {
    scale: vec2f,        // x and y of clip_from_eye
    near: f32,
    padding: f32,
}

struct Draw {
    front: Material,
    back: Material,
    vertex_counts: vec4u,    // directional, point, spot
    fragment_counts: vec4u,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<uniform> draw: Draw;
// The vertex list, then the fragment list; each sorted by kind: directional, point, spot.
@group(0) @binding(2) var<LIGHT_SPACE> lights: array<Light, LIGHT_COUNT>;

// One instance: eye_from_model as rows, the normal matrix as columns.
struct Object {
    @location(0) row0: vec4f,
    @location(1) row1: vec4f,
    @location(2) row2: vec4f,
    @location(3) normal0: vec3f,
    @location(4) normal1: vec3f,
    @location(5) normal2: vec3f,
}

fn eye_position(object: Object, position: vec3f) -> vec3f {
    let p = vec4f(position, 1.0);
    return vec3f(dot(object.row0, p), dot(object.row1, p), dot(object.row2, p));
}

fn eye_normal(object: Object, normal: vec3f) -> vec3f {
    return safe_normalize(object.normal0 * normal.x + object.normal1 * normal.y + object.normal2 * normal.z);
}

// Zero stays zero: a collapsed normal lights nothing, and is finite.
fn safe_normalize(n: vec3f) -> vec3f {
    return n * inverseSqrt(max(dot(n, n), SMALLEST_NORMAL));
}

// Reversed depth with an infinite far plane: z/w = near / distance.
fn clip_position(eye: vec3f) -> vec4f {
    return vec4f(view.scale * eye.xy, view.near, -eye.z);
}

fn arriving(p: vec3f, n: vec3f, shininess: f32, first: u32, directional: u32, points: u32, spots: u32) -> Irradiance {
    let v = to_viewer(p, n);
    var sum = Irradiance();
    var end = first + directional;
    for (var i = first; i < end; i++) {
        sum = add_light(sum, lights[i], lights[i].position, 1.0, n, v, shininess);
    }
    let first_point = end;
    end += points;
    for (var i = first_point; i < end; i++) {
        sum = add_finite_light(sum, lights[i], false, p, n, v, shininess);
    }
    let first_spot = end;
    end += spots;
    for (var i = first_spot; i < end; i++) {
        sum = add_finite_light(sum, lights[i], true, p, n, v, shininess);
    }
    return sum;
}

fn shade_vertex(p: vec3f, n: vec3f, material: Material) -> vec3f {
    var counts = vec3u(VERTEX_DIRECTIONAL, VERTEX_POINT, VERTEX_SPOT);
    if DYNAMIC_COUNTS {
        counts = draw.vertex_counts.xyz;
    }
    return reflected(arriving(p, n, material.shininess, 0, counts.x, counts.y, counts.z), material);
}

fn fragment_terms(p: vec3f, n: vec3f, shininess: f32) -> Irradiance {
    var first = VERTEX_DIRECTIONAL + VERTEX_POINT + VERTEX_SPOT;
    var counts = vec3u(FRAGMENT_DIRECTIONAL, FRAGMENT_POINT, FRAGMENT_SPOT);
    if DYNAMIC_COUNTS {
        first = draw.vertex_counts.x + draw.vertex_counts.y + draw.vertex_counts.z;
        counts = draw.fragment_counts.xyz;
    }
    return arriving(p, n, shininess, first, counts.x, counts.y, counts.z);
}

fn shaded(colour: vec3f, front: bool) -> vec4f {
    if BLEND {
        return vec4f(colour, select(draw.back.opacity, draw.front.opacity, front));
    }
    return vec4f(colour, 1.0);
}

// ---- no lights: emission and ambient -------------------------------------------------------

@vertex
fn vs_unlit(
    @location(0) row0: vec4f,
    @location(1) row1: vec4f,
    @location(2) row2: vec4f,
    @location(6) position: vec3f,
) -> @invariant @builtin(position) vec4f {
    return clip_position(eye_position(Object(row0, row1, row2, vec3f(), vec3f(), vec3f()), position));
}

@fragment
fn fs_unlit() -> @location(0) vec4f {
    return shaded(draw.front.base, true);
}

@fragment
fn fs_unlit_both(@builtin(front_facing) front: bool) -> @location(0) vec4f {
    return shaded(select(draw.back.base, draw.front.base, front), front);
}

// ---- flat: one shade a triangle, made at its provoking vertex from its centroid and face normal ----

struct Flat {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat, first) colour: vec4f,
}

@vertex
fn vs_flat(object: Object, @location(6) position: vec3f, @location(7) normal: vec3f, @location(8) centroid: vec3f) -> Flat {
    let p = eye_position(object, centroid);
    let n = eye_normal(object, normal);
    let front = dot(n, p) <= 0.0;
    var colour = vec3f();
    if front {
        colour = shade_vertex(p, n, draw.front);
    } else if TWO_SIDED {
        colour = shade_vertex(p, -n, draw.back);
    }
    return Flat(clip_position(eye_position(object, position)), shaded(colour, front));
}

@fragment
fn fs_flat(in: Flat) -> @location(0) vec4f {
    return in.colour;
}

// ---- every term at the vertices (Gouraud) ------------------------------------------------------

struct Gouraud {
    @invariant @builtin(position) clip: vec4f,
    @location(0) colour: vec3f,
}

@vertex
fn vs_gouraud(object: Object, @location(6) position: vec3f, @location(7) normal: vec3f) -> Gouraud {
    let p = eye_position(object, position);
    return Gouraud(clip_position(p), shade_vertex(p, eye_normal(object, normal), draw.front));
}

@fragment
fn fs_gouraud(in: Gouraud) -> @location(0) vec4f {
    return shaded(in.colour, true);
}

struct GouraudBoth {
    @invariant @builtin(position) clip: vec4f,
    @location(0) front: vec3f,
    @location(1) back: vec3f,
}

@vertex
fn vs_gouraud_both(object: Object, @location(6) position: vec3f, @location(7) normal: vec3f) -> GouraudBoth {
    let p = eye_position(object, position);
    let n = eye_normal(object, normal);
    return GouraudBoth(clip_position(p), shade_vertex(p, n, draw.front), shade_vertex(p, -n, draw.back));
}

@fragment
fn fs_gouraud_both(in: GouraudBoth, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return shaded(select(in.back, in.front, front), front);
}

// ---- every term at the fragments (Phong) -------------------------------------------------------

struct Phong {
    @invariant @builtin(position) clip: vec4f,
    @location(0) p: vec3f,
    @location(1) n: vec3f,
}

@vertex
fn vs_phong(object: Object, @location(6) position: vec3f, @location(7) normal: vec3f) -> Phong {
    let p = eye_position(object, position);
    return Phong(clip_position(p), p, eye_normal(object, normal));
}

// The interpolated normal, renormalised. Where it vanishes (opposite vertex normals; only meshes
// that have them pay for it) the geometric normal of the side seen as front takes its place.
fn fragment_normal(p: vec3f, n: vec3f, front: bool) -> vec3f {
    if GEOMETRIC_FALLBACK {
        let face = safe_normalize(cross(dpdx(p), dpdy(p)));
        let toward_eye = face * select(1.0, -1.0, dot(face, p) > 0.0);
        let geometric = select(-toward_eye, toward_eye, front);
        return select(safe_normalize(n), geometric, dot(n, n) < 1e-12);
    }
    return safe_normalize(n);
}

@fragment
fn fs_phong(in: Phong, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let n = fragment_normal(in.p, in.n, front);
    if TWO_SIDED {
        // One evaluation for the side seen, not one a side.
        var material = draw.back;
        if front {
            material = draw.front;
        }
        let terms = fragment_terms(in.p, select(-n, n, front), material.shininess);
        return shaded(reflected(terms, material), front);
    }
    let terms = fragment_terms(in.p, n, draw.front.shininess);
    return shaded(reflected(terms, draw.front), true);
}

// ---- some terms at the vertices, some at the fragments -----------------------------------------

struct Mixed {
    @invariant @builtin(position) clip: vec4f,
    @location(0) p: vec3f,
    @location(1) n: vec3f,
    @location(2) front: vec3f,
    @location(3) back: vec3f,
}

@vertex
fn vs_mixed(object: Object, @location(6) position: vec3f, @location(7) normal: vec3f) -> Mixed {
    let p = eye_position(object, position);
    let n = eye_normal(object, normal);
    var back = vec3f();
    if TWO_SIDED {
        back = shade_vertex(p, -n, draw.back);
    }
    return Mixed(clip_position(p), p, n, shade_vertex(p, n, draw.front), back);
}

@fragment
fn fs_mixed(in: Mixed, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let n = fragment_normal(in.p, in.n, front);
    if TWO_SIDED && !front {
        return shaded(in.back + added(fragment_terms(in.p, -n, draw.back.shininess), draw.back), false);
    }
    return shaded(in.front + added(fragment_terms(in.p, n, draw.front.shininess), draw.front), true);
}
