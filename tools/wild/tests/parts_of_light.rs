//! Parts of the light of random scenes, which add up to the whole.

use std::path::Path;
use std::time::Duration;

use bevy_time::TimeUpdateStrategy;
use halfway::lighting::{Choices, Term};
use halfway::mesh::Lines3d;
use halfway::prelude::*;
use halfway::reference::{Image, Oracle};
use halfway::render::AdapterChoice;
use halfway::scene::options::remove_what_is_laid_over;
use halfway::scene::{LightSource, PartOfLight, SceneFile, Spawned, spawn};
use halfway_wild::scene;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/wild");
const SEED: u64 = 2027;
const SCENES: u64 = 130;

/// Either drawer of the parts.
#[derive(Clone, Copy)]
enum Drawer {
    Oracle,
    Cpu,
}

impl Drawer {
    /// The rounding of a sum, relative to the largest value of the picture.
    ///
    /// The CPU's is that of f32 at a vertex, where Gouraud shading may be far brighter than the pixel, and of another
    /// order of the same operations on other sets of terms: 3.8·10⁻⁵ is the most in 200 of these scenes, in which
    /// triangles are steep and exponents large.
    fn rounding(self) -> f64 {
        match self {
            Self::Oracle => 1e-12,
            Self::Cpu => 1e-4,
        }
    }

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

    fn app(self, file: &SceneFile) -> (App, Spawned) {
        let mut app = App::new();
        match self {
            Self::Oracle => app.add_plugins(HalfwayPlugins::reference()),
            Self::Cpu => app.add_plugins(HalfwayPlugins::headless(UVec2::from_array(file.size))),
        };
        app.insert_resource(AdapterChoice::cpu())
            .insert_resource(Headless { size: UVec2::from_array(file.size), pixels: Pixels::Float })
            .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
        let spawned = spawn(file, Path::new(FOLDER), app.world_mut()).expect("a scene of the folder");
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

/// A random scene without what is drawn over a picture, and with intensities as they are.
fn plain(number: u64) -> SceneFile {
    let mut file = SceneFile::from_json(&scene(SEED, number).to_string(), "scene").expect("a scene");
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

fn check(drawer: Drawer, number: u64) -> bool {
    let file = plain(number);
    let size = UVec2::from_array(file.size);
    let (mut app, spawned) = drawer.app(&file);
    let Some(whole) = drawer.draw(&mut app, size) else { return false };
    for (cut, parts) in cuts(spawned.lights.len()) {
        let mut sum = vec![[0.0; 3]; whole.pixels().len()];
        for part in parts {
            spawned.show_light(part, app.world_mut());
            let image = drawer.draw(&mut app, size).expect("it was drawn before");
            for (sum, pixel) in sum.iter_mut().zip(image.pixels()) {
                *sum = [0, 1, 2].map(|k| sum[k] + pixel[k]);
            }
        }
        let most = whole.largest().max(1e-3);
        for (i, (sum, pixel)) in sum.iter().zip(whole.pixels()).enumerate() {
            let is_close = sum.iter().zip(pixel).all(|(sum, i)| (sum - i).abs() <= drawer.rounding() * most);
            let (x, y) = (i as u32 % size.x, i as u32 / size.x);
            assert!(is_close, "scene {number}, {cut}, ({x}, {y}): {sum:?} instead of {pixel:?}");
        }
    }
    spawned.show_light(PartOfLight::default(), app.world_mut());
    let again = drawer.draw(&mut app, size);
    assert_eq!(again, Some(whole), "scene {number}: all of the light again");
    true
}

#[test]
fn parts_of_the_oracle_add_up() {
    let drawn = (0..SCENES).filter(|&number| check(Drawer::Oracle, number)).count();
    assert!(drawn as u64 > SCENES / 2, "{drawn} of {SCENES}");
}

#[test]
fn parts_of_the_cpus_picture_add_up() {
    let drawn = (0..SCENES).filter(|&number| check(Drawer::Cpu, number)).count();
    assert!(drawn as u64 > SCENES / 2, "{drawn} of {SCENES}");
}
