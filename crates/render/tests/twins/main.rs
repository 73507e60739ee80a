//! Twins: the functions of lighting.wgsl, tone.wgsl and environment.wgsl, run on the adapter, against those of the same
//! name in `halfway_lighting::equations` and `halfway_texture::environment` in f64; those of maps.wgsl and solids.wgsl,
//! against `halfway_texture` too; and sums of terms.

mod adapter;
mod derivatives;
mod ellipse_rows;
mod images;
mod inputs;
mod map_inputs;
mod map_rows;
mod maps;
mod normal_rows;
mod place_rows;
#[path = "../../src/gpu/draw/placings.rs"]
mod placings;
mod shape_inputs;
mod shape_rows;
mod shapes;
mod solid_rows;
mod solids;
#[path = "../../src/gpu/shaders/switches.rs"]
mod switches;
mod table;
mod terms;

use halfway_render::{Gpu, wgpu::naga};
use std::collections::BTreeSet;
use std::sync::LazyLock;
use table::{Row, constants, described, rows};

/// The texts of functions alone.
static LIGHTING: LazyLock<String> = LazyLock::new(|| {
    [
        include_str!("../../src/gpu/shaders/lighting.wgsl"),
        halfway_lighting::lights::wgsl(),
        include_str!("../../src/gpu/shaders/tone.wgsl"),
        include_str!("../../src/gpu/shaders/environment.wgsl"),
    ]
    .concat()
});

/// A description of the first result that is too far from its twin.
fn too_far(gpu: &Gpu, lighting: &str, row: &Row) -> Option<String> {
    far_of(row, adapter::results(gpu, lighting, (row.call, row.kind), row.constants, &row.inputs))
}

/// The same of results that are there.
fn far_of(row: &Row, results: Vec<[f32; adapter::RESULT]>) -> Option<String> {
    row.inputs.iter().zip(results).find_map(|(input, result)| {
        let expected = (row.twin)(input);
        let allowed = (row.allowed)(input, &expected);
        assert!(
            !expected.is_empty() && allowed.len() == expected.len(),
            "{}: as many tolerances as numbers",
            row.function
        );
        (0..expected.len()).find_map(|k| {
            let (found, expected, allowed) = (f64::from(result[k]), expected[k], allowed[k]);
            // A result that is not a number is too far.
            let near = (found - expected).abs() <= allowed;
            (!near).then(|| {
                let Row { call, constants, .. } = row;
                let input = described(input);
                format!("{call} {constants:?}, number {k}: {found:e}, twin {expected:e} ± {allowed:.1e}, for {input}")
            })
        })
    })
}

#[test]
fn each_function_matches_its_twin() {
    let gpu = Gpu::open_headless().expect("an adapter");
    let failures: Vec<String> = rows().iter().filter_map(|row| too_far(&gpu, &LIGHTING, row)).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Faults: the function whose rows find it, what is right, and what is written instead.
const FAULTS: [(&str, &str, &str); 46] = [
    ("mirrored", "2.0 * dot(n, v) * n - v", "2.0 * dot(n, v) * n + v"),
    ("lobe_exponent", "0.25 * exponent", "0.26 * exponent"),
    ("lobe_angle", "sqrt(alpha + 3.0)", "sqrt(alpha + 2.0)"),
    ("mean_light", "c[2] * n.z", "c[2] * n.x"),
    ("mean_light", "n.x * n.x - n.y * n.y", "n.x * n.x + n.y * n.y"),
    ("on_cube", "select(3.0, 2.0", "select(2.0, 3.0"),
    ("power", "select(0.0, 1.0, e == 0.0)", "0.0"),
    ("power", "i < squarings", "i <= squarings"),
    ("attenuation", "d * light.quadratic", "light.quadratic"),
    ("range_window", "1.0 - t * t * t * t", "1.0 - t * t"),
    ("spot_factor", "cos_phi >= light.cos_cutoff", "cos_phi > light.cos_cutoff"),
    ("incidence", "squared * inverse, 0.0, at_point", "squared * inverse, 0.1, at_point"),
    ("directional_light", "Incidence(light.position, GRAZING, 1.0)", "Incidence(light.position, 0.0, 0.5)"),
    ("point_light", "incidence(light, false, p, n)", "incidence(light, true, p, n)"),
    ("spot_light", "incidence(light, true, p, n)", "incidence(light, false, p, n)"),
    ("any_light", "light.kind == 0u", "light.kind == 1u"),
    ("any_light", "light.kind == 1u", "light.kind == 2u"),
    ("any_light", "light.kind == 2u", "light.kind == 3u"),
    ("hemisphere_light", "0.5 + 0.5 * dot(n, light.position)", "0.5 - 0.5 * dot(n, light.position)"),
    ("any_light", "light.kind == 3u", "light.kind == 4u"),
    ("view_vector", "-p * inverseSqrt", "p * inverseSqrt"),
    ("diffuse_term", "max(dot(n, l), 0.0)", "abs(dot(n, l))"),
    ("specular_phong", "clamp(2.0 * n_dot_l", "clamp(1.999 * n_dot_l"),
    ("specular_blinn_phong", "0.5 * beta", "0.505 * beta"),
    ("specular_blinn_phong", "(dot(n, l) > 0.0)", "true"),
    ("specular_term", "if BLINN_PHONG", "if !BLINN_PHONG"),
    ("axial_exponent", "2.0 * widths.y * a * b", "widths.y * a * b"),
    ("axial_exponent", "max(along / max(squared, 1e-30), 0.0)", "along / max(squared, 1e-30)"),
    ("axial_exponent", "otherwise, squared <= 1e-30", "0.0, squared <= 1e-30"),
    ("irradiance", "light.ambient * incident.weight", "light.ambient"),
    ("irradiance", "dot(n, incident.l) > incident.grazing", "true"),
    ("irradiance", "color = light.diffuse", "color = light.specular"),
    ("normalize_or_zero", "return n * inverseSqrt(max(dot(n, n), MIN_POSITIVE))", "return n * inverseSqrt(dot(n, n))"),
    ("transform_normal", "normal_matrix[1] * n.y", "normal_matrix[1] * n.x"),
    ("interpolated_normal", "geometric, dot(n, n) <", "n, dot(n, n) <"),
    ("srgb_encoded", "1.2554042", "1.2556"),
    ("attenuation", "ATTENUATION_MAX: f32 = 1e6", "ATTENUATION_MAX: f32 = 1.001e6"),
    ("incidence", "COINCIDENT: f32 = 2e-6", "COINCIDENT: f32 = 2e-5"),
    ("incidence", "GRAZING: f32 = 5e-7", "GRAZING: f32 = 6e-7"),
    ("incidence", "GRAZING * length(p) * inverse", "GRAZING * inverse"),
    ("interpolated_normal", "NORMAL_MIN: f32 = 1e-6", "NORMAL_MIN: f32 = 1e-5"),
    ("divisor", "max(largest, 1.0)", "largest"),
    ("divisor", "smoothing * (before - plain)", "smoothing * before"),
    ("reinhard", "i * per_white", "per_white"),
    ("aces", "2.43 * i + 0.59", "2.43 * i + 0.5901"),
    ("aces", "ACES_WHITE: f32 = 8.0", "ACES_WHITE: f32 = 7.0"),
];

#[test]
fn a_planted_fault_in_any_function_is_found() {
    let gpu = Gpu::open_headless().expect("an adapter");
    let rows = rows();
    for (function, right, wrong) in FAULTS {
        assert_eq!(LIGHTING.matches(right).count(), 1, "{right} is in the text once");
        let faulty = LIGHTING.replace(right, wrong);
        let found = rows.iter().filter(|row| row.function == function).any(|row| too_far(&gpu, &faulty, row).is_some());
        assert!(found, "{function} with {wrong} for {right} passes");
    }
    let planted: BTreeSet<&str> = FAULTS.iter().map(|fault| fault.0).collect();
    let called: BTreeSet<&str> = rows.iter().map(|row| row.function).collect();
    assert_eq!(planted, called, "each function has a fault");
}

fn parsed(text: &str) -> naga::Module {
    naga::front::wgsl::parse_str(text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(text)))
}

/// Functions and constants of a text, the constants with their values.
fn named(module: &naga::Module) -> (BTreeSet<String>, Vec<(String, Option<f32>)>) {
    let functions = module.functions.iter().filter_map(|(_, function)| function.name.clone()).collect();
    let value = |constant: &naga::Constant| match module.global_expressions[constant.init] {
        naga::Expression::Literal(naga::Literal::F32(value)) => Some(value),
        _ => None,
    };
    let constants = module.constants.iter().filter_map(|(_, constant)| Some((constant.name.clone()?, value(constant))));
    let mut constants: Vec<_> = constants.collect();
    constants.sort_by(|a, b| a.0.cmp(&b.0));
    (functions, constants)
}

/// The functions and constants of a text without a twin in the table, and the other way round.
fn without_twin(text: &str) -> Vec<String> {
    let (functions, constants) = named(&parsed(text));
    let called: BTreeSet<String> = rows().iter().map(|row| row.function.to_owned()).collect();
    let mut alone: Vec<String> = functions.symmetric_difference(&called).cloned().collect();
    let in_rust = self::constants();
    for (name, value) in &constants {
        let twin = in_rust.iter().find(|twin| twin.0 == name).map(|twin| twin.1);
        if twin.is_none() || twin != *value {
            alone.push(format!("{name} = {value:?}, in Rust {twin:?}"));
        }
    }
    let missing = in_rust.iter().filter(|twin| constants.iter().all(|constant| constant.0 != twin.0));
    alone.extend(missing.map(|twin| twin.0.to_owned()));
    alone
}

#[test]
fn no_function_and_no_constant_is_without_its_twin() {
    assert_eq!(without_twin(&LIGHTING), Vec::<String>::new());
    let lonely = format!("{}fn lonely(x: f32) -> f32 {{ return x; }}\nconst LONELY: f32 = 2.0;", *LIGHTING);
    assert_eq!(without_twin(&lonely), ["lonely", "LONELY = Some(2.0), in Rust None"]);
    let wrong = LIGHTING.replace("HALFWAY_MIN: f32 = 1e-6", "HALFWAY_MIN: f32 = 2e-6");
    assert_eq!(without_twin(&wrong), ["HALFWAY_MIN = Some(2e-6), in Rust Some(1e-6)"]);
    let renamed = LIGHTING.replace("diffuse_term", "lambert");
    assert_eq!(without_twin(&renamed), ["diffuse_term", "lambert"]);
}
