//! Pictures with known mistakes, and what the marking says of them.

mod known;
mod pairs;
mod right;
mod small;
mod task;
mod tasks;
mod unlisted;
