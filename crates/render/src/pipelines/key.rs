//! What a pipeline is made for: a draw, and what it writes.

use crate::batch::key::DrawKey;
use crate::shaders::light_slots::Lists;
use crate::shaders::text::{LightText, SurfaceText, Text};
use crate::target::frame::ShaderOutput;
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
            Lists::Counted(_) => LightText::Few,
        };
        let surface = match (key.is_mapped(), key.colored) {
            _ if key.surrounded && key.solid.is_some() => SurfaceText::SolidSurrounded,
            _ if key.surrounded => SurfaceText::Surrounded,
            _ if key.solid.is_some() => SurfaceText::Solid,
            (true, _) => SurfaceText::Mapped,
            (false, true) => SurfaceText::Colored,
            (false, false) => SurfaceText::Plain,
        };
        Self { lights, surface, by_shape: key.maps.by_shape() }
    }
}
