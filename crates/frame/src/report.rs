//! The counters and the errors of a frame.

use crate::error::RenderError;
use crate::phases::Pass;
use bevy_ecs::prelude::Resource;

/// Counters and errors of the newest frame. Counts are exact, so they can be tested. Of several cameras in one picture
/// they are sums, so that an object which two of them see counts twice.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct FrameReport {
    /// Everything that kept the frame from being drawn as requested, in the order found. The subject of each error is
    /// omitted from the picture, and nothing is omitted without an error but [`passes_refused`](Self::passes_refused).
    /// A failure outside the frames is reported here too, once, though nothing is omitted for it: that of a pipeline
    /// that a frame can do without.
    pub errors: Vec<RenderError>,
    /// Objects with a mesh that are not [hidden](halfway_lighting::Visibility).
    pub objects: u32,
    /// Objects whose bounding sphere meets the view frustum.
    pub visible: u32,
    /// Lights that shone: neither hidden nor refused.
    pub lights: u32,
    /// Meshes whose [levels of detail](halfway_lighting::Tolerance::pixels) are still being made; they are drawn in full.
    pub levels_pending: u32,
    /// Triangles of the visible objects' meshes, as modelled.
    pub triangles_in: u64,
    /// Patches of the visible meshes that are cut into several.
    pub patches: u32,
    /// Patches among them that are outside of the frustum or show only sides that are not drawn.
    pub patches_culled: u32,
    /// Diffuse and specular terms in the light lists, summed over objects and patches; 0 where all lights of the scene
    /// are compiled in.
    pub lights_assigned: u64,
    /// Pairs of a patch and a light whose bounds were evaluated for those lists. Lights that are out of reach of the
    /// patches around are in none.
    pub light_pairs: u64,
    /// The most that the terms left out of the lists could have added anywhere, in linear intensity; 0 where none was.
    pub left_out: f64,
    /// Draw commands.
    pub draws: u32,
    /// Triangles in those draws, before culling of faces.
    pub triangles: u64,
    /// The passes that drew something, in order, and how much each of them drew.
    pub passes: Vec<Pass>,
    /// Passes of the App's own that are not drawn, since the `Cpu` draws.
    pub passes_refused: u32,
    /// Passes over the finished picture, by an [`Intensity`](halfway_lighting::Intensity) that acts on it: of
    /// `Cpu` over its memory. 0 under [`Intensity::Clamp`](halfway_lighting::Intensity::Clamp).
    pub picture_passes: u32,
    /// Model-view and normal matrices computed; 0 where nothing moved.
    pub matrices: u32,
    /// Distinct materials (front and back together) in the picture.
    pub materials: u32,
    /// Bytes sent to the GPU: meshes, the view, instances, materials, lights and their lists. The `Cpu`
    /// reads all but meshes where they are: there, the bytes of those that were made ready. 0 for a frame equal to the
    /// last.
    pub bytes_uploaded: u64,
    /// Pipelines built since the device was opened; each is one variant of the shader. The `Cpu` has
    /// none.
    pub pipelines: u32,
    /// Pipelines that are there now: those built, less the specialised ones that were given up.
    pub pipelines_live: u32,
    /// Pipelines that are still being built beside the frames: specialised ones, in whose place generic ones draw, and
    /// generic ones that are built ahead.
    pub pipelines_pending: u32,
    /// Pipelines that this frame waited for; under `Compile::Beside` never a specialised one
    /// after the first frame.
    pub pipelines_awaited: u32,
}

impl FrameReport {
    /// Adds what the frame of another camera did, in the same picture.
    pub fn add(&mut self, other: Self) {
        let Self { pipelines, pipelines_live, pipelines_pending, levels_pending, .. } = other;
        *self = Self {
            errors: [std::mem::take(&mut self.errors), other.errors].concat(),
            objects: self.objects + other.objects,
            visible: self.visible + other.visible,
            lights: self.lights + other.lights,
            triangles_in: self.triangles_in + other.triangles_in,
            patches: self.patches + other.patches,
            patches_culled: self.patches_culled + other.patches_culled,
            lights_assigned: self.lights_assigned + other.lights_assigned,
            light_pairs: self.light_pairs + other.light_pairs,
            left_out: self.left_out.max(other.left_out),
            draws: self.draws + other.draws,
            triangles: self.triangles + other.triangles,
            passes: [std::mem::take(&mut self.passes), other.passes].concat(),
            passes_refused: self.passes_refused + other.passes_refused,
            picture_passes: self.picture_passes + other.picture_passes,
            matrices: self.matrices + other.matrices,
            materials: self.materials + other.materials,
            bytes_uploaded: self.bytes_uploaded + other.bytes_uploaded,
            pipelines_awaited: self.pipelines_awaited + other.pipelines_awaited,
            // They are of the App.
            levels_pending,
            pipelines,
            pipelines_live,
            pipelines_pending,
        };
    }

    /// Starts a frame: everything but the pipelines, which live on, is zeroed.
    pub(crate) fn begin(&mut self) {
        let Self { pipelines, pipelines_live, pipelines_pending, .. } = *self;
        // Its memory is kept.
        let mut passes = std::mem::take(&mut self.passes);
        passes.clear();
        *self = Self { pipelines, pipelines_live, pipelines_pending, ..Self::default() };
        self.passes = passes;
    }
}
