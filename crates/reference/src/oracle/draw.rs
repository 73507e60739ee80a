//! Draws every pixel, tile by tile.

use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicU32, Ordering};

use bevy_math::UVec2;
use rayon::prelude::*;

use super::Oracle;
use super::error::Stopped;
use super::layers::Layers;
use super::raster::{Hit, Primitive, TILE};
use super::solid::Color;
use crate::Image;

/// A finished part of the picture.
struct DrawnTile {
    /// Its top left pixel.
    origin: [u32; 2],
    width: u32,
    /// Row by row: the colour, and whether an object is seen.
    pixels: Vec<([f64; 3], bool)>,
}

impl Oracle {
    /// Draws the picture on all cores. It is the same to the bit whatever their number.
    pub fn draw(&self) -> Image {
        match self.draw_with(&|_, _| ControlFlow::Continue(())) {
            Ok(image) => image,
            Err(Stopped) => unreachable!("nothing asked to stop"),
        }
    }

    /// Draws the picture on all cores; `progress` receives the number of finished tiles and of all tiles, from any
    /// thread, and may stop the work.
    ///
    /// # Errors
    /// [`Stopped`] where `progress` said so.
    pub fn draw_with(&self, progress: &(dyn Fn(u32, u32) -> ControlFlow<()> + Sync)) -> Result<Image, Stopped> {
        let tiles = self.tiles().count();
        let done = AtomicU32::new(0);
        let parts: Vec<DrawnTile> = (0..tiles)
            .into_par_iter()
            .map(|tile| {
                let part = self.part(tile);
                match progress(done.fetch_add(1, Ordering::Relaxed) + 1, tiles as u32) {
                    ControlFlow::Continue(()) => Ok(part),
                    ControlFlow::Break(()) => Err(Stopped),
                }
            })
            .collect::<Result<_, _>>()?;
        Ok(self.under_policy(self.put_together(&parts)))
    }

    fn part(&self, tile: usize) -> DrawnTile {
        let origin = self.tiles().origin(tile);
        let UVec2 { x, y } = self.size;
        let [width, height] = [x - origin[0], y - origin[1]].map(|left| left.min(TILE));
        let mut part = DrawnTile { origin, width, pixels: vec![([0.0; 3], false); (width * height) as usize] };
        let share = self.share();
        for offset in self.offsets() {
            for (number, layers) in self.layers(tile, &part, offset).iter().enumerate() {
                let (row, column) = (number as u32 / width, number as u32 % width);
                let [x, y] = [origin[0] + column, origin[1] + row].map(f64::from);
                let behind = self.scene.behind(self.scene.view.direction(x + offset[0], y + offset[1]));
                let color = layers.color(&self.scene, behind, self.clamps());
                let (sum, covered) = &mut part.pixels[number];
                *sum = with_share(*sum, share, color);
                *covered |= !layers.is_empty();
            }
        }
        part
    }

    /// The places of the samples in a pixel, from its top left corner, row by row.
    pub(super) fn offsets(&self) -> impl Iterator<Item = [f64; 2]> + use<> {
        let n = self.supersampling;
        (0..n * n).map(move |sample| [sample % n, sample / n].map(|i| (f64::from(i) + 0.5) / f64::from(n)))
    }

    /// The share of a sample in its pixel.
    fn share(&self) -> f64 {
        1.0 / f64::from(self.supersampling * self.supersampling)
    }

    /// The colour of a pixel of these samples.
    pub(super) fn mean(&self, samples: impl Iterator<Item = Color>) -> Color {
        samples.fold([0.0; 3], |sum, color| with_share(sum, self.share(), color))
    }

    /// The layers on the rays through the pixels of a part, each at `offset` from the pixel's top left corner.
    fn layers(&self, tile: usize, part: &DrawnTile, offset: [f64; 2]) -> Vec<Layers> {
        let mut layers = vec![Layers::default(); part.pixels.len()];
        let height = part.pixels.len() as u32 / part.width;
        let scene = &self.scene;
        let mut add = |x: u32, y: u32, hit: Hit| {
            let pixel = (y - part.origin[1]) * part.width + x - part.origin[0];
            layers[pixel as usize].add(scene, hit);
        };
        let at = |x: u32, y: u32| [f64::from(x) + offset[0], f64::from(y) + offset[1]];
        let primitives: Vec<&Primitive> = self.tiles().of_tile(tile).collect();
        for group in primitives.chunk_by(|a, b| a.solid == b.solid) {
            let solid = group[0].solid;
            if scene.solids[solid].smooth.is_some() {
                for (y, x) in grid(part.origin[1]..part.origin[1] + height, part.origin[0]..part.origin[0] + part.width)
                {
                    let [u, v] = at(x, y);
                    let pieces = group.iter().copied().filter(|piece| piece.reaches(u, v));
                    scene.pieces(solid, pieces, scene.view.at(u, v)).for_each(|hit| add(x, y, hit));
                }
                continue;
            }
            for primitive in group {
                let meet = scene.triangle(primitive);
                let Primitive { low, high, .. } = primitive;
                let rows = covered(low.y, high.y, offset[1], part.origin[1], height);
                for (y, x) in grid(rows, covered(low.x, high.x, offset[0], part.origin[0], part.width)) {
                    let [u, v] = at(x, y);
                    if let Some(hit) = meet(scene.view.at(u, v)) {
                        add(x, y, hit);
                    }
                }
            }
        }
        layers
    }

    fn put_together(&self, parts: &[DrawnTile]) -> Image {
        let UVec2 { x: width, y: height } = self.size;
        let pixels = width as usize * height as usize;
        let mut colors = vec![[0.0; 3]; pixels];
        let mut covered = vec![false; pixels];
        for part in parts {
            for (row, of_row) in part.pixels.chunks(part.width as usize).enumerate() {
                let first = (part.origin[1] as usize + row) * width as usize + part.origin[0] as usize;
                for (i, (color, is_covered)) in of_row.iter().enumerate() {
                    colors[first + i] = *color;
                    covered[first + i] = *is_covered;
                }
            }
        }
        Image::new(width, height, colors).with_coverage(covered)
    }
}

/// A sum with the share of one more sample.
fn with_share(sum: Color, share: f64, color: Color) -> Color {
    [0, 1, 2].map(|k| sum[k] + share * color[k])
}

/// The pixels, of `count` from `first` on, whose samples at `offset` lie from `low` to `high`.
fn covered(low: f64, high: f64, offset: f64, first: u32, count: u32) -> Range<u32> {
    let pixel = |at: f64| (at as u32).clamp(first, first + count);
    // Casts saturate negative numbers to 0.
    pixel((low - offset).ceil())..pixel((high - offset).floor() + 1.0)
}

/// Row by row.
fn grid(rows: Range<u32>, columns: Range<u32>) -> impl Iterator<Item = (u32, u32)> {
    rows.flat_map(move |y| columns.clone().map(move |x| (y, x)))
}
