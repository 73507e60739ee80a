//! `cargo xtask install-desktop`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;

use crate::cargo::{cargo, root, step};
use crate::failure::{Failure, Result};

/// Install the command, and thumbnails of models for file managers
///
/// Copies the command to PREFIX/bin, and the entries of assets/desktop/ to PREFIX/share: the thumbnailer of the
/// freedesktop specification, and the MIME types of model files. File managers that draw thumbnails in a sandbox see
/// only what is below /usr: give --prefix /usr/local for those.
#[derive(Args, Debug)]
#[command(verbatim_doc_comment)]
pub(crate) struct Options {
    /// The folder for bin/ and share/ [default: ~/.local]
    #[arg(long)]
    prefix: Option<PathBuf>,
}

pub(crate) fn run(options: &Options) -> Result {
    let home = || std::env::var_os("HOME").map(|home| Path::new(&home).join(".local"));
    let prefix =
        options.prefix.clone().or_else(home).ok_or_else(|| Failure::new("HOME is not set; expected --prefix"))?;
    step("build", &mut cargo(["build", "--release", "--bin", "halfway"]))?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    let mime = prefix.join("share/mime");
    for (from, to) in places(&target, &prefix) {
        copy(&from, &to)?;
        println!("{}", to.display());
    }
    // A desktop brings it; without a desktop nobody reads the types.
    let mut update = Command::new("update-mime-database");
    match update.arg(&mime).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Failure::new(format!("update-mime-database {}: {status}", mime.display()))),
        Err(_) => {
            eprintln!("note: update-mime-database is not there; a desktop finds the types of models after it has run");
            Ok(())
        }
    }
}

/// The files with their destinations.
fn places(target: &Path, prefix: &Path) -> [(PathBuf, PathBuf); 3] {
    let desktop = root().join("assets/desktop");
    let program = format!("halfway{}", std::env::consts::EXE_SUFFIX);
    [
        (target.join("release").join(&program), prefix.join("bin").join(program)),
        (desktop.join("halfway.thumbnailer"), prefix.join("share/thumbnailers/halfway.thumbnailer")),
        (desktop.join("halfway.xml"), prefix.join("share/mime/packages/halfway.xml")),
    ]
}

fn copy(from: &Path, to: &Path) -> Result {
    let failed = |error: std::io::Error| Failure::new(format!("{}: {error}", to.display()));
    to.parent().map_or(Ok(()), fs::create_dir_all).map_err(failed)?;
    // A program that runs cannot be written over, but its name can be given away.
    let _ = fs::remove_file(to);
    fs::copy(from, to).map(drop).map_err(failed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_entries_are_there_and_name_the_same_types() {
        let [_, (thumbnailer, _), (types, _)] = places(Path::new("target"), Path::new("/usr/local"));
        let [thumbnailer, types] = [thumbnailer, types].map(|file| fs::read_to_string(file).expect("it is there"));
        assert!(thumbnailer.contains("Exec=halfway thumbnail %i -o %o --size %s\n"));
        let named: Vec<&str> =
            types.split("mime-type type=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
        assert_eq!(named.len(), 6, "{named:?}");
        let line = thumbnailer.lines().find_map(|line| line.strip_prefix("MimeType=")).expect("types");
        assert!(named.iter().all(|name| line.split(';').any(|other| other == *name)), "{line}");
    }
}
