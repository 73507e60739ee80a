//! False colours: what was chosen for each patch, in place of how it looks.

use bevy_ecs::prelude::{ReflectResource, Resource};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

/// Whether everything is drawn in false colours, which say where the terms of its lights are shaded. Default: not.
///
/// Red grows with the share of terms shaded at the fragments, green with that of terms shaded at the vertices or once a
/// triangle, of all that the patch has; a patch without a term is dark grey. Patches that are coarser than the mesh are
/// bluish.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Resource, Clone, Debug, Default, PartialEq)]
pub struct FalseColors(pub bool);

impl FalseColors {
    /// The colour of a patch, linear.
    pub(crate) fn color(at_vertices: u64, at_fragments: u64, is_coarse: bool) -> [f32; 3] {
        let all = (at_vertices + at_fragments) as f32;
        let blue = if is_coarse { 0.6 } else { 0.03 };
        if all == 0.0 {
            return [0.03, 0.03, blue];
        }
        [at_fragments as f32 / all, at_vertices as f32 / all, blue]
    }
}
