// Draws with images, or of which a mask cuts something out: what mapped.wgsl and surrounded.wgsl share. Images count at
// each fragment: what they multiply apart is interpolated apart. Colors of the vertices multiply where light is
// evaluated. Needs maps.wgsl.

struct Parts {
    ambient: vec3f,
    diffuse: vec3f,
    specular: vec3f,
}

fn ambient_part(arriving: Irradiance, material: Material) -> vec3f {
    if ATTENUATED_AMBIENT {
        return material.ambient * arriving.ambient;
    }
    return vec3f();
}

fn specular_part(arriving: Irradiance, material: Material) -> vec3f {
    if SPECULAR {
        return material.specular * arriving.specular;
    }
    return vec3f();
}

// The base is ka times the ambient light that nothing attenuates.
fn parts(arriving: Irradiance, material: Material, color: vec3f) -> Parts {
    let ambient = color * (material.base + ambient_part(arriving, material));
    return Parts(ambient, color * material.diffuse * arriving.diffuse, specular_part(arriving, material));
}

fn front_parts(p: vec3f, n: vec3f, color: vec4f, record: u32) -> Parts {
    return parts(vertex_terms(p, n, draws[record].front.shininess, record), draws[record].front, color.rgb);
}

fn back_parts(p: vec3f, n: vec3f, color: vec4f, record: u32) -> Parts {
    return parts(vertex_terms(p, n, draws[record].back.shininess, record), draws[record].back, color.rgb);
}

// I and the opacity, from the parts, and from the opacity that the vertices' colors have.
fn output(sums: Parts, alpha: f32, record: u32, front: bool, c: Coordinates) -> vec4f {
    var opacity = clamp(alpha, 0.0, 1.0) * select(draws[record].back.opacity, draws[record].front.opacity, front);
    var emission = select(draws[record].back_emission, draws[record].front_emission, front);
    var ambient = sums.ambient;
    var specular = sums.specular;
    if OCCLUSION_MAP != NO_MAP {
        ambient *= channel_of(OCCLUSION_MAP, factor(occlusion_image, 5u, OCCLUSION_MAP, c));
    }
    var tinted = ambient + sums.diffuse;
    if COLOR_MAP != NO_MAP {
        let texel = factor(color_image, 0u, COLOR_MAP, c);
        tinted *= texel.rgb;
        if OPACITY_MAP == NO_MAP {
            opacity *= texel.a;
        }
    }
    if SPECULAR_MAP != NO_MAP {
        specular *= factor(specular_image, 1u, SPECULAR_MAP, c).rgb;
    }
    if EMISSION_MAP != NO_MAP {
        emission *= factor(emission_image, 2u, EMISSION_MAP, c).rgb;
    }
    if OPACITY_MAP != NO_MAP {
        opacity *= channel_of(OPACITY_MAP, factor(opacity_image, 3u, OPACITY_MAP, c));
    }
    if MASKED && opacity < placings.cutoff.x {
        discard;
    }
    return vec4f(written(tinted + specular + emission), select(1.0, opacity, BLEND));
}

struct Vertex {
    @location(6) position: vec3f,
    @location(7) normal: vec3f,
    @location(10) color: vec4f,
    @location(11) uv: vec4f,         // of both sets
    @location(12) tangent: vec4f,
}

struct FlatVertex {
    @location(6) position: vec3f,
    @location(7) normal: vec3f,
    @location(8) centroid: vec3f,
    @location(10) color: vec4f,
    @location(11) uv: vec4f,
}

// ---- some term at the fragments: Phong, or mixed ---------------------------------------------------

struct Mixed {
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
}

// Of two terms one is here: the diffuse, with what is attenuated of the ambient one, or the specular.
fn of_vertices(terms: Irradiance, material: Material, color: vec3f) -> vec3f {
    if VERTEX_DIFFUSE {
        return color * material.diffuse * terms.diffuse;
    }
    return specular_part(terms, material);
}

fn eye_direction(object: Object, direction: vec3f) -> vec3f {
    return vec3f(dot(object.row0.xyz, direction), dot(object.row1.xyz, direction), dot(object.row2.xyz, direction));
}

fn mixed_vertex(object: Object, vertex: Vertex) -> Mixed {
    let p = eye_position(object, vertex.position);
    let n = eye_normal(object, vertex.normal);
    let record = record_of(object.record);
    let color = vertex.color;
    var front = vec3f();
    var back = vec3f();
    var front_ambient = vec3f();
    var back_ambient = vec3f();
    if VERTEX_DIFFUSE || VERTEX_SPECULAR {
        let terms = vertex_terms(p, n, draws[record].front.shininess, record);
        front = of_vertices(terms, draws[record].front, color.rgb);
        if VERTEX_DIFFUSE {
            front_ambient = color.rgb * ambient_part(terms, draws[record].front);
        }
        if TWO_SIDED {
            let behind = vertex_terms(p, -n, draws[record].back.shininess, record);
            back = of_vertices(behind, draws[record].back, color.rgb);
            if VERTEX_DIFFUSE {
                back_ambient = color.rgb * ambient_part(behind, draws[record].back);
            }
        }
    }
    var frame = vec4f();
    if NORMAL_MAP != NO_MAP {
        let t = TANGENT_SIGN * normalize_or_zero(eye_direction(object, vertex.tangent.xyz));
        frame = vec4f(t, BITANGENT_SIGN * vertex.tangent.w);
    } else if HEIGHT_MAP != NO_MAP {
        frame = vec4f(eye_direction(object, vertex.normal), 0.0);
    }
    let uv = vertex.uv;
    return Mixed(
        clip_position(p), p, n, color, front, back, front_ambient, back_ambient, frame, uv, uv, p, object.record,
    );
}

@vertex
fn vs_mixed(object: Object, vertex: Vertex) -> Mixed {
    return mixed_vertex(object, vertex);
}

// What a fragment has before images multiply it.
struct MixedParts {
    sums: Parts,
    n: vec3f,                 // of the side that is seen
    color: vec4f,
    record: u32,
    is_front: bool,
    c: Coordinates,
    mean: f32,                // how long the mean of the normals there is, as highlights take it
}

fn mixed_parts(in: Mixed, front: bool) -> MixedParts {
    let c = coordinates(in.uv, in.at, -in.middle.z);
    let record = record_of(in.record);
    let color = clamp(in.color, vec4f(), vec4f(1.0));
    let is_front = front || !TWO_SIDED;
    var n = fragment_normal(in.p, in.n, front);
    var mean = 1.0;
    var covariance = vec3f();
    let amount = placings.each[6].row0.w;
    // What is mirrored turns twice as far.
    let turns = select(2.0 * amount, amount, BLINN_PHONG);
    if LEAN {
        let slopes = at_footprint(normal_image, 6u, NORMAL_MAP, c).xy;
        let squares = at_footprint(height_image, 7u, NORMAL_MAP, c).xyz;
        n = mapped_normal(in.n, in.frame.xyz, in.frame.w, vec3f(0.5 * slopes + 0.5, 1.0), amount, n);
        covariance = slope_covariance(slopes, squares, turns);
        mean = spread_length(covariance);
        axial.axes = lobe_axes(n, in.frame.xyz, in.frame.w);
    } else if NORMAL_MAP != NO_MAP {
        let texel = filtered(normal_image, 6u, NORMAL_MAP, c);
        n = mapped_normal(in.n, in.frame.xyz, in.frame.w, texel.xyz, amount, n);
        if TOKSVIG {
            mean = mean_length(texel.xyz, turns);
        }
    } else if HEIGHT_MAP != NO_MAP {
        let along = gradient(height_image, 7u, HEIGHT_MAP, place_on(7u, HEIGHT_MAP, c), level_on(7u, HEIGHT_MAP, c));
        let right = way_on(7u, of_set(HEIGHT_MAP, dpdx(in.at)));
        let down = way_on(7u, of_set(HEIGHT_MAP, dpdy(in.at)));
        let rises = placings.each[7].row0.w * vec2f(dot(along, right), dot(along, down));
        n = bumped_normal(in.n, in.frame.xyz, dpdx(in.middle), dpdy(in.middle), rises, n);
    }
    var material = draws[record].front;
    var terms_of_vertices = interpolated(in.front);
    var ambient_of_vertices = interpolated(in.front_ambient);
    if !is_front {
        material = draws[record].back;
        terms_of_vertices = interpolated(in.back);
        ambient_of_vertices = interpolated(in.back_ambient);
        n = -n;
    }
    var exponent = material.shininess;
    if SHININESS_MAP != NO_MAP {
        exponent *= channel_of(SHININESS_MAP, factor(shininess_image, 4u, SHININESS_MAP, c));
    }
    var far = vec2f(exponent, 1.0);
    if LEAN {
        let lobe = lean_lobe(covariance, exponent);
        axial.widths = lobe.xyz;
        far = vec2f(toksvig(mean, exponent).x, lobe.w);
    } else if TOKSVIG {
        far = toksvig(mean, exponent);
    }
    var terms = fragment_terms(in.p, n, far.x, record);
    if LEAN || TOKSVIG {
        terms.specular *= far.y;
    }
    var sums = parts(terms, material, color.rgb);
    if VERTEX_DIFFUSE {
        sums.ambient += ambient_of_vertices;
        sums.diffuse += terms_of_vertices;
    } else {
        sums.specular += terms_of_vertices;
    }
    return MixedParts(sums, n, color, record, is_front, c, mean);
}
