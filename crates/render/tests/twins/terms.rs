//! Twins: the functions of colored.wgsl and parts.wgsl that read no bindings, run on the adapter, against the sums of
//! `halfway_lighting::equations` in f64.

use halfway_lighting::equations::vector::mul;
use halfway_lighting::equations::{Coefficients, Irradiance, reflected};
use halfway_render::{Gpu, wgpu::naga};
use std::collections::BTreeSet;

use crate::adapter::{Kind, results};
use crate::inputs::{Input, many, wide};
use crate::table::Row;
use crate::{LIGHTING, far_of, parsed};

macro_rules! shader {
    ($file:literal) => {
        include_str!(concat!("../../src/shaders/", $file))
    };
}

/// What both files need.
const BEFORE: [&str; 4] = [LIGHTING, shader!("records.wgsl"), shader!("uniform.wgsl"), shader!("mesh.wgsl")];
const COLORED: &str = shader!("colored.wgsl");
const MAPPED: &str =
    concat!(shader!("maps.wgsl"), shader!("by_level.wgsl"), shader!("factors.wgsl"), shader!("parts.wgsl"));

/// The step of f32 at 1; each operation is right to half of it.
const ULP: f64 = f32::EPSILON as f64;
const LEAST: f64 = f32::MIN_POSITIVE as f64;

/// What arrives, a material without its base, its base, an emission, and a color.
#[derive(Clone)]
struct Lit {
    arriving: Irradiance<f64>,
    material: Coefficients<f64>,
    base: [f64; 3],
    opacity: f64,
    emission: [f64; 3],
    color: [f64; 3],
    alpha: f64,
}

impl Lit {
    fn of(x: &[f32]) -> Self {
        let arriving = Irradiance { ambient: wide(x), diffuse: wide(&x[3..]), specular: wide(&x[6..]) };
        let (kd, ks, ka) = (wide(&x[12..]), wide(&x[15..]), wide(&x[18..]));
        Self {
            arriving,
            material: Coefficients { ka, kd, ks, ke: [0.0; 3], shininess: 1.0 },
            base: wide(&x[9..]),
            opacity: x[21].into(),
            emission: wide(&x[22..]),
            color: wide(&x[25..]),
            alpha: x[28].into(),
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

    /// The terms under the color.
    fn tinted_terms(&self) -> [f64; 3] {
        let Coefficients { ka, kd, .. } = self.material;
        reflected(&self.arriving, &Coefficients { ka: mul(ka, self.color), kd: mul(kd, self.color), ..self.material })
    }

    fn tinted(&self) -> Vec<f64> {
        let (terms, base) = (self.tinted_terms(), mul(self.base, self.color));
        let sum = (0..3).map(|k| self.emission[k] + base[k] + terms[k]);
        sum.chain([self.opacity * self.alpha]).collect()
    }

    fn reflected(&self) -> Vec<f64> {
        reflected(&self.arriving, &self.material).to_vec()
    }

    fn parts(&self) -> Vec<f64> {
        let base = mul(self.base, self.color);
        let part = |switches| self.clone().only(switches).tinted_terms();
        let ambient = part([1.0, 0.0, 0.0]);
        let ambient: Vec<f64> = (0..3).map(|k| base[k] + ambient[k]).collect();
        [&ambient[..], &part([0.0, 1.0, 0.0]), &part([0.0, 0.0, 1.0])].concat()
    }
}

fn inputs() -> Vec<Input> {
    many([[0.0; 40], [1.0; 40]], 500, |random| std::array::from_fn(|_| random.between(0.0, 2.0)))
}

/// Both signs.
fn directions() -> Vec<Input> {
    many([], 500, |random| std::array::from_fn(|_| random.between(-2.0, 2.0)))
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

/// A call with the arguments that stand in each input.
macro_rules! row {
    ($name:literal, $call:literal, $kind:ident, $constants:expr, $twin:expr) => {
        Row {
            function: $name,
            call: concat!(
                $name,
                "(Irradiance(v(i, 0), v(i, 3), v(i, 6)), ",
                "Material(v(i, 9), 1.0, v(i, 12), s(i, 21), v(i, 15), 0.0, v(i, 18), 0.0)",
                $call,
                ")"
            ),
            kind: Kind::$kind,
            constants: $constants,
            inputs: inputs(),
            twin: $twin,
            allowed: of_sum,
        }
    };
}

fn colored_rows() -> Vec<Row> {
    vec![
        row!("tinted", ", v(i, 22), vec4f(v(i, 25), s(i, 28))", Texel, NOTHING, |x| Lit::of(x).tinted()),
        row!("tinted_terms", ", v(i, 25)", Vector, NOTHING, |x| Lit::of(x).tinted_terms().to_vec()),
        row!("tinted_terms", ", v(i, 25)", Vector, NO_AMBIENT, |x| {
            Lit::of(x).only([0.0, 1.0, 1.0]).tinted_terms().to_vec()
        }),
        row!("tinted_terms", ", v(i, 25)", Vector, NO_SPECULAR, |x| {
            Lit::of(x).only([1.0, 1.0, 0.0]).tinted_terms().to_vec()
        }),
        output_row(NOTHING, |x| vec![x[0].into(), x[1].into(), x[2].into(), 1.0]),
        output_row(&[("BLEND", 1.0)], |x| wide::<4>(x).to_vec()),
    ]
}

fn output_row(constants: &'static [(&'static str, f64)], twin: fn(&[f32]) -> Vec<f64>) -> Row {
    let call = "output(vec4f(v(i, 0), s(i, 3)))";
    let allowed = |_: &[f32], expected: &[f64]| vec![0.0; expected.len()];
    Row { function: "output", call, kind: Kind::Texel, constants, inputs: inputs(), twin, allowed }
}

fn mapped_rows() -> Vec<Row> {
    vec![
        row!("ambient_part", "", Vector, NOTHING, |x| Lit::of(x).only([1.0, 0.0, 0.0]).reflected()),
        row!("ambient_part", "", Vector, NO_AMBIENT, |_| vec![0.0; 3]),
        row!("specular_part", "", Vector, NOTHING, |x| Lit::of(x).only([0.0, 0.0, 1.0]).reflected()),
        row!("specular_part", "", Vector, NO_SPECULAR, |_| vec![0.0; 3]),
        row!("parts", ", v(i, 25)", Irradiance, NOTHING, |x| Lit::of(x).parts()),
        row!("parts", ", v(i, 25)", Irradiance, NO_AMBIENT, |x| Lit::of(x).only([0.0, 1.0, 1.0]).parts()),
        row!("of_vertices", ", v(i, 25)", Vector, &[("VERTEX_DIFFUSE", 1.0)], |x| {
            Lit::of(x).only([0.0, 1.0, 0.0]).tinted_terms().to_vec()
        }),
        row!("of_vertices", ", v(i, 25)", Vector, NOTHING, |x| Lit::of(x).only([0.0, 0.0, 1.0]).reflected()),
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

/// A file, and the rows of its functions.
fn files() -> [(&'static str, Vec<Row>); 2] {
    [(COLORED, colored_rows()), (MAPPED, mapped_rows())]
}

fn with_those_before(text: &str) -> String {
    BEFORE.concat() + text
}

fn too_far(gpu: &Gpu, text: &str, row: &Row) -> Option<String> {
    far_of(row, results(gpu, &with_those_before(text), (row.call, row.kind), row.constants, &row.inputs))
}

#[test]
fn each_sum_of_terms_is_what_the_equations_give() {
    let gpu = Gpu::open_headless().expect("an adapter");
    let failures: Vec<String> =
        files().iter().flat_map(|(text, rows)| rows.iter().filter_map(|row| too_far(&gpu, text, row))).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Faults: the function whose rows find it, what is right, and what is written instead.
const FAULTS: [(&str, &str, &str); 11] = [
    ("tinted", "emission + color.rgb * material.base", "emission + material.base"),
    ("tinted", "material.opacity * color.a", "material.opacity"),
    (
        "tinted_terms",
        "color * material.diffuse * arriving.diffuse;\n    if",
        "material.diffuse * arriving.diffuse;\n    if",
    ),
    ("tinted_terms", "    if SPECULAR {\n        sum +=", "    {\n        sum +="),
    ("output", "select(1.0, shade.a, BLEND)", "shade.a"),
    ("ambient_part", "return material.ambient * arriving.ambient", "return material.diffuse * arriving.ambient"),
    ("specular_part", "return material.specular * arriving.specular", "return arriving.specular"),
    ("parts", "color * (material.base + ambient_part", "(color * material.base + ambient_part"),
    ("of_vertices", "if VERTEX_DIFFUSE {\n        return color", "if !VERTEX_DIFFUSE {\n        return color"),
    ("of_vertices", "return color * material.diffuse * terms.diffuse", "return material.diffuse * terms.diffuse"),
    ("eye_direction", "dot(object.row1.xyz, direction)", "dot(object.row0.xyz, direction)"),
];

#[test]
fn a_planted_fault_in_any_sum_of_terms_is_found() {
    let gpu = Gpu::open_headless().expect("an adapter");
    for (function, right, wrong) in FAULTS {
        let files = files();
        let (text, rows) =
            files.iter().find(|(_, rows)| rows.iter().any(|row| row.function == function)).expect("a row");
        assert_eq!(text.matches(right).count(), 1, "{right} is in the text once");
        let faulty = text.replace(right, wrong);
        let found = rows.iter().filter(|row| row.function == function).any(|row| too_far(&gpu, &faulty, row).is_some());
        assert!(found, "{function} with {wrong} for {right} passes");
    }
    let planted: BTreeSet<&str> = FAULTS.iter().map(|fault| fault.0).collect();
    let called: BTreeSet<&str> =
        files().iter().flat_map(|(_, rows)| rows.iter().map(|row| row.function).collect::<Vec<_>>()).collect();
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

/// Functions of a file without bindings that no row calls, and the other way round. Those of `known` are other rows'.
fn without_row(text: &str, known: &str, rows: &[Row]) -> Vec<String> {
    let own: BTreeSet<String> =
        unbound(&with_those_before(text)).difference(&unbound(&with_those_before(known))).cloned().collect();
    let called = rows.iter().map(|row| row.function.to_owned()).collect();
    own.symmetric_difference(&called).cloned().collect()
}

#[test]
fn no_sum_of_terms_is_without_a_row() {
    let maps = shader!("maps.wgsl");
    let of_colored = |text: &str| without_row(text, "", &colored_rows());
    assert_eq!(of_colored(COLORED), Vec::<String>::new());
    assert_eq!(without_row(MAPPED, maps, &mapped_rows()), Vec::<String>::new());
    let lonely = format!("{COLORED}fn lonely(x: f32) -> f32 {{ return x; }}");
    assert_eq!(of_colored(&lonely), ["lonely"]);
}
