//! Decodes image files into texels in linear light.

use std::fs::File;
use std::io::{BufRead, Cursor, Read, Seek, SeekFrom};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, ImageResult, Limits};

use crate::error::TextureError;
use crate::limits::MOST_DECODED;
use crate::reduced::{reduced, reduced_size};
use crate::texels::{TexelImage, check_finite};

/// The meaning of an image's values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TexelMeaning {
    /// A color: red, green and blue are encoded by the sRGB curve and decoded here; alpha is linear.
    #[default]
    Color,
    /// Data, such as normals: all values are used as they are.
    Data,
}

/// The longest file that is read, in bytes.
const LONGEST_FILE: u64 = 1 << 28;

/// Reads an image file in one of the formats of [`decode`].
///
/// ```
/// use std::path::Path;
/// use halfway_texture::{TexelMeaning, TextureError, load};
///
/// let error = load(Path::new("missing.png"), TexelMeaning::Color).unwrap_err();
/// assert!(matches!(error, TextureError::Read { .. }));
/// ```
///
/// # Errors
/// The file cannot be read, is too long or not a regular file, or [`decode`] refuses it.
pub fn load(path: &Path, meaning: TexelMeaning) -> Result<TexelImage, TextureError> {
    let image = || path.display().to_string();
    let read = |reason: std::io::Error| TextureError::Read { image: image(), reason: reason.to_string() };
    // Checked before it is opened: opening a pipe waits for its other end.
    if !std::fs::metadata(path).map_err(read)?.is_file() {
        return Err(TextureError::NotAFile { image: image() });
    }
    let mut bytes = Vec::new();
    File::open(path).map_err(read)?.take(LONGEST_FILE + 1).read_to_end(&mut bytes).map_err(read)?;
    if bytes.len() as u64 > LONGEST_FILE {
        return Err(TextureError::TooLong { image: image(), limit: LONGEST_FILE });
    }
    decode(&bytes, &image(), meaning)
}

/// Decodes the bytes of an image file: PNG, JPEG, WebP, BMP, TIFF, GIF, Radiance HDR or EXR, told apart by their first
/// bytes, or TGA, told by the mark at its end or by the end of `name`. Error messages call the image `name`. Of an
/// animation the first frame is read.
///
/// Grey becomes equal red, green and blue; without an alpha channel alpha is 1; palettes and CMYK are converted to
/// RGB. Values of 8 and 16 bits are divided by 255 and 65535; floats, which HDR, EXR and some TIFF files hold, are linear
/// already and are used as they are, whatever the `meaning`.
///
/// An image above [`LONGEST_SIDE`] or [`MOST_TEXELS`] is scaled down to them: [`TexelImage::reduction`] says so.
///
/// [`LONGEST_SIDE`]: crate::LONGEST_SIDE
/// [`MOST_TEXELS`]: crate::MOST_TEXELS
///
/// ```
/// use halfway_texture::{TexelMeaning, decode};
///
/// let error = decode(b"not an image", "bricks.png", TexelMeaning::Color).unwrap_err();
/// assert!(error.to_string().starts_with("bricks.png: "));
/// ```
///
/// # Errors
/// Bytes in none of these formats, NaN or an infinite number in a texel, an image that is broken, empty or of more than
/// 1 GiB when decoded, or an allocation that fails. The size is checked before memory is allocated.
pub fn decode(bytes: &[u8], name: &str, meaning: TexelMeaning) -> Result<TexelImage, TextureError> {
    let mut file = Cursor::new(bytes);
    if guessed(&mut file, name)? == Some(ImageFormat::Jpeg) && !has_end_of_jpeg(bytes) {
        // The decoder would fill the rest with gray.
        return Err(broken(name, "the file ends before the picture does"));
    }
    let decoder = opened(file, name, Limits::default())?;
    let size = decoder.dimensions();
    check_decoded(name, size, decoder.total_bytes())?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(decoder.total_bytes().saturating_mul(2).saturating_add(1 << 24));
    let image = finished(decoder, name, limits)?;
    match reduced_size(size) {
        Some(smaller) => reduced(&image, smaller, |strip, first| texels(strip, first, name, meaning)),
        None => Ok(TexelImage::checked(size.0, size.1, texels(&image, 0, name, meaning)?)),
    }
}

/// Checks the size that a file states.
fn check_decoded(name: &str, (width, height): (u32, u32), bytes: u64) -> Result<(), TextureError> {
    let image = || name.to_owned();
    if width == 0 || height == 0 {
        return Err(TextureError::Empty { image: image(), width, height });
    }
    if bytes > MOST_DECODED {
        return Err(TextureError::TooLargeDecoded { image: image(), width, height, bytes });
    }
    Ok(())
}

/// The values of an image, or of some rows of it from the `first` on, in linear light.
fn texels(image: &DynamicImage, first: u32, name: &str, meaning: TexelMeaning) -> Result<Vec<[f32; 4]>, TextureError> {
    let count = image.width() as usize * image.height() as usize;
    let mut texels = Vec::new();
    let refused = |_| TextureError::Memory { image: name.into(), bytes: 16 * count as u64 };
    texels.try_reserve_exact(count).map_err(refused)?;
    if matches!(image, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_)) {
        texels.extend(image.to_rgba32f().pixels().map(|pixel| pixel.0));
        check_finite(&texels, image.width()).map_err(|error| error.named(name, first))?;
        return Ok(texels);
    }
    let color = meaning == TexelMeaning::Color;
    if image.color().bytes_per_pixel() / image.color().channel_count() > 1 {
        let linear = |value: u16| f64::from(value) / 65535.0;
        let curved = |value: u16| if color { srgb_decoded(linear(value)) } else { linear(value) };
        texels.extend(image.to_rgba16().pixels().map(|pixel| {
            let [r, g, b, a] = pixel.0;
            [curved(r) as f32, curved(g) as f32, curved(b) as f32, linear(a) as f32]
        }));
    } else {
        let linear: [f32; 256] = std::array::from_fn(|value| (value as f64 / 255.0) as f32);
        let table: [f32; 256] = std::array::from_fn(|value| srgb_decoded(value as f64 / 255.0) as f32);
        let curved = |value: u8| if color { table[usize::from(value)] } else { linear[usize::from(value)] };
        texels.extend(image.to_rgba8().pixels().map(|pixel| {
            let [r, g, b, a] = pixel.0;
            [curved(r), curved(g), curved(b), linear[usize::from(a)]]
        }));
    }
    Ok(texels)
}

/// The values of a file as they are stored: for pictures to compare, not for surfaces. Error messages call the file
/// `name`.
///
/// # Errors
/// Bytes that are not an image, a broken one, or one beyond the `limits`; or an allocation that fails. The size is
/// checked before memory is allocated.
pub fn decode_stored(file: impl BufRead + Seek, name: &str, mut limits: Limits) -> Result<DynamicImage, TextureError> {
    let decoder = opened(file, name, limits.clone())?;
    limits.reserve(decoder.total_bytes()).map_err(|error| broken(name, error))?;
    finished(decoder, name, limits)
}

fn broken(name: &str, reason: impl ToString) -> TextureError {
    TextureError::Decode { image: name.into(), reason: reason.to_string() }
}

/// The format by the first bytes, or for TGA, which has no mark there, by the last ones or the name; the file is rewound.
fn guessed(mut file: impl BufRead + Seek, name: &str) -> Result<Option<ImageFormat>, TextureError> {
    let format = ImageReader::new(&mut file).with_guessed_format().map(|reader| reader.format());
    let format = format.map(|format| format.or_else(|| is_tga(&mut file, name).then_some(ImageFormat::Tga)));
    format.and_then(|format| file.rewind().map(|()| format)).map_err(|error| broken(name, error))
}

/// Whether a file is a TGA by its footer (Truevision TGA 2.0), which older files lack, or by its name.
fn is_tga(mut file: impl BufRead + Seek, name: &str) -> bool {
    const FOOTER: &[u8; 18] = b"TRUEVISION-XFILE.\0";
    let mut last = [0; FOOTER.len()];
    let has_footer = file.seek(SeekFrom::End(-(FOOTER.len() as i64))).is_ok() && file.read_exact(&mut last).is_ok();
    let is_named = Path::new(name).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("tga"));
    has_footer && last == *FOOTER || is_named
}

/// The decoder of a file, which has read the image's header.
fn opened<'a>(
    mut file: impl BufRead + Seek + 'a,
    name: &str,
    limits: Limits,
) -> Result<impl ImageDecoder + 'a, TextureError> {
    let format = guessed(&mut file, name)?;
    if format == Some(ImageFormat::Png) && !has_whole_palette(&mut file) {
        // The decoder would panic.
        return Err(broken(name, "its palette ends within a color"));
    }
    guarded(name, || {
        let mut reader = ImageReader::new(file);
        match format {
            Some(format) => reader.set_format(format),
            // For the error that it has then.
            None => reader = reader.with_guessed_format()?,
        }
        reader.limits(limits);
        reader.into_decoder()
    })
}

/// Decodes the image after reserving its memory.
fn finished(mut decoder: impl ImageDecoder, name: &str, limits: Limits) -> Result<DynamicImage, TextureError> {
    // The decoder allocates its memory at once, and a failed allocation would abort the program.
    let bytes = decoder.total_bytes();
    Vec::<u8>::new()
        .try_reserve_exact(bytes as usize)
        .map_err(|_| TextureError::Memory { image: name.into(), bytes })?;
    guarded(name, || {
        decoder.set_limits(limits)?;
        DynamicImage::from_decoder(decoder)
    })
}

/// Runs a decoder and turns its panics into errors. Fuzzing found files on which decoders panic.
fn guarded<T>(name: &str, decode: impl FnOnce() -> ImageResult<T>) -> Result<T, TextureError> {
    let given = catch_unwind(AssertUnwindSafe(decode));
    given.map_err(|_| broken(name, "its decoder cannot make sense of it"))?.map_err(|error| broken(name, error))
}

/// Whether a JPEG file has an end marker, EOI, where one may stand (ITU-T T.81, B.1): not within a segment, such as
/// that of a preview with an end of its own.
fn has_end_of_jpeg(bytes: &[u8]) -> bool {
    let mut at = 2;
    while at + 1 < bytes.len() {
        match (bytes[at], bytes[at + 1]) {
            (0xFF, 0xD9) => return true,
            // An escaped 0xFF in a scan, a restart, or a fill byte before a marker.
            (0xFF, 0x00 | 0x01 | 0xD0..=0xD8) => at += 2,
            (0xFF, 0xFF) => at += 1,
            (0xFF, _) => {
                let Some(&[high, low]) = bytes.get(at + 2..at + 4) else { return false };
                at += 2 + usize::from(u16::from_be_bytes([high, low]));
            }
            _ => at += 1,
        }
    }
    false
}

/// Whether every palette of a PNG file has three bytes a color (PNG Specification, 11.2.2): chunk after chunk, each the
/// length of its data, a name, the data and a checksum.
fn has_whole_palette(mut file: impl BufRead + Seek) -> bool {
    let mut at = 8;
    let mut chunk = [0; 8];
    while file.seek(SeekFrom::Start(at)).is_ok() && file.read_exact(&mut chunk).is_ok() {
        let [a, b, c, d, ref name @ ..] = chunk;
        let length = u32::from_be_bytes([a, b, c, d]);
        if name == b"PLTE" && !length.is_multiple_of(3) {
            return false;
        }
        at += 12 + u64::from(length);
    }
    file.rewind().is_ok()
}

/// Decodes a value by the sRGB curve (IEC 61966-2-1).
fn srgb_decoded(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}
