//! Pictures with one known mistake.

use std::collections::BTreeSet;
use std::ops::ControlFlow;

use halfway_lighting::{Camera, Encoding, Samples};
use halfway_reference::marking::{Marker, examine, mistaken_picture};
use halfway_reference::metrics::Bars;
use halfway_reference::mistakes::{Mistake, Mistakes};
use image::RgbImage;
use rayon::prelude::*;

use crate::right::image;
use crate::small;
use crate::task::Task;
use crate::tasks;

/// The share of the pixels in which two pictures differ by two steps or more.
fn differing(a: &RgbImage, b: &RgbImage) -> f64 {
    let differs = |(a, b): &(&image::Rgb<u8>, &image::Rgb<u8>)| (0..3).any(|k| a.0[k].abs_diff(b.0[k]) >= 2);
    a.pixels().zip(b.pixels()).filter(differs).count() as f64 / f64::from(a.width() * a.height())
}

/// At least this share of the pixels has to differ for two pictures to be told apart.
const TELLS: f64 = 0.01;

/// What is said of one picture.
struct Said {
    what: String,
    mistake: Mistake,
    /// Whether no other mistake draws the same.
    unique: bool,
    right: bool,
    first: Vec<Mistake>,
    share: f64,
}

/// Whether somebody who draws the task can make the mistake at all.
fn can_be_made(mistake: Mistake, task: &Task) -> bool {
    match mistake {
        Mistake::GammaMissing | Mistake::GammaTwice | Mistake::GammaAsPower => task.encoding == Encoding::Srgb,
        Mistake::GammaUnasked => task.encoding == Encoding::Raw,
        _ => true,
    }
}

fn of_task(task: &Task) -> Vec<Said> {
    let oracle = task.oracle();
    let marker = Marker::new(&oracle, task.encoding);
    let right = mistaken_picture(&oracle, Mistakes::NONE, task.encoding);
    let mistakes: Vec<Mistake> = Mistake::ALL.iter().copied().filter(|it| can_be_made(*it, task)).collect();
    let own: Vec<(Mistake, RgbImage)> = mistakes
        .par_iter()
        .map(|&mistake| (mistake, mistaken_picture(&oracle, mistake.into(), task.encoding)))
        .collect();
    let small: Vec<Mistake> = mistakes.iter().copied().filter(|it| small::can_make(*it)).collect();
    let small: Vec<(Mistake, RgbImage)> = small.par_iter().map(|&it| (it, small::draw(task, it.into()))).collect();
    let pictures = own.iter().map(|it| ("oracle", it)).chain(small.iter().map(|it| ("small", it)));
    let mut said = Vec::new();
    for (by, (mistake, picture)) in pictures {
        if differing(picture, &right) < TELLS {
            continue;
        }
        let same: BTreeSet<Mistake> =
            own.iter().filter(|(_, other)| differing(picture, other) < TELLS).map(|(other, _)| *other).collect();
        let found = marker.diagnose(&image(picture, task.encoding)).expect("pictures of one size");
        let first: Vec<Mistake> = match found.explanations.first().map(|it| &it.causes[..]) {
            Some([cause]) => cause.alternatives.clone(),
            _ => Vec::new(),
        };
        // All that is named draws the same, and the mistake is among it.
        let is_right = first.contains(mistake) && first.iter().all(|it| it == mistake || same.contains(it));
        said.push(Said {
            what: format!("{mistake} in {} by {by}", task.name),
            mistake: *mistake,
            unique: same.iter().all(|it| it == mistake),
            right: is_right,
            share: found.explanations.first().or(found.nearest.as_ref()).map_or(0.0, |it| it.share),
            first,
        });
    }
    said
}

#[test]
fn known_mistakes_are_named_first() {
    let said: Vec<Said> = tasks::all().iter().flat_map(of_task).collect();
    let right = said.iter().filter(|it| it.right).count();
    let unique = said.iter().filter(|it| it.unique).count();
    for it in said.iter().filter(|it| !it.right) {
        println!("{}: {:?}, {:.3}", it.what, it.first, it.share);
    }
    let kinds: BTreeSet<Mistake> = said.iter().map(|it| it.mistake).collect();
    println!("{right} of {} named first ({unique} like no other), of {} mistakes", said.len(), kinds.len());
    for by in ["oracle", "small"] {
        let drawn = said.iter().filter(|it| it.what.ends_with(by)).count();
        assert!(drawn >= 150, "{drawn} pictures by {by}");
    }
    assert!(kinds.len() >= 70, "{} mistakes show", kinds.len());
    assert!(right as f64 >= 0.95 * said.len() as f64, "{right} of {}", said.len());
}

#[test]
fn smoothed_edges_do_not_hide_a_mistake() {
    let pictures = [
        ("ball", Mistake::GouraudForPhong),
        ("ball", Mistake::HighlightTimesCosine),
        ("eggs", Mistake::NormalsByModelMatrix),
        ("doughnut", Mistake::PhongForGouraud),
        ("doughnut", Mistake::AmbientByKd),
        ("facets", Mistake::FlatFromFirstVertex),
        ("stage", Mistake::SpotExponentIgnored),
        ("bowl", Mistake::NormalsNotFlipped),
        ("glare", Mistake::AmbientNotAttenuated),
        ("crowd", Mistake::ViewerLocal),
        ("lanterns", Mistake::RangeIgnored),
        ("road", Mistake::AttenuationOfDiffuseOnly),
    ];
    let tasks = tasks::all();
    let wrong: Vec<String> = pictures
        .par_iter()
        .filter_map(|(name, mistake)| {
            let task = tasks.iter().find(|task| task.name == *name).expect("a task of this name");
            let picture = small::draw_smoothed(task, (*mistake).into(), &small::grid(4));
            let found = Marker::new(&task.oracle(), task.encoding).diagnose(&image(&picture, task.encoding));
            let found = found.expect("pictures of one size");
            let first = found.explanations.first();
            let is_named = first.is_some_and(|it| it.causes.len() == 1 && it.causes[0].alternatives[0] == *mistake);
            (!is_named).then(|| format!("{mistake} in {name}: {found:?}"))
        })
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn mistakes_are_named_in_smoothed_pictures_of_scenes_that_ask_for_them() {
    let pictures = [
        ("ball", Mistake::FlatForSmooth),
        ("eggs", Mistake::FaceNormals),
        ("doughnut", Mistake::FlatForSmooth),
        ("facets", Mistake::FlatFromFirstVertex),
        ("facets", Mistake::GammaMissing),
        ("crowd", Mistake::GouraudForPhong),
        ("road", Mistake::AttenuationMissing),
    ];
    // The places of multisampling's four samples, and four of a student's own.
    let standard = [[0.375, 0.125], [0.875, 0.375], [0.125, 0.625], [0.625, 0.875]];
    let own = small::grid(2);
    let tasks = tasks::all();
    for (points, (name, mistake)) in [&standard[..], &own].into_iter().flat_map(|it| pictures.map(|of| (it, of))) {
        let task = tasks.iter().find(|task| task.name == name).expect("a task of this name");
        let mut world = task.world();
        world.query::<&mut Camera>().single_mut(&mut world).expect("a camera").samples = Samples::Four;
        let picture = image(&small::draw_smoothed(task, mistake.into(), points), task.encoding);
        let bars = Bars { equal: 0.0, ..Bars::bytes(task.encoding) };
        let found = examine(&mut world, &picture, task.encoding, bars, &|_, _| ControlFlow::Continue(()));
        let found = found.expect("the task can be drawn").diagnosis.expect("it is wrong");
        println!("{mistake} in {name}, smoothed: {:.3}", found.share());
        // Facets of a pixel's size are as the samples lie: with others than the standard ones it may only be the nearest.
        let first = found.explanations.first().or(found.nearest.as_ref().filter(|it| points == own && it.share > 0.9));
        let causes = first.map_or(&[][..], |it| &it.causes);
        let is_named = causes.len() == 1 && causes[0].alternatives.contains(&mistake);
        assert!(is_named, "{mistake} in {name}: {found:?}");
    }
}
