//! Many frames on one picture.

use halfway_lighting::Encoding;
use halfway_reference::metrics::{text_height, text_scale, write_text};
use halfway_render::Picture;
use image::imageops::{self, FilterType};
use image::{DynamicImage, Rgb, Rgb32FImage, RgbImage, Rgba, RgbaImage};

use super::encode::{quantise, to_linear};

/// A grid of frames, scaled down, row by row from the top left.
///
/// Frames are averaged in linear light, so that fine bright lines keep their brightness. Only the small ones are
/// stored.
///
/// ```
/// use halfway_lighting::Encoding;
/// use halfway_record::output::ContactSheet;
/// use halfway_render::Picture;
///
/// let mut sheet = ContactSheet::new(2, 8, Encoding::Srgb);
/// for _ in 0..4 {
///     sheet.push(&Picture::Byte(image::RgbaImage::new(16, 16)));
/// }
/// // Two columns and two rows of 8 pixels, with gaps of 4.
/// assert_eq!((sheet.len(), sheet.picture().dimensions()), (4, (28, 28)));
/// ```
#[derive(Clone, Debug)]
pub struct ContactSheet {
    columns: u32,
    width: u32,
    encoding: Encoding,
    cells: Vec<RgbaImage>,
}

/// The pixels between and around frames, and their colour.
const GAP: u32 = 4;
const PAPER: Rgba<u8> = Rgba([24, 24, 24, 255]);

/// The frame's intensities, laid over the sheet where the frame is not opaque.
fn over_paper(frame: &Picture, mut linear: Rgb32FImage, encoding: Encoding) -> Rgb32FImage {
    let paper = encoding.decode(f64::from(PAPER.0[0]) / 255.0) as f32;
    for (x, y, pixel) in linear.enumerate_pixels_mut() {
        let alpha = match frame {
            Picture::Byte(image) => f32::from(image.get_pixel(x, y).0[3]) / 255.0,
            Picture::Float(image) => image.get_pixel(x, y).0[3].clamp(0.0, 1.0),
        };
        pixel.0 = pixel.0.map(|i| alpha * i + (1.0 - alpha) * paper);
    }
    linear
}

impl ContactSheet {
    /// A sheet of `columns` frames in a row, each `width` pixels wide and as high as its shape needs. 0 is taken as 1.
    pub fn new(columns: u32, width: u32, encoding: Encoding) -> Self {
        Self { columns: columns.max(1), width: width.max(1), encoding, cells: Vec::new() }
    }

    /// Adds a frame. Frames narrower than the cells keep their size; frames without pixels are left out.
    pub fn push(&mut self, frame: &Picture) {
        self.push_with_caption(frame, "");
    }

    /// Adds a frame with a line of text below it; an empty one takes no room. Characters other than those of ASCII are
    /// shown as `?`.
    pub fn push_with_caption(&mut self, frame: &Picture, caption: &str) {
        let (width, height) = frame.dimensions();
        if width == 0 || height == 0 {
            return;
        }
        let cell_width = self.width.min(width);
        let cell_height = (u64::from(height) * u64::from(cell_width)).div_ceil(u64::from(width)) as u32;
        let linear = to_linear(frame, self.encoding);
        let linear = over_paper(frame, linear, self.encoding);
        let small = imageops::resize(&linear, cell_width, cell_height, FilterType::Triangle);
        let mut cell = RgbImage::from_fn(cell_width, cell_height, |x, y| {
            Rgb(small.get_pixel(x, y).0.map(|i| quantise(i, self.encoding, 255) as u8))
        });
        if !caption.is_empty() {
            let scale = text_scale(cell_width);
            let line = text_height(scale) + 2 * GAP;
            let [r, g, b, _] = PAPER.0;
            let mut captioned = RgbImage::from_pixel(cell_width, cell_height + line, Rgb([r, g, b]));
            imageops::replace(&mut captioned, &cell, 0, 0);
            write_text(&mut captioned, (GAP, cell_height + GAP), scale, caption);
            cell = captioned;
        }
        self.cells.push(DynamicImage::from(cell).into_rgba8());
    }

    /// How many frames are on the sheet.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether there is no frame on the sheet.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// The sheet as a picture of 8 bits a channel. A sheet without frames is an empty picture, which cannot be written.
    pub fn picture(&self) -> Picture {
        let Some(width) = self.cells.iter().map(RgbaImage::width).max() else {
            return Picture::Byte(RgbaImage::new(0, 0));
        };
        let height = self.cells.iter().map(RgbaImage::height).max().unwrap_or(0);
        let columns = self.columns.min(self.cells.len() as u32);
        let rows = (self.cells.len() as u32).div_ceil(columns);
        let mut sheet = RgbaImage::from_pixel(columns * (width + GAP) + GAP, rows * (height + GAP) + GAP, PAPER);
        for (i, cell) in self.cells.iter().enumerate() {
            let (row, column) = (i as u32 / columns, i as u32 % columns);
            let (x, y) = (GAP + column * (width + GAP), GAP + row * (height + GAP));
            imageops::replace(&mut sheet, cell, i64::from(x), i64::from(y));
        }
        Picture::Byte(sheet)
    }
}
