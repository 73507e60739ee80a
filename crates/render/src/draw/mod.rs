//! Draws go to the GPU: what they read is uploaded, and the pass is encoded, submitted and presented.

pub(crate) mod pass;
pub(crate) mod upload;
