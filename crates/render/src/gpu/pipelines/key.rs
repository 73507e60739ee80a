//! The key of a pipeline: a draw, and the format of its output.

use crate::gpu::attachments::ShaderOutput;
use crate::gpu::shaders::text::{LightText, Text};
use halfway_frame::batch::key::DrawKey;
use halfway_frame::lights::slots::Lists;
use halfway_frame::lights::terms::by_fragment_shader;
use halfway_lighting::record::Cull;
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
    pub(crate) fn from_key(key: &DrawKey) -> Self {
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
