//! Choose: where each object's diffuse and specular terms are shaded.

use crate::error::{RenderError, label};
use crate::report::FrameReport;
use crate::view::camera::View;
use crate::view::select::{Representatives, Visible};
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
    representatives: Res<Representatives>,
    mut visible: ResMut<Visible>,
    view: Res<View>,
    mut report: ResMut<FrameReport>,
) {
    let wrong = |entity: Entity| shown_shading(objects.get(entity).ok()?.0, &view).validate().err();
    // Objects with equal components are right or wrong together.
    if !representatives.0.iter().any(|&entity| wrong(entity).is_some()) {
        return;
    }
    visible.0.retain(|&entity| {
        let Some(source) = wrong(entity) else { return true };
        let name = objects.get(entity).ok().and_then(|(_, name)| name);
        report.errors.push(RenderError::Invalid { entity: label(entity, name), source });
        false
    });
}
