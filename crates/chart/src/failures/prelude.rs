//! Shared by the pages: scenes, drawn by the oracle and by adapters, and their plots.

use bevy_ecs::query::QueryFilter;
use halfway::reference::Oracle;
use halfway::reference::metrics::{self, Comparison};
use halfway::render::AdapterChoice;
use image::RgbImage;

pub(super) use halfway::prelude::*;
pub(super) use halfway::reference::{Image, Mode};
pub(super) use halfway::render::Adapter;

pub(super) use super::FailurePage;
pub(super) use crate::error::ChartError;
pub(super) use crate::figure::{Axis, Figure, Panel};
use crate::figure::{Marker, Point, Series, Stroke, Style, colors};
pub(super) use crate::front::ChartedAdapter;
pub(super) use crate::front::scenes::sound;

/// Width and height of the pictures.
pub(super) const SIZE: UVec2 = UVec2::splat(256);

/// A scene for the oracle.
pub(super) fn set_up(spawn: impl FnOnce(&mut World)) -> App {
    let mut app = App::new();
    app.add_plugins(HalfwayPlugins::reference()).insert_resource(GlobalAmbient(LinearRgba::BLACK));
    app.finish();
    app.cleanup();
    spawn(app.world_mut());
    app.update();
    app
}

/// A scene drawn by the oracle.
pub(super) fn drawn(mode: Mode, spawn: impl FnOnce(&mut World)) -> Result<Image, ChartError> {
    drawn_at(SIZE, mode, spawn)
}

/// A scene drawn by the oracle in another size.
pub(super) fn drawn_at(size: UVec2, mode: Mode, spawn: impl FnOnce(&mut World)) -> Result<Image, ChartError> {
    let mut app = set_up(spawn);
    Ok(Oracle::new(app.world_mut(), size)?.with_mode(mode).draw())
}

/// A camera of 45° that looks at the origin.
pub(super) fn camera(world: &mut World, from: Vec3, up: Vec3) {
    world.spawn((Camera::default(), Transform::from_translation(from).looking_at(Vec3::ZERO, up)));
}

/// A camera on the z axis that looks at the origin and sees `half` to each side of it, above and below; its near plane
/// is at a tenth of its distance.
pub(super) fn camera_above(world: &mut World, distance: f32, half: f32) {
    let fov_y = (2.0 * (f64::from(half) / f64::from(distance)).atan()) as f32;
    let camera = Camera::perspective(fov_y).with_near(0.1 * distance);
    world.spawn((camera, Transform::from_xyz(0.0, 0.0, distance)));
}

/// A white light from a direction.
pub(super) fn sun(world: &mut World, from: Vec3) {
    world.spawn((DirectionalLight::white(), Transform::default().looking_to(-from, Vec3::Y)));
}

/// A white light without attenuation.
pub(super) fn lamp(world: &mut World, at: Vec3) {
    let lamp = PointLight { attenuation: Attenuation::NONE, ..PointLight::white() };
    world.spawn((lamp, Transform::from_translation(at)));
}

pub(super) fn show(world: &mut World, mesh: impl Into<Mesh>, material: Material, shading: Shading) -> Entity {
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh.into());
    world.spawn((Mesh3d(mesh), material, shading, Transform::default())).id()
}

/// A mesh from valid data of this crate.
pub(super) fn made(positions: Vec<Vec3>, normals: Option<Vec<Vec3>>, indices: Vec<u32>) -> Mesh {
    sound(Mesh::from_parts(positions, normals, None, indices))
}

/// The square from −1 to 1 in the plane z = 0, facing +z, of N cells; each is split from lower left to upper right.
pub(super) fn square(columns: u32, rows: u32) -> Mesh {
    let at = |i: u32, of: u32| 2.0 * i as f32 / of as f32 - 1.0;
    let corners = (0..=rows).flat_map(|j| (0..=columns).map(move |i| Vec3::new(at(i, columns), at(j, rows), 0.0)));
    let positions: Vec<Vec3> = corners.collect();
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| j * (columns + 1) + i));
    let triangles = cells.flat_map(|a| {
        let (b, c) = (a + 1, a + columns + 1);
        [a, b, c + 1, a, c + 1, c]
    });
    let normals = vec![Vec3::Z; positions.len()];
    made(positions, Some(normals), triangles.collect())
}

/// A highlight and nothing else.
pub(super) fn shine(shininess: f32) -> Material {
    Material { specular: LinearRgba::WHITE, shininess, ..Material::matte(LinearRgba::BLACK) }
}

/// The three shadings and the truth of one scene, in this order.
pub(super) fn four(size: UVec2, spawn: impl Fn(&mut World, Shading)) -> Result<[Image; 4], ChartError> {
    let [flat, gouraud, phong] = SHADINGS.map(|shading| drawn_at(size, Mode::Mesh, |world| spawn(world, shading)));
    Ok([flat?, gouraud?, phong?, drawn_at(size, Mode::Surface, |world| spawn(world, Shading::Phong))?])
}

/// The difference of two pictures in linear intensity, on pixels that both cover.
pub(super) fn compared(picture: &Image, truth: &Image) -> Result<Comparison, ChartError> {
    Ok(metrics::compare(picture, truth, Encoding::Raw)?)
}

/// The root mean square of that difference.
pub(super) fn rms(picture: &Image, truth: &Image) -> Result<f64, ChartError> {
    Ok(compared(picture, truth)?.linear.all.rmse)
}

/// The total light of a picture: the sum of its channels.
pub(super) fn light(picture: &Image) -> f64 {
    picture.pixels().iter().flatten().sum()
}

/// The renderers beside the oracle: the charted ones, and the CPU without a driver, if it is not among them.
pub(super) fn renderers(charted: &[ChartedAdapter]) -> Result<Vec<ChartedAdapter>, ChartError> {
    let mut renderers = charted.to_vec();
    if !renderers.iter().any(|one| matches!(one.adapter, Adapter::Cpu(_))) {
        let adapter = AdapterChoice::cpu().open()?;
        renderers.push(ChartedAdapter { name: "cpu".to_owned(), adapter });
    }
    Ok(renderers)
}

/// Scenes that replace each other, drawn by an adapter and by the oracle, with every triangle and every light.
pub(super) struct JudgedApp {
    app: App,
    size: UVec2,
}

impl JudgedApp {
    pub(super) fn new(adapter: &Adapter, size: UVec2, pixels: Pixels) -> Self {
        let mut app = App::new();
        adapter.clone().insert_into(app.world_mut());
        app.add_plugins(HalfwayPlugins::headless(size))
            .insert_resource(ViewTolerance(Tolerance::EXACT))
            .insert_resource(GlobalAmbient(LinearRgba::BLACK));
        app.finish();
        app.cleanup();
        app.world_mut().resource_mut::<Headless>().pixels = pixels;
        Self { app, size }
    }

    /// Replaces the scene.
    pub(super) fn set(&mut self, spawn: impl FnOnce(&mut World)) {
        let world = self.app.world_mut();
        clear::<With<Camera>>(world);
        clear::<With<Mesh3d>>(world);
        clear::<Or<(With<PointLight>, With<SpotLight>, With<DirectionalLight>)>>(world);
        spawn(world);
    }

    /// The adapter's picture.
    pub(super) fn picture(&mut self) -> Result<Image, ChartError> {
        Ok(match render_picture(&mut self.app)? {
            Picture::Float(image) => Image::from_float(&image),
            Picture::Byte(image) => Image::from_bytes(&image, Encoding::Raw),
        })
    }

    /// The oracle's picture of the same; after [`picture`](Self::picture), which updates all transforms.
    pub(super) fn truth(&mut self) -> Result<Image, ChartError> {
        Ok(Oracle::new(self.app.world_mut(), self.size)?.with_mode(Mode::Mesh).draw())
    }

    /// The largest error of a channel relative to its true value, over channels of more than `least`.
    pub(super) fn relative_error(&mut self, least: f64) -> Result<f64, ChartError> {
        let (picture, truth) = (self.picture()?, self.truth()?);
        let channels = picture.pixels().iter().flatten().zip(truth.pixels().iter().flatten());
        let counted = channels.filter(|(_, should)| **should > least);
        let largest = counted.map(|(is, should)| (is / should - 1.0).abs()).reduce(f64::max);
        largest.ok_or_else(|| ChartError::Scene("the picture shows nothing that could be judged".to_owned()))
    }
}

/// The adapter's picture of a scene, the oracle's, and their difference times a factor; with the captions of the first
/// and the last.
pub(super) fn judged(
    renderers: &[ChartedAdapter],
    (size, pixels): (UVec2, Pixels),
    (as_drawn, difference, factor): (&'static str, &'static str, f64),
    spawn: impl FnOnce(&mut World),
) -> Result<Vec<(&'static str, RgbImage)>, ChartError> {
    let drawer = renderers.first().ok_or_else(|| ChartError::Scene("there is nothing that draws".to_owned()))?;
    let mut judged = JudgedApp::new(&drawer.adapter, size, pixels);
    judged.set(spawn);
    let (drawn, truth) = (judged.picture()?, judged.truth()?);
    let off = |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|channel| factor * (a[channel] - b[channel]).abs());
    let off = Image::new(size.x, size.y, drawn.pixels().iter().zip(truth.pixels()).map(off).collect());
    Ok(shown([(as_drawn, &drawn), ("the oracle", &truth), (difference, &off)]))
}

fn clear<F: QueryFilter>(world: &mut World) {
    let entities: Vec<Entity> = world.query_filtered::<Entity, F>().iter(world).collect();
    for entity in entities {
        world.despawn(entity);
    }
}

/// The compared shadings, the cheapest first.
pub(super) const SHADINGS: [Shading; 3] = [Shading::Flat, Shading::Gouraud, Shading::Phong];
/// Their names, and that of the truth.
pub(super) const NAMES: [&str; 4] = ["flat", "Gouraud", "Phong", "true surface"];

/// The first channel along a row of pixels, from the first covered column to the last.
pub(super) fn row(image: &Image, y: u32) -> Vec<(f64, f64)> {
    let covered = |x: u32| image.covered().is_none_or(|covered| covered[(y * SIZE.x + x) as usize]);
    (0..SIZE.x).filter(|x| covered(*x)).map(|x| (f64::from(x), image.pixel(x, y)[0])).collect()
}

/// Lines of five kinds that differ in colour and in stroke.
pub(super) fn series(name: &str, kind: usize, points: &[(f64, f64)], marked: bool) -> Series {
    let styles = [
        (colors::RED, Marker::Square, Stroke::Dot),
        (colors::BLUE, Marker::Triangle, Stroke::Dash),
        (colors::GREEN, Marker::Circle, Stroke::Solid),
        (colors::INK, Marker::Diamond, Stroke::Solid),
        (colors::PURPLE, Marker::Wedge, Stroke::Dash),
    ];
    let (color, marker, stroke) = styles[kind % styles.len()];
    let point = |&(x, y): &(f64, f64)| Point::new(x, y, format!("{name}: {} at {}", number(y), number(x)));
    Series {
        name: name.to_owned(),
        style: Style { color, marker: marked.then_some(marker), filled: true, stroke },
        points: points.iter().map(point).collect(),
    }
}

/// A marked line of `value` at these positions.
pub(super) fn measured<T>(
    name: &str,
    kind: usize,
    over: impl IntoIterator<Item = (f64, T)>,
    mut value: impl FnMut(T) -> Result<f64, ChartError>,
) -> Result<Series, ChartError> {
    let points = over.into_iter().map(|(x, it)| Ok((x, value(it)?)));
    Ok(series(name, kind, &points.collect::<Result<Vec<_>, ChartError>>()?, true))
}

/// With four decimals if that is precise enough, else with a power of ten.
fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-2..1e5).contains(&size) { format!("{value:.4}") } else { format!("{value:.2e}") }
}

/// A figure of one panel.
pub(super) fn figure(id: &str, title: &str, axes: [Axis; 2], panel: Panel) -> Figure {
    Figure::new(format!("failure-{id}"), title, axes, vec![panel])
}

/// The pictures in the encoding of displays.
pub(super) fn shown<const N: usize>(pictures: [(&'static str, &Image); N]) -> Vec<(&'static str, RgbImage)> {
    pictures.map(|(caption, picture)| (caption, picture.to_bytes(Encoding::Srgb))).into()
}
