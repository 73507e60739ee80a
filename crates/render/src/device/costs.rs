//! What is cheap on an adapter.

use crate::error::RenderError;

/// What is cheap on the adapter, and so by which of two ways a frame is drawn: the one place where the renderer tells
/// software adapters, which draw on the CPU, from hardware. Either way gives the same picture, but for rounding.
///
/// Taken from the adapter when it is opened, unless the environment variable `HALFWAY_COSTS` says `software` or
/// `hardware`;
/// [`Gpu::set_costs`](crate::Gpu::set_costs) sets it later. So the ways of hardware can be tried on a software adapter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Costs {
    /// What has images may be lit by an environment. llvmpipe through Vulkan (Mesa 22.3) crashes in draws that read
    /// both.
    pub images_in_environments: bool,
}

/// What an adapter is taken for of which nothing is known: [`Costs::HARDWARE`].
impl Default for Costs {
    fn default() -> Self {
        Self::HARDWARE
    }
}

impl Costs {
    /// Of an adapter that draws on the CPU.
    pub const SOFTWARE: Self = Self { images_in_environments: true };

    /// Of a graphics card.
    pub const HARDWARE: Self = Self { images_in_environments: true };

    /// Of the CPU without a driver ([`Cpu`](crate::Cpu)).
    pub const CPU: Self = Self { images_in_environments: true };

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

    /// Without what this adapter cannot do.
    fn as_able_as(self, adapter: &wgpu::Adapter) -> Self {
        let info = adapter.get_info();
        let crashes = info.backend == wgpu::Backend::Vulkan && info.name.starts_with("llvmpipe");
        Self { images_in_environments: !crashes, ..self }
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
