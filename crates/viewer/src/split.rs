//! The divider: the window shows one way of drawing at its left and another at its right.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use bevy_ecs::prelude::*;
use egui::{Align2, Color32, ColorImage, Context, CursorIcon, FontId, Id, LayerId, Order, Rect, Sense, Stroke};
use egui::{TextureHandle, TextureOptions, pos2, vec2};
use halfway::lighting::{CameraTurn, Choices, Edges, Film, Layers, Part, Projection, Viewport};
use halfway::prelude::*;
use halfway::reference::{Oracle, OracleError, Shows};
use halfway::render::{Picture, Surfaces, WindowPicture, draw_background, draw_lines, has_lines};
use image::{DynamicImage, RgbaImage};

use crate::projected::pixels_of;

/// The way in which the right side of the window is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Way {
    /// The same in this shading.
    Shading(Shading),
    /// The picture of the reference renderer, in f64.
    Oracle,
    /// By how much the picture differs from the reference renderer's, so many times.
    Difference(u32),
}

impl Way {
    /// All that can be chosen.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        let shadings = Shading::CHOICES.iter().map(|choice| Self::Shading(choice.value));
        shadings.chain([Self::Oracle, Self::Difference(1), Self::Difference(16), Self::Difference(64)])
    }

    pub(crate) fn name(self) -> String {
        match self {
            Self::Shading(shading) => shading.choice().map_or_else(String::new, |choice| choice.name.to_owned()),
            Self::Oracle => "reference (f64)".into(),
            Self::Difference(1) => "difference".into(),
            Self::Difference(times) => format!("difference × {times}"),
        }
    }
}

/// The divider and what is at its right.
pub(crate) struct Split {
    pub(crate) way: Way,
    /// Where the divider is, as a share of the window's width.
    at: f32,
    /// The camera that draws the right side.
    camera: Option<Entity>,
    oracle: Drawn,
}

/// The picture of the reference renderer.
#[derive(Default)]
struct Drawn {
    /// The picture that it was asked for: all that it depends on.
    asked: Option<Key>,
    job: Option<Job>,
    /// The bytes of the picture, red, green and blue, of what was asked.
    bytes: Option<Vec<u8>>,
    shown: Option<(Way, TextureHandle)>,
}

#[derive(Clone, Debug, PartialEq)]
struct Key {
    camera: (Transform, Projection),
    size: UVec2,
    revision: u64,
}

struct Job {
    stop: Arc<AtomicBool>,
    done: Receiver<Surfaced>,
}

/// The reference renderer's picture of surfaces, and what is needed to put the background behind it and lines over it.
struct Surfaced {
    picture: RgbaImage,
    /// How much of the background each pixel shows; `None` where it is one opaque colour, which is there already.
    background: Option<Vec<f32>>,
    /// The object and the triangle that each pixel shows, where there are lines.
    triangles: Option<Vec<Option<(Entity, u32)>>>,
}

impl Drop for Job {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

impl Split {
    pub(crate) fn new(way: Way) -> Self {
        Self { way, at: 0.5, camera: None, oracle: Drawn::default() }
    }

    /// The bytes of the reference renderer's picture, red, green and blue, once it is drawn.
    #[cfg(test)]
    pub(crate) fn reference_picture(&self) -> Option<&[u8]> {
        self.oracle.bytes.as_deref()
    }

    /// Takes what it has put into the world out of it.
    pub(crate) fn end(self, world: &mut World) {
        world.remove_resource::<WindowPicture>();
        if let Some(camera) = self.camera
            && let Ok(camera) = world.get_entity_mut(camera)
        {
            camera.despawn();
        }
    }

    /// Shows the divider, and has the right side drawn. `revision` is another number whenever the scene is another one.
    pub(crate) fn show(
        &mut self,
        ctx: &Context,
        window: Rect,
        left: &str,
        (main, revision): (Entity, u64),
        world: &mut World,
    ) {
        self.divider(ctx, window);
        self.draw_camera(main, window, ctx.pixels_per_point(), world);
        let x = window.left() + self.at * window.width();
        let painter = ctx.layer_painter(LayerId::background()).with_clip_rect(window);
        let mut note = self.way.name();
        if !matches!(self.way, Way::Shading(_)) {
            let part = Rect::from_min_max(pos2(x, window.top()), window.max);
            match self.reference(ctx, window, (main, revision), world) {
                Ok(texture) => {
                    let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                    painter.with_clip_rect(part).image(texture, window, uv, Color32::WHITE);
                }
                Err(sentence) => note = format!("{note}: {sentence}"),
            }
        }
        let top = window.top() + 8.0;
        for (at, anchor, text) in [(x - 8.0, Align2::RIGHT_TOP, left), (x + 8.0, Align2::LEFT_TOP, &note)] {
            let font = FontId::proportional(13.0);
            let galley = painter.layout_no_wrap(text.to_owned(), font, Color32::WHITE);
            let rect = anchor.anchor_size(pos2(at, top), galley.size());
            painter.rect_filled(rect.expand(3.0), 3.0, Color32::from_black_alpha(170));
            painter.galley(rect.min, galley, Color32::WHITE);
        }
    }

    fn divider(&mut self, ctx: &Context, window: Rect) {
        let x = window.left() + self.at * window.width();
        let line = Rect::from_min_max(pos2(x - 4.0, window.top()), pos2(x + 4.0, window.bottom()));
        egui::Area::new(Id::unique("divider")).order(Order::Background).fixed_pos(line.min).show(ctx, |ui| {
            let (rect, response) = ui.allocate_exact_size(line.size(), Sense::drag());
            let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
            let bright = response.hovered() || response.dragged();
            let color = if bright { Color32::WHITE } else { Color32::from_white_alpha(120) };
            ui.painter().vline(rect.center().x, rect.y_range(), Stroke::new(if bright { 2.0 } else { 1.0 }, color));
            let grip = Rect::from_center_size(rect.center(), vec2(6.0, 30.0));
            ui.painter().rect_filled(grip, 3.0, color);
            if response.dragged() {
                self.at = (self.at + response.drag_delta().x / window.width()).clamp(0.02, 0.98);
            }
        });
    }

    /// Has a second camera draw the right side, over the first one's picture.
    fn draw_camera(&mut self, main: Entity, window: Rect, scale: f32, world: &mut World) {
        let Way::Shading(shading) = self.way else {
            if let Some(camera) = self.camera.take() {
                world.despawn(camera);
            }
            return;
        };
        let Part::Pixels([left, top, width, height]) = pixels_of(window, scale).part else { return };
        let cut = ((self.at * width as f32).round() as u32).min(width - 1);
        let viewport = Viewport::pixels([left + cut, top, width - cut, height]).with_order(1);
        let Some(camera) = world.get::<Camera>(main).copied() else { return };
        let right = Camera { projection: part(camera.projection, [width, height], cut), ..camera };
        if world.get::<Viewport>(main).is_none() {
            world.entity_mut(main).insert(pixels_of(window, scale));
        }
        let second = *self.camera.get_or_insert_with(|| {
            world.spawn((Name::new("right of the divider"), Transform::default(), ChildOf(main))).id()
        });
        world.entity_mut(second).insert((right, viewport, shading));
        share::<Reflectance>(world, main, second);
        share::<Layers>(world, main, second);
        share::<Edges>(world, main, second);
    }

    /// The texture of the reference renderer's picture, or of how far the window's is from it.
    fn reference(
        &mut self,
        ctx: &Context,
        window: Rect,
        (main, revision): (Entity, u64),
        world: &mut World,
    ) -> Result<egui::TextureId, String> {
        let Part::Pixels([left, top, width, height]) = pixels_of(window, ctx.pixels_per_point()).part else {
            return Err("there is no picture".into());
        };
        let size = UVec2::new(width, height);
        let (Some(at), Some(camera)) = (world.get::<Transform>(main), world.get::<Camera>(main)) else {
            return Err("there is no camera".into());
        };
        let (encoding, key) = (camera.encoding, Key { camera: (*at, camera.projection), size, revision });
        if self.oracle.asked.as_ref() != Some(&key) {
            // A camera that moves would only begin pictures.
            let is_moving = self.oracle.asked.replace(key).is_some() && self.oracle.job.is_some();
            (self.oracle.job, self.oracle.bytes, self.oracle.shown) = (None, None, None);
            world.remove_resource::<WindowPicture>();
            if is_moving {
                self.oracle.asked = None;
            }
            ctx.request_repaint();
            return Err("drawing …".into());
        }
        self.oracle.draw((main, size), encoding, world)?;
        let Some(bytes) = &self.oracle.bytes else { return Err("drawing …".into()) };
        if self.oracle.shown.as_ref().is_none_or(|(way, _)| *way != self.way) {
            let pixels = if let Way::Difference(times) = self.way {
                let kept = world.remove_resource::<WindowPicture>().and_then(|kept| kept.0);
                let Some(actual) = kept else {
                    // The next frame keeps it.
                    world.init_resource::<WindowPicture>();
                    ctx.request_repaint();
                    return Err("drawing …".into());
                };
                differences(&cut_out(&actual, actual.width(), [left, top, width, height]), bytes, times)
            } else {
                bytes.clone()
            };
            let image = ColorImage::from_rgb([size.x as usize, size.y as usize], &pixels);
            self.oracle.shown = Some((self.way, ctx.load_texture("reference", image, TextureOptions::NEAREST)));
        }
        self.oracle.shown.as_ref().map(|(_, texture)| texture.id()).ok_or_else(|| "drawing …".into())
    }
}

/// Gives an entity the component of another, or takes it away where that has none.
fn share<T: Component + Clone>(world: &mut World, from: Entity, to: Entity) {
    match world.get::<T>(from).cloned() {
        Some(component) => _ = world.entity_mut(to).insert(component),
        None => _ = world.entity_mut(to).remove::<T>(),
    }
}

impl Drawn {
    /// Begins the picture on a thread of its own, or takes it from there.
    fn draw(
        &mut self,
        (camera, size): (Entity, UVec2),
        encoding: halfway::lighting::Encoding,
        world: &mut World,
    ) -> Result<(), String> {
        if self.bytes.is_some() {
            return Ok(());
        }
        let Some(job) = &self.job else {
            let oracle = seen_by(camera, size, world).map_err(|error| error.to_string())?;
            let has_background =
                !oracle.has_sky() && world.get::<Camera>(camera).is_some_and(|it| !it.background_is_plain());
            let has_lines = has_lines(world);
            let (sender, done) = channel();
            let stop = Arc::new(AtomicBool::new(false));
            let asked = Arc::clone(&stop);
            std::thread::spawn(move || {
                let goes_on = |_, _| {
                    if asked.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
                };
                let Ok(picture) = oracle.draw_with(&goes_on) else { return };
                let triangle = |x: u32, y: u32| {
                    let nearest = oracle.probe(f64::from(x) + 0.5, f64::from(y) + 0.5).nearest?;
                    Some((nearest.object, nearest.triangle?))
                };
                let row = |y: u32| (0..size.x).map(move |x| (x, y));
                let triangles = has_lines.then(|| (0..size.y).flat_map(row).map(|(x, y)| triangle(x, y)).collect());
                let picture = DynamicImage::from(picture.to_bytes(encoding)).into_rgba8();
                let background = has_background.then(|| {
                    let coverage = oracle.showing(Shows::Coverage).draw();
                    coverage.pixels().iter().map(|&[coverage, ..]| (1.0 - coverage) as f32).collect()
                });
                // Nobody waits for it any more if it cannot be sent.
                let _ = sender.send(Surfaced { picture, background, triangles });
            });
            self.job = Some(Job { stop, done });
            return Ok(());
        };
        match job.done.try_recv() {
            Ok(surfaced) => {
                self.job = None;
                self.bytes = Some(in_turn(camera, world, |world| surfaced.finished(camera, world)));
            }
            Err(TryRecvError::Empty) => {}
            Err(TryRecvError::Disconnected) => return Err("it could not be drawn".into()),
        }
        Ok(())
    }
}

impl Surfaced {
    /// The bytes of the whole picture, red, green and blue. Lines that cannot be drawn are an error of the window's frame.
    fn finished(self, camera: Entity, world: &mut World) -> Vec<u8> {
        let size = UVec2::from(self.picture.dimensions());
        let mut picture = Picture::Byte(self.picture);
        if let (Some(shares), Some(camera)) = (self.background, world.get::<Camera>(camera)) {
            draw_background(&mut picture, &shares, camera);
        }
        if let Some(triangles) = self.triangles {
            let at = |x, y| triangles[(y * size.x + x) as usize];
            let drawn =
                Surfaces::found_by(world, size, at).and_then(|surfaces| draw_lines(world, &mut picture, &surfaces));
            drawn.ok();
        }
        let Picture::Byte(picture) = picture else { return Vec::new() };
        DynamicImage::from(picture).into_rgb8().into_raw()
    }
}

/// The reference renderer, for the picture of one of the cameras that share the window.
pub(crate) fn seen_by(camera: Entity, size: UVec2, world: &mut World) -> Result<Oracle, OracleError> {
    in_turn(camera, world, |world| Oracle::new(world, size).map(|oracle| oracle.with_clamping(true)))
}

/// Calls `work` while it is this camera's turn.
fn in_turn<T>(camera: Entity, world: &mut World, work: impl FnOnce(&mut World) -> T) -> T {
    let turn = world.get_resource::<CameraTurn>().copied();
    world.insert_resource(CameraTurn(Some(camera)));
    let result = work(world);
    match turn {
        Some(turn) => world.insert_resource(turn),
        None => drop(world.remove_resource::<CameraTurn>()),
    }
    result
}

/// The projection of the part of a picture from this column on.
fn part(projection: Projection, size: [u32; 2], left: u32) -> Projection {
    let ([half_width, half_height], [x, y]) = (projection.half_extent(size), projection.middle());
    let moved = half_width * f64::from(left) / f64::from(size[0]);
    let shift = [(x + moved) / (2.0 * half_height), y / (2.0 * half_height)].map(|along| along as f32);
    let pixel_aspect = match projection {
        Projection::Perspective { film, .. } | Projection::Orthographic { film, .. } => film.pixel_aspect,
    };
    let film = Film { shift, aspect: None, pixel_aspect };
    match projection {
        Projection::Perspective { near, .. } => {
            Projection::Perspective { fov_y: 2.0 * half_height.atan() as f32, near, film }
        }
        Projection::Orthographic { near, far, .. } => {
            Projection::Orthographic { height: 2.0 * half_height as f32, near, far, film }
        }
    }
}

/// A part of a picture of four bytes a pixel: its left edge, its upper edge, its width and height.
fn cut_out(bytes: &[u8], row: u32, [left, top, width, height]: [u32; 4]) -> Vec<u8> {
    let rows = bytes.chunks_exact(4 * row.max(1) as usize).skip(top as usize).take(height as usize);
    let (from, to) = (4 * left as usize, 4 * (left + width) as usize);
    rows.filter_map(|row| row.get(from..to)).flatten().copied().collect()
}

/// By how much each channel of a picture (four bytes a pixel) differs from another (three), so many times.
fn differences(actual: &[u8], expected: &[u8], times: u32) -> Vec<u8> {
    let pixels = actual.as_chunks::<4>().0.iter().zip(expected.as_chunks::<3>().0);
    let off = |a: u8, b: u8| (u32::from(a.abs_diff(b)) * times).min(255) as u8;
    pixels.flat_map(|([r, g, b, _], [er, eg, eb])| [off(*r, *er), off(*g, *eg), off(*b, *eb)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_part_shows_what_the_whole_shows_there() {
        let film = Film { shift: [0.1, -0.2], aspect: Some(2.0), pixel_aspect: 1.5 };
        let projections = [
            Projection::perspective(0.8),
            Projection::Perspective { fov_y: 0.8, near: 0.1, film },
            Projection::Orthographic { height: 3.0, near: 0.0, far: None, film },
        ];
        for projection in projections {
            let (size, left) = ([640, 400], 230);
            let whole = projection.lens::<f64>(size);
            let right = part(projection, size, left).lens::<f64>([size[0] - left, size[1]]);
            let column = |lens: &halfway::lighting::Lens<f64>, point, width: u32| {
                let [x, y, _, w] = lens.clip_from_eye(point);
                [(x / w + 1.0) * 0.5 * f64::from(width), y / w]
            };
            for point in [[0.3, 0.2, -4.0], [1.0, -0.5, -2.0], [-0.2, 0.0, -9.0]] {
                let [x, y] = column(&whole, point, size[0]);
                let [right_x, right_y] = column(&right, point, size[0] - left);
                // The part's film is rounded to f32: a thousandth of a pixel.
                assert!((x - f64::from(left) - right_x).abs() < 1e-3, "{projection:?}: {x} and {right_x}");
                assert!((y - right_y).abs() < 1e-5, "{projection:?}: {y} and {right_y}");
            }
        }
    }

    #[test]
    fn a_part_is_cut_out_by_rows() {
        let bytes: Vec<u8> = (0..4 * 6).collect();
        assert_eq!(cut_out(&bytes, 3, [1, 1, 2, 1]), (16..24).collect::<Vec<u8>>());
    }

    #[test]
    fn differences_are_scaled_and_end_at_white() {
        let actual = [10, 20, 30, 255, 100, 0, 7, 255];
        let expected = [12, 20, 29, 0, 0, 7];
        assert_eq!(differences(&actual, &expected, 1), [2, 0, 1, 100, 0, 0]);
        assert_eq!(differences(&actual, &expected, 64), [128, 0, 64, 255, 0, 0]);
    }
}
