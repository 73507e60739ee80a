//! What a pipeline is made for: a draw, and what it writes.

use crate::batch::key::DrawKey;
use crate::lights::terms::by_fragment_shader;
use crate::shaders::light_slots::Lists;
use crate::shaders::text::{LightText, Text};
use crate::target::frame::ShaderOutput;
use halfway_raster::Cull;
use halfway_texture::MapKind;
use std::fmt;

/// All that a pipeline is specialised for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct PipelineKey {
    pub(crate) draw: DrawKey,
    pub(crate) output: ShaderOutput,
}

impl fmt::Display for PipelineKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ShaderOutput { format, encoded, samples } = self.output;
        write!(f, "{}{} {format:?} x{samples}", self.draw, if encoded { " encoded" } else { "" })
    }
}

impl Text {
    /// The text whose pipelines such draws take.
    pub(crate) fn of(key: &DrawKey) -> Self {
        let lights = match key.lists {
            _ if key.per_instance => LightText::Listed,
            Lists::Listed => LightText::Listed,
            Lists::Counted(..) => LightText::Few,
        };
        let turns_normals = key.maps.has(MapKind::Normal) || key.maps.has(MapKind::Height);
        Self {
            lights,
            terms: key.terms,
            two_sided: key.cull != Cull::Back,
            painted: key.is_painted(),
            mapped: key.is_mapped(),
            by_shape: key.maps.by_shape(),
            relief: turns_normals && by_fragment_shader(key.terms).contains(&true),
            solid: key.solid.is_some(),
            surrounded: key.surrounded,
        }
    }
}
