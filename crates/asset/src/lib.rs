#![doc = include_str!("../README.md")]

mod assets;
mod handle;

pub use assets::{AssetGone, Assets, add_assets};
pub use handle::{AssetId, Handle};
