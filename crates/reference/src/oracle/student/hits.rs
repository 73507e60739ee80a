//! The hits of the rays through chosen pixels, and the pictures that are shaded from them.

use bevy_ecs::entity::Entity;
use bevy_math::{DVec3, UVec2};
use halfway_lighting::equations::divisor;
use halfway_lighting::{Faces, Intensity};
use rayon::prelude::*;

use super::plan::Student;
use crate::Image;
use crate::mistakes::{Mistake, Mistakes};
use crate::oracle::layers::Layers;
use crate::oracle::possible::FOUR;
use crate::oracle::raster::{Hit, Primitive, TILE};
use crate::oracle::scene::OracleScene;
use crate::oracle::solid::Color;
use crate::oracle::{Mode, Oracle};

/// All hits of the rays through the centres of chosen pixels: of front and back faces, hidden or not, in the order of
/// drawing.
#[derive(Clone, Debug)]
pub(crate) struct HitSheet {
    /// The oracle of the meshes, every side of which is shown.
    open: Oracle,
    pixels: Vec<PixelHits>,
}

/// The hits of one pixel.
#[derive(Clone, Debug)]
struct PixelHits {
    at: (u32, u32),
    /// Of the ray through its centre.
    hits: Vec<Hit>,
    /// Of the rays through four points, of which the pixel is the mean, if edges are smoothed.
    samples: Option<[Vec<Hit>; 4]>,
    /// Whether a neighbouring pixel shows another object, another side or the background, or lies before or behind.
    silhouette: bool,
}

/// The surfaces that a pixel shows: a number that is the same for the same sides of the same objects, and the depth of the nearest;
/// infinite where that is the background.
#[derive(Clone, Copy, Debug)]
struct Seen {
    number: u64,
    depth: f64,
}

/// A surface that lies by this share of its depth before or behind the plane of its neighbour is another one.
const JUMP: f64 = 0.01;

/// A tile's part of the sheet.
struct TileHits {
    origin: [u32; 2],
    width: u32,
    seen: Vec<Seen>,
    /// The chosen pixels, without their neighbours.
    pixels: Vec<PixelHits>,
}

impl HitSheet {
    /// The hits of every `step`-th pixel of every `step`-th row. A pixel shows its centre, or the mean of four points if it
    /// `is_smooth`.
    pub(crate) fn new(oracle: &Oracle, step: u32, is_smooth: bool) -> Self {
        let mut open = oracle.clone().with_mode(Mode::Mesh);
        open.scene.solids.iter_mut().flat_map(|solid| &mut solid.sides).for_each(|side| side.shown = true);
        let tiles: Vec<TileHits> = (0..open.tiles().count())
            .into_par_iter()
            .map(|tile| tile_hits(&open, tile, step.max(1), is_smooth))
            .collect();
        let UVec2 { x: width, y: height } = open.size;
        let mut seen = vec![Seen { number: 0, depth: f64::INFINITY }; width as usize * height as usize];
        for tile in &tiles {
            for (row, of_row) in tile.seen.chunks(tile.width as usize).enumerate() {
                let first = (tile.origin[1] as usize + row) * width as usize + tile.origin[0] as usize;
                seen[first..first + of_row.len()].copy_from_slice(of_row);
            }
        }
        let is_silhouette = |(x, y): (u32, u32), hits: &[Hit]| {
            let seen = |x: u32, y: u32| seen[y as usize * width as usize + x as usize];
            let around = |at: u32, size: u32| at.saturating_sub(1)..(at + 2).min(size);
            let plane = plane(&open.scene, hits);
            around(y, height).any(|row| {
                around(x, width).any(|column| {
                    let there = seen(column, row);
                    let jumps = plane.is_some_and(|plane| {
                        let expected = depth_on(&open.scene, plane, (column, row));
                        (there.depth - expected).abs() > JUMP * expected.abs()
                    });
                    there.number != seen(x, y).number || jumps
                })
            })
        };
        let mut pixels: Vec<PixelHits> = tiles.into_iter().flat_map(|tile| tile.pixels).collect();
        for pixel in &mut pixels {
            pixel.silhouette = is_silhouette(pixel.at, &pixel.hits);
        }
        Self { open, pixels }
    }

    /// The columns and rows of the pixels.
    pub(crate) fn places(&self) -> impl ExactSizeIterator<Item = (u32, u32)> {
        self.pixels.iter().map(|pixel| pixel.at)
    }

    /// Whether each pixel lies beside one that shows another object, another side or the background, or on an edge where
    /// one part of an object hides another.
    pub(crate) fn silhouettes(&self) -> impl ExactSizeIterator<Item = bool> {
        self.pixels.iter().map(|pixel| pixel.silhouette)
    }

    /// The nearest object of a pixel, in the scene as it should be.
    pub(crate) fn object(&self, number: usize) -> Option<Entity> {
        let scene = &self.open.scene;
        let layers = layers(scene, &self.pixels[number].hits, Mistakes::NONE);
        let nearest = layers.visible(scene).min_by(|a, b| a.depth.total_cmp(&b.depth));
        nearest.map(|hit| scene.solids[hit.solid].entity)
    }

    /// The pixels' intensities in the picture of somebody who makes these mistakes, before it is encoded. Mistakes with
    /// the whole picture, its encoding or its rows, do not show in them.
    pub(crate) fn drawn(&self, mistakes: Mistakes) -> Vec<Color> {
        self.drawn_by(mistakes, |pixel| pixel.samples.as_ref())
    }

    /// The right intensities at the centres of the pixels.
    pub(crate) fn right_at_centres(&self) -> Vec<Color> {
        self.drawn_by(Mistakes::NONE, |_| None)
    }

    fn drawn_by(
        &self,
        mistakes: Mistakes,
        samples: impl Fn(&PixelHits) -> Option<&[Vec<Hit>; 4]> + Sync,
    ) -> Vec<Color> {
        let scene = &self.open.scene;
        let student = Student::new(scene, mistakes);
        let policy = if mistakes.has(Mistake::ToneMappingMissing) { Intensity::Clamp } else { self.open.policy() };
        let clamps = self.open.clamp && policy == Intensity::Clamp && !mistakes.has(Mistake::ClampMissing);
        let written = |i: Color| if clamps { i.map(|channel| channel.min(1.0)) } else { i };
        let along = |[x, y]: [f64; 2], hits: &[Hit]| {
            let behind = scene.behind(scene.view.direction(x, y));
            layers(scene, hits, mistakes).visible(scene).fold(written(behind), |behind, hit| {
                let opacity = if mistakes.has(Mistake::OpacityIgnored) { 1.0 } else { scene.opacity(hit) };
                let over = written(student.intensity(hit));
                [0, 1, 2].map(|k| if opacity < 1.0 { opacity * over[k] + (1.0 - opacity) * behind[k] } else { over[k] })
            })
        };
        let color = |pixel: &PixelHits| {
            let point = |[x, y]: [f64; 2]| [f64::from(pixel.at.0) + x, f64::from(pixel.at.1) + y];
            let Some(samples) = samples(pixel) else { return along(point([0.5; 2]), &pixel.hits) };
            let colors = FOUR.iter().zip(samples).map(|(offset, hits)| along(point(*offset), hits));
            colors.fold([0.0; 3], |sum, color| [0, 1, 2].map(|k| sum[k] + 0.25 * color[k]))
        };
        let mut colors: Vec<Color> = self.pixels.par_iter().map(color).collect();
        let by = match policy {
            Intensity::Renormalize { .. } => divisor(colors.iter().flatten().copied().fold(0.0, f64::max), 0.0, 0.0),
            _ => 1.0,
        };
        colors.iter_mut().flatten().for_each(|channel| *channel = policy.toned(*channel / by));
        colors
    }

    /// Whether a mistake could change the scene at all. Where this is true it need not show.
    pub(crate) fn could_show(&self, mistake: Mistake) -> bool {
        super::plan::could_show(&self.open.scene, mistake)
    }
}

impl Oracle {
    /// Draws the meshes as somebody would who makes these mistakes. Those with encodings, rows and columns do not show in
    /// intensities: [`mistaken_picture`](crate::marking::mistaken_picture) draws them, too. Without a mistake this is
    /// [`draw`](Self::draw) to 10⁻¹² without supersampling.
    pub fn draw_mistaken(&self, mistakes: Mistakes) -> Image {
        let sheet = HitSheet::new(self, 1, false);
        let (width, height) = self.size();
        let mut pixels = vec![[0.0; 3]; width as usize * height as usize];
        for ((x, y), color) in sheet.places().zip(sheet.drawn(mistakes)) {
            pixels[y as usize * width as usize + x as usize] = color;
        }
        Image::new(width, height, pixels)
    }
}

fn tile_hits(open: &Oracle, tile: usize, step: u32, is_smooth: bool) -> TileHits {
    let scene = &open.scene;
    let origin = open.tiles().origin(tile);
    let UVec2 { x, y } = open.size;
    let [width, height] = [x - origin[0], y - origin[1]].map(|left| left.min(TILE));
    let mut hits: Vec<Vec<Hit>> = vec![Vec::new(); (width * height) as usize];
    for primitive in open.tiles().of_tile(tile) {
        let meet = scene.triangle(primitive);
        let Primitive { low, high, .. } = primitive;
        let pixels = |low: f64, high: f64, first: u32, count: u32| {
            let pixel = |at: f64| (at as u32).clamp(first, first + count);
            pixel((low - 0.5).ceil())..pixel((high - 0.5).floor() + 1.0)
        };
        for row in pixels(low.y, high.y, origin[1], height) {
            for column in pixels(low.x, high.x, origin[0], width) {
                let hit = meet(scene.view.at(f64::from(column) + 0.5, f64::from(row) + 0.5));
                hits[((row - origin[1]) * width + column - origin[0]) as usize].extend(hit);
            }
        }
    }
    let seen = hits.iter().map(|hits| shown(scene, hits)).collect();
    let chosen = |number: usize| {
        let at = (origin[0] + number as u32 % width, origin[1] + number as u32 / width);
        ([at.0, at.1].iter().all(|at| at % step == step / 2)).then_some((number, at))
    };
    let mut pixels: Vec<PixelHits> = (0..hits.len())
        .filter_map(chosen)
        .map(|(number, at)| {
            let samples = is_smooth.then(Default::default);
            PixelHits { at, hits: std::mem::take(&mut hits[number]), samples, silhouette: false }
        })
        .collect();
    if is_smooth {
        for primitive in open.tiles().of_tile(tile) {
            let meet = scene.triangle(primitive);
            let pixels = pixels.iter_mut().filter(|pixel| {
                let [x, y] = [pixel.at.0, pixel.at.1].map(f64::from);
                let (low, high) = (primitive.low, primitive.high);
                x + 1.0 >= low.x && x <= high.x && y + 1.0 >= low.y && y <= high.y
            });
            for PixelHits { at: (x, y), samples, .. } in pixels {
                for ([right, down], hits) in FOUR.iter().zip(samples.iter_mut().flatten()) {
                    hits.extend(meet(scene.view.at(f64::from(*x) + right, f64::from(*y) + down)));
                }
            }
        }
    }
    TileHits { origin, width, seen, pixels }
}

fn shown(scene: &OracleScene, hits: &[Hit]) -> Seen {
    let layers = layers(scene, hits, Mistakes::NONE);
    let number = |hit: &Hit| 2 * hit.solid as u64 + u64::from(hit.front) + 1;
    let nothing = Seen { number: 0, depth: f64::INFINITY };
    layers.visible(scene).fold(nothing, |all, hit| Seen {
        number: all.number.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(number(hit)),
        depth: all.depth.min(hit.depth),
    })
}

/// A point and the normal of the nearest visible triangle on a ray.
fn plane(scene: &OracleScene, hits: &[Hit]) -> Option<[DVec3; 2]> {
    let layers = layers(scene, hits, Mistakes::NONE);
    let nearest = layers.visible(scene).min_by(|a, b| a.depth.total_cmp(&b.depth))?;
    let (triangle, _) = nearest.on_triangle()?;
    let [a, b, c] = scene.solids[nearest.solid].lit_triangle(triangle);
    Some([a, (b - a).cross(c - a)])
}

/// The depth at which the ray through a pixel's centre meets a plane.
fn depth_on(scene: &OracleScene, [point, normal]: [DVec3; 2], (x, y): (u32, u32)) -> f64 {
    let ray = scene.view.ray(scene.view.at(f64::from(x) + 0.5, f64::from(y) + 0.5));
    normal.dot(point - ray.origin) / normal.dot(ray.direction)
}

/// The visible hits among those of a ray, under mistakes with sides and depths.
fn layers(scene: &OracleScene, hits: &[Hit], mistakes: Mistakes) -> Layers {
    let seen = |hit: &Hit| {
        let front = hit.front != mistakes.has(Mistake::WindingReversed);
        let faces = scene.solids[hit.solid].faces;
        let shown = if front { faces.shows_front() } else { faces.shows_back() };
        let not_culled = mistakes.has(Mistake::BackFacesNotCulled);
        let culled = mistakes.has(Mistake::BackFacesCulled) && faces == Faces::Both && !front;
        ((shown || not_culled) && !culled).then_some(Hit { front, ..*hit })
    };
    let seen = hits.iter().filter_map(seen);
    let mut layers = Layers::default();
    if mistakes.has(Mistake::DepthTestMissing) || mistakes.has(Mistake::DepthTestReversed) {
        let (blended, opaque): (Vec<Hit>, Vec<Hit>) = seen.partition(|hit| scene.solids[hit.solid].blend);
        let mut opaque = opaque.into_iter().filter(|hit| !scene.is_cut(hit));
        let shown = if mistakes.has(Mistake::DepthTestMissing) {
            opaque.next_back()
        } else {
            opaque.max_by(|a, b| a.depth.total_cmp(&b.depth))
        };
        shown.into_iter().chain(blended).for_each(|hit| layers.add(scene, hit));
    } else {
        seen.for_each(|hit| layers.add(scene, hit));
    }
    layers
}
