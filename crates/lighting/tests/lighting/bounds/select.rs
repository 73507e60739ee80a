//! The sum of the omitted terms stays within the tolerance; they are the weakest, and no more could be omitted.

use halfway_lighting::bounds::Selected;
use halfway_lighting::equations::Light;
use halfway_lighting::lights::LightSource;
use proptest::prelude::*;

use super::support::{Scene, Source, around, cases, samples, scene, source};

/// One term of one light: its largest share of the tolerance, its light, whether it is specular, and its bound.
type Item = (f32, u32, bool, [f64; 3]);

/// The longest run of weakest terms within the tolerance, by a sort: what is kept of each term, and the sum left out.
fn by_sorting(scene: &Scene, lights: &[Light<f32>], tolerance: [f64; 3]) -> (Vec<u32>, Vec<u32>, [f64; 3]) {
    let receiver = scene.receiver::<f32>();
    let mut items: Vec<Item> = Vec::new();
    for (light, number) in lights.iter().zip(0u32..) {
        let bounds = receiver.bounds(light);
        let diffuse = [0, 1, 2].map(|c| f64::from(bounds.ambient[c] + bounds.diffuse[c]));
        for (specular, bound) in [(false, diffuse), (true, bounds.specular.map(f64::from))] {
            let share = (0..3).map(|c| bound[c] * tolerance[c].recip()).fold(0.0, f64::max) as f32;
            items.push((share, number, specular, bound));
        }
    }
    items.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut left_out = [0.0; 3];
    let mut kept = items.len();
    for (place, item) in items.iter().enumerate() {
        let sum = [0, 1, 2].map(|c| left_out[c] + item.3[c]);
        if (0..3).any(|c| sum[c] > tolerance[c]) {
            kept = place;
            break;
        }
        left_out = sum;
    }
    let list = |specular| {
        let mut list: Vec<u32> = items[kept..].iter().filter(|item| item.2 == specular).map(|item| item.1).collect();
        list.sort_unstable();
        list
    };
    (list(false), list(true), left_out)
}

pub(crate) fn lights(scene: &Scene, sources: &[Source]) -> Vec<Light<f32>> {
    sources.iter().map(|&source| around(scene, source).light()).collect()
}

pub(crate) fn some_tolerance() -> impl Strategy<Value = [f64; 3]> {
    let channel = prop_oneof![1 => Just(0.0), 1 => Just(f64::INFINITY), 8 => (-4f64..6.0).prop_map(|x| 10f64.powf(x))];
    (channel.clone(), channel.clone(), channel, any::<bool>())
        .prop_map(|(r, g, b, gray)| if gray { [r; 3] } else { [r, g, b] })
}

/// The first point of the patch where the terms left out add more than the figure says, in words.
pub(crate) fn missing_above_the_figure(
    scene: &Scene,
    sources: &[Source],
    selected: &Selected,
    samples: Vec<[f64; 6]>,
) -> Option<String> {
    let lights: Vec<Light<f64>> = sources.iter().map(|&source| around(scene, source).light()).collect();
    let seekers = lights.iter().cycle();
    samples.into_iter().zip(seekers).find_map(|(u, seeker)| {
        let surface = scene.sample(seeker, u);
        let mut missing = [0f64; 3];
        for (light, number) in lights.iter().zip(0u32..) {
            let terms = scene.terms(&surface, light);
            for (c, missing) in missing.iter_mut().enumerate() {
                if !selected.diffuse.contains(&number) {
                    let ambient = if light.steady_ambient() == [0.0; 3] { terms.ambient[c] } else { 0.0 };
                    *missing += ambient + terms.diffuse[c];
                }
                if !selected.specular.contains(&number) {
                    *missing += terms.specular[c];
                }
            }
        }
        // f32 counts terms below its smallest normal number as 0.
        let holds = (0..3).all(|c| missing[c] <= selected.left_out[c] + 1e-36);
        (!holds).then(|| format!("{missing:?} above {:?} at {surface:?}", selected.left_out))
    })
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn the_weakest_are_left_out_as_by_a_sort(
        scene in scene(),
        sources in prop::collection::vec(source(), 0..40),
        tolerance in some_tolerance(),
    ) {
        // Without a tolerance nothing is sorted: see `exact_lists_keep_what_has_a_bound`.
        prop_assume!(tolerance != [0.0; 3]);
        let lights = lights(&scene, &sources);
        let mut selected = Selected::default();
        scene.receiver().select((0..).zip(&lights), tolerance, &mut selected);
        let (diffuse, specular, left_out) = by_sorting(&scene, &lights, tolerance);
        prop_assert_eq!(&selected.diffuse, &diffuse);
        prop_assert_eq!(&selected.specular, &specular);
        for c in 0..3 {
            prop_assert!(selected.left_out[c] <= tolerance[c]);
            // The two sums run in different orders.
            prop_assert!((selected.left_out[c] - left_out[c]).abs() <= 1e-13 * left_out[c]);
        }
    }

    /// The promise itself: at no point do the terms left out add more than the figure says.
    #[test]
    fn omitted_light_is_at_most_left_out(
        scene in scene(),
        sources in prop::collection::vec(source(), 0..40),
        tolerance in some_tolerance(),
        samples in samples(12),
    ) {
        let narrow = lights(&scene, &sources);
        let mut selected = Selected::default();
        scene.receiver().select((0..).zip(&narrow), tolerance, &mut selected);
        let excess = missing_above_the_figure(&scene, &sources, &selected, samples);
        prop_assert!(excess.is_none(), "{}", excess.unwrap_or_default());
    }

    /// Without a tolerance every term with a bound above 0 is kept.
    #[test]
    fn exact_lists_keep_what_has_a_bound(
        scene in scene(),
        sources in prop::collection::vec(source(), 0..40),
    ) {
        let lights = lights(&scene, &sources);
        let mut selected = Selected::default();
        scene.receiver().select((0..).zip(&lights), [0.0; 3], &mut selected);
        for (light, number) in lights.iter().zip(0u32..) {
            let bounds = scene.receiver::<f32>().bounds(light);
            let diffuse = [0, 1, 2].map(|c| bounds.ambient[c] + bounds.diffuse[c]);
            prop_assert!(diffuse == [0.0; 3] || selected.diffuse.contains(&number), "{bounds:?}");
            prop_assert!(bounds.specular == [0.0; 3] || selected.specular.contains(&number), "{bounds:?}");
        }
        prop_assert_eq!(selected.left_out, [0.0; 3]);
    }

    /// Filled again, the lists are the same, whatever was in them, and lie where they lay.
    #[test]
    fn a_second_filling_needs_no_memory(
        first in scene(),
        second in scene(),
        sources in prop::collection::vec(source(), 0..40),
        tolerance in some_tolerance(),
    ) {
        let lights = lights(&first, &sources);
        let mut selected = Selected::default();
        let fill = |scene: &Scene, into: &mut Selected| scene.receiver().select((0..).zip(&lights), tolerance, into);
        fill(&first, &mut selected);
        fill(&second, &mut selected);
        let places = (selected.diffuse.as_ptr(), selected.specular.as_ptr());
        fill(&first, &mut selected);
        prop_assert_eq!(places, (selected.diffuse.as_ptr(), selected.specular.as_ptr()));
        let mut fresh = Selected::default();
        fill(&first, &mut fresh);
        prop_assert_eq!((&fresh.diffuse, &fresh.specular, fresh.left_out),
            (&selected.diffuse, &selected.specular, selected.left_out));
    }
}
