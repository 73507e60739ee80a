//! How far the sweeps are.

/// Is told what has been done, and how much of all that is. Units are about equally long.
pub struct MeasureProgress<'a> {
    done: u64,
    tell: &'a mut dyn FnMut(u64, &str),
}

impl<'a> MeasureProgress<'a> {
    /// Progress that `tell` hears of: units done so far, and what is being done.
    pub fn new(tell: &'a mut dyn FnMut(u64, &str)) -> Self {
        Self { done: 0, tell }
    }

    /// What begins now.
    pub fn begin(&mut self, what: &str) {
        (self.tell)(self.done, what);
    }

    /// So many units more are done.
    pub fn advance(&mut self, units: u64, what: &str) {
        self.done += units;
        (self.tell)(self.done, what);
    }
}
