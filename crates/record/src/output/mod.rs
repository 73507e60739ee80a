//! Pictures on disk: PNG with 8 or 16 bits, JPEG, WebP, EXR in floating point, animated PNG, and contact sheets.
//!
//! Every file is written beside its place under another name and moved there when it is complete, so that an
//! interrupted run leaves no partial picture. Opaque pictures have three channels, others four; the top row comes first.
//!
//! ```
//! use halfway_lighting::Encoding;
//! use halfway_record::output::{PictureFormat, write_picture};
//! use halfway_render::Picture;
//!
//! // In 16 bits, a picture drawn in floating point.
//! let picture = Picture::Float(image::Rgba32FImage::from_pixel(2, 2, image::Rgba([0.5, 0.25, 2.0, 1.0])));
//! let file = std::env::temp_dir().join(format!("gray_{}.png", std::process::id()));
//! write_picture(&picture, &file, PictureFormat::from_path(&file, Some(16))?, Encoding::Srgb)?;
//! assert!(file.exists());
//! # std::fs::remove_file(file).unwrap();
//! # Ok::<(), halfway_record::output::OutputError>(())
//! ```

mod animation;
mod contact_sheet;
mod encode;
mod error;
mod format;
mod partial;
mod picture;
mod quantities;

pub use animation::{AnimationWriter, FrameDelay};
pub use contact_sheet::ContactSheet;
pub use encode::to_bytes;
pub use error::OutputError;
pub use format::PictureFormat;
pub use partial::{write_bytes, write_text};
pub use picture::{SavePicture, encode_picture, write_picture};
pub use quantities::{check_quantity_file, write_quantities};

#[cfg(test)]
mod tests;
