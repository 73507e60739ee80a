//! How much is measured.

use crate::measure::{accuracy, convergence, highlight, scaling};

/// How much is measured of everything.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReportPlan {
    /// Of error and time.
    pub accuracy: accuracy::AccuracyPlan,
    /// Of the rates of convergence.
    pub convergence: convergence::ConvergencePlan,
    /// Of the moving highlight.
    pub highlight: highlight::HighlightPlan,
    /// Of how the time of a frame grows.
    pub scaling: scaling::ScalingPlan,
}

impl ReportPlan {
    /// What the project's figures come from: minutes on two cores without a GPU.
    pub const FULL: Self = Self {
        accuracy: accuracy::AccuracyPlan { size: 640, levels: 5, rounds: 25 },
        convergence: convergence::ConvergencePlan { size: 768, levels: 5 },
        highlight: highlight::HighlightPlan { size: 256, level: 8, frames: 120 },
        scaling: scaling::ScalingPlan {
            size: 512,
            per_decade: 2,
            rounds: 15,
            budget_ms: 600.0,
            limit_ms: 1000.0,
            decades_less: 0,
        },
    };
    /// The same with fewer levels, rounds, frames and pixels: for a look, and for CI.
    pub const QUICK: Self = Self {
        accuracy: accuracy::AccuracyPlan { size: 320, levels: 3, rounds: 15 },
        convergence: convergence::ConvergencePlan { size: 384, levels: 4 },
        highlight: highlight::HighlightPlan { size: 128, level: 8, frames: 60 },
        scaling: scaling::ScalingPlan {
            size: 256,
            per_decade: 1,
            rounds: 5,
            budget_ms: 100.0,
            limit_ms: 300.0,
            decades_less: 1,
        },
    };

    /// The units that [`measure`](super::measure) will report.
    pub fn units(self) -> u64 {
        self.accuracy.units() + self.convergence.units() + self.highlight.units() + self.scaling.units()
    }
}
