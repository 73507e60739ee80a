//! Progress of long work, and signals that stop it.

use std::io::{IsTerminal, Write};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use halfway::record::Continue;

use crate::failure::STOPPED;

/// A [`Bar`], and whether Ctrl-C or SIGTERM was received.
///
/// The first signal ends the work in good order, so that no partial file is left; a second one ends it at once.
pub(crate) struct Progress {
    bar: Bar,
    frames: u32,
    stop: Arc<AtomicBool>,
}

impl Progress {
    /// For whole frames; no bar for a single one.
    pub(crate) fn for_frames(frames: u32) -> Self {
        let bar = if frames < 2 { Bar::hidden() } else { Bar::new() };
        Self { bar, frames, stop: stop_on_signals() }
    }

    /// For the tiles of a number of frames.
    pub(crate) fn for_tiles(frames: u32) -> Self {
        Self { bar: Bar::new(), frames, stop: stop_on_signals() }
    }

    /// For the bytes of a file.
    pub(crate) fn for_bytes() -> Self {
        Self::for_tiles(1)
    }

    /// Reports finished frames.
    pub(crate) fn frame(&self, done: u32) -> Continue {
        self.bar.show(done.into(), self.frames.into(), "");
        self.going_on()
    }

    /// Whether to begin another frame.
    pub(crate) fn going_on(&self) -> Continue {
        if self.is_stopped() { Continue::No } else { Continue::Yes }
    }

    /// Reports that `done` of the `of` tiles of frame `index` are finished.
    pub(crate) fn tile(&self, index: u32, done: u32, of: u32) -> ControlFlow<()> {
        self.part(u64::from(of) * u64::from(index) + u64::from(done), u64::from(of) * u64::from(self.frames))
    }

    /// Reports that `done` of `of` bytes are read.
    pub(crate) fn bytes(&self, done: u64, of: u64) -> ControlFlow<()> {
        self.part(done, of)
    }

    fn part(&self, done: u64, of: u64) -> ControlFlow<()> {
        self.bar.show(done, of, "");
        if self.is_stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// A progress line on standard error, cleared at the end. Nothing is shown if standard error is not a terminal.
pub(crate) struct Bar(Option<Mutex<Shown>>);

struct Shown {
    begun: Instant,
    /// Nothing is shown before.
    patience: Duration,
    /// The time of the last update.
    written: Option<Instant>,
    done: u64,
}

impl Bar {
    pub(crate) fn new() -> Self {
        Self::after(Duration::ZERO)
    }

    /// A bar for work that is usually done before it would be shown.
    pub(crate) fn after(patience: Duration) -> Self {
        let shown = || Mutex::new(Shown { begun: Instant::now(), patience, written: None, done: 0 });
        Self(std::io::stderr().is_terminal().then(shown))
    }

    fn hidden() -> Self {
        Self(None)
    }

    /// Shows that `done` of `of` are finished, and the current work. Updates at most ten times a second.
    pub(crate) fn show(&self, done: u64, of: u64, doing: &str) {
        let Some(shown) = &self.0 else { return };
        let mut shown = shown.lock().unwrap_or_else(PoisonError::into_inner);
        // Threads may report in another order than they finish in.
        shown.done = shown.done.max(done);
        let is_due = |written: Instant| written.elapsed() >= Duration::from_millis(100);
        if shown.begun.elapsed() >= shown.patience && shown.written.is_none_or(is_due) {
            shown.written = Some(Instant::now());
            let line = line(shown.done, of, shown.begun.elapsed(), doing);
            let _ = write!(std::io::stderr(), "\r{line}\x1b[K");
        }
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        let was_shown = |shown: &Mutex<Shown>| shown.lock().unwrap_or_else(PoisonError::into_inner).written.is_some();
        if self.0.as_ref().is_some_and(was_shown) {
            let _ = write!(std::io::stderr(), "\r\x1b[K");
        }
    }
}

/// For example `[#####               ]  25 %, 0:30 left: s1`.
fn line(done: u64, of: u64, elapsed: Duration, doing: &str) -> String {
    const WIDTH: usize = 20;
    let share = (done as f64 / of.max(1) as f64).min(1.0);
    let full = "#".repeat((share * WIDTH as f64) as usize);
    let left = match elapsed.div_f64(share.max(1e-9)).saturating_sub(elapsed).as_secs() {
        _ if done == 0 => String::new(),
        seconds => format!(", {}:{:02} left", seconds / 60, seconds % 60),
    };
    let doing = if doing.is_empty() { String::new() } else { format!(": {doing}") };
    format!("[{full:WIDTH$}] {:3.0} %{left}{doing}", share * 100.0)
}

/// Set by the first Ctrl-C or SIGTERM; the second one ends the process.
fn stop_on_signals() -> Arc<AtomicBool> {
    // A process has one handler.
    static STOP: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    let stop = STOP.get_or_init(|| {
        let stop = Arc::new(AtomicBool::new(false));
        let asked = Arc::clone(&stop);
        // Without a handler the signal ends the process, as by default.
        let _ = ctrlc::set_handler(move || {
            if asked.swap(true, Ordering::Relaxed) {
                std::process::exit(STOPPED.into());
            }
        });
        stop
    });
    Arc::clone(stop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_how_much_is_left() {
        let half_a_minute = Duration::from_secs(30);
        for (done, of, doing, expected) in [
            (0, 0, "", "[                    ]   0 %"),
            (0, 8, "s1", "[                    ]   0 %: s1"),
            (2, 8, "", "[#####               ]  25 %, 1:30 left"),
            (8, 8, "s2", "[####################] 100 %, 0:00 left: s2"),
            (9, 8, "", "[####################] 100 %, 0:00 left"),
        ] {
            assert_eq!(line(done, of, half_a_minute, doing), expected);
        }
    }
}
