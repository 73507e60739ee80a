//! What is cheap on an adapter.

use crate::error::RenderError;
use bevy_ecs::prelude::{ReflectResource, Resource};
use bevy_reflect::Reflect;
use halfway_lighting::{Fields, InvalidValue};

/// What is cheap on the adapter, and so by which of two ways a frame is drawn: the one place where the renderer tells
/// software adapters, which draw on the CPU, from hardware. Either way gives the same picture, but for rounding.
///
/// Taken from the adapter when it is opened, unless the environment variable `HALFWAY_COSTS` says `software` or
/// `hardware`;
/// [`Gpu::set_costs`](crate::Gpu::set_costs) sets it later. So the ways of hardware can be tried on a software adapter.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a way of drawing by itself")]
pub struct Costs {
    /// Shaders write the sRGB curve where nothing blends and a pixel has one sample; else the target's format does. A
    /// software adapter decodes and encodes all 16 pixels of a block to write some of them.
    pub shaders_encode: bool,
    /// Each patch of a scene with many lights has its own bound at fixed places, where they are few enough. A software
    /// adapter reads those faster than lists, but starts a draw for each set.
    pub lights_at_fixed_places: bool,
    /// From this number of materials and light lists on, what one command can draw looks them up by instance; 2 or
    /// more. A software adapter looks up pixel by pixel, in the time of which it starts many draws.
    pub records_of_one_command: usize,
    /// From this number of draws on, those that share their state are one command, `multi_draw_indexed_indirect`;
    /// `None` where each draw is a command.
    pub multi_draw: Option<u32>,
    /// The CPU writes meshes directly into the buffers that are drawn from. Elsewhere than on a software adapter,
    /// memory that both reach is slow for one of them.
    pub maps_meshes: bool,
    /// What has images may be lit by an environment. llvmpipe through Vulkan (Mesa 22.3) crashes in draws that read
    /// both.
    pub images_in_environments: bool,
    /// Fragments may be shaded at the nearest corner of their triangle, with its normal, so that triangles may be 1.7
    /// times as long as where all three corners count. Nothing of wgpu tells a fragment which corner is nearest.
    pub nearest_corner: bool,
    /// What shading at the vertices saves and costs, for [`Shading::Auto`](halfway_lighting::Shading::Auto).
    pub vertices: VertexPrices,
}

/// What it costs to shade the lights of a patch at its vertices, in what a light costs at a pixel: for
/// [`Shading::Auto`](halfway_lighting::Shading::Auto), which moves terms to the vertices, and leaves lights out of a
/// patch that are compiled in, where that is within the tolerance and saves more than it costs.
///
/// As a resource it stands for the adapter's own, in [`Costs`]. Prices are 0 or more, also infinite; where one
/// is not, [`FrameReport::errors`](crate::FrameReport) tells, and the adapter's own are taken.
/// [`Calibration`](crate::Calibration) measures them.
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Resource, Clone, Debug, PartialEq)]
pub struct VertexPrices {
    /// A light at a vertex.
    pub light: f32,
    /// That there is any light at a pixel: its normal, and the way to the eye.
    pub pixel: f32,
    /// To bound what a light changes of a patch.
    pub look: f32,
    /// To draw a patch with lights of its own.
    pub draw: f32,
    /// A light's diffuse term where its specular one is shaded elsewhere, 0 to 1: most of what a light costs is where
    /// it is, which one term needs as two do. Of a light without a specular term this is left to save.
    pub diffuse_alone: f32,
    /// Its specular term where its diffuse one is shaded elsewhere, 0 to 1.
    pub specular_alone: f32,
}

impl VertexPrices {
    /// Whatever the tolerance allows is shaded at the vertices, though that may be dearer.
    pub const FREE: Self = Self { light: 0.0, pixel: 0.0, look: 0.0, draw: 0.0, ..Self::BY_DRIVER };
    /// Nothing is, but what is coarser than its mesh.
    pub const NEVER: Self =
        Self { light: f32::INFINITY, pixel: 0.0, look: f32::INFINITY, draw: f32::INFINITY, ..Self::BY_DRIVER };
    /// Of an adapter that draws on the CPU by a driver: from `bench` on one machine with llvmpipe.
    const BY_DRIVER: Self =
        Self { light: 3.0, pixel: 0.5, look: 8.0, draw: 900.0, diffuse_alone: 0.8, specular_alone: 0.9 };
    /// Of the CPU without a driver: from `calibrate` on one machine with AVX-512, whose pixels are the cheapest.
    const OF_CPU: Self =
        Self { light: 0.2, pixel: 2.5, look: 200.0, draw: 1000.0, diffuse_alone: 0.35, specular_alone: 0.9 };

    /// Each with its name.
    pub fn named(&self) -> [(&'static str, f32); 6] {
        let Self { light, pixel, look, draw, diffuse_alone, specular_alone } = *self;
        [
            ("light", light),
            ("pixel", pixel),
            ("look", look),
            ("draw", draw),
            ("diffuse_alone", diffuse_alone),
            ("specular_alone", specular_alone),
        ]
    }

    /// Expects each price to be 0 or more, and those of one term to be 1 or less.
    ///
    /// # Errors
    /// One is not.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        self.named().into_iter().try_for_each(|(name, price)| {
            let fields = Fields::of("VertexPrices");
            if name.ends_with("_alone") {
                fields.number(name, price, (0.0..=1.0).contains(&price), "0 to 1")
            } else {
                fields.number(name, price, price >= 0.0, "0 or more")
            }
        })
    }
}

/// What an adapter is taken for of which nothing is known: [`Costs::HARDWARE`].
impl Default for Costs {
    fn default() -> Self {
        Self::HARDWARE
    }
}

impl Costs {
    /// Of an adapter that draws on the CPU.
    pub const SOFTWARE: Self = Self {
        shaders_encode: true,
        lights_at_fixed_places: true,
        records_of_one_command: 512,
        multi_draw: None,
        maps_meshes: true,
        images_in_environments: true,
        nearest_corner: false,
        vertices: VertexPrices::BY_DRIVER,
    };

    /// Of a graphics card.
    ///
    /// wgpu checks on the GPU what a multi-draw reads, by a pass before that of the frame. The CPU takes as long to set
    /// that pass up as for about a hundred draws.
    pub const HARDWARE: Self = Self {
        shaders_encode: false,
        lights_at_fixed_places: false,
        records_of_one_command: 2,
        multi_draw: Some(128),
        maps_meshes: false,
        images_in_environments: true,
        nearest_corner: false,
        vertices: VertexPrices::NEVER,
    };

    /// Of the CPU without a driver ([`Cpu`](crate::Cpu)): its shading reads materials and lights where they are, so
    /// that what would start a draw elsewhere is free.
    pub const CPU: Self = Self {
        shaders_encode: true,
        lights_at_fixed_places: false,
        records_of_one_command: 2,
        multi_draw: None,
        maps_meshes: true,
        images_in_environments: true,
        nearest_corner: true,
        vertices: VertexPrices::OF_CPU,
    };

    /// Of this adapter, or what the environment says of it.
    pub(crate) fn of(adapter: &wgpu::Adapter) -> Result<Self, RenderError> {
        match std::env::var_os(VARIABLE) {
            Some(value) if !value.is_empty() => Ok(Self::named(&value.to_string_lossy())?.as_able_as(adapter)),
            _ => Ok(Self::of_kind(adapter)),
        }
    }

    /// Of this adapter, whatever the environment says.
    pub(crate) fn of_kind(adapter: &wgpu::Adapter) -> Self {
        let is_software = adapter.get_info().device_type == wgpu::DeviceType::Cpu;
        if is_software { Self::SOFTWARE } else { Self::HARDWARE }.as_able_as(adapter)
    }

    /// Without what this adapter cannot do. Without the feature that is asked for here, wgpu writes a multi-draw out as
    /// single draws.
    fn as_able_as(self, adapter: &wgpu::Adapter) -> Self {
        let has_multi_draw = adapter.features().contains(wgpu::Features::MULTI_DRAW_INDIRECT_COUNT);
        let info = adapter.get_info();
        let crashes = info.backend == wgpu::Backend::Vulkan && info.name.starts_with("llvmpipe");
        Self { multi_draw: self.multi_draw.filter(|_| has_multi_draw), images_in_environments: !crashes, ..self }
    }

    fn named(name: &str) -> Result<Self, RenderError> {
        match name {
            "software" => Ok(Self::SOFTWARE),
            "hardware" => Ok(Self::HARDWARE),
            other => Err(RenderError::BadCosts { found: other.into() }),
        }
    }
}

/// The environment variable that says what is to be taken for cheap.
const VARIABLE: &str = "HALFWAY_COSTS";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn costs_go_by_two_names() {
        assert_eq!(Costs::named("software"), Ok(Costs::SOFTWARE));
        assert_eq!(Costs::named("hardware"), Ok(Costs::HARDWARE));
        let message = Costs::named("Hardware").unwrap_err().to_string();
        assert_eq!(message, "HALFWAY_COSTS is \"Hardware\"; expected software or hardware");
    }
}
