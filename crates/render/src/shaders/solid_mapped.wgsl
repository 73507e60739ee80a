// The entry points of mapped draws with a solid: those of mapped.wgsl, and where a vertex lies in the object's space.
// The solid's color multiplies what all else has left of the ambient and the diffuse part. Needs mapped.wgsl and
// solid.wgsl.

// ---- flat ----------------------------------------------------------------------------------------

struct SolidFlat {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat, first) ambient: vec4f,    // and the opacity of the vertices
    @location(1) @interpolate(flat, first) diffuse: vec3f,
    @location(2) @interpolate(flat, first) specular: vec3f,
    @location(3) @interpolate(perspective, centroid) uv: vec4f,
    @location(4) @interpolate(perspective, center) at: vec4f,
    @location(5) @interpolate(perspective, center) middle: vec3f,
    @location(6) @interpolate(flat, first) record: vec2u,     // and whether it shows its front
    @location(12) @interpolate(perspective, centroid) place: vec4f,
    @location(13) @interpolate(perspective, center) at_center: vec4f,
}

@vertex
fn vs_solid_flat(object: Object, vertex: FlatVertex) -> SolidFlat {
    let made = flat_vertex(object, vertex);
    let place = vec4f(vertex.position, 1.0);
    return SolidFlat(
        made.clip, made.ambient, made.diffuse, made.specular, made.uv, made.at, made.middle, made.record, place,
        place,
    );
}

@fragment
fn fs_solid_flat(in: Flat, cut: Cut) -> @location(0) vec4f {
    let color = cut_color(cut, -in.middle.z);
    let sums = cut_parts(Parts(in.ambient.rgb, in.diffuse, in.specular), color);
    return output(sums, in.ambient.a, record_of(in.record.x), in.record.y == 1u, coordinates(in.uv, in.at, -in.middle.z));
}

// ---- no term at the fragments: Gouraud, or no lights ----------------------------------------------

struct SolidGouraud {
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
    @location(12) @interpolate(perspective, centroid) place: vec4f,
    @location(13) @interpolate(perspective, center) at_center: vec4f,
}

@vertex
fn vs_solid_gouraud(object: Object, vertex: Vertex) -> SolidGouraud {
    let made = gouraud_vertex(object, vertex);
    let place = vec4f(vertex.position, 1.0);
    return SolidGouraud(
        made.clip, made.ambient, made.diffuse, made.specular, made.back_ambient, made.back_diffuse,
        made.back_specular, made.uv, made.at, made.middle, made.record, place, place,
    );
}

@fragment
fn fs_solid_gouraud(in: Gouraud, cut: Cut, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let color = cut_color(cut, -in.middle.z);
    let is_front = front || !TWO_SIDED;
    let sums = Parts(
        interpolated(select(in.back_ambient, in.ambient.rgb, is_front)),
        interpolated(select(in.back_diffuse, in.diffuse, is_front)),
        interpolated(select(in.back_specular, in.specular, is_front)),
    );
    let c = coordinates(in.uv, in.at, -in.middle.z);
    return output(cut_parts(sums, color), in.ambient.a, record_of(in.record), is_front, c);
}

// ---- some term at the fragments: Phong, or mixed ---------------------------------------------------

@fragment
fn fs_solid_mixed(in: Mixed, cut: Cut, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let color = cut_color(cut, -in.middle.z);
    let found = mixed_parts(in, front);
    return output(cut_parts(found.sums, color), found.color.a, found.record, found.is_front, found.c);
}
