//! The CPU as what draws.

use bevy_ecs::prelude::Resource;
use halfway_frame::error::RenderError;
use halfway_raster::{RasterError, RasterOptions, Rasterizer, VectorWidth, WIDTH_VARIABLE};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The CPU, drawing by itself: no driver, no device, and the same bits on every machine. Opened by the first frame
/// where
/// [`AdapterChoice`](crate::AdapterChoice) says so, or inserted; clones share threads and memory, and may be given to
/// several Apps. While there is a [`Gpu`](crate::Gpu) too, that one draws.
///
/// It draws with vectors as wide as the CPU has, unless the environment variable `HALFWAY_SIMD` says `avx512`, `avx2`,
/// `neon` or `plain`, and with as many threads as the process may run at once.
#[derive(Resource, Clone)]
pub struct Cpu {
    rasterizer: Arc<Mutex<Rasterizer>>,
    width: VectorWidth,
}

impl Cpu {
    /// Its name for [`AdapterChoice`](crate::AdapterChoice), in full or before a colon.
    pub const NAME: &str = "cpu";

    /// The bits of the grid within a pixel to which vertices are rounded.
    pub const SUB_PIXEL_BITS: u32 = 8;

    /// With the widest vectors of this CPU, or those that `HALFWAY_SIMD` names.
    ///
    /// # Errors
    /// [`RenderError::NoVectors`] where the variable names others, [`RenderError::NoDevice`] where the system refuses
    /// threads.
    pub fn open() -> Result<Self, RenderError> {
        Self::drawing_with(VectorWidth::from_environment().map_err(|error| no_vectors(WIDTH_VARIABLE, error))?)
    }

    /// With the vectors of that name.
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

    /// The name of its vectors: `avx512`, `avx2`, `neon` or `plain`.
    pub fn vectors(&self) -> String {
        self.width.to_string()
    }

    /// One line for people, in the form of a graphics adapter's: `avx2 (cpu, software)`.
    pub fn describe(&self) -> String {
        format!("{} ({}, software)", self.width, Self::NAME)
    }

    /// To draw with; one App at a time.
    pub(crate) fn rasterizer(&self) -> MutexGuard<'_, Rasterizer> {
        self.rasterizer.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn no_vectors(asked_by: &str, error: RasterError) -> RenderError {
    RenderError::NoVectors { asked_by: asked_by.into(), reason: error.to_string() }
}
