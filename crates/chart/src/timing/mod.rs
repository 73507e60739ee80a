//! How a frame is timed, and what was found out about the machine that drew it.
//!
//! Times are those of a [`frame`], [in turns](in_turns) with what they are compared with, once all has
//! [settled](settle).

mod look;
mod machine;
mod turns;

pub use look::TimedLook;
pub use machine::{Machine, counters};
pub use turns::{FRAME_TIME, Spread, frame, in_turns, in_turns_with, median, median_ratio, ratios, settle};
