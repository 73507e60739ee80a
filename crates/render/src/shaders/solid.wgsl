// What a fragment takes from the solid that its object is cut from, and the vertices of draws with some term at the
// fragments. Needs parts.wgsl and solids.wgsl.

override SOLID_KIND: u32 = 0;

struct SolidData {
    rows: array<vec4f, 3>,          // from the object's space to the solid's
    first: vec3f,                   // the colors
    octaves: u32,
    second: vec4f,
}

@group(1) @binding(9) var<uniform> solid: SolidData;

// Where a fragment lies in the object's space: at its centroid, and at the pixel's center.
struct Cut {
    @location(12) @interpolate(perspective, centroid) place: vec4f,
    @location(13) @interpolate(perspective, center) at: vec4f,
}

// A point where w is 1, or a way where it is 0, in the solid's space.
fn in_solid(v: vec4f) -> vec3f {
    return vec3f(dot(solid.rows[0], v), dot(solid.rows[1], v), dot(solid.rows[2], v));
}

// What multiplies the ambient and the diffuse part; w is the distance along the view at the pixel's center.
fn cut_color(cut: Cut, w: f32) -> vec3f {
    let c = coordinates(cut.place, cut.at, w);
    let x = in_solid(vec4f(c.dx.xyz, 0.0));
    let y = in_solid(vec4f(c.dy.xyz, 0.0));
    let t = solid_value(SOLID_KIND, solid.octaves, in_solid(vec4f(c.uv.xyz, 1.0)), x, y);
    return solid.first + t * (solid.second.xyz - solid.first);
}

fn cut_parts(sums: Parts, color: vec3f) -> Parts {
    return Parts(color * sums.ambient, color * sums.diffuse, sums.specular);
}

// Mixed, and where the vertex lies in the object's space.
struct SolidMixed {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(perspective, centroid) p: vec3f,
    @location(1) @interpolate(perspective, centroid) n: vec3f,
    @location(2) @interpolate(perspective, centroid) color: vec4f,
    @location(3) @interpolate(perspective, centroid) front: vec3f,   // the terms of the vertices, of either side
    @location(4) @interpolate(perspective, centroid) back: vec3f,
    @location(5) @interpolate(perspective, centroid) front_ambient: vec3f,
    @location(6) @interpolate(perspective, centroid) back_ambient: vec3f,
    @location(7) @interpolate(perspective, centroid) frame: vec4f,   // the tangent and w, or what a rise of 1 becomes
    @location(8) @interpolate(perspective, centroid) uv: vec4f,
    @location(9) @interpolate(perspective, center) at: vec4f,
    @location(10) @interpolate(perspective, center) middle: vec3f,
    @location(11) @interpolate(flat, either) record: u32,
    @location(12) @interpolate(perspective, centroid) place: vec4f,
    @location(13) @interpolate(perspective, center) at_center: vec4f,
}

@vertex
fn vs_solid_mixed(object: Object, vertex: Vertex) -> SolidMixed {
    let made = mixed_vertex(object, vertex);
    let place = vec4f(vertex.position, 1.0);
    return SolidMixed(
        made.clip, made.p, made.n, made.color, made.front, made.back, made.front_ambient, made.back_ambient,
        made.frame, made.uv, made.at, made.middle, made.record, place, place,
    );
}
