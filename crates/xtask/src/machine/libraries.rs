//! Shared libraries, as the dynamic loader finds them.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::programs;

/// What can be loaded by name.
#[derive(Debug, Default)]
pub(crate) struct Libraries {
    /// The names in the loader's cache.
    cached: HashSet<String>,
    /// Where else to look.
    folders: Vec<PathBuf>,
}

impl Libraries {
    /// Those of this machine.
    pub(crate) fn here() -> Self {
        let cache = programs::find("ldconfig").and_then(|ldconfig| Command::new(ldconfig).arg("-p").output().ok());
        let cached = cache.map(|output| names_in_cache(&String::from_utf8_lossy(&output.stdout))).unwrap_or_default();
        let given = std::env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
        // Not every system keeps a cache; these are the usual places.
        let triple = format!("/usr/lib/{}-linux-gnu", std::env::consts::ARCH);
        let usual = ["/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib", "/run/opengl-driver/lib", &triple];
        let folders = std::env::split_paths(&given).chain(usual.map(PathBuf::from)).collect();
        Self { cached, folders }
    }

    /// Only those in `folder`.
    #[cfg(test)]
    pub(crate) fn in_folder(folder: &Path) -> Self {
        Self { folders: vec![folder.to_owned()], ..Self::default() }
    }

    /// Whether a library of this name, or at this path, can be loaded.
    pub(crate) fn has(&self, library: &str) -> bool {
        if library.contains('/') {
            return Path::new(library).is_file();
        }
        self.cached.contains(library) || self.folders.iter().any(|folder| folder.join(library).is_file())
    }

    /// The libraries among `needed` that cannot be loaded.
    pub(crate) fn missing<'a>(&self, needed: &[&'a str]) -> Vec<&'a str> {
        needed.iter().copied().filter(|library| !self.has(library)).collect()
    }
}

/// The names that `ldconfig -p` lists, one a line: `libm.so.6 (libc6,x86-64) => /lib/x86_64-linux-gnu/libm.so.6`.
fn names_in_cache(listing: &str) -> HashSet<String> {
    let entries = listing.lines().filter_map(|line| line.split_once("=>"));
    // The cache may be older than the removal of a package.
    let existing = entries.filter(|(_, path)| Path::new(path.trim()).is_file());
    existing.filter_map(|(entry, _)| entry.split_whitespace().next().map(str::to_owned)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cache_lists_what_still_exists() {
        let scratch = tempfile::tempdir().unwrap();
        let there = scratch.path().join("libthere.so.1");
        std::fs::write(&there, "").unwrap();
        let gone = scratch.path().join("libgone.so.1");
        let listing = format!(
            "2 libs found in cache `/etc/ld.so.cache'\n\tlibthere.so.1 (libc6,x86-64) => {}\n\tlibgone.so.1 (libc6) => {}\n",
            there.display(),
            gone.display()
        );
        assert_eq!(names_in_cache(&listing), HashSet::from(["libthere.so.1".to_owned()]));
    }

    #[test]
    fn libraries_by_name_and_by_path() {
        let scratch = tempfile::tempdir().unwrap();
        let path = scratch.path().join("liba.so");
        std::fs::write(&path, "").unwrap();
        let libraries = Libraries::in_folder(scratch.path());
        assert!(libraries.has("liba.so"));
        assert!(libraries.has(path.to_str().unwrap()));
        assert!(!libraries.has("libb.so"));
        assert!(!libraries.has(scratch.path().to_str().unwrap()), "a folder is no library");
        assert_eq!(libraries.missing(&["liba.so", "libb.so"]), ["libb.so"]);
    }
}
