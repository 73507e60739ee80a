//! Visible objects become sorted, instanced draws.

pub(crate) mod batches;
pub(crate) mod draws;
pub(crate) mod object;
pub(crate) mod table;
pub(crate) mod terms;
