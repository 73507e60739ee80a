// The entry points of surrounded draws with a solid: those of surrounded.wgsl, and where a vertex lies in the object's
// space. The solid's color multiplies what all else has left of the ambient and the diffuse part. Needs surrounded.wgsl
// and solid.wgsl.

// ---- flat ----------------------------------------------------------------------------------------

struct SolidFlat {
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
    @location(12) @interpolate(perspective, centroid) place: vec4f,
    @location(13) @interpolate(perspective, center) at_center: vec4f,
}

@vertex
fn vs_solid_flat(object: Object, vertex: FlatVertex) -> SolidFlat {
    let made = flat_vertex(object, vertex);
    let place = vec4f(vertex.position, 1.0);
    return SolidFlat(
        made.clip, made.ambient, made.diffuse, made.specular, made.n, made.uv, made.at, made.middle, made.record,
        made.p, place, place,
    );
}

@fragment
fn fs_solid_flat(in: Flat, cut: Cut) -> @location(0) vec4f {
    let cut_by = cut_color(cut, in.middle.w);
    let c = coordinates(in.uv, in.at, in.middle.w);
    let record = record_of(in.record.x);
    let front = in.record.y == 1u;
    let color = vec3f(in.diffuse.a, in.specular.a, in.n.a);
    let lit = Parts(in.ambient.rgb, in.diffuse.rgb, in.specular.rgb);
    let sums = surrounded(lit, in.p, in.n.xyz, 1.0, color, record, front, c);
    return output(cut_parts(sums, cut_by), in.ambient.a, record, front, c);
}

// ---- no term at the fragments: Gouraud, or no lights ----------------------------------------------

struct SolidGouraud {
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
    @location(12) @interpolate(perspective, centroid) place: vec4f,
    @location(13) @interpolate(perspective, center) at_center: vec4f,
    @location(14) @interpolate(perspective, centroid) p: vec3f,
}

@vertex
fn vs_solid_gouraud(object: Object, vertex: Vertex) -> SolidGouraud {
    let made = gouraud_vertex(object, vertex);
    let place = vec4f(vertex.position, 1.0);
    return SolidGouraud(
        made.clip, made.ambient, made.diffuse, made.specular, made.back_ambient, made.back_diffuse,
        made.back_specular, made.color, made.n, made.uv, made.at, made.middle, made.record, place, place, made.p,
    );
}

@fragment
fn fs_solid_gouraud(in: Gouraud, cut: Cut, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let cut_by = cut_color(cut, -in.middle.z);
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
    return output(cut_parts(sums, cut_by), color.a, record, is_front, c);
}

// ---- some term at the fragments: Phong, or mixed ---------------------------------------------------

@fragment
fn fs_solid_mixed(in: Mixed, cut: Cut, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let cut_by = cut_color(cut, -in.middle.z);
    let found = mixed_parts(in, front);
    let is_front = found.is_front;
    let color = found.color.rgb;
    let sums = surrounded(found.sums, in.p, found.n, found.mean, color, found.record, is_front, found.c);
    return output(cut_parts(sums, cut_by), found.color.a, found.record, is_front, found.c);
}
