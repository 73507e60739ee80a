//! An open adapter: a graphics card or the CPU.

use crate::cpu::device::Cpu;
#[cfg(feature = "wgpu")]
use crate::gpu::device::Gpu;
use bevy_ecs::prelude::{Res, World};
use halfway_frame::error::RenderError;

/// An adapter that is open. [`AdapterChoice::open`](crate::AdapterChoice::open) opens it, and the world holds it as the
/// resource
/// [`Gpu`] or [`Cpu`].
#[derive(Clone)]
pub enum Adapter {
    /// A graphics adapter with its driver, hardware or software.
    #[cfg(feature = "wgpu")]
    Gpu(Gpu),
    /// The CPU without a driver.
    Cpu(Cpu),
}

impl Adapter {
    /// The adapter that draws the frames of this world; `None` while none is open.
    pub fn from_world(world: &World) -> Option<Self> {
        #[cfg(feature = "wgpu")]
        if let Some(gpu) = world.get_resource::<Gpu>() {
            return Some(Self::Gpu(gpu.clone()));
        }
        world.get_resource::<Cpu>().cloned().map(Self::Cpu)
    }

    /// Inserts it into a world, whose frames it draws from the next one on.
    pub fn insert_into(self, world: &mut World) {
        match self {
            #[cfg(feature = "wgpu")]
            Self::Gpu(gpu) => world.insert_resource(gpu),
            Self::Cpu(cpu) => {
                #[cfg(feature = "wgpu")]
                world.remove_resource::<Gpu>();
                world.insert_resource(cpu);
            }
        }
    }

    /// A line of description: its name, its backend, and whether it is software.
    pub fn describe(&self) -> String {
        match self {
            #[cfg(feature = "wgpu")]
            Self::Gpu(gpu) => gpu.describe(),
            Self::Cpu(cpu) => cpu.describe(),
        }
    }

    /// Whether it draws on the CPU.
    pub fn is_software(&self) -> bool {
        match self {
            #[cfg(feature = "wgpu")]
            Self::Gpu(gpu) => gpu.is_software(),
            Self::Cpu(_) => true,
        }
    }

    /// Whether objects with images or a solid can be lit by an environment.
    pub fn lights_images_by_environments(&self) -> bool {
        match self {
            #[cfg(feature = "wgpu")]
            Self::Gpu(gpu) => gpu.lights_images_by_environments(),
            Self::Cpu(_) => true,
        }
    }

    /// Whether blended objects can be drawn into 32-bit floating point.
    pub fn blends_floats(&self) -> bool {
        match self {
            #[cfg(feature = "wgpu")]
            Self::Gpu(gpu) => {
                let can = gpu.format_features(wgpu::TextureFormat::Rgba32Float);
                can.flags.contains(wgpu::TextureFormatFeatureFlags::BLENDABLE)
            }
            Self::Cpu(_) => true,
        }
    }

    /// The bits of the sub-pixel grid that it snaps vertices to.
    ///
    /// # Errors
    /// [`RenderError::Device`] if the device fails while they are measured.
    pub fn sub_pixel_bits(&self) -> Result<u32, RenderError> {
        match self {
            #[cfg(feature = "wgpu")]
            Self::Gpu(gpu) => gpu.sub_pixel_bits(),
            Self::Cpu(_) => Ok(Cpu::SUB_PIXEL_BITS),
        }
    }

    /// Waits until it has finished all submitted work.
    ///
    /// # Errors
    /// [`RenderError::DeviceLost`] or [`RenderError::Device`].
    pub fn finish(&self) -> Result<(), RenderError> {
        match self {
            #[cfg(feature = "wgpu")]
            Self::Gpu(gpu) => gpu.poll(wgpu::PollType::wait_indefinitely()),
            // The CPU has finished a frame once it returns.
            Self::Cpu(_) => Ok(()),
        }
    }
}

/// Whether the CPU draws.
pub(crate) fn cpu_draws(#[cfg(feature = "wgpu")] gpu: Option<Res<Gpu>>, cpu: Option<Res<Cpu>>) -> bool {
    #[cfg(feature = "wgpu")]
    if gpu.is_some() {
        return false;
    }
    cpu.is_some()
}
