//! Whether a Vulkan driver is installed that can draw on this machine, told from files alone.
//!
//! This is a quick look before a long build, by the rules by which the Vulkan loader finds drivers ("Loader Interface
//! to Drivers" of the loader's documentation); whether the driver works is seen afterwards, by the built command.

use std::ffi::OsString;
use std::fmt;
use std::path::{Path, PathBuf};

use super::libraries::Libraries;

/// The loader, which finds the drivers.
const LOADER: &str = "libvulkan.so.1";

/// Where drivers may be.
#[derive(Debug)]
pub(crate) struct Drivers {
    libraries: Libraries,
    /// The files that describe drivers, one each.
    manifests: Vec<PathBuf>,
    /// Where devices are.
    devices: PathBuf,
}

/// Why there is nothing to draw with.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct NoDriver {
    /// One line for each thing that was found and would not do, or for what was not found.
    reasons: Vec<String>,
}

impl fmt::Display for NoDriver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no Vulkan driver that can draw on this machine ({})", self.reasons.join("; "))
    }
}

impl Drivers {
    /// Those of this machine.
    pub(crate) fn here() -> Self {
        let manifests = manifests(|name| std::env::var_os(name).filter(|value| !value.is_empty()));
        Self { libraries: Libraries::here(), manifests, devices: PathBuf::from("/dev") }
    }

    /// The manifest of a driver that can draw.
    ///
    /// # Errors
    /// What was found, and why it will not do.
    pub(crate) fn usable(&self) -> Result<&Path, NoDriver> {
        if !self.libraries.has(LOADER) {
            return Err(NoDriver { reasons: vec![format!("the loader {LOADER} is missing")] });
        }
        let mut reasons = Vec::new();
        for manifest in &self.manifests {
            match self.judge(manifest) {
                Ok(()) => return Ok(manifest),
                Err(reason) => reasons.push(format!("{}: {reason}", manifest.display())),
            }
        }
        if reasons.is_empty() {
            reasons.push("no driver is installed".into());
        }
        Err(NoDriver { reasons })
    }

    fn judge(&self, manifest: &Path) -> Result<(), String> {
        let json = std::fs::read_to_string(manifest).map_err(|error| error.to_string())?;
        let json: serde_json::Value = serde_json::from_str(&json).map_err(|error| format!("not JSON: {error}"))?;
        let library = json["ICD"]["library_path"].as_str().ok_or("names no library_path")?;
        // A path without a folder is the dynamic loader's to find; other relative ones start at the manifest.
        let folder = manifest.parent().filter(|_| library.contains('/')).unwrap_or(Path::new(""));
        let library = folder.join(library).to_string_lossy().into_owned();
        if !self.libraries.has(&library) {
            return Err(format!("its library {library} is missing"));
        }
        let device = Device::of(manifest, &library);
        if self.has(device) { Ok(()) } else { Err(format!("needs {}", device.name())) }
    }

    fn has(&self, device: Device) -> bool {
        let any = |folder: PathBuf, start: &str| {
            let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
            entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).any(|name| {
                name.strip_prefix(start).is_some_and(|number| number.starts_with(|digit: char| digit.is_ascii_digit()))
            })
        };
        match device {
            Device::Processor => true,
            Device::Nvidia => any(self.devices.clone(), "nvidia"),
            Device::DirectX => self.devices.join("dxg").exists(),
            Device::Card => any(self.devices.join("dri"), "renderD"),
        }
    }
}

/// What a driver draws with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Device {
    /// The processor: always there.
    Processor,
    /// A card behind NVIDIA's own kernel driver.
    Nvidia,
    /// The graphics card of a Windows host.
    DirectX,
    /// A card behind one of Linux' kernel drivers.
    Card,
}

impl Device {
    fn of(manifest: &Path, library: &str) -> Self {
        let named = format!("{} {library}", manifest.file_name().unwrap_or_default().to_string_lossy()).to_lowercase();
        let is = |names: &[&str]| names.iter().any(|name| named.contains(name));
        if is(&["lvp", "lavapipe", "swrast", "swiftshader"]) {
            Self::Processor
        } else if is(&["nvidia"]) {
            Self::Nvidia
        } else if is(&["dzn"]) {
            Self::DirectX
        } else {
            Self::Card
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Processor => "a processor",
            Self::Nvidia => "an NVIDIA card (/dev/nvidia0)",
            Self::DirectX => "a Windows host (/dev/dxg)",
            Self::Card => "a graphics card (/dev/dri/renderD128)",
        }
    }
}

/// The manifests that the Vulkan loader reads, in its order.
fn manifests(variable: impl Fn(&str) -> Option<OsString>) -> Vec<PathBuf> {
    let list = |name: &str| -> Vec<PathBuf> {
        variable(name).map(|value| std::env::split_paths(&value).collect()).unwrap_or_default()
    };
    let only = variable("VK_DRIVER_FILES").or_else(|| variable("VK_ICD_FILENAMES"));
    if let Some(only) = only {
        return std::env::split_paths(&only).flat_map(expanded).collect();
    }
    let home = variable("HOME").map(PathBuf::from);
    let own = |name: &str, default: &str| variable(name).map(PathBuf::from).or(home.as_ref().map(|h| h.join(default)));
    let shared = |name: &str, default: &[&str]| {
        let given = list(name);
        if given.is_empty() { default.iter().map(PathBuf::from).collect() } else { given }
    };
    let mut folders: Vec<PathBuf> = own("XDG_CONFIG_HOME", ".config").into_iter().collect();
    folders.extend(shared("XDG_CONFIG_DIRS", &["/etc/xdg"]));
    folders.push("/etc".into());
    folders.extend(own("XDG_DATA_HOME", ".local/share"));
    folders.extend(shared("XDG_DATA_DIRS", &["/usr/local/share", "/usr/share"]));
    folders.push("/run/opengl-driver/share".into());
    let found = folders.into_iter().flat_map(|folder| expanded(folder.join("vulkan/icd.d")));
    list("VK_ADD_DRIVER_FILES").into_iter().flat_map(expanded).chain(found).collect()
}

/// The path itself, or the manifests in it where it is a folder, sorted by name.
fn expanded(path: PathBuf) -> Vec<PathBuf> {
    if !path.is_dir() {
        return if path.is_file() { vec![path] } else { Vec::new() };
    }
    let entries = std::fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut manifests: Vec<_> = entries.filter(|path| path.extension().is_some_and(|end| end == "json")).collect();
    manifests.sort();
    manifests
}

#[cfg(test)]
mod tests;
