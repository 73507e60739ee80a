//! Where methods fail: a page for each way, with pictures, a plot, the cause, the remedy, and the test that keeps it.
//!
//! All is drawn by the oracle, so that what is seen is what a method loses and not how it was implemented; what policies of
//! intensity cost is timed on an adapter.

mod creases;
mod diagonals;
mod highlight;
mod interpolation;
mod mach;
mod saturation;
mod terminator;

use halfway::prelude::*;
use halfway::reference::{Image, Mode, Oracle};
use image::RgbImage;

use crate::figure::{Figure, Marker, Point, Series, Stroke, Style};
use crate::measure::{MeasureError, SHADINGS, shading_name};

/// One way in which a method fails.
#[derive(Clone, Debug)]
pub struct FailurePage {
    /// Names its file: lower case, no spaces.
    pub id: &'static str,
    /// What is seen.
    pub title: &'static str,
    /// Why, in a line.
    pub cause: &'static str,
    /// What helps, in a line.
    pub remedy: &'static str,
    /// The test that keeps what the page says.
    pub test: &'static str,
    /// How much, over what it depends on.
    pub figure: Figure,
    /// More of it.
    pub others: Vec<Figure>,
    /// Captions and pictures.
    pub pictures: Vec<(&'static str, RgbImage)>,
}

/// How many pages there are, for whoever is told of progress.
pub const PAGES: u64 = 7;

/// Every page; `done` is told after each.
///
/// # Errors
/// The first picture that could not be drawn.
pub fn all(mut done: impl FnMut(&FailurePage)) -> Result<Vec<FailurePage>, MeasureError> {
    let drawn = [highlight::page, mach::page, terminator::page, creases::page, diagonals::page, saturation::page];
    let pages = drawn.into_iter().map(|page| page()).chain(std::iter::once_with(|| Ok(interpolation::page())));
    pages.map(|page| page.inspect(&mut done)).collect()
}

/// Width and height of the pictures.
const SIZE: UVec2 = UVec2::splat(256);

/// A scene for the oracle.
fn set_up(spawn: impl FnOnce(&mut World)) -> App {
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::reference()).insert_resource(GlobalAmbient(LinearRgba::BLACK));
    app.finish();
    app.cleanup();
    spawn(app.world_mut());
    app.update();
    app
}

/// A scene drawn by the oracle.
fn drawn(mode: Mode, spawn: impl FnOnce(&mut World)) -> Result<Image, MeasureError> {
    let mut app = set_up(spawn);
    Ok(Oracle::new(app.world_mut(), SIZE)?.with_mode(mode).draw())
}

/// A camera of 45° that looks at the origin.
fn camera(world: &mut World, from: Vec3, up: Vec3) {
    world.spawn((Camera::default(), Transform::from_translation(from).looking_at(Vec3::ZERO, up)));
}

/// A white light from a direction.
fn sun(world: &mut World, from: Vec3) {
    world.spawn((DirectionalLight::white(), Transform::default().looking_to(-from, Vec3::Y)));
}

fn show(world: &mut World, mesh: impl Into<Mesh>, material: Material, shading: Shading) {
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh.into());
    world.spawn((Mesh3d(mesh), material, shading, Transform::default()));
}

/// The three shadings and the truth of one scene, in this order.
fn four(spawn: impl Fn(&mut World, Shading)) -> Result<[Image; 4], MeasureError> {
    let [flat, gouraud, phong] = SHADINGS.map(|shading| drawn(Mode::Mesh, |world| spawn(world, shading)));
    Ok([flat?, gouraud?, phong?, drawn(Mode::Surface, |world| spawn(world, Shading::Phong))?])
}

/// Their names.
fn names() -> [&'static str; 4] {
    let [flat, gouraud, phong] = SHADINGS.map(shading_name);
    [flat, gouraud, phong, "true surface"]
}

/// The first channel along a row of pixels, from column to column where something is covered.
fn row(image: &Image, y: u32) -> Vec<(f64, f64)> {
    let covered = |x: u32| image.covered().is_none_or(|covered| covered[(y * SIZE.x + x) as usize]);
    (0..SIZE.x).filter(|x| covered(*x)).map(|x| (f64::from(x), image.pixel(x, y)[0])).collect()
}

/// Lines of four kinds that are told apart by colour and by stroke.
fn series(name: &str, kind: usize, points: &[(f64, f64)], marked: bool) -> Series {
    let styles = [
        ([0xd5, 0x5e, 0x00], Marker::Square, Stroke::Dot),
        ([0x00, 0x72, 0xb2], Marker::Triangle, Stroke::Dash),
        ([0x00, 0x9e, 0x73], Marker::Circle, Stroke::Solid),
        ([0x22, 0x22, 0x22], Marker::Diamond, Stroke::Solid),
    ];
    let (color, marker, stroke) = styles[kind % styles.len()];
    let point = |&(x, y): &(f64, f64)| Point::new(x, y, format!("{name}: {y:.4} at {x:.4}"));
    Series {
        name: name.to_owned(),
        style: Style { color, marker: marked.then_some(marker), filled: true, stroke },
        points: points.iter().map(point).collect(),
    }
}

/// As they are looked at.
fn shown<const N: usize>(pictures: [(&'static str, &Image); N]) -> Vec<(&'static str, RgbImage)> {
    pictures.map(|(caption, picture)| (caption, picture.to_bytes(Encoding::Srgb))).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_page_names_a_test_that_there_is() {
        let mut told = 0;
        let pages = all(|_| told += 1).unwrap();
        assert_eq!((pages.len() as u64, told), (PAGES, PAGES));
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/failures");
        let files =
            std::fs::read_dir(folder).unwrap().map(|file| std::fs::read_to_string(file.unwrap().path()).unwrap());
        let text: String = files.collect();
        for page in &pages {
            assert!(text.contains(&format!("    fn {}() {{", page.test)), "{}: {}", page.id, page.test);
            assert!(!page.pictures.is_empty() && page.figure.shown().count() > 3, "{}", page.id);
        }
    }
}
