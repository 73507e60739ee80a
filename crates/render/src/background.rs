//! Backgrounds that are more than one opaque colour.

use crate::picture::Picture;
use crate::quantities::background_shares;
use bevy_color::LinearRgba;
use bevy_ecs::prelude::World;
use halfway_frame::error::RenderError;
use halfway_frame::passes::{Passes, Phase};
use halfway_lighting::{Camera, Encoding};
use image::Rgba;

/// Puts this camera's background behind the newest frame's picture, where it is more than one opaque colour: where nothing
/// is drawn, and in part where blended surfaces and the edges of surfaces cover a pixel in part. Colours are those of what
/// is seen, not multiplied by the opacity. A picture that is `kept` takes the background's place.
///
/// # Errors
/// Those of drawing how much of the background is seen.
pub(crate) fn put_behind(
    world: &mut World,
    picture: &mut Picture,
    kept: Option<&Picture>,
    camera: &Camera,
) -> Result<(), RenderError> {
    let is_sky = world.get_resource::<Passes>().is_some_and(|passes| passes.has(Phase::Sky));
    if is_sky || kept.is_none() && camera.background_is_plain() {
        return Ok(());
    }
    let shares = background_shares(world)?;
    match kept {
        Some(kept) => draw_kept(picture, &shares, camera, kept),
        None => draw_background(picture, &shares, camera),
    }
    Ok(())
}

/// Puts the camera's background behind a picture that was drawn over its upper colour, opaque. `shares` says for each
/// pixel how much of the background is seen in it, from 0 to 1, row by row from the top.
///
/// [`take_picture`](crate::take_picture) and [`render_picture`](crate::render_picture) have done it.
pub fn draw_background(picture: &mut Picture, shares: &[f32], camera: &Camera) {
    let (width, height) = picture.dimensions();
    let rows = (0..height).map(|row| camera.background_at((f64::from(row) + 0.5) / f64::from(height)));
    let behind = rows.flat_map(|color| std::iter::repeat_n(color, width as usize));
    draw_behind(picture, shares, camera, behind);
}

/// The same with a picture in place of the background, of the same size and values and in the camera's encoding: for a
/// camera that keeps what others before it have drawn.
pub fn draw_kept(picture: &mut Picture, shares: &[f32], camera: &Camera, kept: &Picture) {
    match kept {
        Picture::Float(kept) => {
            let behind = kept.pixels().map(|&Rgba([red, green, blue, alpha])| LinearRgba { red, green, blue, alpha });
            draw_behind(picture, shares, camera, behind);
        }
        Picture::Byte(kept) => {
            let decoded = decoded(camera.encoding);
            let behind = kept.pixels().map(|&Rgba([red, green, blue, alpha])| {
                let [red, green, blue] = [red, green, blue].map(|value| decoded[usize::from(value)]);
                LinearRgba { red, green, blue, alpha: f32::from(alpha) / 255.0 }
            });
            draw_behind(picture, shares, camera, behind);
        }
    }
}

/// The linear intensities of the bytes.
fn decoded(encoding: Encoding) -> [f32; 256] {
    std::array::from_fn(|byte| encoding.decode(byte as f64 / 255.0) as f32)
}

/// Puts a colour behind each pixel.
fn draw_behind(picture: &mut Picture, shares: &[f32], camera: &Camera, behind: impl Iterator<Item = LinearRgba>) {
    let seen = shares.iter().zip(behind).map(|(&share, behind)| (share, behind));
    match picture {
        Picture::Float(image) => {
            for (pixel, (share, behind)) in image.pixels_mut().zip(seen).filter(|(_, (share, _))| *share > 0.0) {
                let [red, green, blue, _] = pixel.0;
                pixel.0 = over([red, green, blue], share, camera.background, behind);
            }
        }
        Picture::Byte(image) => {
            let encoding = camera.encoding;
            let decoded = decoded(encoding);
            let byte = |share: f64| (share * 255.0).round() as u8;
            for (pixel, (share, behind)) in image.pixels_mut().zip(seen).filter(|(_, (share, _))| *share > 0.0) {
                let [red, green, blue, _] = pixel.0;
                let [red, green, blue, alpha] =
                    over([red, green, blue].map(|value| decoded[usize::from(value)]), share, camera.background, behind);
                let [red, green, blue] =
                    [red, green, blue].map(|linear| byte(encoding.encode(f64::from(linear.min(1.0)))));
                pixel.0 = [red, green, blue, byte(alpha.into())];
            }
        }
    }
}

/// A colour of which `share` is the opaque `drawn`, with `behind` in its place; and its opacity.
fn over(color: [f32; 3], share: f32, drawn: LinearRgba, behind: LinearRgba) -> [f32; 4] {
    let part = share * behind.alpha;
    let opacity = 1.0 - share + part;
    if opacity <= 0.0 {
        return [0.0; 4];
    }
    let [drawn, behind] = [drawn, behind].map(|color| [color.red, color.green, color.blue]);
    let [red, green, blue] = [0, 1, 2].map(|c| ((color[c] - share * drawn[c] + part * behind[c]) / opacity).max(0.0));
    [red, green, blue, opacity]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_colour_over_another_background() {
        let ink = [0.8, 0.1, 0.3];
        let drawn = LinearRgba::rgb(0.5, 0.25, 1.0);
        let behind = LinearRgba { red: 0.25, green: 0.75, blue: 0.0, alpha: 0.25 };
        let [over_drawn, over_behind] = [drawn, behind].map(|color| [color.red, color.green, color.blue]);
        for share in [0.0, 0.25, 0.5, 1.0] {
            let opaque = [0, 1, 2].map(|c| (1.0 - share) * ink[c] + share * over_drawn[c]);
            let [r, g, b, alpha] = over(opaque, share, drawn, behind);
            // The background's part is its share times its opacity.
            assert!((alpha - (1.0 - share + share * 0.25)).abs() < 1e-6);
            let expected = [0, 1, 2].map(|c| ((1.0 - share) * ink[c] + share * 0.25 * over_behind[c]) / alpha);
            for (found, expected) in [r, g, b].into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-6, "{share}: {found} instead of {expected}");
            }
        }
        assert_eq!(over([0.0; 3], 1.0, LinearRgba::BLACK, LinearRgba::NONE).map(f32::to_bits), [0; 4]);
    }
}
