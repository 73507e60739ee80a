//! How the time of a frame grows with what is in it.

mod growth;
mod scenery;
mod slopes;

use halfway::prelude::*;
use halfway::render::AdapterChoice;

use super::{MeasureError, MeasureProgress};
use crate::timing::{Machine, Spread, TimedLook, in_turns, settle};
use scenery::ScalingScene;

pub use growth::Growth;
pub use slopes::{Decade, Law};

/// How objects look: in one constant colour, and under each shading, the cheapest first.
pub const LOOKS: [TimedLook; 4] = [
    TimedLook::Constant,
    TimedLook::Shaded(Shading::Flat),
    TimedLook::Shaded(Shading::Gouraud),
    TimedLook::Shaded(Shading::Phong),
];

/// The fewest rounds that a median is taken of, however long a frame takes: one that is disturbed then leaves it alone.
const LEAST: u32 = 3;

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScalingPlan {
    /// Width and height of the pictures in pixels, where it is not pixels that grow.
    pub size: u32,
    /// How many steps lead from 10ᵏ to 10ᵏ⁺¹.
    pub per_decade: u32,
    /// How often every look is timed in turn at each step, at most.
    pub rounds: u32,
    /// The time in milliseconds that the timed frames of one look may take at one step; 3 rounds are made at
    /// least, unless `rounds` are fewer.
    pub budget_ms: f64,
    /// The longest frame that is worth waiting for, in milliseconds: where one may be expected to take longer, its
    /// curve ends.
    pub limit_ms: f64,
    /// How many decades each sweep ends before its full length ([`Growth::end`]).
    pub decades_less: u32,
}

/// One point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedSample {
    /// How many triangles, objects, lights or pixels there are.
    pub count: f64,
    /// Times of a frame in milliseconds.
    pub frame_ms: Spread,
}

/// The time of a frame over a count of something.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What is counted.
    pub growth: Growth,
    /// How it looks.
    pub look: TimedLook,
    /// From few to many.
    pub samples: Vec<TimedSample>,
    /// Whether it was ended because a frame would have taken too long ([`ScalingPlan::limit_ms`]).
    pub is_cut: bool,
}

impl Curve {
    /// The slope in each decade of the count that was measured.
    pub fn decades(&self) -> Vec<Decade> {
        let points: Vec<_> = self.samples.iter().map(|sample| (sample.count, sample.frame_ms.median)).collect();
        slopes::decades(&points)
    }

    /// How it grows in the end, and where it does otherwise.
    pub fn law(&self) -> Option<Law> {
        slopes::law(&self.decades())
    }
}

impl ScalingPlan {
    /// The units of [`MeasureProgress`] that [`sweep`] will report.
    pub fn units(self) -> u64 {
        Growth::ALL.iter().map(|growth| growth.steps(self).len() as u64).sum()
    }
}

/// Measures every growth under every look; in this order, the last the quickest to change. Also tells what they were
/// measured on.
///
/// # Errors
/// The first frame that could not be drawn.
pub fn sweep(plan: ScalingPlan, progress: &mut MeasureProgress<'_>) -> Result<(Vec<Curve>, Machine), MeasureError> {
    let adapter = AdapterChoice::default().open()?;
    let mut sceneries = LOOKS.map(|look| ScalingScene::new(look, &adapter));
    let mut all = Vec::new();
    for growth in Growth::ALL {
        let mut curves = LOOKS.map(|look| Curve { growth, look, samples: Vec::new(), is_cut: false });
        for step in growth.steps(plan) {
            progress.begin(growth.name());
            extend(&mut curves, &mut sceneries, step, plan)?;
            progress.advance(1, growth.name());
        }
        all.extend(curves);
    }
    Ok((all, Machine::new(&adapter)))
}

/// Takes one step on every curve that is not cut.
fn extend(
    curves: &mut [Curve; LOOKS.len()],
    sceneries: &mut [ScalingScene; LOOKS.len()],
    step: f64,
    plan: ScalingPlan,
) -> Result<(), MeasureError> {
    let mut going_on = Vec::new();
    let mut apps = Vec::new();
    for (curve, scenery) in curves.iter_mut().zip(sceneries) {
        curve.is_cut |= curve.samples.last().is_some_and(|last| expected(last, step) > plan.limit_ms);
        if !curve.is_cut {
            let count = scenery.show(curve.growth, step, plan.size);
            let app = scenery.app();
            settle(app)?;
            going_on.push((curve, count));
            apps.push(app);
        }
    }
    // The first round tells how long the others may be expected to take.
    let mut times = in_turns(&mut apps, 1)?;
    let slowest = times.iter().map(|own| own.iter().sum::<f64>()).fold(f64::MIN_POSITIVE, f64::max);
    let rounds = (plan.budget_ms / slowest) as u32;
    let more = in_turns(&mut apps, rounds.max(LEAST - 1).min(plan.rounds.saturating_sub(1)))?;
    for (((curve, count), own), more) in going_on.into_iter().zip(&mut times).zip(more) {
        own.extend(more);
        curve.samples.push(TimedSample { count, frame_ms: Spread::of(own) });
    }
    Ok(())
}

/// What a frame takes at a later step if its time grows in proportion.
fn expected(last: &TimedSample, step: f64) -> f64 {
    last.frame_ms.median * step / last.count
}
