//! An allocator that counts, to see what memory a reader takes.
#![allow(dead_code, reason = "each program uses a part of it")]
#![allow(unsafe_code, reason = "an allocator is unsafe by its trait; this one only counts and hands on")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Bytes that a file may take in memory: for each of its own, and in any case. An `f` of SMF with two digits a
/// corner takes 9 bytes and becomes three vertices of 48 bytes where attributes are bound to faces, in arrays that are
/// up to twice as large; the documents of glTF are trees of JSON. Errors and warnings quote a few lines.
const PER_BYTE: usize = 256;
const AT_LEAST: usize = 1 << 18;

/// The most memory that reading a file of N bytes may take.
pub(crate) const fn most_for(bytes: usize) -> usize {
    AT_LEAST + PER_BYTE * bytes
}

/// The system's allocator, with a count of the bytes that are taken.
pub(crate) struct Counting {
    now: AtomicUsize,
    peak: AtomicUsize,
}

impl Counting {
    pub(crate) const fn new() -> Self {
        Self { now: AtomicUsize::new(0), peak: AtomicUsize::new(0) }
    }

    /// The bytes that are taken now.
    pub(crate) fn now(&self) -> usize {
        self.now.load(Relaxed)
    }

    /// Does some work; returns its result, and the peak of the bytes taken meanwhile beyond those before.
    pub(crate) fn peak_of<T>(&self, work: impl FnOnce() -> T) -> (T, usize) {
        let before = self.now();
        self.peak.store(before, Relaxed);
        let done = work();
        (done, self.peak.load(Relaxed) - before)
    }

    fn add(&self, bytes: usize) {
        let now = self.now.fetch_add(bytes, Relaxed) + bytes;
        self.peak.fetch_max(now, Relaxed);
    }
}

// SAFETY: every call is handed on to the system's allocator as it is.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        self.add(layout.size());
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        self.now.fetch_sub(layout.size(), Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // The larger of the two counts: large blocks grow in place.
        if size > layout.size() {
            self.add(size - layout.size());
        } else {
            self.now.fetch_sub(layout.size() - size, Relaxed);
        }
        // SAFETY: as the caller promises.
        unsafe { System.realloc(pointer, layout, size) }
    }
}
