//! Faults of a pass.

use thiserror::Error;

/// The longest side of a picture, in pixels.
pub const LARGEST_SIDE: u32 = 16_384;

/// Why nothing was drawn.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum RasterError {
    /// A side of the picture is 0 or longer than [`LARGEST_SIDE`].
    #[error("a picture of {width} × {height} pixels: each side must be 1 to {LARGEST_SIDE}")]
    Size {
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The memory to draw into has another length than the picture.
    #[error("the output holds {found} values, but a picture of {width} × {height} pixels has {expected}")]
    Output {
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// How many values it must hold.
        expected: usize,
        /// How many it holds.
        found: usize,
    },
    /// The system refuses the memory that drawing takes.
    #[error("{bytes} bytes of memory for {what} were refused")]
    Memory {
        /// The purpose of the memory.
        what: &'static str,
        /// How much was asked for.
        bytes: u64,
    },
    /// A number is NaN, infinite or out of its range.
    #[error("{what} {index}: {field} is {value}, expected {expected}")]
    Number {
        /// The list or struct that holds it.
        what: &'static str,
        /// Which element.
        index: usize,
        /// Which field.
        field: &'static str,
        /// Its value.
        value: f64,
        /// The expected value.
        expected: &'static str,
    },
    /// An index or range reaches beyond what it indexes.
    #[error("{what} {index}: {field} reaches to {reaches}, but there are {available}")]
    Reference {
        /// The list that holds the index.
        what: &'static str,
        /// Which element.
        index: usize,
        /// Which field.
        field: &'static str,
        /// The end of the range, or one more than the index.
        reaches: u64,
        /// How many there are.
        available: u64,
    },
    /// A range of indices does not begin and end at cuts of the mesh.
    #[error("draw {draw}: indices {start}..{end} do not begin and end where the mesh was cut")]
    Cut {
        /// Which draw.
        draw: usize,
        /// First index.
        start: u32,
        /// One more than the last.
        end: u32,
    },
    /// The memory of a finished picture has another length or format than that of what was drawn.
    #[error("the finished picture holds {found} values of its format, but {expected} were drawn, four a pixel")]
    Finish {
        /// How many were drawn.
        expected: usize,
        /// How many it holds.
        found: usize,
    },
    /// A policy makes no finished picture.
    #[error("no picture can be finished so: {reason}")]
    Policy {
        /// Its fault.
        reason: String,
    },
    /// A width was asked for that this CPU does not have, or whose name is unknown.
    #[error("this CPU cannot draw with {asked:?}; it has {available}")]
    Width {
        /// The name that was asked for.
        asked: String,
        /// The valid names, separated by commas.
        available: String,
    },
    /// The system refuses threads.
    #[error("{count} threads were refused: {reason}")]
    Threads {
        /// How many were asked for.
        count: usize,
        /// The system's message.
        reason: String,
    },
}
