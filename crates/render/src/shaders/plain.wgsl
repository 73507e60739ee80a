// The entry points: one pair for each frequency of a draw's terms. Needs mesh.wgsl.

// I = ke + ka·(Ga + Σ La) + Σ …, from what arrives.
fn shade(arriving: Irradiance, material: Material) -> vec3f {
    return material.base + reflected(arriving, material);
}

fn shade_front(p: vec3f, n: vec3f, record: u32) -> vec3f {
    return shade(vertex_terms(p, n, draws[record].front.shininess, record), draws[record].front);
}

fn shade_back(p: vec3f, n: vec3f, record: u32) -> vec3f {
    return shade(vertex_terms(p, n, draws[record].back.shininess, record), draws[record].back);
}

fn shaded(color: vec3f, record: u32, front: bool) -> vec4f {
    if BLEND {
        return vec4f(written(color), select(draws[record].back.opacity, draws[record].front.opacity, front));
    }
    return vec4f(written(color), 1.0);
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
    @location(0) @interpolate(flat, either) color: vec4f,
}

@vertex
fn vs_unlit(object: Placed, @location(6) position: vec3f) -> Unlit {
    let record = record_of(object.record);
    return Unlit(placed_position(object, position), shaded(draws[record].front.base, record, true));
}

@fragment
fn fs_unlit(in: Unlit) -> @location(0) vec4f {
    return in.color;
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
    @location(0) @interpolate(flat, first) color: vec4f,
}

@vertex
fn vs_flat(object: Object, @location(6) position: vec3f, @location(7) normal: vec3f, @location(8) centroid: vec3f) -> Flat {
    let p = eye_position(object, centroid);
    let n = eye_normal(object, normal);
    let record = record_of(object.record);
    // Of one side the rasteriser shows what winds as the front does. It snaps vertices to a grid, so that of a triangle
    // seen edge-on, or smaller than the grid, it may find another side than n·p does.
    let front = !TWO_SIDED || dot(n, p) <= 0.0;
    var color: vec3f;
    if front {
        color = shade_front(p, n, record);
    } else {
        color = shade_back(p, -n, record);
    }
    return Flat(clip_position(eye_position(object, position)), shaded(color, record, front));
}

@fragment
fn fs_flat(in: Flat) -> @location(0) vec4f {
    return in.color;
}

// Of a pixel with four samples of which a triangle covers some, the centre may lie outside the triangle: what is
// interpolated is taken where the triangle is (centroid). With one sample that is the centre.

// ---- every term at the vertices (Gouraud) ------------------------------------------------------

struct Gouraud {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(perspective, centroid) color: vec3f,
    @location(1) @interpolate(flat, either) record: u32,
}

@vertex
fn vs_gouraud(object: Object, @location(6) position: vec3f, @location(7) normal: vec3f) -> Gouraud {
    let p = eye_position(object, position);
    let color = shade_front(p, eye_normal(object, normal), record_of(object.record));
    return Gouraud(clip_position(p), color, object.record);
}

@fragment
fn fs_gouraud(in: Gouraud) -> @location(0) vec4f {
    return shaded(interpolated(in.color), record_of(in.record), true);
}

struct GouraudBoth {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(perspective, centroid) front: vec3f,
    @location(1) @interpolate(perspective, centroid) back: vec3f,
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
    return shaded(interpolated(select(in.back, in.front, front)), record_of(in.record), front);
}

// ---- every term at the fragments (Phong) -------------------------------------------------------

struct Phong {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(perspective, centroid) p: vec3f,
    @location(1) @interpolate(perspective, centroid) n: vec3f,
    @location(2) @interpolate(flat, either) record: u32,
}

@vertex
fn vs_phong(object: Object, @location(6) position: vec3f, @location(7) normal: vec3f) -> Phong {
    let p = eye_position(object, position);
    return Phong(clip_position(p), p, eye_normal(object, normal), object.record);
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
        return shaded(shade(terms, material), record, front);
    }
    let terms = fragment_terms(in.p, n, draws[record].front.shininess, record);
    return shaded(shade(terms, draws[record].front), record, true);
}

// ---- some terms at the vertices, some at the fragments -----------------------------------------

struct Mixed {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(perspective, centroid) p: vec3f,
    @location(1) @interpolate(perspective, centroid) n: vec3f,
    @location(2) @interpolate(perspective, centroid) front: vec3f,
    @location(3) @interpolate(perspective, centroid) back: vec3f,
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
        return shaded(interpolated(in.back) + reflected(terms, draws[record].back), record, false);
    }
    let terms = fragment_terms(in.p, n, draws[record].front.shininess, record);
    return shaded(interpolated(in.front) + reflected(terms, draws[record].front), record, true);
}
