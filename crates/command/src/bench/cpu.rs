//! CPU times of each set of a frame.

use std::time::Duration;

use halfway::prelude::*;
use halfway::render::{FrameTimes, RenderError, SetTimes};
use halfway_chart::timing::{in_turns_with, median, settle};
use serde_json::{Map, Value, json};

/// The explanation of [`CpuTimes::own_ms`] for readers.
pub(super) const OWN_TIME: &str = "Own CPU is the renderer's own part of it, a median, too: every set of a frame but \
                                   Draw, which hands the work to the adapter; a software adapter may draw in there.";

/// The sets' times in each timed frame.
#[derive(Clone, Debug, Default)]
pub(super) struct CpuTimes(Vec<SetTimes>);

/// Lets the Apps settle and times them in turns, with the CPU's times in the same frames.
pub(super) fn timed(apps: &mut [App], rounds: u32) -> Result<Vec<(Vec<f64>, CpuTimes)>, RenderError> {
    apps.iter_mut().try_for_each(settle)?;
    let mut cpu = vec![CpuTimes::default(); apps.len()];
    let times = in_turns_with(&mut apps.iter_mut().collect::<Vec<_>>(), rounds, |i, app| {
        cpu[i].0.extend(app.world().get_resource::<FrameTimes>().map(FrameTimes::newest));
    })?;
    Ok(times.into_iter().zip(cpu).collect())
}

impl CpuTimes {
    /// Medians in milliseconds, by the names of the sets; and that of the sum.
    pub(super) fn json(&self) -> Value {
        let sets =
            RenderSet::ALL.map(|set| (set.name().to_owned(), json!(self.median_ms(|times| times.duration(set)))));
        let total = ("total".to_owned(), json!(self.median_ms(SetTimes::total)));
        sets.into_iter().chain([total]).collect::<Map<_, _>>().into()
    }

    /// The renderer's own part: without the set that submits, which a software adapter may use to draw.
    pub(super) fn own_ms(&self) -> f64 {
        median(&self.own_of_each_ms())
    }

    /// The renderer's own part, frame by frame.
    pub(super) fn own_of_each_ms(&self) -> Vec<f64> {
        self.each_ms(|times| times.total().saturating_sub(times.duration(RenderSet::Draw)))
    }

    /// The set that draws, frame by frame.
    pub(super) fn draw_of_each_ms(&self) -> Vec<f64> {
        self.each_ms(|times| times.duration(RenderSet::Draw))
    }

    fn median_ms(&self, of: impl Fn(&SetTimes) -> Duration) -> f64 {
        median(&self.each_ms(of))
    }

    fn each_ms(&self, of: impl Fn(&SetTimes) -> Duration) -> Vec<f64> {
        self.0.iter().map(|times| of(times).as_secs_f64() * 1e3).collect()
    }
}
