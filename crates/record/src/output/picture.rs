//! Still pictures.

use std::io::{Cursor, Write};
use std::path::Path;

use halfway_lighting::Encoding;
use halfway_render::{Picture, Pixels};
use image::codecs::jpeg::JpegEncoder;
use image::codecs::webp::WebPEncoder;
use image::{DynamicImage, ImageFormat, Rgba32FImage};

use super::encode::{quantise, to_bytes, to_bytes_with_alpha};
use super::partial::Partial;
use super::{OutputError, PictureFormat};

/// Writes a picture to a file, replacing an existing one.
///
/// `encoding` is the camera's. In a PNG, a picture drawn in floating point is clamped to [0, 1] and encoded with it;
/// a picture in bytes is encoded already; likewise in a JPEG and a WebP, which take sRGB for granted. A PNG of sRGB
/// values is tagged (`sRGB`, `gAMA` and `cHRM` chunks); raw values are not, since they are meant to be displayed as they
/// are. In an EXR the intensities are stored unchanged.
///
/// A picture that is not opaque everywhere has a fourth channel: in a PNG and a WebP beside the colours as they are
/// (straight alpha), in an EXR with colours that are multiplied by it (associated alpha), as these formats have it.
///
/// # Errors
/// [`OutputError::TooCoarse`] for a byte picture in a format of more bits, [`OutputError::Empty`] for one without
/// pixels, [`OutputError::NotOpaque`] for a JPEG of one that is not opaque, and any error of the system or the encoder. An existing file is then unchanged.
pub fn write_picture(
    picture: &Picture,
    file: &Path,
    format: PictureFormat,
    encoding: Encoding,
) -> Result<(), OutputError> {
    // Refused before a file is made.
    check(picture, file, format)?;
    let (partial, mut writer) = Partial::create(file)?;
    encode_picture(picture, &mut writer, file, format, encoding)?;
    drop(writer);
    partial.keep()
}

/// Writes a picture to a stream, such as standard output; `name` is what errors call it. See [`write_picture`].
///
/// ```
/// use std::path::Path;
/// use halfway_lighting::Encoding;
/// use halfway_record::output::{PictureFormat, encode_picture};
/// use halfway_render::Picture;
///
/// let mut bytes = Vec::new();
/// let picture = Picture::Byte(image::RgbaImage::new(4, 3));
/// encode_picture(&picture, &mut bytes, Path::new("memory"), PictureFormat::Png8, Encoding::Srgb)?;
/// assert!(bytes.starts_with(b"\x89PNG"));
/// # Ok::<(), halfway_record::output::OutputError>(())
/// ```
///
/// # Errors
/// As [`write_picture`].
pub fn encode_picture(
    picture: &Picture,
    writer: &mut impl Write,
    name: &Path,
    format: PictureFormat,
    encoding: Encoding,
) -> Result<(), OutputError> {
    check(picture, name, format)?;
    match (format, picture) {
        (PictureFormat::Png8, _) if is_opaque(picture) => {
            let bytes = to_bytes(picture, encoding);
            write_png(writer, name, (picture, png::BitDepth::Eight), encoding, bytes.as_raw())?;
        }
        (PictureFormat::Png8, _) => {
            let bytes = to_bytes_with_alpha(picture, encoding);
            write_png(writer, name, (picture, png::BitDepth::Eight), encoding, bytes.as_raw())?;
        }
        (PictureFormat::Png16, Picture::Float(image)) => {
            let bytes = sixteen_bits(image, encoding, is_opaque(picture));
            write_png(writer, name, (picture, png::BitDepth::Sixteen), encoding, &bytes)?;
        }
        (PictureFormat::Jpeg, _) => {
            let encoder = JpegEncoder::new_with_quality(&mut *writer, QUALITY);
            let written = to_bytes(picture, encoding).write_with_encoder(encoder);
            written.map_err(|error| OutputError::image(name, error))?;
        }
        (PictureFormat::WebP, _) => {
            let encoder = WebPEncoder::new_lossless(&mut *writer);
            let written = if is_opaque(picture) {
                to_bytes(picture, encoding).write_with_encoder(encoder)
            } else {
                to_bytes_with_alpha(picture, encoding).write_with_encoder(encoder)
            };
            written.map_err(|error| OutputError::image(name, error))?;
        }
        (PictureFormat::Exr, Picture::Float(image)) => {
            let image = if is_opaque(picture) {
                DynamicImage::from(DynamicImage::ImageRgba32F(image.clone()).into_rgb32f())
            } else {
                associated(image.clone())
            };
            // The encoder goes back to its beginning, which a stream cannot.
            let mut bytes = Cursor::new(Vec::new());
            image.write_to(&mut bytes, ImageFormat::OpenExr).map_err(|error| OutputError::image(name, error))?;
            writer.write_all(bytes.get_ref()).map_err(|source| OutputError::io(name, source))?;
        }
        // Refused by the check.
        (PictureFormat::Png16 | PictureFormat::Exr, Picture::Byte(_)) => {}
    }
    writer.flush().map_err(|source| OutputError::io(name, source))
}

/// The quality of a JPEG, of 100.
const QUALITY: u8 = 90;

/// The longest side of a JPEG and of a WebP, in pixels.
const LONGEST_JPEG: u32 = 65_535;
const LONGEST_WEBP: u32 = 16_384;

fn check(picture: &Picture, file: &Path, format: PictureFormat) -> Result<(), OutputError> {
    let (width, height) = picture.dimensions();
    not_empty(file, (width, height))?;
    if format.pixels() == Pixels::Float && matches!(picture, Picture::Byte(_)) {
        return Err(OutputError::TooCoarse { file: file.to_owned() });
    }
    if format == PictureFormat::Jpeg && !is_opaque(picture) {
        let expected = ".png, .webp or .exr, or an opaque background";
        return Err(OutputError::NotOpaque { file: file.to_owned(), format: "a JPEG", expected });
    }
    let longest = match format {
        PictureFormat::Jpeg => LONGEST_JPEG,
        PictureFormat::WebP => LONGEST_WEBP,
        _ => u32::MAX,
    };
    if width.max(height) > longest {
        let message = format!("{width} × {height} pixels; expected sides of at most {longest}");
        return Err(OutputError::Encode { file: file.to_owned(), message });
    }
    Ok(())
}

/// Writes a picture by the ending of a file's name.
pub trait SavePicture {
    /// Writes the picture to `file`, replacing one that is there: `.png` gets 8 bits a channel, `.exr` 32-bit floats;
    /// `.jpg` and `.webp` are written, too.
    ///
    /// A PNG is sRGB, as a camera draws by default; a picture drawn under [`Encoding::Raw`], and a PNG of 16 bits, take
    /// [`write_picture`]. An EXR takes a picture drawn in floating point: insert
    /// [`Headless`](halfway_render::Headless) with [`Pixels::Float`](halfway_render::Pixels::Float) before the frame.
    ///
    /// ```
    /// use halfway_record::output::{OutputError, SavePicture};
    /// use halfway_render::Picture;
    ///
    /// let picture = Picture::Byte(image::RgbaImage::new(4, 3));
    /// let file = std::env::temp_dir().join("halfway_save_picture.png");
    /// picture.save(&file)?;
    /// assert_eq!(image::image_dimensions(&file).unwrap(), (4, 3));
    /// # std::fs::remove_file(&file).unwrap();
    ///
    /// let error = picture.save("teapot.bmp").unwrap_err();
    /// assert!(error.to_string().contains("expected a file that ends in .png, .jpg, .jpeg, .webp or .exr"));
    /// # Ok::<(), OutputError>(())
    /// ```
    ///
    /// # Errors
    /// [`OutputError::UnknownEnding`] for any other ending, [`OutputError::TooCoarse`] for an EXR of a byte picture, and
    /// those of [`write_picture`].
    fn save(&self, file: impl AsRef<Path>) -> Result<(), OutputError>;
}

impl SavePicture for Picture {
    fn save(&self, file: impl AsRef<Path>) -> Result<(), OutputError> {
        let file = file.as_ref();
        write_picture(self, file, PictureFormat::from_path(file, None)?, Encoding::Srgb)
    }
}

/// Whether nothing lies behind the picture: then it has three channels in a file, else four.
pub(super) fn is_opaque(picture: &Picture) -> bool {
    match picture {
        Picture::Byte(image) => image.pixels().all(|pixel| pixel.0[3] == 255),
        Picture::Float(image) => image.pixels().all(|pixel| pixel.0[3] >= 1.0),
    }
}

/// Channels of 16 bits, the high byte first as PNG has them.
fn sixteen_bits(image: &Rgba32FImage, encoding: Encoding, is_opaque: bool) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(image.as_raw().len() * 2);
    for pixel in image.pixels() {
        for &intensity in &pixel.0[..3] {
            bytes.extend(quantise(intensity, encoding, u16::MAX).to_be_bytes());
        }
        if !is_opaque {
            bytes.extend(quantise(pixel.0[3], Encoding::Raw, u16::MAX).to_be_bytes());
        }
    }
    bytes
}

fn write_png(
    writer: &mut impl Write,
    name: &Path,
    (picture, depth): (&Picture, png::BitDepth),
    encoding: Encoding,
    data: &[u8],
) -> Result<(), OutputError> {
    let (width, height) = picture.dimensions();
    let mut encoder = png_encoder(writer, width, height, depth, encoding);
    if !is_opaque(picture) {
        encoder.set_color(png::ColorType::Rgba);
    }
    encoder
        .write_header()
        .and_then(|mut writer| {
            writer.write_image_data(data)?;
            writer.finish()
        })
        .map_err(|error| OutputError::png(name, error))
}

/// An encoder for pictures of three channels, with the chunks that tag the encoding of the values.
pub(super) fn png_encoder<W: Write>(
    writer: W,
    width: u32,
    height: u32,
    depth: png::BitDepth,
    encoding: Encoding,
) -> png::Encoder<'static, W> {
    let mut encoder = png::Encoder::new(writer, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(depth);
    encoder.validate_sequence(true);
    if encoding == Encoding::Srgb {
        tagged(&mut encoder);
    }
    encoder
}

/// Tags a picture as sRGB.
pub(super) fn tagged<W: Write>(encoder: &mut png::Encoder<'_, W>) {
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    // For readers that do not know the sRGB chunk: the values that the PNG specification gives for it.
    encoder.set_source_gamma(png::ScaledFloat::from_scaled(45_455));
    let scaled = |x: u32, y: u32| (png::ScaledFloat::from_scaled(x), png::ScaledFloat::from_scaled(y));
    encoder.set_source_chromaticities(png::SourceChromaticities {
        white: scaled(31_270, 32_900),
        red: scaled(64_000, 33_000),
        green: scaled(30_000, 60_000),
        blue: scaled(15_000, 6_000),
    });
}

/// The colours times the opacity, as an EXR has them.
fn associated(mut image: Rgba32FImage) -> DynamicImage {
    for pixel in image.pixels_mut() {
        let [red, green, blue, alpha] = pixel.0;
        pixel.0 = [red * alpha, green * alpha, blue * alpha, alpha];
    }
    DynamicImage::from(image)
}

pub(super) fn not_empty(file: &Path, (width, height): (u32, u32)) -> Result<(), OutputError> {
    if width == 0 || height == 0 {
        return Err(OutputError::Empty { file: file.to_owned(), width, height });
    }
    Ok(())
}
