//! A pool of threads.

use crate::error::RasterError;
use std::sync::Mutex;

/// Threads that process the parts of a task in parallel, including the calling one, and sleep between tasks.
#[derive(Debug)]
pub struct Threads {
    count: usize,
    pool: Option<rayon::ThreadPool>,
}

impl Threads {
    /// The calling thread alone.
    pub const ALONE: Self = Self { count: 1, pool: None };

    /// Starts `count` − 1 threads beside the calling one, whose names begin with `name`; `None` for one a core. 0
    /// counts as 1.
    ///
    /// # Errors
    /// The system refuses threads.
    pub fn new(name: &'static str, count: Option<usize>) -> Result<Self, RasterError> {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        let count = count.unwrap_or_else(cores).max(1);
        if count == 1 {
            return Ok(Self::ALONE);
        }
        let named = move |number| format!("{name} {number}");
        let built = rayon::ThreadPoolBuilder::new().num_threads(count - 1).thread_name(named).build();
        let pool = built.map_err(|error| RasterError::Threads { count: count - 1, reason: error.to_string() })?;
        Ok(Self { count, pool: Some(pool) })
    }

    /// The number of threads, including the calling one.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Calls `work` with each worker, each on a thread of its own as far as there are threads, and waits for all.
    pub fn all<W: Send>(&self, workers: impl IntoIterator<Item = W>, work: impl Fn(W) + Sync) {
        let mut workers = workers.into_iter();
        let Some(first) = workers.next() else { return };
        let work = &work;
        match &self.pool {
            Some(pool) => pool.in_place_scope(|scope| {
                for worker in workers {
                    scope.spawn(move |_| work(worker));
                }
                work(first);
            }),
            None => std::iter::once(first).chain(workers).for_each(work),
        }
    }

    /// Calls `work` with each part and a free worker. No more threads than workers are woken.
    pub fn share<W: Send, T: Send>(
        &self,
        workers: impl IntoIterator<Item = W>,
        parts: impl Iterator<Item = T> + Send,
        work: impl Fn(&mut W, T) + Sync,
    ) {
        let parts = Mutex::new(parts);
        let next = || parts.lock().ok()?.next();
        self.all(workers, |mut worker| {
            while let Some(part) = next() {
                work(&mut worker, part);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_part_is_done_once_by_one_of_the_workers() {
        for count in [0, 1, 2, 3] {
            let threads = Threads::new("test", Some(count)).expect("a few threads");
            assert_eq!(threads.count(), count.max(1));
            let mut workers = [0_u32; 3];
            let mut parts = [0_u32; 1000];
            threads.share(workers.iter_mut(), parts.iter_mut(), |worker, part| {
                **worker += 1;
                *part += 1;
            });
            assert_eq!(parts, [1; 1000]);
            assert_eq!(workers.iter().sum::<u32>(), 1000, "{workers:?}");
        }
    }
}
