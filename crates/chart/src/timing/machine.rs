//! The machine that figures come from.

use halfway::render::{Adapter, Cpu};
use serde::Serialize;

/// The machine and the programs that figures come from. Unknown facts are `unknown`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Machine {
    /// The adapter's name from its driver; for the CPU without a driver, its vectors.
    pub adapter: String,
    /// The graphics API, such as `vulkan`, or `cpu`.
    pub backend: String,
    /// Whether the adapter draws on the CPU.
    pub software: bool,
    /// The driver's name.
    pub driver: String,
    /// The driver's version, in its own words.
    pub driver_version: String,
    /// halfway's version.
    pub halfway: &'static str,
    /// The CPU's model.
    pub cpu: String,
    /// The threads that this process may run at once; 0 where the system does not tell.
    pub cores: usize,
}

impl Machine {
    /// This machine, drawing on `adapter`.
    pub fn new(adapter: &Adapter) -> Self {
        let known = |text: String| if text.is_empty() { UNKNOWN.to_owned() } else { text };
        let [name, backend, driver, driver_version] = match adapter {
            Adapter::Gpu(gpu) => {
                let info = gpu.device.adapter_info();
                [info.name, info.backend.to_string(), info.driver, info.driver_info]
            }
            Adapter::Cpu(cpu) => [cpu.vectors(), Cpu::NAME.into(), "halfway".into(), env!("CARGO_PKG_VERSION").into()],
        };
        Self {
            adapter: known(name),
            backend,
            software: adapter.is_software(),
            driver: known(driver),
            driver_version: known(driver_version),
            halfway: env!("CARGO_PKG_VERSION"),
            cpu: this_cpu(),
            cores: cores(),
        }
    }

    /// Names and values, for people.
    pub fn facts(&self) -> Vec<(String, String)> {
        let software = if self.software { ", software" } else { "" };
        let own = [
            ("adapter", format!("{} ({}{software})", self.adapter, self.backend)),
            ("driver", format!("{} {}", self.driver, self.driver_version)),
        ];
        own.map(|(name, value)| (name.to_owned(), value))
            .into_iter()
            .chain(processor(self.halfway, self.cpu.clone(), self.cores))
            .collect()
    }

    /// Names and values for programs that run without an adapter.
    pub fn processor() -> Vec<(String, String)> {
        processor(env!("CARGO_PKG_VERSION"), this_cpu(), cores()).into()
    }
}

fn processor(halfway: &str, cpu: String, cores: usize) -> [(String, String); 3] {
    let cores = if cores == 0 { UNKNOWN.to_owned() } else { cores.to_string() };
    [("halfway", halfway.to_owned()), ("CPU", cpu), ("CPU cores", cores)].map(|(name, value)| (name.to_owned(), value))
}

fn this_cpu() -> String {
    cpu_model(&std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default())
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(0, Into::into)
}

const UNKNOWN: &str = "unknown";

/// The first model that Linux's list of processors names.
fn cpu_model(list: &str) -> String {
    let model = list.lines().find_map(|line| {
        let (key, value) = line.split_once(':')?;
        (key.trim() == "model name").then(|| value.trim())
    });
    model.filter(|model| !model.is_empty()).unwrap_or(UNKNOWN).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn processors_by_their_model() {
        let list = "processor\t: 0\nmodel\t\t: 85\nmodel name\t: A CPU: fast @ 2 GHz\n\nmodel name\t: Another\n";
        assert_eq!(cpu_model(list), "A CPU: fast @ 2 GHz");
        for list in ["", "model name\t:\n", "Hardware : board\n"] {
            assert_eq!(cpu_model(list), "unknown", "{list:?}");
        }
    }
}
