// The entry points of draws with an image, whose color multiplies the ambient and diffuse terms at each fragment, and whose
// alpha the opacity; and so do colors of the vertices. Needs mesh.wgsl.
//
// Terms of the vertices are interpolated in two sums: what the image multiplies, and what it does not.

// As in halfway_texture: filters 0 nearest, 1 bilinear, 2 B-spline, 3 Catmull-Rom; levels 0 none, 1 the nearest, 2 two of
// them; beyond the image 0 the image again, 1 mirrored, 2 its edge.
override MAGNIFY: u32 = 1;
override MINIFY: u32 = 1;
override LEVELS: u32 = 2;
override WRAP_U: u32 = 0;
override WRAP_V: u32 = 0;

// Where the mesh's coordinates lie on the image, and where its levels are. All of them lie in one texture without levels,
// one after the other, in rows as wide as the texture: software adapters load from one level for four pixels at once.
struct Placing {
    row0: vec4f,
    row1: vec4f,
    levels: vec4u,                  // how many, and the width of the texture
    level: array<vec4u, 14>,        // the number of the first texel, columns, rows
}

@group(1) @binding(0) var image: texture_2d<f32>;
@group(1) @binding(1) var<uniform> placing: Placing;

fn placed(uv: vec2f) -> vec2f {
    return vec2f(dot(placing.row0.xy, uv) + placing.row0.z, dot(placing.row1.xy, uv) + placing.row1.z);
}

// ---- the image at a point: twins of halfway_texture::lookup -------------------------------------

// A coordinate in texels: taken into the image, or where it ends to within two texels of it.
fn wrapped(u: f32, side: f32, wrap: u32) -> f32 {
    if wrap == 0u {
        return (u - floor(u)) * side;
    }
    if wrap == 1u {
        let there_and_back = u - 2.0 * floor(0.5 * u);
        return side * select(there_and_back, 2.0 - there_and_back, there_and_back > 1.0);
    }
    return clamp(u * side, -2.0, side + 2.0);
}

fn wrapped_index(at: i32, side: i32, wrap: u32) -> i32 {
    if wrap == 0u {
        return (at % side + side) % side;
    }
    if wrap == 1u {
        let period = 2 * side;
        let there_and_back = (at % period + period) % period;
        return min(there_and_back, period - 1 - there_and_back);
    }
    return clamp(at, 0, side - 1);
}

// The weights of the texels around a point, at the part f of the way between two of them.
fn texel_weights(f: f32, filter_kind: u32) -> vec4f {
    let g = 1.0 - f;
    if filter_kind == 2u {
        return vec4f(g * g * g, (3.0 * f - 6.0) * f * f + 4.0, ((-3.0 * f + 3.0) * f + 3.0) * f + 1.0, f * f * f) / 6.0;
    }
    if filter_kind == 3u {
        return 0.5 * vec4f(
            ((2.0 - f) * f - 1.0) * f, (3.0 * f - 5.0) * f * f + 2.0, ((4.0 - 3.0 * f) * f + 1.0) * f, (f - 1.0) * f * f,
        );
    }
    return vec4f(0.0, g, f, 0.0);
}

fn texel_of(level: vec4u, at: vec2i) -> vec4f {
    let number = level.x + u32(at.y) * level.y + u32(at.x);
    return textureLoad(image, vec2u(number % placing.levels.y, number / placing.levels.y), 0);
}

fn in_level(uv: vec2f, number: u32, filter_kind: u32) -> vec4f {
    let level = placing.level[number];
    let size = vec2i(level.yz);
    let texels = vec2f(wrapped(uv.x, f32(size.x), WRAP_U), wrapped(uv.y, f32(size.y), WRAP_V));
    if filter_kind == 0u {
        return texel_of(level, clamp(vec2i(floor(texels)), vec2i(0), size - 1));
    }
    let first = floor(texels - 0.5);
    let part = texels - 0.5 - first;
    let columns = texel_weights(part.x, filter_kind);
    let rows = texel_weights(part.y, filter_kind);
    var low = 0;
    var high = 4;
    if filter_kind == 1u {
        low = 1;
        high = 3;
    }
    var sum = vec4f();
    for (var y = low; y < high; y++) {
        let row = wrapped_index(i32(first.y) + y - 1, size.y, WRAP_V);
        for (var x = low; x < high; x++) {
            let column = wrapped_index(i32(first.x) + x - 1, size.x, WRAP_U);
            sum += rows[y] * columns[x] * texel_of(level, vec2i(column, row));
        }
    }
    return sum;
}

// D = log2 of the longer side of the footprint: `at` is (u, v, w), w the distance along the view. (u, v)/w and 1/w are linear
// over the picture, so that their differences are their derivatives; the rule of quotients has those of u and v.
fn footprint_level(at: vec3f) -> f32 {
    let over_w = vec3f(at.xy, 1.0) / at.z;
    let dx = dpdx(over_w);
    let dy = dpdy(over_w);
    let size = vec2f(placing.level[0].yz) * at.z;
    let x = (dx.xy - at.xy * dx.z) * size;
    let y = (dy.xy - at.xy * dy.z) * size;
    return 0.5 * log2(max(dot(x, x), dot(y, y)));
}

fn filtered(uv: vec2f, d: f32) -> vec4f {
    if !(d > 0.0) {
        return in_level(uv, 0u, MAGNIFY);
    }
    if LEVELS == 0u {
        return in_level(uv, 0u, MINIFY);
    }
    let last = f32(placing.levels.x - 1u);
    if LEVELS == 1u {
        return in_level(uv, u32(min(floor(d + 0.5), last)), MINIFY);
    }
    let level = min(d, last);
    let finer = floor(level);
    let a = in_level(uv, u32(finer), MINIFY);
    if level == finer {
        return a;
    }
    return mix(a, in_level(uv, u32(finer) + 1u, MINIFY), level - finer);
}

fn mapped(uv: vec2f, at: vec3f) -> vec4f {
    return clamp(filtered(uv, footprint_level(at)), vec4f(), vec4f(1.0));
}

// ---- what is shaded ------------------------------------------------------------------------------

// What the image multiplies, with the opacity, and what it does not.
struct Parts {
    tinted: vec4f,
    plain: vec3f,
}

fn tinted_part(arriving: Irradiance, material: Material) -> vec3f {
    var sum = material.diffuse * arriving.diffuse;
    if ATTENUATED_AMBIENT {
        sum += material.ambient * arriving.ambient;
    }
    return sum;
}

fn plain_part(arriving: Irradiance, material: Material) -> vec3f {
    if SPECULAR {
        return material.specular * arriving.specular;
    }
    return vec3f();
}

fn parts(arriving: Irradiance, material: Material, emission: vec3f, color: vec4f) -> Parts {
    let tinted = color.rgb * (material.base + tinted_part(arriving, material));
    return Parts(vec4f(tinted, material.opacity * color.a), emission + plain_part(arriving, material));
}

fn front_parts(p: vec3f, n: vec3f, color: vec4f, record: u32) -> Parts {
    let arriving = vertex_terms(p, n, draws[record].front.shininess, record);
    return parts(arriving, draws[record].front, draws[record].front_emission, color);
}

fn back_parts(p: vec3f, n: vec3f, color: vec4f, record: u32) -> Parts {
    let arriving = vertex_terms(p, n, draws[record].back.shininess, record);
    return parts(arriving, draws[record].back, draws[record].back_emission, color);
}

fn output(tinted: vec4f, plain: vec3f, texel: vec4f) -> vec4f {
    let shade = texel.rgb * tinted.rgb + plain;
    return vec4f(written(shade), select(1.0, tinted.a * texel.a, BLEND));
}

struct Vertex {
    @location(6) position: vec3f,
    @location(7) normal: vec3f,
    @location(10) color: vec4f,
    @location(11) uv: vec2f,
}

// ---- flat ----------------------------------------------------------------------------------------

struct FlatVertex {
    @location(6) position: vec3f,
    @location(7) normal: vec3f,
    @location(8) centroid: vec3f,
    @location(10) color: vec4f,
    @location(11) uv: vec2f,
}

struct Flat {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat, first) tinted: vec4f,
    @location(1) @interpolate(flat, first) plain: vec3f,
    @location(2) @interpolate(perspective, centroid) uv: vec2f,
    @location(3) @interpolate(perspective, center) at: vec3f,
}

@vertex
fn vs_flat(object: Object, vertex: FlatVertex) -> Flat {
    let p = eye_position(object, vertex.centroid);
    let n = eye_normal(object, vertex.normal);
    let record = record_of(object.record);
    var shade: Parts;
    if !TWO_SIDED || dot(n, p) <= 0.0 {
        shade = front_parts(p, n, vertex.color, record);
    } else {
        shade = back_parts(p, -n, vertex.color, record);
    }
    let corner = eye_position(object, vertex.position);
    let uv = placed(vertex.uv);
    return Flat(clip_position(corner), shade.tinted, shade.plain, uv, vec3f(uv, -corner.z));
}

@fragment
fn fs_flat(in: Flat) -> @location(0) vec4f {
    return output(in.tinted, in.plain, mapped(in.uv, in.at));
}

// ---- no term at the fragments: Gouraud, or no lights ----------------------------------------------

struct Gouraud {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(perspective, centroid) front_tinted: vec4f,
    @location(1) @interpolate(perspective, centroid) front_plain: vec3f,
    @location(2) @interpolate(perspective, centroid) back_tinted: vec4f,
    @location(3) @interpolate(perspective, centroid) back_plain: vec3f,
    @location(4) @interpolate(perspective, centroid) uv: vec2f,
    @location(5) @interpolate(perspective, center) at: vec3f,
}

@vertex
fn vs_gouraud(object: Object, vertex: Vertex) -> Gouraud {
    let p = eye_position(object, vertex.position);
    let n = eye_normal(object, vertex.normal);
    let record = record_of(object.record);
    let front = front_parts(p, n, vertex.color, record);
    var back = Parts();
    if TWO_SIDED {
        back = back_parts(p, -n, vertex.color, record);
    }
    let uv = placed(vertex.uv);
    let at = vec3f(uv, -p.z);
    return Gouraud(clip_position(p), front.tinted, front.plain, back.tinted, back.plain, uv, at);
}

@fragment
fn fs_gouraud(in: Gouraud, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let texel = mapped(in.uv, in.at);
    let is_front = front || !TWO_SIDED;
    let tinted = select(in.back_tinted, in.front_tinted, is_front);
    let plain = select(in.back_plain, in.front_plain, is_front);
    return output(vec4f(interpolated(tinted.rgb), clamp(tinted.a, 0.0, 1.0)), interpolated(plain), texel);
}

// ---- some term at the fragments: Phong, or mixed ---------------------------------------------------

struct Mixed {
    @invariant @builtin(position) clip: vec4f,
    @location(0) @interpolate(perspective, centroid) p: vec3f,
    @location(1) @interpolate(perspective, centroid) n: vec3f,
    @location(2) @interpolate(perspective, centroid) color: vec4f,
    @location(3) @interpolate(perspective, centroid) front: vec3f,   // the terms of the vertices, of either side
    @location(4) @interpolate(perspective, centroid) back: vec3f,
    @location(5) @interpolate(perspective, centroid) uv: vec2f,
    @location(6) @interpolate(perspective, center) at: vec3f,
    @location(7) @interpolate(flat, either) record: u32,
}

// Of two terms one is here: the image multiplies it, or it does not.
fn of_vertices(terms: Irradiance, material: Material, color: vec3f) -> vec3f {
    if VERTEX_DIFFUSE {
        return color * tinted_part(terms, material);
    }
    return plain_part(terms, material);
}

@vertex
fn vs_mixed(object: Object, vertex: Vertex) -> Mixed {
    let p = eye_position(object, vertex.position);
    let n = eye_normal(object, vertex.normal);
    let record = record_of(object.record);
    let color = vertex.color;
    var front = vec3f();
    var back = vec3f();
    if VERTEX_DIFFUSE || VERTEX_SPECULAR {
        let terms = vertex_terms(p, n, draws[record].front.shininess, record);
        front = of_vertices(terms, draws[record].front, color.rgb);
        if TWO_SIDED {
            let behind = vertex_terms(p, -n, draws[record].back.shininess, record);
            back = of_vertices(behind, draws[record].back, color.rgb);
        }
    }
    let uv = placed(vertex.uv);
    return Mixed(clip_position(p), p, n, color, front, back, uv, vec3f(uv, -p.z), object.record);
}

@fragment
fn fs_mixed(in: Mixed, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let texel = mapped(in.uv, in.at);
    let n = fragment_normal(in.p, in.n, front);
    let record = record_of(in.record);
    let color = clamp(in.color, vec4f(), vec4f(1.0));
    var material = draws[record].front;
    var emission = draws[record].front_emission;
    var interpolated_terms = interpolated(in.front);
    var side = n;
    if TWO_SIDED && !front {
        material = draws[record].back;
        emission = draws[record].back_emission;
        interpolated_terms = interpolated(in.back);
        side = -n;
    }
    let terms = fragment_terms(in.p, side, material.shininess, record);
    var shade = parts(terms, material, emission, color);
    if VERTEX_DIFFUSE {
        shade.tinted += vec4f(interpolated_terms, 0.0);
    } else {
        shade.plain += interpolated_terms;
    }
    return output(shade.tinted, shade.plain, texel);
}
