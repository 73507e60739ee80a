//! The lights of a scene in a tree, and those that a patch of surface needs.

mod select;
mod tree;

pub use select::Selected;
pub use tree::LightTree;
