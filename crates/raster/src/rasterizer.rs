//! The rasterizer, which draws passes and distributes their tiles over threads.

use crate::error::RasterError;
use crate::input::check::check;
use crate::input::pass::{Output, Pass};
use crate::simd::lanes::Simd;
use crate::simd::width::{VectorWidth, with_vectors};
use crate::threads::Threads;
use crate::tiles::bands::{Bands, ClearTiles};
use crate::tiles::bins::Bins;
use crate::tiles::draw::{Scene, Worker};
use crate::vertices::screen::Screen;
use fearless_simd::Level;
use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How to draw. Neither choice changes a bit of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RasterOptions {
    /// The vectors to draw with; `None` for [`VectorWidth::from_environment`].
    pub width: Option<VectorWidth>,
    /// The number of threads, including the calling one; `None` for one a core. 0 counts as 1.
    pub threads: Option<usize>,
}

/// Draws passes on the CPU. It keeps the memory that it needs from one picture to the next; its threads sleep between.
pub struct Rasterizer {
    width: VectorWidth,
    level: Level,
    threads: Threads,
    bins: Bins,
    workers: Vec<Worker>,
}

/// A pass with fewer triangles and pixels than this is drawn by the calling thread, since waking another takes longer.
const WORTH_A_THREAD: usize = 4_000;

impl Rasterizer {
    /// Detects the CPU's SIMD level, and starts threads.
    ///
    /// # Errors
    /// The width is not this CPU's, the environment names an unknown one, or the system refuses threads.
    pub fn new(options: RasterOptions) -> Result<Self, RasterError> {
        let width = options.width.map_or_else(VectorWidth::from_environment, Ok)?;
        let Some(level) = width.level() else { return VectorWidth::named(&width.to_string()).map(|_| unreachable!()) };
        let threads = Threads::new("raster", options.threads)?;
        let workers = (0..threads.count()).map(|_| Worker::new()).collect();
        Ok(Self { width, level, threads, bins: Bins::default(), workers })
    }

    /// The SIMD level it draws with.
    pub fn width(&self) -> VectorWidth {
        self.width
    }

    /// The number of threads that draw.
    pub fn threads(&self) -> usize {
        self.threads.count()
    }

    /// The proof that this CPU has those vectors.
    pub(crate) fn level(&self) -> Level {
        self.level
    }

    /// Calls a function with each of some parts, on all threads.
    pub(crate) fn each<T: Send>(&self, parts: impl Iterator<Item = T> + Send, work: impl Fn(T) + Sync) {
        self.threads.share(0..self.threads.count(), parts, |_, part| work(part));
    }

    /// Draws a pass into memory of four values a pixel: red, green, blue, alpha. The memory has to hold the last
    /// picture that was drawn with these `clear_tiles`, or anything if they are new; tiles that were clear and stay
    /// clear are not written.
    ///
    /// # Errors
    /// The first fault of the pass or the output; nothing is drawn then.
    pub fn draw(&mut self, pass: &Pass, output: Output, clear_tiles: &mut ClearTiles) -> Result<(), RasterError> {
        check(pass, &output)?;
        let mut bins = std::mem::take(&mut self.bins);
        let filled = bins.fill(pass, self.threads.count(), |parts, work| self.each(parts.iter_mut(), work));
        self.bins = bins;
        filled?;
        let screen = Screen::new(pass);
        let scene = Scene { pass, bins: &self.bins, screen: &screen };
        let tiles = Tiles { rows: self.bins.tiles[1], count: (self.bins.tiles[0] * self.bins.tiles[1]) as usize };
        clear_tiles.prepare(pass, tiles.count)?;
        let bands = Bands::new(pass, output, clear_tiles);
        let amount = pass.size[0] as usize * pass.size[1] as usize / 8 + 16 * self.bins.jobs.len();
        let threads = if amount > WORTH_A_THREAD { self.threads.count().min(tiles.count) } else { 1 };
        let (level, next, workers) = (self.level, AtomicUsize::new(0), &mut self.workers[..threads]);
        for worker in &mut *workers {
            worker.prepare(pass);
        }
        self.threads.all(workers, |worker| {
            with_vectors!(level, simd => tiles.draw(simd, worker, &scene, &next, &bands));
        });
        Ok(())
    }
}

impl fmt::Debug for Rasterizer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Rasterizer")
            .field("width", &self.width)
            .field("threads", &self.threads())
            .finish_non_exhaustive()
    }
}

#[derive(Clone, Copy)]
struct Tiles {
    rows: u32,
    count: usize,
}

impl Tiles {
    /// Draws the next tile while there are any, column by column, so that threads are at different rows of tiles.
    #[inline(always)]
    fn draw<S: Simd>(self, simd: S, worker: &mut Worker, scene: &Scene, next: &AtomicUsize, bands: &Bands) {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= self.count {
                return;
            }
            let tile = [number as u32 / self.rows, number as u32 % self.rows];
            worker.draw(simd, scene, tile, bands);
        }
    }
}
