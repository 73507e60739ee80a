//! How much memory reading files and making levels of detail take. The allocator counts for the whole program, so these
//! tests are a program of their own and run one at a time.

mod bad_bytes;
#[path = "../common/mod.rs"]
mod common;
#[path = "../common/counting.rs"]
mod counting;
mod lod;
mod past_failures;
#[path = "../common/targets.rs"]
mod targets;

use std::sync::{Mutex, MutexGuard, PoisonError};

use counting::Counting;

#[global_allocator]
static ALLOCATOR: Counting = Counting::new();

/// Waits until no other test takes memory.
fn alone() -> MutexGuard<'static, ()> {
    static LOCK: Mutex<()> = Mutex::new(());
    LOCK.lock().unwrap_or_else(PoisonError::into_inner)
}
