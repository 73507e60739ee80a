//! Choose: at which frequency each object's diffuse and specular terms are shaded.

use crate::view::camera::View;
use crate::view::matrices::Visible;
use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use halfway_lighting::{Frequency, Shading, Terms};

/// Which terms a light list keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct TermMask {
    pub(crate) diffuse: bool,
    pub(crate) specular: bool,
}

impl TermMask {
    pub(crate) fn is_empty(self) -> bool {
        self == Self::default()
    }

    /// How many terms.
    pub(crate) fn terms(self) -> u64 {
        u64::from(self.diffuse) + u64::from(self.specular)
    }
}

/// What the frame chose for an object. Holds after [`RenderSet::Choose`](crate::RenderSet::Choose).
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(opaque, Component, Clone, Debug, Default, PartialEq, Hash)]
pub struct Chosen {
    /// The terms of the vertex list.
    pub(crate) vertex: TermMask,
    /// The terms of the fragment list.
    pub(crate) fragment: TermMask,
    /// The vertex list shades one point a triangle: its centroid.
    pub(crate) flat: bool,
}

pub(crate) fn choose(
    mut objects: Query<(&mut Chosen, Option<&Shading>, Option<&Terms>)>,
    visible: Res<Visible>,
    view: Res<View>,
) {
    for &entity in &visible.0 {
        let Ok((mut chosen, shading, terms)) = objects.get_mut(entity) else { continue };
        let wanted =
            terms.map_or_else(|| of_shading(shading.copied().unwrap_or(view.shading)), |&terms| of_terms(terms));
        chosen.set_if_neq(wanted);
    }
}

fn of_shading(shading: Shading) -> Chosen {
    let both = TermMask { diffuse: true, specular: true };
    match shading {
        Shading::Flat => Chosen { vertex: both, flat: true, ..Chosen::default() },
        Shading::Gouraud => Chosen { vertex: both, ..Chosen::default() },
        _ => Chosen { fragment: both, ..Chosen::default() },
    }
}

fn of_terms(terms: Terms) -> Chosen {
    let mask = |frequency| TermMask { diffuse: terms.diffuse == frequency, specular: terms.specular == frequency };
    Chosen { vertex: mask(Frequency::Vertex), fragment: mask(Frequency::Fragment), flat: false }
}
