//! Parts of the light of random scenes, which add up to the whole.

use std::path::Path;
use std::time::Duration;

use bevy_time::TimeUpdateStrategy;
use halfway::lighting::{Choices, Term};
use halfway::mesh::Lines3d;
use halfway::prelude::*;
use halfway::reference::metrics::Bars;
use halfway::reference::{Image, Oracle};
use halfway::render::AdapterChoice;
use halfway::scene::options::remove_what_is_laid_over;
use halfway::scene::{LightSource, PartOfLight, SceneFile, Spawned, spawn};
use halfway_wild::scene;
use serde_json::Value;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/wild");
const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/scenes");
const SEED: u64 = 2027;
const SCENES: u64 = 130;

/// Either drawer of the parts.
#[derive(Clone, Copy)]
enum Drawer {
    Oracle,
    Cpu,
}

impl Drawer {
    fn draw(self, app: &mut App, size: UVec2) -> Option<Image> {
        match self {
            Self::Oracle => {
                app.update();
                Oracle::new(app.world_mut(), size).ok().map(|oracle| oracle.draw())
            }
            Self::Cpu => match render_picture(app).ok()? {
                Picture::Float(image) => Some(Image::from_float(&image)),
                Picture::Byte(_) => None,
            },
        }
    }

    fn app(self, file: &SceneFile, folder: &str) -> (App, Spawned) {
        let mut app = App::new();
        match self {
            Self::Oracle => app.add_plugins(HalfwayPlugins::reference()),
            Self::Cpu => app.add_plugins(HalfwayPlugins::headless(UVec2::from_array(file.size))),
        };
        app.insert_resource(AdapterChoice::cpu())
            .insert_resource(Headless { size: UVec2::from_array(file.size), pixels: Pixels::Float })
            .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
        let spawned = spawn(file, Path::new(folder), app.world_mut()).expect("a scene of the folder");
        let world = app.world_mut();
        let lines: Vec<Entity> = world.query_filtered::<Entity, With<Lines3d>>().iter(world).collect();
        for entity in lines {
            world.entity_mut(entity).remove::<Lines3d>();
        }
        app.finish();
        app.cleanup();
        (app, spawned)
    }
}

/// A scene without what is drawn over a picture, and with intensities as they are.
fn plain(scene: &Value) -> SceneFile {
    let mut file = SceneFile::from_json(&scene.to_string(), "scene").expect("a scene");
    file.all_cameras_mut().for_each(|camera| camera.viewport = None);
    remove_what_is_laid_over(&mut file);
    (file.only, file.light) = (None, None);
    file.intensity = Intensity::Clamp;
    file.samples = 1;
    file
}

fn terms() -> impl Iterator<Item = Term> {
    Term::CHOICES.iter().map(|choice| choice.value)
}

/// Ways to cut the light into parts.
fn cuts(lights: usize) -> [(&'static str, Vec<PartOfLight>); 3] {
    let of = |term, source| PartOfLight { term, source };
    let sources = || (0..lights).map(LightSource::Light).chain([LightSource::NoLight]);
    let by_both = sources().flat_map(|source| terms().map(move |term| of(Some(term), source)));
    [
        ("terms", terms().map(|term| of(Some(term), LightSource::Anywhere)).collect()),
        ("lights", sources().map(|source| of(None, source)).collect()),
        ("lights and terms", by_both.collect()),
    ]
}

/// The differences of the sums of parts from the whole, for each way to cut it, relative to the largest value of the
/// picture; `None` of a scene that cannot be drawn.
fn differences(drawer: Drawer, file: &SceneFile, folder: &str) -> Option<Vec<(&'static str, Vec<f64>)>> {
    let size = UVec2::from_array(file.size);
    let (mut app, spawned) = drawer.app(file, folder);
    let whole = drawer.draw(&mut app, size)?;
    let most = whole.largest().max(1e-3);
    let found = cuts(spawned.lights.len()).map(|(cut, parts)| {
        let mut sum = vec![[0.0; 3]; whole.pixels().len()];
        for part in parts {
            spawned.show_light(part, app.world_mut());
            let image = drawer.draw(&mut app, size).expect("it was drawn before");
            for (sum, pixel) in sum.iter_mut().zip(image.pixels()) {
                *sum = [0, 1, 2].map(|k| sum[k] + pixel[k]);
            }
        }
        let off = |(sum, pixel): (&[f64; 3], &[f64; 3])| {
            [0, 1, 2].map(|k| (sum[k] - pixel[k]).abs() / most).into_iter().fold(0.0, f64::max)
        };
        (cut, sum.iter().zip(whole.pixels()).map(off).collect())
    });
    spawned.show_light(PartOfLight::default(), app.world_mut());
    assert_eq!(drawer.draw(&mut app, size), Some(whole), "all of the light again");
    Some(found.into())
}

fn worst(differences: &[f64]) -> f64 {
    differences.iter().copied().fold(0.0, f64::max)
}

/// Checks random scenes, and that most of them can be drawn.
fn check_random_scenes(drawer: Drawer, is_right: impl Fn(&[f64]) -> bool) {
    let mut drawn = 0;
    for number in 0..SCENES {
        let Some(found) = differences(drawer, &plain(&scene(SEED, number)), FOLDER) else { continue };
        drawn += 1;
        for (cut, differences) in found {
            assert!(is_right(&differences), "scene {number}, by {cut}: {:e}", worst(&differences));
        }
    }
    assert!(drawn > SCENES / 2, "{drawn} of {SCENES}");
}

#[test]
fn parts_of_the_oracle_add_up() {
    check_random_scenes(Drawer::Oracle, |differences| worst(differences) <= 1e-12);
}

/// In f32 a light that nearly touches a surface, a steep triangle or a large exponent multiply rounding, which is another
/// one among other lights: in such places parts and whole are each within the bar of `Bars::FLOAT` for all values.
#[test]
fn parts_of_the_cpus_pictures_of_random_scenes_add_up() {
    check_random_scenes(Drawer::Cpu, |differences| {
        let rounded = differences.iter().filter(|&&off| off <= 1e-5).count();
        worst(differences) <= Bars::FLOAT.worst && rounded as f64 >= 0.98 * differences.len() as f64
    });
}

/// Without such places they add up to a few units of f32.
#[test]
fn parts_of_the_cpus_pictures_add_up_to_rounding() {
    for name in ["brass_teapot", "light_kinds", "moonlit_table", "material_spheres"] {
        let text = std::fs::read_to_string(Path::new(EXAMPLES).join(name).with_extension("json")).expect("a file");
        let mut file = plain(&serde_json::from_str(&text).expect("JSON"));
        file.size = [96, 72];
        for (cut, differences) in differences(Drawer::Cpu, &file, EXAMPLES).expect("a scene that can be drawn") {
            assert!(worst(&differences) <= 4e-7, "{name}, by {cut}: {:e}", worst(&differences));
        }
    }
}
