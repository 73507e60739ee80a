// Bindings, specialisation and the entry points: one pair for each frequency of a draw's terms.

// What a draw does not use is not in its pipeline.
override VERTEX_DIFFUSE: bool = false;
override VERTEX_SPECULAR: bool = false;
override FRAGMENT_DIFFUSE: bool = false;
override FRAGMENT_SPECULAR: bool = false;
override BLINN_PHONG: bool = true;
override LOCAL_VIEWER: bool = true;
override ATTENUATED_AMBIENT: bool = true;
override SHARED_COLOUR: bool = false;  // every light's specular colour is its diffuse colour
override RANGED: bool = true;          // some light has a range
override SQUARINGS: i32 = -1;          // the shininess is 2^SQUARINGS; -1: read it and take a power
override TWO_SIDED: bool = true;
override BLEND: bool = false;
override ENCODED: bool = false;        // the target takes bytes as they are: the sRGB curve is the shader's
override GEOMETRIC_FALLBACK: bool = false;
override PER_INSTANCE: bool = false;   // each instance names its record; else the draw has one
// The lights are those that the record's lists name. Else they are the first that are bound, of each kind so many.
override LISTED: bool = false;
override DIRECTIONAL: u32 = 0;
override POINTS: u32 = 0;
override SPOTS: u32 = 0;
override HIGHLIGHTS: u32 = 2;          // of each kind, the first so many halves have specular terms

struct View {
    scale: vec2f,        // x and y of clip_from_eye
    near: f32,
    padding: f32,
}

// Light lists: how many directional, point and spot lights, and where their numbers begin among `lists`.
struct Draw {
    front: Material,
    back: Material,
    vertex: vec4u,
    vertex_diffuse: vec4u,    // these lights' specular terms are left out
    fragment: vec4u,
    fragment_diffuse: vec4u,
    padding: array<vec4u, 4>,
}

@group(0) @binding(0) var<uniform> view: View;

// One instance: eye_from_model as rows, the normal matrix as columns, and the number of its record.
struct Object {
    @location(0) row0: vec4f,
    @location(1) row1: vec4f,
    @location(2) row2: vec4f,
    @location(3) normal0: vec3f,
    @location(4) normal1: vec3f,
    @location(5) normal2: vec3f,
    @location(9) record: u32,
}

fn record_of(object_record: u32) -> u32 {
    return select(0u, object_record, PER_INSTANCE);
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

fn vertex_terms(p: vec3f, n: vec3f, shininess: f32, record: u32) -> Irradiance {
    let terms = Terms(VERTEX_DIFFUSE, VERTEX_SPECULAR);
    if !LISTED {
        return add_counted(p, n, shininess, terms);
    }
    let sum = add_listed(Irradiance(), p, n, shininess, draws[record].vertex, terms);
    return add_listed(sum, p, n, shininess, draws[record].vertex_diffuse, Terms(VERTEX_DIFFUSE, false));
}

fn fragment_terms(p: vec3f, n: vec3f, shininess: f32, record: u32) -> Irradiance {
    let terms = Terms(FRAGMENT_DIFFUSE, FRAGMENT_SPECULAR);
    if !LISTED {
        return add_counted(p, n, shininess, terms);
    }
    let sum = add_listed(Irradiance(), p, n, shininess, draws[record].fragment, terms);
    return add_listed(sum, p, n, shininess, draws[record].fragment_diffuse, Terms(FRAGMENT_DIFFUSE, false));
}

fn shade_front(p: vec3f, n: vec3f, record: u32) -> vec3f {
    return reflected(vertex_terms(p, n, draws[record].front.shininess, record), draws[record].front);
}

fn shade_back(p: vec3f, n: vec3f, record: u32) -> vec3f {
    return reflected(vertex_terms(p, n, draws[record].back.shininess, record), draws[record].back);
}

fn shaded(colour: vec3f, record: u32, front: bool) -> vec4f {
    var written = colour;
    if ENCODED {
        written = srgb_encoded(colour);
    }
    if BLEND {
        return vec4f(written, select(draws[record].back.opacity, draws[record].front.opacity, front));
    }
    return vec4f(written, 1.0);
}

// The sRGB curve (IEC 61966-2-1) of a clamped intensity. Its upper part, 1.055·I^(1/2.4) − 0.055, is a polynomial of the
// fifth degree in ⁴√I here, fitted for the least greatest error: 6.8e-6, a 600th of an 8-bit step.
fn srgb_encoded(colour: vec3f) -> vec3f {
    let linear = clamp(colour, vec3f(0.0), vec3f(1.0));
    let q = sqrt(sqrt(linear));
    let lower = -0.06134022 + q * (0.16202632 + q * 1.2554042);
    let curved = lower + q * q * q * (-0.57748237 + q * (0.28953271 - q * 0.06814721));
    return select(curved, 12.92 * linear, linear <= vec3f(0.0031308));
}

// ---- no lights: emission and ambient -------------------------------------------------------

// An instance without its normal matrix.
struct Placed {
    @location(0) row0: vec4f,
    @location(1) row1: vec4f,
    @location(2) row2: vec4f,
    @location(9) record: u32,
}

fn placed_position(object: Placed, position: vec3f) -> vec4f {
    let normal = vec3f();
    let placed = Object(object.row0, object.row1, object.row2, normal, normal, normal, object.record);
    return clip_position(eye_position(placed, position));
}

struct Unlit {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat, either) colour: vec4f,
}

@vertex
fn vs_unlit(object: Placed, @location(6) position: vec3f) -> Unlit {
    let record = record_of(object.record);
    return Unlit(placed_position(object, position), shaded(draws[record].front.base, record, true));
}

@fragment
fn fs_unlit(in: Unlit) -> @location(0) vec4f {
    return in.colour;
}

struct UnlitBoth {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat, either) front: vec4f,
    @location(1) @interpolate(flat, either) back: vec4f,
}

@vertex
fn vs_unlit_both(object: Placed, @location(6) position: vec3f) -> UnlitBoth {
    let record = record_of(object.record);
    let front = shaded(draws[record].front.base, record, true);
    return UnlitBoth(placed_position(object, position), front, shaded(draws[record].back.base, record, false));
}

@fragment
fn fs_unlit_both(in: UnlitBoth, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return select(in.back, in.front, front);
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
    let record = record_of(object.record);
    let front = dot(n, p) <= 0.0;
    var colour = vec3f();
    if front {
        colour = shade_front(p, n, record);
    } else if TWO_SIDED {
        colour = shade_back(p, -n, record);
    }
    return Flat(clip_position(eye_position(object, position)), shaded(colour, record, front));
}

@fragment
fn fs_flat(in: Flat) -> @location(0) vec4f {
    return in.colour;
}

// ---- every term at the vertices (Gouraud) ------------------------------------------------------

struct Gouraud {
    @invariant @builtin(position) clip: vec4f,
    @location(0) colour: vec3f,
    @location(1) @interpolate(flat, either) record: u32,
}

@vertex
fn vs_gouraud(object: Object, @location(6) position: vec3f, @location(7) normal: vec3f) -> Gouraud {
    let p = eye_position(object, position);
    let colour = shade_front(p, eye_normal(object, normal), record_of(object.record));
    return Gouraud(clip_position(p), colour, object.record);
}

@fragment
fn fs_gouraud(in: Gouraud) -> @location(0) vec4f {
    return shaded(in.colour, record_of(in.record), true);
}

struct GouraudBoth {
    @invariant @builtin(position) clip: vec4f,
    @location(0) front: vec3f,
    @location(1) back: vec3f,
    @location(2) @interpolate(flat, either) record: u32,
}

@vertex
fn vs_gouraud_both(object: Object, @location(6) position: vec3f, @location(7) normal: vec3f) -> GouraudBoth {
    let p = eye_position(object, position);
    let n = eye_normal(object, normal);
    let record = record_of(object.record);
    let front = shade_front(p, n, record);
    return GouraudBoth(clip_position(p), front, shade_back(p, -n, record), object.record);
}

@fragment
fn fs_gouraud_both(in: GouraudBoth, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return shaded(select(in.back, in.front, front), record_of(in.record), front);
}

// ---- every term at the fragments (Phong) -------------------------------------------------------

struct Phong {
    @invariant @builtin(position) clip: vec4f,
    @location(0) p: vec3f,
    @location(1) n: vec3f,
    @location(2) @interpolate(flat, either) record: u32,
}

@vertex
fn vs_phong(object: Object, @location(6) position: vec3f, @location(7) normal: vec3f) -> Phong {
    let p = eye_position(object, position);
    return Phong(clip_position(p), p, eye_normal(object, normal), object.record);
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
    let record = record_of(in.record);
    if TWO_SIDED {
        // One evaluation for the side seen, not one a side.
        var material = draws[record].back;
        if front {
            material = draws[record].front;
        }
        let terms = fragment_terms(in.p, select(-n, n, front), material.shininess, record);
        return shaded(reflected(terms, material), record, front);
    }
    let terms = fragment_terms(in.p, n, draws[record].front.shininess, record);
    return shaded(reflected(terms, draws[record].front), record, true);
}

// ---- some terms at the vertices, some at the fragments -----------------------------------------

struct Mixed {
    @invariant @builtin(position) clip: vec4f,
    @location(0) p: vec3f,
    @location(1) n: vec3f,
    @location(2) front: vec3f,
    @location(3) back: vec3f,
    @location(4) @interpolate(flat, either) record: u32,
}

@vertex
fn vs_mixed(object: Object, @location(6) position: vec3f, @location(7) normal: vec3f) -> Mixed {
    let p = eye_position(object, position);
    let n = eye_normal(object, normal);
    let record = record_of(object.record);
    var back = vec3f();
    if TWO_SIDED {
        back = shade_back(p, -n, record);
    }
    return Mixed(clip_position(p), p, n, shade_front(p, n, record), back, object.record);
}

@fragment
fn fs_mixed(in: Mixed, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let n = fragment_normal(in.p, in.n, front);
    let record = record_of(in.record);
    if TWO_SIDED && !front {
        let terms = fragment_terms(in.p, -n, draws[record].back.shininess, record);
        return shaded(in.back + added(terms, draws[record].back), record, false);
    }
    let terms = fragment_terms(in.p, n, draws[record].front.shininess, record);
    return shaded(in.front + added(terms, draws[record].front), record, true);
}
