// The entry points of draws in an environment, with images, a mask, or without. What it adds is evaluated at each
// fragment, whatever the shading. The way to the viewer is that of the point that is shaded, which lies in the triangle
// also where it covers a part of a pixel of four samples. Needs parts.wgsl and surroundings.wgsl.

// The sums with what the environment adds at a fragment whose normal, of the side that is seen, is n, a mean of normals
// that is so long.
fn surrounded(
    sums: Parts, p: vec3f, n: vec3f, mean: f32, color: vec3f, record: u32, front: bool, c: Coordinates,
) -> Parts {
    var material = draws[record].back;
    if front {
        material = draws[record].front;
    }
    var exponent = material.shininess;
    if SHININESS_MAP != NO_MAP {
        exponent *= channel_of(SHININESS_MAP, factor(shininess_image, 4u, SHININESS_MAP, c));
    }
    if LEAN || TOKSVIG {
        exponent = toksvig(mean, exponent).x;
    }
    let arriving = surroundings_of(n, view_vector(p, n), lobe_exponent(BLINN_PHONG, exponent));
    let ambient = sums.ambient + color * material.diffuse * arriving.mean;
    return Parts(ambient, sums.diffuse, sums.specular + material.specular * arriving.seen);
}

// ---- flat ----------------------------------------------------------------------------------------

struct Flat {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat, first) ambient: vec4f,    // and the opacity of the vertices
    @location(1) @interpolate(flat, first) diffuse: vec4f,    // and their red
    @location(2) @interpolate(flat, first) specular: vec4f,   // green
    @location(3) @interpolate(flat, first) n: vec4f,          // blue; n is of the side that is seen
    @location(4) @interpolate(perspective, centroid) uv: vec4f,
    @location(5) @interpolate(perspective, center) at: vec4f,
    @location(6) @interpolate(perspective, center) middle: vec4f,    // and w
    @location(7) @interpolate(flat, first) record: vec2u,     // and whether it shows its front
    @location(8) @interpolate(perspective, centroid) p: vec3f,
}

fn flat_vertex(object: Object, vertex: FlatVertex) -> Flat {
    let p = eye_position(object, vertex.centroid);
    var n = eye_normal(object, vertex.normal);
    let record = record_of(object.record);
    let front = !TWO_SIDED || dot(n, p) <= 0.0;
    var sums: Parts;
    if front {
        sums = front_parts(p, n, vertex.color, record);
    } else {
        n = -n;
        sums = back_parts(p, n, vertex.color, record);
    }
    let corner = eye_position(object, vertex.position);
    let uv = vertex.uv;
    let sides = vec2u(object.record, u32(front));
    let color = vertex.color;
    return Flat(
        clip_position(corner), vec4f(sums.ambient, color.a), vec4f(sums.diffuse, color.r), vec4f(sums.specular, color.g),
        vec4f(n, color.b), uv, uv, vec4f(corner, -corner.z), sides, corner,
    );
}

@vertex
fn vs_flat(object: Object, vertex: FlatVertex) -> Flat {
    return flat_vertex(object, vertex);
}

@fragment
fn fs_flat(in: Flat) -> @location(0) vec4f {
    let c = coordinates(in.uv, in.at, in.middle.w);
    let record = record_of(in.record.x);
    let front = in.record.y == 1u;
    let color = vec3f(in.diffuse.a, in.specular.a, in.n.a);
    let lit = Parts(in.ambient.rgb, in.diffuse.rgb, in.specular.rgb);
    return output(surrounded(lit, in.p, in.n.xyz, 1.0, color, record, front, c), in.ambient.a, record, front, c);
}

// ---- no term at the fragments: Gouraud, or no lights ----------------------------------------------

struct Gouraud {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(perspective, centroid) ambient: vec3f,
    @location(1) @interpolate(perspective, centroid) diffuse: vec3f,
    @location(2) @interpolate(perspective, centroid) specular: vec3f,
    @location(3) @interpolate(perspective, centroid) back_ambient: vec3f,
    @location(4) @interpolate(perspective, centroid) back_diffuse: vec3f,
    @location(5) @interpolate(perspective, centroid) back_specular: vec3f,
    @location(6) @interpolate(perspective, centroid) color: vec4f,
    @location(7) @interpolate(perspective, centroid) n: vec3f,
    @location(8) @interpolate(perspective, centroid) uv: vec4f,
    @location(9) @interpolate(perspective, center) at: vec4f,
    @location(10) @interpolate(perspective, center) middle: vec3f,
    @location(11) @interpolate(flat, either) record: u32,
    @location(14) @interpolate(perspective, centroid) p: vec3f,   // 12 and 13 are a solid's
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
    return Gouraud(
        clip_position(p), front.ambient, front.diffuse, front.specular, back.ambient, back.diffuse, back.specular,
        vertex.color, n, uv, uv, p, object.record, p,
    );
}

@vertex
fn vs_gouraud(object: Object, vertex: Vertex) -> Gouraud {
    return gouraud_vertex(object, vertex);
}

@fragment
fn fs_gouraud(in: Gouraud, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let c = coordinates(in.uv, in.at, -in.middle.z);
    let is_front = front || !TWO_SIDED;
    let lit = Parts(
        interpolated(select(in.back_ambient, in.ambient, is_front)),
        interpolated(select(in.back_diffuse, in.diffuse, is_front)),
        interpolated(select(in.back_specular, in.specular, is_front)),
    );
    let n = fragment_normal(in.middle, in.n, front);
    let record = record_of(in.record);
    let color = clamp(in.color, vec4f(), vec4f(1.0));
    let sums = surrounded(lit, in.p, select(-n, n, is_front), 1.0, color.rgb, record, is_front, c);
    return output(sums, color.a, record, is_front, c);
}

// ---- some term at the fragments: Phong, or mixed ---------------------------------------------------

@fragment
fn fs_mixed(in: Mixed, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let found = mixed_parts(in, front);
    let is_front = found.is_front;
    let color = found.color.rgb;
    let sums = surrounded(found.sums, in.p, found.n, found.mean, color, found.record, is_front, found.c);
    return output(sums, found.color.a, found.record, is_front, found.c);
}
