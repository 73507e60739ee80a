//! Choose: where each object's diffuse and specular terms are shaded.

use crate::error::{RenderError, label};
use crate::report::FrameReport;
use crate::view::camera::View;
use crate::view::matrices::Visible;
use bevy_ecs::prelude::*;
use halfway_lighting::{Frequency, Shading, Terms};

/// The frequency at which the frame shades each term of an object. Holds after
/// [`RenderSet::Choose`](crate::sets::RenderSet::Choose).
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Chosen(pub Terms);

impl Default for Chosen {
    fn default() -> Self {
        Self(Terms::NONE)
    }
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

type Wishes = (&'static mut Chosen, Option<&'static Shading>, Option<&'static Terms>, Option<&'static Name>);

pub(crate) fn choose(
    mut objects: Query<Wishes>,
    mut visible: ResMut<Visible>,
    view: Res<View>,
    mut report: ResMut<FrameReport>,
) {
    visible.0.retain(|&entity| {
        let Ok((mut chosen, shading, terms, name)) = objects.get_mut(entity) else { return false };
        let terms = terms.copied().unwrap_or_else(|| shading.copied().unwrap_or(view.shading).into());
        if let Err(source) = terms.validate() {
            report.errors.push(RenderError::Invalid { entity: label(entity, name), source });
            return false;
        }
        chosen.set_if_neq(Chosen(terms));
        true
    });
}
