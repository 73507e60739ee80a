//! The adapter, its device and its queue.

use crate::gpu::old_opengl::unfit;
use crate::gpu::provoking_vertex::ProvokingVertex;
use bevy_ecs::prelude::Resource;
use futures_lite::future::block_on;
use halfway_frame::error::RenderError;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The open graphics device. Inserted by the window or by an engine that has one ([`Gpu::from_device`]), or opened
/// headless by the first frame.
///
/// Another `Gpu` may be inserted between any two frames: the next frame is drawn on it, with all data of the App.
///
/// A device can be lost at any time: the driver crashes or is updated, the GPU hangs or is unplugged. The frame that
/// detects the loss has [`RenderError::DeviceLost`] in its report, once, and is not drawn; then a new device is opened,
/// by the window for its surface or else by the next frame, which is drawn.
#[derive(Resource, Clone)]
pub struct Gpu {
    /// The instance the adapter came from; surfaces are made with it. `None` where a device came alone.
    pub instance: Option<wgpu::Instance>,
    /// The adapter that was picked. `None` where a device came alone.
    pub adapter: Option<wgpu::Adapter>,
    /// The logical device.
    pub device: wgpu::Device,
    /// The queue all work is submitted to.
    pub queue: wgpu::Queue,
    /// A number that no other device has, in any instance. (wgpu's own comparison is valid within an instance only.)
    id: u64,
    /// The reason why it cannot draw correctly, if any.
    unfit: Option<Arc<str>>,
    notices: Arc<Mutex<Notices>>,
}

/// The messages of the device's callbacks.
struct Notices {
    /// The first error outside of any call, until it is reported.
    failure: Option<String>,
    loss: Option<Loss>,
}

struct Loss {
    reason: String,
    /// Whether a report has it.
    told: bool,
}

impl Gpu {
    pub(super) fn of_adapter(instance: wgpu::Instance, adapter: wgpu::Adapter) -> Result<Self, RenderError> {
        let wanted = wgpu::Features::FLOAT32_BLENDABLE
            | wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES
            | wgpu::Features::TIMESTAMP_QUERY;
        if let Some(reason) = unfit(&adapter.get_info(), adapter.get_downlevel_capabilities().flags) {
            return Err(RenderError::NoDevice { adapter: adapter.get_info().name, reason });
        }
        let (device, queue) = block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("halfway"),
            required_features: wanted & adapter.features(),
            // All of the adapter's limits: large meshes and long light lists may need more than the defaults.
            required_limits: adapter.limits(),
            ..Default::default()
        }))
        .map_err(|error| RenderError::NoDevice { adapter: adapter.get_info().name, reason: error.to_string() })?;
        let gpu = Self::from_existing(instance, adapter, device, queue);
        gpu.listen();
        Ok(gpu)
    }

    /// A device that an engine has opened. It may lack any of wgpu's optional features and have the smallest limits;
    /// missing features are replaced by fallbacks, or reported in [`FrameReport::errors`](crate::FrameReport::errors).
    /// If its OpenGL is too old to draw correctly, each frame reports that.
    ///
    /// The device's callbacks stay the engine's: what goes wrong outside of any call, and the loss of the device, goes
    /// to whatever it has set with `on_uncaptured_error` and `set_device_lost_callback`. After a loss it inserts
    /// another `Gpu`. [`TextureTarget`](crate::TextureTarget) has a frame drawn by an encoder of the engine's own.
    ///
    /// [`from_existing`](Self::from_existing) takes the adapter, too.
    pub fn from_device(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        // Properties that a device does not report are taken at their worst.
        let unfit = unfit(&device.adapter_info(), wgpu::DownlevelFlags::all());
        Self::new((None, None), device, queue, unfit)
    }

    /// The same as [`from_device`](Self::from_device), with the instance and the adapter that the device came from. A
    /// [`SurfaceTarget`](crate::SurfaceTarget) needs them; on a device with `TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES`
    /// the adapter tells what more than the guaranteed it can do with formats; and OpenGL before 4.2 without compute
    /// shaders, which draws what is right, is known by it.
    pub fn from_existing(
        instance: wgpu::Instance,
        adapter: wgpu::Adapter,
        device: wgpu::Device,
        queue: wgpu::Queue,
    ) -> Self {
        let unfit = unfit(&adapter.get_info(), adapter.get_downlevel_capabilities().flags);
        Self::new((Some(instance), Some(adapter)), device, queue, unfit)
    }

    fn new(
        (instance, adapter): (Option<wgpu::Instance>, Option<wgpu::Adapter>),
        device: wgpu::Device,
        queue: wgpu::Queue,
        unfit: Option<String>,
    ) -> Self {
        static DEVICES: AtomicU64 = AtomicU64::new(0);
        let id = DEVICES.fetch_add(1, Ordering::Relaxed);
        let notices = Arc::new(Mutex::new(Notices { failure: None, loss: None }));
        Self { instance, adapter, device, queue, id, unfit: unfit.map(Arc::from), notices }
    }

    /// Registers the device's callbacks.
    fn listen(&self) {
        let notices = Arc::clone(&self.notices);
        self.device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            log::error!("{error}");
            lock(&notices).failure.get_or_insert(error.to_string());
        }));
        let notices = Arc::clone(&self.notices);
        self.device.set_device_lost_callback(move |reason, message| {
            lock(&notices).loss = Some(Loss { reason: describe_loss(reason, &message), told: false });
        });
    }

    /// Whether objects with images or a solid can be lit by an environment. llvmpipe through Vulkan (Mesa 22.3) crashes
    /// in draws that read both.
    pub fn lights_images_by_environments(&self) -> bool {
        let info = self.device.adapter_info();
        !(info.backend == wgpu::Backend::Vulkan && info.name.starts_with("llvmpipe"))
    }

    /// The features of a texture format on the device.
    pub(crate) fn format_features(&self, format: wgpu::TextureFormat) -> wgpu::TextureFormatFeatures {
        let features = self.device.features();
        let adapter = self.adapter.as_ref();
        match adapter.filter(|_| features.contains(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES)) {
            Some(adapter) => adapter.get_texture_format_features(format),
            None => format.guaranteed_format_features(features),
        }
    }

    /// Whether the device is known to be lost. Always `false` for an engine's device, whose loss only the engine learns
    /// of.
    pub fn is_lost(&self) -> bool {
        lock(&self.notices).loss.is_some()
    }

    /// A number that no other device of this program has. Devices of two instances of wgpu may compare as equal.
    pub fn id(&self) -> u64 {
        self.id
    }

    /// Polls the device for finished work and for its loss.
    ///
    /// # Errors
    /// [`RenderError::DeviceLost`], each time; the caller reports the loss.
    pub(crate) fn poll(&self, poll: wgpu::PollType) -> Result<(), RenderError> {
        if !self.is_lost() {
            // wgpu panics if polling itself detects the loss, after it has called the callback.
            let polled = catch_unwind(AssertUnwindSafe(|| self.device.poll(poll)));
            if !self.is_lost() {
                return match polled {
                    Ok(Ok(_)) => Ok(()),
                    Ok(Err(error)) => Err(RenderError::Device(error.to_string())),
                    Err(_) => Err(RenderError::Device("waiting for it failed".into())),
                };
            }
        }
        let mut notices = lock(&self.notices);
        let reason = notices.loss.as_mut().map(|loss| {
            loss.told = true;
            loss.reason.clone()
        });
        Err(RenderError::DeviceLost(reason.unwrap_or_default()))
    }

    /// The first error that the driver reported outside any call, unless it was taken before; for an unfit device the
    /// reason, each time.
    pub(crate) fn take_failure(&self) -> Option<RenderError> {
        let unfit = self.unfit.as_deref().map(str::to_owned);
        unfit.or_else(|| lock(&self.notices).failure.take()).map(RenderError::Device)
    }

    /// The loss of the device, if it was not reported yet.
    pub(crate) fn take_loss(&self) -> Option<RenderError> {
        let mut notices = lock(&self.notices);
        let loss = notices.loss.as_mut().filter(|loss| !loss.told)?;
        loss.told = true;
        Some(RenderError::DeviceLost(loss.reason.clone()))
    }

    /// The provoking vertex of triangles.
    pub(crate) fn provoking_vertex(&self) -> ProvokingVertex {
        ProvokingVertex::for_backend(self.device.adapter_info().backend)
    }

    /// Whether the adapter draws on the CPU.
    pub fn is_software(&self) -> bool {
        self.device.adapter_info().device_type == wgpu::DeviceType::Cpu
    }

    /// One line for people: the adapter's name, its backend, and whether it is software.
    pub fn describe(&self) -> String {
        describe_adapter(&self.device.adapter_info())
    }
}

/// One line for people: the adapter's name, its backend, and whether it is software.
pub(crate) fn describe_adapter(info: &wgpu::AdapterInfo) -> String {
    let software = if info.device_type == wgpu::DeviceType::Cpu { ", software" } else { "" };
    format!("{} ({}{software})", info.name, info.backend)
}

fn lock(notices: &Mutex<Notices>) -> MutexGuard<'_, Notices> {
    notices.lock().unwrap_or_else(PoisonError::into_inner)
}

fn describe_loss(reason: wgpu::DeviceLostReason, message: &str) -> String {
    match (reason, message.trim()) {
        (wgpu::DeviceLostReason::Destroyed, _) => "it was destroyed".into(),
        (_, "") => "the driver does not say why".into(),
        (_, message) => message.into(),
    }
}
