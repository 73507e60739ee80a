#![doc = include_str!("../README.md")]

mod document;
mod error;
mod files;
mod handles;
mod keys;
mod live;
mod paint;
mod panels;
mod pictures;
mod projected;
mod settings;
mod split;
mod times;
mod viewer;

pub use document::Document;
pub use error::ViewerError;
pub use viewer::SceneViewer;
