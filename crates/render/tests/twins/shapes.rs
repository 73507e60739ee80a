//! Twins: the functions of `by_shape.wgsl`, run on the adapter over images, against `halfway_texture::lookup` and
//! definitions in f64.

use halfway_render::Gpu;
use std::collections::BTreeSet;

use crate::adapter::{Bound, results_with};
use crate::ellipse_rows::ellipse_rows;
use crate::images::bound;
use crate::shape_rows::shape_rows;
use crate::table::Row;
use crate::{LIGHTING, far_of, named, parsed};

const MAPS: &str = include_str!("../../src/gpu/shaders/maps.wgsl");
const SHAPES: &str = include_str!("../../src/gpu/shaders/by_shape.wgsl");

fn rows() -> Vec<Row> {
    [shape_rows(), ellipse_rows()].into_iter().flatten().collect()
}

fn too_far(gpu: &Gpu, bound: &Bound, shapes: &str, row: &Row) -> Option<String> {
    let text = format!("{}{MAPS}{shapes}", *LIGHTING);
    far_of(row, results_with(gpu, (&text, Some(bound)), (row.call, row.kind), row.constants, &row.inputs))
}

#[test]
fn each_function_of_by_shape_matches_its_twin() {
    let gpu = Gpu::open_headless().expect("an adapter");
    let bound = bound(&gpu.device, &gpu.queue);
    let failures: Vec<String> = rows().iter().filter_map(|row| too_far(&gpu, &bound, SHAPES, row)).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Faults: the function whose rows find it, what is right, and what is written instead.
const FAULTS: [(&str, &str, &str); 41] = [
    ("shape_of", "look >> 13u & 7u", "look >> 13u & 3u"),
    ("footprint_shape", "a.x * a.y + b.x * b.y", "a.x * b.y + b.x * a.y"),
    ("footprint_shape", "a.x * b.y - a.y * b.x", "a.x * b.y + a.y * b.x"),
    ("footprint_shape", "moments.x + moments.z > 1e18", "moments.x + moments.z > 1e37"),
    ("long_direction", "apart + radius, moments.y", "apart - radius, moments.y"),
    ("long_direction", "along / max(size, 1e-30), size > 0.0", "along / size, size > -1.0"),
    ("reduced", "(look & ~3u) | minify_of(look)", "look | minify_of(look)"),
    ("probes", "1u << (shape_of(look) - 2u)", "1u << (shape_of(look) - 1u)"),
    ("probes", "max(shape.short, 1.0), most)", "max(shape.short, 1.1), most)"),
    ("probes", "uv - k * step", "uv + k * step"),
    ("probes", "0.5 * min(left, 2.0)", "min(0.5, left)"),
    ("ripmap_level", "of_rows.w * placings.each[slot].levels.w", "of_rows.w * placings.each[slot].levels.y"),
    ("ripmap_level", "of_rows.z * of_columns.x", "of_columns.x"),
    ("in_ripmap", "max(shape.moments.xz, vec2f(1.0))", "max(shape.moments.zx, vec2f(1.0))"),
    ("in_ripmap", "clamp(0.5 * log2", "clamp(0.49 * log2"),
    ("in_ripmap", "select(1.0 - part.x, part.x, i == 1u)", "select(part.x, 1.0 - part.x, i == 1u)"),
    ("part_of", "max(min(high, 0.0) - low, 0.0)", "max(high - low, 0.0)"),
    ("part_of", "max(high - max(low, side), 0.0)", "max(high - side, 0.0)"),
    ("part_of", "clamp(middle * side, -length", "clamp(middle * side, 0.0"),
    ("part_of", "between - 1.0", "between"),
    ("part_of", "number > 0u && between == 0.0", "false"),
    ("part_of", "side - part.y, side - part.x", "part.x, part.y"),
    ("strip", "vec2i(at.w, row)) - high", "vec2i(at.w, row))"),
    ("strip", "vec2i(at.z + 1, row)) - low", "vec2i(at.z + 1, row))"),
    ("between_rows", "(b.low - a.low) * weights", "(b.low + a.low) * weights"),
    ("rectangle", "vec3f(-u.x, 1.0 - u.y, u.y)", "vec3f(u.x, 1.0 - u.y, u.y)"),
    ("rectangle", "level[0].yz) - 1;", "level[0].yz) - 2;"),
    ("rectangle", "(1.0 - v.y) * between_rows", "between_rows"),
    ("summed", "sqrt(shape.moments.xz), vec2f(1.0)", "sqrt(shape.moments.xz), vec2f(0.9)"),
    ("summed", "columns.z * rows.z * rectangle", "columns.z * rectangle"),
    ("widened", "if small >= 1.0 {", "if small >= 0.5 {"),
    ("widened", "m.y * share", "m.y"),
    ("ellipse_of", "m.z * inverse, -m.y * inverse", "m.z * inverse, m.y * inverse"),
    ("ellipse_of", "64.0 / max(sqrt(whole.xz), vec2f(64.0))", "32.0 / max(sqrt(whole.xz), vec2f(32.0))"),
    ("gaussian", "1.0 / 40320.0", "0.0"),
    ("within", "-reach - 2.0, side + reach + 2.0", "0.0, side"),
    ("in_ellipse", "2.0 * ellipse.y * x * y", "ellipse.y * x * y"),
    ("in_ellipse", "root + ellipse.y * y", "root - ellipse.y * y"),
    ("elliptical", "shape.long / 16.0), 1.0)", "shape.long / 8.0), 1.0)"),
    ("at_shape", "!(shape.long > 1.0)", "!(shape.long > 1.5)"),
    ("at_footprint", "let b = way_on(slot, of_set(look, c.dy))", "let b = way_on(slot, of_set(look, c.dx))"),
];

#[test]
fn a_planted_fault_in_any_function_of_by_shape_is_found() {
    let gpu = Gpu::open_headless().expect("an adapter");
    let bound = bound(&gpu.device, &gpu.queue);
    let rows = rows();
    let mut passed = Vec::new();
    for (function, right, wrong) in FAULTS {
        assert_eq!(SHAPES.matches(right).count(), 1, "{right} is in the text once");
        let faulty = SHAPES.replace(right, wrong);
        let mut of_it = rows.iter().filter(|row| row.function == function);
        if !of_it.any(|row| too_far(&gpu, &bound, &faulty, row).is_some()) {
            passed.push(format!("{function} with {wrong} for {right} passes"));
        }
    }
    assert!(passed.is_empty(), "{}", passed.join("\n"));
    let planted: BTreeSet<&str> = FAULTS.iter().map(|fault| fault.0).collect();
    let called: BTreeSet<&str> = rows.iter().map(|row| row.function).collect();
    assert_eq!(planted, called, "each function has a fault");
}

/// Functions of the text that no row calls, and the other way round.
fn without_row(shapes: &str) -> Vec<String> {
    let functions = |text: &str| named(&parsed(&format!("{}{MAPS}{text}", *LIGHTING))).0;
    let own: BTreeSet<String> = functions(shapes).difference(&functions("")).cloned().collect();
    let called = rows().iter().map(|row| row.function.to_owned()).collect();
    own.symmetric_difference(&called).cloned().collect()
}

#[test]
fn no_function_of_by_shape_is_without_a_row() {
    assert_eq!(without_row(SHAPES), Vec::<String>::new());
    let lonely = format!("{SHAPES}fn lonely(x: f32) -> f32 {{ return x; }}");
    assert_eq!(without_row(&lonely), ["lonely"]);
    assert_eq!(without_row(&SHAPES.replace("ripmap_level", "ripmap_image")), ["ripmap_image", "ripmap_level"]);
}
