//! Instances of wgpu, which create adapters and surfaces.

/// An instance with only these backends. `display` is that of the window, if any.
pub(crate) fn instance(
    backends: wgpu::Backends,
    display: Option<Box<dyn wgpu::wgt::WgpuHasDisplayHandle>>,
) -> wgpu::Instance {
    #[cfg(target_os = "linux")]
    if backends.contains(wgpu::Backends::VULKAN)
        && let Some(instance) = without_wayland()
    {
        return instance;
    }
    let descriptor = wgpu::InstanceDescriptor { display, ..wgpu::InstanceDescriptor::new_without_display_handle() };
    // The variable that limits backends is already applied.
    wgpu::Instance::new(wgpu::InstanceDescriptor { backends, ..descriptor.with_env() })
}

/// An instance of Vulkan without Wayland surfaces, if there can be none; else `None`.
///
/// With them Mesa's layer `VK_LAYER_MESA_device_select` asks the Wayland library for a display while adapters are
/// listed, and without `XDG_RUNTIME_DIR` that library prints an error line.
#[cfg(target_os = "linux")]
fn without_wayland() -> Option<wgpu::Instance> {
    use wgpu::hal::vulkan;
    let unreachable = ["XDG_RUNTIME_DIR", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"];
    let flags = wgpu::InstanceFlags::default();
    // An instance made from a driver's instance has the default flags.
    if unreachable.iter().any(|variable| std::env::var_os(variable).is_some()) || flags.with_env() != flags {
        return None;
    }
    let descriptor = wgpu::hal::InstanceDescriptor {
        name: "wgpu",
        flags,
        memory_budget_thresholds: wgpu::MemoryBudgetThresholds::default(),
        backend_options: wgpu::BackendOptions::from_env_or_default(),
        telemetry: None,
        display: None,
    };
    let leave_out: Box<vulkan::CreateInstanceCallback> =
        Box::new(|arguments| arguments.extensions.retain(|&name| name != c"VK_KHR_wayland_surface"));
    #[expect(unsafe_code, reason = "only the driver's own instance can be made without one extension")]
    // SAFETY: wgpu-hal asks not to remove extensions because it takes the supported ones for enabled. This one it uses
    // in one function, `create_surface_from_wayland`, which first looks it up among those that are enabled and returns
    // an error without it (30.0.1). Nothing else is changed, and the instance goes to wgpu whole.
    unsafe {
        let instance = vulkan::Instance::init_with_callback(&descriptor, Some(leave_out)).ok()?;
        Some(wgpu::Instance::from_hal::<wgpu::hal::api::Vulkan>(instance))
    }
}
