#![doc = include_str!("../README.md")]
//!
//! This crate is the compiled half of the package, `halfway._halfway`: meshes, drawings and pictures as buffers of
//! numbers. The other half, in `python/halfway`, gives them the shapes and names that users of Python know, and is
//! documented there.

mod drawing;
mod equations;
mod mesh;
mod pictures;
mod reference;
mod work;

use pyo3::prelude::*;

/// The compiled half of the package.
#[pymodule]
fn _halfway(module: &Bound<'_, PyModule>) -> PyResult<()> {
    work::remember_process();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<mesh::Mesh>()?;
    module.add_class::<drawing::Drawing>()?;
    module.add_function(wrap_pyfunction!(mesh::origin_of_box, module)?)?;
    drawing::add_to(module)?;
    pictures::add_to(module)?;
    equations::add_to(module)
}
