//! Timing of frames, and facts about the machine.
//!
//! Times are those of a [`frame`], until the device has finished it, [in turns](in_turns) with the reference, once all
//! Apps have [settled](settle).

mod machine;

use std::time::Instant;

use halfway::prelude::*;
use halfway::render::{Adapter, RenderError};
use serde::Serialize;

pub use machine::Machine;

/// The definition of the time of a [`frame`].
pub const FRAME_TIME: &str = "A frame is App::update, which moves everything, prepares, encodes and submits the draws, \
                              and the wait until the device, if one draws, has finished them; start-up and reading the \
                              picture back are not in it.";

/// The frames that a turn of [`in_turns`] times.
const TIMED: usize = 2;
/// The most frames that [`settle`] waits for.
const MOST: u32 = 20;

/// The shading of everything in a timed scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TimedShading {
    /// In the colour of its material alone: the cost of drawing without lighting.
    Constant,
    /// Lit.
    Shaded(Shading),
}

impl TimedShading {
    /// A material of this ambient and diffuse color with a white highlight of shininess 32; unlit if the shading is
    /// constant.
    pub fn material(self, color: LinearRgba) -> Material {
        let lit = Material { specular: LinearRgba::WHITE, shininess: 32.0, ..Material::matte(color) };
        match self {
            Self::Constant => Material { diffuse: LinearRgba::BLACK, specular: LinearRgba::BLACK, ..lit },
            Self::Shaded(_) => lit,
        }
    }

    /// The shading of objects; Phong, which has no effect, if it is constant.
    pub fn shading(self) -> Shading {
        match self {
            Self::Constant => Shading::default(),
            Self::Shaded(shading) => shading,
        }
    }
}

/// One frame, until the device has finished it.
///
/// # Errors
/// The first error of the frame, or of the device.
pub fn frame(app: &mut App) -> Result<(), RenderError> {
    app.update();
    let world = app.world();
    if let Some(error) = world.get_resource::<FrameReport>().and_then(|report| report.errors.first()) {
        return Err(error.clone());
    }
    Adapter::from_world(world).ok_or(RenderError::NoAdapter)?.finish()
}

/// Runs frames until three in a row are alike, since the first ones build pipelines and upload meshes: the number of
/// pipelines is the same after each, and each uploads as many bytes. Stops after 20 frames of a scene that keeps
/// changing.
///
/// # Errors
/// See [`frame`].
pub fn settle(app: &mut App) -> Result<(), RenderError> {
    let mut last = None;
    let mut alike = 0;
    for _ in 0..MOST {
        frame(app)?;
        let report = app.world().get_resource::<FrameReport>();
        let now = report.map(|report| (report.pipelines, report.bytes_uploaded));
        alike = if now == last { alike + 1 } else { 0 };
        if alike == 2 {
            break;
        }
        last = now;
    }
    Ok(())
}

/// The times of frames in milliseconds, a list for each App, two frames a round.
///
/// All take turns within a round, so that disturbances of the machine affect all alike, and the i-th times belong
/// together. Each round begins with another App, so that none always follows the same one. The first frame of each turn
/// is not timed: it warms the caches that the others have cooled. [`settle`] the Apps first.
///
/// # Errors
/// See [`frame`].
pub fn in_turns(apps: &mut [&mut App], rounds: u32) -> Result<Vec<Vec<f64>>, RenderError> {
    in_turns_with(apps, rounds, |_, _| ())
}

/// [`in_turns`], with `note` called for each App, by its index, after each of its timed frames.
///
/// # Errors
/// See [`frame`].
pub fn in_turns_with(
    apps: &mut [&mut App],
    rounds: u32,
    mut note: impl FnMut(usize, &App),
) -> Result<Vec<Vec<f64>>, RenderError> {
    let mut times = vec![Vec::with_capacity(rounds as usize * TIMED); apps.len()];
    for round in 0..rounds as usize {
        for i in order(round, apps.len()) {
            let (app, times) = (&mut apps[i], &mut times[i]);
            frame(app)?;
            for _ in 0..TIMED {
                let start = Instant::now();
                frame(app)?;
                times.push(start.elapsed().as_secs_f64() * 1e3);
                note(i, app);
            }
        }
    }
    Ok(times)
}

/// The order of N Apps in this round.
fn order(round: usize, apps: usize) -> impl Iterator<Item = usize> {
    (0..apps).map(move |i| (i + round) % apps)
}

/// The median; the upper of two middle values, 0 of none.
pub fn median(values: &[f64]) -> f64 {
    Spread::from_values(values).median
}

/// The median over the rounds of the ratio of two times of the same round, which temporary slowdowns of the machine do
/// not change. 0 for none.
pub fn median_ratio(times: &[f64], to: &[f64]) -> f64 {
    ratios(times, to).median
}

/// The distribution of the ratios of [`median_ratio`].
pub fn ratios(times: &[f64], to: &[f64]) -> Spread {
    Spread::from_values(&times.iter().zip(to).map(|(time, to)| time / to).collect::<Vec<_>>())
}

/// The distribution of values, in their unit; all 0 of none. Of two middle values the upper one is the median; likewise
/// for the quartiles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// The least.
    pub min: f64,
    /// A quarter is below it.
    pub lower_quartile: f64,
    /// Half is below it.
    pub median: f64,
    /// Three quarters are below it.
    pub upper_quartile: f64,
    /// The largest.
    pub max: f64,
    /// The number of values.
    pub count: usize,
}

impl Spread {
    /// From values in any order.
    pub fn from_values(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len();
        let at = |index: usize| sorted.get(index).copied().unwrap_or_default();
        Self {
            min: at(0),
            lower_quartile: at(count / 4),
            median: at(count / 2),
            upper_quartile: at(count * 3 / 4),
            max: at(count.saturating_sub(1)),
            count,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreads_of_few_values() {
        let spread = Spread::from_values(&[5.0, 1.0, 4.0, 2.0, 3.0]);
        let expected = Spread { min: 1.0, lower_quartile: 2.0, median: 3.0, upper_quartile: 4.0, max: 5.0, count: 5 };
        assert_eq!(spread, expected);
        assert_eq!(median(&[4.0, 1.0, 3.0, 2.0]).to_bits(), 3f64.to_bits(), "the upper of two");
        assert_eq!(Spread::from_values(&[]), Spread::default());
    }

    #[test]
    fn each_round_begins_with_another() {
        let rounds: Vec<Vec<usize>> = (0..4).map(|round| order(round, 3).collect()).collect();
        assert_eq!(rounds, [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 1, 2]]);
        assert_eq!(order(7, 0).count(), 0);
    }

    #[test]
    fn ratios_are_taken_within_a_round() {
        // The machine is ten times slower in the second round; the ratio of the medians would be 20.
        let ratio = median_ratio(&[2.0, 20.0, 2.0], &[1.0, 10.0, 1.0]);
        assert_eq!(ratio.to_bits(), 2f64.to_bits());
    }
}
