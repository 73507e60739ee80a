//! How much is measured.

use crate::measure::{accuracy, convergence, highlight};

/// How much is measured of everything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Of error and time.
    pub accuracy: accuracy::Plan,
    /// Of the rates of convergence.
    pub convergence: convergence::Plan,
    /// Of the moving highlight.
    pub highlight: highlight::Plan,
}

impl Plan {
    /// What the project's figures come from: minutes on two cores without a GPU.
    pub const FULL: Self = Self {
        accuracy: accuracy::Plan { size: 640, levels: 5, rounds: 25 },
        convergence: convergence::Plan { size: 768, levels: 5 },
        highlight: highlight::Plan { size: 256, level: 8, frames: 120 },
    };
    /// The same with fewer levels, rounds, frames and pixels: for a look, and for CI.
    pub const QUICK: Self = Self {
        accuracy: accuracy::Plan { size: 320, levels: 3, rounds: 15 },
        convergence: convergence::Plan { size: 384, levels: 4 },
        highlight: highlight::Plan { size: 128, level: 8, frames: 60 },
    };

    /// The units that [`measure`](super::measure) will report.
    pub fn units(self) -> u64 {
        self.accuracy.units() + self.convergence.units() + self.highlight.units()
    }
}
