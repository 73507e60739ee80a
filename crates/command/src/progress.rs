//! How far long work is, and signals to stop it.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use halfway::record::Continue;
use indicatif::{ProgressBar, ProgressStyle};

use crate::failure::STOPPED;

/// A bar on standard error, hidden where that is no terminal; and whether Ctrl-C or SIGTERM asked for the end.
///
/// The first of them ends the work in good order, so that no half file is left; a second one ends it at once.
pub(crate) struct Progress {
    bar: ProgressBar,
    stop: Arc<AtomicBool>,
}

impl Progress {
    /// Of whole frames; no bar for a single one.
    pub(crate) fn of_frames(frames: u32) -> Self {
        if frames < 2 {
            return Self { bar: ProgressBar::hidden(), stop: stop_on_signals() };
        }
        Self { bar: bar("{bar:40} {pos}/{len} frames, {eta} left"), stop: stop_on_signals() }.with_length(frames.into())
    }

    /// Of the tiles of frames; their number is told by the first that is done.
    pub(crate) fn of_tiles() -> Self {
        Self { bar: bar("{bar:40} {percent} %, {eta} left"), stop: stop_on_signals() }
    }

    /// Of the bytes of a file; their number is told with the first that are read.
    pub(crate) fn of_bytes() -> Self {
        Self { bar: bar("{bar:40} {bytes}/{total_bytes}, {eta} left"), stop: stop_on_signals() }
    }

    fn with_length(self, length: u64) -> Self {
        self.bar.set_length(length);
        self
    }

    /// So many frames are done.
    pub(crate) fn frame(&self, done: u32) -> Continue {
        self.bar.set_position(done.into());
        self.going_on()
    }

    /// Whether to begin another frame.
    pub(crate) fn going_on(&self) -> Continue {
        if self.is_stopped() { Continue::No } else { Continue::Yes }
    }

    /// N of the tiles of frame `index` of M frames are done.
    pub(crate) fn tile(&self, index: u32, frames: u32, done: u32, of: u32) -> ControlFlow<()> {
        self.bar.set_length(u64::from(of) * u64::from(frames));
        // Threads may report in another order than they finish in.
        self.bar.set_position((u64::from(of) * u64::from(index) + u64::from(done)).max(self.bar.position()));
        if self.is_stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// N bytes of M are read.
    pub(crate) fn bytes(&self, done: u64, of: u64) -> ControlFlow<()> {
        self.bar.set_length(of);
        self.bar.set_position(done);
        if self.is_stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

fn bar(template: &str) -> ProgressBar {
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(1).with_style(style)
}

/// Set by the first Ctrl-C or SIGTERM; the second one ends the process.
fn stop_on_signals() -> Arc<AtomicBool> {
    // A process has one handler.
    static STOP: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    let stop = STOP.get_or_init(|| {
        let stop = Arc::new(AtomicBool::new(false));
        let asked = Arc::clone(&stop);
        // Where a handler cannot be set the signal ends the process, as it always did.
        let _ = ctrlc::set_handler(move || {
            if asked.swap(true, Ordering::Relaxed) {
                std::process::exit(STOPPED.into());
            }
        });
        stop
    });
    Arc::clone(stop)
}
