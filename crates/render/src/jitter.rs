//! Pictures of more samples than a frame has: the mean of frames that are moved by parts of a pixel.

use crate::headless::Headless;
use crate::picture::Picture;
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemState;
use halfway_frame::error::RenderError;
use halfway_lighting::{Camera, Encoding, Samples, SharingCameras};
use image::{Rgba32FImage, RgbaImage};

/// The samples along each side of a pixel, where a camera asks for more than a frame has.
pub(crate) fn side(world: &mut World) -> Option<u32> {
    world.query::<&Camera>().iter(world).filter_map(|camera| camera.samples.side()).max()
}

/// The mean of `side`² pictures of a sample each, at the middles of equal squares of each pixel. The newest frame is then
/// the camera's own, of four samples.
pub(crate) fn averaged(
    world: &mut World,
    side: u32,
    mut draw: impl FnMut(&mut World) -> Result<Picture, RenderError>,
) -> Result<Picture, RenderError> {
    let size = world.get_resource::<Headless>().ok_or(RenderError::NoPicture)?.size.to_array();
    let sharing =
        SystemState::<SharingCameras>::new(world).get(world).map(|cameras| cameras.parts(size)).unwrap_or_default();
    let size_of = |camera| sharing.iter().find(|part| part.camera == camera).map_or(size, |part| part.size);
    let mut query = world.query::<(Entity, &Camera)>();
    let cameras: Vec<(Entity, Camera)> = query.iter(world).map(|(entity, camera)| (entity, *camera)).collect();
    let encoding = cameras.first().map(|(_, camera)| camera.encoding).unwrap_or_default();
    let mut sum = None;
    let mut failed = None;
    for sample in 0..side * side {
        let moved = [sample % side, sample / side].map(|i| (f64::from(i) + 0.5) / f64::from(side) - 0.5);
        for (entity, camera) in cameras.iter().filter(|(_, camera)| camera.samples.side().is_some()) {
            let projection = camera.projection.moved_by_pixels(moved, size_of(*entity));
            set(world, *entity, Camera { projection, samples: Samples::One, ..*camera });
        }
        match draw(world) {
            Ok(picture) => sum.get_or_insert_with(|| Sum::new(&picture)).add(&picture, encoding),
            Err(error) => {
                failed = Some(error);
                break;
            }
        }
    }
    for (entity, camera) in cameras {
        set(world, entity, camera);
    }
    if let Some(error) = failed {
        return Err(error);
    }
    // Questions about the frame are answered by the camera's own.
    let last = draw(world)?;
    Ok(sum.map_or(last, |sum| sum.mean(encoding)))
}

fn set(world: &mut World, entity: Entity, camera: Camera) {
    if let Some(mut there) = world.get_mut::<Camera>(entity) {
        *there = camera;
    }
}

/// A sum of pictures: linear RGB times opacity, and opacity.
struct Sum {
    size: (u32, u32),
    is_byte: bool,
    pixels: Vec<[f64; 4]>,
    count: f64,
}

impl Sum {
    fn new(picture: &Picture) -> Self {
        let size @ (width, height) = picture.dimensions();
        let pixels = vec![[0.0; 4]; width as usize * height as usize];
        Self { size, is_byte: matches!(picture, Picture::Byte(_)), pixels, count: 0.0 }
    }

    fn add(&mut self, picture: &Picture, encoding: Encoding) {
        let mut add = |number: usize, [r, g, b, alpha]: [f64; 4]| {
            if let Some(sum) = self.pixels.get_mut(number) {
                *sum = [sum[0] + alpha * r, sum[1] + alpha * g, sum[2] + alpha * b, sum[3] + alpha];
            }
        };
        match picture {
            Picture::Byte(image) => {
                let decoded: [f64; 256] = std::array::from_fn(|byte| encoding.decode(byte as f64 / 255.0));
                for (number, pixel) in image.pixels().enumerate() {
                    let [r, g, b, alpha] = pixel.0;
                    let [r, g, b] = [r, g, b].map(|byte| decoded[usize::from(byte)]);
                    add(number, [r, g, b, f64::from(alpha) / 255.0]);
                }
            }
            Picture::Float(image) => {
                image.pixels().enumerate().for_each(|(number, pixel)| add(number, pixel.0.map(f64::from)));
            }
        }
        self.count += 1.0;
    }

    fn mean(&self, encoding: Encoding) -> Picture {
        let (width, height) = self.size;
        let mean = |[r, g, b, alpha]: [f64; 4]| {
            let color = [r, g, b].map(|sum| if alpha > 0.0 { sum / alpha } else { 0.0 });
            (color, alpha / self.count)
        };
        let at = |x: u32, y: u32| mean(self.pixels[y as usize * width as usize + x as usize]);
        if !self.is_byte {
            return Picture::Float(Rgba32FImage::from_fn(width, height, |x, y| {
                let ([r, g, b], alpha) = at(x, y);
                image::Rgba([r, g, b, alpha].map(|number| number as f32))
            }));
        }
        let byte = |share: f64| (share * 255.0).round() as u8;
        Picture::Byte(RgbaImage::from_fn(width, height, |x, y| {
            let (color, alpha) = at(x, y);
            let [r, g, b] = color.map(|linear| byte(encoding.encode(linear)));
            image::Rgba([r, g, b, byte(alpha)])
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_of_light_and_by_opacity() {
        let one = |pixel| Picture::Byte(RgbaImage::from_pixel(1, 1, image::Rgba(pixel)));
        let mean = |pictures: &[[u8; 4]], encoding| {
            let mut sum = Sum::new(&one([0; 4]));
            for pixel in pictures {
                sum.add(&one(*pixel), encoding);
            }
            sum.mean(encoding)
        };
        let pictures = [[255, 0, 100, 255], [0, 0, 100, 255]];
        assert_eq!(mean(&pictures, Encoding::Raw), one([128, 0, 100, 255]));
        // Half of the light, not half of the byte.
        assert_eq!(mean(&pictures, Encoding::Srgb), one([188, 0, 100, 255]));
        // Transparent pixels have no colour.
        assert_eq!(mean(&[[200, 10, 0, 255], [0, 0, 0, 0]], Encoding::Srgb), one([200, 10, 0, 128]));
        assert_eq!(mean(&[[0; 4]; 2], Encoding::Srgb), one([0; 4]));
    }
}
