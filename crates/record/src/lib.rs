#![doc = include_str!("../README.md")]

mod oracle_quantities;
pub mod output;
mod recording;
mod reference;

pub use recording::{Continue, FrameToDraw, HeadlessPlugin, RecordError, Recording, parse_size, record, record_with};
pub use reference::ReferenceDrawing;
