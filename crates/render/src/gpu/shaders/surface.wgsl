// The vertex and the fragment stage of every surface. Images and environments count at each fragment: what they multiply
// apart is interpolated apart. Needs mesh.wgsl; with MAPPED factors.wgsl, with SURROUNDED surroundings.wgsl, and with
// SOLID solids.wgsl.

struct Vertex {
    @location(6) position: vec3f,
#if NORMALS
    @location(7) normal: vec3f,
#end
#if FLAT
    @location(8) centroid: vec3f,    // of the triangle whose shade this vertex carries
#end
#if PAINTED
    @location(10) color: vec4f,      // linear, each channel from 0 to 1
#end
#if MAPPED
    @location(11) uv: vec4f,         // of both sets
#end
#if RELIEF
    @location(12) tangent: vec4f,
#end
}

// If a triangle covers some of a pixel's four samples, the centre may lie outside the triangle: values are interpolated
// inside it (centroid), except those that measure the size of a pixel. With one sample that is the centre.
struct Varyings {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat, either) record: u32,
#if FLAT
#if PAINTED
    @location(1) @interpolate(flat, first) color: vec4f,
#end
#if SURROUNDED
    @location(2) @interpolate(flat, first) n: vec3f,             // of the side that is seen
#end
#if MAPPED
#if VERTEX_DIFFUSE
    @location(4) @interpolate(flat, first) ambient: vec3f,
    @location(5) @interpolate(flat, first) diffuse: vec3f,
#end
#if VERTEX_SPECULAR
    @location(6) @interpolate(flat, first) specular: vec3f,
#end
#else
    @location(5) @interpolate(flat, first) shade: vec3f,
#end
#if TWO_SIDED
    @location(7) @interpolate(flat, first) is_front: u32,
#end
#else
#if PAINTED
    @location(1) @interpolate(perspective, centroid) color: vec4f,
#end
#if NORMALS_AT_FRAGMENTS
    @location(2) @interpolate(perspective, centroid) n: vec3f,
#end
#if VERTEX
#if MAPPED
#if VERTEX_DIFFUSE
    @location(4) @interpolate(perspective, centroid) ambient: vec3f,
    @location(5) @interpolate(perspective, centroid) diffuse: vec3f,
#end
#if VERTEX_SPECULAR
    @location(6) @interpolate(perspective, centroid) specular: vec3f,
#end
#else
    @location(5) @interpolate(perspective, centroid) shade: vec3f,
#end
#if TWO_SIDED
#if MAPPED
#if VERTEX_DIFFUSE
    @location(7) @interpolate(perspective, centroid) back_ambient: vec3f,
    @location(8) @interpolate(perspective, centroid) back_diffuse: vec3f,
#end
#if VERTEX_SPECULAR
    @location(9) @interpolate(perspective, centroid) back_specular: vec3f,
#end
#else
    @location(8) @interpolate(perspective, centroid) back_shade: vec3f,
#end
#end
#end
#end
#if NORMALS_AT_FRAGMENTS
    @location(3) @interpolate(perspective, centroid) p: vec3f,
#end
#if RELIEF
    @location(10) @interpolate(perspective, centroid) frame: vec4f,    // the tangent and w, or what a rise of 1 becomes
#end
#if MAPPED
    @location(11) @interpolate(perspective, centroid) uv: vec4f,
    @location(12) @interpolate(perspective, center) at: vec4f,
    @location(13) @interpolate(perspective, center) middle: vec4f,     // and -w of clip space
#end
#if SOLID
    @location(14) @interpolate(perspective, centroid) place: vec4f,    // in the object's space
    @location(15) @interpolate(perspective, center) at_center: vec4f,
#end
}

// The reflected part of the light that arrives, in the parts that images multiply.
struct Parts {
    ambient: vec3f,
    diffuse: vec3f,
    specular: vec3f,
}

// The color multiplies everything but highlights.
fn parts(arriving: Irradiance, material: Material, color: vec3f) -> Parts {
    var ambient = vec3f();
    if ATTENUATED_AMBIENT {
        ambient = color * material.ambient * arriving.ambient;
    }
    var specular = vec3f();
    if SPECULAR {
        specular = material.specular * arriving.specular;
    }
    return Parts(ambient, color * material.diffuse * arriving.diffuse, specular);
}

fn all_parts(sums: Parts) -> vec3f {
    return sums.ambient + sums.diffuse + sums.specular;
}

// The material of a side.
fn side(record: u32, front: bool) -> Material {
    if TWO_SIDED && !front {
        return surfaces[record].back;
    }
    return surfaces[record].front;
}

// The terms of a vertex that are shaded at the vertices.
fn vertex_parts(p: vec3f, n: vec3f, material: Material, color: vec3f, record: u32) -> Parts {
    return parts(vertex_terms(p, n, material, record), material, color);
}

@vertex
fn vs_surface(object: Object, vertex: Vertex) -> Varyings {
    var out: Varyings;
    let record = record_of(object.record);
    let corner = eye_position(object, vertex.position);
    out.clip = clip_position(corner);
    out.record = object.record;
    var color = vec4f(1.0);
#if PAINTED
    color = vertex.color;
    out.color = color;
#end
#if NORMALS
    var n = eye_normal(object, vertex.normal);
    var p = corner;
    var front = true;
#if FLAT
    p = eye_position(object, vertex.centroid);
#if TWO_SIDED
    // Of a one-sided surface the rasteriser shows the triangles that wind as the front does. It snaps vertices to a
    // grid, so that of a triangle seen edge-on, or smaller than the grid, it may find another side than n·p does.
    front = dot(n, sight(p)) <= 0.0;
    n = select(-n, n, front);
    out.is_front = u32(front);
#end
#end
#if NORMALS_AT_FRAGMENTS
    out.p = corner;
    out.n = n;
#end
#if VERTEX
    let shaded = vertex_parts(p, n, side(record, front), color.rgb, record);
#if MAPPED
#if VERTEX_DIFFUSE
    out.ambient = shaded.ambient;
    out.diffuse = shaded.diffuse;
#end
#if VERTEX_SPECULAR
    out.specular = shaded.specular;
#end
#else
    out.shade = all_parts(shaded);
#end
#if FACING
    let back = vertex_parts(p, -n, side(record, false), color.rgb, record);
#if MAPPED
#if VERTEX_DIFFUSE
    out.back_ambient = back.ambient;
    out.back_diffuse = back.diffuse;
#end
#if VERTEX_SPECULAR
    out.back_specular = back.specular;
#end
#else
    out.back_shade = all_parts(back);
#end
#end
#end
#end
#if RELIEF
    if NORMAL_MAP != NO_MAP {
        let t = TANGENT_SIGN * normalize_or_zero(eye_direction(object, vertex.tangent.xyz));
        out.frame = vec4f(t, BITANGENT_SIGN * vertex.tangent.w);
    } else {
        out.frame = vec4f(eye_direction(object, vertex.normal), 0.0);
    }
#end
#if MAPPED
    out.uv = vertex.uv;
    out.at = vertex.uv;
    // Mesa 22.3's lavapipe crashes where the fragment shader takes w as it comes.
    out.middle = vec4f(corner, -clip_w(corner));
#end
#if SOLID
    out.place = vec4f(vertex.position, 1.0);
    out.at_center = out.place;
#end
    return out;
}

#if VERTEX
// The interpolated terms of the visible side.
fn parts_of_vertices(in: Varyings, front: bool) -> Parts {
    var sums: Parts;
#if MAPPED
#if VERTEX_DIFFUSE
    sums.ambient = in.ambient;
    sums.diffuse = in.diffuse;
#end
#if VERTEX_SPECULAR
    sums.specular = in.specular;
#end
#else
    sums.diffuse = in.shade;
#end
#if FACING
    if !front {
#if MAPPED
#if VERTEX_DIFFUSE
        sums.ambient = in.back_ambient;
        sums.diffuse = in.back_diffuse;
#end
#if VERTEX_SPECULAR
        sums.specular = in.back_specular;
#end
#else
        sums.diffuse = in.back_shade;
#end
    }
#end
    return Parts(interpolated(sums.ambient), interpolated(sums.diffuse), interpolated(sums.specular));
}
#end

#if RELIEF
// A fragment's normal after images, and the inputs of its highlights.
struct Relief {
    n: vec3f,
    covariance: vec3f,    // of the slopes
    mean: f32,            // how long the mean of the normals is
}

fn eye_direction(object: Object, direction: vec3f) -> vec3f {
    return vec3f(dot(object.row0.xyz, direction), dot(object.row1.xyz, direction), dot(object.row2.xyz, direction));
}

// The same for a fragment whose normal is n without images.
fn relief(in: Varyings, c: Coordinates, n: vec3f) -> Relief {
    let amount = placings.each[6].row0.w;
    // A mirrored direction turns twice as far.
    let turns = select(2.0 * amount, amount, BLINN_PHONG);
    if LEAN {
        let slopes = at_footprint(normal_image, 6u, NORMAL_MAP, c).xy;
        let squares = at_footprint(height_image, 7u, NORMAL_MAP, c).xyz;
        let covariance = slope_covariance(slopes, squares, turns);
        let texel = vec3f(0.5 * slopes + 0.5, 1.0);
        let turned = mapped_normal(in.n, in.frame.xyz, in.frame.w, texel, amount, n);
        return Relief(turned, covariance, spread_length(covariance));
    }
    if NORMAL_MAP != NO_MAP {
        let texel = filtered(normal_image, 6u, NORMAL_MAP, c).xyz;
        var mean = 1.0;
        if TOKSVIG {
            mean = mean_length(texel, turns);
        }
        return Relief(mapped_normal(in.n, in.frame.xyz, in.frame.w, texel, amount, n), vec3f(), mean);
    }
    let along = gradient(height_image, 7u, HEIGHT_MAP, place_on(7u, HEIGHT_MAP, c), level_on(7u, HEIGHT_MAP, c));
    let right = way_on(7u, of_set(HEIGHT_MAP, dpdx(in.at)));
    let down = way_on(7u, of_set(HEIGHT_MAP, dpdy(in.at)));
    let rises = placings.each[7].row0.w * vec2f(dot(along, right), dot(along, down));
    return Relief(bumped_normal(in.n, in.frame.xyz, dpdx(in.middle.xyz), dpdy(in.middle.xyz), rises, n), vec3f(), 1.0);
}
#end

#if SOLID
override SOLID_KIND: u32 = 0;

struct SolidData {
    rows: array<vec4f, 3>,          // from the object's space to the solid's
    first: vec3f,                   // the colors
    octaves: u32,
    second: vec4f,
}

@group(1) @binding(9) var<uniform> solid: SolidData;

// A point if w is 1, or a vector if it is 0, in the solid's space.
fn in_solid(v: vec4f) -> vec3f {
    return vec3f(dot(solid.rows[0], v), dot(solid.rows[1], v), dot(solid.rows[2], v));
}

// The factor of the solid for the ambient and the diffuse part; c is the fragment's position in the object's space.
fn solid_color(c: Coordinates) -> vec3f {
    let x = in_solid(vec4f(c.dx.xyz, 0.0));
    let y = in_solid(vec4f(c.dy.xyz, 0.0));
    let t = solid_value(SOLID_KIND, solid.octaves, in_solid(vec4f(c.uv.xyz, 1.0)), x, y);
    return solid.first + t * (solid.second.xyz - solid.first);
}
#end

#if MAPPED
// I and the opacity, after images.
fn with_images(sums: Parts, emission: vec3f, opacity: f32, c: Coordinates) -> vec4f {
    var ambient = sums.ambient;
    if OCCLUSION_MAP != NO_MAP {
        ambient *= channel_of(OCCLUSION_MAP, factor(occlusion_image, 5u, OCCLUSION_MAP, c));
    }
    var tinted = ambient + sums.diffuse;
    var alpha = opacity;
    if COLOR_MAP != NO_MAP {
        let texel = factor(color_image, 0u, COLOR_MAP, c);
        tinted *= texel.rgb;
        if OPACITY_MAP == NO_MAP {
            alpha *= texel.a;
        }
    }
    var specular = sums.specular;
    if SPECULAR_MAP != NO_MAP {
        specular *= factor(specular_image, 1u, SPECULAR_MAP, c).rgb;
    }
    var emitted = emission;
    if EMISSION_MAP != NO_MAP {
        emitted *= factor(emission_image, 2u, EMISSION_MAP, c).rgb;
    }
    if OPACITY_MAP != NO_MAP {
        alpha *= channel_of(OPACITY_MAP, factor(opacity_image, 3u, OPACITY_MAP, c));
    }
    return vec4f(tinted + specular + emitted, alpha);
}
#end

// The output for a target.
fn output(shade: vec4f) -> vec4f {
    return vec4f(written(shade.rgb), select(1.0, shade.a, BLEND));
}

@fragment
fn fs_surface(
    in: Varyings,
#if FACING
    @builtin(front_facing) facing: bool,
#end
) -> @location(0) vec4f {
    let record = record_of(in.record);
    var front = true;
#if FACING
    front = facing;
#end
#if FLAT
#if TWO_SIDED
    front = in.is_front == 1u;
#end
#end
    let material = side(record, front);
    var color = vec4f(1.0);
#if PAINTED
    color = clamp(in.color, vec4f(), vec4f(1.0));
#end
    // The base is ka times the ambient light that nothing attenuates.
    var sums = Parts(color.rgb * material.base, vec3f(), vec3f());
#if VERTEX
    let of_vertices = parts_of_vertices(in, front);
    sums = Parts(sums.ambient + of_vertices.ambient, of_vertices.diffuse, of_vertices.specular);
#end
#if MAPPED
    let c = coordinates(in.uv, in.at, -in.middle.w);
#end
#if NORMALS_AT_FRAGMENTS
    // The exponent of highlights, and their factor.
    var lobe = vec2f(material.shininess, 1.0);
#if MAPPED
    if SHININESS_MAP != NO_MAP {
        lobe.x *= channel_of(SHININESS_MAP, factor(shininess_image, 4u, SHININESS_MAP, c));
    }
#end
    var n = in.n;
#if !FLAT
    n = fragment_normal(in.p, in.n, front);
#if RELIEF
    let turned = relief(in, c, n);
    n = turned.n;
    if LEAN {
        axial.axes = lobe_axes(n, in.frame.xyz, in.frame.w);
        let wide = lean_lobe(turned.covariance, lobe.x);
        axial.widths = wide.xyz;
        lobe = vec2f(toksvig(turned.mean, lobe.x).x, wide.w);
    } else if TOKSVIG {
        lobe = toksvig(turned.mean, lobe.x);
    }
#end
    n = select(-n, n, front);
#end
#if FRAGMENT
    var shiny = material;
    shiny.shininess = lobe.x;
    var terms = fragment_terms(in.p, n, shiny, record);
#if RELIEF
    terms.specular *= lobe.y;
#end
    let of_lights = parts(terms, material, color.rgb);
    sums = Parts(
        sums.ambient + of_lights.ambient, sums.diffuse + of_lights.diffuse, sums.specular + of_lights.specular,
    );
#end
#if SURROUNDED
    // The direction to the viewer is that of the shaded point, which lies in the triangle even if that covers a part of
    // a pixel of four samples.
    let around = surroundings_of(n, view_vector(in.p, n), lobe_exponent(BLINN_PHONG, lobe.x));
    sums.ambient += color.rgb * material.diffuse * around.mean;
    sums.specular += material.specular * around.seen;
#end
#end
#if SOLID
    let cut = solid_color(coordinates(in.place, in.at_center, -in.middle.w));
    sums = Parts(cut * sums.ambient, cut * sums.diffuse, sums.specular);
#end
    var emission = vec3f();
#if PAINTED
    // Else it is part of the base.
    emission = material.emission;
#end
    let opacity = color.a * material.opacity;
#if MAPPED
    let shade = with_images(sums, emission, opacity, c);
    if MASKED && shade.a < placings.cutoff.x {
        discard;
    }
    return output(shade);
#else
    return output(vec4f(emission + all_parts(sums), opacity));
#end
}
