//! The progress of measurements.

/// Reports progress, in units of about the same time.
pub struct Progress<'a> {
    done: u64,
    tell: &'a mut dyn FnMut(u64, &str),
}

impl<'a> Progress<'a> {
    /// Progress reported to `tell`: units done so far, and the current work.
    pub fn new(tell: &'a mut dyn FnMut(u64, &str)) -> Self {
        Self { done: 0, tell }
    }

    /// Reports the work that begins now.
    pub fn begin(&mut self, what: &str) {
        (self.tell)(self.done, what);
    }

    /// Counts finished units.
    pub fn advance(&mut self, units: u64, what: &str) {
        self.done += units;
        (self.tell)(self.done, what);
    }
}
