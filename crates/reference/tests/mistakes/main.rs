//! Pictures with known mistakes, and what the marking says of them.

mod known;
mod right;
mod small;
mod task;
mod tasks;
