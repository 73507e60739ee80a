//! How much is measured.

use crate::failures;
use crate::front::{ChartedScene, FrontFilter, FrontPlan, MeasuredOver};
use crate::measure::{convergence, highlight, scaling};

/// How much is measured of everything.
#[derive(Clone, Debug, PartialEq)]
pub struct ReportPlan {
    /// Of error and time.
    pub fronts: FrontPlan,
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
        fronts: FrontPlan {
            smaller: 1,
            details: 5,
            all_methods: true,
            rounds: 25,
            budget_ms: 2000.0,
            samples: 4,
            only: FrontFilter { methods: Vec::new(), detail: None },
        },
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
        fronts: FrontPlan {
            smaller: 2,
            details: 3,
            all_methods: false,
            rounds: 7,
            budget_ms: 100.0,
            samples: 2,
            only: FrontFilter { methods: Vec::new(), detail: None },
        },
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

    /// The units that [`measure`](super::measure) will report of these scenes on `adapters` adapters.
    pub fn units(&self, scenes: &[ChartedScene], adapters: usize) -> u64 {
        let own = self.convergence.units() + self.highlight.units() + self.scaling.units() + failures::PAGES;
        self.fronts.units(scenes, adapters) + MeasuredOver::units(&self.fronts, adapters) + own
    }
}
