//! `halfway adapters`.

use super::Failure;
use halfway::render::{Gpu, RenderError};

pub(super) fn run() -> Result<(), Failure> {
    let gpu = Gpu::open_headless().map_err(|error| match error {
        RenderError::NoAdapter => Failure::new(3, error),
        other => other.into(),
    })?;
    println!("{}", gpu.describe());
    Ok(())
}
