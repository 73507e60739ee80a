//! What drawing costs on an adapter, kept on disk from `halfway calibrate` to `halfway view` and `halfway bench`.

mod text;

use std::ffi::OsString;
use std::io::Read;
use std::path::{Path, PathBuf};

use halfway::prelude::*;
use halfway::render::{Adapter, Calibration, VertexPrices};
use halfway_chart::timing::Machine;
use serde_json::{Value, json};

/// What prices hold for, in words: the adapter, its driver, the CPU that may draw in it, and the ways of drawing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PricedAdapter(Vec<(&'static str, String)>);

/// The folder of kept prices: a file for each adapter. Anything in it may be deleted at any time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PriceFolder(PathBuf);

/// What an adapter is drawn on by.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PricesInUse {
    /// `None` for the adapter's own.
    kept: Option<(VertexPrices, PathBuf)>,
}

/// A file of prices has about a thousand bytes; what is longer is none.
const LONGEST: u64 = 1 << 16;

impl PricedAdapter {
    pub(crate) fn new(adapter: &Adapter) -> Self {
        let Machine { adapter: name, backend, software, driver, driver_version, cpu, cores, .. } =
            Machine::new(adapter);
        let ways = if adapter.costs().shaders_encode { "software" } else { "hardware" };
        // The CPU counts on hardware as well: it looks at lights.
        Self(vec![
            ("adapter", name),
            ("backend", backend),
            ("software", software.to_string()),
            ("driver", driver),
            ("driver_version", driver_version),
            ("ways", ways.to_owned()),
            ("cpu", cpu),
            ("cores", cores.to_string()),
        ])
    }

    /// The name of its file: a few letters for people, and a number for all of it.
    fn file_name(&self) -> String {
        let letters = self.0.iter().take(2).map(|(_, value)| value.as_str()).collect::<Vec<_>>().join("-");
        let mut plain: String =
            letters.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '-' }).collect();
        plain.truncate(40);
        let parts = self.0.iter().flat_map(|(name, value)| [name.as_bytes(), b"=", value.as_bytes(), b"\n"]);
        format!("prices-{}-{:016x}.json", plain.to_lowercase(), fnv(parts.flatten().copied()))
    }

    pub(crate) fn json(&self) -> Value {
        self.0.iter().map(|(name, value)| ((*name).to_owned(), json!(value))).collect::<serde_json::Map<_, _>>().into()
    }
}

/// The hash of Fowler, Noll and Vo, FNV-1a in 64 bits: the same in every program.
fn fnv(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

impl PriceFolder {
    /// The user's, if the environment says where: `$HALFWAY_CACHE`, none where that is empty; else `halfway` in
    /// `$XDG_CACHE_HOME`, else in `~/.cache`; on Windows in `%LOCALAPPDATA%`.
    pub(crate) fn of_user() -> Option<Self> {
        Self::named_by(|variable| std::env::var_os(variable))
    }

    fn named_by(variable: impl Fn(&str) -> Option<OsString>) -> Option<Self> {
        if let Some(own) = variable("HALFWAY_CACHE") {
            return (!own.is_empty()).then(|| Self(own.into()));
        }
        // A relative path would be another folder for each working folder: the XDG specification has it ignored.
        let folder = |name| variable(name).map(PathBuf::from).filter(|folder| folder.is_absolute());
        let cache = folder("XDG_CACHE_HOME").or_else(|| folder("HOME").map(|home| home.join(".cache")));
        cache.or_else(|| folder("LOCALAPPDATA")).map(|cache| Self(cache.join("halfway")))
    }

    /// Of the prices of this adapter.
    pub(crate) fn file(&self, of: &PricedAdapter) -> PathBuf {
        self.0.join(of.file_name())
    }

    /// What was kept: nothing where there is no file, and a sentence where it cannot be used.
    fn read(&self, of: &PricedAdapter) -> Result<Option<(VertexPrices, PathBuf)>, String> {
        let file = self.file(of);
        let said = |problem: String| format!("{}: {problem}", file.display());
        match limited(&file) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(said(error.to_string())),
            Ok(text) => text::read(&text, of).map(|prices| Some((prices, file.clone()))).map_err(said),
        }
    }
}

/// Keeps what was measured. The file appears when it is complete.
pub(crate) fn keep(file: &Path, of: &PricedAdapter, found: &Calibration) -> Result<(), String> {
    halfway::output::write_text(file, &text::written(of, found)).map_err(|error| error.to_string())
}

fn limited(file: &Path) -> std::io::Result<String> {
    let mut text = String::new();
    std::fs::File::open(file)?.take(LONGEST).read_to_string(&mut text)?;
    Ok(text)
}

impl PricesInUse {
    /// What is kept for this adapter, else its own prices. What is there and cannot be used is told, once.
    pub(crate) fn of(adapter: &Adapter) -> Self {
        let folder = PriceFolder::of_user();
        let kept = folder.map_or(Ok(None), |folder| folder.read(&PricedAdapter::new(adapter)));
        let kept = kept.unwrap_or_else(|problem| {
            eprintln!("warning: {problem}; not used, and `halfway calibrate` measures anew");
            None
        });
        Self { kept }
    }

    /// Has the App draw by them.
    pub(crate) fn insert_into(&self, world: &mut World) {
        if let Some((prices, _)) = &self.kept {
            world.insert_resource(*prices);
        }
    }

    /// Whether they are measured.
    #[cfg(feature = "window")]
    pub(crate) fn is_kept(&self) -> bool {
        self.kept.is_some()
    }

    /// In a few words.
    pub(crate) fn describe(&self) -> String {
        match &self.kept {
            None => "those fixed for this kind of adapter".to_owned(),
            Some((_, file)) => format!("measured, from {}", file.display()),
        }
    }

    /// Where they come from, and what they are on `adapter`; what is infinite is null.
    pub(crate) fn json(&self, adapter: &Adapter) -> Value {
        let prices = self.kept.as_ref().map_or(adapter.costs().vertices, |(prices, _)| *prices);
        let mut json = text::prices(&prices);
        json["measured"] = json!(self.kept.is_some());
        json["file"] = json!(self.kept.as_ref().map(|(_, file)| file.display().to_string()));
        json
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: [&str; 4]) -> PricedAdapter {
        PricedAdapter(
            ["adapter", "backend", "driver", "driver_version"].into_iter().zip(values.map(String::from)).collect(),
        )
    }

    #[test]
    fn each_adapter_and_driver_has_a_file_of_its_own() {
        let all = [
            of(["llvmpipe (LLVM 15)", "vulkan", "llvmpipe", "Mesa 22.3"]),
            of(["llvmpipe (LLVM 15)", "vulkan", "llvmpipe", "Mesa 22.4"]),
            of(["llvmpipe (LLVM 15)", "gl", "llvmpipe", "Mesa 22.3"]),
            of(["llvmpipe (LLVM 16)", "vulkan", "llvmpipe", "Mesa 22.3"]),
            of(["../../ä€", "vulkan", "llvmpipe", ""]),
        ];
        for (i, one) in all.iter().enumerate() {
            let name = one.file_name();
            assert!(name.len() < 80 && !name.contains(['/', '\\', ' ']) && name.is_ascii(), "{name}");
            for other in &all[..i] {
                assert_ne!(name, other.file_name());
            }
        }
        assert!(all[0].file_name().starts_with("prices-llvmpipe--llvm-15--vulkan-"), "{}", all[0].file_name());
        // From the authors' tables of the hash.
        assert_eq!(fnv(b"foobar".iter().copied()), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn what_cannot_be_written_is_said() {
        let found = Calibration {
            unit_ns: 1.0,
            vertex_ns: 1.0,
            measured: VertexPrices::FREE,
            prices: VertexPrices::FREE,
            doubts: Vec::new(),
            weight: Some(1.0),
            trial: 1.0,
        };
        let program = std::env::current_exe().expect("a program");
        let beneath = program.join("prices.json");
        let said = keep(&beneath, &of(["", "", "", ""]), &found).expect_err("a program is no folder");
        assert!(said.contains("prices.json"), "{said}");
    }

    #[test]
    fn the_folder_is_where_the_environment_says() {
        let folder = |set: &[(&str, &str)]| {
            let find =
                |name: &str| set.iter().find(|(known, _)| *known == name).map(|(_, value)| OsString::from(value));
            PriceFolder::named_by(find).map(|PriceFolder(folder)| folder)
        };
        assert_eq!(folder(&[]), None);
        assert_eq!(folder(&[("XDG_CACHE_HOME", ""), ("HOME", "home")]), None, "relative paths do not count");
        assert_eq!(folder(&[("HALFWAY_CACHE", "here"), ("HOME", "/home/ada")]), Some("here".into()));
        assert_eq!(folder(&[("HALFWAY_CACHE", ""), ("HOME", "/home/ada")]), None);
        if cfg!(unix) {
            assert_eq!(folder(&[("HOME", "/home/ada")]), Some("/home/ada/.cache/halfway".into()));
            let both = [("XDG_CACHE_HOME", "/cache"), ("HOME", "/home/ada")];
            assert_eq!(folder(&both), Some("/cache/halfway".into()));
        }
    }
}
