//! Metrics of the difference between two pictures.
//!
//! [`compare`] measures two pictures pixel by pixel, in linear intensity and in the 256 steps of an 8-bit picture;
//! [`flip()`] measures the difference that a viewer would notice. [`judge`] measures a rendered picture against the
//! oracle, separating the pixels where edges leave the renderer a choice. [`difference`] draws the errors, and
//! [`report_failure`] writes the pictures of a failing test.
//!
//! ```
//! use halfway_lighting::Encoding;
//! use halfway_reference::{Image, metrics};
//!
//! let expected = Image::new(2, 1, vec![[0.5; 3], [0.25; 3]]);
//! let actual = Image::new(2, 1, vec![[0.5; 3], [0.25, 0.25, 0.27]]);
//! let comparison = metrics::compare(&actual, &expected, Encoding::Raw)?;
//! let worst = comparison.steps.all.worst.expect("there are pixels");
//! assert_eq!((worst.at, worst.channel, worst.error()), ((1, 0), 2, 5.0));
//! println!("{comparison}\n\n{}", comparison.table());
//! # Ok::<(), metrics::SizeMismatch>(())
//! ```

mod bands;
mod canvas;
mod comparison;
mod coverage;
mod difference;
mod flip;
mod judge;
mod legend;
mod ranks;
mod report;
mod scale;
mod statistics;
mod table;

pub use bands::{PictureRows, SizeMismatch};
pub use canvas::{text_height, text_scale, write_text};
pub use comparison::{Comparison, Difference, NotFinite, compare};
pub use coverage::Coverage;
pub use difference::difference;
pub use flip::{Flip, PIXELS_PER_DEGREE, flip, flip_of_covered};
pub use judge::{Bars, Measure, Verdict, judge, judge_on_grid};
pub use ranks::PERCENTILES;
pub use report::report_failure;
pub use scale::{Scale, Unit};
pub use statistics::{Errors, Statistics, Worst};
pub use table::Table;
