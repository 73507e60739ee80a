//! `halfway adapters`, and `--adapter`.

use clap::Args;
use clap::builder::NonEmptyStringValueParser;
use halfway::render::AdapterChoice;

use crate::failure::Failure;

#[derive(Args, Clone, Debug)]
pub(crate) struct AdapterArgs {
    /// The renderer: cpu, or cpu:avx2, say, for the CPU without a driver; or a graphics adapter, by a part of its name
    /// or its backend's, as `halfway adapters` lists them, or both, such as vulkan:llvmpipe or gpu for any of these
    /// [default: `HALFWAY_ADAPTER`, then `WGPU_BACKEND`, `WGPU_ADAPTER_NAME` and `VK_DRIVER_FILES`; else hardware, and
    /// without it the CPU]
    #[arg(id = "adapter", long = "adapter", value_name = "NAME", value_parser = NonEmptyStringValueParser::new())]
    name: Option<String>,
}

impl AdapterArgs {
    pub(crate) fn choice(&self) -> AdapterChoice {
        AdapterChoice { name: self.name.clone() }
    }
}

pub(crate) fn run() -> Result<(), Failure> {
    for adapter in AdapterChoice::default().list()? {
        println!("{adapter}");
    }
    Ok(())
}
