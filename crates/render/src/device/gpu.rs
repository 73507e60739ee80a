//! The adapter, its device and its queue.

use crate::device::choice::{AdapterChoice, describe_adapter};
use crate::device::costs::Costs;
use crate::device::provoking_vertex::ProvokingVertex;
use crate::error::RenderError;
use bevy_ecs::prelude::Resource;
use std::sync::{Arc, Mutex, PoisonError};

/// The open graphics device. Inserted by the window, or opened headless by the first frame.
#[derive(Resource, Clone)]
pub struct Gpu {
    /// The instance the adapter came from; surfaces are made with it.
    pub instance: wgpu::Instance,
    /// The adapter that was picked.
    pub adapter: wgpu::Adapter,
    /// The logical device.
    pub device: wgpu::Device,
    /// The queue all work is submitted to.
    pub queue: wgpu::Queue,
    costs: Costs,
    failure: Arc<Mutex<Option<String>>>,
}

impl Gpu {
    /// Opens an adapter that needs no window, the one that [`AdapterChoice::default`] finds.
    ///
    /// # Errors
    /// As [`AdapterChoice::open`].
    pub fn open_headless() -> Result<Self, RenderError> {
        AdapterChoice::default().open()
    }

    pub(super) fn of_adapter(instance: wgpu::Instance, adapter: wgpu::Adapter) -> Result<Self, RenderError> {
        let wanted = wgpu::Features::FLOAT32_BLENDABLE
            | wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES
            | wgpu::Features::TIMESTAMP_QUERY
            | wgpu::Features::INDIRECT_FIRST_INSTANCE;
        let costs = Costs::of(&adapter)?;
        let wanted = if costs.maps_meshes { wanted | wgpu::Features::MAPPABLE_PRIMARY_BUFFERS } else { wanted };
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("halfway"),
            required_features: wanted & adapter.features(),
            // All the adapter has: large meshes and long light lists may need more than the defaults.
            required_limits: adapter.limits(),
            ..Default::default()
        }))
        .map_err(|error| RenderError::NoDevice { adapter: adapter.get_info().name, reason: error.to_string() })?;
        let failure = Arc::new(Mutex::new(None));
        let seen = Arc::clone(&failure);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            log::error!("{error}");
            seen.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error.to_string());
        }));
        let mut gpu = Self { instance, adapter, device, queue, costs, failure };
        gpu.set_costs(costs);
        Ok(gpu)
    }

    /// From how many draws on those that share their state are one command, `multi_draw_indexed_indirect`; `None` where
    /// each is a command.
    pub fn multi_draw(&self) -> Option<u32> {
        self.costs.multi_draw
    }

    /// Sets that number, from the next frame on. The picture is the same, but for rounding where materials are looked up.
    ///
    /// Default: 128 on a hardware adapter that has multi-draw, else `None`. It stays `None` where the device cannot:
    /// without `wgpu::Features::INDIRECT_FIRST_INSTANCE` or `wgpu::DownlevelFlags::INDIRECT_EXECUTION`.
    pub fn set_multi_draw(&mut self, from: Option<u32>) {
        self.set_costs(Costs { multi_draw: from, ..self.costs });
    }

    /// What is taken to be cheap on the adapter.
    pub fn costs(&self) -> Costs {
        self.costs
    }

    /// Draws in the ways that are cheap by `costs`, from the next frame on, as far as the device can: multi-draw takes
    /// `wgpu::Features::INDIRECT_FIRST_INSTANCE` and `wgpu::DownlevelFlags::INDIRECT_EXECUTION`, and mapping
    /// `wgpu::Features::MAPPABLE_PRIMARY_BUFFERS`. Meshes that have been uploaded stay as they are.
    pub fn set_costs(&mut self, costs: Costs) {
        let features = self.device.features();
        let flags = self.adapter.get_downlevel_capabilities().flags;
        let can_multi_draw = features.contains(wgpu::Features::INDIRECT_FIRST_INSTANCE)
            && flags.contains(wgpu::DownlevelFlags::INDIRECT_EXECUTION);
        self.costs = Costs {
            multi_draw: costs.multi_draw.filter(|_| can_multi_draw),
            maps_meshes: costs.maps_meshes && features.contains(wgpu::Features::MAPPABLE_PRIMARY_BUFFERS),
            ..costs
        };
    }

    /// The first error the driver reported outside any call, if it has not been taken yet.
    pub(crate) fn take_failure(&self) -> Option<RenderError> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner).take().map(RenderError::Device)
    }

    /// Which vertex of a triangle gives what is not interpolated.
    pub(crate) fn provoking_vertex(&self) -> ProvokingVertex {
        ProvokingVertex::of(self.adapter.get_info().backend)
    }

    /// Whether the adapter draws on the CPU.
    pub fn is_software(&self) -> bool {
        self.adapter.get_info().device_type == wgpu::DeviceType::Cpu
    }

    /// One line for people: the adapter's name, its backend, and whether it is software.
    pub fn describe(&self) -> String {
        describe_adapter(&self.adapter.get_info())
    }
}
