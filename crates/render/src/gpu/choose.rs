//! Selects the graphics adapter of a choice.

use crate::adapter::Adapter;
use crate::choice::{ANY, AdapterChoice, variable};
use crate::cpu::device::Cpu;
use crate::gpu::device::{Gpu, describe_adapter};
use crate::gpu::instance::instance;
use futures_lite::future::block_on;
use halfway_frame::error::RenderError;
use std::path::Path;

impl AdapterChoice {
    /// Opens a graphics adapter, for pictures without a window: a software one if there is no other, and never the CPU
    /// without a driver.
    ///
    /// # Errors
    /// [`RenderError::NoAdapter`], [`RenderError::NoAdapterAmong`], [`RenderError::NoSuchAdapter`] or
    /// [`RenderError::NoDevice`], each with what to do about it.
    pub fn open_gpu(&self) -> Result<Gpu, RenderError> {
        let (instance, adapter) = self.wanted(variable).find()?;
        Gpu::of_adapter(instance, adapter)
    }

    /// Opens the adapter for a window: a graphics adapter with a surface that it can present to, or the CPU, which
    /// needs none. `display` is the display of the surface's window, which OpenGL requires; `make_surface` makes the
    /// surface from an instance, and may be called once a backend.
    ///
    /// # Errors
    /// Those of [`open`](Self::open) and of `make_surface`.
    pub fn open_for<E: From<RenderError>>(
        &self,
        display: &(impl wgpu::wgt::WgpuHasDisplayHandle + Clone),
        mut make_surface: impl FnMut(&wgpu::Instance) -> Result<wgpu::Surface<'static>, E>,
    ) -> Result<(Adapter, Option<wgpu::Surface<'static>>), E> {
        if let Some(cpu) = self.open_cpu(variable) {
            return Ok((Adapter::Cpu(cpu?), None));
        }
        let wanted = self.wanted(variable).or_the_cpu(self, variable);
        let mut refused = None;
        for &backends in &wanted.rounds {
            let instance = instance(backends, Some(Box::new(display.clone())));
            match make_surface(&instance) {
                Ok(surface) => {
                    if let Some(adapter) = wanted.pick(&instance, backends, Some(&surface)) {
                        if !wanted.takes(&adapter) {
                            break;
                        }
                        return Ok((Adapter::Gpu(Gpu::of_adapter(instance, adapter)?), Some(surface)));
                    }
                }
                // Without any driver there is no surface either, and the missing driver is the error to report.
                Err(error) if enumerate(&instance, backends).iter().any(|there| wanted.takes(there)) => {
                    refused = Some(error);
                }
                Err(_) => {}
            }
        }
        match (refused, wanted.missing()) {
            (Some(error), _) => Err(error),
            (None, RenderError::NoAdapter) => Ok((Adapter::Cpu(Cpu::open()?), None)),
            (None, missing) => Err(missing.into()),
        }
    }

    /// Opens the adapter if the name does not select the CPU.
    pub(crate) fn open_other(&self) -> Result<Adapter, RenderError> {
        match self.wanted(variable).or_the_cpu(self, variable).find() {
            Err(RenderError::NoAdapter) => Cpu::open().map(Adapter::Cpu),
            Err(missing) => Err(missing),
            Ok((instance, adapter)) => Gpu::of_adapter(instance, adapter).map(Adapter::Gpu),
        }
    }

    /// The line of [`list`](Self::list) for the adapter that [`open_other`](Self::open_other) opens.
    pub(crate) fn describe_other(&self) -> Result<String, RenderError> {
        match self.wanted(variable).or_the_cpu(self, variable).find() {
            Ok((_, adapter)) => Ok(describe_adapter(&adapter.get_info())),
            Err(RenderError::NoAdapter) => Ok(Cpu::open()?.describe()),
            Err(missing) => Err(missing),
        }
    }

    /// The lines of [`list`](Self::list), of which the first is known.
    #[expect(clippy::unused_self, clippy::unnecessary_wraps, reason = "as without wgpu")]
    pub(crate) fn list_after(&self, first: String) -> Result<Vec<String>, RenderError> {
        let rounds = AdapterChoice::default().wanted(|name| variable(name).filter(|_| name == BACKEND)).rounds;
        let mut all = vec![first];
        for adapter in there(&rounds) {
            if !all.contains(&adapter) {
                all.push(adapter);
            }
        }
        Ok(all)
    }

    fn wanted(&self, variable: impl Fn(&str) -> Option<String>) -> Wanted {
        if let Some(text) = self.given(&variable).filter(|text| !text.eq_ignore_ascii_case(ANY)) {
            let name = AdapterName::new(&text);
            let rounds = ROUNDS.map(|round| round & name.backends()).into_iter().filter(|round| !round.is_empty());
            return Wanted { rounds: rounds.collect(), name: Some(name), limited: None, hardware: false };
        }
        let limited = variable(BACKEND);
        let rounds = limited.as_deref().map_or(ROUNDS.to_vec(), |list| vec![wgpu::Backends::from_comma_list(list)]);
        let name = variable("WGPU_ADAPTER_NAME").map(|text| AdapterName::new(&text));
        Wanted { name, rounds, limited, hardware: false }
    }
}

impl Gpu {
    /// Opens a graphics adapter that needs no window, the one that [`AdapterChoice::default`] finds.
    ///
    /// # Errors
    /// As [`AdapterChoice::open_gpu`].
    pub fn open_headless() -> Result<Self, RenderError> {
        AdapterChoice::default().open_gpu()
    }
}

/// The variable that limits the backends.
const BACKEND: &str = "WGPU_BACKEND";

/// Whether there may be a graphics card: on Linux, whether the kernel lists one among its devices. The nodes are those
/// of its own drivers, of NVIDIA's, of WSL, and of mobile GPUs.
fn may_have_hardware(devices: &Path) -> bool {
    const NODES: [&str; 7] = ["nvidia", "dxg", "kgsl", "mali", "pvr", "galcore", "vchiq"];
    let names = |folder: &Path| -> Vec<String> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
    };
    !cfg!(target_os = "linux")
        || names(devices).iter().any(|name| NODES.iter().any(|node| name.starts_with(node)))
        || names(&devices.join("dri")).iter().any(|name| name.starts_with("renderD"))
}

/// The variables that limit the Vulkan drivers.
const DRIVERS: [&str; 2] = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"];

/// The backends that are asked first, and those that are asked if no adapter is found.
const ROUNDS: [wgpu::Backends; 2] = [wgpu::Backends::PRIMARY, wgpu::Backends::GL];

/// The requested adapter.
#[derive(Debug, PartialEq, Eq)]
struct Wanted {
    name: Option<AdapterName>,
    rounds: Vec<wgpu::Backends>,
    /// The limit that `WGPU_BACKEND` sets.
    limited: Option<String>,
    /// Whether only hardware is accepted.
    hardware: bool,
}

impl Wanted {
    /// Prefers the CPU to a software adapter that was not requested.
    fn or_the_cpu(self, choice: &AdapterChoice, variable: impl Fn(&str) -> Option<String>) -> Self {
        let named = choice.given(&variable).is_some() || self.name.is_some() || self.limited.is_some();
        let hardware = !named && !DRIVERS.iter().any(|name| variable(name).is_some());
        // Asking would load software drivers, which takes longer than a first frame.
        let rounds = if hardware && !may_have_hardware(Path::new("/dev")) { Vec::new() } else { self.rounds };
        Self { rounds, hardware, ..self }
    }

    fn takes(&self, adapter: &wgpu::Adapter) -> bool {
        !self.hardware || adapter.get_info().device_type != wgpu::DeviceType::Cpu
    }

    fn find(&self) -> Result<(wgpu::Instance, wgpu::Adapter), RenderError> {
        let found = self.rounds.iter().find_map(|&backends| {
            let instance = instance(backends, None);
            let adapter = self.pick(&instance, backends, None)?;
            Some((instance, adapter))
        });
        found.filter(|(_, adapter)| self.takes(adapter)).ok_or_else(|| self.missing())
    }

    fn pick(
        &self,
        instance: &wgpu::Instance,
        backends: wgpu::Backends,
        surface: Option<&wgpu::Surface<'_>>,
    ) -> Option<wgpu::Adapter> {
        let Some(name) = &self.name else {
            let options = wgpu::RequestAdapterOptions {
                power_preference: wgpu::PowerPreference::from_env().unwrap_or(wgpu::PowerPreference::HighPerformance),
                compatible_surface: surface,
                ..Default::default()
            };
            return block_on(instance.request_adapter(&options)).ok();
        };
        let fitting = enumerate(instance, backends).into_iter().filter(|adapter| name.fits(&adapter.get_info()));
        let able = fitting.filter(|adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface)));
        able.min_by_key(|adapter| rank(adapter.get_info().device_type))
    }

    /// The error of not having found it.
    fn missing(&self) -> RenderError {
        match (&self.name, &self.limited) {
            (Some(name), limited) => {
                // The adapters to choose from by name; the limit applies only to a name of wgpu's own variable.
                let rounds = if limited.is_some() { &self.rounds[..] } else { &ROUNDS };
                RenderError::NoSuchAdapter { wanted: name.0.clone(), there: there(rounds) }
            }
            (None, Some(backends)) => RenderError::NoAdapterAmong { backends: backends.clone() },
            (None, None) => RenderError::NoAdapter,
        }
    }
}

/// A line for each adapter of these backends, in the order in which they are asked, and for the CPU.
fn there(rounds: &[wgpu::Backends]) -> Vec<String> {
    let of = |&backends: &wgpu::Backends| enumerate(&instance(backends, None), backends);
    let adapters = rounds.iter().flat_map(of).map(|adapter| describe_adapter(&adapter.get_info()));
    adapters.chain(Cpu::open().ok().map(|cpu| cpu.describe())).collect()
}

fn enumerate(instance: &wgpu::Instance, backends: wgpu::Backends) -> Vec<wgpu::Adapter> {
    block_on(instance.enumerate_adapters(backends))
}

/// The preference of a kind of device: lower is better.
fn rank(kind: wgpu::DeviceType) -> u8 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}

/// The backends by their names for users.
const BACKENDS: [(&str, wgpu::Backends); 5] = [
    ("vulkan", wgpu::Backends::VULKAN),
    ("metal", wgpu::Backends::METAL),
    ("dx12", wgpu::Backends::DX12),
    ("gl", wgpu::Backends::GL),
    ("opengl", wgpu::Backends::GL),
];

/// A user's name for an adapter, in lower case.
#[derive(Clone, Debug, PartialEq, Eq)]
struct AdapterName(String);

impl AdapterName {
    fn new(text: &str) -> Self {
        Self(text.to_lowercase())
    }

    fn fits(&self, info: &wgpu::AdapterInfo) -> bool {
        let (backend, part) = self.parts();
        let is_backend = |backends: wgpu::Backends| backends.contains(info.backend.into());
        let in_name = info.name.to_lowercase().contains(part);
        match backend {
            Some(backends) => is_backend(backends) && in_name,
            None => in_name || is_backend(backends_of(part)),
        }
    }

    /// The backends that may have an adapter of this name.
    fn backends(&self) -> wgpu::Backends {
        self.parts().0.unwrap_or(wgpu::Backends::all())
    }

    /// The backends, if the text names one in full or before a colon; and a part of the adapter's name.
    fn parts(&self) -> (Option<wgpu::Backends>, &str) {
        if let Some((_, backends)) = BACKENDS.iter().find(|(name, _)| *name == self.0) {
            return (Some(*backends), "");
        }
        // A colon may also belong to the adapter's name.
        match self.0.split_once(':') {
            Some((backend, part)) if !backends_of(backend).is_empty() => (Some(backends_of(backend)), part.trim()),
            _ => (None, &self.0),
        }
    }
}

/// The backends with names that `part` is a part of; none for an empty one.
fn backends_of(part: &str) -> wgpu::Backends {
    let named = BACKENDS.iter().filter(|(name, _)| !part.is_empty() && name.contains(part));
    named.fold(wgpu::Backends::empty(), |all, (_, backends)| all | *backends)
}

#[cfg(test)]
mod tests {
    use super::*;
    use wgpu::{Backend, Backends, DeviceType};

    fn info(name: &str, backend: Backend) -> wgpu::AdapterInfo {
        wgpu::AdapterInfo { name: name.into(), ..wgpu::AdapterInfo::new(DeviceType::Cpu, backend) }
    }

    #[test]
    fn names_fit_parts_of_adapters_and_backends() {
        let vulkan = info("llvmpipe (LLVM 15.0.6, 256 bits)", Backend::Vulkan);
        let gl = info("llvmpipe (LLVM 15.0.6, 256 bits)", Backend::Gl);
        // Many names contain the letters of a backend.
        let intel = info("Intel(R) Iris(R) Xe Graphics (TGL GT2)", Backend::Vulkan);
        let rows = [
            ("llvmpipe", [true, true, false]),
            ("LLVM", [true, true, false]),
            ("vulkan:llvmpipe", [true, false, false]),
            ("gl:llvmpipe", [false, true, false]),
            ("OpenGL: llvmpipe", [false, true, false]),
            ("vulkan", [true, false, true]),
            ("vulk", [true, false, true]),
            ("gl", [false, true, false]),
            ("opengl", [false, true, false]),
            ("vulkan:", [true, false, true]),
            ("(tgl", [false, false, true]),
            ("intel", [false, false, true]),
            ("metal", [false; 3]),
            ("metal:llvmpipe", [false; 3]),
            ("nothing:llvmpipe", [false; 3]),
            (":llvmpipe", [false; 3]),
        ];
        for (name, expected) in rows {
            assert_eq!([&vulkan, &gl, &intel].map(|info| AdapterName::new(name).fits(info)), expected, "{name}");
        }
    }

    #[test]
    fn a_software_adapter_is_taken_only_where_it_is_asked_for() {
        let hardware = |own: Option<&str>, set: &[&str]| {
            let choice = AdapterChoice { name: own.map(str::to_owned) };
            let variable = |name: &str| set.contains(&name).then(|| "A".to_owned());
            choice.wanted(variable).or_the_cpu(&choice, variable).hardware
        };
        assert!(hardware(None, &[]));
        assert!(!hardware(Some("llvmpipe"), &[]));
        assert!(!hardware(Some("GPU"), &[]));
        for name in ["HALFWAY_ADAPTER", "WGPU_BACKEND", "WGPU_ADAPTER_NAME", "VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
            assert!(!hardware(None, &[name]), "{name}");
        }
        assert!(!AdapterChoice::default().wanted(|_| None).hardware, "`open_gpu` takes what there is");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_kernel_lists_graphics_cards() {
        let folder = std::env::temp_dir().join(format!("halfway_devices_{}", std::process::id()));
        let with = |node: &str| {
            let path = folder.join(node);
            std::fs::create_dir_all(&path).expect("a folder of its own");
            let found = may_have_hardware(&folder);
            std::fs::remove_dir_all(&folder).expect("it was made");
            found
        };
        assert!(!may_have_hardware(&folder), "a folder that is not there");
        for node in ["null", "dri/card0", "dri/by-path", "fb0"] {
            assert!(!with(node), "{node}");
        }
        for node in ["dri/renderD128", "nvidia0", "nvidiactl", "dxg", "mali0", "kgsl-3d0"] {
            assert!(with(node), "{node}");
        }
    }

    #[test]
    fn the_more_specific_choice_wins() {
        let wanted = |own: Option<&str>, set: &[(&str, &str)]| {
            let choice = AdapterChoice { name: own.map(str::to_owned) };
            let variable = |name: &str| set.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).to_owned());
            let Wanted { name, rounds, .. } = choice.wanted(variable);
            (name.map(|name| name.0), rounds)
        };
        let both = vec![Backends::PRIMARY, Backends::GL];
        let named = |name: &str| Some(name.to_owned());
        let all = [("HALFWAY_ADAPTER", "B"), ("WGPU_BACKEND", "gl"), ("WGPU_ADAPTER_NAME", "C")];
        assert_eq!(wanted(Some("A"), &all), (named("a"), both.clone()));
        assert_eq!(wanted(None, &all), (named("b"), both.clone()));
        assert_eq!(wanted(None, &all[1..]), (named("c"), vec![Backends::GL]));
        assert_eq!(wanted(None, &all[2..]), (named("c"), both.clone()));
        assert_eq!(wanted(None, &all[1..2]), (None, vec![Backends::GL]));
        assert_eq!(wanted(None, &[]), (None, both.clone()));
        assert_eq!(wanted(Some(""), &[]), (None, both.clone()));
        // Any graphics adapter, limited by wgpu's variables.
        assert_eq!(wanted(Some("gpu"), &all), (named("c"), vec![Backends::GL]));
        assert_eq!(wanted(None, &[("HALFWAY_ADAPTER", "GPU"), all[1]]), (None, vec![Backends::GL]));
        assert_eq!(wanted(Some("gpu"), &[]), (None, both));
        // Backends that a name leaves out are not asked.
        assert_eq!(wanted(Some("gl:a"), &[]).1, [Backends::GL]);
        assert_eq!(wanted(Some("vulkan"), &[]).1, [Backends::VULKAN]);
    }
}
