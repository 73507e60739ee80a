// An image at a fragment where its filter goes by the footprint's shape: twins of
// halfway_texture::lookup. Needs maps.wgsl.

// 0 by D alone, 1 a ripmap, 2 summed areas, 3 to 6 up to 2, 4, 8 and 16 probes, 7 the elliptical mean.
fn shape_of(look: u32) -> u32 {
    return look >> 13u & 7u;
}

// An ellipse, in texels: its moments uu, uv and vv, and its semiaxes. One of more than 10^9 texels is a circle of so
// many.
struct FootprintShape {
    moments: vec3f,
    long: f32,
    short: f32,
}

// `a` and `b` are the ways to the next pixels, in texels.
fn footprint_shape(a: vec2f, b: vec2f) -> FootprintShape {
    let moments = vec3f(a.x * a.x + b.x * b.x, a.x * a.y + b.x * b.y, a.y * a.y + b.y * b.y);
    if moments.x + moments.z > 1e18 {
        return FootprintShape(vec3f(1e18, 0.0, 1e18), 1e9, 1e9);
    }
    let apart = 0.5 * (moments.x - moments.z);
    let long = sqrt(0.5 * (moments.x + moments.z) + sqrt(apart * apart + moments.y * moments.y));
    let area = abs(a.x * b.y - a.y * b.x);
    return FootprintShape(moments, long, min(area / max(long, 1e-30), long));
}

// The direction of the long axis.
fn long_direction(moments: vec3f) -> vec2f {
    let apart = 0.5 * (moments.x - moments.z);
    let radius = sqrt(apart * apart + moments.y * moments.y);
    // Of the two forms of an eigenvector the one that does not cancel.
    let along = select(vec2f(moments.y, radius - apart), vec2f(apart + radius, moments.y), apart >= 0.0);
    let size = length(along);
    return select(vec2f(1.0, 0.0), along / max(size, 1e-30), size > 0.0);
}

// ---- probes ---------------------------------------------------------------------------------------

// The filters of an image that is reduced also if D is 0.
fn reduced(look: u32) -> u32 {
    return (look & ~3u) | minify_of(look);
}

fn probes(image: texture_2d<f32>, slot: u32, look: u32, uv: vec2f, shape: FootprintShape) -> vec4f {
    let most = f32(1u << (shape_of(look) - 2u));
    let n = min(shape.long / max(shape.short, 1.0), most);
    let apart = shape.long / n;
    let d = log2(apart);
    let step = apart * long_direction(shape.moments) / vec2f(placings.each[slot].level[0].yz);
    var sum = at_level(image, slot, reduced(look), uv, d);
    var left = n - 1.0;
    for (var k = 1.0; left > 0.0; k += 1.0) {
        let a = at_level(image, slot, reduced(look), uv + k * step, d);
        let b = at_level(image, slot, reduced(look), uv - k * step, d);
        sum += 0.5 * min(left, 2.0) * (a + b);
        left -= 2.0;
    }
    return sum / n;
}

// ---- ripmaps ---------------------------------------------------------------------------------------
//
// Of each number of halvings a level has the columns of all wider images, the width, the height, and the rows of all
// higher ones; `levels` has how many widths, the width of the texture, how many heights, and the columns of all widths.

fn ripmap_level(slot: u32, at: vec2u) -> vec4u {
    let of_columns = placings.each[slot].level[at.x];
    let of_rows = placings.each[slot].level[at.y];
    let start = of_rows.w * placings.each[slot].levels.w + of_rows.z * of_columns.x;
    return vec4u(start, of_columns.y, of_rows.z, 0u);
}

fn in_ripmap(image: texture_2d<f32>, slot: u32, look: u32, uv: vec2f, shape: FootprintShape) -> vec4f {
    let last = vec2f(placings.each[slot].levels.xz - 1u);
    let d = clamp(0.5 * log2(max(shape.moments.xz, vec2f(1.0))), vec2f(), last);
    let finer = floor(d);
    let part = d - finer;
    var sum = vec4f();
    for (var j = 0u; j < 2u; j++) {
        let of_row = select(1.0 - part.y, part.y, j == 1u);
        for (var i = 0u; i < 2u; i++) {
            let weight = of_row * select(1.0 - part.x, part.x, i == 1u);
            if weight > 0.0 {
                let level = ripmap_level(slot, vec2u(finer) + vec2u(i, j));
                sum += weight * in_image(image, slot, level, wrap_of(look), uv, minify_of(look));
            }
        }
    }
    return sum;
}

// ---- summed areas ----------------------------------------------------------------------------------
//
// Behind the image, level 1 is the table, with two texels for each sum; level 2 has the bits of the mean, level 3 those
// of what the sums are in units of.

// A part of an interval that lies within one image: its ends in texels of it, and its weight. Three of them are the
// whole.
fn part_of(middle: f32, length: f32, side: f32, wrap: u32, number: u32) -> vec3f {
    if wrap == 2u {
        let at = clamp(middle * side, -length, side + length);
        let low = at - 0.5 * length;
        let high = at + 0.5 * length;
        if number == 0u {
            return vec3f(clamp(low, 0.0, side), clamp(high, 0.0, side), 1.0);
        }
        // The outermost texels go on.
        if number == 1u {
            return vec3f(0.0, 1.0, max(min(high, 0.0) - low, 0.0));
        }
        return vec3f(side - 1.0, side, max(high - max(low, side), 0.0));
    }
    let at = side * select(middle - floor(middle), middle - 2.0 * floor(0.5 * middle), wrap == 1u);
    let low = at - 0.5 * length;
    let high = at + 0.5 * length;
    let periods = vec2f(floor(low / side), floor(high / side));
    let ends = clamp(vec2f(low, high) - periods * side, vec2f(), vec2f(side));
    let between = periods.y - periods.x;
    var part = vec3f(0.0, side, between - 1.0);
    var period = 0.0;
    if number == 0u {
        part = vec3f(ends.x, select(side, ends.y, between == 0.0), 1.0);
        period = periods.x;
    } else if number == 1u {
        part = vec3f(0.0, ends.y, 1.0);
        period = periods.y;
    }
    if wrap == 1u && abs(period - 2.0 * floor(0.5 * period)) == 1.0 {
        part = vec3f(side - part.y, side - part.x, part.z);
    }
    return select(part, vec3f(), number > 0u && between == 0.0);
}

// The sums of a row at three columns, less that at the first of four: first halves, and seconds.
struct Strip {
    high: mat3x4f,
    low: mat3x4f,
}

fn strip(image: texture_2d<f32>, slot: u32, columns: vec4i, row: i32) -> Strip {
    let table = placings.each[slot].level[1];
    let at = 2 * columns;
    let high = texel_of(image, slot, table, vec2i(at.x, row));
    let low = texel_of(image, slot, table, vec2i(at.x + 1, row));
    return Strip(
        mat3x4f(
            texel_of(image, slot, table, vec2i(at.y, row)) - high,
            texel_of(image, slot, table, vec2i(at.z, row)) - high,
            texel_of(image, slot, table, vec2i(at.w, row)) - high,
        ),
        mat3x4f(
            texel_of(image, slot, table, vec2i(at.y + 1, row)) - low,
            texel_of(image, slot, table, vec2i(at.z + 1, row)) - low,
            texel_of(image, slot, table, vec2i(at.w + 1, row)) - low,
        ),
    );
}

// The sum between two rows, of the three columns with these weights. First halves are exact until they are weighted.
fn between_rows(a: Strip, b: Strip, weights: vec3f) -> vec4f {
    return (b.high - a.high) * weights + (b.low - a.low) * weights;
}

// The sum of a rectangle within the image, each texel being a square of its value: its ends along u, and along v.
fn rectangle(image: texture_2d<f32>, slot: u32, along_u: vec2f, along_v: vec2f) -> vec4f {
    let last = vec2i(placings.each[slot].level[0].yz) - 1;
    let column = min(vec2i(along_u), vec2i(last.x));
    let row = min(vec2i(along_v), vec2i(last.y));
    let u = along_u - vec2f(column);
    let v = along_v - vec2f(row);
    let columns = vec4i(column.x, column.x + 1, column.y, column.y + 1);
    let weights = vec3f(-u.x, 1.0 - u.y, u.y);
    let first = strip(image, slot, columns, row.x);
    var sum = -v.x * between_rows(first, strip(image, slot, columns, row.x + 1), weights);
    sum += (1.0 - v.y) * between_rows(first, strip(image, slot, columns, row.y), weights);
    return sum + v.y * between_rows(first, strip(image, slot, columns, row.y + 1), weights);
}

fn summed(image: texture_2d<f32>, slot: u32, look: u32, uv: vec2f, shape: FootprintShape) -> vec4f {
    let sides = vec2f(placings.each[slot].level[0].yz);
    let lengths = clamp(sqrt(shape.moments.xz), vec2f(1.0), 4096.0 * sides);
    let wrap = wrap_of(look);
    var sum = vec4f();
    for (var j = 0u; j < 3u; j++) {
        let rows = part_of(uv.y, lengths.y, sides.y, wrap.y, j);
        for (var i = 0u; i < 3u && rows.z > 0.0; i++) {
            let columns = part_of(uv.x, lengths.x, sides.x, wrap.x, i);
            if columns.z > 0.0 {
                sum += columns.z * rows.z * rectangle(image, slot, columns.xy, rows.xy);
            }
        }
    }
    let mean = bitcast<vec4f>(placings.each[slot].level[2]);
    let unit = bitcast<vec4f>(placings.each[slot].level[3]);
    return mean + unit * (sum / (lengths.x * lengths.y));
}

// ---- the elliptical mean --------------------------------------------------------------------------

// Moments with both eigenvalues at least 1.
fn widened(m: vec3f) -> vec3f {
    let apart = 0.5 * (m.x - m.z);
    let radius = sqrt(apart * apart + m.y * m.y);
    let large = 0.5 * (m.x + m.z) + radius;
    let small = 0.5 * (m.x + m.z) - radius;
    if small >= 1.0 {
        return m;
    }
    if large <= 1.0 || radius <= 0.0 {
        return vec3f(1.0, 0.0, 1.0);
    }
    let share = (large - 1.0) / (large - small);
    return vec3f(1.0 + (m.x - small) * share, m.y * share, 1.0 + (m.z - small) * share);
}

// r^2 = a x^2 + 2b xy + c y^2, and w: ac - b^2, in texels of a level of which `scale` is how large it is to the image.
fn ellipse_of(shape: FootprintShape, short: f32, scale: vec2f) -> vec4f {
    let along = long_direction(shape.moments);
    let long = max(shape.long, short);
    let more = (long - short) * (long + short);
    let round = short * short;
    let size = vec3f(scale.x * scale.x, scale.x * scale.y, scale.y * scale.y);
    let m_uu = round + more * along.x * along.x;
    let m_vv = round + more * along.y * along.y;
    let whole = vec3f(m_uu, more * along.x * along.y, m_vv) * size;
    let less = 64.0 / max(sqrt(whole.xz), vec2f(64.0));
    let m = widened(whole * vec3f(less.x * less.x, less.x * less.y, less.y * less.y));
    let inverse = 1.0 / (m.x * m.z - m.y * m.y);
    return vec4f(m.z * inverse, -m.y * inverse, m.x * inverse, inverse);
}

// e^x - e^-1 with x = 1 - 2r^2, the power by its series.
fn gaussian(r2: f32) -> f32 {
    let x = 1.0 - 2.0 * r2;
    var power = 1.0 / 40320.0;
    power = power * x + 1.0 / 5040.0;
    power = power * x + 1.0 / 720.0;
    power = power * x + 1.0 / 120.0;
    power = power * x + 1.0 / 24.0;
    power = power * x + 1.0 / 6.0;
    power = power * x + 0.5;
    power = power * x + 1.0;
    power = power * x + 1.0;
    return max(power - 0.36787944, 0.0);
}

// A coordinate in texels, within one period of the image, or within reach of it.
fn within(u: f32, side: f32, reach: f32, wrap: u32) -> f32 {
    if wrap == 0u {
        return (u - floor(u)) * side;
    }
    if wrap == 1u {
        return (u - 2.0 * floor(0.5 * u)) * side;
    }
    return clamp(u * side, -reach - 2.0, side + reach + 2.0);
}

// The texels of a level in an ellipse.
fn in_ellipse(image: texture_2d<f32>, slot: u32, wrap: vec2u, uv: vec2f, number: u32, ellipse: vec4f) -> vec4f {
    let level = placings.each[slot].level[number];
    let size = vec2i(level.yz);
    let reach = sqrt(ellipse.zx / ellipse.w);
    let middle_x = within(uv.x, f32(size.x), reach.x, wrap.x);
    let middle_y = within(uv.y, f32(size.y), reach.y, wrap.y);
    // Row by row in one loop that counts what is left: draws with a loop whose bounds take a uniform crash llvmpipe of
    // Mesa
    // 22.3 through Vulkan.
    var row = i32(ceil(middle_y - reach.y - 0.5)) - 1;
    var rows = i32(floor(middle_y + reach.y - 0.5)) - row;
    var sum = vec4f();
    var weights = 0.0;
    var y = 0.0;
    var at = 0;
    var column = 1;
    var last = 0;
    loop {
        if column <= last {
            let x = f32(column) + 0.5 - middle_x;
            let weight = gaussian(ellipse.x * x * x + 2.0 * ellipse.y * x * y + ellipse.z * y * y);
            weights += weight;
            sum += weight * texel_of(image, slot, level, vec2i(wrapped_index(column, size.x, wrap.x), at));
            column++;
            continue;
        }
        if rows <= 0 {
            break;
        }
        rows--;
        row++;
        y = f32(row) + 0.5 - middle_y;
        at = wrapped_index(row, size.y, wrap.y);
        let root = sqrt(max(ellipse.x - ellipse.w * y * y, 0.0));
        column = i32(ceil(middle_x - (root + ellipse.y * y) / ellipse.x - 0.5));
        last = i32(floor(middle_x + (root - ellipse.y * y) / ellipse.x - 0.5));
    }
    return sum / weights;
}

fn elliptical(image: texture_2d<f32>, slot: u32, look: u32, uv: vec2f, shape: FootprintShape) -> vec4f {
    let short = max(max(shape.short, shape.long / 16.0), 1.0);
    let last = placings.each[slot].levels.x - 1u;
    let d = max(log2(short), 0.0);
    if d >= f32(last) {
        return texel_of(image, slot, placings.each[slot].level[last], vec2i());
    }
    let full = vec2f(placings.each[slot].level[0].yz);
    let finer = u32(d);
    let part = d - floor(d);
    var sum = vec4f();
    for (var k = 0u; k < 2u; k++) {
        let weight = select(1.0 - part, part, k == 1u);
        if weight > 0.0 {
            let scale = vec2f(placings.each[slot].level[finer + k].yz) / full;
            let ellipse = ellipse_of(shape, short, scale);
            sum += weight * in_ellipse(image, slot, wrap_of(look), uv, finer + k, ellipse);
        }
    }
    return sum;
}

// ---- all of them ----------------------------------------------------------------------------------

fn at_shape(image: texture_2d<f32>, slot: u32, look: u32, uv: vec2f, shape: FootprintShape) -> vec4f {
    if !(shape.long > 1.0) {
        return in_level(image, slot, wrap_of(look), uv, 0u, magnify_of(look));
    }
    if shape_of(look) == 1u {
        return in_ripmap(image, slot, look, uv, shape);
    }
    if shape_of(look) == 2u {
        return summed(image, slot, look, uv, shape);
    }
    if shape_of(look) == 7u {
        return elliptical(image, slot, look, uv, shape);
    }
    return probes(image, slot, look, uv, shape);
}

fn at_footprint(image: texture_2d<f32>, slot: u32, look: u32, c: Coordinates) -> vec4f {
    let uv = place_on(slot, look, c);
    if shape_of(look) == 0u {
        return at_level(image, slot, look, uv, level_on(slot, look, c));
    }
    let size = vec2f(placings.each[slot].level[0].yz);
    let a = way_on(slot, of_set(look, c.dx)) * size;
    let b = way_on(slot, of_set(look, c.dy)) * size;
    return at_shape(image, slot, look, uv, footprint_shape(a, b));
}
