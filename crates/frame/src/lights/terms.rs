//! Choose: where each object's diffuse and specular terms are shaded.

use crate::error::{RenderError, label};
use crate::report::FrameReport;
use crate::view::camera::View;
use crate::view::matrices::Visible;
use bevy_ecs::prelude::*;
use halfway_lighting::{Frequency, Shading, Terms};

/// How an object is shaded: as it says itself, else as the view says.
pub(crate) fn shown_shading(own: Option<&Shading>, view: &View) -> Shading {
    own.copied().unwrap_or(view.shading)
}

/// Whether the diffuse and the specular term are evaluated by the vertex shader: at each vertex, or at the one vertex
/// that stands for a triangle.
pub fn by_vertex_shader(terms: Terms) -> [bool; 2] {
    [terms.diffuse, terms.specular].map(|term| matches!(term, Frequency::Triangle | Frequency::Vertex))
}

/// Whether the diffuse and the specular term are evaluated by the fragment shader.
pub fn by_fragment_shader(terms: Terms) -> [bool; 2] {
    [terms.diffuse, terms.specular].map(|term| term == Frequency::Fragment)
}

/// Reports objects whose terms cannot be drawn together, and leaves them out.
pub(crate) fn check(
    objects: Query<(Option<&Shading>, Option<&Name>)>,
    mut visible: ResMut<Visible>,
    view: Res<View>,
    mut report: ResMut<FrameReport>,
) {
    visible.0.retain(|&entity| {
        let Ok((shading, name)) = objects.get(entity) else { return false };
        let checked = shown_shading(shading, &view).validate();
        if let Err(source) = checked {
            report.errors.push(RenderError::Invalid { entity: label(entity, name), source });
            return false;
        }
        true
    });
}
