// Declarations that the stages of surfaces share. Needs lighting.wgsl, records.wgsl, and uniform.wgsl or storage.wgsl.

override BLEND: bool = false;
override ENCODED: bool = false;        // the target has no sRGB format: the curve is the shader's
override GEOMETRIC_FALLBACK: bool = false;
override PER_INSTANCE: bool = false;   // each instance names its record; else the draw has one

// One instance: eye_from_model as rows, the normal matrix as columns, and the number of its record.
struct Object {
    @location(0) row0: vec4f,
    @location(1) row1: vec4f,
    @location(2) row2: vec4f,
#if NORMALS
    @location(3) normal0: vec3f,
    @location(4) normal1: vec3f,
    @location(5) normal2: vec3f,
#end
    @location(9) record: u32,
}

fn record_of(object_record: u32) -> u32 {
    return select(0u, object_record, PER_INSTANCE);
}

fn eye_position(object: Object, position: vec3f) -> vec3f {
    let p = vec4f(position, 1.0);
    return vec3f(dot(object.row0, p), dot(object.row1, p), dot(object.row2, p));
}

#if NORMALS
fn eye_normal(object: Object, normal: vec3f) -> vec3f {
    return transform_normal(mat3x3f(object.normal0, object.normal1, object.normal2), normal);
}
#end

// Reversed depth: z/w is 1 at the near plane.
fn clip_position(eye: vec3f) -> vec4f {
    let w = clip_w(eye);
    return vec4f(view.scale * eye.xy + view.center * w, view.depth.x * -eye.z + view.depth.y, w);
}

// w of clip space.
fn clip_w(eye: vec3f) -> f32 {
    return view.w.x * -eye.z + view.w.y;
}

// The direction in which a point is seen, of any length: from the eye to it, or along the view where rays are parallel.
fn sight(p: vec3f) -> vec3f {
    return view.w.x * p - vec3f(0.0, 0.0, view.w.y);
}

// The lights of a record's lists.
fn add_lists(p: vec3f, n: vec3f, material: Material, record: u32, terms: Terms) -> Irradiance {
    var sum = add_listed(Irradiance(), p, n, material, surfaces[record].both, terms);
    if terms.diffuse {
        sum = add_listed(sum, p, n, material, surfaces[record].diffuse, Terms(true, false));
    }
    if terms.specular {
        sum = add_listed(sum, p, n, material, surfaces[record].specular, Terms(false, true));
    }
    return sum;
}

// ANCHOR: vertex_terms
fn vertex_terms(p: vec3f, n: vec3f, material: Material, record: u32) -> Irradiance {
    let terms = Terms(VERTEX_DIFFUSE, VERTEX_SPECULAR);
    if !LISTED {
        return add_counted(p, n, material, terms);
    }
    return add_lists(p, n, material, record, terms);
}
// ANCHOR_END: vertex_terms

// ANCHOR: fragment_terms
fn fragment_terms(p: vec3f, n: vec3f, material: Material, record: u32) -> Irradiance {
    let terms = Terms(FRAGMENT_DIFFUSE, FRAGMENT_SPECULAR);
    if !LISTED {
        return add_counted(p, n, material, terms);
    }
    return add_lists(p, n, material, record, terms);
}
// ANCHOR_END: fragment_terms

// In the format of the target.
fn written(color: vec3f) -> vec3f {
    if ENCODED {
        return srgb_encoded(clamp(color, vec3f(0.0), vec3f(1.0)));
    }
    return color;
}

// No shade is below 0. Across a triangle seen edge-on an adapter may extrapolate, and so leave the range of the
// vertices.
fn interpolated(color: vec3f) -> vec3f {
    return max(color, vec3f());
}

// The interpolated normal, renormalised. Only meshes with opposite vertex normals pay for the fallback, the geometric
// normal of the visible side.
fn fragment_normal(p: vec3f, n: vec3f, front: bool) -> vec3f {
    if GEOMETRIC_FALLBACK {
        let face = normalize_or_zero(cross(dpdx(p), dpdy(p)));
        let toward_eye = face * select(1.0, -1.0, dot(face, sight(p)) > 0.0);
        return interpolated_normal(n, select(-toward_eye, toward_eye, front));
    }
    return normalize_or_zero(n);
}
