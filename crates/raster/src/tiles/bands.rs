//! The picture's memory, cut into rows of tiles that threads borrow.

use crate::error::{LARGEST_SIDE, RasterError};
use crate::input::pass::{Output, Pass, PixelFormat};
use crate::pixels::cover::PIXELS;
use crate::vertices::placed::TILE;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// The most rows of tiles.
const MOST_BANDS: usize = LARGEST_SIDE as usize / TILE;

/// Values a pixel.
const CHANNELS: usize = 4;

/// Values of pixels: one of both lists is empty.
#[derive(Default)]
pub(crate) struct PixelData<B, F> {
    pub(crate) bytes: B,
    pub(crate) floats: F,
}

/// A thread's own memory of one tile.
pub(crate) type Own = PixelData<Vec<u8>, Vec<f32>>;

/// The memory of a tile's pixels.
pub(crate) struct Rows<'a> {
    pub(crate) values: PixelData<&'a mut [u8], &'a mut [f32]>,
    /// Pixels from the first of a row to the first of the next.
    stride: usize,
}

impl Rows<'_> {
    /// The index of a pixel's first value, given its number in the tile.
    #[inline(always)]
    pub(crate) fn place(&self, pixel: usize) -> usize {
        CHANNELS * (pixel / TILE * self.stride + pixel % TILE)
    }
}

/// The picture; in an array, so that no frame allocates one.
pub(crate) struct Bands<'a> {
    each: [Mutex<PixelData<&'a mut [u8], &'a mut [f32]>>; MOST_BANDS],
    width: usize,
    clear: &'a ClearTiles,
    columns: usize,
}

impl<'a> Bands<'a> {
    pub(crate) fn new(pass: &Pass, output: Output<'a>, clear: &'a ClearTiles) -> Self {
        let width = pass.size[0] as usize;
        let (bytes, floats): (&mut [u8], &mut [f32]) = match output {
            Output::Bytes(bytes) => (bytes, &mut []),
            Output::Floats(floats) => (&mut [], floats),
        };
        let band = CHANNELS * width * TILE;
        let (mut bytes, mut floats) = (bytes.chunks_mut(band), floats.chunks_mut(band));
        let mut next = |_| {
            let (bytes, floats) = (bytes.next().unwrap_or_default(), floats.next().unwrap_or_default());
            Mutex::new(PixelData { bytes, floats })
        };
        Self { each: std::array::from_fn(&mut next), width, clear, columns: width.div_ceil(TILE) }
    }

    /// Calls `put` with the memory of a tile's pixels; or, if another thread holds its row of tiles or the picture's
    /// edge cuts the tile, with memory of the thread's own, which is then copied.
    pub(crate) fn fill(&self, [column, row]: [u32; 2], own: &mut Own, put: impl FnOnce(&mut Rows)) {
        let left = column as usize * TILE;
        let across = TILE.min(self.width - left);
        let band = &self.each[row as usize];
        if across == TILE
            && let Ok(mut band) = band.try_lock()
        {
            let PixelData { bytes, floats } = &mut *band;
            let values = PixelData { bytes: from(bytes, CHANNELS * left), floats: from(floats, CHANNELS * left) };
            put(&mut Rows { values, stride: self.width });
            return;
        }
        put(&mut Rows { values: PixelData { bytes: &mut own.bytes, floats: &mut own.floats }, stride: TILE });
        let Ok(mut band) = band.lock() else { return };
        let places = CHANNELS * left..CHANNELS * (left + across);
        for (to, from) in rows(band.bytes, self.width).zip(own.bytes.chunks_exact(CHANNELS * TILE)) {
            to[places.clone()].copy_from_slice(&from[..places.len()]);
        }
        for (to, from) in rows(band.floats, self.width).zip(own.floats.chunks_exact(CHANNELS * TILE)) {
            to[places.clone()].copy_from_slice(&from[..places.len()]);
        }
    }

    /// Records whether a tile is clear; returns whether it was.
    pub(crate) fn set_clear(&self, [column, row]: [u32; 2], is_clear: bool) -> bool {
        self.clear.tiles[row as usize * self.columns + column as usize].swap(is_clear, Ordering::Relaxed)
    }
}

fn rows<T>(band: &mut [T], width: usize) -> impl Iterator<Item = &mut [T]> {
    band.chunks_exact_mut(CHANNELS * width)
}

/// The next element, or nothing of an empty list.
fn from<T>(list: &mut [T], start: usize) -> &mut [T] {
    list.get_mut(start..).unwrap_or_default()
}

/// Allocates the memory of a tile.
pub(crate) fn make_room(own: &mut Own, pixels: PixelFormat) {
    let (bytes, floats) = if pixels.is_bytes() { (PIXELS, 0) } else { (0, PIXELS) };
    own.bytes.resize(CHANNELS * bytes, 0);
    own.floats.resize(CHANNELS * floats, 0.0);
}

/// Which tiles of a picture show only its clear color. Keep it with the memory that pictures are drawn into: tiles that
/// stay clear are then not written again.
#[derive(Debug, Default)]
pub struct ClearTiles {
    /// Of this width and height, format, and color's bits.
    of: Option<([u32; 2], PixelFormat, [u32; 3])>,
    tiles: Vec<AtomicBool>,
}

impl ClearTiles {
    /// Resets it if the size, format or clear color has changed.
    pub(crate) fn prepare(&mut self, pass: &Pass, count: usize) -> Result<(), RasterError> {
        let of = Some((pass.size, pass.pixels, pass.clear.map(f32::to_bits)));
        if self.of != of {
            self.of = None;
            self.tiles.clear();
            let refused = |_| RasterError::Memory { what: "the lists of tiles", bytes: count as u64 };
            self.tiles.try_reserve(count).map_err(refused)?;
            self.tiles.resize_with(count, AtomicBool::default);
            self.of = of;
        }
        Ok(())
    }
}
