//! The choice of the adapter.

use crate::adapter::Adapter;
use crate::cpu::device::Cpu;
use bevy_ecs::prelude::Resource;
use halfway_frame::error::RenderError;

/// The choice of an adapter: a graphics adapter, or the CPU. Insert it before the first frame; an open `Gpu` or [`Cpu`]
/// stays.
///
/// The first of these that is given decides:
///
/// 1. the name here;
/// 2. the environment variable `HALFWAY_ADAPTER`, a name as here;
/// 3. wgpu's variables `WGPU_BACKEND`, the allowed backends (`vulkan`, `gl`, `metal`, `dx12`; several separated by
///    commas), and `WGPU_ADAPTER_NAME`, a name of a graphics adapter as here;
/// 4. `VK_DRIVER_FILES`, or `VK_ICD_FILENAMES`, which name drivers: an adapter of theirs, also a software one;
/// 5. otherwise: a hardware adapter of Vulkan, Metal or DirectX 12; without one, a hardware adapter of OpenGL; without
///    hardware, the CPU, which is faster than software drivers. On Linux drivers are loaded only if the kernel lists a
///    graphics card (such as `/dev/dri/renderD128`).
///
/// The name `cpu` stands for the CPU without a driver ([`Cpu`]), `cpu:avx512`, `cpu:avx2`, `cpu:neon` and `cpu:plain`
/// for the CPU with these vectors. The name `gpu` stands for any graphics adapter, hardware first, else a software one;
/// wgpu's variables limit which.
///
/// Any other name is a part, in upper or lower case, of the adapter's name or of its backend's (`vulkan`, `metal`,
/// `dx12`, `gl` or `opengl`), or both with a colon between: `vulkan:llvmpipe`, `gl:llvmpipe`. The name of a backend in
/// full stands for the backend only. If several adapters match, hardware is preferred to software. `VK_DRIVER_FILES`
/// limits the Vulkan drivers in every case. OpenGL is asked only if the name may refer to it and no other adapter
/// matches, since that takes time.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct AdapterChoice {
    /// The name. Default `None`: the environment's, or none.
    pub name: Option<String>,
}

impl AdapterChoice {
    /// The adapter of that name.
    pub fn named(name: impl Into<String>) -> Self {
        Self { name: Some(name.into()) }
    }

    /// The CPU without a driver.
    pub fn cpu() -> Self {
        Self::named(Cpu::NAME)
    }

    /// A graphics adapter, also a software one.
    pub fn gpu() -> Self {
        Self::named(ANY)
    }

    /// Opens the adapter, for pictures without a window.
    ///
    /// # Errors
    /// [`RenderError::NoAdapterAmong`], [`RenderError::NoSuchAdapter`], [`RenderError::NoDevice`] or
    /// [`RenderError::NoVectors`], each with its remedy.
    pub fn open(&self) -> Result<Adapter, RenderError> {
        match self.open_cpu(variable) {
            Some(cpu) => cpu.map(Adapter::Cpu),
            None => self.open_other(),
        }
    }

    /// All adapters, or those that `WGPU_BACKEND` allows, and the CPU, a line each; the one that would be opened comes
    /// first. OpenGL is asked, too.
    ///
    /// # Errors
    /// Those of [`open`](Self::open) if the adapter that would be opened is missing.
    pub fn list(&self) -> Result<Vec<String>, RenderError> {
        match self.open_cpu(variable) {
            Some(cpu) => self.list_after(cpu?.describe()),
            None => self.list_after(self.describe_other()?),
        }
    }

    /// The CPU, if the name asks for it.
    pub(crate) fn open_cpu(&self, variable: impl Fn(&str) -> Option<String>) -> Option<Result<Cpu, RenderError>> {
        let name = self.given(variable)?.to_lowercase();
        match name.split_once(':') {
            None if name == Cpu::NAME => Some(Cpu::open()),
            Some((Cpu::NAME, vectors)) => Some(Cpu::open_with(vectors.trim())),
            _ => None,
        }
    }

    /// The name that is given here or, before wgpu's own, by the environment.
    pub(crate) fn given(&self, variable: impl Fn(&str) -> Option<String>) -> Option<String> {
        self.name.clone().filter(|name| !name.is_empty()).or_else(|| variable("HALFWAY_ADAPTER"))
    }
}

/// Without wgpu, the CPU is the only adapter.
#[cfg(not(feature = "wgpu"))]
impl AdapterChoice {
    fn open_other(&self) -> Result<Adapter, RenderError> {
        let cpu = Cpu::open()?;
        match self.given(variable) {
            None => Ok(Adapter::Cpu(cpu)),
            Some(wanted) => {
                Err(RenderError::NoSuchAdapter { wanted: wanted.to_lowercase(), there: vec![cpu.describe()] })
            }
        }
    }

    fn describe_other(&self) -> Result<String, RenderError> {
        self.open_other().map(|adapter| adapter.describe())
    }

    #[expect(clippy::unused_self, clippy::unnecessary_wraps, reason = "with wgpu there is more to list")]
    fn list_after(&self, first: String) -> Result<Vec<String>, RenderError> {
        Ok(vec![first])
    }
}

/// The name of any graphics adapter.
pub(crate) const ANY: &str = "gpu";

/// An environment variable that is set and not empty.
pub(crate) fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok().filter(|value| !value.is_empty())
}
