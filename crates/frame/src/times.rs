//! The time of a frame on the CPU, set by set.

use crate::mean::{self, FrameWeights};
use crate::sets::RenderSet;
use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::InternedScheduleLabel;
use bevy_transform::TransformSystems;

use std::time::{Duration, Instant};

/// The CPU's time for each [`RenderSet`], and the frame's wait for the display.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SetTimes {
    /// In seconds, by the sets' order.
    sets: [f64; RenderSet::ALL.len()],
    display: f64,
}

impl SetTimes {
    /// The time from the end of the set before to the end of this one, by the wall clock, without
    /// [`SetTimes::display`]; of several cameras, the sum. Systems of the App that the schedule runs in between count too; order them
    /// before [`RenderSet::View`] or after [`RenderSet::Deliver`] to keep them out.
    pub fn duration(&self, set: RenderSet) -> Duration {
        Duration::from_secs_f64(self.sets[set as usize])
    }

    /// The sum over all sets.
    pub fn total(&self) -> Duration {
        Duration::from_secs_f64(self.sets.iter().sum())
    }

    /// The time in the calls that acquire a picture of the window's surface and present it. They wait where the
    /// display sets the pace, so this is part of no set. Zero without a window.
    pub fn display(&self) -> Duration {
        Duration::from_secs_f64(self.display)
    }

    /// Every set with its time, in the order of a frame.
    pub fn sets(&self) -> impl Iterator<Item = (RenderSet, Duration)> {
        RenderSet::ALL.into_iter().map(|set| (set, self.duration(set)))
    }

    /// Moves towards `new` by its share, 0 to 1.
    fn approach(&mut self, new: &Self, share: f64) {
        for (old, new) in self.sets.iter_mut().zip(new.sets) {
            *old = mean::approach(*old, new, share);
        }
        self.display = mean::approach(self.display, new.display, share);
    }
}

/// The CPU's time of a frame, set by set, of the newest one and smoothed. Holds after
/// [`RenderSet::Deliver`]; until then it is of the frame before.
///
/// ```no_run
/// # use bevy_app::App;
/// # use halfway_frame::times::FrameTimes;
/// # let app = App::new();
/// let times = app.world().resource::<FrameTimes>();
/// for (set, time) in times.smoothed().sets() {
///     println!("{:10} {time:?}", set.name());
/// }
/// ```
#[derive(Resource, Clone, Debug, Default)]
pub struct FrameTimes {
    newest: SetTimes,
    smoothed: SetTimes,
    /// The frame under way.
    current: SetTimes,
    /// When that began, and where its running set did.
    began: Option<Instant>,
    set_began: Option<Instant>,
    /// From the beginning of the frame before to that of this one.
    interval: Duration,
    weights: FrameWeights,
}

impl FrameTimes {
    /// Of the newest frame; all zero before the first.
    pub fn newest(&self) -> &SetTimes {
        &self.newest
    }

    /// The mean over frames, each with a weight that falls to 1/e within a second. It starts with the second
    /// frame, since the first one opens the adapter and builds pipelines; until then it is the newest.
    pub fn smoothed(&self) -> &SetTimes {
        &self.smoothed
    }

    /// Leaves `call`, which may wait for the display, out of the set that makes it.
    pub fn at_display<T>(&mut self, call: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = call();
        let took = start.elapsed();
        self.current.display += took.as_secs_f64();
        self.set_began = self.set_began.map(|began| began + took);
        result
    }

    fn begin(&mut self, now: Instant) {
        self.interval = self.began.map_or(Duration::ZERO, |before| now.saturating_duration_since(before));
        (self.began, self.set_began) = (Some(now), Some(now));
        self.current = SetTimes::default();
    }

    fn end(&mut self, set: RenderSet, now: Instant) {
        let took = self.set_began.replace(now).map_or(Duration::ZERO, |began| now.saturating_duration_since(began));
        self.current.sets[set as usize] += took.as_secs_f64();
    }

    /// Leaves out what happens until the next set begins.
    fn resume(&mut self, now: Instant) {
        self.set_began = Some(now);
    }

    fn finish(&mut self) {
        self.newest = self.current;
        self.smoothed.approach(&self.newest, self.weights.share(self.interval));
    }
}

/// Puts a clock before the first set and behind each.
pub(crate) fn add_clocks(app: &mut App, schedule: InternedScheduleLabel) {
    let [first, ..] = RenderSet::ALL;
    let begin = |mut times: ResMut<FrameTimes>| times.begin(Instant::now());
    app.init_resource::<FrameTimes>();
    app.add_systems(schedule, begin.after(TransformSystems::Propagate).before(first));
    add_ends(app, schedule);
    let [.., last] = RenderSet::ALL;
    let finish = move |mut times: ResMut<FrameTimes>| {
        times.end(last, Instant::now());
        times.finish();
    };
    app.add_systems(schedule, finish.after(last));
}

/// The same for the frame of a further camera, whose times are added to those of the first.
pub(crate) fn add_clocks_of_further_camera(app: &mut App, schedule: InternedScheduleLabel) {
    let [first, ..] = RenderSet::ALL;
    let resume = |mut times: ResMut<FrameTimes>| times.resume(Instant::now());
    app.add_systems(schedule, resume.before(first));
    add_ends(app, schedule);
}

fn add_ends(app: &mut App, schedule: InternedScheduleLabel) {
    for pair in RenderSet::ALL.windows(2) {
        let (set, next) = (pair[0], pair[1]);
        let end = move |mut times: ResMut<FrameTimes>| times.end(set, Instant::now());
        app.add_systems(schedule, end.after(set).before(next));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    /// A frame in which the set with index i takes i + 1 times `unit`.
    fn frame(times: &mut FrameTimes, mut now: Instant, unit: Duration) {
        times.begin(now);
        for (index, set) in RenderSet::ALL.into_iter().enumerate() {
            now += unit * (index as u32 + 1);
            times.end(set, now);
        }
        times.finish();
    }

    /// Nanoseconds apart at most: times are sums of seconds in f64, and clocks count whole nanoseconds.
    fn assert_close(actual: Duration, expected: Duration) {
        assert!(actual.abs_diff(expected) <= Duration::from_nanos(2), "{actual:?}, not {expected:?}");
    }

    #[test]
    fn sets_have_their_places() {
        for (index, set) in RenderSet::ALL.into_iter().enumerate() {
            assert_eq!(set as usize, index, "{set:?}");
            assert_eq!(set.name(), format!("{set:?}"));
        }
    }

    #[test]
    fn each_set_has_the_time_up_to_its_end() {
        let mut times = FrameTimes::default();
        assert_eq!(times.newest().total(), Duration::ZERO, "before the first frame");
        frame(&mut times, Instant::now(), MS);
        for (index, (set, time)) in times.newest().sets().enumerate() {
            assert_eq!(set, RenderSet::ALL[index]);
            assert_close(time, MS * (index as u32 + 1));
        }
        assert_close(times.newest().total(), 36 * MS);
    }

    #[test]
    fn a_frame_under_way_does_not_show() {
        let mut times = FrameTimes::default();
        let start = Instant::now();
        frame(&mut times, start, MS);
        times.begin(start + 50 * MS);
        times.end(RenderSet::View, start + 90 * MS);
        assert_close(times.newest().duration(RenderSet::View), MS);
        assert_close(times.newest().total(), 36 * MS);
    }

    #[test]
    fn waiting_for_the_display_counts_to_no_set() {
        let mut times = FrameTimes::default();
        let start = Instant::now();
        times.begin(start);
        times.at_display(|| std::thread::sleep(20 * MS));
        times.end(RenderSet::View, Instant::now());
        times.finish();
        let whole = start.elapsed();
        let (wait, view) = (times.newest().display(), times.newest().duration(RenderSet::View));
        assert!(wait >= 20 * MS, "{wait:?}");
        // However slow the machine, nothing may count twice.
        assert!(wait + view <= whole, "{wait:?} and {view:?} of {whole:?}");
    }

    #[test]
    fn the_first_frame_is_forgotten_and_the_others_are_smoothed() {
        let mut times = FrameTimes::default();
        let start = Instant::now();
        frame(&mut times, start, 100 * MS);
        frame(&mut times, start + 5000 * MS, 2 * MS);
        assert_close(times.smoothed().total(), 72 * MS);
        for i in 1..=10 {
            frame(&mut times, start + (5000 + 100 * i) * MS, 4 * MS);
        }
        // Ten of weights that fall to 1/e within a second, and one of 1/e.
        let ten: f64 = (0..10).map(|i| (-0.1 * f64::from(i)).exp()).sum();
        let one = (-1f64).exp();
        assert_close(times.smoothed().total(), MS.mul_f64((144.0 * ten + 72.0 * one) / (ten + one)));
        assert_close(times.newest().total(), 144 * MS);
    }
}
