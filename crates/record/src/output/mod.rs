//! Pictures on disk: PNG with 8 or 16 bits, EXR in floating point, animated PNG, and contact sheets.
//!
//! Every file is written beside its place under another name and moved there when it is complete, so that an
//! interrupted run leaves no half picture. All pictures are opaque and have three channels; the top row comes first.
//!
//! ```no_run
//! use halfway_record::output::{PictureFormat, write_picture};
//! use halfway_lighting::Encoding;
//! use halfway_render::Picture;
//! # fn picture() -> Picture { unimplemented!() }
//! # fn main() -> Result<(), halfway_record::output::OutputError> {
//! let file = "teapot.png".as_ref();
//! let format = PictureFormat::of(file, Some(16))?;
//! let picture: Picture = picture(); // drawn with `format.pixels()`
//! write_picture(&picture, file, format, Encoding::Srgb)?;
//! # Ok(())
//! # }
//! ```

mod animation;
mod contact_sheet;
mod encode;
mod error;
mod format;
mod partial;
mod picture;

pub use animation::{AnimationWriter, FrameDelay};
pub use contact_sheet::ContactSheet;
pub use encode::to_bytes;
pub use error::OutputError;
pub use format::PictureFormat;
pub use partial::write_text;
pub use picture::{SavePicture, write_picture};

#[cfg(test)]
mod tests;
