//! The memory that the CPU draws into.

use crate::picture::Picture;
use bevy_ecs::prelude::Resource;
use bevy_math::UVec2;
use halfway_frame::error::RenderError;
use halfway_lighting::{Encoding, Intensity};
use halfway_raster::{ClearTiles, Output, PixelFormat, RasterError, Rasterizer};
use image::{Rgba32FImage, RgbaImage};

/// While this resource exists, the CPU draws pictures of this size for a window instead of for
/// [`Headless`](crate::Headless). The window's runner inserts it, and shows the [`Canvas`] after each frame.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct CanvasTarget {
    /// Width and height in physical pixels; nothing is drawn if one is 0.
    pub size: UVec2,
}

/// The newest frame that the CPU has drawn, in memory that the next one is drawn into.
#[derive(Resource, Default)]
pub struct Canvas {
    size: UVec2,
    /// One of them is empty.
    bytes: Vec<u8>,
    floats: Vec<f32>,
    /// The drawn values before a policy that acts on the finished picture; empty without one.
    drawn_floats: Vec<f32>,
    /// The divisor of the last picture, if it was divided.
    divisor: Option<f32>,
    clear_tiles: ClearTiles,
    /// Whether it holds a frame.
    drawn: bool,
    /// The pictures of all cameras that share the window, and its size; of size 0 where one camera has it for itself.
    shared: (UVec2, Vec<u8>),
}

/// Values a pixel.
const CHANNELS: usize = 4;

impl Canvas {
    /// Width and height in pixels, and the bytes of the newest frame: red, green, blue and 255, row by row from the
    /// top. `None` without a frame, or for one in floating point.
    pub fn bytes(&self) -> Option<(UVec2, &[u8])> {
        let (size, shared) = &self.shared;
        if *size != UVec2::ZERO {
            return Some((*size, &shared[..]));
        }
        Some((self.size, self.own_bytes()?))
    }

    /// The bytes that were drawn into it.
    pub(crate) fn own_bytes(&self) -> Option<&[u8]> {
        (self.drawn && !self.bytes.is_empty()).then_some(&self.bytes[..])
    }

    /// The memory of a picture that all cameras share, black.
    pub(crate) fn begin_shared(&mut self, size: UVec2) -> Result<Vec<u8>, RenderError> {
        let mut shared = std::mem::take(&mut self.shared.1);
        resize(&mut shared, CHANNELS * size.x as usize * size.y as usize)?;
        shared.chunks_exact_mut(CHANNELS).for_each(|pixel| pixel.copy_from_slice(&[0, 0, 0, u8::MAX]));
        Ok(shared)
    }

    /// Shows the picture that all cameras share until the next frame begins.
    pub(crate) fn show_shared(&mut self, size: UVec2, shared: Vec<u8>) {
        self.shared = (size, shared);
    }

    /// Begins a frame of this size.
    ///
    /// # Errors
    /// [`RenderError::Memory`]
    pub(crate) fn begin(&mut self, size: UVec2, is_float: bool, is_toned: bool) -> Result<(), RenderError> {
        (self.drawn, self.shared.0) = (false, UVec2::ZERO);
        if size != self.size || is_toned == self.drawn_floats.is_empty() {
            // The memory may have moved, too.
            self.clear_tiles = ClearTiles::default();
            self.divisor = None;
        }
        if is_float == self.floats.is_empty() {
            self.divisor = None;
        }
        self.size = size;
        let count = CHANNELS * size.x as usize * size.y as usize;
        if is_toned {
            resize(&mut self.drawn_floats, count)?;
        } else {
            self.drawn_floats = Vec::new();
        }
        if is_float {
            self.bytes = Vec::new();
            resize(&mut self.floats, count)
        } else {
            self.floats = Vec::new();
            resize(&mut self.bytes, count)
        }
    }

    /// The memory to draw into, and its clear tiles.
    pub(crate) fn output(&mut self) -> (Output<'_>, &mut ClearTiles) {
        let output = match (self.drawn_floats.is_empty(), self.bytes.is_empty()) {
            (false, _) => Output::Floats(&mut self.drawn_floats),
            (true, true) => Output::Floats(&mut self.floats),
            (true, false) => Output::Bytes(&mut self.bytes),
        };
        (output, &mut self.clear_tiles)
    }

    /// Applies a policy that acts on the finished picture.
    ///
    /// # Errors
    /// Those of the rasterizer.
    pub(crate) fn finish(
        &mut self,
        rasterizer: &Rasterizer,
        policy: Intensity,
        encoding: Encoding,
    ) -> Result<(), RasterError> {
        if self.drawn_floats.is_empty() {
            return Ok(());
        }
        let (output, format) = match (self.bytes.is_empty(), encoding) {
            (true, _) => (Output::Floats(&mut self.floats), PixelFormat::Floats),
            (false, Encoding::Srgb) => (Output::Bytes(&mut self.bytes), PixelFormat::SrgbBytes),
            (false, Encoding::Raw) => (Output::Bytes(&mut self.bytes), PixelFormat::RawBytes),
        };
        self.divisor = rasterizer.finish(&self.drawn_floats, policy, self.divisor, output, format)?;
        Ok(())
    }

    /// Records whether the frame was drawn.
    pub(crate) fn end(&mut self, drawn: bool) {
        self.drawn = drawn;
    }

    /// A copy of the newest frame.
    ///
    /// # Errors
    /// [`RenderError::NoPicture`] without a frame, [`RenderError::Memory`].
    pub(crate) fn picture(&self) -> Result<Picture, RenderError> {
        let UVec2 { x, y } = self.size;
        let picture = match (self.drawn, self.floats.is_empty()) {
            (false, _) => None,
            (true, true) => RgbaImage::from_raw(x, y, copied(&self.bytes)?).map(Picture::Byte),
            (true, false) => Rgba32FImage::from_raw(x, y, copied(&self.floats)?).map(Picture::Float),
        };
        picture.ok_or(RenderError::NoPicture)
    }
}

fn resize<T: Copy + Default>(memory: &mut Vec<T>, count: usize) -> Result<(), RenderError> {
    if memory.capacity() < count || memory.capacity() / 4 > count {
        // Its contents will be overwritten.
        *memory = Vec::new();
        reserve(memory, count)?;
    }
    memory.resize(count, T::default());
    Ok(())
}

fn copied<T: Copy>(memory: &[T]) -> Result<Vec<T>, RenderError> {
    let mut copy = Vec::new();
    reserve(&mut copy, memory.len())?;
    copy.extend_from_slice(memory);
    Ok(copy)
}

fn reserve<T>(memory: &mut Vec<T>, count: usize) -> Result<(), RenderError> {
    let bytes = count as u64 * size_of::<T>() as u64;
    memory.try_reserve_exact(count).map_err(|_| RenderError::Memory { what: "the picture".into(), bytes })
}
