// The entry points of draws with images, or of which a mask cuts something out. Needs parts.wgsl.

// ---- flat ----------------------------------------------------------------------------------------

struct Flat {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat, first) ambient: vec4f,    // and the opacity of the vertices
    @location(1) @interpolate(flat, first) diffuse: vec3f,
    @location(2) @interpolate(flat, first) specular: vec3f,
    @location(3) @interpolate(perspective, centroid) uv: vec4f,
    @location(4) @interpolate(perspective, center) at: vec4f,
    @location(5) @interpolate(perspective, center) middle: vec3f,
    @location(6) @interpolate(flat, first) record: vec2u,     // and whether it shows its front
}

fn flat_vertex(object: Object, vertex: FlatVertex) -> Flat {
    let p = eye_position(object, vertex.centroid);
    let n = eye_normal(object, vertex.normal);
    let record = record_of(object.record);
    let front = !TWO_SIDED || dot(n, p) <= 0.0;
    var sums: Parts;
    if front {
        sums = front_parts(p, n, vertex.color, record);
    } else {
        sums = back_parts(p, -n, vertex.color, record);
    }
    let corner = eye_position(object, vertex.position);
    let uv = vertex.uv;
    let ambient = vec4f(sums.ambient, vertex.color.a);
    let sides = vec2u(object.record, u32(front));
    return Flat(clip_position(corner), ambient, sums.diffuse, sums.specular, uv, uv, corner, sides);
}

@vertex
fn vs_flat(object: Object, vertex: FlatVertex) -> Flat {
    return flat_vertex(object, vertex);
}

@fragment
fn fs_flat(in: Flat) -> @location(0) vec4f {
    let sums = Parts(in.ambient.rgb, in.diffuse, in.specular);
    return output(sums, in.ambient.a, record_of(in.record.x), in.record.y == 1u, coordinates(in.uv, in.at, -in.middle.z));
}

// ---- no term at the fragments: Gouraud, or no lights ----------------------------------------------

struct Gouraud {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(perspective, centroid) ambient: vec4f,    // and the opacity of the vertices
    @location(1) @interpolate(perspective, centroid) diffuse: vec3f,
    @location(2) @interpolate(perspective, centroid) specular: vec3f,
    @location(3) @interpolate(perspective, centroid) back_ambient: vec3f,
    @location(4) @interpolate(perspective, centroid) back_diffuse: vec3f,
    @location(5) @interpolate(perspective, centroid) back_specular: vec3f,
    @location(6) @interpolate(perspective, centroid) uv: vec4f,
    @location(7) @interpolate(perspective, center) at: vec4f,
    @location(8) @interpolate(perspective, center) middle: vec3f,
    @location(9) @interpolate(flat, either) record: u32,
}

fn gouraud_vertex(object: Object, vertex: Vertex) -> Gouraud {
    let p = eye_position(object, vertex.position);
    let n = eye_normal(object, vertex.normal);
    let record = record_of(object.record);
    let front = front_parts(p, n, vertex.color, record);
    var back = Parts();
    if TWO_SIDED {
        back = back_parts(p, -n, vertex.color, record);
    }
    let uv = vertex.uv;
    let ambient = vec4f(front.ambient, vertex.color.a);
    return Gouraud(
        clip_position(p), ambient, front.diffuse, front.specular, back.ambient, back.diffuse, back.specular, uv, uv, p,
        object.record,
    );
}

@vertex
fn vs_gouraud(object: Object, vertex: Vertex) -> Gouraud {
    return gouraud_vertex(object, vertex);
}

@fragment
fn fs_gouraud(in: Gouraud, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let is_front = front || !TWO_SIDED;
    let sums = Parts(
        interpolated(select(in.back_ambient, in.ambient.rgb, is_front)),
        interpolated(select(in.back_diffuse, in.diffuse, is_front)),
        interpolated(select(in.back_specular, in.specular, is_front)),
    );
    return output(sums, in.ambient.a, record_of(in.record), is_front, coordinates(in.uv, in.at, -in.middle.z));
}

// ---- some term at the fragments: Phong, or mixed ---------------------------------------------------

@fragment
fn fs_mixed(in: Mixed, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let found = mixed_parts(in, front);
    return output(found.sums, found.color.a, found.record, found.is_front, found.c);
}
