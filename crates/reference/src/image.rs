//! Pictures as linear intensities.

use std::ops::Range;

use halfway_lighting::Encoding;
use image::{DynamicImage, Rgb, RgbImage, Rgba32FImage, RgbaImage};

/// An intensity clamped to [0, 1] and encoded; NaN becomes 0.
pub(crate) fn encoded(i: f64, encoding: Encoding) -> f64 {
    encoding.encode(if i.is_nan() { 0.0 } else { i.clamp(0.0, 1.0) })
}

/// An encoded channel as the nearest of 256 steps.
pub(crate) fn byte(encoded: f64) -> u8 {
    (encoded * 255.0).round() as u8
}

/// A picture of linear intensities in f64, top row first, three channels; and, where it is known, which pixels show an
/// object and which the background.
///
/// ```
/// use halfway_lighting::Encoding;
/// use halfway_reference::Image;
///
/// let image = Image::new(2, 1, vec![[0.0; 3], [1.0, 0.5, 2.0]]).with_background([0.0; 3]);
/// assert_eq!(image.covered(), Some(&[false, true][..]));
/// assert_eq!(image.to_bytes(Encoding::Srgb).get_pixel(1, 0).0, [255, 188, 255]);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Vec<[f64; 3]>,
    covered: Option<Vec<bool>>,
    divisor: Option<f64>,
}

impl Image {
    /// A picture of `width` × `height` pixels, row by row.
    ///
    /// # Panics
    /// There are not `width`·`height` pixels.
    pub fn new(width: u32, height: u32, pixels: Vec<[f64; 3]>) -> Self {
        assert_eq!(pixels.len(), width as usize * height as usize, "one colour a pixel");
        Self { width, height, pixels, covered: None, divisor: None }
    }

    /// The picture with the pixels that show an object.
    ///
    /// # Panics
    /// There is not one entry a pixel.
    #[must_use]
    pub fn with_coverage(self, covered: Vec<bool>) -> Self {
        assert_eq!(covered.len(), self.pixels.len(), "one entry a pixel");
        Self { covered: Some(covered), ..self }
    }

    /// The picture divided by a number, which it remembers: by
    /// [`Intensity::Renormalize`](halfway_lighting::Intensity::Renormalize).
    #[must_use]
    pub fn divided(self, divisor: f64) -> Self {
        let by = divisor / self.divisor.unwrap_or(1.0);
        Self { divisor: Some(divisor), ..self }.scaled(by.recip())
    }

    /// The number that it was divided by, if any.
    pub fn divisor(&self) -> Option<f64> {
        self.divisor
    }

    /// The picture, brighter or darker.
    #[must_use]
    pub(crate) fn scaled(self, factor: f64) -> Self {
        self.mapped(|channel| channel * factor)
    }

    /// The picture with a function applied to each channel.
    #[must_use]
    pub(crate) fn mapped(mut self, of: impl Fn(f64) -> f64) -> Self {
        self.pixels.iter_mut().flatten().for_each(|channel| *channel = of(*channel));
        self
    }

    /// The largest channel that is not NaN; 0 if none is above 0.
    pub fn largest(&self) -> f64 {
        self.pixels.iter().flatten().copied().fold(0.0, f64::max)
    }

    /// The picture, in which every pixel of exactly this colour counts as background.
    #[must_use]
    #[expect(clippy::float_cmp, reason = "what is cleared to a colour holds exactly that")]
    pub fn with_background(self, background: [f64; 3]) -> Self {
        let covered = self.pixels.iter().map(|pixel| *pixel != background).collect();
        self.with_coverage(covered)
    }

    /// From linear intensities; alpha is dropped.
    pub fn from_float(image: &Rgba32FImage) -> Self {
        let pixels = image.pixels().map(|p| [p.0[0], p.0[1], p.0[2]].map(f64::from)).collect();
        Self::new(image.width(), image.height(), pixels)
    }

    /// From bytes, decoded to intensities; alpha is dropped.
    pub fn from_bytes(image: &RgbaImage, encoding: Encoding) -> Self {
        let table: [f64; 256] = std::array::from_fn(|byte| encoding.decode(byte as f64 / 255.0));
        let pixels = image.pixels().map(|p| [p.0[0], p.0[1], p.0[2]].map(|byte| table[usize::from(byte)])).collect();
        Self::new(image.width(), image.height(), pixels)
    }

    /// From a decoded picture: values of 8 or 16 bits are decoded to intensities, floating-point ones are intensities
    /// already. Alpha is dropped.
    pub fn from_decoded(image: &DynamicImage, encoding: Encoding) -> Self {
        use DynamicImage as D;
        match image {
            D::ImageRgb32F(_) | D::ImageRgba32F(_) => Self::from_float(&image.to_rgba32f()),
            D::ImageLuma16(_) | D::ImageLumaA16(_) | D::ImageRgb16(_) | D::ImageRgba16(_) => {
                let decode = |value: u16| encoding.decode(f64::from(value) / 65535.0);
                let pixels = image.to_rgb16().pixels().map(|pixel| pixel.0.map(decode)).collect();
                Self::new(image.width(), image.height(), pixels)
            }
            _ => Self::from_bytes(&image.to_rgba8(), encoding),
        }
    }

    /// Width and height in pixels.
    pub fn dimensions(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// The pixels, row by row.
    pub fn pixels(&self) -> &[[f64; 3]] {
        &self.pixels
    }

    /// The pixel in column `x` of row `y`.
    ///
    /// # Panics
    /// It lies outside.
    pub fn pixel(&self, x: u32, y: u32) -> [f64; 3] {
        assert!(x < self.width && y < self.height, "({x}, {y}) lies outside {} × {}", self.width, self.height);
        self.pixels[y as usize * self.width as usize + x as usize]
    }

    /// A range of rows as a picture.
    ///
    /// # Panics
    /// They lie outside.
    #[must_use]
    pub fn cut(&self, rows: Range<u32>) -> Self {
        let [start, end] = [rows.start, rows.end].map(|row| row as usize * self.width as usize);
        Self {
            width: self.width,
            height: rows.end - rows.start,
            pixels: self.pixels[start..end].to_vec(),
            covered: self.covered.as_ref().map(|covered| covered[start..end].to_vec()),
            divisor: self.divisor,
        }
    }

    /// Whether each pixel shows an object, if that is known.
    pub fn covered(&self) -> Option<&[bool]> {
        self.covered.as_deref()
    }

    /// Each channel clamped to [0, 1], encoded and rounded to the nearest of 256 steps. NaN becomes 0.
    pub fn to_bytes(&self, encoding: Encoding) -> RgbImage {
        let pixel = |x, y| Rgb(self.pixel(x, y).map(|i| byte(encoded(i, encoding))));
        RgbImage::from_fn(self.width, self.height, pixel)
    }

    /// Rounded to f32, with an alpha of 1.
    pub fn to_float(&self) -> Rgba32FImage {
        Rgba32FImage::from_fn(self.width, self.height, |x, y| {
            let [r, g, b] = self.pixel(x, y).map(|i| i as f32);
            image::Rgba([r, g, b, 1.0])
        })
    }
}
