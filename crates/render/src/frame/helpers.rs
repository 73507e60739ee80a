//! Threads that help with a frame, of which each does a part of what is the same whoever does it.

use halfway_raster::Threads;

/// A thread for each core, started when there is enough to do.
#[derive(Debug, Default)]
pub(crate) struct Helpers(Option<Threads>);

/// A second thread is woken for no fewer parts than this: what it takes over is to be worth more than waking it.
const WORTH_A_THREAD: usize = 4;

impl Helpers {
    /// These threads.
    #[cfg(test)]
    pub(crate) fn of(threads: Threads) -> Self {
        Self(Some(threads))
    }

    /// Whether there have been enough parts of anything to start them.
    #[cfg(test)]
    pub(crate) fn are_started(&self) -> bool {
        self.0.is_some()
    }

    /// Those who do so many parts, and how many of them: the calling thread alone where they are few.
    pub(crate) fn for_parts(&mut self, parts: usize) -> (&Threads, usize) {
        let threads = if parts < WORTH_A_THREAD { &Threads::ALONE } else { self.0.get_or_insert_with(started) };
        (threads, threads.count().min(parts / 2).max(1))
    }
}

/// A thread for each core, or the calling one alone where the system refuses others.
fn started() -> Threads {
    Threads::new("frame", None).unwrap_or_else(|error| {
        log::warn!("frames are prepared on one thread: {error}");
        Threads::ALONE
    })
}
