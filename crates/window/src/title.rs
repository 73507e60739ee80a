//! The window's title: what is shown, how much of it, how fast, and how it is shaded.

use bevy_ecs::prelude::*;
use halfway_lighting::{Reflectance, Shading};
use halfway_render::{FrameReport, ModelView, View};
use std::time::Duration;

/// The name of what is shown, a model's or a scene's, for the window's title. Default empty: no name.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct WindowTitle(pub String);

/// From the start of a frame on the CPU to its presentation, waiting for the display included;
/// smoothed over about half a second. `None` until the second frame.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameTime(pub Option<Duration>);

impl FrameTime {
    /// The time over which an old frame's weight falls to 1/e, in seconds.
    const MEMORY: f64 = 0.5;

    /// Takes in a frame.
    pub(crate) fn push(&mut self, frame: Duration) {
        let new = frame.as_secs_f64();
        let smoothed = self.0.map_or(new, |old| {
            let old = old.as_secs_f64();
            old + (new - old) * (1.0 - (-new / Self::MEMORY).exp())
        });
        self.0 = Some(Duration::from_secs_f64(smoothed));
    }
}

/// What a title says.
#[derive(Default)]
struct Status<'a> {
    program: &'a str,
    name: &'a str,
    triangles: Option<u64>,
    frame: Option<Duration>,
    shading: Option<&'static str>,
    reflectance: Option<&'static str>,
    errors: usize,
}

impl Status<'_> {
    fn text(&self) -> String {
        let mut parts = Vec::new();
        parts.extend([self.program, self.name].into_iter().filter(|part| !part.is_empty()).map(String::from));
        parts.extend(self.triangles.map(|count| plural(count, "triangle")));
        parts.extend(self.frame.map(|frame| format!("{:.1} ms", frame.as_secs_f64() * 1e3)));
        parts.extend(
            self.shading.zip(self.reflectance).map(|(shading, reflectance)| format!("{shading}, {reflectance}")),
        );
        parts.extend((self.errors > 0).then(|| plural(self.errors as u64, "error")));
        parts.join(" – ")
    }
}

/// The count in groups of three digits, and the noun in its number.
fn plural(count: u64, noun: &str) -> String {
    let digits = count.to_string();
    let mut grouped = String::new();
    for (index, digit) in digits.char_indices() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    let ending = if count == 1 { "" } else { "s" };
    format!("{grouped} {noun}{ending}")
}

fn shading_name(shading: Shading) -> &'static str {
    match shading {
        Shading::Flat => "flat",
        Shading::Gouraud => "Gouraud",
        Shading::Phong => "Phong",
        _ => "other shading",
    }
}

fn reflectance_name(reflectance: Reflectance) -> &'static str {
    match reflectance {
        Reflectance::Phong => "Phong",
        Reflectance::BlinnPhong => "Blinn–Phong",
        Reflectance::BlinnPhongMatched => "matched Blinn–Phong",
    }
}

/// The one name of all the objects, "mixed" where they differ, the view's where there are none.
fn common(mut names: impl Iterator<Item = &'static str>, view: &'static str) -> &'static str {
    let Some(first) = names.next() else { return view };
    if names.all(|name| name == first) { first } else { "mixed" }
}

/// The title of a window of `program` as it is now.
pub(crate) fn title(
    In(program): In<String>,
    name: Option<Res<WindowTitle>>,
    time: Option<Res<FrameTime>>,
    report: Option<Res<FrameReport>>,
    view: Option<Res<View>>,
    objects: Query<(Option<&Shading>, Option<&Reflectance>), With<ModelView>>,
) -> String {
    let shadings = |view: &View| {
        let own = objects.iter().map(|(own, _)| shading_name(own.copied().unwrap_or(view.shading)));
        common(own, shading_name(view.shading))
    };
    let reflectances = |view: &View| {
        let own = objects.iter().map(|(_, own)| reflectance_name(own.copied().unwrap_or(view.reflectance)));
        common(own, reflectance_name(view.reflectance))
    };
    Status {
        program: &program,
        name: name.as_ref().map_or("", |name| &name.0),
        triangles: report.as_ref().map(|report| report.triangles),
        frame: time.and_then(|time| time.0),
        shading: view.as_deref().map(shadings),
        reflectance: view.as_deref().map(reflectances),
        errors: report.as_ref().map_or(0, |report| report.errors.len()),
    }
    .text()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles() {
        let full = || Status {
            program: "halfway",
            name: "teapot",
            triangles: Some(15_872),
            frame: Some(Duration::from_micros(4_240)),
            shading: Some("Phong"),
            reflectance: Some("Blinn–Phong"),
            errors: 0,
        };
        let rows = [
            (full(), "halfway – teapot – 15,872 triangles – 4.2 ms – Phong, Blinn–Phong"),
            (Status { name: "", ..full() }, "halfway – 15,872 triangles – 4.2 ms – Phong, Blinn–Phong"),
            (Status { frame: None, ..full() }, "halfway – teapot – 15,872 triangles – Phong, Blinn–Phong"),
            (
                Status { errors: 2, triangles: Some(0), ..full() },
                "halfway – teapot – 0 triangles – 4.2 ms – Phong, Blinn–Phong – 2 errors",
            ),
            (Status { program: "halfway", ..Status::default() }, "halfway"),
        ];
        for (status, expected) in rows {
            assert_eq!(status.text(), expected);
        }
    }

    #[test]
    fn counts_are_grouped() {
        let rows = [
            (0, "0 triangles"),
            (1, "1 triangle"),
            (999, "999 triangles"),
            (1_000, "1,000 triangles"),
            (261_120, "261,120 triangles"),
            (1_234_567, "1,234,567 triangles"),
        ];
        for (count, expected) in rows {
            assert_eq!(plural(count, "triangle"), expected);
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
        // Ten seconds are twenty times the memory: what is left of the first frame is 10 ms · e⁻²⁰ and rounding.
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
            let title = world.run_system_cached_with(title, "halfway".to_owned()).unwrap();
            assert_eq!(title, format!("halfway – box – 12 triangles – {expected}, Blinn–Phong"), "{case}");
        }
        let empty = World::new().run_system_cached_with(title, "halfway".to_owned()).unwrap();
        assert_eq!(empty, "halfway", "an App that draws nothing");
    }
}
