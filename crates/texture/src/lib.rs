//! Images as surfaces have them: in linear light, as pyramids of ever smaller ones, and looked up with filters.
//!
//! - [`TexelImage`]: four numbers a texel; [`decode`] and [`load`] make one of a PNG or JPEG file, within
//!   [limits](MOST_TEXELS) that are checked before memory is taken.
//! - [`Pyramid`]: an image of any size and its halves, down to one texel.
//! - [`Sampling`]: what is beyond the image ([`Wrap`]), which filter enlarges it and which reduces it ([`TexelFilter`],
//!   [`LevelFilter`]).
//! - [`lookup`]: the filters as functions, in `f32` or `f64`.
//! - [`environment`]: light from all directions: equirectangular, mirror-ball and cube maps.
//! - [`FootprintTruth`]: the mean over a pixel's footprint, integrated, which judges the filters.
//! - [`noise`]: gradient noise in space, and solids of it, faded with distance.
//! - [`solid`]: [`SolidTexture`], the component that cuts an object from such a solid.
//! - [`normals`]: normals of heights, and what their roughness makes of highlights from afar.
//! - [`UvTransform`]: where on the image a surface's coordinates lie.
//! - [`Texture`], [`Maps`]: the asset, and the component that puts some onto an object, one for each [`MapKind`].
//!
//! (u, v) = (0, 0) is the image's top left corner, (1, 1) its bottom right. Texel (i, j) of a w × h image has its
//! center at ((i + ½)/w, (j + ½)/h). No GPU, no window is touched; files only by [`load`].
//!
//! ```
//! use halfway_texture::{Pyramid, Sampling, TexelImage, lookup};
//!
//! let checker = TexelImage::from_fn(2, 2, |x, y| [[0.0; 4], [1.0; 4]][(x + y) as usize % 2])?;
//! let pyramid = Pyramid::new(checker);
//! // A footprint of half the image, in each direction: its mean.
//! let color = lookup::filtered(&pyramid, &Sampling::default(), [0.3_f64, 0.6], [[0.5, 0.0], [0.0, 1.0]]);
//! assert_eq!(color, [0.5; 4]);
//! # Ok::<(), halfway_texture::TextureError>(())
//! ```

// Powers and logarithms only by libm: see clippy.toml.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod decode;
pub mod environment;
mod error;
mod halves;
mod limits;
pub mod lookup;
mod maps;
mod moments;
pub mod noise;
pub mod normals;
mod pyramid;
mod ripmap;
mod sampling;
pub mod solid;
mod sums;
mod texels;
mod truth;
mod uv;

pub use decode::{TexelMeaning, decode, decode_stored, load};
pub use error::TextureError;
pub use halves::Level;
pub use limits::{LONGEST_SIDE, MOST_TEXELS};
pub use maps::{MapKind, Maps, SurfaceMap, Texture, TexturePlugin, UvSet, WrongMap};
pub use normals::FarNormals;
pub use pyramid::Pyramid;
pub use ripmap::Ripmap;
pub use sampling::{Channel, ImageForm, LevelFilter, Sampling, TexelFilter, Wrap};
pub use solid::{SolidKind, SolidTexture, WrongSolid};
pub use sums::SummedAreas;
pub use texels::TexelImage;
pub use truth::{FootprintTruth, PictureMap};
pub use uv::UvTransform;
