//! The CPU as an adapter.

use bevy_ecs::prelude::Resource;
use halfway_frame::error::RenderError;
use halfway_raster::{RasterError, RasterOptions, Rasterizer, VectorWidth, WIDTH_VARIABLE};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The CPU without a driver: no device, and the same bits on every machine. Opened by the first frame if
/// [`AdapterChoice`](crate::AdapterChoice) selects it, or inserted; clones share threads and memory, and may be given
/// to several Apps. If the world also has a [`Gpu`](crate::Gpu), that one draws.
///
/// It uses the widest SIMD level of the CPU, unless the environment variable `HALFWAY_SIMD` names another (`avx512`,
/// `avx2`, `neon` or `plain`), and as many threads as the process may run at once.
#[derive(Resource, Clone)]
pub struct Cpu {
    rasterizer: Arc<Mutex<Rasterizer>>,
    width: VectorWidth,
}

impl Cpu {
    /// Its name for [`AdapterChoice`](crate::AdapterChoice), in full or before a colon.
    pub const NAME: &str = "cpu";

    /// The bits of the sub-pixel grid that vertices are snapped to.
    pub const SUB_PIXEL_BITS: u32 = 8;

    /// Opens the CPU with its widest SIMD level, or the one that `HALFWAY_SIMD` names.
    ///
    /// # Errors
    /// [`RenderError::NoVectors`] if the variable names a level that the CPU lacks, [`RenderError::NoDevice`] if the
    /// system refuses threads.
    pub fn open() -> Result<Self, RenderError> {
        Self::drawing_with(VectorWidth::from_environment().map_err(|error| no_vectors(WIDTH_VARIABLE, error))?)
    }

    /// Opens the CPU with the SIMD level of that name.
    ///
    /// # Errors
    /// [`RenderError::NoVectors`] or [`RenderError::NoDevice`].
    pub(crate) fn open_with(vectors: &str) -> Result<Self, RenderError> {
        let asked_by = format!("the adapter {}:{vectors}", Self::NAME);
        Self::drawing_with(VectorWidth::named(vectors).map_err(|error| no_vectors(&asked_by, error))?)
    }

    fn drawing_with(width: VectorWidth) -> Result<Self, RenderError> {
        let rasterizer = Rasterizer::new(RasterOptions { width: Some(width), threads: None })
            .map_err(|error| RenderError::NoDevice { adapter: Self::NAME.into(), reason: error.to_string() })?;
        Ok(Self { rasterizer: Arc::new(Mutex::new(rasterizer)), width })
    }

    /// The name of its SIMD level: `avx512`, `avx2`, `neon` or `plain`.
    pub fn vectors(&self) -> String {
        self.width.to_string()
    }

    /// A line of description, in the form of a graphics adapter's: `avx2 (cpu, software)`.
    pub fn describe(&self) -> String {
        format!("{} ({}, software)", self.width, Self::NAME)
    }

    /// The rasterizer, for one App at a time.
    pub(crate) fn rasterizer(&self) -> MutexGuard<'_, Rasterizer> {
        self.rasterizer.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn no_vectors(asked_by: &str, error: RasterError) -> RenderError {
    RenderError::NoVectors { asked_by: asked_by.into(), reason: error.to_string() }
}
