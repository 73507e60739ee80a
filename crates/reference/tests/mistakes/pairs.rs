//! Pictures with two mistakes at once.

use halfway_reference::marking::{Marker, mistaken_picture};
use halfway_reference::mistakes::{Mistake, Mistakes};
use rayon::prelude::*;

use crate::right::image;
use crate::small;
use crate::task::Task;
use crate::tasks;

use Mistake as M;

/// Pairs, each of which shows in the task of this name.
const PAIRS: [(&str, [Mistake; 2]); 24] = [
    ("ball", [M::GammaMissing, M::HighlightTimesCosine]),
    ("ball", [M::GouraudForPhong, M::AttenuationMissing]),
    ("ball", [M::UpsideDown, M::PhongForBlinn]),
    ("ball", [M::RedAndBlueSwapped, M::AmbientMissing]),
    ("eggs", [M::NormalsByModelMatrix, M::BlinnForPhong]),
    ("eggs", [M::Mirrored, M::AttenuationSwapped]),
    ("eggs", [M::GammaUnasked, M::NormalsNotRenormalised]),
    ("doughnut", [M::PhongForGouraud, M::LightAmbientMissing]),
    ("doughnut", [M::GammaTwice, M::HighlightMissing]),
    ("facets", [M::PhongForFlat, M::LightDirectionReversed]),
    ("facets", [M::FlatFromFirstVertex, M::GammaMissing]),
    ("stage", [M::CutoffAsFullAngle, M::GammaMissing]),
    ("stage", [M::SpotExponentIgnored, M::HighlightMissing]),
    ("stage", [M::CutoffIgnored, M::UpsideDown]),
    ("bowl", [M::NormalsNotFlipped, M::GammaAsPower]),
    ("bowl", [M::BackMaterialIgnored, M::HighlightTimesCosine]),
    ("glare", [M::ClampMissing, M::AmbientNotAttenuated]),
    ("glare", [M::AmbientNotTimesKa, M::RedAndBlueSwapped]),
    ("crowd", [M::DepthTestMissing, M::GammaTwice]),
    ("crowd", [M::ViewerLocal, M::AmbientForEachLight]),
    ("lanterns", [M::RangeIgnored, M::GammaMissing]),
    ("lanterns", [M::LightPositionInWorldSpace, M::Mirrored]),
    ("road", [M::AffineInterpolation, M::AmbientByKd]),
    ("pipe", [M::HighlightBehind, M::CosineAbsolute]),
];

fn named(task: &Task, pair: [Mistake; 2], is_small: bool) -> Vec<Vec<Mistake>> {
    let oracle = task.oracle();
    let mistakes: Mistakes = pair.into_iter().collect();
    let picture =
        if is_small { small::draw(task, mistakes) } else { mistaken_picture(&oracle, mistakes, task.encoding) };
    let found = Marker::new(&oracle, task.encoding).diagnose(&image(&picture, task.encoding));
    let found = found.expect("pictures of one size");
    let causes = found.explanations.first().map(|it| it.causes.clone()).unwrap_or_default();
    causes.into_iter().map(|cause| cause.alternatives).collect()
}

#[test]
fn two_mistakes_at_once_are_named() {
    let tasks = tasks::all();
    let all: Vec<_> = PAIRS.iter().flat_map(|pair| [(pair, false), (pair, true)]).collect();
    let wrong: Vec<String> = all
        .par_iter()
        .filter_map(|((name, pair), is_small)| {
            let task = tasks.iter().find(|task| task.name == *name).expect("a task of this name");
            let named = named(task, *pair, *is_small);
            let is_named = named.len() == 2 && pair.iter().all(|it| named.iter().any(|all| all.contains(it)));
            (!is_named).then(|| format!("{pair:?} in {name}: {named:?}"))
        })
        .collect();
    println!("{} of {} pairs are named", all.len() - wrong.len(), all.len());
    for wrong in &wrong {
        println!("{wrong}");
    }
    assert!(wrong.len() * 20 <= all.len(), "{wrong:#?}");
}
