// What a fragment takes from the solid that its object is cut from. Needs parts.wgsl and solids.wgsl.

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
