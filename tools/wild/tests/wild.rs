//! Random scenes, those that failed once, and planted faults.

use std::fs;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use halfway::lighting::Width;
use halfway::render::{Adapter, AdapterChoice};
use halfway::scene::{ColorMap, LightsEntry, MaterialEntry, SceneFile};
use halfway_wild::{Fault, Finding, Judge, scene, written};
use serde_json::Value;

/// Small scenes that failed once. Those in its folder `known` still fail: those in `known/cpu` on the CPU, those in
/// `known/swiftshader` and `known/opengl` on these drivers. Those in `four` failed on the CPU with four samples a
/// pixel.
const KEPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/wild");

/// The adapter of the environment variables, else a graphics adapter.
fn choice() -> AdapterChoice {
    if std::env::var_os("HALFWAY_ADAPTER").is_some() { AdapterChoice::default() } else { AdapterChoice::gpu() }
}

fn judge() -> Judge {
    judge_of(&choice())
}

fn judge_of(choice: &AdapterChoice) -> Judge {
    let judge = choice.open().and_then(|adapter| Judge::new(adapter, KEPT));
    judge.unwrap_or_else(|error| panic!("{error}"))
}

/// Whether the choice is the CPU without a driver.
fn is_on_the_cpu() -> bool {
    matches!(choice().open(), Ok(Adapter::Cpu(_)))
}

/// The chosen driver, if it is one, and the CPU.
fn judges() -> Vec<(&'static str, Judge)> {
    let by_a_driver = (!is_on_the_cpu()).then(|| ("by a driver", judge()));
    by_a_driver.into_iter().chain([("on the CPU", judge_of(&AdapterChoice::cpu()))]).collect()
}

/// The adapter under test, if the environment names one.
fn tried() -> Option<String> {
    std::env::var("HALFWAY_TESTED_ADAPTER").ok()
}

/// The folder of known failures of the driver.
fn known() -> &'static str {
    match tried() {
        Some(tried) if tried.contains("SwiftShader") => "known/swiftshader",
        Some(tried) if tried.contains("(gl") => "known/opengl",
        _ => "known",
    }
}

fn kept(folder: &Path) -> Vec<(PathBuf, Value)> {
    let files = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<PathBuf> = files.map(|file| file.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "json"));
    files.sort();
    let read = |file: PathBuf| {
        let scene = serde_json::from_str(&fs::read_to_string(&file).unwrap());
        (file.clone(), scene.unwrap_or_else(|error| panic!("{}: {error}", file.display())))
    };
    files.into_iter().map(read).collect()
}

#[test]
fn a_few_dozen_scenes_are_right() {
    for (by, judge) in judges() {
        let failures = (0..40).filter_map(|number| {
            let scene = scene(SEED, number);
            let finding = judge.judge(&scene).err()?;
            Some(format!("scene {number}: {finding}\n{}", written(&judge.shrunk(&scene, &finding, 100))))
        });
        let failures: Vec<String> = failures.collect();
        assert!(failures.is_empty(), "{by} {} scenes of seed {SEED} failed:\n{}", failures.len(), failures.join("\n"));
    }
}

/// Scenes that are drawn within some steps keep to them. `halfway-wild --steps` tries more.
#[test]
fn light_lists_keep_to_their_steps() {
    // A driver takes far longer to compile a scene's shaders than the CPU takes to draw it.
    for (by, mut judge) in judges() {
        let scenes = if by == "on the CPU" { 12 } else { 2 };
        let (mut used, mut failures) = (0, Vec::new());
        for (place, steps) in [0.5, 2.0, 8.0].into_iter().enumerate() {
            judge = judge.within(steps);
            let first = place as u64 * scenes;
            for number in first..first + scenes {
                match judge.judge(&with_many_lights(scene(SEED, number))) {
                    Ok(figures) => used += u64::from(figures.left_out > 0.0),
                    Err(finding) => failures.push(format!("scene {number} within {steps}: {finding}")),
                }
            }
        }
        assert!(failures.is_empty(), "{by}:\n{}", failures.join("\n"));
        assert!(used >= scenes, "{by}: lights are left out in {used} of {} scenes", 3 * scenes);
    }
}

/// The scene with a dozen more weak lights: more than a shader takes without lists.
fn with_many_lights(mut scene: Value) -> Value {
    let mut lights = scene["lights"].as_array().cloned().unwrap_or_default();
    for number in 0..12_u8 {
        let (sin, cos) = (0.5 * f32::from(number)).sin_cos();
        let position = [3.0 * cos, 0.4 * f32::from(number) - 2.0, 3.0 * sin];
        lights.push(serde_json::json!({ "kind": "point", "position": position, "diffuse": [0.004, 0.004, 0.004], "specular": [0.004, 0.004, 0.004] }));
    }
    scene["lights"] = lights.into();
    scene
}

/// Missing lights whose effect exceeds the tolerance are found.
#[test]
fn missing_light_is_found() {
    let judge = judge_of(&AdapterChoice::cpu()).within(1.0).with_fault(without_last_light).until_wrong();
    let found = (0..16).filter(|&number| judge.judge(&scene(SEED, number)).is_err()).count();
    assert!(found >= 4, "found in {found} of 16 scenes");
}

/// A seed of which no scene is known to fail.
const SEED: u64 = 1;

#[test]
fn scenes_that_failed_once_are_right() {
    // The CPU is tested with the first of the drivers. Failures of one driver are known by its name.
    let count = if tried().is_some() { 1 } else { 2 };
    let known = Path::new(KEPT).join(known());
    for (by, judge) in judges().into_iter().take(count) {
        let scenes = kept(Path::new(KEPT)).into_iter();
        let scenes = scenes.filter(|(file, _)| !known.join(file.file_name().unwrap()).exists());
        let wrong = scenes.filter_map(|(file, scene)| {
            judge.judge(&scene).err().map(|finding| format!("{} {by}: {finding}", file.display()))
        });
        let wrong: Vec<String> = wrong.collect();
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }
}

/// Current drivers have faults with four samples: decision 0029.
#[test]
fn scenes_that_failed_once_with_four_samples_are_right() {
    let judge = judge_of(&AdapterChoice::cpu()).with_four_samples(true);
    let scenes = kept(&Path::new(KEPT).join("four"));
    assert!(scenes.len() >= 8, "{} scenes", scenes.len());
    for (file, scene) in scenes {
        assert_eq!(scene["samples"], 4, "{}", file.display());
        let found = judge.judge(&scene);
        assert!(found.is_ok(), "{}: {}", file.display(), found.unwrap_err());
    }
}

/// Fixed failures are moved up to the scenes that are right. Failures of hardware are not recorded.
#[test]
fn known_failures_fail() {
    let on_the_cpu = tried().is_none().then(|| ("known/cpu", judge_of(&AdapterChoice::cpu())));
    let is_hardware = matches!(choice().open(), Ok(Adapter::Gpu(gpu)) if !gpu.is_software());
    let by_the_driver = (!is_hardware && !is_on_the_cpu()).then(|| (known(), judge()));
    for (folder, judge) in by_the_driver.into_iter().chain(on_the_cpu) {
        let scenes = kept(&Path::new(KEPT).join(folder));
        assert!(!scenes.is_empty(), "nothing is known: remove {folder} here");
        let mended = scenes.into_iter().filter_map(|(file, scene)| match judge.judge(&scene) {
            Err(Finding::NoScene(problem)) => panic!("{}: {problem}", file.display()),
            Err(_) => None,
            Ok(_) => Some(file.display().to_string()),
        });
        let mended: Vec<String> = mended.collect();
        assert!(mended.is_empty(), "mended:\n{}", mended.join("\n"));
    }
}

fn without_last_light(scene: &mut SceneFile) {
    if let Some(LightsEntry::List(lights)) = &mut scene.lights {
        lights.pop();
    }
}

fn with_broader_highlights(scene: &mut SceneFile) {
    for object in &mut scene.objects {
        if let Some(MaterialEntry::Values(material)) = &mut object.material {
            material.shininess *= 0.8;
        }
    }
}

fn with_mirrors_undone(scene: &mut SceneFile) {
    for object in &mut scene.objects {
        if let halfway::scene::TransformEntry::Parts(parts) = &mut object.transform {
            parts.scale = parts.scale.map(f32::abs);
        }
    }
}

fn with_another_environment(scene: &mut SceneFile) {
    if let Some(environment) = &mut scene.environment {
        environment.rotation_deg += 20.0;
    }
}

fn with_wider_lines(scene: &mut SceneFile) {
    let of_objects = scene.objects.iter_mut().filter_map(|object| object.edges.as_mut());
    for edges in of_objects.chain(&mut scene.edges) {
        edges.width = Width::Pixels(edges.width.value() + 1.0);
    }
}

fn with_parts_swapped(scene: &mut SceneFile) {
    let mut cameras: Vec<_> = scene.all_cameras_mut().collect();
    if let [first, second, ..] = &mut cameras[..] {
        std::mem::swap(&mut first.viewport, &mut second.viewport);
    }
}

fn with_other_maps(scene: &mut SceneFile) {
    for scalars in scene.objects.iter_mut().filter_map(|object| object.scalars.as_mut()) {
        scalars.map = if scalars.map == ColorMap::Cividis { ColorMap::Inferno } else { ColorMap::Cividis };
    }
}

/// The fault is found within 40 scenes, and the minimised scene has this many objects. The fault is planted into the
/// scene, so that any renderer shows it; the CPU is used, since it compiles no shaders.
fn is_found_and_made_small(fault: Fault, objects: RangeInclusive<usize>) {
    is_found_among(0..40, fault, objects);
}

fn is_found_among(numbers: impl Iterator<Item = u64>, fault: Fault, objects: RangeInclusive<usize>) {
    let right = judge_of(&AdapterChoice::cpu());
    let faulty = judge_of(&AdapterChoice::cpu()).with_fault(fault).until_wrong();
    let found = numbers.map(|number| scene(SEED, number)).find_map(|scene| {
        // Scenes with more than two objects leave something to minimise.
        let finding = if scene["objects"].as_array()?.len() > 2 { faulty.judge(&scene).err()? } else { return None };
        right.judge(&scene).is_ok().then_some((scene, finding))
    });
    let (scene, finding) = found.expect("the fault is not found");
    let small = faulty.shrunk(&scene, &finding, 100);
    let left = small["objects"].as_array().map_or(0, Vec::len);
    assert!(objects.contains(&left), "{left} objects in\n{}", written(&small));
    assert!(written(&small).len() * 2 < written(&scene).len(), "still large:\n{}", written(&small));
    assert!(right.judge(&small).is_ok(), "it is not the planted fault that is left:\n{}", written(&small));
}

#[test]
fn a_missing_light_is_found_and_minimised() {
    is_found_and_made_small(without_last_light, 1..=2);
}

#[test]
fn broader_highlights_are_found_and_minimised() {
    is_found_and_made_small(with_broader_highlights, 1..=2);
}

#[test]
fn undone_mirrors_are_found_and_minimised() {
    // From the last on, as the first that shows it takes minutes to judge a hundred times.
    is_found_among((0..36).rev(), with_mirrors_undone, 1..=2);
}

/// An environment shows without any object.
#[test]
fn a_turned_environment_is_found_and_minimised() {
    is_found_and_made_small(with_another_environment, 0..=2);
}

#[test]
fn wider_lines_are_found_and_minimised() {
    is_found_and_made_small(with_wider_lines, 0..=2);
}

/// The background shows a part of another size.
#[test]
fn swapped_parts_of_a_picture_are_found_and_minimised() {
    // A hundred steps do not make the two scenes small that show it before these.
    is_found_among(80..120, with_parts_swapped, 0..=2);
}

#[test]
fn other_colors_of_numbers_are_found_and_minimised() {
    is_found_and_made_small(with_other_maps, 1..=2);
}
