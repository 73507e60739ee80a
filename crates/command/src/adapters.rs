//! `halfway adapters`.

use crate::failure::Failure;
use halfway::render::{Gpu, RenderError};

pub(crate) fn run() -> Result<(), Failure> {
    let gpu = Gpu::open_headless().map_err(|error| match error {
        RenderError::NoAdapter => Failure::new(3, error),
        other => other.into(),
    })?;
    println!("{}", gpu.describe());
    Ok(())
}
