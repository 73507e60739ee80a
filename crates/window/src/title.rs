//! The window's title: the scene, the cost of a frame, and the shading.

use crate::short_numbers::{bytes, count, milliseconds, per_second};
use bevy_ecs::prelude::*;
use halfway_lighting::{Intensity, Reflectance, Shading, ViewTolerance};
use halfway_render::{FrameReport, FrameTimes, GpuTimer, ModelView, View};
use std::time::Duration;

/// The name of the shown model or scene, for the window's title. Default empty: no name.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct WindowTitle(pub String);

/// From the start of a frame on the CPU to its presentation, waiting for the display included;
/// smoothed over about half a second. `None` until the second frame.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameTime(pub Option<Duration>);

impl FrameTime {
    /// The time over which an old frame's weight falls to 1/e, in seconds.
    const MEMORY: f64 = 0.5;

    /// Adds a frame.
    pub(crate) fn push(&mut self, frame: Duration) {
        let new = frame.as_secs_f64();
        let smoothed = self.0.map_or(new, |old| {
            let old = old.as_secs_f64();
            old + (new - old) * (1.0 - (-new / Self::MEMORY).exp())
        });
        self.0 = Some(Duration::from_secs_f64(smoothed));
    }
}

/// The contents of a title.
#[derive(Default)]
struct Status<'a> {
    program: &'a str,
    name: &'a str,
    report: Option<&'a FrameReport>,
    cpu: Option<Duration>,
    gpu: Option<Duration>,
    rate: Option<f64>,
    shading: Option<&'static str>,
    reflectance: Option<&'static str>,
    /// The policy for intensities above 1, unless they are clamped.
    intensity: Option<&'static str>,
    /// The light that may be left out, in steps of 1/255.
    steps: Option<f32>,
}

impl Status<'_> {
    /// "program – name — counters · times · shading · errors", without empty parts.
    fn text(&self) -> String {
        let names: Vec<_> = [self.program, self.name].into_iter().filter(|name| !name.is_empty()).collect();
        let mut parts = self.report.map_or_else(Vec::new, counters);
        parts.extend(self.cpu.map(|time| format!("{} CPU", milliseconds(time))));
        parts.extend(self.gpu.map(|time| format!("{} GPU", milliseconds(time))));
        parts.extend(self.rate.map(per_second));
        parts.extend(
            self.shading.zip(self.reflectance).map(|(shading, reflectance)| format!("{shading}, {reflectance}")),
        );
        parts.extend(self.intensity.map(str::to_owned));
        let steps = self.steps.filter(|steps| *steps > 0.0);
        parts.extend(steps.map(|steps| format!("within {steps} of 255 steps")));
        let errors = self.report.map_or(0, |report| report.errors.len() as u64);
        parts.extend((errors > 0).then(|| count(errors, "error")));
        [names.join(" – "), parts.join(" · ")]
            .into_iter()
            .filter(|half| !half.is_empty())
            .collect::<Vec<_>>()
            .join(" — ")
    }
}

/// The counters of the title, in order; some are left out if they are 0.
fn counters(report: &FrameReport) -> Vec<String> {
    let unless_0 = |value: u64, noun: &str, done: &str| (value > 0).then(|| format!("{} {done}", count(value, noun)));
    let shown = [
        Some(count(report.draws.into(), "draw")),
        Some(count(report.triangles, "triangle")),
        unless_0(report.patches_culled.into(), "patch", "culled"),
        Some(count(report.lights.into(), "light")),
        unless_0(report.lights_assigned, "term", "listed"),
        unless_0(report.levels_pending.into(), "mesh", "awaiting levels"),
        Some(count(report.pipelines.into(), "pipeline")),
        unless_0(report.pipelines_pending.into(), "pipeline", "pending"),
        Some(bytes(report.bytes_uploaded)),
    ];
    shown.into_iter().flatten().collect()
}

fn intensity_name(policy: Intensity) -> Option<&'static str> {
    match policy {
        Intensity::Clamp => None,
        Intensity::Renormalize { smoothing } if smoothing > 0.0 => Some("renormalised smoothly"),
        named => Some(named.name()),
    }
}

/// The common name of all objects, "mixed" if they differ, the view's if there are none.
fn common(mut names: impl Iterator<Item = &'static str>, view: &'static str) -> &'static str {
    let Some(first) = names.next() else { return view };
    if names.all(|name| name == first) { first } else { "mixed" }
}

/// The title of a window of `program` as it is now, after frames at `rate` a second.
#[expect(clippy::too_many_arguments, reason = "a system takes each resource as a parameter")]
pub(crate) fn title(
    In((program, rate)): In<(String, Option<f64>)>,
    name: Option<Res<WindowTitle>>,
    report: Option<Res<FrameReport>>,
    times: Option<Res<FrameTimes>>,
    gpu: Option<Res<GpuTimer>>,
    view: Option<Res<View>>,
    tolerance: Option<Res<ViewTolerance>>,
    objects: Query<(Option<&Shading>, Option<&Reflectance>), With<ModelView>>,
) -> String {
    let shadings = |view: &View| {
        let own = objects.iter().map(|(own, _)| own.copied().unwrap_or(view.shading).name());
        common(own, view.shading.name())
    };
    let reflectances = |view: &View| {
        let own = objects.iter().map(|(_, own)| own.copied().unwrap_or(view.reflectance).name());
        common(own, view.reflectance.name())
    };
    Status {
        program: &program,
        name: name.as_ref().map_or("", |name| &name.0),
        report: report.as_deref(),
        cpu: times.map(|times| times.smoothed().total()),
        gpu: gpu.and_then(|gpu| gpu.smoothed()),
        rate,
        shading: view.as_deref().map(shadings),
        reflectance: view.as_deref().map(reflectances),
        intensity: view.as_deref().and_then(|view| intensity_name(view.camera?.intensity)),
        steps: tolerance.map(|tolerance| tolerance.0.steps),
    }
    .text()
}

#[cfg(test)]
mod tests {
    use super::*;
    use halfway_render::RenderError;

    #[test]
    fn titles() {
        let report = FrameReport {
            draws: 12,
            triangles: 1_234_567,
            lights: 4,
            pipelines: 3,
            bytes_uploaded: 0,
            ..FrameReport::default()
        };
        let failing = FrameReport { errors: vec![RenderError::NoCamera; 2], ..FrameReport::default() };
        let saving = FrameReport {
            patches_culled: 5_642,
            lights_assigned: 1,
            levels_pending: 1,
            pipelines_pending: 6,
            ..report.clone()
        };
        let full = || Status {
            program: "halfway",
            name: "teapot",
            report: Some(&report),
            cpu: Some(Duration::from_micros(840)),
            gpu: Some(Duration::from_micros(2_120)),
            rate: Some(59.94),
            shading: Some("Phong"),
            reflectance: Some("Blinn–Phong"),
            intensity: None,
            steps: Some(0.0),
        };
        let counted = "12 draws · 1.2 M triangles · 4 lights · 3 pipelines · 0 B";
        let shaded = "Phong, Blinn–Phong";
        let rows = [
            (full(), format!("halfway – teapot — {counted} · 0.84 ms CPU · 2.1 ms GPU · 60 fps · {shaded}")),
            (
                Status { name: "", gpu: None, ..full() },
                format!("halfway — {counted} · 0.84 ms CPU · 60 fps · {shaded}"),
            ),
            (
                Status { program: "", name: "", rate: None, gpu: None, ..full() },
                format!("{counted} · 0.84 ms CPU · {shaded}"),
            ),
            (
                Status { report: Some(&failing), cpu: None, gpu: None, rate: None, ..full() },
                format!(
                    "halfway – teapot — 0 draws · 0 triangles · 0 lights · 0 pipelines · 0 B · {shaded} · 2 errors"
                ),
            ),
            (
                Status { program: "", name: "", report: Some(&saving), ..Status::default() },
                "12 draws · 1.2 M triangles · 5.6 k patches culled · 4 lights · 1 term listed · 1 mesh awaiting levels · \
                 3 pipelines · 6 pipelines pending · 0 B"
                    .into(),
            ),
            (
                Status { shading: Some("flat"), reflectance: Some("Phong"), steps: Some(0.5), ..Status::default() },
                "flat, Phong · within 0.5 of 255 steps".into(),
            ),
            (Status { intensity: Some("ACES"), ..Status::default() }, "ACES".into()),
            (Status { program: "halfway", ..Status::default() }, "halfway".into()),
            (Status::default(), String::new()),
        ];
        for (status, expected) in rows {
            assert_eq!(status.text(), expected);
        }
    }

    #[test]
    fn the_frame_time_is_smoothed() {
        let mut time = FrameTime::default();
        time.push(Duration::from_millis(10));
        assert_eq!(time.0, Some(Duration::from_millis(10)), "the first one is taken as it is");
        time.push(Duration::from_millis(20));
        let after_one = time.0.unwrap();
        assert!(after_one > Duration::from_millis(10) && after_one < Duration::from_millis(11), "{after_one:?}");
        for _ in 0..500 {
            time.push(Duration::from_millis(20));
        }
        // Ten seconds are twenty times the memory: the first frame's share is 10 ms · e⁻²⁰ and rounding.
        let settled = time.0.unwrap().as_secs_f64();
        assert!((settled - 0.020).abs() < 1e-6, "{settled}");
    }

    #[test]
    fn the_title_of_a_world() {
        use Shading::{Flat, Gouraud, Phong};
        let rows: [(&str, &[Option<Shading>], &str); 4] = [
            ("the view's", &[None, None], "Gouraud"),
            ("the objects' own", &[Some(Flat), Some(Flat)], "flat"),
            ("some their own", &[Some(Phong), None], "mixed"),
            ("none", &[], "Gouraud"),
        ];
        for (case, objects, expected) in rows {
            let mut world = World::new();
            world.insert_resource(View { shading: Gouraud, ..View::default() });
            world.insert_resource(FrameReport { triangles: 12, ..FrameReport::default() });
            world.insert_resource(WindowTitle("box".into()));
            for own in objects {
                let mut object = world.spawn(ModelView::default());
                if let Some(own) = *own {
                    object.insert(own);
                }
            }
            let title = world.run_system_cached_with(title, ("halfway".to_owned(), Some(30.0))).unwrap();
            let counted = "0 draws · 12 triangles · 0 lights · 0 pipelines · 0 B";
            assert_eq!(title, format!("halfway – box — {counted} · 30 fps · {expected}, Blinn–Phong"), "{case}");
        }
        let empty = World::new().run_system_cached_with(title, ("halfway".to_owned(), None)).unwrap();
        assert_eq!(empty, "halfway", "an App that draws nothing");
    }
}
