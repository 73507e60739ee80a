//! What a frame did, counted; and what it could not do.

use crate::error::RenderError;
use bevy_ecs::prelude::Resource;

/// Counters and errors of the newest frame. Counts are exact, so they can be tested.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct FrameReport {
    /// Everything that kept the frame from being drawn as asked, in the order found. What an error
    /// names is left out of the picture; nothing is left out without one.
    pub errors: Vec<RenderError>,
    /// Objects with a mesh.
    pub objects: u32,
    /// Objects whose bounding sphere meets the view frustum.
    pub visible: u32,
    /// Lights that shone.
    pub lights: u32,
    /// Draw calls.
    pub draws: u32,
    /// Triangles in those draw calls, before culling of faces.
    pub triangles: u64,
    /// Model-view and normal matrices computed; 0 where nothing moved.
    pub matrices: u32,
    /// Distinct materials (front and back together) in the picture.
    pub materials: u32,
    /// Bytes sent to the GPU: meshes, instances, materials and lights. 0 for a frame equal to the last.
    pub bytes_uploaded: u64,
    /// Pipelines built since the start; each is one specialised shader variant.
    pub pipelines: u32,
}

impl FrameReport {
    /// Starts a frame: everything but the pipelines, which live on, is zeroed.
    pub(crate) fn begin(&mut self) {
        *self = Self { pipelines: self.pipelines, ..Self::default() };
    }
}
