//! Paints the panels on the CPU: triangles with colours and images, blended over the pixels of a window.

use egui::epaint::{Mesh, Primitive, Vertex};
use egui::{Color32, ColorImage, Pos2};
use halfway::prelude::UVec2;

use super::{Images, Painted};

/// The painter, with the images of the panels.
#[derive(Default)]
pub(crate) struct Painter {
    images: Images,
}

/// The part of the window that a mesh may touch, in pixels: from `low` on and before `high`.
#[derive(Clone, Copy)]
struct Clip {
    low: [i32; 2],
    high: [i32; 2],
}

impl Painter {
    /// Paints over `pixels`, of which each is 0x00RRGGBB.
    pub(crate) fn paint(&mut self, painted: &mut Painted, pixels: &mut [u32], size: UVec2) {
        let textures = std::mem::take(&mut painted.textures);
        self.images.update(&textures);
        for primitive in &painted.primitives {
            let Primitive::Mesh(mesh) = &primitive.primitive else { continue };
            let Some(image) = self.images.get(mesh.texture_id) else { continue };
            let scale = painted.scale;
            let pixel = |at: f32, limit: u32| ((at * scale).round() as i32).clamp(0, limit as i32);
            let rect = primitive.clip_rect;
            let clip = Clip {
                low: [pixel(rect.min.x, size.x), pixel(rect.min.y, size.y)],
                high: [pixel(rect.max.x, size.x), pixel(rect.max.y, size.y)],
            };
            paint_mesh(mesh, image, scale, clip, (pixels, size.x as usize));
        }
        self.images.free(&textures);
    }
}

/// The texel at a point of an image, each coordinate from 0 to 1.
fn nearest(image: &ColorImage, [u, v]: [f32; 2]) -> [f32; 4] {
    let texel = |at: f32, count: usize| ((at * count as f32) as usize).min(count - 1);
    let [width, height] = image.size;
    channels(image.pixels[texel(v, height) * width + texel(u, width)])
}

fn channels(color: Color32) -> [f32; 4] {
    color.to_array().map(f32::from)
}

fn paint_mesh(mesh: &Mesh, image: &ColorImage, scale: f32, clip: Clip, mut target: (&mut [u32], usize)) {
    if image.pixels.is_empty() {
        return;
    }
    for corners in mesh.indices.as_chunks::<3>().0 {
        let corner = |index: u32| mesh.vertices.get(index as usize).copied();
        let [Some(a), Some(b), Some(c)] = corners.map(corner) else { continue };
        paint_triangle([a, b, c].map(|vertex| scaled(vertex, scale)), image, clip, &mut target);
    }
}

fn scaled(vertex: Vertex, scale: f32) -> Vertex {
    Vertex { pos: Pos2::new(vertex.pos.x * scale, vertex.pos.y * scale), ..vertex }
}

/// A pixel belongs to the triangle if its middle does. Triangles that share an edge compute it from the same end, so that
/// each pixel along it belongs to one of them.
fn paint_triangle(corners: [Vertex; 3], image: &ColorImage, clip: Clip, (pixels, width): &mut (&mut [u32], usize)) {
    let [a, b, c] = corners.map(|vertex| vertex.pos);
    let area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if !area.is_finite() || area == 0.0 {
        return;
    }
    let first = |least: f32| (least - 0.5).ceil();
    let rows = [a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y)].map(|y| first(y) as i32);
    // Values change evenly across and down: each has its steps.
    let values = corners.map(|Vertex { uv, color, .. }| {
        let [r, g, b, a] = channels(color);
        [r, g, b, a, uv.x, uv.y]
    });
    let [bits, others @ ..] = values.map(|corner| corner.map(f32::to_bits));
    let is_plain = others.iter().all(|other| *other == bits);
    let across: [f32; 6] = std::array::from_fn(|k| {
        let [va, vb, vc] = [values[0][k], values[1][k], values[2][k]];
        ((vb - va) * (c.y - a.y) - (vc - va) * (b.y - a.y)) / area
    });
    let down: [f32; 6] = std::array::from_fn(|k| {
        let [va, vb, vc] = [values[0][k], values[1][k], values[2][k]];
        ((vc - va) * (b.x - a.x) - (vb - va) * (c.x - a.x)) / area
    });
    let fixed = is_plain.then(|| source(values[0], image));
    if fixed.is_some_and(|color| color.iter().all(|channel| *channel == 0.0)) {
        return;
    }
    for y in rows[0].max(clip.low[1])..rows[1].min(clip.high[1]) {
        let middle = y as f32 + 0.5;
        let Some([left, right]) = span([a, b, c], middle) else { continue };
        let (begin, end) = ((first(left) as i32).max(clip.low[0]), (first(right) as i32).min(clip.high[0]));
        if begin >= end {
            continue;
        }
        let row = &mut pixels[y as usize * *width..][begin as usize..end as usize];
        if let Some(color) = fixed {
            for pixel in row {
                *pixel = over(color, *pixel);
            }
            continue;
        }
        let (dx, dy) = (begin as f32 + 0.5 - a.x, middle - a.y);
        let mut value: [f32; 6] = std::array::from_fn(|k| values[0][k] + across[k] * dx + down[k] * dy);
        for pixel in row {
            *pixel = over(source(value, image), *pixel);
            value = std::array::from_fn(|k| value[k] + across[k]);
        }
    }
}

/// Where a row of middles enters and leaves a triangle.
fn span([a, b, c]: [Pos2; 3], y: f32) -> Option<[f32; 2]> {
    let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
    for (from, to) in [(a, b), (b, c), (c, a)] {
        let (top, bottom) = if (from.y, from.x) <= (to.y, to.x) { (from, to) } else { (to, from) };
        if top.y <= y && y < bottom.y {
            let x = top.x + (bottom.x - top.x) * ((y - top.y) / (bottom.y - top.y));
            (low, high) = (low.min(x), high.max(x));
        }
    }
    (low < high).then_some([low, high])
}

/// Colour times image: premultiplied, each channel 0 to 255.
fn source([r, g, b, a, u, v]: [f32; 6], image: &ColorImage) -> [f32; 4] {
    let texel = nearest(image, [u, v]);
    std::array::from_fn(|k| [r, g, b, a][k].clamp(0.0, 255.0) * texel[k] * (1.0 / 255.0))
}

fn over(color: [f32; 4], pixel: u32) -> u32 {
    let [_, red, green, blue] = pixel.to_be_bytes();
    let behind = 1.0 - color[3] * (1.0 / 255.0);
    let mixed = |front: f32, back: u8| (front + behind * f32::from(back) + 0.5) as u8;
    u32::from_be_bytes([0, mixed(color[0], red), mixed(color[1], green), mixed(color[2], blue)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::epaint::ImageDelta;
    use egui::{ClippedPrimitive, Rect, TextureId, pos2, vec2};

    const SIZE: UVec2 = UVec2::new(16, 8);

    /// Paints meshes with an image of one white texel.
    fn painted(meshes: Vec<Mesh>, clip: Rect, scale: f32) -> Vec<u32> {
        let mut painter = Painter::default();
        let mut painted = Painted { scale, ..Painted::default() };
        let image = ColorImage::filled([1, 1], Color32::WHITE);
        let delta = ImageDelta::full(image, egui::TextureOptions::NEAREST);
        painted.textures.set.insert(TextureId::default(), [delta].into_iter().collect());
        let clipped = |mesh| ClippedPrimitive { clip_rect: clip, primitive: Primitive::Mesh(mesh) };
        painted.primitives = meshes.into_iter().map(clipped).collect();
        let mut pixels = vec![0x0010_2030; (SIZE.x * SIZE.y) as usize];
        painter.paint(&mut painted, &mut pixels, SIZE);
        pixels
    }

    fn rectangle(rect: Rect, color: Color32) -> Mesh {
        let mut mesh = Mesh::default();
        mesh.add_colored_rect(rect, color);
        mesh
    }

    #[test]
    fn triangles_that_share_an_edge_share_no_pixel_and_leave_none_out() {
        // Half transparent: a pixel that is painted twice is darker.
        let color = Color32::from_rgba_premultiplied(0, 0, 0, 128);
        for shift in 0..32 {
            let shift = shift as f32 / 32.0;
            let corners =
                [pos2(1.0 + shift, 1.0), pos2(13.0, 1.5 + shift), pos2(14.0 - shift, 7.0), pos2(2.0, 6.0 + shift)];
            let vertex = |pos| Vertex { pos, uv: pos2(0.0, 0.0), color };
            let middle = pos2(7.3, 3.7 + shift);
            let mut vertices = corners.map(vertex).to_vec();
            vertices.push(vertex(middle));
            let indices = vec![0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4];
            let pixels = painted(vec![Mesh { indices, vertices, ..Mesh::default() }], Rect::EVERYTHING, 1.0);
            let count = |color: u32| pixels.iter().filter(|pixel| **pixel == color).count();
            let (once, never) = (count(0x0008_1018), count(0x0010_2030));
            assert_eq!(once + never, pixels.len(), "shift {shift}: none twice");
            assert!(once > 40, "shift {shift}: {once}");
        }
    }

    #[test]
    fn rectangles_are_clipped_and_scaled() {
        let white = 0x00ff_ffff;
        let rect = Rect::from_min_size(pos2(1.0, 1.0), vec2(3.0, 2.0));
        for (clip, scale, expected) in [
            (Rect::EVERYTHING, 1.0, 6),
            (Rect::EVERYTHING, 2.0, 24),
            (Rect::from_min_max(pos2(2.0, 0.0), pos2(9.0, 2.0)), 1.0, 2),
            (Rect::from_min_max(pos2(5.0, 5.0), pos2(9.0, 9.0)), 1.0, 0),
        ] {
            let pixels = painted(vec![rectangle(rect, Color32::WHITE)], clip, scale);
            assert_eq!(pixels.iter().filter(|pixel| **pixel == white).count(), expected, "{clip:?} {scale}");
        }
        let pixels = painted(vec![rectangle(rect, Color32::WHITE)], Rect::EVERYTHING, 1.0);
        assert_eq!((pixels[17], pixels[16], pixels[1]), (white, 0x0010_2030, 0x0010_2030));
    }

    #[test]
    fn colours_go_evenly_from_corner_to_corner() {
        let mut mesh = rectangle(Rect::from_min_size(pos2(0.0, 0.0), vec2(16.0, 8.0)), Color32::BLACK);
        mesh.vertices.iter_mut().filter(|vertex| vertex.pos.x > 8.0).for_each(|vertex| vertex.color = Color32::WHITE);
        let pixels = painted(vec![mesh], Rect::EVERYTHING, 1.0);
        let expected = |x: u32| (255.0 * (x as f32 + 0.5) / 16.0 + 0.5) as u32;
        for x in 0..16 {
            assert_eq!(pixels[3 * 16 + x as usize] & 0xff, expected(x), "column {x}");
        }
    }

    #[test]
    fn what_makes_no_sense_is_left_out() {
        let vertex = |x, y| Vertex { pos: pos2(x, y), uv: pos2(9.0, f32::NAN), color: Color32::WHITE };
        let vertices = vec![vertex(f32::NAN, 1.0), vertex(5.0, f32::INFINITY), vertex(1.0, 1.0), vertex(-9e9, 1.0)];
        let indices = vec![0, 1, 2, 2, 2, 2, 0, 9, 1, 2, 3, 1];
        let pixels = painted(vec![Mesh { indices, vertices, ..Mesh::default() }], Rect::EVERYTHING, 1.0);
        assert!(pixels.iter().all(|pixel| *pixel == 0x0010_2030));
    }
}
