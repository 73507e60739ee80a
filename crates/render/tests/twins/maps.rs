//! Twins: the functions of maps.wgsl, `by_level.wgsl` and factors.wgsl, run on the adapter over images, against their
//! definition in f64.

use halfway_render::Gpu;
use std::collections::BTreeSet;

use crate::adapter::{Bound, results_with};
use crate::derivatives;
use crate::images::bound;
use crate::map_rows::{image_rows, look_rows, texel_rows};
use crate::normal_rows::normal_rows;
use crate::place_rows::place_rows;
use crate::table::Row;
use crate::{LIGHTING, far_of, named, parsed};

const MAPS: &str = concat!(
    include_str!("../../src/gpu/shaders/maps.wgsl"),
    include_str!("../../src/gpu/shaders/by_level.wgsl"),
    include_str!("../../src/gpu/shaders/factors.wgsl"),
);

fn rows() -> Vec<Row> {
    [look_rows(), texel_rows(), image_rows(), place_rows(), normal_rows()].into_iter().flatten().collect()
}

/// The functions that rows call; derivatives are in fragments alone.
fn called(rows: &[Row]) -> BTreeSet<&'static str> {
    rows.iter().map(|row| row.function).chain([derivatives::FUNCTION]).collect()
}

fn too_far(gpu: &Gpu, bound: &Bound, maps: &str, row: &Row) -> Option<String> {
    let text = format!("{}{maps}", *LIGHTING);
    far_of(row, results_with(gpu, (&text, Some(bound)), (row.call, row.kind), row.constants, &row.inputs))
}

#[test]
fn each_function_of_maps_matches_its_twin() {
    let gpu = Gpu::open_headless().expect("an adapter");
    let bound = bound(&gpu.device, &gpu.queue);
    let mut failures: Vec<String> = rows().iter().filter_map(|row| too_far(&gpu, &bound, MAPS, row)).collect();
    failures.extend(derivatives::too_far(&gpu, &format!("{}{MAPS}", *LIGHTING)));
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Faults: the function whose rows find it, what is right, and what is written instead.
const FAULTS: [(&str, &str, &str); 57] = [
    ("magnify_of", "return look & 3u", "return look & 1u"),
    ("minify_of", "look >> 2u & 3u", "look >> 1u & 3u"),
    ("levels_of", "look >> 4u & 3u", "look >> 4u & 1u"),
    ("wrap_of", "vec2u(look >> 6u & 3u, look >> 8u & 3u)", "vec2u(look >> 8u & 3u, look >> 6u & 3u)"),
    ("channel_of", "look >> 10u & 3u", "look >> 9u & 3u"),
    ("takes_second", "look >> 12u & 1u", "look >> 11u & 1u"),
    ("wrapped", "(u - floor(u)) * side", "abs(u - trunc(u)) * side"),
    ("wrapped", "there_and_back > 1.0", "there_and_back > 1.5"),
    ("wrapped", "clamp(u * side, -2.0, side + 2.0)", "clamp(u * side, 0.0, side)"),
    ("remainder", "side - 1 - rest", "side - rest"),
    ("remainder", "return select(rest, side - 1 - rest, below)", "return at % side"),
    ("wrapped_index", "2 * side - 1 - there_and_back", "2 * side - there_and_back"),
    ("wrapped_index", "clamp(at, 0, side - 1)", "clamp(at, 0, side)"),
    ("texel_weights", "let g = 1.0 - f", "let g = 0.9999 - f"),
    ("texel_weights", "(-3.0 * f + 3.0) * f + 3.0", "(-3.0 * f + 3.0) * f + 3.001"),
    ("texel_weights", "(3.0 * f - 5.0) * f * f", "(3.0 * f - 5.0) * f"),
    ("texel_of", "u32(at.y) * level.y", "u32(at.y) * level.z"),
    ("texel_of", "number % width, number / width", "number % width, 0"),
    ("in_image", "clamp(vec2i(floor(texels)), vec2i(0), size - 1)", "vec2i(floor(texels)) % size"),
    ("in_image", "let first = floor(texels - 0.5)", "let first = floor(texels)"),
    ("in_image", "size.y, wrap.y)", "size.y, wrap.x)"),
    ("in_image", "f32(size.x), wrap.x)", "f32(size.x), wrap.y)"),
    ("in_level", ".level[number], wrap", ".level[0], wrap"),
    ("at_level", "!(d > 0.0)", "!(d > 0.5)"),
    ("at_level", "floor(d + 0.5)", "floor(d)"),
    ("at_level", "uv, 0u, magnify_of(look)", "uv, 0u, minify"),
    ("at_level", "minify), level - finer)", "minify), 0.999 * (level - finer))"),
    ("gradient", "exp2(min(d", "exp2(0.99 * min(d"),
    ("gradient", "look) != 0u && d > 0.0", "look) != 0u"),
    ("gradient", "vec2f(0.5 * across.x, 0.0)", "vec2f(0.501 * across.x, 0.0)"),
    ("coordinates", "at * dpdx(1.0 / w)", "at * dpdx(1.0 / at.x)"),
    ("coordinates", "dpdy(over_w) - at", "dpdy(at) - at"),
    ("coordinates", "Coordinates(uv, dx", "Coordinates(at, dx"),
    ("of_set", "select(both.xy, both.zw", "select(both.zw, both.xy"),
    ("way_on", "row1.xy, way", "row0.xy, way"),
    ("place_on", "row0.z, placings", "row1.z, placings"),
    ("level_on", "0.5 * log2(max(", "0.5 * log2(min("),
    ("level_on", "of_set(look, c.dy)", "of_set(look, c.dx)"),
    ("at_footprint", "level_on(slot, look, c));", "0.0);"),
    ("filtered", "vec4f(), vec4f(1.0))", "vec4f(), vec4f(2.0))"),
    ("factor", "look, c) - 1.0)", "look, c))"),
    ("mapped_normal", "w * x.y * s", "x.y * s"),
    ("mapped_normal", "length(n) > NORMAL_MIN && ", ""),
    ("mapped_normal", " && dot(turned, turned) > 0.0", ""),
    ("mean_length", "s * s * (1.0 - found)", "s * (1.0 - found)"),
    ("mean_length", "1.0, found >= 1.0", "found, found >= 1.0"),
    ("toksvig", "(1.0 + f * exponent) /", "(1.0 + exponent) /"),
    ("toksvig", "within + exponent *", "1.0 + exponent *"),
    ("slope_covariance", "squares.y - mean.x * mean.y", "squares.y"),
    ("slope_covariance", "clamp(s, -1e6, 1e6)", "s"),
    ("spread_length", "0.5 * (covariance.x + covariance.z)", "0.5 * covariance.x + covariance.z"),
    ("lean_lobe", "vec3f(yy, -wide.y, xx)", "vec3f(xx, -wide.y, yy)"),
    ("lean_lobe", "wide.y * wide.y, xx + yy - 1.0)", "wide.y * wide.y, 1.0)"),
    ("lobe_axes", "t - n * dot(n, t)", "t"),
    ("lobe_axes", "w * cross(n, along)", "cross(n, along)"),
    ("bumped_normal", "cross(unit, e1)", "cross(e1, unit)"),
    ("bumped_normal", "if size <= NORMAL_MIN {", "if size <= 1e-7 {"),
];

#[test]
fn a_planted_fault_in_any_function_of_maps_is_found() {
    let gpu = Gpu::open_headless().expect("an adapter");
    let bound = bound(&gpu.device, &gpu.queue);
    let rows = rows();
    let mut passed = Vec::new();
    for (function, right, wrong) in FAULTS {
        assert_eq!(MAPS.matches(right).count(), 1, "{right} is in the text once");
        let faulty = MAPS.replace(right, wrong);
        let found = if function == derivatives::FUNCTION {
            derivatives::too_far(&gpu, &format!("{}{faulty}", *LIGHTING)).is_some()
        } else {
            let mut of_it = rows.iter().filter(|row| row.function == function);
            of_it.any(|row| too_far(&gpu, &bound, &faulty, row).is_some())
        };
        if !found {
            passed.push(format!("{function} with {wrong} for {right} passes"));
        }
    }
    assert!(passed.is_empty(), "{}", passed.join("\n"));
    let planted: BTreeSet<&str> = FAULTS.iter().map(|fault| fault.0).collect();
    assert_eq!(planted, called(&rows), "each function has a fault");
}

/// Functions of the text that no row calls, and the other way round.
fn without_row(maps: &str) -> Vec<String> {
    let functions = |text: &str| named(&parsed(text)).0;
    let own: BTreeSet<String> =
        functions(&format!("{}{maps}", *LIGHTING)).difference(&functions(&LIGHTING)).cloned().collect();
    let called = called(&rows()).into_iter().map(str::to_owned).collect();
    own.symmetric_difference(&called).cloned().collect()
}

#[test]
fn no_function_of_maps_is_without_a_row() {
    assert_eq!(without_row(MAPS), Vec::<String>::new());
    let lonely = format!("{MAPS}fn lonely(x: f32) -> f32 {{ return x; }}");
    assert_eq!(without_row(&lonely), ["lonely"]);
    assert_eq!(without_row(&MAPS.replace("way_on", "moved_on")), ["moved_on", "way_on"]);
}
