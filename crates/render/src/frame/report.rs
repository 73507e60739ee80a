//! What a frame did, counted; and what it could not do.

use crate::error::RenderError;
use bevy_ecs::prelude::{ReflectResource, Resource};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

/// Counters and errors of the newest frame. Counts are exact, so they can be tested.
#[derive(Resource, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Resource, Clone, Debug, Default, PartialEq)]
pub struct FrameReport {
    /// Everything that kept the frame from being drawn as asked, in the order found. What an error names is left out of
    /// the picture, and nothing is left out without one. What goes wrong beside the frames is told here as well, once,
    /// though nothing is left out for it: a pipeline that a frame can do without, or levels of detail that cannot be
    /// made.
    #[reflect(ignore)]
    pub errors: Vec<RenderError>,
    /// Objects with a mesh that are not [hidden](halfway_lighting::Visibility).
    pub objects: u32,
    /// Objects whose bounding sphere meets the view frustum.
    pub visible: u32,
    /// Lights that shone: neither hidden nor refused.
    pub lights: u32,
    /// Meshes that have been seen and whose levels of detail are still being made; they are drawn as they are.
    pub levels_pending: u32,
    /// Triangles of the visible objects' meshes, as modelled.
    pub triangles_in: u64,
    /// Patches of the visible large meshes, at their levels of detail.
    pub patches: u32,
    /// Patches among them that are outside of the frustum or show only sides that are not drawn.
    pub patches_culled: u32,
    /// Diffuse and specular terms in the light lists, summed over objects and patches; 0 where all lights of the scene
    /// are compiled in.
    pub lights_assigned: u64,
    /// Pairs of a patch, of patches that have one list together, or of an object in one piece, and a light whose bounds
    /// were looked at for those lists. Lights that are out of reach of the patches around are in none.
    pub light_pairs: u64,
    /// Terms that are shaded at each point of an object or patch with light lists, summed over these: those in the
    /// lists, and what a list is filled up with where a shader takes only some numbers of terms.
    pub terms_shaded: u64,
    /// Terms in those lists that are shaded at the vertices, or once a triangle, summed over objects and patches.
    pub terms_at_vertices: u64,
    /// Terms in those lists that are shaded at the fragments, summed over objects and patches.
    pub terms_at_fragments: u64,
    /// Patches of which a term of a light went from the vertices to the fragments or back since the frame before, under
    /// [`Shading::Auto`](halfway_lighting::Shading::Auto) and without another level of detail;
    /// [`Choosing`](crate::Choosing) keeps them few.
    pub choices_changed: u32,
    /// The most that shading terms at the vertices under [`Shading::Auto`](halfway_lighting::Shading::Auto) may have
    /// changed any channel of any pixel, in steps of 1/255 of the picture: the largest sum of bounds. What is left out
    /// of the lists is in it where terms are shaded at the vertices.
    pub steps_spent: f64,
    /// The most that the terms left out of the lists could have added anywhere, in linear intensity; 0 where none was.
    pub left_out: f64,
    /// Draw commands: a multi-draw is one, however much it draws ([`Gpu::multi_draw`](crate::Gpu::multi_draw)).
    pub draws: u32,
    /// Triangles in those draws, before culling of faces.
    pub triangles: u64,
    /// Passes over the finished picture, by an [`Intensity`](halfway_lighting::Intensity) that acts on it: of
    /// [`Cpu`](crate::Cpu) over its memory. 0 under [`Intensity::Clamp`](halfway_lighting::Intensity::Clamp).
    pub picture_passes: u32,
    /// Whether nothing that the draws are made of has changed since the frame before, so that they are drawn again as
    /// they were: nothing is chosen, and counts of patches, lights and draws are those of the frame that made them.
    pub kept: bool,
    /// Model-view and normal matrices computed; 0 where nothing moved.
    pub matrices: u32,
    /// Distinct materials (front and back together) in the picture.
    pub materials: u32,
    /// Bytes sent to the GPU: meshes, the view, instances, materials, lights and their lists, and draws that a
    /// multi-draw reads. The [`Cpu`](crate::Cpu) reads all but meshes where they are: there, the bytes of those that
    /// were made ready. 0 for a frame equal to the last.
    pub bytes_uploaded: u64,
    /// Pipelines built since the device was opened; each is one variant of the shader. The [`Cpu`](crate::Cpu) has
    /// none.
    pub pipelines: u32,
    /// Pipelines that are there now: those built, less the specialised ones that were given up.
    pub pipelines_live: u32,
    /// Pipelines that are still being built beside the frames: specialised ones, in whose place generic ones draw, and
    /// generic ones that are built ahead.
    pub pipelines_pending: u32,
    /// Pipelines that this frame waited for; under [`Compile::Beside`](crate::Compile::Beside) never a specialised one
    /// after the first frame.
    pub pipelines_awaited: u32,
}

impl FrameReport {
    /// Starts a frame: everything but the pipelines, which live on, is zeroed.
    pub(crate) fn begin(&mut self) {
        let Self { pipelines, pipelines_live, pipelines_pending, .. } = *self;
        *self = Self { pipelines, pipelines_live, pipelines_pending, ..Self::default() };
    }

    /// Takes what was reported of the draws when they were made, where they are drawn again.
    pub(crate) fn keep(&mut self, made: &Self) {
        let &Self { triangles_in, patches, patches_culled, lights_assigned, light_pairs, terms_shaded, .. } = made;
        let &Self { terms_at_vertices, terms_at_fragments, steps_spent, left_out, draws, triangles, materials, .. } =
            made;
        *self = Self {
            triangles_in,
            patches,
            patches_culled,
            lights_assigned,
            light_pairs,
            terms_shaded,
            terms_at_vertices,
            terms_at_fragments,
            steps_spent,
            left_out,
            draws,
            triangles,
            materials,
            kept: true,
            ..std::mem::take(self)
        };
    }
}
