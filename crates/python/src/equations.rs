//! The equations of the lighting crate in f64, on arrays.

use halfway::lighting::equations::{
    ConeTerms, attenuation, diffuse_term, half_vector, reflect, specular_blinn_phong, specular_phong, spot_factor,
    srgb_encoded,
};
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;

use crate::work::Failure;

/// The vectors and the numbers of one evaluation.
type Arguments<'a> = (&'a [[f64; 3]], &'a [f64]);

/// An equation, and how many vectors and how many numbers it takes.
type Equation = (&'static str, usize, usize, fn(Arguments) -> Value);

enum Value {
    Number(f64),
    Vector([f64; 3]),
}

const EQUATIONS: [Equation; 8] = [
    ("reflect", 2, 0, |(v, _)| Value::Vector(reflect(v[0], v[1]))),
    ("half_vector", 2, 0, |(v, _)| Value::Vector(half_vector(v[0], v[1]).unwrap_or_default())),
    ("diffuse", 2, 0, |(v, _)| Value::Number(diffuse_term(v[0], v[1]))),
    ("specular_phong", 3, 1, |(v, s)| Value::Number(specular_phong(v[0], v[1], v[2], s[0]))),
    ("specular_blinn_phong", 3, 1, |(v, s)| Value::Number(specular_blinn_phong(v[0], v[1], v[2], s[0]))),
    ("attenuation", 0, 4, |(_, s)| Value::Number(attenuation([s[0], s[1], s[2]], s[3]))),
    ("spot_factor", 0, 4, |(_, s)| Value::Number(spot_factor(s[0], &cone(s)))),
    ("srgb_encoded", 0, 1, |(_, s)| Value::Number(srgb_encoded(s[0]))),
];

fn cone(s: &[f64]) -> ConeTerms<f64> {
    // NaN stands for no inner cone.
    let cos_inner = Some(s[3]).filter(|inner| !inner.is_nan());
    ConeTerms { direction: [0.0; 3], cos_cutoff: s[1], cos_inner, exponent: s[2] }
}

/// Evaluates an equation for each of `count` points: its vectors and numbers are contiguous arrays of as many.
#[pyfunction]
fn evaluate<'py>(
    py: Python<'py>,
    name: &str,
    vectors: Vec<PyBuffer<f64>>,
    numbers: Vec<PyBuffer<f64>>,
    count: usize,
) -> PyResult<Bound<'py, PyByteArray>> {
    let found = EQUATIONS.iter().find(|(known, ..)| *known == name);
    let (_, of_vectors, of_numbers, equation) =
        found.ok_or_else(|| Failure::Input(format!("{name}: there is no such equation")))?;
    let read = |all: Vec<PyBuffer<f64>>| all.iter().map(|it| it.to_vec(py)).collect::<PyResult<Vec<_>>>();
    let (vectors, numbers) = (read(vectors)?, read(numbers)?);
    let fits = vectors.len() == *of_vectors
        && numbers.len() == *of_numbers
        && vectors.iter().all(|it| it.len() == 3 * count)
        && numbers.iter().all(|it| it.len() == count);
    if !fits {
        let expected = format!("{name}: expected {of_vectors} vectors and {of_numbers} numbers for each of {count}");
        return Err(Failure::Input(expected).into());
    }
    let mut bytes = Vec::new();
    let (mut v, mut s) = (vec![[0.0; 3]; *of_vectors], vec![0.0; *of_numbers]);
    for i in 0..count {
        v.iter_mut().zip(&vectors).for_each(|(v, all)| *v = all.as_chunks::<3>().0[i]);
        s.iter_mut().zip(&numbers).for_each(|(s, all)| *s = all[i]);
        match equation((&v, &s)) {
            Value::Number(x) => bytes.extend(x.to_ne_bytes()),
            Value::Vector(x) => bytes.extend(x.into_iter().flat_map(f64::to_ne_bytes)),
        }
    }
    Ok(PyByteArray::new(py, &bytes))
}

pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(evaluate, module)?)
}
