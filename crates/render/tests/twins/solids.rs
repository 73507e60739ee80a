//! Twins: the functions of solids.wgsl, run on the adapter, against `halfway_texture::noise` and
//! `halfway_texture::solid` in f64.

use halfway_render::Gpu;
use std::collections::BTreeSet;

use crate::adapter::results;
use crate::solid_rows::solid_rows;
use crate::table::Row;
use crate::{far_of, named, parsed};

const SOLIDS: &str = include_str!("../../src/gpu/shaders/solids.wgsl");

/// The other text that the shader around a call needs.
const LIGHT: &str = include_str!("../../src/gpu/shaders/lighting.wgsl");

fn too_far(gpu: &Gpu, solids: &str, row: &Row) -> Option<String> {
    let text = format!("{LIGHT}{solids}");
    far_of(row, results(gpu, &text, (row.call, row.kind), row.constants, &row.inputs))
}

#[test]
fn each_function_of_solids_matches_its_twin() {
    let gpu = Gpu::open_headless().expect("an adapter");
    let failures: Vec<String> = solid_rows().iter().filter_map(|row| too_far(&gpu, SOLIDS, row)).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Faults: the function whose rows find it, what is right, and what is written instead.
const FAULTS: [(&str, &str, &str); 25] = [
    ("hash", "cell * 1664525u", "cell * 1664527u"),
    ("hash", "v ^ (v >> vec3u(16u))", "v ^ (v >> vec3u(15u))"),
    ("at_corner", "hash(cell + offset)", "hash(cell)"),
    ("at_corner", "number == 12u || number == 14u", "number == 12u || number == 13u"),
    ("at_corner", "(number & 2u) == 0u", "(number & 2u) != 0u"),
    ("gradient_noise", "f * 6.0 - 15.0", "f * 6.0 - 15.001"),
    ("gradient_noise", "mix(front, behind, s.z)", "mix(front, behind, f.z)"),
    ("fade", "(width - 0.25) * 2.0", "(width - 0.26) * 2.0"),
    ("fractal", "min(octaves, MOST_OCTAVES)", "min(octaves, 8u)"),
    ("fractal", "f32(octave) * 0.37", "f32(octave) * 0.3701"),
    ("fractal", "amplitude *= 0.5", "amplitude *= 0.5001"),
    ("fractal", "weight = fade(frequency * abs(width))", "weight = fade(0.5 * frequency * abs(width))"),
    ("sine_of_turns", "abs(x) <= 0.25", "abs(x) <= 0.4"),
    ("sine_of_turns", "1.0 / 362880.0 - z", "1.0 / 362880.0 + z"),
    ("wave", "w >= 1.0", "w >= 2.0"),
    ("wave", "sine_of_turns(0.5 * w)", "sine_of_turns(0.501 * w)"),
    ("marble", "p.x + fractal", "p.y + fractal"),
    ("wood", "0.1 * p.y", "0.11 * p.y"),
    ("wood", "p.x * p.x + p.z * p.z", "p.x * p.x + p.y * p.y"),
    ("in_period", "floor(0.5 * x)", "trunc(0.5 * x)"),
    ("square_wave", "max(box_width, LEAST_WIDTH)", "max(box_width, 2e-3)"),
    ("square_wave", "width <= 1.0", "width <= 2.0"),
    ("checker", "abs(widths.y)", "abs(widths.x)"),
    ("solid_value", "max(dot(x, x), dot(y, y))", "min(dot(x, x), dot(y, y))"),
    ("solid_value", "checker(q + 0.5", "checker(q + 0.501"),
];

#[test]
fn a_planted_fault_in_any_function_of_solids_is_found() {
    let gpu = Gpu::open_headless().expect("an adapter");
    let rows = solid_rows();
    let mut passed = Vec::new();
    for (function, right, wrong) in FAULTS {
        assert_eq!(SOLIDS.matches(right).count(), 1, "{right} is in the text once");
        let faulty = SOLIDS.replace(right, wrong);
        let mut of_it = rows.iter().filter(|row| row.function == function);
        if !of_it.any(|row| too_far(&gpu, &faulty, row).is_some()) {
            passed.push(format!("{function} with {wrong} for {right} passes"));
        }
    }
    assert!(passed.is_empty(), "{}", passed.join("\n"));
    let planted: BTreeSet<&str> = FAULTS.iter().map(|fault| fault.0).collect();
    let called: BTreeSet<&str> = rows.iter().map(|row| row.function).collect();
    assert_eq!(planted, called, "each function has a fault");
}

/// Functions of the text that no row calls, and the other way round.
fn without_row(solids: &str) -> Vec<String> {
    let called: BTreeSet<String> = solid_rows().iter().map(|row| row.function.to_owned()).collect();
    named(&parsed(solids)).0.symmetric_difference(&called).cloned().collect()
}

#[test]
fn no_function_of_solids_is_without_a_row() {
    assert_eq!(without_row(SOLIDS), Vec::<String>::new());
    let lonely = format!("{SOLIDS}fn lonely(x: f32) -> f32 {{ return x; }}");
    assert_eq!(without_row(&lonely), ["lonely"]);
    assert_eq!(without_row(&SOLIDS.replace("in_period", "in_the_period")), ["in_period", "in_the_period"]);
}
