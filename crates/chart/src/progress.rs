//! How far the measuring is.

/// Tells what has been done, in units of about the same time.
pub struct Progress<'a> {
    done: u64,
    tell: &'a mut dyn FnMut(u64, &str),
}

impl<'a> Progress<'a> {
    /// Progress that `tell` hears of: units done so far, and what is being done.
    pub fn new(tell: &'a mut dyn FnMut(u64, &str)) -> Self {
        Self { done: 0, tell }
    }

    /// Says what begins now.
    pub fn begin(&mut self, what: &str) {
        (self.tell)(self.done, what);
    }

    /// Counts units that are done.
    pub fn advance(&mut self, units: u64, what: &str) {
        self.done += units;
        (self.tell)(self.done, what);
    }
}
