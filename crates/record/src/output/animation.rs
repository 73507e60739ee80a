//! Animated PNG.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use halfway_lighting::Encoding;
use halfway_render::Picture;

use super::OutputError;
use super::encode::{to_bytes, to_bytes_with_alpha};
use super::format::ending;
use super::partial::Partial;
use super::picture::{is_opaque, not_empty, png_encoder};

/// The duration of a frame: `numerator / denominator` seconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameDelay {
    /// The numerator; 0 is as fast as the viewer can.
    pub numerator: u16,
    /// The denominator; 0 stands for 100.
    pub denominator: u16,
}

impl FrameDelay {
    /// The delay for a frame rate in frames a second; 0 is taken as 1.
    pub const fn per_second(frames: u16) -> Self {
        Self { numerator: 1, denominator: if frames == 0 { 1 } else { frames } }
    }
}

impl Default for FrameDelay {
    /// 30 frames a second.
    fn default() -> Self {
        Self::per_second(30)
    }
}

/// Writes an animated PNG of 8 bits a channel, frame by frame. Viewers that do not animate show the first frame. Where the
/// first frame is not opaque, the animation has a fourth channel.
///
/// The file appears when [`finish`](Self::finish) is called; a writer that is dropped before leaves no file.
///
/// ```
/// use halfway_lighting::Encoding;
/// use halfway_record::output::{AnimationWriter, FrameDelay};
/// use halfway_render::Picture;
///
/// let file = std::env::temp_dir().join(format!("blink_{}.png", std::process::id()));
/// let delay = FrameDelay::per_second(2);
/// let mut animation = AnimationWriter::create(&file, (4, 4), 2, delay, Encoding::Srgb)?;
/// for gray in [0, 255] {
///     animation.frame(&Picture::Byte(image::RgbaImage::from_pixel(4, 4, image::Rgba([gray, gray, gray, 255]))))?;
/// }
/// animation.finish()?;
/// assert!(file.exists());
/// # std::fs::remove_file(file).unwrap();
/// # Ok::<(), halfway_record::output::OutputError>(())
/// ```
pub struct AnimationWriter {
    // Dropped first, so that the file is closed before it is removed.
    writer: Writer,
    partial: Partial,
    size: (u32, u32),
    encoding: Encoding,
    written: u32,
    frames: u32,
}

/// The first frame decides about the channels, which stand at the beginning of the file.
enum Writer {
    Waiting(Option<Box<png::Encoder<'static, BufWriter<File>>>>),
    Begun { writer: png::Writer<BufWriter<File>>, has_alpha: bool },
}

impl AnimationWriter {
    /// Begins an animation of `frames` frames of `size` pixels (width, height), repeated without end.
    ///
    /// # Errors
    /// The file does not end in `.png` or `.apng`, the size or the number of frames is 0, or the file cannot be made.
    pub fn create(
        file: &Path,
        size: (u32, u32),
        frames: u32,
        delay: FrameDelay,
        encoding: Encoding,
    ) -> Result<Self, OutputError> {
        Self::check(file)?;
        not_empty(file, size)?;
        if frames == 0 {
            return Err(OutputError::FrameCount { file: file.to_owned(), found: 0, expected: 0 });
        }
        let (partial, file_writer) = Partial::create(file)?;
        let mut encoder = png_encoder(file_writer, size.0, size.1, png::BitDepth::Eight, encoding);
        encoder
            .set_animated(frames, 0)
            .and_then(|()| encoder.set_frame_delay(delay.numerator, delay.denominator))
            .map_err(|error| OutputError::png(file, error))?;
        Ok(Self { writer: Writer::Waiting(Some(Box::new(encoder))), partial, size, encoding, written: 0, frames })
    }

    /// Checks that a file of this name can hold an animation.
    ///
    /// # Errors
    /// [`OutputError::UnknownEnding`] where it does not end in `.png` or `.apng`.
    pub fn check(file: &Path) -> Result<(), OutputError> {
        match ending(file).as_str() {
            "png" | "apng" => Ok(()),
            _ => Err(OutputError::UnknownEnding { file: file.to_owned(), known: ".png or .apng" }),
        }
    }

    /// Adds the next frame. A picture in floating point is clamped and encoded.
    ///
    /// # Errors
    /// The frame has another size than the animation, there are more frames than announced, it is not opaque where the
    /// first one was, or it cannot be written.
    pub fn frame(&mut self, picture: &Picture) -> Result<(), OutputError> {
        let (found_width, found_height) = picture.dimensions();
        let (width, height) = self.size;
        let file = self.partial.file();
        if (found_width, found_height) != (width, height) {
            let (file, frame) = (file.to_owned(), self.written);
            return Err(OutputError::FrameSize { file, frame, found_width, found_height, width, height });
        }
        if self.written == self.frames {
            let (file, found) = (file.to_owned(), self.frames.saturating_add(1));
            return Err(OutputError::FrameCount { file, found, expected: self.frames });
        }
        let is_opaque = is_opaque(picture);
        if let Writer::Waiting(encoder) = &mut self.writer
            && let Some(mut encoder) = encoder.take()
        {
            if !is_opaque {
                encoder.set_color(png::ColorType::Rgba);
            }
            let writer = encoder.write_header().map_err(|error| OutputError::png(file, error))?;
            self.writer = Writer::Begun { writer, has_alpha: !is_opaque };
        }
        // Its beginning could not be written, which was said then.
        let Writer::Begun { writer, has_alpha } = &mut self.writer else { return Ok(()) };
        let written = if *has_alpha {
            writer.write_image_data(to_bytes_with_alpha(picture, self.encoding).as_raw())
        } else if is_opaque {
            writer.write_image_data(to_bytes(picture, self.encoding).as_raw())
        } else {
            let (format, expected) =
                ("an animated PNG whose first frame is opaque", "opaque frames, or a first one that is not");
            return Err(OutputError::NotOpaque { file: file.to_owned(), format, expected });
        };
        written.map_err(|error| OutputError::png(file, error))?;
        self.written += 1;
        Ok(())
    }

    /// Ends the animation and moves the file to its place.
    ///
    /// # Errors
    /// Frames are missing, or the file cannot be written.
    pub fn finish(self) -> Result<(), OutputError> {
        let Self { writer, partial, written, frames, .. } = self;
        if written != frames {
            let file = partial.file().to_owned();
            return Err(OutputError::FrameCount { file, found: written, expected: frames });
        }
        if let Writer::Begun { writer, .. } = writer {
            writer.finish().map_err(|error| OutputError::png(partial.file(), error))?;
        }
        partial.keep()
    }
}
