//! `halfway adapters`, and `--adapter`.

use clap::Args;
use clap::builder::NonEmptyStringValueParser;
use halfway::render::{AdapterChoice, RenderError, describe_adapter};

use crate::failure::Failure;

#[derive(Args, Clone, Debug)]
pub(crate) struct AdapterArgs {
    /// The graphics adapter: a part of its name or its backend's, as `halfway adapters` lists them, or both, such as
    /// vulkan:llvmpipe [default: `HALFWAY_ADAPTER`, then `WGPU_BACKEND` and `WGPU_ADAPTER_NAME`; else hardware
    /// first]
    #[arg(id = "adapter", long = "adapter", value_name = "NAME", value_parser = NonEmptyStringValueParser::new())]
    name: Option<String>,
}

impl AdapterArgs {
    pub(crate) fn choice(&self) -> AdapterChoice {
        AdapterChoice { name: self.name.clone() }
    }

    /// The arguments that mean the same, for another process.
    pub(crate) fn arguments(&self) -> Vec<String> {
        self.name.iter().flat_map(|name| ["--adapter".to_owned(), name.clone()]).collect()
    }
}

pub(crate) fn run() -> Result<(), Failure> {
    let adapters = AdapterChoice::default().list();
    if adapters.is_empty() {
        let error = AdapterChoice::default().open().err().unwrap_or(RenderError::NoAdapter);
        return Err(error.into());
    }
    for adapter in &adapters {
        println!("{}", describe_adapter(adapter));
    }
    Ok(())
}
