//! Twins: the functions of surface.wgsl that read no bindings, run on the adapter, against the sums of
//! `halfway_lighting::equations` in f64.

use halfway_lighting::equations::vector::mul;
use halfway_lighting::equations::{Coefficients, Irradiance, reflected};
use halfway_render::{Gpu, wgpu::naga};
use std::collections::BTreeSet;
use std::sync::LazyLock;

use crate::adapter::{Kind, results};
use crate::inputs::{Input, between, many, wide};
use crate::switches::assembled;
use crate::table::Row;
use crate::{LIGHTING, far_of, parsed};

macro_rules! shader {
    ($file:literal) => {
        include_str!(concat!("../../src/gpu/shaders/", $file))
    };
}

/// The files that the text needs, if it has images.
static BEFORE: LazyLock<[&str; 7]> = LazyLock::new(|| {
    [
        &LIGHTING,
        shader!("records.wgsl"),
        shader!("uniform.wgsl"),
        shader!("mesh.wgsl"),
        shader!("maps.wgsl"),
        shader!("by_level.wgsl"),
        shader!("factors.wgsl"),
    ]
});
const SURFACE: &str = shader!("surface.wgsl");

/// Its switches, for a text with all functions that are tried here; with images, and without.
fn switches(mapped: bool) -> Vec<(&'static str, bool)> {
    const ON: [&str; 11] = [
        "VERTEX",
        "VERTEX_DIFFUSE",
        "VERTEX_SPECULAR",
        "FRAGMENT",
        "FRAGMENT_DIFFUSE",
        "FRAGMENT_SPECULAR",
        "NORMALS",
        "NORMALS_AT_FRAGMENTS",
        "TWO_SIDED",
        "FACING",
        "PAINTED",
    ];
    let images = [("MAPPED", mapped), ("RELIEF", mapped)];
    ON.map(|name| (name, true))
        .into_iter()
        .chain(images)
        .chain(["FLAT", "SOLID", "SURROUNDED"].map(|name| (name, false)))
        .collect()
}

/// The step of f32 at 1; each operation is right to half of it.
const ULP: f64 = f32::EPSILON as f64;
const LEAST: f64 = f32::MIN_POSITIVE as f64;

/// The arriving light, a material, and a color.
#[derive(Clone)]
struct Lit {
    arriving: Irradiance<f64>,
    material: Coefficients<f64>,
    color: [f64; 3],
}

impl Lit {
    fn from_input(x: &[f32]) -> Self {
        let arriving = Irradiance { ambient: wide(x), diffuse: wide(&x[3..]), specular: wide(&x[6..]) };
        let (kd, ks, ka) = (wide(&x[12..]), wide(&x[15..]), wide(&x[18..]));
        Self {
            arriving,
            material: Coefficients { ka, kd, ks, shininess: 1.0, ..Coefficients::black() },
            color: wide(&x[25..]),
        }
    }

    /// With nothing but the terms whose switch is 1: ambient, diffuse, specular.
    fn only(mut self, [ambient, diffuse, specular]: [f64; 3]) -> Self {
        let Coefficients { ka, kd, ks, .. } = &mut self.material;
        for (k, switch) in [(ka, ambient), (kd, diffuse), (ks, specular)] {
            *k = k.map(|x| switch * x);
        }
        self
    }

    /// The light that the material reflects, multiplied by the color.
    fn sum(&self) -> [f64; 3] {
        let Coefficients { ka, kd, .. } = self.material;
        reflected(&self.arriving, &Coefficients { ka: mul(ka, self.color), kd: mul(kd, self.color), ..self.material })
    }

    fn parts(&self) -> Vec<f64> {
        let part = |switches| self.clone().only(switches).sum();
        [part([1.0, 0.0, 0.0]), part([0.0, 1.0, 0.0]), part([0.0, 0.0, 1.0])].concat()
    }
}

fn inputs() -> Vec<Input> {
    many([[0.0; 40], [1.0; 40]], 500, |random| std::array::from_fn(|_| between(random, 0.0, 2.0)))
}

/// Both signs.
fn directions() -> Vec<Input> {
    many([], 500, |random| std::array::from_fn(|_| between(random, -2.0, 2.0)))
}

/// Sums of at most four products of at most three, none below 0.
fn of_sum(_: &[f32], expected: &[f64]) -> Vec<f64> {
    expected.iter().map(|e| 6.0 * ULP * e + LEAST).collect()
}

fn of_dot(x: &[f32], _: &[f64]) -> Vec<f64> {
    (0..3).map(|row| 3.0 * ULP * (0..3).map(|k| f64::from(x[4 * row + k] * x[12 + k]).abs()).sum::<f64>()).collect()
}

fn eye_direction(x: &[f32]) -> Vec<f64> {
    (0..3).map(|row| (0..3).map(|k| f64::from(x[4 * row + k]) * f64::from(x[12 + k])).sum()).collect()
}

const NOTHING: &[(&str, f64)] = &[];
const NO_AMBIENT: &[(&str, f64)] = &[("ATTENUATED_AMBIENT", 0.0)];
const NO_SPECULAR: &[(&str, f64)] = &[("SPECULAR", 0.0)];

fn exactly(_: &[f32], expected: &[f64]) -> Vec<f64> {
    vec![0.0; expected.len()]
}

/// A call of `parts` with these switches of the pipeline.
fn parts_row(constants: &'static [(&'static str, f64)], twin: fn(&[f32]) -> Vec<f64>) -> Row {
    let call = "parts(Irradiance(v(i, 0), v(i, 3), v(i, 6)), \
        Material(v(i, 9), 1.0, v(i, 12), s(i, 21), v(i, 15), 0.0, v(i, 18), 0.0, vec3f(), 0.0), v(i, 25))";
    Row { function: "parts", call, kind: Kind::Irradiance, constants, inputs: inputs(), twin, allowed: of_sum }
}

fn output_row(constants: &'static [(&'static str, f64)], twin: fn(&[f32]) -> Vec<f64>) -> Row {
    let call = "output(vec4f(v(i, 0), s(i, 3)))";
    Row { function: "output", call, kind: Kind::Texel, constants, inputs: inputs(), twin, allowed: exactly }
}

/// Numbers below 0 are an adapter's extrapolation.
fn not_below_0(x: &[f32]) -> Vec<f64> {
    x.iter().map(|&x| f64::from(x.max(0.0))).collect()
}

/// The rows of texts with images.
fn mapped_rows() -> Vec<Row> {
    // The parts of the front are 0 to 8, those of the back 9 to 17.
    macro_rules! of_vertices {
        ($front:literal) => {
            concat!(
                "parts_of_vertices(Varyings(vec4f(), 0u, vec4f(), vec3f(), v(i, 0), v(i, 3), v(i, 6), v(i, 9), ",
                "v(i, 12), v(i, 15), vec3f(), vec4f(), vec4f(), vec4f(), vec4f()), ",
                $front,
                ")"
            )
        };
    }
    let of_vertices = |call, twin| Row {
        function: "parts_of_vertices",
        call,
        kind: Kind::Irradiance,
        constants: NOTHING,
        inputs: directions(),
        twin,
        allowed: exactly,
    };
    vec![
        parts_row(NOTHING, |x| Lit::from_input(x).parts()),
        parts_row(NO_AMBIENT, |x| Lit::from_input(x).only([0.0, 1.0, 1.0]).parts()),
        parts_row(NO_SPECULAR, |x| Lit::from_input(x).only([1.0, 1.0, 0.0]).parts()),
        Row {
            function: "all_parts",
            call: "all_parts(Parts(v(i, 0), v(i, 3), v(i, 6)))",
            kind: Kind::Vector,
            constants: NOTHING,
            inputs: inputs(),
            twin: |x| (0..3).map(|k| [k, k + 3, k + 6].map(|k| f64::from(x[k])).iter().sum()).collect(),
            allowed: of_sum,
        },
        output_row(NOTHING, |x| vec![x[0].into(), x[1].into(), x[2].into(), 1.0]),
        output_row(&[("BLEND", 1.0)], |x| wide::<4>(x).to_vec()),
        of_vertices(of_vertices!("true"), |x| not_below_0(&x[..9])),
        of_vertices(of_vertices!("false"), |x| not_below_0(&x[9..18])),
        Row {
            function: "eye_direction",
            call: "eye_direction(Object(vec4f(v(i, 0), s(i, 3)), vec4f(v(i, 4), s(i, 7)), vec4f(v(i, 8), s(i, 11)), \
                vec3f(), vec3f(), vec3f(), 0u), v(i, 12))",
            kind: Kind::Vector,
            constants: NOTHING,
            inputs: directions(),
            twin: eye_direction,
            allowed: of_dot,
        },
    ]
}

/// The rows of texts without images, of what is another function there.
fn unmapped_rows() -> Vec<Row> {
    let row = |call, twin| Row {
        function: "parts_of_vertices",
        call,
        kind: Kind::Vector,
        constants: NOTHING,
        inputs: directions(),
        twin,
        allowed: exactly,
    };
    macro_rules! shade {
        ($front:literal) => {
            concat!(
                "all_parts(parts_of_vertices(Varyings(vec4f(), 0u, vec4f(), vec3f(), v(i, 0), v(i, 3), vec3f()), ",
                $front,
                "))"
            )
        };
    }
    vec![row(shade!("true"), |x| not_below_0(&x[..3])), row(shade!("false"), |x| not_below_0(&x[3..6]))]
}

/// Rows, and whether their text has images.
fn rows() -> [(bool, Vec<Row>); 2] {
    [(true, mapped_rows()), (false, unmapped_rows())]
}

fn text(surface: &str, mapped: bool) -> String {
    let files = if mapped { &BEFORE[..] } else { &BEFORE[..4] };
    assembled(&[files, &[surface]].concat(), &switches(mapped))
}

fn too_far(gpu: &Gpu, text: &str, row: &Row) -> Option<String> {
    far_of(row, results(gpu, text, (row.call, row.kind), row.constants, &row.inputs))
}

#[test]
fn each_sum_of_terms_matches_the_equations() {
    let gpu = Gpu::open_headless().expect("an adapter");
    let failures: Vec<String> = rows()
        .iter()
        .flat_map(|(mapped, rows)| {
            let text = text(SURFACE, *mapped);
            rows.iter().filter_map(|row| too_far(&gpu, &text, row)).collect::<Vec<_>>()
        })
        .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Faults: the function whose rows find it, what is right, and what is written instead.
const FAULTS: [(&str, &str, &str); 10] = [
    ("parts", "color * material.ambient * arriving.ambient", "material.ambient * arriving.ambient"),
    ("parts", "Parts(ambient, color * material.diffuse", "Parts(ambient, material.diffuse"),
    ("parts", "specular = material.specular * arriving.specular", "specular = arriving.specular"),
    ("parts", "    if SPECULAR {", "    {"),
    ("all_parts", "sums.ambient + sums.diffuse + sums.specular", "sums.ambient + sums.diffuse"),
    ("output", "select(1.0, shade.a, BLEND)", "shade.a"),
    ("parts_of_vertices", "sums.specular = in.back_specular", "sums.specular = in.specular"),
    ("parts_of_vertices", "sums.diffuse = in.back_shade", "sums.diffuse = in.shade"),
    ("parts_of_vertices", "Parts(interpolated(sums.ambient)", "Parts(sums.ambient"),
    ("eye_direction", "dot(object.row1.xyz, direction)", "dot(object.row0.xyz, direction)"),
];

#[test]
fn a_planted_fault_in_any_sum_of_terms_is_found() {
    let gpu = Gpu::open_headless().expect("an adapter");
    let rows = rows();
    for (function, right, wrong) in FAULTS {
        assert_eq!(SURFACE.matches(right).count(), 1, "{right} is in the text once");
        let faulty = SURFACE.replace(right, wrong);
        let found = rows.iter().any(|(mapped, rows)| {
            let text = text(&faulty, *mapped);
            rows.iter().filter(|row| row.function == function).any(|row| too_far(&gpu, &text, row).is_some())
        });
        assert!(found, "{function} with {wrong} for {right} passes");
    }
    let planted: BTreeSet<&str> = FAULTS.iter().map(|fault| fault.0).collect();
    let called: BTreeSet<&str> = rows.iter().flat_map(|(_, rows)| rows.iter().map(|row| row.function)).collect();
    assert_eq!(planted, called, "each function has a fault");
}

/// The functions of a module that read no bindings.
fn unbound(text: &str) -> BTreeSet<String> {
    let module = parsed(text);
    let flags = naga::valid::ValidationFlags::all();
    let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::all());
    let info = validator.validate(&module).expect("a valid module");
    let reads = |handle: naga::Handle<naga::Function>| {
        module.global_variables.iter().any(|(variable, _)| !info[handle][variable].is_empty())
    };
    let functions = module.functions.iter().filter(|&(handle, _)| !reads(handle));
    functions.filter_map(|(_, function)| function.name.clone()).collect()
}

/// Functions of the file without bindings that no row calls, and the other way round.
fn without_row(surface: &str) -> Vec<String> {
    let known = unbound(&text("", true));
    let own: BTreeSet<String> = unbound(&text(surface, true)).difference(&known).cloned().collect();
    let called = mapped_rows().iter().map(|row| row.function.to_owned()).collect();
    own.symmetric_difference(&called).cloned().collect()
}

#[test]
fn no_sum_of_terms_is_without_a_row() {
    assert_eq!(without_row(SURFACE), Vec::<String>::new());
    let lonely = format!("{SURFACE}fn lonely(x: f32) -> f32 {{ return x; }}");
    assert_eq!(without_row(&lonely), ["lonely"]);
}
