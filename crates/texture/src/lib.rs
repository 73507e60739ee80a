#![doc = include_str!("../README.md")]
// Powers and logarithms are computed only by libm: see clippy.toml.
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
mod reduced;
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
