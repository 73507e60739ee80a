//! Pictures on disk: what an App draws without a window, as files.
//!
//! [`record`] runs an App frame by frame and writes its frames: one picture, a numbered sequence, or an animated PNG;
//! [`Recording`] says which frames, and is a plugin that does it as the App's runner. [`ReferenceDrawing`] draws the
//! frames by the oracle instead. [`output`] writes single pictures.

pub mod output;
mod recording;
mod reference;

pub use recording::{Continue, FrameToDraw, HeadlessPlugin, RecordError, Recording, parse_size, record, record_with};
pub use reference::ReferenceDrawing;
